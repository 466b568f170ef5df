//! Takes out new vertices that have come together.
//!
//! A patch is divided while it is still the triangulation of its rim, which may be folded and so larger than the smooth
//! surface that it becomes. Where that has no room for all new vertices, they end in one point or on one line, and their
//! triangles have no area. Edges that became too short are collapsed, as far as the patch stays a surface.

use super::patch::{PatchMesh, listed_by};
use super::refine::Lengths;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::are_collinear;
use crate::mesh::triangle_of;

/// An edge is collapsed when it is shorter than this share of the length wanted at its ends. Division makes none that is
/// shorter than two thirds.
const SHORT: f64 = 0.25;
/// Passes over all edges, at most; a pass collapses no two edges that are near each other.
const PASSES_MAX: usize = 24;

/// Collapses edges that are too short; `false` when there was none to collapse. `is_free(a, b)` says whether there may be
/// an edge between two corners of the rim.
pub(super) fn coarsen(
    mesh: &mut PatchMesh,
    lengths: &mut Lengths,
    is_free: &dyn Fn(u32, u32) -> bool,
    budget: &Budget,
) -> Result<bool, Stopped> {
    let mut has_changed = false;
    for _ in 0..PASSES_MAX {
        let short = short_edges(mesh, lengths, budget)?;
        if short.is_empty() {
            break;
        }
        let pass = Pass::new(mesh, is_free);
        let into = pass.choose(&short, budget)?;
        let is_kept: Vec<bool> = (0u32..).zip(&into).map(|(v, &to)| v == to).collect();
        if is_kept.iter().all(|&is_kept| is_kept) {
            break;
        }
        let Some(coarser) = collapsed(mesh, &into) else { break };
        *mesh = coarser;
        lengths.keep(&is_kept);
        has_changed = true;
    }
    Ok(has_changed)
}

/// The edges to collapse with their lengths, the shortest first.
fn short_edges(
    mesh: &PatchMesh,
    lengths: &Lengths,
    budget: &Budget,
) -> Result<Vec<(f64, [u32; 2])>, Stopped> {
    let mut short = Vec::new();
    for h in 0..3 * mesh.triangles.len() as u32 {
        if h.is_multiple_of(CHECK_EVERY as u32) {
            budget.spend(CHECK_EVERY as u64 / 16)?;
        }
        let [a, b] = mesh.ends(h);
        let is_first = mesh.twin(h).is_some_and(|twin| h < twin);
        let is_new = (a.max(b) as usize) >= mesh.rim;
        if is_first && is_new && lengths.is_below(SHORT, mesh, [a, b]) {
            short.push((mesh.point(a).distance_squared(mesh.point(b)), [a, b]));
        }
    }
    short.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    Ok(short)
}

/// What is asked of a mesh before an edge of it is collapsed.
struct Pass<'a> {
    mesh: &'a PatchMesh,
    is_free: &'a dyn Fn(u32, u32) -> bool,
    /// The neighbours of each vertex: where those of each begin, and all of them.
    start: Vec<u32>,
    others: Vec<u32>,
    /// The corners at each vertex, likewise: three times the number of a triangle, plus the place in it.
    corners_start: Vec<u32>,
    corners: Vec<u32>,
}

impl<'a> Pass<'a> {
    fn new(mesh: &'a PatchMesh, is_free: &'a dyn Fn(u32, u32) -> bool) -> Self {
        let (start, others) = mesh.neighbours();
        let vertices = mesh.triangles.as_flattened();
        let (corners_start, corners) =
            listed_by(mesh.points.len(), vertices.len() as u32, |corner| vertices[corner as usize]);
        Self { mesh, is_free, start, others, corners_start, corners }
    }

    fn neighbours(&self, v: u32) -> &[u32] {
        &self.others[self.start[v as usize] as usize..self.start[v as usize + 1] as usize]
    }

    /// The triangles at vertex `v`, ascending.
    fn star(&self, v: u32) -> impl Iterator<Item = u32> {
        let [first, end] = [v, v + 1].map(|v| self.corners_start[v as usize] as usize);
        self.corners[first..end].iter().map(|&corner| triangle_of(corner))
    }

    /// For each vertex the one that it becomes. Around an edge that is collapsed nothing else is.
    fn choose(&self, short: &[(f64, [u32; 2])], budget: &Budget) -> Result<Vec<u32>, Stopped> {
        let mut into: Vec<u32> = (0..self.mesh.points.len() as u32).collect();
        let mut is_locked = vec![false; into.len()];
        for &(_, [a, b]) in short {
            // The later one goes, so that what was born between others stays later than they are.
            let (gone, kept) = (a.max(b), a.min(b));
            let around = || self.neighbours(gone).iter().chain(self.neighbours(kept));
            budget.spend(around().count() as u64 / 8 + 1)?;
            if around().any(|&v| is_locked[v as usize]) || !self.may_become(gone, kept) {
                continue;
            }
            around().for_each(|&v| is_locked[v as usize] = true);
            into[gone as usize] = kept;
        }
        Ok(into)
    }

