//! Takes moves back until no two triangles meet, exactly.

use super::super::lattice::Lattice;
use super::normals::Stars;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3, Shared, ThreePointPlane, are_collinear, contact};
use crate::par;
use crate::spatial::{self, Bvh, Search, Terrains, coincident_f64};

/// How far a vertex goes back each time that what it belongs to meets something, as shares of its move: what all but passes is
/// about as near to the input as if it had not gone back.
const SHARES_BACK: [f64; 4] = [1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0];

/// Rounds in which only the vertices of what meets go back.
const ROUNDS_NEAR: usize = 8;

/// Rounds before everything goes back.
const ROUNDS: usize = 20;

/// Times that half of the vertices that went back try again to come nearer to where they belong.
const ATTEMPTS: u32 = 8;

/// Contacts to take back in a round.
const CONTACTS: usize = 1 << 20;

/// Moves of a surface that has no contacts before them.
pub(super) struct Moves<'m> {
    /// Positions before the moves.
    pub(super) before: &'m [DVec3],
    /// Where vertices belong.
    pub(super) goals: &'m [DVec3],
    pub(super) triangles: &'m [[u32; 3]],
    pub(super) stars: &'m Stars,
    /// The lattice that positions are on.
    pub(super) lattice: &'m Lattice,
    pub(super) budget: &'m Budget,
}

impl Moves<'_> {
    /// Positions as near to the goals as nothing meets and no triangle is without area. Where something does, vertices go back a
    /// part of their way, those of triangles that meet or have no area and then ever more around them, until nothing does; then
    /// half of those that went back try half of what is missing, and the other half, and so on.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn without_contacts(&self) -> Result<Vec<DVec3>, Stopped> {
        let mut swept = None;
        let mut positions = self.goals.to_vec();
        if !self.take_back(&mut positions, self.before, &SHARES_BACK, None, &mut swept)? {
            return Ok(positions);
        }
        for attempt in 0..ATTEMPTS {
            if positions == self.goals {
                break;
            }
            let settled = positions.clone();
            let mut tried = Vec::new();
            for (v, position) in positions.iter_mut().enumerate() {
                // Two that are in each other's way rarely try at the same time.
                let has_turn = (v as u32).wrapping_mul(0x9e37_79b9) >> 31 == attempt & 1;
                if has_turn && *position != self.goals[v] {
                    *position = self.nearest(position.lerp(self.goals[v], 0.5));
                    tried.push(v as u32);
                }
            }
            let changed = sorted_around(&tried, self.stars);
            if !self.take_back(&mut positions, &settled, &[], Some(changed), &mut swept)? {
                break;
            }
        }
        Ok(positions)
    }

    fn nearest(&self, place: DVec3) -> DVec3 {
        self.lattice.nearest(self.lattice.units_of(place))
    }

    /// A search structure with a box around each triangle wherever its corners may be on their ways.
    fn swept_boxes(&self) -> Result<Bvh, Stopped> {
        let bounds = |t: &[u32; 3]| {
            let ends = t.map(|v| [self.before[v as usize], self.goals[v as usize]]);
            let bounds = Aabb::of(ends.into_iter().flatten());
            [bounds.min, bounds.max]
        };
        let _charge = self.budget.charge(self.triangles.len() as u64 * 60)?;
        let ends: Vec<DVec3> = self.triangles.iter().flat_map(bounds).collect();
        let names: Vec<[u32; 3]> =
            (0..self.triangles.len() as u32).map(|t| [2 * t, 2 * t + 1, 2 * t + 1]).collect();
        Bvh::build(&ends, &names, None, self.budget)
    }

    /// Moves vertices from `positions` back to `before`, where nothing meets, by these shares one after the other and then all
    /// the way, until nothing meets. Where `changed` names triangles, all others are as `before`. False: everything went back.
    fn take_back(
        &self,
        positions: &mut [DVec3],
        before: &[DVec3],
        shares: &[f64],
        mut changed: Option<Vec<u32>>,
        swept: &mut Option<Bvh>,
    ) -> Result<bool, Stopped> {
        let ahead = positions.to_vec();
        let mut times = vec![0u8; positions.len()];
        for round in 0..ROUNDS {
            let Offenders { vertices: mut bad, are_contacts } =
                self.offenders(positions, changed.as_deref(), swept)?;
            if bad.is_empty() {
                return Ok(true);
            }
            for _ in ROUNDS_NEAR..=round {
                bad = around(&bad, self.stars).flat_map(|t| self.triangles[t as usize]).collect();
                bad.sort_unstable();
                bad.dedup();
            }
            bad.retain(|&v| positions[v as usize] != before[v as usize]);
            for v in bad.iter().map(|&v| v as usize) {
                let share = shares.get(usize::from(times[v])).filter(|_| round < ROUNDS_NEAR);
                positions[v] =
                    share.map_or(before[v], |&share| self.nearest(ahead[v].lerp(before[v], share)));
                times[v] += 1;
            }
            // After a search for contacts only triangles around a vertex that went back since can have begun to meet others.
            if are_contacts || changed.is_some() {
                let known = if are_contacts { None } else { changed.take() };
                let mut now = sorted_around(&bad, self.stars);
                now.extend(known.into_iter().flatten());
                now.sort_unstable();
                now.dedup();
                changed = Some(now);
            }
        }
        let is_settled = self.offenders(positions, None, swept)?.vertices.is_empty();
        if !is_settled {
            positions.copy_from_slice(before);
        }
        Ok(is_settled)
    }

    /// What breaks P0 or P1 `among` these triangles and all others, or everywhere.
    fn offenders(
        &self,
        positions: &[DVec3],
        among: Option<&[u32]>,
        swept: &mut Option<Bvh>,
    ) -> Result<Offenders, Stopped> {
        let (triangles, budget) = (self.triangles, self.budget);
        let mut bad = at_one_place(positions, budget)?;
        bad.extend(flat(positions, triangles, among, budget)?);
        let are_contacts = bad.is_empty();
        if are_contacts {
            let meeting = match among {
                None => everywhere(positions, triangles, budget)?,
                Some(among) => {
                    let swept = match swept {
                        Some(swept) => swept,
                        None => swept.insert(self.swept_boxes()?),
                    };
                    of_these(positions, triangles, among, swept, budget)?
                }
            };
            bad.extend(meeting.into_iter().flat_map(|t| triangles[t as usize]));
        }
        bad.sort_unstable();
        bad.dedup();
        Ok(Offenders { vertices: bad, are_contacts })
    }
}

