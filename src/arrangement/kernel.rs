//! The numbers of one cluster: its triangles in integers from a local origin, and the predicates on its points.
//!
//! The f64 coordinates of the input are taken as they are: in units of the last bit that any of them uses they are integers.
//! With coordinates of `b` bits (differences to the origin), a normal has `2 b + 3` bits and a plane's offset `3 b + 5`; a
//! point on an edge and a plane has coordinates of `4 b + 8` and a denominator of `3 b + 6` bits, one on three planes `7 b + 15` and
//! `6 b + 12`. The exact tier is integers of any size, so no width can be too small; the test of the widths shows these.

use super::ball::{self, Ball};
use super::exact::{self, ExactPlane, Homogeneous, IntegerVector, sign_of};
use super::point::{ArrangementPoint, Definition};
use crate::geom::{AxisProjection, BitSpan, DVec3, Sign, ThreePointPlane, power_of_two};
use num_bigint::BigInt;
use std::cmp::Ordering;
use std::sync::OnceLock;

/// Units of work of a step that decides with exact points.
pub(super) const EXACT: u64 = 64;

/// The two coordinates of a plane that are looked at, mirrored so that the plane's own triangle turns counter-clockwise, and that
/// triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PlaneView {
    pub(super) u: usize,
    pub(super) v: usize,
    pub(super) plane: u32,
}

/// The triangles of a cluster and its numbers. Vertices and triangles are numbered within the cluster.
#[derive(Debug)]
pub(super) struct ClusterKernel {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    span: BitSpan,
    origin: IntegerVector,
    /// A power of two in the integers of the kernel, well beyond every coordinate: its exponent.
    far: u32,
    /// Beyond this error the near coordinates of a point are rounded from the exact ones.
    error_max: f64,
    near: Vec<[Ball; 3]>,
    integers: Vec<OnceLock<Box<IntegerVector>>>,
    planes: Vec<OnceLock<Box<ExactPlane>>>,
}

