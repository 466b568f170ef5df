//! The surface through the points around a hole: shapes whose truth is known, invariance, thin walls, meshes.

use meshmend::budget::{Budget, StopFlag, Stopped};
use meshmend::geom::{Aabb, DVec3};
use meshmend::implicit::{
    Band, BandSurroundings, ConstraintValues, Field, Kernel, Patch, RbfOptions, SolveMethod, Unfit, fit,
    march, mesh_surface,
};
use meshmend::par;
use meshmend::spatial::NearestSearch;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

const KERNELS: [Kernel; 3] = [Kernel::ThinPlate, Kernel::Cubic, Kernel::Linear];
const ALONE: BandSurroundings<'static, 'static> = BandSurroundings { surface: None, mesh_box: Aabb::EMPTY };

fn fitted(band: &Band, options: &RbfOptions) -> Field {
    fit(band, &ALONE, options, &Budget::unlimited()).unwrap().unwrap()
}

/// Rings of points around the origin of the plane, lifted by `lift`: the rim with radius `radius`, then `rings` rings
/// further out.
fn rings(
    radius: f64,
    count: usize,
    rings: usize,
    outward: f64,
    lift: impl Fn(f64, f64) -> (DVec3, DVec3),
) -> Band {
    let mut band = Band::default();
    for ring in 0..=rings {
        let r = radius + outward * TAU * radius / count as f64 * ring as f64;
        for i in 0..count {
            let turn = TAU * (i as f64 + 0.5 * (ring % 2) as f64) / count as f64;
            let (point, normal) = lift(r * libm::cos(turn), r * libm::sin(turn));
            band.points.push(point);
            band.normals.push(normal);
        }
    }
    band
}

/// The unit sphere above the plane, by arc length from the pole.
fn on_sphere(x: f64, y: f64) -> (DVec3, DVec3) {
    let arc = (x * x + y * y).sqrt();
    let share = if arc == 0.0 { 1.0 } else { libm::sin(arc) / arc };
    let p = DVec3::new(x * share, y * share, libm::cos(arc));
    (p, p)
}

fn on_saddle(x: f64, y: f64) -> (DVec3, DVec3) {
    (DVec3::new(x, y, x * x - y * y), DVec3::new(-2.0 * x, 2.0 * y, 1.0).normalize())
}

/// A cylinder of radius 1 along y.
fn on_cylinder(x: f64, y: f64) -> (DVec3, DVec3) {
    let normal = DVec3::new(libm::sin(x), 0.0, libm::cos(x));
    (normal + DVec3::new(0.0, y, 0.0), normal)
}

/// Points inside of the hole.
fn inside(radius: f64) -> impl Iterator<Item = (f64, f64)> {
    (0..60).map(move |i| {
        let (r, turn) = (radius * f64::from(i) / 60.0, 2.4 * f64::from(i));
        (r * libm::cos(turn), r * libm::sin(turn))
    })
}

/// The largest distance from points of the truth to the zero set.
fn error(field: &Field, radius: f64, lift: impl Fn(f64, f64) -> (DVec3, DVec3)) -> f64 {
    inside(radius).fold(0.0, |worst: f64, (x, y)| {
        let truth = lift(x, y).0;
        let found = field.project(truth, radius).expect("the zero set is near");
        worst.max(found.distance(truth))
    })
}

fn every_way() -> impl Iterator<Item = RbfOptions> {
    KERNELS.into_iter().flat_map(|kernel| {
        [ConstraintValues::Unit, ConstraintValues::Distance].map(|values| RbfOptions {
            kernel,
            values,
            ..RbfOptions::default()
        })
    })
}

#[test]
fn a_plane_is_reproduced() {
    let tilt =
        |x: f64, y: f64| (DVec3::new(x, y, 0.3 * x - 0.7 * y + 11.0), DVec3::new(-0.3, 0.7, 1.0).normalize());
    for options in every_way() {
        for share in [1.0, 0.7, 0.5, 0.3] {
            for dense_centres_max in [3000, 50] {
                let band = rings(3.0, 40, 2, 1.0, tilt);
                let field = fitted(&band, &RbfOptions { share, dense_centres_max, ..options });
                let worst = error(&field, 3.0, tilt);
                assert!(worst < 1e-9 * 3.0, "{options:?} {share} {dense_centres_max}: {worst:e}");
            }
        }
    }
}

