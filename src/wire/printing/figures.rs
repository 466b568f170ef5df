//! What was measured, in millimetres.

use serde::Serialize;
use utoipa::ToSchema;

use super::words::BuildDirection;
use crate::printing;
use crate::wire::finite::{finite, point};
use crate::wire::mesh_info::Bounds;

/// Thickness of walls, or width of gaps, by samples. Both definitions are about places that have a wall opposite: one whose
/// normal is at least 150 degrees away.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Thickness {
    /// Along the normal to the opposite wall.
    pub ray: Spread,
    /// Diameter of the largest ball that touches the surface at the place and holds nothing of it.
    pub sphere: Spread,
    /// Area below the limit of a warning; null: no limit.
    #[schema(required)]
    pub area_below_warning: Option<f64>,
    /// Area below the limit of an error; null: no limit.
    #[schema(required)]
    pub area_below_error: Option<f64>,
    /// Samples, spread evenly over the area.
    pub samples: u64,
}

/// How a figure is spread over the surface.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Spread {
    /// The smallest that was found; null: no place has a wall opposite.
    #[schema(required)]
    pub min: Option<f64>,
    /// A twentieth of the measured area has less.
    #[schema(required)]
    pub p5: Option<f64>,
    /// Half of the measured area has less.
    #[schema(required)]
    pub median: Option<f64>,
    /// Share of the area that has a wall opposite, from 0 to 1.
    pub measured_share: f64,
}

/// What needs support with one direction up.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Overhang {
    /// What is up.
    pub direction: BuildDirection,
    /// Height of the part.
    #[schema(required)]
    pub height: Option<f64>,
    /// Area of the faces below the angle limit that do not lie on the plate.
    #[schema(required)]
    pub area: Option<f64>,
    /// Sum of the shadows of those faces on the plate.
    #[schema(required)]
    pub support_area: Option<f64>,
    /// Area that lies on the plate.
    #[schema(required)]
    pub plate_area: Option<f64>,
    /// The smallest angle from the horizontal among those faces; null: there are none.
    #[schema(required)]
    pub angle_min: Option<f64>,
}

/// Sharp and short edges.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Edges {
    /// Edges with less material than this angle are counted.
    pub angle_limit: f64,
    /// How many.
    pub sharp_count: u64,
    /// Their length.
    #[schema(required)]
    pub sharp_length: Option<f64>,
    /// The smallest angle of material at an edge; null: no edge has two faces.
    #[schema(required)]
    pub angle_min: Option<f64>,
    /// Length of the shortest edge.
    #[schema(required)]
    pub shortest: Option<f64>,
}

/// Parts of their own and cavities.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Parts {
    /// Parts connected by edges, without cavities.
    pub bodies: u64,
    /// Longest side of the smallest body.
    #[schema(required)]
    pub smallest_side: Option<f64>,
    /// Volume of the smallest body; null: the mesh is not a valid solid.
    #[schema(required)]
    pub smallest_volume: Option<f64>,
    /// Bodies below the limit of the policy.
    pub small_count: u64,
    /// Cavities without a way out; null: the mesh is not a valid solid.
    #[schema(required)]
    pub cavities: Option<u64>,
    /// Volume that is trapped in them; null: the mesh is not a valid solid.
    #[schema(required)]
    pub trapped_volume: Option<f64>,
}

/// What a price depends on.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Quote {
    /// The figures can be relied on: the mesh is certified to be a valid solid, so that its volume is meant as it stands.
    pub price_safe: bool,
    /// Why they can or cannot.
    pub reason: &'static str,
    /// Volume of material; null: not defined.
    #[schema(required)]
    pub volume: Option<f64>,
    /// Area of the surface.
    #[schema(required)]
    pub area: Option<f64>,
    /// Box along the axes.
    #[schema(required)]
    pub bounds: Option<Bounds>,
    /// Small box turned in any way.
    pub oriented_box: OrientedBox,
    /// Area that the part covers seen along the build direction.
    #[schema(required)]
    pub shadow_area: Option<f64>,
}

