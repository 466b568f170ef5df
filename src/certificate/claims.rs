//! What is claimed about a file, and what disproves it.

use crate::formats::Encoding;
use crate::geom::DVec3;

/// One way of reading a file; all that apply must be valid, because readers differ.
///
/// They are judged in this order: f64 before f32, our own triangulation before the fans, welded before as indexed.
/// One that gives the same triangles at the same places as an earlier one is not judged again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Reading {
    /// Coordinates as f32 (direct decimal-to-f32) instead of f64.
    pub is_f32: bool,
    /// Every polygon as the fan around its first corner instead of our own triangulation.
    pub is_fan: bool,
    /// Vertices as the file indexes them instead of bit-equal positions welded. P0 only.
    pub is_as_indexed: bool,
}

/// A condition that a valid solid must meet, and the element that breaks it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Condition {
    /// P0: every face of the file is usable (indices in range, three corners or more) and all coordinates are finite.
    Usable,
    /// P0: no triangle has a repeated or exactly collinear corner.
    NonDegenerate,
    /// P0: no two triangles have the same three vertices.
    Distinct,
    /// P0: every edge has exactly two triangles.
    TwoTrianglesPerEdge,
    /// P0: the two triangles of an edge run through it in opposite directions.
    OppositeDirections,
    /// P0: the link of every vertex is one cycle.
    OneFanPerVertex,
    /// P1: no two triangles meet except in a common vertex or a common edge.
    Embedded,
    /// P2: there is at least one triangle.
    NotEmpty,
    /// P2: nested shells alternate and the outermost ones point outward, so the winding number is 0 or 1 everywhere.
    Alternating,
}

impl Condition {
    /// Every condition.
    pub(super) const ALL: [Self; 9] = [
        Self::Usable,
        Self::NonDegenerate,
        Self::Distinct,
        Self::TwoTrianglesPerEdge,
        Self::OppositeDirections,
        Self::OneFanPerVertex,
        Self::Embedded,
        Self::NotEmpty,
        Self::Alternating,
    ];
}

/// The element that breaks a [`Condition`].
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    /// What is broken.
    pub condition: Condition,
    /// The reading in which it is broken.
    pub reading: Reading,
    /// Faces of the file (numbered from 0) that show it, at most eight.
    pub faces: Vec<u32>,
    /// Where, in the unit of the file; `None` when the place is not finite.
    pub position: Option<DVec3>,
}

/// How often each condition is broken, over the reading in which that is most often. `None`: found nowhere, but not
/// evaluated in some reading, because a condition it rests on is broken there (P2 rests on P0 and P1) or the check
/// ended at the first violation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ViolationCounts {
    /// [`Condition::Usable`]: unusable faces and non-finite vertices.
    pub unusable: Option<u64>,
    /// [`Condition::NonDegenerate`]: triangles.
    pub degenerate: Option<u64>,
    /// [`Condition::Distinct`]: triangles beyond the first of each vertex set. This and the next three counts leave out
    /// triangles with a repeated vertex.
    pub duplicate: Option<u64>,
    /// [`Condition::TwoTrianglesPerEdge`]: edges.
    pub edges_without_two_triangles: Option<u64>,
    /// [`Condition::OppositeDirections`]: edges.
    pub edges_in_one_direction: Option<u64>,
    /// [`Condition::OneFanPerVertex`]: vertices.
    pub singular_vertices: Option<u64>,
    /// [`Condition::Embedded`]: pairs of triangles; degenerate triangles and duplicates are left out.
    pub contacts: Option<u64>,
    /// There may be more of these: a search that had found some ended at its bound of work.
    pub contacts_are_at_least: bool,
    /// [`Condition::Alternating`]: shells.
    pub misnested_shells: Option<u64>,
}

impl ViolationCounts {
    /// All violations that were counted.
    pub fn total(&self) -> u64 {
        [
            self.unusable,
            self.degenerate,
            self.duplicate,
            self.edges_without_two_triangles,
            self.edges_in_one_direction,
            self.singular_vertices,
            self.contacts,
            self.misnested_shells,
        ]
        .into_iter()
        .flatten()
        .sum()
    }
}

/// One connected component of a valid solid's surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shell {
    /// Number of triangles.
    pub triangles: u32,
    /// Number of shells around it; even: an outer surface, odd: a cavity.
    pub depth: u32,
    /// Genus: number of handles.
    pub genus: u32,
    /// Enclosed volume, positive when it points outward; in cubic units of the file.
    pub volume: f64,
}

/// What was proved about a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Certificate {
    /// SHA-256 of the bytes.
    pub sha256: [u8; 32],
    /// Number of bytes.
    pub bytes: u64,
    /// Encoding of the bytes.
    pub encoding: Encoding,
    /// Number of parts that were judged one by one, each in its own coordinates; `None`: all triangles were judged together.
    pub parts: Option<u32>,
    /// P0: closed, oriented, 2-manifold, without degenerate or duplicate triangles.
    pub p0: bool,
    /// P1: no two triangles meet except in a common vertex or edge. `None`: found nowhere, but not evaluated everywhere.
    pub p1: Option<bool>,
    /// P2: winding number 0 or 1 everywhere. `None`: as for P1.
    pub p2: Option<bool>,
    /// How often each condition is broken.
    pub violations: ViolationCounts,
    /// Violations, first those of the first reading, there in the order of conditions, then of elements; at most as
    /// many of each condition as asked, all from the first reading in which it is broken.
    pub witnesses: Vec<Violation>,
    /// The readings that were judged, in order; the claims are about these. All that apply, unless the check ended at
    /// the first violation.
    pub readings: Vec<Reading>,
    /// Triangles of the welded f64 reading.
    pub triangles: u64,
    /// Vertices of the welded f64 reading that a triangle with three distinct vertices uses.
    pub vertices: u64,
    /// V - E + F of the welded f64 reading, over triangles with three distinct vertices.
    pub euler_characteristic: i64,
    /// The shells of a valid solid, by first triangle; empty when the file is not valid.
    pub shells: Vec<Shell>,
}

impl Certificate {
    /// P0, P1 and P2 hold.
    pub fn is_printable(&self) -> bool {
        self.p0 && self.p1 == Some(true) && self.p2 == Some(true)
    }
}