#[test]
fn the_error_of_a_sphere_cap_over_that_of_a_flat_fill_falls_with_the_hole() {
    for options in every_way() {
        let mut last = f64::INFINITY;
        // Holes of these radii in a mesh with edges of 0.05.
        for (radius, count, limit) in [(0.8, 96, 1.5e-2), (0.4, 48, 3e-3), (0.2, 24, 3e-4), (0.1, 12, 4e-5)] {
            let field = fitted(&rings(radius, count, 2, 1.0, on_sphere), &options);
            let flat = 1.0 - libm::cos(radius);
            let found = error(&field, radius, on_sphere);
            println!("{:?} {:?} {radius}: {found:.1e}, flat {flat:.1e}", options.kernel, options.values);
            assert!(found < limit, "{options:?} {radius}: {found:e}");
            assert!(found / flat < last, "{options:?} {radius}: {found:e} / {flat:e}");
            assert!(field.facts().residual <= 1e-9);
            last = found / flat;
        }
    }
}

#[test]
fn saddles_and_cylinders_are_close_to_the_truth() {
    for options in every_way() {
        let saddle = error(&fitted(&rings(0.4, 40, 2, 1.0, on_saddle), &options), 0.4, on_saddle);
        let cylinder = error(&fitted(&rings(0.4, 40, 2, 1.0, on_cylinder), &options), 0.4, on_cylinder);
        // A flat fill misses by 0.16 and 0.08.
        assert!(saddle < 4e-3 && cylinder < 4e-3, "{options:?} {saddle:e} {cylinder:e}");
    }
}

#[test]
fn round_rims_have_rank_nine_and_a_ring_restores_ten() {
    let plane = |x: f64, y: f64| (DVec3::new(x, y, 0.0), DVec3::Z);
    for (lift, limit) in [(plane as fn(f64, f64) -> (DVec3, DVec3), 1e-9), (on_sphere, 0.236)] {
        let alone = fitted(&rings(0.7, 32, 0, 1.0, lift), &RbfOptions::default());
        assert_eq!((alone.facts().rank, alone.facts().degree), (9, 1));
        let ringed = fitted(&rings(0.7, 32, 1, 1.0, lift), &RbfOptions::default());
        assert_eq!((ringed.facts().rank, ringed.facts().degree), (10, 2));
        // Alone, a round rim is filled flat, which misses the sphere by 0.2352.
        let (without, with) = (error(&alone, 0.7, lift), error(&ringed, 0.7, lift));
        assert!(without < limit && (with < 0.1 * without || with < 1e-9), "{without:e} {with:e}");
    }
}

