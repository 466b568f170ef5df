//! What a collapse must not do to the faces around it.

use super::options::Guards;
use super::report::SimplifyRefusal;
use super::surface::CollapseSurface;
use crate::geom::{DVec3, are_collinear};
use crate::mesh::corner_table::{EdgeRings, NONE, VertexRing, prev, triangle_of};

/// Twice the area of a triangle over the product of two of its sides is their sine; above this the rounded value
/// cannot come from collinear corners (its error is a few times 2^-53).
const SINE_OF_DOUBT: f64 = 1e-12;

/// Whether the faces that stay around the edge of `h` remain sound when its ends move to `position`.
#[inline]
pub(super) fn check_faces<S: Copy + Default>(
    surface: &CollapseSurface<S>,
    h: u32,
    rings: &EdgeRings,
    position: DVec3,
    guards: &Guards<'_>,
) -> Result<(), SimplifyRefusal> {
    let twin = surface.table.twin(h);
    let removed = [triangle_of(h), if twin == NONE { NONE } else { triangle_of(twin) }];
    check_ring(surface, &rings.origin, removed, position, guards)?;
    check_ring(surface, &rings.destination, removed, position, guards)
}

#[inline]
fn check_ring<S: Copy + Default>(
    surface: &CollapseSurface<S>,
    ring: &VertexRing,
    removed: [u32; 2],
    position: DVec3,
    guards: &Guards<'_>,
) -> Result<(), SimplifyRefusal> {
    let Some(&first) = ring.corners.first() else { return Ok(()) };
    let before = surface.position(surface.table.origin(first));
    for (&corner, &neighbour) in ring.corners.iter().zip(&ring.neighbours) {
        if !removed.contains(&triangle_of(corner)) {
            let other = surface.table.origin(prev(corner));
            let fixed = [neighbour, other].map(|v| surface.position(v));
            check_face(before, position, fixed, guards, surface.scale)?;
        }
    }
    Ok(())
}

/// Whether a face stays sound when its first corner moves. The envelope sees the input's units, `scale` times smaller.
#[inline]
fn check_face(
    from: DVec3,
    to: DVec3,
    [q, r]: [DVec3; 2],
    guards: &Guards<'_>,
    scale: f64,
) -> Result<(), SimplifyRefusal> {
    let (old_q, old_r, new_q, new_r, side) = (q - from, r - from, q - to, r - to, r - q);
    let (old, new) = (old_q.cross(old_r), new_q.cross(new_r));
    let (old_squared, new_squared) = (old.length_squared(), new.length_squared());
    let (q_squared, r_squared) = (new_q.length_squared(), new_r.length_squared());
    let doubt = SINE_OF_DOUBT * SINE_OF_DOUBT * q_squared * r_squared;
    if new_squared.is_nan() || (new_squared <= doubt && are_collinear(to, q, r)) {
        return Err(SimplifyRefusal::Degenerate);
    }
    // A face without a normal has none to turn.
    if old_squared > 0.0 {
        let cosine = guards.normal_cos_min;
        let product = old.dot(new);
        let limit = cosine * cosine * old_squared * new_squared;
        let is_within = if cosine >= 0.0 {
            product >= 0.0 && product * product >= limit
        } else {
            product >= 0.0 || product * product <= limit
        };
        if !is_within {
            return Err(SimplifyRefusal::NormalTurns);
        }
    }
    let side_squared = side.length_squared();
    let is_thin = |area_squared: f64, sides_squared: f64| {
        12.0 * area_squared < guards.aspect_min * guards.aspect_min * sides_squared * sides_squared
    };
    if is_thin(new_squared, q_squared + r_squared + side_squared) {
        let old_sides = old_q.length_squared() + old_r.length_squared() + side_squared;
        let new_sides = q_squared + r_squared + side_squared;
        let is_better = new_squared * old_sides * old_sides > old_squared * new_sides * new_sides;
        if !is_better {
            return Err(SimplifyRefusal::Aspect);
        }
    }
    match guards.envelope {
        Some(envelope) if !envelope.holds([to, q, r].map(|p| p / scale)) => Err(SimplifyRefusal::Envelope),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simplify::options::Envelope;

    const Q: DVec3 = DVec3::new(1.0, 0.0, 0.0);
    const R: DVec3 = DVec3::new(0.0, 1.0, 0.0);

    fn moved(to: [f64; 3], guards: &Guards<'_>) -> Result<(), SimplifyRefusal> {
        check_face(DVec3::ZERO, DVec3::from_array(to), [Q, R], guards, 1.0)
    }

    #[test]
    fn a_face_may_turn_up_to_the_limit() {
        // From the corner opposite to the hypotenuse, raised: the normal turns by the slope.
        let guards = |normal_cos_min| Guards { normal_cos_min, ..Guards::default() };
        let half = 0.5f64.sqrt();
        for (height, cosine) in [(half, half), (half * 3.0f64.sqrt(), 0.5)] {
            assert_eq!(moved([0.0, 0.0, height], &guards(cosine - 1e-9)), Ok(()));
            assert_eq!(moved([0.0, 0.0, height], &guards(cosine + 1e-9)), Err(SimplifyRefusal::NormalTurns));
        }
        assert_eq!(moved([1.0, 1.0, 0.0], &guards(0.0)), Err(SimplifyRefusal::NormalTurns));
        assert_eq!(moved([1.0, 1.0, 0.0], &guards(-1.0)), Ok(()));
        assert_eq!(moved([1.0, 1.0, 0.1], &guards(-0.5)), Err(SimplifyRefusal::NormalTurns));
    }

    #[test]
    fn a_face_is_degenerate_only_when_its_corners_are_exactly_collinear() {
        let guards = Guards { normal_cos_min: -1.0, aspect_min: 0.0, envelope: None };
        assert_eq!(moved([0.5, 0.5, 0.0], &guards), Err(SimplifyRefusal::Degenerate));
        assert_eq!(moved([0.5, 0.5 - 2f64.powi(-54), 0.0], &guards), Ok(()));
        assert_eq!(moved([1.0, 0.0, 0.0], &guards), Err(SimplifyRefusal::Degenerate));
        assert_eq!(moved([f64::NAN, 0.0, 0.0], &guards), Err(SimplifyRefusal::Degenerate));
    }

    #[test]
    fn a_face_may_be_thin_when_it_was_thinner() {
        let guards = Guards { aspect_min: 0.5, normal_cos_min: -1.0, envelope: None };
        assert_eq!(moved([0.4, 0.4, 0.0], &guards), Err(SimplifyRefusal::Aspect));
        let from = DVec3::new(0.45, 0.45, 0.0);
        assert_eq!(check_face(from, DVec3::new(0.4, 0.4, 0.0), [Q, R], &guards, 1.0), Ok(()));
    }

    #[test]
    fn a_face_must_stay_in_the_envelope() {
        struct Below(f64);
        impl Envelope for Below {
            fn holds(&self, corners: [DVec3; 3]) -> bool {
                corners.iter().all(|p| p.z <= self.0)
            }
        }
        let guards = Guards { envelope: Some(&Below(0.25)), ..Guards::default() };
        assert_eq!(moved([0.0, 0.0, 0.25], &guards), Ok(()));
        assert_eq!(moved([0.0, 0.0, 0.26], &guards), Err(SimplifyRefusal::Envelope));
    }
}
