//! Closes what is left open by triangles that may pass through others, for bodies that are to be united.
//!
//! A winding number is defined where the triangles along every edge run as often one way as the other. Of the edges where they
//! do not, closed walks are made, each is parted where it comes to a vertex again, and every loop is triangulated with the
//! least area that a search finds. Where a patch meets the mesh is for the arrangement to resolve; no vertex is added or moved.

use super::chords::All;
use super::large;
use super::minimal::{self, Least};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::{EdgeGroups, edge_of};
use crate::repair::{Changes, Draft, NEW};
use rustc_hash::FxHashMap;

/// Corners beyond which a loop is closed by triangles at one of its corners.
const CORNERS_MAX: usize = 1 << 14;

/// Closes every open edge of `draft`, which must be welded, by triangles between the vertices of its rims.
///
/// # Errors
/// When the budget stops the run.
pub fn span_rims(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let missing = missing_edges(draft, budget)?;
    span(draft, &missing, budget)
}

/// As [`span_rims`], but it does not matter which way triangles turn: what is spanned are the edges that an odd number of them
/// have.
///
/// # Errors
/// When the budget stops the run.
pub fn span_odd_edges(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?;
    budget.spend(draft.triangles.len() as u64)?;
    let odd = groups.iter().filter(|group| group.len() % 2 == 1);
    let edges: Vec<[u32; 2]> = odd.map(|group| edge_of(&draft.triangles, group[0])).collect();
    drop(groups);
    span(draft, &directed(&edges), budget)
}

/// Closes loops of directed edges, as many of which begin at each vertex as end there.
fn span(draft: &mut Draft, edges: &[[u32; 2]], budget: &Budget) -> Result<Changes, Stopped> {
    let loops = loops(edges);
    let first = draft.triangles.len();
    for corners in &loops {
        let points: Vec<DVec3> = corners.iter().map(|&v| draft.positions[v as usize]).collect();
        for t in triangulate(&points, budget)? {
            draft.triangles.push(t.map(|i| corners[i]));
            draft.triangle_origin.push(NEW);
        }
    }
    let added = (draft.triangles.len() - first) as u64;
    Ok(Changes::counted([("rims_spanned", loops.len() as u64), ("triangles_added", added)]))
}

/// These edges, of which an even number are at each vertex, directed so that as many begin there as end there; sorted.
fn directed(edges: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut at: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
    for (i, edge) in edges.iter().enumerate().rev() {
        for &v in edge {
            at.entry(v).or_default().push(i as u32);
        }
    }
    let mut is_used = vec![false; edges.len()];
    let mut directed = Vec::with_capacity(edges.len());
    for start in edges.iter().map(|edge| edge[0]) {
        let mut from = start;
        while let Some(i) = at.get_mut(&from).and_then(Vec::pop) {
            if std::mem::replace(&mut is_used[i as usize], true) {
                continue;
            }
            let [a, b] = edges[i as usize];
            let to = if from == a { b } else { a };
            directed.push([from, to]);
            from = to;
        }
    }
    directed.sort_unstable();
    directed
}

/// The directed edges that balance the triangles along every edge, sorted.
fn missing_edges(draft: &Draft, budget: &Budget) -> Result<Vec<[u32; 2]>, Stopped> {
    let groups = EdgeGroups::build(&draft.triangles, draft.positions.len(), budget)?;
    let mut missing = Vec::new();
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.spend(CHECK_EVERY as u64)?;
        }
        let [from, to] = edge_of(&draft.triangles, group[0]);
        let along = group.iter().filter(|&&h| edge_of(&draft.triangles, h)[0] == from).count();
        let against = group.len() - along;
        let edge = if along > against { [to, from] } else { [from, to] };
        missing.extend(std::iter::repeat_n(edge, along.abs_diff(against)));
    }
    missing.sort_unstable();
    Ok(missing)
}

/// Closed loops of these edges, none of which comes to a vertex twice. As many edges begin at each vertex as end there.
fn loops(edges: &[[u32; 2]]) -> Vec<Vec<u32>> {
    let mut next = FxHashMap::default();
    for (i, edge) in edges.iter().enumerate().rev() {
        next.insert(edge[0], i);
    }
    let mut step = |from: u32| {
        let i = next.get_mut(&from)?;
        let edge = edges.get(*i).filter(|edge| edge[0] == from)?;
        *i += 1;
        Some(edge[1])
    };
    let mut loops = Vec::new();
    for &[start, _] in edges {
        let (mut walk, mut place) = (vec![start], FxHashMap::from_iter([(start, 0)]));
        while let Some(to) = step(walk[walk.len() - 1]) {
            let Some(&back) = place.get(&to) else {
                place.insert(to, walk.len());
                walk.push(to);
                continue;
            };
            let closed: Vec<u32> = walk.drain(back + 1..).collect();
            for v in &closed {
                place.remove(v);
            }
            loops.push([vec![to], closed].concat());
        }
    }
    loops
}

