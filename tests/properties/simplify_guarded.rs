//! Guarded simplification of a certified solid gives a certified solid with the same shells.

use crate::certificate_soups::verify;
use crate::oracle::RawSoup;
use crate::random::Random;
use crate::solids::{any_solid, cuboid, ring, star, tetrahedron};
use crate::support::{cases, on_all_cores};
use meshmend::budget::Budget;
use meshmend::certificate::{Certificate, Depth};
use meshmend::formats::Encoding;
use meshmend::geom::{DVec3, upward_crossing};
use meshmend::mesh::UnionFind;
use meshmend::simplify::{
    CriterionKind, Guards, Placement, Simplified, SimplifyInput, SimplifyOptions, Target, simplify_fast,
    simplify_guarded,
};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU32, Ordering};

/// Every triangle in four, by the middles of its edges: the same surface.
fn refined(soup: &RawSoup) -> RawSoup {
    let mut fine = RawSoup { positions: soup.positions.clone(), triangles: Vec::new() };
    let mut middles = BTreeMap::new();
    for &[a, b, c] in &soup.triangles {
        let mut middle = |u: u32, v: u32| {
            *middles.entry((u.min(v), u.max(v))).or_insert_with(|| {
                let (p, q) = (soup.positions[u as usize], soup.positions[v as usize]);
                fine.positions.push(std::array::from_fn(|k| (p[k] + q[k]) / 2.0));
                fine.positions.len() as u32 - 1
            })
        };
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        fine.triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    fine
}

fn refined_times(soup: RawSoup, times: usize) -> RawSoup {
    (0..times).fold(soup, |soup, _| refined(&soup))
}

/// A sphere of refined octahedron faces with bumps, seen from the middle without folds.
fn ball(random: &mut Random, times: usize, radius: f64, bump: f64) -> RawSoup {
    let octahedron = RawSoup {
        positions: (0..6)
            .map(|i| std::array::from_fn(|k| if k != i / 2 { 0.0 } else { 1.0 - 2.0 * (i % 2) as f64 }))
            .collect(),
        triangles: vec![
            [0, 2, 4],
            [2, 1, 4],
            [1, 3, 4],
            [3, 0, 4],
            [2, 0, 5],
            [1, 2, 5],
            [3, 1, 5],
            [0, 3, 5],
        ],
    };
    let mut ball = refined_times(octahedron, times);
    for p in &mut ball.positions {
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        let r = radius * (1.0 + bump * (random.unit() - 0.5));
        *p = p.map(|x| f64::from((x / length * r) as f32));
    }
    ball
}

/// A plate of `thickness`, bent: its two sides run close to each other.
fn bent_plate(random: &mut Random, thickness: f64) -> RawSoup {
    let bend = random.unit() + 0.2;
    refined_times(cuboid([1.0, 1.0, thickness]), 3).map(|[x, y, z]| {
        let lift = bend * (x * (1.0 - x) + y * y * (1.0 - y));
        [x, y, f64::from((z + lift) as f32)]
    })
}

/// A star and, just inside of it, its copy: a thin wall around a cavity, sometimes with a core and a neighbour.
fn thin_walled(random: &mut Random) -> RawSoup {
    let radii: Vec<f64> = (0..32).map(|_| 0.5 + random.unit()).collect();
    let shell = || {
        let mut radii = radii.iter().copied().cycle();
        star(&mut || radii.next().unwrap_or(1.0))
    };
    let thickness = random.pick(&[0.3, 0.1, 0.03]);
    let mut soup = shell().with(&shell().scaled(1.0 - thickness).inside_out());
    if random.one_in(2) {
        soup = soup.with(&shell().scaled(0.5));
    }
    if random.one_in(2) {
        soup = soup.with(&shell().scaled(0.4).moved([1.1, 0.9, 0.2]));
    }
    soup.map(|p| p.map(|x| f64::from(x as f32)))
}

/// A thin plate with a dent upward in its middle, and a pebble below the dent: above the height of the plate's rim, so
/// that a plate without the dent would have it on the other side. The pebble's first vertex comes last.
fn dented_plate(random: &mut Random) -> RawSoup {
    let n = 8 + random.below(10) as u32;
    let (height, width) = (0.1 + 0.5 * random.unit(), 0.15 + 0.3 * random.unit());
    let thickness = random.pick(&[1.0 / 16.0, 1.0 / 64.0, 1.0 / 256.0]);
    let at = |i: u32, j: u32, lift: f64| {
        let [x, y] = [i, j].map(|k| 2.0 * f64::from(k) / f64::from(n) - 1.0);
        let dent = height * (-(x * x + y * y) / (width * width)).exp();
        [x, y, lift + dent].map(|x| f64::from(x as f32))
    };
    let id = |side: u32, i: u32, j: u32| (side * (n + 1) + i) * (n + 1) + j;
    let mut plate = RawSoup::default();
    for (lift, (i, j)) in [0.0, thickness]
        .into_iter()
        .flat_map(|lift| (0..=n).flat_map(move |i| (0..=n).map(move |j| (lift, (i, j)))))
    {
        plate.positions.push(at(i, j, lift));
    }
    let mut add = |[a, b, c, d]: [u32; 4]| plate.triangles.extend([[a, b, c], [a, c, d]]);
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let square = |side| [id(side, i, j), id(side, i + 1, j), id(side, i + 1, j + 1), id(side, i, j + 1)];
        add(square(1));
        let [a, b, c, d] = square(0);
        add([d, c, b, a]);
    }
    for k in 0..n {
        for [from, to] in [
            [(k, 0), (k + 1, 0)],
            [(n, k), (n, k + 1)],
            [(n - k, n), (n - k - 1, n)],
            [(0, n - k), (0, n - k - 1)],
        ] {
            add([id(0, from.0, from.1), id(0, to.0, to.1), id(1, to.0, to.1), id(1, from.0, from.1)]);
        }
    }
    let size = 1.0 / 128.0;
    let below = (thickness + height) * 0.5;
    let pebble = tetrahedron().map(|p| p.map(|x| 1.0 - x)).inside_out().scaled(size);
    plate.with(&pebble.moved([0.01, 0.02, below]).map(|p| p.map(|x| f64::from(x as f32))))
}

