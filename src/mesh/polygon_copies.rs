//! Polygons that are the same: with the same corners in the same order, from whichever they begin and whichever way they
//! run. No coordinates here.

use super::Polygons;
use crate::budget::{Budget, CHECK_EVERY, Stopped};

/// A polygon that an earlier one equals. Both are indices into the lists of [`Polygons`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct PolygonCopy {
    /// The later polygon.
    pub polygon: u32,
    /// The first one with these corners.
    pub of: u32,
    /// They run in opposite directions.
    pub is_reversed: bool,
}

/// The copies among `polygons`, ascending. `place` tells the place of a vertex; two vertices at one place are the same
/// corner. Polygons that pass a place more than once are left out. O(n log n) in the number of corners.
///
/// # Errors
/// When the budget stops the run.
pub fn polygon_copies(
    polygons: &Polygons,
    place: impl Fn(u32) -> u32,
    budget: &Budget,
) -> Result<Vec<PolygonCopy>, Stopped> {
    let count = polygons.faces.len();
    let _charge = budget.charge(count as u64 * 16)?;
    let mut marks: Vec<(u64, u32)> = Vec::with_capacity(count);
    for i in 0..count {
        if i % CHECK_EVERY == 0 {
            budget.check()?;
        }
        marks.push((mark(polygons.corners_of(i), &place), i as u32));
    }
    marks.sort_unstable();
    let mut copies = Vec::new();
    for alike in marks.chunk_by(|a, b| a.0 == b.0).filter(|alike| alike.len() > 1) {
        // Equal marks are equal places but for a chance of 2^-64, so what is compared here is mostly one polygon.
        let mut loops = Vec::with_capacity(alike.len());
        for &(_, i) in alike {
            let corners = polygons.corners_of(i as usize);
            budget.spend(1 + corners.len() as u64 / 8)?;
            loops.extend(from_the_smallest(corners, &place).map(|(corners, runs)| (corners, i, runs)));
        }
        loops.sort_unstable();
        for same in loops.chunk_by(|a, b| a.0 == b.0) {
            let (_, of, first_runs) = same[0];
            let later = same[1..].iter();
            copies.extend(later.map(|&(_, polygon, runs)| PolygonCopy {
                polygon,
                of,
                is_reversed: runs != first_runs,
            }));
        }
    }
    copies.sort_unstable();
    Ok(copies)
}

/// A number that polygons over the same places have in common, whatever their order.
fn mark(corners: &[u32], place: impl Fn(u32) -> u32) -> u64 {
    // The finalizer of SplitMix64: sums of such numbers agree by chance only.
    let mixed = |x: u64| {
        let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    };
    let number = |&v: &u32| mixed(u64::from(place(v)).wrapping_add(0x9e37_79b9_7f4a_7c15));
    corners.iter().map(number).fold(corners.len() as u64, u64::wrapping_add)
}

/// The places of a polygon from the smallest one on, towards the smaller of its neighbours, and whether the polygon runs
/// that way; `None` when it passes a place more than once.
fn from_the_smallest(corners: &[u32], place: impl Fn(u32) -> u32) -> Option<(Vec<u32>, bool)> {
    let mut places: Vec<u32> = corners.iter().map(|&v| place(v)).collect();
    let mut sorted = places.clone();
    sorted.sort_unstable();
    if sorted.windows(2).any(|pair| pair[0] == pair[1]) {
        return None;
    }
    let first = places.iter().position(|&p| p == sorted[0])?;
    places.rotate_left(first);
    let runs = places[1] < places[places.len() - 1];
    if !runs {
        places[1..].reverse();
    }
    Some((places, runs))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn copies(faces: &[&[u32]]) -> Vec<(u32, u32, bool)> {
        let mut polygons = Polygons { starts: vec![0], ..Polygons::default() };
        for (face, corners) in faces.iter().enumerate() {
            polygons.faces.push(face as u32);
            polygons.corners.extend_from_slice(corners);
            polygons.starts.push(polygons.corners.len() as u32);
        }
        let found = polygon_copies(&polygons, |v| v % 100, &Budget::unlimited()).unwrap();
        found.into_iter().map(|copy| (copy.polygon, copy.of, copy.is_reversed)).collect()
    }

    #[test]
    fn a_polygon_is_the_same_from_every_corner_and_in_both_directions() {
        let pentagon = [7, 3, 9, 1, 4];
        for start in 0..5 {
            let mut other = pentagon;
            other.rotate_left(start);
            assert_eq!(copies(&[&pentagon, &other]), [(1, 0, false)]);
            other.reverse();
            assert_eq!(copies(&[&pentagon, &other]), [(1, 0, true)]);
        }
    }

    #[test]
    fn other_orders_of_the_same_corners_are_other_polygons() {
        assert_eq!(copies(&[&[0, 1, 2, 3], &[0, 2, 1, 3], &[0, 1, 3, 2]]), []);
    }

    #[test]
    fn vertices_at_one_place_are_one_corner_and_a_place_passed_twice_is_left_out() {
        assert_eq!(copies(&[&[0, 1, 2, 3], &[102, 3, 100, 1]]), [(1, 0, false)]);
        assert_eq!(copies(&[&[0, 1, 0, 3], &[0, 1, 0, 3]]), []);
    }

    #[test]
    fn each_copy_is_told_against_the_first() {
        let found = copies(&[&[5, 6, 7, 8], &[0, 1, 2, 3], &[6, 5, 8, 7], &[8, 5, 6, 7]]);
        assert_eq!(found, [(2, 0, true), (3, 0, false)]);
    }
}
