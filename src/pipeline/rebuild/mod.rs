//! The last rung: a surface rebuilt around what no local edit could make a solid.

mod creases;
mod effort;
mod fewer;
mod filled;
mod parts;

pub use self::effort::Effort;

use self::effort::coarser_than;
use self::fewer::WrapReduction;
use super::fidelity::{FidelityMeasurement, Original, defined_volume};
use super::input::Input;
use super::output::{Candidate, NoCandidate};
use super::plan::{Attempt, Variant};
use super::repair_choices::Choices;
use super::step::Step;
use super::{Action, Answer, Failure, FillHoles, Options, Outcome, Refusal, Report, looks};
use crate::analysis::{Analysis, DefectCode};
use crate::budget::{AsStopped, Budget, Stage, Stopped};
use crate::certificate::Depth;
use crate::figures::figure;
use crate::formats::Encoding;
use crate::geom::{Aabb, DVec3};
use crate::mesh::Soup;
use crate::repair::duplicates::OppositePairs;
use crate::repair::fill::FillOptions;
use crate::repair::nest::{self, NestOptions, NestingPolicy};
use crate::repair::{Draft, NEW, Selection, weld};
use crate::simplify::Mode;
use crate::winding::{OpenShells, WindingSolid};
use crate::wrap::{self, Account, WrapError, WrapOptions, Wrapped};

/// How a broken mesh is rebuilt.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WrapChoices {
    /// How open shells are read.
    pub open_shells: OpenShells,
    /// Cells along the longest side; `None`: by the effort, as many as the area of the surface allows.
    pub cells: Option<u32>,
    /// How fine and so how long to try, where no number of cells is given.
    pub effort: Effort,
    /// Thickness of the walls that sheets become, in the unit of the file; `None`: 0.4 % of the diagonal.
    pub wall: Option<f64>,
    /// A mesh too far from the origin for float32 is moved there.
    pub may_recenter: bool,
}

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

/// A certified mesh, how it came to be, and how far it is from the input.
pub(super) struct Rebuilt {
    candidate: Candidate,
    /// The triangle of the input that each triangle is, or [`NEW`].
    origins: Vec<u32>,
    /// What it is chosen by, with patches over openings in the way.
    pub(super) fidelity: FidelityMeasurement,
    /// Side of a cube of its lattice, in the unit of the file.
    spacing: f64,
    /// What is told of it: nothing of the file is hidden that a straight line leads to.
    as_seen: FidelityMeasurement,
    actions: Vec<Action>,
}

impl Rebuilt {
    pub(super) fn returned(self, input: &Input, report: Report, budget: &Budget) -> Result<Answer, Stopped> {
        let FidelityMeasurement { distance, losses } = self.as_seen;
        let report = Report { actions: self.actions, distance, losses: Some(losses), ..report };
        self.candidate.returned(input, &self.origins, report, Outcome::Rebuilt, budget)
    }
}

/// Rebuilds `input`, ever finer until a result passes; the best one there is.
///
/// # Errors
/// When there is none, or the budget stops the run.
pub(super) fn rebuild(
    input: &Input,
    encoding: Encoding,
    options: &Options,
    choices: &Choices,
    before: Option<&Analysis>,
    budget: &Budget,
) -> Result<Rebuilt, NotRebuilt> {
    let start = Attempt::start(&input.soup, before);
    let _charge = budget.charge(2 * start.draft.bytes())?;
    let variant = Variant { opposite: OppositePairs::KeepFirst, ..Variant::default() };
    let mend = || {
        let mut attempt = start.clone();
        attempt.run(&variant.mending(&choices.before_rebuilding()), &input.soup, before, budget)?;
        // A hole in a sheet is a part of its shape; one in a shell around a volume is a defect.
        let fill =
            options.fill_holes == FillHoles::Simple && !is_mostly_sheets(&attempt.draft, options, budget)?;
        let steps = fill
            .then_some(Step::FillHoles(FillOptions::plain(Selection::default())))
            .into_iter()
            .chain([Step::JoinCopies]);
        attempt.run(&steps.collect::<Vec<_>>(), &input.soup, before, budget)?;
        Ok::<_, Stopped>(attempt)
    };
    let Attempt { draft, actions, .. } =
        budget.stage(Stage::Repair, || match budget.within_part(4, mend)? {
            Some(attempt) => Ok::<_, Stopped>(attempt),
            // The lattice takes the triangles as they are.
            None => {
                let mut attempt = start.clone();
                let steps = variant.welding(&choices.before_rebuilding());
                attempt.run(&[steps, vec![Step::JoinCopies]].concat(), &input.soup, before, budget)?;
                Ok(attempt)
            }
        })?;
    let search = LatticeSearch { input, encoding, options, before, budget };
    match search.run(&input.soup, &draft, &actions) {
        Err(NotRebuilt::Refused { refusal: Refusal::BeyondFloat32 { .. }, .. })
            if options.wrap.may_recenter =>
        {
            let center = middle(&draft);
            let soup = Soup { positions: moved(&input.soup.positions, center), ..input.soup.clone() };
            let draft = Draft { positions: moved(&draft.positions, center), ..draft };
            search.run(&soup, &draft, &[actions, vec![recentered(center, draft.positions.len())]].concat())
        }
        found => found,
    }
}

