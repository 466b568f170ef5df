//! Edge collapse under the full link condition, on rings that are already walked.

use super::{CornerTable, EdgeRings, NONE, VertexRing, next, prev, triangle_of};

/// Why an edge may not be collapsed; as [`CollapseRefusal`](crate::mesh::half_edge::CollapseRefusal).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LinkRefusal {
    /// Both ends are on a boundary and the edge is not.
    InnerEdgeBetweenBoundaries,
    /// The ends have a common neighbour that is in no triangle of the edge.
    CommonNeighbour,
    /// A triangle of the edge has its two other sides on a boundary.
    Ear,
    /// The edge of a tetrahedron.
    Tetrahedron,
    /// The two triangles of the edge have the same corners.
    DoubleFace,
}

impl CornerTable {
    /// The link condition of Dey, Edelsbrunner, Guha and Nekhayev (1998) with every boundary closed by a cone, for the
    /// edge of `h`, whose rings are `rings`: `lk(a) ∩ lk(b) = lk(ab)`.
    ///
    /// # Errors
    /// With the reason when it does not hold.
    #[inline]
    pub fn link_condition(&self, h: u32, rings: &EdgeRings) -> Result<(), LinkRefusal> {
        let (origin, destination) = (&rings.origin, &rings.destination);
        let twin = self.twin(h);
        if twin != NONE && origin.is_boundary && destination.is_boundary {
            return Err(LinkRefusal::InnerEdgeBetweenBoundaries);
        }
        let is_ear = |g: u32| self.twin(next(g)) == NONE && self.twin(prev(g)) == NONE;
        if is_ear(h) || (twin != NONE && is_ear(twin)) {
            return Err(LinkRefusal::Ear);
        }
        let x = self.origin(prev(h));
        let y = if twin == NONE { NONE } else { self.origin(prev(twin)) };
        if x == y {
            return Err(LinkRefusal::DoubleFace);
        }
        let is_shared = |v: &&u32| destination.neighbours.contains(v);
        if origin.neighbours.iter().filter(is_shared).count() > 1 + usize::from(twin != NONE) {
            return Err(LinkRefusal::CommonNeighbour);
        }
        // A face of one end on the two apexes closes its star with the two faces of the edge: three in all.
        let is_triple = |ring: &VertexRing| ring.corners.len() == 3 && !ring.is_boundary;
        if twin != NONE && is_triple(origin) && is_triple(destination) {
            return Err(LinkRefusal::Tetrahedron);
        }
        Ok(())
    }

    /// Moves the origin `a` of `h` onto its destination `b`; `rings` are those of `h`, and the
    /// [link condition](Self::link_condition) holds.
    ///
    /// ```text
    ///         x                      x
    ///      \ / \ /                \  |  /
    ///     --a-h-b--     gives     ---b---
    ///      / \ / \                /  |  \
    ///         y                      y
    /// ```
    /// The triangles of the edge are removed. Of `ax` and `bx` one edge remains, of `ay` and `by` too, with the marks
    /// of both.
    #[inline]
    pub fn collapse(&mut self, h: u32, rings: &EdgeRings) {
        let b = self.destination(h);
        for &corner in &rings.origin.corners {
            self.triangles[triangle_of(corner) as usize].corners[(corner & 3) as usize] = b;
        }
        let twin = self.twin(h);
        self.close(h);
        if twin != NONE {
            self.close(twin);
        }
    }

    /// Removes the triangle of `h` and joins what is behind its other two sides.
    fn close(&mut self, h: u32) {
        let (ahead, behind) = (next(h), prev(h));
        let marks = self.marks(ahead) | self.marks(behind);
        self.pair(self.twin(ahead), self.twin(behind), marks);
        self.triangles[triangle_of(h) as usize].corners = [NONE; 4];
        self.alive -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Budget;

    fn table(triangles: &[[u32; 3]]) -> CornerTable {
        CornerTable::build(triangles, 9, &Budget::unlimited()).unwrap()
    }

    fn refusal(table: &CornerTable, a: u32, b: u32) -> LinkRefusal {
        let h = table.half_edges().find(|&h| (table.origin(h), table.destination(h)) == (a, b)).unwrap();
        let mut rings = EdgeRings::default();
        rings.walk(table, h);
        table.link_condition(h, &rings).unwrap_err()
    }

    #[test]
    fn each_refusal_is_named() {
        let tetrahedron = table(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
        assert_eq!(refusal(&tetrahedron, 0, 1), LinkRefusal::Tetrahedron);
        assert_eq!(refusal(&table(&[[0, 1, 2]]), 0, 1), LinkRefusal::Ear);
        assert_eq!(refusal(&table(&[[0, 1, 2], [0, 2, 1]]), 0, 1), LinkRefusal::DoubleFace);
        let strip = table(&[[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]]);
        assert_eq!(refusal(&strip, 2, 3), LinkRefusal::InnerEdgeBetweenBoundaries);
        let waist = table(&[[0, 1, 3], [1, 2, 3], [2, 0, 3], [1, 0, 4], [2, 1, 4], [0, 2, 4]]);
        assert_eq!(refusal(&waist, 0, 1), LinkRefusal::CommonNeighbour);
    }

    #[test]
    fn a_collapse_joins_the_sides_and_keeps_their_marks() {
        // An octahedron; its pole 0 goes onto 1.
        let mut octahedron =
            table(&[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [5, 2, 1], [5, 3, 2], [5, 4, 3], [5, 1, 4]]);
        octahedron.mark(4, 1);
        let mut rings = EdgeRings::default();
        rings.walk(&octahedron, 0);
        assert_eq!(octahedron.link_condition(0, &rings), Ok(()));
        octahedron.collapse(0, &rings);
        assert_eq!(octahedron.triangle_count(), 6);
        assert_eq!((octahedron.corners(0), octahedron.corners(3)), (None, None));
        assert_eq!(octahedron.corners(1), Some([1, 2, 3]));
        // The marked edge 0-2 is now one with 1-2, between the triangles 1 and 4.
        assert_eq!((octahedron.twin(4), octahedron.marks(4), octahedron.marks(17)), (17, 1, 1));
        assert!(octahedron.half_edges().all(|h| octahedron.twin(octahedron.twin(h)) == h));
    }
}
