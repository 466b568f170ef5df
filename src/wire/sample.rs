//! Engine reports for tests.

use crate::analysis::{
    Analysis, Counts, DefectCode, Element, Finding, HoleClass, HoleCounts, HoleGuess, Measures, Properties,
    Severity, Watertight, Witness,
};
use crate::certificate::{Certificate, Condition, Reading, Shell, Violation, ViolationCounts};
use crate::formats::Encoding;
use crate::geom::{Aabb, DVec3};
use crate::mesh::Texture;
use crate::pipeline::{
    Action, Answer, ChangeKind, Fidelity, FidelityChange, FidelityVerdict, InputFacts, Operation, Outcome,
    Output, Refusal, Report, Units,
};

/// The certificate of a tetrahedron, or of one that lacks a face.
fn certificate(is_valid: bool) -> Certificate {
    let reading = Reading { is_f32: false, is_fan: false, is_as_indexed: false };
    let hole = Violation {
        condition: Condition::TwoTrianglesPerEdge,
        reading,
        faces: vec![2],
        position: Some(DVec3::new(f64::NAN, 0.0, 0.0)),
    };
    Certificate {
        sha256: [0xab; 32],
        bytes: 284,
        encoding: Encoding::StlBinary,
        parts: None,
        p0: is_valid,
        p1: is_valid.then_some(true),
        p2: is_valid.then_some(true),
        violations: ViolationCounts {
            edges_without_two_triangles: Some(if is_valid { 0 } else { 3 }),
            ..ViolationCounts::default()
        },
        witnesses: if is_valid { Vec::new() } else { vec![hole.clone(), hole] },
        readings: vec![reading],
        triangles: 4,
        vertices: 4,
        euler_characteristic: 2,
        shells: vec![Shell { triangles: 4, depth: 0, genus: 0, volume: 0.5 }],
    }
}

fn analysis(holes: u64) -> Analysis {
    let hole = Finding {
        code: DefectCode::BoundaryLoop,
        severity: Severity::Error,
        count: holes,
        is_at_least: false,
        witnesses: vec![Witness {
            faces: vec![Element { index: 2, line: Some(17) }],
            figures: vec![("edges", 3.0), ("length", f64::INFINITY)],
            hole: Some(HoleGuess { class: HoleClass::MissingFace, confidence: 0.95 }),
            ..Witness::default()
        }],
    };
    Analysis {
        counts: Counts { faces: 4 - holes, triangles: 4 - holes, boundary_loops: holes, ..Counts::default() },
        measures: Measures {
            bounds: Some(Aabb { min: DVec3::ZERO, max: DVec3::ONE }),
            area: 2.0 - holes as f64,
            volume: (holes == 0).then_some(0.5),
            euler_characteristic: 2,
        },
        properties: Properties {
            is_closed: holes == 0,
            is_edge_manifold: true,
            is_vertex_manifold: true,
            is_oriented: true,
            is_embedded: None,
        },
        volume_interval: None,
        watertight: Watertight {
            by_index: None,
            after_exact_weld: holes == 0,
            after_epsilon_weld: None,
            in_float32: holes == 0,
        },
        proximity: None,
        holes: HoleCounts { missing_faces: holes, ..HoleCounts::default() },
        loop_edges: Vec::new(),
        findings: if holes == 0 { Vec::new() } else { vec![hole] },
    }
}

/// The answer to a repair of a tetrahedron that lacked a face.
pub(crate) fn repaired() -> Answer {
    let report = Report {
        operation: Operation::Repair,
        input: InputFacts {
            encoding: Encoding::StlBinary,
            bytes: 234,
            sha256: [0xab; 32],
            units: Units::Millimetre,
            units_are_stated: false,
            result_units: Units::Millimetre,
        },
        before: Some(analysis(1)),
        input_certificate: certificate(false),
        further_inputs: Vec::new(),
        plan: None,
        tried: vec!["as-drawn"],
        actions: vec![Action {
            step: "fill-holes",
            causes: vec![DefectCode::BoundaryLoop],
            changes: vec![("faces_added", 1)],
            move_max: 0.0,
            reason: String::new(),
            stitches: None,
        }],
        levels: Vec::new(),
        after: Some(analysis(0)),
        certificate: Some(certificate(true)),
        identical_triangle_share: Some(1.0),
        distance: None,
        losses: None,
        fidelity: Some(FidelityVerdict {
            word: Fidelity::Changed,
            changes: vec![FidelityChange { kind: ChangeKind::Invented, measured: 0.5, limit: 0.01 }],
        }),
        filling: None,
        modeller: None,
        outcome: Some(Outcome::Repaired),
        refusal: None,
        printing: None,
        parts: Vec::new(),
        remarks: Vec::new(),
        work_used: 7,
        bytes_peak: 1000,
    };
    let output = Some(Output {
        bytes: Some(b"mended".to_vec()),
        encoding: Encoding::StlBinary,
        origins: Vec::new(),
        texture: Texture::default(),
    });
    Answer { report, output, levels: Vec::new(), picture: None }
}

/// The answer to a repair of a mesh that was valid already.
pub(crate) fn identical() -> Answer {
    let Answer { report, output, levels, picture } = repaired();
    let report = Report {
        before: Some(analysis(0)),
        input_certificate: certificate(true),
        further_inputs: Vec::new(),
        plan: None,
        tried: Vec::new(),
        actions: Vec::new(),
        after: None,
        outcome: Some(Outcome::Identical),
        fidelity: Some(FidelityVerdict { word: Fidelity::Exact, changes: Vec::new() }),
        ..report
    };
    Answer { report, output: output.map(|output| Output { bytes: None, ..output }), levels, picture }
}

/// The answer to a repair without a valid result.
pub(crate) fn refused() -> Answer {
    let report = repaired().report;
    let witness = report.input_certificate.witnesses.first().cloned();
    let report = Report {
        after: None,
        certificate: None,
        identical_triangle_share: None,
        outcome: Some(Outcome::Refused),
        fidelity: None,
        refusal: Some(Refusal::NotRepairable { witness }),
        ..report
    };
    Answer { report, output: None, levels: Vec::new(), picture: None }
}
