//! Set operations on several files: one exact arrangement of all of them, settled until its bytes are certified.

use super::bounds::{self, Bound};
use super::faithful::NO_LOSSES;
use super::fidelity::Losses;
use super::input::Input;
use super::ladder::{Climb, Tried};
use super::plan::Attempt;
use super::repair_choices::Choices;
use super::size::diagonal;
use super::step::Step;
use super::{
    Action, Answer, BooleanRefusal, Failure, FidelityVerdict, FurtherInput, Operation, Options, Outcome,
    Refusal, Report, finished, picture,
};
use crate::budget::{Budget, Stage};
use crate::formats::{self, Encoding, Place, ReadError, ReadErrorKind};
use crate::geom::signed_volume;
use crate::mesh::Soup;
use crate::repair::unite::{NotCombined, combine};
use crate::repair::{Draft, NEW};

/// Combines the files that stand one behind the other in `bytes`.
pub(super) fn boolean(
    bytes: &[u8],
    options: &Options,
    bound: &Bound<'_>,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let files = options.files_in(bytes);
    if !Operation::Boolean.meshes().contains(&files.len()) {
        return Err(Failure::MeshCount { operation: Operation::Boolean, count: files.len() });
    }
    let mut reading = OperandReader { options: options.clone(), scaled: None, triangles: 0, vertices: 0 };
    let mut meshes = Vec::with_capacity(files.len());
    for (&bytes, number) in files.iter().zip(1..) {
        let read = bound.reading(|| reading.next(bytes, budget)).map_err(|failure| failure.in_mesh(number));
        meshes.push(read?);
    }
    bound.running(reading.triangles, || combine_all(meshes, reading, budget))
}

/// A file that was read.
struct Operand<'b> {
    bytes: &'b [u8],
    encoding: Encoding,
    soup: Soup,
}

/// Describes the files and combines them.
fn combine_all(
    meshes: Vec<Operand<'_>>,
    mut reading: OperandReader,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let mut meshes = meshes.into_iter().zip(1..);
    let mut describe =
        |(mesh, number)| reading.describe(mesh, budget).map_err(|failure: Failure| failure.in_mesh(number));
    let Some(first) = meshes.next() else { unreachable!("the number of files was looked at") };
    let (mut input, mut report) = describe(first)?;
    let mut soups = vec![std::mem::take(&mut input.soup)];
    for next in meshes {
        let (further, Report { before, .. }) = describe(next)?;
        soups.push(further.soup);
        let certificate = further.examination.certificate;
        report.further_inputs.push(FurtherInput { facts: further.facts, before, certificate });
    }
    // First vertices, triangles and faces.
    let mut starts = Vec::with_capacity(soups.len());
    let mut next = [0; 3];
    for soup in &soups {
        starts.push(next);
        let [vertex, triangle, face] = next;
        let (vertices, triangles) = (soup.positions.len() as u32, soup.triangles.len() as u32);
        next = [vertex + vertices, triangle + triangles, face + soup.face_count];
    }
    let firsts: Vec<u32> = starts.iter().map(|[_, triangle, _]| *triangle).collect();
    input.soup = Soup::joined(&soups);
    drop(soups);
    let options = reading.scaled.as_ref().unwrap_or(&reading.options);
    let answer =
        bounds::or_refused(report, budget, |report| combined(&input, &firsts, report, options, budget))?;
    let answer = finished(&input, options, answer, budget)?;
    bounds::with_picture(Operation::Boolean, answer, budget, |answer| {
        picture::of_meshes(&input, &starts, answer, options, budget)
    })
}

/// The files as they are read, under limits for all together.
struct OperandReader {
    /// With the format of the output, which is that of the first file unless the caller says.
    options: Options,
    /// The same in the unit of the result, if that is another one.
    scaled: Option<Options>,
    triangles: u64,
    vertices: u64,
}

