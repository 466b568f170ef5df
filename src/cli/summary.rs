//! The report for people: a screen of text, the most telling things first.

use super::colours::{BAD, DOUBTFUL, GOOD, PLAIN, QUIET, STRONG, aligned, painted};
use super::figures::counted;
use super::flags::with_flags;
use super::model;
use crate::figures::figure;
use crate::wire::{
    Action, Certificate, Claim, Defect, DefectCode, Deviation, Distance, Fidelity, Hole, InputInfo,
    JoinedEdges, Level, MeshInfo, Operation, Outcome, Part, PrintingCheck, Proposal, Report, Severity,
    TargetSpec, Units, ViolationCount, Witness,
};
use anstyle::Style;
use std::fmt::Write as _;

/// What a report is about, as the user calls it.
#[derive(Debug)]
pub(super) struct Subject {
    /// The input.
    pub input: String,
    /// Where the result was written; `None`: it was not.
    pub written: Option<String>,
}

/// The report as text, with a line end.
pub(super) fn summary(report: &Report, subject: &Subject) -> String {
    let mut text = String::new();
    put(&mut text, &painted(style_of(report), &headline(report)));
    put(&mut text, &head(report, subject));
    if let Some(mesh) = &report.before {
        put(&mut text, &format!("  {}", size(mesh, report.output_units)));
        if let Some(question) = mesh.unit_hypothesis.as_ref().and_then(|told| told.question.as_ref()) {
            put(&mut text, &format!("  {}", with_flags(question)));
        }
        put_styled(&mut text, "defects", &mesh.defects.iter().map(defect_row).collect::<Vec<_>>());
        match &report.holes {
            Some(holes) => put_table(&mut text, "holes", &fate_rows(holes)),
            None if matches!(report.operation, Operation::Analyze | Operation::Plan) => {
                put_table(&mut text, "holes", &hole_rows(mesh));
            }
            None => {}
        }
    }
    for (further, number) in report.further_inputs.iter().zip(2..) {
        put(&mut text, &format!("mesh {number}: {}", facts(&further.input)));
        if let Some(mesh) = &further.before {
            put(&mut text, &format!("  {}", size(mesh, report.output_units)));
            put_styled(&mut text, "defects", &mesh.defects.iter().map(defect_row).collect::<Vec<_>>());
        }
    }
    if let Some(plan) = report.plan.as_ref().filter(|_| report.operation == Operation::Plan) {
        put_table(&mut text, "plan", &plan.findings.iter().map(proposal_row).collect::<Vec<_>>());
    }
    let done: Vec<_> =
        report.actions.iter().filter(|a| a.changes.iter().any(|c| c.count > 0)).map(action_row).collect();
    put_table(&mut text, "done", &done);
    put_table(&mut text, "edges joined", &report.actions.iter().flat_map(stitch_rows).collect::<Vec<_>>());
    let missed: Vec<_> = report.levels.iter().filter(|level| !level.is_reached).map(missed_row).collect();
    put_table(&mut text, "targets not reached", &missed);
    if let Some(told) = &report.modeller {
        if let Some(line) = model::size(told) {
            put(&mut text, &format!("polyhedron\n  {line}"));
        }
        put_table(&mut text, "operators", &told.steps.iter().map(model::step_row).collect::<Vec<_>>());
        put_table(&mut text, "faces", &model::face_rows(&told.faces));
        put_table(
            &mut text,
            "may move inward and outward by less than",
            &told.ranges.iter().map(model::range_row).collect::<Vec<_>>(),
        );
    }
    if let Some(mesh) = &report.after {
        put(&mut text, &format!("result\n  {}", size(mesh, report.output_units)));
        if let Some(kept) = closeness(&report.deviation, report.output_units) {
            put(&mut text, &format!("  {kept}"));
        }
        put_styled(
            &mut text,
            "defects that remain",
            &mesh.defects.iter().map(defect_row).collect::<Vec<_>>(),
        );
    }
    if report.levels.len() > 1 {
        let row = |(number, level)| level_row(number, level, report.output_units);
        let rows: Vec<_> = (1..).zip(&report.levels).map(row).collect();
        put_table(&mut text, "results", &rows);
    }
    if let Some(printing) = &report.printing {
        let heading = format!("printing ({}, {} up)", printing.policy, printing.build_direction);
        put_table(&mut text, &heading, &printing.checks.iter().map(check_row).collect::<Vec<_>>());
    }
    if report.parts.len() > 1 {
        put_table(&mut text, "parts", &report.parts.iter().map(part_row).collect::<Vec<_>>());
    }
    put_table(&mut text, "remarks", &report.remarks.iter().map(|text| [text.clone()]).collect::<Vec<_>>());
    let judged = report.certificate.as_ref().unwrap_or(&report.input_certificate);
    put_styled(&mut text, "certificate", &claim_rows(judged));
    if let Some(line) = written(report, subject) {
        put(&mut text, &line);
    }
    text
}

