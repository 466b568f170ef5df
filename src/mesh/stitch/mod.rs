//! Joins pairs of boundary edges where the mesh stays a manifold. No coordinates here: the caller offers the pairs.
//!
//! After Guéziec, Taubin, Lazarus and Horn, "Cutting and stitching" (2001), with an exact test in place of their
//! sufficient conditions: a pair is joined unless a face would be degenerate, an edge would get a third face or two in one
//! direction, or two faces would get the same outline. Their conditions can be asked for in addition.

mod stars;

use self::stars::PairStars;
use super::{Outlines, edge_of};
use crate::budget::{Budget, Stopped};

/// When two boundary edges may be joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum StitchValidity {
    /// When the mesh is a manifold afterwards and no two faces have the same outline.
    #[default]
    Exact,
    /// When the published conditions hold as well, for each pair of vertices that become one: no edge joins the two, their
    /// stars have no face in common, and no vertex is joined to both. The pairs take turns: first one whose merge makes
    /// two boundary edges one around a vertex that is joined to both, then the other, which folds around the merged one;
    /// where neither does, both at once. So each pair may have one vertex in common, around which it folds, and no other;
    /// the exact test takes any number. The first two conditions follow from the exact test.
    Paper,
}

/// What the caller demands of a join besides that the mesh stays a manifold.
pub trait JoinRule {
    /// Whether vertex `gone` may become `kept`.
    fn may_merge(&self, kept: u32, gone: u32) -> bool;

    /// Whether a triangle may change its vertices so.
    fn may_change(&self, before: [u32; 3], after: [u32; 3]) -> bool;

    /// `gone` has become `kept`.
    fn merged(&mut self, kept: u32, gone: u32);
}

/// Every join that leaves a manifold is welcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AnyJoin;

impl JoinRule for AnyJoin {
    fn may_merge(&self, _kept: u32, _gone: u32) -> bool {
        true
    }

    fn may_change(&self, _before: [u32; 3], _after: [u32; 3]) -> bool {
        true
    }

    fn merged(&mut self, _kept: u32, _gone: u32) {}
}

/// The boundary edges that [`stitch`] made one, as pairs of half-edges.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Stitched {
    /// Pairs that were joined because they were offered.
    pub explicit: Vec<(u32, u32)>,
    /// Pairs that became one edge because vertices of others were joined.
    pub implicit: Vec<(u32, u32)>,
}

/// Joins the offered `pairs` of half-edges, in their order, again and again until none can be joined any more.
/// `triangles` must be a manifold with boundary (see [`cut_singular`](super::cut_singular)) and stays one; the half-edges
/// must be of boundary edges, each pair running in opposite directions. Of two joined vertices the smaller id stays.
///
/// ```text
///     \   /                  \   /
///      u u'                    u
///      | |        gives        |        u u' and v v' are one vertex each, or two without a common edge
///      v v'                    v
///     /   \                  /   \
/// ```
///
/// # Errors
/// When the budget stops the run.
pub fn stitch(
    triangles: &mut [[u32; 3]],
    vertex_count: usize,
    pairs: &[(u32, u32)],
    validity: StitchValidity,
    rule: &mut dyn JoinRule,
    budget: &Budget,
) -> Result<Stitched, Stopped> {
    stitch_faces(triangles, &Outlines::default(), vertex_count, pairs, validity, rule, budget)
}

/// As [`stitch`], for the faces with these `outlines`. Triangles are parts of polygons then: these keep their corners apart,
/// and no two get the same outline.
///
/// # Errors
/// When the budget stops the run.
pub fn stitch_faces(
    triangles: &mut [[u32; 3]],
    outlines: &Outlines,
    vertex_count: usize,
    pairs: &[(u32, u32)],
    validity: StitchValidity,
    rule: &mut dyn JoinRule,
    budget: &Budget,
) -> Result<Stitched, Stopped> {
    let _charge = budget.charge(vertex_count as u64 * 4 + pairs.len() as u64 * 16)?;
    let stars = PairStars::of_ends(triangles, vertex_count, pairs);
    let mut seam = Seam { triangles, outlines, stars, validity, rule, done: Stitched::default() };
    let mut open = pairs.to_vec();
    loop {
        let mut left = Vec::with_capacity(open.len());
        for &(g, h) in &open {
            budget.spend(1)?;
            if !seam.is_one(g, h) && !seam.join(g, h, budget)? {
                left.push((g, h));
            }
        }
        if left.len() == open.len() || left.is_empty() {
            return Ok(seam.done);
        }
        open = left;
    }
}

