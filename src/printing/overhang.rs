//! What hangs over nothing in each orientation.

use super::surface::WeldedSurface;
use super::{BuildDirection, Limit, PrintingWitness};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::triangle_area;
use crate::par;

/// Faces below this angle from the horizontal need support when a policy does not say: the angle that design guides give
/// for most processes, in degrees.
pub(super) const ANGLE_DEFAULT: f64 = 45.0;

/// Cosines closer than this are those of the same angle: a few roundings of a unit normal.
const COSINE_SLACK: f64 = 1e-9;

/// A face no higher above the lowest point than this share of the diagonal lies on the plate.
const PLATE_SHARE: f64 = 1e-6;

/// What needs support when the part stands with one direction up. Angles are from the horizontal, in degrees: 0 is a
/// flat ceiling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overhang {
    /// What is up.
    pub direction: BuildDirection,
    /// Height of the part, in the unit of the file.
    pub height: f64,
    /// Area of the faces below the angle limit that do not lie on the plate, in square units of the file.
    pub area: f64,
    /// Sum of their shadows on the plate: the area on which support stands, one above another counted each.
    pub support_area: f64,
    /// Area that lies on the plate.
    pub plate_area: f64,
    /// The smallest angle among those faces; `None`: there are none.
    pub angle_min: Option<f64>,
}

/// The angle below which a face needs support.
pub(super) fn angle_limit(limit: &Limit) -> f64 {
    limit.first_below().unwrap_or(ANGLE_DEFAULT)
}

/// The figures of one direction.
pub(super) fn overhang(
    surface: &WeldedSurface<'_>,
    direction: BuildDirection,
    angle_limit: f64,
    budget: &Budget,
) -> Result<Overhang, Stopped> {
    let view = OverhangView::new(surface, direction, angle_limit);
    let none = Overhang {
        direction,
        height: view.top - view.floor,
        area: 0.0,
        support_area: 0.0,
        plate_area: 0.0,
        angle_min: None,
    };
    let parts = par::try_map_ranges(surface.triangles.len(), CHECK_EVERY, |range| {
        budget.check()?;
        Ok(range.fold((none, 0.0f64), |(mut sum, mut steepest), t| {
            match view.stand(t as u32) {
                Stand::OnPlate => sum.plate_area += triangle_area(surface.corners(t as u32)),
                Stand::Overhangs { cosine } => {
                    let area = triangle_area(surface.corners(t as u32));
                    sum.area += area;
                    sum.support_area += area * cosine;
                    steepest = steepest.max(cosine);
                }
                Stand::NeedsNothing => {}
            }
            (sum, steepest)
        }))
    })?;
    let (sum, cosine) = parts.into_iter().fold((none, 0.0), |(all, most), (part, cosine)| {
        let sum = Overhang {
            area: all.area + part.area,
            support_area: all.support_area + part.support_area,
            plate_area: all.plate_area + part.plate_area,
            ..all
        };
        (sum, f64::max(most, cosine))
    });
    Ok(Overhang { angle_min: (cosine > 0.0).then(|| degrees_of_cosine(cosine)), ..sum })
}

/// The faces with the smallest angles, at most `most`.
pub(super) fn witnesses(
    surface: &WeldedSurface<'_>,
    direction: BuildDirection,
    angle_limit: f64,
    most: usize,
    budget: &Budget,
) -> Result<Vec<PrintingWitness>, Stopped> {
    let view = OverhangView::new(surface, direction, angle_limit);
    let mut found: Vec<(f64, f64, u32)> = Vec::new();
    for t in 0..surface.triangles.len() as u32 {
        if (t as usize).is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        if let Stand::Overhangs { cosine } = view.stand(t) {
            found.push((cosine, triangle_area(surface.corners(t)), t));
        }
    }
    found.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1)).then(a.2.cmp(&b.2)));
    let witness = |&(cosine, _, t): &(f64, f64, u32)| surface.witness_in_middle(t, degrees_of_cosine(cosine));
    Ok(found.iter().take(most).map(witness).collect())
}

fn degrees_of_cosine(cosine: f64) -> f64 {
    libm::acos(cosine.min(1.0)).to_degrees()
}

/// How a face stands.
enum Stand {
    OnPlate,
    Overhangs {
        /// Of its angle from the horizontal.
        cosine: f64,
    },
    NeedsNothing,
}

/// The surface with one direction up.
struct OverhangView<'v> {
    surface: &'v WeldedSurface<'v>,
    axis: usize,
    sign: f64,
    floor: f64,
    top: f64,
    cosine_limit: f64,
}

impl<'v> OverhangView<'v> {
    fn new(surface: &'v WeldedSurface<'v>, direction: BuildDirection, angle_limit: f64) -> Self {
        let (axis, sign) = direction.axis();
        let ends = [surface.bounds.min[axis] * sign, surface.bounds.max[axis] * sign];
        Self {
            surface,
            axis,
            sign,
            floor: ends[0].min(ends[1]),
            top: ends[0].max(ends[1]),
            cosine_limit: libm::cos(angle_limit.to_radians()),
        }
    }

    fn stand(&self, t: u32) -> Stand {
        let cosine = -self.surface.normals[t as usize][self.axis] * self.sign;
        if cosine <= self.cosine_limit + COSINE_SLACK {
            return Stand::NeedsNothing;
        }
        let plate = self.floor + PLATE_SHARE * self.surface.diagonal();
        if self.surface.corners(t).iter().all(|corner| corner[self.axis] * self.sign <= plate) {
            return Stand::OnPlate;
        }
        Stand::Overhangs { cosine }
    }
}
