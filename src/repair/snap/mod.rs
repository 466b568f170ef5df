//! Joins boundary edges whose ends are close to each other. At distance 0 no vertex moves.
//!
//! The snapping of Guéziec, Taubin, Lazarus and Horn, "Cutting and stitching" (2001): first edges of different
//! boundaries, then the rest; in each pass those that coincide, then by the distance of their ends. Every join is tested
//! when its turn comes, and what was refused is tried again after others. Of two joined vertices the one with the
//! smaller id keeps its place, so no new coordinates arise. Where the two sides of a crack have different vertices, edges are
//! divided first.

mod beside;
mod divide;
mod facing;
mod gap;

use self::beside::{Flank, JoinReach, flank_of};
use self::divide::{DivisionSummary, divide_beside, slits};
pub use self::gap::gap_between_rims;
use super::{Changes, Draft, Effects, Joins};
use crate::budget::{Budget, Stopped};
use crate::figures::figure;
use crate::geom::{Aabb, DVec3, are_collinear};
use crate::mesh::{self, Boundary, ChosenEdges, JoinRule, StitchValidity, Stitched, edge_of};
use crate::spatial::{Octree, is_within};
use rustc_hash::FxHashMap;

/// How to snap.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SnapOptions {
    /// Largest distance of two vertices that become one, in the unit of the file; never more than half the shortest
    /// boundary edge. `None`: 1e-5 of the diagonal.
    pub epsilon: Option<f64>,
    /// When two edges may be joined.
    pub validity: StitchValidity,
    /// Edges that stay apart.
    pub chosen: ChosenEdges,
    /// No part is turned to be joined.
    pub keeps_winding: bool,
    /// Of edges that do not coincide, only those are joined that lie side by side: with ends closer than an eighth of the
    /// shorter one, and triangles that do not lie back to back. Half the shortest boundary edge is no limit then. Edges are
    /// divided first where vertices of another boundary lie beside them.
    pub by_edge: bool,
}

/// Share of the diagonal that vertices may be apart when nothing is asked.
const EPSILON_SHARE: f64 = 1e-5;

/// Edges that each one is paired with at most; keeps the number of pairs linear in that of edges.
const PARTNERS_MAX: usize = 32;

/// Joins boundary edges wherever the mesh stays a manifold and no triangle turns over. The draft must be a manifold
/// (see [`cut`](super::cut::cut)). No vertex ends farther than epsilon from where it was. Parts that lie beside each other
/// but are wound the other way are turned first, unless windings are to be kept, so that the result does not depend on how
/// they were wound.
///
/// # Errors
/// When the budget stops the run.
pub fn snap(draft: &mut Draft, options: &SnapOptions, budget: &Budget) -> Result<Changes, Stopped> {
    let mut rim = ManifoldRim::of(draft, budget)?;
    let epsilon = match options.epsilon {
        Some(epsilon) if options.by_edge => epsilon,
        asked => epsilon(draft, &rim, asked),
    };
    let reach = JoinReach { epsilon, by_edge: options.by_edge };
    let mut divided = DivisionSummary::default();
    if options.by_edge && epsilon > 0.0 {
        divided = divide_beside(draft, &rim, epsilon, &options.chosen, budget)?;
        if divided.edges > 0 {
            rim = ManifoldRim::of(draft, budget)?;
        }
    }
    let flipped = match options.keeps_winding {
        true => 0,
        false => facing::turn_to_face(draft, &rim, reach, &options.chosen, budget)?,
    };
    if flipped > 0 {
        rim = ManifoldRim::of(draft, budget)?;
    }
    let [apart, same] = rim.pairs(draft, reach, &options.chosen, budget)?;
    let outlines = draft.outlines(budget)?;
    let _charge = budget.charge(draft.triangles.len() as u64 * 12)?;
    let before = draft.triangles.clone();
    let mut rule = Closeness::new(&draft.positions, epsilon);
    let mut done = Stitched::default();
    for pairs in [apart, same] {
        let (vertex_count, triangles) = (draft.positions.len(), &mut draft.triangles);
        let validity = options.validity;
        let stitched =
            mesh::stitch_faces(triangles, &outlines, vertex_count, &pairs, validity, &mut rule, budget)?;
        done.explicit.extend(stitched.explicit);
        done.implicit.extend(stitched.implicit);
    }
    let (moved, moved_by) = rule.moves();
    let stitches = Joins::of(draft, &before, &done);
    draft.drop_unused_vertices();
    let others = [("vertices_moved", moved), ("triangles_flipped", flipped)];
    let edges_divided = (divided.edges > 0).then_some(("edges_divided", divided.edges));
    let triangles_split = (divided.edges > 0).then_some(("triangles_split", divided.triangles));
    let mut counts = [stitches.counts(), others].concat();
    counts.extend(edges_divided.into_iter().chain(triangles_split));
    let move_max = moved_by.max(divided.move_max);
    let reason =
        if moved > 0 { format!("vertices up to {} apart are one", figure(epsilon)) } else { String::new() };
    let effects = Effects { turned_triangles: flipped, ..Effects::default() };
    Ok(Changes { counts, move_max, reason, stitches, effects, ..Changes::default() })
}