/// A turn by an angle that is no multiple of anything.
fn turned(p: DVec3) -> DVec3 {
    let (s, c) = (0.6, 0.8);
    let q = DVec3::new(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
    DVec3::new(q.x, c * q.y - s * q.z, s * q.y + c * q.z)
}

#[test]
fn moving_turning_and_scaling_the_band_does_so_to_the_field() {
    for options in every_way() {
        for dense_centres_max in [3000, 100] {
            // By hand, because a box along the axes has another diagonal when the band is turned.
            let options = RbfOptions { dense_centres_max, lambda: Some(0.01), ..options };
            let band = rings(0.6, 30, 2, 1.0, on_saddle);
            // Of points that are equally far, rounding decides which one a part takes.
            let share = if dense_centres_max == 3000 { 1e-6 } else { 1e-3 };
            let field = fitted(&band, &options);
            for (scale, shift) in [(1.0, 50.0), (1000.0, -3.0), (1e-6, 0.0), (1e6, 1e7)] {
                let map = |p: DVec3| if dense_centres_max == 3000 { turned(p) } else { p } * scale + DVec3::splat(shift);
                let mapped = Band {
                    points: band.points.iter().map(|&p| map(p)).collect(),
                    normals: band
                        .normals
                        .iter()
                        .map(|&n| (map(n) - map(DVec3::ZERO)) / scale * 3.0)
                        .collect(),
                };
                let other = fitted(&mapped, &RbfOptions { lambda: Some(0.01 * scale), ..options });
                for (x, y) in inside(0.6) {
                    let p = on_saddle(x, y).0 + DVec3::Z * 0.02;
                    let unit = if options.values == ConstraintValues::Unit { 1.0 } else { scale };
                    let (a, b) = (field.value(p) * unit, other.value(map(p)));
                    let tolerance = share * unit * (field.value(p).abs() + 0.01);
                    assert!((a - b).abs() < tolerance, "{options:?} {scale} {shift}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn an_annulus_between_two_rims_is_one_field() {
    let mut band = rings(0.9, 60, 1, 1.0, on_sphere);
    let inner = rings(0.3, 20, 1, -1.0, on_sphere);
    band.points.extend(&inner.points);
    band.normals.extend(&inner.normals);
    let field = fitted(&band, &RbfOptions::default());
    for i in 0..40 {
        let (r, turn) = (0.3 + 0.6 * f64::from(i) / 40.0, 2.4 * f64::from(i));
        let truth = on_sphere(r * libm::cos(turn), r * libm::sin(turn)).0;
        assert!(field.project(truth, 0.2).unwrap().distance(truth) < 5e-3);
    }
    // The outer rim runs counter-clockwise, the inner one clockwise: the hole is on their left.
    let outer: Vec<DVec3> = band.points[..60].to_vec();
    let inner: Vec<DVec3> = inner.points[..20].iter().rev().copied().collect();
    for patch in [
        march(&field, &[outer.clone(), inner.clone()], 0.09, &Budget::unlimited()).unwrap().unwrap(),
        mesh_surface(&field, &[outer.clone(), inner.clone()], 0.09, &Budget::unlimited()).unwrap().unwrap(),
    ] {
        check_patch(&patch, &[outer.clone(), inner.clone()]);
    }
}

/// Two square plates with a round hole each, `gap` apart: the surface, and the band of both holes.
fn thin_wall(gap: f64) -> (Vec<DVec3>, Vec<[u32; 3]>, Band) {
    let plane = |x: f64, y: f64| (DVec3::new(x, y, 0.0), DVec3::Z);
    let top = rings(40.0, 40, 2, 1.0, plane);
    let mut points = top.points.clone();
    points.extend(top.points.iter().map(|p| DVec3::new(p.x, p.y, -gap)));
    let mut triangles = Vec::new();
    for layer in 0..2u32 {
        for ring in 0..2u32 {
            for i in 0..40u32 {
                let at = |r: u32, i: u32| layer * 120 + r * 40 + i % 40;
                let (a, b, c, d) = (at(ring, i), at(ring, i + 1), at(ring + 1, i), at(ring + 1, i + 1));
                for [a, b, c] in [[a, c, b], [b, c, d]] {
                    triangles.push(if layer == 0 { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    let normals = (0..240).map(|i| if i < 120 { DVec3::Z } else { -DVec3::Z }).collect();
    (points.clone(), triangles, Band { points, normals })
}

#[test]
fn a_thin_wall_with_a_hole_on_each_side_stays_two_surfaces() {
    let budget = Budget::unlimited();
    let (points, triangles, both) = thin_wall(0.5);
    let surface = NearestSearch::build(&points, &triangles, &budget).unwrap();
    let around = BandSurroundings { surface: Some(&surface), mesh_box: Aabb::of(points.iter().copied()) };
    for options in every_way() {
        let field = match fit(&both, &around, &options, &budget).unwrap() {
            Ok(field) => field,
            // Differences of r^3 at such a distance are lost in f64.
            Err(Unfit::Residual { .. }) if options.kernel == Kernel::Cubic => continue,
            Err(refusal) => panic!("{options:?}: {refusal}"),
        };
        let facts = field.facts();
        assert!(facts.lambda > 0.25 && facts.lambda_range[1] <= 0.25 && facts.halved == 240, "{facts:?}");
        for (x, y) in inside(40.0) {
            let [top, bottom] = [0.1, -0.6].map(|z| field.project(DVec3::new(x, y, z), 0.5).unwrap());
            assert!(top.z.abs() < 0.05 && (bottom.z + 0.5).abs() < 0.05, "{options:?} {top} {bottom}");
            assert!(field.value(DVec3::new(x, y, -0.25)) < 0.0);
        }
        // Each side alone, with the other side near.
        let top = Band { points: both.points[..120].to_vec(), normals: both.normals[..120].to_vec() };
        let alone = fit(&top, &around, &options, &budget).unwrap().unwrap();
        assert!(alone.facts().lambda_range[1] <= 0.25);
        assert!(error(&alone, 40.0, |x, y| (DVec3::new(x, y, 0.0), DVec3::Z)) < 1e-8);
    }
}

#[test]
fn parts_give_nearly_the_field_of_the_whole_and_take_the_same_values() {
    for kernel in KERNELS {
        let band = rings(0.8, 80, 2, 1.0, on_saddle);
        let whole = fitted(&band, &RbfOptions { kernel, ..RbfOptions::default() });
        let parts = fitted(&band, &RbfOptions { kernel, dense_centres_max: 200, ..RbfOptions::default() });
        assert_eq!(whole.facts().method, SolveMethod::Dense);
        assert!(matches!(parts.facts().method, SolveMethod::Partition { parts, .. } if parts > 4));
        for (p, n) in band.points.iter().zip(&band.normals) {
            let lambda = parts.facts().lambda;
            assert!(parts.value(*p).abs() < 1e-9 * lambda);
            assert!((parts.value(*p + *n * lambda) - lambda).abs() < 1e-8 * lambda);
        }
        for (x, y) in inside(0.8) {
            let p = on_saddle(x, y).0;
            let (a, b) = (whole.project(p, 0.5).unwrap(), parts.project(p, 0.5).unwrap());
            assert!(a.distance(b) < 5e-3, "{kernel:?} {}", a.distance(b));
            let (value, slope) = parts.value_and_gradient(p);
            assert_eq!(value, parts.value(p));
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let step = axis * 1e-5;
                let change = (parts.value(p + step) - parts.value(p - step)) / 2e-5;
                assert!((change - slope.dot(axis)).abs() < 1e-5, "{kernel:?} {change} {slope}");
            }
        }
    }
}

#[test]
fn the_same_bits_come_with_one_two_and_eight_threads() {
    let band = rings(0.8, 36, 2, 1.0, on_saddle);
    let rim = band.points[..36].to_vec();
    for dense_centres_max in [3000, 200] {
        let options = RbfOptions { dense_centres_max, ..RbfOptions::default() };
        let results = [1, 2, 8].map(|threads| {
            par::with_threads(threads, || {
                let field = fitted(&band, &options);
                let patch = mesh_surface(&field, std::slice::from_ref(&rim), 0.14, &Budget::unlimited())
                    .unwrap()
                    .unwrap();
                (field.value(DVec3::new(0.1, 0.2, 0.3)).to_bits(), patch)
            })
        });
        assert!(results[0] == results[1] && results[1] == results[2]);
    }
}

#[test]
fn what_cannot_be_fitted_is_refused_with_the_reason() {
    let budget = Budget::unlimited();
    let refusal =
        |band: &Band, options: &RbfOptions| fit(band, &ALONE, options, &budget).unwrap().unwrap_err();
    let good = rings(1.0, 12, 1, 1.0, on_saddle);
    let options = RbfOptions::default();
    assert_eq!(refusal(&Band::default(), &options), Unfit::TooFewPoints { points: 0, normals: 0 });
    let mut bad = good.clone();
    bad.points[5].x = f64::NAN;
    assert_eq!(refusal(&bad, &options), Unfit::NotFinite { point: 5 });
    let mut bad = good.clone();
    bad.normals[7] = DVec3::ZERO;
    assert_eq!(refusal(&bad, &options), Unfit::NotFinite { point: 7 });
    assert_eq!(refusal(&good, &RbfOptions { lambda: Some(-1.0), ..options }), Unfit::Options);
    assert_eq!(refusal(&good, &RbfOptions { share: 0.0, ..options }), Unfit::Options);
    let line = Band { points: (0..9).map(|i| DVec3::X * f64::from(i)).collect(), normals: vec![DVec3::Y; 9] };
    assert_eq!(refusal(&line, &options), Unfit::Rank { rank: 3 });
    let one = Band { points: vec![DVec3::ONE; 5], normals: vec![DVec3::Z; 5] };
    assert!(matches!(refusal(&one, &options), Unfit::NotFinite { .. }));
    let stop = StopFlag::default();
    stop.cancel();
    let stopped = Budget::new(stop, u64::MAX, u64::MAX);
    assert_eq!(fit(&good, &ALONE, &options, &stopped).unwrap_err(), Stopped::Cancelled);
}

#[test]
fn points_on_another_wall_have_no_offsets_and_where_all_are_there_is_no_field() {
    let flat = rings(1.0, 12, 2, 1.0, |x, y| (DVec3::new(x, y, 0.0), DVec3::Z));
    let budget = Budget::unlimited();
    // A triangle at each point, and a square below them, much nearer than a thousandth of lambda, from x = `from` on.
    let fit_over = |from: f64| {
        let corner = |x: f64, y: f64| DVec3::new(x, y, -1e-9);
        let mut positions = vec![corner(from, -9.0), corner(9.0, -9.0), corner(9.0, 9.0), corner(from, 9.0)];
        let mut triangles = vec![[0, 2, 1], [0, 3, 2]];
        for &p in &flat.points {
            let first = positions.len() as u32;
            positions.extend([p, p + 0.01 * DVec3::X, p + 0.01 * DVec3::Y]);
            triangles.push([first, first + 1, first + 2]);
        }
        let surface = NearestSearch::build(&positions, &triangles, &budget).unwrap();
        let around = BandSurroundings { surface: Some(&surface), mesh_box: Aabb::EMPTY };
        fit(&flat, &around, &RbfOptions::default(), &budget).unwrap()
    };
    assert_eq!(fit_over(-9.0).unwrap_err(), Unfit::NoRoom);
    let half = fit_over(0.6).unwrap();
    let facts = half.facts();
    let crowded = flat.points.iter().filter(|p| p.x >= 0.6).count();
    assert_eq!(facts.without_room, crowded);
    assert_eq!(facts.centres, 3 * flat.points.len() - 2 * crowded);
    assert!(facts.lambda_range[0] > 0.0, "{facts:?}");
    let place = half.project(DVec3::new(0.1, 0.2, 0.05), 1.0).unwrap();
    assert!(place.z.abs() < 1e-6, "{place}");
}

/// The rims are bounded once in their direction with the same bits, every other edge twice in both directions.
fn check_patch(patch: &Patch, rims: &[Vec<DVec3>]) {
    let rim = rims.concat();
    assert!(patch.points[..rim.len()] == rim[..], "the rims keep their bits");
    let mut edges: BTreeMap<(u32, u32), i32> = BTreeMap::new();
    for t in &patch.triangles {
        for c in 0..3 {
            *edges.entry((t[c], t[(c + 1) % 3])).or_default() += 1;
        }
    }
    let mut first = 0u32;
    let mut rim_edges = Vec::new();
    for rim in rims {
        let n = rim.len() as u32;
        rim_edges.extend((0..n).map(|i| (first + i, first + (i + 1) % n)));
        first += n;
    }
    for (&(a, b), &count) in &edges {
        assert_eq!(count, 1);
        assert_ne!(edges.contains_key(&(b, a)), rim_edges.contains(&(a, b)), "{a} {b}");
    }
    for edge in rim_edges {
        assert!(edges.contains_key(&edge));
    }
    let mut is_used = vec![false; patch.points.len()];
    patch.triangles.iter().flatten().for_each(|&v| is_used[v as usize] = true);
    assert!(is_used.iter().all(|&used| used));
}

/// The smallest angle in degrees, the mean of the triangles' smallest angles, and the largest distance of vertices and
/// middles of triangles from the zero set.
fn quality(field: &Field, patch: &Patch) -> (f64, f64, f64) {
    let (mut least, mut sum, mut far) = (180.0f64, 0.0, 0.0f64);
    for t in &patch.triangles {
        let p = t.map(|v| patch.points[v as usize]);
        let angle = |k: usize| {
            let (u, v) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            libm::atan2(u.cross(v).length(), u.dot(v)).to_degrees()
        };
        let smallest = angle(0).min(angle(1)).min(angle(2));
        least = least.min(smallest);
        sum += smallest;
        for q in [p[0], p[1], p[2], (p[0] + p[1] + p[2]) / 3.0] {
            let (value, slope) = field.value_and_gradient(q);
            far = far.max(value.abs() / slope.length());
        }
    }
    (least, sum / patch.triangles.len() as f64, far)
}

#[test]
fn both_meshes_keep_the_rim_and_lie_on_the_surface_and_the_better_one_has_good_angles() {
    type Lift = fn(f64, f64) -> (DVec3, DVec3);
    let shapes: [(&str, Lift, f64, usize); 5] = [
        ("sphere cap", on_sphere, 0.6, 40),
        ("most of a sphere", on_sphere, 2.2, 30),
        ("saddle", on_saddle, 0.5, 40),
        ("cylinder", on_cylinder, 0.8, 60),
        ("plane", |x, y| (DVec3::new(x, y, 0.0), DVec3::Z), 1.0, 24),
    ];
    println!(
        "| hole | mesh | triangles | smallest angle | mean of smallest | farthest from f = 0 over edge |"
    );
    for (name, lift, radius, count) in shapes {
        let band = rings(radius, count, 2, 1.0, lift);
        let field = fitted(&band, &RbfOptions::default());
        let rim = [band.points[..count].to_vec()];
        let edge = rim[0][0].distance(rim[0][1]);
        let budget = Budget::unlimited();
        for (kind, patch) in [
            ("march", march(&field, &rim, edge, &budget)),
            ("mesh", mesh_surface(&field, &rim, edge, &budget)),
        ] {
            let patch = patch.unwrap().unwrap_or_else(|e| panic!("{name} {kind}: {e}"));
            check_patch(&patch, &rim);
            let (least, mean, far) = quality(&field, &patch);
            println!(
                "| {name} | {kind} | {} | {least:.1} | {mean:.1} | {:.4} |",
                patch.triangles.len(),
                far / edge
            );
            assert!(far < 0.3 * edge, "{name} {kind}: {far} of {edge}");
            assert!(kind == "march" || least >= 30.0, "{name}: {least}");
        }
    }
}
