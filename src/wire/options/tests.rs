//! Options from text, and what they become.

use serde_json::{Map, Value, json};

use super::*;
use crate::wire::problem::Problem;
use crate::wire::problem_code::ProblemCode;

/// A value that the option takes, as JSON.
fn some_value(spec: &OptionSpec) -> Value {
    match spec.kind {
        OptionKind::Word { words, .. } => json!(words[words.len() - 1]),
        OptionKind::Integer { min, .. } => json!(min),
        OptionKind::Number { max, .. } => json!(max),
        OptionKind::Flag => json!(true),
        OptionKind::Plan => json!({"findings": [{"code": "boundary-loop", "remedy": "keep"}]}),
        OptionKind::Edges => json!([[0, 1], [5, 3]]),
        OptionKind::Holes => json!([0, {"number": 3, "method": "rbf", "band_rings": 1}]),
        OptionKind::Targets => json!([{"ratio": 0.5}, {"faces": 10}]),
        OptionKind::Edits => json!([{"shift": {"faces": [{"face": 3, "by_mm": -0.5}]}}, {"undo": {}}]),
        OptionKind::Ranges => json!([2, {"together": [{"face": 1}, {"face": 4, "rate": -1}]}]),
        OptionKind::Input => json!({"job": "x"}),
    }
}

#[test]
fn every_option_reads_the_same_from_a_query_and_from_json() {
    let members: Map<_, _> = SPECS.iter().map(|spec| (spec.name.to_owned(), some_value(spec))).collect();
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let pairs = members.iter().map(|(name, value)| (name.clone(), text(value)));
    let from_query = Options::from_pairs(pairs).unwrap();
    assert_eq!(from_query, Options::from_json(&members).unwrap());
    for spec in SPECS {
        let one = Options::from_pairs([(spec.name, text(&members[spec.name]))]).unwrap();
        assert_ne!(one, Options::default(), "{} is taken and kept", spec.name);
    }
}

