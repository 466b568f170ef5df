//! Whether a polyhedron is valid, from its planes and loops alone, in integers of any size and without the engine's code:
//! its own points, its own tests of edges against faces. Boxes of rounded coordinates leave out pairs that are far apart.
//!
//! Signs that rounded numbers show beyond doubt are not computed again with integers: see [`sure_sign`].

use dashu_int::{
    IBig,
    ops::{Abs, BitTest},
};
use meshmend::mesh::polyhedron::FaceId;
use meshmend::modeller::Solid;
use std::collections::BTreeMap;

type Vector = [IBig; 3];

/// A point `x / w`, `w` positive.
#[derive(Clone, Debug)]
pub(crate) struct Corner {
    pub x: Vector,
    pub w: IBig,
    near: [f64; 3],
}

/// A solid read again: rows `(n, d)` of whole numbers and loops of corners.
pub(crate) struct Model {
    pub rows: Vec<(Vector, IBig)>,
    pub loops: Vec<Vec<Vec<usize>>>,
    pub corners: BTreeMap<usize, Corner>,
    /// The rows divided by the size of the largest number of each normal, rounded.
    near: Vec<([f64; 3], f64)>,
}

fn whole(x: &num_bigint::BigInt) -> IBig {
    IBig::from_le_bytes(&x.to_signed_bytes_le())
}

