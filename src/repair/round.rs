//! Rounds coordinates to float32, for files that hold no more and for readers that keep no more.

use super::{Changes, Draft};

/// Moves every vertex to the nearest float32 point, at most half a float32 step on each axis. A coordinate beyond the
/// range of float32 stays as it is.
pub fn round_to_f32(draft: &mut Draft) -> Changes {
    let (mut moved, mut move_max) = (0, 0.0f64);
    for position in &mut draft.positions {
        let rounded = position.as_vec3().as_dvec3();
        if rounded != *position && rounded.is_finite() {
            moved += 1;
            move_max = move_max.max(rounded.distance(*position));
            *position = rounded;
        }
    }
    Changes { move_max, ..Changes::counted([("vertices_moved", moved)]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    #[test]
    fn only_what_float32_cannot_hold_moves_and_the_distance_is_told() {
        let mut draft = Draft {
            positions: vec![
                DVec3::new(0.5, 1.0, 2.0),
                DVec3::new(0.1, 0.0, 0.0),
                DVec3::new(1e300, 0.0, 0.0),
            ],
            ..Draft::default()
        };
        let changes = round_to_f32(&mut draft);
        assert_eq!(changes.count("vertices_moved"), 1);
        assert_eq!(draft.positions[1].x, f64::from(0.1f32));
        assert_eq!(changes.move_max, f64::from(0.1f32) - 0.1);
        assert_eq!(draft.positions[2].x, 1e300);
    }
}
