//! Which parts to turn so that their boundaries can be joined: two edges that lie on each other are joined only where
//! they run in opposite directions, and how a sheet is wound says nothing about where it belongs.

use super::beside::JoinReach;
use super::{ManifoldRim, flank};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{ChosenEdges, Components, ParityUnionFind, edge_of, triangle_of};
use crate::repair::Draft;
use crate::spatial::{Octree, is_within};

/// Partners that are looked at for each edge, in each direction.
const PARTNERS_MAX: usize = 32;

/// Turns whole parts (triangles connected by edges) so that boundary edges within `reach` of each other, each used once
/// and the closest first, run in opposite directions. Of parts that are related so, those with more area stay. Gives the
/// number of triangles that were turned. The draft must be a manifold, coherently oriented.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn turn_to_face(
    draft: &mut Draft,
    rim: &ManifoldRim,
    reach: JoinReach,
    chosen: &ChosenEdges,
    budget: &Budget,
) -> Result<u64, Stopped> {
    if rim.half_edges.is_empty() {
        return Ok(0);
    }
    let parts = draft.edge_groups(budget)?.components(budget)?;
    if parts.count < 2 {
        return Ok(0);
    }
    let meetings = meetings(draft, rim, &parts, reach, chosen, budget)?;
    if meetings.iter().all(|meeting| !meeting.run_alike) {
        return Ok(0);
    }
    let mut sides = ParityUnionFind::new(parts.count as usize);
    let mut is_used = vec![false; rim.half_edges.len()];
    for (i, FacingEdges { edges: [g, h], run_alike, .. }) in meetings.into_iter().enumerate() {
        if i % CHECK_EVERY == 0 {
            budget.check()?;
        }
        if is_used[g] || is_used[h] {
            continue;
        }
        let [a, b] = [g, h].map(|i| parts.of[triangle_of(rim.half_edges[i]) as usize]);
        if sides.relate(a, b, run_alike) {
            is_used[g] = true;
            is_used[h] = true;
        }
    }
    draft.turn_smaller(&parts, &mut sides, budget)
}

/// Two boundary edges of different parts that lie within epsilon of each other.
struct FacingEdges {
    /// The larger distance of their ends.
    apart: f64,
    /// Places in the rim, the smaller first.
    edges: [usize; 2],
    /// They run in the same direction, so that one of the parts has to turn.
    run_alike: bool,
}

/// The meetings by distance; of those at one distance, where several edges lie on each other, first those for which nothing has to
/// turn, then by triangle.
fn meetings(
    draft: &Draft,
    rim: &ManifoldRim,
    parts: &Components,
    reach: JoinReach,
    chosen: &ChosenEdges,
    budget: &Budget,
) -> Result<Vec<FacingEdges>, Stopped> {
    let at = |v: u32| draft.positions[v as usize];
    let part = |h: u32| parts.of[triangle_of(h) as usize];
    let mut out_of: Vec<(u32, usize)> =
        rim.half_edges.iter().enumerate().map(|(i, &h)| (edge_of(&draft.triangles, h)[0], i)).collect();
    out_of.sort_unstable();
    let vertices = out_of.iter().map(|&(v, _)| v).collect();
    let octree = Octree::build(&draft.positions, vertices, budget)?;
    let leaving = |v: u32| {
        let i = out_of.binary_search_by_key(&v, |&(vertex, _)| vertex).ok()?;
        Some(out_of[i].1)
    };
    let mut found = Vec::new();
    for (i, &g) in rim.half_edges.iter().enumerate() {
        budget.spend(1)?;
        let [from, to] = edge_of(&draft.triangles, g);
        if chosen.contains([from, to].map(|v| draft.vertex_origin[v as usize])) {
            continue;
        }
        let mut partners = Vec::new();
        for end in octree.near(at(from), reach.of_edge([at(from), at(to)]), budget)? {
            let alike = leaving(end).map(|j| (j, edge_of(&draft.triangles, rim.half_edges[j])[1], true));
            let against = rim.into(end).and_then(|h| {
                let j = rim.half_edges.binary_search(&h).ok()?;
                Some((j, edge_of(&draft.triangles, h)[0], false))
            });
            for (j, other, run_alike) in alike.into_iter().chain(against) {
                let may_join = || {
                    let [a, b, third] = flank(draft, rim.half_edges[j]);
                    reach.may_join(flank(draft, g), if run_alike { [a, b, third] } else { [b, a, third] })
                };
                let is_elsewhere = j > i && part(rim.half_edges[j]) != part(g);
                if is_elsewhere && is_within(at(other), at(to), reach.epsilon) && may_join() {
                    let apart = at(end).distance(at(from)).max(at(other).distance(at(to)));
                    partners.push(FacingEdges { apart, edges: [i, j], run_alike });
                }
            }
        }
        partners.sort_unstable_by(|a, b| {
            a.apart.total_cmp(&b.apart).then(a.run_alike.cmp(&b.run_alike)).then(a.edges.cmp(&b.edges))
        });
        partners.truncate(PARTNERS_MAX);
        found.append(&mut partners);
    }
    let triangles = |meeting: &FacingEdges| meeting.edges.map(|i| triangle_of(rim.half_edges[i]));
    found.sort_by(|a, b| {
        let by_place = a.apart.total_cmp(&b.apart).then(a.run_alike.cmp(&b.run_alike));
        by_place.then(triangles(a).cmp(&triangles(b))).then(a.edges.cmp(&b.edges))
    });
    Ok(found)
}
