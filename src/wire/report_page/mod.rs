//! The report as a page for people: one file that loads nothing, with a style sheet and a picture inside.
//!
//! It is made from the report's JSON, so that a kept report and a fresh one look the same. Every text is escaped.

mod markup;
mod plain;
mod printing;

pub use markup::Escaped;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use markup::{HtmlPage, TableCell, Tone, figure, items, measured, text};
use serde_json::Value;

const STYLE: &str = include_str!("style.css");

/// What a browser may do with the page: show it in its own style. The digest is that of the style sheet.
pub const REPORT_PAGE_CSP: &str = "default-src 'none'; img-src data:; style-src 'sha256-kKw7wLNHGE4HKkoSVwZG5MFg0Nmjx8COv8qMgft/Q8k='; base-uri 'none'; form-action 'none'";

/// Witnesses that are shown of each defect.
const PLACES: usize = 3;

/// The page of a report, which is `report` as JSON; `picture`: one of the mesh, and of the result beside it if there is one, which
/// is shown if it is a PNG.
pub fn report_page(report: &Value, picture: Option<&[u8]>) -> String {
    let mut page = HtmlPage(String::new());
    page.add(format_args!(
        "<!doctype html><html lang=en><head><meta charset=utf-8>\
         <meta name=viewport content=\"width=device-width\">\
         <meta http-equiv=Content-Security-Policy content=\"{REPORT_PAGE_CSP}\">\
         <title>Report on a 3D file</title><style>{STYLE}</style></head><body><main>"
    ));
    head(&mut page, report);
    verdict(&mut page, report);
    if let Some(picture) = picture.filter(|picture| !picture.starts_with(b"glTF")) {
        show(&mut page, report, picture);
    }
    found(&mut page, report);
    done(&mut page, report);
    filled(&mut page, report);
    moved(&mut page, report);
    printing::add(&mut page, &report["printing"]);
    certificate(&mut page, report);
    page.add(format_args!("</main></body></html>\n"));
    page.0
}

fn head(page: &mut HtmlPage, report: &Value) {
    let input = &report["input"];
    let known = if input["units"]["is_stated"] == true { "" } else { " (assumed)" };
    page.add(format_args!("<h1>Report on your 3D file</h1>"));
    page.add(format_args!(
        "<p class=quiet>{}, {} bytes, unit {}{known}. Made by {} {}.</p>",
        Escaped(text(&input["encoding"])),
        input["bytes"],
        Escaped(text(&input["units"]["unit"])),
        Escaped(text(&report["engine"]["name"])),
        Escaped(text(&report["engine"]["version"])),
    ));
    for (further, number) in report["further_inputs"].as_array().into_iter().flatten().zip(2..) {
        let input = &further["input"];
        let encoding = Escaped(text(&input["encoding"]));
        page.add(format_args!("<p class=quiet>Mesh {number}: {encoding}, {} bytes.</p>", input["bytes"]));
    }
}

fn verdict(page: &mut HtmlPage, report: &Value) {
    let verdict = &report["verdict"];
    let printing = &report["printing"];
    let is_printable = verdict["printable"] == true;
    let is_changed = verdict["fidelity"] == "changed";
    let (tone, title) = match (is_printable, text(&printing["verdict"]), is_changed) {
        (false, _, _) => (Tone::Bad, "Not a valid solid"),
        (true, "error", false) => (Tone::Bad, "A valid solid, but not for this process"),
        (true, "error", true) => (Tone::Bad, "A valid solid, but changed, and not for this process"),
        (true, _, true) => (Tone::Bad, "A valid solid, but not what your file shows"),
        (true, "warning", false) => (Tone::Fair, "A valid solid, with warnings for this process"),
        (true, _, false) => (Tone::Good, "A valid solid"),
    };
    page.add(format_args!("<div class=\"verdict {}\"><strong>{title}</strong>", tone.class()));
    page.paragraph(plain::outcome(text(&verdict["outcome"])));
    if let Some(word) = verdict["fidelity"].as_str() {
        page.paragraph(plain::fidelity(word, verdict["outcome"] == "combined"));
    }
    for change in items(&verdict["changes"]) {
        page.paragraph(&sentence(text(&change["message"])));
    }
    for reason in items(&verdict["reasons"]) {
        page.paragraph(&sentence(text(&reason["message"])));
    }
    page.add(format_args!("</div>"));
}

