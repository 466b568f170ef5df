//! One file or several: where each result goes, and what is told of all.

use super::arguments::{OutputTarget, Request};
use super::colours::{BAD, DOUBTFUL, GOOD, aligned, painted};
use super::exit::{Exit, print, say};
use super::figures::counted;
use super::files::FileOrStream;
use super::flags::with_flags;
use super::summary::{Subject, summary};
use super::work::{Errand, FinishedFile, run as run_one, unwritable, wrong};
use crate::pipeline::Operation;
use crate::wire::{Fidelity, Problem};
use anstyle::Style;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::io::Write as _;
use std::path::Path;

/// Does what was asked with each file and says what came of it. The exit code is the gravest of all.
pub(super) fn run(request: &Request) -> Exit {
    let errands = match errands(request) {
        Ok(errands) => errands,
        Err(problem) => return tell_problem(request, &problem),
    };
    match errands.as_slice() {
        [errand] => match run_one(errand) {
            Ok(done) => tell(errand, &done),
            Err(problem) => tell_problem(request, &problem),
        },
        errands => run_all(request, errands),
    }
}

/// What is to be done, file by file; nothing is done where two results would have one name.
fn errands(request: &Request) -> Result<Vec<Errand<'_>>, Problem> {
    let each = if request.operation == Operation::Boolean { request.inputs.len() } else { 1 };
    let many = request.inputs.len() > each;
    if many && matches!(request.target, OutputTarget::Place(_)) {
        return Err(wrong(match request.operation {
            Operation::Modeller => "modeller takes one file",
            _ => "one --output holds the result of one file; several files need --out-dir",
        }));
    }
    if many && request.report_html.is_some() {
        return Err(wrong("--report-html writes the page of one file; leave it out, or give one file"));
    }
    if request.inputs.len() > 1 && request.inputs.contains(&FileOrStream::Stream) {
        return Err(wrong("standard input cannot be one of several files"));
    }
    if let OutputTarget::Folder(folder) = &request.target {
        fs::create_dir_all(folder).map_err(|e| unwritable(&folder.display(), &e))?;
    }
    let mut taken = BTreeSet::new();
    let errand = |inputs| {
        let output = match &request.target {
            OutputTarget::None => None,
            OutputTarget::Place(place) => Some(place.clone()),
            OutputTarget::Folder(folder) => Some(place_in(folder, inputs, request)?),
        };
        match &output {
            Some(FileOrStream::File(path)) if !taken.insert(path.clone()) => Err(wrong(format!(
                "two results would be {}; write them into different folders",
                path.display()
            ))),
            _ => Ok(Errand { request, inputs, output }),
        }
    };
    request.inputs.chunks(each.max(1)).map(errand).collect()
}

/// The file of this name in `folder`, with the extension of the format that is asked for.
fn place_in(folder: &Path, inputs: &[FileOrStream], request: &Request) -> Result<FileOrStream, Problem> {
    let [FileOrStream::File(input), ..] = inputs else {
        return Err(wrong("the result of standard input has no name in a folder; give --output"));
    };
    let name = input.file_name().ok_or_else(|| wrong(format!("{} names no file", input.display())))?;
    let mut path = folder.join(name);
    if let Some((_, format)) = request.options.iter().find(|(option, _)| option == "output_format") {
        path.set_extension(format);
    }
    if request.operation == Operation::Render {
        let format = request.options.iter().find(|(option, _)| option == "picture_format");
        path.set_extension(format.map_or("png", |(_, format)| format.as_str()));
    }
    let is_input =
        fs::canonicalize(&path).ok().is_some_and(|path| fs::canonicalize(input).ok() == Some(path));
    match is_input {
        true => Err(wrong(format!("{} would be overwritten; choose another folder", input.display()))),
        false => Ok(FileOrStream::File(path)),
    }
}

/// The whole report of the only file.
fn tell(errand: &Errand<'_>, done: &FinishedFile) -> Exit {
    if errand.request.is_json {
        print_json(&done.report);
    } else {
        let subject = Subject { input: errand.subject(), written: done.written.clone() };
        let text = summary(&done.report, &subject);
        if errand.output == Some(FileOrStream::Stream) {
            // The mesh has standard output for itself.
            let _ = anstream::stderr().write_all(text.as_bytes());
        } else {
            print(&text);
        }
    }
    done.exit
}

fn tell_problem(request: &Request, problem: &Problem) -> Exit {
    say(&problem.detail);
    if request.is_json {
        print_json(problem);
    }
    Exit::of(problem)
}

