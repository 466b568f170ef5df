//! Features of triangles that are near each other without meeting: vertices, edges and faces, lowest dimension first.
//!
//! Each vertex has a reach, at most half of its shortest edge, and two features are near when their distance is positive
//! and at most the smallest reach of all their vertices. So neighbours along an edge never are. A pair of features that
//! has a pair of smaller ones within reach is derived from that and not told; the closest points of what is told are
//! inside both features. Features with a common vertex are no pair.
//!
//! Distances are computed in f64 from differences of the coordinates, with a few units in the last place of these; whether
//! features meet is decided exactly.

mod descent;
mod directions;
mod features;

use super::Bvh;
use super::bvh::{Box32, Elements, Frame, Tree, stars_of, tree_with_stars};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use directions::NearDirections;
use features::SearchedFaces;

/// Which kinds of features are near each other. The closest points of triangles that do not meet are always of one of
/// the first four; an edge and a face, or two faces, are near only where two of their smaller features are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum NearKind {
    /// Two vertices.
    VertexVertex,
    /// A vertex and an edge.
    VertexEdge,
    /// A vertex and a face.
    VertexFace,
    /// Two edges.
    EdgeEdge,
    /// Two faces of which each vertex is near one of the other: told besides the three pairs of vertices.
    FaceFace,
}

/// Features that are near each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearPair {
    /// What they are.
    pub kind: NearKind,
    /// The first feature: its vertices first, then others of its face.
    pub a: [u32; 3],
    /// The second one; the one of more vertices comes last.
    pub b: [u32; 3],
    /// A face of each.
    pub faces: [u32; 2],
    /// Their distance, in the unit of the coordinates; of two faces the largest of their vertices'.
    pub distance: f64,
    /// The middle between their closest points.
    pub place: DVec3,
}

/// What a search found.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NearPairs {
    /// Number of pairs of each kind, in the order of [`NearKind`].
    pub counts: [u64; 5],
    /// The pairs, in an order that depends on the mesh alone; not all of them where there are very many.
    pub list: Vec<NearPair>,
}

/// What is searched.
#[derive(Debug, Clone, Copy)]
pub struct NearInput<'m> {
    /// Positions, all different and finite.
    pub positions: &'m [DVec3],
    /// Corners of the triangles.
    pub triangles: &'m [[u32; 3]],
    /// The triangles to look at, ascending; none of them degenerate, no two with the same vertices.
    pub ids: &'m [u32],
    /// How far the features of each vertex reach, in the unit of the coordinates; at most half of its shortest edge.
    pub reach: &'m [f64],
    /// For each triangle, which of its features it speaks for: bit `i` for corner `i`, bit `3 + i` for the edge from corner
    /// `i`. Each vertex and each edge is spoken for by one of the triangles.
    pub owned: &'m [u8],
}

/// Finds all features that are near each other, except a vertex and an edge of one triangle; `is_face` says whether three
/// vertices are those of one. `None` when so many boxes meet (`work_max` pairs of them) that the search is given up, as
/// around a vertex with many thousand triangles; that depends on the mesh alone.
///
/// # Errors
/// When the budget stops the run.
pub fn near_pairs(
    input: NearInput<'_>,
    is_face: impl Fn(u32, [u32; 2]) -> bool + Sync,
    work_max: u64,
    budget: &Budget,
) -> Result<Option<NearPairs>, Stopped> {
    let count = input.ids.len();
    let frame =
        Frame::around(count, |place| input.positions[input.triangles[input.ids[place] as usize][0] as usize]);
    let _charge = budget.charge(count as u64 * Bvh::BYTES_PER_TRIANGLE)?;
    let grown = Grown { input, frame };
    let stars = stars_of(input.positions.len(), &grown, budget)?;
    let (tree, _) = tree_with_stars(&stars, input.triangles.len(), input.positions, &grown, budget)?;
    let faces = SearchedFaces { input, is_face: &is_face, frame };
    let Some((mut all, mut work)) = descent::search(&tree, &faces, work_max, budget)? else {
        return Ok(None);
    };
    for star in &stars {
        let directions = Tree::build(&NearDirections { input, star }, budget)?;
        let Some((found, more)) = descent::search(&directions, &faces, work_max - work, budget)? else {
            return Ok(None);
        };
        work += more;
        all.add(found);
    }
    Ok(Some(all))
}

impl NearPairs {
    fn add(&mut self, more: Self) {
        for (sum, count) in self.counts.iter_mut().zip(more.counts) {
            *sum += count;
        }
        self.list.extend(more.list);
    }
}

impl NearInput<'_> {
    /// By how much the box of a triangle is grown, so that those of near features meet: somewhat more than half of its
    /// reach, for what is lost when it is added.
    fn growth(&self, corners: [u32; 3]) -> f64 {
        corners.map(|v| self.reach[v as usize]).into_iter().fold(0.0, f64::max) * 0.501
    }
}

/// Triangles with boxes grown by half of their reach, so that those of near features meet.
struct Grown<'m> {
    input: NearInput<'m>,
    frame: Frame,
}

impl Elements for Grown<'_> {
    fn len(&self) -> usize {
        self.input.ids.len()
    }

    fn id(&self, place: usize) -> u32 {
        self.input.ids[place]
    }

    fn bounds(&self, id: u32) -> Box32 {
        let corners = self.corners(id);
        let [a, b, c] = corners.map(|v| self.input.positions[v as usize]);
        let grown = DVec3::splat(self.input.growth(corners));
        let (low, high) = (a.min(b).min(c) - grown, a.max(b).max(c) + grown);
        self.frame.box_of([low.map(f64::next_down), high.map(f64::next_up)])
    }

    fn corners(&self, id: u32) -> [u32; 3] {
        self.input.triangles[id as usize]
    }
}
