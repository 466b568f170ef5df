//! Random holes cut into closed meshes of many kinds, each filled by every method: no patch that is taken adds a defect.

use crate::certificate_soups::verify;
use crate::closed_meshes::{Closed, KINDS, closed_mesh};
use crate::oracle::RawSoup;
use crate::patch_judge::Torn;
use crate::random::Random;
use crate::support::{cases, on_all_cores};
use meshmend::budget::Budget;
use meshmend::certificate::{Condition, Depth, Violation};
use meshmend::formats::Encoding;
use meshmend::geom::DVec3;
use meshmend::mesh::Soup;
use meshmend::repair::Draft;
use meshmend::repair::fill::{FillOptions, FillReport, Method, fill};
use std::collections::{BTreeMap, BTreeSet};

const METHODS: [Method; 6] =
    [Method::Flat, Method::Minimal, Method::Smooth, Method::Creased, Method::Rbf, Method::Auto];

const HOLES: [&str; 10] = [
    "vertices in a ball",
    "triangles in a ball",
    "single triangles",
    "two that touch at a vertex",
    "with an island",
    "grown triangle by triangle",
    "cut by a plane",
    "over a sharp edge",
    "slit along edges",
    "several balls",
];

/// Takes a hole of kind `kind` out of a closed mesh; `None` when hardly anything would be left, or nothing goes.
fn torn(solid: &RawSoup, kind: usize, random: &mut Random) -> Option<RawSoup> {
    let points: Vec<DVec3> = solid.positions.iter().copied().map(DVec3::from_array).collect();
    let corners = |t: &[u32; 3]| t.map(|v| points[v as usize]);
    let used = |random: &mut Random| random_triangle(solid, random)[0] as usize;
    let low = points.iter().copied().fold(points[0], DVec3::min);
    let size = low.distance(points.iter().copied().fold(points[0], DVec3::max));
    let radius = size * random.pick(&[0.03, 0.07, 0.12, 0.2]) * (0.7 + 0.6 * random.unit());
    let mut gone: BTreeSet<usize> = BTreeSet::new();
    let mut take = |is_out: &dyn Fn(&[u32; 3]) -> bool| {
        gone.extend((0..solid.triangles.len()).filter(|&t| is_out(&solid.triangles[t])));
    };
    let middle = |t: &[u32; 3]| corners(t).iter().sum::<DVec3>() / 3.0;
    match kind {
        0 => {
            let center = points[used(random)];
            take(&|t| corners(t).iter().any(|p| p.distance(center) <= radius));
        }
        1 => {
            let center = middle(&random_triangle(solid, random));
            take(&|t| middle(t).distance(center) <= radius);
        }
        2 => {
            let chosen: Vec<[u32; 3]> =
                (0..random.between(1, 4)).map(|_| random_triangle(solid, random)).collect();
            take(&|t| chosen.contains(t));
        }
        3 => {
            let shared = random_triangle(solid, random)[0];
            let mut ring: Vec<u32> =
                solid.triangles.iter().filter(|t| t.contains(&shared)).flatten().copied().collect();
            ring.retain(|&v| v != shared);
            let first = random.pick(&ring);
            let beside: Vec<u32> =
                solid.triangles.iter().filter(|t| t.contains(&first)).flatten().copied().collect();
            let second = ring.iter().copied().find(|v| !beside.contains(v))?;
            take(&|t| t.contains(&first) || t.contains(&second));
        }
        4 => {
            let center = points[used(random)];
            let inner = (0.3 + 0.4 * random.unit()) * radius;
            take(&|t| corners(t).iter().any(|p| (inner..2.0 * radius).contains(&p.distance(center))));
        }
        5 => {
            let mut grown = vec![random_triangle(solid, random)];
            for _ in 0..random.between(1, 40) {
                let from = random.pick(&grown);
                let beside: Vec<[u32; 3]> = solid
                    .triangles
                    .iter()
                    .copied()
                    .filter(|t| !grown.contains(t) && t.iter().filter(|v| from.contains(v)).count() == 2)
                    .collect();
                if !beside.is_empty() {
                    grown.push(random.pick(&beside));
                }
            }
            take(&|t| grown.contains(t));
        }
        6 => {
            let normal = DVec3::from_array(std::array::from_fn(|_| random.unit() - 0.5)).normalize();
            let mut heights: Vec<f64> = points.iter().map(|p| p.dot(normal)).collect();
            heights.sort_by(f64::total_cmp);
            let level = heights[heights.len() - 1 - random.below(heights.len() * 2 / 5)];
            let is_any = random.one_in(2);
            take(&|t| {
                let beyond = corners(t).iter().filter(|p| p.dot(normal) >= level).count();
                beyond == 3 || (is_any && beyond > 0)
            });
        }
        7 => {
            let center = points[sharp_vertex(solid, random) as usize];
            take(&|t| corners(t).iter().any(|p| p.distance(center) <= radius));
        }
        8 => {
            let mut walk = vec![random_triangle(solid, random)[0]];
            for _ in 0..random.between(1, 8) {
                let last = walk[walk.len() - 1];
                let around: Vec<u32> =
                    solid.triangles.iter().filter(|t| t.contains(&last)).flatten().copied().collect();
                let direction = points[last as usize] - points[walk[walk.len().saturating_sub(2)] as usize];
                let ahead = |v: &u32| {
                    (points[*v as usize] - points[last as usize]).normalize_or_zero().dot(direction)
                };
                let next = match walk.len() {
                    1 => random.pick(&around),
                    _ => around.iter().copied().max_by(|a, b| ahead(a).total_cmp(&ahead(b)))?,
                };
                walk.push(next);
            }
            // On one side of each edge, or all around its ends.
            let is_wide = random.one_in(2);
            let runs = |t: &[u32; 3]| {
                walk.windows(2).any(|e| (0..3).any(|c| t[c] == e[0] && t[(c + 1) % 3] == e[1]))
            };
            take(&|t| runs(t) || (is_wide && t.iter().any(|v| walk.contains(v))));
        }
        _ => {
            let centers: Vec<DVec3> = (0..random.between(2, 5)).map(|_| points[used(random)]).collect();
            take(&|t| corners(t).iter().any(|p| centers.iter().any(|c| p.distance(*c) <= 0.6 * radius)));
        }
    }
    let kept = |(t, corners): (usize, &[u32; 3])| (!gone.contains(&t)).then_some(*corners);
    let left: Vec<[u32; 3]> = solid.triangles.iter().enumerate().filter_map(kept).collect();
    (!gone.is_empty() && left.len() >= 8).then(|| of_used_vertices(&solid.positions, &left))
}

