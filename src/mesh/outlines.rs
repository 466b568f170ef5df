//! Polygons among triangles: which triangles are one polygon, and how the outline of each face runs. No coordinates here.
//!
//! A polygon of n corners is n - 2 triangles that follow each other in the list. The edges between them are its diagonals,
//! which are no edges of the mesh: whatever else joins the same two vertices, the two half-edges of a diagonal belong to
//! each other alone.

use super::corners::{edge_of, next_corner, prev_corner, triangle_of};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use std::ops::Range;

/// Which triangles of a list are one polygon with the triangle before them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PolygonRuns {
    /// One mark for each triangle; empty when no polygon was ever noted.
    goes_on: Vec<bool>,
}

impl PolygonRuns {
    /// The runs of `triangle_count` triangles of which these ranges are polygons.
    pub fn of(triangle_count: usize, polygons: impl IntoIterator<Item = Range<usize>>) -> Self {
        let mut goes_on = Vec::new();
        for range in polygons {
            goes_on.resize(triangle_count, false);
            goes_on[range.start + 1..range.end].fill(true);
        }
        Self { goes_on }
    }

    /// True when every triangle is a face of its own, and none was ever part of a polygon.
    pub fn is_empty(&self) -> bool {
        self.goes_on.is_empty()
    }

    /// Number of triangles that it knows of; 0 when it is empty.
    pub fn len(&self) -> usize {
        self.goes_on.len()
    }

    /// The triangles of each face, in their order, of `triangle_count` triangles.
    pub fn faces(&self, triangle_count: usize) -> impl Iterator<Item = Range<usize>> {
        let mut start = 0;
        std::iter::from_fn(move || {
            let face = start..self.end_of(start, triangle_count);
            start = face.end;
            (!face.is_empty()).then_some(face)
        })
    }

    /// The triangles of the face that begins with triangle `start`.
    pub fn face_from(&self, start: usize) -> Range<usize> {
        start..self.end_of(start, start + 1 + self.goes_on.len())
    }

    /// True when triangle `t` is part of a polygon.
    pub fn is_part(&self, t: usize) -> bool {
        let goes_on = |t: usize| self.goes_on.get(t) == Some(&true);
        goes_on(t) || goes_on(t + 1)
    }

    /// Number of polygons.
    pub fn polygon_count(&self) -> u64 {
        // Each has one triangle that does not go on and is followed by one that does.
        self.goes_on.windows(2).filter(|pair| !pair[0] && pair[1]).count() as u64
    }

    /// Where the face ends that begins at triangle `start`.
    fn end_of(&self, start: usize, triangle_count: usize) -> usize {
        if start >= triangle_count {
            return start;
        }
        let more = self.goes_on.get(start + 1..).unwrap_or_default();
        start + 1 + more.iter().take_while(|goes_on| **goes_on).count()
    }

    /// Makes the triangles of the polygon with triangle `t` faces of their own; false when `t` is one.
    pub fn split(&mut self, t: usize) -> bool {
        if self.is_empty() {
            return false;
        }
        let start = t - self.goes_on[..=t].iter().rev().take_while(|goes_on| **goes_on).count();
        let end = self.end_of(start, self.goes_on.len());
        self.goes_on[start..end].fill(false);
        end - start > 1
    }

    /// Keeps the triangles that are marked; what is left of a polygon that does not stay whole are triangles.
    pub fn retain(&mut self, is_kept: &[bool]) {
        let mut kept = Vec::with_capacity(self.goes_on.len());
        for face in self.faces(self.goes_on.len()) {
            let marks = &is_kept[face.clone()];
            let is_whole = marks.iter().all(|&is_kept| is_kept);
            let of_face = face.zip(marks).filter(|&(_, &is_kept)| is_kept);
            kept.extend(of_face.map(|(t, _)| is_whole && self.goes_on[t]));
        }
        self.goes_on = kept;
    }

