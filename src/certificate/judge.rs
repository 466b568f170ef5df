//! The order of judgement: every reading, and in each the conditions that rest on one another.

use super::solid::EmbeddedShells;
use super::surface::ReadingSurface;
use super::topology::{Census, IndexTopology, degenerate, note_degenerate};
use super::verdict::ConditionCounts;
use super::{CertifyError, Condition, Depth, Shell, Violation};
use crate::budget::{Budget, Stopped};
use crate::formats::{self, Encoding, Precision, ReadOptions};
use crate::mesh::Soup;
use crate::par;
use crate::spatial::{Bvh, Contacts, Search, Terrains, self_contacts};
use std::borrow::Cow;

/// Contacts to keep for a report, so that it finds enough of each kind among them.
const CONTACTS_KEPT_MIN: usize = 1 << 16;

/// What was found.
pub(super) struct Judged {
    pub(super) verdict: ConditionCounts,
    /// Of the first reading.
    pub(super) census: Census,
    /// Of the first reading.
    pub(super) contacts: Option<Contacts>,
    /// Of the first reading; empty unless it is valid.
    pub(super) shells: Vec<Shell>,
}

/// Judges every reading of `bytes` that differs; `soup` is the f64 one.
pub(super) fn judge(
    soup: &Soup,
    bytes: &[u8],
    encoding: Encoding,
    options: &ReadOptions,
    depth: Depth,
    budget: &Budget,
) -> Result<Judged, CertifyError> {
    let mut judge = Judge::new(depth, budget);
    judge.judge_soup(soup, false)?;
    let rounded;
    if !soup.is_f32_exact && !judge.verdict.has_ended() {
        let options = ReadOptions { precision: Precision::F32, ..*options };
        rounded = formats::read(bytes, encoding, &options, budget)?;
        judge.judge_soup(&rounded, true)?;
    }
    Ok(judge.into_judged())
}

/// As [`judge`] of a part that was read already: `rounded` is its f32 reading, which is needed unless the other is the same.
pub(super) fn judge_read(
    soup: &Soup,
    rounded: Option<&Soup>,
    depth: Depth,
    budget: &Budget,
) -> Result<Judged, Stopped> {
    let mut judge = Judge::new(depth, budget);
    judge.judge_soup(soup, false)?;
    if !soup.is_f32_exact && !judge.verdict.has_ended() {
        match rounded {
            Some(rounded) => judge.judge_soup(rounded, true)?,
            None => judge.leave_open(),
        }
    }
    Ok(judge.into_judged())
}

/// What is kept of the first reading.
#[derive(Default)]
struct FirstReading {
    census: Census,
    contacts: Option<Contacts>,
    shells: Vec<Shell>,
}

/// What was found about a list of index triples.
#[derive(Clone)]
struct ListFaults {
    is_clean: bool,
    duplicates: Vec<u32>,
    /// Ends of the edges that have not exactly two triangles, one in each direction.
    open_vertices: Vec<u32>,
}

struct Judge<'a> {
    budget: &'a Budget,
    verdict: ConditionCounts,
    first: Option<FirstReading>,
    /// The lists of the f64 readings; those of the f32 readings are the same unless rounding welds more.
    known_lists: Vec<(Cow<'a, [[u32; 3]]>, ListFaults)>,
}

impl<'a> Judge<'a> {
    fn new(depth: Depth, budget: &'a Budget) -> Self {
        Self { budget, verdict: ConditionCounts::new(depth), first: None, known_lists: Vec::new() }
    }

    /// Leaves every condition open: a reading is missing.
    fn leave_open(&mut self) {
        for condition in Condition::ALL {
            self.verdict.leave_open(condition);
        }
    }

    fn into_judged(self) -> Judged {
        let Self { verdict, first, .. } = self;
        let FirstReading { census, contacts, shells } = first.unwrap_or_default();
        Judged { verdict, census, contacts, shells }
    }

    fn judge_soup(&mut self, soup: &'a Soup, is_f32: bool) -> Result<(), Stopped> {
        self.judge_triangles(soup, is_f32, false)?;
        if !soup.polygons.not_fans.is_empty() && !self.verdict.has_ended() {
            self.judge_triangles(soup, is_f32, true)?;
        }
        Ok(())
    }

    fn judge_triangles(&mut self, soup: &'a Soup, is_f32: bool, is_fan: bool) -> Result<(), Stopped> {
        let indexed = ReadingSurface::as_indexed(soup, is_f32, is_fan, self.budget)?;
        let (welded, split) = indexed.weld(self.budget)?;
        self.judge_surface(welded)?;
        match split {
            Some(indexed) if !self.verdict.has_ended() => self.judge_indices(indexed),
            _ => Ok(()),
        }
    }

    /// P0 of the vertices as indexed. Their triangles are degenerate where the welded ones are, so what is left to
    /// judge is the list of indices.
    fn judge_indices(&mut self, surface: ReadingSurface<'a>) -> Result<(), Stopped> {
        self.verdict.readings.push(surface.reading);
        let faults = self.judge_list(&surface)?;
        self.keep_list(surface, faults);
        Ok(())
    }

    /// P0, P1 and P2 of a welded reading.
    fn judge_surface(&mut self, surface: ReadingSurface<'a>) -> Result<(), Stopped> {
        self.verdict.readings.push(surface.reading);
        note_unusable(&surface, &mut self.verdict);
        let degenerate = degenerate(&surface, self.budget)?;
        note_degenerate(&surface, &degenerate, &mut self.verdict);
        let faults = self.judge_list(&surface)?;
        if self.verdict.has_ended() {
            for condition in [Condition::Embedded, Condition::NotEmpty, Condition::Alternating] {
                self.verdict.leave_open(condition);
            }
        } else {
            let is_p0 = surface.is_usable() && degenerate.is_empty() && faults.is_clean;
            let left_out = [&degenerate[..], &faults.duplicates].concat();
            self.judge_embedding(&surface, is_p0, left_out, &faults.open_vertices)?;
        }
        self.keep_list(surface, faults);
        Ok(())
    }