/// These triangles and the positions that they use.
fn of_used_vertices(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> RawSoup {
    let used: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let number: BTreeMap<u32, u32> = used.iter().copied().zip(0..).collect();
    RawSoup {
        positions: used.iter().map(|&v| positions[v as usize]).collect(),
        triangles: triangles.iter().map(|t| t.map(|v| number[&v])).collect(),
    }
}

fn random_triangle(solid: &RawSoup, random: &mut Random) -> [u32; 3] {
    random.pick(&solid.triangles)
}

/// The parts that triangles with common vertices make.
fn pieces(soup: &RawSoup) -> usize {
    let mut part: Vec<u32> = (0..soup.positions.len() as u32).collect();
    let mut is_settled = false;
    while !is_settled {
        is_settled = true;
        for t in &soup.triangles {
            let least = t.iter().map(|&v| part[v as usize]).min().unwrap_or(0);
            for &v in t {
                is_settled &= part[v as usize] == least;
                part[v as usize] = least;
            }
        }
    }
    let used: BTreeSet<u32> = soup.triangles.iter().flatten().map(|&v| part[v as usize]).collect();
    used.len()
}

/// The places where the triangles of `torn` are several fans.
fn where_fans_meet(torn: &RawSoup) -> BTreeSet<[u64; 3]> {
    let mut of_vertex: BTreeMap<u32, Vec<&[u32; 3]>> = BTreeMap::new();
    for corners in &torn.triangles {
        corners.iter().for_each(|&v| of_vertex.entry(v).or_default().push(corners));
    }
    let is_one_fan = |(v, star): &(u32, Vec<&[u32; 3]>)| {
        let have_edge = |t: &[u32; 3], u: &[u32; 3]| t.iter().any(|w| w != v && u.contains(w));
        let mut left = star[1..].to_vec();
        let mut open = vec![star[0]];
        while let Some(t) = open.pop() {
            let beside = |u: &&[u32; 3]| have_edge(t, u);
            open.extend(left.iter().copied().filter(|u| beside(u)));
            left.retain(|u| !beside(u));
        }
        left.is_empty()
    };
    let several = of_vertex.into_iter().filter(|own| !is_one_fan(own));
    several.map(|(v, _)| place(torn.positions[v as usize])).collect()
}

/// Zeros of both signs are one place.
fn place(position: [f64; 3]) -> [u64; 3] {
    position.map(|x| (x + 0.0).to_bits())
}

/// True when all that is wrong with `result` is that fans of `torn` stay apart where they meet.
fn are_fans_of(torn: &RawSoup, result: &RawSoup) -> bool {
    let meeting = where_fans_meet(torn);
    let certificate = verify(result, Encoding::StlBinary, Depth::Count { samples: 1000 });
    let is_of_torn = |violation: &Violation| {
        violation.condition == Condition::OneFanPerVertex
            && violation.position.is_some_and(|p| meeting.contains(&place(p.to_array())))
    };
    !certificate.witnesses.is_empty() && certificate.witnesses.iter().all(is_of_torn)
}

/// A vertex on an edge whose faces turn by more than 35 degrees; any vertex when a hundred edges are not sharp.
fn sharp_vertex(solid: &RawSoup, random: &mut Random) -> u32 {
    let normal = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| DVec3::from_array(solid.positions[v as usize]));
        (b - a).cross(c - a).normalize_or_zero()
    };
    let mut vertex = 0;
    for _ in 0..100 {
        let t = random_triangle(solid, random);
        vertex = t[0];
        let has = |u: &&[u32; 3]| (0..3).any(|c| (u[c], u[(c + 1) % 3]) == (t[1], t[0]));
        if solid.triangles.iter().find(has).is_some_and(|u| normal(u).dot(normal(&t)) < 0.82) {
            break;
        }
    }
    vertex
}

