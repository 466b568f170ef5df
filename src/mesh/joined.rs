//! Several soups as one.

use super::materials::{Materials, NO_MATERIAL};
use super::objects::{NO_OBJECT, Objects};
use super::soup::Soup;
use super::texture::{NO_POINT, Texture};
use crate::geom::DVec3;

impl Soup {
    /// The triangles of all `soups`, one after the other, with their colours, texture coordinates, materials and
    /// objects. What has no triangle stays out, and so do polygons as such and places in files.
    pub fn joined(soups: &[Self]) -> Self {
        let mut joined = Self { is_f32_exact: soups.iter().all(|soup| soup.is_f32_exact), ..Self::default() };
        let has = |is_there: fn(&Self) -> bool| soups.iter().any(is_there);
        let has_vertex_colors = has(|soup| !soup.vertex_colors.is_empty());
        let has_face_colors = has(|soup| !soup.face_colors.is_empty());
        let has_texture = has(|soup| !soup.texture.is_empty());
        let has_materials = has(|soup| !soup.materials.is_empty());
        let has_objects = has(|soup| !soup.objects.is_empty());
        for soup in soups {
            let first = joined.positions.len() as u32;
            joined.positions.extend(&soup.positions);
            joined.triangles.extend(soup.triangles.iter().map(|t| t.map(|v| first + v)));
            let faces = (0..soup.triangles.len() as u32).map(|t| joined.face_count + soup.face_of(t));
            joined.triangle_face.extend(faces);
            joined.face_count += soup.face_count;
            if has_vertex_colors {
                joined.vertex_colors.extend(&soup.vertex_colors);
                joined.vertex_colors.resize(joined.positions.len(), None);
            }
            if has_face_colors {
                joined.face_colors.extend(&soup.face_colors);
                joined.face_colors.resize(joined.face_count as usize, None);
            }
            if has_texture {
                joined.texture.extend(&soup.texture, joined.triangles.len());
            }
            if has_materials {
                joined.materials.extend(&soup.materials, joined.face_count as usize);
            }
            if has_objects {
                joined.objects.extend(&soup.objects, joined.face_count as usize);
            }
        }
        joined
    }

    /// Adds triangles over points of their own, which have no colour, no texture, no material and no object. The soup has no
    /// polygons as such.
    pub fn add_plain(&mut self, positions: &[DVec3], triangles: &[[u32; 3]]) {
        let first = self.positions.len() as u32;
        self.positions.extend(positions);
        self.triangles.extend(triangles.iter().map(|t| t.map(|v| first + v)));
        let faces = self.face_count as usize + triangles.len();
        if !self.triangle_face.is_empty() {
            self.triangle_face.extend(self.face_count..faces as u32);
        }
        self.face_count = faces as u32;
        if !self.vertex_colors.is_empty() {
            self.vertex_colors.resize(self.positions.len(), None);
        }
        if !self.face_colors.is_empty() {
            self.face_colors.resize(faces, None);
        }
        if !self.texture.is_empty() {
            self.texture.corners.resize(self.triangles.len(), [NO_POINT; 3]);
        }
        if !self.materials.is_empty() {
            self.materials.of_face.resize(faces, NO_MATERIAL);
        }
        if !self.objects.is_empty() {
            self.objects.of_face.resize(faces, NO_OBJECT);
        }
    }
}

impl Texture {
    /// Adds that of further triangles; there are `triangles` then.
    fn extend(&mut self, other: &Self, triangles: usize) {
        let first = self.points.len() as u32;
        let shifted = |i: u32| if i == NO_POINT { i } else { first + i };
        self.points.extend(&other.points);
        self.corners.extend(other.corners.iter().map(|corners| corners.map(shifted)));
        self.corners.resize(triangles, [NO_POINT; 3]);
    }
}

impl Materials {
    /// Adds those of further faces; there are `faces` then.
    fn extend(&mut self, other: &Self, faces: usize) {
        let first = self.names.len() as u32;
        let shifted = |m: u32| if m == NO_MATERIAL { m } else { first + m };
        for library in &other.libraries {
            if !self.libraries.contains(library) {
                self.libraries.push(library.clone());
            }
        }
        self.names.extend(other.names.iter().cloned());
        self.of_face.extend(other.of_face.iter().map(|&m| shifted(m)));
        self.of_face.resize(faces, NO_MATERIAL);
    }
}

impl Objects {
    /// Adds those of further faces; there are `faces` then.
    fn extend(&mut self, other: &Self, faces: usize) {
        let first = self.names.len() as u32;
        let shifted = |o: u32| if o == NO_OBJECT { o } else { first + o };
        self.names.extend(other.names.iter().cloned());
        self.of_face.extend(other.of_face.iter().map(|&o| shifted(o)));
        self.of_face.resize(faces, NO_OBJECT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Color;

    #[test]
    fn each_triangle_keeps_its_attributes_and_has_none_that_its_soup_lacks() {
        let plain = Soup {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2]],
            face_count: 2,
            triangle_face: vec![1],
            ..Soup::default()
        };
        let rich = Soup {
            vertex_colors: vec![Some(Color::Index(1)); 3],
            face_colors: vec![None, Some(Color::Index(2))],
            texture: Texture { points: vec![[0.0; 2], [0.5; 2]], corners: vec![[0, 1, 1]] },
            materials: Materials {
                libraries: vec![b"a.mtl".to_vec()],
                names: vec![b"oak".to_vec()],
                of_face: vec![NO_MATERIAL, 0],
                descriptions: None,
            },
            ..plain.clone()
        };
        let joined = Soup::joined(&[rich.clone(), plain, rich]);
        assert_eq!(joined.check(), Vec::<String>::new());
        assert_eq!(joined.triangles, [[0, 1, 2], [3, 4, 5], [6, 7, 8]]);
        assert_eq!((joined.triangle_face, joined.face_count), (vec![1, 3, 5], 6));
        assert_eq!(joined.vertex_colors[2..4], [Some(Color::Index(1)), None]);
        assert_eq!(joined.face_colors[1..4], [Some(Color::Index(2)), None, None]);
        assert_eq!(joined.texture.corners, [[0, 1, 1], [NO_POINT; 3], [2, 3, 3]]);
        assert_eq!(joined.materials.of_face[1..], [0, NO_MATERIAL, NO_MATERIAL, NO_MATERIAL, 1]);
        assert_eq!(joined.materials.libraries.len(), 1);
    }

    #[test]
    fn plain_triangles_have_an_empty_place_in_every_list() {
        let mut soup = Soup {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2]],
            face_count: 1,
            vertex_colors: vec![Some(Color::Index(1)); 3],
            face_colors: vec![Some(Color::Index(2))],
            texture: Texture { points: vec![[0.5; 2]], corners: vec![[0; 3]] },
            materials: Materials { names: vec![b"oak".to_vec()], of_face: vec![0], ..Materials::default() },
            ..Soup::default()
        };
        let positions = soup.positions.clone();
        soup.add_plain(&positions, &[[0, 2, 1], [0, 1, 2]]);
        assert_eq!(soup.check(), Vec::<String>::new());
        assert_eq!(soup.triangles, [[0, 1, 2], [3, 5, 4], [3, 4, 5]]);
        assert_eq!(soup.texture.corners, [[0; 3], [NO_POINT; 3], [NO_POINT; 3]]);
        assert_eq!((soup.materials.of(0), soup.materials.of(2)), (Some(0), None));
        assert_eq!((soup.vertex_colors[5], soup.face_colors[1]), (None, None));
    }
}
