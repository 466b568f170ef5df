//! Choices that several operations offer.

use crate::repair::fill::Method;
use crate::simplify::{CriterionKind, Mode, Placement, Target};

/// Whether simple holes are filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FillHoles {
    /// Leave boundary loops as they are.
    None,
    /// Planar loops by triangulation, others by ears or a fan, each kept only where it adds no contact.
    #[default]
    Simple,
}

/// What becomes of bodies that touch in vertices or edges only, so that a reader that welds would make one of them that is
/// no manifold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Contact {
    /// All but one are drawn back a little.
    #[default]
    Open,
    /// They become one body by necks as thick as a wall, where there is room; elsewhere they are drawn apart.
    Join,
}

/// What of a file of several parts is one solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum SolidParts {
    /// Each part by itself, in its own coordinates and once however often it is there.
    #[default]
    Separate,
    /// All parts at their places, after each was repaired by itself.
    Union,
    /// All parts at their places, as they are.
    Together,
}

/// How far a result may be from the file.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FidelityLimits {
    /// Largest distance, in the unit of the file, of a place of the result from the file and of a visible place of the
    /// file from the result.
    pub deviation_max: Option<f64>,
    /// Largest share by which the volume may change, where the file's is defined.
    pub volume_change_max: Option<f64>,
}

/// How far to simplify, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct SimplifyChoices {
    /// One result for each, from one run, finest first; errors in the unit of the file. None: a `simplify` halves the
    /// number of faces, a repair leaves it.
    pub targets: Vec<Target>,
    /// Which guarantees and what speed; `None`: guarded.
    pub mode: Option<Mode>,
    /// What a collapse costs.
    pub criterion: CriterionKind,
    /// Where the merged vertex goes.
    pub placement: Placement,
    /// What colours the vertices of the results have.
    pub vertex_colors: VertexColors,
    /// Largest angle in degrees by which a collapse may turn the normal of a face, from 180 on any; `None`: 78.46.
    pub normal_turn_max: Option<f64>,
}

/// What colours the vertices of a simplified mesh have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum VertexColors {
    /// Those of the file, mixed where vertices were merged.
    #[default]
    Kept,
    /// The order in which they would go, from blue to red.
    Priority,
}

impl Default for SimplifyChoices {
    fn default() -> Self {
        Self {
            targets: Vec::new(),
            mode: None,
            criterion: CriterionKind::Quadric,
            placement: Placement::Optimal,
            vertex_colors: VertexColors::Kept,
            normal_turn_max: None,
        }
    }
}

/// A hole that is to be filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ChosenHole {
    /// Place among the witnesses of the boundary loops, from 0.
    pub number: u32,
    /// `None`: as for all.
    pub method: Option<Method>,
    /// Rings of neighbours around the rim that the patch is fitted to; `None`: as for all.
    pub band_rings: Option<u32>,
}
