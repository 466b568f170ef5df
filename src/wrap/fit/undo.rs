//! Takes moves back until no two triangles meet, exactly.

use super::super::lattice::Lattice;
use super::normals::Stars;
use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::geom::{Aabb, DVec3, Shared, ThreePointPlane, are_collinear, contact};
use crate::par;
use crate::spatial::{self, Bvh, Search, Terrains, coincident_f64};

/// All the way back, in the parts of a way that are counted.
const ALL: u8 = 64;

/// How vertices go back.
struct Back {
    /// How far in all, of [`ALL`], a vertex has gone back after each time that what it belongs to meets something.
    steps: &'static [u8],
    /// How much less far than a vertex those beside it go back at least, each for [`ROUNDS`] rounds.
    less_beside: &'static [u8],
}

/// What all but passes is about as near to the input as if it had not gone back. Where a part of the surface went back and what is
/// beside it did not, triangles between them meet others, so that what does not settle is smoothed ever more widely.
const SETTLING: Back = Back {
    steps: &[ALL / 16, ALL / 8, ALL / 4, ALL / 2, ALL],
    less_beside: &[ALL / 4, ALL / 8, ALL / 16, ALL / 32, ALL / 64, 0],
};

/// A vertex whose try to come nearer fails is where it was.
const TRYING: Back = Back { steps: &[ALL], less_beside: &[ALL] };

/// Rounds before those beside go back farther, or everything does.
const ROUNDS: usize = 8;

/// Times that half of the vertices that went back try to come nearer to where they belong.
const ATTEMPTS: u32 = 8;

/// Shares of what is missing that a vertex tries to come nearer by: the next one after each time that something was in its way, and
/// after the last one no more.
const NEARER: [f64; 3] = [1.0, 0.5, 0.25];

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

impl<'m> Moves<'m> {
    /// Positions as near to the goals as nothing meets and no triangle is without area. Where something does, vertices go back a
    /// part of their way, those of triangles that meet or have no area and some around them, until nothing does; then half of those
    /// that went back try to come nearer again, and the other half, and so on.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn without_contacts(&self) -> Result<Vec<DVec3>, Stopped> {
        let mut known = None;
        let mut positions = self.goals.to_vec();
        if !self.take_back(&mut positions, self.before, &SETTLING, None, &mut known)? {
            return Ok(positions);
        }
        let mut failures = vec![0u8; positions.len()];
        for attempt in 0..ATTEMPTS {
            let settled = positions.clone();
            let mut tried = Vec::new();
            for (v, position) in positions.iter_mut().enumerate() {
                // Two that are in each other's way rarely try at the same time.
                let has_turn = (v as u32).wrapping_mul(0x9e37_79b9) >> 31 == attempt & 1;
                if has_turn
                    && *position != self.goals[v]
                    && let Some(&share) = NEARER.get(usize::from(failures[v]))
                {
                    *position = self.nearest(position.lerp(self.goals[v], share));
                    tried.push(v as u32);
                }
            }
            if tried.is_empty() {
                continue;
            }
            let changed = sorted_around(&tried, self.stars);
            if !self.take_back(&mut positions, &settled, &TRYING, Some(changed), &mut known)? {
                break;
            }
            for v in tried.into_iter().map(|v| v as usize) {
                failures[v] += u8::from(positions[v] == settled[v]);
            }
        }
        Ok(positions)
    }

    fn nearest(&self, place: DVec3) -> DVec3 {
        self.lattice.nearest(self.lattice.units_of(place))
    }

    /// Moves vertices from `positions` back to `before`, where nothing meets, until nothing does. Where `changed` names triangles, all
    /// others are as `before`. False: everything went back.
    fn take_back(
        &self,
        positions: &mut [DVec3],
        before: &[DVec3],
        back: &Back,
        mut changed: Option<Vec<u32>>,
        known: &mut Option<Known<'m>>,
    ) -> Result<bool, Stopped> {
        let ahead = positions.to_vec();
        let mut gone = vec![0u8; positions.len()];
        for round in 0..ROUNDS * back.less_beside.len() {
            let Offenders { vertices: bad, are_contacts } =
                self.offenders(positions, changed.as_deref(), known)?;
            if bad.is_empty() {
                return Ok(true);
            }
            let mut farther =
                self.gone_farther(&bad, back.steps, back.less_beside[round / ROUNDS], &mut gone);
            // One that is back already is not what meets: of what meets, something has moved.
            farther.retain(|&v| positions[v as usize] != before[v as usize]);
            for v in farther.iter().map(|&v| v as usize) {
                positions[v] = match gone[v] {
                    ALL => before[v],
                    gone => self.nearest(ahead[v].lerp(before[v], f64::from(gone) / f64::from(ALL))),
                };
            }
            // After a search for contacts only triangles around a vertex that went back since can have begun to meet others.
            if are_contacts || changed.is_some() {
                let known = if are_contacts { None } else { changed.take() };
                let mut now = sorted_around(&farther, self.stars);
                now.extend(known.into_iter().flatten());
                now.sort_unstable();
                now.dedup();
                changed = Some(now);
            }
        }
        let is_settled = self.offenders(positions, None, known)?.vertices.is_empty();
        if !is_settled {
            positions.copy_from_slice(before);
        }
        Ok(is_settled)
    }

    /// Raises how far, of [`ALL`], vertices have `gone` back: that of each of `bad` to the next of `steps`, and that of all others to
    /// at least `less` below what is beside them. Gives the vertices whose part rose, ascending.
    fn gone_farther(&self, bad: &[u32], steps: &[u8], less: u8, gone: &mut [u8]) -> Vec<u32> {
        let mut farther = Vec::new();
        for &v in bad {
            let gone = &mut gone[v as usize];
            if let Some(&next) = steps.iter().find(|&next| next > gone) {
                *gone = next;
                farther.push(v);
            }
        }
        let mut next = 0;
        while let Some(&v) = farther.get(next) {
            next += 1;
            let least = gone[v as usize].saturating_sub(less);
            for w in self.stars.of_vertex(v as usize).iter().flat_map(|&t| self.triangles[t as usize]) {
                if gone[w as usize] < least {
                    gone[w as usize] = least;
                    farther.push(w);
                }
            }
        }
        farther.sort_unstable();
        farther.dedup();
        farther
    }

    /// What breaks P0 or P1 `among` these triangles and all others, or everywhere.
    fn offenders(
        &self,
        positions: &[DVec3],
        among: Option<&[u32]>,
        known: &mut Option<Known<'m>>,
    ) -> Result<Offenders, Stopped> {
        let (triangles, budget) = (self.triangles, self.budget);
        let mut bad = flat(positions, triangles, among, budget)?;
        // Where only some triangles are looked at, those around vertices at one place meet.
        if among.is_none() {
            bad.extend(at_one_place(positions, budget)?);
        }
        let are_contacts = bad.is_empty();
        if are_contacts {
            let meeting = match (among, &*known) {
                (Some(among), Some(known)) => known.meeting(positions, triangles, among, budget)?,
                _ => {
                    let bytes =
                        triangles.len() as u64 * Bvh::BYTES_PER_TRIANGLE + size_of_val(positions) as u64;
                    let charge = budget.charge(bytes)?;
                    let bvh = Bvh::build(positions, triangles, None, budget)?;
                    let meeting = everywhere(positions, triangles, &bvh, budget)?;
                    *known = Some(Known { positions: positions.to_vec(), bvh, _charge: charge });
                    meeting
                }
            };
            bad.extend(meeting.into_iter().flat_map(|t| triangles[t as usize]));
        }
        bad.sort_unstable();
        bad.dedup();
        Ok(Offenders { vertices: bad, are_contacts })
    }
}

