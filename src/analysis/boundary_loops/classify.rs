//! What a loop most likely is, by what can be measured of it and of the part that it belongs to.
//!
//! The rules, in their order; the first that holds decides:
//! 1. **crack**: another rim, whose faces are on its other side, runs along all of it no farther away than a tenth of its
//!    mean edge; or its own two sides are less apart than its mean edge and a twentieth of its diameter.
//! 2. **intended opening**, the border of a sheet: its part bounds no volume, and it is at least half as long as the
//!    longest loop there; unless rule 3 holds and the patch would not lie on the part.
//! 3. **missing face**: no more edges than a quadrangle, or than the largest polygon of the file, and nearly flat.
//! 4. **intended opening**, the mouth of a vessel or the end of a pipe: flat, with all of its part on one side, and at
//!    least half as wide as the part is, seen along its axis.
//! 5. **planar cut**: flat.
//! 6. **missing region**: anything else.
//!
//! None of this can be known from a file; the confidence says how clearly the measures are on their side of the limits.

use super::shape::LoopShape;

/// What a boundary loop most likely is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum HoleClass {
    /// Two rims that nearly coincide, or a loop with next to nothing inside.
    Crack,
    /// One face is missing.
    MissingFace,
    /// A flat hole of more edges.
    PlanarCut,
    /// A hole that is not flat.
    MissingRegion,
    /// The border of a sheet, the mouth of a vessel or the end of a pipe: open on purpose.
    IntendedOpening,
}

/// A class, and how sure it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoleGuess {
    /// What the loop most likely is.
    pub class: HoleClass,
    /// How clearly, from 0 to 1, by rule and not by measurement.
    pub confidence: f64,
}

impl HoleClass {
    /// Every class.
    pub const ALL: [Self; 5] =
        [Self::Crack, Self::MissingFace, Self::PlanarCut, Self::MissingRegion, Self::IntendedOpening];
}

impl HoleGuess {
    /// How sure it is that the maker of the file would want the loop closed, from 0 to 1.
    pub fn confidence_of_closing(self) -> f64 {
        match self.class {
            HoleClass::IntendedOpening => to_cents(1.0 - self.confidence),
            _ => self.confidence,
        }
    }
}

/// Width by diameter above which a loop is no crack: about the angle of three degrees at its ends.
const CRACK_SLENDERNESS: f64 = 0.05;
/// A quadrangle; larger only where the file has larger polygons.
const FACE_EDGES_MAX: u32 = 4;
/// Largest polygon that a single face is taken for.
const POLYGON_EDGES_MAX: u32 = 12;
/// How far the corners of a missing face may be from their plane, as a share of its diameter: quadrangles of scanned and
/// swept surfaces are warped.
const FACE_WARP_MAX: f64 = 0.05;
/// How far a flat loop may be from its plane, as a share of its length.
pub(super) const FLAT_SHARE_MAX: f64 = 1e-3;
/// Area of a part by that of the flat patch, below which the patch would lie on or next to the part.
const PATCH_AREA_MIN: f64 = 1.5;
/// Length of a border of a sheet by that of its longest one.
const BORDER_SHARE_MIN: f64 = 0.5;
/// Width of a mouth by that of its part.
pub(super) const MOUTH_SHARE_MIN: f64 = 0.5;

/// What is known of the part that a loop belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LoopContext {
    /// It bounds no volume.
    pub(super) is_sheet: bool,
    /// Its area, in square units of the file.
    pub(super) area: f64,
    /// Diagonal of its box, in the unit of the file.
    pub(super) diagonal: f64,
    /// Length of its longest loop, in the unit of the file.
    pub(super) longest: f64,
    /// Corners of the largest polygon of the file.
    pub(super) polygon_corners: u32,
    /// Largest distance of the loop's vertices from those of other rims along all of it, in the unit of the file;
    /// infinite: no rim runs along it.
    pub(super) gap: f64,
    /// Width of the loop by that of its part, seen along the loop's axis, where all of the part is on one side of it; 0
    /// elsewhere, where it is too small for a mouth, and where it was not measured.
    pub(super) mouth_share: f64,
    /// The part has another such loop.
    pub(super) has_other_mouth: bool,
}

