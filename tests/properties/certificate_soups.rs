//! The certificate against a second opinion, on random small soups that have everything wrong and right with them.

use crate::oracle::{Doubt, Opinion, RawSoup, judge_indices, judge_welded, weld};
use crate::random::Random;
use crate::raw_files::{ENCODINGS, encode};
use crate::solids::{any_solid, cube, prism, voxels};
use crate::support::{cases, on_all_cores};
use meshmend::budget::Budget;
use meshmend::certificate::{Certificate, Condition, Depth, Violation, certify};
use meshmend::formats::{Encoding, Format, ReadOptions};

/// A soup as a reader that rounds to f64, and one that rounds to f32, get it from the file.
pub(crate) struct Readings {
    f64: RawSoup,
    f32: RawSoup,
    has_indices: bool,
}

impl Readings {
    pub(crate) fn of(soup: &RawSoup, encoding: Encoding) -> Self {
        let is_stl = encoding.format() == Format::Stl;
        let is_text =
            matches!(encoding, Encoding::Obj | Encoding::Off | Encoding::PlyAscii | Encoding::StlAscii);
        let rounded = soup.clone().map(|p| {
            p.map(|x| f64::from(if is_text { format!("{x:?}").parse().unwrap() } else { x as f32 }))
        });
        let f64 = if encoding == Encoding::StlBinary { rounded.clone() } else { soup.clone() };
        Self { f64, f32: rounded, has_indices: !is_stl }
    }

    /// The opinions on all readings of the contract as one: the largest counts; solid where every reading is.
    pub(crate) fn judge(&self) -> Opinion {
        let of_f64 = judge_welded(&self.f64);
        let welded = [of_f64, if self.f32 == self.f64 { of_f64 } else { judge_welded(&self.f32) }];
        let solid = welded.map(|o| o.is_solid);
        let is_solid = if solid.contains(&Some(false)) { Some(false) } else { solid[0].and(solid[1]) };
        let indexed = if self.has_indices {
            vec![judge_indices(&self.f64), judge_indices(&self.f32)]
        } else {
            Vec::new()
        };
        let most = |count: fn(&Opinion) -> u64| welded.iter().chain(&indexed).map(count).max().unwrap();
        Opinion {
            unusable: most(|o| o.unusable),
            degenerate: most(|o| o.degenerate),
            duplicate: most(|o| o.duplicate),
            edges_without_two_triangles: most(|o| o.edges_without_two_triangles),
            edges_in_one_direction: most(|o| o.edges_in_one_direction),
            singular_vertices: most(|o| o.singular_vertices),
            contacts: most(|o| o.contacts),
            is_solid,
        }
    }

    /// Whether the violation is really there, in the reading it names.
    fn show(&self, violation: &Violation) -> bool {
        let soup = if violation.reading.is_f32 { &self.f32 } else { &self.f64 };
        let soup = if violation.reading.is_as_indexed { soup.clone() } else { weld(soup) };
        let doubt = Doubt::about(&soup);
        match (violation.condition, &violation.faces[..]) {
            (Condition::Usable, [t]) => doubt.is_unusable(*t),
            (Condition::Usable, []) => soup.positions.iter().flatten().any(|x| !x.is_finite()),
            (Condition::NonDegenerate, [t]) => doubt.is_degenerate(*t),
            (Condition::Distinct, &[a, b]) => doubt.have_same_vertices(a, b),
            (Condition::TwoTrianglesPerEdge, faces) => faces.iter().all(|&t| doubt.has_bad_edge(t, false)),
            (Condition::OppositeDirections, faces @ [_, _]) => {
                faces.iter().all(|&t| doubt.has_bad_edge(t, true))
            }
            (Condition::OneFanPerVertex, faces @ [_, _, ..]) => {
                faces.iter().all(|&t| doubt.has_singular_corner(t))
            }
            (Condition::Embedded, &[a, b]) => doubt.meet(a, b),
            (Condition::Alternating, [t]) => doubt.winding_in_front(*t) != 0,
            _ => false,
        }
    }
}

pub(crate) fn verify(soup: &RawSoup, encoding: Encoding, depth: Depth) -> Certificate {
    let bytes = encode(soup, encoding);
    certify(&bytes, encoding, &ReadOptions::default(), depth, &Budget::unlimited()).unwrap()
}