/// Triangles of the loop through `points`, in its direction; some may have no area.
fn triangulate(points: &[DVec3], budget: &Budget) -> Result<Vec<[usize; 3]>, Stopped> {
    let n = points.len();
    let rim_normals = vec![DVec3::ZERO; n];
    let found = if n <= minimal::CORNERS_MAX {
        let all = All { corners: n };
        let found = minimal::with_least_caps(points, &rim_normals, &all, Least::Area, |_, _| true, budget)?;
        found.map(|found| found.triangles)
    } else if n <= CORNERS_MAX {
        let sides = (0..n).map(|i| points[i].cross(points[(i + 1) % n]));
        let normal = sides.sum::<DVec3>().normalize_or_zero();
        large::triangulate(points, &rim_normals, normal, |_, _| true, budget)?
    } else {
        None
    };
    budget.spend(n as u64)?;
    Ok(found.unwrap_or_else(|| (1..n - 1).map(|i| [0, i, i + 1]).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::unite::unite;

    fn draft(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Draft {
        Draft {
            vertex_origin: (0..positions.len() as u32).collect(),
            triangle_origin: (0..triangles.len() as u32).collect(),
            positions,
            triangles,
            two_sided: Vec::new(),
            blends: Default::default(),
            polygons: Default::default(),
        }
    }

    /// A tetrahedron from the origin on, without its face opposite the origin.
    fn open_tetrahedron(size: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let points = vec![DVec3::ZERO, DVec3::X * size, DVec3::Y * size, DVec3::Z * size];
        (points, vec![[0, 2, 1], [0, 3, 2], [0, 1, 3]])
    }

    #[test]
    fn every_edge_balances_afterwards() {
        let (positions, triangles) = open_tetrahedron(1.0);
        let mut open = draft(positions, triangles);
        let changes = span_rims(&mut open, &Budget::unlimited()).unwrap();
        assert_eq!((changes.count("rims_spanned"), changes.count("triangles_added")), (1, 1));
        assert!(missing_edges(&open, &Budget::unlimited()).unwrap().is_empty());
        assert_eq!(open.triangles[3], [1, 2, 3]);
    }

    #[test]
    fn loops_pass_each_vertex_once_and_use_every_edge() {
        // A figure of eight through 0, and a loop that is there twice.
        let mut edges = vec![
            [0, 1],
            [1, 2],
            [2, 0],
            [0, 3],
            [3, 4],
            [4, 0],
            [5, 6],
            [6, 7],
            [7, 5],
            [5, 6],
            [6, 7],
            [7, 5],
        ];
        edges.sort_unstable();
        let loops = loops(&edges);
        assert_eq!(loops.len(), 4);
        let mut used = Vec::new();
        for own in &loops {
            let mut once = own.clone();
            once.sort_unstable();
            once.dedup();
            assert_eq!(once.len(), own.len());
            used.extend((0..own.len()).map(|i| [own[i], own[(i + 1) % own.len()]]));
        }
        used.sort_unstable();
        assert_eq!(used, edges);
    }

    #[test]
    fn a_body_whose_patch_would_pass_through_it_becomes_a_solid() {
        // The face that is missing of the tetrahedron cuts through a smaller cube-like body at its middle.
        let (mut positions, mut triangles) = open_tetrahedron(3.0);
        let first = positions.len() as u32;
        let middle = DVec3::ONE;
        positions
            .extend([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| middle + p - DVec3::splat(0.25)));
        triangles
            .extend([[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]].map(|t: [u32; 3]| t.map(|v| first + v)));
        let mut open = draft(positions, triangles);
        span_rims(&mut open, &Budget::unlimited()).unwrap();
        unite(&mut open, &Budget::unlimited()).unwrap();
        let groups = EdgeGroups::build(&open.triangles, open.positions.len(), &Budget::unlimited()).unwrap();
        assert!(groups.iter().all(|group| group.len() == 2));
        let volume: f64 = (0..open.triangles.len())
            .map(|t| {
                let [a, b, c] = open.corners(t);
                a.cross(b).dot(c) / 6.0
            })
            .sum();
        // The small body has its corner (0.75, 0.75, 0.75) in the large one, which ends at x + y + z = 3.
        let inside = 0.75f64.powi(3) / 6.0;
        assert!((volume - (4.5 + 1.0 / 6.0 - inside)).abs() < 1e-6, "{volume}");
    }
}
