//! What became of each hole.

use super::Method;
use crate::geom::DVec3;
use crate::implicit::FitFacts;
use crate::repair::Changes;

/// Why a patch was not taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Rejection {
    /// The method makes no patch for such a hole: its rim crosses itself in the view, or no triangulation avoids
    /// triangles without area and edges in use.
    NoPatch,
    /// The rim has more corners, or the patch more vertices, than the method takes.
    TooLarge,
    /// The equations of a smooth patch have no solution, or it swings out far beyond the hole.
    NoFit,
    /// The rim and the rings around it have too few points for a field, or all its centres lie in one plane.
    TooFewPoints,
    /// Other parts of the surface are at the rim everywhere, so that no side of it can be told from the other.
    NoRoom,
    /// The equations of the field are singular to working precision.
    Singular,
    /// The field misses the values that it should take.
    Inexact,
    /// A vertex finds no zero of the field within half the diagonal of the rim.
    NoZero,
    /// The rim is that of a flat sheet, on which every patch would lie.
    FlatSheet,
    /// A triangle without area.
    DegenerateTriangle,
    /// It is not a surface with exactly the rim as its boundary.
    Topology,
    /// An edge of it is an edge of the mesh or of another patch already, or a triangle the double of another.
    EdgeInUse,
    /// It meets the mesh or another patch beyond the rim.
    MeetsOther,
    /// It meets itself.
    MeetsItself,
    /// Its new vertices have no place among the numbers of float32.
    NotRepresentable,
}

/// A patch that was not taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rejected {
    /// How it was made.
    pub method: Method,
    /// Why it was not taken.
    pub reason: Rejection,
    /// Near where it meets something, in the unit of the file; `None`: that was not what was wrong, or not told.
    pub at: Option<DVec3>,
}

impl Rejected {
    /// A patch that was not taken for what it is by itself.
    pub(super) fn alone(method: Method, reason: Rejection) -> Self {
        Self { method, reason, at: None }
    }
}

/// A boundary loop of a hole, or the part of it that is at the hole: where loops meet in several vertices, each gap between
/// them may be closed by itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HoleRim {
    /// The half-edges of the soup that are in it; those of new triangles are none.
    pub half_edges: Vec<u32>,
    /// Its edges.
    pub edges: u32,
}

/// What became of one hole: one loop, or several that get one patch between them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HoleReport {
    /// The first half-edge of the draft in its first loop, which is what reports are sorted by.
    pub order: u32,
    /// Its loops, the outer one first.
    pub rims: Vec<HoleRim>,
    /// Loops that count as closed with it: whole ones, and one for all that it has only parts of.
    pub loops: u64,
    /// The number of closed walks that its rim is: fewer where loops that meet in a vertex are joined.
    pub borders: u64,
    /// The method that was asked for.
    pub asked: Method,
    /// The method whose patch it has; `None`: it stays open.
    pub used: Option<Method>,
    /// Patches that were made before and not taken, in their order.
    pub rejected: Vec<Rejected>,
    /// Triangles of the patch.
    pub triangles: u64,
    /// New vertices of the patch.
    pub vertices: u64,
    /// Area of the patch, in square units of the file.
    pub area: f64,
    /// The field whose surface the patch is; `None`: it is of another method, or has no new vertex.
    pub field: Option<FitFacts>,
}

/// What a fill did.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FillReport {
    /// The sum, as every step tells it.
    pub changes: Changes,
    /// One for each hole that was to be filled, in the order of their first loops.
    pub holes: Vec<HoleReport>,
}
