//! The wrap as a whole, judged by the certificate.

use super::*;
use crate::certificate::{self, Certificate, Depth};
use crate::formats::{self, Encoding, ReadOptions};
use crate::mesh::Soup;
use crate::spatial::NearestSearch;

pub(super) fn certificate_of(positions: &[DVec3], triangles: &[[u32; 3]]) -> Certificate {
    let soup = Soup {
        positions: positions.to_vec(),
        triangles: triangles.to_vec(),
        face_count: triangles.len() as u32,
        ..Soup::default()
    };
    let budget = Budget::unlimited();
    let bytes = formats::write(&soup, Encoding::StlBinary, &budget).unwrap();
    let options = ReadOptions::default();
    certificate::certify(&bytes, Encoding::StlBinary, &options, Depth::FirstViolation, &budget).unwrap()
}

fn wrapped(positions: &[DVec3], triangles: &[[u32; 3]], cells: u32) -> (Wrapped, Certificate) {
    let options = WrapOptions { cells, ..WrapOptions::default() };
    let wrapped = wrap(positions, triangles, &options, &Budget::unlimited()).unwrap();
    let unfitted = certificate_of(&wrapped.unfitted, &wrapped.triangles);
    assert!(unfitted.is_printable(), "{:?}", unfitted.witnesses);
    let certificate = certificate_of(&wrapped.positions, &wrapped.triangles);
    assert!(certificate.is_printable(), "{:?}", certificate.witnesses);
    (wrapped, certificate)
}

/// Triangles of the box between two corners, outward.
fn cuboid(min: [f64; 3], max: [f64; 3]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let corner =
        |i: usize| DVec3::from_array([0, 1, 2].map(|a| if i >> a & 1 == 1 { max[a] } else { min[a] }));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    (
        (0..8).map(corner).collect(),
        faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
    )
}

fn add(mesh: &mut (Vec<DVec3>, Vec<[u32; 3]>), other: &(Vec<DVec3>, Vec<[u32; 3]>), is_turned: bool) {
    let base = mesh.0.len() as u32;
    mesh.0.extend(&other.0);
    mesh.1.extend(
        other.1.iter().map(|&[a, b, c]| if is_turned { [a, c, b] } else { [a, b, c] }.map(|v| v + base)),
    );
}

#[test]
fn a_box_comes_back_with_its_volume() {
    let (positions, triangles) = cuboid([0.0; 3], [10.0, 8.0, 6.0]);
    let (wrap, certificate) = wrapped(&positions, &triangles, 32);
    assert_eq!(certificate.shells.len(), 1);
    assert!((certificate.shells[0].volume - 480.0).abs() < 0.5, "{:?}", certificate.shells);
    assert!(wrap.account.fit.onto_creases > 100, "{:?}", wrap.account);
    for p in &wrap.positions {
        let beyond = (p.max(DVec3::new(10.0, 8.0, 6.0)) - p.min(DVec3::ZERO)) - DVec3::new(10.0, 8.0, 6.0);
        assert!(beyond.abs().max_element() < 1e-2 * wrap.account.spacing, "{p}");
    }
    assert_eq!((wrap.account.closed_parts, wrap.account.thin_triangles), (1, 0));
}

#[test]
fn a_cavity_stays_and_a_box_inside_out_is_turned() {
    let mut mesh = cuboid([0.0; 3], [10.0; 3]);
    add(&mut mesh, &cuboid([3.0; 3], [7.0; 3]), true);
    for is_turned in [false, true] {
        let mut whole = (Vec::new(), Vec::new());
        add(&mut whole, &mesh, is_turned);
        let (_, certificate) = wrapped(&whole.0, &whole.1, 32);
        assert_eq!(certificate.shells.len(), 2);
        assert_eq!(certificate.shells[1].depth + certificate.shells[0].depth, 1);
    }
}

