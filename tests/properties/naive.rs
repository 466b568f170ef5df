//! Counts of a soup straight from their definitions, with maps and no thought of speed.

use meshmend::analysis::{Counts, DefectCode, Properties};
use meshmend::mesh::{FaceFaultReason, Soup};
use std::collections::{BTreeMap, BTreeSet};

/// A position, as it is compared.
type Key = [u64; 3];

/// The triangles at each edge, and whether they run from its smaller end to the larger one.
type Edges = BTreeMap<(Key, Key), Vec<(usize, bool)>>;

/// A soup whose triangles name positions.
pub(crate) struct Naive<'s> {
    soup: &'s Soup,
    /// Triangles with three different positions, and their faces in the file.
    triangles: Vec<([Key; 3], u32)>,
    edges: Edges,
}

fn directed([a, b, c]: [Key; 3]) -> [(Key, Key); 3] {
    [(a, b), (b, c), (c, a)]
}

fn undirected((a, b): (Key, Key)) -> (Key, Key) {
    (a.min(b), a.max(b))
}

/// Joins everything that `pairs` join; a representative for each of `0..len`.
fn joined(len: usize, pairs: impl Iterator<Item = (usize, usize)>) -> Vec<usize> {
    let mut of: Vec<usize> = (0..len).collect();
    for (a, b) in pairs {
        let (from, to) = (of[a], of[b]);
        for x in &mut of {
            if *x == from {
                *x = to;
            }
        }
    }
    of
}

impl<'s> Naive<'s> {
    pub(crate) fn of(soup: &'s Soup) -> Self {
        let key =
            |v: u32| soup.positions[v as usize].to_array().map(|x| if x == 0.0 { 0 } else { x.to_bits() });
        let all =
            soup.triangles.iter().enumerate().map(|(t, corners)| (corners.map(key), soup.face_of(t as u32)));
        let triangles: Vec<_> = all.filter(|([a, b, c], _)| a != b && b != c && c != a).collect();
        let mut edges = Edges::new();
        for (t, (corners, _)) in triangles.iter().enumerate() {
            for edge in directed(*corners) {
                edges.entry(undirected(edge)).or_default().push((t, edge.0 < edge.1));
            }
        }
        Self { soup, triangles, edges }
    }

    fn positions(&self) -> BTreeSet<Key> {
        self.triangles.iter().flat_map(|(corners, _)| *corners).collect()
    }

    /// The part of each triangle.
    fn parts(&self) -> Vec<usize> {
        let pairs = self.edges.values().flat_map(|at| at.windows(2).map(|w| (w[0].0, w[1].0)));
        joined(self.triangles.len(), pairs)
    }

    fn edges_where(&self, is_meant: impl Fn(&[(usize, bool)]) -> bool) -> u64 {
        self.edges.values().filter(|at| is_meant(at)).count() as u64
    }

    fn open_parts(&self) -> BTreeSet<usize> {
        let parts = self.parts();
        self.edges.values().filter(|at| at.len() != 2).map(|at| parts[at[0].0]).collect()
    }

    pub(crate) fn counts(&self) -> Counts {
        let parts: BTreeSet<usize> = self.parts().into_iter().collect();
        Counts {
            vertices: self.soup.positions.len() as u64,
            faces: u64::from(self.soup.face_count),
            triangles: self.soup.triangles.len() as u64,
            welded_vertices: self.positions().len() as u64,
            edges: self.edges.len() as u64,
            components: parts.len() as u64,
            closed_components: (parts.len() - self.open_parts().len()) as u64,
            boundary_loops: self.boundary_loops(),
            boundary_edges: self.edges_where(|at| at.len() == 1),
        }
    }

    pub(crate) fn euler_characteristic(&self) -> i64 {
        self.positions().len() as i64 - self.edges.len() as i64 + self.triangles.len() as i64
    }