/// Two vertices that are to become one, the smaller id first; equal ones at the pivot of a pinch.
type Merge = (u32, u32);

/// A mesh whose boundary edges are being joined.
struct Seam<'a> {
    triangles: &'a mut [[u32; 3]],
    outlines: &'a Outlines,
    stars: PairStars,
    validity: StitchValidity,
    rule: &'a mut dyn JoinRule,
    done: Stitched,
}

impl Seam<'_> {
    /// True when the two half-edges run along one edge.
    fn is_one(&self, g: u32, h: u32) -> bool {
        let [u, v] = edge_of(self.triangles, g);
        edge_of(self.triangles, h) == [v, u]
    }

    /// Joins the edges of `g` and `h` if that is valid.
    fn join(&mut self, g: u32, h: u32, budget: &Budget) -> Result<bool, Stopped> {
        let ([u, v], [v2, u2]) = (edge_of(self.triangles, g), edge_of(self.triangles, h));
        let merges = [(u.min(u2), u.max(u2)), (v.min(v2), v.max(v2))];
        let reach =
            merges.iter().map(|&(a, b)| self.stars.of(a).len() + self.stars.of(b).len()).sum::<usize>();
        budget.spend(reach as u64 / 8)?;
        let is_valid = merges.iter().all(|&(kept, gone)| self.is_valid_after(kept, gone, merges))
            && (self.validity == StitchValidity::Exact || self.take_turns(merges));
        if !is_valid {
            return Ok(false);
        }
        debug_assert_ne!(self.outlines.face(g), self.outlines.face(h), "a face cannot be joined to itself");
        let open = self.open_at(merges);
        for (kept, gone) in merges {
            if kept != gone {
                self.stars.merge(self.triangles, kept, gone);
                self.rule.merged(kept, gone);
            }
        }
        self.note_closed(open, (g, h));
        Ok(true)
    }

    /// True when both pairs of vertices can merge by the published conditions, which [`StitchValidity::Paper`] tells:
    /// the one that folds around a vertex of its own first, the other around the merged one.
    fn take_turns(&self, merges: [Merge; 2]) -> bool {
        let shared = merges.map(|(kept, gone)| match kept == gone {
            true => 0,
            false => self.common_neighbours(kept, gone),
        });
        let is_pinch = merges.iter().any(|&(kept, gone)| kept == gone);
        // A pinch folds around the pivot; otherwise one pair alone may have a vertex to fold around.
        if is_pinch { shared.iter().all(|&count| count <= 1) } else { shared[0] + shared[1] <= 1 }
    }

    /// Number of vertices that edges join to both.
    fn common_neighbours(&self, a: u32, b: u32) -> usize {
        let [of_a, of_b] = [a, b].map(|v| self.stars.neighbours(self.triangles, self.outlines, v));
        of_a.iter().filter(|v| of_b.binary_search(v).is_ok()).count()
    }

    /// True when the star of `kept` and `gone` together, renamed by `merges`, has no degenerate face, no edge used twice in
    /// one direction (which forbids a third face as well), no two faces with the same outline, and the caller's rule
    /// allows it.
    fn is_valid_after(&self, kept: u32, gone: u32, merges: [Merge; 2]) -> bool {
        let others: &[u32] = if kept == gone { &[] } else { self.stars.of(gone) };
        if kept != gone && (!self.rule.may_merge(kept, gone) || self.have_common_face(kept, gone)) {
            return false;
        }
        // Half-edges out of the merged vertex and into it, each with the other end.
        let (mut out, mut into) = (Vec::new(), Vec::new());
        for &t in self.stars.of(kept).iter().chain(others) {
            let before = self.triangles[t as usize];
            let after = before.map(|v| renamed(v, merges));
            let [a, b, c] = after;
            if a == b || b == c || c == a {
                return false;
            }
            if after != before && !self.rule.may_change(before, after) {
                return false;
            }
            let k = after.iter().position(|&v| v == kept).unwrap_or(0);
            let [leaving, entering] = [3 * t + k as u32, 3 * t + (k as u32 + 2) % 3];
            if !self.outlines.is_diagonal(leaving) {
                out.push((after[(k + 1) % 3], leaving));
            }
            if !self.outlines.is_diagonal(entering) {
                into.push((after[(k + 2) % 3], entering));
            }
        }
        has_unique_ends(&mut out) && has_unique_ends(&mut into) && !self.has_copies(&out, &into, merges)
    }

    /// True when a polygon has both vertices as corners; of triangles, those that get degenerate tell.
    fn have_common_face(&self, kept: u32, gone: u32) -> bool {
        if !self.outlines.has_polygons() {
            return false;
        }
        let [mut of_kept, of_gone] = [kept, gone].map(|v| {
            let faces = self.stars.of(v).iter().map(|&t| self.outlines.face(3 * t));
            faces.collect::<Vec<u32>>()
        });
        of_kept.sort_unstable();
        of_gone.iter().any(|face| of_kept.binary_search(face).is_ok())
    }

    /// True when two faces run through the same vertices in opposite directions, once `merges` are made. `out` and `into`
    /// are the half-edges out of a vertex and into it, by the other end, of which no two are the same.
    fn has_copies(&self, out: &[(u32, u32)], into: &[(u32, u32)], merges: [Merge; 2]) -> bool {
        let find = |ends: &[(u32, u32)], v: u32| {
            let i = ends.binary_search_by_key(&v, |&(end, _)| end).ok()?;
            Some(ends[i].1)
        };
        out.iter().any(|&(end, leaving)| {
            // The face beyond this edge, which must come from there and go on to where this face comes from.
            let Some(entering) = find(into, end) else { return false };
            let before = renamed(edge_of(self.triangles, self.outlines.previous(leaving))[0], merges);
            let beyond = renamed(edge_of(self.triangles, self.outlines.next(entering))[1], merges);
            before == beyond && self.are_opposite(leaving, entering, merges)
        })
    }

    /// True when the outline of `leaving` from there on and that of `entering` back from there are one. Both are walked in
    /// both directions at once, so that faces which share a chain of edges are told apart at its nearer end.
    fn are_opposite(&self, leaving: u32, entering: u32, merges: [Merge; 2]) -> bool {
        let end = |h: u32, k: usize| renamed(edge_of(self.triangles, h)[k], merges);
        let (mut ahead, mut ahead_back) = (leaving, entering);
        let (mut behind, mut behind_back) = (self.outlines.previous(leaving), self.outlines.next(entering));
        loop {
            if end(ahead, 1) != end(ahead_back, 0) || end(behind, 0) != end(behind_back, 1) {
                return false;
            }
            // The walks have met on one of the outlines: on both, or the outlines differ in length.
            let has_met = |a: u32, b: u32| a == b || self.outlines.next(a) == b;
            let met = [has_met(ahead, behind), has_met(behind_back, ahead_back)];
            if met[0] || met[1] {
                return met[0] && met[1];
            }
            (ahead, ahead_back) = (self.outlines.next(ahead), self.outlines.previous(ahead_back));
            (behind, behind_back) = (self.outlines.previous(behind), self.outlines.next(behind_back));
        }
    }

    /// The boundary half-edges at the vertices of `merges`, ascending.
    fn open_at(&self, merges: [Merge; 2]) -> Vec<u32> {
        let mut vertices = merges.map(|(a, b)| [a, b]).concat();
        vertices.sort_unstable();
        vertices.dedup();
        let mut open: Vec<u32> =
            vertices.iter().flat_map(|&v| self.stars.boundary_at(self.triangles, self.outlines, v)).collect();
        open.sort_unstable();
        open.dedup();
        open
    }

    /// Records which of the half-edges that were `open` are of one edge now. Only `offered` was joined on purpose.
    fn note_closed(&mut self, open: Vec<u32>, offered: (u32, u32)) {
        let mut by_ends: Vec<([u32; 2], u32)> = open
            .into_iter()
            .map(|h| {
                let [a, b] = edge_of(self.triangles, h);
                ([a.min(b), a.max(b)], h)
            })
            .collect();
        by_ends.sort_unstable();
        self.done.explicit.push(offered);
        for pair in by_ends.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            let closed = (pair[0].1, pair[1].1);
            if closed != (offered.0.min(offered.1), offered.0.max(offered.1)) {
                self.done.implicit.push(closed);
            }
        }
    }
}

