//! Which of the proposed patches may stay: those that add no defect of their own and meet nothing.

use super::report::Rejection;
use super::surface::FillSurface;
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3, are_collinear};
use crate::mesh::next_corner;
use crate::par;
use crate::spatial::{self, Bvh, Search, TriangleContact};
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::atomic::{AtomicBool, Ordering};

/// Contacts to look at in one round; patches that have none among them but come later are put off.
const CONTACTS_MAX: usize = 1 << 20;
/// A patch with more triangles is searched alone first, up to its first contact: one that is crumpled may have pairs of
/// triangles in proportion to the square of their number.
const ALONE_FROM: usize = 64;
/// The mesh is not sorted for the search of what is near to patches when these have less than one in so many triangles.
const FEW_SHARE: usize = 4;
/// Triangles of the mesh that are looked at between two checks of the budget.
const TRIANGLES: usize = 2048;

/// A patch for one hole.
#[derive(Debug, Clone)]
pub(super) struct PatchProposal {
    /// The boundary half-edges whose corners are its rim.
    pub(super) rim: Vec<u32>,
    /// Where the loops of the rim begin.
    pub(super) loop_starts: Vec<usize>,
    /// Positions of its new vertices.
    pub(super) points: Vec<DVec3>,
    /// Below the number of corners of the rim: that corner; from there on: one of `points`.
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Proposals that are judged one after the other by one thread.
const PROPOSALS: usize = 16;

/// The triangles of proposals by vertices of the surface, and what is wrong with each.
struct JudgedProposals {
    triangles: Vec<Vec<[u32; 3]>>,
    verdicts: Vec<Acceptance>,
}

/// Why a proposal does not stay, and near where it meets something.
pub(super) type Refused = (Rejection, Option<DVec3>);

type Acceptance = Result<(), Refused>;

impl FillSurface {
    /// Accepts the proposals that are sound, and says of the others why they are not. For a sound one it gives the first
    /// of its new vertices in the surface.
    ///
    /// Sound is: exactly the rim as boundary, in its direction, connected, one fan at each corner and new vertex, and as
    /// many triangles as a sphere with the loops cut out has; no degenerate triangle; no edge in use already, by the mesh,
    /// by another patch, an earlier proposal or itself; no triangle on the vertices of another one; no new vertex in the place of
    /// another; and exactly no contact with the mesh, with other patches or in itself. `bvh`: that of the mesh, if there is one.
    pub(super) fn accept(
        &mut self,
        proposals: &[&PatchProposal],
        bvh: Option<&Bvh>,
        budget: &Budget,
    ) -> Result<Vec<Result<u32, Refused>>, Stopped> {
        let mut triangles = Vec::with_capacity(proposals.len());
        let mut firsts = Vec::with_capacity(proposals.len());
        for proposal in proposals {
            budget.spend(proposal.triangles.len() as u64 + 1)?;
            let first = self.positions.len() as u32;
            firsts.push(first);
            let rim = proposal.rim.len() as u32;
            let vertex =
                |v: u32| if v < rim { self.corner(proposal.rim[v as usize]) } else { first + v - rim };
            let patch: Vec<[u32; 3]> = proposal.triangles.iter().map(|t| t.map(vertex)).collect();
            self.positions.extend(&proposal.points);
            triangles.push(patch);
        }
        let verdicts = self.judge_each(proposals, &triangles, budget)?;
        let mut judged = JudgedProposals { triangles, verdicts };
        self.reject_contacts(&mut judged, &firsts, bvh, budget)?;
        let JudgedProposals { triangles, verdicts } = judged;
        for ((patch, verdict), proposal) in triangles.into_iter().zip(&verdicts).zip(proposals) {
            if verdict.is_ok() {
                self.diagonals.extend(self.diagonals_of(proposal));
                self.patches.extend(patch);
            }
        }
        Ok(verdicts.into_iter().zip(firsts).map(|(verdict, first)| verdict.map(|()| first)).collect())
    }