/// A part: where it is, its name, what became of it, and how many triangles it has.
fn part_row(part: &Part) -> [String; 4] {
    let verdict = &part.verdict;
    let state = if verdict.printable { "printable" } else { "not printable" };
    let outcome = verdict.outcome.map_or(state.to_owned(), |outcome| format!("{outcome}, {state}"));
    let triangles = part.triangles_after.unwrap_or(part.triangles_before);
    let place = format!("{} {}", part.path, part.object);
    [place, part.name.clone(), outcome, counted(triangles, "triangle")]
}

fn put(text: &mut String, line: &str) {
    text.push_str(line);
    text.push('\n');
}

/// A heading and its rows, columns aligned; nothing when there are no rows.
fn put_table<const N: usize>(text: &mut String, heading: &str, rows: &[[String; N]]) {
    let plain: Vec<_> = rows.iter().map(|row| (PLAIN, row.clone())).collect();
    put_styled(text, heading, &plain);
}

/// The same, each row in a style of its own.
fn put_styled<const N: usize>(text: &mut String, heading: &str, rows: &[(Style, [String; N])]) {
    if rows.is_empty() {
        return;
    }
    put(text, &painted(STRONG, heading));
    for line in aligned(rows) {
        put(text, &format!("  {line}"));
    }
}

/// The file and what is known of it; of several each has its own line.
fn head(report: &Report, subject: &Subject) -> String {
    let between = if report.further_inputs.is_empty() { ": " } else { "\nmesh 1: " };
    format!("{}{between}{}", subject.input, facts(&report.input))
}

fn facts(input: &InputInfo) -> String {
    let known = if input.units.is_stated { "" } else { " (assumed)" };
    format!("{}, {} bytes, unit {}{known}", input.encoding, input.bytes, input.units.unit)
}

/// Counts and measures, in the unit that they are in: that of the result also for the input, which is taken in it.
fn size(mesh: &MeshInfo, unit: Units) -> String {
    let counts = &mesh.counts;
    let mut text = format!(
        "{}, {}, {}",
        counted(counts.triangles, "triangle"),
        counted(counts.welded_vertices, "vertex"),
        counted(counts.components, "component"),
    );
    if let Some(bounds) = &mesh.measures.bounds {
        let [x, y, z] = std::array::from_fn(|i| figure(bounds.max[i] - bounds.min[i]));
        let _ = write!(text, "; {x} x {y} x {z} {unit}");
    }
    for (name, value, power) in [("area", mesh.measures.area, '²'), ("volume", mesh.measures.volume, '³')] {
        if let Some(value) = value {
            let _ = write!(text, "; {name} {} {unit}{power}", figure(value));
        }
    }
    text
}