#[test]
fn boxes_through_each_other_become_one_body() {
    let mut mesh = cuboid([0.0; 3], [10.0, 2.0, 2.0]);
    add(&mut mesh, &cuboid([4.0, -4.0, 0.5], [6.0, 6.0, 1.5]), false);
    let (_, certificate) = wrapped(&mesh.0, &mesh.1, 48);
    assert_eq!(certificate.shells.len(), 1);
    assert!((certificate.shells[0].volume - 56.0).abs() < 2.0, "{:?}", certificate.shells);
}

#[test]
fn a_box_without_a_face_is_closed_and_its_inside_is_solid() {
    let (positions, triangles) = cuboid([0.0; 3], [10.0; 3]);
    let (wrap, certificate) = wrapped(&positions, &triangles[2..], 32);
    assert_eq!((wrap.account.open_parts, wrap.account.sheet_parts), (1, 0));
    assert!(certificate.shells[0].volume > 800.0, "{:?}", certificate.shells);
}

#[test]
fn a_single_triangle_becomes_a_thin_body_behind_it() {
    let positions = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 10.0, 1.0]].map(DVec3::from_array);
    let (wrap, certificate) = wrapped(&positions, &[[0, 1, 2]], 64);
    assert_eq!((wrap.account.open_parts, wrap.account.sheet_parts), (0, 1));
    assert_eq!(certificate.shells.len(), 1);
    let thickness = certificate.shells[0].volume / 50.0 / wrap.account.wall;
    assert!((0.9..1.5).contains(&thickness), "{thickness}");
}

#[test]
fn a_plate_thinner_than_a_cell_is_not_lost() {
    let (positions, triangles) = cuboid([0.0; 3], [10.0, 10.0, 0.05]);
    let (wrap, certificate) = wrapped(&positions, &triangles, 32);
    assert_eq!(wrap.account.thin_triangles, 12);
    assert_eq!(certificate.shells.len(), 1);
    assert_eq!(certificate.shells[0].genus, 0);
}

#[test]
fn thin_plates_keep_their_volume_however_they_lie_in_the_lattice() {
    for (n, share) in [0.125, 0.25, 0.4, 0.6, 0.8, 1.1].into_iter().enumerate() {
        for turn in [0.0, 0.3, 0.7] {
            // A side of 10 has 32 cells.
            let thickness = share * 10.0 / 32.0;
            let (positions, triangles) = cuboid([0.0; 3], [10.0, 8.0, thickness]);
            let turned = glam::DQuat::from_axis_angle(DVec3::new(0.6, 0.48, 0.64), turn + n as f64 * 0.1);
            let positions: Vec<DVec3> = positions.into_iter().map(|p| turned * p).collect();
            let (wrap, certificate) = wrapped(&positions, &triangles, 32);
            assert_eq!((certificate.shells.len(), certificate.shells[0].genus), (1, 0), "{share} {turn}");
            let volume = certificate.shells[0].volume / (80.0 * thickness);
            assert!((0.98..1.02).contains(&volume), "{share} {turn}: {volume} {:?}", wrap.account);
        }
    }
}

#[test]
fn creases_are_where_they_belong_wherever_they_go_through_cells() {
    for n in 0..8 {
        // The second box lies in the lattice of the first one, a little farther each time.
        let mut mesh = cuboid([0.0; 3], [10.0, 4.0, 4.0]);
        let low = [0.0, 6.0, 0.0].map(|x| x + f64::from(n) * 0.037);
        let box_beside = cuboid(low, low.map(|x| x + 3.0));
        add(&mut mesh, &box_beside, false);
        let (wrap, _) = wrapped(&mesh.0, &mesh.1, 32);
        let search = NearestSearch::build(&wrap.positions, &wrap.triangles, &Budget::unlimited()).unwrap();
        let (mut far, mut all) = (0, 0);
        for (a, b) in (0..8).flat_map(|a| [1, 2, 4].map(|bit| (a, a | bit))).filter(|(a, b)| a != b) {
            for k in 0..60 {
                let place = box_beside.0[a].lerp(box_beside.0[b], (f64::from(k) + 0.5) / 60.0);
                let nearest = search.find(place, None, &Budget::unlimited()).unwrap().unwrap();
                all += 1;
                far += u32::from(nearest.distance > 0.05 * wrap.account.spacing);
            }
        }
        assert!(far * 50 <= all, "{n}: {far} of {all}");
    }
}

