//! Whether the surface that a round would leave meets itself.

use super::mesh::MeshDivision;
use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::geom::{Aabb, DVec3, Shared, ThreePointPlane, are_collinear, contact};
use crate::par;
use crate::spatial::{Bvh, Search, self_contacts};

/// Contacts that are looked at; when there are more, the rest is found after these are gone.
const CONTACTS_KEPT: usize = 1 << 20;

/// A way to read coordinates: as they are, or rounded to f32.
pub(super) struct CoordinateReading {
    /// By place in the division.
    pub(super) positions: Vec<DVec3>,
    /// Holds the triangles of the first try that have an area.
    bvh: Bvh,
}

/// What a part leaves.
#[derive(Debug, Clone, Default)]
pub(super) struct Left {
    /// Places in the division.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Numbers in the input.
    pub(super) numbers: Vec<u32>,
    /// Positions of the part's vertices, in the unit of the input; zero for those that are not left.
    pub(super) positions: Vec<DVec3>,
    /// For each vertex, whether others were merged into it.
    pub(super) is_merged: Vec<bool>,
}

/// The surface of a round: that of the first try, and what was done again.
pub(super) struct RoundCheck<'c> {
    division: &'c MeshDivision,
    /// The first try: triangles of each part, then those between parts.
    pub(super) first: Left,
    /// Where the triangles of each part begin in `first`.
    starts: Vec<usize>,
    /// What parts leave that were done again; their positions are in the readings.
    again: Vec<Option<Left>>,
    pub(super) readings: Vec<CoordinateReading>,
    /// There were more contacts than are kept.
    is_truncated: bool,
    budget: &'c Budget,
    _charge: Charge<'c>,
}

/// What a look at the surface found.
#[derive(Debug, Clone, Default)]
pub(super) struct SurfaceCheck {
    /// Merged vertices, by place, of triangles that meet others or have no area.
    pub(super) offenders: Vec<u32>,
    /// Numbers of triangles that are as in the input and meet others that are too.
    pub(super) unsound: Vec<u32>,
}

impl<'c> RoundCheck<'c> {
    /// The surface that `parts` leave, and `between` as it is. `roundings`: for each reading, whether it is rounded.
    pub(super) fn new(
        division: &'c MeshDivision,
        parts: Vec<Left>,
        between: Left,
        roundings: &[bool],
        budget: &'c Budget,
    ) -> Result<Self, Stopped> {
        let (triangles, vertices) =
            parts.iter().chain([&between]).fold((0, 0), |(triangles, vertices), left| {
                (triangles + left.triangles.len() as u64, vertices + left.positions.len() as u64)
            });
        // What is left: as it was first, done again and together; and for each reading positions and a hierarchy.
        let of_left = 3 * 16 * triangles + vertices;
        let of_reading = 24 * vertices + triangles * Bvh::BYTES_PER_TRIANGLE;
        let charge = budget.charge(of_left + roundings.len() as u64 * of_reading)?;
        let (mut first, mut starts) = (Left::default(), Vec::with_capacity(parts.len() + 1));
        first.triangles.reserve_exact(triangles as usize);
        first.numbers.reserve_exact(triangles as usize);
        first.positions.reserve_exact(vertices as usize);
        let again = parts.iter().map(|_| None).collect();
        for part in parts.into_iter().chain([between]) {
            starts.push(first.triangles.len());
            first.triangles.extend(part.triangles);
            first.numbers.extend(part.numbers);
            first.positions.extend(part.positions);
            first.is_merged.extend(part.is_merged);
        }
        let mut positions = std::mem::take(&mut first.positions);
        let mut check = Self {
            division,
            first,
            starts,
            again,
            readings: Vec::new(),
            is_truncated: false,
            budget,
            _charge: charge,
        };
        for (r, &is_rounded) in roundings.iter().enumerate() {
            let is_last = r + 1 == roundings.len();
            let mut positions = if is_last { std::mem::take(&mut positions) } else { positions.clone() };
            if is_rounded {
                positions.iter_mut().for_each(|p| *p = round(*p));
            }
            let with_area = with_area(&positions, &check.first.triangles, budget)?;
            let ids = (with_area.len() < check.first.triangles.len()).then_some(&with_area[..]);
            let bvh = Bvh::build(&positions, &check.first.triangles, ids, budget)?;
            check.readings.push(CoordinateReading { positions, bvh });
        }
        Ok(check)
    }

    /// The hierarchy of the first try, when nothing was done again.
    pub(super) fn first_bvh(&self, reading: usize) -> Option<&Bvh> {
        self.again.iter().all(Option::is_none).then(|| &self.readings[reading].bvh)
    }

    /// Replaces what a part leaves.
    pub(super) fn replace(&mut self, part: usize, mut left: Left, roundings: &[bool]) {
        let first = part * self.division.part_len;
        for (reading, &is_rounded) in self.readings.iter_mut().zip(roundings) {
            for (p, &position) in reading.positions[first..].iter_mut().zip(&left.positions) {
                *p = if is_rounded { round(position) } else { position };
            }
        }
        self.first.is_merged[first..first + left.is_merged.len()].copy_from_slice(&left.is_merged);
        (left.positions, left.is_merged) = (Vec::new(), Vec::new());
        self.again[part] = Some(left);
    }

    /// All triangles as they are now, with their numbers.
    pub(super) fn triangles(&self) -> (Vec<[u32; 3]>, Vec<u32>) {
        let (mut triangles, mut numbers) = (Vec::new(), Vec::new());
        for (i, again) in self.again.iter().enumerate() {
            let own = self.starts[i]..self.starts[i + 1];
            let (t, n) = match again {
                Some(left) => (&left.triangles[..], &left.numbers[..]),
                None => (&self.first.triangles[own.clone()], &self.first.numbers[own]),
            };
            triangles.extend(t);
            numbers.extend(n);
        }
        let between = self.starts[self.again.len()]..;
        triangles.extend(&self.first.triangles[between.clone()]);
        numbers.extend(&self.first.numbers[between]);
        (triangles, numbers)
    }

