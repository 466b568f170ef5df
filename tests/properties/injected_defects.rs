//! Each kind of defect planted in clean meshes at random places: it is found where it was planted, and nothing else is
//! but what follows from it, as the table of classes states.

use crate::oracle::{RawSoup, weld};
use crate::random::Random;
use crate::raw_files::encode;
use crate::solids::{any_solid, cuboid, tetrahedron};
use crate::support::{cases, on_all_cores};
use meshmend::analysis::{Analysis, AnalyzeOptions, DefectCode as D, Finding, NearSearch, analyze};
use meshmend::budget::Budget;
use meshmend::formats::{Encoding, ReadOptions, read};
use std::collections::{BTreeMap, BTreeSet};

type Point = [f64; 3];

/// A mesh with something planted.
struct Planted {
    raw: RawSoup,
    /// More lines of the file.
    lines: &'static str,
    at: At,
}

/// Where something was planted.
enum At {
    /// A witness names one of these faces.
    Faces(Vec<u32>),
    /// A witness names all of these vertices.
    Vertices(Vec<u32>),
}

/// A kind of defect, how it is planted, and what else follows from it.
struct Class {
    code: D,
    plant: fn(&RawSoup, &mut Random) -> Planted,
    /// Other findings that may come with it.
    consequences: &'static [D],
}

/// A rim has edges of one face; a third face at an edge parts the fans of its ends; a part beside the mesh that is open is
/// a sheet or a single face; a part that is tiny is noise, and a tip or a plate has thin faces.
const CLASSES: &[Class] = &[
    // Without a large face a flat solid is a tray, which is read as a sheet.
    Class { code: D::BoundaryLoop, plant: without_face, consequences: &[D::OpenSheet] },
    Class { code: D::OrientationConflict, plant: with_turned_face, consequences: &[] },
    Class {
        code: D::DuplicateFace,
        plant: with_copy,
        consequences: &[D::NonManifoldEdge, D::NonManifoldVertex],
    },
    Class {
        code: D::OppositeDuplicateFace,
        plant: with_back,
        consequences: &[D::NonManifoldEdge, D::NonManifoldVertex],
    },
    Class { code: D::CoincidentCorners, plant: with_coincident_corners, consequences: &[] },
    Class { code: D::CollinearFace, plant: with_line, consequences: &[D::IsolatedFace, D::BoundaryLoop] },
    Class { code: D::IsolatedFace, plant: with_loose_face, consequences: &[D::BoundaryLoop] },
    Class { code: D::NonFiniteVertex, plant: with_nan, consequences: &[D::NonFiniteFace] },
    Class { code: D::NonFiniteFace, plant: with_infinity, consequences: &[D::NonFiniteVertex] },
    Class { code: D::IndexOutOfRange, plant: with_wild_index, consequences: &[] },
    Class { code: D::TooFewCorners, plant: with_two_corners, consequences: &[] },
    Class { code: D::IsolatedVertex, plant: with_loose_vertex, consequences: &[] },
    Class { code: D::DuplicateVertex, plant: with_tear, consequences: &[] },
    Class {
        code: D::NonManifoldEdge,
        plant: with_fin,
        consequences: &[D::BoundaryLoop, D::NonManifoldVertex],
    },
    Class { code: D::NonManifoldVertex, plant: with_cone, consequences: &[] },
    // The conflict of a twisted band is an edge that runs one way twice.
    Class {
        code: D::NonOrientable,
        plant: with_band,
        consequences: &[D::OrientationConflict, D::BoundaryLoop, D::OpenSheet],
    },
    Class { code: D::InvertedShell, plant: inside_out, consequences: &[] },
    Class { code: D::MisnestedShell, plant: with_hidden_part, consequences: &[D::NoiseShell] },
    // A shell without volume has no other form among three vertices.
    Class { code: D::ZeroVolumeShell, plant: with_pillow, consequences: &[D::OppositeDuplicateFace] },
    Class { code: D::SelfIntersection, plant: with_spike_through_face, consequences: &[D::NoiseShell] },
    // The walls of the part touch the face in the outline of what is shared.
    Class { code: D::Overlap, plant: with_part_on_face, consequences: &[D::Touch] },
    Class { code: D::Touch, plant: with_tip_on_face, consequences: &[D::NoiseShell] },
    Class { code: D::Near, plant: with_tip_near_face, consequences: &[D::NoiseShell] },
    Class { code: D::Near, plant: with_tip_near_vertex, consequences: &[] },
    Class { code: D::Needle, plant: with_needle, consequences: &[] },
    Class { code: D::Cap, plant: with_cap, consequences: &[] },
    Class { code: D::FoldedEdge, plant: with_wedge, consequences: &[] },
    Class { code: D::DoubleSkin, plant: with_plate, consequences: &[D::Needle] },
    Class { code: D::OpenSheet, plant: with_square, consequences: &[D::BoundaryLoop] },
    Class { code: D::NoiseShell, plant: with_speck, consequences: &[] },
    Class {
        code: D::NonPlanarPolygon,
        plant: with_bent_polygon,
        consequences: &[D::IsolatedFace, D::BoundaryLoop],
    },
    Class {
        code: D::ConcavePolygon,
        plant: with_notched_polygon,
        consequences: &[D::IsolatedFace, D::BoundaryLoop],
    },
];

