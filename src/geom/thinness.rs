//! What counts as a thin triangle: needles and caps, and pairs folded onto each other.

use super::DVec3;

/// A triangle whose shortest edge is below this share of its longest is a needle.
pub const NEEDLE_RATIO: f64 = 0.01;

/// Cosine of 175 degrees: a triangle with a larger angle that is no needle is a cap. Its height is then below 2.2 % of its
/// longest edge.
const CAP_COSINE: f64 = -0.996_194_698_091_745_5;

/// Cosine of one degree: faces with a smaller angle between them are folded onto each other.
const FOLDED_COSINE: f64 = 0.999_847_695_156_391_3;

/// How a triangle is thin. Edge `i` runs from corner `i` to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Thinness {
    /// By its shortest edge.
    Needle {
        /// That edge.
        shortest: usize,
    },
    /// By the angle across from its longest edge.
    Cap {
        /// That edge.
        longest: usize,
    },
}

/// How the triangle is thin, if it is, at every scale.
pub fn thinness([a, b, c]: [DVec3; 3]) -> Option<Thinness> {
    // Scaled so that the largest coordinate is 1: squares stay in the range of f64.
    let edges = [b - a, c - b, a - c];
    let largest = edges[0].abs().max(edges[1].abs()).max(edges[2].abs()).max_element();
    let edges = edges.map(|edge| edge / largest);
    let squares = edges.map(DVec3::length_squared);
    let longest = (0..3).max_by(|&i, &j| squares[i].total_cmp(&squares[j])).unwrap_or(0);
    let shortest = (0..3).min_by(|&i, &j| squares[i].total_cmp(&squares[j])).unwrap_or(0);
    if squares[shortest] < NEEDLE_RATIO * NEEDLE_RATIO * squares[longest] {
        return Some(Thinness::Needle { shortest });
    }
    let (i, j) = ((longest + 1) % 3, (longest + 2) % 3);
    // One runs to the corner across from the longest edge, the other from it.
    let cosine = -edges[i].dot(edges[j]);
    let is_cap = cosine < 0.0 && cosine * cosine > CAP_COSINE * CAP_COSINE * squares[i] * squares[j];
    is_cap.then_some(Thinness::Cap { longest })
}

/// True when two faces at an edge, with these normals of any length, lie almost on each other.
pub fn is_folded([n, m]: [DVec3; 2]) -> bool {
    let cosine = -n.dot(m);
    cosine > 0.0 && cosine * cosine > FOLDED_COSINE * FOLDED_COSINE * n.length_squared() * m.length_squared()
}