/// A half-edge and the third corner of its triangle.
fn flank(draft: &Draft, h: u32) -> Flank {
    flank_of(&draft.triangles, h).map(|v| draft.positions[v as usize])
}

fn epsilon(draft: &Draft, rim: &ManifoldRim, asked: Option<f64>) -> f64 {
    let diagonal = || Aabb::of(draft.positions.iter().copied()).diagonal();
    let wanted = asked.unwrap_or_else(|| EPSILON_SHARE * diagonal());
    let length = |&h: &u32| {
        let [a, b] = edge_of(&draft.triangles, h).map(|v| draft.positions[v as usize]);
        a.distance(b)
    };
    rim.half_edges.iter().map(length).filter(|&l| l > 0.0).fold(wanted, |least, l| least.min(l / 2.0))
}

/// The boundary half-edges of a manifold.
struct ManifoldRim {
    /// Ascending.
    half_edges: Vec<u32>,
    /// The loop of each.
    loop_of: Vec<u32>,
    /// The vertices they go to, each with the only half-edge that goes there; ascending.
    into: Vec<(u32, u32)>,
}

impl ManifoldRim {
    fn of(draft: &Draft, budget: &Budget) -> Result<Self, Stopped> {
        let groups = draft.edge_groups(budget)?;
        let boundary = Boundary::trace(&draft.triangles, draft.positions.len(), &groups, budget)?;
        drop(groups);
        let mut edges: Vec<(u32, u32)> = boundary
            .loops
            .iter()
            .zip(0..)
            .flat_map(|(half_edges, of)| half_edges.iter().map(move |&h| (h, of)))
            .collect();
        budget.spend(edges.len() as u64)?;
        edges.sort_unstable();
        let mut into: Vec<(u32, u32)> =
            edges.iter().map(|&(h, _)| (edge_of(&draft.triangles, h)[1], h)).collect();
        into.sort_unstable();
        let (half_edges, loop_of) = edges.into_iter().unzip();
        Ok(Self { half_edges, loop_of, into })
    }

    /// For each loop, whether it is all but without area for its length and `width`.
    fn slits(&self, draft: &Draft, width: f64) -> Vec<bool> {
        let mut by_loop: Vec<(u32, u32)> =
            self.loop_of.iter().copied().zip(self.half_edges.iter().copied()).collect();
        by_loop.sort_unstable();
        let loops = by_loop.chunk_by(|a, b| a.0 == b.0).map(|own| own.iter().map(|&(_, h)| h));
        slits(&draft.positions, &draft.triangles, loops, width)
    }

    fn into(&self, v: u32) -> Option<u32> {
        let i = self.into.binary_search_by_key(&v, |&(vertex, _)| vertex).ok()?;
        Some(self.into[i].1)
    }

    fn loop_of(&self, h: u32) -> Option<u32> {
        let i = self.half_edges.binary_search(&h).ok()?;
        Some(self.loop_of[i])
    }

