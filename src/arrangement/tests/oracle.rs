//! What must hold of an arrangement, decided naively in integers of the tests' own: all pairs of pieces, all sides of pieces.

use super::cases::Bodies;
use crate::arrangement::{Arrangement, MergedBoundary, SolidBoundary};
use num_bigint::BigInt;
use num_rational::Ratio;
use num_traits::{ToPrimitive, Zero};
use std::collections::BTreeSet;

type Rational = Ratio<BigInt>;

/// A point as `x / w`, with a positive `w`.
type Place = ([i128; 3], i128);

pub(super) fn whole(x: i64) -> Rational {
    Rational::from_integer(BigInt::from(x))
}

fn place(arrangement: &Arrangement, point: u32) -> Place {
    let [x, y, z] = arrangement.coordinates(point);
    let lcm = |a: &BigInt, b: &BigInt| num_integer::Integer::lcm(a, b);
    let w = lcm(&lcm(x.denom(), y.denom()), z.denom());
    let scaled = [x, y, z].map(|x| (x.numer() * (&w / x.denom())).to_i128().unwrap());
    (scaled, w.to_i128().unwrap())
}

fn det3(a: [i128; 3], b: [i128; 3], c: [i128; 3]) -> i128 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// `b - a`, times both denominators.
fn to(a: Place, b: Place) -> [i128; 3] {
    [0, 1, 2].map(|k| b.0[k] * a.1 - a.0[k] * b.1)
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

fn dot(a: [i128; 3], b: [i128; 3]) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Without its common divisor: the sign and direction stay.
fn short(a: [i128; 3]) -> [i128; 3] {
    let gcd = |a: i128, b: i128| num_integer::Integer::gcd(&a, &b);
    let divisor = gcd(gcd(a[0], a[1]), a[2]).max(1);
    a.map(|x| x / divisor)
}

fn direction(a: Place, b: Place) -> [i128; 3] {
    short(to(a, b))
}

fn normal([a, b, c]: [Place; 3]) -> [i128; 3] {
    short(cross(direction(a, b), direction(a, c)))
}

/// True when `p`, in the plane of the triangle with this `normal`, is in it or on its border.
fn holds(t: [Place; 3], normal: [i128; 3], p: Place) -> bool {
    (0..3).all(|k| dot(cross(direction(t[k], t[(k + 1) % 3]), direction(t[k], p)), normal) >= 0)
}

/// True when the segment from `p` to `q` passes through triangle `t` away from its own ends, or crosses one of its edges in
/// one plane.
fn passes([p, q]: [Place; 2], t: [Place; 3], normal: [i128; 3]) -> bool {
    let side = |x: Place| dot(normal, direction(t[0], x)).signum();
    let (from, to) = (side(p), side(q));
    let along = direction(p, q);
    if from * to < 0 {
        let turns = [0, 1, 2].map(|k| det3(along, direction(p, t[k]), direction(p, t[(k + 1) % 3])).signum());
        return !(turns.contains(&1) && turns.contains(&-1));
    }
    let cross_sides =
        |a: Place, b: Place, x: Place| dot(cross(direction(a, b), direction(a, x)), normal).signum();
    from == 0
        && to == 0
        && (0..3).any(|k| {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            cross_sides(p, q, a) * cross_sides(p, q, b) < 0 && cross_sides(a, b, p) * cross_sides(a, b, q) < 0
        })
}

/// Six times the volume of the part that is inside.
pub(super) fn volume_sixfold(arrangement: &Arrangement, is_inside: impl Fn(&[i32]) -> bool) -> Rational {
    let surface = arrangement.boundary(is_inside);
    let det = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(|p| arrangement.coordinates(p));
        let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
        &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1)
    };
    surface.pieces.iter().map(|piece| det(piece.corners)).fold(Rational::zero(), |sum, x| sum + x)
}

/// Twice the area vector of a triangle.
fn area([a, b, c]: [Place; 3]) -> [Rational; 3] {
    let (u, v) = (to(a, b), to(a, c));
    let scale = BigInt::from(a.1) * b.1 * a.1 * c.1;
    cross(u, v).map(|x| Rational::new(BigInt::from(x), scale.clone()))
}

