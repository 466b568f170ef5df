//! The account of a file out of those of its parts.

use super::merged_analysis::merged_analysis;
use super::{FinishedPart, PartFacts, PartReport};
use crate::distance::{DirectedDistance, SurfaceDistance};
use crate::formats::threemf::{Body, NO_NUMBER, Project, Property};
use crate::formats::{Encoding, Format};
use crate::pipeline::fidelity::defined_volume;
use crate::pipeline::{
    Action, Fidelity, FidelityVerdict, Filling, HoleOutcome, Level, Losses, Operation, Outcome,
    PrintingReport, Report,
};
use crate::simplify;

/// The account of all parts, with so many `samples` of each defect; `whole` says what is known of the file.
pub(super) fn merged(project: &Project, done: &[FinishedPart], whole: Report, samples: usize) -> Report {
    let remarks = remarks(project, done);
    let parts = parts(project, done);
    let reports: Vec<&Report> = parts.iter().map(|part| &part.report).collect();
    let triangles = |report: &Report| report.input_certificate.triangles as f64;
    let merged = match reports[..] {
        [] => whole,
        // Of one part all is told.
        [only] => Report {
            operation: whole.operation,
            input: whole.input,
            input_certificate: whole.input_certificate,
            ..only.clone()
        },
        _ => Report {
            before: merged_analysis(&parts, samples, |report| report.before.as_ref()),
            plan: None,
            actions: actions(&reports),
            levels: levels(&reports),
            after: after(&parts, samples),
            identical_triangle_share: mean(&reports, triangles, |report| report.identical_triangle_share),
            distance: distance(&reports),
            losses: losses(&reports),
            fidelity: fidelity(&reports),
            outcome: outcome(&reports, whole.operation),
            printing: printing(&reports),
            ..whole
        },
    };
    let filling = filling(&reports);
    Report { parts, remarks, filling, ..merged }
}

fn parts(project: &Project, done: &[FinishedPart]) -> Vec<PartReport> {
    let mut first_face = 0;
    done.iter()
        .map(|done| {
            let body = &project.bodies[done.body];
            let facts = PartFacts {
                path: body.part.clone(),
                object: body.object,
                name: body.name.clone(),
                volume: body.volume,
                instances: body.instances,
                first_face,
            };
            first_face += body.soup.face_count;
            PartReport { facts, report: done.answer.report.clone(), attributes: done.attributes }
        })
        .collect()
}

/// What is said of the file, and of what is not a part or is lost with one.
fn remarks(project: &Project, done: &[FinishedPart]) -> Vec<String> {
    let mut remarks = project.remarks.clone();
    for body in project.bodies.iter().filter(|body| !body.is_solid()) {
        let why = match (super::is_model(body) || body.kind.is_solid(), body.extras.is_empty()) {
            (true, true) => "has no triangle",
            (true, false) => "has no triangle beside its lattice",
            _ => "is a support or a surface, which need not be a solid",
        };
        remarks.push(format!("The object {} of {} {why}: it is kept as it is.", body.object, body.part));
    }
    for done in done {
        let body = &project.bodies[done.body];
        let is_remade = done.answer.output.as_ref().is_some_and(|output| output.bytes.is_some());
        if is_remade && !body.extras.is_empty() {
            remarks.push(format!(
                "The object {} of {} has a new mesh; what spoke of the old one by number is left out: {}.",
                body.object,
                body.part,
                body.extras.join(", ")
            ));
        }
    }
    remarks
}

/// What is said where all parts become one mesh of this encoding: which of the project that leaves out.
pub(super) fn left_out(project: &Project, encoding: Encoding) -> Vec<String> {
    let bodies = &project.bodies;
    let count = |of: &dyn Fn(&Body) -> usize| bodies.iter().map(of).sum::<usize>();
    let names = bodies.iter().filter(|body| !body.name.is_empty()).count();
    let places = count(&|body| body.instances as usize);
    let is_stated = |property: &&Property| **property != Property::NONE;
    let properties = count(&|body| body.attributes.properties.iter().filter(is_stated).count());
    let marks = count(&|body| body.attributes.others.iter().filter(|&&number| number != NO_NUMBER).count());
    let has_colors = !matches!(encoding.format(), Format::Obj | Format::Stl);
    let of_properties = if has_colors { "textures and materials" } else { "colours, textures and materials" };
    // Others hold each part at its place as an object with its name.
    let has_objects = matches!(encoding.format(), Format::Obj | Format::Glb | Format::Gltf);
    let (names, further_places) = if has_objects { (0, 0) } else { (names, places.saturating_sub(1)) };
    let lost = [
        (names, format!("names of parts ({names})")),
        (further_places, format!("places of parts ({places})")),
        (properties, format!("{of_properties} that {properties} triangles state")),
        (marks, format!("paint and other marks of {marks} triangles")),
        (1, "what it holds beside meshes, such as pictures, metadata and settings".to_owned()),
    ];
    let lost: Vec<String> = lost.into_iter().filter(|(count, _)| *count > 0).map(|(_, text)| text).collect();
    let text = format!("One mesh takes the place of the project, which leaves out: {}.", lost.join("; "));
    project.remarks.iter().cloned().chain([text]).collect()
}

