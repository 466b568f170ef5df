//! How far two surfaces are from each other.

use serde::Serialize;
use utoipa::ToSchema;

use super::finite::finite;
use crate::distance;

/// How far two surfaces are from each other, in the unit of the file.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Distance {
    /// From the input to the result.
    pub input_to_result: DirectedDistance,
    /// From the result to the input.
    pub result_to_input: DirectedDistance,
}

/// How far one surface is from another, in the unit of the file.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct DirectedDistance {
    /// No point of the surface is farther away than this.
    #[schema(required)]
    pub max: Option<f64>,
    /// The distance at `place`; the largest one lies between this and `max`.
    #[schema(required)]
    pub found: Option<f64>,
    /// True when `max` and `found` are as close as the search aims at; false when the work that a file of this size is worth
    /// was used up before. Both bounds hold either way.
    pub is_close: bool,
    /// The farthest point that was found.
    #[schema(required)]
    pub place: Option<[f64; 3]>,
    /// Mean over the area, by sampling.
    #[schema(required)]
    pub mean: Option<f64>,
    /// Root of the mean square over the area, by sampling.
    #[schema(required)]
    pub root_mean_square: Option<f64>,
}

impl From<&distance::SurfaceDistance> for Distance {
    fn from(inner: &distance::SurfaceDistance) -> Self {
        Self {
            input_to_result: DirectedDistance::from(&inner.forward),
            result_to_input: DirectedDistance::from(&inner.backward),
        }
    }
}

impl From<&distance::DirectedDistance> for DirectedDistance {
    fn from(inner: &distance::DirectedDistance) -> Self {
        Self {
            max: finite(inner.upper),
            found: finite(inner.lower),
            is_close: inner.is_within_tolerance,
            place: inner.farthest.place.is_finite().then(|| inner.farthest.place.to_array()),
            mean: inner.mean.and_then(finite),
            root_mean_square: inner.root_mean_square.and_then(finite),
        }
    }
}
