//! What the faces around a vertex look like just after it was split, seen from infinitely near: new vertices where they
//! are after one unit of time, and rays where the edges to other vertices were.
//!
//! Each new vertex may have a sound link, and still an edge of one may cross a face at another: both were in one point
//! before. So every edge is tried against every face of the picture. Points at infinity are vectors with a weight of
//! zero, for which the determinants that decide are the same.

use super::direction::{Direction, Sector};
use super::exact::{IntegerVector, cross, dot, is_zero, negative, sign};
use super::point::{AxisView, Point, PointLocation};
use crate::geom::DVec3;
use num_bigint::BigInt;
use num_traits::Zero;
use std::cmp::Ordering;

/// A face: its plane is `normal . x = rate`.
struct ConeFace {
    normal: IntegerVector,
    rate: BigInt,
    view: AxisView,
    /// Its real edges, by their points, in their order: in from infinity and out again.
    edges: Vec<[usize; 2]>,
    /// The border of the region with corners at infinity between the last and the first.
    border: Vec<usize>,
}

/// The picture.
pub(super) struct Cone {
    points: Vec<Point>,
    faces: Vec<ConeFace>,
    /// Each edge by its points, and the faces beside it.
    edges: Vec<([usize; 2], [usize; 2])>,
}

/// The plane of a face around the vertex.
pub(super) struct ConePlane<'s> {
    /// Its normal.
    pub(super) normal: &'s Direction,
    /// Its unit normal, rounded.
    pub(super) unit: DVec3,
    /// How much its offset grows.
    pub(super) rate: BigInt,
}

fn at_infinity(direction: IntegerVector) -> Point {
    // Rounded coordinates that decide nothing.
    Point { x: direction, w: BigInt::zero(), near: DVec3::NAN }
}

impl Cone {
    /// `sides`: the faces, clockwise. `rays`: the directions of the edges between each and the next. `vertices`: the new
    /// ones. `cells`: the faces around each, ascending.
    pub(super) fn of(
        sides: &[ConePlane<'_>],
        rays: &[Direction],
        vertices: Vec<Point>,
        cells: &[Vec<usize>],
    ) -> Option<Self> {
        let (count, first_ray) = (sides.len(), vertices.len());
        let mut cone = Self { points: vertices, faces: Vec::new(), edges: Vec::new() };
        cone.points.extend(rays.iter().map(|ray| at_infinity(ray.exact.clone())));
        for (i, side) in sides.iter().enumerate() {
            let before = (i + count - 1) % count;
            let chain = chain(cells, i, count)?;
            let ends = [first_ray + before, first_ray + i];
            let mut border = vec![ends[0]];
            border.extend(&chain);
            border.push(ends[1]);
            let edges: Vec<[usize; 2]> = border.windows(2).map(|pair| [pair[0], pair[1]]).collect();
            cone.edges.push(([chain[chain.len() - 1], ends[1]], [i, (i + 1) % count]));
            for pair in chain.windows(2) {
                let other = cells[pair[0]].iter().find(|&&j| j > i && cells[pair[1]].contains(&j));
                cone.edges.extend(other.map(|&j| ([pair[0], pair[1]], [i, j])));
            }
            let (out, back) = (&rays[i], &rays[before]);
            let sector = Sector { normal: side.normal, from: out, to: back };
            let across = cross(&side.normal.exact, &out.exact);
            for exact in [across.clone(), negative(&out.exact), negative(&across)] {
                let direction = Direction::new(exact);
                if sector.holds(&direction) && !direction.is_parallel(back) {
                    border.push(cone.points.len());
                    cone.points.push(at_infinity(direction.exact));
                }
            }
            let view = AxisView::along(side.unit);
            cone.faces.push(ConeFace {
                normal: side.normal.exact.clone(),
                rate: side.rate.clone(),
                view,
                edges,
                border,
            });
        }
        Some(cone)
    }

    /// True when edges and faces meet in what they share only.
    pub(super) fn is_embedded(&self) -> bool {
        let is_simple = |face: &ConeFace| {
            (0..face.edges.len())
                .all(|i| (0..i).all(|j| !self.do_meet(face.view, face.edges[i], face.edges[j])))
        };
        self.faces.iter().all(is_simple)
            && self.edges.iter().all(|(ends, beside)| {
                (0..self.faces.len()).all(|f| beside.contains(&f) || !self.meets_face(*ends, &self.faces[f]))
            })
    }

    fn is_far(&self, p: usize) -> bool {
        self.points[p].w.is_zero()
    }

    /// From a point at hand to any other: the direction, with a positive factor.
    fn direction(&self, from: usize, to: usize) -> IntegerVector {
        if self.is_far(to) { self.points[to].x.clone() } else { self.points[from].to(&self.points[to]) }
    }

    /// Whether two edges in one plane meet in more than a common end. At most one end of each is at infinity.
    fn do_meet(&self, view: AxisView, g: [usize; 2], h: [usize; 2]) -> bool {
        let point = |p: usize| &self.points[p];
        let shared: Vec<usize> = g.into_iter().filter(|p| h.contains(p)).collect();
        if let &[common] = shared.as_slice() {
            if self.is_far(common) {
                return false;
            }
            let [p, q] = [g, h].map(|s| if s[0] == common { s[1] } else { s[0] });
            let (a, b) = (self.direction(common, p), self.direction(common, q));
            return is_zero(&cross(&a, &b)) && sign(&dot(&a, &b)) == Ordering::Greater;
        }
        if shared.len() == 2 {
            return true;
        }
        let [a, b] = g;
        let [c, d] = h;
        let turn = |p: usize, q: usize, r: usize| view.turn(point(p), point(q), point(r));
        let turns = [turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)];
        let is_on = [(c, a, b), (d, a, b), (a, c, d), (b, c, d)]
            .into_iter()
            .zip(turns)
            .any(|((p, q, r), turn)| turn == Ordering::Equal && !self.is_far(p) && self.is_between(p, q, r));
        is_on || (turns.iter().all(|&t| t != Ordering::Equal) && turns[0] != turns[1] && turns[2] != turns[3])
    }

