//! The order in which the strict mode keeps vertices and triangles: along a space-filling curve, so that what a collapse
//! reads lies together.

use super::order::along_curve;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::corner_table::NONE;

/// The numbers that vertices and triangles have in the input.
#[derive(Debug, Clone)]
pub(super) struct InputNumbers {
    /// Of the vertices that triangles use, along the curve.
    pub(super) vertices: Vec<u32>,
    /// Of the triangles, by the first of their vertices along the curve.
    pub(super) triangles: Vec<u32>,
}

impl InputNumbers {
    /// Bytes that the layout of a mesh takes.
    pub(super) const fn bytes(positions: usize, triangles: usize) -> u64 {
        (4 * positions + 4 * triangles) as u64
    }

    /// The layout of `triangles`, which use only vertices of `positions`, and the triangles in it: vertices by their
    /// places, corners in the order that they have.
    pub(super) fn of(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        budget: &Budget,
    ) -> Result<(Self, Vec<[u32; 3]>), Stopped> {
        // Keys along the curve, then places.
        let _charge = budget.charge(8 * positions.len() as u64)?;
        let mut used = vec![false; positions.len()];
        for block in triangles.chunks(CHECK_EVERY) {
            budget.check()?;
            block.as_flattened().iter().for_each(|&v| used[v as usize] = true);
        }
        let (vertices, _) = along_curve(|v| positions[v], &used, DVec3::ZERO, budget)?;
        drop(used);
        let mut place = vec![NONE; positions.len()];
        (0u32..).zip(&vertices).for_each(|(new, &old)| place[old as usize] = new);
        let placed = |t: &[u32; 3]| t.map(|v| place[v as usize]);
        let first = |t: &[u32; 3]| placed(t).into_iter().fold(NONE, u32::min) as usize;
        let mut next = vec![0u32; vertices.len() + 1];
        triangles.iter().for_each(|t| next[first(t) + 1] += 1);
        (0..vertices.len()).for_each(|v| next[v + 1] += next[v]);
        let (mut numbers, mut sorted) = (vec![0; triangles.len()], vec![[0; 3]; triangles.len()]);
        for (t, corners) in triangles.iter().enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let next = &mut next[first(corners)];
            numbers[*next as usize] = t as u32;
            sorted[*next as usize] = placed(corners);
            *next += 1;
        }
        Ok((Self { vertices, triangles: numbers }, sorted))
    }

    /// What belongs to the vertices of the input, in this layout; nothing of nothing.
    pub(super) fn of_vertices<T: Copy>(&self, items: &[T]) -> Vec<T> {
        in_layout(&self.vertices, items)
    }

    /// What belongs to the triangles of the input, in this layout; nothing of nothing.
    pub(super) fn of_triangles<T: Copy>(&self, items: &[T]) -> Vec<T> {
        in_layout(&self.triangles, items)
    }
}

fn in_layout<T: Copy>(numbers: &[u32], items: &[T]) -> Vec<T> {
    if items.is_empty() {
        return Vec::new();
    }
    numbers.iter().map(|&number| items[number as usize]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_keep_their_corners_and_lie_along_the_curve() {
        let positions: Vec<DVec3> =
            [3.0, 0.0, 2.0, 9.0, 1.0].into_iter().map(|x| DVec3::new(x, x * x, 0.0)).collect();
        let triangles = [[0, 2, 4], [2, 1, 4]];
        let (layout, sorted) = InputNumbers::of(&positions, &triangles, &Budget::unlimited()).unwrap();
        assert_eq!(layout.vertices, [1, 4, 2, 0], "3 is not used");
        assert_eq!(layout.triangles, [1, 0]);
        assert_eq!(sorted, [[2, 0, 1], [3, 2, 1]]);
        assert_eq!(layout.of_vertices(&['a', 'b', 'c', 'd', 'e']), ['b', 'e', 'c', 'a']);
        assert!(layout.of_triangles::<u8>(&[]).is_empty());
    }
}