/// The class of a closed loop.
pub(super) fn classify(shape: &LoopShape, around: &LoopContext) -> HoleGuess {
    // Longer than the diagonal of the part is as large as a hole gets.
    let size = (shape.length / around.diagonal).min(1.0);
    let size = if size.is_nan() { 1.0 } else { size };
    let crack_width = shape.mean_edge().min(CRACK_SLENDERNESS * shape.diameter);
    let is_face = is_face(shape, around);
    let is_flat = shape.deviation <= FLAT_SHARE_MAX * shape.length;
    let is_border = around.is_sheet && shape.length >= BORDER_SHARE_MIN * around.longest;
    let lies_on_part = around.area < PATCH_AREA_MIN * shape.area;
    let (class, confidence) = if around.gap.is_finite() {
        (HoleClass::Crack, 0.9)
    } else if is_border && (lies_on_part || !is_face) {
        (HoleClass::IntendedOpening, 0.9)
    } else if shape.is_around && shape.width <= crack_width {
        // Half as sure at the limit as where both sides coincide.
        let share = if crack_width > 0.0 { shape.width / crack_width } else { 0.0 };
        (HoleClass::Crack, 0.95 - 0.35 * share)
    } else if is_face {
        (HoleClass::MissingFace, 0.95 - 0.3 * size)
    } else if is_flat && is_mouth(around) {
        let share = (around.mouth_share.min(1.0) - MOUTH_SHARE_MIN) / (1.0 - MOUTH_SHARE_MIN);
        let other = if around.has_other_mouth { 0.2 } else { 0.0 };
        (HoleClass::IntendedOpening, 0.5 + 0.1 * share + other)
    } else if is_flat {
        (HoleClass::PlanarCut, 0.95 - 0.3 * size)
    } else {
        (HoleClass::MissingRegion, 0.9 - 0.4 * size)
    };
    HoleGuess { class, confidence: to_cents(confidence) }
}

fn is_face(shape: &LoopShape, around: &LoopContext) -> bool {
    let edges_max = around.polygon_corners.clamp(FACE_EDGES_MAX, POLYGON_EDGES_MAX);
    shape.edges <= edges_max && shape.deviation <= FACE_WARP_MAX * shape.diameter
}

/// True for the mouth of a vessel or the end of a pipe, if it is flat.
pub(super) fn is_mouth(around: &LoopContext) -> bool {
    around.mouth_share >= MOUTH_SHARE_MIN
}

/// To two decimals: more would pretend that it was measured.
fn to_cents(confidence: f64) -> f64 {
    (confidence * 100.0).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    /// A flat hexagon of diameter 2 and its part, a hundred times as large.
    fn hexagon() -> (LoopShape, LoopContext) {
        let shape = LoopShape {
            edges: 6,
            length: 6.0,
            area: 2.6,
            deviation: 0.0,
            normal: DVec3::Z,
            diameter: 2.0,
            width: 2.0,
            is_around: true,
        };
        let around = LoopContext {
            is_sheet: false,
            area: 1e4,
            diagonal: 200.0,
            longest: 6.0,
            polygon_corners: 3,
            gap: f64::INFINITY,
            mouth_share: 0.0,
            has_other_mouth: false,
        };
        (shape, around)
    }

    fn class(change: impl Fn(&mut LoopShape, &mut LoopContext)) -> HoleClass {
        let (mut shape, mut around) = hexagon();
        change(&mut shape, &mut around);
        let guess = classify(&shape, &around);
        assert!((0.0..=1.0).contains(&guess.confidence), "{guess:?}");
        guess.class
    }

    #[test]
    fn each_rule_decides_on_its_own_measure() {
        assert_eq!(class(|_, _| ()), HoleClass::PlanarCut);
        assert_eq!(class(|shape, _| shape.deviation = 0.007), HoleClass::MissingRegion);
        assert_eq!(class(|shape, _| shape.edges = 4), HoleClass::MissingFace);
        assert_eq!(class(|_, around| around.polygon_corners = 6), HoleClass::MissingFace);
        assert_eq!(class(|shape, _| shape.width = 0.09), HoleClass::Crack);
        assert_eq!(class(|_, around| around.gap = 0.01), HoleClass::Crack);
        assert_eq!(class(|_, around| around.is_sheet = true), HoleClass::IntendedOpening);
        assert_eq!(class(|_, around| around.mouth_share = 0.6), HoleClass::IntendedOpening);
    }

    #[test]
    fn a_small_loop_in_a_sheet_is_a_hole_in_it_and_a_strip_is_no_crack() {
        let small = |_: &mut LoopShape, around: &mut LoopContext| {
            (around.is_sheet, around.longest) = (true, 100.0);
        };
        assert_eq!(class(small), HoleClass::PlanarCut);
        assert_eq!(class(|shape, _| (shape.width, shape.is_around) = (0.01, false)), HoleClass::PlanarCut);
    }

    #[test]
    fn the_larger_a_hole_the_less_sure_it_is_that_it_is_one() {
        let (shape, mut around) = hexagon();
        let small = classify(&shape, &around).confidence_of_closing();
        around.diagonal = 3.0;
        assert!(classify(&shape, &around).confidence_of_closing() < small);
        around.mouth_share = 1.0;
        let mouth = classify(&shape, &around);
        assert_eq!((mouth.class, mouth.confidence), (HoleClass::IntendedOpening, 0.6));
        assert_eq!(mouth.confidence_of_closing(), 0.4);
    }
}
