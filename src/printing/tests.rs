//! Measures of the smallest meshes whose figures are known.

use super::*;
use crate::par;

const LIMITS: PrintingPolicy = PrintingPolicy {
    name: "test",
    version: 1,
    wall: Limit { warning: Some(1.0), error: Some(0.5) },
    gap: Limit { warning: Some(0.5), error: None },
    feature: Limit { warning: None, error: Some(0.5) },
    overhang: Limit { warning: Some(45.0), error: None },
    sharp_edge: Limit { warning: Some(30.0), error: None },
    cavities: Limit { warning: None, error: Some(0.0) },
    build_volume: BuildVolume { warning: None, error: Some([100.0; 3]) },
    build_direction: BuildDirection::Z,
};

fn joined(parts: &[Soup]) -> Soup {
    let mut all = Soup::default();
    for part in parts {
        let base = all.positions.len() as u32;
        all.positions.extend(&part.positions);
        all.triangles.extend(part.triangles.iter().map(|t| t.map(|v| v + base)));
        all.face_count += part.face_count;
    }
    all
}

fn turned(mut soup: Soup) -> Soup {
    soup.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    soup
}

fn moved(mut soup: Soup, to: impl Fn(DVec3) -> DVec3) -> Soup {
    soup.positions.iter_mut().for_each(|p| *p = to(*p));
    soup
}

/// Walls and lids over a polygon, counter-clockwise, that a fan around its first corner covers.
fn prism(outline: &[[f64; 2]], height: f64) -> Soup {
    let n = outline.len() as u32;
    let at = |z: f64| outline.iter().map(move |&[x, y]| DVec3::new(x, y, z));
    let lids = (1..n - 1).flat_map(|i| [[0, i + 1, i], [n, n + i, n + i + 1]]);
    let walls = (0..n).flat_map(|i| {
        let j = (i + 1) % n;
        [[i, j, n + j], [i, n + j, n + i]]
    });
    let triangles: Vec<[u32; 3]> = lids.chain(walls).collect();
    let face_count = triangles.len() as u32;
    Soup { positions: at(0.0).chain(at(height)).collect(), triangles, face_count, ..Soup::default() }
}

fn cuboid(size: [f64; 3], at: [f64; 3]) -> Soup {
    let [x, y, z] = size;
    moved(prism(&[[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]], z), |p| p + DVec3::from(at))
}

fn circle(radius: f64, sides: u32) -> Vec<[f64; 2]> {
    let turn = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(sides);
    (0..sides).map(|i| [radius * turn(i).cos(), radius * turn(i).sin()]).collect()
}

