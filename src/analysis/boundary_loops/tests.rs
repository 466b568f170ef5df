//! Loops of small meshes, how they are traced and what they are taken for.

use super::HoleClass;
use crate::analysis::tests::{described, found, joined, polygon, soup, tetrahedron};
use crate::analysis::{DefectCode, Witness};
use crate::geom::DVec3;
use crate::mesh::Soup;

fn loops(mesh: &Soup) -> Vec<(Vec<u32>, bool)> {
    let finding = found(mesh, DefectCode::BoundaryLoop);
    let witnesses = finding.into_iter().flat_map(|f| f.witnesses);
    let figure = |w: &Witness, name| w.figures.iter().find(|f| f.0 == name).unwrap().1;
    witnesses
        .map(|w| (w.vertices.iter().map(|v| v.index).collect(), figure(&w, "is_closed") == 1.0))
        .collect()
}

#[test]
fn a_tetrahedron_without_a_face_has_a_loop_of_three_edges() {
    let open = soup(4, &[[0, 2, 1], [0, 1, 3], [1, 2, 3]]);
    assert_eq!(loops(&open), [(vec![0, 2, 3], true)]);
}

#[test]
fn the_rim_of_a_sheet_is_followed_across_a_face_that_is_turned_over() {
    assert_eq!(loops(&soup(4, &[[0, 1, 2], [0, 3, 2]])), [(vec![0, 1, 2, 3], true)]);
}

#[test]
fn rims_that_touch_in_a_vertex_stay_two() {
    let bow_tie = soup(5, &[[0, 1, 2], [0, 3, 4]]);
    assert_eq!(loops(&bow_tie), [(vec![0, 1, 2], true), (vec![0, 3, 4], true)]);
}

#[test]
fn pages_on_one_spine_are_joined_in_pairs_and_an_odd_one_stays_open() {
    let pages = [[0, 1, 2], [0, 1, 3], [0, 1, 4], [0, 1, 5]];
    assert_eq!(loops(&soup(6, &pages)), [(vec![1, 2, 0, 3], true), (vec![1, 4, 0, 5], true)]);
    assert_eq!(loops(&soup(5, &pages[..3])), [(vec![1, 2, 0, 3], true), (vec![1, 4, 0], false)]);
}

/// The classes of the loops, in their order; `None`: an open chain.
fn classes(mesh: &Soup) -> Vec<Option<HoleClass>> {
    let finding = found(mesh, DefectCode::BoundaryLoop);
    finding.into_iter().flat_map(|f| f.witnesses).map(|w| w.hole.map(|guess| guess.class)).collect()
}

/// A soup of polygons over `points`, split as fans.
fn of_polygons(points: Vec<DVec3>, polygons: &[Vec<u32>]) -> Soup {
    let triangles: Vec<[u32; 3]> = polygons
        .iter()
        .flat_map(|p| (2..p.len()).map(|i| [p[0], p[i - 1], p[i]]).collect::<Vec<_>>())
        .collect();
    Soup { face_count: triangles.len() as u32, positions: points, triangles, ..Soup::default() }
}

/// The mantle of a cone from radius `low` at z = 0 to radius `high` at z = `height` around n corners; the lower end is
/// closed by a fan if `has_floor`.
fn mantle(n: u32, [low, high]: [f64; 2], height: f64, has_floor: bool) -> Soup {
    let ring = |radius: f64, z: f64| {
        (0..n).map(move |i| {
            let angle = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
            DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
        })
    };
    let points: Vec<DVec3> = ring(low, 0.0).chain(ring(high, height)).chain([DVec3::ZERO]).collect();
    let side = |i: u32| vec![i, (i + 1) % n, n + (i + 1) % n, n + i];
    let floor = |i: u32| vec![2 * n, (i + 1) % n, i];
    let polygons: Vec<Vec<u32>> = (0..n).map(side).chain((0..n).filter(|_| has_floor).map(floor)).collect();
    of_polygons(points, &polygons)
}

