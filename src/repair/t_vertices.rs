//! Divides triangles at boundary vertices that lie exactly inside their boundary edges, so that a crack without width
//! closes. No vertex moves.
//!
//! ```text
//!         c                     c
//!        / \                   /|\
//!       /   \                 / | \
//!      a-----b      gives    a--m--b      a-b was one boundary edge, a-m and m-b two others
//!      a--m--b               |  |  |
//!      |  |  |
//! ```

use super::{Changes, Draft};
use crate::budget::{Budget, Charge, Stopped};
use crate::geom::{are_collinear, is_on_segment};
use crate::mesh::{divide, edge_of, prev_corner, triangle_of};
use crate::spatial::Bvh;

/// Divides at every boundary vertex inside a boundary edge; of several at one place, where the draft is not welded, at the
/// first. Collinear triangles are left alone.
///
/// # Errors
/// When the budget stops the run.
pub fn split_t_vertices(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let boundary = boundary_half_edges(draft, budget)?;
    let VerticesInside { pairs: inside, _charges } = vertices_inside(draft, &boundary, budget)?;
    let polygons = split_polygons_of(draft, &inside);
    let split = replace(draft, &inside, budget)?;
    let changes = Changes::counted([("edges_divided", count_edges(&inside)), ("triangles_split", split)]);
    if polygons == 0 {
        return Ok(changes);
    }
    let reason = format!("{polygons} polygons with vertices inside their edges became triangles");
    Ok(Changes { counts: [changes.counts, vec![("polygons_split", polygons)]].concat(), reason, ..changes })
}

/// Makes triangles of the polygons of which an edge is to be divided: split as a fan, as many programs do, one with a
/// corner inside of an edge would have a triangle without area. Gives their number.
fn split_polygons_of(draft: &mut Draft, inside: &[(u32, u32)]) -> u64 {
    inside.iter().map(|&(h, _)| u64::from(draft.polygons.split(triangle_of(h) as usize))).sum()
}

/// The half-edges with one triangle, or with copies of one.
fn boundary_half_edges(draft: &Draft, budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let groups = draft.edge_groups(budget)?;
    let third = |h: u32| edge_of(&draft.triangles, prev_corner(h))[0];
    let is_boundary = |group: &&[u32]| group.iter().all(|&h| third(h) == third(group[0]));
    let is_proper = |h: &u32| {
        let [a, b, c] = draft.corners(*h as usize / 3);
        !are_collinear(a, b, c)
    };
    Ok(groups.iter().filter(is_boundary).flatten().copied().filter(is_proper).collect())
}

/// Units of work for a vertex that is compared with an edge.
const COMPARING: u64 = 8;

/// Bytes for a vertex inside an edge: its place in the list, and the triangle that it makes.
const BYTES_OF_INSIDE: u64 = 48;

/// So many vertices inside edges are charged before more are looked for.
const CHARGED_AT_ONCE: usize = 1 << 12;

/// Boundary half-edges with the vertices inside them, by half-edge, then in its direction. Edges that lie on each other have the
/// square of their number, so they are charged.
struct VerticesInside<'b> {
    pairs: Vec<(u32, u32)>,
    _charges: Vec<Charge<'b>>,
}

fn vertices_inside<'b>(
    draft: &Draft,
    boundary: &[u32],
    budget: &'b Budget,
) -> Result<VerticesInside<'b>, Stopped> {
    let edges: Vec<[u32; 2]> = boundary.iter().map(|&h| edge_of(&draft.triangles, h)).collect();
    let mut vertices: Vec<u32> = edges.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    // A vertex is searched as the triangle that is folded onto it.
    let points: Vec<[u32; 3]> = vertices.iter().map(|&v| [v; 3]).collect();
    let bvh = Bvh::build(&draft.positions, &points, None, budget)?;
    let (mut inside, mut charges) = (Vec::new(), Vec::new());
    for (&h, edge) in boundary.iter().zip(edges) {
        let [from, to] = edge.map(|v| draft.positions[v as usize]);
        let mut compared = 0;
        bvh.visit_segment([from, to], budget, |found| {
            compared += 1;
            let v = vertices[found as usize];
            let p = draft.positions[v as usize];
            // By place: where vertices at one place stay apart, that of another is no vertex inside.
            if p != from && p != to && is_on_segment(p, from, to) {
                inside.push((h, v));
            }
            true
        })?;
        budget.spend(COMPARING * compared)?;
        while inside.len() > charges.len() * CHARGED_AT_ONCE {
            charges.push(budget.charge(BYTES_OF_INSIDE * CHARGED_AT_ONCE as u64)?);
        }
    }
    sort_along_edges(&mut inside, draft);
    inside.dedup_by(|(h, v), (g, u)| g == h && draft.positions[*u as usize] == draft.positions[*v as usize]);
    Ok(VerticesInside { pairs: inside, _charges: charges })
}

/// Sorts by half-edge, then along it, then by vertex. On a line, coordinates in the order x, y, z say where a point is.
fn sort_along_edges(inside: &mut [(u32, u32)], draft: &Draft) {
    let place = |v: u32| draft.positions[v as usize].to_array();
    inside.sort_unstable_by(|&(g, u), &(h, v)| {
        let [from, to] = edge_of(&draft.triangles, g);
        let (near, far) = if place(from) < place(to) { (u, v) } else { (v, u) };
        let along = || place(near).partial_cmp(&place(far)).unwrap_or(std::cmp::Ordering::Equal);
        g.cmp(&h).then_with(along).then(u.cmp(&v))
    });
}

fn count_edges(inside: &[(u32, u32)]) -> u64 {
    inside.chunk_by(|a, b| a.0 == b.0).count() as u64
}

