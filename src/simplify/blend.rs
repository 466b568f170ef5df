//! Colours of merged vertices and groups of equally coloured faces.

use crate::mesh::Color;

/// The colour at share `t` (0 to 1) of the way from `a` to `b`; where the two are not of one kind, that of the nearer.
pub(super) fn blend(a: Option<Color>, b: Option<Color>, t: f64) -> Option<Color> {
    let float = |x: f32, y: f32| (f64::from(x) + (f64::from(y) - f64::from(x)) * t) as f32;
    let byte = |x: u8, y: u8| (f64::from(x) + (f64::from(y) - f64::from(x)) * t + 0.5) as u8;
    match (a, b) {
        (Some(Color::Bytes(p, None)), Some(Color::Bytes(q, None))) => {
            Some(Color::Bytes(std::array::from_fn(|i| byte(p[i], q[i])), None))
        }
        (Some(Color::Bytes(p, Some(x))), Some(Color::Bytes(q, Some(y)))) => {
            Some(Color::Bytes(std::array::from_fn(|i| byte(p[i], q[i])), Some(byte(x, y))))
        }
        (Some(Color::Floats(p, None)), Some(Color::Floats(q, None))) => {
            Some(Color::Floats(std::array::from_fn(|i| float(p[i], q[i])), None))
        }
        (Some(Color::Floats(p, Some(x))), Some(Color::Floats(q, Some(y)))) => {
            Some(Color::Floats(std::array::from_fn(|i| float(p[i], q[i])), Some(float(x, y))))
        }
        (Some(Color::Linear(p, None)), Some(Color::Linear(q, None))) => {
            Some(Color::Linear(std::array::from_fn(|i| float(p[i], q[i])), None))
        }
        (Some(Color::Linear(p, Some(x))), Some(Color::Linear(q, Some(y)))) => {
            Some(Color::Linear(std::array::from_fn(|i| float(p[i], q[i])), Some(float(x, y))))
        }
        _ => {
            if t < 0.5 {
                a
            } else {
                b
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_of_one_kind_are_mixed_channel_by_channel() {
        let bytes = |x, a| Some(Color::Bytes([x, 0, 255], a));
        assert_eq!(blend(bytes(0, None), bytes(100, None), 0.25), bytes(25, None));
        assert_eq!(blend(bytes(0, Some(9)), bytes(100, Some(10)), 0.5), bytes(50, Some(10)));
        let floats = |x| Some(Color::Floats([x, 1.0, 0.0], None));
        assert_eq!(blend(floats(0.0), floats(1.0), 0.75), floats(0.75));
        for t in [0.0, 1.0] {
            let ends = [bytes(7, None), bytes(200, None)];
            assert_eq!(blend(ends[0], ends[1], t), ends[t as usize]);
        }
    }

    #[test]
    fn of_colors_that_cannot_be_mixed_the_nearer_is_taken() {
        let (index, other) = (Some(Color::Index(3)), Some(Color::Index(8)));
        assert_eq!(blend(index, other, 0.4), index);
        assert_eq!(blend(index, other, 0.6), other);
        assert_eq!(blend(None, index, 0.9), index);
        assert_eq!(blend(None, index, 0.1), None);
    }
}
