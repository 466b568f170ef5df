//! Marching tetrahedra on cubes cut in six (Kuhn): the surface between inside and outside, for any signs.
//!
//! ```text
//!   one corner apart            two and two
//!        a                       a-------b      inside: a, b
//!       /|\                      |\ ac bc|
//!     ab | ad                    | \  /  |      the quad ac, ad, bd, bc is cut along
//!     /  ac \                    |  \/   |      ac-bd or ad-bc, the shorter one
//!    b---|---d                   | ad bd |
//!        c                       c-------d
//! ```

use super::lattice::Lattice;
use super::signs::Signs;
use crate::budget::{Budget, Charge, Stopped};

/// An edge of the lattice with ends of both signs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct CutEdge {
    /// Number of its lower vertex.
    pub(super) base: u32,
    /// Bits 0, 1 and 2: whether it goes along the first, second and third axis. Never 0.
    pub(super) direction: u8,
}

/// The surface before the places of its vertices are chosen: vertex `v` is on edge `edges[v]`. Of four corners the
/// diagonal is still to be chosen.
#[derive(Debug, Default)]
pub(super) struct Patches {
    pub(super) edges: Vec<CutEdge>,
    /// Counter-clockwise seen from outside.
    pub(super) triangles: Vec<[u32; 3]>,
    /// As `triangles`, with four corners in cyclic order.
    pub(super) quads: Vec<[u32; 4]>,
}

/// The tetrahedra of a cube: corners as bits of axes, all with positive orientation.
const TETRAHEDRA: [[u8; 4]; 6] =
    [[0, 1, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 3, 2, 7], [0, 6, 4, 7], [0, 5, 1, 7]];

const NONE: u32 = u32::MAX;

/// The surface between known vertices of different sign. Cubes with an unknown vertex must have no two known ones of
/// different sign.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn march(lattice: &Lattice, signs: &Signs<'_>, budget: &Budget) -> Result<Patches, Stopped> {
    let [x, y, z] = lattice.dims;
    let layer = y * z;
    let mut slabs = Slabs::new(layer, budget)?;
    let offsets: [usize; 8] = std::array::from_fn(|c| lattice.index([c & 1, c >> 1 & 1, c >> 2 & 1]));
    let mut patches = Patches::default();
    for i in 0..x - 1 {
        for j in 0..y - 1 {
            budget.check()?;
            let start = lattice.index([i, j, 0]);
            let mut sides = column_sides(signs, &offsets, start);
            for k in 0..z - 1 {
                let base = start + k;
                let above = column_sides(signs, &offsets, base + 1);
                let mask = sides | above << 4;
                sides = above;
                if mask == 0 || mask == 0xff || offsets.iter().any(|o| !signs.is_known(base + o)) {
                    continue;
                }
                let mut vertex = |from: u8, to: u8| {
                    let edge = CutEdge { base: (base + offsets[from as usize]) as u32, direction: from ^ to };
                    slabs.vertex(edge, layer, i, &mut patches.edges)
                };
                for tetrahedron in TETRAHEDRA {
                    cut_tetrahedron(
                        tetrahedron,
                        mask,
                        &mut vertex,
                        &mut patches.triangles,
                        &mut patches.quads,
                    );
                }
            }
        }
        slabs.advance();
    }
    budget.spend((patches.triangles.len() + patches.quads.len()) as u64)?;
    Ok(patches)
}

/// Bits 0 to 3: which of the four vertices across a column at this height are inside.
fn column_sides(signs: &Signs<'_>, offsets: &[usize; 8], base: usize) -> u8 {
    (0..4).map(|c| u8::from(signs.is_inside(base + offsets[c])) << c).sum()
}

