//! The command line from outside: exit codes, streams, and files that appear whole or not at all.

use crate::meshes::MOEBIUS;
use serde_json::Value;
use std::fs;
use std::io::{Read as _, Write as _};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

/// A tetrahedron, valid.
const SOLID: &str = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
/// The same without its last face.
const OPEN: &str = "OFF\n4 3 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n";
/// A triangle whose corners are on a line: nothing to repair.
const LINE: &str = "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n";
/// Two tetrahedra, one pierced by the other.
const CROSSING: &str = "OFF\n8 8 12\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n1 1 -1\n2 1 -1\n1 2 -1\n1 1 9\n\
                        3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 4 6 5\n3 4 5 7\n3 4 7 6\n3 5 6 7\n";

/// A folder with the meshes above, and the binary run in it.
struct Desk {
    folder: tempfile::TempDir,
}

impl Desk {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [
            ("solid.off", SOLID),
            ("open.off", OPEN),
            ("crossing.off", CROSSING),
            ("moebius.off", MOEBIUS),
            ("line.off", LINE),
            ("broken.off", "OFF\n4 4 6\n0 0 zero\n"),
            ("noise.stl", "neither this nor that"),
            ("empty.obj", ""),
        ] {
            fs::write(folder.path().join(name), text).unwrap();
        }
        Self { folder }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_meshmend"));
        for (name, _) in std::env::vars_os() {
            if name.to_string_lossy().starts_with("MESHMEND_") {
                command.env_remove(name);
            }
        }
        command.current_dir(self.path()).args(args).stdin(Stdio::null());
        command
    }

    fn run(&self, args: &[&str]) -> Output {
        self.command(args).output().unwrap()
    }

    fn run_with_input(&self, args: &[&str], input: &str) -> Output {
        let mut child = spawn(self.command(args).stdin(Stdio::piped()));
        // A run that fails early does not read.
        let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
        child.wait_with_output().unwrap()
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path().join(name)).unwrap()
    }

    /// Files that were not there at the beginning.
    fn new_files(&self) -> Vec<String> {
        let names = fs::read_dir(self.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
        let begun = [
            "solid.off",
            "open.off",
            "crossing.off",
            "moebius.off",
            "line.off",
            "broken.off",
            "noise.stl",
            "empty.obj",
        ];
        let mut names: Vec<_> = names.filter(|name| !begun.contains(&name.as_str())).collect();
        names.sort();
        names
    }
}

fn spawn(command: &mut Command) -> Child {
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}: {}", stdout(output)))
}

