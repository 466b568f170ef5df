//! Simplification keeps the topology of what it is given, whatever the criterion, the placement and the target.

use crate::half_edge::{random_closed_manifold, random_manifold, topology};
use crate::random::Random;
use crate::support::{cases, corpus_files};
use meshmend::budget::Budget;
use meshmend::formats::{ReadOptions, read, sniff};
use meshmend::geom::{DVec3, are_collinear};
use meshmend::mesh::half_edge::{Claims, HalfEdgeMesh};
use meshmend::mesh::{Color, Soup, cut_singular};
use meshmend::par;
use meshmend::simplify::{
    Borders, CriterionKind, Guards, NEW, Placement, Simplified, SimplifyError, SimplifyInput,
    SimplifyOptions, SimplifyRefusal, Target, simplify_strict,
};

type Triangle = [u32; 3];

const CRITERIA: [CriterionKind; 3] =
    [CriterionKind::Quadric, CriterionKind::Memoryless, CriterionKind::Length];
const PLACEMENTS: [Placement; 2] = [Placement::Optimal, Placement::OntoEnd];

/// No guard but the one against degenerate faces.
const UNGUARDED: Guards<'static> = Guards { normal_cos_min: -1.0, aspect_min: 0.0, envelope: None };

fn strict(input: &SimplifyInput<'_>, options: &SimplifyOptions<'_>) -> Vec<Simplified> {
    simplify_strict(input, options, &Budget::unlimited()).unwrap()
}

/// A height field of `n` by `n` squares with random bumps.
fn terrain(random: &mut Random, n: u32) -> (Vec<DVec3>, Vec<Triangle>) {
    let side = n + 1;
    let positions = (0..side * side)
        .map(|i| DVec3::new(f64::from(i % side), f64::from(i / side), random.unit()))
        .map(|p| p.as_vec3().as_dvec3())
        .collect();
    let square = |i: u32| {
        let a = i % n + i / n * side;
        [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]
    };
    (positions, (0..n * n).flat_map(square).collect())
}

