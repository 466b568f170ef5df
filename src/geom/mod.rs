//! Points, exact predicates and triangle-triangle classification. Knows no mesh, only coordinates.

mod closest;
mod differences;
mod directions;
mod exact;
pub(crate) mod integers;
mod pitch;
mod predicates;
mod projection;
mod radial;
mod ray;
mod region;
mod sign;
mod thinness;
mod tri_tri;
mod volume;

pub(crate) use closest::closest_with_square;
pub use closest::{closest_point_on_triangle, shares_of_corners};
pub use directions::{DirectionCone, arc_box, direction};
pub(crate) use exact::BitSpan;
pub use exact::{suits_expansions, work_on_exact_signs};
pub use glam::{DMat3, DVec2, DVec3};
pub use pitch::{exponent_above, power_of_two, print_pitch};
pub use predicates::{ThreePointPlane, certain_turns, orient2d, orient3d};
pub use projection::{AxisProjection, are_collinear, is_on_segment};
pub use radial::radial_order;
pub use ray::upward_crossing;
pub(crate) use region::triangulate_region;
pub use sign::Sign;
pub use thinness::{NEEDLE_RATIO, Thinness, is_folded, thinness};
pub use tri_tri::{ContactKind, Shared, contact};
pub use volume::{signed_volume, triangle_area, volume_sign};

/// Axis-aligned box of a point set; empty when `min > max`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// The box of nothing.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The box of `points`, which must be finite.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// True when the boxes have a point in common.
    pub fn meets(self, other: Self) -> bool {
        (self.min.cmple(other.max) & other.min.cmple(self.max)).all()
    }

    /// True for the box of nothing.
    pub fn is_empty(self) -> bool {
        self.min.x > self.max.x
    }

    /// Length of the diagonal, in the unit of the coordinates; 0 for the box of nothing.
    pub fn diagonal(self) -> f64 {
        if self.is_empty() { 0.0 } else { (self.max - self.min).length() }
    }
}
