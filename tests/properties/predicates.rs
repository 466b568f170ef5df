//! Every exact predicate against rational arithmetic, on points that are hard for floating-point numbers.

use crate::random::Random;
use crate::rational::{self as truth, number, point};
use crate::support::cases;
use meshmend::geom::{
    DVec2, DVec3, Sign, are_collinear, is_on_segment, orient2d, orient3d, upward_crossing, volume_sign,
};
use std::convert::Infallible;

const CASES_SMALL: usize = 3_000;
const CASES_FULL: usize = 300_000;

/// Makes four points.
type Family = fn(&mut Random) -> [DVec3; 4];

const FAMILIES: [(&str, Family); 7] = [
    ("uniform", |r| points(r, Random::unit)),
    ("small grid", |r| points(r, |r| f64::from(r.between(-2, 2)))),
    ("float32", |r| points(r, |r| f64::from((r.unit() - 0.5) as f32))),
    ("nearly degenerate", |r| nearly_degenerate(r, 1.0)),
    ("nearly degenerate at any scale", |r| {
        let scale = 2f64.powi(r.between(-1070, 1015));
        nearly_degenerate(r, scale)
    }),
    ("any exponent", |r| points(r, |r| (r.unit() - 0.5) * 2f64.powi(r.between(-1074, 1023)))),
    ("mixed magnitudes", |r| {
        points(r, |r| {
            let step = r.pick(&[f64::from_bits(1), 1e-300, 1e-200, 1e-30, 1.0, 1e30, 1e150, 1e300]);
            f64::from(r.between(-2, 2)) * step
        })
    }),
];

fn points(r: &mut Random, coordinate: impl Fn(&mut Random) -> f64) -> [DVec3; 4] {
    std::array::from_fn(|_| DVec3::new(coordinate(r), coordinate(r), coordinate(r)))
}

/// The last point is near the plane, the line or a corner of the others, a few units in the last place off.
fn nearly_degenerate(r: &mut Random, scale: f64) -> [DVec3; 4] {
    let [a, b, c, _] = points(r, |r| r.unit() * scale);
    let (s, t) = match r.below(3) {
        0 => (r.unit(), r.unit()),
        1 => (r.unit(), 0.0),
        _ => (0.0, 0.0),
    };
    let mut d = a + (b - a) * s + (c - a) * t;
    for k in 0..3 {
        let nudge = r.between(-2, 2);
        d[k] = f64::from_bits((d[k].to_bits() as i64 + i64::from(nudge)).max(0) as u64);
    }
    let mut all = [a, b, c, d];
    all.rotate_left(r.below(4));
    all
}

fn for_each_case(mut check: impl FnMut([DVec3; 4], &str)) {
    for (family, (name, make)) in FAMILIES.into_iter().enumerate() {
        let mut random = Random::new(family as u64);
        for case in 0..cases(CASES_SMALL, CASES_FULL) {
            let points = make(&mut random);
            check(points, &format!("{name}, case {case}: {points:?}"));
        }
    }
}

#[test]
fn orient3d_is_the_sign_of_the_rational_determinant_under_every_permutation() {
    for_each_case(|[a, b, c, d], case| {
        let expected = truth::sign(&truth::orient3d(&point(a), &point(b), &point(c), &point(d)));
        assert_eq!(orient3d(a, b, c, d), expected, "{case}");
        for even in [[b, c, a, d], [c, a, b, d], [b, a, d, c], [d, c, b, a]] {
            assert_eq!(orient3d(even[0], even[1], even[2], even[3]), expected, "{case}");
        }
        for odd in [[b, a, c, d], [a, b, d, c], [d, b, c, a]] {
            assert_eq!(orient3d(odd[0], odd[1], odd[2], odd[3]), -expected, "{case}");
        }
    });
}

