//! One operation on one file.

use super::arguments::Request;
use super::exit::Exit;
use super::files::{FileOrStream, told};
use super::flags::with_flags;
use super::watch::{Share, watched};
use crate::budget::{Budget, StopFlag};
use crate::certificate::{Certificate, Fingerprint};
use crate::config::{Config, Loaded};
use crate::formats::{self, ReadLimits};
use crate::jobs::StageClock;
use crate::par;
use crate::pipeline::{self, Answer, Operation, Output, PictureChoices, ProductKind, Require};
use crate::wire::{OptionError, Options, PictureFormat, Problem, ProblemCode, Report, TimingMs, report_page};
use std::borrow::Cow;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{MAIN_SEPARATOR, PathBuf};

/// One file, or several that become one, and where the result goes.
#[derive(Debug)]
pub(super) struct Errand<'r> {
    pub request: &'r Request,
    /// At least one.
    pub inputs: &'r [FileOrStream],
    /// `None`: nowhere.
    pub output: Option<FileOrStream>,
}

impl Errand<'_> {
    /// Names of the files.
    pub(super) fn subject(&self) -> String {
        self.inputs.iter().map(FileOrStream::to_string).collect::<Vec<_>>().join(", ")
    }

    /// The same without their folders.
    fn file_names(&self) -> String {
        let last = |place: &FileOrStream| place.to_string().rsplit(MAIN_SEPARATOR).next().map(str::to_owned);
        self.inputs.iter().filter_map(last).collect::<Vec<_>>().join(", ")
    }
}

/// What came of one file.
#[derive(Debug)]
pub(super) struct FinishedFile {
    pub report: Report,
    /// Where the result was written; `None`: it was not.
    pub written: Option<String>,
    pub exit: Exit,
}

/// Does what was asked and writes the result. A failure of the engine is a problem like any other.
pub(super) fn run(errand: &Errand<'_>) -> Result<FinishedFile, Problem> {
    let crashed = |_| {
        Err(Problem::new(ProblemCode::EngineCrashed, "the engine failed on this file; that is our error"))
    };
    catch_unwind(AssertUnwindSafe(|| attempt(errand))).unwrap_or_else(crashed)
}

fn attempt(errand: &Errand<'_>) -> Result<FinishedFile, Problem> {
    let &Errand { request, inputs, ref output } = errand;
    check_places(errand)?;
    let options =
        Options::from_pairs(request.options.iter().map(|(n, v)| (n, v))).map_err(|e| about_options(&e))?;
    // A picture has one format, whatever its name.
    let is_picture = request.operation == Operation::Render;
    let by_name = output.as_ref().filter(|_| !is_picture).and_then(FileOrStream::format).map(Into::into);
    let picture_name = output.as_ref().filter(|_| is_picture).and_then(FileOrStream::extension);
    let picture_format = picture_format(options.picture_format, picture_name)?;
    let options = Options { output_format: options.output_format.or(by_name), picture_format, ..options };
    options.check(request.operation.into()).map_err(|e| about_options(&e))?;
    if *output == Some(FileOrStream::Stream) && options.targets.as_ref().is_some_and(|t| t.len() > 1) {
        return Err(wrong("standard output holds one mesh; several --targets need a file name"));
    }
    let loaded = request.sources.load().map_err(|e| wrong(e.to_string()))?;
    if let Some(output) = output {
        output.check_writable().map_err(|e| unwritable(output, &e))?;
    }
    if let Some(page) = &request.report_html {
        let place = FileOrStream::File(page.clone());
        place.check_writable().map_err(|e| unwritable(&place, &e))?;
    }
    // One behind the other.
    let mut bytes = Vec::new();
    let mut file_sizes = Vec::new();
    for input in inputs {
        let file = input.read().map_err(|e| unreadable(input, &e))?;
        file_sizes.push(file.len() as u64);
        if bytes.is_empty() { bytes = file } else { bytes.extend(file) }
    }
    let beside = |path: &Option<PathBuf>| {
        let read = |path: &PathBuf| std::fs::read(path).map_err(|e| unreadable(&path.display(), &e));
        path.as_ref().map(read).transpose()
    };
    let (material, after) = (beside(&request.material)?, beside(&request.after)?);
    let options = engine_options(errand, &options, &loaded.config, &bytes);
    // The page for people has a picture.
    let page_picture = request.report_html.is_some().then(PictureChoices::default);
    let picture = options.picture.clone().or(page_picture.filter(|_| !is_picture));
    let options = pipeline::Options { material, after, picture, file_sizes, ..options };
    // A mesh that is as it was is written from its bytes, which are kept unless they can be read again.
    let is_there = matches!(inputs, [input] if input.is_regular_file());
    let (kept, given) =
        if request.operation.only_reports() || is_there { (None, Some(bytes)) } else { (Some(bytes), None) };
    let given = given.map_or_else(|| Cow::Borrowed(kept.as_deref().unwrap_or_default()), Cow::Owned);
    let (answer, timing) = execute(errand, given, &options, &loaded).map_err(|problem| Problem {
        detail: format!("{}: {}", errand.subject(), problem.detail),
        ..problem
    })?;
    deliver(errand, options.require, kept, &answer, timing)
}