/// How far a repair is from its file, and what it lost; `None`: it was not measured.
fn closeness(deviation: &Deviation, unit: Units) -> Option<String> {
    let (most, lost) = (deviation.hausdorff_max?, deviation.visible_loss?);
    let mut text = format!(
        "at most {} {unit} from the file; {} % of the visible surface lost",
        figure(most),
        figure(lost * 100.0)
    );
    if let Some(area) = deviation.hidden_area.filter(|&area| area > 0.0) {
        let _ = write!(text, "; hidden area {} {unit}² left out", figure(area));
    }
    if let Some(count) = deviation.bodies_lost.filter(|&count| count > 0) {
        let _ = write!(text, "; bodies lost: {count}");
    }
    if let Some(share) = deviation.creases_recovered {
        let _ = write!(text, "; {} % of the creases recovered", figure(share * 100.0));
    }
    Some(text)
}

fn defect_row(defect: &Defect) -> (Style, [String; 4]) {
    let (style, severity) = match defect.severity {
        Severity::Error => (BAD, "error"),
        Severity::Warning => (DOUBTFUL, "warning"),
        Severity::Info => (QUIET, "info"),
    };
    let first = defect.witnesses.first().map(witness).unwrap_or_default();
    let count = format!("{}{}", defect.count, or_more(defect.is_at_least));
    (style, [defect.code.to_string(), count, severity.to_owned(), first])
}

/// Most holes of which a screen tells what became of them.
const HOLES_TOLD: usize = 16;

/// What became of the first holes.
fn fate_rows(holes: &[Hole]) -> Vec<[String; 4]> {
    let row = |hole: &Hole| {
        let loops: Vec<String> = hole.loops.iter().map(u32::to_string).collect();
        let class = hole.class.map_or("open chain", |class| class.word());
        let how = hole.used.map_or_else(String::new, |method| format!(" by {method}"));
        let patch = match hole.used {
            Some(_) => {
                format!("{}, {}", counted(hole.triangles, "triangle"), counted(hole.vertices, "new vertex"))
            }
            None => String::new(),
        };
        let rejected = hole.rejected.iter().map(|one| format!("{} not taken: {}", one.method, one.reason));
        let told: Vec<String> = [patch].into_iter().filter(|text| !text.is_empty()).chain(rejected).collect();
        [loops.join(" "), class.to_owned(), format!("{}{how}", hole.fate), told.join("; ")]
    };
    holes.iter().take(HOLES_TOLD).map(row).collect()
}

/// The boundary loops that are listed, by the numbers under which they can be chosen.
fn hole_rows(mesh: &MeshInfo) -> Vec<[String; 4]> {
    let loops = mesh.defects.iter().filter(|defect| defect.code == DefectCode::BoundaryLoop);
    let listed = loops.flat_map(|defect| defect.witnesses.iter().enumerate());
    let row = |(number, witness): (usize, &Witness)| {
        let value = |name: &str| witness.figures.iter().find(|f| f.name == name).and_then(|f| f.value);
        let told = |name: &str| value(name).map(|value| format!("{name} {}", figure(value)));
        let sizes = ["edges", "length", "diameter"].into_iter().filter_map(told);
        let class = witness.hole.map_or("open chain", |class| class.word());
        let sure = value("confidence").map(|share| format!("{:.0} % sure", share * 100.0));
        let at = witness.position.map(|p| format!("at {}", p.map(figure).join(" ")));
        let sizes = sizes.chain(at).collect::<Vec<_>>().join(", ");
        [number.to_string(), class.to_owned(), sure.unwrap_or_default(), sizes]
    };
    listed.map(row).collect()
}

fn proposal_row(proposal: &Proposal) -> [String; 5] {
    let others = proposal.choices.iter().filter(|&&choice| choice != proposal.remedy);
    let others: Vec<&str> = others.map(|choice| choice.word()).collect();
    let others = if others.is_empty() { String::new() } else { format!("or {}", others.join(", ")) };
    let sure = format!("{:.0} % sure", proposal.confidence * 100.0);
    let reason = proposal.reason.to_owned();
    [proposal.code.to_string(), proposal.remedy.to_string(), others, sure, reason]
}

fn check_row(check: &PrintingCheck) -> [String; 3] {
    let status = check.status.map_or_else(|| "not told".to_owned(), |status| status.to_string());
    [check.code.to_string(), status, check.message.clone()]
}