/// A tube along z, its wall between two regular polygons.
fn tube(inner: f64, outer: f64, height: f64, sides: u32) -> Soup {
    let ring = |radius: f64, z: f64| {
        circle(radius, sides).into_iter().map(move |[x, y]| DVec3::new(x, y, z)).collect::<Vec<_>>()
    };
    let positions = [ring(outer, 0.0), ring(outer, height), ring(inner, height), ring(inner, 0.0)].concat();
    let mut triangles = Vec::new();
    for k in 0..4 {
        for i in 0..sides {
            let at = |ring: u32, i: u32| (ring % 4) * sides + i % sides;
            let [a, b, c, d] = [at(k, i), at(k, i + 1), at(k + 1, i + 1), at(k + 1, i)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Soup { face_count: triangles.len() as u32, positions, triangles, ..Soup::default() }
}

fn with(soup: &Soup, policy: &PrintingPolicy) -> Printing {
    measure(soup, policy, true, 4, &Budget::unlimited()).unwrap().unwrap()
}

fn measured(soup: &Soup) -> Printing {
    with(soup, &LIMITS)
}

fn status(printing: &Printing, code: CheckCode) -> Option<Status> {
    printing.checks.iter().find(|check| check.code == code).unwrap().status
}

fn near(found: Option<f64>, wanted: f64) {
    assert!(found.is_some_and(|found| (found - wanted).abs() < 1e-6 * wanted.max(1.0)), "{found:?} {wanted}");
}

#[test]
fn a_box_has_walls_as_thick_as_its_sides_by_both_definitions() {
    let plate = measured(&cuboid([30.0, 20.0, 2.0], [5.0, -3.0, 1.0]));
    for spread in [plate.figures.walls.ray, plate.figures.walls.sphere] {
        near(spread.min, 2.0);
        near(spread.median, 2.0);
    }
    assert_eq!(plate.figures.walls.ray.measured_share, 1.0);
    assert_eq!(status(&plate, CheckCode::Wall), Some(Status::Ok));
    assert_eq!(plate.figures.gaps.least(), None, "nothing is opposite outside");
    assert_eq!(plate.verdict(), Status::Ok);
    assert_eq!(plate.holds(), Some(true));
}

#[test]
fn a_thin_plate_is_told_with_its_area_and_places_on_it() {
    let thin = measured(&cuboid([30.0, 20.0, 0.4], [0.0; 3]));
    let walls = &thin.figures.walls;
    near(walls.ray.min, 0.4);
    // Both sides; what lies on the rim has thick walls behind.
    let area = walls.area_below_error.unwrap();
    assert!((area - 1200.0).abs() < 45.0, "{area}");
    assert_eq!(status(&thin, CheckCode::Wall), Some(Status::Error));
    assert_eq!(thin.holds(), Some(false));
    let check = &thin.checks[0];
    assert_eq!(check.witnesses.len(), 4);
    assert!(check.witnesses.iter().all(|w| (w.measured - 0.4).abs() < 1e-9 && w.place.is_finite()));
}

#[test]
fn a_knife_runs_out_to_nothing_and_a_tip_is_only_a_warning() {
    let knife = measured(&prism(&[[0.0, 0.0], [20.0, -1.0], [20.0, 1.0]], 30.0));
    assert_eq!(status(&knife, CheckCode::Wall), Some(Status::Error));
    assert_eq!(status(&knife, CheckCode::SharpEdge), Some(Status::Warning));
    assert_eq!(knife.figures.edges.sharp_count, 1);
    near(Some(knife.figures.edges.sharp_length), 30.0);
    near(knife.figures.edges.angle_min, 2.0 * (1.0f64 / 20.0).atan().to_degrees());
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let tip = Soup {
        positions: vec![
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            DVec3::Z * 4.0,
        ],
        triangles: vec![[0, 2, 1], [0, 3, 2], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
        face_count: 6,
        ..Soup::default()
    };
    assert_eq!(status(&measured(&tip), CheckCode::Wall), Some(Status::Warning));
    // A plate that is smaller than a tip may be is thin all the same.
    let plate = prism(&[[0.0, 0.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]], 0.02);
    assert_eq!(status(&measured(&plate), CheckCode::Wall), Some(Status::Error));
}

#[test]
fn a_tube_has_its_wall_inside_and_its_bore_outside() {
    let (sides, height) = (64, 40.0);
    let shrink = (std::f64::consts::PI / f64::from(sides)).cos();
    let tube = measured(&tube(5.0, 6.5, height, sides));
    near(tube.figures.walls.sphere.min, 1.5 * shrink);
    assert!(tube.figures.walls.ray.min.unwrap() > 1.49 * shrink);
    assert!(tube.figures.walls.ray.median.unwrap() < 1.51);
    near(tube.figures.gaps.ray.min, 10.0 * shrink);
    assert!(tube.figures.gaps.sphere.min.unwrap() > 9.9 * shrink);
}

#[test]
fn a_ball_is_smaller_than_the_ray_where_the_wall_opposite_is_curved() {
    // From the flat top the ray to the slope is 45 degrees off the shortest way; the normals are 135 degrees apart.
    let wedge = measured(&prism(&[[0.0, 0.0], [40.0, 20.0], [0.0, 20.0]], 100.0));
    let walls = &wedge.figures.walls;
    assert!(walls.sphere.median.unwrap() < walls.ray.median.unwrap());
    assert!(walls.sphere.p5.unwrap() <= walls.sphere.median.unwrap());
}

#[test]
fn two_plates_have_a_gap_between_them() {
    let plates = joined(&[cuboid([20.0, 20.0, 3.0], [0.0; 3]), cuboid([20.0, 20.0, 3.0], [0.0, 0.0, 3.25])]);
    let of = measured(&plates);
    near(of.figures.gaps.ray.min, 0.25);
    near(of.figures.gaps.sphere.min, 0.25);
    near(of.figures.walls.ray.min, 3.0);
    assert_eq!(status(&of, CheckCode::Gap), Some(Status::Warning));
}

#[test]
fn a_cube_in_a_cube_is_a_trapped_cavity_and_no_wall_is_measured_through_it() {
    let hollow = joined(&[cuboid([10.0; 3], [0.0; 3]), turned(cuboid([4.0; 3], [3.0; 3]))]);
    let of = measured(&hollow);
    let cavities = of.figures.parts.cavities.as_ref().unwrap();
    assert_eq!(cavities.count, 1);
    near(Some(cavities.volume), 64.0);
    near(of.figures.quote.volume, 936.0);
    near(of.figures.walls.ray.min, 3.0);
    near(of.figures.gaps.ray.min, 4.0);
    assert_eq!(status(&of, CheckCode::Cavity), Some(Status::Error));
    let solid_inside = joined(&[hollow, cuboid([1.0; 3], [4.5; 3])]);
    let of = measured(&solid_inside);
    assert_eq!(of.figures.parts.cavities.as_ref().unwrap().count, 1);
    assert_eq!((of.figures.parts.bodies, of.figures.parts.smallest_side), (2, Some(1.0)));
}

#[test]
fn without_a_valid_solid_cavities_volume_and_p3_are_not_told() {
    let open = Soup {
        triangles: cuboid([10.0; 3], [0.0; 3]).triangles[1..].to_vec(),
        ..cuboid([10.0; 3], [0.0; 3])
    };
    let of = measure(&open, &LIMITS, false, 4, &Budget::unlimited()).unwrap().unwrap();
    assert_eq!(of.figures.quote.volume, None);
    assert_eq!(status(&of, CheckCode::Cavity), None);
    assert_eq!(of.holds(), None);
    assert_eq!(measure(&Soup::default(), &LIMITS, false, 4, &Budget::unlimited()).unwrap(), None);
}

#[test]
fn a_wedge_overhangs_in_some_orientations_and_lies_on_the_plate_in_others() {
    // A profile in x and z: a flat underside, an edge at 30 degrees from the horizontal at the right.
    let rise = (30f64).to_radians().tan() * 10.0;
    let profile = prism(&[[0.0, 0.0], [10.0, 0.0], [20.0, rise], [0.0, rise]], 5.0);
    let wedge = moved(profile, |p| DVec3::new(p.x, -p.z, p.y));
    let of = measured(&wedge);
    let up =
        |direction: BuildDirection| of.figures.overhangs.iter().find(|o| o.direction == direction).unwrap();
    let z = up(BuildDirection::Z);
    near(Some(z.support_area), 50.0);
    near(Some(z.area), 50.0 / (30f64).to_radians().cos());
    near(Some(z.plate_area), 50.0);
    near(z.angle_min, 30.0);
    near(Some(z.height), rise);
    let upside_down = up(BuildDirection::MinusZ);
    assert_eq!((upside_down.area, upside_down.angle_min), (0.0, None));
    near(Some(upside_down.plate_area), 100.0);
    assert_eq!(status(&of, CheckCode::Overhang), Some(Status::Warning));
    let policy = PrintingPolicy { build_direction: BuildDirection::MinusZ, ..LIMITS };
    assert_eq!(status(&with(&wedge, &policy), CheckCode::Overhang), Some(Status::Ok));
    let steep = PrintingPolicy { overhang: Limit { warning: Some(30.0), error: None }, ..LIMITS };
    assert_eq!(status(&with(&wedge, &steep), CheckCode::Overhang), Some(Status::Ok), "just steep enough");
}

#[test]
fn an_l_has_its_shadow_its_box_and_no_sharp_edge() {
    let l = joined(&[prism(&[[1.0, 1.0], [1.0, 3.0], [0.0, 3.0], [0.0, 0.0], [4.0, 0.0], [4.0, 1.0]], 2.0)]);
    let of = measured(&l);
    near(of.figures.quote.volume, 12.0);
    // Rows end between the arms; the error is at most half a row along each.
    assert!((of.figures.quote.shadow_area - 6.0).abs() < 0.01, "{}", of.figures.quote.shadow_area);
    assert_eq!(of.figures.quote.bounds.max, DVec3::new(4.0, 3.0, 2.0));
    near(of.figures.edges.angle_min, 90.0);
    assert_eq!(of.figures.edges.sharp_count, 0);
    near(of.figures.edges.shortest, 1.0);
    let along_x = PrintingPolicy { build_direction: BuildDirection::X, ..LIMITS };
    near(Some(with(&l, &along_x).figures.quote.shadow_area), 6.0);
}

fn tilt(p: DVec3) -> DVec3 {
    glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -0.7, 1.1) * p + DVec3::splat(200.0)
}

#[test]
fn the_box_around_a_turned_box_is_that_box() {
    let of = measured(&moved(cuboid([30.0, 20.0, 7.0], [0.0; 3]), tilt));
    let found = of.figures.quote.oriented_box;
    for (found, wanted) in found.size.into_iter().zip([30.0, 20.0, 7.0]) {
        near(Some(found), wanted);
    }
    assert!(found.centre.distance(tilt(DVec3::new(15.0, 10.0, 3.5))) < 1e-9);
}

#[test]
fn the_box_around_a_regular_tetrahedron_has_edges_as_diagonals_of_its_sides() {
    let positions = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    let soup = Soup {
        positions: positions.map(|p| tilt(DVec3::from(p))).to_vec(),
        triangles: vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
        face_count: 4,
        ..Soup::default()
    };
    near(Some(measured(&soup).figures.quote.oriented_box.volume()), 8.0);
}

#[test]
fn a_long_part_fits_as_placed_turned_tilted_or_not() {
    let fit = |soup: &Soup, sides| {
        let volume = BuildVolume { warning: None, error: Some(sides) };
        let of = with(soup, &PrintingPolicy { build_volume: volume, ..LIMITS });
        (of.fit.unwrap(), status(&of, CheckCode::BuildVolume).unwrap())
    };
    let rod = cuboid([90.0, 10.0, 10.0], [0.0; 3]);
    assert_eq!(fit(&rod, [20.0, 100.0, 20.0]), (Fit::AsPlaced, Status::Ok));
    assert_eq!(fit(&rod, [20.0, 20.0, 100.0]), (Fit::Turned, Status::Ok));
    assert_eq!(fit(&rod, [80.0, 80.0, 80.0]), (Fit::No, Status::Error));
    assert_eq!(fit(&moved(rod, tilt), [20.0, 20.0, 100.0]), (Fit::Tilted, Status::Warning));
}

#[test]
fn figures_scale_with_the_mesh_and_do_not_depend_on_threads_or_places() {
    let tube = tube(5.0, 6.5, 40.0, 24);
    let all = |threads| par::with_threads(threads, || format!("{:?}", measured(&tube)));
    assert_eq!(all(1), all(2));
    assert_eq!(all(1), all(8));
    let of = measured(&tube);
    let scaled = |by: f64| {
        let limit = |l: Limit| Limit { warning: l.warning.map(|w| w * by), error: l.error.map(|e| e * by) };
        let policy = PrintingPolicy { wall: limit(LIMITS.wall), gap: limit(LIMITS.gap), ..LIMITS };
        with(&moved(tube.clone(), |p| p * by), &policy)
    };
    for by in [1e-20, 1.0 / 1024.0, 1e20] {
        let found = scaled(by);
        near(found.figures.walls.sphere.median.map(|m| m / by), of.figures.walls.sphere.median.unwrap());
        near(Some(found.figures.quote.oriented_box.size[0] / by), of.figures.quote.oriented_box.size[0]);
    }
}

#[test]
fn meshes_of_any_kind_are_measured_without_harm() {
    let points = [0.0, 1.0, -1.0, 1e-30, 1e30, 1e-300, 1e300, 0.5];
    let mut state = 5u32;
    let mut random = |n: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 16) % n
    };
    for round in 0..200 {
        let wild = if round % 2 == 0 { 3 } else { 8 };
        let count = 3 + random(9);
        let mut coordinate = || points[random(wild) as usize];
        let positions = (0..count).map(|_| DVec3::new(coordinate(), coordinate(), coordinate())).collect();
        let triangles: Vec<[u32; 3]> =
            (0..1 + random(12)).map(|_| [random(count), random(count), random(count)]).collect();
        let soup = Soup { face_count: triangles.len() as u32, positions, triangles, ..Soup::default() };
        for is_solid in [false, true] {
            let policy = PrintingPolicy { build_direction: BuildDirection::ALL[round % 6], ..LIMITS };
            let found = measure(&soup, &policy, is_solid, 2, &Budget::unlimited()).unwrap();
            if let Some(found) = found {
                let of = found.figures.quote;
                let size = of.bounds.max - of.bounds.min;
                assert!(of.oriented_box.volume() <= size.element_product() * (1.0 + 1e-9), "{round}");
            }
        }
    }
}

#[test]
fn a_raised_flag_ends_the_measuring() {
    let stop = crate::budget::StopFlag::default();
    stop.cancel();
    let budget = Budget::new(stop, u64::MAX, u64::MAX);
    assert!(measure(&cuboid([1.0; 3], [0.0; 3]), &LIMITS, true, 4, &budget).is_err());
}

#[test]
fn discs_of_very_many_thin_triangles_are_measured_at_fewer_places() {
    let n = 9_000;
    let mut soup = prism(&circle(20.0, n), 2.0);
    // Lids as fans around their middles: each ray through one meets the boxes of a quarter of it.
    let middles = [2 * n, 2 * n + 1];
    soup.positions.extend([DVec3::ZERO, DVec3::Z * 2.0]);
    soup.triangles.drain(..2 * (n as usize - 2));
    for i in 0..n {
        let j = (i + 1) % n;
        soup.triangles.extend([[middles[0], j, i], [middles[1], n + i, n + j]]);
    }
    let walls = measured(&soup).figures.walls;
    assert!((1 << 10..1 << 15).contains(&walls.samples), "{}", walls.samples);
    near(walls.ray.median, 2.0);
}
