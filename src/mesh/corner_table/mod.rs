//! A lean half-edge mesh of triangles for collapsing edges by the million. Topology only: no coordinates here.
//!
//! The half-edges of triangle `t` are `4 t + c`, `c` in 0..3, from corner `c` to the next one: `next`, `prev` and the
//! triangle need no memory, and a triangle with its corners and twins is 32 bytes that never cross a cache line. A
//! half-edge also names the corner that it leaves. Half-edges on the empty side of a boundary do not exist. Vertices
//! know nothing: every walk starts from a half-edge. See `docs/decisions/0011-corner-table-for-strict.md` for why this
//! stands beside [`half_edge`](super::half_edge).

mod build;
mod collapse;
mod part;
mod ring;

pub use collapse::LinkRefusal;
pub use ring::{EdgeRings, VertexRing};

/// In the place of a half-edge or a vertex that is not there.
pub const NONE: u32 = u32::MAX;

/// Corners and twins of one triangle, and a byte of marks for each of its half-edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(align(32))]
struct Triangle {
    /// The fourth is not used: half-edges count by four.
    corners: [u32; 4],
    /// The fourth holds the marks, a byte for each half-edge.
    twins: [u32; 4],
}

/// A manifold of triangles, coherently oriented, with or without boundary.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CornerTable {
    triangles: Vec<Triangle>,
    alive: usize,
}

/// The half-edge after `h` in its triangle.
#[inline]
pub fn next(h: u32) -> u32 {
    if h & 3 == 2 { h - 2 } else { h + 1 }
}

/// The half-edge before `h` in its triangle.
#[inline]
pub fn prev(h: u32) -> u32 {
    if h & 3 == 0 { h + 2 } else { h - 1 }
}

/// The triangle of `h`.
#[inline]
pub fn triangle_of(h: u32) -> u32 {
    h >> 2
}

impl CornerTable {
    /// Triangle numbers are below this, half-edges below four times this.
    pub fn triangle_bound(&self) -> usize {
        self.triangles.len()
    }

    /// Number of triangles that are there.
    pub fn triangle_count(&self) -> usize {
        self.alive
    }

    /// The corners of triangle `t`, or nothing when it was removed.
    #[inline]
    pub fn corners(&self, t: u32) -> Option<[u32; 3]> {
        let [a, b, c, _] = self.triangles[t as usize].corners;
        (a != NONE).then_some([a, b, c])
    }

    /// The vertex where `h` starts.
    #[inline]
    pub fn origin(&self, h: u32) -> u32 {
        self.triangles[triangle_of(h) as usize].corners[(h & 3) as usize]
    }

    /// The vertex to which `h` goes.
    #[inline]
    pub fn destination(&self, h: u32) -> u32 {
        self.origin(next(h))
    }

    /// The other half-edge of the edge of `h`, or [`NONE`] at a boundary.
    #[inline]
    pub fn twin(&self, h: u32) -> u32 {
        self.triangles[triangle_of(h) as usize].twins[(h & 3) as usize]
    }

    /// The marks of the edge of `h`; the two half-edges of an edge have the same.
    #[inline]
    pub fn marks(&self, h: u32) -> u8 {
        (self.triangles[triangle_of(h) as usize].twins[3] >> (8 * (h & 3))) as u8
    }

    /// Adds marks to the edge of `h`. When two edges become one, it has the marks of both.
    pub fn mark(&mut self, h: u32, marks: u8) {
        let twin = self.twin(h);
        for g in [h, twin] {
            if g != NONE {
                self.triangles[triangle_of(g) as usize].twins[3] |= u32::from(marks) << (8 * (g & 3));
            }
        }
    }

    /// The half-edge that stands for the edge of `h`: the smaller of the two.
    #[inline]
    pub fn edge(&self, h: u32) -> u32 {
        // NONE is larger than every half-edge.
        h.min(self.twin(h))
    }

    /// The half-edges of the triangles that are there, ascending.
    pub fn half_edges(&self) -> impl Iterator<Item = u32> {
        let is_there = |t: &u32| self.triangles[*t as usize].corners[0] != NONE;
        (0..self.triangles.len() as u32).filter(is_there).flat_map(|t| [4 * t, 4 * t + 1, 4 * t + 2])
    }

    /// Makes `a` and `b`, of which one may be [`NONE`], the half-edges of one edge with the marks of both.
    fn pair(&mut self, a: u32, b: u32, marks: u8) {
        for (h, twin) in [(a, b), (b, a)] {
            if h != NONE {
                let triangle = &mut self.triangles[triangle_of(h) as usize];
                triangle.twins[(h & 3) as usize] = twin;
                triangle.twins[3] |= u32::from(marks) << (8 * (h & 3));
            }
        }
    }
}