    /// Judges the `patches` of proposals but for contacts with anything else.
    fn judge_each(
        &self,
        proposals: &[&PatchProposal],
        patches: &[Vec<[u32; 3]>],
        budget: &Budget,
    ) -> Result<Vec<Acceptance>, Stopped> {
        let shapes = par::try_map_ranges(proposals.len(), PROPOSALS, |range| {
            budget.check()?;
            Ok(range.map(|i| self.judge_shape(proposals[i], &patches[i])).collect::<Vec<_>>())
        })?;
        let mut claimed = FxHashSet::default();
        let mut verdicts = Vec::with_capacity(proposals.len());
        for diagonals in shapes.into_iter().flatten() {
            let is_claimed = |edge: &[u32; 2]| claimed.contains(edge);
            verdicts.push(match diagonals {
                Ok(diagonals) if diagonals.iter().any(is_claimed) => Err((Rejection::EdgeInUse, None)),
                Ok(diagonals) => {
                    claimed.extend(diagonals);
                    Ok(())
                }
                Err(reason) => Err((reason, None)),
            });
        }
        let alone = par::try_map_ranges(proposals.len(), 1, |range| match verdicts[range.start] {
            Ok(()) if patches[range.start].len() >= ALONE_FROM => self.alone(&patches[range.start], budget),
            verdict => Ok(verdict),
        })?;
        Ok(alone)
    }

