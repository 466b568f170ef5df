//! Divides boundary edges where vertices of another boundary lie beside them, so that both sides of a crack have the same
//! vertices.
//!
//! ```text
//!     a-----------b-----------c              a----u--b--v------w--c
//!        u        v        w       gives     a----u--b--v------w--c
//! ```
//!
//! No vertex moves: an edge that is divided goes through the vertex beside it.

use super::ManifoldRim;
use super::beside::{Flank, NEAR_MAX, flank_of, vertex_beside};
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::{ChosenEdges, triangle_of};
use crate::repair::{Draft, VertexBeside};
use crate::spatial::Bvh;

/// What was divided.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct DivisionSummary {
    pub(super) edges: u64,
    pub(super) triangles: u64,
    /// Largest distance of a vertex from the edge that goes through it now, in the unit of the file.
    pub(super) move_max: f64,
}

/// Boundary half-edges, to be found by vertices beside them.
pub(super) struct RimSearch<'a> {
    positions: &'a [DVec3],
    triangles: &'a [[u32; 3]],
    half_edges: &'a [u32],
    /// The half-edges at each vertex, ascending by vertex.
    at_vertices: Vec<(u32, u32)>,
    bvh: Bvh,
}

/// A vertex beside a half-edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside {
    pub(super) half_edge: u32,
    /// Its distance from the half-edge, in the unit of the file.
    pub(super) apart: f64,
}

impl<'a> RimSearch<'a> {
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn of(
        positions: &'a [DVec3],
        triangles: &'a [[u32; 3]],
        half_edges: &'a [u32],
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        // An edge is searched as the triangle that is folded onto it.
        let folded = |&h: &u32| {
            let [a, b, _] = flank_of(triangles, h);
            [a, b, b]
        };
        let edges: Vec<[u32; 3]> = half_edges.iter().map(folded).collect();
        let bvh = Bvh::build(positions, &edges, None, budget)?;
        let mut at_vertices: Vec<(u32, u32)> =
            half_edges.iter().zip(&edges).flat_map(|(&h, &[a, b, _])| [(a, h), (b, h)]).collect();
        at_vertices.sort_unstable();
        Ok(Self { positions, triangles, half_edges, at_vertices, bvh })
    }

    /// The vertices with their half-edges.
    pub(super) fn vertices(&self) -> impl Iterator<Item = (u32, &[(u32, u32)])> {
        self.at_vertices.chunk_by(|a, b| a.0 == b.0).map(|own| (own[0].0, own))
    }

    fn flank(&self, h: u32) -> Flank {
        flank_of(self.triangles, h).map(|v| self.positions[v as usize])
    }

    /// Of the half-edges that `may_divide` allows, the one nearest to a vertex with these half-edges of its own that it lies
    /// beside within `most`, and farther than `off_ends` of the edge from its ends.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn nearest_beside(
        &self,
        v: u32,
        own: &[(u32, u32)],
        most: f64,
        off_ends: impl Fn(Flank) -> f64,
        may_divide: impl Fn(u32) -> bool,
        budget: &Budget,
    ) -> Result<Option<Beside>, Stopped> {
        let place = self.positions[v as usize];
        let reach = DVec3::splat(most);
        let around = Aabb::of([place - reach, place + reach]);
        let mut near = Vec::new();
        let is_crowded = self.bvh.any_in_box(around, budget, |e| {
            near.push(self.half_edges[e as usize]);
            near.len() > NEAR_MAX
        })?;
        budget.spend(near.len() as u64)?;
        if is_crowded {
            return Ok(None);
        }
        let own: Vec<Flank> = own.iter().map(|&(_, h)| self.flank(h)).collect();
        let beside = near.into_iter().filter(|&h| may_divide(h)).filter_map(|half_edge| {
            let edge = self.flank(half_edge);
            let apart = vertex_beside(place, &own, edge, most, off_ends(edge))?;
            Some(Beside { half_edge, apart })
        });
        Ok(beside.min_by(|a, b| a.apart.total_cmp(&b.apart).then(a.half_edge.cmp(&b.half_edge))))
    }
}