fn described(raw: &RawSoup, lines: &str) -> Analysis {
    let mut bytes = encode(raw, Encoding::Obj);
    bytes.extend(lines.as_bytes());
    let soup = read(&bytes, Encoding::Obj, &ReadOptions::default(), &Budget::unlimited()).unwrap();
    let options =
        AnalyzeOptions { samples: 1_000, near: NearSearch::ByDiagonal, ..AnalyzeOptions::default() };
    analyze(&soup, None, &options, &Budget::unlimited()).unwrap()
}

/// A closed surface of `2 n m` triangles around a ring.
fn torus(n: u32, m: u32) -> RawSoup {
    let position = |i: u32| {
        let [u, v] =
            [(i / m, n), (i % m, m)].map(|(k, n)| std::f64::consts::TAU * f64::from(k) / f64::from(n));
        let radius = 3.0 + v.cos();
        [radius * u.cos(), radius * u.sin(), v.sin()]
    };
    let vertex = |row: u32, column: u32| (row % n) * m + column % m;
    let quads = (0..n * m).map(|i| (i / m, i % m)).flat_map(|(row, column)| {
        let [a, b] = [vertex(row, column), vertex(row + 1, column)];
        let [c, d] = [vertex(row + 1, column + 1), vertex(row, column + 1)];
        [[a, b, c], [a, c, d]]
    });
    RawSoup { positions: (0..n * m).map(position).collect(), triangles: quads.collect() }
}

/// The surface of a box, each side in `n` by `n` squares.
fn gridded_box(n: u32) -> RawSoup {
    let mut ids = BTreeMap::new();
    let mut raw = RawSoup::default();
    for axis in 0..3usize {
        for side in [0, n] {
            for (row, column) in (0..n * n).map(|i| (i / n, i % n)) {
                let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[u, v]| {
                    let mut at = [side; 3];
                    at[(axis + 1) % 3] = row + u;
                    at[(axis + 2) % 3] = column + v;
                    *ids.entry(at).or_insert_with(|| {
                        raw.positions.push(at.map(|x| f64::from(x) / f64::from(n)));
                        raw.positions.len() as u32 - 1
                    })
                });
                let [a, b, c, d] = corners;
                let quad = [[a, b, c], [a, c, d]];
                raw.triangles.extend(if side == 0 { quad.map(|[a, b, c]| [a, c, b]) } else { quad });
            }
        }
    }
    raw
}

/// A mesh of which nothing is to be said.
fn clean(random: &mut Random) -> RawSoup {
    loop {
        let raw = match random.below(6) {
            0 => torus(9 + random.below(12) as u32, 6 + random.below(6) as u32),
            1 => gridded_box(2 + random.below(5) as u32),
            _ => weld(&any_solid(random)),
        };
        if described(&raw, "").findings.is_empty() {
            return raw;
        }
    }
}

