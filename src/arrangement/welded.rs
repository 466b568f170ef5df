//! The triangles of an arrangement between welded vertices, and which of them meet.

use super::cluster::ContactPair;
use super::error::ArrangementError;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, are_collinear};
use crate::mesh::{EdgeGroups, edge_of, prev_corner, triangle_of};
use crate::par;
use crate::spatial::{Bvh, ContactKind, Search, Terrains, coincident_f64, self_contacts};

/// Triangles between the first of all vertices at one position.
pub(super) struct Welded<'p> {
    pub(super) positions: &'p [DVec3],
    pub(super) triangles: Vec<[u32; 3]>,
    /// Those that have an area, ascending.
    pub(super) sound: Vec<u32>,
    /// They are what was given, all of them sound.
    pub(super) is_as_given: bool,
}

impl<'p> Welded<'p> {
    pub(super) fn of(
        positions: &'p [DVec3],
        given: &[[u32; 3]],
        budget: &Budget,
    ) -> Result<Self, ArrangementError> {
        let is_finite = |v: &u32| positions.get(*v as usize).is_some_and(|p| p.is_finite());
        budget.spend(given.len() as u64)?;
        if let Some(t) = given.iter().position(|corners| !corners.iter().all(is_finite)) {
            return Err(ArrangementError::NotFinite { triangle: t as u32 });
        }
        let vertices = coincident_f64(positions, budget)?;
        let first = |v: u32| vertices.first[vertices.group[v as usize] as usize];
        let triangles: Vec<[u32; 3]> = given.iter().map(|corners| corners.map(first)).collect();
        let sound = sound(positions, &triangles, budget)?;
        let is_as_given = sound.len() == given.len() && triangles == given;
        Ok(Self { positions, triangles, sound, is_as_given })
    }

    /// The pairs of sound triangles that meet beyond common vertices and edges, at most so many; each copy of a triangle with the first.
    /// `known` is the hierarchy of the triangles as given, if there is one; that of the sound ones comes back.
    pub(super) fn meeting(
        &self,
        known: Option<Bvh>,
        pairs_max: usize,
        budget: &Budget,
    ) -> Result<(Vec<ContactPair>, Bvh), ArrangementError> {
        let Self { positions, triangles, .. } = self;
        let (mut pairs, open) = self.copies(budget)?;
        let build = || match known.filter(|_| self.is_as_given) {
            Some(bvh) => Ok(bvh),
            None => Bvh::build(positions, triangles, Some(&self.sound), budget),
        };
        let (bvh, terrains) = par::join(build, || Terrains::find(positions, triangles, &open, budget));
        let (bvh, terrains) = (bvh?, terrains?);
        let search = Search::UpTo { most: pairs_max };
        let contacts = self_contacts(positions, triangles, &bvh, Some(&terrains), search, budget)?;
        let count = contacts.count + pairs.len() as u64;
        if count > pairs_max as u64 {
            return Err(ArrangementError::TooManyPairs { count, limit: pairs_max as u64 });
        }
        pairs.extend(contacts.list.iter().map(|c| ContactPair { triangles: [c.a, c.b], kind: c.kind }));
        Ok((pairs, bvh))
    }

    /// Pairs of sound triangles with the same vertices, each with the first of them, and the ends of every edge that does not have
    /// exactly two triangles, one in each direction.
    fn copies(&self, budget: &Budget) -> Result<(Vec<ContactPair>, Vec<u32>), Stopped> {
        let triangles = &self.triangles;
        let groups = EdgeGroups::build(triangles, self.positions.len(), budget)?;
        budget.spend(self.sound.len() as u64)?;
        let is_sound = |t: u32| self.sound.len() == triangles.len() || self.sound.binary_search(&t).is_ok();
        let found = par::try_map_ranges(groups.len(), CHECK_EVERY, |range| {
            budget.check()?;
            let (mut pairs, mut open) = (Vec::new(), Vec::new());
            for group in range.map(|e| groups.group(e)) {
                let [from, to] = edge_of(triangles, group[0]);
                if !matches!(group, &[_, h] if edge_of(triangles, h) == [to, from] && from != to) {
                    open.extend([from, to]);
                }
                // At the edge opposite of their last vertex.
                let last = |h: u32| triangles[triangle_of(h) as usize][prev_corner(h) as usize % 3];
                let is_one = |&h: &u32| last(h) > from.max(to) && is_sound(triangle_of(h));
                match *group {
                    [] | [_] => {}
                    [h, other] if last(h) != last(other) => {}
                    _ => {
                        let mut by_last: Vec<(u32, u32)> =
                            group.iter().filter(|h| is_one(h)).map(|&h| (last(h), triangle_of(h))).collect();
                        by_last.sort_unstable();
                        for same in by_last.chunk_by(|a, b| a.0 == b.0) {
                            pairs.extend(same[1..].iter().map(|&(_, t)| ContactPair {
                                triangles: [same[0].1, t],
                                kind: ContactKind::Overlap,
                            }));
                        }
                    }
                }
            }
            Ok((pairs, open))
        })?;
        let (pairs, open): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        Ok((pairs.concat(), open.concat()))
    }
}

/// The triangles that have an area, ascending.
fn sound(positions: &[DVec3], triangles: &[[u32; 3]], budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let parts = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
        budget.check()?;
        let has_area = |&t: &usize| {
            let [a, b, c] = triangles[t].map(|v| positions[v as usize]);
            !are_collinear(a, b, c)
        };
        Ok::<_, Stopped>(range.filter(has_area).map(|t| t as u32).collect::<Vec<u32>>())
    })?;
    Ok(parts.concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn copies_of_sound_triangles_are_those_with_the_same_corners() {
        let mut state = 11u32;
        let mut random = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        // The first three are on a line, the last two at one place.
        let mut positions: Vec<DVec3> =
            (0..8).map(|i| DVec3::new(f64::from(i), f64::from(i / 3), 0.0)).collect();
        positions[7] = positions[6];
        let mut copies = 0;
        for round in 0..2_000 {
            let given: Vec<[u32; 3]> = (0..random(24)).map(|_| std::array::from_fn(|_| random(8))).collect();
            let budget = Budget::unlimited();
            let welded = Welded::of(&positions, &given, &budget).unwrap();
            let mut expected: BTreeMap<[u32; 3], Vec<u32>> = BTreeMap::new();
            for &t in &welded.sound {
                let mut corners = given[t as usize].map(|v| v.min(6));
                corners.sort_unstable();
                expected.entry(corners).or_default().push(t);
            }
            let pairs_of = |same: &Vec<u32>| same[1..].iter().map(|&t| [same[0], t]).collect::<Vec<_>>();
            let expected: Vec<[u32; 2]> = expected.values().flat_map(pairs_of).collect();
            let (found, _) = welded.copies(&budget).unwrap();
            let found: Vec<[u32; 2]> = found.iter().map(|pair| pair.triangles).collect();
            assert_eq!(found, expected, "round {round}: {given:?}");
            copies += found.len();
        }
        assert!(copies > 1_000, "{copies}");
    }
}