    /// Judges a patch but for contacts and other patches; gives its diagonals.
    fn judge_shape(&self, proposal: &PatchProposal, patch: &[[u32; 3]]) -> Result<Vec<[u32; 2]>, Rejection> {
        let is_degenerate = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| self.positions[v as usize]);
            are_collinear(a, b, c)
        };
        check_topology(proposal)?;
        if patch.iter().any(is_degenerate) {
            return Err(Rejection::DegenerateTriangle);
        }
        let mut diagonals = self.diagonals_of(proposal);
        diagonals.sort_unstable();
        let is_twice = diagonals.windows(2).any(|pair| pair[0] == pair[1]);
        let is_used = |edge: &[u32; 2]| !self.is_free_edge(*edge);
        if self.is_double_of_neighbour(proposal)
            || is_twice
            || diagonals.iter().any(is_used)
            || self.has_edge_twice(proposal, patch)
        {
            return Err(Rejection::EdgeInUse);
        }
        Ok(diagonals)
    }

    /// True when a patch, whose rim passes a vertex several times, reaches another vertex from two of these corners.
    fn has_edge_twice(&self, proposal: &PatchProposal, patch: &[[u32; 3]]) -> bool {
        let mut corners: Vec<u32> = proposal.rim.iter().map(|&h| self.corner(h)).collect();
        corners.sort_unstable();
        if corners.windows(2).all(|pair| pair[0] != pair[1]) {
            return false;
        }
        // The edges of the surface, each with that of the proposal which it is.
        let mut edges: Vec<[[u32; 2]; 2]> = Vec::with_capacity(3 * patch.len());
        for (own, t) in proposal.triangles.iter().zip(patch) {
            for c in 0..3 {
                let ends = |t: &[u32; 3]| [t[c].min(t[(c + 1) % 3]), t[c].max(t[(c + 1) % 3])];
                edges.push([ends(t), ends(own)]);
            }
        }
        edges.sort_unstable();
        edges.windows(2).any(|pair| pair[0][0] == pair[1][0] && pair[0][1] != pair[1][1])
    }

    /// The edges inside a patch that are between corners of its rim, by vertices of the surface.
    fn diagonals_of(&self, proposal: &PatchProposal) -> Vec<[u32; 2]> {
        let rim = proposal.rim.len() as u32;
        let is_side = |a: u32, b: u32| proposal.next(a) == b || proposal.next(b) == a;
        let mut edges = Vec::new();
        for t in &proposal.triangles {
            for c in 0..3 {
                let [a, b] = [t[c], t[(c + 1) % 3]];
                if a < b && b < rim && !is_side(a, b) {
                    edges.push([a, b]);
                }
            }
        }
        let vertex = |v: u32| self.corner(proposal.rim[v as usize]);
        edges.into_iter().map(|[a, b]| [vertex(a), vertex(b)]).map(|[a, b]| [a.min(b), a.max(b)]).collect()
    }

    /// True for a single triangle that has the vertices of the one beyond its rim. A patch of several triangles has a new
    /// edge in each of them, so none can be the double of another triangle.
    fn is_double_of_neighbour(&self, proposal: &PatchProposal) -> bool {
        if proposal.triangles.len() != 1 {
            return false;
        }
        // Half-edge `g` goes to the corner at `g`; the third vertex of its triangle is where the next half-edge goes to.
        let beyond = self.corner(next_corner(proposal.rim[0]));
        proposal.rim.iter().any(|&h| self.corner(h) == beyond)
    }

    /// Looks for a contact of a patch in itself, and for new vertices of it in one place.
    fn alone(&self, patch: &[[u32; 3]], budget: &Budget) -> Result<Acceptance, Stopped> {
        // Numbered by themselves, so that the work does not depend on how large the mesh is.
        let mut own = patch.as_flattened().to_vec();
        own.sort_unstable();
        own.dedup();
        let points: Vec<DVec3> = own.iter().map(|&v| self.positions[v as usize]).collect();
        let number = |v: u32| own.partition_point(|&other| other < v) as u32;
        let patch: Vec<[u32; 3]> = patch.iter().map(|t| t.map(number)).collect();
        let bvh = Bvh::build(&points, &patch, None, budget)?;
        let found = spatial::self_contacts(&points, &patch, &bvh, None, Search::First, budget)?;
        let place = |contact: &TriangleContact| {
            between([contact.a, contact.b].map(|t| patch[t as usize].map(|v| points[v as usize])))
        };
        Ok(if found.count > 0 {
            Err((Rejection::MeetsItself, found.list.first().map(place)))
        } else {
            Ok(())
        })
    }

    /// Rejects proposals that meet the mesh, an accepted patch, themselves, or an earlier proposal that stays.
    fn reject_contacts(
        &mut self,
        judged: &mut JudgedProposals,
        firsts: &[u32],
        bvh: Option<&Bvh>,
        budget: &Budget,
    ) -> Result<(), Stopped> {
        // Triangles of proposals come first, so that contacts, which are sorted, begin with theirs.
        let mut owner = Vec::new();
        let mut triangles = Vec::new();
        for (i, patch) in judged.triangles.iter().enumerate().filter(|&(i, _)| judged.verdicts[i].is_ok()) {
            owner.extend(std::iter::repeat_n(i, patch.len()));
            triangles.extend(patch);
        }
        if triangles.is_empty() {
            return Ok(());
        }
        let near = self.triangles_near(&triangles, bvh, budget)?;
        triangles.extend(near);
        triangles.extend(&self.patches);
        self.reject_shared_places(&triangles, firsts, &mut judged.verdicts, budget)?;
        let bvh = Bvh::build(&self.positions, &triangles, None, budget)?;
        let search = Search::All { keep: CONTACTS_MAX };
        let contacts = spatial::self_contacts(&self.positions, &triangles, &bvh, None, search, budget)?;
        let corners = |t: u32| triangles[t as usize].map(|v| self.positions[v as usize]);
        let mut pairs = Vec::new();
        let reject = |verdict: &mut Acceptance, reason: Rejection, at: Option<DVec3>| {
            if verdict.is_ok() {
                *verdict = Err((reason, at));
            }
        };
        for contact in &contacts.list {
            let Some(&a) = owner.get(contact.a as usize) else { break };
            let at = Some(between([contact.a, contact.b].map(corners)));
            match owner.get(contact.b as usize) {
                Some(&b) if a != b => {
                    let pair = (a.max(b), a.min(b));
                    if pairs.last().is_none_or(|&(last, _)| last != pair) {
                        pairs.push((pair, at));
                    }
                }
                Some(_) => reject(&mut judged.verdicts[a], Rejection::MeetsItself, at),
                None => reject(&mut judged.verdicts[a], Rejection::MeetsOther, at),
            }
        }
        pairs.sort_by_key(|&(pair, _)| pair);
        for ((later, earlier), at) in pairs {
            if judged.verdicts[earlier].is_ok() {
                reject(&mut judged.verdicts[later], Rejection::MeetsOther, at);
            }
        }
        if contacts.count > contacts.list.len() as u64 {
            let last = contacts.list.last().and_then(|contact| owner.get(contact.a as usize));
            let from = last.map_or(judged.verdicts.len(), |&last| last);
            for verdict in &mut judged.verdicts[from..] {
                reject(verdict, Rejection::MeetsOther, None);
            }
        }
        Ok(())
    }

    /// Rejects proposals with a new vertex where another vertex of `triangles` is.
    fn reject_shared_places(
        &self,
        triangles: &[[u32; 3]],
        firsts: &[u32],
        verdicts: &mut [Acceptance],
        budget: &Budget,
    ) -> Result<(), Stopped> {
        let Some(&first) = firsts.first() else { return Ok(()) };
        if first as usize == self.positions.len() {
            return Ok(());
        }
        budget.spend(triangles.len() as u64)?;
        let mut used = triangles.as_flattened().to_vec();
        used.sort_unstable();
        used.dedup();
        // Zeros of both signs are one place.
        let place = |v: u32| self.positions[v as usize].to_array().map(|x| (x + 0.0).to_bits());
        let mut seen: FxHashMap<[u64; 3], u32> = FxHashMap::default();
        for v in used {
            if seen.insert(place(v), v).is_some() && v >= first {
                let owner = firsts.partition_point(|&first| first <= v) - 1;
                let at = self.positions[v as usize];
                verdicts[owner] = verdicts[owner].and(Err((Rejection::MeetsOther, Some(at))));
            }
        }
        Ok(())
    }

    /// The triangles of the mesh, which may be sorted in `bvh` already, whose boxes may meet those of `patches`.
    fn triangles_near(
        &mut self,
        patches: &[[u32; 3]],
        bvh: Option<&Bvh>,
        budget: &Budget,
    ) -> Result<Vec<[u32; 3]>, Stopped> {
        let is_sorted = bvh.is_some() || self.bvh.is_some();
        if !is_sorted && patches.len() < self.triangles.len() / FEW_SHARE {
            return self.triangles_in_boxes(patches, budget);
        }
        if !is_sorted {
            self.bvh = Some(Bvh::build(&self.positions, &self.triangles, None, budget)?);
        }
        let Some(bvh) = bvh.or(self.bvh.as_ref()) else { return Ok(Vec::new()) };
        let is_near: Vec<AtomicBool> = self.triangles.iter().map(|_| AtomicBool::new(false)).collect();
        par::try_map_ranges(patches.len(), TRIANGLES, |range| {
            budget.spend(range.len() as u64)?;
            for t in &patches[range] {
                let bounds = Aabb::of(t.map(|v| self.positions[v as usize]));
                bvh.visit_box(bounds, budget, |id| is_near[id as usize].store(true, Ordering::Relaxed))?;
            }
            Ok(())
        })?;
        let near = self.triangles.iter().zip(is_near);
        Ok(near.filter_map(|(&t, is_near)| is_near.into_inner().then_some(t)).collect())
    }

    /// As [`Self::triangles_near`] where there are few triangles in `patches`: they are sorted, and the mesh is gone through.
    fn triangles_in_boxes(&self, patches: &[[u32; 3]], budget: &Budget) -> Result<Vec<[u32; 3]>, Stopped> {
        let bvh = Bvh::build(&self.positions, patches, None, budget)?;
        let of = |range: std::ops::Range<usize>| -> Result<Vec<[u32; 3]>, Stopped> {
            budget.spend(range.len() as u64 / 16)?;
            let mut near = Vec::new();
            for &t in &self.triangles[range] {
                if bvh.any_in_box(Aabb::of(t.map(|v| self.positions[v as usize])), budget, |_| true)? {
                    near.push(t);
                }
            }
            Ok(near)
        };
        Ok(par::try_map_ranges(self.triangles.len(), TRIANGLES, of)?.concat())
    }
}