/// The first place to look at.
fn witness(witness: &Witness) -> String {
    let mut parts = Vec::new();
    let elements = [("face", &witness.faces), ("vertex", &witness.vertices)];
    if let Some((name, element)) = elements.iter().find_map(|(name, list)| Some((name, list.first()?))) {
        let line = element.line.map_or_else(String::new, |line| format!(" (line {line})"));
        parts.push(format!("{name} {}{line}", element.index));
    }
    if let Some(position) = witness.position {
        parts.push(format!("at {}", position.map(figure).join(" ")));
    }
    // How sure a guess at a hole is stands beside the guess, in the table of holes.
    let told = witness.figures.iter().filter(|f| !["confidence", "is_closed"].contains(&f.name));
    parts.extend(told.filter_map(|f| Some(format!("{} {}", f.name, figure(f.value?)))));
    parts.join(", ")
}

fn action_row(action: &Action) -> [String; 3] {
    let changes = action.changes.iter().filter(|c| c.count > 0).map(|c| format!("{} {}", c.name, c.count));
    let causes = action.causes.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let why = match (causes.as_str(), action.reason.as_str()) {
        ("", reason) => reason.to_owned(),
        (causes, "") => format!("because of {causes}"),
        (causes, reason) => format!("because of {causes}; {reason}"),
    };
    [action.step.to_owned(), changes.collect::<Vec<_>>().join(", "), why]
}

/// Pairs of joined edges of one kind that the text has of a step; all that are listed are in the JSON.
const STITCHES_SHOWN: usize = 8;

/// The pairs of edges that a step joined, and how many more there are.
fn stitch_rows(action: &Action) -> Vec<[String; 3]> {
    let Some(stitches) = &action.stitches else { return Vec::new() };
    let kinds = [
        ("explicit", &stitches.explicit, stitches.explicit_total),
        ("implicit", &stitches.implicit, stitches.implicit_total),
    ];
    let of_kind = |(kind, pairs, total): (&str, &Vec<JoinedEdges>, u64)| {
        let edge = |pair: &JoinedEdges, i: usize| {
            let [a, b] = pair.edges[i];
            format!("{a}-{b} of face {}", pair.faces[i])
        };
        let step = format!("{} ({kind})", action.step);
        let row = |pair: &JoinedEdges| [step.clone(), edge(pair, 0), format!("with {}", edge(pair, 1))];
        let more = total - (pairs.len().min(STITCHES_SHOWN)) as u64;
        let rest = (more > 0).then(|| [step.clone(), format!("and {more} more"), String::new()]);
        pairs.iter().take(STITCHES_SHOWN).map(row).chain(rest).collect::<Vec<_>>()
    };
    kinds.into_iter().flat_map(of_kind).collect()
}

/// What a target asks.
fn asked(target: TargetSpec) -> String {
    match target {
        TargetSpec::Faces(count) => counted(count.into(), "face"),
        TargetSpec::Ratio(share) => format!("{} of the faces", figure(share)),
        TargetSpec::ErrorMm(error) => format!("error of {} mm", figure(error)),
    }
}

/// One of several results: its number, which its file has, what was asked, and what it is.
fn level_row(number: usize, level: &Level, unit: Units) -> [String; 6] {
    let farthest = |of: &Distance| Some(of.input_to_result.max?.max(of.result_to_input.max?));
    let distance = level.distance.as_ref().and_then(farthest);
    let valid = if level.certificate.printable { "a valid solid" } else { "not a valid solid" };
    [
        number.to_string(),
        asked(level.target),
        counted(level.faces_after, "face"),
        distance.map_or_else(String::new, |most| format!("at most {} {unit} away", figure(most))),
        level.fidelity.map_or_else(String::new, |fidelity| fidelity.to_string()),
        valid.to_owned(),
    ]
}

