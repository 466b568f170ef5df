//! Whether a result is the file, is true to it, or is something else: the second word of a verdict.
//!
//! *Exact*: the same surface, no vertex moved. *Faithful*: nothing that a customer would see is gone, made up or moved
//! beyond bounds that are stated. *Changed*: a bound is exceeded, and which. The bounds and where they are from:
//! `docs/decisions/0032-printable-is-not-faithful.md`.

use super::changed::area_of;
use super::fidelity::{LOSS_MAX, LOST_BEYOND, Losses, Original, defined_volume};
use super::size::diagonal;
use super::{Answer, Outcome, Refusal, Report};
use crate::budget::{Budget, CHECK_EVERY, Stage, Stopped};
use crate::distance::SurfaceDistance;
use crate::geom::{Aabb, DVec3};
use crate::mesh::Soup;
use crate::repair::NEW;

/// Most of the surface of a faithful result that may be invented: as much as may be lost.
const INVENTED_MAX: f64 = LOSS_MAX;

/// Farthest that a place of a faithful result may be from the file, or a visible place of the file from it, as a share of
/// the diagonal: five times the distance from which a place counts as lost, for the few places that may be lost.
const MOVED_MAX: f64 = 0.01;

/// Largest change of a defined volume of a faithful result, as a share: as much as of the surface.
const VOLUME_CHANGE_MAX: f64 = 0.01;

/// Distances up to this share of the diagonal are the rounding of the distances themselves.
const ROUNDING: f64 = 1e-12;

/// How true a result is to its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Fidelity {
    /// The same surface; no vertex moved.
    Exact,
    /// Nothing is lost, invented or moved beyond the bounds.
    Faithful,
    /// A bound is exceeded.
    Changed,
}

/// What of a file a result changed beyond a bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ChangeKind {
    /// Share of the visible surface that is lost.
    Lost,
    /// Share of the surface of the result that the file does not have.
    Invented,
    /// Largest distance between the result and the file, in the unit of the file.
    Moved,
    /// Bodies that are lost as a whole.
    Bodies,
    /// Share by which the volume changed.
    Volume,
}

/// A bound that is exceeded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FidelityChange {
    /// What was measured.
    pub kind: ChangeKind,
    /// How much of it.
    pub measured: f64,
    /// How much a faithful result may have.
    pub limit: f64,
}

/// How true a result is to its file, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct FidelityVerdict {
    /// In a word.
    pub word: Fidelity,
    /// The bounds that are exceeded, worst for a customer first; none unless the word is `Changed`.
    pub changes: Vec<FidelityChange>,
}

impl super::fidelity::FidelityMeasurement {
    /// How true a `result` is to `input` that was measured so.
    pub(super) fn verdict(&self, input: &Soup, result: &Soup) -> FidelityVerdict {
        let moved = self.distance.map_or(0.0, |distance| distance.upper());
        FidelityVerdict::of(&self.losses, moved, size_of_both(diagonal(input), result))
    }

    /// True when a place of `input` is farther from the result than those of a faithful one may be that can be seen.
    pub(super) fn is_far_from(&self, input: &Soup) -> bool {
        self.distance.is_some_and(|distance| distance.forward.upper > MOVED_MAX * diagonal(input))
    }
}

impl FidelityVerdict {
    /// That of the file itself.
    pub(super) const EXACT: Self = Self { word: Fidelity::Exact, changes: Vec::new() };