/// The picture, with what its colours mean.
fn show(page: &mut HtmlPage, report: &Value, picture: &[u8]) {
    let has_other = report["after"].is_object();
    let is_drawing = text(&report["operation"]) == "render";
    let several = !items(&report["further_inputs"]).is_empty();
    let (title, told) = if is_drawing {
        (
            "The picture",
            "Lines, coloured faces and rings show defects; red is the inside of the surface, seen through a hole or \
             because a part is inside out. Where a second mesh stands beside the first, its green faces are not in the \
             first.",
        )
    } else if several && has_other {
        (
            "Your files, and the result",
            "Left your files as they lie together, right the result, from the same side. Lines, coloured faces and rings \
             show defects; red is the inside of the surface. In the result green faces are new and grey ones are those \
             of your files.",
        )
    } else if has_other {
        (
            "Your file, and the result",
            "Left your file, right the result, from the same side. Lines, coloured faces and rings show defects; red is \
             the inside of the surface, seen through a hole or because a part is inside out. In the result green faces \
             are new and grey ones are those of your file.",
        )
    } else {
        (
            "Your file",
            "Lines, coloured faces and rings show defects; red is the inside of the surface, seen through a hole or \
             because a part is inside out.",
        )
    };
    page.add(format_args!(
        "<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>",
        Escaped(title),
        BASE64.encode(picture),
        Escaped(told)
    ));
}

/// With a capital letter and a full stop.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| format!("{}{}.", first.to_uppercase(), letters.as_str()))
}

fn found(page: &mut HtmlPage, report: &Value) {
    let before = &report["before"];
    if before.is_null() {
        return;
    }
    page.heading("What was found");
    let (counts, measures) = (&before["counts"], &before["measures"]);
    let unit = text(&report["input"]["units"]["unit"]);
    page.paragraph(&format!(
        "Triangles: {}. Parts: {}, of which closed: {}. Surface: {} {unit}\u{b2}.",
        counts["triangles"],
        counts["components"],
        counts["closed_components"],
        measured(&measures["area"], ""),
    ));
    // What follows the question speaks of an option, which is nothing for the one who reads this.
    if let Some((question, _)) =
        before["unit_hypothesis"]["question"].as_str().and_then(|q| q.split_once('?'))
    {
        page.paragraph(&format!("{question}? The file was taken in {unit}."));
    }
    // The worst first.
    let mut defects: Vec<&Value> = items(&before["defects"]).iter().collect();
    let rank = |defect: &&Value| match text(&defect["severity"]) {
        "error" => 0,
        "warning" => 1,
        _ => 2,
    };
    defects.sort_by_key(rank);
    if defects.is_empty() {
        page.paragraph("No defects.");
    }
    let row = |defect: &Value| {
        let (tone, word) = match text(&defect["severity"]) {
            "error" => (Tone::Bad, "error"),
            "warning" => (Tone::Fair, "warning"),
            _ => (Tone::Open, "note"),
        };
        let places: Vec<String> = items(&defect["witnesses"]).iter().take(PLACES).map(place).collect();
        vec![
            TableCell::Mark(tone, word),
            TableCell::Text(plain::defect(text(&defect["code"])).to_owned()),
            TableCell::Number(format!("{}{}", defect["count"], or_more(defect))),
            TableCell::Text(places.join("; ")),
        ]
    };
    let rows = defects.iter().copied().map(row).collect();
    page.table(&["", "Defect", "How many", "First places"], rows);
    holes(page, &defects);
}

