//! How much a part may spend on vertices with very many triangles.
//!
//! To look at a collapse of one of `n` edges at a vertex takes `n` steps, so that all of them take the square of that, and
//! what the whole star sweeps is compared with everything around. What a part spends on this is bounded in proportion to
//! its triangles; when it is used up, edges at these vertices stay until the next round.

/// Triangles around one vertex, and triangles that move in one collapse, up to which nothing is counted.
pub(super) const FREE_MAX: usize = 64;

/// Steps for each triangle of the part. A step takes a few nanoseconds.
const STEPS_OF_TRIANGLE: u64 = 2048;

/// Steps to walk around a vertex and to look at what its triangles become, for each of them.
const STEPS_OF_RING: u64 = 64;

/// What is left of the steps.
#[derive(Debug)]
pub(super) struct Allowance {
    left: u64,
    /// For each vertex, whether it was seen to have more triangles than are free; no vertex before the first.
    is_wide: Vec<bool>,
}

impl Allowance {
    pub(super) fn of(triangles: usize) -> Self {
        Self { left: triangles as u64 * STEPS_OF_TRIANGLE, is_wide: Vec::new() }
    }

    /// False for a vertex with very many triangles when the steps are used up.
    #[inline]
    pub(super) fn lets(&self, v: u32) -> bool {
        self.left > 0 || !self.is_wide.get(v as usize).copied().unwrap_or(false)
    }

    /// Says that the `count` triangles around a vertex were walked.
    #[inline]
    pub(super) fn walked(&mut self, v: u32, count: usize) {
        if count > FREE_MAX {
            self.mark(v);
            self.left = self.left.saturating_sub(count as u64 * STEPS_OF_RING);
        }
    }

    /// Takes the steps to compare a triangle with `count` that move; false when they are used up.
    #[inline]
    pub(super) fn compares(&mut self, count: usize) -> bool {
        if count > FREE_MAX {
            self.left = self.left.saturating_sub(count as u64);
        }
        count <= FREE_MAX || self.left > 0
    }

    /// Says that a vertex was merged into another.
    #[inline]
    pub(super) fn merged(&mut self, from: u32, into: u32) {
        if self.is_wide.get(from as usize).copied().unwrap_or(false) {
            self.mark(into);
        }
    }

    fn mark(&mut self, v: u32) {
        if self.is_wide.len() <= v as usize {
            self.is_wide.resize(v as usize + 1, false);
        }
        self.is_wide[v as usize] = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_triangles_are_free_and_many_are_bounded_by_those_of_the_part() {
        let mut allowance = Allowance::of(100);
        for _ in 0..10_000 {
            allowance.walked(1, FREE_MAX);
            assert!(allowance.compares(FREE_MAX) && allowance.lets(1));
        }
        let mut walks = 0;
        while allowance.lets(7) {
            allowance.walked(7, 100);
            walks += 1;
        }
        assert_eq!(walks, 32);
        assert!(!allowance.compares(100) && allowance.compares(3) && allowance.lets(1));
        allowance.merged(7, 1);
        assert!(!allowance.lets(1));
    }
}
