//! The names of materials of an OBJ file.
//!
//! They say nothing of the shape, so nothing in them makes a file unreadable: what cannot be used is taken as absent.

use crate::budget::Stopped;
use crate::formats::decimals::Text;
use crate::mesh::{Materials, NAME_BYTES_MAX, NO_MATERIAL};
use std::collections::HashMap;

/// Materials of a part of a file.
#[derive(Debug, Default)]
pub(super) struct MaterialStatements<'a> {
    pub(super) libraries: Vec<&'a [u8]>,
    /// The number of faces of the part before each `usemtl`, ascending, with the name; of several before one face the last.
    pub(super) uses: Vec<(u32, &'a [u8])>,
}

impl<'a> MaterialStatements<'a> {
    /// Notes that the faces after the first `faces` are made of the material of this name.
    pub(super) fn use_from(&mut self, faces: u32, name: &'a [u8]) {
        let name = if name.len() > NAME_BYTES_MAX || name == NO_NAME { &[] } else { name };
        match self.uses.last_mut() {
            Some(last) if last.0 == faces => last.1 = name,
            _ => self.uses.push((faces, name)),
        }
    }
}

/// The materials of a whole file, part by part.
#[derive(Debug, Default)]
pub(super) struct MaterialsOfFile<'a> {
    libraries: Vec<&'a [u8]>,
    /// Seeded, since the file chooses the names.
    names: HashMap<&'a [u8], u32>,
    of_face: Vec<u32>,
    current: Option<u32>,
}

impl<'a> MaterialsOfFile<'a> {
    /// Adds a part of `faces` faces.
    pub(super) fn append(&mut self, part: &MaterialStatements<'a>, faces: usize) {
        self.libraries.extend(&part.libraries);
        let end = self.of_face.len() + faces;
        let begin = self.of_face.len();
        for &(before, name) in &part.uses {
            self.of_face.resize(begin + before as usize, self.current.unwrap_or(NO_MATERIAL));
            let next = self.names.len() as u32;
            self.current = (!name.is_empty()).then(|| *self.names.entry(name).or_insert(next));
        }
        self.of_face.resize(end, self.current.unwrap_or(NO_MATERIAL));
    }

    pub(super) fn into_materials(self) -> Materials {
        if self.of_face.iter().all(|&material| material == NO_MATERIAL) {
            return Materials::default();
        }
        let mut names: Vec<(u32, &[u8])> =
            self.names.into_iter().map(|(name, number)| (number, name)).collect();
        names.sort_unstable();
        let mut libraries: Vec<Vec<u8>> = self.libraries.into_iter().map(<[u8]>::to_vec).collect();
        libraries.dedup();
        Materials {
            libraries,
            names: names.into_iter().map(|(_, name)| name.to_vec()).collect(),
            of_face: self.of_face,
            descriptions: None,
        }
    }
}

/// Writes the files that describe the materials.
pub(super) fn put_libraries(text: &mut Text<'_>, materials: &Materials) {
    for library in &materials.libraries {
        text.word("mtllib ");
        put_name(text, library);
        text.word("\n");
    }
}

/// Writes a name, which may be one of a format whose names hold anything, so that it stays in its line: line breaks, zero bytes and a
/// backslash at the end become `_`.
pub(super) fn put_name(text: &mut Text<'_>, name: &[u8]) {
    let last = name.len().saturating_sub(1);
    for (i, &byte) in name.iter().enumerate() {
        let would_end_line = matches!(byte, b'\n' | b'\r' | 0) || (i == last && byte == b'\\');
        text.bytes(if would_end_line { b"_" } else { std::slice::from_ref(&byte) });
    }
}

/// What faces without a material are said to be made of after others, as Blender does: the format has no way back to none.
const NO_NAME: &[u8] = b"(null)";

/// Writes changes of the material from face to face.
#[derive(Default)]
pub(super) struct MaterialWriter {
    current: Option<u32>,
    changes: usize,
}

impl MaterialWriter {
    /// To be called before each face.
    pub(super) fn before_face(
        &mut self,
        text: &mut Text<'_>,
        materials: &Materials,
        face: u32,
    ) -> Result<(), Stopped> {
        const USE_BYTES_MAX: usize = NAME_BYTES_MAX + 8;
        let material = materials.of(face);
        if material != self.current {
            text.before_item(self.changes, USE_BYTES_MAX)?;
            self.changes += 1;
            text.word("usemtl ");
            put_name(text, material.map_or(NO_NAME, |m| &materials.names[m as usize]));
            text.word("\n");
            self.current = material;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Budget;
    use crate::formats::{Encoding, ReadOptions, read, write};
    use crate::mesh::Soup;

    const POINTS: &str = "mtllib a b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";

    fn soup(rest: &str) -> Soup {
        let text = format!("{POINTS}{rest}");
        let soup =
            read(text.as_bytes(), Encoding::Obj, &ReadOptions::default(), &Budget::unlimited()).unwrap();
        assert_eq!(soup.check(), Vec::<String>::new());
        soup
    }

    #[test]
    fn faces_have_the_material_before_them_and_keep_it_when_they_are_written() {
        let long = "x".repeat(300);
        let read = soup(&format!(
            "f 1 2 3\nusemtl wood\nusemtl a b \nf 1 2 3\nf 1 2 4 3\nusemtl tin\nf 3 2 1\nusemtl a b\nf 1 2 3\nusemtl {long}\nf 1 2 3\nusemtl\nf 1 3 2\n"
        ));
        let names: Vec<&[u8]> = read.materials.names.iter().map(Vec::as_slice).collect();
        assert_eq!(
            (names, &read.materials.libraries[..]),
            (vec![&b"a b"[..], b"tin"], &[b"a b.mtl".to_vec()][..])
        );
        assert_eq!(read.materials.of_face, [NO_MATERIAL, 0, 0, 1, 0, NO_MATERIAL, NO_MATERIAL]);
        let text = write(&read, Encoding::Obj, &Budget::unlimited()).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert!(text.starts_with("mtllib a b.mtl\nv "), "{text}");
        let faces = text.split_once("f 1 2 3\n").unwrap().1;
        let wanted = "usemtl a b\nf 1 2 3\nf 1 2 4 3\nusemtl tin\nf 3 2 1\nusemtl a b\nf 1 2 3\nusemtl (null)\nf 1 2 3\nf 1 3 2\n";
        assert_eq!(faces, wanted);
        let again = soup(text.strip_prefix(POINTS).unwrap());
        assert_eq!(again.materials, read.materials);
    }

    #[test]
    fn a_file_without_a_material_in_use_has_none() {
        for rest in ["f 1 2 3\n", "f 1 2 3\nusemtl late\n", "usemtl\nf 1 2 3\n"] {
            assert_eq!(soup(rest).materials, Materials::default(), "{rest}");
        }
    }
}