/// Fails unless the certificate of `soup` in `encoding` says exactly what the second opinion says; returns that.
pub(crate) fn assert_agreement(soup: &RawSoup, encoding: Encoding, name: &str) -> Opinion {
    let readings = Readings::of(soup, encoding);
    let opinion = readings.judge();
    let full = verify(soup, encoding, Depth::Count { samples: 3 });
    let said = &full.violations;
    let context = || format!("{name} as {}: {soup:?}\n{full:?}\n{opinion:?}", encoding.name());
    for (ours, theirs) in [
        (said.degenerate, opinion.degenerate),
        (said.duplicate, opinion.duplicate),
        (said.edges_without_two_triangles, opinion.edges_without_two_triangles),
        (said.edges_in_one_direction, opinion.edges_in_one_direction),
        (said.singular_vertices, opinion.singular_vertices),
        (said.contacts, opinion.contacts),
    ] {
        assert_eq!(ours, Some(theirs), "{}", context());
    }
    assert_eq!(said.unusable.is_some_and(|n| n > 0), opinion.unusable > 0, "{}", context());
    assert_eq!(full.p0, opinion.p0(), "{}", context());
    assert_eq!(full.p1, Some(opinion.contacts == 0), "{}", context());
    assert_eq!(full.p2, opinion.is_solid, "{}", context());
    assert_eq!(full.witnesses.is_empty(), full.is_printable(), "{}", context());
    for witness in &full.witnesses {
        assert!(readings.show(witness), "{witness:?} is not there\n{}", context());
    }
    let brief = verify(soup, encoding, Depth::FirstViolation);
    assert_eq!(brief.is_printable(), full.is_printable(), "{}", context());
    assert!(brief.witnesses.len() <= 1, "{brief:?}\n{}", context());
    if let (Some(first), Some(of_full)) = (brief.witnesses.first(), full.witnesses.first()) {
        assert_eq!((first.condition, first.reading), (of_full.condition, of_full.reading), "{}", context());
        assert!(readings.show(first), "{first:?} is not there\n{}", context());
    }
    opinion
}

#[test]
fn certificate_agrees_with_rational_arithmetic_on_random_small_soups() {
    let rounds = cases(2_000, 100_000);
    let opinions = on_all_cores(rounds, |round| {
        let mut random = Random::new(round as u64);
        let encoding = random.pick(&ENCODINGS);
        let soup = without_what_the_format_cannot_hold(random_soup(&mut random), encoding);
        assert_agreement(&soup, encoding, &format!("round {round}"))
    });
    println!("| random small soups, seeds 0 and up | {rounds} | all agree |");
    type IsOne = fn(&Opinion) -> bool;
    let kinds: [(&str, IsOne); 10] = [
        ("valid", Opinion::is_valid),
        ("with an unusable face or vertex", |o| o.unusable > 0),
        ("with a degenerate triangle", |o| o.degenerate > 0),
        ("with a duplicate", |o| o.duplicate > 0),
        ("with an edge without two triangles", |o| o.edges_without_two_triangles > 0),
        ("with an edge in one direction", |o| o.edges_in_one_direction > 0),
        ("with a singular vertex", |o| o.singular_vertices > 0),
        ("with a contact", |o| o.contacts > 0),
        ("with a contact, but P0 holds", |o| o.p0() && o.contacts > 0),
        ("misnested, but P0 and P1 hold", |o| o.is_solid == Some(false)),
    ];
    for (name, is_one) in kinds {
        let count = opinions.iter().filter(|o| is_one(o)).count();
        println!("| of these {name} | {count} | |");
        let least = if name == "valid" { rounds / 5 } else { rounds / 100 };
        assert!(count >= least, "{name}: only {count} of {rounds}");
    }
}