/// The triangles around these vertices, ascending.
fn sorted_around(vertices: &[u32], stars: &Stars) -> Vec<u32> {
    let mut found: Vec<u32> = around(vertices, stars).collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// The triangles around these vertices, those around several of them repeatedly.
fn around<'s>(vertices: &'s [u32], stars: &'s Stars) -> impl Iterator<Item = u32> + 's {
    vertices.iter().flat_map(|&v| stars.of_vertex(v as usize)).copied()
}

/// What breaks P0 or P1.
struct Offenders {
    /// Its vertices, ascending.
    vertices: Vec<u32>,
    /// Contacts were searched, which takes triangles with an area and vertices at places of their own.
    are_contacts: bool,
}

/// Vertices that are where another one is.
fn at_one_place(positions: &[DVec3], budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let coincident = coincident_f64(positions, budget)?;
    let first = |v: u32| coincident.first[coincident.group[v as usize] as usize];
    Ok((0..positions.len() as u32).filter(|&v| first(v) != v).flat_map(|v| [v, first(v)]).collect())
}

/// Vertices of triangles without an area.
fn flat(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    among: Option<&[u32]>,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let count = among.map_or(triangles.len(), <[u32]>::len);
    let flat = par::try_map_ranges(count, CHECK_EVERY, |range| {
        budget.check()?;
        let mut flat = Vec::new();
        for place in range {
            let corners = triangles[among.map_or(place, |among| among[place] as usize)];
            let [a, b, c] = corners.map(|v| positions[v as usize]);
            if are_collinear(a, b, c) {
                flat.extend(corners);
            }
        }
        Ok(flat)
    })?;
    Ok(flat.concat())
}

/// Triangles that meet others.
fn everywhere(positions: &[DVec3], triangles: &[[u32; 3]], budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let bvh = Bvh::build(positions, triangles, None, budget)?;
    let search = Search::All { keep: CONTACTS };
    // The surface is closed: every edge has its two triangles.
    let terrains = Terrains::find(positions, triangles, &[], budget)?;
    let contacts = spatial::self_contacts(positions, triangles, &bvh, Some(&terrains), search, budget)?;
    Ok(contacts.list.iter().flat_map(|contact| [contact.a, contact.b]).collect())
}

/// Triangles that meet one of `these`, and those of these that do.
fn of_these(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    these: &[u32],
    bvh: &Bvh,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let found = par::try_map_ranges(these.len(), 256, |range| {
        let mut found = Vec::new();
        for &t in &these[range] {
            let corners = triangles[t as usize];
            let plane = ThreePointPlane::through(corners.map(|v| positions[v as usize]));
            let bounds = Aabb::of(corners.map(|v| positions[v as usize]));
            bvh.visit_box(bounds, budget, |other| {
                let others = triangles[other as usize];
                let shared = Shared::between(corners, others);
                let points = others.map(|v| &positions[v as usize]);
                if other != t && contact(&plane, points, shared).is_some() {
                    found.extend([t, other]);
                }
            })?;
        }
        budget.spend(4)?;
        Ok(found)
    })?;
    Ok(found.concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_that_went_through_the_base_comes_back() {
        let corners =
            [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]].map(DVec3::from_array);
        // Two tetrahedra, apart before; then a corner of the second is inside the first.
        let before: Vec<DVec3> = corners.into_iter().chain(corners.map(|p| p + 9.0)).collect();
        let tetrahedron = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let triangles: Vec<[u32; 3]> =
            tetrahedron.into_iter().chain(tetrahedron.map(|t| t.map(|v| v + 4))).collect();
        let budget = Budget::unlimited();
        let stars = Stars::of(&triangles, 8, &budget).unwrap();
        let lattice = Lattice::around(Aabb::of(before.iter().copied()), 64, usize::MAX).unwrap();
        let moved = |goals: &[DVec3]| {
            let moves = Moves {
                before: &before,
                goals,
                triangles: &triangles,
                stars: &stars,
                lattice: &lattice,
                budget: &budget,
            };
            let settled = moves.without_contacts().unwrap();
            assert!(everywhere(&settled, &triangles, &budget).unwrap().is_empty());
            settled
        };
        let mut goals = before.clone();
        goals[4] = DVec3::splat(0.5);
        goals[1] = DVec3::new(4.5, 0.0, 0.0);
        let settled = moved(&goals);
        // It stops before the face that it went through, and so much nearer than it was, where the sum is 27.
        let sum = settled[4].element_sum();
        assert!(settled[1].x > 4.4 && sum > 4.0 && sum < 5.0, "{settled:?}");
        goals[1] = goals[0];
        assert!(moved(&goals)[1] != goals[0]);
    }
}