/// The boundary loops that are listed, counted from 1.
fn holes(page: &mut HtmlPage, defects: &[&Value]) {
    let loops = defects.iter().filter(|defect| defect["code"] == "boundary-loop");
    let row = |(number, witness): (usize, &Value)| {
        let figure_of = |name: &str| {
            let told = items(&witness["figures"]).iter().find(|figure| figure["name"] == name);
            told.and_then(|told| told["value"].as_f64())
        };
        let number_of = |name: &str| figure_of(name).map_or_else(String::new, figure);
        let sure = figure_of("confidence").map(|share| format!("{} %", figure(share * 100.0)));
        vec![
            TableCell::Number((number + 1).to_string()),
            TableCell::Text(plain::hole(text(&witness["hole"])).to_owned()),
            TableCell::Number(sure.unwrap_or_default()),
            TableCell::Number(number_of("edges")),
            TableCell::Number(number_of("length")),
            TableCell::Text(place(witness)),
        ]
    };
    let rows = loops.flat_map(|defect| items(&defect["witnesses"]).iter().enumerate()).map(row).collect();
    page.table(&["Hole", "Most likely", "How sure", "Edges", "Length", "First place"], rows);
}

/// Where a defect is: its line in the file and its coordinates; the number of a face or vertex where there is neither.
fn place(witness: &Value) -> String {
    let first = |name: &'static str, list: &Value| items(list).first().map(|first| (name, first.clone()));
    let element = first("face", &witness["faces"]).or_else(|| first("vertex", &witness["vertices"]));
    let line = element.as_ref().and_then(|(_, first)| first["line"].as_u64());
    let line = line.map(|line| format!("line {line}"));
    let at = coordinates(&witness["position"]).map(|at| format!("at {at}"));
    match [line, at] {
        [None, None] => element.map_or_else(String::new, |(name, first)| {
            format!("{name} {} of the file, counted from 0", first["index"])
        }),
        told => told.into_iter().flatten().collect::<Vec<_>>().join(" "),
    }
}

/// The coordinates of a place; what is nothing beside the largest of them is zero.
fn coordinates(position: &Value) -> Option<String> {
    let numbers: Vec<f64> = items(position).iter().filter_map(Value::as_f64).collect();
    let largest = numbers.iter().fold(0.0, |largest: f64, number| largest.max(number.abs()));
    let told = |&number: &f64| figure(if number.abs() < 1e-6 * largest { 0.0 } else { number });
    (numbers.len() == 3).then(|| numbers.iter().map(told).collect::<Vec<_>>().join(", "))
}

fn done(page: &mut HtmlPage, report: &Value) {
    let changed = |action: &&Value| items(&action["changes"]).iter().any(|change| change["count"] != 0);
    let actions: Vec<&Value> = items(&report["actions"]).iter().filter(changed).collect();
    if actions.is_empty() {
        return;
    }
    page.heading("What was changed");
    let row = |action: &&Value| {
        let changes = items(&action["changes"]).iter().filter(|change| change["count"] != 0);
        let changes = changes.map(|change| format!("{}: {}", words(text(&change["name"])), change["count"]));
        let causes = items(&action["causes"]).iter().map(|cause| plain::cause(text(cause)));
        vec![
            TableCell::Text(plain::step(text(&action["step"]))),
            TableCell::Text(changes.collect::<Vec<_>>().join(", ")),
            TableCell::Text(each_once(causes).join(", ")),
            TableCell::Text(text(&action["reason"]).to_owned()),
        ]
    };
    let rows = actions.iter().map(row).collect();
    page.table(&["What", "How many", "Because of", "Choice"], rows);
}

/// The words, each where it stands first.
fn each_once(words: impl Iterator<Item = String>) -> Vec<String> {
    let mut told: Vec<String> = Vec::new();
    for word in words {
        if !told.contains(&word) {
            told.push(word);
        }
    }
    told
}

/// What is said behind the count of a defect that may be there more often.
fn or_more(defect: &Value) -> &'static str {
    if defect["is_at_least"] == true { " or more" } else { "" }
}

/// A code as words.
fn words(code: &str) -> String {
    code.replace(['-', '_'], " ")
}

/// Holes of which the page tells what became of them.
const HOLES: usize = 100;

