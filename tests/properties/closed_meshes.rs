//! Closed meshes of many kinds, made by code: round, flat, turned, noisy, thin, with several bodies.

use crate::certificate_soups::verify;
use crate::oracle::RawSoup;
use crate::random::Random;
use crate::solids::{tetrahedron, voxels};
use meshmend::certificate::Depth;
use meshmend::formats::Encoding;
use meshmend::geom::DVec3;
use std::collections::BTreeMap;

/// What [`closed_mesh`] makes, in turn.
pub(crate) const KINDS: [&str; 12] = [
    "ellipsoid",
    "bumpy ball",
    "noisy ball",
    "torus",
    "gear",
    "cylinder with round edges",
    "box",
    "box in another triangulation",
    "thin plate",
    "hollow ball with a thin wall",
    "body with a small one away from it",
    "part with long thin triangles",
];

/// A mesh, and whether its faces look inward.
pub(crate) struct Closed {
    pub(crate) kind: usize,
    pub(crate) soup: RawSoup,
    pub(crate) is_inside_out: bool,
}

/// The valid solid of this number, of kind `number % 12`, for some numbers inside out; of float32 coordinates.
pub(crate) fn closed_mesh(number: usize) -> Closed {
    let kind = number % KINDS.len();
    let mut random = Random::of_round(1_717, number);
    let is_solid = |soup: &RawSoup| verify(soup, Encoding::StlBinary, Depth::FirstViolation).is_printable();
    for _ in 0..100 {
        let plain = rounded(of_kind(kind, &mut random));
        let size = random.pick(&[1.0, 1.0, 0.01, 25.4, 1000.0]);
        let by = random.pick(&[0.0, 0.0, 3.0, -50.0]) * size;
        let placed = rounded(plain.clone().scaled(size).moved([by, 2.0 * by, -by]));
        // Far from the origin, vertices may round together.
        if let Some(soup) = [placed, plain].into_iter().find(is_solid) {
            let is_inside_out = random.one_in(5);
            return Closed {
                kind,
                soup: if is_inside_out { soup.inside_out() } else { soup },
                is_inside_out,
            };
        }
    }
    panic!("no valid {}", KINDS[kind]);
}

fn rounded(soup: RawSoup) -> RawSoup {
    soup.map(|p| p.map(|x| f64::from(x as f32)))
}

fn of_kind(kind: usize, random: &mut Random) -> RawSoup {
    match kind {
        0 => {
            let axes: [f64; 3] = std::array::from_fn(|_| 0.5 + random.unit());
            sphere(random.pick(&[2, 3])).map(|p| std::array::from_fn(|k| p[k] * axes[k]))
        }
        1 => {
            let (n, phase) = (f64::from(random.between(2, 5)), random.unit());
            with_radius(sphere(3), |[x, y, z]| 1.0 + 0.15 * (n * x + phase).sin() * (n * y - z).cos())
        }
        2 => {
            let noise = random.pick(&[0.01, 0.05, 0.2]);
            with_radius(sphere(random.pick(&[2, 3])), |_| 1.0 + noise * (random.unit() - 0.5))
        }
        3 => round_torus(random.between(10, 28) as u32, random.between(6, 14) as u32),
        4 => gear(random.between(18, 40) as u32, random.between(6, 12) as u32),
        5 => round_edged(random),
        6 => fine_box(std::array::from_fn(|_| random.between(2, 7))),
        7 => {
            let soup = fine_box(std::array::from_fn(|_| random.between(2, 6)));
            turned_over(soup, random)
        }
        8 => match random.below(2) {
            0 => fine_box([random.between(4, 9), random.between(4, 9), 1]),
            _ => sphere(3).map(|[x, y, z]| [x, y, z.signum() * z.abs().min(0.5) * 0.08]),
        },
        9 => {
            let wall = random.pick(&[0.1, 0.03]);
            let outer = with_radius(sphere(3), |[x, ..]| 1.0 + 0.1 * x);
            let inner = outer.clone().scaled(1.0 - wall).inside_out();
            outer.with(&inner)
        }
        10 => {
            let small = match random.below(3) {
                0 => tetrahedron(),
                1 => sphere(1),
                _ => round_torus(8, 5),
            };
            let body = match random.below(3) {
                0 => sphere(3),
                1 => round_torus(20, 10),
                _ => fine_box([5, 4, 3]).scaled(4.0),
            };
            body.with(&small.scaled(0.02 + 0.05 * random.unit()).moved([2.0, 0.3, -0.2]))
        }
        _ => with_thin_triangles(random),
    }
}

