//! The leaves of a tree: a few triangles side by side, so that one is compared with all at once.

use super::Box32;
use super::frame::larger;

/// Triangles of a leaf.
pub(in crate::spatial) const LEAF_LEN: usize = 4;

/// Up to [`LEAF_LEN`] triangles; the boxes of absent ones are empty.
#[derive(Debug, Clone, Copy)]
pub(in crate::spatial) struct Leaf {
    min: [[f32; LEAF_LEN]; 3],
    max: [[f32; LEAF_LEN]; 3],
    corners: [[u32; LEAF_LEN]; 3],
    ids: [u32; LEAF_LEN],
}

const ABSENT: u32 = u32::MAX;

impl Leaf {
    pub(super) const EMPTY: Self = Self {
        min: [[f32::INFINITY; LEAF_LEN]; 3],
        max: [[f32::NEG_INFINITY; LEAF_LEN]; 3],
        corners: [[ABSENT; LEAF_LEN]; 3],
        ids: [ABSENT; LEAF_LEN],
    };

    pub(super) fn set(&mut self, k: usize, id: u32, bounds: &Box32, corners: [u32; 3]) {
        self.ids[k] = id;
        for (i, v) in corners.into_iter().enumerate() {
            self.corners[i][k] = v;
            self.min[i][k] = bounds.min[i];
            self.max[i][k] = bounds.max[i];
        }
    }

    /// Number of triangles.
    #[inline]
    pub(in crate::spatial) fn len(&self) -> usize {
        self.ids.iter().take_while(|&&id| id != ABSENT).count()
    }

    /// The id of triangle `k`; ascending.
    #[inline]
    pub(in crate::spatial) fn id(&self, k: usize) -> u32 {
        self.ids[k]
    }

    /// The vertices of triangle `k`.
    #[inline]
    pub(in crate::spatial) fn corners(&self, k: usize) -> [u32; 3] {
        [self.corners[0][k], self.corners[1][k], self.corners[2][k]]
    }

    /// The box of triangle `k`.
    #[inline]
    pub(in crate::spatial) fn bounds(&self, k: usize) -> Box32 {
        Box32 {
            min: [self.min[0][k], self.min[1][k], self.min[2][k]],
            max: [self.max[0][k], self.max[1][k], self.max[2][k]],
        }
    }

    /// The triangles whose boxes meet `query`.
    #[inline]
    pub(in crate::spatial) fn meeting(&self, query: &Box32) -> Lanes {
        // The largest gap along an axis, for all at once; the sign of a difference is exact.
        let mut gap = [f32::NEG_INFINITY; LEAF_LEN];
        for axis in 0..3 {
            for (k, gap) in gap.iter_mut().enumerate() {
                *gap = larger(*gap, self.min[axis][k] - query.max[axis]);
                *gap = larger(*gap, query.min[axis] - self.max[axis][k]);
            }
        }
        Lanes(gap.iter().enumerate().fold(0, |lanes, (k, &gap)| lanes | u32::from(gap <= 0.0) << k))
    }

    /// The squared distance of each triangle's box from the point; infinite for absent ones.
    #[inline]
    pub(in crate::spatial) fn squared_gaps(&self, p: [f32; 3]) -> [f32; LEAF_LEN] {
        let mut squares = [0.0; LEAF_LEN];
        for (axis, &x) in p.iter().enumerate() {
            for (k, square) in squares.iter_mut().enumerate() {
                let gap = larger(larger(self.min[axis][k] - x, x - self.max[axis][k]), 0.0);
                *square += gap * gap;
            }
        }
        squares
    }

    /// For each triangle, where its corners are among `corners`: bit `3 i + j` says that its corner `j` is
    /// `corners[i]`.
    #[inline]
    pub(in crate::spatial) fn pairs_with(&self, corners: [u32; 3]) -> [u32; LEAF_LEN] {
        let mut pairs = [0; LEAF_LEN];
        for (i, v) in corners.into_iter().enumerate() {
            for (j, of_corner) in self.corners.iter().enumerate() {
                for (pairs, &w) in pairs.iter_mut().zip(of_corner) {
                    *pairs |= u32::from(v == w) << (3 * i + j);
                }
            }
        }
        pairs
    }
}

/// A set of triangles of a leaf, lowest first.
#[derive(Debug, Clone, Copy)]
pub(in crate::spatial) struct Lanes(u32);

impl Lanes {
    /// Those after triangle `k`.
    #[inline]
    pub(in crate::spatial) fn after(self, k: usize) -> Self {
        Self(self.0 & !((2 << k) - 1))
    }

    /// Those of them for which `is_wanted` holds.
    #[inline]
    pub(in crate::spatial) fn only(self, is_wanted: impl Fn(usize) -> bool) -> Self {
        Self((0..LEAF_LEN).fold(0, |lanes, k| lanes | u32::from(is_wanted(k)) << k) & self.0)
    }

    #[inline]
    pub(in crate::spatial) fn is_empty(self) -> bool {
        self.0 == 0
    }
}

impl Iterator for Lanes {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        let k = self.0.trailing_zeros() as usize;
        self.0 &= self.0.wrapping_sub(1);
        (k < LEAF_LEN).then_some(k)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(x: f32) -> Box32 {
        Box32 { min: [x, 0.0, 0.0], max: [x + 1.0, 1.0, 1.0] }
    }

    #[test]
    fn a_leaf_tells_which_boxes_meet_and_which_corners_are_shared() {
        let mut leaf = Leaf::EMPTY;
        for k in 0..3 {
            leaf.set(k, 10 + k as u32, &cell(2.0 * k as f32), [k as u32, 7, 8]);
        }
        assert_eq!(leaf.len(), 3);
        assert_eq!(leaf.meeting(&cell(1.0)).collect::<Vec<_>>(), [0, 1]);
        assert_eq!(leaf.meeting(&cell(1.0)).after(0).collect::<Vec<_>>(), [1]);
        let everything = Box32 { min: [f32::MIN; 3], max: [f32::MAX; 3] };
        assert_eq!(leaf.meeting(&everything).collect::<Vec<_>>(), [0, 1, 2]);
        assert_eq!(leaf.meeting(&leaf.bounds(1)).collect::<Vec<_>>(), [1]);
        assert_eq!(leaf.pairs_with([8, 2, 5])[..3], [1 << 2, 1 << 2, 1 << 2 | 1 << 3]);
    }
}
