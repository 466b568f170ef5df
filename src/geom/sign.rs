//! The sign of an exactly evaluated quantity.

use std::ops::{Mul, Neg};

/// The sign of an exactly evaluated quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Sign {
    /// Less than zero.
    Negative,
    /// Exactly zero.
    Zero,
    /// Greater than zero.
    Positive,
}

impl Sign {
    /// The sign of `value - zero`, where `zero` is the neutral element of the type; `value` must not be NaN.
    pub fn of<T: PartialOrd + Default>(value: &T) -> Self {
        let zero = T::default();
        if *value > zero {
            Self::Positive
        } else if *value < zero {
            Self::Negative
        } else {
            Self::Zero
        }
    }

    /// The sign of `a - b`, decided without subtracting.
    pub fn of_difference(a: f64, b: f64) -> Self {
        if a > b {
            Self::Positive
        } else if a < b {
            Self::Negative
        } else {
            Self::Zero
        }
    }

    /// True for [`Sign::Zero`].
    pub fn is_zero(self) -> bool {
        self == Self::Zero
    }

    /// This sign, or what `next` gives when it is zero.
    #[must_use]
    pub fn or_else(self, next: impl FnOnce() -> Self) -> Self {
        if self.is_zero() { next() } else { self }
    }
}

impl Neg for Sign {
    type Output = Self;

    fn neg(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Zero => Self::Zero,
            Self::Positive => Self::Negative,
        }
    }
}

impl Mul for Sign {
    type Output = Self;

    /// The sign of a product.
    fn mul(self, other: Self) -> Self {
        match self {
            Self::Negative => -other,
            Self::Zero => Self::Zero,
            Self::Positive => other,
        }
    }
}