#[test]
fn clean_meshes_have_no_findings_but_for_few_solids_with_thin_faces() {
    let found: Vec<Vec<D>> = on_all_cores(cases(300, 5_000), |round| {
        let raw = weld(&any_solid(&mut Random::new(round as u64)));
        described(&raw, "").findings.iter().map(|f| f.code).collect()
    });
    assert!(
        found.iter().flatten().all(|code| [D::Needle, D::Cap, D::FoldedEdge].contains(code)),
        "{found:?}"
    );
    let rejected = found.iter().filter(|codes| !codes.is_empty()).count();
    assert!(rejected * 10 < found.len(), "{rejected}");
    assert_eq!(described(&torus(12, 8), "").findings, []);
    assert_eq!(described(&gridded_box(4), "").findings, []);
}

#[test]
fn injected_defect_is_found_where_it_was_planted_and_nothing_else_is() {
    let rounds = cases(20, 1_000);
    println!("| class | planted | found | other findings |");
    println!("|---|---|---|---|");
    let mut faults = Vec::new();
    for (number, class) in CLASSES.iter().enumerate() {
        let told = on_all_cores(rounds, |round| {
            let mut random = Random::new((number * 1_000_000 + round) as u64);
            let raw = clean(&mut random);
            let planted = (class.plant)(&raw, &mut random);
            let told = described(&planted.raw, planted.lines);
            let finding = told.findings.iter().find(|f| f.code == class.code);
            let is_found = finding.is_some_and(|finding| is_at(finding, &planted.at));
            let others: BTreeSet<D> =
                told.findings.iter().map(|f| f.code).filter(|code| *code != class.code).collect();
            (is_found, others, raw)
        });
        let mut counts: BTreeMap<D, usize> = BTreeMap::new();
        for (round, (is_found, others, raw)) in told.iter().enumerate() {
            others.iter().for_each(|code| *counts.entry(*code).or_default() += 1);
            if !is_found || !others.iter().all(|code| class.consequences.contains(code)) {
                faults.push(format!(
                    "{:?} round {round}: found {is_found}, {others:?}, in {raw:?}",
                    class.code
                ));
            }
        }
        let found = told.iter().filter(|(is_found, ..)| *is_found).count();
        println!("| {:?} | {rounds} | {found} | {counts:?} |", class.code);
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn is_at(finding: &Finding, at: &At) -> bool {
    finding.witnesses.iter().any(|witness| match at {
        At::Faces(faces) => witness.faces.iter().any(|face| faces.contains(&face.index)),
        At::Vertices(vertices) => vertices.iter().all(|v| witness.vertices.iter().any(|w| w.index == *v)),
    })
}

// --- small geometry --------------------------------------------------------------------------------------------------

fn sum(a: Point, b: Point, share: f64) -> Point {
    std::array::from_fn(|k| a[k] + b[k] * share)
}

fn minus(a: Point, b: Point) -> Point {
    sum(a, b, -1.0)
}

fn cross(u: Point, v: Point) -> Point {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

fn length(u: Point) -> f64 {
    u.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn unit(u: Point) -> Point {
    u.map(|x| x / length(u))
}

fn corners(raw: &RawSoup, t: usize) -> [Point; 3] {
    raw.triangles[t].map(|v| raw.positions[v as usize])
}

fn diagonal(raw: &RawSoup) -> f64 {
    let extent = |k: usize| {
        let values = || raw.positions.iter().map(|p| p[k]);
        values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
    };
    length([extent(0), extent(1), extent(2)])
}

/// The middle of a face, its outward unit normal and the length of its shortest edge.
fn face(raw: &RawSoup, t: usize) -> (Point, Point, f64) {
    let [a, b, c] = corners(raw, t);
    let edges = [minus(b, a), minus(c, b), minus(a, c)];
    let middle = std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0);
    (middle, unit(cross(edges[0], minus(c, a))), edges.map(length).into_iter().fold(f64::MAX, f64::min))
}

/// A tetrahedron with its tip at a point and its foot in a direction, outward.
fn pointing(tip: Point, direction: Point, size: f64) -> RawSoup {
    let away = if direction[0].abs() < 0.7 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let u = unit(cross(direction, away));
    let v = cross(direction, u);
    let foot = |x: f64, y: f64| sum(sum(sum(tip, direction, size), u, x * size), v, y * size);
    let positions = vec![foot(0.5, 0.0), foot(-0.25, 0.433), foot(-0.25, -0.433), tip];
    let [a, b, c] = [0, 1, 2].map(|i| minus(positions[i], tip));
    let is_outward = cross(a, b).iter().zip(c).map(|(x, y)| x * y).sum::<f64>() < 0.0;
    let raw = RawSoup { positions, ..tetrahedron() };
    if is_outward { raw } else { raw.inside_out() }
}

/// Adds a part; the numbers of its faces.
fn with_part(raw: &RawSoup, part: &RawSoup) -> Planted {
    let first = raw.triangles.len() as u32;
    let faces = (first..first + part.triangles.len() as u32).collect();
    Planted { raw: raw.clone().with(part), lines: "", at: At::Faces(faces) }
}

/// Some place well outside.
fn beside(raw: &RawSoup, random: &mut Random) -> Point {
    let far = raw.positions.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    std::array::from_fn(|k| far * if k == 0 { 1.5 + random.unit() } else { random.unit() })
}

fn sized(raw: &RawSoup, part: RawSoup, share: f64, random: &mut Random) -> Planted {
    with_part(raw, &part.scaled(share * diagonal(raw)).moved(beside(raw, random)))
}

// --- what is planted -------------------------------------------------------------------------------------------------

fn changed(raw: &RawSoup, at: At, change: impl FnOnce(&mut RawSoup)) -> Planted {
    let mut raw = raw.clone();
    change(&mut raw);
    Planted { raw, lines: "", at }
}

fn any_face(raw: &RawSoup, random: &mut Random) -> (usize, [u32; 3]) {
    let t = random.below(raw.triangles.len());
    (t, raw.triangles[t])
}

fn without_face(raw: &RawSoup, random: &mut Random) -> Planted {
    let (_, at) = any_face(raw, random);
    changed(raw, At::Vertices(at.to_vec()), |raw| raw.triangles.retain(|other| *other != at))
}

fn with_turned_face(raw: &RawSoup, random: &mut Random) -> Planted {
    let (t, _) = any_face(raw, random);
    changed(raw, At::Faces(vec![t as u32]), |raw| raw.triangles[t].swap(0, 1))
}

fn with_face(raw: &RawSoup, corners: [u32; 3]) -> Planted {
    changed(raw, At::Faces(vec![raw.triangles.len() as u32]), |raw| raw.triangles.push(corners))
}

fn with_copy(raw: &RawSoup, random: &mut Random) -> Planted {
    let (_, [a, b, c]) = any_face(raw, random);
    with_face(raw, [b, c, a])
}

fn with_back(raw: &RawSoup, random: &mut Random) -> Planted {
    let (_, [a, b, c]) = any_face(raw, random);
    with_face(raw, [c, b, a])
}

fn with_coincident_corners(raw: &RawSoup, random: &mut Random) -> Planted {
    let (_, [a, b, _]) = any_face(raw, random);
    with_face(raw, [a, a, b])
}

fn with_triangle(raw: &RawSoup, points: [Point; 3]) -> Planted {
    with_part(raw, &RawSoup { positions: points.to_vec(), triangles: vec![[0, 1, 2]] })
}

fn with_line(raw: &RawSoup, random: &mut Random) -> Planted {
    let start = 40.0 + random.below(20) as f64;
    with_triangle(raw, [[start, 9.0, 1.0], [start + 1.0, 9.0, 1.0], [start + 4.0, 9.0, 1.0]])
}

fn with_loose_face(raw: &RawSoup, random: &mut Random) -> Planted {
    let [x, y, z] = beside(raw, random);
    let size = diagonal(raw) * 0.2;
    with_triangle(raw, [[x, y, z], [x + size, y, z], [x, y + size, z]])
}

fn with_nan(raw: &RawSoup, random: &mut Random) -> Planted {
    let mut p = beside(raw, random);
    p[random.below(3)] = f64::NAN;
    let planted = with_triangle(raw, [p, beside(raw, random), beside(raw, random)]);
    Planted { at: At::Vertices(vec![raw.positions.len() as u32]), ..drop_loose(planted, raw) }
}

/// The other corners of a face that cannot be used are those of the mesh, so that they are not isolated.
fn drop_loose(mut planted: Planted, raw: &RawSoup) -> Planted {
    planted.raw.positions.truncate(raw.positions.len() + 1);
    if let Some(face) = planted.raw.triangles.last_mut() {
        *face = [face[0], raw.triangles[0][0], raw.triangles[0][1]];
    }
    planted
}

fn with_infinity(raw: &RawSoup, random: &mut Random) -> Planted {
    let mut p = beside(raw, random);
    p[random.below(3)] = f64::INFINITY;
    drop_loose(with_triangle(raw, [p, beside(raw, random), beside(raw, random)]), raw)
}

fn with_wild_index(raw: &RawSoup, random: &mut Random) -> Planted {
    let (_, [a, b, _]) = any_face(raw, random);
    with_face(raw, [a, b, (raw.positions.len() + 1 + random.below(9)) as u32])
}

fn with_two_corners(raw: &RawSoup, _: &mut Random) -> Planted {
    Planted { raw: raw.clone(), lines: "f 1 2\n", at: At::Faces(vec![raw.triangles.len() as u32]) }
}

fn with_loose_vertex(raw: &RawSoup, random: &mut Random) -> Planted {
    let p = beside(raw, random);
    changed(raw, At::Vertices(vec![raw.positions.len() as u32]), |raw| raw.positions.push(p))
}

fn with_tear(raw: &RawSoup, random: &mut Random) -> Planted {
    let (t, [a, _, _]) = any_face(raw, random);
    let new = raw.positions.len() as u32;
    changed(raw, At::Vertices(vec![a, new]), |raw| {
        raw.positions.push(raw.positions[a as usize]);
        raw.triangles[t][0] = new;
    })
}

/// The faces at the first edge of face `t`: itself, the other one, and the corner opposite in that.
fn across(raw: &RawSoup, t: usize) -> (usize, u32) {
    let [a, b, _] = raw.triangles[t];
    let mut others =
        raw.triangles.iter().enumerate().filter(|(i, f)| *i != t && f.contains(&a) && f.contains(&b));
    let (other, corners) = others.next().unwrap();
    (other, corners.iter().copied().find(|&v| v != a && v != b).unwrap())
}

fn with_fin(raw: &RawSoup, random: &mut Random) -> Planted {
    let (t, [a, b, _]) = any_face(raw, random);
    let (other, _) = across(raw, t);
    let ((_, n, _), (_, m, _)) = (face(raw, t), face(raw, other));
    let [p, q] = [a, b].map(|v| raw.positions[v as usize]);
    // Out of the middle of the edge, halfway between both faces.
    let tip = sum(sum(p, minus(q, p), 0.5), unit(sum(n, m, 1.0)), 0.1 * length(minus(q, p)));
    let new = raw.positions.len() as u32;
    changed(raw, At::Vertices(vec![a, b]), |raw| {
        raw.positions.push(tip);
        raw.triangles.push([a, b, new]);
    })
}

/// The vertex that is farthest in some direction, and that direction.
fn extreme(raw: &RawSoup, random: &mut Random) -> (u32, Point) {
    let direction = unit(std::array::from_fn(|_| random.unit() - 0.5));
    let height = |v: &usize| raw.positions[*v].iter().zip(direction).map(|(x, y)| x * y).sum::<f64>();
    let top = (0..raw.positions.len()).max_by(|v, w| height(v).total_cmp(&height(w))).unwrap();
    (top as u32, direction)
}

fn with_cone(raw: &RawSoup, random: &mut Random) -> Planted {
    let (top, direction) = extreme(raw, random);
    let cone = pointing(raw.positions[top as usize], direction, 0.2 * diagonal(raw));
    let tip = raw.positions.len() as u32 + 3;
    let mut planted = with_part(raw, &cone);
    planted.raw.triangles.iter_mut().flatten().filter(|v| **v == tip).for_each(|v| *v = top);
    planted.raw.positions.pop();
    Planted { at: At::Vertices(vec![top]), ..planted }
}

fn with_band(raw: &RawSoup, random: &mut Random) -> Planted {
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.5, 0.5, 1.0]];
    let band = RawSoup { positions, triangles: (0..5).map(|i| [i, (i + 1) % 5, (i + 2) % 5]).collect() };
    sized(raw, band, 0.2, random)
}

fn inside_out(raw: &RawSoup, _: &mut Random) -> Planted {
    let faces = (0..raw.triangles.len() as u32).collect();
    Planted { raw: raw.clone().inside_out(), lines: "", at: At::Faces(faces) }
}

fn with_hidden_part(raw: &RawSoup, random: &mut Random) -> Planted {
    let (t, _) = any_face(raw, random);
    let (middle, normal, size) = face(raw, t);
    with_part(raw, &pointing(sum(middle, normal, -0.01 * size), normal.map(|x| -x), 0.02 * size))
}

fn with_pillow(raw: &RawSoup, random: &mut Random) -> Planted {
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    sized(raw, RawSoup { positions, triangles: vec![[0, 1, 2], [0, 2, 1]] }, 0.2, random)
}

fn with_spike_through_face(raw: &RawSoup, random: &mut Random) -> Planted {
    let (t, _) = any_face(raw, random);
    let (middle, normal, size) = face(raw, t);
    let spike = pointing(sum(middle, normal, -0.02 * size), normal, 0.04 * size);
    Planted { at: At::Faces(vec![t as u32]), ..with_part(raw, &spike) }
}

/// The mesh with a cube beside it, and one of its faces: the corners have few digits, so that what is between them is exact.
fn with_cube(raw: &RawSoup, random: &mut Random) -> (RawSoup, usize) {
    let place = raw.positions.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs())).ceil() + 2.0;
    let t = raw.triangles.len() + random.below(12);
    (raw.clone().with(&cuboid([1.0; 3]).moved([place, 0.0, 0.0])), t)
}

