//! What each fault is told as.

use super::*;
use crate::formats::WriteError;
use crate::wire::problem_code::errors;

fn read_error(kind: ReadErrorKind, place: Place) -> ReadError {
    ReadError { kind, place, expected: "a number".to_owned() }
}

#[test]
fn a_broken_file_is_told_with_its_place_and_what_was_expected() {
    let error = read_error(ReadErrorKind::Unparseable { found: "x".into() }, Place::Line(12));
    let problem = serde_json::to_value(Problem::from(&error)).unwrap();
    assert_eq!(problem["code"], "mesh-unparseable");
    assert_eq!(problem["status"], 422);
    assert_eq!(problem["type"], "/v1/errors#mesh-unparseable");
    assert_eq!((&problem["line"], &problem["expected"]), (&12.into(), &"a number".into()));
    assert!(problem.get("byte").is_none(), "members that do not apply are absent");
    let problem = Problem::from(&read_error(ReadErrorKind::Truncated, Place::Byte(84)));
    assert_eq!((problem.code, problem.byte), (ProblemCode::MeshTruncated, Some(84)));
}

#[test]
fn a_limit_is_named_with_the_value_over_it() {
    let kind =
        ReadErrorKind::TooLarge { what: "triangles", limit_name: "triangles_max", limit: 5, actual: 9 };
    let problem = Problem::from(&Failure::Unreadable(read_error(kind, Place::Whole)));
    assert_eq!(problem.code, ProblemCode::MeshTooLarge);
    assert_eq!(
        (problem.limit_name.as_deref(), problem.limit, problem.actual),
        (Some("triangles_max"), Some(5), Some(9))
    );
    let problem = Problem::from(&Stopped::Memory { limit: 1, wanted: 2 });
    assert_eq!(problem.code, ProblemCode::EngineOutOfMemory);
    assert_eq!((problem.limit, problem.actual), (Some(1), Some(2)));
}

#[test]
fn each_way_to_stop_has_its_code() {
    assert_eq!(Problem::from(&Stopped::Cancelled).code, ProblemCode::Cancelled);
    assert_eq!(Problem::from(&Stopped::Deadline).code, ProblemCode::EngineTimeout);
    assert_eq!(Problem::from(&Stopped::Work { limit: 1 }).limit_name.as_deref(), Some("engine_work_max"));
}

#[test]
fn a_coordinate_that_is_not_finite_has_a_code_of_its_own() {
    let refusal = |value| Refusal::NotRepresentable {
        reason: WriteError::NotRepresentable { vertex: 3, value, encoding: "stl-binary" },
    };
    let problem = |value| Problem::of_refusal(&refusal(value), Units::Millimetre);
    assert_eq!(problem(f64::NAN).code, ProblemCode::MeshNonFinite);
    assert_eq!(problem(1e300).code, ProblemCode::NotRepairable);
}

#[test]
fn a_remedy_that_does_not_fit_is_told_with_those_that_do() {
    let mismatch = PlanMismatch::NoSuchRemedy(DefectCode::Needle, Remedy::Fill);
    let told = Problem::from(&mismatch).detail;
    assert_eq!(told, "`fill` is no remedy of `needle`; these are: keep, collapse");
}

#[test]
fn a_problem_is_read_back_as_it_was_written() {
    let plain = Problem::new(ProblemCode::Cancelled, "the job was cancelled");
    let full = Problem {
        line: Some(3),
        byte: Some(u64::MAX),
        expected: Some("a number".into()),
        parameter: Some("units".into()),
        suggestion: Some("mm".into()),
        retry_after_s: Some(7),
        report: Some(serde_json::json!({"verdict": {"volume": 0.1 + 0.2}})),
        ..plain
            .clone()
            .with_limit("queue_max", 5, Some(6))
            .with_allowed(["mm", "cm"])
            .with_instance("/v1/jobs/x")
    };
    for problem in [plain, full] {
        let text = serde_json::to_string(&problem).unwrap();
        assert_eq!(serde_json::from_str::<Problem>(&text).unwrap(), problem);
    }
}

#[test]
fn every_code_is_explained_and_is_an_error() {
    for row in errors() {
        assert!((400..600).contains(&row.status), "{}", row.code);
        assert!(row.title.len() > 5 && row.explanation.len() > 20, "{}", row.code);
    }
}
