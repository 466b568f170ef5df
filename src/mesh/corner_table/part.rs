//! A corner table of a piece of a larger mesh, in which not every vertex has all its triangles.

use super::{CornerTable, NONE, Triangle};
use crate::budget::{Budget, CHECK_EVERY, Stopped};

impl CornerTable {
    /// The table of `triangles`, whose vertices are `first_vertex..first_vertex + vertex_count` and are counted from 0
    /// in the table; and for each vertex whether its triangles are exactly one fan, closed or open, with every
    /// neighbour once. Around other vertices twins may be missing. O(n).
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn build_part(
        triangles: &[[u32; 3]],
        first_vertex: u32,
        vertex_count: usize,
        budget: &Budget,
    ) -> Result<(Self, Vec<bool>), Stopped> {
        budget.check()?;
        let mut table = Self::unpaired(triangles, first_vertex);
        let mut is_regular = vec![true; vertex_count];
        for triangle in &table.triangles {
            let [a, b, c, _] = triangle.corners;
            if a == b || b == c || c == a {
                [a, b, c].into_iter().for_each(|v| is_regular[v as usize] = false);
            }
        }
        let mut edges = HalfEdgeEntries::of(&table, vertex_count);
        for v in 0..vertex_count {
            if v.is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            table.pair_above(v, edges.above(v), &mut is_regular);
        }
        table.require_one_fan(&mut is_regular);
        Ok((table, is_regular))
    }

    /// The table of `triangles`, with `first_vertex` taken from their vertices, in which no half-edge has a twin.
    pub fn unpaired(triangles: &[[u32; 3]], first_vertex: u32) -> Self {
        let triangle = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|v| v - first_vertex);
            Triangle { corners: [a, b, c, NONE], twins: [NONE, NONE, NONE, 0] }
        };
        Self { triangles: triangles.iter().map(triangle).collect(), alive: triangles.len() }
    }

    /// Pairs the half-edges between `v` and larger vertices.
    fn pair_above(&mut self, v: usize, edges: &mut [HalfEdgeEntry], is_regular: &mut [bool]) {
        edges.sort_unstable();
        for edge in edges.chunk_by(|a, b| a.larger == b.larger) {
            match *edge {
                [_] => {}
                [a, b] if a.is_upward != b.is_upward => self.pair(a.half_edge, b.half_edge, 0),
                _ => {
                    is_regular[v] = false;
                    is_regular[edge[0].larger as usize] = false;
                }
            }
        }
    }

    /// Takes the mark from vertices of which one walk does not reach all triangles.
    fn require_one_fan(&self, is_regular: &mut [bool]) {
        let mut left = vec![0u32; is_regular.len()];
        for triangle in &self.triangles {
            triangle.corners[..3].iter().for_each(|&v| left[v as usize] += 1);
        }
        for h in self.half_edges() {
            let v = self.origin(h) as usize;
            if left[v] > 0 && is_regular[v] {
                is_regular[v] = self.fan(h).take(left[v] as usize + 1).count() == left[v] as usize;
                left[v] = 0;
            }
        }
    }
}

/// A half-edge seen from the smaller of its ends.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct HalfEdgeEntry {
    larger: u32,
    half_edge: u32,
    is_upward: bool,
}

/// The half-edges by the smaller of their ends.
struct HalfEdgeEntries {
    starts: Vec<u32>,
    sides: Vec<HalfEdgeEntry>,
}

impl HalfEdgeEntries {
    fn of(table: &CornerTable, vertex_count: usize) -> Self {
        let mut starts = vec![0u32; vertex_count + 2];
        for triangle in &table.triangles {
            let [a, b, c, _] = triangle.corners;
            for smaller in [a.min(b), b.min(c), c.min(a)] {
                starts[smaller as usize + 2] += 1;
            }
        }
        for v in 0..vertex_count {
            starts[v + 2] += starts[v + 1];
        }
        let mut sides = vec![HalfEdgeEntry::default(); table.triangles.len() * 3];
        for (t, triangle) in table.triangles.iter().enumerate() {
            let [a, b, c, _] = triangle.corners;
            for (k, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
                let place = &mut starts[from.min(to) as usize + 1];
                let half_edge = (4 * t + k) as u32;
                sides[*place as usize] =
                    HalfEdgeEntry { larger: from.max(to), half_edge, is_upward: from < to };
                *place += 1;
            }
        }
        Self { starts, sides }
    }

    fn above(&mut self, v: usize) -> &mut [HalfEdgeEntry] {
        &mut self.sides[self.starts[v] as usize..self.starts[v + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::corner_table::next;

    fn part(triangles: &[[u32; 3]]) -> (CornerTable, Vec<bool>) {
        CornerTable::build_part(triangles, 10, 6, &Budget::unlimited()).unwrap()
    }

    fn shifted(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
        triangles.iter().map(|t| t.map(|v| v + 10)).collect()
    }

    #[test]
    fn a_manifold_is_paired_as_by_the_strict_builder() {
        let octahedron =
            [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [5, 2, 1], [5, 3, 2], [5, 4, 3], [5, 1, 4]];
        for list in [&octahedron[..], &octahedron[..5], &octahedron[..2]] {
            let (table, is_regular) = part(&shifted(list));
            assert_eq!(table, CornerTable::build(list, 6, &Budget::unlimited()).unwrap());
            assert_eq!(is_regular, [true; 6]);
        }
    }

    #[test]
    fn vertices_whose_triangles_are_not_one_fan_are_told() {
        for (list, irregular) in [
            // Two triangles with a common vertex only; a book of three pages; two in conflict; a double book.
            (&[[0, 1, 2], [2, 3, 4]][..], &[2][..]),
            (&[[0, 1, 2], [1, 0, 3], [0, 1, 4]][..], &[0, 1][..]),
            (&[[0, 1, 2], [0, 1, 3]][..], &[0, 1][..]),
            (&[[0, 1, 2], [1, 0, 3], [0, 1, 4], [1, 0, 5]][..], &[0, 1][..]),
            (&[[0, 1, 1]][..], &[0, 1][..]),
        ] {
            let (table, is_regular) = part(&shifted(list));
            let found: Vec<usize> = (0..6).filter(|&v| !is_regular[v]).collect();
            assert_eq!(found, irregular, "{list:?}");
            assert!(table.half_edges().all(|h| table.twin(h) == NONE || table.twin(table.twin(h)) == h));
            assert!(
                table
                    .half_edges()
                    .filter(|&h| table.twin(h) != NONE)
                    .all(|h| table.origin(table.twin(h)) == table.origin(next(h)))
            );
        }
    }
}