/// The vertex that stands for `v` once `merges` are made.
fn renamed(v: u32, merges: [Merge; 2]) -> u32 {
    merges.iter().fold(v, |v, &(kept, gone)| if v == gone { kept } else { v })
}

/// Sorts half-edges by their ends; false when two have the same.
fn has_unique_ends(half_edges: &mut [(u32, u32)]) -> bool {
    half_edges.sort_unstable();
    half_edges.windows(2).all(|pair| pair[0].0 != pair[1].0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stitch_by(
        validity: StitchValidity,
        triangles: &mut [[u32; 3]],
        vertex_count: usize,
        pairs: &[(u32, u32)],
    ) -> Stitched {
        stitch(triangles, vertex_count, pairs, validity, &mut AnyJoin, &Budget::unlimited()).unwrap()
    }

    fn stitched(
        triangles: &[[u32; 3]],
        vertex_count: usize,
        pairs: &[(u32, u32)],
    ) -> (Vec<[u32; 3]>, Stitched) {
        let mut triangles = triangles.to_vec();
        let done = stitch_by(StitchValidity::Exact, &mut triangles, vertex_count, pairs);
        (triangles, done)
    }

    #[test]
    fn two_triangles_are_joined_along_an_edge() {
        let (triangles, done) = stitched(&[[0, 1, 2], [3, 4, 5]], 6, &[(0, 3)]);
        assert_eq!(triangles, [[0, 1, 2], [1, 0, 5]]);
        assert_eq!(done, Stitched { explicit: vec![(0, 3)], implicit: vec![] });
    }

    #[test]
    fn two_triangles_are_not_joined_into_a_double_face() {
        // All three edges are offered; after two of them, the triangles would have the same three vertices.
        let (triangles, done) = stitched(&[[0, 1, 2], [3, 4, 5]], 6, &[(0, 3), (1, 5), (2, 4)]);
        assert_eq!(triangles, [[0, 1, 2], [1, 0, 5]]);
        assert_eq!(done.explicit.len(), 1);
    }

    #[test]
    fn a_third_page_is_not_joined_to_a_book_of_two() {
        let (triangles, done) = stitched(&[[0, 1, 2], [4, 3, 5], [7, 6, 8]], 9, &[(0, 3), (0, 6)]);
        assert_eq!(triangles, [[0, 1, 2], [1, 0, 5], [7, 6, 8]]);
        assert_eq!(done, Stitched { explicit: vec![(0, 3)], implicit: vec![] });
    }

    #[test]
    fn the_last_gap_of_a_cone_closes_as_a_pinch() {
        // Four triangles around 0, cut open between 4 and 1: the edges 0-4 and 0-5 are one afterwards.
        let (triangles, done) = stitched(&[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]], 6, &[(0, 11)]);
        assert_eq!(triangles[3], [0, 4, 1]);
        assert_eq!(done.explicit.len(), 1);
    }

    /// A sheet of 3 by 3 quads over vertices 0 to 15 without the one in the middle, 5 6 10 9.
    fn frame() -> Vec<[u32; 3]> {
        let quads = (0..9).filter(|&i| i != 4).map(|i| 4 * (i / 3) + i % 3);
        quads.flat_map(|v| [[v, v + 1, v + 5], [v, v + 5, v + 4]]).collect()
    }

    fn half_edge(triangles: &[[u32; 3]], ends: [u32; 2]) -> u32 {
        (0..triangles.len() as u32 * 3).find(|&h| edge_of(triangles, h) == ends).unwrap()
    }

    #[test]
    fn edges_that_get_the_same_ends_by_a_stitch_of_others_are_recorded_as_implicit() {
        let mut mesh = frame();
        let [from, to, opposite, after] =
            [[6, 5], [5, 9], [9, 10], [10, 6]].map(|ends| half_edge(&mesh, ends));
        let done = stitch_by(StitchValidity::Exact, &mut mesh, 16, &[(from, to)]);
        let implicit = vec![(opposite.min(after), opposite.max(after))];
        assert_eq!(done, Stitched { explicit: vec![(from, to)], implicit });
        assert!(mesh.iter().flatten().all(|&v| v != 9), "it is 6 now");
    }

    #[test]
    fn by_the_paper_a_pair_folds_around_one_vertex_at_most() {
        let half_edges = |mesh: &[[u32; 3]], ends: &[[u32; 2]]| {
            ends.iter().map(|&e| half_edge(mesh, e)).collect::<Vec<_>>()
        };
        // The four rims of the frame: a pinch at 5 would make 6 and 9 one, which 10 is joined to as well.
        let mut mesh = frame();
        let rims = half_edges(&mesh, &[[6, 5], [5, 9]]);
        let done = stitch_by(StitchValidity::Paper, &mut mesh, 16, &[(rims[0], rims[1])]);
        assert_eq!((done, mesh), (Stitched::default(), frame()));
        // Six triangles around a hole of six edges, 0 to 5: of opposite edges both pairs of ends have a vertex to fold around.
        let ring: Vec<[u32; 3]> =
            (0..6).flat_map(|i| [[(i + 1) % 6, i, i + 6], [(i + 1) % 6, i + 6, (i + 1) % 6 + 6]]).collect();
        for (validity, joins) in [(StitchValidity::Exact, 1), (StitchValidity::Paper, 0)] {
            let mut mesh = ring.clone();
            let pair = half_edges(&mesh, &[[1, 0], [4, 3]]);
            let done = stitch_by(validity, &mut mesh, 12, &[(pair[0], pair[1])]);
            assert_eq!((done.explicit.len(), done.implicit.len()), (joins, 2 * joins), "{validity:?}");
        }
    }

    #[test]
    fn by_the_paper_one_end_may_fold_before_the_other() {
        // A slit of two edges, closed at 0: the ends in its middle have 0 in common, those at its mouth nothing.
        let mesh = [[0, 1, 2], [1, 3, 2], [0, 5, 4], [4, 5, 6], [0, 2, 5]];
        let mut joined = mesh.to_vec();
        let pair = (half_edge(&mesh, [1, 3]), half_edge(&mesh, [6, 4]));
        let done = stitch_by(StitchValidity::Paper, &mut joined, 7, &[pair]);
        assert_eq!((done.explicit, done.implicit.len()), (vec![pair], 1));
        assert_eq!(joined, [[0, 1, 2], [1, 3, 2], [0, 5, 1], [1, 5, 3], [0, 2, 5]]);
    }

    /// Vertices may become one when their ids add up to an odd number.
    struct OddSum;

    impl JoinRule for OddSum {
        fn may_merge(&self, kept: u32, gone: u32) -> bool {
            (kept + gone) % 2 == 1
        }

        fn may_change(&self, _before: [u32; 3], _after: [u32; 3]) -> bool {
            true
        }

        fn merged(&mut self, _kept: u32, _gone: u32) {}
    }

    #[test]
    fn the_rule_of_the_caller_is_asked() {
        for (pair, joins) in [((1, 5), 1), ((0, 4), 0), ((0, 3), 1)] {
            let mut mesh = vec![[0, 2, 1], [5, 3, 4]];
            let budget = Budget::unlimited();
            let done = stitch(&mut mesh, 6, &[pair], StitchValidity::Exact, &mut OddSum, &budget).unwrap();
            assert_eq!(done.explicit.len(), joins, "{pair:?}");
        }
    }

    /// Outlines of triangles of which the ranges are polygons.
    fn outlines(triangles: &[[u32; 3]], polygons: &[std::ops::Range<usize>]) -> Outlines {
        let runs = crate::mesh::PolygonRuns::of(triangles.len(), polygons.iter().cloned());
        Outlines::of(triangles, &runs, &Budget::unlimited()).unwrap()
    }

    fn stitch_polygons(
        triangles: &mut [[u32; 3]],
        polygons: &[std::ops::Range<usize>],
        vertex_count: usize,
        pairs: &[(u32, u32)],
    ) -> Stitched {
        let (outlines, budget) = (outlines(triangles, polygons), Budget::unlimited());
        let validity = StitchValidity::Exact;
        stitch_faces(triangles, &outlines, vertex_count, pairs, validity, &mut AnyJoin, &budget).unwrap()
    }

    #[test]
    fn corners_of_a_polygon_stay_apart_though_no_triangle_has_both() {
        // An octagon, split in zigzag: joining 0-1 with 4-5 would make 0 and 5 one, and 1 and 4.
        let mesh = [[0, 1, 7], [1, 2, 7], [2, 6, 7], [2, 3, 6], [3, 5, 6], [3, 4, 5]];
        let pair = (half_edge(&mesh, [0, 1]), half_edge(&mesh, [4, 5]));
        let whole = std::slice::from_ref(&(0..6));
        for polygons in [&[][..], whole] {
            let mut joined = mesh.to_vec();
            let done = stitch_polygons(&mut joined, polygons, 8, &[pair]);
            let as_polygons = !polygons.is_empty();
            assert_eq!(done.explicit.is_empty(), as_polygons, "{joined:?}");
        }
    }

    #[test]
    fn two_squares_are_joined_along_edges_but_not_into_a_double_face_and_diagonals_do_not_count() {
        // Split along diagonals that do not coincide.
        let mesh = [[0, 1, 2], [0, 2, 3], [5, 4, 7], [5, 7, 6]];
        let pairs: Vec<(u32, u32)> = [([0, 1], [5, 4]), ([1, 2], [6, 5]), ([2, 3], [7, 6]), ([3, 0], [4, 7])]
            .map(|(a, b)| (half_edge(&mesh, a), half_edge(&mesh, b)))
            .to_vec();
        let mut joined = mesh.to_vec();
        let done = stitch_polygons(&mut joined, &[0..2, 2..4], 8, &pairs);
        assert_eq!((done.explicit, done.implicit), (pairs[..2].to_vec(), vec![]));
        assert_eq!(joined, [[0, 1, 2], [0, 2, 3], [1, 0, 7], [1, 7, 2]]);
    }
}