/// A line for each file as it ends, and the sum.
fn run_all(request: &Request, errands: &[Errand<'_>]) -> Exit {
    let width = errands.iter().map(|errand| errand.subject().chars().count()).max().unwrap_or(0);
    let mut exits = Vec::with_capacity(errands.len());
    for errand in errands {
        let input = errand.subject();
        let result = run_one(errand);
        exits.push(result.as_ref().map_or_else(Exit::of, |done| done.exit));
        if request.is_json {
            print(&format!("{}\n", json_line(&input, &result)));
        } else {
            let (style, told) = row(&input, &result);
            print(&format!("{input:width$}  {}\n", painted(style, &told)));
        }
    }
    if !request.is_json {
        print(&sum(request, &exits));
    }
    exits.into_iter().max_by_key(|&exit| exit as u8).unwrap_or(Exit::Done)
}

/// What became of a file, in a line that begins with its name.
fn row(input: &str, result: &Result<FinishedFile, Problem>) -> (Style, String) {
    let done = match result {
        Ok(done) => done,
        Err(problem) => return (BAD, without_name(input, &problem.detail).to_owned()),
    };
    let verdict = &done.report.verdict;
    let style = match (done.exit, verdict.printable, verdict.fidelity) {
        (Exit::Done, true, Some(Fidelity::Changed)) | (Exit::Done, false, _) => DOUBTFUL,
        (Exit::Done, true, _) => GOOD,
        _ => BAD,
    };
    let outcome = verdict.outcome.map(|outcome| outcome.to_string());
    let printable = if verdict.printable { "printable" } else { "not printable" };
    let fidelity = verdict.fidelity.map(|fidelity| fidelity.to_string());
    let defects = done.report.before.as_ref().filter(|_| done.written.is_none()).map(|mesh| {
        let errors = mesh.defects.iter().filter(|defect| defect.severity == crate::wire::Severity::Error);
        counted(errors.map(|defect| defect.count).sum(), "error")
    });
    let reason = verdict.reasons.first().map(|reason| with_flags(&reason.message));
    let written = done.written.as_ref().map(|place| format!("written: {place}"));
    let words = [outcome, Some(printable.to_owned()), fidelity, defects, reason, written];
    (style, words.into_iter().flatten().collect::<Vec<_>>().join(", "))
}

/// What is told of the file alone, without its name in front.
fn without_name<'t>(input: &str, told: &'t str) -> &'t str {
    let rest = told.strip_prefix(input).and_then(|rest| rest.strip_prefix([':', ' ']));
    rest.map_or(told, str::trim_start)
}

/// How many files ended in which way.
fn sum(request: &Request, exits: &[Exit]) -> String {
    let count = |wanted: &[Exit]| exits.iter().filter(|exit| wanted.contains(exit)).count();
    let no = match request.target {
        OutputTarget::None => "not valid",
        _ => "without a result as asked",
    };
    let rows = [
        (GOOD, count(&[Exit::Done]), "done"),
        (BAD, count(&[Exit::Negative]), no),
        (BAD, count(&[Exit::Usage]), "not readable"),
        (BAD, count(&[Exit::Stopped]), "stopped at a limit"),
        (BAD, count(&[Exit::Internal]), "failed"),
    ];
    let rows: Vec<_> = rows
        .into_iter()
        .filter(|&(_, count, _)| count > 0)
        .map(|(style, count, word)| (style, [count.to_string(), word.to_owned()]))
        .collect();
    format!("{}\n{}\n", counted(exits.len() as u64, "file"), aligned(&rows).join("\n"))
}

/// A file's report or problem as one line.
fn json_line(input: &str, result: &Result<FinishedFile, Problem>) -> Value {
    match result {
        Ok(done) => json!({"input": input, "written": done.written, "report": done.report}),
        Err(problem) => json!({"input": input, "problem": problem}),
    }
}

fn print_json(value: &impl serde::Serialize) {
    match serde_json::to_string_pretty(value) {
        Ok(text) => print(&format!("{text}\n")),
        Err(error) => say(&error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_named_once_in_its_line() {
        for (told, want) in [
            ("a.stl cannot be read: it is a folder", "cannot be read: it is a folder"),
            ("a.stl: line 3: a number is missing", "line 3: a number is missing"),
            ("a.stla is another name", "a.stla is another name"),
            (
                "--json and --output - both want standard output",
                "--json and --output - both want standard output",
            ),
        ] {
            let result = Err(Problem::new(crate::wire::ProblemCode::NotFound, told));
            assert_eq!(row("a.stl", &result).1, want);
        }
    }
}
