//! Joins pairs of boundary edges where the mesh stays a manifold. No coordinates here: the caller offers the pairs.
//!
//! After Guéziec, Taubin, Lazarus and Horn, "Cutting and stitching" (2001), with an exact test in place of their
//! sufficient conditions: a pair is joined unless an edge would be degenerate, get a third triangle or two in one
//! direction, or two triangles would get the same vertices. Their conditions can be asked for in addition.

mod stars;

use self::stars::Stars;
use super::{edge_of, triangle_of};
use crate::budget::{Budget, Stopped};

/// When two boundary edges may be joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Validity {
    /// When the mesh is a manifold afterwards and no two triangles have the same vertices.
    #[default]
    Exact,
    /// When the published conditions hold as well. Two of them follow from the exact test: the stars of vertices that
    /// become one have no triangle in common, and no vertex is joined to both except by boundary edges that the same
    /// stitch makes one. The third does not: neither the beginning of one edge and the end of the other nor the other
    /// two ends may be candidates for becoming one vertex themselves. Their order of merging the two sides changes
    /// neither the mesh nor which edges become one.
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
    validity: Validity,
    rule: &mut dyn JoinRule,
    budget: &Budget,
) -> Result<Stitched, Stopped> {
    let _charge = budget.charge(vertex_count as u64 * 4 + pairs.len() as u64 * 16)?;
    let stars = Stars::of_ends(triangles, vertex_count, pairs);
    let mut seam = Seam { triangles, stars, validity, rule, done: Stitched::default() };
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
    stars: Stars,
    validity: Validity,
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
            && (self.validity == Validity::Exact || !self.are_crosswise_candidates([u, v], [u2, v2]));
        if !is_valid {
            return Ok(false);
        }
        debug_assert_ne!(triangle_of(g), triangle_of(h), "a triangle cannot be joined to itself");
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

    /// True when the edges could as well be joined the other way around, as far as their vertices go.
    fn are_crosswise_candidates(&self, [u, v]: [u32; 2], [u2, v2]: [u32; 2]) -> bool {
        let is_candidate = |a: u32, b: u32| a != b && self.rule.may_merge(a.min(b), a.max(b));
        is_candidate(u, v2) || is_candidate(v, u2)
    }

    /// True when the star of `kept` and `gone` together, renamed by `merges`, has no degenerate triangle, no edge used
    /// twice in one direction (which forbids a third triangle as well), no two triangles with the same vertices, and the
    /// caller's rule allows it.
    fn is_valid_after(&self, kept: u32, gone: u32, merges: [Merge; 2]) -> bool {
        let rename = |v: u32| merges.iter().fold(v, |v, &(kept, gone)| if v == gone { kept } else { v });
        let others: &[u32] = if kept == gone { &[] } else { self.stars.of(gone) };
        let mut links = Vec::with_capacity(self.stars.of(kept).len() + others.len());
        for &t in self.stars.of(kept).iter().chain(others) {
            let before = self.triangles[t as usize];
            let after = before.map(rename);
            let [a, b, c] = after;
            if a == b || b == c || c == a {
                return false;
            }
            if after != before && !self.rule.may_change(before, after) {
                return false;
            }
            links.push(if a == kept {
                [b, c]
            } else if b == kept {
                [c, a]
            } else {
                [a, b]
            });
        }
        (kept == gone || self.rule.may_merge(kept, gone))
            && is_unique(links.iter().map(|l| l[0]).collect())
            && is_unique(links.iter().map(|l| l[1]).collect())
            && is_unique(links.into_iter().map(|[a, b]| (a.min(b), a.max(b))).collect())
    }

    /// The boundary half-edges at the vertices of `merges`, ascending.
    fn open_at(&self, merges: [Merge; 2]) -> Vec<u32> {
        let mut vertices = merges.map(|(a, b)| [a, b]).concat();
        vertices.sort_unstable();
        vertices.dedup();
        let mut open: Vec<u32> =
            vertices.iter().flat_map(|&v| self.stars.boundary_at(self.triangles, v)).collect();
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

fn is_unique<T: Ord>(mut items: Vec<T>) -> bool {
    items.sort_unstable();
    items.windows(2).all(|pair| pair[0] != pair[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stitch_by(
        validity: Validity,
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
        let done = stitch_by(Validity::Exact, &mut triangles, vertex_count, pairs);
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
        let done = stitch_by(Validity::Exact, &mut mesh, 16, &[(from, to)]);
        let implicit = vec![(opposite.min(after), opposite.max(after))];
        assert_eq!(done, Stitched { explicit: vec![(from, to)], implicit });
        assert!(mesh.iter().flatten().all(|&v| v != 9), "it is 6 now");
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
    fn the_rule_of_the_caller_is_asked_and_by_the_paper_across_too() {
        for (pair, by_exact, by_paper) in [((1, 5), 1, 1), ((0, 4), 0, 0), ((0, 3), 1, 0)] {
            let joins = [Validity::Exact, Validity::Paper].map(|validity| {
                let mut mesh = vec![[0, 2, 1], [5, 3, 4]];
                let budget = Budget::unlimited();
                stitch(&mut mesh, 6, &[pair], validity, &mut OddSum, &budget).unwrap().explicit.len()
            });
            assert_eq!(joins, [by_exact, by_paper], "{pair:?}");
        }
    }
}
