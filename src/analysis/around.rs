//! What the boxes of the parts say about which part can lie in which.

use super::members::Members;
use super::welded::Welded;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::Aabb;
use crate::par;

/// What may be around a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Enclosure {
    /// No box of another part holds this part's box: nothing is around it.
    Nothing,
    /// Only boxes of parts that can be told inside from outside do.
    Known,
    /// The box of a part that cannot be told inside from outside does.
    Unclear,
}

/// The box of each part.
pub(super) fn part_boxes(
    mesh: &Welded<'_>,
    members: &Members,
    budget: &Budget,
) -> Result<Vec<Aabb>, Stopped> {
    par::try_map_ranges(mesh.parts.len(), 1, |range| {
        let mut bounds = Aabb::EMPTY;
        for block in members.part(range.start as u32).chunks(CHECK_EVERY) {
            budget.check()?;
            bounds = bounds.union(Aabb::of(block.iter().flat_map(|&t| mesh.corners(t))));
        }
        Ok(bounds)
    })
}

/// What may be around each box; `is_clear` tells whose inside is known. A sweep along the widest axis.
pub(super) fn around(boxes: &[Aabb], is_clear: &[bool], budget: &Budget) -> Result<Vec<Enclosure>, Stopped> {
    let all = boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
    let axis = (all.max / 2.0 - all.min / 2.0).max_position();
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_unstable_by(|&a, &b| boxes[a].min[axis].total_cmp(&boxes[b].min[axis]).then(a.cmp(&b)));
    let mut around = vec![Enclosure::Nothing; boxes.len()];
    let mut begun = order.iter().copied().peekable();
    // Boxes that have begun along the axis and not yet ended.
    let mut open: Vec<usize> = Vec::new();
    for &inner in &order {
        let from = boxes[inner].min[axis];
        open.retain(|&outer| boxes[outer].max[axis] >= from);
        while let Some(outer) = begun.next_if(|&outer| boxes[outer].min[axis] <= from) {
            open.push(outer);
        }
        budget.spend(open.len() as u64)?;
        let outers = open.iter().filter(|&&outer| outer != inner && holds(boxes[outer], boxes[inner]));
        let claims = outers.map(|&outer| if is_clear[outer] { Enclosure::Known } else { Enclosure::Unclear });
        around[inner] = claims.max().unwrap_or(Enclosure::Nothing);
    }
    Ok(around)
}

fn holds(outer: Aabb, inner: Aabb) -> bool {
    outer.min.cmple(inner.min).all() && outer.max.cmpge(inner.max).all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    fn random_boxes(count: usize, seed: u32) -> Vec<Aabb> {
        let mut state = seed;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from((state >> 16) % 8)
        };
        (0..count)
            .map(|_| {
                let [a, b] = std::array::from_fn(|_| DVec3::new(random(), random(), random()));
                Aabb::of([a, b])
            })
            .collect()
    }

    #[test]
    fn the_sweep_agrees_with_all_pairs() {
        for seed in 0..200 {
            let boxes = random_boxes(20, seed);
            let is_clear: Vec<bool> = (0..20).map(|i| i % 3 != 0).collect();
            let wanted: Vec<Enclosure> = (0..20)
                .map(|i| {
                    let outers = (0..20).filter(|&o| o != i && holds(boxes[o], boxes[i]));
                    let claims =
                        outers.map(|o| if is_clear[o] { Enclosure::Known } else { Enclosure::Unclear });
                    claims.max().unwrap_or(Enclosure::Nothing)
                })
                .collect();
            assert_eq!(around(&boxes, &is_clear, &Budget::unlimited()).unwrap(), wanted, "seed {seed}");
        }
    }
}