#[test]
fn exit_codes_say_what_happened() {
    let table: &[(i32, &[&str])] = &[
        (0, &["--version"]),
        (0, &["repair", "--help"]),
        (0, &["analyze", "solid.off"]),
        (0, &["analyze", "open.off"]),
        (0, &["plan", "open.off"]),
        (0, &["verify", "solid.off"]),
        (0, &["repair", "solid.off", "-o", "out.off"]),
        (0, &["repair", "open.off", "-o", "out.stl"]),
        (0, &["convert", "solid.off", "-o", "out.ply"]),
        (0, &["convert", "open.off", "-o", "out.obj"]),
        (1, &["repair", "open.off", "-o", "out.off", "--require", "faithful"]),
        (0, &["repair", "solid.off", "-o", "out.off", "--require", "faithful"]),
        (1, &["convert", "open.off", "-o", "out.stl", "--require", "printable"]),
        (1, &["verify", "open.off"]),
        (1, &["verify", "crossing.off"]),
        (1, &["repair", "line.off", "-o", "out.off"]),
        (0, &["repair", "crossing.off", "-o", "out.off", "--best-effort", "--wrap-cells", "24"]),
        (2, &["repair"]),
        (2, &["repair", "solid.off"]),
        (2, &["analyze", "absent.off"]),
        (2, &["analyze", "."]),
        (2, &["analyze", "broken.off"]),
        (2, &["analyze", "noise.stl"]),
        (2, &["analyze", "empty.obj"]),
        (2, &["analyze", "solid.off", "--unknown"]),
        (2, &["analyze", "solid.off", "--require", "printable"]),
        (2, &["repair", "open.off", "-o", "out.off", "--wall-mm", "-1"]),
        (2, &["analyze", "solid.off", "--units", "parsec"]),
        (2, &["analyze", "solid.off", "--samples", "many"]),
        (2, &["frobnicate", "solid.off"]),
        (4, &["repair", "solid.off", "-o", "absent/out.off"]),
        (4, &["repair", "solid.off", "-o", "."]),
        (4, &["repair", "solid.off", "-d", "open.off"]),
        (2, &["convert", "solid.off", "-o", "out.unknown"]),
        (2, &["repair", "open.off", "-o", "out.unknown"]),
        (2, &["convert", "solid.off", "-o", "-"]),
        (2, &["convert", "solid.off", "-o", "-", "--output-format", "stl", "--json"]),
        (2, &["verify", "-"]),
        (2, &["verify", "solid.off", "--config", "absent.toml"]),
        (0, &["repair", "solid.off", "open.off", "-d", "out"]),
        (0, &["analyze", "solid.off", "open.off"]),
        (1, &["verify", "solid.off", "open.off"]),
        (2, &["verify", "open.off", "broken.off", "solid.off"]),
        (2, &["repair", "solid.off", "open.off", "-o", "out.off"]),
        (2, &["repair", "solid.off", "-d", "."]),
        (2, &["repair", "solid.off", "-o", "out.off", "-d", "out"]),
        (2, &["verify", "solid.off", "-"]),
        (0, &["boolean", "solid.off", "crossing.off", "-o", "out.stl"]),
        (
            0,
            &[
                "boolean",
                "--operation",
                "intersection",
                "crossing.off",
                "solid.off",
                "solid.off",
                "-o",
                "out.off",
            ],
        ),
        (1, &["boolean", "solid.off", "solid.off", "-o", "out.off", "--set-operation", "difference"]),
        (1, &["boolean", "solid.off", "open.off", "-o", "out.off"]),
        (2, &["boolean", "solid.off", "-o", "out.off"]),
        (2, &["boolean", "solid.off", "crossing.off"]),
        (2, &["boolean", "solid.off", "broken.off", "-o", "out.off"]),
        (2, &["boolean", "solid.off", "-", "-o", "out.off", "--format", "off"]),
        (2, &["completions", "tcsh9"]),
        (3, &["analyze", "solid.off", "--triangles-max", "3"]),
        (3, &["repair", "solid.off", "-o", "out.off", "--engine-bytes-max", "1B"]),
        (3, &["verify", "solid.off", "--engine-work-max", "0"]),
    ];
    for (code, args) in table {
        let output = Desk::new().run(args);
        assert_eq!(output.status.code(), Some(*code), "{args:?}: {}{}", stdout(&output), stderr(&output));
    }
}

#[test]
fn solids_are_combined_into_one_file() {
    let desk = Desk::new();
    let made = desk.run(&[
        "boolean",
        "--operation",
        "difference",
        "crossing.off",
        "solid.off",
        "-o",
        "out.stl",
        "--json",
    ]);
    assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
    let report = json(&made);
    assert_eq!(
        (&report["verdict"]["outcome"], &report["verdict"]["printable"]),
        (&"combined".into(), &true.into())
    );
    assert_eq!(desk.run(&["verify", "out.stl"]).status.code(), Some(0));
    let told = stdout(&desk.run(&["boolean", "crossing.off", "solid.off", "-o", "out.off"]));
    assert!(
        told.contains("crossing.off, solid.off") && told.contains("mesh 2: off") && told.contains("union"),
        "{told}"
    );
    let told = stderr(&desk.run(&["boolean", "solid.off", "broken.off", "-o", "none.off"]));
    assert!(told.contains("mesh 2: "), "{told}");
    assert!(!desk.new_files().contains(&"none.off".to_owned()));
}

#[cfg(target_os = "linux")]
#[test]
fn a_result_that_cannot_be_stored_is_an_internal_error() {
    let output = Desk::new().run(&["repair", "solid.off", "-o", "/dev/full", "--output-format", "off"]);
    assert_eq!(output.status.code(), Some(4), "{}", stderr(&output));
}