fn with_part_on_face(raw: &RawSoup, random: &mut Random) -> Planted {
    let (raw, t) = with_cube(raw, random);
    let [a, b, c] = corners(&raw, t);
    let inner = |p: Point, q: Point, r: Point| std::array::from_fn(|k| p[k] / 2.0 + q[k] / 4.0 + r[k] / 4.0);
    let (middle, normal, size) = face(&raw, t);
    let foot = [inner(a, b, c), inner(c, a, b), inner(b, c, a)];
    let positions = [&foot[..], &[sum(middle, normal, size / 2.0)]].concat();
    let part = RawSoup { positions, triangles: vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]] };
    Planted { at: At::Faces(vec![t as u32]), ..with_part(&raw, &part) }
}

fn with_tip_on_face(raw: &RawSoup, random: &mut Random) -> Planted {
    let (raw, t) = with_cube(raw, random);
    let [a, b, c] = corners(&raw, t);
    let tip = std::array::from_fn(|k| a[k] / 2.0 + b[k] / 4.0 + c[k] / 4.0);
    let (_, normal, size) = face(&raw, t);
    Planted { at: At::Faces(vec![t as u32]), ..with_part(&raw, &pointing(tip, normal, 0.1 * size)) }
}

fn with_tip_near_face(raw: &RawSoup, random: &mut Random) -> Planted {
    let (t, _) = any_face(raw, random);
    let (middle, normal, size) = face(raw, t);
    let tip = sum(middle, normal, diagonal(raw) * 1e-6 * (1.0 + 7.0 * random.unit()));
    Planted { at: At::Faces(vec![t as u32]), ..with_part(raw, &pointing(tip, normal, 0.05 * size)) }
}

