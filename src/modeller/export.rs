//! From a polyhedron to the corners and triangles that a file can hold.

use super::exact::rational;
use super::point::Point;
use super::solid::Solid;
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec2, DVec3, Sign, orient2d, triangulate_region};
use crate::mesh::polyhedron::{FaceId, VertexId};

/// Most corners of a face; a triangulation of so many takes some 20 ms and cannot be stopped inside.
const CORNERS_MAX: usize = 1 << 14;

/// Reflex corners, and corners, from which a fan is tried: each try looks at the whole face.
const FAN_STARTS_MAX: usize = 16;

/// A polyhedron with rounded corners.
#[derive(Debug, Clone, PartialEq)]
pub struct Exported {
    /// The corners, those of the file where nothing has moved them, float32 elsewhere.
    pub positions: Vec<DVec3>,
    /// Triangles of corners.
    pub triangles: Vec<[u32; 3]>,
    /// The face of the polyhedron behind each triangle; those of one face follow each other.
    pub face_of_triangle: Vec<u32>,
    /// Faces of one loop whose rounded corners are a polygon that the fan around its first corner covers, with their
    /// corners in that order: every reader of polygons makes the same triangles of it. Ascending, with four corners or
    /// more.
    pub polygons: Vec<(u32, Vec<u32>)>,
    /// The largest distance by which rounding moved a corner, in the unit of the coordinates.
    pub rounded_by: f64,
}

/// Why a polyhedron cannot be rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ExportRefusal {
    /// The rounded loops of a face touch or cross.
    FaceFolds {
        /// The face.
        face: FaceId,
    },
    /// A coordinate is beyond the range of float32.
    BeyondFloat32 {
        /// The vertex.
        vertex: VertexId,
    },
    /// A face has more corners than are triangulated.
    FaceTooLarge {
        /// The face.
        face: FaceId,
        /// The limit.
        limit: usize,
    },
}

/// Rounds the vertices and triangulates the faces. `originals` are the corners of the file, by the first numbers of
/// vertices, and the solid is `factor` times as large: a vertex that is still exactly there keeps its bits, times `factor`.
///
/// # Errors
/// When the budget stops the run.
pub fn export(
    solid: &Solid,
    originals: &[DVec3],
    factor: f64,
    budget: &Budget,
) -> Result<Result<Exported, ExportRefusal>, Stopped> {
    let topology = solid.topology();
    let mut number = vec![u32::MAX; topology.vertex_bound()];
    let scale = rational(factor);
    let (mut positions, mut rounded_by) = (Vec::new(), 0.0f64);
    for v in topology.vertices() {
        let point = solid.point(v);
        let kept = originals.get(v.index()).filter(|p| *point == Point::of(**p).scaled(&scale));
        let position = kept.map_or_else(|| point.near.as_vec3().as_dvec3(), |p| *p * factor);
        if !position.is_finite() {
            return Ok(Err(ExportRefusal::BeyondFloat32 { vertex: v }));
        }
        number[v.index()] = positions.len() as u32;
        if kept.is_none() {
            rounded_by = rounded_by.max(position.distance(point.near));
        }
        positions.push(position);
    }
    let mut exported = Exported {
        positions,
        triangles: Vec::new(),
        face_of_triangle: Vec::new(),
        polygons: Vec::new(),
        rounded_by,
    };
    for f in topology.faces() {
        let loops: Vec<Vec<u32>> = topology
            .loop_starts(f)
            .map(|h| topology.loop_of(h).map(|h| number[topology.origin(h).index()]).collect())
            .collect();
        let corner_count: usize = loops.iter().map(Vec::len).sum();
        budget.spend(corner_count as u64)?;
        if corner_count > CORNERS_MAX {
            return Ok(Err(ExportRefusal::FaceTooLarge { face: f, limit: CORNERS_MAX }));
        }
        let Some((triangles, fan)) = triangulate(solid, f, &loops, &exported.positions) else {
            return Ok(Err(ExportRefusal::FaceFolds { face: f }));
        };
        exported.face_of_triangle.extend(triangles.iter().map(|_| f.index() as u32));
        exported.triangles.extend(triangles);
        if let Some(corners) = fan.filter(|corners| corners.len() > 3) {
            exported.polygons.push((f.index() as u32, corners));
        }
    }
    Ok(Ok(exported))
}

/// The triangles of a face, and its corners where they are the fan around the first of them.
type Triangulated = (Vec<[u32; 3]>, Option<Vec<u32>>);

fn triangulate(solid: &Solid, f: FaceId, loops: &[Vec<u32>], positions: &[DVec3]) -> Option<Triangulated> {
    let view = solid.view(f);
    let flat = |v: u32| {
        let p = positions[v as usize];
        DVec2::new(p[view.u], p[view.v])
    };
    if let [corners] = loops
        && let Some(corners) = as_fan(corners, &flat)
    {
        let triangles = (1..corners.len() - 1).map(|i| [corners[0], corners[i], corners[i + 1]]).collect();
        return Some((triangles, Some(corners)));
    }
    let seen: Vec<Vec<DVec2>> =
        loops.iter().map(|corners| corners.iter().map(|&v| flat(v)).collect()).collect();
    let inside = triangulate_region(&seen)?;
    let corners: Vec<u32> = loops.concat();
    Some((inside.into_iter().map(|t| t.map(|i| corners[i])).collect(), None))
}

/// The corners of a polygon from one on whose fan covers it: the directions to the others turn counter-clockwise, by less
/// than a whole turn in all. Reflex corners are tried first: the fan of an L starts at its inner corner.
fn as_fan(corners: &[u32], flat: &impl Fn(u32) -> DVec2) -> Option<Vec<u32>> {
    let count = corners.len();
    let turn = |a: usize, b: usize, c: usize| {
        orient2d(flat(corners[a % count]), flat(corners[b % count]), flat(corners[c % count]))
    };
    let is_fan = |&start: &usize| {
        let is_proper = (1..count - 1).all(|i| turn(start, start + i, start + i + 1) == Sign::Positive);
        // Back over the first direction: more than a whole turn.
        let is_behind = |i: usize| turn(start, start + 1, start + i) == Sign::Negative;
        is_proper && !(2..count - 1).any(|i| is_behind(i) && !is_behind(i + 1))
    };
    let reflex = (0..count).filter(|&i| turn(i + count - 1, i, i + 1) == Sign::Negative);
    let start = reflex.take(FAN_STARTS_MAX).chain(0..count.min(FAN_STARTS_MAX)).find(is_fan)?;
    let mut turned = corners.to_vec();
    turned.rotate_left(start);
    Some(turned)
}