#[test]
fn every_option_is_read_back_from_json_as_it_was_written() {
    let digits = json!(0.1 + 0.2);
    let plan = json!({"input_sha256": "ab".repeat(32), "findings": [
        {"code": "boundary-loop", "remedy": "keep", "elements": [{"number": 3, "remedy": "fill"}]}],
        "steps": [{"step": "weld"}, {"step": "snap", "epsilon": digits}, {"step": "round-to-float32"},
            {"step": "fill-holes", "all": false, "except": [0, 7]},
            {"step": "nest", "nesting": "fill", "chosen": [{"triangle": 4, "fate": "goes"}]}]});
    let targets = json!([{"ratio": digits}, {"faces": u32::MAX}, {"error_mm": 1e-300}]);
    let mut all = Options::default();
    for spec in SPECS {
        let more = match spec.kind {
            OptionKind::Word { words, .. } => json!(words[0]),
            OptionKind::Integer { max, .. } => json!(max),
            OptionKind::Number { .. } => digits.clone(),
            OptionKind::Flag => json!(false),
            OptionKind::Edges => json!([[0, u32::MAX]]),
            OptionKind::Holes => json!("all"),
            OptionKind::Plan => plan.clone(),
            OptionKind::Targets => targets.clone(),
            OptionKind::Edits => json!([]),
            OptionKind::Ranges => {
                json!([{"normal": [0, digits, 1], "at": [0, 0, 0]}, {"ray": {"from": [0, 0, 9], "direction": [0, 0, -1]}}])
            }
            OptionKind::Input => json!({"job": "y"}),
        };
        for value in [&some_value(spec), &more] {
            let mut one = Options::default();
            one.set_json(spec.name, value).unwrap();
            let text = serde_json::to_string(&one).unwrap();
            assert_eq!(serde_json::from_str::<Options>(&text).unwrap(), one, "{text}");
            assert_eq!(text.matches(&format!("\"{}\":", spec.name)).count(), 1, "{text}");
        }
        all.set_json(spec.name, &more).unwrap();
    }
    let text = serde_json::to_string(&all).unwrap();
    assert_eq!(serde_json::from_str::<Options>(&text).unwrap(), all);
    assert_eq!(serde_json::to_string(&Options::default()).unwrap(), "{}");
    assert_eq!(serde_json::from_str::<Options>(r#"{"units":null}"#).unwrap(), Options::default());
    assert!(serde_json::from_str::<Options>(r#"{"unit":"mm"}"#).is_err());
}

#[test]
fn every_word_of_an_option_is_taken_and_no_other() {
    for spec in SPECS {
        for word in spec.words() {
            assert!(Options::from_pairs([(spec.name, word)]).is_ok(), "{}={word}", spec.name);
        }
        let error = Options::from_pairs([(spec.name, "xyzzy")]).unwrap_err();
        let is_told = matches!(error, OptionError::Invalid { .. } | OptionError::NoPlan { .. });
        assert!(is_told && error.to_string().contains(spec.name), "{error}");
    }
}

#[test]
fn an_unknown_option_is_named_with_the_nearest_one() {
    let error = Options::from_pairs([("outptu-format", "stl")]).unwrap_err();
    assert_eq!(
        error,
        OptionError::Unknown { name: "outptu-format".into(), suggestion: Some("output_format") }
    );
    let problem = Problem::from(&error);
    assert_eq!(problem.code, ProblemCode::UnknownParameter);
    assert_eq!(problem.suggestion.as_deref(), Some("output_format"));
    let error = Options::from_pairs([("qqq", "1")]).unwrap_err();
    assert_eq!(error, OptionError::Unknown { name: "qqq".into(), suggestion: None });
}

#[test]
fn a_wrong_value_is_answered_with_the_allowed_ones() {
    let error = Options::from_pairs([("require", "printible")]).unwrap_err();
    let problem = Problem::from(&error);
    assert_eq!(problem.allowed, Require::WORDS);
    assert_eq!(problem.suggestion.as_deref(), Some("printable"));
    assert_eq!(problem.parameter.as_deref(), Some("require"));
}

#[test]
fn numbers_out_of_range_or_not_in_digits_are_refused() {
    for value in ["-1", "+1", "", " 1", "1.5", "10001", "99999999999999999999"] {
        assert!(Options::from_pairs([("samples", value)]).is_err(), "samples={value}");
    }
    for value in [json!(-1), json!("1"), json!(1.5), json!(null), json!(10001)] {
        assert!(Options::default().set_json("samples", &value).is_err(), "{value}");
    }
    assert!(Options::default().set_json("samples", &json!(16.0)).is_ok());
}

#[test]
fn an_option_may_be_repeated_but_not_contradicted() {
    assert!(Options::from_pairs([("units", "cm"), ("units", "cm")]).is_ok());
    let error = Options::from_pairs([("units", "cm"), ("units", "mm")]).unwrap_err();
    assert!(matches!(error, OptionError::Contradictory { spec } if spec.name == "units"));
}

#[test]
fn options_of_two_places_are_joined_unless_they_contradict_each_other() {
    for spec in SPECS {
        let mut one = Options::default();
        one.set_json(spec.name, &some_value(spec)).unwrap();
        assert_eq!(one.clone().join(Options::default()).unwrap(), one);
        assert_eq!(Options::default().join(one.clone()).unwrap(), one, "{} is joined", spec.name);
    }
    let of = |units| Options::from_pairs([("units", units)]).unwrap();
    let error = of("cm").join(of("mm")).unwrap_err();
    assert!(matches!(error, OptionError::Contradictory { spec } if spec.name == "units"));
}

#[test]
fn one_target_excludes_the_others_and_errors_are_in_the_unit_of_the_file() {
    let of = |pairs: &[(&str, &str)]| Options::from_pairs(pairs.iter().copied()).unwrap();
    let both = of(&[("faces", "10"), ("targets", r#"[{"ratio":0.5}]"#)]);
    assert!(
        matches!(both.check(Operation::Simplify), Err(OptionError::Excluded { spec, by: "faces" }) if spec.name == "targets")
    );
    let inches = of(&[("error_mm", "2.54"), ("units", "in")]);
    assert!(inches.check(Operation::Simplify).is_ok());
    let targets = inches.to_engine(ReadLimits::default()).simplify.targets;
    assert!(matches!(targets[..], [simplify::Target::Error(e)] if (e - 0.1).abs() < 1e-12));
    for wrong in ["[]", "[{}]", r#"[{"ratio":2}]"#, r#"[{"faces":0}]"#, r#"[{"ratio":0.5,"faces":1}]"#, "[5]"]
    {
        assert!(Options::from_pairs([("targets", wrong)]).is_err(), "{wrong}");
    }
    for wrong in ["nan", "inf", "-1", "1e400", "0x1", ""] {
        assert!(Options::from_pairs([("error_mm", wrong)]).is_err(), "{wrong}");
    }
}

#[test]
fn a_turn_takes_no_choice_that_it_would_leave_out_and_no_size_without_end() {
    let check =
        |pairs: &[(&str, &str)]| Options::from_pairs(pairs.iter().copied()).unwrap().check(Operation::Render);
    let (turn, wide) = (("turntable", "120"), ("width", "2048"));
    for (wrong, told) in [
        ([turn, ("views", "iso")], "`turntable` does not go with `views`"),
        ([turn, ("projection", "perspective")], "`turntable` does not go with `projection`"),
        (
            [turn, wide],
            "this `turntable` needs `width` and `height` of at most 64 million pixels in all its pictures",
        ),
    ] {
        assert_eq!(check(&wrong).unwrap_err().to_string(), told);
    }
    assert_eq!(check(&[turn, ("projection", "orthographic")]), Ok(()));
    assert_eq!(check(&[("turntable", "60"), wide]), Ok(()));
    assert_eq!(check(&[("views", "all"), wide, ("height", "2048")]), Ok(()));
}

#[test]
fn choices_about_a_field_need_a_method_that_fits_one_and_each_hole_is_listed_once() {
    let check = |pairs: &[(&str, &str)]| {
        Options::from_pairs(pairs.iter().copied()).unwrap().check(Operation::FillHoles)
    };
    let (flat, kernel) = (("method", "flat"), ("kernel", "linear"));
    let told = check(&[flat, kernel]).unwrap_err().to_string();
    assert_eq!(told, "this `kernel` needs the method rbf or auto");
    for name in ["lambda_mm", "constraints", "band_rings"] {
        assert!(check(&[("method", "creased"), (name, "1")]).is_err(), "{name}");
    }
    let of_one = r#"[0,{"number":3,"method":"rbf"}]"#;
    assert_eq!(check(&[flat, kernel, ("holes", of_one)]), Ok(()));
    for wrong in [r#"[0,{"number":3,"band_rings":1}]"#, r#"[{"number":3,"method":"smooth"}]"#] {
        assert!(check(&[flat, kernel, ("holes", wrong)]).is_err(), "{wrong}");
    }
    let flat_alone = [kernel, ("holes", r#"[{"number":3,"method":"flat"}]"#)];
    assert!(check(&flat_alone).is_err(), "no hole is filled by a field");
    let rings = check(&[("holes", r#"[0,{"number":3,"method":"flat","band_rings":1}]"#)]);
    let told = "this `holes` needs the method rbf or auto for each hole with `band_rings`";
    assert_eq!(rings.unwrap_err().to_string(), told);
    assert_eq!(check(&[kernel]), Ok(()));
    assert_eq!(check(&[("method", "rbf"), kernel, ("lambda_from", "mesh")]), Ok(()));
    let twice = check(&[("holes", r#"[3,{"number":3,"method":"flat"}]"#)]).unwrap_err().to_string();
    assert_eq!(twice, "this `holes` needs each number once");
}

#[test]
fn colours_of_priorities_need_a_format_that_shows_them() {
    let check = |pairs: &[(&str, &str)]| {
        Options::from_pairs(pairs.iter().copied()).unwrap().check(Operation::Simplify)
    };
    let color = ("vertex_colors", "priority");
    for wrong in [
        &[color][..],
        &[color, ("output_format", "stl")],
        &[color, ("format", "off"), ("output_format", "obj")],
    ] {
        let error = check(wrong).unwrap_err();
        assert!(
            matches!(error, OptionError::Lacking { spec, .. } if spec.name == "vertex_colors"),
            "{wrong:?}"
        );
        assert_eq!(Problem::from(&error).code, ProblemCode::InvalidParameter);
    }
    assert_eq!(check(&[color, ("output_format", "ply")]), Ok(()));
    assert_eq!(check(&[color, ("format", "off")]), Ok(()));
    assert_eq!(check(&[("vertex_colors", "kept")]), Ok(()));
}

#[test]
fn an_option_that_the_operation_does_not_take_is_refused_with_those_that_do() {
    let walls = Options::from_pairs([("wall_mm", "1")]).unwrap();
    assert_eq!(walls.check(Operation::Repair), Ok(()));
    let error = walls.check(Operation::Verify).unwrap_err();
    assert_eq!(error.to_string(), "`verify` takes no `wall_mm`; it is an option of repair, boolean");
    let problem = Problem::from(&error);
    assert_eq!(
        (problem.code, problem.parameter.as_deref()),
        (ProblemCode::UnknownParameter, Some("wall_mm"))
    );
    for &operation in Operation::ALL {
        for spec in SPECS {
            let mut one = Options::default();
            one.set_json(spec.name, &some_value(spec)).unwrap();
            assert_eq!(one.check_taken_by(operation).is_ok(), spec.is_taken_by(operation), "{}", spec.name);
        }
    }
}

#[test]
fn options_reach_the_engine() {
    let options =
        Options::from_pairs([("reader", "tobj"), ("samples", "3"), ("output_format", "ply")]).unwrap();
    let engine = options.to_engine(ReadLimits { triangles_max: 7, ..ReadLimits::default() });
    assert_eq!(engine.read.obj_reader, crate::formats::ObjReader::Tobj);
    assert_eq!(engine.read.limits.triangles_max, 7);
    assert_eq!(engine.samples, Some(3));
    assert_eq!(engine.output_format, Some(crate::formats::Format::Ply));
}
