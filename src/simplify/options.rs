//! What the caller chooses: how far, by which measure, and what must not happen on the way.

use crate::geom::{Aabb, DVec3};

/// How far to simplify.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// To at most this many triangles.
    Faces(usize),
    /// To at most this share (0 to 1) of the faces there were.
    Ratio(f64),
    /// As far as no collapse has an error above this, in the unit of the coordinates. What the error measures depends
    /// on the [`CriterionKind`].
    Error(f64),
}

/// What a collapse costs, which decides the order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CriterionKind {
    /// Area-weighted squared distances from the planes of all triangles that a vertex stands for. Error: the root of
    /// their mean.
    Quadric,
    /// Changes of the enclosed volume by this collapse alone, the volume kept exactly where the mesh has no boundary.
    /// Error: the root mean square distance, weighted with squared areas, from the planes of the triangles before.
    Memoryless,
    /// The length of the edge. Error: that length.
    Length,
}

/// Where the merged vertex goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Placement {
    /// Where the criterion is smallest.
    Optimal,
    /// To the better one of the edge's ends: no new positions.
    OntoEnd,
}

/// What happens to borders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Borders {
    /// Border vertices move and merge along the border only, held by planes across it.
    Follow,
    /// Border vertices stay where they are.
    Keep,
}

/// Says whether a triangle that a collapse would make is near enough to the original surface.
pub trait Envelope: Sync {
    /// True when the triangle may be made.
    fn holds(&self, corners: [DVec3; 3]) -> bool;
}

/// What a collapse must not do to the faces around it.
#[derive(Clone, Copy)]
pub struct Guards<'a> {
    /// The cosine of the angle by which the normal of a face may turn in one collapse.
    pub normal_cos_min: f64,
    /// The least aspect of a changed face, unless it was worse before: 4 √3 area over the sum of the squared sides, 1
    /// for the equilateral triangle and 0 for the degenerate one.
    pub aspect_min: f64,
    /// Every changed face must lie in it.
    pub envelope: Option<&'a dyn Envelope>,
}

impl Default for Guards<'_> {
    fn default() -> Self {
        Self { normal_cos_min: 0.2, aspect_min: 1e-3, envelope: None }
    }
}

/// The settings of a run.
#[derive(Clone)]
pub struct SimplifyOptions<'a> {
    /// One result for each, all from one run: give them from the finest to the coarsest. A target that the mesh has
    /// reached already changes nothing.
    pub targets: Vec<Target>,
    /// What a collapse costs.
    pub criterion: CriterionKind,
    /// Where the merged vertex goes.
    pub placement: Placement,
    /// What must not happen to faces.
    pub guards: Guards<'a>,
    /// What happens to borders.
    pub borders: Borders,
    /// Edges whose faces' normals have at most this cosine are creases: their vertices move and merge along them only.
    /// At -1 or below there are none; the quadrics hold sharp edges anyway.
    pub crease_cos_max: f64,
    /// Weight of the planes that hold borders, creases and borders between face groups, times squared edge length.
    pub wall_weight: f64,
    /// Put new positions on the lattice of pitch `2^(ceil(log2 M) - 23)`, `M` the largest magnitude of a coordinate:
    /// all its points are float32, so that a file of float32 holds the very result.
    pub round: bool,
    /// In the fast and the guarded mode, vertices in these boxes stay, in the unit of the input.
    pub held: &'a [Aabb],
    /// In the guarded mode also refuse collapses that sweep over something. Otherwise the surface is looked at after each
    /// round only: what is valid stays valid, but a plate may go over a pebble on the way.
    pub sweeps: bool,
    /// Give the results the costs of the collapses that would follow.
    pub priorities: bool,
}

impl Default for SimplifyOptions<'_> {
    fn default() -> Self {
        Self {
            targets: vec![Target::Ratio(0.5)],
            criterion: CriterionKind::Quadric,
            placement: Placement::Optimal,
            guards: Guards::default(),
            borders: Borders::Follow,
            crease_cos_max: -2.0,
            wall_weight: 1.0,
            round: true,
            held: &[],
            sweeps: true,
            priorities: false,
        }
    }
}
