//! The mesh around the holes, with one vertex at each place.

use super::fair::PatchSurroundings;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::{EdgeGroups, edge_of, next_corner, prev_corner};
use crate::spatial::Bvh;
use rustc_hash::{FxHashMap, FxHashSet};

/// The mesh around the holes, and the patches it has got so far.
pub(super) struct FillSurface {
    /// Of the mesh, then of new vertices of patches, taken or not.
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) groups: EdgeGroups,
    /// Largest coordinate of the mesh, in size.
    pub(super) reach: f64,
    /// Over the triangles; built when the first patch is to be tested.
    pub(super) bvh: Option<Bvh>,
    pub(super) patches: Vec<[u32; 3]>,
    /// Edges of patches between vertices of the mesh.
    pub(super) diagonals: FxHashSet<[u32; 2]>,
    stars: VertexStars,
    /// Where the edges of each vertex begin in `groups`, of which it is the smaller end; empty until they are asked for.
    first_edge: Vec<u32>,
}

/// The triangles at each vertex: where those of each begin, and all of them. Empty until they are asked for.
#[derive(Default)]
struct VertexStars {
    start: Vec<u32>,
    triangles: Vec<u32>,
}

impl FillSurface {
    pub(super) fn new(
        positions: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let groups = EdgeGroups::build(&triangles, positions.len(), budget)?;
        let reach = positions.iter().fold(0.0, |reach, p| p.abs().max_element().max(reach));
        Ok(Self {
            positions,
            triangles,
            groups,
            reach,
            bvh: None,
            patches: Vec::new(),
            diagonals: FxHashSet::default(),
            stars: VertexStars::default(),
            first_edge: Vec::new(),
        })
    }

    /// The vertex of a boundary loop at half-edge `h`.
    pub(super) fn corner(&self, h: u32) -> u32 {
        edge_of(&self.triangles, h)[1]
    }

    /// The position of that vertex.
    pub(super) fn point(&self, h: u32) -> DVec3 {
        self.positions[self.corner(h) as usize]
    }

    /// The unit normal of the triangle at half-edge `h`; zero when it is too small to have one.
    pub(super) fn normal(&self, h: u32) -> DVec3 {
        let [a, b, c] = [h, next_corner(h), prev_corner(h)].map(|h| self.point(h));
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// The unit direction in which the surface would go on beyond boundary half-edge `h`; zero when its triangle is too
    /// small to have one.
    pub(super) fn outward(&self, h: u32) -> DVec3 {
        let [from, to] = edge_of(&self.triangles, h).map(|v| self.positions[v as usize]);
        (to - from).cross(self.normal(h)).normalize_or_zero()
    }

    /// True when no triangle has the edge between the vertices of two corners.
    pub(super) fn is_free(&self, g: u32, h: u32) -> bool {
        let [a, b] = [self.corner(g), self.corner(h)];
        a != b && self.is_free_edge([a.min(b), a.max(b)])
    }

    pub(super) fn is_free_edge(&self, edge: [u32; 2]) -> bool {
        !self.diagonals.contains(&edge) && !self.has_edge(edge)
    }

    /// True when a triangle of the mesh has this edge, its smaller end first.
    fn has_edge(&self, edge: [u32; 2]) -> bool {
        let [v, to] = edge;
        let Some(&[from, end]) = self.first_edge.get(v as usize..v as usize + 2) else {
            return self.groups.find(&self.triangles, edge).is_some();
        };
        let other_end = |e: u32| {
            let [a, b] = edge_of(&self.triangles, self.groups.group(e as usize)[0]);
            a.max(b)
        };
        let (mut low, mut high) = (from, end);
        while low < high {
            let middle = low + (high - low) / 2;
            if other_end(middle) < to { low = middle + 1 } else { high = middle }
        }
        low < end && other_end(low) == to
    }

    /// Lists where the edges of each vertex begin, so that questions after edges are quick.
    pub(super) fn find_first_edges(&mut self, budget: &Budget) -> Result<(), Stopped> {
        budget.spend(self.groups.len() as u64 / 16)?;
        let mut first = vec![0u32; self.positions.len() + 1];
        for (e, group) in self.groups.edges().enumerate() {
            if e % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let [a, b] = edge_of(&self.triangles, group[0]);
            first[a.min(b) as usize + 1] += 1;
        }
        for v in 0..self.positions.len() {
            first[v + 1] += first[v];
        }
        self.first_edge = first;
        Ok(())
    }

    /// Lists the triangles at each vertex, for [`around`](Self::around) and [`star`](Self::star).
    pub(super) fn find_stars(&mut self, budget: &Budget) -> Result<(), Stopped> {
        if !self.stars.start.is_empty() {
            return Ok(());
        }
        budget.spend(self.triangles.len() as u64 / 16)?;
        let mut start = vec![0u32; self.positions.len() + 1];
        for (i, &v) in self.triangles.as_flattened().iter().enumerate() {
            if i % CHECK_EVERY == 0 {
                budget.check()?;
            }
            start[v as usize + 1] += 1;
        }
        for v in 0..self.positions.len() {
            start[v + 1] += start[v];
        }
        let mut next = start.clone();
        let mut triangles = vec![0u32; self.triangles.len() * 3];
        for (t, corners) in self.triangles.iter().enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            for &v in corners {
                triangles[next[v as usize] as usize] = t as u32;
                next[v as usize] += 1;
            }
        }
        self.stars = VertexStars { start, triangles };
        Ok(())
    }

