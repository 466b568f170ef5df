//! The wrap as a whole, judged by the certificate.

use super::*;
use crate::certificate::{self, Certificate, Depth};
use crate::formats::{self, Encoding, ReadOptions};
use crate::mesh::Soup;

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

/// A linear congruential generator (Knuth's multiplier): signs need no better.
struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
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
        let field: Vec<bool> = if round < 4096 {
            (0..lattice.len()).map(inside).collect()
        } else {
            let share = random.below(9) + 1;
            let is_within =
                |n: usize| (0..3).all(|a| (1..lattice.dims[a] - 1).contains(&lattice.coordinates(n)[a]));
            (0..lattice.len()).map(|n| is_within(n) && random.below(10) < share).collect()
        };
        let signs = Signs::of_field(&lattice, &field);
        let patches = tetrahedra::march(&lattice, &signs, &Budget::unlimited()).unwrap();
        let (least, most) =
            (1u64 << lattice.steps_log2 >> 3, (1u64 << lattice.steps_log2) - (1 << lattice.steps_log2 >> 3));
        let cuts: Vec<Cut> = patches
            .edges
            .iter()
            .map(|_| {
                let steps = match round % 3 {
                    0 => [least, most][random.below(2) as usize],
                    _ => least + random.below(most - least + 1),
                };
                Cut {
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
