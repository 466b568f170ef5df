//! OBJ input as other Rust programs see it.

use super::statements::StatementCounts;
use crate::budget::Budget;
use crate::formats::faces::Faces;
use crate::formats::{Place, ReadError, ReadOptions};
use crate::geom::DVec3;
use crate::mesh::Soup;
use std::panic::{AssertUnwindSafe, catch_unwind};
use tobj::{LoadOptions, Mesh};

const OPTIONS: LoadOptions =
    LoadOptions { single_index: false, triangulate: false, ignore_points: true, ignore_lines: true };

/// What the crate keeps for a vertex: coordinates, also in a list that grows, and an entry of a map, in bytes.
const BYTES_OF_VERTEX: u64 = 96;
/// The same for a face: a variant with three corners of three indices, in a list that grows.
const BYTES_OF_FACE: u64 = 160;
/// The same for a corner of a polygon beyond the third, and ours.
const BYTES_OF_CORNER: u64 = 64;

/// Reads with the `tobj` crate: float32 coordinates, only vertices that a face uses, once for each group, no lines.
/// No material file is opened. The run cannot be stopped while the crate reads.
pub(in crate::formats) fn read(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    let counts = StatementCounts::of(bytes, budget)?;
    options.limits.check_vertices(counts.vertices)?;
    options.limits.check_triangles(counts.faces)?;
    let bytes_of_crate = counts.vertices * BYTES_OF_VERTEX
        + counts.faces * BYTES_OF_FACE
        + counts.further_corners() * BYTES_OF_CORNER;
    let _charged = budget.charge(bytes_of_crate)?;
    let load = || tobj::load_obj_buf(&mut &*bytes, &OPTIONS, |_| Ok(Default::default()));
    // The crate panics on some malformed input; it keeps no state that a panic could leave broken.
    let loaded = catch_unwind(AssertUnwindSafe(load));
    let unreadable = |why: &str| ReadError::unparseable(Place::Whole, why, "OBJ that tobj can read");
    let models = match loaded {
        Ok(Ok((models, _materials))) => models,
        Ok(Err(error)) => return Err(unreadable(&error.to_string())),
        Err(_panic) => return Err(unreadable("what makes tobj panic")),
    };
    let mut positions = Vec::new();
    let mut faces = Faces::default();
    for model in &models {
        budget.check()?;
        add(&model.mesh, &mut positions, &mut faces, options)?;
    }
    faces.into_soup(positions, &options.limits, budget)
}

fn add(
    mesh: &Mesh,
    positions: &mut Vec<DVec3>,
    faces: &mut Faces,
    options: &ReadOptions,
) -> Result<(), ReadError> {
    let first = positions.len() as u32;
    positions.extend(mesh.positions.as_chunks().0.iter().map(|p: &[f32; 3]| DVec3::from(p.map(f64::from))));
    let corners: Vec<u32> = mesh.indices.iter().map(|&i| first.saturating_add(i)).collect();
    if mesh.face_arities.is_empty() {
        for triangle in corners.chunks_exact(3) {
            faces.push(triangle);
        }
        return Ok(());
    }
    let mut rest = &corners[..];
    for &size in &mesh.face_arities {
        options.limits.check_polygon(u64::from(size), Place::Whole)?;
        let Some((face, later)) = rest.split_at_checked(size as usize) else { break };
        faces.push(face);
        rest = later;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Soup, ReadError> {
        super::read(text.as_bytes(), &ReadOptions::default(), &Budget::unlimited())
    }

    #[test]
    fn groups_follow_one_another_with_their_own_vertices() {
        let soup = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\no a\nf 1 2 3\no b\nf 1 2 3 1\nl 1 2\n").unwrap();
        assert_eq!((soup.positions.len(), soup.face_count, &soup.triangle_face[..]), (6, 2, &[0, 1, 1][..]));
        assert_eq!(soup.triangles[1], [3, 4, 5]);
    }

    #[test]
    fn what_the_crate_will_take_is_charged_before_it_begins() {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}", "f 1 2 3\n".repeat(100_000));
        let budget = Budget::new(crate::budget::StopFlag::default(), u64::MAX, 10 << 20);
        let error = super::read(text.as_bytes(), &ReadOptions::default(), &budget).unwrap_err().to_string();
        assert!(error.contains("memory limit"), "{error}");
        let limits = crate::formats::ReadLimits { triangles_max: 1000, ..Default::default() };
        let options = ReadOptions { limits, ..ReadOptions::default() };
        let error = super::read(text.as_bytes(), &options, &Budget::unlimited()).unwrap_err().to_string();
        assert!(error.contains("100000 triangles is over the limit"), "{error}");
    }

    #[test]
    fn what_the_crate_refuses_is_an_error_and_material_files_are_never_opened() {
        assert!(read("v 0 0 0\nf 1 2 9\n").is_err());
        assert!(read("mtllib /does/not/exist.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n").is_ok());
    }
}