/// The format of a picture: that which is `asked` for, or else that of the extension of its name, with which the other must go.
fn picture_format(
    asked: Option<PictureFormat>,
    extension: Option<&str>,
) -> Result<Option<PictureFormat>, Problem> {
    let Some(extension) = extension else { return Ok(asked) };
    let named = if is_glb(extension) { PictureFormat::Glb } else { PictureFormat::Png };
    match asked {
        Some(asked) if asked != named => {
            Err(wrong(format!("--picture-format does not go with the extension .{extension}")))
        }
        _ => Ok((named == PictureFormat::Glb).then_some(named)),
    }
}

/// Streams have no extension that could name their format, other files have one of a format, and standard output holds one thing only.
fn check_places(errand: &Errand<'_>) -> Result<(), Problem> {
    let &Errand { request, inputs, ref output } = errand;
    let is_named = |name: &str| request.options.iter().any(|(given, _)| given == name);
    if inputs.contains(&FileOrStream::Stream) && !is_named("format") {
        return Err(wrong("standard input needs --format"));
    }
    let is_picture = request.operation == Operation::Render;
    if *output == Some(FileOrStream::Stream) && !is_named("output_format") && !is_picture {
        return Err(wrong("standard output needs --output-format"));
    }
    if *output == Some(FileOrStream::Stream) && request.is_json {
        return Err(wrong("--json and --output - both want standard output"));
    }
    let unnamed = output.as_ref().filter(|place| !is_picture && place.format().is_none());
    if let Some(extension) = unnamed.and_then(FileOrStream::extension).filter(|_| !is_named("output_format"))
    {
        return Err(wrong(format!(
            "no mesh format has the file extension .{extension}: --output-format names the format"
        )));
    }
    let of_picture = output.as_ref().filter(|_| is_picture).and_then(FileOrStream::extension);
    if let Some(extension) = of_picture.filter(|extension| !is_png(extension) && !is_glb(extension)) {
        let detail = format!("a picture is a PNG or GLB file, which cannot have the extension .{extension}");
        return Err(wrong(detail));
    }
    let has_format = |place: &FileOrStream| place.format().is_some() || is_named("output_format");
    match output {
        Some(output) if request.operation == Operation::Convert && !has_format(output) => {
            Err(wrong(format!("{output} names no format: --output-format is needed")))
        }
        _ => Ok(()),
    }
}

/// Whether a file of this extension can be a PNG, of one picture or, as APNG, of several.
fn is_png(extension: &str) -> bool {
    ["png", "apng"].iter().any(|png| extension.eq_ignore_ascii_case(png))
}

fn is_glb(extension: &str) -> bool {
    extension.eq_ignore_ascii_case("glb")
}

pub(super) fn wrong(detail: impl Into<String>) -> Problem {
    Problem::new(ProblemCode::InvalidParameter, detail)
}

/// The problem, in which options are called as the flags that set them; what stands in a plan keeps its words.
fn about_options(error: &OptionError) -> Problem {
    let problem = Problem::from(error);
    match error {
        OptionError::NoPlan { .. } => problem,
        _ => Problem { detail: with_flags(&problem.detail), ..problem },
    }
}

pub(super) fn unwritable(place: &dyn std::fmt::Display, error: &io::Error) -> Problem {
    Problem::new(ProblemCode::StorageFull, format!("{place} cannot be written: {}", told(error)))
}

fn unreadable(input: &dyn std::fmt::Display, error: &io::Error) -> Problem {
    Problem::new(ProblemCode::NotFound, format!("{input} cannot be read: {}", told(error)))
}