fn filled(page: &mut HtmlPage, report: &Value) {
    let holes = items(&report["holes"]);
    if holes.is_empty() {
        return;
    }
    page.heading("What became of the holes");
    let row = |hole: &Value| {
        let loops: Vec<String> =
            items(&hole["loops"]).iter().filter_map(Value::as_u64).map(|at| (at + 1).to_string()).collect();
        let (tone, word) = match text(&hole["fate"]) {
            "filled" => (Tone::Good, "filled"),
            "kept" => (Tone::Open, "kept"),
            _ => (Tone::Bad, "open"),
        };
        let why = |one: &Value| {
            let at = coordinates(&one["position"]).map_or_else(String::new, |at| format!(" near {at}"));
            format!("{}: {}{at}", text(&one["method"]), plain::rejection(text(&one["reason"])))
        };
        let rejected = items(&hole["rejected"]).iter().map(why);
        vec![
            TableCell::Number(loops.join(", ")),
            TableCell::Text(plain::hole(text(&hole["class"])).to_owned()),
            TableCell::Mark(tone, word),
            TableCell::Text(text(&hole["used"]).to_owned()),
            TableCell::Number(hole["triangles"].to_string()),
            TableCell::Text(rejected.collect::<Vec<_>>().join(", ")),
        ]
    };
    let rows = holes.iter().take(HOLES).map(row).collect();
    page.table(&["Hole", "Most likely", "", "By", "Triangles", "Patches that were not taken"], rows);
}

fn moved(page: &mut HtmlPage, report: &Value) {
    let deviation = &report["deviation"];
    if report["certificate"].is_null() {
        return;
    }
    page.heading("How far the result is from your file");
    let unit = format!(" {}", text(&report["output_units"]));
    let percent = |value: &Value| match value.as_f64() {
        Some(share) => format!("{} %", figure(share * 100.0)),
        None => "\u{2013}".to_owned(),
    };
    let rows = [
        ("Largest distance from what can be seen of your file", measured(&deviation["hausdorff_max"], &unit)),
        ("Triangles that are exactly the same", percent(&deviation["identical_triangle_share"])),
        ("Change of the volume", percent(&deviation["volume_change_share"])),
        ("Visible surface that was lost", percent(&deviation["visible_loss"])),
        ("Surface that your file does not have", percent(&deviation["invented"])),
        ("Bodies that were lost", measured(&deviation["bodies_lost"], "")),
    ];
    let row =
        |(name, value): (&str, String)| vec![TableCell::Text(name.to_owned()), TableCell::Number(value)];
    page.table(&[], rows.into_iter().map(row).collect());
}

fn certificate(page: &mut HtmlPage, report: &Value) {
    let (judged, about) = match &report["certificate"] {
        Value::Null => (&report["input_certificate"], "your file"),
        certificate => (certificate, "the returned file"),
    };
    page.heading("Certificate");
    page.paragraph(&format!(
        "Checked exactly on the bytes of {about}, in every way in which programs read them."
    ));
    let claims = [
        ("p0", "Topology: every edge has exactly two faces, and none is degenerate or there twice."),
        ("p1", "Embedding: no two faces pass through, lie on or touch each other."),
        ("p2", "Solid: every point is clearly inside or outside."),
    ];
    let mark = |holds: &Value| match holds.as_bool() {
        Some(true) => TableCell::Mark(Tone::Good, "holds"),
        Some(false) => TableCell::Mark(Tone::Bad, "broken"),
        None => TableCell::Mark(Tone::Open, "not told"),
    };
    let row = |(name, meaning): (&str, &str)| {
        vec![mark(&judged[name]["holds"]), TableCell::Text(meaning.to_owned())]
    };
    let mut rows: Vec<Vec<TableCell>> = claims.into_iter().map(row).collect();
    if report["printing"].is_object() {
        let meaning = "Manufacturable: within the limits of the process. Measured, not proved.";
        rows.push(vec![mark(&report["printing"]["p3_holds"]), TableCell::Text(meaning.to_owned())]);
    }
    page.table(&[], rows);
    page.add(format_args!(
        "<p class=quiet>SHA-256 of those bytes: <code>{}</code></p>",
        Escaped(text(&judged["sha256"]))
    ));
}

#[cfg(test)]
mod tests;
