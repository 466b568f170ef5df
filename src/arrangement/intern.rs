//! Points at one place become one, by exact comparison of those that may be.
//!
//! The points are sorted by a linear form of their coordinates with uneven factors, in which hardly any two different points are
//! within each other's error. Equal points always are, so comparing those decides.

use super::ball::Ball;
use super::error::ArrangementError;
use super::kernel::{ClusterKernel, EXACT};
use super::point::ArrangementPoint;
use crate::budget::Budget;

/// Uneven, so that points of a common coordinate are apart.
const FACTORS: [f64; 3] = [0.732_050_807_568_877, 0.414_213_562_373_095, 0.541_196_100_146_197];

/// The first of the points of `candidates` (ascending) at the place of each, in their order.
pub(super) fn first_at_place(
    kernel: &ClusterKernel,
    points: &[ArrangementPoint],
    candidates: &[u32],
    budget: &Budget,
) -> Result<Vec<u32>, ArrangementError> {
    let mut by_form = Vec::with_capacity(candidates.len());
    for (i, &id) in candidates.iter().enumerate() {
        if i % 1024 == 0 {
            // Most clusters have a few.
            budget.spend((candidates.len() - i).min(1024) as u64 * EXACT)?;
        }
        let near = points[id as usize].near;
        let form = (0..3).fold(Ball::exactly(0.0), |sum, k| sum + near[k] * Ball::exactly(FACTORS[k]));
        // What is not known may be everywhere.
        let [low, high] = match form.rad.is_finite() && form.mid.is_finite() {
            true => [form.mid - form.rad * 2.0, form.mid + form.rad * 2.0],
            false => [f64::NEG_INFINITY, f64::INFINITY],
        };
        by_form.push((low, high, i as u32));
    }
    by_form.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
    // Index of the first candidate at the same place that the sweep met, and then the lowest of those.
    let mut head: Vec<u32> = (0..candidates.len() as u32).collect();
    let mut open: Vec<(f64, u32)> = Vec::new();
    for (low, high, i) in by_form {
        open.retain(|&(end, _)| end >= low);
        budget.spend(8 * (1 + open.len() as u64))?;
        let point = |i: u32| &points[candidates[i as usize] as usize];
        match open.iter_mut().find(|(_, other)| kernel.is_same(point(i), point(*other))) {
            Some((end, other)) => {
                head[i as usize] = *other;
                *end = end.max(high);
            }
            None => open.push((high, i)),
        }
    }
    let mut first: Vec<u32> = (0..candidates.len() as u32).collect();
    for (i, &h) in head.iter().enumerate() {
        first[h as usize] = first[h as usize].min(i as u32);
    }
    Ok(head.iter().map(|&h| candidates[first[h as usize] as usize]).collect())
}
