//! The last rung: a surface rebuilt around what no local edit could make a solid.

mod parts;

use super::input::Input;
use super::output::{Candidate, NoCandidate};
use super::plan::{Attempt, Step, Variant};
use super::{Action, Answer, Failure, Options, Outcome, Refusal, Report};
use crate::analysis::DefectCode;
use crate::budget::{Budget, Stage, Stopped};
use crate::certificate::Depth;
use crate::distance::{DistanceOptions, Surface, SurfaceDistance, surface_distance};
use crate::formats::Encoding;
use crate::geom::DVec3;
use crate::mesh::Soup;
use crate::repair::duplicates::OppositePairs;
use crate::repair::{Draft, NEW, nest};
use crate::simplify::{self, Mode, Simplified, SimplifyError, SimplifyOptions, Target};
use crate::wrap::{self, Account, OpenShells, WrapError, WrapOptions, Wrapped};

/// How a broken mesh is rebuilt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WrapChoices {
    /// How open shells are read.
    pub open_shells: OpenShells,
    /// Cells along the longest side; `None`: up to 256, as many as the area of the surface allows.
    pub cells: Option<u32>,
}

/// Collapses of a rebuilt surface have errors up to this share of a cell, unless the caller has targets: what can be
/// seen comes from the lattice's cells, and flat faces need few triangles.
const ERROR_OF_CELL: f64 = 0.05;

/// What the distance of a rebuilt surface from its input may cost, and how close it is enclosed.
const DISTANCE: DistanceOptions = DistanceOptions {
    tolerance_relative: 0.05,
    tolerance_of_diagonal: 1e-5,
    samples: 1 << 14,
    refinements_max: 1 << 21,
};

/// Defects that lead here when no step cures them.
const CAUSES: [DefectCode; 9] = [
    DefectCode::BoundaryLoop,
    DefectCode::NonManifoldEdge,
    DefectCode::NonManifoldVertex,
    DefectCode::OrientationConflict,
    DefectCode::NonOrientable,
    DefectCode::SelfIntersection,
    DefectCode::Overlap,
    DefectCode::Touch,
    DefectCode::MisnestedShell,
];

/// Rebuilds `input`; `report` is the account so far, without actions.
pub(super) fn rebuild(
    input: &Input,
    encoding: Encoding,
    options: &Options,
    report: Report,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let before = report.before.clone();
    let mut attempt = Attempt::start(&input.soup, before.as_ref());
    let _charge = budget.charge(attempt.draft.bytes())?;
    let variant = Variant { opposite: OppositePairs::KeepFirst, ..Variant::default() };
    let steps: Vec<Step> =
        variant.mending(options.fill_holes).into_iter().chain([Step::JoinCopies]).collect();
    budget.stage(Stage::Repair, || attempt.run(&steps, &input.soup, before.as_ref(), budget))?;
    let choices = options.wrap;
    let wrap_options = WrapOptions {
        cells: choices.cells.unwrap_or(WrapOptions::default().cells),
        open_shells: choices.open_shells,
        // Who asks for a number of cells gets it.
        area_max: choices.cells.map_or(WrapOptions::default().area_max, |_| f64::INFINITY),
        ..WrapOptions::default()
    };
    let rebuilding = Rebuilding { input, encoding, options, wrap_options, budget };
    let split = budget.stage(Stage::Repair, || parts::split(&attempt.draft, budget))?;
    let mut rebuilt = None;
    if let Some(split) = split {
        rebuilt = match rebuilding.beside(split) {
            Ok(rebuilt) => Some(rebuilt),
            // Not with these parts kept; without them then.
            Err(NoCandidate::Refused(_)) => None,
            Err(NoCandidate::Failed(failure)) => return Err(failure),
        };
    }
    let rebuilt = match rebuilt.map_or_else(|| rebuilding.all(&attempt.draft), Ok) {
        Ok(rebuilt) => rebuilt,
        Err(NoCandidate::Refused(refusal)) => {
            return Ok(Report { actions: attempt.actions, ..report }.refused(refusal));
        }
        Err(NoCandidate::Failed(failure)) => return Err(failure),
    };
    let mut actions = attempt.actions;
    actions.push(action(&rebuilt, choices.open_shells, before.as_ref()));
    actions.extend(rebuilt.simplified);
    let distance = distance(input, rebuilt.candidate.soup(), budget)?;
    let report = Report { actions, distance, ..report };
    Ok(rebuilt.candidate.returned(input, &rebuilt.origins, report, Outcome::Rebuilt, budget)?)
}

