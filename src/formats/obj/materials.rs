//! Face colours of an OBJ file from its material file.

use super::statements::DIALECT;
use crate::budget::{Budget, CHECK_EVERY};
use crate::formats::foreign::wide_text;
use crate::formats::words::{Words, check_text};
use crate::formats::{Place, ReadError};
use crate::mesh::{Color, Soup};
use rustc_hash::FxHashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Gives each face of `soup`, which was read from `obj`, the diffuse colour (and opacity, if stated) of its material in
/// `mtl`. Faces without a material or of one without a diffuse colour get none.
///
/// # Errors
/// A material file that cannot be read; a stopped budget.
pub fn color_faces(soup: &mut Soup, obj: &[u8], mtl: &[u8], budget: &Budget) -> Result<(), ReadError> {
    let colors = diffuse_colors(mtl)?;
    let (mut face_colors, _charged) = budget.vec::<Option<Color>>(soup.face_count as usize)?;
    let mut current = None;
    let mut words = Words::new(obj, 1, DIALECT);
    let mut statements = 0usize;
    while let Some(keyword) = words.next_word() {
        match keyword {
            b"usemtl" => current = colors.get(&*String::from_utf8_lossy(words.name_in_line())).copied(),
            b"f" => face_colors.push(current),
            _ => {}
        }
        words.next_line();
        statements += 1;
        if statements.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
    }
    face_colors.resize(soup.face_count as usize, None);
    soup.face_colors = face_colors;
    Ok(())
}

/// Diffuse colours by material name.
fn diffuse_colors(mtl: &[u8]) -> Result<FxHashMap<String, Color>, ReadError> {
    let expected = "a material file in UTF-8, without zero bytes";
    if let Some(found) = wide_text(mtl) {
        return Err(ReadError::unparseable(Place::Whole, found, expected));
    }
    check_text(mtl).map_err(|error| ReadError { expected: expected.to_owned(), ..error })?;
    // Names in other encodings than UTF-8 still match, because the OBJ file's are replaced alike.
    let text = String::from_utf8_lossy(mtl);
    let load = || tobj::load_mtl_buf(&mut text.as_bytes());
    // The crate panics on some malformed input; it keeps no state that a panic could leave broken.
    let loaded = catch_unwind(AssertUnwindSafe(load));
    let unreadable =
        |why: &str| ReadError::unparseable(Place::Whole, why, "a material file that tobj can read");
    let materials = match loaded {
        Ok(Ok((materials, _by_name))) => materials,
        Ok(Err(error)) => return Err(unreadable(&error.to_string())),
        Err(_panic) => return Err(unreadable("what makes tobj panic")),
    };
    let color = |rgb, opacity| Color::Floats(rgb, opacity);
    Ok(materials.into_iter().filter_map(|m| Some((m.name, color(m.diffuse?, m.dissolve)))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{Encoding, ReadOptions, read};

    const OBJ: &[u8] =
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl r\xF6t \nf 1 2 3\nf 1 2\nusemtl other\nf 1 2 3\n";

    fn colors(mtl: &[u8]) -> Result<Vec<Option<Color>>, ReadError> {
        let budget = Budget::unlimited();
        let mut soup = read(OBJ, Encoding::Obj, &ReadOptions::default(), &budget).unwrap();
        color_faces(&mut soup, OBJ, mtl, &budget)?;
        assert_eq!(soup.check(), Vec::<String>::new());
        Ok(soup.face_colors)
    }

    #[test]
    fn each_face_has_the_diffuse_colour_of_its_material() {
        let red = Color::Floats([1.0, 0.25, 0.0], Some(0.5));
        let found = colors(b"newmtl r\xF6t\nKd 1 0.25 0\nd 0.5\nmap_Kd a.png\nnewmtl plain\n").unwrap();
        assert_eq!(found, [None, Some(red), Some(red), None]);
    }

    #[test]
    fn a_material_file_in_wide_letters_or_with_zero_bytes_is_an_error() {
        let text = "newmtl r\nKd 1 0 0\n";
        let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        for wide in [little, big] {
            let told = colors(&wide).unwrap_err().to_string();
            assert_eq!(told, "found text in UTF-16; expected a material file in UTF-8, without zero bytes");
        }
        let told = colors(b"newmtl a\nKd 1\0 0 0\n").unwrap_err().to_string();
        assert_eq!(told, "line 2: found a zero byte; expected a material file in UTF-8, without zero bytes");
    }

    #[test]
    fn a_material_file_that_makes_the_reader_panic_is_an_error() {
        assert!(colors(b"newmtl a\nKd 1.0\n").is_err());
        assert!(colors(b"newmtl a\nKd x y z\n").is_err());
    }
}
