//! What faces are made of, by the names that a file gives.

use super::color::Color;
use std::sync::Arc;

/// In the place of the number of a material: the face has none.
pub const NO_MATERIAL: u32 = u32::MAX;

/// Materials of faces. All lists are empty when no face has one.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Materials {
    /// The files that describe them, as the file names them (`mtllib` of OBJ), in its encoding.
    pub libraries: Vec<Vec<u8>>,
    /// Their names (`usemtl` of OBJ), in the encoding of the file.
    pub names: Vec<Vec<u8>>,
    /// For each face of the file the number of its material, or [`NO_MATERIAL`].
    pub of_face: Vec<u32>,
    /// What the file says of them beyond their names, where it holds that itself.
    pub descriptions: Option<Arc<Descriptions>>,
}

/// What a glTF file says of its materials, kept as it stands.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Descriptions {
    /// A JSON object with the arrays `materials` (one for each name), `textures`, `samplers` and `images` of glTF 2.0; the
    /// `bufferView` of an image is the number of its picture, and all textures take the first set of coordinates.
    pub json: Vec<u8>,
    /// Pictures, as the files that they are.
    pub pictures: Vec<Vec<u8>>,
    /// The colour of each material that states one and has no picture for it.
    pub colors: Vec<Option<Color>>,
}

impl Materials {
    /// True when no face has a material.
    pub fn is_empty(&self) -> bool {
        self.of_face.is_empty()
    }

    /// The material of face `f`, if it has one.
    pub fn of(&self, f: u32) -> Option<u32> {
        self.of_face.get(f as usize).copied().filter(|&material| material != NO_MATERIAL)
    }

    /// The same materials on other faces, each of which is made of one of these or of none.
    #[must_use]
    pub fn on(&self, faces: impl Iterator<Item = Option<u32>>) -> Self {
        if self.is_empty() {
            return Self::default();
        }
        let of_face: Vec<u32> = faces.map(|f| f.and_then(|f| self.of(f)).unwrap_or(NO_MATERIAL)).collect();
        if of_face.iter().all(|&material| material == NO_MATERIAL) {
            return Self::default();
        }
        Self {
            libraries: self.libraries.clone(),
            names: self.names.clone(),
            of_face,
            descriptions: self.descriptions.clone(),
        }
    }
}