/// A certified mesh, and how it came to be.
struct Rebuilt {
    candidate: Candidate,
    /// The triangle of the input that each triangle is, or [`NEW`].
    origins: Vec<u32>,
    account: Account,
    simplified: Option<Action>,
}

/// What every attempt to rebuild needs.
struct Rebuilding<'a> {
    input: &'a Input,
    encoding: Encoding,
    options: &'a Options,
    wrap_options: WrapOptions,
    budget: &'a Budget,
}

impl Rebuilding<'_> {
    /// Everything is rebuilt.
    fn all(&self, draft: &Draft) -> Result<Rebuilt, NoCandidate> {
        let wrapped = self.wrap(draft)?;
        self.certified(&wrapped, &Draft::default())
    }

    /// Some parts keep their bits.
    fn beside(&self, split: parts::Split) -> Result<Rebuilt, NoCandidate> {
        let parts::Split { mut kept, broken } = split;
        nest::nest(&mut kept, true, self.budget)?;
        let wrapped = self.wrap(&broken)?;
        self.certified(&wrapped, &kept)
    }

    fn wrap(&self, draft: &Draft) -> Result<Wrapped, NoCandidate> {
        let options = &self.wrap_options;
        let wrap = || wrap::wrap(&draft.positions, &draft.triangles, options, self.budget);
        self.budget.stage(Stage::Repair, wrap).map_err(|error| match error {
            WrapError::Stopped(stopped) => stopped.into(),
            WrapError::Empty => NoCandidate::Refused(Refusal::NothingToRepair),
            WrapError::NotRepresentable(coarse) => NoCandidate::Refused(Refusal::BeyondFloat32 {
                pitch: coarse.pitch,
                diagonal: coarse.diagonal,
            }),
        })
    }

    /// The first of the simplified, the fitted and the bare surface whose bytes are certified, beside `kept`.
    fn certified(&self, wrapped: &Wrapped, kept: &Draft) -> Result<Rebuilt, NoCandidate> {
        let origins = |count: usize| {
            kept.triangle_origin.iter().copied().chain(std::iter::repeat_n(NEW, count)).collect()
        };
        let account = wrapped.account;
        if let Some((simplified, action)) = simplified(wrapped, self.options, self.budget)? {
            let candidate = self.write(&simplified.positions, &simplified.triangles, kept)?;
            if candidate.certificate().is_printable() {
                let origins = origins(simplified.triangles.len());
                return Ok(Rebuilt { candidate, origins, account, simplified: Some(action) });
            }
        }
        let mut witness = None;
        for positions in [&wrapped.positions, &wrapped.unfitted] {
            let candidate = self.write(positions, &wrapped.triangles, kept)?;
            if candidate.certificate().is_printable() {
                let origins = origins(wrapped.triangles.len());
                return Ok(Rebuilt { candidate, origins, account, simplified: None });
            }
            witness = candidate.certificate().witnesses.first().cloned();
        }
        Err(NoCandidate::Refused(Refusal::NotRepairable { witness }))
    }

    fn write(
        &self,
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        kept: &Draft,
    ) -> Result<Candidate, NoCandidate> {
        let mut soup = kept.to_soup(&self.input.soup);
        let base = soup.positions.len() as u32;
        soup.positions.extend(positions);
        soup.triangles.extend(triangles.iter().map(|t| t.map(|v| v + base)));
        soup.face_count = soup.triangles.len() as u32;
        // What is new has no colour.
        if !soup.vertex_colors.is_empty() {
            soup.vertex_colors.resize(soup.positions.len(), None);
        }
        if !soup.face_colors.is_empty() {
            soup.face_colors.resize(soup.triangles.len(), None);
        }
        Candidate::write(soup, self.encoding, Depth::FirstViolation, self.budget)
    }
}

