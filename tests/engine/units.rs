//! Results in another unit than their file's.

use crate::oracle::RawSoup;
use crate::raw_files::encode;
use crate::solids::cuboid;
use meshmend::budget::Budget;
use meshmend::formats::{Encoding, Format};
use meshmend::pipeline::{Answer, Fidelity, Operation, Options, Outcome, SimplifyChoices, Units, run};
use meshmend::simplify::Target;

fn answer(operation: Operation, bytes: &[u8], options: &Options) -> Answer {
    run(operation, bytes, options, &Budget::unlimited()).unwrap()
}

fn sides(bytes: &[u8]) -> [f64; 3] {
    let report = answer(Operation::Analyze, bytes, &Options::default()).report;
    let bounds = report.before.unwrap().measures.bounds.unwrap();
    (bounds.max - bounds.min).to_array()
}

fn inches() -> Options {
    Options { units: Some(Units::Inch), ..Options::default() }
}

/// A box of 1 by 2 by 3 inches, and the same without a face.
fn boxes() -> [RawSoup; 2] {
    let whole = cuboid([1.0, 2.0, 3.0]);
    let mut open = whole.clone();
    open.triangles.truncate(open.triangles.len() - 1);
    [whole, open]
}

#[test]
fn an_stl_of_a_file_in_inches_is_in_millimetres() {
    for soup in boxes() {
        for encoding in [Encoding::StlBinary, Encoding::Obj] {
            let options = Options { output_format: Some(Format::Stl), ..inches() };
            let answer = answer(Operation::Repair, &encode(&soup, encoding), &options);
            let bytes = answer.output.unwrap().bytes.expect("new bytes");
            let (found, want) = (sides(&bytes), [25.4, 50.8, 76.2]);
            assert!(found.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?}");
            assert!(answer.report.certificate.unwrap().is_printable());
            assert_eq!(answer.report.input.result_units, Units::Millimetre);
        }
    }
}

#[test]
fn a_result_keeps_the_unit_of_its_file_where_nothing_else_is_said() {
    let [whole, _] = boxes();
    let obj = answer(Operation::Repair, &encode(&whole, Encoding::Obj), &inches());
    assert_eq!(obj.report.outcome, Some(Outcome::Identical));
    let as_asked = Options { output_units: Some(Units::Inch), ..inches() };
    let stl = answer(Operation::Repair, &encode(&whole, Encoding::StlBinary), &as_asked);
    assert_eq!((stl.report.outcome, stl.output.unwrap().bytes), (Some(Outcome::Identical), None));
    let unsaid = answer(Operation::Repair, &encode(&whole, Encoding::StlBinary), &Options::default());
    assert_eq!(unsaid.report.outcome, Some(Outcome::Identical), "millimetres, assumed");
}

#[test]
fn every_operation_that_returns_a_mesh_gives_it_the_unit_that_is_asked() {
    let [whole, _] = boxes();
    for operation in [Operation::Convert, Operation::Simplify, Operation::CutStitch] {
        let simplify = SimplifyChoices { targets: vec![Target::Ratio(1.0)], ..SimplifyChoices::default() };
        let options = Options { output_units: Some(Units::Millimetre), simplify, ..inches() };
        let answer = answer(operation, &encode(&whole, Encoding::Obj), &options);
        let report = answer.report;
        assert_ne!(report.outcome, Some(Outcome::Identical), "{operation:?}");
        assert_ne!(
            report.fidelity.unwrap().word,
            Fidelity::Changed,
            "{operation:?}: only the unit is another"
        );
        assert!((sides(&answer.output.unwrap().bytes.unwrap())[0] - 25.4).abs() < 1e-9);
    }
}

#[test]
fn an_stl_in_inches_is_in_millimetres_after_every_operation() {
    let [whole, _] = boxes();
    let bytes = encode(&whole, Encoding::StlBinary);
    for operation in [Operation::Convert, Operation::CutStitch, Operation::FillHoles, Operation::Modeller] {
        let answer = answer(operation, &bytes, &inches());
        let bytes = answer.output.unwrap().bytes.expect("new bytes");
        let (found, want) = (sides(&bytes), [25.4, 50.8, 76.2]);
        assert!(found.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-5), "{operation:?}: {found:?}");
    }
}

#[test]
fn a_coordinate_that_has_no_number_in_the_other_unit_is_an_error() {
    let bytes = encode(&cuboid([1e308, 1.0, 1.0]), Encoding::Obj);
    let options = Options { output_units: Some(Units::Millimetre), ..inches() };
    let failure = run(Operation::Convert, &bytes, &options, &Budget::unlimited()).unwrap_err();
    assert!(failure.to_string().contains("the unit of the result"), "{failure}");
}
