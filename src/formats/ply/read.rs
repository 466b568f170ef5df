//! PLY input.

use super::header::{DataEncoding, Header, PlyElement, PropertyType, Scalar};
use super::roles::{ColorKind, PropertyRole, PropertyRoles};
use super::values::{Ascii, Binary, ValueReader};
use crate::budget::{Budget, CHECK_EVERY, Charge};
use crate::formats::colors::note_color;
use crate::formats::faces::Faces;
use crate::formats::numbers::index;
use crate::formats::{BYTES_BEHIND, Precision, ReadError, ReadOptions};
use crate::geom::DVec3;
use crate::mesh::{Color, Places, Segment, Soup};

/// Reads the elements `vertex` and `face` (or `tristrips`, each of whose triangles becomes a face) with their colours, and
/// `edge`, in the layout that the header states. Other elements and properties are skipped.
pub(in crate::formats) fn read(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    let header = Header::read(bytes)?;
    let (begin, line) = (header.end, header.end_line);
    match header.layout {
        DataEncoding::Ascii => read_body(&header, Ascii::new(&bytes[begin..], line, budget), options, budget),
        DataEncoding::LittleEndian => read_body(&header, Binary::<false>::new(bytes, begin), options, budget),
        DataEncoding::BigEndian => read_body(&header, Binary::<true>::new(bytes, begin), options, budget),
    }
}

fn read_body(
    header: &Header<'_>,
    values: impl ValueReader,
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    let (layout, charges) = (header.layout, Vec::new());
    let mut source = ValueSource { values, layout, options, budget, charges, further_properties: 0 };
    let mut mesh = PlyMesh::default();
    for element in &header.elements {
        match element.name {
            _ if element.count == 0 => {}
            b"vertex" => mesh.read_vertices(element, &mut source)?,
            b"face" => mesh.read_faces(element, &mut source)?,
            b"edge" => mesh.read_edges(element, &mut source)?,
            b"tristrips" => mesh.read_strips(element, &mut source)?,
            _ if element.properties.is_empty() => {}
            _ => source.read_items(element, &PropertyRoles::new(element), |_, _| Ok(()))?,
        }
    }
    let soup = mesh.faces.into_soup(mesh.positions, &options.limits, budget)?;
    let PlyMesh { vertex_colors, face_colors, places, mut segments, .. } = mesh;
    segments.retain(|segment| segment.ends.iter().all(|&v| (v as usize) < soup.positions.len()));
    let left_out =
        [("further_properties", source.further_properties), (BYTES_BEHIND, source.values.behind())];
    let left_out = left_out.into_iter().filter(|&(_, count)| count > 0).collect();
    Ok(Soup { vertex_colors, face_colors, places, segments, left_out, ..soup })
}

/// What was read so far.
#[derive(Default)]
struct PlyMesh {
    positions: Vec<DVec3>,
    vertex_colors: Vec<Option<Color>>,
    faces: Faces,
    face_colors: Vec<Option<Color>>,
    places: Places,
    segments: Vec<Segment>,
}

impl PlyMesh {
    fn read_vertices<V: ValueReader>(
        &mut self,
        element: &PlyElement<'_>,
        source: &mut ValueSource<'_, V>,
    ) -> Result<(), ReadError> {
        source.options.limits.check_vertices(element.count)?;
        let plan = PropertyRoles::new(element).with_coordinates(element)?.with_colors(element);
        let _charged = source.budget.reserve(&mut self.positions, source.fitting(element))?;
        let _charged = source.charge_beside(element, plan.colors)?;
        source.read_items(element, &plan, |line, item| {
            note_color(&mut self.vertex_colors, self.positions.len(), item.color(plan.colors));
            self.positions.push(DVec3::from(item.xyz));
            self.places.vertex_lines.extend(line);
            Ok(())
        })
    }

    fn read_faces<V: ValueReader>(
        &mut self,
        element: &PlyElement<'_>,
        source: &mut ValueSource<'_, V>,
    ) -> Result<(), ReadError> {
        source.options.limits.check_triangles(element.count)?;
        let plan = PropertyRoles::new(element)
            .with_vertices(element, PropertyRole::Corners)?
            .with_colors(element)
            .with_color_index(element);
        let _charged = self.faces.reserve(source.fitting(element), source.budget)?;
        let _charged = source.charge_beside(element, plan.colors)?;
        let (budget, limits) = (source.budget, &source.options.limits);
        let mut charges = Vec::new();
        source.read_items(element, &plan, |line, item| {
            let color = item.color_index.map(Color::Index).or_else(|| item.color(plan.colors));
            note_color(&mut self.face_colors, self.faces.len(), color);
            self.faces.push(&item.vertices);
            self.places.face_lines.extend(line);
            if self.faces.is_due() {
                charges.push(self.faces.settle(limits, budget)?);
            }
            Ok(())
        })
    }

