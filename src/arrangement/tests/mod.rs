//! The arrangement against exact checks that share no code with it.

mod cases;
mod oracle;

use super::{Arrangement, ArrangementError, Options, arrange};
use crate::budget::{Budget, StopFlag, Stopped};
use crate::geom::DVec3;
use crate::par;
use cases::{Bodies, Random, cube, tetrahedron};

fn arranged(bodies: &Bodies) -> Result<Arrangement, ArrangementError> {
    let options = Options { operands: 2, ..Options::default() };
    let operand_of = |t: u32| bodies.operands[t as usize];
    arrange(&bodies.positions, &bodies.triangles, operand_of, &options, &Budget::unlimited())
}

/// All checks of one case.
fn check(bodies: &Bodies, name: &str) {
    let arrangement = arranged(bodies).unwrap_or_else(|error| panic!("{name}: {error}\n{bodies:?}"));
    let broken = oracle::breaches(&arrangement, bodies);
    assert!(broken.is_empty(), "{name}: {broken:?}\n{bodies:?}");
}

/// `small` cases, or `full` when `MESHMEND_CAMPAIGN` is set.
fn cases(small: u64, full: u64) -> u64 {
    if std::env::var_os("MESHMEND_CAMPAIGN").is_some() { full } else { small }
}

#[test]
fn two_cubes_that_overlap_are_divided_and_united() {
    let mut bodies = Bodies::default();
    bodies.add(cube([0, 0, 0], [2, 2, 2], 0), 0);
    bodies.add(cube([1, 1, 1], [3, 3, 3], 0), 1);
    check(&bodies, "cubes");
    let arrangement = arranged(&bodies).unwrap();
    let volume = |inside: fn(&[i32]) -> bool| oracle::volume_sixfold(&arrangement, inside);
    assert_eq!(volume(|w| w[0] > 0 || w[1] > 0), oracle::whole(6 * 15));
    assert_eq!(volume(|w| w[0] > 0 && w[1] > 0), oracle::whole(6));
    assert_eq!(volume(|w| w[0] > 0 && w[1] <= 0), oracle::whole(6 * 7));
}

#[test]
fn cavities_and_copies_have_their_winding_numbers() {
    let mut bodies = Bodies::default();
    bodies.add(cube([0, 0, 0], [4, 4, 4], 0), 0);
    bodies.add_turned(cube([1, 1, 1], [2, 2, 2], 0), 0);
    bodies.add(cube([0, 0, 0], [4, 4, 4], 5), 0);
    check(&bodies, "hollow cube twice");
    let arrangement = arranged(&bodies).unwrap();
    let volume = |at_least: i32| oracle::volume_sixfold(&arrangement, move |w| w[0] >= at_least);
    assert_eq!(volume(1), oracle::whole(6 * 64));
    assert_eq!(volume(2), oracle::whole(6 * 63));
    assert_eq!(arrangement.boundary(|w| w[0] >= 3).pieces.len(), 0);
}

#[test]
fn triangles_that_meet_no_other_stay_as_they_are() {
    let mut bodies = Bodies::default();
    bodies.add(cube([0, 0, 0], [1, 1, 1], 0), 0);
    bodies.add(cube([5, 5, 5], [7, 7, 7], 0), 0);
    bodies.add(tetrahedron([[6, 6, 6], [6, 6, 9], [8, 6, 9], [6, 8, 9]]), 0);
    let arrangement = arranged(&bodies).unwrap();
    let same = |t: &&[u32; 3]| arrangement.pieces().contains(t);
    assert!(bodies.triangles.iter().filter(same).count() >= 12 + 10);
    check(&bodies, "apart");
}

#[test]
fn random_small_bodies_agree_with_the_oracle() {
    let count = cases(3_000, 100_000) as usize;
    let failed = par::map_ranges(count, 16, |range| {
        for seed in range {
            let bodies = cases::random(&mut Random::new(seed as u64));
            check(&bodies, &format!("seed {seed}"));
        }
    });
    assert_eq!(failed.len(), count.div_ceil(16));
}

#[test]
fn thirty_sheets_through_one_line_are_ordered_around_it() {
    let mut random = Random::new(7);
    for round in 0..3 {
        let mut bodies = Bodies::default();
        while bodies.triangles.len() < 60 {
            bodies.add(cases::wedge(&mut random), (round % 2) as u8);
        }
        check(&bodies, "sheets");
    }
}

#[test]
fn the_same_pieces_with_1_2_and_8_threads() {
    let bodies = cases::crowd(&mut Random::new(3), 40);
    let told = [1, 2, 8].map(|threads| {
        par::with_threads(threads, || {
            let arrangement = arranged(&bodies).unwrap();
            let points: Vec<DVec3> =
                (0..arrangement.point_count() as u32).map(|p| arrangement.position(p)).collect();
            format!("{:?} {:?} {:?}", arrangement.pieces, arrangement.windings, points)
        })
    });
    assert!(told[0] == told[1] && told[0] == told[2]);
}

