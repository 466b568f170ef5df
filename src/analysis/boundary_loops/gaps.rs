//! Rims that run along another rim: a crack between two parts, or between two places of one, that were never joined.

use super::BoundaryLoops;
use super::shape::inward;
use crate::analysis::Context;
use crate::budget::{CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::edge_of;
use crate::spatial::Bvh;

/// How far another rim may be, as a share of the mean length of the loop's edges: a tenth, so that a wall between the
/// inner and the outer rim of a pipe is hardly ever that thin.
const GAP_SHARE_MAX: f64 = 0.1;

/// Edges that are looked at for each boundary edge, and in all, before the search is given up: no crack is told then.
const VISITS_PER_EDGE: u64 = 64;
const VISITS_MIN: u64 = 1 << 20;

/// For each loop, the largest distance of its vertices from other loops where all are near one whose faces are on the
/// other side; infinite for other loops.
pub(super) fn gaps(loops: &BoundaryLoops, cx: &Context<'_>) -> Result<Vec<f64>, Stopped> {
    let mut gaps = vec![f64::INFINITY; loops.len()];
    if loops.len() < 2 {
        return Ok(gaps);
    }
    let mesh = &cx.mesh;
    let half_edges = &loops.rims.half_edges;
    let _charge = cx.budget.charge(half_edges.len() as u64 * (Bvh::BYTES_PER_TRIANGLE + 16))?;
    let edges: Vec<[u32; 3]> = half_edges
        .iter()
        .map(|&h| {
            let [a, b] = edge_of(&mesh.triangles, h);
            [a, b, b]
        })
        .collect();
    let loop_of = loops.loop_of_edges();
    let bvh = Bvh::build(&mesh.soup.positions, &edges, None, cx.budget)?;
    let place = |v: u32| mesh.position(v);
    let into = |edge: u32| {
        let [a, b, _] = edges[edge as usize];
        inward(place(a), place(b), mesh.apex(half_edges[edge as usize]))
    };
    let visits_max = VISITS_MIN.max(VISITS_PER_EDGE * half_edges.len() as u64);
    let (mut visits, mut queries) = (0u64, 0usize);
    for (number, gap) in gaps.iter_mut().enumerate() {
        let Some(shape) = loops.shape(number) else { continue };
        let reach = GAP_SHARE_MAX * shape.mean_edge();
        let (mut largest, mut side) = (0.0f64, 0.0);
        for &end in loops.chain(number) {
            queries += 1;
            if queries.is_multiple_of(CHECK_EVERY) {
                cx.budget.check()?;
            }
            let p = place(loops.rims.vertex(end, mesh));
            let mut nearest = (reach, u32::MAX);
            let around = Aabb { min: p - reach, max: p + reach };
            bvh.visit_box(around, cx.budget, |edge| {
                visits += 1;
                if loop_of[edge as usize] != number as u32 {
                    let [a, b, _] = edges[edge as usize];
                    let distance = distance_to_segment(p, place(a), place(b));
                    if distance < nearest.0 || (distance == nearest.0 && edge < nearest.1) {
                        nearest = (distance, edge);
                    }
                }
            })?;
            if visits > visits_max {
                return Ok(gaps_told(gaps, number));
            }
            if nearest.1 == u32::MAX {
                side = f64::INFINITY;
                break;
            }
            largest = largest.max(nearest.0);
            side += into(end / 2).dot(into(nearest.1));
        }
        if side < 0.0 {
            *gap = largest;
        }
    }
    Ok(gaps)
}

/// What was found before the search was given up at loop `number`.
fn gaps_told(mut gaps: Vec<f64>, number: usize) -> Vec<f64> {
    gaps[number..].fill(f64::INFINITY);
    gaps
}

fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let share = (p - a).dot(along) / along.length_squared();
    // The share is not a number where the squares vanish; then the ends are one place for all that matters here.
    let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
    p.distance(a + along * share)
}
