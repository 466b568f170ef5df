//! Why there is no field.

/// Why no field was fitted.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Unfit {
    /// There are fewer points than a plane needs, or the lists have different lengths.
    #[error(
        "the band has {points} points with {normals} normals; at least 3 points with one normal each are needed"
    )]
    TooFewPoints {
        /// Points of the band.
        points: usize,
        /// Normals of the band.
        normals: usize,
    },
    /// A coordinate or normal is not a finite number, a normal has no length, or all points are one.
    #[error("point {point} of the band or its normal is not a finite number or has no extent")]
    NotFinite {
        /// The first such point of the band.
        point: usize,
    },
    /// Lambda, the share or another option is outside of its range.
    #[error("lambda must be a positive number and the share of offset constraints above 0 and at most 1")]
    Options,
    /// No point has offset constraints, because other parts of the surface are at it everywhere: the field would be zero.
    #[error("no point of the band has room for offset constraints")]
    NoRoom,
    /// All centres lie in one plane or on one line, so that no field is determined by them.
    #[error("the centres determine only {rank} of the 4 linear polynomials")]
    Rank {
        /// How many of the polynomials of degree 1 or less they tell apart.
        rank: usize,
    },
    /// The matrix is not positive definite in f64: centres nearly coincide.
    #[error("the system of {centres} centres is singular to working precision")]
    Singular {
        /// Centres of the system.
        centres: usize,
    },
    /// The solution misses the values that it should take.
    #[error("the field misses its values by {residual:e} of the largest, more than 1e-9")]
    Residual {
        /// The largest difference at a centre over the largest value.
        residual: f64,
    },
}
