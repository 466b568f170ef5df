//! A project of several parts: each is handled by itself, in its own coordinates, and put back into its place.
//!
//! A part that is valid keeps its bytes, and so does everything around the parts. The file that is returned is judged as a
//! whole, from its own bytes, part by part.

mod drawn;
mod merge;
mod merged_analysis;
mod negative;
mod sources;

pub(super) use self::negative::without_negative_parts;
pub use self::sources::AttributeCounts;
use self::sources::TakenOver;
use super::bounds;
use super::input::{Input, samples_of, units_of_file};
use super::output::refusal;
use super::{
    Answer, Failure, Level, Operation, Options, Outcome, Output, Refusal, Report, Require, SolidParts, run_on,
};
use crate::budget::{Budget, Charge, Stage};
use crate::certificate::{self, Certificate, Depth, Examination, PartsExamination};
use crate::formats::threemf::{
    Between, Body, FaceSource, NewBody, ObjectKind, Project, RewriteError, read_project, rewrite_project,
};
use crate::formats::{self, Encoding, Format, ReadErrorKind, ReadLimits, ReadOptions, WriteError};
use crate::mesh::{Regions, Soup, Texture};
use crate::simplify::Target;

/// Which part of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartFacts {
    /// Where in the file it is, such as `/3D/3dmodel.model`.
    pub path: String,
    /// Its id there.
    pub object: u32,
    /// Its name; empty when it has none.
    pub name: String,
    /// Its number among the volumes of the object, where that has several.
    pub volume: Option<u32>,
    /// How often the file has it at a place.
    pub instances: u32,
    /// Number of its first face, where faces are numbered through all parts.
    pub first_face: u32,
}

/// What was done with a part.
#[derive(Debug, Clone, PartialEq)]
pub struct PartReport {
    /// Which one.
    pub facts: PartFacts,
    /// The account of it; its certificate is about the bytes of the part alone.
    pub report: Report,
    /// What became of what the file says of its faces; `None`: it kept its bytes, or there is nothing.
    pub attributes: Option<AttributeCounts>,
}

/// True when `operation` handles the parts of such a file one by one. A format that holds one mesh takes all parts at their
/// places.
pub(super) fn is_by_parts(encoding: Encoding, operation: Operation, options: &Options) -> bool {
    let stays =
        operation.only_reports() || options.output_format.is_none_or(|format| format == Format::ThreeMf);
    encoding == Encoding::ThreeMf
        && stays
        && match options.parts {
            SolidParts::Separate => true,
            SolidParts::Union => operation == Operation::Repair,
            SolidParts::Together => false,
        }
}

/// Reads the 3MF `bytes`.
pub(super) fn read(bytes: &[u8], options: &Options, budget: &Budget) -> Result<Project, Failure> {
    Ok(budget.stage(Stage::Read, || read_project(bytes, &options.read, budget))?)
}

/// Triangles that a run looks at: those of each part once, and of all at their places where they are united or
/// drawn.
pub(super) fn triangles_of(project: &Project, operation: Operation, options: &Options) -> u64 {
    let has_all = options.parts == SolidParts::Union || operation == Operation::Render;
    let at_places = |body: &Body| if has_all { u64::from(body.instances) } else { 0 };
    let of = |body: &Body| (body.soup.triangles.len() as u64).saturating_mul(1 + at_places(body));
    project.bodies.iter().map(of).fold(0, u64::saturating_add)
}

/// Runs `operation` on every part of the 3MF `bytes`.
pub(super) fn run_by_parts(
    operation: Operation,
    bytes: &[u8],
    project: &Project,
    options: &Options,
    budget: &Budget,
) -> Result<Answer, Failure> {
    units_of_file(Some(project.units), options)?;
    let triangles =
        project.bodies.iter().filter(|body| body.is_solid()).map(|body| body.soup.triangles.len()).sum();
    let run = ProjectRun { operation, bytes, project, triangles, options, budget };
    run.check_options()?;
    let answer = run.answer()?;
    let answer = match options.parts {
        SolidParts::Union if answer.report.refusal.is_none() => run.unite(answer)?,
        _ => answer,
    };
    let mut too_large = None;
    let mut answer =
        bounds::with_picture(operation, answer, budget, |answer| match drawn::picture(&run, answer) {
            // Parts that are few may be at so many places that all together are too large to be drawn.
            Err(Failure::Unreadable(error))
                if operation != Operation::Render && matches!(error.kind, ReadErrorKind::TooLarge { .. }) =>
            {
                too_large = Some(bounds::no_picture(&error.kind));
                Ok(None)
            }
            drawn => drawn,
        })?;
    answer.report.remarks.extend(too_large);
    Ok(answer)
}

