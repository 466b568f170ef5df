//! The volume of a mesh that is open or contradicts itself, as an interval.
//!
//! The generalized winding number (Jacobson, Kavan and Sorkine-Hornung 2013) is near 1 inside and near 0 outside, and
//! passes through what is between where faces are missing or turned. Space where it is at least 3/4 is surely inside, and
//! space where it is below 1/4 surely outside; how much there is of both is estimated from one place in each cell of a
//! grid. Faces that point otherwise than most around them are turned first, and parts that are sheets bound nothing and are
//! left out.

use super::{Context, non_orientable};
use crate::budget::Stopped;
use crate::geom::{Aabb, DVec3};
use crate::par;
use crate::winding::WindingTree;

/// Where the enclosed volume lies, in cubic units of the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeInterval {
    /// Not less than this.
    pub low: f64,
    /// Not more than this.
    pub high: f64,
    /// Both are the sum over closed shells; otherwise they are estimated by winding numbers.
    pub is_exact: bool,
}

/// Winding number of what is surely inside, and of what may be.
const INSIDE: [f64; 2] = [0.75, 0.25];

/// Cells of the grid along each axis.
const CELLS: usize = 32;

/// Places that one thread looks at in one go.
const CHUNK: usize = 1024;

/// The interval is widened by this many standard deviations of a sum over independent places, which is more than that of
/// one place in each cell.
const DEVIATIONS: f64 = 3.0;

/// The exact volume where there is one; otherwise an estimate, if it is asked for and something may be inside.
pub(super) fn volume_interval(
    cx: &Context<'_>,
    volume: Option<f64>,
    is_estimated: bool,
) -> Result<Option<VolumeInterval>, Stopped> {
    if let Some(volume) = volume {
        return Ok(Some(VolumeInterval { low: volume, high: volume, is_exact: true }));
    }
    let Some(bounds) = cx.bounds.filter(|_| is_estimated) else { return Ok(None) };
    let (half, center) = (bounds.max / 2.0 - bounds.min / 2.0, bounds.max / 2.0 + bounds.min / 2.0);
    let scale = half.max_element();
    let size = (bounds.max - bounds.min).element_product();
    if !(size.is_normal() && scale.is_normal()) {
        return Ok(None);
    }
    // Nobody knows what is a sheet.
    if cx.sheets.is_none() {
        return Ok(None);
    }
    let is_counted = |t: &u32| {
        let is_copy =
            cx.repeats.binary_search_by_key(t, |r| r.triangle).is_ok_and(|i| !cx.repeats[i].is_opposite);
        !is_copy && !cx.is_sheet(cx.mesh.components.of[*t as usize])
    };
    let meant = (0..cx.mesh.triangles.len() as u32).filter(is_counted);
    let is_turned = turned(cx)?;
    let in_unit = |t: u32| {
        let [a, b, c] = cx.mesh.corners(t).map(|p| (p - center) / scale);
        if is_turned.get(t as usize) == Some(&true) { [a, c, b] } else { [a, b, c] }
    };
    let triangles: Vec<[DVec3; 3]> = meant.map(in_unit).collect();
    if triangles.is_empty() {
        return Ok(None);
    }
    let _charge = cx.budget.charge(triangles.len() as u64 * 190)?;
    let tree = WindingTree::build(triangles, cx.budget)?;
    let box_in_unit = Aabb { min: -half / scale, max: half / scale };
    let [low, high] = shares(&tree, box_in_unit, cx)?;
    let deviation = |share: f64| DEVIATIONS * (share * (1.0 - share) / (CELLS.pow(3) as f64)).sqrt();
    Ok(Some(VolumeInterval {
        low: (low - deviation(low)).max(0.0) * size,
        high: (high + deviation(high)).min(1.0) * size,
        is_exact: false,
    }))
}

/// The triangles that point otherwise than most around them; empty when all agree.
fn turned(cx: &Context<'_>) -> Result<Vec<bool>, Stopped> {
    let mesh = &cx.mesh;
    if mesh.irregular_where(|triangles| triangles == 2).is_empty() {
        return Ok(Vec::new());
    }
    let (mut sides, _) = non_orientable::sides(mesh, cx.budget)?;
    let count = mesh.triangles.len();
    let _charge = cx.budget.charge(count as u64 * 13)?;
    let side: Vec<(u32, bool)> = (0..count as u32).map(|t| sides.find(t)).collect();
    // For each set, by its smallest member: those on its side less those on the other.
    let mut majority = vec![0i64; count];
    for &(first, is_opposite) in &side {
        majority[first as usize] += if is_opposite { -1 } else { 1 };
    }
    Ok(side.into_iter().map(|(first, is_opposite)| is_opposite == (majority[first as usize] >= 0)).collect())
}