impl ClusterKernel {
    /// The numbers for these triangles, whose positions must be finite.
    pub(super) fn new(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Self {
        let span = positions.iter().flat_map(DVec3::to_array).fold(BitSpan::ZERO, BitSpan::with);
        let start = positions.first().copied().unwrap_or_default();
        let origin = start.to_array().map(|x| span.to_big(x));
        let relative =
            |p: &DVec3| ball::minus(p.to_array().map(Ball::exactly), start.to_array().map(Ball::exactly));
        let near: Vec<[Ball; 3]> = positions.iter().map(relative).collect();
        let reach = near.iter().flatten().fold(0.0f64, |reach, x| reach.max(x.mid.abs()));
        let (vertices, faces) = (positions.len(), triangles.len());
        Self {
            positions,
            triangles,
            span,
            origin,
            far: span.bits() as u32 + 4,
            error_max: reach / (1u64 << 36) as f64,
            near,
            integers: std::iter::repeat_with(OnceLock::new).take(vertices).collect(),
            planes: std::iter::repeat_with(OnceLock::new).take(faces).collect(),
        }
    }

    /// Bits of the largest coordinate, from the origin of the file.
    pub(super) fn bits(&self) -> u32 {
        self.span.bits() as u32
    }

    fn integers(&self, vertex: u32) -> &IntegerVector {
        self.integers[vertex as usize].get_or_init(|| {
            let p = self.positions[vertex as usize].to_array();
            Box::new(std::array::from_fn(|k| self.span.to_big(p[k]) - &self.origin[k]))
        })
    }

    fn plane(&self, triangle: u32) -> &ExactPlane {
        self.planes[triangle as usize].get_or_init(|| {
            let [a, b, c] = self.triangles[triangle as usize].map(|v| self.integers(v));
            let n = exact::cross(&exact::minus(b, a), &exact::minus(c, a));
            let d = exact::dot(&n, a);
            Box::new(ExactPlane { n, d })
        })
    }

    /// The corners of a triangle.
    pub(super) fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|v| self.positions[v as usize])
    }

    /// A view of the plane of a triangle in which it turns counter-clockwise; `None` when it is degenerate.
    pub(super) fn view(&self, triangle: u32) -> Option<PlaneView> {
        let corners = self.corners(triangle);
        // The axis along which it is seen largest; rounding may choose another one, never a wrong one.
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).abs();
        let mut axes = [0, 1, 2];
        axes.sort_by(|&i, &j| normal[j].total_cmp(&normal[i]));
        axes.into_iter().find_map(|k| {
            let [a, b, c] = corners;
            let (u, v) = ((k + 1) % 3, (k + 2) % 3);
            match AxisProjection::ALL[k].turn(a, b, c) {
                Sign::Positive => Some(PlaneView { u, v, plane: triangle }),
                Sign::Negative => Some(PlaneView { u: v, v: u, plane: triangle }),
                Sign::Zero => None,
            }
        })
    }

    /// How the corners of a triangle turn in a view.
    pub(super) fn turn(&self, view: PlaneView, triangle: u32) -> Sign {
        let [a, b, c] = self.corners(triangle);
        let k = 3 - view.u - view.v;
        let turn = AxisProjection::ALL[k].turn(a, b, c);
        if (view.u + 1) % 3 == view.v { turn } else { -turn }
    }

    /// The point that `definition` names.
    pub(super) fn point(&self, definition: Definition) -> ArrangementPoint {
        let mut point =
            ArrangementPoint { definition, near: self.nearby(definition), exact: OnceLock::new() };
        let is_poor = |x: &Ball| x.rad.is_nan() || x.rad > self.error_max;
        if !matches!(definition, Definition::Vertex(_) | Definition::Far(_)) && point.near.iter().any(is_poor)
        {
            let exact = self.exact(&point);
            let rounded = |k: usize| {
                let mid = exact::quotient(&exact.x[k], &exact.w, self.span.low());
                Ball { mid, rad: mid.abs() * (4.0 * f64::EPSILON) + f64::MIN_POSITIVE }
            };
            point.near = std::array::from_fn(rounded);
        }
        point
    }

    fn nearby(&self, definition: Definition) -> [Ball; 3] {
        let vertex = |v: u32| self.near[v as usize];
        match definition {
            Definition::Vertex(v) => vertex(v),
            Definition::EdgePlane { edge: [a, b], plane } => {
                let [a, b] = [a, b].map(vertex);
                let [o, p, q] = self.triangles[plane as usize].map(vertex);
                let n = ball::cross(ball::minus(p, o), ball::minus(q, o));
                let [da, db] = [a, b].map(|x| ball::dot(n, ball::minus(x, o)));
                along(a, b, da.over(da - db))
            }
            Definition::EdgeEdge { edges: [[a, b], [c, d]], axes } => {
                let [a, b, c, d] = [a, b, c, d].map(vertex);
                let [u, v] = axes.map(usize::from);
                let cross = |x: [Ball; 3], y: [Ball; 3]| x[u] * y[v] - x[v] * y[u];
                let (ab, cd, ac) = (ball::minus(b, a), ball::minus(d, c), ball::minus(c, a));
                along(a, b, cross(ac, cd).over(cross(ab, cd)))
            }
            Definition::Planes(planes) => {
                let plane = |t: u32| {
                    let [o, p, q] = self.triangles[t as usize].map(vertex);
                    let n = ball::cross(ball::minus(p, o), ball::minus(q, o));
                    (n, ball::dot(n, o))
                };
                let [(n0, d0), (n1, d1), (n2, d2)] = planes.map(plane);
                let [c12, c20, c01] = [ball::cross(n1, n2), ball::cross(n2, n0), ball::cross(n0, n1)];
                let w = ball::dot(n0, c12);
                std::array::from_fn(|k| (d0 * c12[k] + d1 * c20[k] + d2 * c01[k]).over(w))
            }
            Definition::Far(corner) => {
                let exponent = self.span.low() + self.far as i32;
                if !(-1000..1000).contains(&exponent) {
                    return [Ball::UNKNOWN; 3];
                }
                let size = power_of_two(exponent);
                FAR_CORNERS[usize::from(corner) % 3].map(|x| Ball::exactly(f64::from(x) * size))
            }
        }
    }

    /// The place of a point in integers.
    pub(super) fn exact<'p>(&self, point: &'p ArrangementPoint) -> &'p Homogeneous {
        point.exact.get_or_init(|| Box::new(self.evaluated(point.definition)))
    }

    fn evaluated(&self, definition: Definition) -> Homogeneous {
        match definition {
            Definition::Vertex(v) => Homogeneous { x: self.integers(v).clone(), w: BigInt::from(1) },
            Definition::EdgePlane { edge: [a, b], plane } => {
                let [a, b] = [a, b].map(|v| self.integers(v));
                let plane = self.plane(plane);
                let [da, db] = [a, b].map(|x| exact::dot(&plane.n, x) - &plane.d);
                Homogeneous::new(std::array::from_fn(|k| &a[k] * &db - &b[k] * &da), db - da)
            }
            Definition::EdgeEdge { edges: [[a, b], [c, d]], axes } => {
                let [a, b, c, d] = [a, b, c, d].map(|v| self.integers(v));
                let [u, v] = axes.map(usize::from);
                let cross = |x: &IntegerVector, y: &IntegerVector| &x[u] * &y[v] - &x[v] * &y[u];
                let (ab, cd) = (exact::minus(b, a), exact::minus(d, c));
                let (share, w) = (cross(&exact::minus(c, a), &cd), cross(&ab, &cd));
                Homogeneous::new(std::array::from_fn(|k| &a[k] * &w + &ab[k] * &share), w)
            }
            Definition::Planes(planes) => {
                let [p, q, r] = planes.map(|t| self.plane(t));
                let (qr, rp, pq) =
                    (exact::cross(&q.n, &r.n), exact::cross(&r.n, &p.n), exact::cross(&p.n, &q.n));
                let x = |k: usize| &p.d * &qr[k] + &q.d * &rp[k] + &r.d * &pq[k];
                Homogeneous::new(std::array::from_fn(x), exact::dot(&p.n, &qr))
            }
            Definition::Far(corner) => {
                let size = BigInt::from(1) << self.far;
                let x = FAR_CORNERS[usize::from(corner) % 3].map(|x| BigInt::from(x) * &size);
                Homogeneous { x, w: BigInt::from(1) }
            }
        }
    }

    /// How three points of a plane turn in its view; [`Definition::Far`] ones are corners of the view. `None`: balls do not tell.
    pub(super) fn orient_near(
        view: PlaneView,
        a: &ArrangementPoint,
        b: &ArrangementPoint,
        c: &ArrangementPoint,
    ) -> Option<Sign> {
        let [a, b, c] = [a, b, c].map(|p| seen(p, view));
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).sign()
    }

    /// True when three points of a plane lie on one line by their names.
    pub(super) fn are_collinear_by_name(&self, view: PlaneView, points: [&ArrangementPoint; 3]) -> bool {
        let crosses = |other: u32| !self.are_coplanar(other, view.plane);
        Definition::are_collinear(points.map(|p| &p.definition), crosses)
    }

    /// As [`orient_near`](Self::orient_near), by integers.
    pub(super) fn orient_exact(
        &self,
        view: PlaneView,
        a: &ArrangementPoint,
        b: &ArrangementPoint,
        c: &ArrangementPoint,
    ) -> Sign {
        let [a, b, c] = [a, b, c].map(|p| (self.exact(p), axes_seen(p, view)));
        let (au, av, aw) = (&a.0.x[a.1[0]], &a.0.x[a.1[1]], &a.0.w);
        let (bu, bv, bw) = (&b.0.x[b.1[0]], &b.0.x[b.1[1]], &b.0.w);
        let (cu, cv, cw) = (&c.0.x[c.1[0]], &c.0.x[c.1[1]], &c.0.w);
        let det = (bu * aw - au * bw) * (cv * aw - av * cw) - (bv * aw - av * bw) * (cu * aw - au * cw);
        sign_of(&det)
    }

    /// True when two triangles lie in one plane.
    fn are_coplanar(&self, s: u32, t: u32) -> bool {
        let plane = ThreePointPlane::through(self.corners(t));
        s == t || self.corners(s).into_iter().all(|p| plane.side(p).is_zero())
    }

    /// How coordinate `axis` of two points compares.
    pub(super) fn compare(&self, axis: usize, a: &ArrangementPoint, b: &ArrangementPoint) -> Ordering {
        match (a.near[axis] - b.near[axis]).sign() {
            Some(Sign::Positive) => return Ordering::Greater,
            Some(_) => return Ordering::Less,
            None => {}
        }
        if a.definition == b.definition {
            return Ordering::Equal;
        }
        let (a, b) = (self.exact(a), self.exact(b));
        (&a.x[axis] * &b.w).cmp(&(&b.x[axis] * &a.w))
    }

    /// True when two points are at one place.
    pub(super) fn is_same(&self, a: &ArrangementPoint, b: &ArrangementPoint) -> bool {
        (0..3).all(|k| a.near[k].may_equal(b.near[k]))
            && (0..3).all(|k| self.compare(k, a, b) == Ordering::Equal)
    }

    /// True when three points lie on one line.
    pub(super) fn are_collinear(&self, [a, b, c]: [&ArrangementPoint; 3]) -> bool {
        let (u, v) = (ball::minus(b.near, a.near), ball::minus(c.near, a.near));
        if ball::cross(u, v).iter().any(|x| x.sign().is_some()) {
            return false;
        }
        if Definition::are_on_one_edge([&a.definition, &b.definition, &c.definition]) {
            return true;
        }
        let [a, b, c] = [a, b, c].map(|p| self.exact(p));
        let to =
            |p: &Homogeneous| -> IntegerVector { std::array::from_fn(|k| &p.x[k] * &a.w - &a.x[k] * &p.w) };
        exact::cross(&to(b), &to(c)).iter().all(|x| sign_of(x).is_zero())
    }

    /// The coordinates of a point, rounded.
    pub(super) fn rounded(&self, point: &ArrangementPoint) -> DVec3 {
        match point.definition {
            Definition::Vertex(v) => self.positions[v as usize],
            _ => {
                // Not kept: most points need it once.
                let evaluated;
                let exact = match point.exact.get() {
                    Some(exact) => exact,
                    None => {
                        evaluated = self.evaluated(point.definition);
                        &evaluated
                    }
                };
                let absolute = |k: usize| {
                    exact::quotient(&(&exact.x[k] + &self.origin[k] * &exact.w), &exact.w, self.span.low())
                };
                DVec3::from_array(std::array::from_fn(absolute))
            }
        }
    }

    /// The place of a point as `x / w` times two to a power, from the origin of the file.
    pub(super) fn absolute(&self, point: &ArrangementPoint) -> (Homogeneous, i32) {
        let exact = self.exact(point);
        let x = std::array::from_fn(|k| &exact.x[k] + &self.origin[k] * &exact.w);
        (Homogeneous { x, w: exact.w.clone() }, self.span.low())
    }
}

/// `a + (b - a) t`.
fn along(a: [Ball; 3], b: [Ball; 3], t: Ball) -> [Ball; 3] {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * t)
}

/// The triangle around everything in a view, in units of a size that is beyond twice every coordinate.
const FAR_CORNERS: [[i32; 3]; 3] = [[-1, -1, 0], [3, -1, 0], [-1, 3, 0]];

/// Which coordinates of a point are seen.
#[inline]
fn axes_seen(point: &ArrangementPoint, view: PlaneView) -> [usize; 2] {
    if matches!(point.definition, Definition::Far(_)) { [0, 1] } else { [view.u, view.v] }
}

#[inline]
fn seen(point: &ArrangementPoint, view: PlaneView) -> [Ball; 2] {
    axes_seen(point, view).map(|k| point.near[k])
}
