//! Shells of a result that enclose nothing but the rounding of coordinates.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, triangle_area};
use crate::mesh::{Soup, UnionFind};
use crate::pipeline::fidelity::LOSS_MAX;
use crate::repair::NEW;

/// A shell encloses nothing when its two sides are nearer to each other, on average, than this share of the diagonal of all.
const FLAT_SHARE_MAX: f64 = 5e-6;

/// Counts the shells with new triangles whose sides lie on each other: sheets that were closed by patches on them. What is less than
/// 1 % of the surface is dust where bodies all but meet, and no sheet that anybody would miss. `origins` names the
/// triangle of the file that each triangle is, or [`NEW`].
///
/// # Errors
/// When the budget stops the run.
pub(super) fn flat_shells(
    result: &Soup,
    origins: &[u32],
    diagonal: f64,
    budget: &Budget,
) -> Result<u32, Stopped> {
    budget.spend(result.triangles.len() as u64 / 4)?;
    let mut sets = UnionFind::new(result.positions.len());
    for (t, &[a, b, c]) in result.triangles.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        sets.unite(a, b);
        sets.unite(b, c);
    }
    let parts = sets.into_components();
    // A corner of each.
    let mut start = vec![DVec3::ZERO; parts.count as usize];
    result.positions.iter().zip(&parts.of).for_each(|(&p, &part)| start[part as usize] = p);
    // Six times the volume, and the area; whether triangles of it are new.
    let mut shells = vec![(0.0, 0.0, false); parts.count as usize];
    for (t, origin) in (0..result.triangles.len() as u32).zip(origins) {
        if (t as usize).is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        let part = parts.of[result.triangles[t as usize][0] as usize] as usize;
        let corners = result.corners(t);
        let [a, b, c] = corners.map(|p| p - start[part]);
        let (volume, area, has_new) = &mut shells[part];
        *volume += a.dot(b.cross(c));
        *area += triangle_area(corners);
        *has_new |= *origin == NEW;
    }
    let all: f64 = shells.iter().map(|(_, area, _)| area).sum();
    let is_flat = |&&(volume, area, has_new): &&(f64, f64, bool)| {
        has_new && area >= LOSS_MAX * all && volume.abs() / 3.0 <= FLAT_SHARE_MAX * diagonal * area
    };
    Ok(shells.iter().filter(is_flat).count() as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron of this height over a triangle with sides of 10.
    fn tetrahedron(height: f64) -> Soup {
        let positions = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 10.0, 0.0], [3.0, 3.0, height]];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        Soup { positions: positions.map(DVec3::from_array).to_vec(), triangles, ..Soup::default() }
    }

    #[test]
    fn a_shell_is_flat_by_its_mean_thickness_and_only_where_something_is_new() {
        let count = |height: f64, origins: &[u32]| {
            flat_shells(&tetrahedron(height), origins, 14.0, &Budget::unlimited()).unwrap()
        };
        let patched = [0, 1, 2, NEW];
        assert_eq!([count(1e-6, &patched), count(0.01, &patched), count(1e-6, &[0, 1, 2, 3])], [1, 0, 0]);
    }
}
