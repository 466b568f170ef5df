//! Holes of known shapes filled by every method, judged by all pairs in rational arithmetic.

use crate::closed_meshes::{can, cut, fine_box, round_torus, sphere};
use crate::oracle::{RawSoup, judge_welded};
use crate::solids::voxels;
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::implicit::Kernel;
use meshmend::mesh::Soup;
use meshmend::repair::fill::{Extract, FillOptions, FillReport, HoleReport, Method, fill};
use meshmend::repair::{Draft, Selection};
use std::collections::BTreeMap;

const METHODS: [Method; 6] =
    [Method::Auto, Method::Flat, Method::Minimal, Method::Smooth, Method::Creased, Method::Rbf];

/// A flat sheet of 2 n n triangles from -1 to 1, lifted by `height`.
fn sheet(n: u32, height: impl Fn(f64, f64) -> f64) -> RawSoup {
    let at = |i: u32| f64::from(2 * i) / f64::from(n) - 1.0;
    let vertex = |i: u32, k: u32| i * (n + 1) + k;
    let nodes = (0..(n + 1) * (n + 1)).map(|i| (at(i / (n + 1)), at(i % (n + 1))));
    let cells = (0..n * n).map(|i| (i / n, i % n));
    RawSoup {
        positions: nodes.map(|(x, y)| [x, y, height(x, y)].map(|c| f64::from(c as f32))).collect(),
        triangles: cells
            .flat_map(|(i, k)| {
                let [a, b, c, d] = [vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1), vertex(i, k + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect(),
    }
}

fn as_soup(raw: &RawSoup) -> Soup {
    Soup {
        positions: raw.positions.iter().copied().map(DVec3::from_array).collect(),
        triangles: raw.triangles.clone(),
        face_count: raw.triangles.len() as u32,
        is_f32_exact: true,
        ..Soup::default()
    }
}

fn filled(raw: &RawSoup, method: Method) -> (Draft, FillReport) {
    filled_as(raw, &FillOptions { method, ..FillOptions::default() })
}

fn filled_as(raw: &RawSoup, options: &FillOptions) -> (Draft, FillReport) {
    let soup = as_soup(raw);
    let (mut draft, _) = Draft::from_soup(&soup);
    let before = draft.clone();
    let filled = fill(&mut draft, &soup, options, &Budget::unlimited()).unwrap();
    assert_eq!(draft.check(), Vec::<String>::new());
    assert_eq!(draft.triangles[..before.triangles.len()], before.triangles, "no triangle changes");
    assert_eq!(draft.positions[..before.positions.len()], before.positions, "no vertex moves");
    let is_f32 = |p: &DVec3| p.as_vec3().as_dvec3() == *p;
    assert!(draft.positions[before.positions.len()..].iter().all(is_f32), "new vertices are float32");
    (draft, filled)
}

fn raw(draft: &Draft) -> RawSoup {
    RawSoup {
        positions: draft.positions.iter().map(DVec3::to_array).collect(),
        triangles: draft.triangles.clone(),
    }
}

/// The corners of all triangles of patches, and points between them.
fn patch_points(draft: &Draft, before: &RawSoup) -> Vec<DVec3> {
    (before.triangles.len()..draft.triangles.len())
        .flat_map(|t| {
            let [a, b, c] = draft.corners(t);
            [a, b, c, (a + b + c) / 3.0, (a + b) / 2.0]
        })
        .collect()
}

fn largest(points: &[DVec3], distance: impl Fn(DVec3) -> f64) -> f64 {
    points.iter().map(|&p| distance(p).abs()).fold(0.0, f64::max)
}

#[test]
fn a_hole_in_a_plane_is_filled_in_the_plane() {
    let torn = cut(sheet(10, |_, _| 0.25), [0.1, 0.0, 0.25], 0.45);
    // The outer rim of a sheet is a hole as well, and closing both would be a double skin; it is kept.
    let inner = [-0.5, 0.0];
    for method in METHODS {
        let (draft, report) = filled_as(&torn, &only_near(&torn, method, inner));
        assert!(report.holes.len() == 1 && report.holes[0].used.is_some(), "{method:?}: {:?}", report.holes);
        assert_eq!(largest(&patch_points(&draft, &torn), |p| p.z - 0.25), 0.0, "{method:?}");
    }
}

/// Options that fill only the loop with the boundary edge nearest to a point of the xy plane.
fn only_near(torn: &RawSoup, method: Method, [x, y]: [f64; 2]) -> FillOptions {
    let mut edges: BTreeMap<(u32, u32), Vec<u32>> = BTreeMap::new();
    for (t, corners) in torn.triangles.iter().enumerate() {
        for c in 0..3 {
            let (a, b) = (corners[c], corners[(c + 1) % 3]);
            edges.entry((a.min(b), a.max(b))).or_default().push((3 * t + c) as u32);
        }
    }
    let distance = |h: u32| {
        let [px, py, _] = torn.positions[torn.triangles[h as usize / 3][h as usize % 3] as usize];
        (px - x).hypot(py - y)
    };
    let boundary = edges.values().filter(|half_edges| half_edges.len() == 1).map(|half_edges| half_edges[0]);
    let nearest = boundary.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap();
    FillOptions { method, holes: Selection::Only(vec![nearest]), ..FillOptions::default() }
}

#[test]
fn the_cap_of_a_sphere_comes_back_round() {
    let torn = cut(sphere(4), [0.48, 0.6, 0.64], 0.4);
    let off = |method: Method| {
        let (draft, report) = filled(&torn, method);
        assert_eq!(report.holes[0].used, Some(method));
        largest(&patch_points(&draft, &torn), |p| p.length() - 1.0)
    };
    let flat = off(Method::Flat);
    let (smooth, rbf) = (off(Method::Smooth), off(Method::Rbf));
    assert!(smooth < 0.1 * flat && rbf < 0.05 * flat, "flat {flat}, smooth {smooth}, rbf {rbf}");
}

/// The rim runs over the top and down both walls, where it crosses itself in every view from above, along straight rows.
#[test]
fn a_long_rim_over_three_sides_of_a_box_is_closed_by_every_method_in_space() {
    let torn = cut(fine_box([20, 14, 9]), [0.0, 0.0, 0.45], 0.85);
    for method in [Method::Auto, Method::Minimal, Method::Smooth, Method::Rbf] {
        let (draft, report) = filled(&torn, method);
        let [hole] = &report.holes[..] else { panic!("{} holes", report.holes.len()) };
        assert!(hole.rims[0].edges > 128, "{} edges", hole.rims[0].edges);
        assert!(hole.used.is_some(), "{method:?}: {:?}", hole.rejected);
        let mut uses = BTreeMap::new();
        for &[a, b, c] in &draft.triangles {
            for edge in [[a, b], [b, c], [c, a]] {
                *uses.entry(edge).or_insert(0) += 1;
            }
        }
        assert!(uses.iter().all(|(&[a, b], &n)| n == 1 && uses.contains_key(&[b, a])), "{method:?}");
    }
}

/// A ball torn out of an edge of a box, out of a corner, and out of two edges of a thin wall that run side by side;
/// with the faces the other way around as well.
#[test]
fn sharp_edges_of_a_box_go_on_across_a_hole() {
    let half = [20, 14, 3];
    let thick = [20, 14, 9];
    let cases = [
        (thick, [0.0, 0.7, 0.45], 0.3, 0),
        (thick, [1.0, 0.7, 0.45], 0.3, 1),
        (half, [0.0, 0.7, 0.0], 0.35, 0),
        // Up to a corner, where the other two edges end.
        (thick, [1.0, 0.5, 0.45], 0.155, 0),
    ];
    for (half, center, radius, new_vertices) in cases {
        let torn = cut(fine_box(half), center, radius);
        let mut turned = torn.clone();
        turned.triangles.iter_mut().for_each(|t| t.reverse());
        for (torn, method) in [(&torn, Method::Auto), (&torn, Method::Creased), (&turned, Method::Auto)] {
            let (draft, report) = filled(torn, method);
            let hole = &report.holes[0];
            assert_eq!(
                (hole.used, hole.vertices),
                (Some(Method::Creased), new_vertices),
                "{:?}",
                hole.rejected
            );
            let wall = half.map(|side| f64::from(side as f32 / 20.0));
            let beyond = |p: DVec3| (p.abs() - DVec3::from_array(wall)).max_element();
            let off = largest(&patch_points(&draft, torn), beyond);
            assert!(off < 1e-6, "{center:?}: {off}");
        }
    }
}

/// A block that hangs over the side of a plate: below its corner two edges cross, and four faces meet.
#[test]
fn edges_that_cross_in_a_corner_of_a_part_meet_there_again() {
    let cells = |x: std::ops::Range<i64>, y: std::ops::Range<i64>, z: std::ops::Range<i64>| {
        x.flat_map(move |x| {
            let z = z.clone();
            y.clone().flat_map(move |y| z.clone().map(move |z| [x, y, z]))
        })
    };
    let all: Vec<[i64; 3]> = cells(0..10, 0..6, 0..5).chain(cells(5..10, -5..6, 5..9)).collect();
    let torn = cut(voxels(&all), [5.0, 0.0, 5.0], 2.3);
    for method in [Method::Creased, Method::Auto] {
        let (draft, report) = filled(&torn, method);
        let hole = &report.holes[0];
        assert_eq!((hole.used, hole.vertices), (Some(Method::Creased), 1), "{:?}", hole.rejected);
        let off = |p: DVec3| (p.z - 5.0).abs().min(p.y.abs()).min((p.x - 5.0).abs());
        assert!(largest(&patch_points(&draft, &torn), off) < 1e-5, "{method:?}");
        assert_eq!(draft.positions[draft.positions.len() - 1], DVec3::new(5.0, 0.0, 5.0));
    }
}

#[test]
fn the_round_edge_of_a_can_goes_on_across_a_hole() {
    let torn = cut(can(), [1.0, 0.0, 0.8], 0.4);
    let off = |method: Method| {
        let (draft, report) = filled(&torn, method);
        assert_eq!(report.holes[0].used, Some(method), "{:?}", report.holes[0].rejected);
        largest(&patch_points(&draft, &torn), |p| (p.x.hypot(p.y) - 1.0).max(p.z - 0.8))
    };
    let (creased, smooth) = (off(Method::Creased), off(Method::Smooth));
    assert!(creased < 0.015 && smooth > 0.05, "of a hole of 0.8: creased {creased}, smooth {smooth}");
}

/// What a surface was fitted with is told for each hole.
#[test]
fn a_patch_on_a_field_comes_with_what_was_fitted() {
    let torn = cut(sphere(3), [0.48, 0.6, 0.64], 0.4);
    let (_, report) = filled(&torn, Method::Rbf);
    let field = report.holes[0].field.expect("a sphere has a fit");
    assert!(field.centres > field.points && field.centres <= 3 * field.points, "{field:?}");
    assert!(field.residual <= 1e-9 && field.degree == 2 && field.kernel == Kernel::Cubic, "{field:?}");
    let (_, report) = filled(&torn, Method::Smooth);
    assert_eq!(report.holes[0].field, None);
    // One triangle has no room for a vertex that could be moved to a surface.
    let mut pricked = sphere(3);
    pricked.triangles.pop();
    let (_, report) = filled(&pricked, Method::Rbf);
    let hole = &report.holes[0];
    assert_eq!((hole.used, hole.vertices, hole.field), (Some(Method::Rbf), 0, None));
}

#[test]
fn a_saddle_and_a_cylinder_go_on_across_a_hole() {
    let saddle = |x: f64, y: f64| 0.4 * (x * x - y * y);
    let torn = cut(sheet(24, saddle), [0.0; 3], 0.4);
    for method in [Method::Smooth, Method::Rbf] {
        let (draft, report) = filled_as(&torn, &only_near(&torn, method, [0.0; 2]));
        assert_eq!(report.holes[0].used, Some(method));
        let off = largest(&patch_points(&draft, &torn), |p| p.z - saddle(p.x, p.y));
        assert!(off < 0.01, "{method:?}: {off} of a hole of 0.8");
    }
    let arch = |x: f64, _: f64| (4.0 - x * x).sqrt();
    let torn = cut(sheet(24, arch), [0.0, 0.0, 2.0], 0.4);
    for method in [Method::Smooth, Method::Rbf] {
        let (draft, _) = filled_as(&torn, &only_near(&torn, method, [0.0; 2]));
        let off = largest(&patch_points(&draft, &torn), |p| p.x.hypot(p.z) - 2.0);
        assert!(off < 0.005, "{method:?}: {off} of a hole of 0.8");
    }
}

#[test]
fn two_rims_that_face_each_other_share_one_patch_and_the_ends_of_a_tube_do_not() {
    let whole = round_torus(32, 16);
    let mut torn = whole.clone();
    torn.triangles.retain(|t| t.iter().any(|&v| (v / 16) > 2));
    let (draft, report) = filled(&torn, Method::Minimal);
    assert_eq!(report.holes.len(), 1, "{:?}", report.holes);
    assert_eq!(report.holes[0].rims.len(), 2);
    assert!(judge_welded(&raw(&draft)).is_valid());
    for method in [Method::Smooth, Method::Rbf] {
        let (draft, report) = filled(&torn, method);
        assert_eq!((report.holes.len(), report.holes[0].used), (1, Some(method)), "{:?}", report.holes);
        let off = largest(&patch_points(&draft, &torn), |p| (p.x.hypot(p.y) - 1.0).hypot(p.z) - 0.4);
        assert!(off < 0.06, "{method:?}: {off}");
    }
    // Half a torus: its ends look away from each other.
    let mut half = whole;
    half.triangles.retain(|t| t.iter().all(|&v| (v / 16) <= 12));
    let (draft, report) = filled(&half, Method::Auto);
    assert_eq!(report.holes.len(), 2);
    assert!(judge_welded(&raw(&draft)).is_valid());
}

#[test]
fn a_hole_on_each_side_of_a_thin_wall_gets_two_patches() {
    // A flat box: a sphere pressed thin.
    let thin = sphere(4).map(|[x, y, z]| [x, y, f64::from((z.signum() * z.abs().min(0.5) * 0.04) as f32)]);
    let torn = cut(cut(thin, [0.0, 0.0, 0.02], 0.3), [0.0, 0.0, -0.02], 0.3);
    for method in METHODS {
        let (draft, report) = filled(&torn, method);
        assert_eq!(report.holes.len(), 2, "{method:?}: {:?}", report.holes);
        assert!(judge_welded(&raw(&draft)).contacts == 0, "{method:?}");
        assert!(report.holes.iter().all(|hole| hole.used.is_some()), "{method:?}: {:?}", report.holes);
        if method == Method::Rbf {
            let is_fitted = |hole: &HoleReport| hole.used == Some(method) && hole.field.is_some();
            assert!(report.holes.iter().all(is_fitted), "{:?}", report.holes);
        }
        let off = largest(&patch_points(&draft, &torn), |p| p.z.abs() - 0.02);
        assert!(off < 1e-6, "{method:?}: {off}");
    }
}

/// The rule of `docs/holes.md`, both windings; each patch is closer to the sphere than a flat one.
#[test]
fn auto_fits_a_field_from_26_corners_on() {
    let mut corners_seen = Vec::new();
    for radius in [0.15, 0.25, 0.3, 0.34, 0.38, 0.5] {
        let torn = cut(sphere(4), [0.48, 0.6, 0.64], radius);
        let mut turned = torn.clone();
        turned.triangles.iter_mut().for_each(|t| t.reverse());
        for torn in [torn, turned] {
            let off = |method: Method| {
                let (draft, report) = filled(&torn, method);
                let [hole] = &report.holes[..] else { panic!("{} holes", report.holes.len()) };
                (largest(&patch_points(&draft, &torn), |p| p.length() - 1.0), hole.clone())
            };
            let ((auto, hole), (flat, _)) = (off(Method::Auto), off(Method::Flat));
            let corners = hole.rims[0].edges;
            let wanted = if corners < 26 { Method::Smooth } else { Method::Rbf };
            assert_eq!((hole.used, hole.field.is_some()), (Some(wanted), corners >= 26), "{corners} corners");
            assert!(auto < flat, "{corners} corners: {auto} and {flat}");
            corners_seen.push(corners);
        }
    }
    assert!(
        corners_seen.iter().any(|&n| n < 26) && corners_seen.iter().any(|&n| n >= 26),
        "{corners_seen:?}"
    );
}

#[test]
fn each_way_to_make_triangles_of_a_field_closes_the_hole_soundly() {
    let torn = cut(sphere(3), [0.48, 0.6, 0.64], 0.5);
    for extract in [Extract::Project, Extract::March, Extract::Mesh] {
        let options = FillOptions { method: Method::Rbf, extract, ..FillOptions::default() };
        let (draft, report) = filled_as(&torn, &options);
        let [hole] = &report.holes[..] else { panic!("{} holes", report.holes.len()) };
        assert!(hole.used == Some(Method::Rbf) && hole.field.is_some(), "{extract:?}: {:?}", hole.rejected);
        assert!(judge_welded(&raw(&draft)).is_valid(), "{extract:?}");
        let off = largest(&patch_points(&draft, &torn), |p| p.length() - 1.0);
        assert!(off < 0.03, "{extract:?}: {off} of a hole of 1");
    }
}

#[test]
fn a_rim_that_touches_itself_is_filled_as_the_loops_that_it_is() {
    let solid = sphere(3);
    // Two vertices with one neighbour in common lose their triangles.
    let next = |v: u32| -> Vec<u32> {
        let own = solid.triangles.iter().filter(|t| t.contains(&v));
        own.flatten().copied().filter(|&w| w != v).collect()
    };
    let first = 100;
    let near = next(first);
    let shared = near[0];
    let second = next(shared)
        .into_iter()
        .find(|w| *w != first && next(*w).iter().filter(|x| near.contains(x)).all(|&x| x == shared))
        .unwrap();
    let mut torn = solid.clone();
    torn.triangles.retain(|t| !t.contains(&first) && !t.contains(&second));
    for method in METHODS {
        let (draft, report) = filled(&torn, method);
        assert!(report.holes.iter().all(|hole| hole.used.is_some()), "{method:?}: {:?}", report.holes);
        let draft = raw(&draft);
        assert!(judge_welded(&draft).is_valid(), "{method:?}");
    }
}

#[test]
fn an_island_in_a_hole_and_a_body_far_away_stay_where_they_are() {
    let mut torn = sphere(4);
    let ring = |p: DVec3| (0.15..0.5).contains(&p.distance(DVec3::Z));
    let points: Vec<DVec3> = torn.positions.iter().copied().map(DVec3::from_array).collect();
    torn.triangles.retain(|t| !t.iter().any(|&v| ring(points[v as usize])));
    let torn = torn.with(&cut(sphere(2), [1.0, 0.0, 0.0], 0.5).scaled(8.0).moved([900.0, 0.0, 0.0]));
    let (draft, report) = filled(&torn, Method::Auto);
    assert_eq!(report.holes.len(), 2, "{:?}", report.holes);
    assert!(report.holes.iter().any(|hole| hole.rims.len() == 2));
    assert!(judge_welded(&raw(&draft)).is_valid());
}

#[test]
fn a_hole_that_is_turned_around_gets_the_patch_turned_around() {
    let torn = cut(sphere(3), [0.0, 0.6, 0.8], 0.4);
    let (draft, _) = filled(&torn, Method::Smooth);
    let (turned, _) = filled(&torn.inside_out(), Method::Smooth);
    assert_eq!(draft.triangles.len(), turned.triangles.len());
    assert!(judge_welded(&raw(&draft)).is_valid());
    assert!(judge_welded(&raw(&turned).inside_out()).is_valid());
}