    /// By what was measured of a result of a file with this `diagonal`. `moved`: the largest distance.
    pub(super) fn of(losses: &Losses, moved: f64, diagonal: f64) -> Self {
        let measured = [
            (ChangeKind::Bodies, f64::from(losses.bodies_lost), 0.0),
            (ChangeKind::Lost, losses.visible_loss, LOSS_MAX),
            (ChangeKind::Invented, losses.invented, INVENTED_MAX),
            (ChangeKind::Moved, moved, MOVED_MAX * diagonal),
            (ChangeKind::Volume, losses.volume_change.map_or(0.0, f64::abs), VOLUME_CHANGE_MAX),
        ];
        let changes: Vec<FidelityChange> = measured
            .into_iter()
            .filter(|&(_, measured, limit)| measured > limit)
            .map(|(kind, measured, limit)| FidelityChange { kind, measured, limit })
            .collect();
        let has_losses = [losses.visible_loss, losses.hidden_area, losses.invented] != [0.0; 3];
        let is_same = moved <= ROUNDING * diagonal && !has_losses;
        let word = match (changes.is_empty(), is_same) {
            (true, true) => Fidelity::Exact,
            (true, false) => Fidelity::Faithful,
            (false, _) => Fidelity::Changed,
        };
        Self { word, changes }
    }

    /// True when a bound is exceeded.
    pub(super) fn is_changed(&self) -> bool {
        self.word == Fidelity::Changed
    }
}

/// Nothing is lost or invented.
pub(super) const NO_LOSSES: Losses = Losses {
    visible_loss: 0.0,
    hidden_area: 0.0,
    invented: 0.0,
    bodies_lost: 0,
    volume_change: None,
    creases_recovered: None,
};

/// Judges `result`, made from `input`; `origins` name the triangle behind each of its own ([`NEW`]: none). What `report`
/// measured is used; what it lacks is measured where it matters, and added.
pub(super) fn judge(
    input: &Soup,
    result: &Soup,
    origins: &[u32],
    report: &mut Report,
    budget: &Budget,
) -> Result<FidelityVerdict, Stopped> {
    if let (Some(distance), Some(losses)) = (&report.distance, &report.losses) {
        let size = size_of_both(diagonal(input), result);
        return Ok(FidelityVerdict::of(losses, distance.upper(), size));
    }
    let volume = defined_volume(report.before.as_ref());
    let (verdict, measured) = judge_alone(input, result, origins, report.distance.as_ref(), volume, budget)?;
    if let Some((distance, losses)) = measured {
        report.losses = Some(losses);
        report.distance = report.distance.or(distance);
    }
    Ok(verdict)
}

/// The size of which moves are shares: the `diagonal` of the input, or that of a result which is less than half as large. A corner that
/// lies far away makes a file so large that moves as large as the rest would not count.
fn size_of_both(diagonal: f64, result: &Soup) -> f64 {
    let after = Aabb::of(result.positions.iter().copied()).diagonal();
    if after < diagonal / 2.0 { after } else { diagonal }
}

/// What was measured for a verdict.
type Measured = (Option<SurfaceDistance>, Losses);

/// Judges a `result` that was not measured, or of which only the `distance` from the input is known; what it tells to be lost is
/// what is beyond [`LOST_BEYOND`].
pub(super) fn judge_alone(
    input: &Soup,
    result: &Soup,
    origins: &[u32],
    distance: Option<&SurfaceDistance>,
    volume: Option<f64>,
    budget: &Budget,
) -> Result<(FidelityVerdict, Option<Measured>), Stopped> {
    let diagonal = diagonal(input);
    let size = size_of_both(diagonal, result);
    let moved = match distance {
        Some(distance) => Some(distance.upper()).filter(|&upper| upper <= LOST_BEYOND * diagonal),
        None => largest_move(input, result, origins, budget)?,
    };
    if let Some(moved) = moved {
        return Ok((FidelityVerdict::of(&NO_LOSSES, moved, size), None));
    }
    let original = Original::with_diagonal(input, volume, None, diagonal);
    let (distance, losses) = match distance.filter(|distance| distance.tells_what_is_lost()) {
        Some(distance) => (Some(*distance), original.losses_at(distance, result, origins, budget)?),
        None => {
            let measured = original.measure(result, origins, budget)?;
            (measured.distance, measured.losses)
        }
    };
    let moved = distance.map_or(0.0, |distance| distance.upper());
    Ok((FidelityVerdict::of(&losses, moved, size), Some((distance, losses))))
}

