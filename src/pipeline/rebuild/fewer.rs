//! A rebuilt surface with fewer triangles, which meets itself nowhere.

use crate::budget::{Budget, CHECK_EVERY, Stage, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::UnionFind;
use crate::pipeline::{Action, SimplifyChoices};
use crate::simplify::{self, Mode, Simplified, SimplifyError, SimplifyOptions, Target};
use crate::spatial::{self, Bvh, Search, Terrains};
use crate::wrap::Wrapped;

/// Collapses of a rebuilt surface have errors up to this share of a cell, unless the caller has targets: what can be
/// seen comes from the lattice's cells, and flat faces need few triangles.
const ERROR_OF_CELL: f64 = 0.05;

/// Runs of the fast mode, each with more of the surface held.
const RUNS: usize = 5;

/// So many contacts are worth another run even when there were no more before.
const FEW: usize = 64;

/// Room around contacts in which the surface is held, in cells.
const ROOM: f64 = 2.0;

/// Contacts to hold the surface around after a run.
const CONTACTS: usize = 1 << 14;

/// The surface to simplify, to the caller's first target, or as far as it does not show.
pub(super) struct WrapReduction<'f> {
    pub(super) wrapped: &'f Wrapped,
    pub(super) choices: &'f SimplifyChoices,
    pub(super) budget: &'f Budget,
}

impl WrapReduction<'_> {
    /// What the mode gives. `None`: contacts remained, or there are not as many shells and handles as before.
    pub(super) fn triangles(&self, mode: Mode) -> Result<Option<(Simplified, Action)>, Stopped> {
        let Some(found) = self.embedded(mode)? else { return Ok(None) };
        let before =
            TopologicalInvariants::of(&self.wrapped.triangles, self.wrapped.positions.len(), self.budget)?;
        let after = TopologicalInvariants::of(&found.0.triangles, found.0.positions.len(), self.budget)?;
        Ok((before == after).then_some(found))
    }

    /// Of the fast mode, which does not look at what meets, a result without contacts: where there were
    /// some, the surface is held in the next run. `None`: contacts remained.
    fn embedded(&self, mode: Mode) -> Result<Option<(Simplified, Action)>, Stopped> {
        let (mut held, mut before) = (Vec::new(), usize::MAX);
        for _ in 0..RUNS {
            let Some(found) = self.run(mode, &held)? else { return Ok(None) };
            if mode != Mode::Fast {
                return Ok(Some(found));
            }
            let met = self.budget.stage(Stage::Simplify, || self.places_of_contacts(&found.0))?;
            if met.is_empty() {
                return Ok(Some(found));
            }
            // More of the surface held does not help everywhere.
            if met.len() > FEW.max(before / 2) {
                return Ok(None);
            }
            before = met.len();
            held.extend(met);
        }
        Ok(None)
    }

    fn run(&self, mode: Mode, held: &[Aabb]) -> Result<Option<(Simplified, Action)>, Stopped> {
        let Wrapped { positions, triangles, account, .. } = self.wrapped;
        let input = simplify::SimplifyInput::new(positions, triangles);
        let target = self.choices.targets.first().copied();
        let settings = SimplifyOptions {
            targets: vec![target.unwrap_or(Target::Error(account.spacing * ERROR_OF_CELL))],
            criterion: self.choices.criterion,
            placement: self.choices.placement,
            held,
            // The distance of the result is measured, whatever went over what on the way.
            sweeps: false,
            ..SimplifyOptions::default()
        };
        let run = || simplify::simplify(&input, mode, &settings, self.budget);
        match self.budget.stage(Stage::Simplify, run) {
            Ok(results) => Ok(results.into_iter().next().map(|result| {
                let action = crate::pipeline::simplify::action(&result.report);
                (result, action)
            })),
            Err(SimplifyError::Stopped(stopped)) => Err(stopped),
            Err(SimplifyError::NotManifold(_)) => Ok(None),
        }
    }

    /// Boxes around the places where triangles meet.
    fn places_of_contacts(&self, result: &Simplified) -> Result<Vec<Aabb>, Stopped> {
        let Simplified { positions, triangles, .. } = result;
        let bvh = Bvh::build(positions, triangles, None, self.budget)?;
        let terrains = Terrains::find(positions, triangles, &[], self.budget)?;
        let search = Search::All { keep: CONTACTS };
        let contacts =
            spatial::self_contacts(positions, triangles, &bvh, Some(&terrains), search, self.budget)?;
        let room = DVec3::splat(ROOM * self.wrapped.account.spacing);
        let bounds = |t: u32| Aabb::of(triangles[t as usize].map(|v| positions[v as usize]));
        let place = |contact: &spatial::TriangleContact| {
            let (a, b) = (bounds(contact.a), bounds(contact.b));
            Aabb { min: a.min.max(b.min) - room, max: a.max.min(b.max) + room }
        };
        Ok(contacts.list.iter().map(place).collect())
    }
}

/// What collapses must not change of a closed surface.
#[derive(Debug, PartialEq, Eq)]
struct TopologicalInvariants {
    shells: u32,
    /// Vertices less edges plus triangles: 2 for each shell less 2 for each handle.
    euler_characteristic: i64,
}

impl TopologicalInvariants {
    /// That of closed `triangles`, whose indices are below `vertex_count`.
    fn of(triangles: &[[u32; 3]], vertex_count: usize, budget: &Budget) -> Result<Self, Stopped> {
        let mut sets = UnionFind::new(vertex_count);
        let mut is_used = vec![false; vertex_count];
        for block in triangles.chunks(CHECK_EVERY) {
            budget.check()?;
            for &[a, b, c] in block {
                sets.unite(a, b);
                sets.unite(b, c);
                for v in [a, b, c] {
                    is_used[v as usize] = true;
                }
            }
        }
        let used = is_used.iter().filter(|&&is_used| is_used).count();
        let shells = sets.into_components().count - (vertex_count - used) as u32;
        Ok(Self { shells, euler_characteristic: used as i64 - triangles.len() as i64 / 2 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    fn topology(triangles: &[[u32; 3]], vertex_count: usize) -> (u32, i64) {
        let found = TopologicalInvariants::of(triangles, vertex_count, &Budget::unlimited()).unwrap();
        (found.shells, found.euler_characteristic)
    }

    #[test]
    fn shells_and_handles_are_counted() {
        assert_eq!(topology(&TETRAHEDRON, 4), (1, 2));
        let second = TETRAHEDRON.map(|corners| corners.map(|v| v + 5));
        // Vertices 4 and 9 are not used.
        assert_eq!(topology(&[TETRAHEDRON, second].concat(), 10), (2, 4));
        // A torus: a grid of three by three squares, each in two triangles, whose opposite sides are one.
        let at = |i: u32, j: u32| i % 3 * 3 + j % 3;
        let squares = (0..9).map(|n| (n / 3, n % 3));
        let torus = squares.flat_map(|(i, j)| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        });
        assert_eq!(topology(&torus.collect::<Vec<_>>(), 9), (1, 0));
        assert_eq!(topology(&[], 3), (0, 0));
    }
}