#[test]
fn a_command_without_arguments_prints_a_short_help() {
    for command in
        ["analyze", "plan", "repair", "verify", "convert", "simplify", "cut-stitch", "fill-holes", "modeller"]
    {
        let output = Desk::new().run(&[command]);
        assert!(stderr(&output).contains(&format!("Usage: meshmend {command}")), "{}", stderr(&output));
        assert!(stderr(&output).lines().count() < 120, "it is short");
    }
}

#[test]
fn the_modeller_edits_a_solid_and_refuses_what_would_be_none() {
    let desk = Desk::new();
    let shift = |by: f64| {
        format!(r#"[{{"shift":{{"faces":[{{"face":{{"normal":[0,0,-1],"at":[0,0,0]}},"by_mm":{by}}}]}}}}]"#)
    };
    let run = |args: &[&str]| desk.run(args);
    let asked = run(&["modeller", "solid.off", "--ranges", "[0]", "--json"]);
    assert_eq!(asked.status.code(), Some(0), "{}", stderr(&asked));
    let report: Value = serde_json::from_str(&stdout(&asked)).unwrap();
    assert_eq!(report["modeller"]["ranges"].as_array().unwrap().len(), 1);
    let edited = run(&["modeller", "solid.off", "-o", "out.off", "--operators", &shift(-0.5)]);
    assert_eq!(edited.status.code(), Some(0), "{}{}", stdout(&edited), stderr(&edited));
    assert!(stdout(&edited).contains("verdict: modelled, printable: a valid solid"), "{}", stdout(&edited));
    assert!(stdout(&edited).contains("shift"), "{}", stdout(&edited));
    assert_eq!(run(&["verify", "out.off"]).status.code(), Some(0));
    let refused = run(&["modeller", "solid.off", "-o", "none.off", "--operators", &shift(-1.0)]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(stdout(&refused).contains("operator 0 is refused"), "{}", stdout(&refused));
    assert!(!desk.path().join("none.off").exists());
}

#[test]
fn several_files_are_repaired_into_a_folder_and_told_line_by_line() {
    let desk = Desk::new();
    let output = desk.run(&["repair", "solid.off", "open.off", "line.off", "broken.off", "-d", "out/made"]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let text = stdout(&output);
    let line = |name: &str| text.lines().find(|line| line.starts_with(name)).unwrap_or_default().to_owned();
    assert!(line("solid.off").contains("identical, printable, exact, written: out/made/solid.off"), "{text}");
    assert!(line("open.off").contains("repaired, printable, changed"), "{text}");
    assert!(line("line.off").contains("refused, not printable"), "{text}");
    assert!(line("broken.off").contains("line 3"), "{text}");
    assert!(text.ends_with("4 files\n2  done\n1  without a result as asked\n1  not readable\n"), "{text}");
    assert_eq!(desk.read("out/made/solid.off"), SOLID);
    let mut made: Vec<_> = fs::read_dir(desk.path().join("out/made"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    made.sort();
    assert_eq!(made, ["open.off", "solid.off"]);
    // The extension follows the format, and a result never takes the place of another or of its input.
    desk.run(&["convert", "solid.off", "open.off", "-d", "out", "--output-format", "stl"]);
    assert!(desk.path().join("out/solid.stl").exists() && desk.path().join("out/open.stl").exists());
    let twice = desk.run(&["repair", "solid.off", "./solid.off", "-d", "twice"]);
    assert!(stderr(&twice).contains("two results would be twice/solid.off"), "{}", stderr(&twice));
    let over = desk.run(&["repair", "solid.off", "-d", "."]);
    assert!(stderr(&over).contains("solid.off would be overwritten"), "{}", stderr(&over));
}

#[test]
fn the_json_of_several_files_is_an_object_a_line() {
    let desk = Desk::new();
    let output = desk.run(&["analyze", "open.off", "broken.off", "--json"]);
    let lines: Vec<Value> = stdout(&output).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 2);
    assert_eq!((&lines[0]["input"], &lines[1]["input"]), (&"open.off".into(), &"broken.off".into()));
    assert_eq!(lines[0]["report"]["verdict"]["printable"], false);
    assert_eq!(lines[1]["problem"]["code"], "mesh-unparseable");
}

#[test]
fn nothing_has_colours_where_standard_output_is_no_terminal() {
    let desk = Desk::new();
    let output = desk.command(&["analyze", "open.off"]).env("TERM", "xterm-256color").output().unwrap();
    assert!(!stdout(&output).contains('\u{1b}'), "{}", stdout(&output));
    let forced = desk.command(&["analyze", "open.off"]).env("CLICOLOR_FORCE", "1").output().unwrap();
    assert!(stdout(&forced).starts_with("\u{1b}["), "{}", stdout(&forced));
}

#[test]
fn shells_and_man_are_told_the_commands_and_their_options() {
    let desk = Desk::new();
    for shell in ["bash", "zsh", "fish"] {
        let script = stdout(&desk.run(&["completions", shell]));
        assert!(script.contains("cut-stitch") && script.contains("wall-mm"), "{shell}");
    }
    assert_eq!(desk.run(&["man", "pages"]).status.code(), Some(0));
    let page = desk.read("pages/meshmend-repair.1");
    assert!(page.contains("nothing is written unless it is certified"), "{page}");
    assert_eq!(desk.run(&["man", "solid.off/pages"]).status.code(), Some(4));
}

#[test]
fn the_first_line_says_what_a_customer_must_know() {
    let desk = Desk::new();
    let first = |args: &[&str]| stdout(&desk.run(args)).lines().next().unwrap_or_default().to_owned();
    let line = first(&["repair", "open.off", "-o", "out.off"]);
    assert!(line.starts_with("verdict: repaired, printable: a valid solid; changed: "), "{line}");
    assert!(line.contains(" % of the surface is invented (faithful: at most 1 %)"), "{line}");
    let line = first(&["repair", "solid.off", "-o", "out.off", "--policy", "sls"]);
    assert!(line.starts_with("verdict: identical, printable: a valid solid; exact; sls holds"), "{line}");
    let line = first(&["analyze", "open.off"]);
    assert!(line.starts_with("verdict: not printable; "), "{line}");
}

#[test]
fn the_help_of_an_operation_lists_its_options_only() {
    let desk = Desk::new();
    let help = |command: &str| stdout(&desk.run(&[command, "--help"]));
    assert!(help("repair").contains("--wall-mm") && !help("verify").contains("--wall-mm"));
    assert!(help("cut-stitch").contains("--stitch ") && !help("repair").contains("--stitch "));
}

#[test]
fn a_misspelt_flag_value_or_command_is_answered_with_the_nearest_one() {
    let desk = Desk::new();
    for (args, hint) in [
        (&["analyse", "solid.off"][..], "'analyze'"),
        (&["analyze", "solid.off", "--unit", "mm"], "'--units'"),
        (&["convert", "solid.off", "-o", "out.stl", "--require", "printible"], "'printable'"),
        (
            &["verify", "solid.off", "--wall-mm", "1"],
            "`verify` takes no `--wall-mm`; it is an option of repair",
        ),
        (
            &["repair", "open.off", "-o", "out.off", "--wall-mm", "-1"],
            "`--wall-mm` cannot be `-1`; expected a number from 1e-6",
        ),
        (&["serve", "--admin-listn", "off"], "'--admin-listen'"),
    ] {
        let output = desk.run(args);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(hint), "{args:?}: {}", stderr(&output));
    }
}

#[test]
fn an_unreadable_file_is_told_with_its_line_and_what_was_expected() {
    let output = Desk::new().run(&["analyze", "broken.off"]);
    assert!(
        stderr(&output).contains("line 3") && stderr(&output).contains("expected"),
        "{}",
        stderr(&output)
    );
    assert_eq!(stdout(&output), "");
}

#[test]
fn a_valid_file_comes_back_as_the_same_bytes() {
    let desk = Desk::new();
    desk.run(&["repair", "solid.off", "-o", "out.off"]);
    assert_eq!(desk.read("out.off"), SOLID);
}

#[test]
fn the_extension_of_the_output_names_its_format() {
    let desk = Desk::new();
    assert!(desk.run(&["convert", "solid.off", "-o", "out.obj"]).status.success());
    assert!(desk.read("out.obj").contains("\nf ") || desk.read("out.obj").starts_with("f "));
    assert!(desk.run(&["convert", "solid.off", "-o", "out.obj", "--output-format", "off"]).status.success());
    assert!(desk.read("out.obj").starts_with("OFF"));
    let unknown = desk.run(&["repair", "open.off", "-o", "out.unknown"]);
    let complaint = String::from_utf8(unknown.stderr).unwrap();
    assert!(complaint.contains("no mesh format has the file extension .unknown"), "{complaint}");
    assert!(!desk.path().join("out.unknown").exists());
    let picture = desk.run(&["render", "solid.off", "-o", "out.jpg"]);
    let complaint = String::from_utf8(picture.stderr).unwrap();
    assert!(complaint.contains("cannot have the extension .jpg"), "{complaint}");
    assert!(!desk.path().join("out.jpg").exists());
}

#[test]
fn nothing_is_written_without_a_certificate() {
    let desk = Desk::new();
    fs::write(desk.path().join("out.off"), "what was there before").unwrap();
    let output = desk.run(&["repair", "line.off", "-o", "out.off"]);
    assert!(
        stdout(&output).contains("refused") && stdout(&output).contains("nothing written"),
        "{}",
        stdout(&output)
    );
    assert_eq!(desk.read("out.off"), "what was there before");
    assert_eq!(desk.new_files(), ["out.off"]);
}

#[test]
fn what_is_mended_is_written_when_nothing_is_required_and_still_says_no() {
    let desk = Desk::new();
    let output = desk.run(&["repair", "moebius.off", "-o", "out.off", "--require", "none"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stdout(&output).contains("partial"), "{}", stdout(&output));
    assert!(desk.read("out.off").starts_with("OFF"));
    assert_eq!(desk.new_files(), ["out.off"]);
}

#[test]
fn a_file_can_be_repaired_in_place() {
    let desk = Desk::new();
    assert!(desk.run(&["repair", "open.off", "-o", "open.off"]).status.success());
    assert!(desk.run(&["verify", "open.off"]).status.success());
    assert_eq!(desk.new_files(), Vec::<String>::new());
}

#[test]
fn streams_work_where_their_formats_are_named() {
    let desk = Desk::new();
    let args = ["repair", "-", "--format", "off", "-o", "-", "--output-format", "obj"];
    let output = desk.run_with_input(&args, OPEN);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stdout(&output).lines().any(|line| line.starts_with("f ")));
    assert!(stderr(&output).contains("verdict: repaired"), "{}", stderr(&output));
    let output = desk.run_with_input(&["verify", "-", "--format", "obj"], &stdout(&output));
    assert!(output.status.success(), "{}", stdout(&output));
}

#[test]
fn json_is_the_report_and_nothing_else() {
    let desk = Desk::new();
    let report = json(&desk.run(&["repair", "open.off", "-o", "out.off", "--json"]));
    assert_eq!(report["schema"], "meshmend.report/1");
    assert_eq!(report["verdict"]["outcome"], "repaired");
    assert_eq!(report["certificate"]["printable"], true);
    let report = json(&desk.run(&["analyze", "open.off", "--json"]));
    assert_eq!(report["before"]["counts"]["boundary_loops"], 1);
    assert_eq!(report["verdict"]["printable"], false);
}

#[test]
fn json_of_a_failure_is_a_problem() {
    let desk = Desk::new();
    let problem = json(&desk.run(&["analyze", "broken.off", "--json"]));
    assert_eq!((problem["code"].as_str(), problem["line"].as_u64()), (Some("mesh-unparseable"), Some(3)));
    let problem = json(&desk.run(&["analyze", "solid.off", "--json", "--triangles-max", "3"]));
    assert_eq!(problem["limit_name"], "triangles_max");
    assert_eq!(problem["limit"], 3);
}

#[test]
fn options_are_understood_in_both_spellings() {
    let desk = Desk::new();
    for flag in ["--output-format", "--output_format"] {
        let output = desk.run(&["convert", "open.off", "-o", "out.mesh", flag, "ply"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(fs::read(desk.path().join("out.mesh")).unwrap().starts_with(b"ply"));
    }
}

#[test]
fn the_output_does_not_depend_on_the_number_of_threads() {
    let desk = Desk::new();
    for threads in ["1", "2", "8"] {
        let out = format!("out{threads}.stl");
        assert!(desk.run(&["repair", "open.off", "-o", &out, "--threads", threads]).status.success());
    }
    let bytes = |threads: u8| fs::read(desk.path().join(format!("out{threads}.stl"))).unwrap();
    assert!(bytes(1) == bytes(2) && bytes(1) == bytes(8));
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let desk = Desk::new();
    let mut child = spawn(&mut desk.command(&["analyze", "open.off", "--json"]));
    drop(child.stdout.take());
    let mut said = String::new();
    child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    assert_eq!((child.wait().unwrap().code(), said.as_str()), (Some(0), ""));
}

/// A closed surface of many triangles as OFF: enough work that a signal arrives before its end.
fn large_solid(side: usize) -> String {
    let at = |x: usize, y: usize, z: usize| (z * side + y) * side + x;
    let mut text = format!("OFF\n{} {} 0\n", 2 * side * side, 4 * (side - 1) * (side - 1) + 8 * (side - 1));
    for z in 0..2 {
        for y in 0..side {
            for x in 0..side {
                text.push_str(&format!("{x} {y} {z}\n"));
            }
        }
    }
    let mut quad = |corners: [usize; 4]| {
        let [a, b, c, d] = corners;
        text.push_str(&format!("3 {a} {b} {c}\n3 {a} {c} {d}\n"));
    };
    let end = side - 1;
    for i in 0..end {
        for j in 0..end {
            quad([at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0)]);
            quad([at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1)]);
        }
        quad([at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1)]);
        quad([at(i + 1, end, 0), at(i, end, 0), at(i, end, 1), at(i + 1, end, 1)]);
        quad([at(0, i + 1, 0), at(0, i, 0), at(0, i, 1), at(0, i + 1, 1)]);
        quad([at(end, i, 0), at(end, i + 1, 0), at(end, i + 1, 1), at(end, i, 1)]);
    }
    text
}

#[test]
fn the_large_solid_of_these_tests_is_one() {
    let desk = Desk::new();
    fs::write(desk.path().join("large.off"), large_solid(4)).unwrap();
    let output = desk.run(&["verify", "large.off"]);
    assert!(output.status.success(), "{}", stdout(&output));
}

#[test]
fn a_deadline_ends_a_run() {
    let desk = Desk::new();
    fs::write(desk.path().join("large.off"), large_solid(300)).unwrap();
    let output = desk.run(&["analyze", "large.off", "--deadline-max", "1ms"]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(stderr(&output).contains("deadline"), "{}", stderr(&output));
}

#[cfg(unix)]
#[test]
fn an_interrupt_cancels_a_run_and_leaves_no_file() {
    let desk = Desk::new();
    fs::write(desk.path().join("large.off"), large_solid(400)).unwrap();
    // Too early the signal meets a process that does not listen yet, too late one that is gone.
    let codes: Vec<_> = [200, 100, 400, 50, 800]
        .into_iter()
        .map(|wait_ms| {
            let mut child = spawn(&mut desk.command(&["repair", "large.off", "-o", "out.stl"]));
            std::thread::sleep(Duration::from_millis(wait_ms));
            Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
            let code = child.wait().unwrap().code();
            let _ = fs::remove_file(desk.path().join("out.stl")).map_err(|_| ());
            code
        })
        .collect();
    assert!(codes.contains(&Some(3)), "{codes:?}");
    assert_eq!(desk.new_files(), ["large.off"]);
}

#[test]
fn settings_show_their_origin() {
    let desk = Desk::new();
    fs::write(desk.path().join("meshmend.toml"), "queue_max = 7\n").unwrap();
    let output = desk
        .command(&["config", "show", "--config", "meshmend.toml", "--result-ttl", "1h"])
        .env("MESHMEND_SLOTS", "3")
        .output()
        .unwrap();
    let text = stdout(&output);
    let row = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(&format!("{name} "))).unwrap();
        line.split_whitespace().skip(1).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(row("queue_max"), "7 file meshmend.toml");
    assert_eq!(row("slots"), "3 environment MESHMEND_SLOTS");
    assert_eq!(row("result_ttl"), "1h flag --result-ttl");
    assert_eq!(row("connections_max"), "4096 default");
}

#[test]
fn a_strict_check_takes_warnings_as_errors() {
    let desk = Desk::new();
    let check = |args: &[&str], variable: &str| {
        let output = desk.command(args).env(variable, "1").output().unwrap();
        (output.status.code().unwrap(), stderr(&output))
    };
    let (code, said) = check(&["config", "check"], "MESHMEND_SLOT");
    assert!(code == 0 && said.contains("did you mean `MESHMEND_SLOTS`?"), "{said}");
    assert_eq!(check(&["config", "check", "--strict"], "MESHMEND_SLOT").0, 2);
    assert_eq!(check(&["config", "check", "--strict"], "MESHMEND_SERVICE_PORT").0, 0);
}

#[test]
fn an_address_for_all_needs_a_decision_about_keys() {
    let desk = Desk::new();
    for command in [&["serve"][..], &["config", "check"]] {
        let output = desk.run(&[command, &["--listen", "0.0.0.0:0"]].concat());
        assert_eq!(output.status.code(), Some(2));
        let said = stderr(&output);
        assert!(
            said.contains("MESHMEND_API_KEYS_FILE") && said.contains("MESHMEND_ALLOW_ANONYMOUS=true"),
            "{said}"
        );
    }
}

#[test]
fn a_service_that_is_not_there_is_not_healthy() {
    // Port 1 of loopback: nothing listens there.
    let output = Desk::new().run(&["healthcheck", "--admin-listen", "127.0.0.1:1"]);
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn the_material_of_an_obj_colours_the_faces_of_another_format() {
    let desk = Desk::new();
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
    fs::write(desk.path().join("part.obj"), obj).unwrap();
    fs::write(desk.path().join("part.mtl"), "newmtl red\nKd 1 0 0.5\n").unwrap();
    let run = desk.run(&["convert", "part.obj", "--material", "part.mtl", "-o", "part.off"]);
    assert_eq!(run.status.code(), Some(0));
    assert!(desk.read("part.off").contains("3 0 1 2 1.0 0.0 0.5\n"), "{}", desk.read("part.off"));
    let missing = desk.run(&["convert", "part.obj", "--material", "no.mtl", "-o", "part.off"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&missing.stderr).contains("no.mtl"));
}

#[test]
fn a_policy_is_told_in_text_and_json_and_the_page_is_written() {
    let desk = Desk::new();
    let output = desk.run(&["analyze", "solid.off", "--policy", "fdm", "--report-html", "page.html"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    assert!(text.contains("printing (fdm, z up)") && text.contains("build-volume"), "{text}");
    let page = fs::read_to_string(desk.path().join("page.html")).unwrap();
    assert!(page.contains("Printing by FDM") && page.ends_with("</html>\n"), "{page}");
    let output =
        desk.run(&["verify", "solid.off", "--policy", "sla", "--build-direction", "minus_x", "--json"]);
    let printing = &json(&output)["printing"];
    assert_eq!((&printing["policy"], &printing["build_direction"]), (&"sla".into(), &"minus_x".into()));
    let nowhere = desk.run(&["analyze", "solid.off", "--report-html", "no/such/folder/page.html"]);
    assert_eq!(nowhere.status.code(), Some(4), "{}", stderr(&nowhere));
}

#[test]
fn a_plan_may_stand_in_a_file() {
    let desk = Desk::new();
    let proposed = desk.run(&["plan", "open.off", "--json"]);
    let report: Value = serde_json::from_slice(&proposed.stdout).unwrap();
    fs::write(desk.path().join("plan.json"), report["plan"].to_string()).unwrap();
    let repaired = desk.run(&["repair", "open.off", "--plan", "@plan.json", "-o", "solid.stl"]);
    assert_eq!(repaired.status.code(), Some(0), "{}", String::from_utf8_lossy(&repaired.stderr));
    assert_eq!(desk.new_files(), ["plan.json", "solid.stl"]);
    let missing = desk.run(&["repair", "open.off", "--plan", "@nothing.json", "-o", "other.stl"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&missing.stderr).contains("cannot read nothing.json"));
}