/// The search for a lattice whose result is close enough.
struct LatticeSearch<'a> {
    input: &'a Input,
    encoding: Encoding,
    options: &'a Options,
    before: Option<&'a Analysis>,
    budget: &'a Budget,
}

impl LatticeSearch<'_> {
    /// Tries ever finer lattices for a draft made of `soup` by `actions`.
    fn run(&self, soup: &Soup, draft: &Draft, actions: &[Action]) -> Result<Rebuilt, NotRebuilt> {
        let (choices, limits, budget) = (&self.options.wrap, &self.options.limits, self.budget);
        let refused = |refusal| NotRebuilt::Refused { refusal, actions: actions.to_vec() };
        let split =
            budget.within_part(4, || budget.stage(Stage::Repair, || parts::split(draft, budget)))?.flatten();
        // Where it is too much work to say what is hidden, everything counts as seen.
        let solid = budget.within_part(4, || {
            budget.stage(Stage::Measure, || {
                WindingSolid::of(&draft.positions, &draft.triangles, choices.open_shells, budget)
            })
        })?;
        let volume = defined_volume(self.before);
        let original = Original::new(soup, volume, solid);
        let looks = budget.stage(Stage::Repair, || looks::AppearanceSource::of(soup, budget))?;
        let asked = choices.cells.map(|cells| [(cells, f64::INFINITY)]);
        let mut lattices: &[(u32, f64)] = match &asked {
            Some(one) => one,
            None => choices.effort.lattices(),
        };
        let mut best: Option<Rebuilt> = None;
        let (mut cells_before, mut is_coarser) = (0, false);
        while let Some((&(cells, area_max), finer)) = lattices.split_first() {
            lattices = finer;
            let wrap_options = WrapOptions {
                cells,
                open_shells: choices.open_shells,
                wall: choices.wall,
                area_max,
                ..WrapOptions::default()
            };
            let (input, encoding, options) = (self.input, self.encoding, self.options);
            // Beside a smaller result, one whose triangles are too many to simplify is too much.
            let must_simplify = best.is_some();
            let (source, looks) = (soup, looks.as_ref());
            let rebuilding =
                Rebuilding { input, source, looks, encoding, options, wrap_options, must_simplify, budget };
            let made = match budget.within_all_but(4, || rebuilding.run(draft, split.as_ref())) {
                Ok(Some(made)) => made,
                // Finer was too much; what there is stays.
                Ok(None) | Err(NoCandidate::Refused(_)) if best.is_some() => break,
                Ok(None) if asked.is_some() => break,
                Ok(None) => {
                    (lattices, is_coarser) = (coarser_than(cells), true);
                    continue;
                }
                Err(NoCandidate::Refused(refusal)) => return Err(refused(refusal)),
                Err(NoCandidate::Failed(failure)) => return Err(failure.into()),
            };
            // The limits of the lattice allow no finer one.
            if made.account.cells <= cells_before && best.is_some() {
                break;
            }
            cells_before = made.account.cells;
            let fidelity =
                original.measure(made.candidate.soup(), &made.candidate.origins(&made.origins), budget)?;
            let is_better = |best: &Rebuilt| !best.fidelity.is_no_worse(&fidelity, limits);
            if best.as_ref().is_none_or(is_better) {
                let wrap = action(&made, choices.open_shells, self.before);
                let actions = actions.iter().cloned().chain([wrap]).chain(made.simplified).collect();
                let RebuiltMesh { candidate, origins, account, .. } = made;
                let spacing = account.spacing;
                best = Some(Rebuilt { candidate, origins, fidelity, spacing, as_seen: fidelity, actions });
            }
            if fidelity.passes(limits) || is_coarser {
                break;
            }
        }
        let mut best = best.ok_or_else(|| refused(Refusal::OverBudget { units: budget.work_used() }))?;
        let creases = creases::recovered(&original, best.candidate.soup(), best.spacing, budget)?;
        // What is inside of the outermost shells goes as chosen.
        let fills = self.options.nesting == NestingPolicy::Fill;
        let is_open = !fills && self.before.is_none_or(|before| before.counts.boundary_edges > 0);
        if is_open && best.fidelity.losses.hidden_area > 0.0 {
            let (made, origins) = (best.candidate.soup(), best.candidate.origins(&best.origins));
            let look = || original.with_outlook(budget)?.measure(made, &origins, budget);
            // Where it is too much work, patches stay in the way.
            if let Some(as_seen) = budget.within_part(4, look)? {
                best.as_seen = as_seen;
                best.fidelity = best.fidelity.to_choose_by(as_seen, best.fidelity.losses.invented, limits);
            }
        }
        best.as_seen.losses.creases_recovered = creases;
        match best.as_seen.breach(limits) {
            None => Ok(best),
            Some(refusal) => Err(NotRebuilt::Refused { refusal, actions: best.actions }),
        }
    }
}

