//! Joins edges again that a cut has parted, by zipping each boundary from the places where it turns back on itself. No
//! vertex moves.
//!
//! The pinching of Guéziec, Taubin, Lazarus and Horn, "Cutting and stitching" (2001).

use super::{Changes, Draft, Joins};
use crate::budget::{Budget, Stopped};
use crate::mesh::{self, Boundary, ChosenEdges, EdgeGroups, JoinRule, StitchValidity, edge_of};

/// Joins boundary edges that were one edge of the file and follow each other along a boundary, then their neighbours on
/// both sides while these match too. Edges that the caller chose to cut stay cut. The draft must be a manifold (see
/// [`cut`](super::cut::cut)). Never joins parts, because a boundary belongs to one.
///
/// ```text
///      u   w                      u         u and w are copies of one vertex: the edges u-v and v-w are joined,
///       \ /          gives        |         then the edges before u and after w, if these ends are copies too
///        v                        v
/// ```
///
/// # Errors
/// When the budget stops the run.
pub fn pinch(
    draft: &mut Draft,
    chosen: &ChosenEdges,
    validity: StitchValidity,
    budget: &Budget,
) -> Result<Changes, Stopped> {
    let outlines = draft.outlines(budget)?;
    let groups = EdgeGroups::of_faces(&draft.triangles, &outlines, draft.positions.len(), budget)?;
    let boundary = Boundary::trace(&draft.triangles, draft.positions.len(), &groups, budget)?;
    let mut pairs = Vec::new();
    for half_edges in &boundary.loops {
        budget.spend(half_edges.len() as u64)?;
        zip(draft, chosen, half_edges, &mut pairs);
    }
    let mut rule = CopiesOnly { origin: &draft.vertex_origin };
    let vertex_count = draft.positions.len();
    let triangles = &mut draft.triangles;
    let stitched =
        mesh::stitch_faces(triangles, &outlines, vertex_count, &pairs, validity, &mut rule, budget)?;
    // Copies have one origin, so the edges have the ends that they had.
    let stitches = Joins::of(draft, &draft.triangles, &stitched);
    draft.drop_unused_vertices();
    Ok(Changes { counts: stitches.counts().to_vec(), stitches, ..Changes::default() })
}

/// Appends the pairs of a boundary loop that match, from each pivot outward. A half-edge and the one after it in the
/// loop run into and out of a common vertex, against the order of the loop.
fn zip(draft: &Draft, chosen: &ChosenEdges, half_edges: &[u32], pairs: &mut Vec<(u32, u32)>) {
    let origins = |h: u32| edge_of(&draft.triangles, h).map(|v| draft.vertex_origin[v as usize]);
    let matches = |g: u32, h: u32| {
        let ([a, b], other) = (origins(g), origins(h));
        other == [b, a] && !chosen.contains([a, b])
    };
    // What is left of the loop so far; a match takes its last one away, so that the one before meets the next.
    let mut left: Vec<u32> = Vec::new();
    for &h in half_edges {
        match left.last() {
            Some(&g) if matches(g, h) => {
                pairs.push((g, h));
                left.pop();
            }
            _ => left.push(h),
        }
    }
    // The loop closes: its end may match its beginning.
    let (mut first, mut last) = (0, left.len());
    while last - first >= 2 && matches(left[first], left[last - 1]) {
        pairs.push((left[first], left[last - 1]));
        (first, last) = (first + 1, last - 1);
    }
}

/// Only copies of one vertex become one.
struct CopiesOnly<'a> {
    origin: &'a [u32],
}

impl JoinRule for CopiesOnly<'_> {
    fn may_merge(&self, kept: u32, gone: u32) -> bool {
        self.origin[kept as usize] == self.origin[gone as usize]
    }

    fn may_change(&self, _before: [u32; 3], _after: [u32; 3]) -> bool {
        true
    }

    fn merged(&mut self, _kept: u32, _gone: u32) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::cut::{CutOptions, cut};

    /// Triangles on vertices that all have a place of their own.
    fn draft(triangles: &[[u32; 3]]) -> Draft {
        let count = triangles.as_flattened().iter().max().map_or(0, |max| max + 1);
        Draft {
            positions: (0..count).map(|v| crate::geom::DVec3::splat(f64::from(v))).collect(),
            vertex_origin: (0..count).collect(),
            triangles: triangles.to_vec(),
            triangle_origin: (0..triangles.len() as u32).collect(),
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        }
    }

    /// A grid of 3 by 3 quads over vertices 0 to 15.
    fn grid() -> Vec<[u32; 3]> {
        let quads = (0..9).map(|i| 4 * (i / 3) + i % 3);
        quads.flat_map(|v| [[v, v + 1, v + 5], [v, v + 5, v + 4]]).collect()
    }

    #[test]
    fn a_slit_of_three_edges_closes_from_its_end() {
        // A triangle stands on the edges 5-6, 6-10 inside a sheet, so that both are cut.
        let mut sheet = grid();
        sheet.extend([[5, 6, 16], [6, 10, 16]]);
        let mut mesh = draft(&sheet);
        let changes = cut(&mut mesh, &CutOptions::default(), &Budget::unlimited()).unwrap();
        assert_eq!(changes.count("singular_edges"), 2);
        assert_eq!(
            changes.count("vertices_copied"),
            4,
            "6 twice, 5 and 10 once for the triangles that stand"
        );
        let changes =
            pinch(&mut mesh, &ChosenEdges::default(), StitchValidity::Exact, &Budget::unlimited()).unwrap();
        assert_eq!(changes.count("edges_joined") + changes.count("edges_joined_with_others"), 2);
        assert_eq!(mesh.positions.len(), 17 + 3, "the sheet is whole; what stood on it has its own vertices");
    }

    #[test]
    fn a_chosen_edge_stays_cut() {
        let mut mesh = draft(&grid());
        let chosen = ChosenEdges::of([[5, 6], [6, 10]]);
        let options = CutOptions { chosen: chosen.clone(), ..CutOptions::default() };
        let changes = cut(&mut mesh, &options, &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("chosen_edges"), changes.count("vertices_copied")), (2, 1));
        let before = mesh.clone();
        pinch(&mut mesh, &chosen, StitchValidity::Exact, &Budget::unlimited()).unwrap();
        assert_eq!(mesh, before);
        pinch(&mut mesh, &ChosenEdges::default(), StitchValidity::Exact, &Budget::unlimited()).unwrap();
        assert_eq!(mesh, draft(&grid()));
    }
}
