//! Elements told in the numbering of the uploaded file.

use super::defect::{Element, Witness};
use crate::geom::DVec3;
use crate::mesh::Soup;

/// Most faces and most vertices of one witness.
const ELEMENTS_MAX: usize = 8;

/// Names the elements of a soup as its file does.
#[derive(Debug, Clone, Copy)]
pub(super) struct ElementNames<'s> {
    soup: &'s Soup,
}

impl<'s> ElementNames<'s> {
    pub(super) fn of(soup: &'s Soup) -> Self {
        Self { soup }
    }

    /// A witness of the first few of `faces` (numbers in the file) and `vertices`, at `position`.
    pub(super) fn witness(
        self,
        faces: impl IntoIterator<Item = u32>,
        vertices: impl IntoIterator<Item = u32>,
        position: DVec3,
    ) -> Witness {
        let places = &self.soup.places;
        let vertices = if self.soup.is_welded_by_format { Vec::new() } else { first_few(vertices) };
        Witness {
            faces: named(first_few(faces), &places.face_lines),
            vertices: named(vertices, &places.vertex_lines),
            position: position.is_finite().then_some(position),
            figures: Vec::new(),
            anchor: None,
            test: None,
            hole: None,
        }
    }

    /// The witness that shows the triangles `ts` of the soup.
    pub(super) fn triangles(self, ts: &[u32], position: DVec3) -> Witness {
        let corners = ts.first().into_iter().flat_map(|&t| self.soup.triangles[t as usize]);
        self.witness(ts.iter().map(|&t| self.soup.face_of(t)), corners, position)
    }
}

impl Witness {
    /// The witness that shows the `faces` of the file of `soup`, without a position.
    pub fn of_faces(soup: &Soup, faces: &[u32]) -> Self {
        ElementNames::of(soup).witness(faces.iter().copied(), [], DVec3::NAN)
    }
}

/// The first few different `ids`, in their order.
fn first_few(ids: impl IntoIterator<Item = u32>) -> Vec<u32> {
    let mut kept = Vec::new();
    for id in ids {
        if !kept.contains(&id) {
            kept.push(id);
        }
        if kept.len() == ELEMENTS_MAX {
            break;
        }
    }
    kept
}

fn named(ids: Vec<u32>, lines: &[u32]) -> Vec<Element> {
    ids.into_iter().map(|index| Element { index, line: lines.get(index as usize).copied() }).collect()
}

/// Mean of `points`, without overflow.
pub(super) fn middle<const N: usize>(points: [DVec3; N]) -> DVec3 {
    points.into_iter().map(|p| p / N as f64).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Places;

    #[test]
    fn elements_carry_their_lines_and_repeated_ones_are_named_once() {
        let soup = Soup {
            positions: vec![DVec3::ZERO; 3],
            places: Places { face_lines: vec![10, 11], vertex_lines: vec![1, 2, 3] },
            ..Soup::default()
        };
        let witness = ElementNames::of(&soup).witness([1, 1, 0], [2], DVec3::NAN);
        assert_eq!(
            witness.faces,
            [Element { index: 1, line: Some(11) }, Element { index: 0, line: Some(10) }]
        );
        assert_eq!(witness.vertices, [Element { index: 2, line: Some(3) }]);
        assert_eq!(witness.position, None);
    }

    #[test]
    fn a_format_without_vertices_names_none() {
        let soup = Soup { is_welded_by_format: true, ..Soup::default() };
        assert!(ElementNames::of(&soup).witness([], [0, 1], DVec3::ZERO).vertices.is_empty());
    }

    #[test]
    fn at_most_eight_elements_are_named() {
        assert_eq!(first_few(0..100), Vec::from_iter(0..8));
    }
}
