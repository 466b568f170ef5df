//! Winding numbers of closed surfaces at all vertices of the lattice, by the crossings of vertical lines.

use super::lattice::Lattice;
use super::raster;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, Sign, upward_crossing};
use crate::par;

/// Triangles whose crossings are found at a time.
const CHUNK: usize = 1024;

/// For each vertex how often the closed surface of both lists winds around it, within -127 to 127. Corners are in lattice
/// units and counter-clockwise seen from outside.
///
/// A line through the vertices of a column crosses a closed surface as often upward as downward, whatever the position,
/// because every crossing is decided by exact predicates for a line moved by an infinitesimal amount. So a rounded
/// height can move a crossing past a vertex, but never leave a streak.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn winding(
    lattice: &Lattice,
    corners: [&[[DVec3; 3]]; 2],
    budget: &Budget,
) -> Result<Vec<i8>, Stopped> {
    let [first, second] = corners;
    let found = par::try_map_ranges(first.len() + second.len(), CHUNK, |range| {
        let mut crossings = Vec::new();
        for t in range {
            budget.check()?;
            let triangle = first.get(t).unwrap_or_else(|| &second[t - first.len()]);
            cross(lattice, *triangle, &mut crossings);
        }
        budget.spend(crossings.len() as u64)?;
        Ok(crossings)
    })?;
    let count = found.iter().map(Vec::len).sum::<usize>();
    let _charge = budget.charge(count as u64 * 16)?;
    let mut crossings = found.concat();
    par::sort_unstable(&mut crossings);
    let mut winding = vec![0i8; lattice.len()];
    let height = lattice.dims[2];
    for (n, column) in crossings.chunk_by(|a, b| a.column == b.column).enumerate() {
        if n % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let start = column[0].column as usize * height;
        let mut total = 0i32;
        // From the highest crossing down: those above a vertex are counted at it.
        for (n, crossing) in column.iter().enumerate().rev() {
            total += i32::from(crossing.turn);
            let below = if n == 0 { 0 } else { column[n - 1].end as usize };
            winding[start + below..start + crossing.end as usize].fill(total.clamp(-127, 127) as i8);
        }
    }
    Ok(winding)
}

/// A crossing of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct ColumnCrossing {
    column: u32,
    /// Vertices of the column below the crossing.
    end: u16,
    /// 1 where the surface faces up, -1 where down.
    turn: i8,
}

/// Adds the crossings of one triangle.
fn cross(lattice: &Lattice, corners: [DVec3; 3], crossings: &mut Vec<ColumnCrossing>) {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    let low = a.z.min(b.z).min(c.z).floor().max(0.0) as usize;
    let high = a.z.max(b.z).max(c.z).ceil() as usize;
    raster::columns(corners, lattice.dims, |i, j| {
        let at = |k: usize| DVec3::new(i as f64, j as f64, k as f64);
        let Some(turn) = upward_crossing(at(0), corners) else { return };
        let is_below = |k: usize| upward_crossing(at(k), corners).is_some();
        let height = a.z - (normal.x * (i as f64 - a.x) + normal.y * (j as f64 - a.y)) / normal.z;
        let is_steep = normal.z.abs() < 1e-4 * normal.abs().max_element();
        let is_clear = !is_steep && (height - height.round()).abs() > 1e-6;
        let end = if is_clear {
            (height.floor() as usize + 1).clamp(low, high + 1)
        } else {
            // Vertices from `low` to `high` are below and then above.
            let (mut first, mut last) = (low, high + 1);
            while first < last {
                let middle = usize::midpoint(first, last);
                if is_below(middle) { first = middle + 1 } else { last = middle }
            }
            first
        };
        crossings.push(ColumnCrossing {
            column: (i * lattice.dims[1] + j) as u32,
            end: end.min(lattice.dims[2]) as u16,
            turn: if turn == Sign::Positive { 1 } else { -1 },
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Aabb;

    /// Triangles of the box between two corners, outward.
    fn cuboid(min: DVec3, max: DVec3) -> Vec<[DVec3; 3]> {
        let corner =
            |i: usize| DVec3::from_array([0, 1, 2].map(|a| if i >> a & 1 == 1 { max[a] } else { min[a] }));
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
            .into_iter()
            .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
            .map(|t| t.map(corner))
            .collect()
    }

    #[test]
    fn boxes_wind_once_around_what_is_in_them_also_where_their_faces_lie_on_the_lattice() {
        let bounds = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
        let lattice = Lattice::around(bounds, 16, usize::MAX).unwrap();
        for (min, max) in [(6.5, 12.25), (6.0, 12.0)] {
            let mut all = cuboid(DVec3::splat(min), DVec3::splat(max));
            all.extend(cuboid(DVec3::splat(8.5), DVec3::splat(9.5)).into_iter().map(|[a, b, c]| [a, c, b]));
            let winding = winding(&lattice, [&all, &[]], &Budget::unlimited()).unwrap();
            for (index, &w) in winding.iter().enumerate() {
                let place = lattice.coordinates(index).map(|n| n as f64);
                let inside = |low: f64, high: f64| place.iter().all(|&x| x > low && x < high);
                let is_on = place.iter().any(|x| [min, max].contains(x));
                if !is_on {
                    assert_eq!(w == 1, inside(min, max) && !inside(8.5, 9.5), "{place:?} {w}");
                }
            }
        }
    }

    #[test]
    fn steep_triangles_leave_no_streaks() {
        let bounds = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
        let lattice = Lattice::around(bounds, 24, usize::MAX).unwrap();
        let [a, b, c, d] = [[6.0, 6.0, 6.0], [20.0, 6.0, 27.0], [6.0 + 1e-9, 22.0, 9.0], [20.0, 20.0, 8.0]]
            .map(DVec3::from_array);
        let solid = [[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
        let winding = winding(&lattice, [&solid, &[]], &Budget::unlimited()).unwrap();
        for column in winding.chunks(lattice.dims[2]) {
            assert_eq!((column[0], column[lattice.dims[2] - 1]), (0, 0));
        }
        assert!(winding.iter().filter(|&&w| w != 0).count() > 100);
    }
}