    /// Whether `p`, at hand and on the line of `a` and `b`, is not beyond either.
    fn is_between(&self, p: usize, a: usize, b: usize) -> bool {
        let (to_a, to_b) = (self.direction(p, a), self.direction(p, b));
        sign(&dot(&to_a, &to_b)) != Ordering::Greater
    }

    fn height(&self, face: &ConeFace, p: usize) -> BigInt {
        let point = &self.points[p];
        dot(&face.normal, &point.x) - &face.rate * &point.w
    }

    /// Whether an edge meets a face that is not beside it in more than a common vertex.
    fn meets_face(&self, ends: [usize; 2], face: &ConeFace) -> bool {
        let heights = ends.map(|p| self.height(face, p));
        let is_in = |p: &Point| self.locate(face, p) != PointLocation::Outside;
        match heights.each_ref().map(sign) {
            [Ordering::Equal, Ordering::Equal] => {
                face.edges.iter().any(|&side| self.do_meet(face.view, ends, side)) || is_in(&self.inner(ends))
            }
            [Ordering::Equal, _] => self.touches(ends[0], face),
            [_, Ordering::Equal] => self.touches(ends[1], face),
            [a, b] if a == b => false,
            _ => {
                let [a, b] = ends.map(|p| &self.points[p]);
                let [i, j] = heights.map(|h| if h < BigInt::zero() { -h } else { h });
                let x = std::array::from_fn(|k| &a.x[k] * &j + &b.x[k] * &i);
                is_in(&Point::new(x, &a.w * &j + &b.w * &i))
            }
        }
    }

    /// Whether a point of the plane of a face is in the face and no corner of it.
    fn touches(&self, p: usize, face: &ConeFace) -> bool {
        !self.is_far(p)
            && !face.border.contains(&p)
            && self.locate(face, &self.points[p]) != PointLocation::Outside
    }

    /// A point inside an edge.
    fn inner(&self, [a, b]: [usize; 2]) -> Point {
        let (a, b) = if self.is_far(a) { (b, a) } else { (a, b) };
        let (p, q) = (&self.points[a], &self.points[b]);
        if self.is_far(b) {
            return Point::new(std::array::from_fn(|k| &p.x[k] + &q.x[k]), p.w.clone());
        }
        let x = std::array::from_fn(|k| &p.x[k] * &q.w + &q.x[k] * &p.w);
        Point::new(x, (&p.w * &q.w) << 1)
    }

    fn locate(&self, face: &ConeFace, p: &Point) -> PointLocation {
        let count = face.border.len();
        let corner = |i: usize| &self.points[face.border[i % count]];
        // What is at infinity on one line is no border of anything at hand.
        let sides = (0..count).map(|i| [corner(i), corner(i + 1)]);
        face.view.locate(p, sides)
    }
}

/// The new vertices of face `i`, from its edge with the face before to that with the face after.
fn chain(cells: &[Vec<usize>], i: usize, count: usize) -> Option<Vec<usize>> {
    let around = |c: usize| {
        let cell = &cells[c];
        let k = cell.iter().position(|&j| j == i)?;
        Some([cell[(k + cell.len() - 1) % cell.len()], cell[(k + 1) % cell.len()]])
    };
    let mut at = (0..cells.len()).find(|&c| around(c).is_some_and(|[p, _]| p == (i + count - 1) % count))?;
    let mut chain = vec![at];
    for _ in 0..cells.len() {
        let [_, after] = around(at)?;
        if after == (i + 1) % count {
            return Some(chain);
        }
        at = (0..cells.len()).find(|&c| c != at && around(c).is_some_and(|[p, _]| p == after))?;
        chain.push(at);
    }
    None
}