    /// Pairs of half-edges in opposite directions with both ends within `reach`: those of different loops, and
    /// the others; each by the larger distance of their ends, then id.
    fn pairs(
        &self,
        draft: &Draft,
        reach: JoinReach,
        chosen: &ChosenEdges,
        budget: &Budget,
    ) -> Result<[Vec<(u32, u32)>; 2], Stopped> {
        let at = |v: u32| draft.positions[v as usize];
        let vertices = self.into.iter().map(|&(v, _)| v).collect();
        let octree = Octree::build(&draft.positions, vertices, budget)?;
        let mut found = [Vec::new(), Vec::new()];
        for &g in &self.half_edges {
            budget.spend(8)?;
            let [from, to] = edge_of(&draft.triangles, g);
            if chosen.contains([from, to].map(|v| draft.vertex_origin[v as usize])) {
                continue;
            }
            let mut partners = Vec::new();
            for end in octree.near(at(from), reach.of_edge([at(from), at(to)]), budget)? {
                let Some(h) = self.into(end).filter(|&h| h > g) else { continue };
                let begin = edge_of(&draft.triangles, h)[0];
                let may_join = || {
                    let [a, b, third] = flank(draft, h);
                    reach.may_join(flank(draft, g), [b, a, third])
                };
                if is_within(at(begin), at(to), reach.epsilon) && may_join() {
                    let apart = at(end).distance(at(from)).max(at(begin).distance(at(to)));
                    partners.push((apart, h));
                }
            }
            partners.sort_unstable_by(|(a, g), (b, h)| a.total_cmp(b).then(g.cmp(h)));
            partners.truncate(PARTNERS_MAX);
            for (apart, h) in partners {
                found[usize::from(self.loop_of(g) == self.loop_of(h))].push((apart, g, h));
            }
        }
        Ok(found.map(|mut pairs| {
            pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
            pairs.into_iter().map(|(_, g, h)| (g, h)).collect()
        }))
    }
}

/// Vertices join only as long as each stays within epsilon of where it was and no triangle turns over.
struct Closeness<'a> {
    positions: &'a [DVec3],
    epsilon: f64,
    /// The vertices that each one stands for besides itself, by the one that stays, sorted out as they come.
    members: FxHashMap<u32, Vec<u32>>,
}

impl<'a> Closeness<'a> {
    fn new(positions: &'a [DVec3], epsilon: f64) -> Self {
        Self { positions, epsilon, members: FxHashMap::default() }
    }

    fn at(&self, v: u32) -> DVec3 {
        self.positions[v as usize]
    }

    fn members_of(&self, v: u32) -> impl Iterator<Item = u32> {
        std::iter::once(v).chain(self.members.get(&v).into_iter().flatten().copied())
    }

    /// Number of vertices that are elsewhere now, and how far the farthest has moved.
    fn moves(&self) -> (u64, f64) {
        let all = self.members.iter().flat_map(|(&kept, gone)| gone.iter().map(move |&v| (kept, v)));
        let distances = all.map(|(kept, v)| self.at(kept).distance(self.at(v))).filter(|&d| d > 0.0);
        distances.fold((0, 0.0), |(count, farthest), d| (count + 1, f64::max(farthest, d)))
    }
}