/// What is said of a 3MF whose parts were taken as one mesh.
pub(super) fn remarks_on_scene(
    bytes: &[u8],
    answer: &Answer,
    options: &Options,
    budget: &Budget,
) -> Result<Vec<String>, Failure> {
    let project = read(bytes, options, budget)?;
    Ok(match &answer.output {
        Some(Output { bytes: Some(_), encoding, .. }) => merge::left_out(&project, *encoding),
        _ => project.remarks,
    })
}

struct ProjectRun<'a> {
    operation: Operation,
    bytes: &'a [u8],
    project: &'a Project,
    /// Of all its solids.
    triangles: usize,
    options: &'a Options,
    budget: &'a Budget,
}

/// What came of one part.
struct FinishedPart {
    /// Number of the part among the bodies of the project.
    body: usize,
    answer: Answer,
    attributes: Option<AttributeCounts>,
}

/// The new mesh of a part.
struct Remade<'b> {
    body: usize,
    soup: Soup,
    sources: Vec<FaceSource>,
    between: Vec<Between>,
    _charges: Vec<Charge<'b>>,
}

impl ProjectRun<'_> {
    /// Numbers of the bodies that have to be solids.
    fn solids(&self) -> Vec<usize> {
        let bodies = &self.project.bodies;
        (0..bodies.len()).filter(|&i| bodies[i].is_solid()).collect()
    }

    /// That no option names elements of one mesh where there are several.
    fn check_options(&self) -> Result<(), Failure> {
        let (options, count) = (self.options, self.solids().len());
        let makes_mesh = !self.operation.only_reports();
        if makes_mesh && options.output_units.is_some_and(|units| units != self.project.units) {
            let reason =
                "a 3MF that keeps its parts keeps its unit; `parts=together` makes a new file of one mesh";
            return Err(Failure::NotApplicable { option: "output_units", reason: reason.to_owned() });
        }
        if count < 2 {
            return Ok(());
        }
        let named = [
            ("plan", self.operation == Operation::Repair && options.plan.is_some()),
            ("holes", self.operation == Operation::FillHoles && options.filling.holes.is_some()),
            ("cut_edges", self.operation == Operation::CutStitch && !options.cut_stitch.chosen.is_empty()),
            ("operators", self.operation == Operation::Modeller),
        ];
        match named.into_iter().find(|&(_, is_given)| is_given) {
            Some((option, _)) => {
                let reason = format!(
                    "the file has {count} parts and this is about one; `parts=together` takes all as one mesh"
                );
                Err(Failure::NotApplicable { option, reason })
            }
            None => Ok(()),
        }
    }

    fn answer(&self) -> Result<Answer, Failure> {
        let budget = self.budget;
        let solids = self.solids();
        let examined = budget.stage(Stage::Certify, || {
            let soups: Vec<&Soup> = solids.iter().map(|&i| &self.project.bodies[i].soup).collect();
            let depth = Depth::Count { samples: samples_of(self.options) };
            let read = &self.options.read;
            certificate::examine_parts(&soups, self.bytes, Encoding::ThreeMf, read, depth, budget)
        })?;
        let PartsExamination { certificate, parts } = examined;
        let mut done = Vec::with_capacity(solids.len());
        for (body, examination) in solids.into_iter().zip(parts) {
            done.push(self.run_one(body, examination)?);
        }
        self.finish(done, certificate)
    }

    fn run_one(&self, number: usize, examination: Examination) -> Result<FinishedPart, Failure> {
        let body = &self.project.bodies[number];
        let mut input = Input::of(body.soup.clone(), examination, self.options)?;
        let is_simplified =
            self.operation == Operation::Simplify || !self.options.simplify.targets.is_empty();
        input.regions = Some(if is_simplified { body.regions(self.budget)? } else { Regions::default() });
        let options = &self.options_of(body);
        let answer = run_on(self.operation, &mut input, options, self.budget)?;
        Ok(FinishedPart { body: number, answer, attributes: None })
    }

    /// The options for one part: its share of the faces that a simplification may leave.
    fn options_of(&self, body: &Body) -> Options {
        let share = body.soup.triangles.len() as f64 / self.triangles.max(1) as f64;
        let target = |target: &Target| match *target {
            Target::Faces(faces) => Target::Faces(((faces as f64 * share) as usize).max(4)),
            other => other,
        };
        let mut options = self.options.clone();
        options.simplify.targets = options.simplify.targets.iter().map(target).collect();
        options
    }

    /// The file with all new parts in it, and the account of all.
    fn finish(&self, mut done: Vec<FinishedPart>, input_certificate: Certificate) -> Result<Answer, Failure> {
        let refused = done.iter().position(|done| done.answer.report.refusal.is_some());
        let mut outputs = Vec::new();
        let has_results = !done.is_empty() && done.iter().all(|done| done.answer.output.is_some());
        if refused.is_none() && has_results {
            let levels = done.iter().map(|done| done.answer.levels.len()).max().unwrap_or(0);
            for level in 0..=levels {
                outputs.push(self.write(&mut done, level)?);
            }
        }
        let mut report = merge::merged(
            self.project,
            &done,
            self.verification(input_certificate),
            samples_of(self.options),
        );
        let Some((output, certificate)) = outputs.first().cloned() else {
            if let Some(refused) = refused {
                let refusal = done[refused].answer.report.refusal.clone();
                report = Report { outcome: Some(Outcome::Refused), refusal, ..report };
            } else if done.is_empty() && !self.operation.only_reports() {
                return Ok(self.without_parts(report));
            }
            return Ok(report.into_answer());
        };
        if let Some(refusal) = refusal(&self.with_default_require(), &certificate) {
            return Ok(Report { certificate: None, after: None, ..report }.refused(refusal));
        }
        for (level, (_, certificate)) in report.levels.iter_mut().zip(&outputs) {
            let Level { certificate: of_level, .. } = level;
            *of_level = certificate.clone();
        }
        report.certificate = Some(certificate);
        let levels = outputs.into_iter().skip(1).map(|(output, _)| output).collect();
        Ok(Answer { report, output: Some(output), levels, picture: None })
    }

    /// A repair demands a solid unless the caller says otherwise.
    fn with_default_require(&self) -> Options {
        let of_operation = (self.operation == Operation::Repair).then_some(Require::Printable);
        let require = self.options.require.or(of_operation);
        Options { require, ..Options::default() }
    }

    /// The answer about a file in which nothing has to be a solid: it is returned as it is, unless a solid is demanded.
    fn without_parts(&self, report: Report) -> Answer {
        let demanded = self.with_default_require().require;
        if demanded.is_some_and(Require::is_of_a_solid) {
            return report.refused(Refusal::NothingToRepair);
        }
        let certificate = Some(report.input_certificate.clone());
        let report = Report { certificate, outcome: Some(Outcome::Partial), ..report };
        let output = output_of(None);
        Answer { report, output: Some(output), levels: Vec::new(), picture: None }
    }

    /// The file with the results of a level: 0 is the main one.
    fn write(&self, done: &mut [FinishedPart], level: usize) -> Result<(Output, Certificate), Failure> {
        let budget = self.budget;
        let mut remade = Vec::new();
        for done in done.iter_mut() {
            let output = match level {
                0 => done.answer.output.as_ref(),
                _ => done.answer.levels.get(level - 1).or(done.answer.output.as_ref()),
            };
            let Some(Output { bytes: Some(bytes), encoding, origins, texture }) = output else { continue };
            let soup = budget.stage(Stage::Read, || formats::read(bytes, *encoding, &unlimited(), budget))?;
            let body = &self.project.bodies[done.body];
            let new = sources::NewMesh { soup: &soup, origins, texture };
            let TakenOver { sources, between, counts, charges } =
                budget.stage(Stage::Write, || sources::taken_over(body, &new, budget))?;
            if level == 0 {
                done.attributes = counts;
            }
            remade.push(Remade { body: done.body, soup, sources, between, _charges: charges });
        }
        if remade.is_empty() {
            let output = output_of(None);
            return Ok((output, self.certify(self.bytes)?));
        }
        let new: Vec<NewBody<'_>> = remade
            .iter()
            .map(|remade| {
                let Remade { body, soup, sources, between, .. } = remade;
                NewBody { body: *body, soup, sources, between }
            })
            .collect();
        let bytes = budget.stage(Stage::Write, || rewrite_project(self.bytes, self.project, &new, budget))?;
        let certificate = self.certify(&bytes)?;
        let output = output_of(Some(bytes));
        Ok((output, certificate))
    }

    fn certify(&self, bytes: &[u8]) -> Result<Certificate, Failure> {
        let depth = Depth::Count { samples: samples_of(self.options) };
        let certified = self.budget.stage(Stage::Certify, || {
            certificate::certify_parts(bytes, Encoding::ThreeMf, &unlimited(), depth, self.budget)
        });
        Ok(certified?)
    }

    /// The account of the file before anything was done.
    fn verification(&self, certificate: Certificate) -> Report {
        let none = Soup { units: Some(self.project.units), ..Soup::default() };
        let examination = Examination { certificate, contacts: None };
        // The unit was compared with the caller's before.
        match Input::of(none, examination, &Options { units: None, ..self.options.clone() }) {
            Ok(input) => Report { operation: self.operation, ..input.verification() },
            Err(_) => unreachable!("no unit was stated that could contradict"),
        }
    }

    /// The parts of `answer` at their places, as one solid.
    fn unite(&self, answer: Answer) -> Result<Answer, Failure> {
        let bytes = answer.output.as_ref().and_then(|output| output.bytes.as_deref()).unwrap_or(self.bytes);
        let mut input = Input::read(bytes, Encoding::ThreeMf, self.options, self.budget)?;
        let united = run_on(self.operation, &mut input, self.options, self.budget)?;
        let has_changed = bytes.as_ptr() != self.bytes.as_ptr();
        let is_one_mesh = united.output.as_ref().is_some_and(|output| output.bytes.is_some());
        // Where the parts were mended and nothing had to be united, the file is that of the mended parts.
        let output = united.output.map(|output| match output.bytes {
            None if has_changed => Output { bytes: Some(bytes.to_vec()), ..output },
            _ => output,
        });
        let remarks = match is_one_mesh {
            true => merge::left_out(self.project, Encoding::ThreeMf),
            false => answer.report.remarks.clone(),
        };
        let report = Report { remarks, ..merge::in_turn(answer.report, united.report, has_changed) };
        Ok(Answer { report, output, levels: united.levels, picture: None })
    }
}

/// A project as a file: with these bytes, or with those that were uploaded.
fn output_of(bytes: Option<Vec<u8>>) -> Output {
    Output { bytes, encoding: Encoding::ThreeMf, origins: Vec::new(), texture: Texture::default() }
}

/// What we write may be larger than what we would take in.
fn unlimited() -> ReadOptions {
    let limits =
        ReadLimits { triangles_max: u32::MAX, vertices_max: u32::MAX, polygon_corners_max: u32::MAX };
    ReadOptions { limits, ..ReadOptions::default() }
}

impl From<RewriteError> for Failure {
    fn from(error: RewriteError) -> Self {
        match error {
            RewriteError::Unreadable(error) => error.into(),
            RewriteError::Unwritable(WriteError::Stopped(stopped)) => Self::Stopped(stopped),
            RewriteError::Unwritable(error) => Self::NotApplicable {
                option: "parts",
                reason: format!("the file cannot be written: {error}"),
            },
        }
    }
}

/// True for a part that is printed by itself.
fn is_model(body: &Body) -> bool {
    body.kind == ObjectKind::Model
}