/// One of many solids of some hundred triangles in which a careless collapse goes wrong.
fn any_delicate_solid(random: &mut Random) -> RawSoup {
    match random.below(8) {
        // A shell with a thin wall.
        0 => {
            let gap = random.pick(&[0.02, 0.05, 0.1]);
            ball(random, 3, 1.0, 0.0).with(&ball(random, 3, 1.0 - gap, 0.0).inside_out())
        }
        // Pebbles close to a ball, outside or in bubbles inside.
        1 => {
            let height = random.pick(&[1.01, 1.03, 0.9]);
            let count = 1 + random.below(12);
            (0..count).fold(ball(random, 3, 1.0, 0.0), |soup, _| {
                let to = DVec3::new(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5);
                let at = (to.normalize() * height).to_array().map(|x| f64::from(x as f32));
                let size = random.pick(&[1.0 / 64.0, 1.0 / 256.0]);
                let pebble = tetrahedron().scaled(if height > 1.0 { size } else { -size });
                soup.with(&pebble.moved(at))
            })
        }
        2 => bent_plate(random, 1.0 / 16.0),
        3 => bent_plate(random, 1.0 / 128.0),
        4 => ball(random, 3, 1.0, 0.3),
        5 => refined_times(ring(), 1),
        6 => thin_walled(random),
        _ => refined_times(any_solid(random), 2),
    }
}

/// Moves every coordinate off the float32 numbers.
fn off_float32(random: &mut Random, soup: RawSoup) -> RawSoup {
    let factor = 1.0 + random.unit() * 2f64.powi(-20);
    soup.map(|p| p.map(|x| x * factor + 2f64.powi(-40)))
}