fn with_tip_near_vertex(raw: &RawSoup, random: &mut Random) -> Planted {
    let (top, direction) = extreme(raw, random);
    let apart = diagonal(raw) * 1e-6 * (1.0 + 7.0 * random.unit());
    let tip = sum(raw.positions[top as usize], direction, apart);
    let new = raw.positions.len() as u32 + 3;
    let planted = with_part(raw, &pointing(tip, direction, 0.2 * diagonal(raw)));
    Planted { at: At::Vertices(vec![top, new]), ..planted }
}

/// Divides the first edge of a face, and the face across, close to one end.
fn with_needle(raw: &RawSoup, random: &mut Random) -> Planted {
    let (t, [a, b, c]) = any_face(raw, random);
    let (other, d) = across(raw, t);
    let [p, q, r] = [a, b, c].map(|v| raw.positions[v as usize]);
    let length = |[x, y, z]: [f64; 3]| libm::hypot(libm::hypot(x, y), z);
    // Short beside the face's other edge at `a` as well.
    let share = (length(minus(r, p)) / length(minus(q, p))).min(1.0) / 1024.0;
    let new = raw.positions.len() as u32;
    changed(raw, At::Faces(vec![t as u32]), |raw| {
        raw.positions.push(sum(p, minus(q, p), share));
        raw.triangles[t] = [a, new, c];
        raw.triangles[other] = [new, a, d];
        raw.triangles.extend([[new, b, c], [b, new, d]]);
    })
}