/// A linear congruential generator (Knuth's multiplier): signs need no better.
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }
}

#[test]
fn sheets_back_to_back_are_not_lost() {
    let at = |z: f64| [[0.0, 0.0, z], [10.0, 0.0, z], [0.0, 10.0, z]].map(DVec3::from_array);
    let positions = [at(0.0), at(1e-4)].concat();
    let (_, certificate) = wrapped(&positions, &[[0, 2, 1], [3, 4, 5]], 32);
    assert_eq!(certificate.shells.len(), 1);
    let (_, certificate) = wrapped(&positions, &[[0, 1, 2], [3, 5, 4]], 32);
    assert_eq!(certificate.shells.len(), 1);
}

/// A Moebius band of width 4 around a circle of radius 10, turned around an axis through its center.
fn moebius(turn: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    const AROUND: u32 = 40;
    let place = |n: u32, side: f64| {
        let angle = f64::from(n) * std::f64::consts::TAU / f64::from(AROUND);
        let (half_sine, half_cosine) = (angle / 2.0).sin_cos();
        let radius = 10.0 + side * half_cosine;
        let (sine, cosine) = angle.sin_cos();
        let flat = DVec3::new(radius * cosine, radius * sine, side * half_sine);
        let (s, c) = turn.sin_cos();
        DVec3::new(flat.x, flat.y * c - flat.z * s, flat.y * s + flat.z * c)
    };
    let positions = (0..AROUND).flat_map(|n| [place(n, -2.0), place(n, 2.0)]).collect();
    let triangles = (0..AROUND).flat_map(|n| {
        let [a, b] = [2 * n, 2 * n + 1];
        // The last quad joins the sides crosswise.
        let [c, d] = if n + 1 == AROUND { [1, 0] } else { [a + 2, b + 2] };
        [[a, c, d], [a, d, b]]
    });
    (positions, triangles.collect())
}

#[test]
fn a_moebius_band_has_one_handle_however_it_lies_in_the_lattice() {
    for n in 0..12 {
        let (positions, triangles) = moebius(f64::from(n) * 0.13);
        let (wrap, certificate) = wrapped(&positions, &triangles, 36 + 3 * n);
        let genera: Vec<u32> = certificate.shells.iter().map(|shell| shell.genus).collect();
        assert_eq!((wrap.account.sheet_parts, genera), (1, vec![1]), "{n}");
    }
}

#[test]
fn triangles_over_each_other_that_face_both_ways_make_few_handles() {
    // A square whose corners are taken crosswise, beside a box.
    let mut mesh = cuboid([0.0; 3], [10.0; 3]);
    let corners = [[20.0, 0.0, 5.3], [30.0, 0.0, 5.0], [30.0, 10.0, 5.1], [20.0, 10.0, 5.4]];
    let sheet = (corners.map(DVec3::from_array).to_vec(), vec![[0, 1, 3], [0, 3, 2]]);
    add(&mut mesh, &sheet, false);
    let genera = [24, 48, 64].map(|cells| {
        let (_, certificate) = wrapped(&mesh.0, &mesh.1, cells);
        let genera: Vec<u32> = certificate.shells.iter().map(|shell| shell.genus).collect();
        assert_eq!((genera.len(), genera[0]), (2, 0), "{cells}");
        genera[1]
    });
    // Where their walls change sides some tunnels wider than a vertex stay.
    assert!(genera.iter().all(|&genus| genus <= 3), "{genera:?}");
}

