//! Points near a point, by an octree: cubes halved along every axis until few points are left in each.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};

/// Points sorted into a tree of boxes.
#[derive(Debug)]
pub struct Octree<'a> {
    points: &'a [DVec3],
    nodes: Vec<OctreeNode>,
    /// Ids of points, those of a leaf together.
    ids: Vec<u32>,
}

#[derive(Debug)]
struct OctreeNode {
    /// Tight around the points, so that what it says does not depend on rounded cube sides.
    bounds: Aabb,
    /// Its points in `ids`.
    points: (u32, u32),
    /// Its children in `nodes`; empty for a leaf.
    children: (u32, u32),
}

/// Points that a leaf may hold.
const LEAF_MAX: usize = 8;

/// Halvings after which a leaf is one whatever it holds: those of an f64's digits. Equal points never part.
const DEPTH_MAX: u32 = 52;

/// True when the points are at most `distance` apart. At distance 0 only equal points are, however close others may be.
pub fn is_within(p: DVec3, q: DVec3, distance: f64) -> bool {
    p == q || (distance > 0.0 && ((p - q) / distance).length_squared() <= 1.0)
}

impl<'a> Octree<'a> {
    /// Sorts the points with these ids, which must be finite.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn build(points: &'a [DVec3], ids: Vec<u32>, budget: &Budget) -> Result<Self, Stopped> {
        let _charge = budget.charge(ids.len() as u64 * 80)?;
        let mut tree = Self { points, nodes: Vec::new(), ids };
        let all = (0, tree.ids.len() as u32);
        tree.nodes.push(tree.leaf(all));
        let mut open = vec![(0, 0)];
        while let Some((node, depth)) = open.pop() {
            let (from, to) = tree.nodes[node].points;
            budget.spend(u64::from(to - from) / 16 + 1)?;
            let Aabb { min, max } = tree.nodes[node].bounds;
            if (to - from) as usize > LEAF_MAX && depth < DEPTH_MAX && min != max {
                tree.divide(node, min / 2.0 + max / 2.0);
                let (first, last) = tree.nodes[node].children;
                open.extend((first..last).map(|child| (child as usize, depth + 1)));
            }
        }
        Ok(tree)
    }

    fn leaf(&self, (from, to): (u32, u32)) -> OctreeNode {
        let bounds =
            Aabb::of(self.ids[from as usize..to as usize].iter().map(|&id| self.points[id as usize]));
        OctreeNode { bounds, points: (from, to), children: (0, 0) }
    }

    /// Gives `node` a child for each octant about `center` that has points.
    fn divide(&mut self, node: usize, center: DVec3) {
        let (from, to) = self.nodes[node].points;
        let octant = |id: &u32| {
            let p = self.points[*id as usize];
            u32::from(p.x > center.x) | u32::from(p.y > center.y) << 1 | u32::from(p.z > center.z) << 2
        };
        self.ids[from as usize..to as usize].sort_by_key(octant);
        let first = self.nodes.len() as u32;
        let mut begin = from;
        for of_octant in self.ids[from as usize..to as usize].chunk_by(|a, b| octant(a) == octant(b)) {
            let end = begin + of_octant.len() as u32;
            let child = self.leaf((begin, end));
            self.nodes.push(child);
            begin = end;
        }
        self.nodes[node].children = (first, self.nodes.len() as u32);
    }

    /// The points at most `distance` from `p`, ascending.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn near(&self, p: DVec3, distance: f64, budget: &Budget) -> Result<Vec<u32>, Stopped> {
        let mut near = Vec::new();
        let mut open = vec![0];
        let mut steps = 0;
        while let Some(node) = open.pop() {
            let OctreeNode { bounds, points: (from, to), children: (first, last) } = &self.nodes[node];
            if bounds.is_empty() || !is_within(p, p.clamp(bounds.min, bounds.max), distance) {
                continue;
            }
            steps += 1 + (to - from) as usize * usize::from(first == last);
            if steps > CHECK_EVERY {
                budget.spend(std::mem::take(&mut steps) as u64)?;
            }
            if first < last {
                open.extend((*first..*last).map(|child| child as usize));
            } else {
                let ids = self.ids[*from as usize..*to as usize].iter().copied();
                near.extend(ids.filter(|&id| is_within(p, self.points[id as usize], distance)));
            }
        }
        budget.spend((steps + 4 * near.len()) as u64)?;
        near.sort_unstable();
        Ok(near)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(points: &[DVec3], p: DVec3, distance: f64) -> Vec<u32> {
        let budget = Budget::unlimited();
        let ids = (0..points.len() as u32).collect();
        Octree::build(points, ids, &budget).unwrap().near(p, distance, &budget).unwrap()
    }

    #[test]
    fn what_is_near_is_what_comparing_with_every_point_finds() {
        let mut state = 5u32;
        let mut random = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        for round in 0..300 {
            let scale = [1e-300, 1e-3, 1.0, 1e30, 1e300][round % 5];
            let side = 1 + random(40);
            let points: Vec<DVec3> = (0..random(200))
                .map(|_| DVec3::from_array(std::array::from_fn(|_| f64::from(random(side)) * scale)))
                .collect();
            for distance in [0.0, 1.0, 2.5].map(|d| d * scale) {
                let p = DVec3::from_array(std::array::from_fn(|_| f64::from(random(side)) * scale));
                let all = 0..points.len() as u32;
                let want: Vec<u32> = all.filter(|&i| is_within(p, points[i as usize], distance)).collect();
                assert_eq!(near(&points, p, distance), want, "round {round} at {distance}");
            }
        }
    }

    #[test]
    fn many_equal_points_are_one_leaf() {
        let points = vec![DVec3::splat(0.1); 1000];
        assert_eq!(near(&points, points[0], 0.0).len(), 1000);
        assert_eq!(near(&points, DVec3::splat(0.2), 0.01).len(), 0);
    }

    #[test]
    fn points_that_differ_by_less_than_a_square_can_hold_are_not_equal() {
        let points = [DVec3::ZERO, DVec3::X * 1e-200];
        assert_eq!(near(&points, DVec3::ZERO, 0.0), [0]);
        assert_eq!(near(&points, DVec3::ZERO, 1e-200), [0, 1]);
    }
}
