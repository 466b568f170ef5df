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
    /// How often the first direction of each view is covered, 2 for more.
    covers: [u8; 3],
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
        let mut stars = vec![TerrainStar { turns: 0b11_11_11, covers: [0; 3] }; positions.len()];
        for block in triangles.chunks(CHECK_EVERY) {
            budget.check()?;
            for &corners in block {
                let points = corners.map(|v| positions[v as usize]);
                let turns = certain_turns(points);
                let covers = covered_first_directions(points);
                for (v, covers) in corners.into_iter().zip(covers) {
                    let star = &mut stars[v as usize];
                    star.turns &= turns;
                    for (sum, covers) in star.covers.iter_mut().zip(covers) {
                        *sum = (*sum + covers).min(2);
                    }
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
        (0..3).any(|k| self.turns >> (2 * k) & 3 != 0 && self.covers[k] == 1)
    }
}

/// For each corner and each view 1 when the triangle's angle there, taken the way it turns counter-clockwise, ends in
/// the upper half plane but does not begin there. Around a closed star of clockwise angles the count is the same.
fn covered_first_directions(points: [DVec3; 3]) -> [[u8; 3]; 3] {
    // For each side and each view whether it runs into the upper half plane: along +y, or along +x.
    let is_up = [0, 1, 2].map(|i| {
        let (from, to) = (points[i], points[(i + 1) % 3]);
        [(1, 2), (2, 0), (0, 1)].map(|(x, y)| (to[y] > from[y]) | ((to[y] == from[y]) & (to[x] > from[x])))
    });
    // The angle at a corner begins along the side that leaves it and ends against the one that arrives.
    [0, 1, 2].map(|i| {
        let (leaving, arriving) = (is_up[i], is_up[(i + 2) % 3]);
        [0, 1, 2].map(|k| u8::from(!leaving[k] & !arriving[k]))
    })
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
