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

/// What a run of `repair` may take however few triangles the file has, in bytes: its surface may be rebuilt.
const REBUILT: u64 = 1 << 30;
/// The same of other operations.
const CHANGED: u64 = 256 << 20;

/// What an operation gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProductKind {
    /// Its report.
    Report,
    /// A mesh; the certificate says what holds.
    Mesh,
    /// A mesh that is printable.
    Solid,
    /// A picture.
    Picture,
}

/// What bounds the work of a run, in proportion to its files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WorkBound {
    /// As much as looking at a mesh takes.
    Looking,
    /// As much as a repair takes.
    Repairing,
    /// Nothing but the caller's own limit.
    Unbounded,
}

/// What is particular to an operation: its row in the table of operations.
#[derive(Debug, Clone, PartialEq)]
pub struct Facts {
    /// Name in paths, options and reports.
    pub name: &'static str,
    /// What it gives.
    pub product: ProductKind,
    /// What bounds its work.
    pub work: WorkBound,
    /// Passes of a usual run, by which progress is told.
    pub passes: f64,
    /// Bytes that it takes for each triangle, measured as peaks of a whole process (`docs/campaigns/speed.md`) or estimated from its
    /// lists.
    pub bytes_per_triangle: u64,
    /// Bytes that it may take however few the triangles are.
    pub bytes_min: u64,
    /// Numbers of files that it takes.
    pub meshes: RangeInclusive<usize>,
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

    /// Its row.
    pub fn facts(self) -> Facts {
        // The passes: read, certify and analyze the input; two lists of steps; write, certify and analyze the output.
        let row = |name, product, work, passes, bytes_per_triangle, bytes_min| Facts {
            name,
            product,
            work,
            passes,
            bytes_per_triangle,
            bytes_min,
            meshes: 1..=1,
        };
        use ProductKind::{Mesh, Picture, Report, Solid};
        use WorkBound::{Looking, Repairing, Unbounded};
        match self {
            Self::Analyze => row("analyze", Report, Looking, 3.0, 170, CHANGED),
            Self::Plan => row("plan", Report, Looking, 3.0, 410, REBUILT),
            Self::Repair => row("repair", Solid, Repairing, 8.0, 410, REBUILT),
            Self::Convert => row("convert", Mesh, Looking, 5.0, 170, CHANGED),
            Self::Verify => row("verify", Report, Looking, 2.0, 170, CHANGED),
            Self::Simplify => row("simplify", Mesh, Unbounded, 9.0, 410, CHANGED),
            Self::CutStitch => row("cut-stitch", Mesh, Unbounded, 7.0, 170, CHANGED),
            Self::FillHoles => row("fill-holes", Mesh, Unbounded, 7.0, 410, REBUILT),
            // Exact planes and points, and the boxes around them: 1 to 2 kB for each triangle of parts that were measured.
            Self::Modeller => row("modeller", Mesh, Unbounded, 7.0, 2000, CHANGED),
            // At least two meshes are read, certified and analyzed; the arrangement of all, with winding numbers for each.
            Self::Boolean => {
                Facts { meshes: 2..=MESHES_MAX, ..row("boolean", Solid, Repairing, 11.0, 1000, CHANGED) }
            }
            Self::Render => row("render", Picture, Looking, 4.0, 170, CHANGED),
        }
    }

    /// Name in paths, options and reports.
    pub fn name(self) -> &'static str {
        self.facts().name
    }

    /// True when its answer has no mesh.
    pub(crate) fn only_reports(self) -> bool {
        matches!(self.facts().product, ProductKind::Report | ProductKind::Picture)
    }

    /// Numbers of files that it takes.
    pub fn meshes(self) -> RangeInclusive<usize> {
        self.facts().meshes
    }

    pub(super) fn meshes_taken(self) -> String {
        match self.meshes().into_inner() {
            (_, 1) => "one mesh".to_owned(),
            (least, most) => format!("{least} to {most} meshes"),
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