/// The middle of what the boxes of two triangles have in common.
fn between(triangles: [[DVec3; 3]; 2]) -> DVec3 {
    let [a, b] = triangles.map(Aabb::of);
    (a.min.max(b.min) + a.max.min(b.max)) / 2.0
}

impl PatchProposal {
    /// The corner of the rim after `corner` in its loop.
    fn next(&self, corner: u32) -> u32 {
        let i = self.loop_starts.partition_point(|&start| start <= corner as usize);
        let end = self.loop_starts.get(i).copied().unwrap_or(self.rim.len());
        if corner as usize + 1 == end { self.loop_starts[i - 1] as u32 } else { corner + 1 }
    }
}

/// Euler: a sphere without so many disks, with n corners at their rims and m other vertices, has n + 2 m + 2 h - 4
/// triangles.
pub(super) fn check_topology(proposal: &PatchProposal) -> Result<(), Rejection> {
    let (rim, inner, loops) = (proposal.rim.len(), proposal.points.len(), proposal.loop_starts.len());
    if proposal.triangles.len() + 4 != rim + 2 * inner + 2 * loops {
        return Err(Rejection::Topology);
    }
    // Each directed edge once; what has no opposite is exactly the rim, in its direction.
    let mut edges = Vec::with_capacity(3 * proposal.triangles.len());
    for &[a, b, c] in &proposal.triangles {
        edges.extend([[a, b], [b, c], [c, a]]);
    }
    edges.sort_unstable();
    if edges.windows(2).any(|pair| pair[0] == pair[1]) {
        return Err(Rejection::Topology);
    }
    let has = |edge: [u32; 2]| edges.binary_search(&edge).is_ok();
    let open = edges.iter().filter(|&&[a, b]| !has([b, a])).count();
    let is_rim = (0..rim as u32).all(|v| has([v, proposal.next(v)]) && !has([proposal.next(v), v]));
    let is_fans = one_fan_each(&proposal.triangles, rim + inner);
    if open != rim || !is_rim || !is_fans || !is_connected(&proposal.triangles, rim + inner) {
        return Err(Rejection::Topology);
    }
    Ok(())
}