    pub(crate) fn properties(&self, is_embedded: Option<bool>) -> Properties {
        let runs_once = |at: &[(usize, bool)]| {
            at.iter().filter(|h| h.1).count() <= 1 && at.iter().filter(|h| !h.1).count() <= 1
        };
        Properties {
            is_closed: self.edges_where(|at| at.len() != 2) == 0,
            is_edge_manifold: self.edges_where(|at| at.len() > 2) == 0,
            is_vertex_manifold: self.singular_vertices() == 0,
            is_oriented: self.edges_where(|at| !runs_once(at)) == 0,
            is_embedded,
        }
    }

    /// The corners of all triangles, those joined that are at one position on two sides of an edge of two triangles.
    fn fans(&self) -> Vec<((usize, Key), usize)> {
        let corners: Vec<(usize, Key)> =
            self.triangles.iter().enumerate().flat_map(|(t, (at, _))| at.map(|p| (t, p))).collect();
        let index = |t: usize, p: Key| corners.iter().position(|&corner| corner == (t, p)).unwrap();
        let two = self.edges.iter().filter(|(_, at)| at.len() == 2);
        let pairs =
            two.flat_map(|(&(p, q), at)| [p, q].map(|end| (index(at[0].0, end), index(at[1].0, end))));
        let fans = joined(corners.len(), pairs.collect::<Vec<_>>().into_iter());
        corners.into_iter().zip(fans).collect()
    }

    fn singular_vertices(&self) -> u64 {
        let mut fans: BTreeMap<Key, BTreeSet<usize>> = BTreeMap::new();
        for ((_, position), fan) in self.fans() {
            fans.entry(position).or_default().insert(fan);
        }
        fans.values().filter(|fans| fans.len() > 1).count() as u64
    }

    /// Boundary edges are joined where they end in one fan. Where fans end at edges of three triangles or more, the
    /// ends left over at a position are joined in pairs, in the order of their triangles and of the edges in these.
    fn boundary_loops(&self) -> u64 {
        let mut boundary = Vec::new();
        for (t, (corners, _)) in self.triangles.iter().enumerate() {
            boundary.extend(
                directed(*corners)
                    .into_iter()
                    .filter(|&e| self.edges[&undirected(e)].len() == 1)
                    .map(|e| (t, e)),
            );
        }
        let fan_of: BTreeMap<(usize, Key), usize> = self.fans().into_iter().collect();
        let mut ends: BTreeMap<(Key, usize), Vec<usize>> = BTreeMap::new();
        for (i, &(t, (p, q))) in boundary.iter().enumerate() {
            for end in [p, q] {
                ends.entry((end, fan_of[&(t, end)])).or_default().push(i);
            }
        }
        let mut left_over: BTreeMap<Key, Vec<usize>> = BTreeMap::new();
        for ((position, _), at) in &ends {
            if let &[alone] = &at[..] {
                left_over.entry(*position).or_default().push(alone);
            }
        }
        left_over.values_mut().for_each(|at| at.sort_unstable());
        let in_fans = ends.values().filter(|at| at.len() == 2).map(|at| (at[0], at[1]));
        let across = left_over.values().flat_map(|at| at.chunks_exact(2).map(|pair| (pair[0], pair[1])));
        joined(boundary.len(), in_fans.chain(across)).into_iter().collect::<BTreeSet<_>>().len() as u64
    }

    /// Triangles beyond the first of their positions: in a direction that was there, and in one that was not.
    fn repeats(&self) -> [u64; 2] {
        let mut seen: BTreeMap<[Key; 3], BTreeSet<bool>> = BTreeMap::new();
        let mut repeats = [0, 0];
        for (corners, _) in &self.triangles {
            let mut sorted = *corners;
            sorted.sort_unstable();
            let [a, b, _] = sorted;
            let is_even = directed(*corners).contains(&(a, b));
            let directions = seen.entry(sorted).or_default();
            if !directions.is_empty() {
                repeats[usize::from(!directions.contains(&is_even))] += 1;
            }
            directions.insert(is_even);
        }
        repeats
    }

