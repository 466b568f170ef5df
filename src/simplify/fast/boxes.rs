//! Boxes of triangles that move: a tree that is built once and only grows.

use crate::geom::{Aabb, DVec3};

/// A box of f32, rounded outward.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Box32 {
    min: [f32; 3],
    max: [f32; 3],
}

impl Box32 {
    const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    fn around(bounds: Aabb) -> Self {
        let down = |x: f64| if f64::from(x as f32) > x { (x as f32).next_down() } else { x as f32 };
        let up = |x: f64| if f64::from(x as f32) < x { (x as f32).next_up() } else { x as f32 };
        Self { min: bounds.min.to_array().map(down), max: bounds.max.to_array().map(up) }
    }

    #[inline]
    fn union(self, other: Self) -> Self {
        Self {
            min: std::array::from_fn(|k| self.min[k].min(other.min[k])),
            max: std::array::from_fn(|k| self.max[k].max(other.max[k])),
        }
    }

    #[inline]
    fn meets(&self, other: &Self) -> bool {
        (0..3).all(|k| self.min[k] <= other.max[k] && other.min[k] <= self.max[k])
    }
}

/// Boxes of numbered triangles, neighbours in space near each other in the tree.
///
/// A binary tree in one array: node `i` has the children `2 i` and `2 i + 1`, and the second half are the leaves, one
/// for each triangle.
#[derive(Debug, Clone)]
pub(super) struct GrowingBoxes {
    nodes: Vec<Box32>,
    /// The triangle of each leaf.
    order: Vec<u32>,
    /// The place of each triangle in `order`.
    place: Vec<u32>,
}

impl GrowingBoxes {
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
        let mut nodes = vec![Box32::EMPTY; 2 * leaves];
        for (leaf, &t) in order.iter().enumerate() {
            let [a, b, c] = triangles[t as usize];
            nodes[leaves + leaf] = Box32::around(Aabb::of([position(a), position(b), position(c)]));
        }
        for node in (1..leaves).rev() {
            nodes[node] = nodes[2 * node].union(nodes[2 * node + 1]);
        }
        Self { nodes, order, place }
    }

    /// Bytes that the boxes of `triangles` take.
    pub(super) const fn bytes(triangles: u64) -> u64 {
        triangles * (8 + 2 * size_of::<Box32>() as u64)
    }

    /// Makes room for a triangle where it is now.
    pub(super) fn grow(&mut self, triangle: u32, bounds: Aabb) {
        let bounds = Box32::around(bounds);
        let mut node = self.order.len() + self.place[triangle as usize] as usize;
        while node > 0 {
            let grown = self.nodes[node].union(bounds);
            if grown == self.nodes[node] {
                return;
            }
            self.nodes[node] = grown;
            node /= 2;
        }
    }

    /// Calls `visit` with all triangles whose boxes, as large as they have grown, meet `query`.
    pub(super) fn visit(&self, query: Aabb, mut visit: impl FnMut(u32)) {
        let query = Box32::around(query);
        let leaves = self.order.len();
        let mut stack = [0usize; 64];
        // Without triangles there is no root; with one it is the leaf.
        let mut depth = usize::from(leaves > 0);
        stack[0] = 1;
        while depth > 0 {
            depth -= 1;
            let node = stack[depth];
            if !self.nodes[node].meets(&query) {
                continue;
            }
            if node < leaves {
                stack[depth] = 2 * node + 1;
                stack[depth + 1] = 2 * node;
                depth += 2;
            } else {
                visit(self.order[node - leaves]);
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

    fn found(boxes: &GrowingBoxes, at: DVec3) -> Vec<u32> {
        let mut found = Vec::new();
        boxes.visit(Aabb::of([at]), |t| found.push(t));
        found
    }

    #[test]
    fn no_triangle_at_a_place_is_left_out_and_few_others_are_named() {
        for n in [1, 4, 5, 100, 1000] {
            let boxes = GrowingBoxes::new(&strip(n), position);
            for t in 0..n {
                let all = found(&boxes, position(t + 1));
                assert!(all.contains(&t) && all.len() <= 9, "{t} of {n}: {all:?}");
            }
            assert!(found(&boxes, DVec3::Z).is_empty());
        }
        assert!(found(&GrowingBoxes::new(&[], position), DVec3::ZERO).is_empty());
    }

    #[test]
    fn a_triangle_that_moved_is_found_where_it_is_now() {
        let mut boxes = GrowingBoxes::new(&strip(1000), position);
        let away = DVec3::new(3.0, 3.0, 77.7);
        assert!(found(&boxes, away).is_empty());
        boxes.grow(500, Aabb::of([away]));
        assert!(found(&boxes, away).contains(&500));
        assert!(found(&boxes, position(501)).contains(&500));
    }
}