/// True when the triangles at each vertex are one fan: every vertex is used, and joining its triangles over its edges
/// leaves one part.
fn one_fan_each(triangles: &[[u32; 3]], vertices: usize) -> bool {
    // Of a fan around `v`, each triangle gives the step from one neighbour to the next. A chain or ring of k steps is
    // connected exactly when walking it takes k steps.
    let mut steps: Vec<[u32; 3]> =
        triangles.iter().flat_map(|&[a, b, c]| [[a, b, c], [b, c, a], [c, a, b]]).collect();
    steps.sort_unstable();
    let mut ends: Vec<[u32; 2]> = steps.iter().map(|&[v, _, to]| [v, to]).collect();
    ends.sort_unstable();
    let fans: Vec<&[[u32; 3]]> = steps.chunk_by(|s, t| s[0] == t[0]).collect();
    fans.len() == vertices
        && fans.into_iter().all(|fan| {
            let at = |from: u32| fan.binary_search_by_key(&from, |step| step[1]).ok();
            // A chain begins where no step ends; a ring begins anywhere.
            let begins = |step: &&[u32; 3]| ends.binary_search(&[step[0], step[1]]).is_err();
            let start = fan.iter().find(begins).unwrap_or(&fan[0]);
            let (mut walked, mut next) = (1, start[2]);
            while let Some(step) = at(next)
                && fan[step][1] != start[1]
                && walked < fan.len()
            {
                (walked, next) = (walked + 1, fan[step][2]);
            }
            walked == fan.len()
        })
}

fn is_connected(triangles: &[[u32; 3]], vertices: usize) -> bool {
    let mut parts = crate::mesh::UnionFind::new(vertices);
    for &[a, b, c] in triangles {
        parts.unite(a, b);
        parts.unite(b, c);
    }
    let root = parts.find(triangles[0][0]);
    (0..vertices as u32).all(|v| parts.find(v) == root)
}
