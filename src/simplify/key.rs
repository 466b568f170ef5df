//! Costs as sort keys of 32 bits.

/// A cost of at least zero, rounded to float32: enough to order collapses, and an entry of the queue fits in a word.
/// Costs that agree in 24 bits are ordered by edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct CostKey(u32);

impl CostKey {
    /// The key of a cost; nothing when the cost is NaN, infinite or too large for float32.
    #[inline]
    pub(super) fn of(cost: f64) -> Option<Self> {
        // Floats of at least zero are in the order of their bits. A negative cost is rounding about zero.
        let rounded = if cost < 0.0 { 0.0 } else { cost as f32 };
        rounded.is_finite().then_some(Self(rounded.to_bits()))
    }

    #[inline]
    pub(super) fn bits(self) -> u32 {
        self.0
    }

    #[inline]
    pub(super) fn from_bits(bits: u32) -> Self {
        Self(bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_in_the_order_of_costs_and_only_finite_costs_have_one() {
        let keys: Vec<CostKey> =
            [0.0, 1e-44, 1e-30, 0.5, 1.0, 1e30].iter().filter_map(|&c| CostKey::of(c)).collect();
        assert!(keys.is_sorted() && keys.len() == 6);
        assert_eq!(CostKey::of(-1e-20), CostKey::of(0.0));
        for cost in [f64::NAN, f64::INFINITY, 1e39] {
            assert_eq!(CostKey::of(cost), None);
        }
    }
}
