//! The mesh of an object: vertices, triangles and what is said of triangles.

use super::model::{FaceAttributes, NO_NUMBER, ObjectMesh, Property};
use super::model_reader::{ModelReader, number};
use super::package::{shortened, too_large};
use super::xml::{Namespace, RawAttributes, XmlElement};
use crate::budget::CHECK_EVERY;
use crate::formats::{ReadError, numbers};
use crate::geom::DVec3;
use crate::mesh::{FaceFault, FaceFaultReason, Soup};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Reads the content of the element `mesh`.
pub(super) fn mesh<'x>(
    reader: &mut ModelReader<'x>,
    element: &XmlElement<'x>,
) -> Result<ObjectMesh, ReadError> {
    let mut mesh = ObjectMesh::default();
    let mut triangles = ListedTriangles::default();
    if element.is_empty {
        return Ok(mesh);
    }
    let depth = reader.scanner.depth;
    while let Some(child) = reader.next_child(depth)? {
        let list = match (child.namespace, child.local) {
            (Namespace::Core, "vertices") => 0,
            (Namespace::Core, "triangles") => 1,
            (namespace, local) => {
                // What speaks of a mesh by number goes with it.
                let kept = "where the mesh stays as it is";
                match namespace {
                    Namespace::BeamLattice => reader.note_extension("a beam lattice", kept),
                    Namespace::TriangleSets => reader.note_extension("sets of triangles", kept),
                    _ => {}
                }
                mesh.extras.push(local.to_owned());
                reader.scanner.skip(&child)?;
                mesh.extra_spans.push(child.at..reader.scanner.position());
                continue;
            }
        };
        if !mesh.spans[list].is_empty() {
            return Err(reader.error(child.at, &format!("a second <{}> of a mesh", child.name), "one"));
        }
        if !child.is_empty {
            match list {
                0 => read_vertices(reader, &mut mesh.soup)?,
                _ => triangles.read(reader)?,
            }
        }
        mesh.spans[list] = child.at..reader.scanner.position();
    }
    triangles.put_into(&mut mesh, reader)?;
    Ok(mesh)
}

fn read_vertices(reader: &mut ModelReader<'_>, soup: &mut Soup) -> Result<(), ReadError> {
    let (precision, limit) = (reader.options.precision, reader.options.limits.vertices_max);
    let mut is_f32_exact = true;
    let depth = reader.scanner.depth;
    while let Some(element) = reader.next_child(depth)? {
        if (element.namespace, element.local) != (Namespace::Core, "vertex") {
            reader.scanner.skip(&element)?;
            continue;
        }
        let mut point = [None; 3];
        for attribute in RawAttributes::of(element.attributes) {
            let Ok((key, value)) = attribute else {
                return Err(bad(reader, &element));
            };
            let k = match key {
                "x" => 0,
                "y" => 1,
                "z" => 2,
                _ => continue,
            };
            point[k] = numbers::coordinate(value.trim_ascii().as_bytes(), precision);
        }
        let [Some(x), Some(y), Some(z)] = point else { return Err(bad(reader, &element)) };
        if soup.positions.len() >= limit as usize {
            return Err(too_large("vertices", "vertices_max", limit.into(), u64::from(limit) + 1));
        }
        let p = DVec3::new(x, y, z);
        is_f32_exact &= p.as_vec3().as_dvec3() == p;
        if !p.is_finite() {
            soup.non_finite_vertices.push(soup.positions.len() as u32);
        }
        soup.positions.push(p);
        reader.scanner.skip(&element)?;
    }
    soup.is_f32_exact = is_f32_exact;
    Ok(())
}

fn bad(reader: &ModelReader<'_>, element: &XmlElement<'_>) -> ReadError {
    let found = format!("<{}{}>", element.name, shortened(element.attributes));
    let expected = match element.local {
        "vertex" => "x, y and z with a number each",
        _ => "v1, v2 and v3 with the number of a vertex each",
    };
    reader.error(element.at, &found, expected)
}

/// The triangles of a mesh as they are listed.
#[derive(Default)]
struct ListedTriangles {
    corners: Vec<[u32; 3]>,
    attributes: FaceAttributes,
    numbers: FxHashMap<String, u32>,
}

