//! Texture coordinates at the corners of triangles: what becomes of them in a collapse.
//!
//! Where the two triangles of an edge have different points at one of its ends, the edge is a *seam*. The triangles
//! around a vertex between two seams are a *wedge*: they have one point there. Seams are lines, so vertices move and
//! merge along them only, and what they separate (the *charts*) stays apart.

use super::marks::LINE;
use crate::mesh::corner_table::{CornerTable, EdgeRings, NONE, next, prev, triangle_of};

/// Across and up in the picture.
pub(super) type PicturePoint = [f64; 2];

/// The point of a corner without one: of its triangle no corner has one.
pub const NO_TEXTURE: PicturePoint = [f64::INFINITY; 2];

/// The points of all corners by triangle; empty when there are none.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Wedges(pub(super) Vec<[PicturePoint; 3]>);

impl Wedges {
    fn at(&self, corner: u32) -> PicturePoint {
        self.0[triangle_of(corner) as usize][(corner & 3) as usize]
    }

    /// True when the edge of the half-edges `h` and `twin` is a seam.
    pub(super) fn is_seam(&self, h: u32, twin: u32) -> bool {
        !self.0.is_empty() && (self.at(h) != self.at(next(twin)) || self.at(next(h)) != self.at(twin))
    }

    /// Gives the wedges of both ends of `h` the points of the vertex that the edge becomes, at `share` of the way. Before
    /// the collapse; `rings` are those of `h`.
    pub(super) fn merge(&mut self, table: &CornerTable, rings: &EdgeRings, h: u32, share: f64) {
        if self.0.is_empty() {
            return;
        }
        let twin = table.twin(h);
        let left = [self.at(h), self.at(next(h))];
        let right = if twin == NONE { left } else { [self.at(next(twin)), self.at(twin)] };
        let [new_left, new_right] = [left, right].map(|[a, b]| between(a, b, share));
        for (end, ring) in [&rings.origin, &rings.destination].into_iter().enumerate() {
            // One point on both sides of the seam: its lines tell the sides apart.
            let is_told_by_lines = left[end] == right[end] && new_left != new_right;
            for &corner in &ring.corners {
                let point = &mut self.0[triangle_of(corner) as usize][(corner & 3) as usize];
                if *point == left[end] {
                    *point = new_left;
                } else if *point == right[end] {
                    *point = new_right;
                }
            }
            if is_told_by_lines {
                self.set_right(table, twin, end, ring.corners.len(), new_right);
            }
        }
    }

    /// Gives the triangles between the edge of `twin` and the next line around its destination (`end` 0) or its origin,
    /// on the side of its own triangle, a point there. There are at most `count`.
    fn set_right(&mut self, table: &CornerTable, twin: u32, end: usize, count: usize, new: PicturePoint) {
        let mut corner = if end == 0 { next(twin) } else { twin };
        for _ in 0..count {
            self.0[triangle_of(corner) as usize][(corner & 3) as usize] = new;
            let side = if end == 0 { corner } else { prev(corner) };
            let beyond = table.twin(side);
            if beyond == NONE || table.marks(side) & LINE != 0 {
                return;
            }
            corner = if end == 0 { next(beyond) } else { beyond };
        }
    }
}

fn between(a: PicturePoint, b: PicturePoint, share: f64) -> PicturePoint {
    match share {
        0.0 => a,
        1.0 => b,
        // Also of those that are not there.
        _ if a == b => a,
        _ => [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Budget;

    /// Two fans of six around 0 and 1, which share the triangles of the edge 0-1.
    ///
    /// ```text
    ///       5---4---3
    ///      / \ / \ / \
    ///     6---0---1---2
    ///      \ / \ / \ /
    ///       7---8---9
    /// ```
    fn fans() -> CornerTable {
        let triangles = [
            [0, 1, 4],
            [0, 4, 5],
            [0, 5, 6],
            [0, 6, 7],
            [0, 7, 8],
            [1, 0, 8],
            [1, 2, 3],
            [1, 3, 4],
            [1, 8, 9],
            [1, 9, 2],
        ];
        CornerTable::build(&triangles, 10, &Budget::unlimited()).unwrap()
    }

    fn merged(wedges: &mut Wedges, table: &CornerTable, share: f64) {
        let mut rings = EdgeRings::default();
        rings.walk(table, 0);
        wedges.merge(table, &rings, 0, share);
    }

    fn of(table: &CornerTable, point: impl Fn(u32, u32) -> PicturePoint) -> Wedges {
        let corners = |t: u32| [0, 1, 2].map(|k| point(t, table.origin(4 * t + k)));
        Wedges((0..table.triangle_bound() as u32).map(corners).collect())
    }

    #[test]
    fn one_chart_gets_one_point_between_the_two() {
        let table = fans();
        let mut wedges = of(&table, |_, v| [f64::from(v), 1.0]);
        assert!(
            (0..10)
                .all(|t| (4 * t..4 * t + 3)
                    .all(|h| table.twin(h) == NONE || !wedges.is_seam(h, table.twin(h))))
        );
        merged(&mut wedges, &table, 0.25);
        let want = of(&table, |_, v| [if v < 2 { 0.25 } else { f64::from(v) }, 1.0]);
        assert_eq!(wedges, want);
    }

    #[test]
    fn the_sides_of_a_seam_get_a_point_each_also_where_it_is_pinched() {
        // The seam 6-0-1-2: below it the points are further up, at 0 by `gap` only.
        for gap in [1.0, 0.0] {
            let mut table = fans();
            let is_below = |t: u32| [3, 4, 5, 8, 9].contains(&t);
            let rise = |t: u32, v: u32| match v {
                _ if !is_below(t) => 0.0,
                0 => gap,
                _ => 1.0,
            };
            let mut wedges = of(&table, |t, v| [f64::from(v), rise(t, v)]);
            let seams: Vec<u32> = table
                .half_edges()
                .filter(|&h| {
                    let twin = table.twin(h);
                    twin != NONE && h < twin && wedges.is_seam(h, twin)
                })
                .collect();
            assert_eq!(seams.len(), 3);
            seams.into_iter().for_each(|h| table.mark(h, LINE));
            merged(&mut wedges, &table, 0.5);
            let between = |t: u32| [0.5, if is_below(t) { 0.5 * (gap + 1.0) } else { 0.0 }];
            assert_eq!(
                wedges,
                of(&table, |t, v| if v < 2 { between(t) } else { [f64::from(v), rise(t, v)] })
            );
        }
    }

    #[test]
    fn corners_without_points_stay_without() {
        let table = fans();
        let mut wedges = of(&table, |t, v| if t < 6 { NO_TEXTURE } else { [f64::from(v), 1.0] });
        merged(&mut wedges, &table, 0.5);
        assert!(wedges.0[..6].as_flattened().iter().all(|&point| point == NO_TEXTURE));
    }
}