/// Divides a face at a place close to the middle of its first edge.
fn with_cap(raw: &RawSoup, random: &mut Random) -> Planted {
    let (t, [a, b, c]) = any_face(raw, random);
    let [p, q, r] = corners(raw, t);
    let middle = sum(p, minus(q, p), 0.5);
    let new = raw.positions.len() as u32;
    changed(raw, At::Faces(vec![t as u32]), |raw| {
        raw.positions.push(sum(middle, minus(r, middle), 1.0 / 256.0));
        raw.triangles[t] = [a, b, new];
        raw.triangles.extend([[b, c, new], [c, a, new]]);
    })
}

fn with_wedge(raw: &RawSoup, random: &mut Random) -> Planted {
    let mut wedge = crate::solids::prism(1.0);
    for p in &mut wedge.positions {
        *p = [p[0] + p[1], (p[1] - p[0]) * 0.007, p[2]];
    }
    sized(raw, wedge, 0.2, random)
}

fn with_plate(raw: &RawSoup, random: &mut Random) -> Planted {
    sized(raw, cuboid([1.0, 1.0, 1e-5]), 0.2, random)
}

fn with_square(raw: &RawSoup, random: &mut Random) -> Planted {
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    sized(raw, RawSoup { positions, triangles: vec![[0, 1, 2], [0, 2, 3]] }, 0.2, random)
}

