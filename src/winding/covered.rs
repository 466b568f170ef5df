//! Openings that closed bodies cover: a boss without a bottom that stands on a plate is no sheet.

use super::WindingTree;
use super::rims::UnbalancedEdge;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::UnionFind;

/// Shares of the way from an edge of a rim to its middle at which an opening is looked at.
const SHARES: [f64; 2] = [0.1, 0.5];

/// Places are looked at so many times `beside` away from the opening: a turned body is off its planes by rounding.
const TIMES_BESIDE: f64 = 16.0;

/// Which of the parts that `is_asked` marks have openings that the `closed` bodies cover, all of them: on one side of each at least
/// is the inside of a body. `rims` names edges of `positions`.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn are_covered(
    positions: &[DVec3],
    rims: &[UnbalancedEdge],
    is_asked: &[bool],
    (closed, beside): (&[[DVec3; 3]], f64),
    budget: &Budget,
) -> Result<Vec<bool>, Stopped> {
    let rims: Vec<&UnbalancedEdge> = rims.iter().filter(|rim| is_asked[rim.part as usize]).collect();
    let mut are_covered = vec![false; is_asked.len()];
    if closed.is_empty() || rims.is_empty() {
        return Ok(are_covered);
    }
    rims.iter().for_each(|rim| are_covered[rim.part as usize] = true);
    let tree = WindingTree::build(closed.to_vec(), budget)?;
    let mut sets = UnionFind::new(positions.len());
    for rim in &rims {
        sets.unite(rim.from, rim.to);
    }
    let mut by_opening: Vec<(u32, &UnbalancedEdge)> =
        rims.into_iter().map(|rim| (sets.find(rim.from), rim)).collect();
    by_opening.sort_by_key(|&(opening, _)| opening);
    for opening in by_opening.chunk_by(|a, b| a.0 == b.0) {
        let ends = |rim: &UnbalancedEdge| [rim.from, rim.to].map(|v| positions[v as usize]);
        let edges = || opening.iter().map(|&(_, rim)| ends(rim));
        let middle = edges().map(|[a, b]| (a + b) / 2.0).sum::<DVec3>() / opening.len() as f64;
        let normal = edges().map(|[a, b]| (a - middle).cross(b - middle)).sum::<DVec3>().normalize_or_zero();
        let step = normal * (TIMES_BESIDE * beside);
        let on_rays = |[a, b]: [DVec3; 2]| SHARES.map(|share| ((a + b) / 2.0).lerp(middle, share));
        let mut is_covered = step != DVec3::ZERO;
        for place in edges().flat_map(on_rays).chain([middle]) {
            if !is_covered {
                break;
            }
            budget.spend(16)?;
            is_covered =
                tree.is_inside(place - step, 0.0, budget)? || tree.is_inside(place + step, 0.0, budget)?;
        }
        if !is_covered {
            opening.iter().for_each(|&(_, rim)| are_covered[rim.part as usize] = false);
        }
    }
    Ok(are_covered)
}

#[cfg(test)]
mod tests {
    use super::super::{OpenShells, sort};
    use crate::budget::Budget;
    use crate::geom::DVec3;

    type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

    /// A box from a corner on, with or without its bottom.
    fn block(corner: [f64; 3], size: [f64; 3], has_bottom: bool) -> Mesh {
        let [corner, size] = [corner, size].map(DVec3::from_array);
        let place =
            |i: usize| corner + DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * size;
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles =
            quads[usize::from(!has_bottom)..].iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        ((0..8).map(place).collect(), triangles.collect())
    }

    /// The numbers of closed parts, of those that bound a volume, and of sheets.
    fn parts(of: &[Mesh]) -> [u32; 3] {
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for (places, corners) in of {
            let first = positions.len() as u32;
            positions.extend(places);
            triangles.extend(corners.iter().map(|t| t.map(|v| v + first)));
        }
        sort(&positions, &triangles, OpenShells::Auto, 1e-6, &Budget::unlimited()).unwrap().parts
    }

    #[test]
    fn a_shallow_box_without_a_bottom_stands_on_a_plate_or_in_it_and_is_a_sheet_elsewhere() {
        let plate = || block([0.0; 3], [1.0, 1.0, 0.125], true);
        let shallow = |z: f64| block([0.25, 0.25, z], [0.5, 0.5, 0.0625], false);
        for z in [0.125, 0.1, 0.125 + 1e-6] {
            assert_eq!(parts(&[plate(), shallow(z)]), [2, 0, 0], "{z}");
        }
        assert_eq!(parts(&[plate(), shallow(0.25)]), [1, 0, 1], "above");
        assert_eq!(parts(&[shallow(0.125)]), [0, 0, 1], "alone");
        let mut inward = shallow(0.125);
        inward.1.iter_mut().for_each(|corners| corners.swap(0, 1));
        assert_eq!(parts(&[plate(), inward]), [1, 0, 1], "a dish");
    }

    #[test]
    fn a_part_over_a_bore_or_with_a_second_opening_does_not_stand() {
        let bars = [
            block([0.0, 0.0, 0.0], [1.0, 0.375, 0.125], true),
            block([0.0, 0.625, 0.0], [1.0, 0.375, 0.125], true),
            block([0.0, 0.375, 0.0], [0.375, 0.25, 0.125], true),
            block([0.625, 0.375, 0.0], [0.375, 0.25, 0.125], true),
        ];
        let cover = block([0.25, 0.25, 0.125], [0.5, 0.5, 0.0625], false);
        assert_eq!(parts(&[bars.to_vec(), vec![cover.clone()]].concat()), [4, 0, 1]);
        let plate = block([0.0; 3], [1.0, 1.0, 0.125], true);
        let (places, mut corners) = cover;
        corners.drain(..2);
        assert_eq!(parts(&[plate, (places, corners)]), [1, 0, 1], "open at the top");
    }
}
