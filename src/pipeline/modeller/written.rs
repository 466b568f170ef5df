//! The edited polyhedron, or its dual, as what a file holds.

use super::choices::ModellerChoices;
use super::report::{ModellerRefusal, ModellerReport};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::{Polygons, Soup};
use crate::modeller::{self, Imported, Rational, Solid};

/// Corners, triangles, and faces that may stay polygons, each with the triangles that it is as the fan around its first
/// corner.
struct WrittenMesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// First triangle and corners.
    polygons: Vec<(u32, Vec<u32>)>,
}

/// What is to be written.
pub(super) fn written(
    imported: &Imported,
    choices: &ModellerChoices,
    told: &mut ModellerReport,
    budget: &Budget,
) -> Result<Result<Soup, ModellerRefusal>, Stopped> {
    let parts = match choices.dual {
        Some(embedding) => {
            let origin = choices.is_dual_recentered.then(|| middle(&imported.solid));
            match modeller::dual(&imported.solid, embedding, origin) {
                Ok(dual) => of_dual(dual),
                Err(refusal) => return Ok(Err(ModellerRefusal::Dual(refusal))),
            }
        }
        None => match modeller::export(&imported.solid, &imported.positions, imported.factor, budget)? {
            Ok(exported) => {
                told.rounded_by = Some(exported.rounded_by);
                of_export(exported)
            }
            Err(refusal) => return Ok(Err(ModellerRefusal::Export(refusal))),
        },
    };
    Ok(Ok(soup(parts, choices.writes_polygons)))
}

/// The middle of the box around all vertices.
fn middle(solid: &Solid) -> [Rational; 3] {
    let bounds = solid.bounds();
    ((bounds.min + bounds.max) * 0.5).to_array().map(modeller::rational)
}

fn of_dual(dual: modeller::Dual) -> WrittenMesh {
    let positions = dual.positions.iter().map(|p| p.as_vec3().as_dvec3()).collect();
    let mut parts = WrittenMesh { positions, triangles: Vec::new(), polygons: Vec::new() };
    for corners in dual.faces {
        let first = parts.triangles.len() as u32;
        parts.triangles.extend((1..corners.len() - 1).map(|i| [corners[0], corners[i], corners[i + 1]]));
        if corners.len() > 3 {
            parts.polygons.push((first, corners));
        }
    }
    parts
}

fn of_export(exported: modeller::Exported) -> WrittenMesh {
    // The triangles of a face follow each other.
    let first = |face: u32| exported.face_of_triangle.partition_point(|&f| f < face) as u32;
    let polygons = exported.polygons.iter().map(|(face, corners)| (first(*face), corners.clone())).collect();
    WrittenMesh { positions: exported.positions, triangles: exported.triangles, polygons }
}

fn soup(parts: WrittenMesh, has_polygons: bool) -> Soup {
    let WrittenMesh { positions, triangles, polygons } = parts;
    let is_f32_exact = positions.iter().all(|p| p.as_vec3().as_dvec3() == *p);
    let face_count = triangles.len() as u32;
    let soup = Soup { positions, triangles, face_count, is_f32_exact, ..Soup::default() };
    if !has_polygons || polygons.is_empty() {
        return soup;
    }
    let mut lists = Polygons { starts: vec![0], ..Polygons::default() };
    let mut triangle_face = Vec::with_capacity(soup.triangles.len());
    let mut face = 0u32;
    for (first, corners) in polygons {
        while (triangle_face.len() as u32) < first {
            triangle_face.push(face);
            face += 1;
        }
        lists.faces.push(face);
        lists.first_triangles.push(first);
        triangle_face.resize(triangle_face.len() + corners.len() - 2, face);
        lists.corners.extend(corners);
        lists.starts.push(lists.corners.len() as u32);
        face += 1;
    }
    while triangle_face.len() < soup.triangles.len() {
        triangle_face.push(face);
        face += 1;
    }
    Soup { face_count: face, triangle_face, polygons: lists, ..soup }
}