/// A search structure of the triangles with these positions.
struct Known<'b> {
    positions: Vec<DVec3>,
    bvh: Bvh,
    _charge: Charge<'b>,
}

impl Known<'_> {
    /// Triangles that meet one of `these`, and those of these that do.
    fn meeting(
        &self,
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        these: &[u32],
        budget: &Budget,
    ) -> Result<Vec<u32>, Stopped> {
        // Those that are elsewhere now have a search structure of their own.
        let is_away = |v: &u32| positions[*v as usize] != self.positions[*v as usize];
        let is_elsewhere: Vec<bool> = triangles.iter().map(|corners| corners.iter().any(is_away)).collect();
        let elsewhere: Vec<u32> = (0..triangles.len() as u32).filter(|&t| is_elsewhere[t as usize]).collect();
        let of_tree = elsewhere.len() as u64 * (4 + Bvh::BYTES_PER_TRIANGLE);
        let _charge = budget.charge(2 * triangles.len() as u64 + of_tree)?;
        let there = Bvh::build(positions, triangles, Some(&elsewhere), budget)?;
        let mut is_asked = vec![false; triangles.len()];
        these.iter().for_each(|&t| is_asked[t as usize] = true);
        let found = par::try_map_ranges(these.len(), 256, |range| {
            let mut found = Vec::new();
            for &t in &these[range] {
                let corners = triangles[t as usize];
                let plane = ThreePointPlane::through(corners.map(|v| positions[v as usize]));
                let bounds = Aabb::of(corners.map(|v| positions[v as usize]));
                let mut compare = |other: u32| {
                    let others = triangles[other as usize];
                    let points = others.map(|v| &positions[v as usize]);
                    // Of two that are both asked for, the first one compares.
                    let is_turn = other > t || other < t && !is_asked[other as usize];
                    let is_near = is_turn && Aabb::of(points.map(|&p| p)).meets(bounds);
                    if is_near && contact(&plane, points, Shared::between(corners, others)).is_some() {
                        found.extend([t, other]);
                    }
                };
                self.bvh.visit_box(bounds, budget, |other| {
                    if !is_elsewhere[other as usize] {
                        compare(other);
                    }
                })?;
                there.visit_box(bounds, budget, compare)?;
            }
            budget.spend(4)?;
            Ok(found)
        })?;
        Ok(found.concat())
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
fn everywhere(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    bvh: &Bvh,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let search = Search::All { keep: CONTACTS };
    // The surface is closed: every edge has its two triangles.
    let terrains = Terrains::find(positions, triangles, &[], budget)?;
    let contacts = spatial::self_contacts(positions, triangles, bvh, Some(&terrains), search, budget)?;
    Ok(contacts.list.iter().flat_map(|contact| [contact.a, contact.b]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wrap::tests::Random;

    #[test]
    fn what_is_beside_goes_back_a_little_less() {
        // A strip of triangles, of which one end goes back.
        let triangles: Vec<[u32; 3]> = (0..40).map(|v| [v, v + 1, v + 2]).collect();
        let positions: Vec<DVec3> =
            (0..42).map(|v| DVec3::new(f64::from(v), f64::from(v % 2), 0.0)).collect();
        let budget = Budget::unlimited();
        let stars = Stars::of(&triangles, positions.len(), &budget).unwrap();
        let lattice = Lattice::around(Aabb::of(positions.iter().copied()), 64, usize::MAX).unwrap();
        let moves = Moves {
            before: &positions,
            goals: &positions,
            triangles: &triangles,
            stars: &stars,
            lattice: &lattice,
            budget: &budget,
        };
        let mut gone = vec![0; positions.len()];
        assert_eq!(moves.gone_farther(&[0], &[16, ALL], 16, &mut gone), [0]);
        assert_eq!(moves.gone_farther(&[0], &[16, ALL], 16, &mut gone), [0, 1, 2, 3, 4, 5, 6]);
        assert_eq!(gone[..9], [64, 48, 48, 32, 32, 16, 16, 0, 0]);
        // There is nothing behind all the way; without a difference everything goes.
        assert!(moves.gone_farther(&[0], &[16, ALL], 16, &mut gone).is_empty());
        assert_eq!(moves.gone_farther(&[1], &[16, ALL], 0, &mut gone).len(), 41);
    }

    #[test]
    fn a_search_among_some_finds_what_comparing_all_pairs_finds() {
        let mut random = Random(7);
        // Octahedra: their opposite corners are apexes of triangles that share an edge.
        let octahedron =
            [[4u32, 0, 1], [4, 1, 2], [4, 2, 3], [4, 3, 0], [5, 1, 0], [5, 2, 1], [5, 3, 2], [5, 0, 3]];
        let triangles: Vec<[u32; 3]> =
            (0..3).flat_map(|n| octahedron.map(|t| t.map(|v| v + 6 * n))).collect();
        let all = || 0..triangles.len() as u32;
        let budget = Budget::unlimited();
        let (mut meetings, mut coincidences, mut opposite) = (0, 0, 0);
        for _ in 0..2000 {
            let mut any = || DVec3::from_array([0; 3].map(|_| random.below(6) as f64));
            let base: Vec<DVec3> = (0..18).map(|_| any()).collect();
            let mut positions = base.clone();
            let moved = [4u32, 9, 13];
            moved.iter().for_each(|&v| positions[v as usize] = any());
            if random.below(4) == 0 {
                positions[4] = positions[5];
            }
            if !flat(&base, &triangles, None, &budget).unwrap().is_empty()
                || !flat(&positions, &triangles, None, &budget).unwrap().is_empty()
            {
                continue;
            }
            let bvh = Bvh::build(&base, &triangles, None, &budget).unwrap();
            let known = Known { positions: base, bvh, _charge: budget.charge(0).unwrap() };
            let has_moved = |t: &u32| triangles[*t as usize].iter().any(|v| moved.contains(v));
            let these: Vec<u32> = all().filter(has_moved).collect();
            let mut found = known.meeting(&positions, &triangles, &these, &budget).unwrap();
            found.sort_unstable();
            found.dedup();
            let meet = |t: u32, other: u32| {
                let [these, others] = [t, other].map(|t| triangles[t as usize]);
                let plane = ThreePointPlane::through(these.map(|v| positions[v as usize]));
                let points = others.map(|v| &positions[v as usize]);
                t != other && contact(&plane, points, Shared::between(these, others)).is_some()
            };
            let wanted: Vec<u32> = all()
                .filter(|&t| all().any(|other| (has_moved(&t) || has_moved(&other)) && meet(t, other)))
                .collect();
            assert_eq!(found, wanted);
            meetings += found.len();
            // Vertices at one place are corners of triangles that meet.
            for &v in &moved {
                let is_there = |w: &u32| *w != v && positions[*w as usize] == positions[v as usize];
                if (0..18).any(|w| is_there(&w)) {
                    assert!(found.iter().any(|&t| triangles[t as usize].contains(&v)));
                    coincidences += 1;
                    opposite += u32::from(v % 6 == 4 && is_there(&(v + 1)));
                }
            }
        }
        assert!(
            meetings > 2000 && coincidences > 100 && opposite > 20,
            "{meetings} {coincidences} {opposite}"
        );
    }

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
            let bvh = Bvh::build(&settled, &triangles, None, &budget).unwrap();
            assert!(everywhere(&settled, &triangles, &bvh, &budget).unwrap().is_empty());
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