/// The winding numbers beside a piece, on the side that a ray in `direction` starts on; `None` when the ray meets an edge.
fn winding(
    start: Place,
    along: [i128; 3],
    own: &[(u32, bool)],
    bodies: &Bodies,
    input: &[[Place; 3]],
) -> Option<[i32; 2]> {
    let mut windings = [0; 2];
    for (t, &[a, b, c]) in input.iter().enumerate() {
        let n = normal([a, b, c]);
        if own.iter().any(|&(source, _)| source as usize == t) || n == [0; 3] {
            continue;
        }
        let slope = dot(n, along);
        let height = dot(n, direction(start, a));
        if slope == 0 {
            if height == 0 {
                return None;
            }
            continue;
        }
        if (slope > 0) != (height > 0) {
            continue;
        }
        let turns = [[a, b], [b, c], [c, a]]
            .map(|[p, q]| det3(along, direction(start, p), direction(start, q)).signum());
        if turns.contains(&0) {
            return None;
        }
        if turns[0] == turns[1] && turns[1] == turns[2] {
            windings[usize::from(bodies.operands[t])] += slope.signum() as i32;
        }
    }
    Some(windings)
}

/// Broken laws, as sentences.
pub(super) fn breaches(arrangement: &Arrangement, bodies: &Bodies) -> Vec<String> {
    let mut broken = Vec::new();
    let pieces = arrangement.pieces();
    let places: Vec<Place> = (0..arrangement.point_count() as u32).map(|p| place(arrangement, p)).collect();
    let corners: Vec<[Place; 3]> = pieces.iter().map(|t| t.map(|p| places[p as usize])).collect();
    let normals: Vec<[i128; 3]> = corners.iter().map(|&t| normal(t)).collect();
    let input: Vec<[Place; 3]> = bodies.triangles.iter().map(|t| t.map(|v| places[v as usize])).collect();
    let used: BTreeSet<u32> = pieces.iter().flatten().copied().collect();
    let distinct: BTreeSet<Place> = used.iter().map(|&p| places[p as usize]).collect();
    if used.len() != distinct.len() {
        broken.push(format!("{} points at {} places", used.len(), distinct.len()));
    }
    let sorted = |mut t: [u32; 3]| {
        t.sort_unstable();
        t
    };
    if pieces.iter().map(|&t| sorted(t)).collect::<BTreeSet<_>>().len() != pieces.len() {
        broken.push("a piece is there twice".to_owned());
    }
    for (i, &s) in corners.iter().enumerate() {
        if normals[i] == [0; 3] {
            broken.push(format!("piece {i} has no area"));
        }
        for (j, &t) in corners.iter().enumerate().filter(|&(j, _)| j != i) {
            for k in 0..3 {
                let side = dot(normals[j], direction(t[0], s[k]));
                if side == 0 && !pieces[j].contains(&pieces[i][k]) && holds(t, normals[j], s[k]) {
                    broken.push(format!("corner {k} of piece {i} is on piece {j}"));
                }
                if passes([s[k], s[(k + 1) % 3]], t, normals[j]) {
                    broken.push(format!("edge {k} of piece {i} passes through piece {j}"));
                }
            }
        }
    }
    broken.extend(areas(arrangement, &corners, &input));
    broken.extend(sides(arrangement, bodies, &corners, &normals, &input));
    broken.extend(volumes(arrangement));
    broken
}

/// The pieces of each triangle must have its area together, and lie in it.
fn areas(arrangement: &Arrangement, corners: &[[Place; 3]], input: &[[Place; 3]]) -> Vec<String> {
    let mut left: Vec<[Rational; 3]> = input.iter().map(|&t| area(t)).collect();
    let mut broken = Vec::new();
    for (piece, &t) in corners.iter().enumerate() {
        let own = area(t);
        for &(source, is_turned) in arrangement.sources(piece) {
            let whole = input[source as usize];
            let n = normal(whole);
            for p in t {
                if dot(n, direction(whole[0], p)) != 0 || !holds(whole, n, p) {
                    broken.push(format!("piece {piece} leaves triangle {source}"));
                }
            }
            for k in 0..3 {
                let part = if is_turned { -own[k].clone() } else { own[k].clone() };
                left[source as usize][k] -= part;
            }
        }
    }
    for (t, left) in left.iter().enumerate().filter(|(_, left)| left.iter().any(|x| !x.is_zero())) {
        broken.push(format!("triangle {t} has {left:?} of its area without a piece"));
    }
    broken
}

