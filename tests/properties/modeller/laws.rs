//! Laws of the operators, and their bounds against brute force.

use super::oracle::{Model, cross, dot};
use super::zoo::{prism, pyramid, zoo};
use crate::random::Random;
use dashu_int::IBig;
use dashu_ratio::RBig;
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::mesh::polyhedron::{FaceId, Polyhedron};
use meshmend::modeller::{
    Embedding, EventPolicy, IntervalSide, Operator, OperatorRefusal, Rational, Solid, apply,
    distance_of_growth, dual, dual_faces, edge_between, import, offset_growth, range, rational, vertex_near,
};
use std::collections::BTreeMap;

fn budget() -> Budget {
    Budget::unlimited()
}

fn shift(face: FaceId, by: Rational) -> Operator {
    Operator::Shift { faces: vec![(face, by)], events: EventPolicy::Refuse }
}

/// The limits of a side, if it has any.
fn limit(side: &IntervalSide) -> Option<Rational> {
    match side {
        IntervalSide::Limit { limits, .. } => Some(limits[0].1.clone()),
        _ => None,
    }
}

#[test]
fn a_shift_by_a_and_then_by_b_is_one_by_their_sum_and_back_again_is_nothing() {
    for (name, shape) in zoo() {
        let first = shape.solid();
        for face in first.topology().faces() {
            let sides = range(&first, &[(face, rational(1.0))], &budget()).unwrap();
            for side in &sides {
                let Some(end) = limit(side) else { continue };
                let (a, b) =
                    (&end / Rational::from_integer(3.into()), &end / Rational::from_integer(5.into()));
                let (mut twice, mut once) = (first.clone(), first.clone());
                apply(&mut twice, &shift(face, a.clone()), &budget()).unwrap().unwrap();
                let whole = apply(&mut once, &shift(face, &a + &b), &budget()).unwrap().unwrap();
                apply(&mut twice, &shift(face, b.clone()), &budget()).unwrap().unwrap();
                assert!(twice.is_same_as(&once), "{name}");
                let events = if whole.changes.is_empty() { EventPolicy::Refuse } else { EventPolicy::Pass };
                let back = Operator::Shift { faces: vec![(face, -(&a + &b))], events };
                apply(&mut once, &back, &budget()).unwrap().unwrap();
                assert!(once.is_same_as(&first), "{name} {face:?}");
            }
        }
    }
}

#[test]
fn the_interval_is_open_just_inside_is_valid_and_its_end_is_refused_by_name() {
    let almost = Rational::new(999_999.into(), 1_000_000.into());
    for (name, shape) in zoo() {
        let first = shape.solid();
        for face in first.topology().faces() {
            for side in range(&first, &[(face, rational(1.0))], &budget()).unwrap() {
                let Some(end) = limit(&side) else { continue };
                let mut solid = first.clone();
                apply(&mut solid, &shift(face, &end * &almost), &budget()).unwrap().unwrap();
                assert_eq!(Model::of(&solid).unwrap().fault(), None, "{name} {face:?}");
                let refused =
                    apply(&mut first.clone(), &shift(face, end.clone()), &budget()).unwrap().unwrap_err();
                let OperatorRefusal::Limit { limits, blocking } = refused else {
                    panic!("{name}: {refused:?}")
                };
                assert!(limits[0].1 == end && !blocking.is_empty(), "{name} {face:?}");
            }
        }
    }
}

type Line = [RBig; 2];

/// The point of three planes as a linear function of how far `moved` has gone: `[start, speed]` for each coordinate.
fn moving(rows: &[([IBig; 3], IBig)], faces: &[usize], moved: usize) -> Option<[Line; 3]> {
    for i in 0..faces.len() {
        for j in 0..i {
            for k in 0..j {
                let [(a, d), (b, e), (c, f)] = [i, j, k].map(|m| &rows[faces[m]]);
                let crossed = [cross(b, c), cross(c, a), cross(a, b)];
                let w = RBig::from(dot(a, &crossed[0]));
                if w == RBig::ZERO {
                    continue;
                }
                return Some([0, 1, 2].map(|x| {
                    let start = d * &crossed[0][x] + e * &crossed[1][x] + f * &crossed[2][x];
                    let speed: IBig = [i, j, k]
                        .iter()
                        .zip(&crossed)
                        .filter(|(m, _)| faces[**m] == moved)
                        .map(|(_, c)| c[x].clone())
                        .sum();
                    [RBig::from(start) / &w, RBig::from(speed) / &w]
                }));
            }
        }
    }
    None
}