/// Cuts one tetrahedron. `mask` has a bit for each corner of the cube; `vertex` gives the one on an edge, which it takes
/// from the lower to the higher corner.
fn cut_tetrahedron(
    corners: [u8; 4],
    mask: u8,
    vertex: &mut impl FnMut(u8, u8) -> u32,
    triangles: &mut Vec<[u32; 3]>,
    quads: &mut Vec<[u32; 4]>,
) {
    let inside = (0..4).map(|n| (mask >> corners[n] & 1) << n).sum::<u8>();
    // Of two corners of a tetrahedron, the lower one has fewer bits and the smaller number.
    let mut cut = |p: usize, q: usize| {
        let (p, q) = (corners[p], corners[q]);
        vertex(p.min(q), p.max(q))
    };
    // Even permutations, which keep the orientation: `a` is alone, or with `b`.
    let [a, b, c, d] = match inside {
        0 | 15 => return,
        1 | 14 | 3 | 12 => [0, 1, 2, 3],
        2 | 13 => [1, 0, 3, 2],
        4 | 11 => [2, 0, 1, 3],
        8 | 7 => [3, 0, 2, 1],
        5 | 10 => [0, 2, 3, 1],
        _ => [0, 3, 1, 2],
    };
    let is_a_inside = inside >> a & 1 == 1;
    if matches!(inside.count_ones(), 1 | 3) {
        let [p, q, r] = [cut(a, b), cut(a, c), cut(a, d)];
        triangles.push(if is_a_inside { [p, q, r] } else { [p, r, q] });
    } else {
        let [p, q, r, s] = [cut(a, c), cut(a, d), cut(b, d), cut(b, c)];
        quads.push(if is_a_inside { [p, q, r, s] } else { [p, s, r, q] });
    }
}

/// Numbers of the vertices on the edges that begin in two neighbouring layers.
struct Slabs<'b> {
    /// Seven for each vertex of the layer.
    here: Vec<u32>,
    next: Vec<u32>,
    _charge: Charge<'b>,
}

impl<'b> Slabs<'b> {
    fn new(layer: usize, budget: &'b Budget) -> Result<Self, Stopped> {
        let charge = budget.charge(layer as u64 * 56)?;
        Ok(Self { here: vec![NONE; layer * 7], next: vec![NONE; layer * 7], _charge: charge })
    }

    /// The vertex on `edge`, which begins in layer `i` or the next.
    fn vertex(&mut self, edge: CutEdge, layer: usize, i: usize, edges: &mut Vec<CutEdge>) -> u32 {
        let place = edge.base as usize - i * layer;
        let (slab, place) =
            if place < layer { (&mut self.here, place) } else { (&mut self.next, place - layer) };
        let number = &mut slab[place * 7 + edge.direction as usize - 1];
        if *number == NONE {
            *number = edges.len() as u32;
            edges.push(edge);
        }
        *number
    }

    fn advance(&mut self) {
        std::mem::swap(&mut self.here, &mut self.next);
        self.next.fill(NONE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;

    fn at(corner: u8) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|a| f64::from(corner >> a & 1)))
    }

    #[test]
    fn the_tetrahedra_fill_the_cube_with_one_orientation() {
        let volume: f64 = TETRAHEDRA
            .iter()
            .map(|t| {
                let [a, b, c, d] = t.map(at);
                let six = (b - a).dot((c - a).cross(d - a));
                assert_eq!(six, 1.0, "{t:?}");
                six / 6.0
            })
            .sum();
        assert!((volume - 1.0).abs() < 1e-12);
    }

    #[test]
    fn every_cut_of_a_tetrahedron_faces_from_inside_to_outside() {
        for tetrahedron in TETRAHEDRA {
            for inside in 1..15u8 {
                let mask = (0..4).filter(|n| inside >> n & 1 == 1).map(|n| 1u8 << tetrahedron[n]).sum::<u8>();
                let mut places = Vec::new();
                let (mut triangles, mut quads) = (Vec::new(), Vec::new());
                let mut vertex = |from: u8, to: u8| {
                    assert_eq!(from & to, from, "an edge goes up");
                    assert_ne!(mask >> from & 1, mask >> to & 1);
                    places.push((at(from) + at(to)) / 2.0);
                    places.len() as u32 - 1
                };
                cut_tetrahedron(tetrahedron, mask, &mut vertex, &mut triangles, &mut quads);
                triangles.extend(quads.iter().flat_map(|&[p, q, r, s]| [[p, q, r], [p, r, s]]));
                assert_eq!(triangles.len(), if inside.count_ones() == 2 { 2 } else { 1 });
                for t in triangles {
                    let [a, b, c] = t.map(|v| places[v as usize]);
                    let normal = (b - a).cross(c - a);
                    for n in 0..4 {
                        let side = normal.dot(at(tetrahedron[n]) - a);
                        let is_inside = inside >> n & 1 == 1;
                        assert!(
                            if is_inside { side <= 0.0 } else { side >= 0.0 },
                            "{tetrahedron:?} {inside}"
                        );
                    }
                }
            }
        }
    }
}