/// STL has no vertices but those of its triangles.
pub(crate) fn without_what_the_format_cannot_hold(mut soup: RawSoup, encoding: Encoding) -> RawSoup {
    if encoding.format() == Format::Stl {
        let corners: Vec<u32> = soup.triangles.iter().flatten().copied().collect();
        soup.positions = corners.iter().map(|&v| soup.positions[v as usize]).collect();
        soup.triangles = (0..corners.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    }
    soup
}

pub(crate) fn random_soup(random: &mut Random) -> RawSoup {
    let mut soup = match random.below(9) {
        0 => loose_triangles(random),
        1 => any_solid(random),
        2 | 3 => several_solids(random),
        4 => concentric_cubes(random),
        5 => neighbouring_cubes(random),
        6 => random_voxels(random),
        7 => flat_prisms(random),
        _ => RawSoup::default().with(&any_solid(random)).with(&any_solid(random).moved([7.0, 0.0, 0.0])),
    };
    if random.one_in(2) {
        for _ in 0..=random.below(3) {
            break_something(&mut soup, random);
        }
    }
    place(soup, random)
}

fn loose_triangles(random: &mut Random) -> RawSoup {
    let side = random.between(1, 3);
    let vertex_count = 3 + random.below(6);
    let positions =
        (0..vertex_count).map(|_| std::array::from_fn(|_| f64::from(random.between(0, side)))).collect();
    let triangles = (0..1 + random.below(9))
        .map(|_| std::array::from_fn(|_| random.below(vertex_count) as u32))
        .collect();
    RawSoup { positions, triangles }
}

fn several_solids(random: &mut Random) -> RawSoup {
    let mut soup = RawSoup::default();
    for _ in 0..2 + random.below(2) {
        let size = random.pick(&[0.5, 1.0, 1.0, 2.0, 6.0]);
        let by = std::array::from_fn(|_| f64::from(random.between(-3, 3)));
        let part = any_solid(random).scaled(size).moved(by);
        soup = soup.with(&if random.one_in(4) { part.inside_out() } else { part });
    }
    soup
}

fn concentric_cubes(random: &mut Random) -> RawSoup {
    let mut soup = RawSoup::default();
    let is_right = random.one_in(2);
    for depth in 0..1 + random.below(4) {
        let part = cube().scaled(8.0 - 2.0 * depth as f64).moved([depth as f64; 3]);
        let is_inward = if is_right { depth % 2 == 1 } else { random.one_in(2) };
        soup = soup.with(&if is_inward { part.inside_out() } else { part });
    }
    soup
}

fn neighbouring_cubes(random: &mut Random) -> RawSoup {
    let mut soup = cube();
    for _ in 0..1 + random.below(2) {
        soup = soup.with(&cube().moved(std::array::from_fn(|_| f64::from(random.between(-1, 2)))));
    }
    if random.one_in(2) { weld(&soup) } else { soup }
}

fn random_voxels(random: &mut Random) -> RawSoup {
    let cells: Vec<[i64; 3]> =
        (0..1 + random.below(4)).map(|_| std::array::from_fn(|_| i64::from(random.between(0, 1)))).collect();
    let mut distinct = cells.clone();
    distinct.sort_unstable();
    distinct.dedup();
    voxels(&distinct)
}

fn flat_prisms(random: &mut Random) -> RawSoup {
    let mut soup = RawSoup::default();
    for i in 0..1 + random.below(4) {
        let height = random.pick(&[0.0, 1e-3, 1e-3, 0.5, 1e-6]);
        let by = if random.one_in(5) { [0.5, 0.25, 0.0] } else { [1.5 * i as f64, 0.0, 0.0] };
        soup = soup.with(&prism(height).moved(by));
    }
    soup
}

fn break_something(soup: &mut RawSoup, random: &mut Random) {
    if soup.triangles.is_empty() || soup.positions.is_empty() {
        return;
    }
    let t = random.below(soup.triangles.len());
    let v = random.below(soup.positions.len());
    let other = soup.positions[random.below(soup.positions.len())];
    match random.below(12) {
        0 if soup.triangles.len() > 1 => {
            soup.triangles.remove(t);
        }
        1 => soup.triangles[t].swap(0, 1),
        2 => soup.triangles.push(soup.triangles[t]),
        3 => {
            let [a, b, c] = soup.triangles[t];
            soup.triangles.push([c, b, a]);
        }
        4 => soup.positions[v] = other,
        5 => soup.positions[v] = middle_of(soup, random.below(soup.triangles.len())),
        6 => soup.positions[v][random.below(3)] += random.pick(&[1e-9, -1e-9, 0.25, -1.0, 4.0]),
        7 => soup.triangles[t][random.below(3)] = v as u32,
        8 => split_vertex(soup, t, random.below(3)),
        9 => soup.positions.push(other),
        10 => split_edge(soup, t),
        _ => soup.positions[v][random.below(3)] = random.pick(&[f64::NAN, f64::INFINITY, 1e39, -0.0, 1e-50]),
    }
}

fn middle_of(soup: &RawSoup, t: usize) -> [f64; 3] {
    let corners = soup.triangles[t].map(|v| soup.positions[v as usize]);
    std::array::from_fn(|k| corners.iter().map(|p| p[k] / 3.0).sum())
}

/// One corner gets a vertex of its own at the same position: a seam.
fn split_vertex(soup: &mut RawSoup, t: usize, corner: usize) {
    soup.positions.push(soup.positions[soup.triangles[t][corner] as usize]);
    soup.triangles[t][corner] = soup.positions.len() as u32 - 1;
}

/// A vertex in the middle of an edge, on one side or, by a triangle without area, on both.
fn split_edge(soup: &mut RawSoup, t: usize) {
    let [a, b, c] = soup.triangles[t];
    let (p, q) = (soup.positions[a as usize], soup.positions[b as usize]);
    soup.positions.push(std::array::from_fn(|k| (p[k] + q[k]) / 2.0));
    let middle = soup.positions.len() as u32 - 1;
    soup.triangles[t] = [a, middle, c];
    soup.triangles.push([middle, b, c]);
    if a < b {
        soup.triangles.push([a, b, middle]);
    }
}

/// Somewhere else, in another size, and perhaps sheared, so that decimals are not binary fractions.
fn place(soup: RawSoup, random: &mut Random) -> RawSoup {
    let scale = random.pick(&[1.0, 1.0, 1.0, 0.1, 3.0, 1e-3, 25.4, 1e6]);
    let by: [f64; 3] = std::array::from_fn(|_| random.pick(&[0.0, 0.0, 0.0, 0.1, -100.0, 1e4]));
    let shear = random.pick(&[0.0, 0.0, 0.0, 0.5, 1.0 / 3.0]);
    soup.map(|[x, y, z]| {
        let p = [x + shear * y, y, z - shear * x];
        std::array::from_fn(|k| p[k] * scale + by[k])
    })
}