/// The winding numbers on both sides of each piece against a ray in another direction.
fn sides(
    arrangement: &Arrangement,
    bodies: &Bodies,
    corners: &[[Place; 3]],
    normals: &[[i128; 3]],
    input: &[[Place; 3]],
) -> Vec<String> {
    let mut broken = Vec::new();
    for (piece, t) in corners.iter().enumerate() {
        let [a, b, c] = *t;
        // Unevenly inside the piece, so that no two rays meet one edge for the same reason.
        let w = a.1 * b.1 * c.1;
        let middle =
            [0, 1, 2].map(|k| 3 * a.0[k] * (w / a.1) + 4 * b.0[k] * (w / b.1) + 5 * c.0[k] * (w / c.1));
        let gcd = |a: i128, b: i128| num_integer::Integer::gcd(&a, &b);
        let divisor = middle.iter().fold(12 * w, |d, &x| gcd(d, x)).max(1);
        let start: Place = (middle.map(|x| x / divisor), 12 * w / divisor);
        let directions = [[1, 3, 7], [-5, 2, 3], [11, -7, 2], [3, 5, -13], [17, 1, 4]];
        let own = arrangement.sources(piece);
        let counted = directions.into_iter().find_map(|along| {
            let slope = dot(normals[piece], along);
            if slope == 0 {
                return None;
            }
            Some((slope > 0, winding(start, along, own, bodies, input)?))
        });
        let Some((is_front, counted)) = counted else { continue };
        let [front, back] = arrangement.windings(piece);
        let told = if is_front { front } else { back };
        if told != counted {
            broken.push(format!("beside piece {piece} winding numbers are {counted:?}, not {told:?}"));
        }
    }
    broken
}

/// What holds of the volumes of any two solids.
pub(super) fn volumes(arrangement: &Arrangement) -> Vec<String> {
    let volume = |inside: fn(&[i32]) -> bool| volume_sixfold(arrangement, inside);
    let (a, b) = (volume(|w| w[0] > 0), volume(|w| w[1] > 0));
    let (either, both) = (volume(|w| w[0] > 0 || w[1] > 0), volume(|w| w[0] > 0 && w[1] > 0));
    let only_a = volume(|w| w[0] > 0 && w[1] <= 0);
    let mut broken = Vec::new();
    if &either + &both != &a + &b {
        broken.push(format!("union {either} and intersection {both} of {a} and {b}"));
    }
    if &only_a + &both != a {
        broken.push(format!("difference {only_a} and intersection {both} of {a}"));
    }
    if [&a, &b, &either, &both, &only_a].iter().any(|x| **x < Rational::zero()) {
        broken.push("a volume is negative".to_owned());
    }
    broken
}

/// What must hold of a boundary after its pieces were merged.
pub(super) fn breaches_of_merged(
    arrangement: &Arrangement,
    boundary: &SolidBoundary,
    merged: &MergedBoundary,
) -> Vec<String> {
    let mut broken = Vec::new();
    let place = |p: u32| place(arrangement, p);
    let sixfold = |triangles: &mut dyn Iterator<Item = [u32; 3]>| {
        let det = |corners: [u32; 3]| {
            let [a, b, c] = corners.map(place);
            Rational::new(BigInt::from(det3(a.0, b.0, c.0)), BigInt::from(a.1) * b.1 * c.1)
        };
        triangles.map(det).fold(Rational::zero(), |sum, x| sum + x)
    };
    let before = sixfold(&mut boundary.pieces.iter().map(|piece| piece.corners));
    let after = sixfold(&mut merged.triangles.iter().copied());
    if before != after {
        broken.push(format!("six times the volume was {before} and is {after}"));
    }
    if merged.triangles.len() > boundary.pieces.len() {
        broken.push(format!("{} triangles of {} pieces", merged.triangles.len(), boundary.pieces.len()));
    }
    let mut balance = std::collections::BTreeMap::new();
    for t in &merged.triangles {
        for k in 0..3 {
            let (from, to) = (t[k], t[(k + 1) % 3]);
            *balance.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
        }
    }
    let open = balance.values().filter(|&&balance| balance != 0).count();
    if open > 0 {
        broken.push(format!("{open} edges do not balance"));
    }
    let corners: Vec<[Place; 3]> = merged.triangles.iter().map(|t| t.map(place)).collect();
    let normals: Vec<[i128; 3]> = corners.iter().map(|&t| normal(t)).collect();
    for (i, &s) in corners.iter().enumerate() {
        if normals[i] == [0; 3] {
            broken.push(format!("triangle {i} has no area"));
        }
        for (j, &t) in corners.iter().enumerate().filter(|&(j, _)| j != i) {
            for k in 0..3 {
                let is_shared = merged.triangles[j].contains(&merged.triangles[i][k]);
                let side = dot(normals[j], direction(t[0], s[k]));
                if side == 0 && !is_shared && holds(t, normals[j], s[k]) {
                    broken.push(format!("corner {k} of triangle {i} is on triangle {j}"));
                }
                if passes([s[k], s[(k + 1) % 3]], t, normals[j]) {
                    broken.push(format!("edge {k} of triangle {i} passes through triangle {j}"));
                }
            }
        }
    }
    broken
}
