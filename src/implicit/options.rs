//! What may be chosen about an RBF surface.

/// The radial function phi of the distance r.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Kernel {
    /// r^2 log r, the thin plate spline.
    ThinPlate,
    /// r^3, which makes third derivatives small. Closest to what was removed in the benchmark of `docs/holes.md`.
    #[default]
    Cubic,
    /// -r, which makes second derivatives small. (+r is negative definite where it matters and cannot be used.)
    Linear,
}

/// The values that the field takes at the offset centres.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ConstraintValues {
    /// +1 and -1, with one lambda for all points: the least that any point needs.
    Unit,
    /// +lambda and -lambda of the point, so that the field is a distance near the points.
    #[default]
    Distance,
}

/// Whose bounding box lambda is a share of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LambdaFrom {
    /// That of the points of the band.
    #[default]
    Hole,
    /// That of the whole mesh.
    Mesh,
}

/// Lambda as a share of the diagonal of the bounding box: of the 0.5 to 1 % that the method states the end that is
/// closer to the truth on caps of spheres (`docs/rbf.md`).
pub const LAMBDA_SHARE: f64 = 0.005;
/// The most centres that are solved as one dense system unless the caller says otherwise. The work grows with their
/// cube, and 3,000 take two seconds.
pub const DENSE_CENTRES_MAX: usize = 3_000;

/// How a field is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RbfOptions {
    /// The radial function.
    pub kernel: Kernel,
    /// The distance of the offset centres from their points, in the unit of the coordinates, before it is halved where
    /// the surface needs it. `None`: [`LAMBDA_SHARE`] of the diagonal of the box named by `lambda_from`.
    pub lambda: Option<f64>,
    /// Whose bounding box lambda is a share of.
    pub lambda_from: LambdaFrom,
    /// The values at the offset centres.
    pub values: ConstraintValues,
    /// Share of the points, in (0, 1], that have offset centres. The centres on the surface are always all there.
    pub share: f64,
    /// The most centres that are solved as one dense system; more are solved in overlapping parts.
    pub dense_centres_max: usize,
}

impl Default for RbfOptions {
    fn default() -> Self {
        Self {
            kernel: Kernel::default(),
            lambda: None,
            lambda_from: LambdaFrom::default(),
            values: ConstraintValues::default(),
            share: 1.0,
            dense_centres_max: DENSE_CENTRES_MAX,
        }
    }
}