/// Each vertex of a ball at another distance from its middle: no triangle hides another from there.
fn with_radius(ball: RawSoup, mut radius: impl FnMut([f64; 3]) -> f64) -> RawSoup {
    let mut ball = ball;
    for p in &mut ball.positions {
        let r = radius(*p);
        *p = p.map(|x| x * r);
    }
    ball
}

/// A cylinder whose edges are rounded by a quarter of a circle.
fn round_edged(random: &mut Random) -> RawSoup {
    let (round, steps) = (0.1 + 0.3 * random.unit(), random.between(2, 6));
    let arc = |i: i32| f64::from(i) / f64::from(steps) * std::f64::consts::FRAC_PI_2;
    let mut rows = vec![[0.3, 0.8], [0.6, 0.8]];
    rows.extend((0..=steps).map(arc).map(|a| [1.0 - round + round * a.sin(), 0.8 - round + round * a.cos()]));
    rows.extend([[1.0, 0.2], [1.0, 0.0]]);
    let below: Vec<[f64; 2]> = rows.iter().rev().skip(1).map(|&[radius, z]| [radius, -z]).collect();
    rows.extend(below);
    rows.dedup();
    revolved(&rows, random.between(12, 32) as u32)
}

/// As CAD programs write them: turned parts, rings with a rectangle as their section, cells in rows.
fn with_thin_triangles(random: &mut Random) -> RawSoup {
    match random.below(3) {
        0 => {
            let mut rows = Vec::new();
            let mut z = 0.0;
            for _ in 0..random.between(2, 4) {
                let radius = 0.2 + random.unit();
                let next = z - 0.3 - random.unit();
                rows.extend([[radius, z], [radius, next]]);
                z = next;
            }
            revolved(&rows, random.between(12, 48) as u32)
        }
        1 => {
            let [inner, outer, height] =
                [0.4 + 0.3 * random.unit(), 1.0 + random.unit(), 0.05 + random.unit()];
            let section = [[outer, 0.0], [outer, height], [inner, height], [inner, 0.0]];
            let around = random.between(12, 64) as u32;
            torus(around, 4, |a, b| {
                let [r, z] = section[(b / std::f64::consts::FRAC_PI_2).round() as usize % 4];
                [r * a.cos(), r * a.sin(), z]
            })
        }
        _ => {
            let mut cells = vec![[0, 0, 0]];
            while cells.len() < 5 {
                let mut cell = random.pick(&cells);
                cell[random.below(3)] += random.pick(&[-1, 1]);
                if !cells.contains(&cell) {
                    cells.push(cell);
                }
            }
            let parts = random.between(1, 3) as i64;
            let finer: Vec<[i64; 3]> = cells
                .iter()
                .flat_map(|c| {
                    (0..parts.pow(3)).map(move |i| {
                        let part = [i % parts, i / parts % parts, i / parts / parts];
                        std::array::from_fn(|k| c[k] * parts + part[k])
                    })
                })
                .collect();
            voxels(&finer).map(|[x, y, z]| [x, 0.7 * y, 0.4 * z])
        }
    }
}

/// The same surface with about half of its edges inside flat faces turned.
fn turned_over(mut soup: RawSoup, random: &mut Random) -> RawSoup {
    for _ in 0..3 * soup.triangles.len() {
        let t = random.below(soup.triangles.len());
        let c = random.below(3);
        let [a, b, p] = [0, 1, 2].map(|i| soup.triangles[t][(c + i) % 3]);
        let has = |u: &[u32; 3]| (0..3).any(|i| (u[i], u[(i + 1) % 3]) == (b, a));
        let Some(other) = soup.triangles.iter().position(has) else { continue };
        let Some(q) = soup.triangles[other].into_iter().find(|v| ![a, b].contains(v)) else { continue };
        let normal = |t: [u32; 3]| {
            let [a, b, c] = t.map(|v| DVec3::from_array(soup.positions[v as usize]));
            (b - a).cross(c - a)
        };
        let (one, two) = ([a, q, p], [q, b, p]);
        let before = normal([a, b, p]).normalize();
        let is_flat = before.dot(normal([b, a, q]).normalize()) > 1.0 - 1e-12;
        let is_sound = |t| normal(t).dot(before) > 1e-6;
        if is_flat && is_sound(one) && is_sound(two) {
            (soup.triangles[t], soup.triangles[other]) = (one, two);
        }
    }
    soup
}