/// What was asked, how far it came, and what spoke against collapses, the most frequent first.
fn missed_row(level: &Level) -> [String; 3] {
    let mut refusals: Vec<_> = level.refusals.iter().filter(|refusal| refusal.count > 0).collect();
    refusals.sort_by_key(|refusal| std::cmp::Reverse(refusal.count));
    let reasons: Vec<String> = refusals.iter().map(|r| format!("{} {}", r.name, r.count)).collect();
    let why = match reasons.as_slice() {
        [] => "no edge is left to collapse".to_owned(),
        reasons => format!("collapses refused: {}", reasons.join(", ")),
    };
    [asked(level.target), format!("{} left", counted(level.faces_after, "face")), why]
}

fn claim_rows(certificate: &Certificate) -> Vec<(Style, [String; 2])> {
    let claims =
        [("P0 topology", &certificate.p0), ("P1 embedding", &certificate.p1), ("P2 solid", &certificate.p2)];
    let style = |claim: &Claim| if claim.holds == Some(true) { PLAIN } else { BAD };
    claims.map(|(name, claim)| (style(claim), [name.to_owned(), claim_text(claim)])).into()
}

/// What is said behind a count that may be larger.
fn or_more(is_at_least: bool) -> &'static str {
    if is_at_least { " or more" } else { "" }
}

fn claim_text(claim: &Claim) -> String {
    let broken = claim.violations.iter().filter_map(|v| Some((v, v.count.filter(|&n| n > 0)?)));
    let told =
        |(v, count): (&ViolationCount, u64)| format!("{} {count}{}", v.condition, or_more(v.is_at_least));
    let broken = broken.map(told).collect::<Vec<_>>();
    match claim.holds {
        Some(true) => "holds".to_owned(),
        Some(false) if broken.is_empty() => "broken".to_owned(),
        Some(false) => format!("broken: {}", broken.join(", ")),
        None => "not decided".to_owned(),
    }
}

/// The colour of the verdict.
fn style_of(report: &Report) -> Style {
    match (report.verdict.printable, report.verdict.fidelity) {
        (false, _) => BAD,
        (true, Some(Fidelity::Changed)) => DOUBTFUL,
        (true, _) => GOOD,
    }
}

/// What a customer must know, in one line: what became of the file, whether it is a solid, how true it is to the file, and
/// what breaks the policy.
fn headline(report: &Report) -> String {
    let verdict = &report.verdict;
    let outcome = verdict.outcome.map_or_else(String::new, |outcome| format!("{outcome}, "));
    // Without a result it is said of the input, of several of the first.
    let printable = match (verdict.printable, verdict.outcome) {
        (true, Some(Outcome::Refused)) if report.further_inputs.is_empty() => "the input is a valid solid",
        (true, Some(Outcome::Refused)) => "the first input is a valid solid",
        (true, _) => "printable: a valid solid",
        (false, _) => "not printable",
    };
    let mut text = format!("verdict: {outcome}{printable}");
    if let Some(fidelity) = verdict.fidelity {
        let _ = write!(text, "; {fidelity}");
        for (i, change) in verdict.changes.iter().enumerate() {
            let _ = write!(text, "{}{}", if i == 0 { ": " } else { ", " }, change.message);
        }
    }
    if let Some(printing) = &report.printing {
        let breaches: Vec<_> = verdict.p3_breaches.iter().map(|code| code.word()).collect();
        let _ = match (verdict.p3_holds, breaches.as_slice()) {
            (Some(true), _) => write!(text, "; {} holds", printing.policy),
            (_, []) => write!(text, "; {} cannot be told", printing.policy),
            (_, breaches) => write!(text, "; {} is broken: {}", printing.policy, breaches.join(", ")),
        };
    }
    if let Some(reason) = verdict.reasons.first() {
        let _ = write!(text, "; {}", with_flags(&reason.message));
    }
    text
}

/// Where the result is; `None` where there is none to be.
fn written(report: &Report, subject: &Subject) -> Option<String> {
    match &subject.written {
        Some(place) => Some(format!("written: {place}")),
        None => report.verdict.outcome.map(|_| "nothing written".to_owned()),
    }
}

#[cfg(test)]
mod tests;