#[test]
fn coordinates_of_every_size_are_taken_as_they_are() {
    for (scale, shift) in
        [(1e-30, 0.0), (1e150, 0.0), (1.0, 1e6), (0.1, 0.3), (1e-200, 1e-180), (1e-307, 0.0)]
    {
        for seed in 0..20 {
            let mut bodies = cases::random(&mut Random::new(seed));
            for p in &mut bodies.positions {
                *p = *p * scale + shift;
            }
            let arrangement = arranged(&bodies);
            assert!(arrangement.is_ok(), "{scale} {shift} seed {seed}: {:?}", arrangement.err());
        }
    }
    // One coordinate far below the others, as noise about zero.
    let mut bodies = cases::crowd(&mut Random::new(1), 6);
    bodies.positions[3].x += 1e-17;
    bodies.positions[9].y -= 3e-40;
    assert!(arranged(&bodies).is_ok());
}

#[test]
fn what_is_open_too_much_or_stopped_is_refused_as_such() {
    let mut open = Bodies::default();
    open.add(cube([0, 0, 0], [2, 2, 2], 0), 0);
    open.add(cube([1, 1, 1], [3, 3, 3], 0), 0);
    let pairs = Options { pairs_max: 3, operands: 2 };
    let run = |bodies: &Bodies, options: &Options, budget: &Budget| {
        let operand_of = |t: u32| bodies.operands[t as usize];
        arrange(&bodies.positions, &bodies.triangles, operand_of, options, budget).map(|_| ())
    };
    let unlimited = Budget::unlimited();
    assert!(matches!(run(&open, &pairs, &unlimited), Err(ArrangementError::TooManyPairs { limit: 3, .. })));
    let stop = StopFlag::default();
    let stopped = Budget::new(stop.clone(), u64::MAX, u64::MAX);
    stop.cancel();
    let cancelled = Err(ArrangementError::Stopped(Stopped::Cancelled));
    assert_eq!(run(&open, &Options::default(), &stopped), cancelled);
    let little = Budget::new(StopFlag::default(), 100, u64::MAX);
    assert!(matches!(
        run(&open, &Options::default(), &little),
        Err(ArrangementError::Stopped(Stopped::Work { .. }))
    ));
    open.triangles.pop();
    assert!(matches!(run(&open, &Options::default(), &unlimited), Err(ArrangementError::NotClosed { .. })));
    open.positions[0].x = f64::NAN;
    assert!(matches!(run(&open, &Options::default(), &unlimited), Err(ArrangementError::NotFinite { .. })));
}

#[test]
fn integers_are_as_wide_as_the_analysis_says() {
    use super::ball::Ball;
    use super::kernel::Kernel;
    use super::point::{Definition, Point};
    use std::sync::OnceLock;
    // The largest coordinates of 20 bits at the corners of a cube around the origin, and their odd neighbours.
    let m = f64::from((1 << 20) - 1);
    let (mut random, mut widest) = (Random::new(5), [Vec::new(), Vec::new()]);
    for _ in 0..200 {
        let corner = |random: &mut Random| {
            let sign = |random: &mut Random| if random.below(2) == 0 { m } else { -m };
            DVec3::new(sign(random), sign(random), sign(random) - 2.0 * (random.below(3) as f64))
        };
        let positions: Vec<DVec3> = (0..9).map(|_| corner(&mut random)).collect();
        let kernel = Kernel::new(positions, vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]]);
        // Differences to the origin have one bit more.
        let b = u64::from(kernel.bits()) + 1;
        let width = |definition| {
            let point = Point { definition, near: [Ball::UNKNOWN; 3], exact: OnceLock::new() };
            let exact = kernel.exact(&point);
            [exact.x.iter().map(num_bigint::BigInt::bits).max().unwrap(), exact.w.bits()]
        };
        // The points need not exist: where planes are parallel the denominator is zero, which has no bits.
        let names = [
            (Definition::EdgePlane { edge: [3, 4], plane: 0 }, [4 * b + 8, 3 * b + 6]),
            (Definition::Planes([0, 1, 2]), [7 * b + 15, 6 * b + 12]),
        ];
        for (name, most) in names {
            let [x, w] = width(name);
            assert!(x <= most[0] && w <= most[1], "{name:?} {x} {w} of {most:?}");
            widest[usize::from(matches!(name, Definition::Planes(_)))].push(most[0] - x);
        }
    }
    // The bounds are not far from what occurs.
    assert!(widest.iter().all(|left| left.iter().min().is_some_and(|&bits| bits < 24)), "{widest:?}");
}