/// One for each step, with the sums of what it changed.
fn actions(reports: &[&Report]) -> Vec<Action> {
    let mut all: Vec<Action> = Vec::new();
    for action in reports.iter().flat_map(|report| &report.actions) {
        let Some(known) = all.iter_mut().find(|known| known.step == action.step) else {
            all.push(Action { stitches: None, ..action.clone() });
            continue;
        };
        for &(name, count) in &action.changes {
            match known.changes.iter_mut().find(|(known, _)| *known == name) {
                Some((_, sum)) => *sum += count,
                None => known.changes.push((name, count)),
            }
        }
        known.causes.extend(action.causes.iter().copied());
        known.causes.sort_unstable();
        known.causes.dedup();
        known.move_max = known.move_max.max(action.move_max);
        if known.reason != action.reason {
            known.reason = "it differs from part to part; see the parts".to_owned();
        }
    }
    all
}

/// The mean of a figure over the parts that have it, by their sizes.
fn mean(
    reports: &[&Report],
    size: impl Fn(&Report) -> f64,
    of: impl Fn(&Report) -> Option<f64>,
) -> Option<f64> {
    let known = reports.iter().filter_map(|report| Some((size(report), of(report)?)));
    let (sizes, sum) =
        known.fold((0.0, 0.0), |(sizes, sum), (size, value)| (sizes + size, sum + size * value));
    let is_known = reports.iter().any(|report| of(report).is_some());
    is_known.then_some(if sizes > 0.0 { sum / sizes } else { 1.0 })
}

/// The account of two runs, of which the second was on the result of the first, if that `has_changed` the file.
pub(super) fn in_turn(first: Report, second: Report, has_changed: bool) -> Report {
    let both = Report {
        parts: first.parts.clone(),
        input: first.input.clone(),
        input_certificate: first.input_certificate.clone(),
        ..second
    };
    if !has_changed {
        return both;
    }
    let of_both = [&first, &both];
    let (outcome, fidelity) = (outcome(&of_both, both.operation), fidelity(&of_both));
    // What was measured of the second run is from its own input, so that it says something of the file only where the second
    // run changed nothing.
    let is_kept = both.outcome == Some(Outcome::Identical);
    let actions = first.actions.into_iter().chain(both.actions).collect();
    Report {
        outcome,
        fidelity: fidelity.filter(|_| both.certificate.is_some()),
        actions,
        after: both.after.or(both.before),
        before: first.before,
        plan: None,
        identical_triangle_share: first.identical_triangle_share.filter(|_| is_kept),
        distance: first.distance.filter(|_| is_kept),
        losses: first.losses.filter(|_| is_kept),
        ..both
    }
}

/// The mesh as returned: parts that kept their bytes are as they were. `None`: all did, or there is no result.
fn after(parts: &[PartReport], samples: usize) -> Option<crate::analysis::Analysis> {
    let is_new = parts.iter().any(|part| part.report.after.is_some());
    let has_all = parts.iter().all(|part| part.report.certificate.is_some());
    let of = |report: &Report| report.certificate.is_some();
    (is_new && has_all)
        .then(|| {
            merged_analysis(parts, samples, |report| {
                report.after.as_ref().or(report.before.as_ref()).filter(|_| of(report))
            })
        })
        .flatten()
}

/// The farther of both directions over all parts.
fn distance(reports: &[&Report]) -> Option<SurfaceDistance> {
    let all = || reports.iter().filter_map(|report| report.distance);
    let farthest = |of: fn(&SurfaceDistance) -> DirectedDistance| {
        all().map(|distance| of(&distance)).max_by(|a, b| a.upper.total_cmp(&b.upper))
    };
    Some(SurfaceDistance {
        forward: farthest(|distance| distance.forward)?,
        backward: farthest(|distance| distance.backward)?,
    })
}