    /// Edges that name no two vertices are skipped as other elements are.
    fn read_edges<V: ValueReader>(
        &mut self,
        element: &PlyElement<'_>,
        source: &mut ValueSource<'_, V>,
    ) -> Result<(), ReadError> {
        let Some(plan) = PropertyRoles::new(element).with_ends(element) else {
            return source.read_items(element, &PropertyRoles::new(element), |_, _| Ok(()));
        };
        let _charged = source.budget.reserve(&mut self.segments, source.fitting(element))?;
        source.read_items(element, &plan, |line, item| {
            self.segments.push(Segment { ends: item.ends, line });
            Ok(())
        })
    }

    fn read_strips<V: ValueReader>(
        &mut self,
        element: &PlyElement<'_>,
        source: &mut ValueSource<'_, V>,
    ) -> Result<(), ReadError> {
        let plan = PropertyRoles::new(element).with_vertices(element, PropertyRole::Strips)?;
        let (budget, limits) = (source.budget, &source.options.limits);
        let mut charges = Vec::new();
        source.read_items(element, &plan, |line, item| {
            // -1 ends a strip.
            for strip in item.vertices.split(|&v| v == u32::MAX) {
                for (i, &[a, b, c]) in strip.array_windows().enumerate() {
                    // A strip repeats a vertex to turn a corner; that triangle is not meant.
                    if a != b && b != c && c != a {
                        self.faces.push(&if i % 2 == 0 { [a, b, c] } else { [b, a, c] });
                        self.places.face_lines.extend(line);
                        if self.faces.is_due() {
                            charges.push(self.faces.settle(limits, budget)?);
                            charges.push(budget.charge(4 * line.map_or(0, |_| CHECK_EVERY as u64))?);
                        }
                    }
                }
            }
            Ok(())
        })
    }
}

/// The values of a file and what reading them is subject to.
struct ValueSource<'a, V> {
    values: V,
    layout: DataEncoding,
    options: &'a ReadOptions,
    budget: &'a Budget,
    /// For lists that are longer than others.
    charges: Vec<Charge<'a>>,
    /// Of the elements so far.
    further_properties: u64,
}

impl<'a, V: ValueReader> ValueSource<'a, V> {
    /// How many of `element` the rest of the file can hold, at most as many as are announced.
    fn fitting(&self, element: &PlyElement<'_>) -> usize {
        let held = self.values.remaining() / element.bytes_min(self.layout).max(1) + 1;
        element.count.min(held as u64) as usize
    }

    /// Calls `take` with the line (in text) and the values of each item of `element`.
    fn read_items(
        &mut self,
        element: &PlyElement<'_>,
        plan: &PropertyRoles,
        mut take: impl FnMut(Option<u32>, &ElementValues) -> Result<(), ReadError>,
    ) -> Result<(), ReadError> {
        self.further_properties += plan.further_properties(element);
        let mut item = ElementValues::default();
        for i in 0..element.count {
            if i.is_multiple_of(CHECK_EVERY as u64) {
                self.budget.check()?;
            }
            self.values.begin_item();
            for &(role, kind) in &plan.properties {
                self.read_property(role, kind, &mut item)?;
            }
            take(self.values.item_line(), &item)?;
        }
        Ok(())
    }

