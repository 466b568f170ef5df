//! What the collapses leave of a part.

use super::mesh::{Mesh, MeshDivision};
use super::part::{PartSimplifier, Tally};
use crate::simplify::criterion::CollapseCriterion;

/// What is left of a part: much less than what it took to simplify it.
pub(super) struct PartOutcome<S> {
    /// Triangles by the places of their corners in the division, with their numbers in the input; and the vertices of
    /// them and of triangles between parts.
    pub(super) left: Mesh<S>,
    /// The place of each of these vertices, in ascending order.
    pub(super) places: Vec<u32>,
    /// For each vertex that the part had, the number in the part of the one that is left of it. Only in the guarded mode.
    pub(super) roots: Vec<u32>,
    pub(super) tally: Tally,
}

impl<S: Copy + Default> PartOutcome<S> {
    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> u64 {
        let left = &self.left;
        let numbers = left.numbers.len() + self.places.len() + self.roots.len();
        let bytes = size_of_val(&left.vertices[..])
            + size_of_val(&left.colors[..])
            + size_of_val(&left.triangles[..])
            + size_of_val(&left.texture[..])
            + left.lines.len()
            + 4 * numbers;
        bytes as u64
    }

    /// The outcome of part `i`, whose triangles have `numbers` in the input.
    pub(super) fn of<C: CollapseCriterion<State = S>>(
        part: &PartSimplifier<'_, C>,
        division: &MeshDivision,
        i: usize,
        numbers: &[u32],
    ) -> Self {
        let first = i * division.part_len;
        let count = part.triangle_count();
        let mut left = Mesh {
            triangles: Vec::with_capacity(count),
            numbers: Vec::with_capacity(count),
            lines: Vec::with_capacity(count),
            ..Mesh::default()
        };
        let mut is_left = division.is_between[first..first + part.surface.vertices.len()].to_vec();
        for (t, corners, lines) in part.triangles() {
            corners.iter().for_each(|&v| is_left[v as usize] = true);
            left.triangles.push(corners.map(|v| v + first as u32));
            left.numbers.push(numbers[t as usize]);
            left.lines.push(lines);
            left.texture.extend(part.surface.wedges.0.get(t as usize));
        }
        let of_left: Vec<usize> = (0..is_left.len()).filter(|&v| is_left[v]).collect();
        left.vertices = of_left.iter().map(|&v| part.surface.vertices[v]).collect();
        left.colors = of_left.iter().filter_map(|&v| part.colors.get(v).copied()).collect();
        let places = of_left.iter().map(|&v| (first + v) as u32).collect();
        Self { left, places, roots: part.roots(), tally: part.tally }
    }
}
