//! The summary of a report, on small reports.

use super::*;
use crate::distance::{DirectedDistance, FarPoint, SurfaceDistance};
use crate::geom::DVec3;
use crate::pipeline::{self, Answer, Losses};
use crate::simplify::{self, Refusals, SimplifyRefusal, Target};
use crate::wire::{TimingMs, sample};

fn of(answer: &Answer, written: Option<&str>) -> String {
    let report = Report::new(&answer.report, TimingMs::default());
    let text = summary(&report, &Subject { input: "part.stl".into(), written: written.map(str::to_owned) });
    anstream::adapter::strip_str(&text).to_string()
}

#[test]
fn a_repair_is_told_from_defect_to_verdict() {
    let want = "\
verdict: repaired, printable: a valid solid; changed: 50 % of the surface is invented (faithful: at most 1 %)
part.stl: stl-binary, 234 bytes, unit mm (assumed)
  3 triangles, 0 vertices, 0 components; 1 x 1 x 1 mm; area 1 mm²
  No unit is stated: is the longest side 10 mm (if the unit is cm) or 1000 mm (if the unit is m) or 25.4 mm (if the unit is in)? Say so with `--units`; without it the file is taken in millimetres.
defects
  boundary-loop  1  error  face 2 (line 17), edges 3
done
  fill-holes  faces_added 1  because of boundary-loop
result
  4 triangles, 0 vertices, 0 components; 1 x 1 x 1 mm; area 2 mm²; volume 0.5 mm³
certificate
  P0 topology   holds
  P1 embedding  holds
  P2 solid      holds
written: out.stl
";
    assert_eq!(of(&sample::repaired(), Some("out.stl")), want);
}

#[test]
fn the_headline_of_a_refusal_calls_no_result_printable() {
    let mut answer = sample::repaired();
    answer.report.outcome = Some(crate::pipeline::Outcome::Refused);
    let text = of(&answer, None);
    assert!(text.starts_with("verdict: refused, the input is a valid solid"), "{text}");
}

#[test]
fn an_analysis_lists_holes_by_the_numbers_under_which_they_can_be_chosen() {
    let mut answer = sample::repaired();
    assert!(!of(&answer, None).contains("holes\n"));
    answer.report.operation = crate::pipeline::Operation::Analyze;
    let text = of(&answer, None);
    assert!(text.contains("holes\n  0  missing-face"), "{text}");
}

/// A distance of at most 0.25.
fn quarter_away() -> SurfaceDistance {
    let place = FarPoint { place: DVec3::ZERO, triangle: 0, closest: DVec3::ZERO, closest_triangle: 0 };
    let one = DirectedDistance {
        is_within_tolerance: true,
        upper: 0.25,
        lower: 0.2,
        farthest: place,
        mean: None,
        root_mean_square: None,
        seen: None,
    };
    SurfaceDistance { forward: one, backward: one }
}

#[test]
fn a_measured_repair_tells_how_close_it_is() {
    let mut answer = sample::repaired();
    assert!(!of(&answer, None).contains("from the file"));
    answer.report.losses = Some(Losses {
        visible_loss: 0.012,
        hidden_area: 2.5,
        invented: 0.0,
        bodies_lost: 1,
        volume_change: None,
        creases_recovered: Some(0.97),
    });
    answer.report.distance = Some(quarter_away());
    let want = "  at most 0.25 mm from the file; 1.2 % of the visible surface lost; hidden area 2.5 mm² left out; bodies lost: 1; \
                97 % of the creases recovered\n";
    let text = of(&answer, None);
    assert!(text.contains(want), "{text}");
}

#[test]
fn a_refusal_says_why_and_that_nothing_was_written() {
    let text = of(&sample::refused(), None);
    assert!(text.starts_with("verdict: refused, not printable; "), "{text}");
    assert!(text.ends_with("nothing written\n"), "{text}");
}

/// A result with 40 of 100 faces.
fn level(target: Target, refused: &[(SimplifyRefusal, u64)], is_reached: bool) -> pipeline::Level {
    let mut refusals = Refusals::default();
    refused.iter().for_each(|&(reason, count)| refusals.add_times(reason, count));
    let simplified = simplify::TargetReport {
        target,
        is_reached,
        faces_before: 100,
        faces_after: 40,
        collapses: 30,
        refusals,
        error_max: 0.5,
    };
    let of_repair = sample::repaired().report;
    let (certificate, fidelity) = (of_repair.input_certificate, of_repair.fidelity);
    pipeline::Level { simplified, certificate, distance: Some(quarter_away()), fidelity }
}

#[test]
fn a_target_that_was_not_reached_is_told_with_the_reasons() {
    let mut answer = sample::repaired();
    answer.report.levels = vec![
        level(Target::Faces(50), &[], true),
        level(Target::Faces(10), &[(SimplifyRefusal::Held, 2), (SimplifyRefusal::NormalTurns, 7)], false),
        level(Target::Ratio(0.25), &[], false),
    ];
    let want = "\
targets not reached
  10 faces           40 faces left  collapses refused: normal_turns 7, held 2
  0.25 of the faces  40 faces left  no edge is left to collapse
";
    let text = of(&answer, None);
    assert!(text.contains(want), "{text}");
}

#[test]
fn each_of_several_results_has_a_row_with_its_number() {
    let mut answer = sample::repaired();
    answer.report.levels = vec![level(Target::Faces(50), &[], true)];
    assert!(!of(&answer, None).contains("results"));
    answer.report.levels.push(level(Target::Ratio(0.25), &[], false));
    let want = "\
results
  1  50 faces           40 faces  at most 0.25 mm away  changed  not a valid solid
  2  0.25 of the faces  40 faces  at most 0.25 mm away  changed  not a valid solid
";
    let text = of(&answer, None);
    assert!(text.contains(want), "{text}");
}

#[test]
fn sizes_of_a_file_whose_result_has_another_unit_are_told_in_that_unit() {
    let mut answer = sample::repaired();
    answer.report.input.result_units = pipeline::Units::Inch;
    let text = of(&answer, None);
    assert!(text.contains("unit mm (assumed)") && text.contains("; 1 x 1 x 1 in; area 1 in²\n"), "{text}");
}

#[test]
fn tables_without_rows_leave_no_heading() {
    let mut text = String::new();
    put_table::<2>(&mut text, "none", &[]);
    assert_eq!(text, "");
}

#[test]
fn the_verdict_and_the_rows_of_defects_have_colours() {
    let report = Report::new(&sample::refused().report, TimingMs::default());
    let text = summary(&report, &Subject { input: "part.stl".into(), written: None });
    assert!(text.starts_with(&BAD.render().to_string()), "{text:?}");
}
