//! The certificate as JSON: what was proved about a file's bytes. It carries no times.

use serde::Serialize;
use utoipa::ToSchema;

use super::finite::{finite, point};
use super::words::{Condition, Encoding};
use crate::certificate as judge;

/// One of P0, P1 and P2.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Claim {
    /// Whether it holds; null: not decided, because a claim it rests on does not hold.
    #[schema(required)]
    pub holds: Option<bool>,
    /// How often each of its conditions is broken; null: not counted.
    pub violations: Vec<ViolationCount>,
}

/// How often a condition is broken.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct ViolationCount {
    /// The condition.
    pub condition: Condition,
    /// Faces, edges, vertices, pairs or shells that break it; null: not counted.
    #[schema(required)]
    pub count: Option<u64>,
    /// There may be more: the search for pairs ended at its bound of work.
    pub is_at_least: bool,
}

/// One way of reading a file.
#[derive(Debug, Clone, Copy, Serialize, ToSchema)]
pub struct Reading {
    /// Coordinates rounded to 32-bit floats.
    pub is_f32: bool,
    /// Polygons split as fans.
    pub is_fan: bool,
    /// Vertices as the file indexes them instead of welded.
    pub is_as_indexed: bool,
}

/// The element that breaks a condition.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Violation {
    /// What is broken.
    pub condition: Condition,
    /// The reading in which it is broken.
    pub reading: Reading,
    /// Faces of the judged file, numbered from 0.
    pub faces: Vec<u32>,
    /// Where, in the unit of the file; null: the place is not finite.
    #[schema(required)]
    pub position: Option<[f64; 3]>,
}

/// One connected component of a valid solid's surface.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Shell {
    /// Number of triangles.
    pub triangles: u32,
    /// Number of shells around it; even: an outer surface, odd: a cavity.
    pub depth: u32,
    /// Number of handles.
    pub genus: u32,
    /// Enclosed volume in cubic units of the file.
    #[schema(required)]
    pub volume: Option<f64>,
}

/// What was proved about a file, from its bytes alone.
#[derive(Debug, Clone, Serialize, ToSchema)]
#[schema(as = Certificate)]
pub struct Certificate {
    /// Version of the checker.
    pub engine_version: &'static str,
    /// SHA-256 of the judged bytes, in hexadecimal.
    pub sha256: String,
    /// Number of bytes.
    pub bytes: u64,
    /// Layout of the bytes.
    pub encoding: Encoding,
    /// Parts that were judged one by one, each in its own coordinates; null: all triangles were judged together.
    #[schema(required)]
    pub parts: Option<u32>,
    /// P0, P1 and P2 hold.
    pub printable: bool,
    /// P0: closed, oriented and 2-manifold, without degenerate or duplicate triangles.
    pub p0: Claim,
    /// P1: no two triangles meet except in a common vertex or edge.
    pub p1: Claim,
    /// P2: winding number 0 or 1 everywhere.
    pub p2: Claim,
    /// Violations, the first one first.
    pub witnesses: Vec<Violation>,
    /// The readings that were judged.
    pub readings: Vec<Reading>,
    /// Triangles after welding.
    pub triangles: u64,
    /// Vertices after welding.
    pub vertices: u64,
    /// V - E + F after welding.
    pub euler_characteristic: i64,
    /// The shells of a valid solid; empty when the file is not valid.
    pub shells: Vec<Shell>,
}

impl From<&judge::Certificate> for Certificate {
    fn from(inner: &judge::Certificate) -> Self {
        let [p0, p1, p2] = claims(inner);
        Self {
            engine_version: super::ENGINE_VERSION,
            sha256: hex(&inner.sha256),
            bytes: inner.bytes,
            encoding: inner.encoding.into(),
            parts: inner.parts,
            printable: inner.is_printable(),
            p0,
            p1,
            p2,
            witnesses: inner.witnesses.iter().map(Violation::from).collect(),
            readings: inner.readings.iter().copied().map(Reading::from).collect(),
            triangles: inner.triangles,
            vertices: inner.vertices,
            euler_characteristic: inner.euler_characteristic,
            shells: inner.shells.iter().map(Shell::from).collect(),
        }
    }
}

fn claims(inner: &judge::Certificate) -> [Claim; 3] {
    let counts = &inner.violations;
    let count = |condition: judge::Condition, count| {
        let is_at_least = condition == judge::Condition::Embedded && counts.contacts_are_at_least;
        ViolationCount { condition: condition.into(), count, is_at_least }
    };
    let p0 = vec![
        count(judge::Condition::Usable, counts.unusable),
        count(judge::Condition::NonDegenerate, counts.degenerate),
        count(judge::Condition::Distinct, counts.duplicate),
        count(judge::Condition::TwoTrianglesPerEdge, counts.edges_without_two_triangles),
        count(judge::Condition::OppositeDirections, counts.edges_in_one_direction),
        count(judge::Condition::OneFanPerVertex, counts.singular_vertices),
    ];
    let p1 = vec![count(judge::Condition::Embedded, counts.contacts)];
    let p2 = vec![count(judge::Condition::Alternating, counts.misnested_shells)];
    [
        Claim { holds: Some(inner.p0), violations: p0 },
        Claim { holds: inner.p1, violations: p1 },
        Claim { holds: inner.p2, violations: p2 },
    ]
}

impl From<judge::Reading> for Reading {
    fn from(inner: judge::Reading) -> Self {
        let judge::Reading { is_f32, is_fan, is_as_indexed } = inner;
        Self { is_f32, is_fan, is_as_indexed }
    }
}

impl From<&judge::Violation> for Violation {
    fn from(inner: &judge::Violation) -> Self {
        Self {
            condition: inner.condition.into(),
            reading: inner.reading.into(),
            faces: inner.faces.clone(),
            position: inner.position.and_then(|p| point(&p)),
        }
    }
}

impl From<&judge::Shell> for Shell {
    fn from(inner: &judge::Shell) -> Self {
        Self {
            triangles: inner.triangles,
            depth: inner.depth,
            genus: inner.genus,
            volume: finite(inner.volume),
        }
    }
}

/// Bytes in lower-case hexadecimal.
pub(super) fn hex(bytes: &[u8]) -> String {
    use std::fmt::Write;
    bytes.iter().fold(String::with_capacity(2 * bytes.len()), |mut text, byte| {
        // Writing to a String cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// The digest of 64 lower-case hexadecimal digits.
pub(super) fn digest_of_hex(text: &str) -> Option<[u8; 32]> {
    let is_hex = |digit: u8| digit.is_ascii_digit() || (b'a'..=b'f').contains(&digit);
    if text.len() != 64 || !text.bytes().all(is_hex) {
        return None;
    }
    let byte = |i: usize| u8::from_str_radix(&text[2 * i..2 * i + 2], 16).unwrap_or_default();
    Some(std::array::from_fn(byte))
}