/// A body of rings around the z axis, given by their radius and height from the top down, closed by fans.
fn revolved(rows: &[[f64; 2]], around: u32) -> RawSoup {
    let mut positions = vec![[0.0, 0.0, rows[0][1]], [0.0, 0.0, rows[rows.len() - 1][1]]];
    for &[radius, z] in rows {
        positions.extend((0..around).map(|i| {
            let angle = f64::from(i) * std::f64::consts::TAU / f64::from(around);
            [radius * angle.cos(), radius * angle.sin(), z]
        }));
    }
    let at = |row: u32, i: u32| 2 + row * around + i % around;
    let last = rows.len() as u32 - 1;
    let mut triangles = Vec::new();
    for i in 0..around {
        triangles.extend([[0, at(0, i), at(0, i + 1)], [1, at(last, i + 1), at(last, i)]]);
        for row in 0..last {
            let [a, b, c, d] = [at(row, i), at(row + 1, i), at(row + 1, i + 1), at(row, i + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    rounded(RawSoup { positions, triangles })
}

/// A can of radius 1 from -0.8 to 0.8, of about equal triangles.
pub(crate) fn can() -> RawSoup {
    let disk: Vec<[f64; 2]> = (1..=10).map(|i| [f64::from(i) / 10.0, 0.8]).collect();
    let wall = (1..16).map(|i| [1.0, 0.8 - f64::from(i) / 10.0]);
    let below = disk.iter().rev().map(|&[radius, z]| [radius, -z]);
    let rows: Vec<[f64; 2]> = disk.iter().copied().chain(wall).chain(below).collect();
    revolved(&rows, 64)
}

/// A closed surface over a grid that is closed both ways.
fn torus(around: u32, across: u32, place: impl Fn(f64, f64) -> [f64; 3]) -> RawSoup {
    let vertex = |i: u32, k: u32| (i % around) * across + k % across;
    let turn = |i: u32, n: u32| f64::from(i) * std::f64::consts::TAU / f64::from(n);
    let cells = (0..around * across).map(|i| (i / across, i % across));
    RawSoup {
        positions: cells
            .clone()
            .map(|(i, k)| place(turn(i, around), turn(k, across)).map(|x| f64::from(x as f32)))
            .collect(),
        triangles: cells
            .flat_map(|(i, k)| {
                let [a, b, c, d] = [vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1), vertex(i, k + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect(),
    }
}

pub(crate) fn round_torus(around: u32, across: u32) -> RawSoup {
    torus(around, across, |a, b| {
        let r = 1.0 + 0.4 * b.cos();
        [r * a.cos(), r * a.sin(), 0.4 * b.sin()]
    })
}

/// A torus with teeth.
fn gear(around: u32, across: u32) -> RawSoup {
    torus(around, across, |a, b| {
        let r = 2.0 + (0.6 + if (6.0 * a).sin() > 0.0 { 0.2 } else { 0.0 }) * b.cos();
        [r * a.cos(), r * a.sin(), 0.5 * b.sin()]
    })
}

/// A sphere: an octahedron whose faces are divided `levels` times.
pub(crate) fn sphere(levels: u32) -> RawSoup {
    let mut points: Vec<DVec3> =
        [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z].to_vec();
    let mut triangles: Vec<[u32; 3]> =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..levels {
        let mut middles = BTreeMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in triangles {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b): (u32, u32)| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    points.push(((points[a as usize] + points[b as usize]) / 2.0).normalize());
                    points.len() as u32 - 1
                })
            });
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    RawSoup { positions: points.iter().map(|p| p.as_vec3().as_dvec3().to_array()).collect(), triangles }
}

/// A box of squares of a twentieth, each in two triangles, around the origin; `half` is half of its sides in twentieths.
pub(crate) fn fine_box(half: [i32; 3]) -> RawSoup {
    let mut positions = Vec::new();
    let mut number = BTreeMap::new();
    let mut triangles = Vec::new();
    for axis in 0..3 {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        for side in [-1, 1] {
            let mut vertex = |i: i32, k: i32| {
                let mut at = [0; 3];
                (at[axis], at[u], at[v]) = (side * half[axis], i, k);
                *number.entry(at).or_insert_with(|| {
                    positions.push(at.map(|x| f64::from(x as f32 / 20.0)));
                    positions.len() as u32 - 1
                })
            };
            for (i, k) in (-half[u]..half[u]).flat_map(|i| (-half[v]..half[v]).map(move |k| (i, k))) {
                let [a, b, c, d] = [vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1), vertex(i, k + 1)];
                let squares = if side > 0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
                triangles.extend(squares);
            }
        }
    }
    RawSoup { positions, triangles }
}

/// Takes out the triangles with a vertex in a ball.
pub(crate) fn cut(mut soup: RawSoup, center: [f64; 3], radius: f64) -> RawSoup {
    let center = DVec3::from_array(center);
    let is_in = |v: u32| DVec3::from_array(soup.positions[v as usize]).distance(center) < radius;
    let kept: Vec<[u32; 3]> =
        soup.triangles.iter().copied().filter(|t| !t.iter().any(|&v| is_in(v))).collect();
    soup.triangles = kept;
    soup
}