/// How far the corners of triangles moved, where each triangle of `result` is one of `input` and all that have an area are
/// still there; `None` otherwise. No place of such surfaces is farther from the other than that. Polygons of which something moved
/// may be divided into other triangles.
fn largest_move(
    input: &Soup,
    result: &Soup,
    origins: &[u32],
    budget: &Budget,
) -> Result<Option<f64>, Stopped> {
    budget.stage(Stage::Measure, || {
        let mut stays = vec![false; input.triangles.len()];
        let mut most: f64 = 0.0;
        for (t, &origin) in origins.iter().enumerate().take(result.triangles.len()) {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            if origin == NEW || std::mem::replace(&mut stays[origin as usize], true) {
                return Ok(None);
            }
            most = most.max(move_of(input.corners(origin), result.corners(t as u32)));
        }
        if most > 0.0 && !input.polygons.faces.is_empty() {
            return Ok(None);
        }
        let gone: Vec<u32> = (0..input.triangles.len() as u32).filter(|&t| !stays[t as usize]).collect();
        Ok((area_of(input, &gone) == 0.0).then_some(most))
    })
}

/// The farthest that a corner moved, whichever corner the triangle starts from and whichever way it is wound.
fn move_of([a, b, c]: [DVec3; 3], after: [DVec3; 3]) -> f64 {
    let orders = [[a, b, c], [b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]];
    let farthest = |before: [DVec3; 3]| {
        before.iter().zip(after).map(|(before, after)| before.distance(after)).fold(0.0, f64::max)
    };
    orders.into_iter().map(farthest).fold(f64::INFINITY, f64::min)
}

impl Report {
    /// True when a result is changed, in all or in one of its levels.
    pub(super) fn first_change(&self) -> Option<&FidelityVerdict> {
        let of_levels = self.levels.iter().filter_map(|level| level.fidelity.as_ref());
        self.fidelity.iter().chain(of_levels).find(|fidelity| fidelity.is_changed())
    }

    /// True when there is a result.
    pub(super) fn has_result(&self) -> bool {
        self.outcome.is_some_and(|outcome| outcome != Outcome::Refused)
    }
}