/// A sphere of `n` rings of `n` corners between two poles, float32 exact.
fn sphere(n: u32) -> (Vec<DVec3>, Vec<Triangle>) {
    let mut positions = vec![DVec3::Z, -DVec3::Z];
    for i in 0..n * n {
        // Angles by rational points of the circle, so that no transcendental function is needed.
        let circle = |t: f64| ((1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
        let turn = f64::from(i % n) / f64::from(n) * 4.0;
        let (c, s) = circle(turn % 1.0);
        let (x, y) = match turn as u32 {
            0 => (c, s),
            1 => (-s, c),
            2 => (-c, -s),
            _ => (s, -c),
        };
        let (z, r) = circle(f64::from(i / n + 1) / f64::from(n + 1) * 2.0 - 1.0);
        // The half circle from the south pole (z = -1) to the north pole.
        let (z, r) = (r, z);
        positions.push(DVec3::new(x * r, y * r, z).as_vec3().as_dvec3());
    }
    let at = |ring: u32, k: u32| 2 + ring * n + k % n;
    let mut triangles = Vec::new();
    for k in 0..n {
        triangles.push([1, at(0, k + 1), at(0, k)]);
        triangles.push([0, at(n - 1, k), at(n - 1, k + 1)]);
        for ring in 0..n - 1 {
            triangles.push([at(ring, k), at(ring, k + 1), at(ring + 1, k + 1)]);
            triangles.push([at(ring, k), at(ring + 1, k + 1), at(ring + 1, k)]);
        }
    }
    (positions, triangles)
}

/// Fails unless `result` is a manifold with the topology of `triangles`, without degenerate faces, and its origins are
/// true.
fn assert_kept(input: &SimplifyInput<'_>, result: &Simplified) {
    let budget = Budget::unlimited();
    let mesh =
        |positions: usize, list: &[Triangle]| HalfEdgeMesh::from_triangles(list, positions, &budget).unwrap();
    let before = mesh(input.positions.len(), input.triangles);
    let after = mesh(result.positions.len(), &result.triangles);
    let (was, is) = (before.counts(), after.counts());
    assert_eq!((is.euler(), is.boundary_loops), (was.euler(), was.boundary_loops));
    let claims = Claims { is_triangular: true, euler: Some(was.euler()), ..Claims::default() };
    assert_eq!(after.check(&claims, &budget).unwrap(), []);
    assert_eq!(is.vertices, result.positions.len(), "every vertex is used");
    assert_eq!(result.report.faces_after, result.triangles.len());
    assert_eq!(result.vertex_origin.len(), result.positions.len());
    for (&origin, &p) in result.vertex_origin.iter().zip(&result.positions) {
        assert!(origin == NEW || input.positions[origin as usize] == p);
        assert!(p.is_finite());
    }
    assert!(result.triangle_origin.is_sorted());
}

#[test]
fn random_manifolds_keep_their_topology_down_to_the_last_collapse() {
    let mut random = Random::new(51);
    let mut collapses = 0;
    for case in 0..cases(400, 10_000) {
        let triangles = random_manifold(&mut random, 60);
        let count = triangles.as_flattened().iter().max().unwrap() + 1;
        let positions: Vec<DVec3> =
            (0..count).map(|_| DVec3::new(random.unit(), random.unit(), random.unit())).collect();
        let options = SimplifyOptions {
            targets: vec![Target::Ratio(0.5), Target::Ratio(0.1), Target::Faces(0)],
            criterion: CRITERIA[case % 3],
            placement: PLACEMENTS[case / 3 % 2],
            guards: if case % 4 < 3 { UNGUARDED } else { Guards::default() },
            borders: if random.one_in(4) { Borders::Keep } else { Borders::Follow },
            ..SimplifyOptions::default()
        };
        let input = SimplifyInput::new(&positions, &triangles);
        let before = topology(&triangles).unwrap();
        for level in strict(&input, &options) {
            assert_kept(&input, &level);
            assert_eq!(topology(&level.triangles), Some(before), "case {case}: {triangles:?}");
            collapses += level.report.collapses;
        }
    }
    assert!(collapses > 5_000, "{collapses}");
}

#[test]
fn a_run_ends_only_when_no_edge_of_a_closed_mesh_can_be_collapsed() {
    let mut random = Random::new(56);
    for case in 0..cases(200, 5_000) {
        let triangles = random_closed_manifold(&mut random, 80);
        let count = triangles.as_flattened().iter().max().unwrap() + 1;
        let positions: Vec<DVec3> =
            (0..count).map(|_| DVec3::new(random.unit(), random.unit(), random.unit())).collect();
        let options = SimplifyOptions {
            targets: vec![Target::Faces(0)],
            criterion: CRITERIA[case % 3],
            guards: UNGUARDED,
            ..SimplifyOptions::default()
        };
        let level = strict(&SimplifyInput::new(&positions, &triangles), &options).remove(0);
        let budget = Budget::unlimited();
        let mesh = HalfEdgeMesh::from_triangles(&level.triangles, level.positions.len(), &budget).unwrap();
        let left = mesh.half_edges().find(|&h| mesh.can_collapse(h).is_ok());
        assert_eq!(left, None, "case {case}: {triangles:?}");
    }
}

#[test]
fn a_sphere_and_a_terrain_reach_their_targets_in_every_criterion() {
    let mut random = Random::new(52);
    let shapes = [sphere(24), terrain(&mut random, 20)];
    for (positions, triangles) in &shapes {
        let input = SimplifyInput::new(positions, triangles);
        for criterion in CRITERIA {
            for placement in PLACEMENTS {
                let targets = [0.5, 0.1].map(Target::Ratio).to_vec();
                let options = SimplifyOptions { targets, criterion, placement, ..SimplifyOptions::default() };
                let levels = strict(&input, &options);
                for (level, share) in levels.iter().zip([0.5, 0.1]) {
                    assert_kept(&input, level);
                    let wanted = (triangles.len() as f64 * share) as usize;
                    assert!(level.report.is_reached, "{criterion:?} {placement:?}: {:?}", level.report);
                    assert!((wanted - 1..=wanted).contains(&level.triangles.len()));
                    if placement == Placement::OntoEnd {
                        assert!(level.vertex_origin.iter().all(|&v| v != NEW));
                    }
                    for t in &level.triangles {
                        let [a, b, c] = t.map(|v| level.positions[v as usize]);
                        assert!(!are_collinear(a, b, c));
                        assert!([a, b, c].iter().all(|p| p.as_vec3().as_dvec3() == *p), "float32 exact");
                    }
                }
            }
        }
    }
}

#[test]
fn levels_of_one_run_are_what_separate_runs_give() {
    let (positions, triangles) = sphere(20);
    let input = SimplifyInput::new(&positions, &triangles);
    let options =
        |targets: &[Target]| SimplifyOptions { targets: targets.to_vec(), ..SimplifyOptions::default() };
    let targets = [Target::Faces(500), Target::Ratio(0.3), Target::Faces(60)];
    let together = strict(&input, &options(&targets));
    for (level, &target) in together.iter().zip(&targets) {
        let alone = &strict(&input, &options(&[target]))[0];
        assert_eq!(alone.positions, level.positions);
        assert_eq!(alone.triangles, level.triangles);
    }
}

#[test]
fn the_result_does_not_depend_on_the_number_of_threads() {
    let (positions, triangles) = terrain(&mut Random::new(53), 130);
    let input = SimplifyInput::new(&positions, &triangles);
    let options = SimplifyOptions { targets: vec![Target::Ratio(0.2)], ..SimplifyOptions::default() };
    let results = [1, 2, 5].map(|threads| par::with_threads(threads, || strict(&input, &options)));
    assert!(results[0] == results[1] && results[1] == results[2]);
}

#[test]
fn an_error_target_stops_before_the_error_and_a_larger_one_goes_on() {
    let (positions, triangles) = sphere(24);
    let input = SimplifyInput::new(&positions, &triangles);
    for criterion in CRITERIA {
        let targets = [1e-3, 1e-2, 1e-1].map(Target::Error).to_vec();
        let options = SimplifyOptions { targets, criterion, ..SimplifyOptions::default() };
        let levels = strict(&input, &options);
        for (level, limit) in levels.iter().zip([1e-3, 1e-2, 1e-1]) {
            assert_kept(&input, level);
            assert!(level.report.is_reached && level.report.error_max <= limit * (1.0 + 1e-9));
        }
        assert!(levels.windows(2).all(|l| l[0].triangles.len() >= l[1].triangles.len()));
        // The length of an edge is a much larger error than what its collapse does to a smooth surface.
        let share = if criterion == CriterionKind::Length { 1 } else { 2 };
        assert!(levels[2].triangles.len() < triangles.len() / share, "{criterion:?}");
        if criterion == CriterionKind::Quadric {
            let farthest = levels[1].positions.iter().map(|p| (p.length() - 1.0).abs()).fold(0.0, f64::max);
            assert!(farthest < 0.05, "{farthest}");
        }
    }
}

#[test]
fn borders_that_are_kept_do_not_move_and_others_stay_on_their_line() {
    let (positions, triangles) = terrain(&mut Random::new(54), 16);
    let input = SimplifyInput::new(&positions, &triangles);
    let is_border = |p: &DVec3| [p.x, p.y].iter().any(|&x| x == 0.0 || x == 16.0);
    for borders in [Borders::Keep, Borders::Follow] {
        let options =
            SimplifyOptions { targets: vec![Target::Ratio(0.2)], borders, ..SimplifyOptions::default() };
        let level = &strict(&input, &options)[0];
        let mesh =
            HalfEdgeMesh::from_triangles(&level.triangles, level.positions.len(), &Budget::unlimited())
                .unwrap();
        let border: Vec<DVec3> = mesh
            .vertices()
            .filter(|&v| mesh.is_boundary_vertex(v))
            .map(|v| level.positions[v.index()])
            .collect();
        if borders == Borders::Keep {
            let want = positions.iter().filter(|p| is_border(p)).count();
            assert_eq!(border.iter().filter(|p| is_border(p)).count(), want);
            assert_eq!(border.len(), want);
        } else {
            assert!(border.len() < positions.iter().filter(|p| is_border(p)).count());
            // In the plane the border is straight, so it stays on it up to its corners.
            let off = |p: &DVec3| p.x.min(p.y).min(16.0 - p.x).min(16.0 - p.y).abs();
            assert!(border.iter().map(off).fold(0.0, f64::max) < 0.5);
        }
    }
}

#[test]
fn colors_of_faces_keep_their_borders_and_colors_of_vertices_are_mixed() {
    let (positions, triangles) = terrain(&mut Random::new(55), 16);
    let groups: Vec<u32> =
        triangles.iter().map(|t| u32::from(t.iter().any(|&v| positions[v as usize].x < 8.0))).collect();
    let shade = |p: DVec3| Some(Color::Floats([p.x as f32 / 16.0, 0.5, 0.0], None));
    let colors: Vec<Option<Color>> = positions.iter().map(|&p| shade(p)).collect();
    let flat: Vec<DVec3> = positions.iter().map(|p| DVec3::new(p.x, p.y, 0.0)).collect();
    let input = SimplifyInput {
        positions: &flat,
        triangles: &triangles,
        face_groups: &groups,
        vertex_colors: &colors,
        texture: &[],
    };
    let options = SimplifyOptions { targets: vec![Target::Ratio(0.1)], ..SimplifyOptions::default() };
    let level = &strict(&input, &options)[0];
    assert_kept(&input, level);
    assert!(level.report.is_reached);
    let mut area = [0.0; 2];
    for (t, &origin) in level.triangles.iter().zip(&level.triangle_origin) {
        let [a, b, c] = t.map(|v| level.positions[v as usize]);
        area[groups[origin as usize] as usize] += (b - a).cross(c - a).z / 2.0;
        let is_left = [a, b, c].iter().all(|p| p.x <= 8.0 + 1e-6);
        assert_eq!(is_left, groups[origin as usize] == 1, "{a} {b} {c}");
    }
    assert!((area[0] - 128.0).abs() < 1e-3 && (area[1] - 128.0).abs() < 1e-3, "{area:?}");
    for (p, color) in level.positions.iter().zip(&level.vertex_colors) {
        let (Some(Color::Floats(is, None)), Some(Color::Floats(want, None))) = (color, shade(*p)) else {
            panic!("{color:?}");
        };
        assert!((is[0] - want[0]).abs() < 0.05 && is[1] == 0.5, "{is:?} {want:?}");
    }
}

#[test]
fn a_cube_of_many_faces_comes_down_to_twelve_and_stays_a_cube() {
    let n = 8i32;
    let mut soup = Soup::default();
    // Six grids, welded by exact position.
    let mut ids = std::collections::BTreeMap::new();
    for (axis, side) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)] {
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut corner = |di: i32, dj: i32| {
                let mut p = [0i32; 3];
                p[axis] = side * n;
                p[(axis + 1) % 3] = i + di;
                p[(axis + 2) % 3] = j + dj;
                *ids.entry(p).or_insert_with(|| {
                    soup.positions.push(DVec3::from_array(p.map(f64::from)));
                    soup.positions.len() as u32 - 1
                })
            };
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            let faces = if side == 1 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
            soup.triangles.extend(faces);
        }
    }
    let input = SimplifyInput::new(&soup.positions, &soup.triangles);
    for criterion in [CriterionKind::Quadric, CriterionKind::Memoryless] {
        let options =
            SimplifyOptions { targets: vec![Target::Faces(12)], criterion, ..SimplifyOptions::default() };
        let level = &strict(&input, &options)[0];
        assert_kept(&input, level);
        assert_eq!(level.triangles.len(), 12, "{criterion:?}: {:?}", level.report);
        for p in &level.positions {
            assert!(p.to_array().iter().all(|&x| x == 0.0 || x == f64::from(n)), "{criterion:?}: {p}");
        }
    }
}