/// A sphere as a mantle of `n` by `n` quadrangles and two fans, without the polygons for which `is_gone` holds by ring and
/// place in it.
fn sphere(n: u32, is_gone: impl Fn(u32, u32) -> bool) -> Soup {
    let point = |ring: u32, i: u32| {
        let (polar, angle) = (
            f64::from(ring) / f64::from(n) * std::f64::consts::PI,
            f64::from(i) / f64::from(n) * std::f64::consts::TAU,
        );
        DVec3::new(polar.sin() * angle.cos(), polar.sin() * angle.sin(), polar.cos())
    };
    let mut points = vec![DVec3::Z, DVec3::NEG_Z];
    points.extend((1..n).flat_map(|ring| (0..n).map(move |i| point(ring, i))));
    let id = |ring: u32, i: u32| match ring {
        0 => 0,
        ring if ring == n => 1,
        ring => 2 + (ring - 1) * n + i % n,
    };
    let quad = |ring: u32, i: u32| {
        let mut corners = vec![id(ring, i), id(ring + 1, i), id(ring + 1, i + 1), id(ring, i + 1)];
        corners.dedup();
        if corners.first() == corners.last() {
            corners.pop();
        }
        corners
    };
    let polygons: Vec<Vec<u32>> = (0..n)
        .flat_map(|ring| (0..n).map(move |i| (ring, i)))
        .filter(|&(ring, i)| !is_gone(ring, i))
        .map(|(ring, i)| quad(ring, i))
        .collect();
    of_polygons(points, &polygons)
}

#[test]
fn a_missing_triangle_or_quadrangle_is_a_missing_face() {
    let mut open = tetrahedron(DVec3::ZERO, 1.0);
    open.triangles.pop();
    open.face_count -= 1;
    assert_eq!(classes(&open), [Some(HoleClass::MissingFace)]);
    assert_eq!(classes(&sphere(16, |ring, i| (ring, i) == (5, 3))), [Some(HoleClass::MissingFace)]);
    assert_eq!(classes(&sphere(16, |ring, i| (ring, i) == (0, 3))), [Some(HoleClass::MissingFace)]);
}

#[test]
fn a_missing_polygon_is_a_missing_face_where_the_file_has_such_polygons() {
    let flat = mantle(8, [1.0, 0.9], 6.0, true);
    assert_ne!(classes(&flat), [Some(HoleClass::MissingFace)]);
    let octagon: Vec<DVec3> = flat.positions[..8].iter().map(|p| p + DVec3::X * 50.0).collect();
    let mut with_octagon = joined(&[flat]);
    let apart = polygon(&octagon);
    let first = with_octagon.positions.len() as u32;
    with_octagon.positions.extend(&apart.positions);
    let triangle = with_octagon.triangles.len() as u32;
    with_octagon.triangle_face = (0..triangle).chain([triangle; 6]).collect();
    with_octagon.triangles.extend(apart.triangles.iter().map(|t| t.map(|v| v + first)));
    with_octagon.face_count = triangle + 1;
    with_octagon.polygons = apart.polygons;
    with_octagon.polygons.faces = vec![triangle];
    with_octagon.polygons.first_triangles = vec![triangle];
    with_octagon.polygons.corners.iter_mut().for_each(|v| *v += first);
    assert_eq!(classes(&with_octagon), [Some(HoleClass::MissingFace), Some(HoleClass::IntendedOpening)]);
}

#[test]
fn a_hole_across_several_faces_of_a_sphere_is_a_missing_region_and_a_cut_off_cap_is_planar() {
    let region = sphere(24, |ring, i| (6..9).contains(&ring) && (2..6).contains(&i));
    assert_eq!(classes(&region), [Some(HoleClass::MissingRegion)]);
    assert_eq!(classes(&sphere(24, |ring, _| ring < 3)), [Some(HoleClass::PlanarCut)]);
}

#[test]
fn a_vase_and_a_pipe_are_open_on_purpose_and_two_mouths_are_surer_than_one() {
    let confidence = |mesh: &Soup| {
        let finding = found(mesh, DefectCode::BoundaryLoop).unwrap();
        let told = finding.witnesses[0].figures.iter().find(|(name, _)| *name == "confidence");
        told.unwrap().1
    };
    let (vase, pipe) = (mantle(24, [1.0, 1.3], 4.0, true), mantle(24, [1.0, 1.0], 9.0, false));
    assert_eq!(classes(&vase), [Some(HoleClass::IntendedOpening)]);
    assert_eq!(classes(&pipe), [Some(HoleClass::IntendedOpening); 2]);
    assert!(confidence(&pipe) > confidence(&vase));
}

