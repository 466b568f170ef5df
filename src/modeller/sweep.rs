//! Which of two sets of boxes meet.

use super::contact::do_meet;
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};

/// Pairs up to which each is compared with each.
const FEW_PAIRS: usize = 1024;

/// Calls `visit` with the places of every box of `left` and every box of `right` that meet. Boxes may be infinite.
pub(super) fn each_meeting(
    left: &[Aabb],
    right: &[Aabb],
    budget: &Budget,
    mut visit: impl FnMut(usize, usize),
) -> Result<(), Stopped> {
    if left.len() * right.len() <= FEW_PAIRS {
        budget.spend(right.len() as u64 / 16 + 1)?;
        for (i, a) in left.iter().enumerate() {
            (0..right.len()).filter(|&j| do_meet(a, &right[j])).for_each(|j| visit(i, j));
        }
        return Ok(());
    }
    // Boxes in the order of their lower ends along an axis, each compared with those of the other side still open.
    let axis = narrow_axis(left, right);
    let mut order: Vec<(f64, bool, usize)> = Vec::with_capacity(left.len() + right.len());
    order.extend(left.iter().enumerate().map(|(i, b)| (b.min[axis], true, i)));
    order.extend(right.iter().enumerate().map(|(j, b)| (b.min[axis], false, j)));
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let (mut open_left, mut open_right): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
    for (low, is_left, k) in order {
        budget.spend(1 + if is_left { open_right.len() } else { open_left.len() } as u64 / 64)?;
        if is_left {
            open_right.retain(|&j| right[j].max[axis] >= low);
            open_right.iter().filter(|&&j| do_meet(&left[k], &right[j])).for_each(|&j| visit(k, j));
            open_left.push(k);
        } else {
            open_left.retain(|&i| left[i].max[axis] >= low);
            open_left.iter().filter(|&&i| do_meet(&left[i], &right[k])).for_each(|&i| visit(i, k));
            open_right.push(k);
        }
    }
    Ok(())
}

/// The axis along which boxes are shortest, beside all that is bounded.
fn narrow_axis(left: &[Aabb], right: &[Aabb]) -> usize {
    let boxes = || left.iter().chain(right);
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for corner in boxes().flat_map(|b| [b.min, b.max]) {
        for k in (0..3).filter(|&k| corner[k].is_finite()) {
            (low[k], high[k]) = (low[k].min(corner[k]), high[k].max(corner[k]));
        }
    }
    let width = |k: usize| {
        let lengths = boxes().map(|b| b.max[k].min(high[k]) - b.min[k].max(low[k]));
        let length = high[k] - low[k];
        if length > 0.0 { lengths.sum::<f64>() / length } else { f64::INFINITY }
    };
    (0..3).min_by(|&a, &b| width(a).total_cmp(&width(b))).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_finds_each_pair_once_infinite_boxes_too() {
        let mut state = 1u64;
        let mut number = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % below) as f64
        };
        let mut boxes = |count: usize| -> Vec<Aabb> {
            let one = |_| {
                let min = DVec3::new(number(40), number(20), number(40));
                let mut max = min + DVec3::new(number(4), number(9), number(4));
                if number(10) == 0.0 {
                    max.x = f64::INFINITY;
                }
                Aabb { min, max }
            };
            (0..count).map(one).collect()
        };
        let (left, right) = (boxes(90), boxes(70));
        let mut found = Vec::new();
        each_meeting(&left, &right, &Budget::unlimited(), |i, j| found.push((i, j))).unwrap();
        found.sort_unstable();
        let all = (0..90).flat_map(|i| (0..70).map(move |j| (i, j)));
        let expected: Vec<(usize, usize)> = all.filter(|&(i, j)| do_meet(&left[i], &right[j])).collect();
        assert_eq!(found, expected);
    }
}