    /// Whether the patch stays a surface, without a new edge or flat triangle between corners of the rim, when new vertex
    /// `gone` becomes its neighbour `kept`. Link condition (Dey and others 1998) for an edge inside: two common neighbours.
    fn may_become(&self, gone: u32, kept: u32) -> bool {
        let mut near = self.neighbours(kept).to_vec();
        near.sort_unstable();
        let is_common = |v: &u32| near.binary_search(v).is_ok();
        if self.neighbours(gone).iter().filter(|&v| is_common(v)).count() != 2 {
            return false;
        }
        let is_of_rim = |v: u32| (v as usize) < self.mesh.rim;
        if !is_of_rim(kept) {
            return true;
        }
        let mut gained =
            self.neighbours(gone).iter().filter(|&&v| v != kept && is_of_rim(v) && !is_common(&v));
        let is_sound = |t: u32| {
            let corners = self.mesh.triangles[t as usize];
            let turned = corners.map(|v| if v == gone { kept } else { v });
            let [p, q, r] = turned.map(|v| self.mesh.point(v));
            corners.contains(&kept) || !turned.into_iter().all(is_of_rim) || !are_collinear(p, q, r)
        };
        gained.all(|&v| (self.is_free)(kept, v)) && self.star(gone).all(is_sound)
    }
}

/// The mesh in which each vertex `v` is `into[v]`; `None` when that is no patch.
fn collapsed(mesh: &PatchMesh, into: &[u32]) -> Option<PatchMesh> {
    let mut number = vec![u32::MAX; into.len()];
    let (mut points, mut parents) = (Vec::new(), Vec::new());
    for v in (0..into.len()).filter(|&v| into[v] as usize == v) {
        number[v] = points.len() as u32;
        points.push(mesh.points[v]);
        // A parent that is gone is stood for by its own.
        let kept = |mut parent: u32| {
            while into[parent as usize] != parent {
                parent = mesh.parents[parent as usize - mesh.rim][0];
            }
            number[parent as usize]
        };
        if v >= mesh.rim {
            parents.push(mesh.parents[v - mesh.rim].map(kept));
        }
    }
    let corners = mesh.triangles.iter().map(|t| t.map(|v| number[into[v as usize] as usize]));
    let is_whole = |&[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    let mut coarser = PatchMesh::new(points, corners.filter(is_whole).collect())?;
    (coarser.rim, coarser.parents) = (mesh.rim, parents);
    Some(coarser)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    /// A square of four corners whose middle is a knot: a vertex on the diagonal, around which others were born.
    fn knotted(knots: u32) -> PatchMesh {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let mut mesh = PatchMesh::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap();
        for _ in 0..knots {
            let newest = mesh.points.len() as u32 - 1;
            let h = (0..3 * mesh.triangles.len() as u32)
                .find(|&h| mesh.twin(h).is_some() && (newest < 4 || mesh.ends(h)[0] == newest))
                .unwrap();
            mesh.split(h, DVec3::new(0.5, 0.5, 0.0)).unwrap();
        }
        mesh
    }

    #[test]
    fn vertices_at_one_place_become_one() {
        let mut mesh = knotted(12);
        let mut lengths = Lengths::of_rim(&mesh, &[1, 2, 3, 0]);
        (0..12).for_each(|_| lengths.push(0.5));
        assert!(coarsen(&mut mesh, &mut lengths, &|_, _| true, &Budget::unlimited()).unwrap());
        assert_eq!(mesh.check(), Vec::<String>::new());
        assert_eq!((mesh.rim, mesh.points.len(), mesh.triangles.len()), (4, 5, 4));
        assert_eq!(mesh.parents.len(), 1);
        assert!(mesh.parents[0].iter().all(|&v| v < 4), "{:?}", mesh.parents);
        assert!(!coarsen(&mut mesh, &mut lengths, &|_, _| true, &Budget::unlimited()).unwrap());
    }

    #[test]
    fn a_vertex_does_not_become_a_corner_where_that_would_double_an_edge_of_the_mesh() {
        let mut mesh = knotted(1);
        mesh.points[4] = DVec3::new(1e-3, 1e-3, 0.0);
        let mut lengths = Lengths::of_rim(&mesh, &[1, 2, 3, 0]);
        lengths.push(0.5);
        let budget = Budget::unlimited();
        assert!(!coarsen(&mut mesh, &mut lengths, &|_, _| false, &budget).unwrap());
        assert!(coarsen(&mut mesh, &mut lengths, &|_, _| true, &budget).unwrap());
        assert_eq!((mesh.check(), mesh.points.len(), mesh.triangles.len()), (Vec::new(), 4, 2));
    }
}