fn with_speck(raw: &RawSoup, random: &mut Random) -> Planted {
    sized(raw, tetrahedron(), 1e-3, random)
}

/// Lines of a face of four corners at the end of the file.
fn with_polygon(raw: &RawSoup, lines: &'static str) -> Planted {
    Planted { raw: raw.clone(), lines, at: At::Faces(vec![raw.triangles.len() as u32]) }
}

fn with_bent_polygon(raw: &RawSoup, random: &mut Random) -> Planted {
    let bent = [
        "v 40 0 0\nv 41 0 0\nv 41 1 0.2\nv 40 1 0\nf -4 -3 -2 -1\n",
        "v 40 0 0\nv 44 0 0\nv 44 3 -1\nv 40 3 0\nf -4 -3 -2 -1\n",
    ];
    with_polygon(raw, random.pick(&bent))
}

fn with_notched_polygon(raw: &RawSoup, random: &mut Random) -> Planted {
    let notched = [
        "v 40 0 0\nv 44 0 0\nv 41 1 0\nv 40 4 0\nf -4 -3 -2 -1\n",
        "v 40 0 0\nv 41 1 0\nv 44 0 0\nv 40 4 0\nf -4 -3 -2 -1\n",
    ];
    with_polygon(raw, random.pick(&notched))
}