impl ListedTriangles {
    fn read(&mut self, reader: &mut ModelReader<'_>) -> Result<(), ReadError> {
        let limit = reader.options.limits.triangles_max;
        let depth = reader.scanner.depth;
        let mut text = String::new();
        while let Some(element) = reader.next_child(depth)? {
            if (element.namespace, element.local) != (Namespace::Core, "triangle") {
                reader.scanner.skip(&element)?;
                continue;
            }
            let (mut corners, mut property) = ([None; 3], Property::NONE);
            text.clear();
            for attribute in RawAttributes::of(element.attributes) {
                let Ok((key, value)) = attribute else { return Err(bad(reader, &element)) };
                match key {
                    "v1" => corners[0] = corner(value),
                    "v2" => corners[1] = corner(value),
                    "v3" => corners[2] = corner(value),
                    "pid" => property.group = number(value).unwrap_or(NO_NUMBER),
                    "p1" => property.members[0] = number(value).unwrap_or(NO_NUMBER),
                    "p2" => property.members[1] = number(value).unwrap_or(NO_NUMBER),
                    "p3" => property.members[2] = number(value).unwrap_or(NO_NUMBER),
                    _ => {
                        let quote = if value.contains('"') { '\'' } else { '"' };
                        for piece in [if text.is_empty() { "" } else { " " }, key, "="] {
                            text.push_str(piece);
                        }
                        text.push(quote);
                        text.push_str(value);
                        text.push(quote);
                    }
                }
            }
            let [Some(a), Some(b), Some(c)] = corners else { return Err(bad(reader, &element)) };
            if self.corners.len() >= limit as usize {
                return Err(too_large("triangles", "triangles_max", limit.into(), u64::from(limit) + 1));
            }
            self.take([a, b, c], property, &text);
            reader.scanner.skip(&element)?;
        }
        Ok(())
    }

    fn take(&mut self, corners: [u32; 3], property: Property, text: &str) {
        let (face, attributes) = (self.corners.len(), &mut self.attributes);
        self.corners.push(corners);
        if property != Property::NONE || !attributes.properties.is_empty() {
            attributes.properties.resize(face, Property::NONE);
            attributes.properties.push(property);
        }
        if text.is_empty() && attributes.others.is_empty() {
            return;
        }
        attributes.others.resize(face, NO_NUMBER);
        let number = match self.numbers.get(text) {
            _ if text.is_empty() => NO_NUMBER,
            Some(&number) => number,
            None => {
                let number = attributes.texts.len() as u32;
                Arc::make_mut(&mut attributes.texts).push(text.to_owned());
                self.numbers.insert(text.to_owned(), number);
                number
            }
        };
        attributes.others.push(number);
    }

    /// Checks the corners against the vertices.
    fn put_into(self, mesh: &mut ObjectMesh, reader: &ModelReader<'_>) -> Result<(), ReadError> {
        let Self { corners, mut attributes, .. } = self;
        let count = corners.len();
        if !attributes.properties.is_empty() {
            attributes.properties.resize(count, Property::NONE);
        }
        if !attributes.others.is_empty() {
            attributes.others.resize(count, NO_NUMBER);
        }
        let soup = &mut mesh.soup;
        let vertices = soup.positions.len();
        let is_all_finite = soup.non_finite_vertices.is_empty();
        let fault = |corners: &[u32; 3], positions: &[DVec3]| {
            if corners.iter().any(|&v| v as usize >= vertices) {
                Some(FaceFaultReason::IndexOutOfRange)
            } else if !is_all_finite && corners.iter().any(|&v| !positions[v as usize].is_finite()) {
                Some(FaceFaultReason::NonFinite)
            } else {
                None
            }
        };
        soup.face_count = count as u32;
        for (face, corners) in corners.iter().enumerate() {
            if face % CHECK_EVERY == 0 {
                reader.budget.check()?;
            }
            match fault(corners, &soup.positions) {
                None => {
                    soup.triangle_face.push(face as u32);
                    soup.triangles.push(*corners);
                }
                Some(reason) => soup.face_faults.push(FaceFault { face: face as u32, reason }),
            }
        }
        if soup.face_faults.is_empty() {
            soup.triangle_face = Vec::new();
        }
        mesh.attributes = attributes;
        Ok(())
    }
}

/// The number of a vertex; what no file can have is out of range.
fn corner(value: &str) -> Option<u32> {
    numbers::integer(value.trim_ascii().as_bytes()).map(numbers::index)
}
