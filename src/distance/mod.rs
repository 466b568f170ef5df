//! How far two surfaces are from each other.
//!
//! The distance of a point from a surface is that to its closest point. The *directed* distance from one surface to
//! another is the largest over the points of the first, the *Hausdorff* distance is the larger of both directions. It is
//! enclosed between a lower bound, which is a distance at a place that is named, and an upper bound that no point of the
//! surface exceeds: branch and bound over ever smaller pieces of triangles (as Guthe, Borodin and Klein 2005, with other
//! bounds; see `bound` and `cover`). The mean is over the area, by systematic sampling. The work is bounded in
//! proportion to the triangles of both surfaces; where that ends the search the bounds hold, and it is told that they are
//! farther apart than was asked.

mod bound;
mod cover;
mod creases;
mod pieces;
mod samples;
mod scale;
mod search;
mod target;
mod view;

use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::par;
pub use creases::creases_recovered;
pub use samples::{Areas, SurfaceSample};
use scale::Common;
use search::Directed;
use target::DistanceTarget;
use view::ScaledSight;

/// The triangles of a surface, by reference. Triangles may be degenerate, open, or meet in any way.
#[derive(Debug, Clone, Copy)]
pub struct Surface<'s> {
    /// Vertex positions. Those that a triangle uses must be finite.
    pub positions: &'s [DVec3],
    /// Vertex ids of each triangle's corners.
    pub triangles: &'s [[u32; 3]],
}

/// How closely to enclose a distance, and how much to spend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DistanceOptions {
    /// The upper bound may exceed the lower one by this share of it.
    pub tolerance_relative: f64,
    /// And by this share of the diagonal of the box around both surfaces.
    pub tolerance_of_diagonal: f64,
    /// Samples for the mean, for each direction; none: no mean. Fewer are taken where they cost too much.
    pub samples: u32,
    /// Closest points to find, for each direction, beyond one for each vertex, sample and triangle. When they are used
    /// up the upper bound still holds, but may be farther from the lower one than the tolerances.
    pub refinements_max: u64,
    /// Units of work for them, for each direction; the wave of refinements in which they are used up is the last.
    pub refining_work_max: u64,
    /// What is farther than this from the second surface is lost, in the unit of the coordinates; `None`: that is not told.
    pub lost_beyond: Option<f64>,
}

impl Default for DistanceOptions {
    fn default() -> Self {
        Self {
            tolerance_relative: 0.01,
            tolerance_of_diagonal: 1e-6,
            samples: 1 << 17,
            refinements_max: 1 << 26,
            refining_work_max: u64::MAX,
            lost_beyond: None,
        }
    }
}

/// Gives the first of these places on a triangle, which is named, that can be seen. It may keep what hid one place to look at it
/// first for the next.
pub type VisibilitySearch<'v> =
    Box<dyn FnMut(&mut dyn Iterator<Item = DVec3>, u32) -> Result<Option<DVec3>, Stopped> + 'v>;

/// Makes a look at places on triangles of the first surface, whose answers do not depend on earlier ones. The distance is then
/// that of the places that can be seen: of a piece of a triangle that is farther than others some places are asked about, and
/// it counts unless all are hidden.
pub type Look<'v> = &'v (dyn Fn() -> VisibilitySearch<'v> + Sync);

/// Shares of the area of a surface, by sampling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AreaShares {
    /// What is hidden.
    pub hidden_share: f64,
    /// What is lost, of what can be seen.
    pub lost_share: f64,
}

/// The place where a distance was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FarPoint {
    /// A point of the first surface.
    pub place: DVec3,
    /// Its triangle there.
    pub triangle: u32,
    /// The closest point of the other surface.
    pub closest: DVec3,
    /// A triangle of the other surface that the closest point is on.
    pub closest_triangle: u32,
}

/// The distance from one surface to another. Lengths are in the unit of the coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DirectedDistance {
    /// No point of the first surface is farther from the other than this.
    pub upper: f64,
    /// The distance at `farthest`; the true maximum is at least this, up to rounding.
    pub lower: f64,
    /// True when `upper` exceeds `lower` by no more than the tolerances; false when the search ended before.
    pub is_within_tolerance: bool,
    /// The farthest point that was looked at.
    pub farthest: FarPoint,
    /// The mean over the area of the first surface; `None` without samples.
    pub mean: Option<f64>,
    /// The root of the mean square over the area of the first surface; `None` without samples.
    pub root_mean_square: Option<f64>,
    /// What is hidden and lost; `None` where it is not asked what is lost.
    pub seen: Option<AreaShares>,
}

/// The distance between two surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceDistance {
    /// From the first to the second.
    pub forward: DirectedDistance,
    /// From the second to the first.
    pub backward: DirectedDistance,
}

impl SurfaceDistance {
    /// The Hausdorff distance is at most this.
    pub fn upper(&self) -> f64 {
        self.forward.upper.max(self.backward.upper)
    }

    /// The Hausdorff distance is at least this.
    pub fn lower(&self) -> f64 {
        self.forward.lower.max(self.backward.lower)
    }

    /// True when it is told of both surfaces what is lost.
    pub fn tells_what_is_lost(&self) -> bool {
        self.forward.seen.is_some() && self.backward.seen.is_some()
    }

    /// True when both directions are enclosed within the tolerances.
    pub fn is_within_tolerance(&self) -> bool {
        self.forward.is_within_tolerance && self.backward.is_within_tolerance
    }
}

/// The two-sided distance between surfaces `a` and `b`; `None` when one of them has no triangle.
///
/// Spends one work unit for each closest point. The same whatever the thread count.
///
/// # Errors
/// When the budget stops the run.
pub fn surface_distance(
    a: Surface<'_>,
    b: Surface<'_>,
    options: &DistanceOptions,
    budget: &Budget,
) -> Result<Option<SurfaceDistance>, Stopped> {
    if a.triangles.is_empty() || b.triangles.is_empty() {
        return Ok(None);
    }
    let common = Common::of(a, b, budget)?;
    let (a, b) = common.surfaces();
    let (to_a, to_b) =
        par::join(|| DistanceTarget::of(a, &common, budget), || DistanceTarget::of(b, &common, budget));
    let (to_a, to_b) = (to_a?, to_b?);
    let view = ScaledSight::of(None, &common, options);
    let directed = |from, to| Directed { from, to, view, common: &common, options, budget }.measure();
    let forward = directed(a, &to_b)?;
    let backward = directed(b, &to_a)?;
    Ok(Some(SurfaceDistance { forward: common.unscale(forward), backward: common.unscale(backward) }))
}

/// The distance from what of `from` can be seen to surface `to`, one direction of [`surface_distance`]; without a `look` all of
/// it can be seen.
///
/// # Errors
/// When the budget stops the run.
pub fn directed_distance(
    from: Surface<'_>,
    to: Surface<'_>,
    look: Option<Look<'_>>,
    options: &DistanceOptions,
    budget: &Budget,
) -> Result<Option<DirectedDistance>, Stopped> {
    if from.triangles.is_empty() || to.triangles.is_empty() {
        return Ok(None);
    }
    let common = Common::of(from, to, budget)?;
    let (from, to) = common.surfaces();
    let to = DistanceTarget::of(to, &common, budget)?;
    let view = ScaledSight::of(look, &common, options);
    let found = Directed { from, to: &to, view, common: &common, options, budget }.measure()?;
    Ok(Some(common.unscale(found)))
}
