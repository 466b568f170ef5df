//! OBJ input.

use super::material_names::MaterialsOfFile;
use super::object_names::ObjectsOfFile;
use super::statements::{StatementCounts, Statements};
use super::texture::TextureOfFile;
use crate::budget::Budget;
use crate::formats::faces::Faces;
use crate::formats::{ReadError, ReadOptions};
use crate::geom::DVec3;
use crate::mesh::{Color, Places, Segment, Soup, Texture};
use crate::par;
use memchr::memchr2;

/// Parts of a file that are read at the same time have about this many bytes.
const PART_BYTES: usize = 1 << 20;

/// Reads vertices with their colours, faces with their texture coordinates, the segments of lines, and the names of
/// materials, objects and groups; normals and all else are ignored. Indices may point to vertices further down.
///
/// Twice through the file: first to count, so that every part knows its first line and vertex, then to read the parts
/// at the same time.
pub(in crate::formats) fn read(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    read_parts(&cut(bytes, PART_BYTES), options, budget)
}

/// Cuts at line breaks where no line is continued, after about `part_bytes` each.
fn cut(bytes: &[u8], part_bytes: usize) -> Vec<&[u8]> {
    let mut parts = Vec::new();
    let mut rest = bytes;
    while rest.len() > part_bytes {
        let (part, later) = rest.split_at(line_start(rest, part_bytes));
        parts.push(part);
        rest = later;
    }
    parts.push(rest);
    parts
}

/// The first start of a line at or after `from` whose line before it does not go on; the end if there is none.
fn line_start(bytes: &[u8], mut from: usize) -> usize {
    while let Some(skipped) = memchr2(b'\n', b'\r', &bytes[from..]) {
        let end = from + skipped;
        from = end + if bytes[end..].starts_with(b"\r\n") { 2 } else { 1 };
        // The search may have begun between CR and LF.
        let line = if bytes[end] == b'\n' { bytes[..end].strip_suffix(b"\r") } else { None };
        if !line.unwrap_or(&bytes[..end]).ends_with(b"\\") {
            return from;
        }
    }
    bytes.len()
}

fn read_parts(parts: &[&[u8]], options: &ReadOptions, budget: &Budget) -> Result<Soup, ReadError> {
    let counts = par::try_map_ranges(parts.len(), 1, |i| StatementCounts::of(parts[i.start], budget))?;
    let mut before = Vec::with_capacity(parts.len());
    let mut total = StatementCounts::default();
    for &inside in &counts {
        before.push(total);
        total = total.plus(inside);
    }
    options.limits.check_vertices(total.vertices)?;
    // A polygon has two triangles fewer than corners; faces with fewer than two corners only make this less.
    options.limits.check_triangles(total.faces.max(total.corners.saturating_sub(2 * total.faces)))?;

    // Charged here at once: what is in use at one time inside depends on the number of threads.
    let has_texture = total.texture_points > 0;
    let of_texture = if has_texture { 16 * total.texture_points + 12 * total.faces } else { 0 };
    let bytes_of_parts = total.vertices * size_of::<(DVec3, u32)>() as u64
        + total.faces * size_of::<[u32; 4]>() as u64
        + total.further_corners() * 2 * size_of::<u32>() as u64
        + total.line_corners * size_of::<Segment>() as u64
        + total.materials * size_of::<(u32, &[u8])>() as u64
        + total.objects * size_of::<(u32, [&[u8]; 2])>() as u64
        + of_texture;
    let _charged = budget.charge(bytes_of_parts)?;
    let read = par::try_map_ranges(parts.len(), 1, |i| {
        let i = i.start;
        Statements::read(parts[i], before[i], counts[i], has_texture, options, budget)
    })?;
    join(read, total, options, budget)
}

