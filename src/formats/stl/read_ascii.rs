//! ASCII STL: `solid`, `facet`, `outer loop`, three times `vertex`, `endloop`, `endfacet`, `endsolid`, in any case.

use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::formats::faces::Faces;
use crate::formats::numbers::coordinate;
use crate::formats::words::{Dialect, Words};
use crate::formats::{Precision, ReadError, ReadOptions};
use crate::geom::DVec3;
use crate::mesh::{Places, Soup};
use crate::spatial::coincident_f64;

/// Reads the facets of all solids, numbered on from one to the next, and welds bit-equal corners. Names and normals are
/// ignored. The last `endsolid` may be missing.
pub(in crate::formats) fn read(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    let mut facets = Facets::default();
    let mut charges = Vec::new();
    let mut words = Words::new(bytes, 1, Dialect::default());
    while let Some(word) = words.next_word() {
        if is(word, "solid") || is(word, "endsolid") {
            words.rest_of_line();
        } else if is(word, "facet") {
            if facets.sizes.len().is_multiple_of(CHECK_EVERY) {
                options.limits.check_triangles(facets.sizes.len() as u64)?;
                charges.push(facets.make_room(budget)?);
            }
            facets.read_facet(&mut words, options.precision)?;
        } else {
            return Err(words.wrong(Some(word), "facet, solid or endsolid"));
        }
    }
    facets.weld(options, budget)
}

/// What the facets say, before corners are welded.
#[derive(Default)]
struct Facets {
    corners: Vec<DVec3>,
    corner_lines: Vec<u32>,
    /// Corners of each facet.
    sizes: Vec<u8>,
    face_lines: Vec<u32>,
}

impl Facets {
    /// Room for the facets until the next check.
    fn make_room<'b>(&mut self, budget: &'b Budget) -> Result<[Charge<'b>; 4], Stopped> {
        Ok([
            budget.reserve(&mut self.corners, 3 * CHECK_EVERY)?,
            budget.reserve(&mut self.corner_lines, 3 * CHECK_EVERY)?,
            budget.reserve(&mut self.sizes, CHECK_EVERY)?,
            budget.reserve(&mut self.face_lines, CHECK_EVERY)?,
        ])
    }

    /// Reads the rest of a facet.
    fn read_facet(&mut self, words: &mut Words<'_>, precision: Precision) -> Result<(), ReadError> {
        self.face_lines.push(words.line() as u32);
        skip_to_loop(words)?;
        let first = self.corners.len();
        loop {
            let count = self.corners.len() - first;
            match words.next_word() {
                Some(word) if is(word, "vertex") && count < 3 => {
                    self.corner_lines.push(words.line() as u32);
                    self.corners.push(read_vertex(words, precision)?);
                }
                Some(word) if is(word, "endloop") => {
                    self.sizes.push(count as u8);
                    break;
                }
                found => {
                    return Err(words.wrong(found, if count < 3 { "vertex or endloop" } else { "endloop" }));
                }
            }
        }
        match words.next_word() {
            Some(word) if is(word, "endfacet") => Ok(()),
            found => Err(words.wrong(found, "endfacet")),
        }
    }

    fn weld(self, options: &ReadOptions, budget: &Budget) -> Result<Soup, ReadError> {
        options.limits.check_triangles(self.sizes.len() as u64)?;
        let welded = coincident_f64(&self.corners, budget)?;
        let positions = welded.first.iter().map(|&i| self.corners[i as usize]).collect();
        let vertex_lines = welded.first.iter().map(|&i| self.corner_lines[i as usize]).collect();
        let mut faces = Faces::default();
        let mut rest = &welded.group[..];
        for size in self.sizes {
            let (corners, later) = rest.split_at(usize::from(size));
            faces.push(corners);
            rest = later;
        }
        let soup = faces.into_soup(positions, &options.limits, budget)?;
        let places = Places { face_lines: self.face_lines, vertex_lines };
        Ok(Soup { places, is_welded_by_format: true, ..soup })
    }
}

/// Skips `normal` and its three numbers, whatever they are, and `outer loop`.
fn skip_to_loop(words: &mut Words<'_>) -> Result<(), ReadError> {
    const WORDS_OF_NORMAL: usize = 4;
    let mut found = words.next_word();
    for _ in 0..WORDS_OF_NORMAL {
        if !found.is_some_and(|word| is(word, "outer")) {
            found = words.next_word();
        }
    }
    if found.is_some_and(|word| is(word, "outer")) {
        found = words.next_word();
    }
    if found.is_some_and(|word| is(word, "loop")) { Ok(()) } else { Err(words.wrong(found, "outer loop")) }
}

