//! Points sorted into the cells of a grid, for questions about close ones.

use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;

/// Points that are looked at for one question. More are there only where points crowd in one cell, and then any of them
/// will do.
const NEAR_MAX: usize = 512;

/// Questions between two checks of the budget.
pub(super) const QUESTIONS: usize = 256;

/// Points in cells of one size; sorted, so that no order of a hash map can reach a result.
pub(super) struct PointCells<'p> {
    points: &'p [DVec3],
    size: f64,
    /// The cell of each point and the point, sorted.
    entries: Vec<([i64; 3], u32)>,
}

impl<'p> PointCells<'p> {
    /// Sorts `points`, which must be finite, into cells with sides of `size` or, where that is too small to be told
    /// from the coordinates, larger ones.
    pub(super) fn new(points: &'p [DVec3], size: f64) -> Self {
        let largest = points.iter().fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
        // Cell numbers stay below 2^50.
        let size = size.max(largest * 1e-15).max(f64::MIN_POSITIVE);
        let mut entries: Vec<_> =
            points.iter().enumerate().map(|(i, &p)| (cell_of(p, size), i as u32)).collect();
        entries.sort_unstable();
        Self { points, size, entries }
    }

    /// The points in the cell of `p` and the 26 around it: all within `size` of it, and others; at most [`NEAR_MAX`].
    pub(super) fn near(&self, p: DVec3) -> impl Iterator<Item = u32> + '_ {
        let [x, y, z] = cell_of(p, self.size);
        let rows = (-1..=1).flat_map(move |dx| (-1..=1).map(move |dy| (x + dx, y + dy)));
        let mut from = 0;
        rows.flat_map(move |(x, y)| {
            // Rows come in the order of the entries, and mostly the next entry is beyond several of them.
            let start = [x, y, z - 1];
            if self.entries.get(from).is_some_and(|(cell, _)| *cell < start) {
                from += self.entries[from..].partition_point(|(cell, _)| *cell < start);
            }
            self.entries[from..].iter().take_while(move |(cell, _)| *cell <= [x, y, z + 1]).map(|&(_, i)| i)
        })
        .take(NEAR_MAX)
    }

    /// For each point the first one in the list that is within `reach` (at most the size of a cell) of it and is
    /// itself the first of those near it; the point itself where there is none.
    pub(super) fn first_within(&self, reach: f64, budget: &Budget) -> Result<Vec<u32>, Stopped> {
        let mut first: Vec<u32> = (0..self.points.len() as u32).collect();
        for i in 0..self.points.len() {
            if i.is_multiple_of(QUESTIONS) {
                budget.check()?;
            }
            let p = self.points[i];
            let is_same = |&j: &u32| {
                (j as usize) < i
                    && first[j as usize] == j
                    && self.points[j as usize].distance_squared(p) <= reach * reach
            };
            if let Some(found) = self.near(p).filter(is_same).min() {
                first[i] = found;
            }
        }
        Ok(first)
    }
}

fn cell_of(p: DVec3, size: f64) -> [i64; 3] {
    (p / size).floor().to_array().map(|x| x as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_points_are_found_across_cells_and_nothing_near_is_missed() {
        let points: Vec<DVec3> = (0..400u32)
            .map(|i| {
                DVec3::new(f64::from(i * 37 % 101), f64::from(i * 53 % 97), f64::from(i * 7 % 11)) * 0.1 - 3.0
            })
            .collect();
        let cells = PointCells::new(&points, 1.0);
        for &p in &points {
            let mut found: Vec<u32> =
                cells.near(p).filter(|&j| points[j as usize].distance(p) <= 1.0).collect();
            found.sort_unstable();
            let truth: Vec<u32> = (0..400).filter(|&j| points[j as usize].distance(p) <= 1.0).collect();
            assert_eq!(found, truth);
        }
    }

    #[test]
    fn equal_points_name_the_first() {
        let points = [DVec3::X, DVec3::Y, DVec3::X, DVec3::Y + DVec3::splat(1e-12), DVec3::X];
        let first = PointCells::new(&points, 1e-9).first_within(1e-9, &Budget::unlimited()).unwrap();
        assert_eq!(first, [0, 1, 0, 1, 0]);
    }
}