fn join(
    parts: Vec<Statements<'_>>,
    total: StatementCounts,
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    let (vertex_count, face_count) = (total.vertices as usize, total.faces as usize);
    let (mut positions, _charged) = budget.vec::<DVec3>(vertex_count)?;
    let (mut vertex_lines, _charged) = budget.vec(vertex_count)?;
    let (mut face_lines, _charged) = budget.vec(face_count)?;
    let mut faces = Faces::default();
    let _charged = faces.reserve(face_count, budget)?;
    let _charged = budget.charge(2 * size_of::<u32>() as u64 * total.further_corners())?;
    let mut texture = TextureOfFile::default();
    let has_texture = total.texture_points > 0;
    let _charged = match has_texture {
        true => Some(texture.reserve(face_count, total.texture_points as usize, budget)?),
        false => None,
    };
    let (mut segments, _charged) = budget.vec::<Segment>(total.line_corners as usize)?;
    let mut materials = MaterialsOfFile::default();
    let _charged = budget.charge(if total.materials > 0 { 4 * total.faces } else { 0 })?;
    let mut objects = ObjectsOfFile::default();
    // An object that is kept has a face.
    const PER_OBJECT: u64 = 128;
    let objects_max = total.objects.min(total.faces);
    let _charged =
        budget.charge(if total.objects > 0 { 4 * total.faces + PER_OBJECT * objects_max } else { 0 })?;
    let has_colors = parts.iter().any(|part| !part.colors.is_empty());
    let mut vertex_colors: Vec<Option<Color>> = Vec::new();
    for part in parts {
        budget.check()?;
        positions.extend_from_slice(&part.positions);
        vertex_lines.extend_from_slice(&part.vertex_lines);
        face_lines.extend_from_slice(&part.face_lines);
        faces.append(&part.faces);
        texture.append(&part.texture);
        if total.materials > 0 {
            materials.append(&part.materials, part.faces.len());
        }
        if total.objects > 0 {
            objects.append(&part.objects, part.faces.len());
        }
        let is_there = |segment: &&Segment| segment.ends.iter().all(|&v| (v as usize) < vertex_count);
        segments.extend(part.segments.iter().filter(is_there));
        if has_colors {
            vertex_colors.extend_from_slice(&part.colors);
            vertex_colors.resize(positions.len(), None);
        }
    }
    let soup = faces.into_soup(positions, &options.limits, budget)?;
    let texture = if has_texture { texture.into_texture(&soup, budget)? } else { Texture::default() };
    let (places, materials) = (Places { face_lines, vertex_lines }, materials.into_materials());
    let (objects, objects_left_out) = objects.into_objects(budget)?;
    let left_out = if objects_left_out > 0 { vec![("objects", objects_left_out)] } else { Vec::new() };
    Ok(Soup { places, vertex_colors, texture, materials, objects, segments, left_out, ..soup })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::Precision;
    use crate::mesh::FaceFaultReason;

    fn read(text: &str) -> Result<Soup, ReadError> {
        super::read(text.as_bytes(), &ReadOptions::default(), &Budget::unlimited())
    }

    fn error(text: &str) -> String {
        read(text).unwrap_err().to_string()
    }

    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

    #[test]
    fn all_forms_of_a_corner_name_the_same_vertex() {
        for face in [
            "1 2 3",
            "1/1 2/9 3/7",
            "1//1 2//2 3//3",
            "1/1/1 2/2/2 3/3/3",
            "-3 -2 -1",
            "1// 2/ 3//-1",
            "+1 2 3",
        ] {
            assert_eq!(read(&format!("{TRIANGLE}f {face}\n")).unwrap().triangles, [[0, 1, 2]], "{face}");
        }
    }

    #[test]
    fn negative_indices_count_from_the_vertices_so_far() {
        let soup = read(&format!("{TRIANGLE}f -3 -2 -1\nv 0 0 1\nf -1 -4 -2\nf 1 2 -5")).unwrap();
        assert_eq!(soup.triangles, [[0, 1, 2], [3, 0, 2]]);
        assert_eq!(
            (soup.face_faults[0].face, soup.face_faults[0].reason),
            (2, FaceFaultReason::IndexOutOfRange)
        );
    }

    #[test]
    fn indices_may_point_forward_and_unused_vertices_stay() {
        let soup = read(&format!("f 1 2 3\n{TRIANGLE}v 9 9 9\n")).unwrap();
        assert_eq!((soup.triangles.len(), soup.positions.len()), (1, 4));
        assert_eq!((soup.places.face_lines, soup.places.vertex_lines), (vec![1], vec![2, 3, 4, 5]));
    }

    #[test]
    fn bad_indices_are_findings_and_words_that_are_no_index_are_errors() {
        let soup = read(&format!("{TRIANGLE}f 0 1 2\nf 1 2 99\nf 1 2\nf 1 2 3\nf 99999999999999999999 1 2"))
            .unwrap();
        assert_eq!((soup.face_faults.len(), soup.triangle_face), (4, vec![3]));
        assert_eq!(error(&format!("{TRIANGLE}f 1 2 x")), "line 4: found \"x\"; expected a vertex index");
        assert_eq!(error("\nv 1 2\nv 3"), "line 2: found the end of the line; expected a coordinate");
        assert_eq!(error("v 1 2"), "line 1: the file ends here; expected a coordinate");
        assert_eq!(error("v 1 2 3,5"), "line 1: found \"3,5\"; expected a coordinate");
    }

    #[test]
    fn line_ends_blanks_comments_and_joined_lines_do_not_matter() {
        let text = format!("{TRIANGLE}f 1 2 3\n");
        let expected = read(&text).unwrap().triangles;
        for other in [
            text.replace('\n', "\r\n"),
            text.replace('\n', "\r"),
            text.replace(' ', " \t  "),
            text.replace('\n', " # v 5 5 5\n"),
            text.replace(' ', " \\\n "),
            text.replace(' ', "\\\r\n"),
            format!("\u{feff}{text}"),
            text.trim_end().to_owned(),
        ] {
            assert_eq!(read(&other).unwrap().triangles, expected, "{other}");
        }
    }

    #[test]
    fn latin_1_names_are_ignored_as_everything_else_that_is_no_mesh() {
        let mut text =
            b"# gr\xFC\xDFe\no B\xFC\nmtllib a\\\ng x\\y\ns 1\nvt 0 0\nvn 0 0 1\nl 1 2\np 1\ncstype bezier\n"
                .to_vec();
        text.extend(TRIANGLE.bytes());
        text.extend(b"usemtl \xE4\nf 1 2 3");
        let soup = super::read(&text, &ReadOptions::default(), &Budget::unlimited()).unwrap();
        assert_eq!((soup.positions.len(), soup.triangles.len()), (3, 1));
    }

    #[test]
    fn colours_follow_positions_and_a_weight_is_no_colour() {
        let soup = read("v 0 0 0\nv 1 0 0 1\nv 0 1 0 0.5 0.25 1\nv 0 0 1 1 0 0 0.5\nv 0 0 2\n").unwrap();
        let (rgb, rgba) = (Color::Floats([0.5, 0.25, 1.0], None), Color::Floats([1.0, 0.0, 0.0], Some(0.5)));
        assert_eq!(soup.vertex_colors, [None, None, Some(rgb), Some(rgba), None]);
        assert!(read(TRIANGLE).unwrap().vertex_colors.is_empty());
    }

    #[test]
    fn lines_are_segments_between_neighbouring_corners_that_are_there() {
        let soup = read(&format!("{TRIANGLE}l 1 2/4 -1\nl 3 9 1 2\nl 1\nl x 1 2\nf 1 2 3\nl 4 1\nv 5 5 5\n"))
            .unwrap();
        let segments: Vec<([u32; 2], Option<u32>)> = soup.segments.iter().map(|s| (s.ends, s.line)).collect();
        let expected = [([0, 1], 4), ([1, 2], 4), ([0, 1], 5), ([0, 1], 7), ([3, 0], 9)];
        assert_eq!(segments, expected.map(|(ends, line)| (ends, Some(line))));
        assert!(soup.check().is_empty());
    }

    #[test]
    fn nan_is_a_finding_with_its_line() {
        let soup = read("v 0 0 0\nv nan 0 0\nv 0 1e999 0\nf 1 2 3\n").unwrap();
        assert_eq!(
            (soup.non_finite_vertices, soup.face_faults[0].reason),
            (vec![1, 2], FaceFaultReason::NonFinite)
        );
    }

    #[test]
    fn coordinates_follow_the_precision_asked() {
        let options = ReadOptions { precision: Precision::F32, ..ReadOptions::default() };
        let soup = super::read(b"v 0.1 0 0", &options, &Budget::unlimited()).unwrap();
        assert_eq!((soup.positions[0].x, soup.is_f32_exact), (f64::from(0.1f32), true));
        assert!(!read("v 0.1 0 0").unwrap().is_f32_exact);
    }

    #[test]
    fn limits_are_errors_with_their_names() {
        let limits = crate::formats::ReadLimits { polygon_corners_max: 4, ..Default::default() };
        let options = ReadOptions { limits, ..ReadOptions::default() };
        let text = b"v 0 0 0\nf 1 1 1 1 1 1 1 1";
        let error = super::read(text, &options, &Budget::unlimited()).unwrap_err().to_string();
        assert_eq!(error, "line 2: 5 corners of one polygon is over the limit polygon_corners_max = 4");
    }

    #[test]
    fn long_polygons_are_charged_and_counted_before_they_are_read() {
        let text = format!("{TRIANGLE}{}", format!("f{}\n", " 1 2 3".repeat(20_000)).repeat(4));
        let read = |triangles_max, bytes_max| {
            let limits = crate::formats::ReadLimits { triangles_max, ..Default::default() };
            let options = ReadOptions { limits, ..ReadOptions::default() };
            let budget = Budget::new(crate::budget::StopFlag::default(), u64::MAX, bytes_max);
            (super::read(text.as_bytes(), &options, &budget).unwrap_err().to_string(), budget.bytes_peak())
        };
        let (error, peak) = read(200_000, u64::MAX);
        assert!(error.contains("239992 triangles is over the limit triangles_max = 200000"), "{error}");
        assert_eq!(peak, 0, "nothing was read");
        assert!(read(u32::MAX, 1 << 20).0.contains("memory limit"));
    }

    #[test]
    fn a_file_without_mesh_is_empty_and_points_alone_are_a_soup() {
        assert!(error("# nothing\n").contains("empty"));
        assert_eq!(read("v 1 2 3").unwrap().positions.len(), 1);
    }

    /// The same soup and the same error, wherever the file is cut.
    #[test]
    fn parts_of_any_size_make_the_same_soup() {
        let text = "# a\\\nvt 0 1\nv 0 0 0\r\nv 1 0 0 1 0 0\r\rv 0 \\\r\n1 0\nf -3 \\\n-2 \\\n-1\nf 1/1 2/2 3/-1 1/1\nvt 1 0.5\n# b\nf 1 2 9\nv 5 5 5\nf -4 -3 -1 # c\nl 1 -1 \\\n2\nl 9 1\nf 1 1";
        let options = ReadOptions::default();
        for text in [text.to_owned(), format!("{text}\nf x\nf y")] {
            let whole = read_parts(&[text.as_bytes()], &options, &Budget::unlimited());
            for part_bytes in 1..text.len() {
                let parts = cut(text.as_bytes(), part_bytes);
                assert_eq!(parts.concat(), text.as_bytes());
                assert_eq!(
                    read_parts(&parts, &options, &Budget::unlimited()),
                    whole,
                    "parts of {part_bytes}"
                );
            }
        }
    }
}
