//! Fewer triangles: a manifold from the file, simplified, written and judged at each target.

use super::fidelity::{LOSS_SAMPLES, LOST_BEYOND, Original, defined_volume};
use super::input::Input;
use super::output::{Candidate, NoCandidate, refusal};
use super::plan::Attempt;
use super::seams::Seams;
use super::size::diagonal;
use super::step::Step;
use super::texture::texture_on;
use super::{
    Action, Answer, Failure, FidelityVerdict, Level, Operation, Options, Outcome, Refusal, Report,
    SimplifyChoices, VertexColors, faithful, priority,
};
use crate::budget::{Budget, Stage, Stopped};
use crate::certificate::Depth;
use crate::distance::{DistanceOptions, Surface, SurfaceDistance, surface_distance};
use crate::mesh::Soup;
use crate::repair::Draft;
use crate::repair::cut::CutOptions;
use crate::repair::duplicates::OppositePairs;
use crate::simplify::{
    self, Guards, Mode, Simplified, SimplifyError, SimplifyOptions, SimplifyRefusal, Target,
};
use crate::winding::WindingSolid;

/// What makes a manifold of any mesh, without moving a vertex.
fn manifold() -> [Step; 5] {
    [
        Step::Weld,
        Step::DropDegenerate,
        Step::DropDuplicates(OppositePairs::KeepFirst),
        Step::Orient,
        Step::Cut(CutOptions::default()),
    ]
}

/// Share of the faces that is left when no target is given.
const RATIO_DEFAULT: f64 = 0.5;

/// Simplifies `input`; one file for each target.
pub(super) fn simplify(input: &Input, options: &Options, budget: &Budget) -> Result<Answer, Failure> {
    let report = input.report(Operation::Simplify, budget)?;
    let mut attempt = Attempt::start(&input.soup, report.before.as_ref());
    let _charge = budget.charge(2 * attempt.draft.bytes())?;
    budget.stage(Stage::Repair, || attempt.run(&manifold(), &input.soup, report.before.as_ref(), budget))?;
    let Attempt { draft, actions, .. } = attempt;
    let report = Report { actions, ..report };
    if draft.triangles.is_empty() {
        return Ok(report.refused(Refusal::NothingToRepair));
    }
    let mesh = draft.to_soup(&input.soup);
    let seams = Seams::of(&mesh, &draft, input);
    let results = match run(&mesh, &seams, &options.simplify, budget) {
        Ok(results) => results,
        Err(SimplifyError::Stopped(stopped)) => return Err(stopped.into()),
        Err(SimplifyError::NotManifold(_)) => {
            return Ok(report.refused(Refusal::NotRepairable { witness: None }));
        }
    };
    ResultWriter { input, options, draft: &draft, mesh: &mesh, budget }.answer(results, report)
}

/// Writes results and gives the account of them.
struct ResultWriter<'a> {
    input: &'a Input,
    options: &'a Options,
    draft: &'a Draft,
    mesh: &'a Soup,
    budget: &'a Budget,
}

impl ResultWriter<'_> {
    fn answer(&self, results: Vec<Simplified>, mut report: Report) -> Result<Answer, Failure> {
        let lost_beyond = Some(LOST_BEYOND * diagonal(&self.input.soup));
        let mut first = None;
        let mut others = Vec::new();
        for result in results {
            let candidate = match self.write(&result) {
                Ok(candidate) => candidate,
                Err(reason) => return Ok(report.refused(reason.refusal()?)),
            };
            let certificate = candidate.certificate().clone();
            if let Some(refusal) = refusal(self.options, &certificate) {
                return Ok(report.refused(refusal));
            }
            let distance = distance(self.mesh, candidate.soup(), lost_beyond, self.budget)?;
            // That of the first is judged when it is returned.
            let fidelity = match &first {
                None => None,
                Some(_) => Some(self.fidelity(&candidate, &result, distance.as_ref(), &report)?),
            };
            report.levels.push(Level { simplified: result.report, certificate, distance, fidelity });
            match &first {
                None => first = Some((candidate, result.triangle_origin)),
                Some(_) => others.push(candidate.into_output(self.origins(&result))),
            }
        }
        let Some((candidate, origins)) = first else {
            return Ok(report.refused(Refusal::NothingToRepair));
        };
        report.distance = report.levels[0].distance;
        let origins: Vec<u32> = origins.iter().map(|&t| self.draft.triangle_origin[t as usize]).collect();
        let mut answer =
            candidate.returned(self.input, &origins, report, Outcome::Simplified, self.budget)?;
        answer.report.levels[0].fidelity = answer.report.fidelity.clone();
        Ok(Answer { levels: others, ..answer })
    }

    /// How true a result is to the file: the manifold that was simplified has the same surface.
    fn fidelity(
        &self,
        candidate: &Candidate,
        result: &Simplified,
        distance: Option<&SurfaceDistance>,
        report: &Report,
    ) -> Result<FidelityVerdict, Stopped> {
        let origins = self.origins(result);
        let volume = defined_volume(report.before.as_ref());
        let (input, budget) = (&self.input.soup, self.budget);
        Ok(faithful::judge_alone(
            input,
            candidate.soup(),
            &candidate.origins(&origins),
            distance,
            volume,
            budget,
        )?
        .0)
    }

    /// The input's triangle behind each triangle of a result.
    fn origins(&self, result: &Simplified) -> Vec<u32> {
        result.triangle_origin.iter().map(|&t| self.draft.triangle_origin[t as usize]).collect()
    }

    fn write(&self, result: &Simplified) -> Result<Candidate, NoCandidate> {
        let encoding = self.input.output_encoding(self.options);
        let depth = Depth::Count { samples: self.input.samples };
        Candidate::write(soup_of(result, self.mesh), self.input, encoding, depth, self.budget)
    }
}