impl JoinRule for Closeness<'_> {
    fn may_merge(&self, kept: u32, gone: u32) -> bool {
        self.members_of(gone).all(|v| is_within(self.at(kept), self.at(v), self.epsilon))
    }

    fn may_change(&self, before: [u32; 3], after: [u32; 3]) -> bool {
        let [was, is] = [before, after].map(|t| t.map(|v| self.at(v)));
        if was == is {
            return true;
        }
        let normal = |[a, b, c]: [DVec3; 3]| (b - a).normalize_or_zero().cross((c - a).normalize_or_zero());
        !are_collinear(is[0], is[1], is[2]) && normal(was).dot(normal(is)) > 0.0
    }

    fn merged(&mut self, kept: u32, gone: u32) {
        let mut moved = self.members.remove(&gone).unwrap_or_default();
        moved.push(gone);
        self.members.entry(kept).or_default().extend(moved);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two sheets side by side with a gap of this width between x = 1 and x = 1 + gap.
    fn sheets(gap: f64) -> Draft {
        let xs = [0.0, 1.0, 1.0 + gap, 2.0];
        let positions: Vec<DVec3> =
            xs.into_iter().flat_map(|x| [DVec3::new(x, 0.0, 0.0), DVec3::new(x, 1.0, 0.0)]).collect();
        Draft {
            vertex_origin: (0..8).collect(),
            positions,
            triangles: vec![[0, 2, 3], [0, 3, 1], [4, 6, 7], [4, 7, 5]],
            triangle_origin: (0..4).collect(),
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        }
    }

    fn snapped(mut draft: Draft, epsilon: Option<f64>) -> (Draft, Changes) {
        let options = SnapOptions { epsilon, ..SnapOptions::default() };
        let changes = snap(&mut draft, &options, &Budget::unlimited()).unwrap();
        assert!(draft.check().is_empty());
        (draft, changes)
    }

    #[test]
    fn a_gap_narrower_than_epsilon_closes_and_the_first_sheet_stays_where_it_is() {
        let (draft, changes) = snapped(sheets(0.01), Some(0.02));
        assert_eq!((changes.count("edges_joined"), changes.count("vertices_moved")), (1, 2));
        assert_eq!(changes.move_max, 0.010000000000000009);
        assert_eq!(draft.positions.len(), 6);
        assert_eq!(draft.triangles[2..], [[2, 4, 5], [2, 5, 3]]);
        assert_eq!(draft.positions[2], DVec3::X);
    }

    #[test]
    fn a_sheet_that_is_wound_the_other_way_is_turned_and_joined() {
        for gap in [0.0, 0.01] {
            let mut draft = sheets(gap);
            draft.flip(2);
            draft.flip(3);
            let (turned, changes) = snapped(draft, Some(0.02));
            let (same, _) = snapped(sheets(gap), Some(0.02));
            assert_eq!((changes.count("edges_joined"), changes.count("triangles_flipped")), (1, 2));
            assert_eq!(turned, same);
        }
    }

    #[test]
    fn the_smaller_sheet_turns() {
        let mut draft = sheets(0.01);
        draft.positions[6..].iter_mut().for_each(|p| p.x = 9.0);
        draft.flip(0);
        draft.flip(1);
        let (after, changes) = snapped(draft, Some(0.02));
        assert_eq!((changes.count("triangles_flipped"), after.triangles[0]), (2, [0, 2, 3]));
    }

    #[test]
    fn a_wider_gap_stays_open() {
        for epsilon in [Some(0.0), Some(0.005), None] {
            let (draft, changes) = snapped(sheets(0.01), epsilon);
            assert_eq!((changes.count("edges_joined"), draft), (0, sheets(0.01)), "{epsilon:?}");
        }
    }

    #[test]
    fn coincident_edges_are_joined_at_any_epsilon_and_nothing_moves() {
        for epsilon in [Some(0.0), None] {
            let (draft, changes) = snapped(sheets(0.0), epsilon);
            assert_eq!((changes.count("edges_joined"), changes.count("vertices_moved")), (1, 0));
            assert_eq!(draft.positions.len(), 6);
        }
    }

    #[test]
    fn epsilon_is_at_most_half_the_shortest_boundary_edge() {
        // The gap is wider than half of every edge, whatever is asked.
        let (_, changes) = snapped(sheets(0.6), Some(5.0));
        assert_eq!(changes.count("edges_joined"), 0);
    }

    #[test]
    fn a_chain_of_close_vertices_is_not_pulled_together_beyond_epsilon() {
        // Three sheets, each gap within epsilon, the outer ones not: the last keeps its place.
        let mut draft = sheets(0.01);
        draft.positions.extend([[1.02, 0.0], [1.02, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.5)));
        for p in &mut draft.positions[8..] {
            p.z = 0.0;
        }
        draft.positions.extend([[3.0, 0.0], [3.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0)));
        draft.vertex_origin = (0..12).collect();
        draft.triangles.extend([[8, 10, 11], [8, 11, 9]]);
        draft.triangle_origin = (0..6).collect();
        let (after, changes) = snapped(draft, Some(0.015));
        assert_eq!(changes.count("edges_joined"), 1);
        assert!(changes.move_max <= 0.015);
        assert!(after.positions.contains(&DVec3::new(1.02, 0.0, 0.0)));
    }

    #[test]
    fn a_join_that_would_turn_a_triangle_over_is_refused() {
        // A sliver beside the gap, thinner than the gap: its far vertex would end on the wrong side of the joined edge.
        let mut draft = sheets(0.01);
        draft.positions[6] = DVec3::new(1.005, 0.0, 0.0);
        draft.positions[7] = DVec3::new(1.005, 1.0, 0.0);
        draft.triangles[2..].copy_from_slice(&[[4, 7, 6], [4, 5, 7]]);
        let flipped = draft.triangles.clone();
        let (after, changes) = snapped(draft, Some(0.02));
        assert_eq!((changes.count("edges_joined"), after.triangles), (0, flipped));
    }
}