    /// The conditions of P0 that the list of indices decides.
    fn judge_list(&mut self, surface: &ReadingSurface<'_>) -> Result<ListFaults, Stopped> {
        if let Some((_, faults)) = self.known_lists.iter().find(|(list, _)| *list == surface.triangles) {
            return Ok(faults.clone());
        }
        let topology = IndexTopology::of(&surface.triangles, surface.positions.len(), self.budget)?;
        topology.note(surface, &mut self.verdict, self.budget)?;
        self.first
            .get_or_insert_with(|| FirstReading { census: topology.census(), ..FirstReading::default() });
        Ok(ListFaults {
            is_clean: topology.is_clean(),
            duplicates: topology.duplicates(),
            open_vertices: topology.open_vertices(),
        })
    }

    fn keep_list(&mut self, surface: ReadingSurface<'a>, faults: ListFaults) {
        if !surface.reading.is_f32 {
            self.known_lists.push((surface.triangles, faults));
        }
    }

    /// P1, and P2 where P0 and P1 hold. P1 leaves out the triangles `left_out`.
    fn judge_embedding(
        &mut self,
        surface: &ReadingSurface<'_>,
        is_p0: bool,
        left_out: Vec<u32>,
        open_vertices: &[u32],
    ) -> Result<(), Stopped> {
        let ids = (!is_p0).then(|| all_but(surface.triangles.len() as u32, left_out));
        let (positions, triangles, budget) = (&surface.positions, &surface.triangles, self.budget);
        let (bvh, terrains) = par::join(
            || Bvh::build(positions, triangles, ids.as_deref(), budget),
            || Terrains::find(positions, triangles, open_vertices, budget),
        );
        let (bvh, terrains) = (bvh?, terrains?);
        let search = if self.verdict.is_brief() {
            Search::First
        } else {
            Search::Most { keep: self.verdict.samples().max(CONTACTS_KEPT_MIN) }
        };
        let contacts = self_contacts(positions, triangles, &bvh, Some(&terrains), search, budget)?;
        let is_p1 = contacts.count == 0 && !contacts.is_cut_short;
        if contacts.is_cut_short {
            self.verdict.leave_contacts_uncounted();
            // A search is cut short only after it has found something; nothing is proved in any case.
            self.verdict.leave_open(Condition::Embedded);
        }
        self.verdict.note(Condition::Embedded, contacts.count, |samples| {
            let first = contacts.list.iter().take(samples);
            first.map(|c| surface.violation_between(Condition::Embedded, [c.a, c.b])).collect()
        });
        let shells = if is_p0 && is_p1 {
            self.judge_solid(surface, &bvh)?
        } else {
            self.verdict.leave_open(Condition::NotEmpty);
            self.verdict.leave_open(Condition::Alternating);
            Vec::new()
        };
        if let Some(first) = self.first.as_mut().filter(|first| first.contacts.is_none()) {
            first.contacts = Some(contacts);
            first.shells = shells;
        }
        Ok(())
    }

    /// P2, where P0 and P1 hold.
    fn judge_solid(&mut self, surface: &ReadingSurface<'_>, bvh: &Bvh) -> Result<Vec<Shell>, Stopped> {
        let solid = EmbeddedShells::of(surface, bvh, self.budget)?;
        let shells = solid.describe(surface, self.budget)?;
        self.verdict.note(Condition::NotEmpty, u64::from(shells.is_empty()), |_| {
            let (condition, reading) = (Condition::NotEmpty, surface.reading);
            vec![Violation { condition, reading, faces: Vec::new(), position: None }]
        });
        let misnested = solid.misnested();
        self.verdict.note(Condition::Alternating, misnested.len() as u64, |samples| {
            let witness =
                |&t: &u32| surface.violation(Condition::Alternating, &[t], &surface.triangles[t as usize]);
            misnested.iter().take(samples).map(witness).collect()
        });
        Ok(shells)
    }
}

/// Notes the faces and vertices of the file that no triangle of the soup stands for.
fn note_unusable(surface: &ReadingSurface<'_>, verdict: &mut ConditionCounts) {
    let (faces, vertices) = (&surface.soup.face_faults, &surface.soup.non_finite_vertices);
    verdict.note(Condition::Usable, (faces.len() + vertices.len()) as u64, |samples| {
        let (condition, reading) = (Condition::Usable, surface.reading);
        let faces = faces.iter().map(|fault| vec![fault.face]);
        let nameless = vertices.iter().map(|_| Vec::new());
        let named = faces.chain(nameless).take(samples);
        named.map(|faces| Violation { condition, reading, faces, position: None }).collect()
    });
}

/// The numbers below `count` without those `left_out`, which may be in any order and repeat.
fn all_but(count: u32, mut left_out: Vec<u32>) -> Vec<u32> {
    left_out.sort_unstable();
    left_out.push(count);
    let (mut next, mut others) = (0, Vec::with_capacity(count as usize));
    for t in left_out {
        others.extend(next..t);
        next = t + 1;
    }
    others
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_may_be_in_any_order_and_repeat() {
        assert_eq!(all_but(6, vec![5, 1, 3, 1]), [0, 2, 4]);
        assert!(all_but(3, vec![0, 1, 2]).is_empty());
        assert_eq!(all_but(2, Vec::new()), [0, 1]);
        assert!(all_but(0, Vec::new()).is_empty());
    }
}