    /// Charges the lines and colours of the items of `element`.
    fn charge_beside(&self, element: &PlyElement<'_>, colors: ColorKind) -> Result<Charge<'a>, ReadError> {
        let line = if self.layout == DataEncoding::Ascii { size_of::<u32>() } else { 0 };
        let color = if colors == ColorKind::None { 0 } else { size_of::<Option<Color>>() };
        Ok(self.budget.charge(self.fitting(element) as u64 * (line + color) as u64)?)
    }

    #[inline]
    fn read_property(
        &mut self,
        role: PropertyRole,
        kind: PropertyType,
        item: &mut ElementValues,
    ) -> Result<(), ReadError> {
        match (role, kind) {
            (PropertyRole::Coordinate(k), PropertyType::One(scalar)) => {
                item.xyz[k] = self.values.number(scalar, self.options.precision)?;
            }
            (PropertyRole::Channel(k), PropertyType::One(scalar)) => {
                item.channels[k] = self.values.number(scalar, Precision::F32)? as f32;
            }
            (PropertyRole::ColorIndex, PropertyType::One(scalar)) => {
                let index = i32::try_from(self.values.integer(scalar)?).ok();
                item.color_index = index.filter(|&index| index >= 0);
            }
            (PropertyRole::End(k), PropertyType::One(scalar)) => {
                item.ends[k] = index(self.values.integer(scalar)?);
            }
            (_, PropertyType::One(scalar)) => self.values.skip(scalar, 1)?,
            (_, PropertyType::List { count, item: scalar }) => {
                let place = self.values.place();
                let length = self.values.integer(count)?;
                let length = u64::try_from(length)
                    .map_err(|_| ReadError::unparseable(place, length.to_string(), "the length of a list"))?;
                match role {
                    PropertyRole::Corners => {
                        self.options.limits.check_polygon(length, place)?;
                        self.read_vertices(length, scalar, &mut item.vertices)?;
                    }
                    PropertyRole::Strips => self.read_vertices(length, scalar, &mut item.vertices)?,
                    _ => self.values.skip(scalar, length)?,
                }
            }
        }
        Ok(())
    }

    fn read_vertices(&mut self, count: u64, kind: Scalar, vertices: &mut Vec<u32>) -> Result<(), ReadError> {
        vertices.clear();
        for i in 0..count {
            if (i + 1).is_multiple_of(CHECK_EVERY as u64) {
                self.charges.push(self.budget.reserve(vertices, CHECK_EVERY)?);
            }
            vertices.push(index(self.values.integer(kind)?));
        }
        Ok(())
    }
}

/// The values of one item that have a role.
#[derive(Default)]
struct ElementValues {
    xyz: [f64; 3],
    channels: [f32; 4],
    vertices: Vec<u32>,
    ends: [u32; 2],
    color_index: Option<i32>,
}

impl ElementValues {
    fn color(&self, kind: ColorKind) -> Option<Color> {
        let [r, g, b, a] = self.channels;
        match kind {
            ColorKind::None => None,
            ColorKind::Bytes { has_alpha } => {
                Some(Color::Bytes([r, g, b].map(|c| c as u8), has_alpha.then_some(a as u8)))
            }
            ColorKind::Floats { has_alpha } => Some(Color::Floats([r, g, b], has_alpha.then_some(a))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::FaceFaultReason;

    fn read_bytes(bytes: &[u8]) -> Result<Soup, ReadError> {
        super::read(bytes, &ReadOptions::default(), &Budget::unlimited())
    }

    fn read(header: &str, body: &str) -> Result<Soup, ReadError> {
        read_bytes(format!("ply\nformat ascii 1.0\n{header}end_header\n{body}").as_bytes())
    }

    fn error(header: &str, body: &str) -> String {
        read(header, body).unwrap_err().to_string()
    }

    const XYZ: &str = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const FACE: &str = "element face 1\nproperty list uchar int vertex_indices\n";

    #[test]
    fn strips_are_charged_and_counted_while_they_are_read() {
        let mut file = format!(
            "ply\nformat binary_little_endian 1.0\n{XYZ}element tristrips 1\nproperty list int uchar vertex_indices\n\
             end_header\n"
        )
        .into_bytes();
        let count = 3_000_000_u32;
        file.extend([0; 36]);
        file.extend(count.to_le_bytes());
        file.extend((0..count).map(|i| (i % 3) as u8));
        let read = |triangles_max, bytes_max| {
            let limits = crate::formats::ReadLimits { triangles_max, ..Default::default() };
            let options = ReadOptions { limits, ..ReadOptions::default() };
            let budget = Budget::new(crate::budget::StopFlag::default(), u64::MAX, bytes_max);
            let read = super::read(&file, &options, &budget);
            (read.map(|soup| soup.triangles.len()).map_err(|error| error.to_string()), budget.bytes_peak())
        };
        let (all, peak) = read(u32::MAX, u64::MAX);
        assert_eq!(all, Ok(count as usize - 2));
        assert!(peak > 16 * u64::from(count), "the list and the faces are charged: {peak}");
        let (refused, peak_of_refused) = read(100_000, u64::MAX);
        assert!(refused.unwrap_err().contains("triangles_max = 100000"));
        assert!(peak_of_refused < peak * 3 / 4, "{peak_of_refused} of {peak}");
        assert!(read(u32::MAX, 16 << 20).0.unwrap_err().contains("memory limit"));
    }

    #[test]
    fn an_element_without_items_needs_no_properties() {
        assert_eq!(read(&format!("{XYZ}element face 0\n"), "0 0 0 1 0 0 0 1 0").unwrap().positions.len(), 3);
        assert!(error(&format!("{XYZ}element face 1\n"), TRIANGLE).contains("found element face; expected"));
    }

    const TRIANGLE: &str = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

    #[test]
    fn properties_come_in_any_order_and_type_and_the_rest_is_skipped() {
        let header = "element camera 2\nproperty int id\nproperty list short double values\n\
            element face 1\nproperty uchar kind\nproperty list ushort uint vertex_index\nproperty list int float uv\n\
            element vertex 3\nproperty float nx\nproperty double z\nproperty short x\nproperty float y\n\
            element nothing 4000000000\n";
        let body = "1 2 0.5 0.5\n2 0\n7 3 0 1 2 1 9\n0 5 0 0\n0 5 1 0\n0 5 0 1.5\n";
        let soup = read(header, body).unwrap();
        assert_eq!(soup.triangles, [[0, 1, 2]]);
        assert_eq!(soup.positions[2], DVec3::new(0.0, 1.5, 5.0));
        assert_eq!((soup.places.face_lines, soup.places.vertex_lines), (vec![19], vec![20, 21, 22]));
    }

    #[test]
    fn both_byte_orders_make_the_same_soup() {
        let header = |order: &str| {
            format!(
                "ply\nformat binary_{order}_endian 1.0\nelement vertex 3\nproperty double x\nproperty float y\n\
                property short z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n\
                property list uchar ushort vertex_indices\nproperty char flag\nend_header\n"
            )
        };
        let (mut little, mut big) = (header("little").into_bytes(), header("big").into_bytes());
        for (x, y, z) in [(0.1f64, 0.0f32, 10i16), (1.0, 0.5, 10), (0.0, 1.0, -300)] {
            little.extend([&x.to_le_bytes()[..], &y.to_le_bytes(), &z.to_le_bytes(), &[1, 2, 3]].concat());
            big.extend([&x.to_be_bytes()[..], &y.to_be_bytes(), &z.to_be_bytes(), &[1, 2, 3]].concat());
        }
        for corners in [&[0u16, 1, 2][..], &[1, 2]] {
            little.push(corners.len() as u8);
            big.push(corners.len() as u8);
            for corner in corners {
                little.extend(corner.to_le_bytes());
                big.extend(corner.to_be_bytes());
            }
            little.push(255);
            big.push(255);
        }
        let soup = read_bytes(&little).unwrap();
        assert_eq!(soup, read_bytes(&big).unwrap());
        assert_eq!(soup.positions[2], DVec3::new(0.0, 1.0, -300.0));
        assert_eq!((&soup.triangles[..], soup.face_faults.len()), (&[[0, 1, 2]][..], 1));
        assert_eq!(soup.vertex_colors, [Some(Color::Bytes([1, 2, 3], None)); 3]);
        let start = header("little").len();
        for keep in start..little.len() {
            let error = read_bytes(&little[..keep]).unwrap_err().to_string();
            assert!(error.starts_with(&format!("byte {keep}: the file ends here")), "{error}");
        }
    }

    #[test]
    fn colours_are_bytes_or_floats_as_their_type_says() {
        let colors = "property float red\nproperty float green\nproperty float blue\nproperty float alpha\n";
        let soup =
            read(&format!("{XYZ}{colors}"), "0 0 0 1 0 0.1 1\n1 0 0 0 0 0 0\n0 1 0 0 0 0 0\n").unwrap();
        assert_eq!(soup.vertex_colors[0], Some(Color::Floats([1.0, 0.0, 0.1], Some(1.0))));
        let bytes = colors.replace("float", "uchar");
        let soup =
            read(&format!("{XYZ}{FACE}{bytes}"), &TRIANGLE.replace("3 0 1 2", "3 0 1 2 255 0 7 9")).unwrap();
        assert_eq!(soup.face_colors, [Some(Color::Bytes([255, 0, 7], Some(9)))]);
        let mixed = bytes.replacen("uchar", "int", 1);
        let soup =
            read(&format!("{XYZ}{FACE}{mixed}"), &TRIANGLE.replace("3 0 1 2", "3 0 1 2 255 0 7 9")).unwrap();
        assert!(soup.face_colors.is_empty());
    }

    #[test]
    fn triangle_strips_become_faces_with_the_same_side_up() {
        let header =
            format!("{}element tristrips 1\nproperty list int int vertex_indices\n", XYZ.replace('3', "5"));
        let soup = read(&header, "0 0 0 1 0 0 0 1 0 1 1 0 0 2 0\n9 0 1 2 3 -1 2 3 4 4").unwrap();
        assert_eq!(soup.triangles, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
    }

    #[test]
    fn what_stands_behind_the_announced_elements_is_counted() {
        let left_out = |bytes: &[u8]| read_bytes(bytes).unwrap().left_out;
        let text = format!("ply\nformat ascii 1.0\n{XYZ}{FACE}end_header\n{TRIANGLE}\n");
        assert_eq!(left_out(text.as_bytes()), []);
        assert_eq!(left_out(format!("{text}3 0 2 1\n").as_bytes()), [(BYTES_BEHIND, 8)]);
        let header = format!("ply\nformat binary_little_endian 1.0\n{XYZ}{FACE}end_header\n");
        let vertices = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
        let face = [vec![3], [0u32, 1, 2].map(u32::to_le_bytes).concat()].concat();
        let whole = [header.as_bytes(), &vertices, &face].concat();
        assert_eq!(left_out(&whole), []);
        assert_eq!(left_out(&[&whole[..], b"\n\0"].concat()), [], "padding");
        assert_eq!(left_out(&[whole, face].concat()), [(BYTES_BEHIND, 13)]);
    }

    #[test]
    fn edges_are_segments_where_they_name_vertices_that_are_there() {
        let edges = "element edge 3\nproperty int vertex1\nproperty uchar red\nproperty int vertex2\n";
        let soup =
            read(&format!("{XYZ}{edges}{FACE}"), "0 0 0\n1 0 0\n0 1 0\n0 255 1\n2 0 3\n1 9 -1\n3 0 1 2")
                .unwrap();
        assert_eq!(soup.segments, [Segment { ends: [0, 1], line: Some(17) }]);
        let other = edges.replace("vertex2", "length");
        let soup =
            read(&format!("{XYZ}{other}{FACE}"), "0 0 0\n1 0 0\n0 1 0\n0 255 1\n2 0 3\n1 9 -1\n3 0 1 2")
                .unwrap();
        assert_eq!((soup.segments.len(), soup.triangles.len()), (0, 1));
    }

    #[test]
    fn polygons_and_bad_indices_are_kept_apart() {
        let soup = read(
            &format!("{XYZ}{}", FACE.replace('1', "3")),
            "0 0 0 1 0 0 0 1 0\n4 0 1 2 0\n3 0 1 3\n3 -1 0 1",
        )
        .unwrap();
        assert_eq!(soup.polygons.faces, [0]);
        assert!(soup.face_faults.iter().all(|f| f.reason == FaceFaultReason::IndexOutOfRange));
    }

    #[test]
    fn what_is_missing_or_wrong_is_named_with_its_place() {
        let header = format!("{XYZ}{FACE}");
        assert_eq!(error(&header, "0 0 0\n1 0 x"), "line 11: found \"x\"; expected a number");
        assert_eq!(
            error(&header, "0 0 0\n1 0 0\n0 1 0\n3 0 1"),
            "line 13: the file ends here; expected an integer"
        );
        assert_eq!(
            error(&header, "0 0 0\n1 0 0\n0 1 0\n-3 0"),
            "line 12: found -3; expected the length of a list"
        );
        assert!(
            error("element vertex 1\nproperty float x\n", "0")
                .starts_with("line 3: found element vertex; expected")
        );
        assert!(
            error("element face 1\nproperty int vertex_indices\n", "0")
                .contains("expected a list of integers")
        );
        assert!(error(&header.replace("vertex 3", "vertex 4294967295"), TRIANGLE).contains("vertices_max"));
        assert!(
            error(&header.replace("vertex 3", "vertex 300000000"), TRIANGLE).contains("the file ends here")
        );
        assert!(error(&header, &TRIANGLE.replace("3 0 1 2", "70000 0 1 2")).contains("polygon_corners_max"));
    }
}
