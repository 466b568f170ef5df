//! Reports of small runs.

use super::*;
use crate::wire::sample;
use serde_json::{Value, json};

fn json_of(answer: &pipeline::Answer) -> Value {
    serde_json::to_value(Report::new(&answer.report, TimingMs::default())).unwrap()
}

fn members(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn a_report_has_the_same_members_whatever_came_out() {
    let expected = [
        "schema",
        "operation",
        "engine",
        "input",
        "further_inputs",
        "before",
        "output_units",
        "plan",
        "tried",
        "actions",
        "levels",
        "holes",
        "modeller",
        "after",
        "deviation",
        "verdict",
        "parts",
        "remarks",
        "input_certificate",
        "certificate",
        "printing",
        "timing_ms",
        "resources",
    ];
    for answer in [sample::repaired(), sample::identical(), sample::refused()] {
        let report = json_of(&answer);
        assert_eq!(members(&report), expected);
        assert_eq!(
            members(&report["deviation"]),
            [
                "hausdorff_max",
                "distance",
                "volume_change",
                "area_change",
                "volume_change_share",
                "visible_loss",
                "hidden_area",
                "invented",
                "bodies_lost",
                "creases_recovered",
                "interpolated_area_share",
                "identical_triangle_share"
            ]
        );
        assert_eq!(
            members(&report["verdict"]),
            ["printable", "outcome", "fidelity", "changes", "p3_holds", "p3_breaches", "reasons"]
        );
        assert_eq!(
            members(&report["timing_ms"]),
            ["read", "analyze", "repair", "simplify", "write", "certify", "measure", "draw", "total"]
        );
    }
}

#[test]
fn what_was_not_computed_or_is_not_finite_is_null() {
    let report = json_of(&sample::repaired());
    assert_eq!(report["deviation"]["hausdorff_max"], Value::Null);
    assert_eq!(report["deviation"]["volume_change"], Value::Null, "the input has no volume");
    assert_eq!(report["deviation"]["area_change"], json!(1.0));
    assert_eq!(report["timing_ms"]["repair"], Value::Null);
    let defect = &report["before"]["defects"][0];
    assert_eq!(defect["witnesses"][0]["position"], Value::Null);
    assert_eq!(defect["witnesses"][0]["figures"][1], json!({"name": "length", "value": null}));
    assert_eq!(report["input_certificate"]["witnesses"][0]["position"], Value::Null);
    assert_eq!(report["input_certificate"]["p1"]["holds"], Value::Null);
}

#[test]
fn a_defect_speaks_the_file_s_numbering_and_says_how_many_are_fixed() {
    let defect = &json_of(&sample::repaired())["before"]["defects"][0];
    assert_eq!(defect["code"], "boundary-loop");
    assert_eq!(defect["severity"], "error");
    assert_eq!((&defect["count"], &defect["fixed"]), (&json!(1), &json!(1)));
    assert_eq!(defect["witnesses"][0]["faces"], json!([{"index": 2, "line": 17}]));
    let refused = json_of(&sample::refused());
    assert_eq!(refused["before"]["defects"][0]["fixed"], Value::Null, "there is no result to compare with");
}

#[test]
fn a_verdict_gives_its_reasons_each_condition_once() {
    let refused = &json_of(&sample::refused())["verdict"];
    assert_eq!((&refused["printable"], &refused["outcome"]), (&json!(false), &json!("refused")));
    let codes: Vec<_> = refused["reasons"].as_array().unwrap().iter().map(|reason| &reason["code"]).collect();
    assert_eq!(codes, ["not-repairable", "condition-broken"]);
    assert_eq!(refused["reasons"][1]["condition"], "two-triangles-per-edge");
    let repaired = &json_of(&sample::repaired())["verdict"];
    assert_eq!((&repaired["printable"], &repaired["outcome"]), (&json!(true), &json!("repaired")));
    assert_eq!((&repaired["reasons"], &repaired["p3_holds"]), (&json!([]), &Value::Null));
    let changes: Vec<_> =
        repaired["changes"].as_array().unwrap().iter().map(|change| &change["reason"]).collect();
    assert_eq!((&repaired["fidelity"], changes), (&json!("changed"), vec![&json!("invented")]));
    assert_eq!(refused["fidelity"], Value::Null);
}

#[test]
fn digests_are_lower_case_hexadecimal() {
    assert_eq!(json_of(&sample::repaired())["input"]["sha256"], "ab".repeat(32));
}