/// The share of the box that is surely inside, and that may be.
fn shares(tree: &WindingTree, bounds: Aabb, cx: &Context<'_>) -> Result<[f64; 2], Stopped> {
    let count = CELLS.pow(3);
    let parts = par::try_map_ranges(count, CHUNK, |range| {
        cx.budget.spend(range.len() as u64 * 8)?;
        let mut sums = Sums::default();
        for cell in range {
            sums.add(tree.at(place_in_cell(cell, bounds), 0.0, cx.budget)?);
        }
        Ok(sums)
    })?;
    let mut all = Sums::default();
    for part in parts {
        all.total += part.total;
        for k in 0..2 {
            all.outward[k] += part.outward[k];
            all.inward[k] += part.inward[k];
        }
    }
    // As a whole inside out: what it winds around is inside all the same.
    let counts = if all.total < 0.0 { all.inward } else { all.outward };
    Ok(counts.map(|n| f64::from(n) / count as f64))
}

/// Sums over places.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    /// Of the winding numbers.
    total: f64,
    /// Places inside by each threshold, as the surface points and the other way around.
    outward: [u32; 2],
    inward: [u32; 2],
}

impl Sums {
    fn add(&mut self, number: f64) {
        self.total += number;
        for (k, threshold) in INSIDE.into_iter().enumerate() {
            self.outward[k] += u32::from(number >= threshold);
            self.inward[k] += u32::from(-number >= threshold);
        }
    }
}

/// A place in a cell that depends on the cell's number alone, so that planes of the grid meet no planes of the mesh.
fn place_in_cell(cell: usize, bounds: Aabb) -> DVec3 {
    let at = [cell % CELLS, cell / CELLS % CELLS, cell / CELLS / CELLS];
    let mut bits = cell as u64;
    let share = at.map(|i| {
        // SplitMix64.
        bits = bits.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = bits;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let within = ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64;
        (i as f64 + within) / CELLS as f64
    });
    bounds.min + (bounds.max - bounds.min) * DVec3::from_array(share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::tests::{soup, tetrahedron, turned};
    use crate::analysis::{AnalyzeOptions, analyze};
    use crate::budget::Budget;
    use crate::mesh::Soup;
    use crate::spatial::Contacts;

    fn interval(mesh: &Soup) -> Option<VolumeInterval> {
        let options = AnalyzeOptions { volume_interval: true, ..AnalyzeOptions::default() };
        let told = analyze(mesh, Some(&Contacts::default()), &options, &Budget::unlimited()).unwrap();
        told.volume_interval
    }

    /// A cube from 0 to `size`, outward.
    fn cube(size: f64) -> Soup {
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> =
            quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let mut mesh = soup(8, &triangles);
        mesh.positions = (0..8u32)
            .map(|i| DVec3::from_array(std::array::from_fn(|k| f64::from(i >> k & 1) * size)))
            .collect();
        mesh
    }

    #[test]
    fn a_closed_solid_has_its_exact_volume_and_a_sheet_has_none() {
        let told = interval(&tetrahedron(DVec3::ZERO, 6.0)).unwrap();
        assert_eq!((told.low, told.high, told.is_exact), (36.0, 36.0, true));
        let mut square = soup(4, &[[0, 1, 2], [0, 2, 3]]);
        square.positions = vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y + DVec3::Z];
        assert_eq!(interval(&square), None);
        assert_eq!(interval(&Soup::default()), None);
    }

    #[test]
    fn a_cube_without_a_triangle_or_with_one_turned_has_its_volume_between_bounds_that_are_near_it() {
        for size in [1e-60, 10.0, 1e60] {
            for t in 0..12 {
                let mut holed = cube(size);
                holed.triangles.remove(t);
                holed.face_count -= 1;
                let mut contrary = cube(size);
                contrary.triangles[t].swap(0, 1);
                for mesh in [holed.clone(), turned(holed), contrary] {
                    let told = interval(&mesh).unwrap();
                    let [low, high] = [told.low, told.high].map(|v| v / size.powi(3));
                    assert!(low <= 1.0 && 1.0 <= high && !told.is_exact, "{told:?}");
                    assert!(low > 0.6, "{low} {high}");
                }
            }
        }
    }

    #[test]
    fn places_are_in_their_cells() {
        let bounds = Aabb { min: DVec3::ZERO, max: DVec3::splat(CELLS as f64) };
        for cell in 0..CELLS.pow(3) {
            let place = place_in_cell(cell, bounds).floor();
            let number = place.x as usize + CELLS * (place.y as usize + CELLS * place.z as usize);
            assert_eq!(number, cell);
        }
    }
}
