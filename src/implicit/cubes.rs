//! How the surface between corners outside and inside runs through one cube (Lorensen and Cline 1987), by a
//! construction that makes neighbouring cubes agree.
//!
//! Each face of a cube carries directed segments between those of its edges whose ends differ: going around the face
//! counter-clockwise, seen from outside of the cube, each crossing out of a positive stretch is joined to the crossing
//! into it. So the segments of a face depend on its corners alone (on a face with two positive corners across, each is
//! cut off), and the cube on the other side, which goes around the other way, has them reversed. Each crossing edge of a
//! cube ends a segment on one of its two faces and begins one on the other: the segments form closed loops. Loops are
//! cut into triangles without a diagonal in a face of the cube, which another cube might have too.

/// The vertex in the middle of a loop, of the number `code - CENTRE`.
pub(super) const CENTRE: u8 = 32;

/// The triangles of a cube, `mask` having the bit of each corner that is positive (corner x + 2 y + 4 z).
/// Vertices are edges, as lower corner + 8 * axis, or centres of loops. Seen from the positive side they run
/// counter-clockwise. Centres come with the edges of their loops.
pub(super) fn triangles(mask: u8) -> (Vec<[u8; 3]>, Vec<Vec<u8>>) {
    let (mut triangles, mut centres) = (Vec::new(), Vec::new());
    for ring in rings(mask) {
        let n = ring.len();
        let at = |i: usize| ring[i % n];
        let is_free = |&k: &usize| (2..n - 1).all(|d| !share_a_face(at(k), at(k + d)));
        if let Some(k) = (0..n).find(is_free) {
            triangles.extend((1..n - 1).map(|d| [at(k), at(k + d), at(k + d + 1)]));
        } else {
            let centre = CENTRE + centres.len() as u8;
            triangles.extend((0..n).map(|i| [at(i), at(i + 1), centre]));
            centres.push(ring);
        }
    }
    (triangles, centres)
}

/// The closed loops of edges that the surface crosses.
fn rings(mask: u8) -> Vec<Vec<u8>> {
    const NONE: u8 = u8::MAX;
    let mut after = [NONE; CENTRE as usize];
    for axis in 0..3 {
        for side in 0..2 {
            let corners = face_corners(axis, side);
            let is_positive = |k: usize| mask >> corners[k % 4] & 1 == 1;
            for k in (0..4).filter(|&k| is_positive(k) && !is_positive(k + 1)) {
                // Back to where this positive stretch began.
                let begin = (1..4).map(|d| k + 4 - d).find(|&j| !is_positive(j)).unwrap_or(k);
                let leaving = edge(corners[k], corners[(k + 1) % 4]);
                after[leaving as usize] = edge(corners[begin % 4], corners[(begin + 1) % 4]);
            }
        }
    }
    let mut rings = Vec::new();
    for first in 0..CENTRE {
        let (mut ring, mut at) = (Vec::new(), first);
        while after[at as usize] != NONE {
            ring.push(at);
            at = std::mem::replace(&mut after[at as usize], NONE);
        }
        if !ring.is_empty() {
            rings.push(ring);
        }
    }
    rings
}

/// The corners of a face, counter-clockwise seen from outside of the cube.
fn face_corners(axis: u8, side: u8) -> [u8; 4] {
    let (b, c) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
    let base = side << axis;
    if side == 1 {
        [base, base + b, base + b + c, base + c]
    } else {
        [base, base + c, base + b + c, base + b]
    }
}

/// The edge between two corners.
fn edge(a: u8, b: u8) -> u8 {
    a.min(b) + 8 * (a ^ b).trailing_zeros() as u8
}

/// The corner and the axis of an edge.
pub(super) fn corner_and_axis(edge: u8) -> (u8, usize) {
    (edge % 8, usize::from(edge / 8))
}

fn share_a_face(e: u8, g: u8) -> bool {
    let ((p, a), (q, b)) = (corner_and_axis(e), corner_and_axis(g));
    (0..3).any(|axis| axis != a && axis != b && (p >> axis & 1) == (q >> axis & 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    type Vertex = ([i32; 3], u8);

    fn vertex(cell: [i32; 3], code: u8) -> Vertex {
        if code >= CENTRE {
            return (cell, code);
        }
        let (corner, axis) = corner_and_axis(code);
        (std::array::from_fn(|a| cell[a] + i32::from(corner >> a & 1)), axis as u8)
    }

    #[test]
    fn every_field_of_signs_gives_a_closed_oriented_surface_with_two_triangles_at_each_edge() {
        let mut state = 5u64;
        for round in 0..400 {
            let size = 4;
            let mut signs = BTreeMap::new();
            for x in 0..=size {
                for y in 0..=size {
                    for z in 0..=size {
                        state = state
                            .wrapping_mul(6_364_136_223_846_793_005)
                            .wrapping_add(1_442_695_040_888_963_407);
                        let is_border = [x, y, z].iter().any(|&c| c == 0 || c == size);
                        signs.insert([x, y, z], is_border || (state >> 33) % 10 < 1 + round % 9);
                    }
                }
            }
            let mut edges: BTreeMap<(Vertex, Vertex), i32> = BTreeMap::new();
            for cell in signs.keys().filter(|c| c.iter().all(|&x| x < size)) {
                let corner = |k: u8| std::array::from_fn(|a| cell[a] + i32::from(k >> a & 1));
                let mask = (0..8).fold(0, |m, k| m | u8::from(signs[&corner(k)]) << k);
                for t in triangles(mask).0 {
                    let t = t.map(|code| vertex(*cell, code));
                    for c in 0..3 {
                        *edges.entry((t[c], t[(c + 1) % 3])).or_default() += 1;
                    }
                }
            }
            for (&(a, b), &count) in &edges {
                assert_eq!((count, edges.get(&(b, a))), (1, Some(&1)), "round {round}: {a:?} {b:?}");
            }
        }
    }

    #[test]
    fn triangles_face_the_positive_side() {
        // Only the corner at x = y = z = 1 is positive.
        let (triangles, centres) = triangles(0b1000_0000);
        assert!(centres.is_empty());
        let place = |code: u8| {
            let (corner, axis) = corner_and_axis(code);
            let mut p: [f64; 3] = std::array::from_fn(|a| f64::from(corner >> a & 1));
            p[axis] = 0.5;
            crate::geom::DVec3::from_array(p)
        };
        let [a, b, c] = triangles[0].map(place);
        assert!((b - a).cross(c - a).dot(crate::geom::DVec3::ONE) > 0.0);
    }
}