    /// Looks at what has changed since the last look.
    pub(super) fn look(&mut self) -> Result<SurfaceCheck, Stopped> {
        let mut found = SurfaceCheck::default();
        let is_first = self.again.iter().all(Option::is_none);
        let redone: (Vec<[u32; 3]>, Vec<u32>) = if is_first {
            (Vec::new(), Vec::new())
        } else if std::mem::take(&mut self.is_truncated) {
            self.triangles()
        } else {
            let left = self.again.iter().flatten();
            left.fold(Default::default(), |(mut triangles, mut numbers), left| {
                triangles.extend(&left.triangles);
                numbers.extend(&left.numbers);
                (triangles, numbers)
            })
        };
        for r in 0..self.readings.len() {
            if is_first {
                let (triangles, numbers) = (&self.first.triangles, &self.first.numbers);
                self.is_truncated |= self.meet(r, triangles, numbers, None, &mut found)?;
            } else {
                let bvh = self.build(r, &redone.0)?;
                self.is_truncated |= self.meet(r, &redone.0, &redone.1, Some(&bvh), &mut found)?;
                self.meet_rest(r, &redone, &mut found)?;
            }
        }
        for list in [&mut found.offenders, &mut found.unsound] {
            list.sort_unstable();
            list.dedup();
        }
        Ok(found)
    }

    fn build(&self, reading: usize, triangles: &[[u32; 3]]) -> Result<Bvh, Stopped> {
        let positions = &self.readings[reading].positions;
        let ids = with_area(positions, triangles, self.budget)?;
        Bvh::build(positions, triangles, Some(&ids), self.budget)
    }

    /// Contacts among `triangles`, and those without an area. True when there were more than are kept.
    fn meet(
        &self,
        reading: usize,
        triangles: &[[u32; 3]],
        numbers: &[u32],
        bvh: Option<&Bvh>,
        found: &mut SurfaceCheck,
    ) -> Result<bool, Stopped> {
        let CoordinateReading { positions, bvh: first } = &self.readings[reading];
        let flat = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
            self.budget.check()?;
            let is_flat = |t: &usize| {
                let [a, b, c] = triangles[*t].map(|v| positions[v as usize]);
                are_collinear(a, b, c)
            };
            Ok(range.filter(is_flat).collect::<Vec<_>>())
        })?;
        for t in flat.concat() {
            self.note(&[(triangles[t], numbers[t])], found);
        }
        let search = Search::All { keep: CONTACTS_KEPT };
        let contacts = self_contacts(positions, triangles, bvh.unwrap_or(first), None, search, self.budget)?;
        for contact in &contacts.list {
            let pair = [contact.a, contact.b].map(|t| (triangles[t as usize], numbers[t as usize]));
            self.note(&pair, found);
        }
        Ok(contacts.count > contacts.list.len() as u64)
    }

    /// Contacts of what was done again with what was not.
    fn meet_rest(
        &self,
        reading: usize,
        (triangles, numbers): &(Vec<[u32; 3]>, Vec<u32>),
        found: &mut SurfaceCheck,
    ) -> Result<(), Stopped> {
        let CoordinateReading { positions, bvh } = &self.readings[reading];
        let corners = |t: [u32; 3]| t.map(|v| positions[v as usize]);
        let pairs = par::try_map_ranges(triangles.len(), CHECK_EVERY / 16, |range| {
            let mut pairs = Vec::new();
            for t in range {
                let own = corners(triangles[t]);
                let plane = ThreePointPlane::through(own);
                bvh.visit_box(Aabb::of(own), self.budget, |other| {
                    let its = self.first.triangles[other as usize];
                    let do_meet = || {
                        let theirs = corners(its);
                        contact(&plane, theirs.each_ref(), Shared::between(triangles[t], its)).is_some()
                    };
                    if !self.is_again(other) && do_meet() {
                        pairs.push([(triangles[t], numbers[t]), (its, self.first.numbers[other as usize])]);
                    }
                })?;
            }
            Ok(pairs)
        })?;
        pairs.concat().iter().for_each(|pair| self.note(pair, found));
        Ok(())
    }

    /// True when a triangle of the first try is in a part that was done again.
    fn is_again(&self, triangle: u32) -> bool {
        let part = self.starts.partition_point(|&start| start <= triangle as usize) - 1;
        self.again.get(part).is_some_and(Option::is_some)
    }

    /// Notes triangles that should not be as they are.
    fn note(&self, triangles: &[([u32; 3], u32)], found: &mut SurfaceCheck) {
        let corners = triangles.iter().flat_map(|(corners, _)| corners);
        let before = found.offenders.len();
        found.offenders.extend(corners.filter(|&&v| self.first.is_merged[v as usize]));
        if found.offenders.len() == before {
            found.unsound.extend(triangles.iter().map(|(_, number)| number));
        }
    }
}

fn round(p: DVec3) -> DVec3 {
    p.as_vec3().as_dvec3()
}

pub(super) fn rounded(positions: &[DVec3]) -> Vec<DVec3> {
    positions.iter().map(|&p| round(p)).collect()
}

/// The triangles that have an area.
pub(super) fn with_area(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let parts = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
        budget.check()?;
        let has_area = |t: &u32| {
            let [a, b, c] = triangles[*t as usize].map(|v| positions[v as usize]);
            !are_collinear(a, b, c)
        };
        Ok((range.start as u32..range.end as u32).filter(has_area).collect::<Vec<_>>())
    })?;
    Ok(parts.concat())
}
