//! The boundary edges that a step made one, by the numbers of the file.

use crate::mesh::Soup;
use crate::repair;

/// The edges that a step joined, at most the first 10,000 pairs of each kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stitches {
    /// Pairs that were joined because they match, in the order in which they were joined.
    pub explicit: Vec<JoinedEdges>,
    /// All such pairs, listed or not.
    pub explicit_total: u64,
    /// Pairs that became one because vertices of others were joined.
    pub implicit: Vec<JoinedEdges>,
    /// All such pairs, listed or not.
    pub implicit_total: u64,
}

/// Two boundary edges that became one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct JoinedEdges {
    /// The ends of each edge, in the direction of its face, by the numbers that the face has for them in the file.
    pub edges: [[u32; 2]; 2],
    /// The face of each edge, by its number in the file.
    pub faces: [u32; 2],
}

impl Stitches {
    /// What a step tells of a draft that was made of `soup`.
    pub(super) fn of(inner: &repair::Joins, soup: &Soup) -> Self {
        let stitch = |join: &repair::Join| JoinedEdges {
            edges: [0, 1].map(|i| join.edges[i].map(|v| number_in_face(soup, join.triangles[i], v))),
            faces: join.triangles.map(|t| soup.face_of(t)),
        };
        Self {
            explicit: inner.explicit.iter().map(stitch).collect(),
            explicit_total: inner.explicit_total,
            implicit: inner.implicit.iter().map(stitch).collect(),
            implicit_total: inner.implicit_total,
        }
    }
}

/// The vertex of the face of triangle `t` that is at the place of vertex `v`; `v` itself where the face has none there.
fn number_in_face(soup: &Soup, t: u32, v: u32) -> u32 {
    let place = |v: u32| soup.positions[v as usize];
    let face = soup.face_of(t);
    let corners = match soup.polygons.faces.binary_search(&face) {
        Ok(polygon) => soup.polygons.corners_of(polygon),
        Err(_) => &soup.triangles[t as usize],
    };
    if corners.contains(&v) {
        return v;
    }
    corners.iter().copied().find(|&u| place(u) == place(v)).unwrap_or(v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Budget;
    use crate::formats::{Encoding, ReadOptions, read};

    #[test]
    fn ends_are_named_as_the_face_has_them() {
        let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nf 1 5 3 4\nf 2 3 1\n";
        let soup = read(text, Encoding::Obj, &ReadOptions::default(), &Budget::unlimited()).unwrap();
        let join = repair::Join { edges: [[1, 2], [2, 1]], triangles: [1, 2] };
        let inner = repair::Joins { explicit: vec![join], explicit_total: 7, ..Default::default() };
        let told = Stitches::of(&inner, &soup);
        assert_eq!(told.explicit, [JoinedEdges { edges: [[4, 2], [2, 1]], faces: [0, 1] }]);
        assert_eq!((told.explicit_total, told.implicit_total), (7, 0));
    }
}