fn filled(torn: &RawSoup, method: Method) -> (RawSoup, FillReport) {
    let soup = Soup {
        positions: torn.positions.iter().copied().map(DVec3::from_array).collect(),
        triangles: torn.triangles.clone(),
        face_count: torn.triangles.len() as u32,
        is_f32_exact: true,
        ..Soup::default()
    };
    let (mut draft, _) = Draft::from_soup(&soup);
    let options = FillOptions { method, ..FillOptions::default() };
    let report = fill(&mut draft, &soup, &options, &Budget::unlimited()).unwrap();
    assert_eq!(draft.check(), Vec::<String>::new());
    let positions = draft.positions.iter().map(DVec3::to_array).collect();
    (RawSoup { positions, triangles: draft.triangles }, report)
}

/// What became of the holes of one mesh.
#[derive(Default)]
struct Tally {
    meshes: usize,
    cases: usize,
    /// By what was asked: patches taken, holes left open, results in which all were closed.
    methods: BTreeMap<&'static str, [usize; 3]>,
    /// The same by the kind of hole and of mesh.
    holes: BTreeMap<&'static str, [usize; 3]>,
    kinds: BTreeMap<&'static str, [usize; 3]>,
    /// Patches taken by the method that made them, and patches made but not taken by their reason.
    used: BTreeMap<String, usize>,
    rejected: BTreeMap<String, usize>,
    /// Results of cuts that tore a piece loose, closed as a body that lies in another.
    misnested: usize,
    /// Results in which fans stay apart at a vertex where the cut had left several: no patch between the loops there was sound,
    /// or bodies lean against each other.
    parted: usize,
    faults: Vec<String>,
}

fn name(method: Method) -> &'static str {
    match method {
        Method::Auto => "`auto`",
        Method::Flat => "`flat`",
        Method::Minimal => "`minimal`",
        Method::Smooth => "`smooth`",
        Method::Creased => "`creased`",
        Method::Rbf => "`rbf`",
    }
}

