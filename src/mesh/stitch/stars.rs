//! The triangles around the vertices that a stitch may join, kept up to date.

use crate::mesh::{Outlines, edge_of, prev_corner};

/// The triangles around each vertex that a pair could join; other vertices have none here.
pub(super) struct PairStars {
    slot: Vec<u32>,
    stars: Vec<Vec<u32>>,
}

const NO_SLOT: u32 = u32::MAX;

impl PairStars {
    pub(super) fn of_ends(triangles: &[[u32; 3]], vertex_count: usize, pairs: &[(u32, u32)]) -> Self {
        let mut slot = vec![NO_SLOT; vertex_count];
        let mut stars = Vec::new();
        for h in pairs.iter().flat_map(|&(g, h)| [g, h]) {
            for v in edge_of(triangles, h) {
                if slot[v as usize] == NO_SLOT {
                    slot[v as usize] = stars.len() as u32;
                    stars.push(Vec::new());
                }
            }
        }
        for (t, corners) in triangles.iter().enumerate() {
            for &v in corners {
                if slot[v as usize] != NO_SLOT {
                    stars[slot[v as usize] as usize].push(t as u32);
                }
            }
        }
        Self { slot, stars }
    }

    pub(super) fn of(&self, v: u32) -> &[u32] {
        &self.stars[self.slot[v as usize] as usize]
    }

    /// Makes `gone` the vertex `kept`.
    pub(super) fn merge(&mut self, triangles: &mut [[u32; 3]], kept: u32, gone: u32) {
        let star = std::mem::take(&mut self.stars[self.slot[gone as usize] as usize]);
        for &t in &star {
            for v in &mut triangles[t as usize] {
                if *v == gone {
                    *v = kept;
                }
            }
        }
        self.stars[self.slot[kept as usize] as usize].extend(star);
    }

    /// The half-edges of edges at `v` that have one face.
    pub(super) fn boundary_at(&self, triangles: &[[u32; 3]], outlines: &Outlines, v: u32) -> Vec<u32> {
        let edges = self.edges_at(triangles, outlines, v);
        let of_edge = edges.chunk_by(|(a, _), (b, _)| a == b);
        of_edge.filter_map(|edge| if let [(_, h)] = *edge { Some(h) } else { None }).collect()
    }

    /// The vertices that an edge joins to `v`, ascending.
    pub(super) fn neighbours(&self, triangles: &[[u32; 3]], outlines: &Outlines, v: u32) -> Vec<u32> {
        let edges = self.edges_at(triangles, outlines, v);
        edges.chunk_by(|(a, _), (b, _)| a == b).map(|edge| edge[0].0).collect()
    }

    /// The half-edges of edges at `v`, each with the other end; ascending.
    fn edges_at(&self, triangles: &[[u32; 3]], outlines: &Outlines, v: u32) -> Vec<(u32, u32)> {
        let mut edges: Vec<(u32, u32)> = Vec::with_capacity(2 * self.of(v).len());
        for &t in self.of(v) {
            for h in 3 * t..3 * t + 3 {
                if edge_of(triangles, h)[0] == v {
                    let back = prev_corner(h);
                    let both = [(edge_of(triangles, h)[1], h), (edge_of(triangles, back)[0], back)];
                    edges.extend(both.into_iter().filter(|&(_, h)| !outlines.is_diagonal(h)));
                }
            }
        }
        edges.sort_unstable();
        edges
    }
}
