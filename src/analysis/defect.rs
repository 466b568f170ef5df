//! The words in which a defect is told: its code, how bad it is, and where.

use super::{HoleGuess, ProximityTest};
use crate::geom::DVec3;

/// How bad a defect is for printing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Severity {
    /// Good to know; valid all the same.
    Info,
    /// Some readers will take it differently.
    Warning,
    /// The file is not a valid solid.
    Error,
}

/// A kind of defect. The code is the public name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum DefectCode {
    /// No triangle at all: nothing that could be solid.
    NoTriangle,
    /// Vertex with a NaN or infinite coordinate.
    NonFiniteVertex,
    /// Face that uses such a vertex.
    NonFiniteFace,
    /// Face that names a vertex the file does not have.
    IndexOutOfRange,
    /// Face with fewer than three corners.
    TooFewCorners,
    /// Polygon whose corners are not in one plane.
    NonPlanarPolygon,
    /// Polygon that is not convex, so simple readers split it wrongly.
    ConcavePolygon,
    /// Triangle with two or three corners at one position.
    CoincidentCorners,
    /// Triangle whose three distinct corners are exactly on one line.
    CollinearFace,
    /// Triangle whose shortest edge is below 1 % of its longest.
    Needle,
    /// Triangle with an angle above 175 degrees that is no needle.
    Cap,
    /// Triangle with the same three vertices as an earlier one in the same direction.
    DuplicateFace,
    /// Triangle with the same three vertices as an earlier one in the opposite direction, the first such.
    OppositeDuplicateFace,
    /// Vertex that no face and no edge uses.
    IsolatedVertex,
    /// Edge that the file states by itself (`l` of OBJ, `edge` of PLY) and no face has.
    IsolatedEdge,
    /// Vertex at the position of an earlier one (a seam; welding joins them).
    DuplicateVertex,
    /// Face that shares no edge with another face.
    IsolatedFace,
    /// Loop of edges with one triangle: a hole or the border of an open sheet.
    BoundaryLoop,
    /// Edge with three triangles or more.
    NonManifoldEdge,
    /// Vertex whose triangles form more than one fan.
    NonManifoldVertex,
    /// Edge whose two triangles run in the same direction.
    OrientationConflict,
    /// Component that cannot be oriented coherently.
    NonOrientable,
    /// Edge whose two triangles are less than one degree apart: they almost lie on each other.
    FoldedEdge,
    /// Closed shell that points inward although nothing is around it.
    InvertedShell,
    /// Closed shell nested so that the winding number is neither 0 nor 1.
    MisnestedShell,
    /// Closed shell with exactly no volume.
    ZeroVolumeShell,
    /// Closed shell, or shell and the next one inside it, with next to nothing between its two sides.
    DoubleSkin,
    /// Part with a rim that bounds no volume, rather than a solid that lacks faces.
    OpenSheet,
    /// Part that is tiny beside the largest one.
    NoiseShell,
    /// Two triangles that pass through each other.
    SelfIntersection,
    /// Two triangles that overlap in one plane.
    Overlap,
    /// Two triangles that touch in a point or segment they do not share.
    Touch,
    /// Features that do not meet but are nearer than epsilon and half of the edges around them.
    Near,
    /// Sound as described here, but not in another reading that programs make of the file: coordinates rounded to
    /// float32, or polygons as the fan around their first corner.
    UnsoundReading,
}

impl DefectCode {
    /// How bad it is. A [`DuplicateVertex`](Self::DuplicateVertex) is an error all the same where the indices as
    /// written leave the surface open.
    pub fn severity(self) -> Severity {
        match self {
            Self::Needle | Self::Cap | Self::IsolatedVertex | Self::IsolatedEdge | Self::Near => {
                Severity::Info
            }
            Self::DuplicateVertex
            | Self::NonPlanarPolygon
            | Self::ConcavePolygon
            | Self::FoldedEdge
            | Self::DoubleSkin
            | Self::OpenSheet
            | Self::NoiseShell => Severity::Warning,
            _ => Severity::Error,
        }
    }
}

/// An element of the uploaded file, in its own numbering.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Element {
    /// Number in the file, from 0.
    pub index: u32,
    /// Line in the file, from 1, for text formats.
    pub line: Option<u32>,
}

/// Where a defect is.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Witness {
    /// Faces of the file that show it, the most telling first, at most eight.
    pub faces: Vec<Element>,
    /// Vertices of the file that show it, at most eight. For STL, which has no vertices of its own, empty.
    pub vertices: Vec<Element>,
    /// A point of the defect in the unit of the file; `None` when it is not finite.
    pub position: Option<DVec3>,
    /// What else is to be said, in the defect's own measures, e.g. `("edges", 12.0)` for a boundary loop.
    pub figures: Vec<(&'static str, f64)>,
    /// Of loops and parts, a half-edge of the soup in it (see [`edge_of`](crate::mesh::edge_of)), by which repair steps
    /// find it again.
    pub anchor: Option<u32>,
    /// Which features meet or are near each other, where the defect is of a pair of them.
    pub test: Option<ProximityTest>,
    /// What a boundary loop most likely is; `None` for chains that do not close and for other defects.
    pub hole: Option<HoleGuess>,
}

/// All defects of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What.
    pub code: DefectCode,
    /// How bad.
    pub severity: Severity,
    /// How many.
    pub count: u64,
    /// There may be more: the search ended at its bound of work.
    pub is_at_least: bool,
    /// The first ones.
    pub witnesses: Vec<Witness>,
}

impl Finding {
    /// The finding that `items` are defects of kind `code`; none without items.
    pub(super) fn of<T>(
        code: DefectCode,
        items: &[T],
        samples: usize,
        witness: impl Fn(&T) -> Witness,
    ) -> Vec<Self> {
        Self::with(code, items.len() as u64, items.iter().take(samples).map(witness).collect())
    }

    /// The finding that there are `count` defects of kind `code`, the first of which `witnesses` show; none when the
    /// count is 0.
    pub(super) fn with(code: DefectCode, count: u64, witnesses: Vec<Witness>) -> Vec<Self> {
        if count == 0 {
            return Vec::new();
        }
        vec![Self { code, severity: code.severity(), count, is_at_least: false, witnesses }]
    }
}
