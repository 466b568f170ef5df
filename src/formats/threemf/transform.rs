//! Where an object is put: an affine map, as 3MF writes it.

use crate::formats::Precision;
use crate::formats::numbers::{coordinate, rounded};
use crate::geom::{DMat3, DVec3};

/// A point `p` goes to `linear * p + shift`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Transform {
    pub(super) linear: DMat3,
    pub(super) shift: DVec3,
}

impl Transform {
    /// Everything stays where it is.
    pub(super) const IDENTITY: Self = Self { linear: DMat3::IDENTITY, shift: DVec3::ZERO };

    /// The transform that the twelve numbers of `text` spell: the images of the axes, then the shift. `None`: they are not
    /// twelve finite numbers, or the images lie in one plane, so that every solid would become flat.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let mut numbers = [0.0; 12];
        let mut words = text.split_ascii_whitespace();
        for number in &mut numbers {
            *number = coordinate(words.next()?.as_bytes(), Precision::F64).filter(|x| x.is_finite())?;
        }
        let axis = |k: usize| DVec3::new(numbers[k], numbers[k + 1], numbers[k + 2]);
        let linear = DMat3::from_cols(axis(0), axis(3), axis(6));
        let is_good = words.next().is_none() && linear.determinant() != 0.0;
        is_good.then_some(Self { linear, shift: axis(9) })
    }

    /// This transform after `first`.
    pub(super) fn after(&self, first: &Self) -> Self {
        if *self == Self::IDENTITY {
            return *first;
        }
        Self { linear: self.linear * first.linear, shift: self.linear * first.shift + self.shift }
    }

    /// Left and right change sides.
    pub(super) fn is_mirror(&self) -> bool {
        self.linear.determinant() < 0.0
    }

    /// Where `p` goes; the same bits where nothing moves.
    pub(super) fn apply(&self, p: DVec3, precision: Precision) -> DVec3 {
        if *self == Self::IDENTITY {
            return p;
        }
        (self.linear * p + self.shift).map(|x| rounded(x, precision))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_images_of_the_axes_come_first_and_the_shift_last() {
        let quarter_turn = Transform::parse("0 1 0 -1 0 0 0 0 1 10 20 30").unwrap();
        let place = |p: [f64; 3]| quarter_turn.apply(DVec3::from_array(p), Precision::F64).to_array();
        assert_eq!(place([1.0, 0.0, 0.0]), [10.0, 21.0, 30.0]);
        assert_eq!(place([0.0, 1.0, 0.0]), [9.0, 20.0, 30.0]);
        let shift = Transform::parse("1 0 0 0 1 0 0 0 1 1 2 3").unwrap();
        let both = quarter_turn.after(&shift).apply(DVec3::ZERO, Precision::F64);
        assert_eq!(both.to_array(), [8.0, 21.0, 33.0]);
    }

    #[test]
    fn what_is_no_transform_is_refused() {
        for text in [
            "",
            "1 0 0 0 1 0 0 0 1 0 0",
            "1 0 0 0 1 0 0 0 1 0 0 0 0",
            "1 0 0 2 0 0 0 0 1 0 0 0",
            "nan 0 0 0 1 0 0 0 1 0 0 0",
        ] {
            assert_eq!(Transform::parse(text), None, "{text}");
        }
        assert!(Transform::parse("-1 0 0 0 1 0 0 0 1 0 0 0").unwrap().is_mirror());
    }
}