#[test]
fn the_border_of_a_sheet_is_an_opening_and_a_hole_in_it_is_not() {
    let n = 12u32;
    let grid = |is_gone: &dyn Fn(u32, u32) -> bool| {
        let points: Vec<DVec3> = (0..=n)
            .flat_map(|y| (0..=n).map(move |x| (f64::from(x), f64::from(y))))
            .map(|(x, y)| DVec3::new(x, y, 0.1 * (x * y).sin()))
            .collect();
        let id = |x: u32, y: u32| y * (n + 1) + x;
        let cells = (0..n).flat_map(|y| (0..n).map(move |x| (x, y))).filter(|&(x, y)| !is_gone(x, y));
        let quad = |(x, y)| vec![id(x, y), id(x + 1, y), id(x + 1, y + 1), id(x, y + 1)];
        of_polygons(points, &cells.map(quad).collect::<Vec<_>>())
    };
    assert_eq!(classes(&grid(&|_, _| false)), [Some(HoleClass::IntendedOpening)]);
    let holed = grid(&|x, y| (5..7).contains(&x) && (5..7).contains(&y));
    assert_eq!(classes(&holed), [Some(HoleClass::IntendedOpening), Some(HoleClass::MissingRegion)]);
    assert_eq!(classes(&soup(3, &[[0, 1, 2]])), [Some(HoleClass::IntendedOpening)]);
}

#[test]
fn a_slit_is_a_crack_and_so_are_two_halves_that_do_not_quite_meet() {
    // The equator of one half is a thousandth of an edge lower than that of the other.
    let mut halves = sphere(16, |_, _| false);
    let equator: Vec<DVec3> = halves.positions[2 + 7 * 16..2 + 8 * 16].to_vec();
    let first = halves.positions.len() as u32;
    halves.positions.extend(equator.iter().map(|p| p - DVec3::Z * 4e-4));
    let ids = 2 + 7 * 16..2 + 8 * 16u32;
    let is_lower = |t: &[u32; 3]| t.iter().any(|&v| v == 1 || v >= ids.end);
    for t in halves.triangles.iter_mut().filter(|t| is_lower(t)) {
        *t = t.map(|v| if ids.contains(&v) { first + v - ids.start } else { v });
    }
    assert_eq!(classes(&halves), [Some(HoleClass::Crack); 2]);
    // The same with only a part of the equator torn open: one loop.
    let mut slit = halves;
    for t in &mut slit.triangles {
        *t = t.map(|v| {
            if v >= first && !(first + 3..first + 12).contains(&v) { v - first + ids.start } else { v }
        });
    }
    assert_eq!(classes(&slit), [Some(HoleClass::Crack)]);
}

#[test]
fn the_end_of_a_thin_pipe_is_no_crack() {
    // Inner and outer wall are nearer than a tenth of an edge, but their faces are on one side.
    let outer = mantle(12, [1.0, 1.0], 5.0, false);
    let mut inner = mantle(12, [0.99, 0.99], 5.0, false);
    inner.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    let pipe = joined(&[outer, inner]);
    assert!(classes(&pipe).iter().all(|class| *class != Some(HoleClass::Crack)), "{:?}", classes(&pipe));
}

#[test]
fn turning_faces_over_does_not_change_a_class() {
    let meshes = [
        sphere(16, |ring, i| (ring, i) == (5, 3)),
        sphere(24, |ring, i| (6..9).contains(&ring) && (2..6).contains(&i)),
        mantle(24, [1.0, 1.3], 4.0, true),
    ];
    for mesh in meshes {
        let turned = crate::analysis::tests::turned(mesh.clone());
        assert_eq!(classes(&turned), classes(&mesh));
    }
}

#[test]
fn all_loops_are_counted_by_class() {
    let told =
        described(&joined(&[sphere(16, |ring, i| (ring, i) == (5, 3)), mantle(24, [1.0, 1.0], 9.0, false)]));
    assert_eq!((told.holes.missing_faces, told.holes.intended_openings), (1, 2));
    assert_eq!(told.counts.boundary_loops, 3);
}