fn at(p: &[Line; 3], s: &RBig) -> [RBig; 3] {
    p.each_ref().map(|[a, b]| a + b * s)
}

/// Every time after 0 at which anything linear that the solid is made of becomes zero, by brute force: four planes that
/// meet in a point, whichever they are. Events are among these.
fn all_times(rows: &[([IBig; 3], IBig)], moved: usize) -> Vec<RBig> {
    let n = rows.len();
    let mut times = Vec::new();
    for a in 0..n {
        for b in 0..a {
            for c in 0..b {
                if [a, b, c].contains(&moved) {
                    continue;
                }
                let det = dot(&rows[a].0, &cross(&rows[b].0, &rows[c].0));
                if det == IBig::ZERO {
                    continue;
                }
                let p = moving(rows, &[a, b, c], moved).unwrap().map(|[start, _]| start);
                let height =
                    (0..3).fold(RBig::ZERO, |sum, k| sum + RBig::from(rows[moved].0[k].clone()) * &p[k]);
                let time = height - RBig::from(rows[moved].1.clone());
                if time > RBig::ZERO {
                    times.push(time);
                }
            }
        }
    }
    times.sort();
    times.dedup();
    times
}

/// The planes with that of `moved` gone a way along its row, read as a model of the same loops.
fn model_at(model: &Model, moved: usize, s: &RBig) -> Option<Model> {
    let (numerator, denominator) = (s.numerator().clone(), IBig::from(s.denominator().clone()));
    let mut rows = model.rows.clone();
    let (normal, offset) = &model.rows[moved];
    rows[moved] = (normal.each_ref().map(|n| n * &denominator), offset * &denominator + numerator);
    let mut around: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (f, face) in model.loops.iter().enumerate() {
        face.iter().flatten().for_each(|&v| around.entry(v).or_default().push(f));
    }
    let mut corners = BTreeMap::new();
    for (v, faces) in around {
        corners.insert(v, super::oracle::meet(&rows, &faces)?);
    }
    Some(Model::new(rows, model.loops.clone(), corners))
}

/// The first time of the sweep at which the model is not valid: tried between and at all candidates, in order.
fn swept_limit(model: &Model, moved: usize) -> Option<RBig> {
    let two = RBig::from(2);
    let mut before = RBig::ZERO;
    for time in all_times(&model.rows, moved) {
        let middle = (&before + &time) / &two;
        let is_valid = |s: &RBig| model_at(model, moved, s).is_some_and(|m| m.fault().is_none());
        if !is_valid(&middle) {
            return Some(before);
        }
        if !is_valid(&time) {
            return Some(time);
        }
        before = time;
    }
    None
}

#[test]
fn limits_are_those_of_a_brute_force_sweep_in_rationals() {
    let shapes = zoo();
    let few = crate::support::cases(12, 40);
    for (name, shape) in shapes.iter().filter(|(_, s)| s.faces.len() <= few) {
        let solid = shape.solid();
        let model = Model::of(&solid).unwrap();
        for face in solid.topology().faces() {
            let has_high = solid
                .topology()
                .sides(face)
                .any(|h| solid.topology().faces_around(solid.topology().origin(h)).count() > 3);
            // A vertex of more than three faces splits at once: the sweep keeps the loops as they are.
            if has_high {
                continue;
            }
            let sides = range(&solid, &[(face, rational(1.0))], &budget()).unwrap();
            let swept = swept_limit(&model, face.index());
            // Rows of the model are scaled by the denominator of the offset, which is 1 in the zoo.
            let told = limit(&sides[1]).map(|t| {
                let whole = |x: &num_bigint::BigInt| IBig::from_le_bytes(&x.to_signed_bytes_le());
                RBig::from_parts_signed(whole(t.numer()), whole(t.denom()))
            });
            assert_eq!(told, swept, "{name} {face:?}");
        }
    }
}