    /// The triangles of the mesh at vertex `v`, ascending.
    pub(super) fn star(&self, v: u32) -> &[u32] {
        let VertexStars { start, triangles } = &self.stars;
        match start.get(v as usize + 1) {
            Some(&end) => &triangles[start[v as usize] as usize..end as usize],
            None => &[],
        }
    }

    /// The normal of the mesh at vertex `v`, its triangles weighted by their angle there; zero when it has none.
    pub(super) fn vertex_normal(&self, v: u32) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for &t in self.star(v) {
            let corners = self.triangles[t as usize];
            let Some(c) = corners.iter().position(|&corner| corner == v) else { continue };
            let [p, q, r] = [c, (c + 1) % 3, (c + 2) % 3].map(|c| self.positions[corners[c] as usize]);
            let (a, b) = (q - p, r - p);
            let cross = a.cross(b);
            sum += cross.normalize_or_zero() * libm::atan2(cross.length(), a.dot(b));
        }
        sum.normalize_or_zero()
    }

    /// What is around a patch, given the half-edge at each corner of its rim (`None`: a corner that is not of the mesh) and
    /// where it is clamped.
    pub(super) fn around(
        &self,
        half_edges: &[Option<u32>],
        is_clamped: Vec<bool>,
        budget: &Budget,
    ) -> Result<PatchSurroundings, Stopped> {
        let rim = half_edges.len();
        let corners = || half_edges.iter().enumerate().filter_map(|(i, h)| Some((i, self.corner((*h)?))));
        let mut number: FxHashMap<u32, u32> = FxHashMap::default();
        for (i, v) in corners() {
            // Of a place that is passed twice, the first corner stands for both.
            number.entry(v).or_insert(i as u32);
        }
        let mut own: Vec<u32> = Vec::new();
        for (_, v) in corners().filter(|&(i, _)| is_clamped[i]) {
            own.extend(self.star(v));
        }
        budget.spend(own.len() as u64 / 8 + 1)?;
        own.sort_unstable();
        own.dedup();
        let mut around = PatchSurroundings { is_clamped, ..PatchSurroundings::default() };
        for t in own {
            let corners = self.triangles[t as usize].map(|v| {
                *number.entry(v).or_insert_with(|| {
                    around.points.push(self.positions[v as usize]);
                    (rim + around.points.len() - 1) as u32
                })
            });
            around.triangles.push(corners);
        }
        Ok(around)
    }
}