/// The answer, or a refusal where its result is changed.
pub(super) fn demand_faithful(answer: Answer) -> Answer {
    let changes = answer.report.first_change().map(|fidelity| fidelity.changes.clone());
    match changes.filter(|_| answer.report.has_result()) {
        // What was measured stays, so that the report shows what the result would have been.
        Some(changes) => {
            let units = answer.report.input.result_units;
            Report {
                certificate: None,
                after: None,
                levels: Vec::new(),
                identical_triangle_share: None,
                ..answer.report
            }
            .refused(Refusal::NotFaithful { changes, units })
        }
        None => answer,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::{DistanceOptions, Surface, surface_distance};

    fn soup(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Soup {
        let positions = positions.iter().copied().map(DVec3::from).collect();
        Soup { positions, triangles: triangles.to_vec(), ..Soup::default() }
    }

    const SQUARE: [[f64; 3]; 4] = [[0.0; 3], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0], [0.0, 10.0, 0.0]];
    const BOTH: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    fn word(result: &Soup, origins: &[u32]) -> FidelityVerdict {
        judge_alone(&soup(&SQUARE, &BOTH), result, origins, None, None, &Budget::unlimited()).unwrap().0
    }

    #[test]
    fn what_is_turned_or_listed_otherwise_is_exact() {
        let turned = soup(&SQUARE, &[[3, 2, 0], [2, 1, 0]]);
        assert_eq!(word(&turned, &[1, 0]), FidelityVerdict::EXACT);
    }

    #[test]
    fn a_rounding_is_faithful_and_a_move_is_a_change() {
        let moved = |by: f64| {
            let mut positions = SQUARE;
            positions[2][2] = by;
            word(&soup(&positions, &BOTH), &[0, 1])
        };
        assert_eq!(moved(1e-6).word, Fidelity::Faithful);
        let far = moved(1.0);
        assert_eq!(
            (far.word, far.changes.len(), far.changes[0].kind),
            (Fidelity::Changed, 1, ChangeKind::Moved)
        );
        assert!((far.changes[0].limit - 0.01 * 200f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn half_a_square_is_lost() {
        let half = word(&soup(&SQUARE, &[[0, 1, 2]]), &[0]);
        assert_eq!(half.word, Fidelity::Changed);
        let lost = half.changes.iter().find(|change| change.kind == ChangeKind::Lost).unwrap();
        assert!((lost.measured - 0.5).abs() < 0.02, "{}", lost.measured);
    }

    #[test]
    fn a_known_distance_says_what_is_lost_and_one_that_does_not_is_measured_again() {
        let (file, half) = (soup(&SQUARE, &BOTH), soup(&SQUARE, &[[0, 1, 2]]));
        let known = |lost_beyond: Option<f64>| {
            let [from, to] =
                [&file, &half].map(|mesh| Surface { positions: &mesh.positions, triangles: &mesh.triangles });
            let options = DistanceOptions { lost_beyond, ..DistanceOptions::default() };
            surface_distance(from, to, &options, &Budget::unlimited()).unwrap()
        };
        let judged = |distance: Option<SurfaceDistance>| {
            let unlimited = Budget::unlimited();
            judge_alone(&file, &half, &[0], distance.as_ref(), None, &unlimited).unwrap().1.unwrap().1
        };
        let told = judged(known(Some(LOST_BEYOND * diagonal(&file))));
        for losses in [told, judged(known(None)), judged(None)] {
            assert!((losses.visible_loss - 0.5).abs() < 0.02 && losses.invented == 0.0, "{losses:?}");
        }
    }

    #[test]
    fn another_square_beside_it_is_invented_and_a_split_one_is_not() {
        let more = [&SQUARE[..], &[[20.0, 0.0, 0.0], [20.0, 10.0, 0.0]]].concat();
        let invented = word(&soup(&more, &[[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]]), &[0, 1, NEW, NEW]);
        let of = invented.changes.iter().find(|change| change.kind == ChangeKind::Invented).unwrap();
        assert!((of.measured - 0.5).abs() < 0.02, "{}", of.measured);
        // A distance is enclosed between bounds, so that of triangles divided otherwise is at most next to nothing.
        let middle = [&SQUARE[..], &[[5.0, 5.0, 0.0]]].concat();
        let split = word(&soup(&middle, &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]), &[NEW; 4]);
        assert_ne!(split.word, Fidelity::Changed);
    }

    #[test]
    fn bodies_and_volume_count_by_themselves() {
        let of = |losses: Losses| FidelityVerdict::of(&losses, 0.0, 1.0).changes;
        assert_eq!(of(Losses { bodies_lost: 1, ..NO_LOSSES })[0].kind, ChangeKind::Bodies);
        let volume = of(Losses { volume_change: Some(-0.02), ..NO_LOSSES });
        assert_eq!((volume[0].kind, volume[0].measured), (ChangeKind::Volume, 0.02));
        assert!(of(Losses { volume_change: Some(0.01), visible_loss: 0.01, ..NO_LOSSES }).is_empty());
    }

    #[test]
    fn a_result_that_is_far_smaller_than_its_file_is_what_moves_are_shares_of() {
        let of = |far: f64| {
            let positions = [DVec3::ZERO, DVec3::X * far, DVec3::Y * far, DVec3::Z * far].to_vec();
            Soup { positions, triangles: vec![[0, 2, 1], [0, 1, 3]], ..Soup::default() }
        };
        let size = |soup: &Soup| Aabb::of(soup.positions.iter().copied()).diagonal();
        let (file, most, rest) = (of(1e12), of(0.6e12), of(1.0));
        assert_eq!(size_of_both(size(&file), &most), size(&file));
        assert_eq!(size_of_both(size(&file), &rest), size(&rest));
        assert_eq!(size_of_both(size(&rest), &file), size(&rest));
    }
}