#[test]
fn the_linear_determinant_changes_sign_where_an_edge_vanishes_and_the_quadratic_one_does_not() {
    let mut random = Random::new(5);
    for _ in 0..crate::support::cases(200, 20_000) {
        let mut plane =
            || ([0, 1, 2].map(|_| IBig::from(random.between(-9, 9))), IBig::from(random.between(-9, 9)));
        let rows = [plane(), plane(), plane(), plane()];
        let det3 = |i: usize, j: usize, k: usize| dot(&rows[i].0, &cross(&rows[j].0, &rows[k].0));
        let (m12, m23) = (det3(0, 1, 2), det3(0, 2, 3));
        let slope = det3(1, 2, 3);
        if m12 == IBig::ZERO || m23 == IBig::ZERO || slope == IBig::ZERO {
            continue;
        }
        // D of the rows (n, d), developed along the column of offsets: D(t) = D(0) - t det(n1, n2, n3).
        let big_d = |d0: &IBig| {
            let d = [d0, &rows[1].1, &rows[2].1, &rows[3].1];
            -(d[0] * &slope) + d[1] * det3(0, 2, 3) - d[2] * det3(0, 1, 3) + d[3] * det3(0, 1, 2)
        };
        let zero = big_d(&IBig::ZERO);
        assert_eq!(big_d(&IBig::from(7)), &zero - IBig::from(7) * &slope);
        // The edge of plane 0 on plane 2 between its corners with planes 1 and 3: B - A = D / (m12 m23) (n x n2).
        let a = moving(&rows, &[0, 1, 2], 0).unwrap();
        let b = moving(&rows, &[0, 2, 3], 0).unwrap();
        let line = cross(&rows[0].0, &rows[2].0);
        for t in [-5, 0, 3] {
            let t = RBig::from(t);
            let d = RBig::from(big_d(&rows[0].1)) - &t * RBig::from(slope.clone());
            let (p, q) = (at(&a, &t), at(&b, &t));
            for k in 0..3 {
                let told = &d / RBig::from(&m12 * &m23) * RBig::from(line[k].clone());
                assert_eq!(&q[k] - &p[k], told);
            }
        }
    }
}

fn faces_of(topology: &Polyhedron) -> Vec<Vec<Vec<u32>>> {
    dual_faces(topology).into_iter().map(|f| vec![f]).collect()
}

#[test]
fn the_dual_of_the_dual_is_the_primal() {
    let mut count = 0;
    for (name, shape) in zoo() {
        let solid = shape.solid();
        let topology = solid.topology();
        if topology.faces().any(|f| !topology.loops(f).interior.is_empty()) {
            assert!(dual(&solid, Embedding::Centroid, None).is_err(), "{name}");
            continue;
        }
        let Ok(first) = Polyhedron::from_loops(&faces_of(topology), topology.face_count()) else { continue };
        assert_eq!(first.counts().faces, topology.counts().vertices, "{name}");
        let second = Polyhedron::from_loops(&faces_of(&first), first.face_count()).unwrap();
        // A vertex of the second is a face of the first, which is a vertex of the primal: the numbers are the same.
        let primal: Vec<Vec<Vec<u32>>> = topology
            .faces()
            .map(|f| {
                topology
                    .loop_starts(f)
                    .map(|h| topology.loop_of(h).map(|h| topology.origin(h).index() as u32).collect())
                    .collect()
            })
            .collect();
        assert!(
            second.has_topology_of(&Polyhedron::from_loops(&primal, topology.vertex_bound()).unwrap()),
            "{name}"
        );
        count += 1;
    }
    assert!(count >= 12, "{count}");
}

