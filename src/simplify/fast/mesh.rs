//! The mesh between two rounds: compact arrays, cut in parts along a space-filling curve.

use super::region::CodeRegion;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::Color;
use crate::par;
use crate::simplify::order::{Curve, along_curve};
use crate::simplify::surface::Vertex;
use std::sync::atomic::{AtomicBool, Ordering};

/// What is left of the input, and some vertices without triangles.
#[derive(Debug, Clone, Default)]
pub(super) struct Mesh<S> {
    pub(super) vertices: Vec<Vertex<S>>,
    /// Of the vertices; empty when the input has none.
    pub(super) colors: Vec<Option<Color>>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Numbers that the triangles have in the input.
    pub(super) numbers: Vec<u32>,
    /// For each triangle, bit `k` is set when the edge from corner `k` is a line.
    pub(super) lines: Vec<u8>,
    /// Texture coordinates of the triangles' corners; empty when the input has none.
    pub(super) texture: Vec<[[f64; 2]; 3]>,
}

/// A mesh cut in parts.
pub(super) struct MeshDivision {
    /// Vertices of a part; the last has fewer.
    pub(super) part_len: usize,
    /// The vertices of all parts, one part after the other. Triangles name vertices by their place here.
    pub(super) order: Vec<u32>,
    /// Where the triangles of each part begin, and after them those between parts.
    pub(super) starts: Vec<usize>,
    /// For each place in `order`, whether a triangle between parts uses the vertex.
    pub(super) is_between: Vec<bool>,
    /// What `order` follows.
    curve: Curve,
    /// The first and the last code of each part.
    codes: Vec<[u32; 2]>,
}

impl MeshDivision {
    /// The first triangle between parts.
    pub(super) fn first_between(&self) -> usize {
        self.starts.last().copied().unwrap_or(0)
    }

    /// The vertices of part `i`.
    pub(super) fn vertices(&self, i: usize) -> &[u32] {
        &self.order[i * self.part_len..self.order.len().min((i + 1) * self.part_len)]
    }

    /// The space of part `i`.
    pub(super) fn region(&self, i: usize) -> CodeRegion {
        let before = |i: usize| i.checked_sub(1).and_then(|i| self.codes.get(i));
        CodeRegion {
            curve: self.curve,
            after: before(i).map(|codes| codes[1]),
            before: self.codes.get(i + 1).map(|codes| codes[0]),
        }
    }
}

impl<S: Copy + Send + Sync> Mesh<S> {
    /// Cuts the mesh in parts of `part_len` vertices, which are neighbours along a curve that `shift` moves. The
    /// triangles are sorted by part, those between parts last.
    pub(super) fn divide(
        &mut self,
        part_len: usize,
        shift: DVec3,
        budget: &Budget,
    ) -> Result<MeshDivision, Stopped> {
        let used: Vec<AtomicBool> = par::map_indices(self.vertices.len(), CHECK_EVERY, |_| false.into());
        par::try_map_ranges(self.triangles.len(), CHECK_EVERY, |range| {
            let corners = self.triangles[range].as_flattened();
            corners.iter().for_each(|&v| used[v as usize].store(true, Ordering::Relaxed));
            budget.check()
        })?;
        let used: Vec<bool> = used.into_iter().map(AtomicBool::into_inner).collect();
        let (order, curve) = along_curve(|v| self.vertices[v].position, &used, shift, budget)?;
        drop(used);
        let mut place = vec![0u32; self.vertices.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old as usize] = new as u32;
        }
        par::for_each_chunk_mut(&mut self.triangles, CHECK_EVERY, |_, triangles| {
            triangles.as_flattened_mut().iter_mut().for_each(|v| *v = place[*v as usize]);
        });
        drop(place);
        let part_len = part_len.min(order.len()).max(1);
        let (starts, is_between) = self.sort_triangles(part_len, order.len(), budget)?;
        let code = |&v: &u32| curve.code(self.vertices[v as usize].position);
        let ends = |part: &[u32]| [part.first().map_or(0, code), part.last().map_or(0, code)];
        let codes = order.chunks(part_len).map(ends).collect();
        Ok(MeshDivision { part_len, order, starts, is_between, curve, codes })
    }

    fn sort_triangles(
        &mut self,
        part_len: usize,
        vertex_count: usize,
        budget: &Budget,
    ) -> Result<(Vec<usize>, Vec<bool>), Stopped> {
        let parts = vertex_count.div_ceil(part_len);
        let part_of = par::map_indices(self.triangles.len(), CHECK_EVERY, |t| {
            let [a, b, c] = self.triangles[t].map(|v| v as usize / part_len);
            if a == b && b == c { a as u32 } else { parts as u32 }
        });
        let mut starts = vec![0usize; parts + 2];
        let mut is_between = vec![false; vertex_count];
        for (t, &part) in part_of.iter().enumerate() {
            starts[part as usize + 1] += 1;
            if part as usize == parts {
                self.triangles[t].iter().for_each(|&v| is_between[v as usize] = true);
            }
        }
        budget.check()?;
        for part in 0..=parts {
            starts[part + 1] += starts[part];
        }
        let mut next = starts.clone();
        let count = self.triangles.len();
        let mut sorted = vec![0u32; count];
        for (t, &part) in (0..).zip(&part_of) {
            let place = &mut next[part as usize];
            sorted[*place] = t;
            *place += 1;
        }
        drop(part_of);
        budget.check()?;
        self.triangles = gathered(&self.triangles, &sorted);
        self.numbers = gathered(&self.numbers, &sorted);
        self.lines = gathered(&self.lines, &sorted);
        if !self.texture.is_empty() {
            self.texture = gathered(&self.texture, &sorted);
        }
        starts.pop();
        Ok((starts, is_between))
    }
}

/// The items at `places`.
fn gathered<T: Copy + Send + Sync>(items: &[T], places: &[u32]) -> Vec<T> {
    par::map_indices(places.len(), CHECK_EVERY, |i| items[places[i] as usize])
}
