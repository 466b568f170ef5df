//! What a policy says of meshes whose figures are known, in public words.

use serde_json::{Value, json};

use crate::budget::Budget;
use crate::formats::ReadLimits;
use crate::pipeline::{Operation, run};
use crate::wire::{Options, Report, TimingMs};

/// A box between these corners, as OBJ.
fn cuboid(size: [f64; 3]) -> Vec<u8> {
    let corner = |i: usize| (0..3).map(move |k| if i >> k & 1 == 1 { size[k] } else { 0.0 }.to_string());
    let vertices = (0..8).map(|i| format!("v {}\n", corner(i).collect::<Vec<_>>().join(" ")));
    let quads = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"];
    vertices.chain(quads.iter().map(|quad| format!("f {quad}\n"))).collect::<String>().into_bytes()
}

fn printing(operation: Operation, bytes: &[u8], options: &[(&str, &str)]) -> Value {
    let options = Options::from_pairs(options.iter().copied()).unwrap().to_engine(ReadLimits::default());
    let answer = run(operation, bytes, &options, &Budget::unlimited()).unwrap();
    serde_json::to_value(Report::new(&answer.report, TimingMs::default())).unwrap()["printing"].clone()
}

fn check(printing: &Value, code: &str) -> Value {
    printing["checks"].as_array().unwrap().iter().find(|check| check["code"] == code).unwrap().clone()
}

#[test]
fn without_a_policy_nothing_is_measured() {
    assert_eq!(printing(Operation::Analyze, &cuboid([9.0; 3]), &[]), Value::Null);
}

#[test]
fn a_box_in_inches_is_measured_in_millimetres() {
    let of = printing(Operation::Verify, &cuboid([2.0, 1.0, 0.02]), &[("policy", "fdm"), ("units", "in")]);
    assert_eq!(
        (&of["policy"], &of["about"], &of["build_direction"]),
        (&json!("fdm"), &json!("input"), &json!("z"))
    );
    let wall = check(&of, "wall-thickness");
    assert!((wall["measured"].as_f64().unwrap() - 0.508).abs() < 1e-9, "{wall}");
    assert_eq!(
        (&wall["status"], &wall["error"], &wall["unit"]),
        (&json!("error"), &json!(0.8), &json!("mm"))
    );
    let message = wall["message"].as_str().unwrap();
    assert!(message.starts_with("The thinnest wall is 0.508 mm (at least 0.8 mm, better 1.2);"), "{message}");
    assert!(wall["witnesses"][0]["face"].as_u64().unwrap() < 6, "faces of the file, not triangles");
    assert_eq!((&of["verdict"], &of["p3_holds"]), (&json!("error"), &json!(false)));
    let quote = &of["quote"];
    assert!((quote["volume"].as_f64().unwrap() - 0.04 * 25.4f64.powi(3)).abs() < 1e-6, "{quote}");
    assert!((quote["oriented_box"]["size"][0].as_f64().unwrap() - 50.8).abs() < 1e-9);
    assert_eq!(quote["price_safe"], true);
}

#[test]
fn a_result_is_measured_and_a_file_where_there_is_none() {
    let mut open = cuboid([20.0; 3]);
    open.truncate(open.len() - "f 2 4 8 6\n".len());
    let repaired = printing(Operation::Repair, &open, &[("policy", "sls")]);
    assert_eq!((&repaired["about"], &repaired["p3_holds"]), (&json!("result"), &json!(true)));
    assert_eq!(repaired["quote"]["price_safe"], true);
    let analyzed = printing(Operation::Analyze, &open, &[("policy", "sls")]);
    assert_eq!((&analyzed["about"], &analyzed["p3_holds"]), (&json!("input"), &Value::Null));
    assert_eq!(
        (&analyzed["quote"]["price_safe"], &analyzed["quote"]["volume"]),
        (&json!(false), &Value::Null)
    );
    assert_eq!(check(&analyzed, "trapped-cavity")["status"], Value::Null);
    assert_eq!(check(&repaired, "trapped-cavity")["status"], "ok");
}

#[test]
fn each_policy_has_its_own_checks_and_says_how_the_part_fits() {
    let codes = |policy| {
        let of = printing(Operation::Analyze, &cuboid([500.0, 250.0, 10.0]), &[("policy", policy)]);
        let codes: Vec<Value> =
            of["checks"].as_array().unwrap().iter().map(|check| check["code"].clone()).collect();
        (codes, of["fit"].clone(), check(&of, "build-volume")["status"].clone())
    };
    let (fdm, fit, status) = codes("fdm");
    let wanted = ["wall-thickness", "gap", "small-feature", "overhang", "sharp-edge", "build-volume"];
    assert_eq!(fdm, wanted);
    assert_eq!((fit, status), (json!("as_placed"), json!("warning")));
    assert_eq!(codes("mjf").2, "error");
    assert_eq!(codes("metal").0.len(), 6);
}
