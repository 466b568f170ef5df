//! Points in a tree of boxes, to find whether one that counts is in a triangle.

use crate::geom::{DVec2, Sign, orient2d};

/// Points below which a box is not divided.
const LEAF: usize = 8;

/// Points in boxes halved along the longer side. Which of them count changes.
#[derive(Debug, Default)]
pub(super) struct Obstacles {
    nodes: Vec<ObstacleNode>,
    /// The points' numbers, those of a box together.
    ids: Vec<u32>,
    /// The leaf of each point, by its number; [`NO_LEAF`] for what is no point here.
    leaf_of: Vec<u32>,
}

const NO_LEAF: u32 = u32::MAX;

#[derive(Debug)]
struct ObstacleNode {
    min: DVec2,
    max: DVec2,
    first: u32,
    len: u32,
    /// Points that count.
    counting: u32,
    /// The box around this one; the root's is itself.
    parent: u32,
    /// The first of two children, 0 for a leaf.
    children: u32,
}

impl Obstacles {
    /// Takes the points with these numbers, all of which count.
    pub(super) fn reset(&mut self, points: &[DVec2], ids: impl Iterator<Item = u32>) {
        self.ids.clear();
        self.ids.extend(ids);
        self.leaf_of.clear();
        self.leaf_of.resize(points.len(), NO_LEAF);
        self.nodes.clear();
        self.push(points, 0, 0..self.ids.len());
        let mut n = 0;
        while n < self.nodes.len() {
            self.divide(points, n);
            n += 1;
        }
    }

    /// True when there is none at all.
    pub(super) fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    fn push(&mut self, points: &[DVec2], parent: u32, range: std::ops::Range<usize>) {
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &id in &self.ids[range.clone()] {
            (min, max) = (min.min(points[id as usize]), max.max(points[id as usize]));
        }
        let len = range.len() as u32;
        self.nodes.push(ObstacleNode {
            min,
            max,
            first: range.start as u32,
            len,
            counting: len,
            parent,
            children: 0,
        });
    }

    /// Gives node `n` its children, or notes what it holds.
    fn divide(&mut self, points: &[DVec2], n: usize) {
        let ObstacleNode { min, max, first, len, .. } = self.nodes[n];
        let (first, len) = (first as usize, len as usize);
        let ids = &mut self.ids[first..first + len];
        if len <= LEAF || min == max {
            for &id in ids.iter() {
                self.leaf_of[id as usize] = n as u32;
            }
            return;
        }
        let axis = usize::from(max.x / 2.0 - min.x / 2.0 < max.y / 2.0 - min.y / 2.0);
        let half = len / 2;
        let key = |id: &u32| points[*id as usize][axis];
        ids.select_nth_unstable_by(half, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        self.nodes[n].children = self.nodes.len() as u32;
        self.push(points, n as u32, first..first + half);
        self.push(points, n as u32, first + half..first + len);
    }

    /// Says whether the point with this number counts from now on, other than before.
    pub(super) fn change(&mut self, id: u32, counts: bool) {
        let mut n = self.leaf_of[id as usize];
        if n == NO_LEAF {
            return;
        }
        loop {
            let node = &mut self.nodes[n as usize];
            node.counting = if counts { node.counting + 1 } else { node.counting - 1 };
            if n == 0 {
                return;
            }
            n = node.parent;
        }
    }

    /// Whether a point for which `counts` is in the closed triangle, which runs counter-clockwise, other than at a corner of it.
    /// Adds to `steps` what that took.
    pub(super) fn is_one_in(
        &self,
        points: &[DVec2],
        corners: [DVec2; 3],
        counts: impl Fn(u32) -> bool,
        steps: &mut u64,
    ) -> bool {
        let [a, b, c] = corners;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let mut open = vec![0u32];
        while let Some(n) = open.pop() {
            *steps += 1;
            let node = &self.nodes[n as usize];
            let is_apart = node.min.cmpgt(high).any() || node.max.cmplt(low).any();
            if node.counting == 0
                || is_apart
                || [[a, b], [b, c], [c, a]].iter().any(|&side| node.is_right_of(side))
            {
                continue;
            }
            if node.children != 0 {
                open.extend([node.children + 1, node.children]);
                continue;
            }
            for &id in &self.ids[node.first as usize..(node.first + node.len) as usize] {
                *steps += 1;
                let p = points[id as usize];
                if counts(id)
                    && !corners.contains(&p)
                    && orient2d(a, b, p) != Sign::Negative
                    && orient2d(b, c, p) != Sign::Negative
                    && orient2d(c, a, p) != Sign::Negative
                {
                    return true;
                }
            }
        }
        false
    }
}

impl ObstacleNode {
    /// True only when the box is certainly to the right of the line from `p` to `q`.
    fn is_right_of(&self, [p, q]: [DVec2; 2]) -> bool {
        let along = q - p;
        // The corner of the box that is farthest to the left.
        let x = if along.y >= 0.0 { self.min.x } else { self.max.x };
        let y = if along.x >= 0.0 { self.max.y } else { self.min.y };
        let (left, right) = (along.x * (y - p.y), along.y * (x - p.x));
        let size = left.abs() + right.abs();
        // Each product is off by less than three roundings; none of them may have lost its digits.
        (1e-280..1e280).contains(&size) && left - right < -1e-14 * size
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_found_in_a_triangle_exactly_when_one_is_there() {
        let mut state = 7u32;
        let mut random = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        let mut found = 0;
        for round in 0..400 {
            let side = 4 + random(60);
            let scale = [1.0, 1e-170, 1e160, 0.1][round % 4];
            let mut point = || DVec2::new(f64::from(random(side)) * scale, f64::from(random(side)) * scale);
            let points: Vec<DVec2> = (0..1 + round).map(|_| point()).collect();
            let triangles: Vec<[DVec2; 3]> = (0..40).map(|_| [point(), point(), point()]).collect();
            let mut counts = vec![true; points.len()];
            let mut obstacles = Obstacles::default();
            obstacles.reset(&points, (0..points.len() as u32).filter(|id| id % 5 != 3));
            for corners in triangles {
                let id = random(points.len() as u32);
                counts[id as usize] = !counts[id as usize];
                obstacles.change(id, counts[id as usize]);
                let corners = match orient2d(corners[0], corners[1], corners[2]) {
                    Sign::Positive => corners,
                    Sign::Negative => [corners[1], corners[0], corners[2]],
                    Sign::Zero => continue,
                };
                let is_in = |p: DVec2| {
                    let sides = [[0, 1], [1, 2], [2, 0]];
                    let is_left = |[i, j]: [usize; 2]| orient2d(corners[i], corners[j], p) != Sign::Negative;
                    !corners.contains(&p) && sides.into_iter().all(is_left)
                };
                let want = (0..points.len()).any(|id| id % 5 != 3 && counts[id] && is_in(points[id]));
                let got = obstacles.is_one_in(&points, corners, |id| counts[id as usize], &mut 0);
                assert_eq!(got, want, "round {round}");
                found += u32::from(want);
            }
        }
        assert!(found > 1000, "{found}");
    }
}