/// A certified mesh with fewer triangles, the end of a repair.
pub(super) struct ReducedMesh {
    /// That of the first target.
    candidate: Candidate,
    /// The triangle of the draft that each of its triangles was.
    origins: Vec<u32>,
    /// What was done for the first target.
    action: Action,
    /// One for each target.
    levels: Vec<Level>,
    /// Those of further targets, with the triangles of the draft that theirs were.
    others: Vec<(Candidate, Vec<u32>)>,
}

impl ReducedMesh {
    /// The answer of a repair whose `report` so far is about the certified `draft`, unless a result is farther from the
    /// input than `limits` allow.
    pub(super) fn returned(
        self,
        input: &Input,
        draft: &Draft,
        report: Report,
        outcome: Outcome,
        options: &Options,
        budget: &Budget,
    ) -> Result<Answer, Failure> {
        let Self { candidate, origins, action, mut levels, others } = self;
        let of_input = |origins: &[u32]| -> Vec<u32> {
            origins.iter().map(|&t| draft.triangle_origin[t as usize]).collect()
        };
        let origins = of_input(&origins);
        let volume = defined_volume(report.before.as_ref());
        let solid = budget.stage(Stage::Measure, || {
            WindingSolid::of(&draft.positions, &draft.triangles, options.wrap.open_shells, budget)
        })?;
        let original = Original::new(&input.soup, volume, Some(solid));
        let fidelity = original.measure(candidate.soup(), &candidate.origins(&origins), budget)?;
        for (level, (candidate, origins)) in levels.iter_mut().skip(1).zip(&others) {
            let of_level =
                original.measure(candidate.soup(), &candidate.origins(&of_input(origins)), budget)?;
            level.fidelity = Some(of_level.verdict(&input.soup, candidate.soup()));
        }
        let of_draft = report.distance.map_or(0.0, |distance| distance.upper());
        let actions = [report.actions, vec![action]].concat();
        let (distance, losses) = (fidelity.distance, Some(fidelity.losses));
        let report = Report { actions, levels, distance, losses, ..report };
        // Further results are at most as far as they are from the draft and the draft is from the input.
        let bounds = report.levels.iter().skip(1).filter_map(|level| level.distance);
        let farthest = bounds.map(|distance| distance.upper() + of_draft).fold(0.0, f64::max);
        let exceeded = options.limits.deviation_max.filter(|&limit| farthest > limit);
        // How far the farthest is at least is not known: both distances may be in opposite directions.
        let too_far =
            exceeded.map(|limit| Refusal::DeviationBeyondLimit { deviation: farthest, found: 0.0, limit });
        if let Some(refusal) = fidelity.breach(&options.limits).or(too_far) {
            return Ok(Report { levels: Vec::new(), ..report }.refused(refusal));
        }
        let mut answer = candidate.returned(input, &origins, report, outcome, budget)?;
        answer.report.levels[0].fidelity = answer.report.fidelity.clone();
        let file = |(candidate, origins): (Candidate, Vec<u32>)| candidate.into_output(of_input(&origins));
        Ok(Answer { levels: others.into_iter().map(file).collect(), ..answer })
    }
}

