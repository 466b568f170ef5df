//! Sums that do not lose small terms.

/// A sum with the rounding errors of its additions kept apart (Neumaier 1974): as if added with twice the digits.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CompensatedSum {
    sum: f64,
    lost: f64,
}

impl CompensatedSum {
    pub(super) fn add(&mut self, term: f64) {
        let next = self.sum + term;
        let (larger, smaller) =
            if self.sum.abs() >= term.abs() { (self.sum, term) } else { (term, self.sum) };
        self.lost += (larger - next) + smaller;
        self.sum = next;
    }

    /// The sum; infinite when it is out of range.
    pub(super) fn value(self) -> f64 {
        if self.sum.is_finite() { self.sum + self.lost } else { self.sum }
    }
}

impl FromIterator<f64> for CompensatedSum {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Self {
        let mut sum = Self::default();
        for term in terms {
            sum.add(term);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_terms_between_large_ones_are_not_lost() {
        assert_eq!(CompensatedSum::from_iter([1e100, 1.0, -1e100]).value(), 1.0);
        assert_eq!(CompensatedSum::from_iter([f64::MAX, f64::MAX]).value(), f64::INFINITY);
    }
}
