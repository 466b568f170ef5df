//! The objects that faces belong to, by the names that a file gives.

/// In the place of the number of an object: the face belongs to none.
pub const NO_OBJECT: u32 = u32::MAX;

/// A file with more of them is read as if it had none.
pub const OBJECTS_MAX: usize = 1 << 16;

/// Longer names, in bytes, are taken as absent, so that a result is not much longer than its file.
pub const NAME_BYTES_MAX: usize = 255;

/// The names of an object, in the encoding of the file; empty where it has none.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash)]
pub struct ObjectName {
    /// `o` of OBJ, the name of a node of glTF.
    pub object: Vec<u8>,
    /// `g` of OBJ, the name of the mesh of a node of glTF.
    pub group: Vec<u8>,
}

/// Objects of faces: what OBJ calls objects and groups, and the nodes of glTF. Both lists are empty when the file has none.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Objects {
    /// Of each object; several may have the same.
    pub names: Vec<ObjectName>,
    /// For each face of the file the number of its object, or [`NO_OBJECT`].
    pub of_face: Vec<u32>,
}

impl Objects {
    /// True when no face has one.
    pub fn is_empty(&self) -> bool {
        self.of_face.is_empty()
    }

    /// How many have a face.
    pub fn in_use(&self) -> u64 {
        let mut is_used = vec![false; self.names.len()];
        self.of_face.iter().filter(|&&object| object != NO_OBJECT).for_each(|&o| is_used[o as usize] = true);
        is_used.into_iter().filter(|&is_used| is_used).count() as u64
    }

    /// The object of face `f`, if it has one.
    pub fn of(&self, f: u32) -> Option<u32> {
        self.of_face.get(f as usize).copied().filter(|&object| object != NO_OBJECT)
    }

    /// The same objects of other faces, each of which belongs where one of these does or to none.
    #[must_use]
    pub fn on(&self, faces: impl Iterator<Item = Option<u32>>) -> Self {
        if self.is_empty() {
            return Self::default();
        }
        let of_face: Vec<u32> = faces.map(|f| f.and_then(|f| self.of(f)).unwrap_or(NO_OBJECT)).collect();
        if of_face.iter().all(|&object| object == NO_OBJECT) {
            return Self::default();
        }
        Self { names: self.names.clone(), of_face }
    }
}
