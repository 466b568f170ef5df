//! Finds the lines of the whole mesh when it is cut in parts for the first time: borders, creases and borders between
//! face groups.

use super::mesh::{Mesh, MeshDivision};
use super::part::PartTopology;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::corner_table::{NONE, triangle_of};
use crate::par;
use crate::simplify::options::{Borders, SimplifyOptions};

/// A half-edge of the sorted triangles, with its ends, the smaller first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct SortedHalfEdge {
    ends: [u32; 2],
    triangle: u32,
    corner: u32,
}

/// The lines on the edges inside parts.
struct InnerLines {
    /// Lines with two triangles, by one of their half-edges and its twin.
    seams: Vec<[(u32, u32); 2]>,
    /// Half-edges on a border.
    borders: Vec<(u32, u32)>,
    /// Half-edges that have their twin, if there is one, elsewhere.
    loose: Vec<SortedHalfEdge>,
}

pub(super) struct LineMarking<'l, S> {
    pub(super) mesh: &'l mut Mesh<S>,
    pub(super) division: &'l MeshDivision,
    pub(super) pieces: &'l [PartTopology],
    /// Of the input's triangles; empty when all are in one.
    pub(super) groups: &'l [u32],
    pub(super) options: &'l SimplifyOptions<'l>,
    pub(super) budget: &'l Budget,
}

impl<S: Copy + Send + Sync> LineMarking<'_, S> {
    /// Marks the lines of the mesh, and at its vertices how many there are; gives the numbers of the triangles on a
    /// border. Nothing when an edge has more than two triangles, or two in the same direction.
    pub(super) fn mark(mut self) -> Result<Option<Vec<u32>>, Stopped> {
        let inside = par::try_map_ranges(self.pieces.len(), 1, |range| {
            self.budget.check()?;
            Ok(self.inside(range.start))
        })?;
        let (mut seams, mut borders, mut loose) = (Vec::new(), Vec::new(), self.between());
        for part in inside {
            seams.extend(part.seams);
            borders.extend(part.borders);
            loose.extend(part.loose);
        }
        par::sort_unstable(&mut loose);
        for group in loose.chunk_by(|a, b| a.ends == b.ends) {
            match *group {
                [side] => borders.push((side.triangle, side.corner)),
                [a, b] if self.from(a) != self.from(b) => {
                    let pair = [a, b].map(|side| (side.triangle, side.corner));
                    if self.is_seam(pair) {
                        seams.push(pair);
                    }
                }
                _ => return Ok(None),
            }
        }
        self.note(&seams, &borders)?;
        Ok(Some(borders.into_iter().map(|(t, _)| self.mesh.numbers[t as usize]).collect()))
    }

    fn from(&self, side: SortedHalfEdge) -> u32 {
        self.mesh.triangles[side.triangle as usize][side.corner as usize]
    }

    fn inside(&self, part: usize) -> InnerLines {
        let PartTopology { table, is_free } = &self.pieces[part];
        let first = self.division.starts[part] as u32;
        let mut found = InnerLines { seams: Vec::new(), borders: Vec::new(), loose: Vec::new() };
        let place = |h: u32| (first + triangle_of(h), h & 3);
        for h in table.half_edges() {
            let twin = table.twin(h);
            if twin != NONE {
                if h < twin && self.is_seam([place(h), place(twin)]) {
                    found.seams.push([place(h), place(twin)]);
                }
            } else if is_free[table.origin(h) as usize] || is_free[table.destination(h) as usize] {
                found.borders.push(place(h));
            } else {
                found.loose.push(self.side(place(h)));
            }
        }
        found
    }

    /// The half-edges of the triangles between parts.
    fn between(&self) -> Vec<SortedHalfEdge> {
        let triangles = self.division.first_between() as u32..self.mesh.triangles.len() as u32;
        triangles.flat_map(|t| [(t, 0), (t, 1), (t, 2)]).map(|place| self.side(place)).collect()
    }

    fn side(&self, (triangle, corner): (u32, u32)) -> SortedHalfEdge {
        let corners = self.mesh.triangles[triangle as usize];
        let [from, to] = [corners[corner as usize], corners[(corner as usize + 1) % 3]];
        SortedHalfEdge { ends: [from.min(to), from.max(to)], triangle, corner }
    }

    /// True when an edge with two triangles is a line.
    fn is_seam(&self, sides: [(u32, u32); 2]) -> bool {
        if !self.mesh.texture.is_empty() {
            let [a, b] = sides.map(|(t, k)| {
                let points = self.mesh.texture[t as usize];
                [points[k as usize], points[(k as usize + 1) % 3]]
            });
            if a != [b[1], b[0]] {
                return true;
            }
        }
        if !self.groups.is_empty() {
            let [a, b] = sides.map(|(t, _)| self.groups[self.mesh.numbers[t as usize] as usize]);
            if a != b {
                return true;
            }
        }
        let limit = self.options.crease_cos_max;
        if limit < -1.0 {
            return false;
        }
        let [n, m] = sides.map(|(t, _)| {
            let [p, q, r] = self.mesh.triangles[t as usize].map(|v| self.position(v));
            (q - p).cross(r - p)
        });
        n.dot(m) <= limit * (n.length() * m.length())
    }

    fn position(&self, place: u32) -> DVec3 {
        self.mesh.vertices[self.division.order[place as usize] as usize].position
    }

    fn note(&mut self, seams: &[[(u32, u32); 2]], borders: &[(u32, u32)]) -> Result<(), Stopped> {
        for (i, &(t, corner)) in seams.as_flattened().iter().chain(borders).enumerate() {
            if i % CHECK_EVERY == 0 {
                self.budget.check()?;
            }
            self.mesh.lines[t as usize] |= 1 << corner;
        }
        let keep_borders = self.options.borders == Borders::Keep;
        let border_sides = borders.iter().map(|&place| (place, keep_borders));
        for (place, is_held) in seams.iter().map(|sides| (sides[0], false)).chain(border_sides) {
            for place in self.side(place).ends {
                let vertex = &mut self.mesh.vertices[self.division.order[place as usize] as usize];
                vertex.lines += 1;
                vertex.is_held |= is_held;
            }
        }
        Ok(())
    }
}