fn engine_options(
    errand: &Errand<'_>,
    options: &Options,
    config: &Config,
    bytes: &[u8],
) -> pipeline::Options {
    let limits = ReadLimits {
        triangles_max: config.triangles_max,
        vertices_max: config.vertices_max,
        polygon_corners_max: config.polygon_corners_max,
    };
    let engine = options.to_engine(limits);
    // The content decides; the extension only where the content leaves it open.
    let named = if let [input] = errand.inputs { input.format() } else { None };
    let by_extension = || named.filter(|_| formats::sniff(bytes, None).is_err());
    pipeline::Options {
        format: engine.format.or_else(by_extension),
        output_format: engine.output_format.or_else(|| errand.output.as_ref()?.format()),
        ..engine
    }
}

/// Runs the engine under the configured limits.
fn execute(
    errand: &Errand<'_>,
    bytes: Cow<'_, [u8]>,
    options: &pipeline::Options,
    loaded: &Loaded,
) -> Result<(Answer, TimingMs), Problem> {
    let (config, operation, subject) = (&loaded.config, errand.request.operation, errand.file_names());
    // The default deadline protects a service from its guests; here the guest is at home.
    let deadline = loaded.is_given("deadline_max").then_some(config.deadline_max);
    let stop = StopFlag::default();
    let clock = StageClock::start(operation.into());
    let budget = Budget::new(stop.clone(), config.engine_work_max, config.engine_bytes_max.0)
        .observed_by(clock.observer());
    let engine =
        || par::with_threads(config.engine_threads, || pipeline::run(operation, bytes, options, &budget));
    let progress = || Share::of(operation, &subject, clock.progress());
    let answer = watched(&stop, deadline, progress, engine).map_err(|failure| Problem::from(&failure))?;
    Ok((answer, clock.timing_ms()))
}

/// The bytes of the file that was certified.
fn read_again(errand: &Errand<'_>, certificate: &Certificate) -> Result<Vec<u8>, Problem> {
    for input in errand.inputs {
        let bytes = input.read().map_err(|e| unreadable(input, &e))?;
        let file = Fingerprint::of(&bytes, &Budget::unlimited());
        if file.is_ok_and(|file| file.sha256 == certificate.sha256) {
            return Ok(bytes);
        }
    }
    let detail =
        "the file was changed by another program in the meantime: nothing is written; run this again";
    Err(Problem::new(ProblemCode::Internal, format!("{}: {detail}", errand.subject())))
}

/// Writes the result, if there is one, and the page.
fn deliver(
    errand: &Errand<'_>,
    require: Option<Require>,
    kept: Option<Vec<u8>>,
    answer: &Answer,
    timing: TimingMs,
) -> Result<FinishedFile, Problem> {
    let request = errand.request;
    let is_as_it_was = |output: &Output| output.bytes.is_none();
    let as_it_was = match (&errand.output, kept) {
        (Some(_), None) if answer.output.iter().chain(&answer.levels).any(is_as_it_was) => {
            read_again(errand, &answer.report.input_certificate)?
        }
        (_, kept) => kept.unwrap_or_default(),
    };
    let mut written = Vec::new();
    for (i, output) in answer.output.iter().chain(&answer.levels).enumerate() {
        let Some(place) = &errand.output else { continue };
        let place = if answer.levels.is_empty() { place.clone() } else { place.numbered(i + 1) };
        place.write(output.bytes.as_deref().unwrap_or(&as_it_was)).map_err(|e| unwritable(&place, &e))?;
        written.push(place.to_string());
    }
    let drawn = answer.picture.as_ref().filter(|_| request.operation == Operation::Render);
    if let (Some(place), Some(picture)) = (&errand.output, drawn) {
        place.write(picture).map_err(|e| unwritable(&place, &e))?;
        written.push(place.to_string());
    }
    let report = Report::new(&answer.report, timing);
    if let Some(path) = &request.report_html {
        let value = serde_json::to_value(&report).unwrap_or_default();
        let place = FileOrStream::File(path.clone());
        place
            .write(report_page(&value, answer.picture.as_deref()).as_bytes())
            .map_err(|e| unwritable(&place, &e))?;
    }
    let exit = verdict(request.operation, require, &report, answer.output.is_some());
    Ok(FinishedFile { report, written: (!written.is_empty()).then(|| written.join(", ")), exit })
}

fn verdict(operation: Operation, require: Option<Require>, report: &Report, has_result: bool) -> Exit {
    let is_done = match operation.facts().product {
        ProductKind::Solid => has_result && report.verdict.printable,
        ProductKind::Report => operation != Operation::Verify || report.verdict.printable,
        ProductKind::Picture => true,
        ProductKind::Mesh => has_result && (require != Some(Require::Printable) || report.verdict.printable),
    };
    if is_done { Exit::Done } else { Exit::Negative }
}