/// The certified mesh of a repair with fewer triangles, for each target, if that is asked for and all stay certified.
pub(super) fn of_certified(
    draft: &Draft,
    input: &Input,
    options: &Options,
    budget: &Budget,
) -> Result<Option<ReducedMesh>, Failure> {
    if options.simplify.targets.is_empty() {
        return Ok(None);
    }
    let mesh = draft.to_soup(&input.soup);
    let guarded = SimplifyChoices { mode: Some(Mode::Guarded), ..options.simplify.clone() };
    let seams = Seams::of(&mesh, draft, input);
    let results = match run(&mesh, &seams, &guarded, budget) {
        Ok(results) => results,
        Err(SimplifyError::Stopped(stopped)) => return Err(stopped.into()),
        Err(SimplifyError::NotManifold(_)) => return Ok(None),
    };
    let encoding = input.output_encoding(options);
    let mut fewer: Option<ReducedMesh> = None;
    for result in results {
        let soup = soup_of(&result, &mesh);
        let candidate = match Candidate::write(soup, input, encoding, Depth::FirstViolation, budget) {
            Ok(candidate) if candidate.certificate().is_printable() => candidate,
            Ok(_) | Err(NoCandidate::Refused(_)) => return Ok(None),
            Err(NoCandidate::Failed(failure)) => return Err(failure),
        };
        let distance = distance(&mesh, candidate.soup(), None, budget)?;
        let level = Level {
            simplified: result.report,
            certificate: candidate.certificate().clone(),
            distance,
            fidelity: None,
        };
        match &mut fewer {
            None => {
                let (action, origins) = (action(&result.report), result.triangle_origin);
                fewer =
                    Some(ReducedMesh { candidate, origins, action, levels: vec![level], others: Vec::new() });
            }
            Some(fewer) => {
                fewer.levels.push(level);
                fewer.others.push((candidate, result.triangle_origin));
            }
        }
    }
    Ok(fewer)
}

/// What a simplification did, as a step of a plan.
pub(super) fn action(report: &simplify::TargetReport) -> Action {
    let refused = SimplifyRefusal::ALL.map(|reason| (reason.name(), report.refusals.count(reason)));
    let counts = [
        ("faces_removed", (report.faces_before - report.faces_after) as u64),
        ("edges_collapsed", report.collapses),
    ];
    Action {
        step: "simplify",
        causes: Vec::new(),
        changes: counts.into_iter().chain(refused).collect(),
        move_max: 0.0,
        reason: if report.is_reached { String::new() } else { "the target was not reached".to_owned() },
        stitches: None,
    }
}

/// Closest points that may be found to enclose a distance more closely, whatever the size of the mesh. On round parts
/// every place is nearly the farthest, and the search would go on everywhere; its bounds hold wherever it ends, and the
/// report has both.
const REFINEMENTS_MIN: u64 = 1 << 18;

/// And one more for so many triangles.
const TRIANGLES_PER_REFINEMENT: u64 = 4;

/// Runs the simplification of a manifold; results in the order of the targets.
fn run(
    mesh: &Soup,
    seams: &Seams,
    choices: &SimplifyChoices,
    budget: &Budget,
) -> Result<Vec<Simplified>, SimplifyError> {
    let targets = match choices.targets.as_slice() {
        [] => vec![Target::Ratio(RATIO_DEFAULT)],
        targets => targets.to_vec(),
    };
    let Seams { groups, points } = seams;
    let _charge = budget.charge((size_of_val(&points[..]) + size_of_val(&groups[..])) as u64)?;
    let input = simplify::SimplifyInput {
        positions: &mesh.positions,
        triangles: &mesh.triangles,
        face_groups: groups,
        vertex_colors: &mesh.vertex_colors,
        texture: points,
    };
    let usual = Guards::default();
    let options = SimplifyOptions {
        guards: Guards {
            normal_cos_min: choices.normal_turn_max.map_or(usual.normal_cos_min, cosine_of_turn),
            ..usual
        },
        criterion: choices.criterion,
        placement: choices.placement,
        priorities: choices.vertex_colors == VertexColors::Priority,
        ..SimplifyOptions::default()
    };
    let mode = choices.mode.unwrap_or(Mode::Guarded);
    let mut by_target = Vec::new();
    for order in finest_first(&targets, mesh.triangles.len()) {
        let targets = order.iter().map(|&i| targets[i]).collect();
        let options = SimplifyOptions { targets, ..options.clone() };
        let results = budget.stage(Stage::Simplify, || simplify::simplify(&input, mode, &options, budget))?;
        by_target.extend(order.into_iter().zip(results));
    }
    by_target.sort_by_key(|&(i, _)| i);
    Ok(by_target.into_iter().map(|(_, result)| result).collect())
}

