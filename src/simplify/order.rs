//! Vertices along a space-filling curve, so that consecutive ones are neighbours in space.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::par;

/// Cells of the curve along each axis.
const CELLS_LOG2: u32 = 10;

/// A Morton curve through a grid of cells.
#[derive(Debug, Clone, Copy)]
pub(super) struct Curve {
    min: DVec3,
    /// Cells to a unit of length.
    scale: f64,
    /// In cells.
    shift: DVec3,
}

impl Curve {
    /// The curve through the cells of `bounds`. The grid is moved by `shift` (0 to 1 in each coordinate) of half its
    /// size, so that another shift cuts space elsewhere.
    pub(super) fn over(bounds: Aabb, shift: DVec3) -> Self {
        // Half of the grid on the box, half to move in.
        let cells = f64::from(1 << (CELLS_LOG2 - 1));
        let size = (bounds.max - bounds.min).max_element();
        Self { min: bounds.min, scale: if size > 0.0 { cells / size } else { 0.0 }, shift: shift * cells }
    }

    /// The number of the cell of `p` along the curve, or of the nearest cell in each coordinate. It never falls when a
    /// coordinate grows.
    #[inline]
    pub(super) fn code(&self, p: DVec3) -> u32 {
        let cell = (p - self.min) * self.scale + self.shift;
        interleaved(cell.to_array().map(|x| x as u32))
    }
}

/// The vertices `used` in the order of a curve that `shift` moves; of vertices in one cell the one with the smaller id
/// first.
pub(super) fn along_curve(
    position_of: impl Fn(usize) -> DVec3 + Sync,
    used: &[bool],
    shift: DVec3,
    budget: &Budget,
) -> Result<(Vec<u32>, Curve), Stopped> {
    let boxes = par::try_map_ranges(used.len(), CHECK_EVERY, |range| {
        budget.check()?;
        Ok(Aabb::of(range.filter(|&v| used[v]).map(&position_of)))
    })?;
    let curve = Curve::over(boxes.into_iter().fold(Aabb::EMPTY, Aabb::union), shift);
    let keys = par::try_map_ranges(used.len(), CHECK_EVERY, |range| {
        budget.check()?;
        let key = |v: usize| u64::from(curve.code(position_of(v))) << 32 | v as u64;
        Ok(range.filter(|&v| used[v]).map(key).collect::<Vec<_>>())
    })?;
    let mut keys = keys.concat();
    par::sort_unstable(&mut keys);
    Ok((keys.into_iter().map(|key| key as u32).collect(), curve))
}

/// The bits of three numbers in turn.
fn interleaved(cell: [u32; 3]) -> u32 {
    let spread = |x: u32| {
        let x = x.min((1 << CELLS_LOG2) - 1);
        let x = (x | x << 16) & 0x0300_00ff;
        let x = (x | x << 8) & 0x0300_f00f;
        let x = (x | x << 4) & 0x030c_30c3;
        (x | x << 2) & 0x0924_9249
    };
    spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bits_of_a_cell_take_turns() {
        for bit in 0..CELLS_LOG2 {
            assert_eq!(interleaved([1 << bit, 0, 0]), 1 << (3 * bit));
            assert_eq!(interleaved([0, 1 << bit, 0]), 2 << (3 * bit));
            assert_eq!(interleaved([0, 0, 1 << bit]), 4 << (3 * bit));
        }
        assert_eq!(interleaved([u32::MAX; 3]), (1 << 30) - 1);
    }

    #[test]
    fn used_vertices_come_once_and_neighbours_are_near() {
        let positions: Vec<DVec3> =
            (0..512).map(|i| DVec3::new(f64::from(i % 8), f64::from(i / 8 % 8), f64::from(i / 64))).collect();
        let mut used = vec![true; 512];
        used[77] = false;
        for shift in [DVec3::ZERO, DVec3::new(0.3, 0.7, 0.99)] {
            let order = along_curve(|v| positions[v], &used, shift, &Budget::unlimited()).unwrap().0;
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq((0..512).filter(|&v| v != 77)));
            let steps: f64 =
                order.windows(2).map(|w| positions[w[0] as usize].distance(positions[w[1] as usize])).sum();
            assert!(steps / 510.0 < 2.5, "{steps}");
        }
    }

    #[test]
    fn one_place_for_all_vertices_is_an_order_too() {
        let order = along_curve(|_| DVec3::ONE, &[true; 3], DVec3::splat(0.5), &Budget::unlimited()).unwrap();
        assert_eq!(order.0, [0, 1, 2]);
    }
}