pub(crate) fn dot(a: &Vector, b: &Vector) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(crate) fn cross(a: &Vector, b: &Vector) -> Vector {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

/// `x / w`, `w` positive, within `ROUNDING` of its size.
fn near(x: &IBig, w: &IBig) -> f64 {
    if *x == IBig::ZERO {
        return 0.0;
    }
    let bits = |x: &IBig| BitTest::bit_len(x) as isize;
    // The quotient gets 79 to 81 bits.
    let shift = 80 - bits(x) + bits(w);
    let scaled: IBig = if shift >= 0 { (x << shift as usize) / w } else { x / (w << -shift as usize) };
    let value = scaled.to_f64().value() * 2f64.powi(-(shift as i32));
    assert!(value.is_normal(), "a number far beyond the coordinates of the zoo and of parts");
    value
}

/// How far a number of the oracle that is rounded once may be from the true one, as a share of it: 2^-52, and more.
const ROUNDING: f64 = 3e-16;

/// The sign of a number that is `value` within `error`; none in doubt.
fn sure_sign(value: f64, error: f64) -> Option<i8> {
    (value.abs() > error).then_some(if value > 0.0 { 1 } else { -1 })
}

fn sign(x: &IBig) -> i8 {
    i8::from(*x > IBig::ZERO) - i8::from(*x < IBig::ZERO)
}

impl Model {
    /// Reads planes and topology; `Err` when the planes around a vertex do not meet in one point.
    pub(crate) fn of(solid: &Solid) -> Result<Self, String> {
        let topology = solid.topology();
        let rows: Vec<(Vector, IBig)> = topology
            .faces()
            .map(|f| {
                let plane = solid.plane(f);
                let denominator = whole(plane.offset().denom());
                (plane.normal().each_ref().map(|n| whole(n) * &denominator), whole(plane.offset().numer()))
            })
            .collect();
        let of_loop = |h| topology.loop_of(h).map(|h| topology.origin(h).index()).collect::<Vec<_>>();
        let loops: Vec<Vec<Vec<usize>>> =
            topology.faces().map(|f: FaceId| topology.loop_starts(f).map(of_loop).collect()).collect();
        let mut around: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (f, face) in loops.iter().enumerate() {
            face.iter().flatten().for_each(|&v| around.entry(v).or_default().push(f));
        }
        let mut corners = BTreeMap::new();
        for (v, faces) in around {
            corners.insert(
                v,
                meet(&rows, &faces).ok_or(format!("the planes {faces:?} do not meet in one point"))?,
            );
        }
        Ok(Self::new(rows, loops, corners))
    }

    pub(crate) fn new(
        rows: Vec<(Vector, IBig)>,
        loops: Vec<Vec<Vec<usize>>>,
        corners: BTreeMap<usize, Corner>,
    ) -> Self {
        let rounded = |(normal, offset): &(Vector, IBig)| {
            let largest = normal.iter().map(|n| n.clone().abs()).max().unwrap();
            (normal.each_ref().map(|n| near(n, &largest)), near(offset, &largest))
        };
        let near = rows.iter().map(rounded).collect();
        Self { rows, loops, corners, near }
    }

    fn height(&self, f: usize, p: &Corner) -> IBig {
        dot(&self.rows[f].0, &p.x) - &self.rows[f].1 * &p.w
    }

    /// On which side of the plane of `f` a point is.
    fn side(&self, f: usize, p: &Corner) -> i8 {
        let (normal, offset) = &self.near[f];
        let terms: [f64; 3] = [0, 1, 2].map(|k| normal[k] * p.near[k]);
        let value = terms[0] + terms[1] + terms[2] - offset;
        let sizes = terms[0].abs() + terms[1].abs() + terms[2].abs() + offset.abs();
        // Two rounded factors, their product and three sums.
        sure_sign(value, sizes * (8.0 * ROUNDING)).unwrap_or_else(|| sign(&self.height(f, p)))
    }

    /// The first thing that is wrong, if any is.
    pub(crate) fn fault(&self) -> Option<String> {
        let mut edges: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for (f, face) in self.loops.iter().enumerate() {
            for l in face {
                for i in 0..l.len() {
                    let ends = (l[i], l[(i + 1) % l.len()]);
                    if edges.insert(ends, f).is_some() {
                        return Some(format!("two faces run along {ends:?}"));
                    }
                }
            }
        }
        for (&(a, b), &f) in &edges {
            let Some(&g) = edges.get(&(b, a)) else { return Some(format!("{a}-{b} has one face")) };
            if f == g || is_equal(&self.corners[&a], &self.corners[&b]) {
                return Some(format!("the edge {a}-{b} of {f} and {g} has no length"));
            }
        }
        let boxes: Vec<[[f64; 2]; 3]> =
            self.loops.iter().map(|face| bounds(face.iter().flatten().map(|v| &self.corners[v]))).collect();
        for (&(a, b), &f) in edges.iter().filter(|((a, b), _)| a < b) {
            let g = edges[&(b, a)];
            let own = bounds([&self.corners[&a], &self.corners[&b]].into_iter());
            for (h, other) in boxes.iter().enumerate() {
                if (0..3).all(|k| own[k][0] <= other[k][1] && other[k][0] <= own[k][1]) {
                    let does_meet =
                        if h == f || h == g { self.meets_sides(a, b, h) } else { self.meets(a, b, h) };
                    if does_meet {
                        return Some(format!("the edge {a}-{b} of {f} and {g} meets face {h}"));
                    }
                }
            }
        }
        (0..self.loops.len()).find_map(|f| self.area_fault(f))
    }

    /// The exterior loop is the one with the positive doubled area along the normal, and there is one.
    fn area_fault(&self, f: usize) -> Option<String> {
        (0..self.loops[f].len())
            .find(|&i| self.area_sign(f, i) != if i == 0 { 1 } else { -1 })
            .map(|i| format!("loop {i} of face {f} runs the wrong way round"))
    }

    /// The sign of the doubled area of a loop along the normal: the sum over a fan of triangles.
    fn area_sign(&self, f: usize, i: usize) -> i8 {
        let l = &self.loops[f][i];
        let normal = self.near[f].0;
        let at = |v: usize| self.corners[&v].near;
        let base = at(l[0]);
        let from_base = |p: [f64; 3]| [0, 1, 2].map(|k| p[k] - base[k]);
        let size = l.iter().flat_map(|&v| at(v)).fold(0.0f64, |size, x| size.max(x.abs()));
        let (mut total, mut sizes) = (0.0, 0.0);
        for pair in l.windows(2).skip(1) {
            let [u, v] = [from_base(at(pair[0])), from_base(at(pair[1]))];
            for (k, n) in normal.iter().enumerate() {
                let [a, b] = [(k + 1) % 3, (k + 2) % 3];
                total += n * (u[a] * v[b] - u[b] * v[a]);
                sizes += u[a].abs() + u[b].abs() + v[a].abs() + v[b].abs();
            }
        }
        // As in `turn`, for products with numbers of at most 1; and sums of as many terms as there are.
        let slack = 16.0 * ROUNDING * size * l.len() as f64;
        let error = slack * (sizes + slack);
        sure_sign(total, error).unwrap_or_else(|| self.exact_area_sign(f, i))
    }

    fn exact_area_sign(&self, f: usize, i: usize) -> i8 {
        let l = &self.loops[f][i];
        // One common denominator.
        let common = l.iter().fold(IBig::ONE, |c, v| c * &self.corners[v].w);
        let at = |v: usize| {
            let c = &self.corners[&v];
            let k = &common / &c.w;
            c.x.each_ref().map(|x| x * &k)
        };
        let base_at = at(l[0]);
        let mut total = IBig::ZERO;
        for pair in l.windows(2).skip(1) {
            let [p, q] = [at(pair[0]), at(pair[1])];
            let u: Vector = [0, 1, 2].map(|k| &p[k] - &base_at[k]);
            let v: Vector = [0, 1, 2].map(|k| &q[k] - &base_at[k]);
            total += dot(&cross(&u, &v), &self.rows[f].0);
        }
        sign(&total)
    }

    fn axis(&self, f: usize) -> usize {
        (0..3).find(|&k| self.rows[f].0[k] != IBig::ZERO).unwrap()
    }

    /// Whether an edge in the border of `f` meets other sides of it elsewhere than at its ends.
    fn meets_sides(&self, a: usize, b: usize, f: usize) -> bool {
        let ends = [a, b];
        self.sides(f)
            .any(|s| (s[0].min(s[1]), s[0].max(s[1])) != (a.min(b), a.max(b)) && self.do_cross(f, ends, s))
    }

    fn sides(&self, f: usize) -> impl Iterator<Item = [usize; 2]> {
        self.loops[f].iter().flat_map(|l| (0..l.len()).map(|i| [l[i], l[(i + 1) % l.len()]]))
    }

    fn meets(&self, a: usize, b: usize, f: usize) -> bool {
        let (p, q) = (&self.corners[&a], &self.corners[&b]);
        let (i, j) = (self.side(f, p), self.side(f, q));
        let is_corner = |v: usize| self.loops[f].iter().flatten().any(|&w| w == v);
        if i == 0 && j == 0 {
            if self.sides(f).any(|s| self.do_cross(f, [a, b], s)) {
                return true;
            }
            let middle = mix(p, q, &p.w, &q.w);
            return self.holds(f, &middle);
        }
        if i == 0 {
            return !is_corner(a) && self.holds(f, p);
        }
        if j == 0 {
            return !is_corner(b) && self.holds(f, q);
        }
        if i == j {
            return false;
        }
        let x = mix(p, q, &self.height(f, p).abs(), &self.height(f, q).abs());
        self.holds(f, &x)
    }

    fn flat(&self, f: usize, p: &Corner) -> [IBig; 3] {
        let k = self.axis(f);
        [p.x[(k + 1) % 3].clone(), p.x[(k + 2) % 3].clone(), p.w.clone()]
    }

    fn turn(&self, f: usize, a: &Corner, b: &Corner, c: &Corner) -> i8 {
        let k = self.axis(f);
        let [p, q, r] = [a, b, c].map(|c| [c.near[(k + 1) % 3], c.near[(k + 2) % 3]]);
        let [x1, y1, x2, y2] = [q[0] - p[0], q[1] - p[1], r[0] - p[0], r[1] - p[1]];
        let size = [p, q, r].iter().flatten().fold(0.0f64, |size, x| size.max(x.abs()));
        // Each difference is within 3 `ROUNDING` of the largest coordinate, so each product within that times its factors
        // and the square of it; twice that is room for the rounding of products.
        let slack = 6.0 * ROUNDING * size;
        let error = slack * (x1.abs() + y1.abs() + x2.abs() + y2.abs() + slack);
        sure_sign(x1 * y2 - y1 * x2, error).unwrap_or_else(|| self.exact_turn(f, a, b, c))
    }

    fn exact_turn(&self, f: usize, a: &Corner, b: &Corner, c: &Corner) -> i8 {
        let [a, b, c] = [a, b, c].map(|p| self.flat(f, p));
        sign(&dot(&a, &cross(&b, &c)))
    }

    /// Whether two segments in the plane of `f` meet in more than a common end.
    fn do_cross(&self, f: usize, g: [usize; 2], h: [usize; 2]) -> bool {
        let c = |v: usize| &self.corners[&v];
        let on = |v: usize, s: [usize; 2]| {
            !s.contains(&v) && self.turn(f, c(s[0]), c(s[1]), c(v)) == 0 && between(c(v), c(s[0]), c(s[1]))
        };
        if g.iter().any(|&v| on(v, h)) || h.iter().any(|&v| on(v, g)) {
            return true;
        }
        if g.iter().any(|v| h.contains(v)) {
            return false;
        }
        let t = |s: [usize; 2], v: usize| self.turn(f, c(s[0]), c(s[1]), c(v));
        t(g, h[0]) * t(g, h[1]) < 0 && t(h, g[0]) * t(h, g[1]) < 0
    }

    /// Whether a point of the plane of `f` is in `f`, its border included: by winding.
    fn holds(&self, f: usize, p: &Corner) -> bool {
        let mut winding = 0;
        for s in self.sides(f) {
            let (a, b) = (&self.corners[&s[0]], &self.corners[&s[1]]);
            let turn = self.turn(f, a, b, p);
            if turn == 0 && between(p, a, b) {
                return true;
            }
            let k = (self.axis(f) + 2) % 3;
            let is_below = |q: &Corner| is_at_most(q, p, k);
            match (is_below(a), is_below(b)) {
                (true, false) if turn > 0 => winding += 1,
                (false, true) if turn < 0 => winding -= 1,
                _ => {}
            }
        }
        winding != 0
    }
}

fn corner(x: Vector, w: IBig) -> Corner {
    let near = x.each_ref().map(|x| near(x, &w));
    Corner { x, w, near }
}

/// `(p j + q i) / (p.w j + q.w i)` with the numerators as they are.
fn mix(p: &Corner, q: &Corner, i: &IBig, j: &IBig) -> Corner {
    let x: Vector = [0, 1, 2].map(|k| &p.x[k] * j + &q.x[k] * i);
    corner(x, &p.w * j + &q.w * i)
}

/// Whether coordinate `k` of one is at most that of the other.
fn is_at_most(p: &Corner, q: &Corner, k: usize) -> bool {
    let (a, b) = (p.near[k], q.near[k]);
    match sure_sign(b - a, (a.abs() + b.abs()) * (2.0 * ROUNDING)) {
        Some(sign) => sign > 0,
        None => &p.x[k] * &q.w <= &q.x[k] * &p.w,
    }
}

/// Whether `p`, which is on the line of `a` and `b`, is not beyond either.
fn between(p: &Corner, a: &Corner, b: &Corner) -> bool {
    (0..3).all(|k| {
        let less = |s: &Corner, t: &Corner| is_at_most(s, t, k);
        (less(a, p) && less(p, b)) || (less(b, p) && less(p, a))
    })
}

fn is_equal(a: &Corner, b: &Corner) -> bool {
    (0..3).all(|k| is_at_most(a, b, k) && is_at_most(b, a, k))
}

fn bounds<'c>(corners: impl Iterator<Item = &'c Corner>) -> [[f64; 2]; 3] {
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for c in corners {
        for (bound, near) in bounds.iter_mut().zip(c.near) {
            let margin = near.abs() * 1e-9 + 1e-12;
            *bound = [bound[0].min(near - margin), bound[1].max(near + margin)];
        }
    }
    bounds
}

/// The one point of all planes, by Cramer's rule.
pub(crate) fn meet(rows: &[(Vector, IBig)], faces: &[usize]) -> Option<Corner> {
    for i in 0..faces.len() {
        for j in 0..i {
            for k in 0..j {
                let [(a, d), (b, e), (c, f)] = [i, j, k].map(|m| &rows[faces[m]]);
                let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
                let w = dot(a, &bc);
                if w == IBig::ZERO {
                    continue;
                }
                let x: Vector = [0, 1, 2].map(|m| d * &bc[m] + e * &ca[m] + f * &ab[m]);
                let p = if w < IBig::ZERO { corner(x.map(|x| -x), -w) } else { corner(x, w) };
                return faces.iter().all(|&g| dot(&rows[g].0, &p.x) == &rows[g].1 * &p.w).then_some(p);
            }
        }
    }
    None
}