/// A random field that is outside at the border.
fn random_signs<'l>(lattice: &'l Lattice, random: &mut Random, share: u64) -> Signs<'l> {
    let is_within = |n: usize| (0..3).all(|a| (1..lattice.dims[a] - 1).contains(&lattice.coordinates(n)[a]));
    let field: Vec<bool> = (0..lattice.len()).map(|n| is_within(n) && random.below(10) < share).collect();
    Signs::of_field(lattice, &field)
}

/// Of the surface between the signs.
fn shells_and_handles(lattice: &Lattice, signs: &Signs<'_>) -> (u32, i64) {
    let patches = tetrahedra::march(lattice, signs, &Budget::unlimited()).unwrap();
    let mut sets = crate::mesh::UnionFind::new(patches.edges.len());
    for &[a, b, c] in &patches.triangles {
        sets.unite(a, b);
        sets.unite(b, c);
    }
    for &[a, b, c, d] in &patches.quads {
        sets.unite(a, b);
        sets.unite(b, c);
        sets.unite(c, d);
    }
    let shells = sets.into_components().count;
    let triangles = patches.triangles.len() + 2 * patches.quads.len();
    (shells, i64::from(shells) - (patches.edges.len() as i64 - triangles as i64 / 2) / 2)
}

#[test]
fn handles_go_and_nothing_else_changes() {
    let bounds = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let lattice = Lattice::around(bounds, 6, usize::MAX).unwrap();
    let (mut random, mut closed, mut cut) = (Random(5), 0, 0);
    for round in 0..200 {
        let mut signs = random_signs(&lattice, &mut random, 1 + round % 9);
        let (shells, handles) = shells_and_handles(&lattice, &signs);
        let [tunnels, bridges] = signs.drop_handles(&Budget::unlimited()).unwrap();
        let (shells_after, handles_after) = shells_and_handles(&lattice, &signs);
        assert_eq!(shells_after, shells, "{round}");
        let fewer = handles - handles_after;
        assert!(fewer >= i64::from(tunnels + bridges) && handles_after >= 0, "{round}: {fewer}");
        assert!(fewer == 0 || tunnels + bridges > 0, "{round}");
        (closed, cut) = (closed + tunnels, cut + bridges);
    }
    assert!(closed > 1000 && cut > 1000, "{closed} {cut}");
}

#[test]
fn crumbs_and_bubbles_go_unless_they_are_all_there_is_or_deep_inside() {
    let bounds = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let lattice = Lattice::around(bounds, 16, usize::MAX).unwrap();
    let none = InputSurface::new(winding::Shells::default(), &Budget::unlimited()).unwrap();
    // The faces of a block but the one toward greater z, where there is a way out.
    let (low, high) = (DVec3::splat(3.5), DVec3::splat(17.5));
    let corner =
        |n: usize| DVec3::from_array([0, 1, 2].map(|a| if n >> a & 1 == 1 { high[a] } else { low[a] }));
    let quads = [[0, 2, 3, 1], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let closed: Vec<[DVec3; 3]> =
        quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(corner)).collect();
    let shells = winding::Shells { closed_part: vec![0; closed.len()], closed, ..Default::default() };
    let faces = InputSurface::new(shells, &Budget::unlimited()).unwrap();
    // The block with bubbles behind one layer, behind two, far from everything outside, and behind two layers and no face; and a
    // crumb beside it.
    let is_inside = |n: usize| {
        let at = lattice.coordinates(n);
        let is_in_block = at.iter().all(|x| (4..18).contains(x));
        let is_bubble = [[6, 9, 9], [6, 9, 10], [11, 11, 11], [16, 14, 14], [8, 8, 15]].contains(&at);
        is_in_block && !is_bubble || [[20, 9, 9], [20, 10, 9]].contains(&at)
    };
    let field: Vec<bool> = (0..lattice.len()).map(is_inside).collect();
    let mut signs = Signs::of_field(&lattice, &field);
    let budget = Budget::unlimited();
    assert_eq!(shells_and_handles(&lattice, &signs), (6, 0));
    assert_eq!(signs.drop_crumbs(&none, &budget), Ok(1));
    assert_eq!(signs.clear_bubbles(&faces, &budget), Ok([2, 1]));
    assert_eq!(shells_and_handles(&lattice, &signs), (2, 0));
    let is_inside = |at| signs.is_inside(lattice.index(at));
    assert!(is_inside([6, 9, 9]) && !is_inside([11, 11, 11]) && !is_inside([17, 14, 14]));
    assert!(!is_inside([8, 8, 15]) && !is_inside([8, 8, 16]) && !is_inside([8, 8, 17]));
    // What is alone stays.
    let alone: Vec<bool> = (0..lattice.len()).map(|n| lattice.coordinates(n) == [9, 9, 9]).collect();
    let mut signs = Signs::of_field(&lattice, &alone);
    assert_eq!(signs.drop_crumbs(&none, &budget), Ok(0));
}