/// The cosine of an angle in degrees; below all cosines from 180 on, so that rounding refuses no turn.
fn cosine_of_turn(degrees: f64) -> f64 {
    if degrees >= 180.0 { -2.0 } else { libm::cos(degrees.to_radians()) }
}

/// The targets of each run, from the finest to the coarsest: those of counts and those of errors, which cannot be compared before
/// a run. In one run a count could take the mesh past an error that was asked for.
fn finest_first(targets: &[Target], faces: usize) -> Vec<Vec<usize>> {
    let (mut counts, mut errors) = (Vec::new(), Vec::new());
    for (i, target) in targets.iter().enumerate() {
        match *target {
            Target::Faces(count) => counts.push((-(count as f64), i)),
            Target::Ratio(ratio) => counts.push((-ratio * faces as f64, i)),
            Target::Error(error) => errors.push((error, i)),
        }
    }
    let order = |mut run: Vec<(f64, usize)>| {
        run.sort_by(|a, b| a.0.total_cmp(&b.0));
        run.into_iter().map(|(_, i)| i).collect::<Vec<_>>()
    };
    [counts, errors].into_iter().filter(|run| !run.is_empty()).map(order).collect()
}

/// The result with the colours, materials and objects that its faces had in `mesh`, and the texture of its corners.
fn soup_of(result: &Simplified, mesh: &Soup) -> Soup {
    let color = |&t: &u32| mesh.face_colors.get(t as usize).copied().flatten();
    let origins = || result.triangle_origin.iter().map(|&t| Some(t));
    Soup {
        is_f32_exact: result.positions.iter().all(|p| p.as_vec3().as_dvec3() == *p),
        positions: result.positions.clone(),
        triangles: result.triangles.clone(),
        face_count: result.triangles.len() as u32,
        vertex_colors: match result.priorities.is_empty() {
            true => result.vertex_colors.clone(),
            false => priority::colors_of(&result.priorities),
        },
        texture: texture_on(result, mesh),
        materials: mesh.materials.on(origins()),
        objects: mesh.objects.on(origins()),
        face_colors: match mesh.face_colors.is_empty() {
            true => Vec::new(),
            false => result.triangle_origin.iter().map(color).collect(),
        },
        left_out: mesh.left_out.clone(),
        ..Soup::default()
    }
}

/// How far a result, as it was written, is from the `mesh` that it is of. Tells, too, what of both is farther than `lost_beyond` from
/// the other, where there are as many samples as that takes.
fn distance(
    mesh: &Soup,
    result: &Soup,
    lost_beyond: Option<f64>,
    budget: &Budget,
) -> Result<Option<SurfaceDistance>, Stopped> {
    let before = Surface { positions: &mesh.positions, triangles: &mesh.triangles };
    let after = Surface { positions: &result.positions, triangles: &result.triangles };
    // Enough for a mean, and no more than large meshes are worth.
    let most = DistanceOptions::default().samples;
    let samples = (8 * mesh.triangles.len()).clamp(1 << 10, most as usize) as u32;
    let lost_beyond = lost_beyond.filter(|_| samples >= LOSS_SAMPLES);
    let triangles = before.triangles.len().max(after.triangles.len()) as u64;
    let refinements_max = REFINEMENTS_MIN + triangles / TRIANGLES_PER_REFINEMENT;
    let options = DistanceOptions { samples, refinements_max, lost_beyond, ..DistanceOptions::default() };
    budget.stage(Stage::Measure, || surface_distance(before, after, &options, budget))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_are_met_from_the_finest_to_the_coarsest() {
        let order = |targets: &[Target]| finest_first(targets, 1000);
        assert_eq!(order(&[Target::Faces(10), Target::Ratio(0.5), Target::Faces(600)]), [[2, 1, 0]]);
        assert_eq!(order(&[Target::Error(0.2), Target::Error(0.1)]), [[1, 0]]);
        let both = order(&[Target::Error(0.2), Target::Faces(10), Target::Error(0.1)]);
        assert_eq!(both, [vec![1], vec![2, 0]]);
    }

    #[test]
    fn a_turn_of_180_degrees_is_no_limit_and_the_usual_one_is_78() {
        assert!((cosine_of_turn(78.46) - Guards::default().normal_cos_min).abs() < 1e-4);
        assert!(cosine_of_turn(180.0) < -1.0 && cosine_of_turn(0.0) == 1.0);
    }
}