#[test]
fn what_is_no_manifold_is_refused_and_a_tetrahedron_stays() {
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
    let book = [[0, 1, 2], [1, 0, 3], [0, 1, 4]];
    let options = SimplifyOptions { targets: vec![Target::Faces(2)], ..SimplifyOptions::default() };
    let refused = simplify_strict(&SimplifyInput::new(&positions, &book), &options, &Budget::unlimited());
    assert!(matches!(refused, Err(SimplifyError::NotManifold(_))));
    let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let level = &strict(&SimplifyInput::new(&positions, &tetrahedron), &options)[0];
    assert_eq!(level.triangles, tetrahedron);
    assert!(!level.report.is_reached && level.report.refusals.total() > 0);
    let link = SimplifyRefusal::ALL.iter().filter(|r| matches!(r, SimplifyRefusal::Link(_)));
    assert!(link.map(|&r| level.report.refusals.count(r)).sum::<u64>() > 0);
}

#[test]
fn huge_tiny_and_far_coordinates_give_the_same_mesh() {
    let (positions, triangles) = sphere(12);
    let run = |map: &dyn Fn(DVec3) -> DVec3| {
        let moved: Vec<DVec3> = positions.iter().map(|&p| map(p)).collect();
        let options =
            SimplifyOptions { targets: vec![Target::Ratio(0.3)], round: false, ..SimplifyOptions::default() };
        strict(&SimplifyInput::new(&moved, &triangles), &options).remove(0)
    };
    let plain = run(&|p| p);
    for exponent in [-900, -100, 100, 900] {
        let scale = 2f64.powi(exponent);
        let scaled = run(&|p| p * scale);
        assert_eq!(scaled.triangles, plain.triangles, "2^{exponent}");
        let same = scaled.positions.iter().zip(&plain.positions).all(|(&p, &q)| p == q * scale);
        assert!(same, "2^{exponent}");
    }
    let far = run(&|p| p + DVec3::splat(1e6));
    assert!(far.report.is_reached);
    let off = |p: &DVec3| ((*p - DVec3::splat(1e6)).length() - 1.0).abs();
    assert!(far.positions.iter().map(off).fold(0.0, f64::max) < 0.2);
}

