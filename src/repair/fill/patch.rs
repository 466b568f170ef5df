//! A patch while it is made: triangles over the corners of the rim and new vertices, with their neighbours.
//!
//! A corner of the rim is a step of a loop, so that a place that loops pass twice is two corners here, and every edge has
//! two triangles or is in the rim.

use crate::geom::{DVec3, triangle_area};
use crate::mesh::{edge_of, next_corner, prev_corner, triangle_of};
use rustc_hash::FxHashSet;

/// No half-edge on the other side: the edge is in the rim.
pub(super) const RIM: u32 = u32::MAX;

/// Triangles whose edges have two of them or are in the rim.
#[derive(Debug, Clone)]
pub(super) struct PatchMesh {
    /// Those of the rim's corners, then new ones.
    pub(super) points: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Number of corners of the rim.
    pub(super) rim: usize,
    /// For each new vertex the ends of the edge that it has divided.
    pub(super) parents: Vec<[u32; 2]>,
    /// For each half-edge the one on the other side, or [`RIM`].
    twin: Vec<u32>,
    edges: FxHashSet<[u32; 2]>,
}

fn undirected(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The numbers below `count` by the bins `of` puts them into: where those of each of `bins` begin, and all of them, ascending in
/// each.
pub(super) fn listed_by(bins: usize, count: u32, of: impl Fn(u32) -> u32) -> (Vec<u32>, Vec<u32>) {
    let mut start = vec![0u32; bins + 1];
    for i in 0..count {
        start[of(i) as usize + 1] += 1;
    }
    for bin in 0..bins {
        start[bin + 1] += start[bin];
    }
    let mut next = start.clone();
    let mut listed = vec![0; count as usize];
    for i in 0..count {
        let at = &mut next[of(i) as usize];
        listed[*at as usize] = i;
        *at += 1;
    }
    (start, listed)
}

impl PatchMesh {
    /// `None` when an edge has more than two triangles, or two in the same direction.
    pub(super) fn new(points: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Option<Self> {
        let rim = points.len();
        let count = 3 * triangles.len() as u32;
        let ends = |h: u32| {
            let [a, b] = edge_of(&triangles, h);
            undirected(a, b)
        };
        // The half-edges at each vertex that is the smaller of their ends: few, so that they are quickly sorted.
        let (start, mut half_edges) = listed_by(rim, count, |h| ends(h)[0]);
        let mut twin = vec![RIM; count as usize];
        let mut edges = FxHashSet::with_capacity_and_hasher(count as usize / 2 + rim, Default::default());
        for range in start.windows(2) {
            let own = &mut half_edges[range[0] as usize..range[1] as usize];
            own.sort_unstable_by_key(|&h| (ends(h)[1], h));
            for group in own.chunk_by(|&g, &h| ends(g)[1] == ends(h)[1]) {
                match *group {
                    [_] => {}
                    [g, h] if edge_of(&triangles, g)[0] == edge_of(&triangles, h)[1] => {
                        (twin[g as usize], twin[h as usize]) = (h, g);
                    }
                    _ => return None,
                }
                edges.insert(ends(group[0]));
            }
        }
        Some(Self { points, triangles, rim, parents: Vec::new(), twin, edges })
    }

    pub(super) fn ends(&self, h: u32) -> [u32; 2] {
        edge_of(&self.triangles, h)
    }

    pub(super) fn twin(&self, h: u32) -> Option<u32> {
        Some(self.twin[h as usize]).filter(|&twin| twin != RIM)
    }

    /// The corner of the triangle of `h` that is not on `h`.
    pub(super) fn apex(&self, h: u32) -> u32 {
        self.ends(prev_corner(h))[0]
    }

    pub(super) fn point(&self, v: u32) -> DVec3 {
        self.points[v as usize]
    }

    /// Area of all triangles, in square units of the file.
    pub(super) fn area(&self) -> f64 {
        self.triangles.iter().map(|t| triangle_area(t.map(|v| self.point(v)))).sum()
    }

    /// The edges inside that have both ends in the rim.
    pub(super) fn chords(&self) -> impl Iterator<Item = [u32; 2]> {
        let half_edges = 0..self.twin.len() as u32;
        let inside = half_edges.filter(|&h| self.twin(h).is_some_and(|twin| h < twin));
        inside.map(|h| self.ends(h)).filter(|ends| ends.iter().all(|&v| (v as usize) < self.rim))
    }

    pub(super) fn has_edge(&self, a: u32, b: u32) -> bool {
        self.edges.contains(&undirected(a, b))
    }

    fn link(&mut self, g: u32, h: u32) {
        self.twin[g as usize] = h;
        if h != RIM {
            self.twin[h as usize] = g;
        }
    }

    /// Turns the edge of `h` so that it joins the other two corners of its triangles. Gives the half-edges of the four
    /// edges around. The caller has seen that there is no such edge yet.
    ///
    /// ```text
    ///       c                c
    ///     /   \            / | \
    ///    a --- b   gives  a  |  b
    ///     \   /            \ | /
    ///       d                d
    /// ```
    pub(super) fn flip(&mut self, h: u32) -> Option<[u32; 4]> {
        let g = self.twin(h)?;
        let ([a, b], c, d) = (self.ends(h), self.apex(h), self.apex(g));
        let [to_c, from_c, to_d, from_d] =
            [next_corner(h), prev_corner(h), next_corner(g), prev_corner(g)].map(|e| self.twin[e as usize]);
        let (t, u) = (triangle_of(h), triangle_of(g));
        self.triangles[t as usize] = [c, a, d];
        self.triangles[u as usize] = [d, b, c];
        self.link(3 * t, from_c);
        self.link(3 * t + 1, to_d);
        self.link(3 * u, from_d);
        self.link(3 * u + 1, to_c);
        self.link(3 * t + 2, 3 * u + 2);
        self.edges.remove(&undirected(a, b));
        self.edges.insert(undirected(c, d));
        Some([3 * t, 3 * t + 1, 3 * u, 3 * u + 1])
    }

    /// Divides the edge of `h` and both its triangles at a new vertex. Gives that vertex.
    ///
    /// ```text
    ///       c                c
    ///     /   \            / | \
    ///    a --- b   gives  a--m--b
    ///     \   /            \ | /
    ///       d                d
    /// ```
    pub(super) fn split(&mut self, h: u32, point: DVec3) -> Option<u32> {
        let g = self.twin(h)?;
        let ([a, b], c, d) = (self.ends(h), self.apex(h), self.apex(g));
        let [to_c, from_c, to_d, from_d] =
            [next_corner(h), prev_corner(h), next_corner(g), prev_corner(g)].map(|e| self.twin[e as usize]);
        let m = self.points.len() as u32;
        self.points.push(point);
        self.parents.push([a, b]);
        let (t, u, v) = (triangle_of(h), triangle_of(g), self.triangles.len() as u32);
        let w = v + 1;
        self.triangles[t as usize] = [a, m, c];
        self.triangles[u as usize] = [m, a, d];
        self.triangles.extend([[m, b, c], [b, m, d]]);
        self.twin.extend([RIM; 6]);
        self.link(3 * t + 2, from_c);
        self.link(3 * u + 1, to_d);
        self.link(3 * v + 1, to_c);
        self.link(3 * w + 2, from_d);
        self.link(3 * t, 3 * u);
        self.link(3 * v, 3 * w);
        self.link(3 * t + 1, 3 * v + 2);
        self.link(3 * u + 2, 3 * w + 1);
        self.edges.remove(&undirected(a, b));
        self.edges.extend([a, b, c, d].map(|x| undirected(x, m)));
        Some(m)
    }

    /// The neighbours of every vertex: where those of each begin, and all of them.
    pub(super) fn neighbours(&self) -> (Vec<u32>, Vec<u32>) {
        let mut start = vec![0u32; self.points.len() + 1];
        let once = |h: u32| self.twin(h).is_none_or(|twin| h < twin);
        let all = || (0..self.twin.len() as u32).filter(|&h| once(h)).map(|h| self.ends(h));
        for v in all().flatten() {
            start[v as usize + 1] += 1;
        }
        for v in 0..self.points.len() {
            start[v + 1] += start[v];
        }
        let mut next = start.clone();
        let mut others = vec![0; start[self.points.len()] as usize];
        for [a, b] in all() {
            for (v, other) in [(a, b), (b, a)] {
                others[next[v as usize] as usize] = other;
                next[v as usize] += 1;
            }
        }
        (start, others)
    }

    /// Broken invariants, as sentences; empty when all hold.
    #[cfg(test)]
    pub(super) fn check(&self) -> Vec<String> {
        let mut broken = Vec::new();
        for h in 0..self.twin.len() as u32 {
            let [a, b] = self.ends(h);
            match self.twin(h) {
                Some(g) if self.twin(g) != Some(h) => {
                    broken.push(format!("the twin of {h} has another twin"));
                }
                Some(g) if self.ends(g) != [b, a] => broken.push(format!("the twin of {h} is elsewhere")),
                _ => {}
            }
            if !self.has_edge(a, b) {
                broken.push(format!("edge {a}-{b} is not listed"));
            }
        }
        let rim = self.twin.iter().filter(|&&twin| twin == RIM).count();
        if self.edges.len() != (self.twin.len() - rim) / 2 + rim {
            broken.push(format!("{} edges are listed", self.edges.len()));
        }
        broken
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fan(n: u32) -> PatchMesh {
        let corner = |i: u32| {
            let angle = f64::from(i) * std::f64::consts::TAU / f64::from(n);
            DVec3::new(angle.cos(), angle.sin(), 0.0)
        };
        PatchMesh::new((0..n).map(corner).collect(), (1..n - 1).map(|i| [0, i, i + 1]).collect()).unwrap()
    }

    #[test]
    fn splits_and_flips_keep_twins_and_edges_right() {
        let mut mesh = fan(7);
        assert_eq!(mesh.check(), Vec::<String>::new());
        for step in 0..60u32 {
            let h = step * 7919 % (3 * mesh.triangles.len() as u32);
            if step % 3 == 0 {
                let [a, b] = mesh.ends(h).map(|v| mesh.point(v));
                mesh.split(h, (a + b) / 2.0);
            } else if let Some(g) = mesh.twin(h)
                && !mesh.has_edge(mesh.apex(h), mesh.apex(g))
            {
                mesh.flip(h);
            }
            assert_eq!(mesh.check(), Vec::<String>::new(), "step {step}");
        }
        assert!(mesh.points.len() > 20);
        // Euler: a disk of n corners and m other vertices has n + 2 m - 2 triangles.
        assert_eq!(mesh.triangles.len(), mesh.rim + 2 * (mesh.points.len() - mesh.rim) - 2);
        let (start, others) = mesh.neighbours();
        for v in 0..mesh.points.len() {
            let mut own = others[start[v] as usize..start[v + 1] as usize].to_vec();
            let all = own.len();
            own.sort_unstable();
            own.dedup();
            assert_eq!(own.len(), all, "vertex {v} has a neighbour twice");
        }
    }

    #[test]
    fn an_edge_of_three_triangles_makes_no_patch() {
        assert!(PatchMesh::new(vec![DVec3::ZERO; 5], vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]]).is_none());
        assert!(PatchMesh::new(vec![DVec3::ZERO; 4], vec![[0, 1, 2], [0, 1, 3]]).is_none());
    }
}