#[test]
fn orient2d_is_the_sign_of_the_rational_determinant_under_every_permutation() {
    for_each_case(|points, case| {
        let [a, b, c, _] = points.map(|p| DVec2::new(p.x, p.y));
        let [u, v] = [b, c].map(|p| [number(p.x) - number(a.x), number(p.y) - number(a.y)]);
        let expected = truth::sign(&(&u[0] * &v[1] - &u[1] * &v[0]));
        for [a, b, c] in [[a, b, c], [b, c, a], [c, a, b]] {
            assert_eq!(orient2d(a, b, c), expected, "{case}");
            assert_eq!(orient2d(b, a, c), -expected, "{case}");
        }
    });
}

#[test]
fn collinearity_and_segments_agree_with_rational_arithmetic() {
    let mut collinear = 0;
    for_each_case(|[a, b, c, d], case| {
        for p in [c, d, a.midpoint(b), a, a + (b - a) * 3.0] {
            if !p.is_finite() {
                continue;
            }
            let (u, v) = (truth::minus(&point(b), &point(a)), truth::minus(&point(p), &point(a)));
            let is_collinear = truth::is_zero(&truth::cross(&u, &v));
            assert_eq!(are_collinear(a, b, p), is_collinear, "{case}");
            let along = truth::dot(&u, &v);
            let is_between = truth::sign(&along) != Sign::Negative && along <= truth::dot(&u, &u);
            assert_eq!(is_on_segment(p, a, b), is_collinear && is_between && (a != b || p == a), "{case}");
            collinear += usize::from(is_collinear);
        }
    });
    assert!(collinear > 1000, "too few collinear cases to mean anything: {collinear}");
}

/// The four triangles of a tetrahedron, outward when `d` is on the negative side of `a b c`.
fn faces([a, b, c, d]: [DVec3; 4]) -> [[DVec3; 3]; 4] {
    [[a, b, c], [b, a, d], [c, b, d], [a, c, d]]
}

#[test]
fn the_sign_of_a_volume_is_that_of_the_rational_sum() {
    for_each_case(|points, case| {
        let [a, b, c, d] = points;
        // A second tetrahedron, mirrored and a hair larger, so that sums nearly cancel.
        let shrunk = [b, a, c, DVec3::new(d.x, d.y, d.z.next_up())];
        for tetrahedra in [&[points][..], &[shrunk], &[points, shrunk], &[points, [b, a, c, d]]] {
            let volume = tetrahedra
                .iter()
                .map(|t| {
                    let [a, b, c, d] = t.map(point);
                    -truth::orient3d(&a, &b, &c, &d)
                })
                .fold(number(0.0), |sum, v| sum + v);
            let surface: Vec<_> = tetrahedra.iter().flat_map(|&t| faces(t)).collect();
            let found = volume_sign(surface.iter().copied(), || Ok::<_, Infallible>(())).unwrap();
            assert_eq!(found, truth::sign(&volume), "{case}");
        }
    });
}

#[test]
fn crossings_sum_up_to_the_winding_number_of_a_tetrahedron() {
    let mut inside = 0;
    for case in 0..cases(20_000, 2_000_000) {
        let mut random = Random::new(case as u64);
        let [a, b, c, d] = points(&mut random, |r| f64::from(r.between(-3, 3)));
        let p = DVec3::from_array([0; 3].map(|_| f64::from(random.between(-2, 2))));
        // In the sense of the four faces: on which side of each the point is.
        let sides = faces([a, b, c, d])
            .map(|[a, b, c]| truth::sign(&truth::orient3d(&point(a), &point(b), &point(c), &point(p))));
        let volume = -orient3d(a, b, c, d);
        if sides.contains(&Sign::Zero) || volume.is_zero() {
            // On the plane of a face; the point may be on the surface.
            continue;
        }
        let is_inside = sides.iter().all(|&s| s == -volume);
        inside += usize::from(is_inside);
        let expected = match (is_inside, volume) {
            (true, Sign::Positive) => 1,
            (true, _) => -1,
            (false, _) => 0,
        };
        let winding: i32 = faces([a, b, c, d])
            .into_iter()
            .filter_map(|t| upward_crossing(p, t))
            .map(|s| if s == Sign::Positive { 1 } else { -1 })
            .sum();
        assert_eq!(winding, expected, "case {case}: {p} in {a} {b} {c} {d}");
    }
    assert!(inside > 100, "too few points inside to mean anything: {inside}");
}