/// Divides the triangles of the half-edges; gives their number. Parts take the place of the triangle and of new ones.
fn replace(draft: &mut Draft, inside: &[(u32, u32)], budget: &Budget) -> Result<u64, Stopped> {
    let mut split = 0;
    for of_triangle in inside.chunk_by(|a, b| a.0 / 3 == b.0 / 3) {
        budget.spend(of_triangle.len() as u64)?;
        let t = of_triangle[0].0 / 3;
        let on = [0, 1, 2].map(|c| {
            of_triangle.iter().filter(|&&(h, _)| h == 3 * t + c).map(|&(_, v)| v).collect::<Vec<u32>>()
        });
        let parts = divide(draft.triangles[t as usize], on.each_ref().map(Vec::as_slice));
        draft.replace(t, &parts);
        split += 1;
    }
    Ok(split)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::StopFlag;
    use crate::geom::DVec3;
    use crate::mesh::EdgeGroups;

    #[test]
    fn a_crack_with_vertices_on_one_side_closes() {
        let points = [[0, 0], [3, 0], [1, 2], [1, 0], [2, 0], [1, -1]];
        let triangles = vec![[0, 1, 2], [0, 5, 3], [3, 5, 4], [4, 5, 1]];
        let mut draft = Draft {
            positions: points.map(|[x, y]| DVec3::new(f64::from(x), f64::from(y), 0.0)).to_vec(),
            vertex_origin: (0..6).collect(),
            triangle_origin: (0..4).collect(),
            triangles,
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        };
        let changes = split_t_vertices(&mut draft, &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("edges_divided"), changes.count("triangles_split")), (1, 1));
        assert_eq!(draft.triangles.len(), 6);
        assert_eq!(draft.triangle_origin, [0, 1, 2, 3, 0, 0]);
        let groups = EdgeGroups::build(&draft.triangles, 6, &Budget::unlimited()).unwrap();
        for ends in [[0, 3], [3, 4], [1, 4]] {
            let e = groups.find(&draft.triangles, ends).unwrap();
            assert_eq!(groups.group(e).len(), 2, "{ends:?}");
        }
    }

    #[test]
    fn copies_of_a_triangle_in_both_directions_are_divided_alike() {
        let points = [[0, 0], [3, 0], [1, 2], [1, 0], [1, -1]];
        let mut draft = Draft {
            positions: points.map(|[x, y]| DVec3::new(f64::from(x), f64::from(y), 0.0)).to_vec(),
            vertex_origin: (0..5).collect(),
            triangle_origin: (0..4).collect(),
            triangles: vec![[0, 1, 2], [0, 2, 1], [0, 4, 3], [3, 4, 1]],
            ..Draft::default()
        };
        let changes = split_t_vertices(&mut draft, &Budget::unlimited()).unwrap();
        assert_eq!(changes.count("triangles_split"), 2);
        let ordered = |t: &[u32; 3]| {
            let mut t = *t;
            t.sort_unstable();
            t
        };
        let mut all: Vec<[u32; 3]> = draft.triangles.iter().map(ordered).collect();
        all.sort_unstable();
        assert_eq!(all, [[0, 2, 3], [0, 2, 3], [0, 3, 4], [1, 2, 3], [1, 2, 3], [1, 3, 4]]);
    }

    #[test]
    fn a_vertex_beside_an_edge_divides_nothing() {
        let mut draft = Draft {
            positions: [[0.0, 0.0], [3.0, 0.0], [1.0, 2.0], [1.0, 1e-30], [2.0, -1.0], [1.0, -1.0]]
                .map(|[x, y]| DVec3::new(x, y, 0.0))
                .to_vec(),
            vertex_origin: (0..6).collect(),
            triangles: vec![[0, 1, 2], [3, 4, 5]],
            triangle_origin: vec![0, 1],
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        };
        let before = draft.clone();
        let changes = split_t_vertices(&mut draft, &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("edges_divided"), draft), (0, before));
    }

    /// Triangles whose longest edges lie on one line, each with ends of its own.
    fn edges_on_each_other(count: u32) -> Draft {
        let points = (0..count).flat_map(|i| {
            let (i, n) = (f64::from(i), f64::from(count));
            [DVec3::new(i, 0.0, 0.0), DVec3::new(n + i, 0.0, 0.0), DVec3::new(n, 1.0 + i, 1.0)]
        });
        Draft {
            positions: points.collect(),
            vertex_origin: (0..3 * count).collect(),
            triangles: (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
            triangle_origin: (0..count).collect(),
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        }
    }

    #[test]
    fn vertices_inside_many_edges_on_each_other_are_charged() {
        let count = 200;
        let limited = |bytes| Budget::new(StopFlag::default(), u64::MAX, bytes);
        let mut draft = edges_on_each_other(count);
        let before = draft.clone();
        let pairs = u64::from(count) * u64::from(count - 1);
        // Of two edges that overlap each has an end of the other.
        let stopped = split_t_vertices(&mut draft, &limited(pairs * BYTES_OF_INSIDE / 2)).unwrap_err();
        assert!(matches!(stopped, Stopped::Memory { .. }), "{stopped}");
        assert_eq!(draft, before);
        let enough = limited(4 * pairs * BYTES_OF_INSIDE);
        let changes = split_t_vertices(&mut draft, &enough).unwrap();
        assert_eq!(changes.count("edges_divided"), u64::from(count));
        assert_eq!(draft.triangles.len() as u64, u64::from(count) + pairs);
        assert!(enough.bytes_peak() > pairs * BYTES_OF_INSIDE);
    }
}