fn options(random: &mut Random) -> SimplifyOptions<'static> {
    SimplifyOptions {
        targets: [0.5, 0.2, 0.05].map(Target::Ratio).to_vec(),
        criterion: random.pick(&[
            CriterionKind::Quadric,
            CriterionKind::Quadric,
            CriterionKind::Memoryless,
            CriterionKind::Length,
        ]),
        placement: random.pick(&[Placement::Optimal, Placement::Optimal, Placement::OntoEnd]),
        guards: Guards {
            normal_cos_min: random.pick(&[0.2, -1.0]),
            aspect_min: random.pick(&[1e-3, 0.0]),
            envelope: None,
        },
        round: !random.one_in(4),
        ..SimplifyOptions::default()
    }
}

fn certified(positions: &[DVec3], triangles: &[[u32; 3]], is_float32: bool) -> Certificate {
    let soup =
        RawSoup { positions: positions.iter().map(DVec3::to_array).collect(), triangles: triangles.to_vec() };
    // Binary PLY has doubles, so it is read in two ways; binary STL is welded.
    let encoding = if is_float32 { Encoding::StlBinary } else { Encoding::PlyBinaryLittleEndian };
    verify(&soup, encoding, Depth::Count { samples: 2 })
}

fn shells(certificate: &Certificate) -> Vec<(u32, u32, bool)> {
    let mut shells: Vec<_> =
        certificate.shells.iter().map(|shell| (shell.depth, shell.genus, shell.volume > 0.0)).collect();
    shells.sort_unstable();
    shells
}

fn is_valid(certificate: &Certificate) -> bool {
    certificate.violations.contacts == Some(0) && !certificate.shells.is_empty()
}

#[test]
fn certified_solids_stay_certified_and_keep_their_shells() {
    let counts = [const { AtomicU32::new(0) }; 4];
    let [solids, careless, smaller, reached] = &counts;
    on_all_cores(cases(1_200, 40_000), |case| {
        let random = &mut Random::new(case as u64);
        let is_float32 = !random.one_in(4);
        let mut soup = any_delicate_solid(random);
        if !is_float32 {
            soup = off_float32(random, soup);
        }
        let positions: Vec<DVec3> = soup.positions.iter().map(|&p| DVec3::from_array(p)).collect();
        let before = certified(&positions, &soup.triangles, is_float32);
        if !is_valid(&before) {
            return;
        }
        solids.fetch_add(1, Ordering::Relaxed);
        let mut options = options(random);
        options.round |= is_float32;
        let input = SimplifyInput::new(&positions, &soup.triangles);
        let judge = |level: &Simplified| certified(&level.positions, &level.triangles, is_float32);
        for level in simplify_guarded(&input, &options, &Budget::unlimited()).unwrap() {
            let after = judge(&level);
            assert!(is_valid(&after), "{case}: {after:?} {:?}", level.report);
            assert_eq!(shells(&after), shells(&before), "{case}");
            assert_eq!(after.euler_characteristic, before.euler_characteristic, "{case}");
            smaller.fetch_add(u32::from(after.triangles < before.triangles), Ordering::Relaxed);
            reached.fetch_add(u32::from(level.report.is_reached), Ordering::Relaxed);
        }
        let fast = simplify_fast(&input, &options, &Budget::unlimited()).unwrap();
        let went_wrong = |level: &&Simplified| {
            let after = judge(level);
            !is_valid(&after) || shells(&after) != shells(&before)
        };
        careless.fetch_add(fast.iter().filter(went_wrong).count() as u32, Ordering::Relaxed);
    });
    let [solids, careless, smaller, reached] = counts.map(AtomicU32::into_inner);
    assert!(solids > cases(900, 30_000) as u32, "{solids} certified");
    assert!(careless > solids / 4, "the solids are not delicate: {careless} of {solids} went wrong");
    assert!(smaller > solids * 2 && reached > solids, "{smaller} smaller, {reached} reached of {solids}");
}