impl OperandReader {
    fn next<'b>(&mut self, bytes: &'b [u8], budget: &Budget) -> Result<Operand<'b>, Failure> {
        let encoding = budget.stage(Stage::Read, || formats::sniff(bytes, self.options.format))?;
        let soup = Input::read_soup(bytes, encoding, &self.options, budget)?;
        self.triangles += soup.triangles.len() as u64;
        self.vertices += soup.positions.len() as u64;
        let limits = self.options.read.limits;
        for (what, limit_name, actual, limit) in [
            ("triangles", "triangles_max", self.triangles, limits.triangles_max),
            ("vertices", "vertices_max", self.vertices, limits.vertices_max),
        ] {
            if actual > u64::from(limit) {
                let kind = ReadErrorKind::TooLarge { what, limit_name, limit: limit.into(), actual };
                return Err(ReadError { kind, place: Place::Whole, expected: String::new() }.into());
            }
        }
        Ok(Operand { bytes, encoding, soup })
    }

    /// Judges and describes the next of the files that were read.
    fn describe(&mut self, mesh: Operand<'_>, budget: &Budget) -> Result<(Input, Report), Failure> {
        let Operand { bytes, encoding, soup } = mesh;
        let mut input = Input::examined(soup, bytes.into(), encoding, &self.options, budget)?;
        self.options.output_format.get_or_insert(input.facts.encoding.format());
        let in_units_of_format = input.take_lengths(&self.options);
        let options = in_units_of_format.as_ref().unwrap_or(&self.options);
        self.scaled = input.take_units_of_result(Operation::Boolean, options)?.or(in_units_of_format);
        self.options.output_units.get_or_insert(input.facts.result_units);
        let report = input.report(Operation::Boolean, budget)?;
        Ok((input, report))
    }
}

/// `input` is the first file with the triangles of all; `firsts` are the first ones of each.
fn combined(
    input: &Input,
    firsts: &[u32],
    report: Report,
    options: &Options,
    budget: &Budget,
) -> Result<Answer, Failure> {
    let mut attempt = Attempt::start_as_oriented(&input.soup);
    let _charge = budget.charge(3 * attempt.draft.bytes())?;
    let operation = options.set_operation;
    let changes = budget.stage(Stage::Repair, || combine(&mut attempt.draft, firsts, operation, budget));
    let (changes, exact_volume) = match changes {
        Ok(combined) => combined,
        Err(NotCombined::Stopped(stopped)) => return Err(stopped.into()),
        Err(reason) => {
            let reason = BooleanRefusal { operation, reason };
            return Ok(report.refused(Refusal::Boolean { reason }));
        }
    };
    attempt.actions.push(Action {
        step: operation.name(),
        causes: Vec::new(),
        changes: changes.counts,
        move_max: changes.move_max,
        reason: changes.reason,
        stitches: None,
    });
    let choices = Choices::of(options, &input.soup, report.before.as_ref())?;
    let encoding = input.output_encoding(options);
    let climb = Climb { input, encoding, options, choices: &choices, before: None, budget };
    let rounding = [Step::RoundToF32, Step::Unite, Step::JoinCopies];
    climb.go_on(&mut attempt, &[Step::JoinCopies])?;
    let is_rounded = encoding.is_float32() || input.soup.is_f32_exact;
    if encoding.is_float32() && !input.soup.is_f32_exact {
        climb.go_on(&mut attempt, &rounding)?;
    }
    let coarser = |combined: &Attempt, steps: u32| {
        let mut attempt = combined.clone();
        if steps > 0 {
            let round = Step::RoundToCoarser { steps };
            let steps = [round, Step::JoinCopies, Step::DropDegenerate, Step::SplitCollinear, Step::Unite];
            climb.go_on(&mut attempt, &steps)?;
        }
        Ok(Some(attempt))
    };
    let mut tried = climb.settled(|steps| coarser(&attempt, steps))?;
    if matches!(tried, Tried::SolidInF64) && !is_rounded {
        climb.go_on(&mut attempt, &rounding)?;
        tried = climb.settled(|steps| coarser(&attempt, steps))?;
    }
    let Tried::Certified(found) = tried else {
        return Ok(report.refused(Refusal::NotRepairable { witness: None }));
    };
    let (Attempt { draft, actions, .. }, candidate) = *found;
    let moved = actions.iter().map(|action| action.move_max).sum();
    let losses = Losses {
        creases_recovered: None,
        invented: share_of_new(&draft),
        volume_change: change_of_volume(&draft, exact_volume),
        ..NO_LOSSES
    };
    let fidelity = FidelityVerdict::of(&losses, moved, diagonal(&input.soup));
    let report = Report { actions, fidelity: Some(fidelity), ..report };
    Ok(candidate.returned(input, &draft.triangle_origin, report, Outcome::Combined, budget)?)
}

/// The share of the surface that no file has: necks between what touched.
fn share_of_new(draft: &Draft) -> f64 {
    let areas = draft.areas();
    let new = areas.iter().zip(&draft.triangle_origin).filter(|&(_, &origin)| origin == NEW);
    let all: f64 = areas.iter().sum();
    if all > 0.0 { new.fold(0.0, |sum, (area, _)| sum + area) / all } else { 0.0 }
}

/// The share by which the volume is not the `exact` one; `None` where one of them has no number that can be compared.
fn change_of_volume(draft: &Draft, exact: f64) -> Option<f64> {
    let volume = signed_volume((0..draft.triangles.len()).map(|t| draft.corners(t)));
    (exact.is_normal() && volume.is_finite()).then(|| (volume - exact) / exact.abs())
}