    /// Appends a face of so many triangles to a list of `triangle_count`.
    pub fn push_face(&mut self, triangle_count: usize, triangles: usize) {
        if triangles > 1 || !self.is_empty() {
            self.goes_on.resize(triangle_count, false);
            self.goes_on.extend((0..triangles).map(|i| i > 0));
        }
    }

    /// Appends triangles that are faces of their own.
    pub fn push_triangles(&mut self, count: usize) {
        if !self.is_empty() {
            self.goes_on.resize(self.goes_on.len() + count, false);
        }
    }
}

/// In the place of a neighbour of a diagonal.
const INSIDE: u32 = u32::MAX;

/// The outlines of faces as half-edges that follow each other. Empty, and without cost, when all faces are triangles.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Outlines {
    /// The half-edge after each one along the outline of its face; [`INSIDE`] for diagonals.
    next: Vec<u32>,
    /// The half-edge before.
    previous: Vec<u32>,
    /// The first triangle of the face of each triangle.
    first: Vec<u32>,
}

impl Outlines {
    /// The outlines of `triangles`, of which `runs` are polygons: each a disk whose corners are different vertices.
    /// O(n log n) in the corners of a polygon.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn of(triangles: &[[u32; 3]], runs: &PolygonRuns, budget: &Budget) -> Result<Self, Stopped> {
        if runs.is_empty() {
            return Ok(Self::default());
        }
        let half_edges = triangles.len() * 3;
        let mut outlines = Self {
            next: vec![INSIDE; half_edges],
            previous: vec![INSIDE; half_edges],
            first: Vec::with_capacity(triangles.len()),
        };
        let mut unpaid = 0;
        for face in runs.faces(triangles.len()) {
            unpaid += face.len();
            if unpaid >= CHECK_EVERY {
                budget.spend(std::mem::take(&mut unpaid) as u64 / 8)?;
            }
            outlines.first.resize(face.end, face.start as u32);
            outlines.trace(triangles, &face);
        }
        Ok(outlines)
    }

    /// Notes the outline of one face.
    fn trace(&mut self, triangles: &[[u32; 3]], face: &Range<usize>) {
        let half_edges = 3 * face.start as u32..3 * face.end as u32;
        let mut by_ends: Vec<([u32; 2], u32)> = half_edges
            .clone()
            .map(|h| {
                let [a, b] = edge_of(triangles, h);
                ([a.min(b), a.max(b)], h)
            })
            .collect();
        by_ends.sort_unstable();
        let mut twin = vec![INSIDE; by_ends.len()];
        for pair in by_ends.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            let [g, h] = [pair[0].1, pair[1].1];
            twin[(g - half_edges.start) as usize] = h;
            twin[(h - half_edges.start) as usize] = g;
        }
        let twin = |h: u32| twin[(h - half_edges.start) as usize];
        for h in half_edges.clone().filter(|&h| twin(h) == INSIDE) {
            let mut next = next_corner(h);
            // Around the corner that h goes to, from triangle to triangle; no half-edge is met twice.
            while twin(next) != INSIDE {
                next = next_corner(twin(next));
            }
            self.next[h as usize] = next;
            self.previous[next as usize] = h;
        }
    }

    /// True when some face may have more than three corners.
    pub fn has_polygons(&self) -> bool {
        !self.next.is_empty()
    }

    /// True when half-edge `h` is inside of a polygon.
    pub fn is_diagonal(&self, h: u32) -> bool {
        self.has_polygons() && self.next[h as usize] == INSIDE
    }

    /// The half-edge after `h`, which is no diagonal, along the outline of its face.
    pub fn next(&self, h: u32) -> u32 {
        if self.has_polygons() { self.next[h as usize] } else { next_corner(h) }
    }

    /// The half-edge before `h`, which is no diagonal, along the outline of its face.
    pub fn previous(&self, h: u32) -> u32 {
        if self.has_polygons() { self.previous[h as usize] } else { prev_corner(h) }
    }

    /// The face of half-edge `h`, by its first triangle.
    pub fn face(&self, h: u32) -> u32 {
        let t = triangle_of(h);
        if self.has_polygons() { self.first[t as usize] } else { t }
    }

    /// The half-edges along the outline of a face, beginning at the first corner of its first triangle where the outline
    /// enters or leaves it there, and at any other corner elsewhere.
    pub fn along(&self, first_triangle: u32) -> impl Iterator<Item = u32> {
        let corner = 3 * first_triangle;
        let start = if !self.is_diagonal(corner) {
            corner
        } else if !self.is_diagonal(prev_corner(corner)) {
            self.next(prev_corner(corner))
        } else {
            (corner..).find(|&h| !self.is_diagonal(h)).unwrap_or(corner)
        };
        let mut at = Some(start);
        std::iter::from_fn(move || {
            let h = at?;
            at = Some(self.next(h)).filter(|&next| next != start);
            Some(h)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outlines(triangles: &[[u32; 3]], runs: &PolygonRuns) -> Vec<Vec<u32>> {
        let outlines = Outlines::of(triangles, runs, &Budget::unlimited()).unwrap();
        let corners = |face: Range<usize>| {
            outlines.along(face.start as u32).map(|h| edge_of(triangles, h)[0]).collect()
        };
        runs.faces(triangles.len()).map(corners).collect()
    }

    #[test]
    fn triangles_are_their_own_outlines() {
        let triangles = [[0, 1, 2], [3, 4, 5]];
        assert_eq!(outlines(&triangles, &PolygonRuns::default()), [[0, 1, 2], [3, 4, 5]]);
    }

    #[test]
    fn a_polygon_is_what_is_around_its_triangles_however_it_is_split() {
        // A hexagon as a fan, as ears around a triangle in the middle, and one that starts with that triangle.
        for split in [
            [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]],
            [[0, 1, 2], [2, 3, 4], [4, 5, 0], [0, 2, 4]],
            [[2, 4, 0], [0, 1, 2], [2, 3, 4], [4, 5, 0]],
        ] {
            let mut triangles = vec![[7, 8, 9]];
            triangles.extend(split);
            triangles.push([0, 2, 7]);
            let runs = PolygonRuns::of(6, std::iter::once(1..5));
            let got = outlines(&triangles, &runs);
            assert_eq!(
                (&got[0][..], &got[1][..], &got[2][..]),
                (&[7, 8, 9][..], &[0, 1, 2, 3, 4, 5][..], &[0, 2, 7][..])
            );
            let turned: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
            let mut back = outlines(&turned, &runs)[1].clone();
            // From 0 on where that is a corner of the first triangle's outline, from elsewhere otherwise.
            let start = back.iter().position(|&v| v == 0).unwrap();
            assert!(start == 0 || triangles[1] == [2, 4, 0]);
            back.rotate_left(start);
            assert_eq!(back, [0, 5, 4, 3, 2, 1]);
        }
    }

    #[test]
    fn what_is_left_of_a_polygon_are_triangles() {
        let mut runs = PolygonRuns::of(6, [0..2, 3..6]);
        let faces = |runs: &PolygonRuns| runs.faces(runs.len()).collect::<Vec<_>>();
        assert_eq!(faces(&runs), [0..2, 2..3, 3..6]);
        runs.retain(&[true, true, false, true, false, true]);
        assert_eq!(faces(&runs), [0..2, 2..3, 3..4]);
        runs.push_face(4, 3);
        runs.push_triangles(1);
        assert_eq!(faces(&runs), [0..2, 2..3, 3..4, 4..7, 7..8]);
        assert!(runs.split(5) && !runs.split(5) && !runs.split(7));
        assert_eq!(faces(&runs)[3..], [4..5, 5..6, 6..7, 7..8]);
        assert!(!PolygonRuns::default().split(0));
    }
}
