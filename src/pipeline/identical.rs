//! How much of the input is in the output, bit for bit.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::Soup;
use crate::par;
use crate::repair::NEW;
use foldhash::fast::FixedState;
use std::hash::BuildHasher;

/// Share of the triangles of `input` that `output` holds with equal coordinates in the same direction, both taken as
/// multisets. `origins` name the triangle of the input that each one of the output most likely is ([`NEW`]: none): those
/// need one comparison, and only what is left is searched.
pub(super) fn identical_triangle_share(
    input: &Soup,
    output: &Soup,
    origins: &[u32],
    budget: &Budget,
) -> Result<f64, Stopped> {
    let mut is_found = vec![false; input.triangles.len()];
    let mut others = Vec::new();
    for (t, &origin) in origins.iter().enumerate().take(output.triangles.len()) {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let corners = output.corners(t as u32);
        let is_origin =
            origin != NEW && !is_found[origin as usize] && are_one(input.corners(origin), corners);
        if is_origin {
            is_found[origin as usize] = true;
        } else {
            others.push(fingerprint(corners));
        }
    }
    let mut left = Vec::new();
    for t in (0..input.triangles.len()).filter(|&t| !is_found[t]) {
        if left.len() % CHECK_EVERY == 0 {
            budget.check()?;
        }
        left.push(fingerprint(input.corners(t as u32)));
    }
    let identical = input.triangles.len() - left.len() + common(left, others);
    Ok(identical as f64 / input.triangles.len().max(1) as f64)
}

/// True when both have the same corners in the same direction.
fn are_one([a, b, c]: [DVec3; 3], other: [DVec3; 3]) -> bool {
    [[a, b, c], [b, c, a], [c, a, b]].contains(&other)
}

/// A number that is the same for a triangle from whichever corner it starts, and different for different triangles but
/// for a chance of 2^-128.
pub(super) fn fingerprint(corners: [DVec3; 3]) -> u128 {
    // Adding zero makes -0 and 0 one.
    let [a, b, c] = corners.map(|p| p.to_array().map(|x| (x + 0.0).to_bits()));
    let first = [[a, b, c], [b, c, a], [c, a, b]].into_iter().min();
    let half = |seed: u64| u128::from(FixedState::with_seed(seed).hash_one(first));
    half(1) << 64 | half(2)
}

/// Number of members that two multisets have in common.
fn common(mut a: Vec<u128>, mut b: Vec<u128>) -> usize {
    par::sort_unstable(&mut a);
    par::sort_unstable(&mut b);
    let (mut i, mut j, mut count) = (0, 0, 0);
    while i < a.len() && j < b.len() {
        count += usize::from(a[i] == b[j]);
        (i, j) = (i + usize::from(a[i] <= b[j]), j + usize::from(b[j] <= a[i]));
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    fn soup(triangles: &[[u32; 3]]) -> Soup {
        let corner = |i: u32| DVec3::new(f64::from(i), f64::from(i * i), 0.0);
        Soup { positions: (0..6).map(corner).collect(), triangles: triangles.to_vec(), ..Soup::default() }
    }

    fn share(input: &[[u32; 3]], output: &[[u32; 3]], origins: &[u32]) -> f64 {
        identical_triangle_share(&soup(input), &soup(output), origins, &Budget::unlimited()).unwrap()
    }

    #[test]
    fn a_triangle_is_itself_from_any_corner_but_not_the_other_way_around() {
        assert_eq!(share(&[[0, 1, 2]], &[[2, 0, 1]], &[0]), 1.0);
        assert_eq!(share(&[[0, 1, 2]], &[[0, 2, 1]], &[0]), 0.0);
    }

    #[test]
    fn of_two_copies_one_that_stays_is_half() {
        assert_eq!(share(&[[0, 1, 2], [1, 2, 0]], &[[0, 1, 2]], &[0]), 0.5);
        assert_eq!(share(&[[0, 1, 2], [3, 4, 5]], &[[0, 1, 2], [0, 1, 2]], &[0, 0]), 0.5);
    }

    #[test]
    fn a_new_triangle_that_equals_one_that_went_counts() {
        assert_eq!(share(&[[0, 1, 2], [3, 4, 5]], &[[4, 5, 3], [0, 1, 3]], &[NEW, 0]), 0.5);
    }
}