/// The meshes of the corpus, cut where they are no manifold, that are not too large for a test.
fn corpus_meshes(faces_max: usize) -> Vec<(String, Soup)> {
    let budget = Budget::unlimited();
    let mut meshes = Vec::new();
    for file in corpus_files(&["stl", "obj", "off", "ply"]).unwrap_or_default() {
        let bytes = std::fs::read(&file).unwrap();
        let Ok(encoding) = sniff(&bytes, None) else { continue };
        let Ok(mut soup) = read(&bytes, encoding, &ReadOptions::default(), &budget) else { continue };
        soup.triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        if soup.triangles.is_empty() || soup.triangles.len() > faces_max {
            continue;
        }
        let cut = cut_singular(&mut soup.triangles, soup.positions.len(), &budget).unwrap();
        let copies: Vec<DVec3> = cut.copies.iter().map(|&v| soup.positions[v as usize]).collect();
        soup.positions.extend(copies);
        meshes.push((file.display().to_string(), soup));
    }
    meshes
}

#[test]
fn real_meshes_keep_their_topology_at_a_half_a_tenth_and_a_hundredth() {
    let mut reached = 0;
    let meshes = corpus_meshes(cases(20_000, 3_000_000));
    for (name, soup) in &meshes {
        let input = SimplifyInput::new(&soup.positions, &soup.triangles);
        for criterion in if soup.triangles.len() < 5_000 { &CRITERIA[..] } else { &CRITERIA[..1] } {
            let targets = [0.5, 0.1, 0.01].map(Target::Ratio).to_vec();
            let options = SimplifyOptions { targets, criterion: *criterion, ..SimplifyOptions::default() };
            let levels = simplify_strict(&input, &options, &Budget::unlimited())
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            for level in &levels {
                assert_kept(&input, level);
                reached += usize::from(level.report.is_reached);
            }
        }
    }
    assert!(meshes.is_empty() || reached > meshes.len() / 2, "{reached} of {}", meshes.len());
}
