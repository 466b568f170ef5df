//! What a file says, before anyone judges it.

use super::color::Color;
use super::materials::{Materials, NO_MATERIAL};
use super::objects::{NO_OBJECT, Objects};
use super::texture::{NO_POINT, Texture};
use super::units::Units;
use crate::geom::DVec3;

/// Why a face of the file has no triangles in the soup.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FaceFaultReason {
    /// A corner's coordinates are NaN or infinite.
    NonFinite,
    /// A corner names a vertex that the file does not have.
    IndexOutOfRange,
    /// Fewer than three corners.
    TooFewCorners,
}

/// A face of the file that could not be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaceFault {
    /// Number of the face in the file, from 0.
    pub face: u32,
    /// What is wrong with it.
    pub reason: FaceFaultReason,
}

/// The faces with more than three corners, in file order, with their corners as the file lists them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Polygons {
    /// Number of the face in the file, from 0.
    pub faces: Vec<u32>,
    /// Where the corners of polygon `i` begin in `corners`; one more entry than polygons, or none at all.
    pub starts: Vec<u32>,
    /// Vertex ids.
    pub corners: Vec<u32>,
    /// First triangle of polygon `i` in the soup; a polygon of `n` corners has `n - 2` consecutive triangles.
    pub first_triangles: Vec<u32>,
    /// Polygons (indices into the lists here) whose triangles are not the fan around their first corner.
    pub not_fans: Vec<u32>,
}

/// An edge that the file states by itself and not as a side of a face (`l` of OBJ, `edge` of PLY).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Segment {
    /// Vertex ids of its ends.
    pub ends: [u32; 2],
    /// Its 1-based line in a text file.
    pub line: Option<u32>,
}

/// Where elements stand in a text file: 1-based lines. Empty lists when the format is not made of lines.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Places {
    /// Line of each face of the file.
    pub face_lines: Vec<u32>,
    /// Line of each vertex of the file.
    pub vertex_lines: Vec<u32>,
}

/// Triangles as a file gives them: any set of points and index triples, possibly broken in every way.
///
/// Invariants: every index in `triangles` is in range and its position finite; indices inside a triangle may repeat.
/// Unused positions may be NaN or infinite.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Soup {
    /// Vertex positions, in the unit of the file.
    pub positions: Vec<DVec3>,
    /// Vertex ids of each triangle's corners.
    pub triangles: Vec<[u32; 3]>,
    /// Face of the file behind each triangle; empty when triangle `t` is face `t`.
    pub triangle_face: Vec<u32>,
    /// Number of faces in the file, used or not.
    pub face_count: u32,
    /// Faces with more than three corners.
    pub polygons: Polygons,
    /// Faces that have no triangle here, in file order.
    pub face_faults: Vec<FaceFault>,
    /// Edges that the file states by themselves, in file order; those of vertices that it does not have are left out.
    pub segments: Vec<Segment>,
    /// Vertices whose coordinates are NaN or infinite, in file order.
    pub non_finite_vertices: Vec<u32>,
    /// Lines of faces and vertices.
    pub places: Places,
    /// True when the format has no indices (STL) or one set of them for all attributes (glTF), so that it cannot but repeat
    /// positions: bit-equal ones are one vertex, numbered by first use.
    pub is_welded_by_format: bool,
    /// True when every coordinate is exactly a float32, so both readings of the contract are the same.
    pub is_f32_exact: bool,
    /// Colour of each vertex; empty when the file has none.
    pub vertex_colors: Vec<Option<Color>>,
    /// Colour of each face of the file; empty when the file has none.
    pub face_colors: Vec<Option<Color>>,
    /// Texture coordinates of the corners of triangles.
    pub texture: Texture,
    /// Materials of the faces of the file.
    pub materials: Materials,
    /// Objects of the faces of the file.
    pub objects: Objects,
    /// What the file has beside its mesh and no new file takes over, by name and number.
    pub left_out: Vec<(&'static str, u64)>,
    /// Unit of the positions, where the format states one.
    pub units: Option<Units>,
}

