//! The triangles and vertices around a vertex, and around both ends of an edge.

use super::{CornerTable, NONE, next, prev};

/// What is around one vertex.
#[derive(Debug, Clone, Default)]
pub struct VertexRing {
    /// The half-edges of triangles that leave the vertex, counter-clockwise from the one the walk began with; at a
    /// boundary those clockwise of it follow, clockwise.
    pub corners: Vec<u32>,
    /// The vertices that share an edge with it. `neighbours[i]` is where `corners[i]` goes; at a boundary one more
    /// follows.
    pub neighbours: Vec<u32>,
    /// True when an edge of the vertex is on a boundary.
    pub is_boundary: bool,
}

/// The rings of the two ends of an edge. Kept between edges, so that nothing is allocated.
#[derive(Debug, Clone, Default)]
pub struct EdgeRings {
    /// Around the origin; begins with the half-edge itself.
    pub origin: VertexRing,
    /// Around the destination; begins with the half-edge after it.
    pub destination: VertexRing,
}

impl VertexRing {
    /// Fills in what is around the origin of `h`.
    #[inline]
    pub fn walk(&mut self, table: &CornerTable, h: u32) {
        self.corners.clear();
        self.neighbours.clear();
        self.is_boundary = false;
        let mut corner = h;
        loop {
            self.corners.push(corner);
            self.neighbours.push(table.destination(corner));
            let before = prev(corner);
            let beyond = table.twin(before);
            if beyond == h {
                return;
            }
            if beyond == NONE {
                self.is_boundary = true;
                self.walk_clockwise(table, h, table.origin(before));
                return;
            }
            corner = beyond;
        }
    }

    fn walk_clockwise(&mut self, table: &CornerTable, h: u32, last_neighbour: u32) {
        let mut twin = table.twin(h);
        while twin != NONE {
            let corner = next(twin);
            self.corners.push(corner);
            self.neighbours.push(table.destination(corner));
            twin = table.twin(corner);
        }
        self.neighbours.push(last_neighbour);
    }
}

impl EdgeRings {
    /// Fills in what is around both ends of `h`.
    #[inline]
    pub fn walk(&mut self, table: &CornerTable, h: u32) {
        self.origin.walk(table, h);
        self.destination.walk(table, next(h));
    }
}

impl CornerTable {
    /// The half-edges of triangles that leave the origin of `h`, in the order of [`VertexRing::corners`].
    pub fn fan(&self, h: u32) -> impl Iterator<Item = u32> {
        let mut is_clockwise = false;
        std::iter::successors(Some(h), move |&corner| {
            if !is_clockwise {
                let beyond = self.twin(prev(corner));
                if beyond != NONE {
                    return Some(beyond).filter(|&beyond| beyond != h);
                }
                is_clockwise = true;
                return Some(self.twin(h)).filter(|&twin| twin != NONE).map(next);
            }
            Some(self.twin(corner)).filter(|&twin| twin != NONE).map(next)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Budget;

    #[test]
    fn a_ring_is_the_same_set_from_every_corner_and_equals_the_fan() {
        // Four triangles around 0, open between 5 and 1; and a tetrahedron.
        let lists: [&[[u32; 3]]; 2] =
            [&[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]], &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]];
        for list in lists {
            let table = CornerTable::build(list, 6, &Budget::unlimited()).unwrap();
            let mut ring = VertexRing::default();
            for h in table.half_edges() {
                ring.walk(&table, h);
                assert_eq!(ring.corners, table.fan(h).collect::<Vec<_>>());
                let v = table.origin(h);
                let mut corners = ring.corners.clone();
                corners.sort_unstable();
                let want: Vec<u32> = table.half_edges().filter(|&g| table.origin(g) == v).collect();
                assert_eq!(corners, want);
                let mut neighbours = ring.neighbours.clone();
                neighbours.sort_unstable();
                let mut want: Vec<u32> =
                    list.iter().filter(|t| t.contains(&v)).flatten().copied().filter(|&w| w != v).collect();
                want.sort_unstable();
                want.dedup();
                assert_eq!(neighbours, want);
                for (&corner, &neighbour) in ring.corners.iter().zip(&ring.neighbours) {
                    assert_eq!(table.destination(corner), neighbour);
                }
                assert_eq!(ring.is_boundary, ring.neighbours.len() > ring.corners.len());
            }
        }
    }
}
