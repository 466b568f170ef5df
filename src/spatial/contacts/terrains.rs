//! Vertices around which the triangles lie side by side, so that none of their pairs has to be looked at.
//!
//! Let every edge at a vertex `v` have one triangle in each direction, and let all triangles at `v` turn the same way,
//! strictly, seen along a coordinate axis. Then each of them covers an angle below 180 degrees around `v` in that view,
//! and around `v` as many angles end as begin in every direction: all directions are covered equally often. If that is
//! once, two triangles have at most one edge of their angles in common, which is an edge of both, since a second edge in
//! that direction would begin an angle that covers it again. So they meet in `v` or in a common edge, and nowhere else.
//!
//! How often they are covered is the number of angles that pass or reach the view's first axis: those that end in the
//! upper half plane but do not begin there. Comparisons decide that exactly, and the turns count only where the f64
//! filter is certain.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, certain_turns};

/// For each vertex whether its triangles are known to meet only in it and in common edges.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Terrains {
    is_terrain: Vec<bool>,
}

/// What is known of the triangles around a vertex.
#[derive(Debug, Clone, Copy)]
struct TerrainStar {
    /// Bit `2 k` while all turn counter-clockwise seen along axis `k`, bit `2 k + 1` while all turn clockwise.
    turns: u8,
    /// Bit `k` when the first direction of view `k` is covered, and when it is more than once.
    is_covered: u8,
    is_covered_again: u8,
}

impl Terrains {
    /// Looks at every vertex but those of `open`, which must hold the ends of every edge that does not have exactly two
    /// triangles, one in each direction. O(n).
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn find(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        open: &[u32],
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let _charge = budget.charge((positions.len() * (size_of::<TerrainStar>() + 1)) as u64)?;
        let mut stars =
            vec![TerrainStar { turns: 0b11_11_11, is_covered: 0, is_covered_again: 0 }; positions.len()];
        for block in triangles.chunks(CHECK_EVERY) {
            budget.check()?;
            for &corners in block {
                let points = corners.map(|v| positions[v as usize]);
                let turns = certain_turns(points);
                let covers = covered_first_directions(points);
                for (v, covers) in corners.into_iter().zip(covers) {
                    let star = &mut stars[v as usize];
                    star.turns &= turns;
                    star.is_covered_again |= star.is_covered & covers;
                    star.is_covered |= covers;
                }
            }
        }
        let mut is_terrain: Vec<bool> = stars.iter().map(TerrainStar::is_terrain).collect();
        open.iter().for_each(|&v| is_terrain[v as usize] = false);
        Ok(Self { is_terrain })
    }

    /// True when the triangles at `v` meet only in it and in common edges; false says nothing.
    #[inline]
    pub fn holds(&self, v: u32) -> bool {
        self.is_terrain[v as usize]
    }
}

impl TerrainStar {
    fn is_terrain(&self) -> bool {
        let is_covered_once = self.is_covered & !self.is_covered_again;
        (0..3).any(|k| self.turns >> (2 * k) & 3 != 0 && is_covered_once >> k & 1 != 0)
    }
}

/// For each corner the views, as bits, in which the triangle's angle there, taken the way it turns counter-clockwise, ends in
/// the upper half plane but does not begin there. Around a closed star of clockwise angles as many do.
#[inline]
fn covered_first_directions([a, b, c]: [DVec3; 3]) -> [u8; 3] {
    let is_up = [runs_up(a, b), runs_up(b, c), runs_up(c, a)];
    // The angle at a corner begins along the side that leaves it and ends against the one that arrives.
    [0, 1, 2].map(|i| ALL_VIEWS & !is_up[i] & !is_up[(i + 2) % 3])
}

const ALL_VIEWS: u8 = 0b111;

/// The views, as bits, in which the way from one point to another runs into the upper half plane: along +y, or along +x.
#[inline]
fn runs_up(from: DVec3, to: DVec3) -> u8 {
    let (grows, stays) = (to.cmpgt(from).bitmask() as u8, to.cmpeq(from).bitmask() as u8);
    // View `k` shows axis `k + 1` as x and axis `k + 2` as y.
    let along_x = |axes: u8| axes >> 1 | axes << 2;
    let along_y = |axes: u8| axes >> 2 | axes << 1;
    ALL_VIEWS & (along_y(grows) | along_y(stays) & along_x(grows))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A closed fan around vertex 0 with the given rim.
    fn fan(hub: DVec3, rim: &[DVec3]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let count = rim.len() as u32;
        let triangles = (0..count).map(|i| [0, 1 + i, 1 + (i + 1) % count]).collect();
        (std::iter::once(hub).chain(rim.iter().copied()).collect(), triangles)
    }

    fn is_terrain((positions, triangles): &(Vec<DVec3>, Vec<[u32; 3]>), open: &[u32]) -> bool {
        Terrains::find(positions, triangles, open, &Budget::unlimited()).unwrap().holds(0)
    }

    /// `turns` times around in `steps` steps, along each axis in turn.
    fn rim(steps: u32, turns: f64, axis: usize) -> Vec<DVec3> {
        let point = |i: u32| {
            let angle = turns * std::f64::consts::TAU * f64::from(i) / f64::from(steps) + 0.1;
            let [x, y, z] = [angle.cos(), angle.sin(), 0.3 * f64::from(i % 2)];
            [DVec3::new(z, x, y), DVec3::new(y, z, x), DVec3::new(x, y, z)][axis]
        };
        (0..steps).map(point).collect()
    }

    #[test]
    fn a_fan_that_goes_around_once_is_a_terrain_in_either_direction() {
        for axis in 0..3 {
            for turns in [1.0, -1.0] {
                let fan = fan(DVec3::ZERO, &rim(7, turns, axis));
                assert!(is_terrain(&fan, &[]), "{axis} {turns}");
                assert!(!is_terrain(&fan, &[0]), "an open vertex is none");
            }
        }
    }

    #[test]
    fn a_fan_that_goes_around_twice_or_back_is_none() {
        assert!(!is_terrain(&fan(DVec3::ZERO, &rim(9, 2.0, 2)), &[]));
        let mut folded = rim(7, 1.0, 2);
        folded.swap(2, 3);
        assert!(!is_terrain(&fan(DVec3::ZERO, &folded), &[]));
    }

    #[test]
    fn the_views_in_which_a_way_runs_up_are_told_from_its_coordinates() {
        let steps = [-1.0, 0.0, 1.0];
        for way in steps.iter().flat_map(|&x| steps.iter().flat_map(move |&y| steps.map(|z| [x, y, z]))) {
            for k in 0..3 {
                let (x, y) = (way[(k + 1) % 3], way[(k + 2) % 3]);
                let is_up = y > 0.0 || y == 0.0 && x > 0.0;
                let views = runs_up(DVec3::ONE, DVec3::ONE + DVec3::from(way));
                assert_eq!(views >> k & 1 == 1, is_up, "{way:?} {k}");
            }
        }
    }

    #[test]
    fn rims_on_the_axes_count_once() {
        for axis in 0..3 {
            let mut square = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y];
            square
                .iter_mut()
                .for_each(|p| *p = [DVec3::new(p.z, p.x, p.y), DVec3::new(p.y, p.z, p.x), *p][axis]);
            assert!(is_terrain(&fan(DVec3::ZERO, &square), &[]), "{axis}");
        }
    }

    #[test]
    fn a_degenerate_triangle_makes_none() {
        let (positions, mut triangles) = fan(DVec3::ZERO, &rim(7, 1.0, 2));
        triangles.push([0, 1, 1]);
        assert!(!is_terrain(&(positions, triangles), &[]));
    }
}