/// Whether most of the open surface of `draft` is read as sheets.
pub(super) fn is_mostly_sheets(draft: &Draft, options: &Options, budget: &Budget) -> Result<bool, Stopped> {
    let mut welded = draft.clone();
    weld::weld(&mut welded, budget)?;
    let solid = WindingSolid::of(&welded.positions, &welded.triangles, options.wrap.open_shells, budget)?;
    Ok(solid.is_mostly_sheets())
}

/// The middle of a mesh, rounded so that small coordinates stay exact.
fn middle(draft: &Draft) -> DVec3 {
    let bounds = Aabb::of(draft.triangles.as_flattened().iter().map(|&v| draft.positions[v as usize]));
    (bounds.min / 2.0 + bounds.max / 2.0).round()
}

/// `positions` as seen from `center`.
fn moved(positions: &[DVec3], center: DVec3) -> Vec<DVec3> {
    positions.iter().map(|&p| p - center).collect()
}

/// The step that moved everything to the origin.
fn recentered(center: DVec3, vertices: usize) -> Action {
    Action {
        step: "recenter",
        causes: Vec::new(),
        changes: vec![("vertices_moved", vertices as u64)],
        move_max: center.length(),
        reason: format!(
            "moved by [{}] as allowed: float32 is too coarse where it was; distances do not count this",
            (DVec3::ZERO - center).to_array().map(|x| x.to_string()).join(", ")
        ),
        stitches: None,
    }
}

/// Why nothing was rebuilt.
pub(super) enum NotRebuilt {
    /// With the steps that ran.
    Refused {
        refusal: Refusal,
        actions: Vec<Action>,
    },
    Failed(Failure),
}

impl NotRebuilt {
    /// Why it is refused, with the steps that ran.
    ///
    /// # Errors
    /// The failure, where it is one.
    pub(super) fn refusal(self) -> Result<(Refusal, Vec<Action>), Failure> {
        match self {
            Self::Refused { refusal, actions } => Ok((refusal, actions)),
            Self::Failed(failure) => Err(failure),
        }
    }
}

impl AsStopped for NotRebuilt {
    fn as_stopped(&self) -> Option<Stopped> {
        match self {
            Self::Failed(failure) => failure.as_stopped(),
            Self::Refused { .. } => None,
        }
    }
}

impl<E: Into<Failure>> From<E> for NotRebuilt {
    fn from(error: E) -> Self {
        Self::Failed(error.into())
    }
}

/// A certified mesh, and how it came to be.
struct RebuiltMesh {
    candidate: Candidate,
    /// The triangle of the input that each triangle is, or [`NEW`].
    origins: Vec<u32>,
    account: Account,
    simplified: Option<Action>,
}

/// What every attempt to rebuild needs.
struct Rebuilding<'a> {
    input: &'a Input,
    /// The mesh of the input, where it is rebuilt.
    source: &'a Soup,
    /// What a new surface takes over.
    looks: Option<&'a looks::AppearanceSource<'a>>,
    encoding: Encoding,
    options: &'a Options,
    wrap_options: WrapOptions,
    /// A surface that is too much work to simplify is no result.
    must_simplify: bool,
    budget: &'a Budget,
}