/// For each boundary loop, whether it is a slit: all but without area for its length and `width`. What closes it needs no
/// vertex elsewhere.
pub(super) fn slits(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    loops: impl Iterator<Item = impl Iterator<Item = u32>>,
    width: f64,
) -> Vec<bool> {
    let is_slit = |half_edges: &mut dyn Iterator<Item = u32>| {
        let mut half_edges = half_edges.map(|h| {
            let [from, to, _] = flank_of(triangles, h);
            [positions[from as usize], positions[to as usize]]
        });
        let Some([origin, next]) = half_edges.next() else { return true };
        let first = (DVec3::ZERO, origin.distance(next));
        let (area, length) = half_edges.fold(first, |(area, length), [from, to]| {
            (area + (from - origin).cross(to - origin) / 2.0, length + from.distance(to))
        });
        area.length() <= width * length
    };
    loops.map(|mut half_edges| is_slit(&mut half_edges)).collect()
}

/// Divides the half-edges of a rim at the vertices of other boundaries, or of another side of one that is no slit, that lie
/// beside them within `epsilon`, each at a new vertex there. The draft must be a manifold.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn divide_beside(
    draft: &mut Draft,
    rim: &ManifoldRim,
    epsilon: f64,
    chosen: &ChosenEdges,
    budget: &Budget,
) -> Result<DivisionSummary, Stopped> {
    let search = RimSearch::of(&draft.positions, &draft.triangles, &rim.half_edges, budget)?;
    let is_slit = rim.slits(draft, epsilon);
    let mut inside: Vec<InnerVertex> = Vec::new();
    for (v, own) in search.vertices() {
        let may_divide = |h: u32| {
            let ends = flank_of(&draft.triangles, h);
            rim.loop_of(h).is_some_and(|of| rim.loop_of(own[0].1) != Some(of) || !is_slit[of as usize])
                && !chosen.contains([ends[0], ends[1]].map(|v| draft.vertex_origin[v as usize]))
        };
        if let Some(Beside { half_edge, apart }) =
            search.nearest_beside(v, own, epsilon, |_| epsilon, may_divide, budget)?
        {
            let [from, to, _] = search.flank(half_edge);
            let along = (draft.positions[v as usize] - from).dot((to - from).normalize_or_zero());
            inside.push(InnerVertex { half_edge, along, v, apart });
        }
    }
    inside.sort_unstable_by(|a, b| {
        a.half_edge.cmp(&b.half_edge).then(a.along.total_cmp(&b.along)).then(a.v.cmp(&b.v))
    });
    // Of two that are all but at one place, one is enough.
    inside.dedup_by(|next, last| {
        next.half_edge == last.half_edge && next.along - last.along <= 2.0 * next.apart.max(last.apart)
    });
    let mut divided = DivisionSummary::default();
    for of_triangle in inside.chunk_by(|a, b| triangle_of(a.half_edge) == triangle_of(b.half_edge)) {
        budget.spend(of_triangle.len() as u64)?;
        let beside = |&InnerVertex { half_edge, v, .. }: &InnerVertex| VertexBeside {
            half_edge,
            place: draft.positions[v as usize],
            like: v,
        };
        let inside: Vec<VertexBeside> = of_triangle.iter().map(beside).collect();
        if draft.divide_beside(triangle_of(of_triangle[0].half_edge), inside) {
            divided.triangles += 1;
            divided.edges += of_triangle.chunk_by(|a, b| a.half_edge == b.half_edge).count() as u64;
            divided.move_max = of_triangle.iter().fold(divided.move_max, |most, at| most.max(at.apart));
        }
    }
    Ok(divided)
}

