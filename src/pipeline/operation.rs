//! The operations, and what a caller demands of their results.

use std::ops::RangeInclusive;

/// Most files that one run of `boolean` combines: each costs twelve bytes for every triangle of the arrangement of all.
pub const MESHES_MAX: usize = 32;

/// What to do with a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Operation {
    /// Report only.
    Analyze,
    /// Report and what a repair would do about each defect.
    Plan,
    /// Report and a certified repair.
    Repair,
    /// The same mesh in another format; its certificate states what holds.
    Convert,
    /// The certificate of the file as it is.
    Verify,
    /// Fewer triangles; the certificate states what holds.
    Simplify,
    /// A manifold with boundary; the certificate states what holds.
    CutStitch,
    /// Holes closed; the certificate states what holds.
    FillHoles,
    /// A closed polyhedron edited by its planes; the certificate states what holds.
    Modeller,
    /// Several solids combined into one that is certified.
    Boolean,
    /// A picture.
    Render,
}

impl Operation {
    /// Every operation.
    pub const ALL: [Self; 11] = [
        Self::Analyze,
        Self::Plan,
        Self::Repair,
        Self::Convert,
        Self::Verify,
        Self::Simplify,
        Self::CutStitch,
        Self::FillHoles,
        Self::Modeller,
        Self::Boolean,
        Self::Render,
    ];

    /// Name in paths, options and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Analyze => "analyze",
            Self::Plan => "plan",
            Self::Repair => "repair",
            Self::Convert => "convert",
            Self::Verify => "verify",
            Self::Simplify => "simplify",
            Self::CutStitch => "cut-stitch",
            Self::FillHoles => "fill-holes",
            Self::Modeller => "modeller",
            Self::Boolean => "boolean",
            Self::Render => "render",
        }
    }

    /// True when its answer has no mesh.
    pub(crate) fn only_reports(self) -> bool {
        matches!(self, Self::Analyze | Self::Plan | Self::Verify | Self::Render)
    }

    /// Numbers of files that it takes.
    pub fn meshes(self) -> RangeInclusive<usize> {
        if self == Self::Boolean { 2..=MESHES_MAX } else { 1..=1 }
    }

    pub(super) fn meshes_taken(self) -> String {
        match self {
            Self::Boolean => format!("2 to {MESHES_MAX} meshes"),
            _ => "one mesh".to_owned(),
        }
    }
}

/// What the caller demands of a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Require {
    /// P0, P1 and P2 hold, or the answer is a refusal. Default of `repair`.
    Printable,
    /// That, and the result is exact or faithful to the file, or the answer is a refusal.
    Faithful,
    /// The best result there is, called `partial` when it is not printable.
    BestEffort,
    /// Whatever the operation gives, and nothing is rebuilt; the certificate says what holds. Default of all other
    /// operations.
    None,
}

impl Require {
    /// True when P0, P1 and P2 must hold.
    pub fn is_of_a_solid(self) -> bool {
        matches!(self, Self::Printable | Self::Faithful)
    }
}