#[test]
fn the_polar_dual_of_a_cube_is_an_octahedron_and_twice_gives_the_cube() {
    let square = vec![[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let cube = prism(&[square], -2.0, 2.0).solid();
    let polar = dual(&cube, Embedding::Polar, None).unwrap();
    assert!(polar.positions.iter().all(|p| p.length() == 0.5), "{polar:?}");
    let loops: Vec<Vec<Vec<u32>>> = polar.faces.iter().map(|f| vec![f.clone()]).collect();
    let octahedron = meshmend::modeller::from_polygons(&polar.positions, &loops).unwrap();
    assert_eq!(Model::of(&octahedron).unwrap().fault(), None, "its loops look outward");
    let again = dual(&octahedron, Embedding::Polar, None).unwrap();
    let corner = DVec3::splat(2.0);
    assert!(again.positions.iter().all(|p| p.abs() == corner));
    let feet = dual(&cube, Embedding::Foot, None).unwrap();
    assert!(feet.positions.iter().all(|p| p.length() == 2.0));
    let offset = dual(&cube, Embedding::OffsetNormal, None).unwrap();
    assert!(offset.positions.iter().all(|p| p.length() == 3.0));
    assert_eq!(dual(&cube, Embedding::Centroid, None).unwrap().positions, feet.positions);
    let shifted = prism(&[vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]], 0.0, 4.0).solid();
    assert!(dual(&shifted, Embedding::Polar, None).is_err());
    let origin = [rational(2.0), rational(2.0), rational(2.0)];
    assert_eq!(dual(&shifted, Embedding::Polar, Some(origin)).unwrap(), polar);
}

/// The face with this normal.
fn face(solid: &Solid, normal: [f64; 3], at: [f64; 3]) -> FaceId {
    meshmend::modeller::face_by_normal(solid, DVec3::from_array(normal), DVec3::from_array(at)).unwrap()
}

/// A hip roof on its floor, whose ridge vanishes when a hip moves in.
fn hip_roof() -> Solid {
    let mut shape = prism(&[vec![[0.0, 0.0], [60.0, 0.0], [60.0, 40.0], [0.0, 40.0]]], 0.0, 50.0);
    shape.points.extend([DVec3::new(20.0, 20.0, 20.0), DVec3::new(40.0, 20.0, 20.0)]);
    let at = |p: [f64; 3]| shape.points.iter().position(|q| *q == DVec3::from_array(p)).unwrap() as u32;
    let [a, b, c, d] = [[0.0, 0.0, 0.0], [60.0, 0.0, 0.0], [60.0, 40.0, 0.0], [0.0, 40.0, 0.0]].map(at);
    let (e, f) = (8, 9);
    shape.faces.truncate(1);
    shape.faces.extend([
        vec![vec![a, b, f, e]],
        vec![vec![b, c, f]],
        vec![vec![c, d, e, f]],
        vec![vec![d, a, e]],
    ]);
    shape.solid()
}

#[test]
fn an_edge_flips_when_its_roof_moves_past_it_and_flips_back() {
    let first = hip_roof();
    let (left, right) = (
        face(&first, [-1.0, 0.0, 1.0], [10.0, 20.0, 30.0]),
        face(&first, [1.0, 0.0, 1.0], [50.0, 20.0, 30.0]),
    );
    let (front, back) = (
        face(&first, [0.0, -1.0, 1.0], [30.0, 10.0, 30.0]),
        face(&first, [0.0, 1.0, 1.0], [30.0, 30.0, 30.0]),
    );
    let ridge = edge_between(&first, [front, back], None).unwrap();
    let mut solid = first.clone();
    // The hips move inward until the ridge is gone and front and back part: left and right become neighbours.
    let flip = Operator::Flip { edge: ridge, face: left, by: None };
    let applied = apply(&mut solid, &flip, &budget()).unwrap().unwrap();
    assert_eq!(applied.changes.len(), 2);
    assert!(edge_between(&solid, [front, back], None).is_none());
    assert!(edge_between(&solid, [left, right], None).is_some());
    assert_eq!(Model::of(&solid).unwrap().fault(), None);
    let inverse = applied.inverse(&solid, &budget()).unwrap().unwrap();
    apply(&mut solid, &inverse, &budget()).unwrap().unwrap();
    assert!(solid.is_same_as(&first));
    // The edge between two walls has the roof and the floor at its ends; the floor never comes near.
    let mut merged = first.clone();
    apply(&mut merged, &Operator::Merge { edge: ridge, face: left }, &budget()).unwrap().unwrap();
    let tip = vertex_near(&merged, DVec3::new(40.0, 20.0, 20.0)).unwrap();
    assert_eq!(merged.topology().faces_around(tip).count(), 4);
    assert_eq!(Model::of(&merged).unwrap().fault(), None);
}

#[test]
fn bad_flips_and_splits_are_refused_by_their_reasons() {
    let solid = hip_roof();
    let (left, front) = (
        face(&solid, [-1.0, 0.0, 1.0], [10.0, 20.0, 30.0]),
        face(&solid, [0.0, -1.0, 1.0], [30.0, 10.0, 30.0]),
    );
    let refusal = |operator: &Operator, solid: &Solid| {
        apply(&mut solid.clone(), operator, &budget()).unwrap().unwrap_err()
    };
    // A hip is a triangle: its edges vanish together.
    let edge = edge_between(&solid, [left, front], None).unwrap();
    assert_eq!(
        refusal(&Operator::Flip { edge, face: front, by: None }, &solid),
        OperatorRefusal::FaceHasThreeSides { face: left }
    );
    // The edge between two walls of a box has parallel faces at its ends, which never meet.
    let cube = prism(&[vec![[0.0, 0.0], [60.0, 0.0], [60.0, 40.0], [0.0, 40.0]]], 0.0, 20.0).solid();
    let walls =
        [face(&cube, [1.0, 0.0, 0.0], [60.0, 20.0, 10.0]), face(&cube, [0.0, 1.0, 0.0], [30.0, 40.0, 10.0])];
    let edge = edge_between(&cube, walls, None).unwrap();
    let flip = Operator::Flip { edge, face: walls[0], by: None };
    assert!(matches!(refusal(&flip, &cube), OperatorRefusal::DoesNotOpen { .. }));
    let top = face(&cube, [0.0, 0.0, 1.0], [30.0, 20.0, 20.0]);
    let vertex = vertex_near(&cube, DVec3::new(60.0, 40.0, 20.0)).unwrap();
    let split = Operator::Split { vertex, face: top, by: offset_growth(&cube, top, 1.0) };
    assert_eq!(refusal(&split, &cube), OperatorRefusal::VertexIsTrihedral { vertex });
    // The top of a box meets the floor when all upright edges vanish together: no flip, no merge.
    let pass = Operator::Shift { faces: vec![(top, rational(-25.0))], events: EventPolicy::Pass };
    assert!(matches!(refusal(&pass, &cube), OperatorRefusal::FaceVanishes { .. }));
    let tip = pyramid(&[[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]], [10.0, 10.0, 30.0], 0.0).solid();
    let floor = face(&tip, [0.0, 0.0, -1.0], [10.0, 10.0, 0.0]);
    let vertex = vertex_near(&tip, DVec3::new(10.0, 10.0, 30.0)).unwrap();
    let split = Operator::Split { vertex, face: floor, by: rational(1.0) };
    assert_eq!(refusal(&split, &tip), OperatorRefusal::NotThere { face: floor });
}

#[test]
fn a_tip_of_four_faces_splits_one_way_outward_and_the_other_way_inward() {
    let base = [[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]];
    let first = pyramid(&base, [10.0, 10.0, 30.0], 0.0).solid();
    let vertex = vertex_near(&first, DVec3::new(10.0, 10.0, 30.0)).unwrap();
    let side = face(&first, [3.0, 0.0, 1.0], [15.0, 10.0, 15.0]);
    let neighbours: Vec<FaceId> = first.topology().faces_around(vertex).filter(|&f| f != side).collect();
    let mut new_edges = Vec::new();
    for by in [0.5, -0.5] {
        let mut solid = first.clone();
        let by = offset_growth(&first, side, by);
        let applied =
            apply(&mut solid, &Operator::Split { vertex, face: side, by }, &budget()).unwrap().unwrap();
        assert_eq!(Model::of(&solid).unwrap().fault(), None);
        new_edges
            .push(neighbours.iter().filter(|&&f| edge_between(&solid, [side, f], None).is_some()).count());
        let inverse = applied.inverse(&solid, &budget()).unwrap().unwrap();
        apply(&mut solid, &inverse, &budget()).unwrap().unwrap();
        assert!(solid.is_same_as(&first));
    }
    // Outward the side stays between its two neighbours, inward it meets the opposite side as well.
    assert_eq!(new_edges, [2, 3]);
}

/// A drum between two rings of different numbers of corners, roughly rounded, so that its sides are triangles and its
/// vertices have four to six faces with planes in general position.
fn rough_drum(seed: u64) -> Solid {
    let mut random = Random::new(seed);
    let rings = [7 + random.below(12), 7 + random.below(12)];
    let mut points = Vec::new();
    for (k, &count) in rings.iter().enumerate() {
        let lean = random.below(5) as f64 / 16.0;
        for i in 0..count {
            let turn = std::f64::consts::TAU * (i as f64 + lean) / count as f64;
            let p = [libm::cos(turn), libm::sin(turn)].map(|x| (x * 1000.0).round() / 64.0);
            points.push(DVec3::new(p[0], p[1], [-8.0, 8.0][k]));
        }
    }
    let at = |ring: usize, i: usize| (if ring == 0 { i % rings[0] } else { rings[0] + i % rings[1] }) as u32;
    let mut triangles = Vec::new();
    for i in 1..rings[0] - 1 {
        triangles.push([at(0, 0), at(0, i + 1), at(0, i)]);
    }
    for i in 1..rings[1] - 1 {
        triangles.push([at(1, 0), at(1, i), at(1, i + 1)]);
    }
    let (mut i, mut j) = (0, 0);
    while i < rings[0] || j < rings[1] {
        if j == rings[1] || (i < rings[0] && i * rings[1] <= j * rings[0]) {
            triangles.push([at(0, i), at(0, i + 1), at(1, j)]);
            i += 1;
        } else {
            triangles.push([at(0, i), at(1, j + 1), at(1, j)]);
            j += 1;
        }
    }
    import(&points, &triangles, Some(0.0), &budget()).unwrap().unwrap().solid
}

#[test]
fn a_shift_inside_the_interval_that_was_told_is_never_refused_where_several_vertices_split() {
    let (mut done, mut blocked) = (0, 0);
    for seed in 0..crate::support::cases(6, 300) as u64 {
        let first = rough_drum(seed);
        for face in first.topology().faces() {
            let sides = range(&first, &[(face, rational(1.0))], &budget()).unwrap();
            for (side, far) in sides.iter().zip([-4.0, 4.0]) {
                let reach = match side {
                    IntervalSide::Limit { limits, .. } => limits[0].1.clone(),
                    IntervalSide::Unbounded => offset_growth(&first, face, far),
                    IntervalSide::Blocked { .. } => {
                        blocked += 1;
                        continue;
                    }
                };
                for share in [1, 7] {
                    let mut solid = first.clone();
                    let by = &reach * Rational::new(share.into(), 8.into());
                    let applied = apply(&mut solid, &shift(face, by), &budget()).unwrap();
                    let applied = applied.unwrap_or_else(|r| panic!("{seed} {face:?} {share}: {r:?}"));
                    assert_eq!(Model::of(&solid).unwrap().fault(), None, "{seed} {face:?} {share}");
                    applied.undo(&mut solid);
                    assert!(solid.is_same_as(&first));
                    done += 1;
                }
            }
        }
    }
    assert!(done > 100 && blocked < done / 10, "{done} done, {blocked} blocked");
}

#[test]
fn a_wall_by_its_two_sides_moves_as_far_as_one_likes() {
    let (_, shape) = &zoo()[3];
    let solid = shape.solid();
    // The left prong of the U: its outer and its inner side, together to the left.
    let (outer, inner) = (
        face(&solid, [-1.0, 0.0, 0.0], [0.0, 25.0, 10.0]),
        face(&solid, [1.0, 0.0, 0.0], [15.0, 30.0, 10.0]),
    );
    let together = [(outer, rational(1.0)), (inner, rational(-1.0))];
    let [to_the_right, to_the_left] = range(&solid, &together, &budget()).unwrap();
    assert_eq!(to_the_left, IntervalSide::Unbounded);
    // To the right the inner side meets the other prong after 30.
    let IntervalSide::Limit { limits, .. } = &to_the_right else { panic!("a limit") };
    assert!(limits.contains(&(inner, rational(30.0))) && limits.contains(&(outer, rational(-30.0))));
    let alone = range(&solid, &[(inner, rational(1.0))], &budget()).unwrap();
    assert_eq!(
        alone.each_ref().map(|s| distance_of_growth(&solid, inner, &limit(s).unwrap()).round()),
        [-15.0, 30.0]
    );
}