    /// Parts for which no choice of turned triangles makes all agree, by trying from one triangle on.
    fn twisted_parts(&self) -> u64 {
        let parts = self.parts();
        let mut side: Vec<Option<bool>> = vec![None; self.triangles.len()];
        let mut twisted = BTreeSet::new();
        let two: Vec<_> = self.edges.values().filter(|at| at.len() == 2).collect();
        for start in 0..self.triangles.len() {
            let mut waiting = vec![(start, false)];
            while side[start].is_none() || !waiting.is_empty() {
                let Some((t, is_turned)) = waiting.pop() else { break };
                if side[t].is_some() {
                    continue;
                }
                side[t] = Some(is_turned);
                for at in two.iter().filter(|at| at.iter().any(|h| h.0 == t)) {
                    let other = if at[0].0 == t { at[1].0 } else { at[0].0 };
                    let wanted = is_turned ^ (at[0].1 == at[1].1);
                    match side[other] {
                        None => waiting.push((other, wanted)),
                        Some(is) if is != wanted => drop(twisted.insert(parts[t])),
                        Some(_) => {}
                    }
                }
            }
        }
        twisted.len() as u64
    }

    fn lone_faces(&self) -> u64 {
        let parts = self.parts();
        let mut faces: BTreeMap<usize, BTreeSet<u32>> = BTreeMap::new();
        for (t, (_, face)) in self.triangles.iter().enumerate() {
            faces.entry(parts[t]).or_default().insert(*face);
        }
        faces.values().filter(|faces| faces.len() == 1).count() as u64
    }

    /// Isolated and duplicate vertices of an indexed file.
    fn vertices(&self) -> [u64; 2] {
        if self.soup.is_welded_by_format {
            return [0, 0];
        }
        let used: BTreeSet<u32> = self.soup.triangles.iter().flatten().copied().collect();
        let is_loose = |v: &u32| !used.contains(v) && self.soup.positions[*v as usize].is_finite();
        let isolated = (0..self.soup.positions.len() as u32).filter(is_loose).count();
        let positions: BTreeSet<[u64; 3]> = used
            .iter()
            .map(|&v| self.soup.positions[v as usize].to_array().map(|x| (x + 0.0).to_bits()))
            .collect();
        [isolated as u64, (used.len() - positions.len()) as u64]
    }

    /// How often each defect that needs no geometry is there.
    pub(crate) fn defects(&self) -> Vec<(DefectCode, u64)> {
        use DefectCode as D;
        let faults = |reason| self.soup.face_faults.iter().filter(|f| f.reason == reason).count() as u64;
        let [duplicate, opposite] = self.repeats();
        let [isolated, doubled] = self.vertices();
        vec![
            (D::NoTriangle, u64::from(self.triangles.is_empty())),
            (D::NonFiniteVertex, self.soup.positions.iter().filter(|p| !p.is_finite()).count() as u64),
            (D::NonFiniteFace, faults(FaceFaultReason::NonFinite)),
            (D::IndexOutOfRange, faults(FaceFaultReason::IndexOutOfRange)),
            (D::TooFewCorners, faults(FaceFaultReason::TooFewCorners)),
            (D::CoincidentCorners, (self.soup.triangles.len() - self.triangles.len()) as u64),
            (D::DuplicateFace, duplicate),
            (D::OppositeDuplicateFace, opposite),
            (D::IsolatedVertex, isolated),
            (D::DuplicateVertex, doubled),
            (D::IsolatedFace, self.lone_faces()),
            (D::BoundaryLoop, self.boundary_loops()),
            (D::NonManifoldEdge, self.edges_where(|at| at.len() > 2)),
            (D::NonManifoldVertex, self.singular_vertices()),
            (D::OrientationConflict, self.edges_where(|at| at.len() == 2 && at[0].1 == at[1].1)),
            (D::NonOrientable, self.twisted_parts()),
        ]
    }
}