/// How often the ray upward from `p` crosses the surface.
fn crossings_above(p: DVec3, positions: &[DVec3], triangles: &[[u32; 3]]) -> usize {
    let corners = |t: &[u32; 3]| t.map(|v| positions[v as usize]);
    triangles.iter().filter(|t| upward_crossing(p, corners(t)).is_some()).count()
}

#[test]
fn a_pebble_in_the_dent_of_a_thin_plate_stays_on_its_side() {
    let counts = [const { AtomicU32::new(0) }; 4];
    let [plates, passed, smaller, below] = &counts;
    on_all_cores(cases(400, 20_000), |case| {
        let random = &mut Random::new(case as u64);
        let soup = dented_plate(random);
        let positions: Vec<DVec3> = soup.positions.iter().map(|&p| DVec3::from_array(p)).collect();
        if !is_valid(&certified(&positions, &soup.triangles, true)) {
            return;
        }
        // From the highest vertex of the pebble, the shell of four triangles.
        let above = |positions: &[DVec3], triangles: &[[u32; 3]]| {
            let mut parts = UnionFind::new(positions.len());
            for &[a, b, c] in triangles {
                parts.unite(a, b);
                parts.unite(b, c);
            }
            let parts = parts.into_components();
            let part_of = |t: &[u32; 3]| parts.of[t[0] as usize];
            let mut sizes = vec![0; parts.count as usize];
            triangles.iter().for_each(|t| sizes[part_of(t) as usize] += 1);
            let of_pebble = triangles.iter().filter(|t| sizes[part_of(t) as usize] == 4);
            let pebble = of_pebble.flatten().map(|&v| positions[v as usize]);
            let top = pebble.max_by(|a, b| a.z.total_cmp(&b.z)).unwrap_or_default();
            crossings_above(top + DVec3::Z * 1e-6, positions, triangles)
        };
        // A pebble right below a slope may be beside the dent.
        if above(&positions, &soup.triangles) != 2 {
            return;
        }
        plates.fetch_add(1, Ordering::Relaxed);
        // By length alone a plate folds and shrinks so much that it goes around the pebble.
        let criterion = random.pick(&[CriterionKind::Quadric, CriterionKind::Memoryless]);
        let options = SimplifyOptions { round: true, criterion, ..options(random) };
        let input = SimplifyInput::new(&positions, &soup.triangles);
        for level in simplify_guarded(&input, &options, &Budget::unlimited()).unwrap() {
            assert!(is_valid(&certified(&level.positions, &level.triangles, true)), "{case}");
            // A plate may fold above it, and one that shrinks past it may come to lie below by its rim.
            let is_below = above(&level.positions, &level.triangles) == 0;
            below.fetch_add(u32::from(is_below), Ordering::Relaxed);
            smaller.fetch_add(
                u32::from(level.triangles.len() * 4 < soup.triangles.len() * 3),
                Ordering::Relaxed,
            );
        }
        // What a look at the end alone would let through.
        let went_through = |level: &&Simplified| {
            above(&level.positions, &level.triangles) == 0
                && is_valid(&certified(&level.positions, &level.triangles, true))
        };
        let fast = simplify_fast(&input, &options, &Budget::unlimited()).unwrap();
        passed.fetch_add(u32::from(fast.iter().any(|level| went_through(&level))), Ordering::Relaxed);
    });
    let [plates, passed, smaller, below] = counts.map(AtomicU32::into_inner);
    assert!(plates > cases(100, 5_000) as u32, "{plates} plates");
    assert!(below <= plates / 2_000, "{below} of {plates} plates are below the pebble");
    assert!(passed > 0, "none of {plates} passes in the fast mode");
    assert!(smaller > plates / 2, "{smaller} results are much smaller");
}
