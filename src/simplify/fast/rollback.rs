//! The guarded mode: a round's collapses are taken back where the surface would meet itself.
//!
//! After a round the triangles that meet others where they must not are found exactly, and also closed shells that are
//! inside out or have others around them than in the input: such a shell has jumped, although nothing meets. The
//! vertices that were merged into the corners of these triangles are locked, and the parts they are in are done again
//! without them. Every try locks at least one more vertex, and with all of them locked the surface is that of the round
//! before, so it ends, with a surface that is as sound as the input.
//!
//! Where the input meets itself its triangles stay as they are.

use super::check::{Left, RoundCheck, SurfaceCheck};
use super::guard::{Guard, RoundConditions};
use super::mesh::{Mesh, MeshDivision};
use super::outcome::PartOutcome;
use super::rounds::Rounds;
use crate::budget::Stopped;
use crate::geom::DVec3;
use crate::par;
use crate::simplify::criterion::CollapseCriterion;
use crate::simplify::report::SimplifyRefusal;
use crate::simplify::surface::NEW;

/// Tries after which one more ring around what must be locked is locked too.
const TRIES_TO_RING: usize = 4;
/// Tries after which whole parts are locked.
const TRIES_MAX: usize = 40;

impl<'r, C: CollapseCriterion> Rounds<'r, C> {
    /// Does parts again until the surface they leave is sound.
    pub(super) fn roll_back(
        &self,
        guard: &mut Guard,
        division: &MeshDivision,
        parts: &mut [PartOutcome<C::State>],
        course: &RoundConditions,
    ) -> Result<(), Stopped> {
        let left =
            par::map_ranges(parts.len(), 1, |range| self.left(division, range.start, &parts[range.start]));
        let between = self.between(division);
        let mut check = RoundCheck::new(division, left, between, &guard.roundings, self.budget)?;
        let mut locked = vec![false; division.order.len()];
        let mut tries = 0;
        loop {
            let SurfaceCheck { mut offenders, unsound } = check.look()?;
            guard.shells.exclude(&unsound);
            let mut reason = SimplifyRefusal::SelfIntersection;
            if offenders.is_empty() {
                let moved = guard.shells.moved(&self.input, &check, &guard.roundings, self.budget)?;
                if !moved.is_empty() {
                    offenders = guard.shells.offenders(&moved, &check);
                    reason = SimplifyRefusal::Nesting;
                }
            }
            if offenders.is_empty() {
                return Ok(());
            }
            tries += 1;
            let again = lock(division, parts, &offenders, tries, &mut locked);
            self.redo(division, parts, &again, &locked, course)?;
            for (i, count) in again {
                parts[i].tally.refusals.add_times(reason, count);
                check.replace(i, self.left(division, i, &parts[i]), &guard.roundings);
            }
        }
    }

    /// Does parts again, without the locked vertices and no further than before.
    fn redo(
        &self,
        division: &MeshDivision,
        parts: &mut [PartOutcome<C::State>],
        again: &[(usize, u64)],
        locked: &[bool],
        course: &RoundConditions,
    ) -> Result<(), Stopped> {
        let bytes = |&(i, _): &(usize, u64)| {
            let triangles = &self.mesh.triangles[division.starts[i]..division.starts[i + 1]];
            self.bytes_of_parts(triangles, division.vertices(i).len())
        };
        // Of the largest: few are done at a time, and a part is small or the only one.
        let _charge = self.budget.charge(again.iter().map(bytes).max().unwrap_or(0))?;
        let done = par::try_map_ranges(again.len(), 1, |range| {
            let i = again[range.start].0;
            let mut piece = self.piece(division, i)?;
            for (is_free, is_locked) in piece.is_free.iter_mut().zip(&locked[i * division.part_len..]) {
                *is_free &= !is_locked;
            }
            let mut part = self.part(division, i, piece, &course.strays, course.is_first)?;
            part.advance(course.class_max, parts[i].left.triangles.len(), self.budget)?;
            Ok(self.outcome(division, i, &part))
        })?;
        for (&(i, _), mut part) in again.iter().zip(done) {
            part.tally.refusals.add_all(&parts[i].tally.refusals);
            parts[i] = part;
        }
        Ok(())
    }

    /// What part `i` leaves, as it is looked at.
    fn left(&self, division: &MeshDivision, i: usize, part: &PartOutcome<C::State>) -> Left {
        let first = i * division.part_len;
        let PartOutcome { left: Mesh { triangles, numbers, vertices, .. }, places, roots, .. } = part;
        let mut left = Left {
            triangles: triangles.clone(),
            numbers: numbers.clone(),
            positions: vec![DVec3::ZERO; roots.len()],
            is_merged: vec![false; roots.len()],
        };
        for (&place, vertex) in places.iter().zip(vertices) {
            left.positions[place as usize - first] = match vertex.origin {
                NEW => vertex.position / self.frame.scale,
                origin => self.input.positions[origin as usize],
            };
        }
        for (v, &root) in roots.iter().enumerate() {
            left.is_merged[root as usize] |= v != root as usize;
        }
        left
    }

    /// The triangles between parts.
    fn between(&self, division: &MeshDivision) -> Left {
        let first = division.first_between();
        Left {
            triangles: self.mesh.triangles[first..].to_vec(),
            numbers: self.mesh.numbers[first..].to_vec(),
            ..Left::default()
        }
    }
}

/// Locks what was merged into the offenders; gives the parts in which it is, with the number of vertices. After
/// some tries also what was merged into their neighbours, then those of these, and in the end all of a part.
fn lock<S>(
    division: &MeshDivision,
    parts: &[PartOutcome<S>],
    offenders: &[u32],
    tries: usize,
    locked: &mut [bool],
) -> Vec<(usize, u64)> {
    let mut again = Vec::new();
    for own in offenders.chunk_by(|&a, &b| a as usize / division.part_len == b as usize / division.part_len) {
        let i = own[0] as usize / division.part_len;
        let first = i * division.part_len;
        let part = &parts[i];
        let mut is_meant = vec![tries > TRIES_MAX; part.roots.len()];
        own.iter().for_each(|&v| is_meant[v as usize - first] = true);
        for _ in 0..(tries - 1) / TRIES_TO_RING {
            let before = is_meant.clone();
            for corners in &part.left.triangles {
                if corners.iter().any(|&v| before[v as usize - first]) {
                    corners.iter().for_each(|&v| is_meant[v as usize - first] = true);
                }
            }
        }
        let mut count = 0;
        for (v, &root) in part.roots.iter().enumerate() {
            if is_meant[root as usize] && !std::mem::replace(&mut locked[first + v], true) {
                count += 1;
            }
        }
        again.push((i, count));
    }
    again
}
