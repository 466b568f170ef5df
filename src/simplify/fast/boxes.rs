//! Boxes of triangles that move: a tree that is built once and follows them.

use crate::geom::{Aabb, DVec3};

/// A box in steps of a grid. Rounding never turns the order of two coordinates around, so boxes that meet still do.
#[derive(Debug, Clone, Copy, PartialEq)]
struct GridBox {
    min: [u16; 3],
    max: [u16; 3],
}

impl GridBox {
    const EMPTY: Self = Self { min: [u16::MAX; 3], max: [0; 3] };

    #[inline]
    fn union(self, other: Self) -> Self {
        Self {
            min: std::array::from_fn(|k| self.min[k].min(other.min[k])),
            max: std::array::from_fn(|k| self.max[k].max(other.max[k])),
        }
    }

    /// Only what goes from one end of the grid to the other meets an empty box.
    #[inline]
    fn meets(&self, other: &Self) -> bool {
        // No branches: which side decides is not to be foreseen.
        (0..3).fold(true, |meets, k| meets & (self.min[k] <= other.max[k]) & (other.min[k] <= self.max[k]))
    }
}

/// Cubes over the box of all triangles at the start; what is beyond counts to the ends.
#[derive(Debug, Clone, Copy)]
struct CubeGrid {
    min: DVec3,
    /// Steps to a unit of length.
    scale: f64,
}

impl CubeGrid {
    fn over(bounds: Aabb) -> Self {
        let size = (bounds.max - bounds.min).max_element();
        Self { min: bounds.min, scale: if size > 0.0 { f64::from(u16::MAX) / size } else { 0.0 } }
    }

    #[inline]
    fn around(&self, bounds: Aabb) -> GridBox {
        let steps = |p: DVec3| ((p - self.min) * self.scale).to_array().map(|x| x as u16);
        GridBox { min: steps(bounds.min), max: steps(bounds.max) }
    }
}

/// Boxes of numbered triangles, neighbours in space near each other in the tree.
///
/// A binary tree in one array: node `i` has the children `2 i` and `2 i + 1`, and the second half are the leaves, one
/// for each triangle.
#[derive(Debug, Clone)]
pub(super) struct MovingBoxes {
    grid: CubeGrid,
    nodes: Vec<GridBox>,
    /// The triangle of each leaf.
    order: Vec<u32>,
    /// The place of each triangle in `order`.
    place: Vec<u32>,
}

impl MovingBoxes {
    /// The boxes of `triangles` whose vertices are numbered along a space-filling curve. O(n).
    pub(super) fn new(triangles: &[[u32; 3]], position: impl Fn(u32) -> DVec3) -> Self {
        let first = |t: &[u32; 3]| t[0].min(t[1]).min(t[2]) as usize;
        let vertex_count = triangles.iter().map(first).max().map_or(0, |v| v + 1);
        let mut next = vec![0u32; vertex_count + 1];
        triangles.iter().for_each(|t| next[first(t) + 1] += 1);
        (0..vertex_count).for_each(|v| next[v + 1] += next[v]);
        let mut order = vec![0; triangles.len()];
        let place: Vec<u32> = (0u32..)
            .zip(triangles)
            .map(|(t, corners)| {
                let next = &mut next[first(corners)];
                let place = *next;
                order[place as usize] = t;
                *next += 1;
                place
            })
            .collect();
        let leaves = triangles.len();
        let grid = CubeGrid::over(Aabb::of(triangles.as_flattened().iter().map(|&v| position(v))));
        let mut nodes = vec![GridBox::EMPTY; 2 * leaves];
        for (leaf, &t) in order.iter().enumerate() {
            let [a, b, c] = triangles[t as usize];
            nodes[leaves + leaf] = grid.around(Aabb::of([position(a), position(b), position(c)]));
        }
        for node in (1..leaves).rev() {
            nodes[node] = nodes[2 * node].union(nodes[2 * node + 1]);
        }
        Self { grid, nodes, order, place }
    }

    /// Bytes that the boxes of `triangles` take.
    pub(super) const fn bytes(triangles: u64) -> u64 {
        triangles * (8 + 2 * size_of::<GridBox>() as u64)
    }

    /// Says where a triangle is now.
    pub(super) fn set(&mut self, triangle: u32, bounds: Aabb) {
        self.replace(triangle, self.grid.around(bounds));
    }

    /// Says that a triangle is gone.
    pub(super) fn forget(&mut self, triangle: u32) {
        self.replace(triangle, GridBox::EMPTY);
    }

    fn replace(&mut self, triangle: u32, bounds: GridBox) {
        let mut node = self.order.len() + self.place[triangle as usize] as usize;
        let mut now = bounds;
        while std::mem::replace(&mut self.nodes[node], now) != now && node > 1 {
            node /= 2;
            now = self.nodes[2 * node].union(self.nodes[2 * node + 1]);
        }
    }

    /// Calls `visit` with all triangles whose boxes may meet `query`, until it says false.
    pub(super) fn visit(&self, query: Aabb, mut visit: impl FnMut(u32) -> bool) {
        let query = self.grid.around(query);
        let leaves = self.order.len();
        let mut stack = [0usize; 64];
        // Without triangles there is no root; with one it is the leaf.
        let mut depth = usize::from(self.nodes.get(1).is_some_and(|root| root.meets(&query)));
        stack[0] = 1;
        while depth > 0 {
            depth -= 1;
            let node = stack[depth];
            if node < leaves {
                for child in [2 * node + 1, 2 * node] {
                    stack[depth] = child;
                    depth += usize::from(self.nodes[child].meets(&query));
                }
            } else if !visit(self.order[node - leaves]) {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn position(v: u32) -> DVec3 {
        DVec3::new(f64::from(v / 2), f64::from(v % 2), 0.1)
    }

    /// A strip of `n` triangles along x.
    fn strip(n: u32) -> Vec<[u32; 3]> {
        (0..n).map(|v| [v, v + 1, v + 2]).collect()
    }

    fn found(boxes: &MovingBoxes, at: DVec3) -> Vec<u32> {
        let mut found = Vec::new();
        boxes.visit(Aabb::of([at]), |t| {
            found.push(t);
            true
        });
        found
    }

    #[test]
    fn no_triangle_at_a_place_is_left_out_and_few_others_are_named() {
        for n in [1, 4, 5, 100, 1000] {
            let boxes = MovingBoxes::new(&strip(n), position);
            for t in 0..n {
                let all = found(&boxes, position(t + 1));
                assert!(all.contains(&t) && all.len() <= 9, "{t} of {n}: {all:?}");
            }
            assert!(found(&boxes, DVec3::Z).is_empty());
        }
        assert!(found(&MovingBoxes::new(&[], position), DVec3::ZERO).is_empty());
    }

    #[test]
    fn a_triangle_that_moved_is_found_where_it_is_now() {
        let mut boxes = MovingBoxes::new(&strip(1000), position);
        let away = DVec3::new(700.0, 3.0, 77.7);
        boxes.set(500, Aabb::of([away, position(501)]));
        assert!(found(&boxes, away).contains(&500) && found(&boxes, position(501)).contains(&500));
        boxes.set(500, Aabb::of([position(1)]));
        assert!(found(&boxes, position(1)).contains(&500) && !found(&boxes, position(501)).contains(&500));
        boxes.forget(500);
        assert!(!found(&boxes, position(1)).contains(&500));
    }
}