impl Tally {
    fn of_mesh(number: usize, holes: usize) -> Self {
        let Closed { kind, soup: solid, is_inside_out } = closed_mesh(number);
        let mut tally = Self { meshes: 1, ..Self::default() };
        for hole in 0..holes {
            // Every kind of hole in every kind of mesh, also when there are few of them.
            let of_kind = (hole + number * 3) % HOLES.len();
            let mut random = Random::of_round(10_000, number * 100 + hole);
            let cut = |kind: usize, random: &mut Random| (0..20).find_map(|_| torn(&solid, kind, random));
            let (of_kind, torn) = match cut(of_kind, &mut random) {
                Some(torn) => (of_kind, torn),
                // Of a very coarse mesh a ball may leave nothing, or no two vertices have what it takes.
                None => (2, cut(2, &mut random).expect("single triangles leave something")),
            };
            tally.cases += 1;
            let judge = Torn::new(&torn);
            for method in METHODS {
                let (result, report) = filled(&torn, method);
                let place = format!(
                    "mesh {number} ({}), hole {hole} ({}), {}",
                    KINDS[kind],
                    HOLES[of_kind],
                    name(method)
                );
                let found = judge.faults(&result, &report);
                tally.faults.extend(found.into_iter().map(|fault| format!("{place}: {fault}")));
                let closed = report.holes.iter().filter(|hole| hole.used.is_some()).count();
                let open = report.holes.len() - closed;
                let is_whole = open == 0 && !report.holes.is_empty();
                if is_whole {
                    let outward = if is_inside_out { result.clone().inside_out() } else { result };
                    let certificate = verify(&outward, Encoding::StlBinary, Depth::FirstViolation);
                    // A piece that a cut has torn loose and that is closed alone is a body of its own; whether it lies in
                    // another is told by the certificate, and no patch is to blame.
                    let is_parted = pieces(&torn) > pieces(&solid);
                    let is_surface = certificate.p0 && certificate.p1 == Some(true);
                    if is_surface && is_parted {
                        tally.misnested += usize::from(!certificate.is_printable());
                    } else if !is_surface && are_fans_of(&torn, &outward) {
                        tally.parted += 1;
                    } else if !certificate.is_printable() {
                        tally.faults.push(format!("{place}: all closed, and {:?}", certificate.witnesses));
                    }
                }
                let counts = [closed, open, usize::from(is_whole)];
                for (of, key) in [
                    (&mut tally.methods, name(method)),
                    (&mut tally.holes, HOLES[of_kind]),
                    (&mut tally.kinds, KINDS[kind]),
                ] {
                    add(of.entry(key).or_default(), counts);
                }
                for own in &report.holes {
                    assert_eq!(own.asked, method, "{place}");
                    if let Some(used) = own.used {
                        *tally.used.entry(format!("{} by {}", name(method), name(used))).or_default() += 1;
                    }
                    for rejected in &own.rejected {
                        let reason = format!("{} {:?}", name(rejected.method), rejected.reason);
                        *tally.rejected.entry(reason).or_default() += 1;
                    }
                }
            }
        }
        tally
    }

    fn merge(&mut self, other: Self) {
        self.meshes += other.meshes;
        self.cases += other.cases;
        for (own, others) in [
            (&mut self.methods, other.methods),
            (&mut self.holes, other.holes),
            (&mut self.kinds, other.kinds),
        ] {
            others.into_iter().for_each(|(key, counts)| add(own.entry(key).or_default(), counts));
        }
        for (own, others) in [(&mut self.used, other.used), (&mut self.rejected, other.rejected)] {
            others.into_iter().for_each(|(key, count)| *own.entry(key).or_default() += count);
        }
        self.misnested += other.misnested;
        self.parted += other.parted;
        self.faults.extend(other.faults);
    }

    #[allow(clippy::print_stdout, reason = "the campaign's table")]
    fn print(&self) {
        println!("| meshes, seed 1717 | {} | | |", self.meshes);
        println!("| cuts, seed 10000, each closed by every method | {} | | |", self.cases);
        println!("| defects that patches added | {} | | |", self.faults.len());
        println!(
            "| results with a piece that was torn loose and lies in another body | {} | | |",
            self.misnested
        );
        println!("| results with two fans at a vertex, as the cut had left them | {} | | |", self.parted);
        for (what, own) in [("asked", &self.methods), ("holes", &self.holes), ("meshes", &self.kinds)] {
            println!(
                "| **{what}** | patches taken | holes left open | results without a hole, all certified |"
            );
            for (key, [closed, open, whole]) in own {
                println!("| {key} | {closed} | {open} | {whole} |");
            }
        }
        println!("| **asked and used** | patches | | |");
        self.used.iter().for_each(|(key, count)| println!("| {key} | {count} | | |"));
        println!("| **not taken** | patches | | |");
        self.rejected.iter().for_each(|(key, count)| println!("| {key} | {count} | | |"));
    }
}

fn add(own: &mut [usize; 3], counts: [usize; 3]) {
    own.iter_mut().zip(counts).for_each(|(own, count)| *own += count);
}

#[test]
fn random_holes_in_closed_meshes_are_filled_without_a_new_defect() {
    let (meshes, holes) = (cases(KINDS.len(), 100), cases(3, 100));
    let mut tally = Tally::default();
    on_all_cores(meshes, |number| Tally::of_mesh(number, holes)).into_iter().for_each(|own| tally.merge(own));
    println!("| | | | |\n| --- | --- | --- | --- |");
    tally.print();
    let first: Vec<&String> = tally.faults.iter().take(20).collect();
    assert!(tally.faults.is_empty(), "{} faults: {first:#?}", tally.faults.len());
    // Where loops meet in a vertex, one patch closes them.
    assert!(tally.parted * 1000 <= tally.cases * METHODS.len(), "{} results with two fans", tally.parted);
    // What is not closed is told, and it is the exception.
    for (method, [closed, open, _]) in &tally.methods {
        assert!(open * 20 <= closed + open, "{method}: {open} open, {closed} closed");
    }
}