fn losses(reports: &[&Report]) -> Option<Losses> {
    let area = |report: &Report| report.before.as_ref().map_or(0.0, |before| before.measures.area);
    let known = || reports.iter().filter_map(|report| report.losses);
    known().next()?;
    // A part that kept its bytes lost nothing.
    let share = |of: fn(&Losses) -> f64| {
        mean(reports, area, |report| Some(report.losses.as_ref().map_or(0.0, of))).unwrap_or(0.0)
    };
    let volume = |report: &Report| defined_volume(report.before.as_ref());
    let is_defined = reports.iter().all(|report| volume(report).is_some());
    let changed: f64 = reports
        .iter()
        .map(|report| {
            let change = report.losses.and_then(|losses| losses.volume_change).unwrap_or(0.0);
            change * volume(report).unwrap_or(0.0)
        })
        .sum();
    let all: f64 = reports.iter().filter_map(|report| volume(report)).sum();
    Some(Losses {
        visible_loss: share(|losses| losses.visible_loss),
        hidden_area: known().map(|losses| losses.hidden_area).sum(),
        invented: share(|losses| losses.invented),
        bodies_lost: known().map(|losses| losses.bodies_lost).sum(),
        volume_change: (is_defined && all != 0.0).then_some(changed / all),
        creases_recovered: known().filter_map(|losses| losses.creases_recovered).reduce(f64::min),
    })
}

/// The worst of all parts, with every bound that one exceeds.
pub(super) fn fidelity(reports: &[&Report]) -> Option<FidelityVerdict> {
    let all: Vec<&FidelityVerdict> = reports.iter().filter_map(|report| report.fidelity.as_ref()).collect();
    let rank = |word: Fidelity| match word {
        Fidelity::Exact => 0,
        Fidelity::Faithful => 1,
        Fidelity::Changed => 2,
    };
    let word = all.iter().map(|verdict| verdict.word).max_by_key(|&word| rank(word))?;
    let mut changes: Vec<crate::pipeline::FidelityChange> = Vec::new();
    for change in all.iter().flat_map(|verdict| &verdict.changes) {
        match changes.iter_mut().find(|known| known.kind == change.kind) {
            Some(known) if known.measured < change.measured => *known = *change,
            Some(_) => {}
            None => changes.push(*change),
        }
    }
    Some(FidelityVerdict { word, changes })
}

/// Of a part that tells nothing of holes no area is a patch.
fn filling(reports: &[&Report]) -> Option<Filling> {
    if reports.iter().all(|report| report.filling.is_none()) {
        return None;
    }
    let area = |report: &Report| {
        report.after.as_ref().or(report.before.as_ref()).map_or(0.0, |mesh| mesh.measures.area)
    };
    let of_patches = |report: &Report| report.filling.as_ref().map_or(0.0, |f| f.interpolated_area_share);
    let share = match reports {
        [only] => of_patches(only),
        _ => mean(reports, area, |report| Some(of_patches(report)))?,
    };
    let mut holes = Vec::new();
    for (part, report) in (0..).zip(reports) {
        let own = report.filling.iter().flat_map(|filling| &filling.holes);
        holes.extend(own.map(|hole| HoleOutcome { part: Some(part), ..hole.clone() }));
    }
    Some(Filling { holes, interpolated_area_share: share })
}

/// The one that changed most.
pub(super) fn outcome(reports: &[&Report], operation: Operation) -> Option<Outcome> {
    let rank = |outcome: Outcome| match outcome {
        Outcome::Identical => 0,
        Outcome::Converted => 1,
        Outcome::Simplified
        | Outcome::CutStitched
        | Outcome::Filled
        | Outcome::Modelled
        | Outcome::Combined => 2,
        Outcome::Repaired => 3,
        Outcome::Rebuilt => 4,
        Outcome::Partial => 5,
        Outcome::Refused => 6,
    };
    if operation.only_reports() {
        return None;
    }
    reports.iter().filter_map(|report| report.outcome).max_by_key(|&outcome| rank(outcome))
}

/// That of the first part which the process cannot make, or else of the first.
fn printing(reports: &[&Report]) -> Option<PrintingReport> {
    let mut all = reports.iter().filter_map(|report| report.printing.as_ref());
    let breach = all.clone().find(|report| report.printing.holds() == Some(false));
    breach.or_else(|| all.next()).cloned()
}

/// One for each target. The certificate is put in its place when the file is written.
fn levels(reports: &[&Report]) -> Vec<Level> {
    let count = reports.iter().map(|report| report.levels.len()).max().unwrap_or(0);
    let level = |i: usize| {
        let of_parts: Vec<&Level> = reports.iter().filter_map(|report| report.levels.get(i)).collect();
        let first = of_parts.first()?;
        let mut simplified: simplify::TargetReport = first.simplified;
        for level in &of_parts[1..] {
            let more = &level.simplified;
            simplified.is_reached &= more.is_reached;
            simplified.faces_before += more.faces_before;
            simplified.faces_after += more.faces_after;
            simplified.collapses += more.collapses;
            simplified.refusals.add_all(&more.refusals);
            simplified.error_max = simplified.error_max.max(more.error_max);
        }
        let farthest =
            of_parts.iter().filter_map(|level| level.distance).max_by(|a, b| a.upper().total_cmp(&b.upper()));
        Some(Level { simplified, distance: farthest, ..(*first).clone() })
    };
    (0..count).filter_map(level).collect()
}
