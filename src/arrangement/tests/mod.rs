//! The arrangement against exact checks that share no code with it.

mod cases;
mod oracle;

use super::constraints::BYTES_OF_CROSSING;
use super::point::Definition;
use super::{Arrangement, ArrangementError, ArrangementOptions, PlacedBoundary, arrange, arrange_enclosed};
use crate::budget::{Budget, StopFlag, Stopped};
use crate::geom::{DVec3, Sign, are_collinear};
use crate::mesh::EdgeGroups;
use crate::par;
use crate::spatial::{Bvh, Search, self_contacts};
use cases::{Bodies, Random, cube, tetrahedron};

fn arranged(bodies: &Bodies) -> Result<Arrangement, ArrangementError> {
    let options = ArrangementOptions { operands: 2, ..ArrangementOptions::default() };
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
fn faces_that_many_bodies_pass_through_agree_with_the_oracle() {
    let count = cases(60, 4_000) as usize;
    let pieces = par::map_ranges(count, 4, |range| {
        let mut pieces = usize::MAX;
        for seed in range {
            let bodies = cases::pierced_plate(&mut Random::new(seed as u64 + 3_000_000), 8);
            check(&bodies, &format!("seed {seed}"));
            pieces = pieces.min(arranged(&bodies).unwrap().pieces().len());
        }
        pieces
    });
    let fewest = pieces.into_iter().min().unwrap();
    assert!(fewest > 150, "{fewest} pieces");
}

#[test]
fn work_on_a_face_is_in_proportion_to_what_passes_through_it() {
    let work = |beams| {
        let bodies = cases::crossed_beam(beams);
        let budget = Budget::unlimited();
        let options = ArrangementOptions { operands: 2, ..ArrangementOptions::default() };
        let operand_of = |t: u32| bodies.operands[t as usize];
        let arrangement =
            arrange(&bodies.positions, &bodies.triangles, operand_of, &options, &budget).unwrap();
        let boundary = arrangement.boundary(|w| w[0] > 0 || w[1] > 0);
        assert!(arrangement.merged(&boundary, &budget).unwrap().triangles.len() > 32 * beams as usize);
        budget.work_used()
    };
    let (few, many) = (work(25), work(200));
    assert!(many < 12 * few, "{few} and {many} units");
}

#[test]
fn volumes_of_random_pairs_of_solids_add_up_exactly() {
    let count = cases(100, 10_000) as usize;
    let meeting = par::map_ranges(count, 16, |range| {
        let mut meeting = 0;
        for seed in range {
            // Small grids make common planes and edges, large ones long numbers.
            let end = [4, 12, 1_000, 1_000_000][seed % 4];
            let bodies = cases::pair(&mut Random::new(seed as u64 + 2_000_000), end);
            let arrangement = arranged(&bodies).unwrap();
            let broken = oracle::volumes(&arrangement);
            assert!(broken.is_empty(), "seed {seed}: {broken:?}\n{bodies:?}");
            let volume = |inside: fn(&[i32]) -> bool| oracle::volume_sixfold(&arrangement, inside);
            let alone = [0, 1].map(|operand| arranged(&bodies.only(operand)).unwrap());
            assert_eq!(volume(|w| w[0] > 0), oracle::volume_sixfold(&alone[0], |w| w[0] > 0), "seed {seed}");
            assert_eq!(volume(|w| w[1] > 0), oracle::volume_sixfold(&alone[1], |w| w[1] > 0), "seed {seed}");
            meeting += usize::from(volume(|w| w[0] > 0 && w[1] > 0) != oracle::whole(0));
        }
        meeting
    });
    let meeting: usize = meeting.into_iter().sum();
    assert!(meeting * 2 > count, "{meeting} of {count} pairs have something in common");
}

#[test]
fn what_random_solids_enclose_is_their_union_whichever_way_their_triangles_turn() {
    let count = cases(2_000, 20_000) as usize;
    let compared = par::map_ranges(count, 16, |range| {
        let (mut whole, mut with_voids) = (0, 0);
        for seed in range {
            let mut random = Random::new(seed as u64 + 3_000_000);
            let bodies = cases::pair(&mut random, [4, 12, 1_000, 1_000_000][seed % 4]);
            let union = oracle::volume_sixfold(&arranged(&bodies).unwrap(), |w| w[0] > 0 || w[1] > 0);
            let mut turned = bodies.triangles.clone();
            turned.iter_mut().filter(|_| random.below(2) == 0).for_each(|corners| corners.swap(0, 1));
            let budget = Budget::unlimited();
            let enclosed =
                arrange_enclosed(&bodies.positions, &turned, &ArrangementOptions::default(), &budget)
                    .unwrap();
            let groups = EdgeGroups::build(enclosed.pieces(), enclosed.point_count(), &budget).unwrap();
            // Parts of their own are not united.
            if groups.components(&budget).unwrap().count > 1 {
                continue;
            }
            let volume = oracle::volume_sixfold(&enclosed, |w| w[0] > 0);
            assert!(volume >= union, "seed {seed}: {volume} of {union}\n{bodies:?}");
            whole += 1;
            with_voids += usize::from(volume != union);
        }
        [whole, with_voids]
    });
    let [whole, with_voids] = [0, 1].map(|k| compared.iter().map(|found| found[k]).sum::<usize>());
    assert!(whole * 3 > count && with_voids * 50 < whole, "{whole} of {count}, {with_voids} with voids");
}

#[test]
fn a_strip_with_one_side_encloses_nothing_and_may_stand_in_a_body() {
    // Half a turn around a circle: the two sides of each piece look into one cell.
    let steps = 12;
    let point = |i: usize, end: f64| {
        let angle = std::f64::consts::TAU * (i % steps) as f64 / steps as f64;
        let end = if i >= steps { -end } else { end };
        let (out, up) = (4.0 + end * (angle / 2.0).cos(), end * (angle / 2.0).sin());
        DVec3::new(out * angle.cos(), out * angle.sin(), up)
    };
    let corner = |i: usize, end: f64| [point(i, end), point(i, -end), point(i + 1, end), point(i + 1, -end)];
    let squares: Vec<[DVec3; 4]> = (0..steps).map(|i| corner(i, 1.0)).collect();
    let positions: Vec<DVec3> = squares.iter().flatten().copied().collect();
    let halves = |i: u32| [[4 * i, 4 * i + 1, 4 * i + 2], [4 * i + 3, 4 * i + 2, 4 * i + 1]];
    let strip: Vec<[u32; 3]> = (0..steps as u32).flat_map(halves).collect();
    let (options, budget) = (ArrangementOptions::default(), Budget::unlimited());
    let alone = arrange_enclosed(&positions, &strip, &options, &budget).unwrap();
    assert_eq!(alone.pieces().len(), strip.len());
    assert!(alone.windings.iter().all(|&winding| winding == 0));
    // Through the wall of a cube that part of it is in.
    let mut bodies = Bodies::default();
    bodies.add(cube([2, -2, -3], [7, 2, 3], 0), 0);
    let first = bodies.positions.len() as u32;
    let positions = [bodies.positions, positions].concat();
    let triangles =
        [bodies.triangles, strip.iter().map(|corners| corners.map(|v| v + first)).collect()].concat();
    let both = arrange_enclosed(&positions, &triangles, &options, &budget).unwrap();
    assert_eq!(oracle::volume_sixfold(&both, |w| w[0] > 0), oracle::whole(6 * 5 * 4 * 6));
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
fn points_where_constraints_cross_are_charged() {
    let bodies = cases::crowd(&mut Random::new(3), 120);
    let budget = Budget::unlimited();
    let operand_of = |t: u32| bodies.operands[t as usize];
    let options = ArrangementOptions { operands: 2, ..ArrangementOptions::default() };
    let arrangement = arrange(&bodies.positions, &bodies.triangles, operand_of, &options, &budget).unwrap();
    let points = arrangement.clusters.iter().flat_map(|cluster| &cluster.points);
    let crossings = points.filter(|point| matches!(point.definition, Definition::Planes(_))).count() as u64;
    assert!(crossings > 300, "{crossings} crossings");
    let peak = budget.bytes_peak();
    assert!(peak > crossings * BYTES_OF_CROSSING, "{peak} bytes for {crossings} crossings");
    let few = ArrangementOptions { crossings_max: crossings as usize, ..options };
    let refused = arrange(&bodies.positions, &bodies.triangles, operand_of, &few, &budget).map(|_| ());
    assert_eq!(refused, Err(ArrangementError::TooManyCrossings { limit: crossings }));
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
    let pairs = ArrangementOptions { pairs_max: 3, operands: 2, ..ArrangementOptions::default() };
    let run = |bodies: &Bodies, options: &ArrangementOptions, budget: &Budget| {
        let operand_of = |t: u32| bodies.operands[t as usize];
        arrange(&bodies.positions, &bodies.triangles, operand_of, options, budget).map(|_| ())
    };
    let unlimited = Budget::unlimited();
    assert!(matches!(run(&open, &pairs, &unlimited), Err(ArrangementError::TooManyPairs { limit: 3, .. })));
    let stop = StopFlag::default();
    let stopped = Budget::new(stop.clone(), u64::MAX, u64::MAX);
    stop.cancel();
    let cancelled = Err(ArrangementError::Stopped(Stopped::Cancelled));
    assert_eq!(run(&open, &ArrangementOptions::default(), &stopped), cancelled);
    let little = Budget::new(StopFlag::default(), 100, u64::MAX);
    assert!(matches!(
        run(&open, &ArrangementOptions::default(), &little),
        Err(ArrangementError::Stopped(Stopped::Work { .. }))
    ));
    open.triangles.pop();
    assert!(matches!(
        run(&open, &ArrangementOptions::default(), &unlimited),
        Err(ArrangementError::NotClosed { .. })
    ));
    open.positions[0].x = f64::NAN;
    assert!(matches!(
        run(&open, &ArrangementOptions::default(), &unlimited),
        Err(ArrangementError::NotFinite { .. })
    ));
}

#[test]
fn integers_are_as_wide_as_the_analysis_says() {
    use super::ball::Ball;
    use super::kernel::ClusterKernel;
    use super::point::{ArrangementPoint, Definition};
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
        let kernel = ClusterKernel::new(positions, vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]]);
        // Differences to the origin have one bit more.
        let b = u64::from(kernel.bits()) + 1;
        let width = |definition| {
            let point = ArrangementPoint { definition, near: [Ball::UNKNOWN; 3], exact: OnceLock::new() };
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

#[test]
fn merged_boundaries_have_the_same_volume_and_meet_nowhere_else() {
    let count = cases(1_000, 30_000) as usize;
    par::map_ranges(count, 16, |range| {
        for seed in range {
            let bodies = cases::random(&mut Random::new(seed as u64 + 1_000_000));
            let arrangement = arranged(&bodies).unwrap();
            for inside in [|w: &[i32]| w[0] + w[1] > 0, |w: &[i32]| w[0] > 0 && w[1] <= 0] {
                let boundary = arrangement.boundary(inside);
                let merged = arrangement.merged(&boundary, &Budget::unlimited()).unwrap();
                let broken = oracle::breaches_of_merged(&arrangement, &boundary, &merged);
                assert!(broken.is_empty(), "seed {seed}: {broken:?}\n{bodies:?}");
            }
        }
    });
}

#[test]
fn what_nothing_passes_through_any_more_is_whole_again() {
    // A small cube that sticks out of the top of a large one, and one that is inside and touches the bottom.
    let mut bodies = Bodies::default();
    bodies.add(cube([0, 0, 0], [8, 8, 8], 0), 0);
    bodies.add(cube([3, 2, 6], [5, 4, 10], 0), 0);
    bodies.add(cube([3, 2, 0], [4, 3, 1], 0), 0);
    let arrangement = arranged(&bodies).unwrap();
    let boundary = arrangement.boundary(|w| w[0] > 0);
    let merged = arrangement.merged(&boundary, &Budget::unlimited()).unwrap();
    let whole = |source: u32| merged.sources.iter().zip(&merged.is_whole).any(|(&s, &is)| s == source && is);
    // All of the large cube but its top, and the top of the small one.
    assert!([0, 1, 4, 5, 6, 7, 8, 9, 10, 11, 14, 15].into_iter().all(whole), "{merged:?}");
    assert!((2..4).chain(24..36).all(|source| !whole(source)));
    let pitch = 2f64.powi(-20);
    let placed = super::place(&arrangement, merged, pitch, &Budget::unlimited()).unwrap();
    assert_eq!((placed.conflicts, placed.move_max), (0, 0.0));
}

/// Pairs of all triangles that meet, and triangles without an area.
fn conflicts(PlacedBoundary { positions, triangles, .. }: &PlacedBoundary) -> u64 {
    let budget = Budget::unlimited();
    let has_area = |&t: &u32| {
        let [a, b, c] = triangles[t as usize].map(|p| positions[p as usize]);
        !are_collinear(a, b, c)
    };
    let (sound, flat): (Vec<u32>, Vec<u32>) = (0..triangles.len() as u32).partition(has_area);
    let bvh = Bvh::build(positions, triangles, Some(&sound), &budget).unwrap();
    let search = Search::All { keep: 0 };
    self_contacts(positions, triangles, &bvh, None, search, &budget).unwrap().count + flat.len() as u64
}

#[test]
fn placed_boundaries_are_on_the_lattice_and_conflicts_are_counted() {
    let (mut clean, mut all, mut most) = (0, 0, 0);
    for seed in 0..cases(40, 1_000) {
        let mut bodies = cases::crowd(&mut Random::new(seed), 6);
        for p in &mut bodies.positions {
            *p *= 0.125;
        }
        let arrangement = arranged(&bodies).unwrap();
        let boundary = arrangement.boundary(|w| w[0] > 0 || w[1] > 0);
        let merged = arrangement.merged(&boundary, &Budget::unlimited()).unwrap();
        // On the coarsest, what is left of bodies that are a few steps large meets itself in places.
        for pitch in [2f64.powi(-19), 2f64.powi(-5), 2f64.powi(-3), 2f64.powi(-1)] {
            let placed = super::place(&arrangement, merged.clone(), pitch, &Budget::unlimited()).unwrap();
            assert_eq!(placed.triangles.len(), placed.sources.len());
            assert!(placed.move_max <= pitch * 3.0, "{} of {pitch}", placed.move_max);
            for &p in placed.triangles.as_flattened() {
                let (place, is_new) = (placed.positions[p as usize], p as usize >= bodies.positions.len());
                assert!((place / pitch).round() * pitch == place || !is_new && pitch > 0.125);
            }
            let conflicts = conflicts(&placed);
            assert_eq!(placed.conflicts, conflicts, "{seed}");
            most = most.max(conflicts);
            if pitch < 1e-3 {
                all += 1;
                clean += u32::from(placed.conflicts == 0);
            }
        }
    }
    assert!(clean * 20 >= all * 19, "{clean} of {all} without conflicts");
    assert!(most > 0);
}

#[test]
fn a_plane_with_two_names_is_no_line() {
    use super::kernel::ClusterKernel;
    use super::point::Definition::EdgePlane;
    use super::triangulation::CarrierView;
    // Two triangles side by side in the plane z = 0, and three edges through it, whose points there are named by the second one.
    let mut positions: Vec<DVec3> = [[0, 0, 0], [9, 0, 0], [0, 9, 0], [30, 0, 0], [39, 0, 0], [30, 9, 0]]
        .map(|p: [i32; 3]| DVec3::from_array(p.map(f64::from)))
        .to_vec();
    let mut triangles = vec![[0, 1, 2], [3, 4, 5]];
    for [x, y] in [[1.0, 1.0], [2.0, 1.0], [1.0, 1.0 + f64::EPSILON]] {
        let first = positions.len() as u32;
        positions.extend([DVec3::new(x, y, -1.0), DVec3::new(x, y, 1.0), DVec3::new(50.0, 50.0, 1.0)]);
        triangles.push([first, first + 1, first + 2]);
    }
    let kernel = ClusterKernel::new(positions, triangles);
    let point = |first: u32| kernel.point(EdgePlane { edge: [first, first + 1], plane: 1 });
    let view = kernel.view(0).unwrap();
    let [a, b, c] = [6, 9, 12].map(point);
    let sight = CarrierView::new(&kernel, view, &[]);
    assert_eq!(sight.orient(&a, &b, &c), Sign::Positive);
    assert!(sight.take_units() > 1, "decided by balls");
}

#[test]
fn names_say_collinear_only_of_points_on_one_line() {
    use super::point::Definition::{self, EdgePlane, Planes, Vertex};
    let is = |points: [Definition; 3]| Definition::are_collinear(points.each_ref(), |plane| plane != 0);
    assert!(is([Planes([0, 1, 2]), Planes([0, 2, 3]), Planes([0, 2, 5])]));
    assert!(!is([Planes([0, 1, 2]), Planes([0, 2, 3]), Planes([0, 1, 3])]));
    assert!(is([Planes([0, 1, 2]), EdgePlane { edge: [4, 5], plane: 2 }, Planes([0, 2, 5])]));
    let on_edge = |plane| EdgePlane { edge: [4, 5], plane };
    assert!(is([Vertex(4), on_edge(1), on_edge(2)]));
    assert!(is([Vertex(4), on_edge(1), Vertex(5)]));
    assert!(!is([Vertex(4), on_edge(1), Vertex(6)]));
    // The plane that all of them are in says nothing.
    assert!(!is([on_edge(0), EdgePlane { edge: [6, 7], plane: 0 }, Planes([0, 1, 2])]));
}
