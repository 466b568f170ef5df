//! The boundary of a solid in an arrangement: the pieces with the inside on one side only.

use super::Arrangement;

/// A piece of a boundary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoundaryPiece {
    /// Its corners, counter-clockwise seen from outside.
    pub corners: [u32; 3],
    /// A triangle of the input that covers it, one that turns the same way if there is one.
    pub source: u32,
    /// True when it turns the other way than `source`.
    pub is_opposite: bool,
}

/// The boundary of a solid.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SolidBoundary {
    /// Its pieces, in the order of the arrangement.
    pub pieces: Vec<BoundaryPiece>,
}

impl Arrangement {
    /// The boundary of the cells that `is_inside` is true of, by the winding number of each operand there. Cavities stay.
    pub fn boundary(&self, is_inside: impl Fn(&[i32]) -> bool) -> SolidBoundary {
        let mut pieces = Vec::with_capacity(self.pieces.len());
        for (f, &[a, b, c]) in self.pieces.iter().enumerate() {
            let [front, back] = self.windings(f).map(&is_inside);
            if front == back {
                continue;
            }
            // The inside is behind what turns counter-clockwise.
            let is_turned = front;
            let sources = self.sources(f);
            let same = sources.iter().find(|(_, turned)| *turned == is_turned);
            let corners = if is_turned { [a, c, b] } else { [a, b, c] };
            let source = same.or(sources.first()).map_or(self.planes[f], |&(t, _)| t);
            pieces.push(BoundaryPiece { corners, source, is_opposite: same.is_none() });
        }
        SolidBoundary { pieces }
    }
}
