//! STL output.

use crate::budget::{Budget, CHECK_EVERY};
use crate::formats::decimals::Text;
use crate::formats::{WriteError, float32};
use crate::geom::DVec3;
use crate::mesh::Soup;
use crate::par;

/// Must not begin with "solid", which some readers take for ASCII.
const HEADER: &[u8; 80] = b"Binary STL by Meshmend                                                          ";

/// Binary STL with coordinates rounded to f32.
pub(in crate::formats) fn binary(soup: &Soup, budget: &Budget) -> Result<Vec<u8>, WriteError> {
    let (mut out, _charged) = budget.vec::<u8>(84 + 50 * soup.triangles.len())?;
    out.extend_from_slice(HEADER);
    out.extend_from_slice(&(soup.triangles.len() as u32).to_le_bytes());
    out.resize(84 + 50 * soup.triangles.len(), 0);
    let records = out[84..].chunks_mut(50 * CHECK_EVERY).collect();
    let written = par::map_items(records, |i, records: &mut [u8]| {
        budget.check()?;
        (i * CHECK_EVERY..).zip(records.chunks_exact_mut(50)).try_for_each(|(t, record)| put(record, soup, t))
    });
    written.into_iter().collect::<Result<(), _>>()?;
    Ok(out)
}

/// Writes the normal and the corners of a triangle.
fn put(record: &mut [u8], soup: &Soup, t: usize) -> Result<(), WriteError> {
    let corners = soup.corners(t as u32);
    let mut points = [normal(corners).to_array().map(|c| c as f32); 4];
    for ((point, v), p) in points[1..].iter_mut().zip(soup.triangles[t]).zip(corners) {
        *point = float32::rounded(v, p, "stl-binary")?;
    }
    for (place, value) in record.chunks_exact_mut(4).zip(points.as_flattened()) {
        place.copy_from_slice(&value.to_le_bytes());
    }
    Ok(())
}

/// ASCII STL as one solid without a name. The coordinates are within the range of float32 here too, because STL knows
/// nothing else.
pub(in crate::formats) fn ascii(soup: &Soup, budget: &Budget) -> Result<Vec<u8>, WriteError> {
    const FACET_BYTES_MAX: usize = 512;
    let mut text = Text::new(budget);
    text.word("solid\n");
    for t in 0..soup.triangles.len() {
        text.before_item(t, FACET_BYTES_MAX)?;
        let corners = soup.corners(t as u32);
        text.word("facet normal");
        for c in normal(corners).to_array() {
            text.word(" ");
            text.coordinate(f64::from(c as f32));
        }
        text.word("\n outer loop\n");
        for (v, p) in soup.triangles[t].into_iter().zip(corners) {
            float32::rounded(v, p, "stl-ascii")?;
            text.word("  vertex ");
            text.point(v, p, "stl-ascii")?;
            text.word("\n");
        }
        text.word(" endloop\nendfacet\n");
    }
    text.word("endsolid\n");
    Ok(text.into_bytes())
}

/// The unit normal by the right-hand rule; zero for a triangle without area.
fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    // Lengths near 1 keep the products in range, so that tiny and huge triangles have normals too.
    let size = ab.abs().max(ac.abs()).max_element();
    let area = (ab / size).cross(ac / size);
    let length = area.dot(area).sqrt();
    if length > 0.0 { area / length } else { DVec3::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(points: [[f64; 3]; 3]) -> Soup {
        Soup { positions: points.map(DVec3::from).to_vec(), triangles: vec![[0, 1, 2]], ..Soup::default() }
    }

    #[test]
    fn text_is_short_and_exact() {
        let soup = triangle([[0.0, -0.0, 0.1], [1.0, 0.0, 0.1], [0.0, 1e-7, 0.1]]);
        let text = String::from_utf8(ascii(&soup, &Budget::unlimited()).unwrap()).unwrap();
        let expected = "solid\nfacet normal 0 0 1\n outer loop\n  vertex 0 -0 0.1\n  vertex 1 0 0.1\n  vertex 0 1e-7 0.1\n endloop\nendfacet\nendsolid\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn binary_is_84_bytes_and_50_for_each_triangle() {
        let soup = triangle([[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]);
        let bytes = binary(&soup, &Budget::unlimited()).unwrap();
        assert_eq!((bytes.len(), &bytes[80..88]), (134, &[1, 0, 0, 0, 0, 0, 128, 63][..]));
        assert!(!bytes.to_ascii_lowercase().starts_with(b"solid"));
    }

    #[test]
    fn normals_are_unit_whatever_the_size_and_zero_without_area() {
        for size in [1e-40, 1.0, 1e38] {
            let corners = [DVec3::ZERO, DVec3::X * size, DVec3::Y * size];
            assert_eq!(normal(corners), DVec3::Z);
        }
        assert_eq!(normal([DVec3::ONE; 3]), DVec3::ZERO);
        assert_eq!(normal([DVec3::ZERO, DVec3::ONE, DVec3::ONE * 2.0]), DVec3::ZERO);
    }

    #[test]
    fn a_coordinate_beyond_float32_is_refused_with_its_vertex() {
        let soup = triangle([[0.0, 0.0, 0.0], [0.0, 1e39, 0.0], [0.0, 0.0, 2.0]]);
        for result in [binary(&soup, &Budget::unlimited()), ascii(&soup, &Budget::unlimited())] {
            let error = result.unwrap_err().to_string();
            assert!(error.starts_with("vertex 1: coordinate 1"), "{error}");
        }
    }
}