/// A box turned in any way.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct OrientedBox {
    /// Lengths of its sides, the longest first.
    #[schema(required)]
    pub size: Option<[f64; 3]>,
    /// Their directions.
    pub axes: [[f64; 3]; 3],
    /// Its middle.
    #[schema(required)]
    pub centre: Option<[f64; 3]>,
    /// Its volume.
    #[schema(required)]
    pub volume: Option<f64>,
}

fn scaled(value: Option<f64>, factor: f64) -> Option<f64> {
    value.and_then(|value| finite(value * factor))
}

impl Thickness {
    pub(super) fn new(inner: &printing::Thickness, millimetres: f64) -> Self {
        Self {
            ray: Spread::new(&inner.ray, millimetres),
            sphere: Spread::new(&inner.sphere, millimetres),
            area_below_warning: scaled(inner.area_below_warning, millimetres.powi(2)),
            area_below_error: scaled(inner.area_below_error, millimetres.powi(2)),
            samples: inner.samples,
        }
    }
}

impl Spread {
    fn new(inner: &printing::Spread, millimetres: f64) -> Self {
        Self {
            min: scaled(inner.min, millimetres),
            p5: scaled(inner.p5, millimetres),
            median: scaled(inner.median, millimetres),
            measured_share: inner.measured_share,
        }
    }
}

impl Overhang {
    pub(super) fn new(inner: &printing::Overhang, millimetres: f64) -> Self {
        let area = |area: f64| finite(area * millimetres.powi(2));
        Self {
            direction: inner.direction.into(),
            height: finite(inner.height * millimetres),
            area: area(inner.area),
            support_area: area(inner.support_area),
            plate_area: area(inner.plate_area),
            angle_min: inner.angle_min,
        }
    }
}

impl Edges {
    pub(super) fn new(inner: &printing::Edges, millimetres: f64) -> Self {
        Self {
            angle_limit: inner.angle_limit,
            sharp_count: inner.sharp_count,
            sharp_length: finite(inner.sharp_length * millimetres),
            angle_min: inner.angle_min.and_then(finite),
            shortest: scaled(inner.shortest, millimetres),
        }
    }
}

impl Parts {
    pub(super) fn new(inner: &printing::Parts, millimetres: f64) -> Self {
        let cavities = inner.cavities.as_ref();
        Self {
            bodies: inner.bodies,
            smallest_side: scaled(inner.smallest_side, millimetres),
            smallest_volume: scaled(inner.smallest_volume, millimetres.powi(3)),
            small_count: inner.small_count,
            cavities: cavities.map(|cavities| cavities.count),
            trapped_volume: scaled(cavities.map(|cavities| cavities.volume), millimetres.powi(3)),
        }
    }
}

impl Quote {
    pub(super) fn new(inner: &printing::Quote, is_solid: bool, millimetres: f64) -> Self {
        let bounds = [inner.bounds.min, inner.bounds.max].map(|corner| point(&(corner * millimetres)));
        let reason = if is_solid {
            "the mesh is certified to be a valid solid: its volume is what it encloses"
        } else {
            "the mesh is not a valid solid, so its volume is not defined; repair it, and price the result"
        };
        Self {
            price_safe: is_solid && inner.volume.is_some_and(|volume| volume > 0.0),
            reason,
            volume: scaled(inner.volume, millimetres.powi(3)),
            area: finite(inner.area * millimetres.powi(2)),
            bounds: match bounds {
                [Some(min), Some(max)] => Some(Bounds { min, max }),
                _ => None,
            },
            oriented_box: OrientedBox::new(&inner.oriented_box, millimetres),
            shadow_area: finite(inner.shadow_area * millimetres.powi(2)),
        }
    }
}

impl OrientedBox {
    fn new(inner: &printing::OrientedBox, millimetres: f64) -> Self {
        let size = inner.size.map(|side| side * millimetres);
        Self {
            size: size.iter().all(|side| side.is_finite()).then_some(size),
            axes: inner.axes.map(|axis| axis.to_array()),
            centre: point(&(inner.centre * millimetres)),
            volume: finite(inner.volume() * millimetres.powi(3)),
        }
    }
}
