//! Boundary loops: closed walks along edges of one triangle that pass each place once.

use super::{EdgeGroups, edge_of};
use crate::budget::{Budget, CHECK_EVERY, Stopped};

/// A boundary loop as its half-edges, in the direction of the patch that would close it. The half-edges themselves run
/// against that direction: corner `i` of the loop is where half-edge `i` goes to.
pub type BoundaryLoop = Vec<u32>;

/// The boundary of a mesh.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Boundary {
    /// Each with at least two edges.
    pub loops: Vec<BoundaryLoop>,
    /// Boundary edges that are in no loop, because the walk ends where directions or more than two triangles meet.
    pub stray_edges: u64,
}

/// No step on the walk.
const NOWHERE: u32 = u32::MAX;

impl Boundary {
    /// Traces all boundary edges of `triangles`. Where several loops meet in a vertex, the walk is parted there, so that
    /// each passes it once.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn trace(
        triangles: &[[u32; 3]],
        vertex_count: usize,
        groups: &EdgeGroups,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let half_edges: Vec<u32> =
            groups.iter().filter_map(|group| if let [h] = *group { Some(h) } else { None }).collect();
        let edges = by_start(triangles, vertex_count, &half_edges);
        let mut walk = EdgeWalk::new(&edges, vertex_count);
        for (i, (ends, _)) in edges.iter().enumerate() {
            if i % CHECK_EVERY == 0 {
                budget.check()?;
            }
            walk.from(ends[0]);
        }
        Ok(walk.boundary)
    }
}

/// The half-edges, each with its ends the other way around, in the order of where they then start.
fn by_start(triangles: &[[u32; 3]], vertex_count: usize, half_edges: &[u32]) -> Vec<([u32; 2], u32)> {
    let reversed = |h: u32| {
        let [from, to] = edge_of(triangles, h);
        [to, from]
    };
    let mut slot = vec![0u32; vertex_count + 1];
    for &h in half_edges {
        slot[reversed(h)[0] as usize + 1] += 1;
    }
    for v in 0..vertex_count {
        slot[v + 1] += slot[v];
    }
    let mut edges = vec![([0, 0], 0); half_edges.len()];
    for &h in half_edges {
        let ends = reversed(h);
        edges[slot[ends[0] as usize] as usize] = (ends, h);
        slot[ends[0] as usize] += 1;
    }
    edges
}

/// A walk over directed edges, each taken once.
struct EdgeWalk<'a> {
    /// Ends (from, to) and half-edge, ascending by from.
    edges: &'a [([u32; 2], u32)],
    /// Next edge to take at each vertex.
    next: Vec<u32>,
    /// Where on the path each vertex is.
    step_of: Vec<u32>,
    /// Edges taken and not yet part of a loop, each from where the one before ends.
    path: Vec<u32>,
    boundary: Boundary,
}

impl<'a> EdgeWalk<'a> {
    fn new(edges: &'a [([u32; 2], u32)], vertex_count: usize) -> Self {
        let mut next = vec![NOWHERE; vertex_count];
        for (i, (ends, _)) in edges.iter().enumerate().rev() {
            next[ends[0] as usize] = i as u32;
        }
        Self {
            edges,
            next,
            step_of: vec![NOWHERE; vertex_count],
            path: Vec::new(),
            boundary: Boundary::default(),
        }
    }

    /// Takes an edge that leaves `v`, if there is one left.
    fn take(&mut self, v: u32) -> Option<u32> {
        let i = self.next[v as usize];
        let (ends, _) = self.edges.get(i as usize)?;
        if ends[0] != v {
            return None;
        }
        self.next[v as usize] += 1;
        Some(i)
    }

    /// Walks from `start` until no edge leaves the vertex it has come to.
    fn from(&mut self, start: u32) {
        let mut at = start;
        while let Some(edge) = self.take(at) {
            self.step_of[at as usize] = self.path.len() as u32;
            self.path.push(edge);
            at = self.edges[edge as usize].0[1];
            if self.step_of[at as usize] != NOWHERE {
                self.close(self.step_of[at as usize] as usize);
            }
        }
        self.boundary.stray_edges += self.path.len() as u64;
        self.forget(0);
    }

    /// The path from `step` on is a loop.
    fn close(&mut self, step: usize) {
        self.boundary.loops.push(self.path[step..].iter().map(|&i| self.edges[i as usize].1).collect());
        self.forget(step);
    }

    /// Leaves the path from `step` on.
    fn forget(&mut self, step: usize) {
        for &i in &self.path[step..] {
            self.step_of[self.edges[i as usize].0[0] as usize] = NOWHERE;
        }
        self.path.truncate(step);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trace(triangles: &[[u32; 3]], vertex_count: usize) -> Boundary {
        let budget = Budget::unlimited();
        let groups = EdgeGroups::build(triangles, vertex_count, &budget).unwrap();
        Boundary::trace(triangles, vertex_count, &groups, &budget).unwrap()
    }

    fn corners(triangles: &[[u32; 3]], boundary: &Boundary) -> Vec<Vec<u32>> {
        boundary.loops.iter().map(|l| l.iter().map(|&h| edge_of(triangles, h)[1]).collect()).collect()
    }

    #[test]
    fn the_loop_of_a_triangle_runs_against_it() {
        let mesh = [[0, 1, 2]];
        assert_eq!(corners(&mesh, &trace(&mesh, 3)), [[0, 2, 1]]);
    }

    #[test]
    fn a_closed_mesh_has_no_loop() {
        assert_eq!(trace(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], 4), Boundary::default());
    }

    #[test]
    fn two_triangles_that_meet_in_a_vertex_have_a_loop_each() {
        let mesh = [[0, 1, 2], [0, 3, 4]];
        assert_eq!(corners(&mesh, &trace(&mesh, 5)), [[0, 2, 1], [0, 4, 3]]);
    }

    #[test]
    fn edges_that_lead_nowhere_are_counted() {
        // Neighbours in the same direction: the walk around them finds two edges into 1 and two out of 0.
        let boundary = trace(&[[0, 1, 2], [0, 1, 3]], 4);
        assert_eq!((boundary.loops.len(), boundary.stray_edges), (0, 4));
    }
}
