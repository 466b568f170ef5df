//! The borders of groups of triangles as loops of corners.

use super::groups::TriangleNeighbours;
use crate::geom::DVec3;
use crate::mesh::polyhedron::BuildFault;
use crate::modeller::point::{AxisView, Point};
use std::cmp::Ordering;

/// Faces made of groups of triangles.
pub(super) struct GroupedFaces {
    /// The loops of each face, the exterior one first, of numbers of kept vertices.
    pub(super) loops: Vec<Vec<Vec<u32>>>,
    /// The group of each face.
    pub(super) groups: Vec<u32>,
    /// The vertex of the file behind each kept vertex.
    pub(super) vertices: Vec<u32>,
    /// The faces around each kept vertex, ascending.
    pub(super) around: Vec<Vec<u32>>,
    pub(super) face_of_triangle: Vec<u32>,
}

/// The triangle beyond each edge.
pub(super) fn neighbours(
    triangles: &[[u32; 3]],
    vertex_count: usize,
) -> Result<TriangleNeighbours, BuildFault> {
    let loops: Vec<Vec<Vec<u32>>> = triangles.iter().map(|t| vec![t.to_vec()]).collect();
    let mesh = crate::mesh::polyhedron::Polyhedron::from_loops(&loops, vertex_count)?;
    let beyond = |t: usize, c: usize| {
        let h = crate::mesh::polyhedron::HalfEdgeId::new(3 * t + c);
        mesh.face(mesh.opposite(h)).index() as u32
    };
    Ok((0..triangles.len()).map(|t| [0, 1, 2].map(|c| beyond(t, c))).collect())
}

/// The loops of all groups, `Err` with groups that are no faces: those that touch themselves, have no or several outer
/// borders, or too few corners.
pub(super) fn trace(
    triangles: &[[u32; 3]],
    neighbours: &TriangleNeighbours,
    group: &[u32],
    points: &[DVec3],
) -> Result<GroupedFaces, Vec<u32>> {
    let mut borders: Vec<(u32, u32, u32)> = Vec::new();
    for (t, corners) in triangles.iter().enumerate() {
        for c in 0..3 {
            if group[neighbours[t][c] as usize] != group[t] {
                borders.push((group[t], corners[c], corners[(c + 1) % 3]));
            }
        }
    }
    borders.sort_unstable();
    // Two borders of one group that leave one vertex: the group touches itself there.
    let mut bad: Vec<u32> =
        borders.windows(2).filter(|w| (w[0].0, w[0].1) == (w[1].0, w[1].1)).map(|w| w[0].0).collect();
    if !bad.is_empty() {
        return Err(bad);
    }
    // A vertex is kept when borders of three groups or more leave it.
    let mut degree = vec![0u32; points.len()];
    borders.iter().for_each(|b| degree[b.1 as usize] += 1);
    let mut number = vec![u32::MAX; points.len()];
    let mut vertices = Vec::new();
    for v in (0..points.len()).filter(|&v| degree[v] >= 3) {
        number[v] = vertices.len() as u32;
        vertices.push(v as u32);
    }
    // Faces in the order of their first triangles.
    let mut groups: Vec<u32> = Vec::new();
    let mut face_of_group = vec![u32::MAX; triangles.len()];
    for &g in group {
        if face_of_group[g as usize] == u32::MAX {
            face_of_group[g as usize] = groups.len() as u32;
            groups.push(g);
        }
    }
    let mut loops: Vec<Vec<Vec<u32>>> = Vec::with_capacity(groups.len());
    for &g in &groups {
        let from = borders.partition_point(|b| b.0 < g);
        let to = borders.partition_point(|b| b.0 <= g);
        match face_loops(&borders[from..to], &number, triangles[g as usize], points) {
            Some(found) => loops.push(found),
            None => {
                bad.push(g);
                // What lies beyond may be to blame as well.
                let of = |t: usize| neighbours[t].map(|n| group[n as usize]);
                bad.extend((0..triangles.len()).filter(|&t| group[t] == g).flat_map(of));
                loops.push(Vec::new());
            }
        }
    }
    if !bad.is_empty() {
        return Err(bad);
    }
    let mut around: Vec<Vec<u32>> = vec![Vec::new(); vertices.len()];
    for (f, face) in loops.iter().enumerate() {
        face.iter().flatten().for_each(|&v| around[v as usize].push(f as u32));
    }
    let face_of_triangle = group.iter().map(|&g| face_of_group[g as usize]).collect();
    Ok(GroupedFaces { loops, groups, vertices, around, face_of_triangle })
}

/// The loops of one group, the exterior one first; `None` when it is no face.
fn face_loops(
    borders: &[(u32, u32, u32)],
    number: &[u32],
    seed: [u32; 3],
    points: &[DVec3],
) -> Option<Vec<Vec<u32>>> {
    let [a, b, c] = seed.map(|v| points[v as usize]);
    let view = AxisView::along((b - a).cross(c - a).try_normalize()?);
    let mut is_walked = vec![false; borders.len()];
    let (mut exterior, mut interior) = (Vec::new(), Vec::new());
    for first in 0..borders.len() {
        if is_walked[first] {
            continue;
        }
        let (mut at, mut all) = (first, Vec::new());
        while !std::mem::replace(&mut is_walked[at], true) {
            all.push(borders[at].1);
            at = borders.binary_search_by_key(&borders[at].2, |b| b.1).ok()?;
        }
        let corners: Vec<u32> = all.iter().map(|&v| number[v as usize]).filter(|&n| n != u32::MAX).collect();
        if corners.len() < 3 {
            return None;
        }
        if is_counter_clockwise(view, &all, points)? {
            exterior.push(corners);
        } else {
            interior.push(corners);
        }
    }
    (exterior.len() == 1).then(|| exterior.into_iter().chain(interior).collect())
}

fn is_counter_clockwise(view: AxisView, corners: &[u32], points: &[DVec3]) -> Option<bool> {
    let at: Vec<Point> = corners.iter().map(|&v| Point::of(points[v as usize])).collect();
    let first = (0..at.len())
        .min_by(|&i, &j| at[i].compare(&at[j], view.u).then_with(|| at[i].compare(&at[j], view.v)))?;
    let count = at.len();
    match view.turn(&at[(first + count - 1) % count], &at[first], &at[(first + 1) % count]) {
        Ordering::Equal => None,
        turn => Some(turn == Ordering::Greater),
    }
}