fn read_vertex(words: &mut Words<'_>, precision: Precision) -> Result<DVec3, ReadError> {
    let mut xyz = [0.0; 3];
    for c in &mut xyz {
        let word = words.next_word();
        *c = word
            .and_then(|word| coordinate(word, precision))
            .ok_or_else(|| words.wrong(word, "a coordinate"))?;
    }
    Ok(DVec3::from(xyz))
}

fn is(word: &[u8], keyword: &str) -> bool {
    word.eq_ignore_ascii_case(keyword.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{FaceFault, FaceFaultReason};

    fn read(text: &[u8]) -> Result<Soup, ReadError> {
        super::read(text, &ReadOptions::default(), &Budget::unlimited())
    }

    const FACET: &str = "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n endloop\nendfacet\n";

    #[test]
    fn several_solids_are_one_soup_and_facets_count_on() {
        let text = format!("solid a\n{FACET}endsolid a\nsolid\n{FACET}{FACET}endsolid\n");
        let soup = read(text.as_bytes()).unwrap();
        assert_eq!(soup.triangles, [[0, 1, 2]; 3]);
        assert_eq!(soup.places.face_lines, [2, 11, 18]);
        assert_eq!(soup.places.vertex_lines, [4, 5, 6]);
        assert!(soup.is_welded_by_format && soup.is_f32_exact);
    }

    #[test]
    fn case_line_ends_and_name_do_not_matter() {
        let upper = format!("SOLID B\u{fc}gel facet\n{}ENDSOLID", FACET.to_uppercase());
        for text in [upper.replace('\n', "\r\n"), upper.replace('\n', "\r"), upper.replace("1", "1.0e+000")] {
            assert_eq!(read(text.as_bytes()).unwrap().triangles.len(), 1);
        }
        let mut latin_1 = b"solid B\xFCgel\n".to_vec();
        latin_1.extend(FACET.bytes());
        assert_eq!(read(&latin_1).unwrap().triangles.len(), 1);
    }

    #[test]
    fn the_normal_may_be_anything_but_a_coordinate_may_not() {
        let text = format!("solid\n{}", FACET.replace("normal 0 0 1", "normal nan -nan(ind) x"));
        assert!(read(text.as_bytes()).is_ok());
        let text = format!("solid\n{}", FACET.replace("normal 0 0 1", ""));
        assert!(read(text.as_bytes()).is_ok());
        let error = read(format!("solid\n{}", FACET.replace("1 0 0", "1 0,5 0")).as_bytes()).unwrap_err();
        assert_eq!(error.to_string(), "line 5: found \"0,5\"; expected a coordinate");
    }

    #[test]
    fn an_end_between_facets_is_fine_and_inside_one_is_an_error() {
        assert!(read(format!("solid\n{FACET}").as_bytes()).is_ok());
        for keep in 1..FACET.len() - 1 {
            let text = format!("solid\n{}", &FACET[..keep]);
            assert!(read(text.as_bytes()).is_err(), "{text}");
        }
    }

    #[test]
    fn a_loop_of_two_vertices_is_a_fault_and_of_four_an_error() {
        let soup = read(format!("solid\n{}{FACET}", FACET.replace("vertex 0 1 0", "")).as_bytes()).unwrap();
        assert_eq!(soup.face_faults, [FaceFault { face: 0, reason: FaceFaultReason::TooFewCorners }]);
        assert_eq!(soup.triangle_face, [1]);
        let four = FACET.replace(" endloop", "vertex 1 1 0\nendloop");
        let error = read(format!("solid\n{four}").as_bytes()).unwrap_err();
        assert_eq!(error.to_string(), "line 7: found \"vertex\"; expected endloop");
    }

    #[test]
    fn nan_in_a_vertex_is_a_finding_with_its_line() {
        let text = format!("solid\n{}{FACET}", FACET.replace("vertex 1 0 0", "vertex 1 nan 0"));
        let soup = read(text.as_bytes()).unwrap();
        assert_eq!((soup.non_finite_vertices, soup.triangles), (vec![1], vec![[0, 3, 2]]));
        assert_eq!(soup.places.vertex_lines[1], 5);
    }
}
