//! What the file has beside its shape and a new file has not.

use super::Action;
use crate::formats::{BYTES_BEHIND, Encoding};
use crate::mesh::{Color, Soup};
use crate::repair::NEW;

/// What is said of it: of what no format takes over, of what was `lost` with changes of the mesh, and of the colours and objects of
/// `before` that the file read back as `after` does not hold.
pub(super) fn left_out(
    before: &Soup,
    lost: &[(&'static str, u64)],
    after: &Soup,
    encoding: Encoding,
) -> Option<Action> {
    let colors = lost_colors(before, after, encoding);
    let has_lost_all = colors[0].1 > 0;
    let opacities = Some(("opacities", lost_opacities(before, after))).filter(|&(_, count)| count > 0);
    let lost = lost.iter().copied().filter(|&(name, _)| !(has_lost_all && name == "colors_at_seams"));
    let colors = colors.into_iter().filter(|&(_, count)| count > 0);
    let objects = if after.objects.is_empty() { before.objects.in_use() } else { 0 };
    let objects = (objects > 0).then_some(("objects", objects));
    let changes: Vec<_> =
        before.left_out.iter().copied().chain(lost).chain(objects).chain(colors).chain(opacities).collect();
    if changes.is_empty() {
        return None;
    }
    let reason = "what the file has beside its mesh is not in the output".to_owned();
    let (step, causes) = ("left_out", Vec::new());
    Some(Action { step, causes, changes, move_max: 0.0, reason, stitches: None })
}

/// What is said of a file that goes on where its mesh has ended.
pub(super) fn remark_on_end(soup: &Soup) -> Option<String> {
    let (_, bytes) = soup.left_out.iter().find(|(what, _)| *what == BYTES_BEHIND)?;
    let faces = soup.face_count;
    Some(format!(
        "the file goes on after the faces that its header announces ({faces}); what follows was not read ({bytes} bytes)"
    ))
}

/// What is said of new triangles with the colours, texture and materials of faces of the file. `origins` name the triangles of `before`
/// behind those of `after`.
pub(super) fn taken_over(before: &Soup, after: &Soup, origins: &[u32]) -> Option<Action> {
    let has_color = |f: u32| after.face_colors.get(f as usize).is_some_and(Option::is_some);
    let new = || (0..).zip(origins).filter(|&(_, &origin)| origin == NEW).map(|(t, _)| after.face_of(t));
    let colors = if before.face_colors.is_empty() { 0 } else { new().filter(|&f| has_color(f)).count() };
    let materials = new().filter(|&f| after.materials.of(f).is_some()).count();
    let has_texture = |(t, &origin): (usize, &u32)| origin == NEW && after.texture.of_triangle(t).is_some();
    let texture = origins.iter().enumerate().filter(|&at| has_texture(at)).count();
    if colors == 0 && materials == 0 && texture == 0 {
        return None;
    }
    let changes = vec![
        ("triangles_with_color", colors as u64),
        ("triangles_with_material", materials as u64),
        ("triangles_with_texture", texture as u64),
    ];
    let reason =
        "new triangles have the colours, texture and materials of the nearest faces of the file".to_owned();
    let (step, causes) = ("taken_over", Vec::new());
    Some(Action { step, causes, changes, move_max: 0.0, reason, stitches: None })
}

/// The colours of vertices and of faces of which a new file holds none.
fn lost_colors(before: &Soup, after: &Soup, encoding: Encoding) -> [(&'static str, u64); 2] {
    let count = |colors: &[Option<Color>]| colors.iter().flatten().count() as u64;
    let has = |colors: &[Option<Color>]| colors.iter().any(Option::is_some);
    // A 3MF holds colours at the corners of faces, so that those of faces take the place of those of vertices.
    let at_corners = encoding == Encoding::ThreeMf && !has(&before.face_colors) && has(&after.face_colors);
    // The colours of an OBJ are in the file that describes its materials.
    let by_name =
        encoding == Encoding::Obj && !after.materials.is_empty() && !after.materials.libraries.is_empty();
    let of_vertices = if has(&after.vertex_colors) || at_corners { 0 } else { count(&before.vertex_colors) };
    let of_faces = if has(&after.face_colors) || by_name { 0 } else { count(&before.face_colors) };
    [("vertex_colors", of_vertices), ("face_colors", of_faces)]
}

/// The colours that are not opaque where `after` has colours, none of which says how opaque it is.
fn lost_opacities(before: &Soup, after: &Soup) -> u64 {
    let opacity = |color: &Color| match *color {
        Color::Bytes(_, alpha) => alpha.map(|alpha| f32::from(alpha) / 255.0),
        Color::Floats(_, alpha) | Color::Linear(_, alpha) => alpha,
        Color::Index(_) => None,
    };
    let lost = |before: &[Option<Color>], after: &[Option<Color>]| {
        let is_lost =
            after.iter().any(Option::is_some) && !after.iter().flatten().any(|c| opacity(c).is_some());
        let is_translucent = |color: &&Color| opacity(color).is_some_and(|opacity| opacity != 1.0);
        if is_lost { before.iter().flatten().filter(is_translucent).count() as u64 } else { 0 }
    };
    lost(&before.vertex_colors, &after.vertex_colors) + lost(&before.face_colors, &after.face_colors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Budget;
    use crate::formats::{Format, ReadOptions, read, write};
    use crate::geom::DVec3;
    use crate::mesh::Materials;

    /// What is said where `soup` is written as it is.
    fn told(soup: &Soup, format: Format) -> Vec<(&'static str, u64)> {
        let (encoding, budget) = (format.default_encoding(), Budget::unlimited());
        let bytes = write(soup, encoding, &budget).unwrap();
        let after = read(&bytes, encoding, &ReadOptions::default(), &budget).unwrap();
        left_out(soup, &[], &after, encoding).map_or(Vec::new(), |action| action.changes)
    }

    #[test]
    fn colours_that_a_format_cannot_hold_are_counted() {
        let red = Some(Color::Bytes([255, 0, 0], None));
        let plain = Soup {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2]],
            face_count: 1,
            ..Soup::default()
        };
        let vertices = Soup { vertex_colors: vec![red, None, red], ..plain.clone() };
        let faces = Soup { face_colors: vec![red], ..plain.clone() };
        let both = Soup { vertex_colors: vec![red; 3], ..faces.clone() };
        for format in Format::ALL {
            let of_vertices: &[_] = if format == Format::Stl { &[("vertex_colors", 2)] } else { &[] };
            let has_faces = !matches!(format, Format::Stl | Format::Obj);
            let of_faces: &[_] = if has_faces { &[] } else { &[("face_colors", 1)] };
            assert_eq!(told(&plain, format), [], "{format:?}");
            assert_eq!(told(&vertices, format), of_vertices, "{format:?}");
            assert_eq!(told(&faces, format), of_faces, "{format:?}");
            let of_both: &[_] = match format {
                Format::Ply | Format::Off => &[],
                Format::Stl => &[("vertex_colors", 3), ("face_colors", 1)],
                Format::ThreeMf => &[("vertex_colors", 3)],
                Format::Obj | Format::Glb | Format::Gltf => &[("face_colors", 1)],
            };
            assert_eq!(told(&both, format), of_both, "{format:?}");
        }
    }

    #[test]
    fn colours_of_materials_stay_where_their_file_is_named() {
        let materials = Materials {
            libraries: vec![b"a.mtl".to_vec()],
            names: vec![b"oak".to_vec()],
            of_face: vec![0],
            descriptions: None,
        };
        let mut soup = Soup {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2]],
            face_count: 1,
            face_colors: vec![Some(Color::Index(1))],
            materials,
            ..Soup::default()
        };
        assert_eq!(told(&soup, Format::Obj), []);
        soup.materials.libraries.clear();
        assert_eq!(told(&soup, Format::Obj), [("face_colors", 1)]);
    }

    #[test]
    fn colours_that_a_format_holds_without_their_opacity_are_counted() {
        let color = |alpha: u8| Some(Color::Bytes([9, 8, 7], Some(alpha)));
        let soup = Soup {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2]],
            face_count: 1,
            vertex_colors: vec![color(200), color(255), color(0)],
            ..Soup::default()
        };
        assert_eq!(told(&soup, Format::Obj), [("opacities", 2)]);
        for format in [Format::Ply, Format::Off, Format::Glb] {
            assert_eq!(told(&soup, format), [], "{format:?}");
        }
        assert_eq!(told(&soup, Format::Stl), [("vertex_colors", 3)], "which tells it all");
    }

    #[test]
    fn what_a_reader_counted_is_told_first() {
        let text = "o a\ng b\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\ng c\nf 1 2 3\n";
        let soup = read(text.as_bytes(), Encoding::Obj, &ReadOptions::default(), &Budget::unlimited());
        let counts = [("objects", 2), ("vertex_colors", 1)];
        assert_eq!(told(&soup.unwrap(), Format::Stl), counts);
        let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                    property float nx\nproperty float quality\nelement face 1\nproperty list uchar int vertex_indices\n\
                    property int label\nelement camera 1\nproperty int id\nend_header\n\
                    0 0 0 1 5\n1 0 0 1 5\n0 1 0 1 5\n3 0 1 2 7\n9\n";
        let soup = read(text.as_bytes(), Encoding::PlyAscii, &ReadOptions::default(), &Budget::unlimited());
        assert_eq!(told(&soup.unwrap(), Format::Ply), [("further_properties", 3)]);
    }
}