/// A vertex beside a half-edge, and where along it.
struct InnerVertex {
    half_edge: u32,
    along: f64,
    v: u32,
    apart: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squares from y = 0 down to -1 between these places along x, and squares from y = `gap` up to 1 between others.
    fn strips(below: &[f64], above: &[f64], gap: f64) -> Draft {
        let mut points = Vec::new();
        let mut triangles = Vec::new();
        for (xs, near, far) in [(below, 0.0, -1.0), (above, gap, 1.0)] {
            let first = points.len() as u32;
            points.extend(xs.iter().flat_map(|&x| [[x, near, 0.0], [x, far, 0.0]]));
            for k in 0..xs.len() as u32 - 1 {
                let [a, b, c, d] = [0, 1, 2, 3].map(|corner| first + 2 * k + corner);
                triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
        Draft::of(&points, &triangles)
    }

    fn divided(draft: &mut Draft, epsilon: f64) -> DivisionSummary {
        let budget = Budget::unlimited();
        let rim = ManifoldRim::of(draft, &budget).unwrap();
        let divided = divide_beside(draft, &rim, epsilon, &ChosenEdges::default(), &budget).unwrap();
        assert_eq!(draft.check(), Vec::<String>::new());
        divided
    }

    /// The places along x of the vertices within 0.1 of y = 0 that triangles below or above have.
    fn places(draft: &Draft, is_below: bool) -> Vec<f64> {
        let of_side = (0..draft.triangles.len())
            .filter(|&t| (draft.corners(t).iter().map(|p| p.y).sum::<f64>() < 0.0) == is_below);
        let mut places: Vec<f64> =
            of_side.flat_map(|t| draft.corners(t)).filter(|p| p.y.abs() < 0.1).map(|p| p.x).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    }

    #[test]
    fn both_sides_have_all_vertices_afterwards() {
        for gap in [1e-9, 1e-3, 0.01] {
            let mut draft = strips(&[0.0, 1.0, 2.0, 3.0], &[0.0, 0.5, 1.4, 2.2, 3.0], gap);
            let divided = divided(&mut draft, 2.0 * gap);
            assert_eq!((divided.edges, divided.triangles), (5, 5), "{gap}");
            assert!((divided.move_max / gap - 1.0).abs() < 1e-6, "{gap}: {divided:?}");
            let all = [0.0, 0.5, 1.0, 1.4, 2.0, 2.2, 3.0];
            assert_eq!([places(&draft, true), places(&draft, false)], [all, all], "{gap}");
        }
    }

    #[test]
    fn vertices_beyond_epsilon_or_beside_an_end_divide_nothing() {
        let before = strips(&[0.0, 1.0, 2.0], &[0.0, 0.5, 2.0], 0.01);
        let mut draft = before.clone();
        assert_eq!((divided(&mut draft, 0.009), draft == before), (DivisionSummary::default(), true));
        let before = strips(&[0.0, 1.0, 2.0], &[0.0, 1.001, 2.0], 0.01);
        let mut draft = before.clone();
        assert_eq!((divided(&mut draft, 0.02), draft == before), (DivisionSummary::default(), true));
    }

    #[test]
    fn a_triangle_of_which_a_part_would_turn_stays() {
        let before = strips(&[0.0, 2.0], &[0.0, 0.5, 2.0], 0.01);
        let mut flat = before.clone();
        // Nearly as flat as the gap is wide.
        flat.positions[1].y = -0.02;
        flat.positions[3].y = -0.02;
        let mut draft = flat.clone();
        assert_eq!((divided(&mut draft, 0.02), draft == flat), (DivisionSummary::default(), true));
        let mut draft = before.clone();
        assert_eq!(divided(&mut draft, 0.02).edges, 1);
    }

    #[test]
    fn a_slit_is_left_to_be_closed() {
        // A square of four triangles around its middle, and a vertex beside the middle of one of its inner edges.
        let points = [
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [4.0, 4.0, 0.0],
            [0.0, 4.0, 0.0],
            [2.0, 2.0, 0.0],
            [1.0, 1.001, 0.0],
        ];
        let triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 5], [3, 5, 4]];
        let before = Draft::of(&points, &triangles);
        let rim = ManifoldRim::of(&before, &Budget::unlimited()).unwrap();
        assert_eq!(rim.slits(&before, 0.002), [false, true]);
        let mut draft = before.clone();
        assert_eq!((divided(&mut draft, 0.002), draft == before), (DivisionSummary::default(), true));
    }
}