impl Polygons {
    /// The corners of polygon `i`, as vertices of the file.
    pub fn corners_of(&self, i: usize) -> &[u32] {
        &self.corners[self.starts[i] as usize..self.starts[i + 1] as usize]
    }
}

impl Soup {
    /// The face of the file behind triangle `t`.
    pub fn face_of(&self, t: u32) -> u32 {
        if self.triangle_face.is_empty() { t } else { self.triangle_face[t as usize] }
    }

    /// The faces in the order of their triangles: each polygon by its corners, each other triangle by its own, with the
    /// first triangle of the face.
    pub fn faces(&self) -> impl Iterator<Item = (u32, &[u32])> {
        let (mut next, mut polygon) = (0, 0);
        std::iter::from_fn(move || {
            let first = next;
            if self.polygons.first_triangles.get(polygon) == Some(&first) {
                let corners = self.polygons.corners_of(polygon);
                polygon += 1;
                next += corners.len() as u32 - 2;
                return Some((first, corners));
            }
            next += 1;
            Some((first, self.triangles.get(first as usize)?.as_slice()))
        })
    }

    /// The three corners of triangle `t`.
    pub fn corners(&self, t: u32) -> [DVec3; 3] {
        self.triangles[t as usize].map(|v| self.positions[v as usize])
    }

    /// Broken invariants, as sentences; empty when all hold.
    pub fn check(&self) -> Vec<String> {
        let mut broken = Vec::new();
        let vertex_count = self.positions.len();
        for (t, corners) in self.triangles.iter().enumerate() {
            for &v in corners {
                if v as usize >= vertex_count {
                    broken.push(format!("triangle {t} names vertex {v} of {vertex_count}"));
                } else if !self.positions[v as usize].is_finite() {
                    broken.push(format!("triangle {t} uses vertex {v}, which is not finite"));
                }
            }
        }
        if !self.triangle_face.is_empty() && self.triangle_face.len() != self.triangles.len() {
            broken.push("triangle_face has another length than triangles".to_owned());
        }
        if let Some(f) = self.triangle_face.iter().find(|&&f| f >= self.face_count) {
            broken.push(format!("a triangle belongs to face {f} of {}", self.face_count));
        }
        for (name, len, want) in [
            ("vertex_colors", self.vertex_colors.len(), vertex_count),
            ("materials.of_face", self.materials.of_face.len(), self.face_count as usize),
            ("objects.of_face", self.objects.of_face.len(), self.face_count as usize),
            ("face_colors", self.face_colors.len(), self.face_count as usize),
            ("places.face_lines", self.places.face_lines.len(), self.face_count as usize),
            ("places.vertex_lines", self.places.vertex_lines.len(), vertex_count),
        ] {
            if len != 0 && len != want {
                broken.push(format!("{name} has {len} entries for {want}"));
            }
        }
        if let Some(segment) =
            self.segments.iter().find(|s| s.ends.iter().any(|&v| v as usize >= vertex_count))
        {
            broken.push(format!("a segment names the vertices {:?} of {vertex_count}", segment.ends));
        }
        let names = self.materials.names.len();
        if let Some(m) = self.materials.of_face.iter().find(|&&m| m != NO_MATERIAL && m as usize >= names) {
            broken.push(format!("a face has material {m} of {names}"));
        }
        let objects = self.objects.names.len();
        if let Some(o) = self.objects.of_face.iter().find(|&&o| o != NO_OBJECT && o as usize >= objects) {
            broken.push(format!("a face has object {o} of {objects}"));
        }
        let texture = &self.texture;
        if !texture.is_empty() && texture.corners.len() != self.triangles.len() {
            broken.push("texture.corners has another length than triangles".to_owned());
        }
        for (t, corners) in texture.corners.iter().enumerate() {
            let is_good =
                |&i: &u32| texture.points.get(i as usize).is_some_and(|p| p.iter().all(|c| c.is_finite()));
            if *corners != [NO_POINT; 3] && !corners.iter().all(is_good) {
                broken.push(format!("triangle {t} has texture points that are none"));
            }
        }
        broken
    }
}