/// The surface with fewer triangles: to the caller's first target, or as far as it does not show.
fn simplified(
    wrapped: &Wrapped,
    options: &Options,
    budget: &Budget,
) -> Result<Option<(Simplified, Action)>, Stopped> {
    let input = simplify::Input {
        positions: &wrapped.positions,
        triangles: &wrapped.triangles,
        face_groups: &[],
        vertex_colors: &[],
        texture: &[],
    };
    let choices = &options.simplify;
    let target = choices.targets.first().copied();
    let settings = SimplifyOptions {
        targets: vec![target.unwrap_or(Target::Error(wrapped.account.spacing * ERROR_OF_CELL))],
        criterion: choices.criterion,
        placement: choices.placement,
        ..SimplifyOptions::default()
    };
    let results =
        budget.stage(Stage::Simplify, || simplify::simplify(&input, Mode::Guarded, &settings, budget));
    match results {
        Ok(results) => Ok(results.into_iter().next().map(|result| {
            let action = super::simplify::action(&result.report);
            (result, action)
        })),
        Err(SimplifyError::Stopped(stopped)) => Err(stopped),
        Err(SimplifyError::NotManifold(_)) => Ok(None),
    }
}

fn distance(input: &Input, result: &Soup, budget: &Budget) -> Result<Option<SurfaceDistance>, Stopped> {
    let (draft, _) = Draft::from_soup(&input.soup);
    let before = Surface { positions: &draft.positions, triangles: &draft.triangles };
    let after = Surface { positions: &result.positions, triangles: &result.triangles };
    budget.stage(Stage::Measure, || surface_distance(before, after, &DISTANCE, budget))
}

/// The wrap as a step of the plan, with the reading that it took.
fn action(rebuilt: &Rebuilt, open_shells: OpenShells, before: Option<&crate::analysis::Analysis>) -> Action {
    let account = &rebuilt.account;
    let kept = rebuilt.origins.iter().filter(|&&origin| origin != NEW).count() as u64;
    let findings = before.map_or(&[][..], |analysis| &analysis.findings);
    let has = |code: &DefectCode| findings.iter().any(|f| f.code == *code && f.count > 0);
    Action {
        step: "wrap",
        causes: CAUSES.into_iter().filter(has).collect(),
        changes: vec![
            ("cells", u64::from(account.cells)),
            ("triangles_kept", kept),
            ("closed_parts", u64::from(account.closed_parts)),
            ("open_parts_closed", u64::from(account.open_parts)),
            ("sheets_thickened", u64::from(account.sheet_parts)),
            ("thin_wall_triangles", account.thin_triangles),
            ("vertices_fitted", account.fit.moved),
            ("vertices_on_creases", account.fit.onto_creases),
            ("fits_taken_back", account.fit.taken_back),
        ],
        move_max: 0.0,
        reason: reason(account, open_shells),
    }
}

fn reason(account: &Account, open_shells: OpenShells) -> String {
    let reading = match (account.open_parts, account.sheet_parts) {
        (_, 0) => "solid",
        (0, _) if account.closed_parts == 0 => "sheet",
        _ => "solid, with sheets",
    };
    let why = match (open_shells, account.closedness) {
        (_, None) => "every part is closed".to_owned(),
        (OpenShells::Close, _) => "open shells are closed as asked".to_owned(),
        (OpenShells::Thicken, _) => "open shells are thickened as asked".to_owned(),
        (OpenShells::Auto, Some(closedness)) => {
            format!("open shells bound a volume to {:.0} %", closedness * 100.0)
        }
    };
    // The decision is at a half; the farther, the surer.
    let confidence = account.closedness.map_or(1.0, |closedness| (2.0 * closedness - 1.0).abs());
    format!(
        "rebuilt on a lattice with a spacing of {:e}; read as {reading}: {why} (confidence {confidence:.2})",
        account.spacing
    )
}
