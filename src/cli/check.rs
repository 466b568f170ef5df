//! `meshmend check`: is a file's mesh, face by face as it is indexed, a half-edge mesh, and what kind of one? A face that no
//! mesh can have, or a vertex that is nowhere, is a no.

use super::exit::{Exit, print, say};
use super::files::FileOrStream;
use crate::budget::Budget;
use crate::formats::{self, Format, ReadOptions};
use crate::mesh::half_edge::{BuildError, Claims, HalfEdgeMesh};
use crate::mesh::{FaceFaultReason, Soup};
use crate::wire::Problem;

/// Says what the mesh is; [`Exit::Negative`] when it is no half-edge mesh.
pub(super) fn run(input: &FileOrStream, format: Option<Format>) -> Exit {
    match described(input, format) {
        Ok((text, is_sound)) => {
            print(&text);
            if is_sound { Exit::Done } else { Exit::Negative }
        }
        Err(problem) => {
            say(&format!("{input}: {}", problem.detail));
            Exit::of(&problem)
        }
    }
}

fn described(input: &FileOrStream, format: Option<Format>) -> Result<(String, bool), Problem> {
    let budget = Budget::unlimited();
    let bytes = input.read().map_err(|error| {
        Problem::new(crate::wire::ProblemCode::NotFound, format!("it cannot be read: {error}"))
    })?;
    let unreadable = |error: formats::ReadError| Problem::from(&crate::pipeline::Failure::from(error));
    let encoding = formats::sniff(&bytes, format.or(input.format())).map_err(unreadable)?;
    let soup = formats::read(&bytes, encoding, &ReadOptions::default(), &budget).map_err(unreadable)?;
    if let Some(reason) = unusable(&soup) {
        return Ok((format!("{input}: no half-edge mesh: {reason}\n"), false));
    }
    let (corners, starts) = loops_of(&soup);
    match HalfEdgeMesh::from_polygons(&corners, &starts, soup.positions.len(), &budget) {
        Ok(mesh) => {
            let faults =
                mesh.check(&Claims::default(), &budget).map_err(|stopped| Problem::from(&stopped))?;
            let counts = mesh.counts();
            let kind = if soup.polygons.faces.is_empty() { "triangular" } else { "polygonal" };
            let mut text = format!(
                "{input}: a {kind} half-edge mesh\n  {} vertices, {} edges, {} faces, {} boundary loop{}; Euler characteristic {}\n",
                counts.vertices,
                counts.edges,
                counts.faces,
                counts.boundary_loops,
                if counts.boundary_loops == 1 { "" } else { "s" },
                counts.euler()
            );
            for fault in &faults {
                text.push_str(&format!("  {fault}\n"));
            }
            Ok((text, faults.is_empty()))
        }
        Err(BuildError::Stopped(stopped)) => Err(Problem::from(&stopped)),
        Err(error) => Ok((format!("{input}: no half-edge mesh: {error}\n"), false)),
    }
}

/// What of the file is no part of any mesh: the first of the faces that cannot be used and of the vertices that are not
/// finite, by number and line, and how many there are.
fn unusable(soup: &Soup) -> Option<String> {
    let line =
        |lines: &[u32], i: u32| lines.get(i as usize).map_or(String::new(), |line| format!(" (line {line})"));
    if let Some(fault) = soup.face_faults.first() {
        let why = match fault.reason {
            FaceFaultReason::NonFinite => "has a corner whose coordinates are not finite",
            FaceFaultReason::IndexOutOfRange => "names a vertex that the file does not have",
            FaceFaultReason::TooFewCorners => "has fewer than three corners",
        };
        let (face, count) = (fault.face, soup.face_faults.len());
        let place = line(&soup.places.face_lines, face);
        return Some(format!(
            "face {face}{place} {why}; {count} of {} faces cannot be used",
            soup.face_count
        ));
    }
    let vertex = *soup.non_finite_vertices.first()?;
    let place = line(&soup.places.vertex_lines, vertex);
    Some(format!("vertex {vertex}{place} has coordinates that are not finite"))
}

/// The corners of the usable faces as the file lists them, polygons whole, and where each face begins.
fn loops_of(soup: &Soup) -> (Vec<u32>, Vec<u32>) {
    let mut polygons = soup.polygons.first_triangles.iter().zip(soup.polygons.starts.windows(2)).peekable();
    let (mut all, mut starts) = (Vec::with_capacity(3 * soup.triangles.len()), vec![0]);
    let mut t = 0;
    while t < soup.triangles.len() {
        match polygons.next_if(|&(&first, _)| first as usize == t) {
            Some((_, ends)) => {
                let corners = &soup.polygons.corners[ends[0] as usize..ends[1] as usize];
                t += corners.len() - 2;
                all.extend_from_slice(corners);
            }
            None => {
                all.extend_from_slice(&soup.triangles[t]);
                t += 1;
            }
        }
        starts.push(all.len() as u32);
    }
    (all, starts)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str) -> (String, bool) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.off");
        std::fs::write(&path, text).unwrap();
        described(&FileOrStream::File(path), None).unwrap()
    }

    #[test]
    fn polygons_are_faces_and_a_mesh_is_counted() {
        let pyramid = "OFF\n5 5 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 0.5 1\n4 3 2 1 0\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";
        let (text, is_sound) = check(pyramid);
        assert!(
            is_sound
                && text.contains("a polygonal half-edge mesh")
                && text.contains("5 vertices, 8 edges, 5 faces, 0 boundary loops; Euler characteristic 2"),
            "{text}"
        );
    }

    #[test]
    fn a_face_that_cannot_be_used_and_a_vertex_that_is_nowhere_are_told_and_a_triangular_mesh_is_called_so() {
        let points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
        let solid = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
        let with = |vertices: u32, more_points: &str, faces: u32, more_faces: &str| {
            check(&format!("OFF\n{vertices} {faces} 0\n{points}{more_points}{solid}{more_faces}"))
        };
        let (text, is_sound) = with(4, "", 4, "");
        assert!(is_sound && text.contains("a triangular half-edge mesh"), "{text}");
        for (vertices, more_points, faces, more_faces, why) in [
            (4, "", 5, "3 0 8 1\n", "face 4 (line 11) names a vertex that the file does not have"),
            (4, "", 5, "2 0 1\n", "face 4 (line 11) has fewer than three corners"),
            (5, "nan 0 0\n", 4, "", "vertex 4 (line 7) has coordinates that are not finite"),
        ] {
            let (text, is_sound) = with(vertices, more_points, faces, more_faces);
            assert!(!is_sound && text.contains(why), "{text}");
        }
    }

    #[test]
    fn what_is_no_half_edge_mesh_is_told_with_the_element() {
        let (text, is_sound) = check("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n");
        assert!(!is_sound && text.contains("two faces run from vertex 0 to vertex 1"), "{text}");
    }
}