#[test]
fn any_signs_give_a_surface_that_is_certified() {
    let bounds = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let lattice = Lattice::around(bounds, 4, usize::MAX).unwrap();
    let mut random = Random(3);
    // Every pattern of two cubes side by side in the middle, the rest outside: how cubes are cut does not depend on the
    // order of the axes, so that one side is enough. Then random fields.
    for round in 1..4096 + 60 {
        let inside = |index: usize| {
            let [i, j, k] = lattice.coordinates(index).map(|n| n.wrapping_sub(5));
            i < 3 && j < 2 && k < 2 && round >> (4 * i + 2 * j + k) & 1 == 1
        };
        let signs = if round < 4096 {
            Signs::of_field(&lattice, &(0..lattice.len()).map(inside).collect::<Vec<bool>>())
        } else {
            let share = random.below(9) + 1;
            random_signs(&lattice, &mut random, share)
        };
        let patches = tetrahedra::march(&lattice, &signs, &Budget::unlimited()).unwrap();
        let (least, most) =
            (1u64 << lattice.steps_log2 >> 3, (1u64 << lattice.steps_log2) - (1 << lattice.steps_log2 >> 3));
        let cuts: Vec<LatticeCut> = patches
            .edges
            .iter()
            .map(|_| {
                let steps = match round % 3 {
                    0 => [least, most][random.below(2) as usize],
                    _ => least + random.below(most - least + 1),
                };
                LatticeCut {
                    steps: steps as u16,
                    point: DVec3::ZERO,
                    triangle: cut::NONE,
                    why: signs::Inside::Wound,
                }
            })
            .collect();
        let positions = places(&lattice, &patches, &cuts);
        let triangles = triangulate(&patches, &positions, &Budget::unlimited()).unwrap();
        let certificate = certificate_of(&positions, &triangles);
        assert!(certificate.is_printable(), "{round}: {:?}", certificate.witnesses);
    }
}

#[test]
fn a_wrap_is_the_same_with_1_2_and_8_threads_and_ends_when_it_is_cancelled() {
    let mut mesh = cuboid([0.0; 3], [10.0; 3]);
    let whole = mesh.clone();
    mesh.1.truncate(9);
    add(&mut mesh, &whole, true);
    let (positions, triangles) = mesh;
    let options = WrapOptions { cells: 24, ..WrapOptions::default() };
    let run = || wrap(&positions, &triangles, &options, &Budget::unlimited());
    let [one, two, eight] = [1, 2, 8].map(|threads| crate::par::with_threads(threads, run));
    assert!(one == two && one == eight && one.is_ok());
    let stop = crate::budget::StopFlag::default();
    stop.cancel();
    let cancelled = wrap(&positions, &triangles, &options, &Budget::new(stop, u64::MAX, u64::MAX));
    assert_eq!(cancelled, Err(WrapError::Stopped(Stopped::Cancelled)));
}