impl Rebuilding<'_> {
    /// Beside the parts that can keep their bits, or without them.
    fn run(&self, draft: &Draft, split: Option<&parts::SplitMesh>) -> Result<RebuiltMesh, NoCandidate> {
        match split.map(|split| self.beside(split)) {
            None | Some(Err(NoCandidate::Refused(_))) => self.all(draft),
            Some(made) => made,
        }
    }

    /// Everything is rebuilt.
    fn all(&self, draft: &Draft) -> Result<RebuiltMesh, NoCandidate> {
        let wrapped = self.wrap(draft)?;
        self.certified(&wrapped, &Draft::default())
    }

    /// Some parts keep their bits.
    fn beside(&self, split: &parts::SplitMesh) -> Result<RebuiltMesh, NoCandidate> {
        let mut kept = split.kept.clone();
        let nesting =
            NestOptions { policy: self.options.nesting, is_embedded: true, ..NestOptions::default() };
        nest::nest(&mut kept, &nesting, self.budget)?;
        let wrapped = self.wrap(&split.broken)?;
        self.certified(&wrapped, &kept)
    }

    fn wrap(&self, draft: &Draft) -> Result<Wrapped, NoCandidate> {
        let options = &self.wrap_options;
        let wrap = || {
            let wrapped = wrap::wrap(&draft.positions, &draft.triangles, options, self.budget)?;
            match self.options.nesting {
                NestingPolicy::Fill => Ok(filled::filled(wrapped, self.budget)?),
                NestingPolicy::AsOriented | NestingPolicy::Alternate => Ok(wrapped),
            }
        };
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
    fn certified(&self, wrapped: &Wrapped, kept: &Draft) -> Result<RebuiltMesh, NoCandidate> {
        let origins = |count: usize| {
            kept.triangle_origin.iter().copied().chain(std::iter::repeat_n(NEW, count)).collect()
        };
        let account = wrapped.account;
        let fewer = WrapReduction { wrapped, choices: &self.options.simplify, budget: self.budget };
        for mode in [Mode::Fast, Mode::Guarded] {
            // What takes too much work keeps its triangles, all of which are judged and measured then: that is dear too.
            let Some(found) = self.budget.within_all_but(5, || fewer.triangles(mode))? else {
                if self.must_simplify {
                    let units = self.budget.work_used();
                    return Err(NoCandidate::Refused(Refusal::OverBudget { units }));
                }
                break;
            };
            let Some((simplified, action)) = found else { continue };
            let candidate = self.write(&simplified.positions, &simplified.triangles, kept)?;
            if candidate.certificate().is_printable() {
                let origins = origins(simplified.triangles.len());
                return Ok(RebuiltMesh { candidate, origins, account, simplified: Some(action) });
            }
        }
        let mut witness = None;
        for positions in [&wrapped.positions, &wrapped.unfitted] {
            let candidate = self.write(positions, &wrapped.triangles, kept)?;
            if candidate.certificate().is_printable() {
                let origins = origins(wrapped.triangles.len());
                return Ok(RebuiltMesh { candidate, origins, account, simplified: None });
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
        let mut soup = kept.to_soup(self.source);
        soup.add_plain(positions, triangles);
        if let Some(looks) = self.looks {
            let put_on = || looks.put_on(&mut soup, positions.len(), triangles.len(), self.budget);
            self.budget.stage(Stage::Repair, put_on)?;
        }
        Candidate::write(soup, self.input, self.encoding, Depth::FirstViolation, self.budget)
    }
}

/// The wrap as a step of the plan, with the reading that it took.
fn action(made: &RebuiltMesh, open_shells: OpenShells, before: Option<&Analysis>) -> Action {
    let account = &made.account;
    let kept = made.origins.iter().filter(|&&origin| origin != NEW).count() as u64;
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
            ("crumbs_dropped", u64::from(account.own.crumbs_dropped)),
            ("bubbles_opened", u64::from(account.own.bubbles_opened)),
            ("bubbles_filled", u64::from(account.own.bubbles_filled)),
            ("tunnels_closed", u64::from(account.own.tunnels_closed)),
            ("bridges_cut", u64::from(account.own.bridges_cut)),
            ("vertices_fitted", account.fit.moved),
            ("vertices_on_creases", account.fit.onto_creases),
            ("fits_taken_back", account.fit.taken_back),
        ],
        move_max: 0.0,
        reason: reason(account, open_shells),
        stitches: None,
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
    let walls = match account.sheet_parts {
        0 => String::new(),
        _ => format!(", with walls of {}", figure(account.wall)),
    };
    format!(
        "rebuilt on a lattice with a spacing of {}; read as {reading}{walls}: {why} (confidence {confidence:.2})",
        figure(account.spacing)
    )
}
