//! Every repair step on random meshes of polygons: squares and polygons of more corners, each from any corner and wound
//! either way, some twice, some without area, and elements far away from the body.

use crate::random::Random;
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::formats::{Encoding, ReadOptions, read};
use meshmend::mesh::Soup;
use meshmend::pipeline::{Operation, Options, Outcome, run};
use meshmend::repair::cut::CutOptions;
use meshmend::repair::duplicates::OppositePairs;
use meshmend::repair::nest::NestOptions;
use meshmend::repair::pair_sheets::Across;
use meshmend::repair::polygons::DegenerateFaces;
use meshmend::repair::snap::SnapOptions;
use meshmend::repair::{
    Changes, Draft, collinear, contact, cut, degenerate, duplicates, fill, nest, orient, pair_sheets, pinch,
    polygons, snap, t_vertices, weld,
};
use std::fmt::Write as _;

/// Points, and faces over them, from 0.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mesh {
    pub(crate) points: Vec<[i32; 3]>,
    pub(crate) faces: Vec<Vec<u32>>,
}

impl Mesh {
    pub(crate) fn obj(&self) -> String {
        let mut text = String::new();
        for [x, y, z] in &self.points {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        for face in &self.faces {
            let corners: Vec<String> = face.iter().map(|v| (v + 1).to_string()).collect();
            writeln!(text, "f {}", corners.join(" ")).unwrap();
        }
        text
    }
}

/// Corners of a convex polygon, counter-clockwise.
const OUTLINES: [&[[i32; 2]]; 4] = [
    &[[0, 0], [6, 0], [6, 4], [0, 4]],
    &[[0, 0], [4, -2], [8, 0], [6, 5], [2, 5]],
    &[[0, 0], [3, -2], [6, 0], [6, 4], [3, 6], [0, 4]],
    &[[0, 0], [5, 0], [0, 5]],
];

/// A prism: two outlines and a square for each side; the volume in units of a half.
pub(crate) fn prism(random: &mut Random, mesh: &mut Mesh, at: [i32; 3]) -> i32 {
    let outline = random.pick(&OUTLINES);
    let (n, height) = (outline.len() as u32, random.between(1, 7));
    let base = mesh.points.len() as u32;
    for z in [0, height] {
        mesh.points.extend(outline.iter().map(|&[x, y]| [at[0] + x, at[1] + y, at[2] + z]));
    }
    mesh.faces.push((0..n).rev().map(|i| base + i).collect());
    mesh.faces.push((n..2 * n).map(|i| base + i).collect());
    mesh.faces.extend((0..n).map(|i| [i, (i + 1) % n, (i + 1) % n + n, i + n].map(|v| base + v).to_vec()));
    let next = |i: usize| outline[(i + 1) % outline.len()];
    let doubled: i32 = outline.iter().enumerate().map(|(i, a)| a[0] * next(i)[1] - a[1] * next(i)[0]).sum();
    doubled * height
}

/// What does not change what a mesh is: other corners first, all of a body turned around, copies of faces, faces without
/// area, vertices of no face.
pub(crate) fn disguise(random: &mut Random, mesh: &mut Mesh) {
    if random.one_in(2) {
        mesh.faces.iter_mut().for_each(|face| face.reverse());
    }
    let copies: Vec<Vec<u32>> = mesh.faces.iter().filter(|_| random.one_in(6)).cloned().collect();
    mesh.faces.extend(copies);
    for face in &mut mesh.faces {
        let start = random.below(face.len());
        face.rotate_left(start);
    }
    for _ in 0..random.below(3) {
        let base = mesh.points.len() as u32;
        let far = random.pick(&[40, 1000, -500]);
        mesh.points.extend((0..4).map(|i| [far + i, far, 7]));
        let without_area: [&[u32]; 5] = [&[0, 0, 0], &[0, 1, 2], &[0, 1, 1], &[0, 2, 1, 3], &[0, 1, 1, 0]];
        mesh.faces.push(random.pick(&without_area).iter().map(|v| base + v).collect());
    }
}

pub(crate) fn soup_of(mesh: &Mesh) -> Soup {
    read(mesh.obj().as_bytes(), Encoding::Obj, &ReadOptions::default(), &Budget::unlimited()).unwrap()
}

/// Every step that needs no choice, in the order of the plan.
fn steps(draft: &mut Draft, soup: &Soup, mut look: impl FnMut(&str, &Draft, &Changes)) {
    let budget = Budget::unlimited();
    let mut step = |name: &str, draft: &mut Draft, run: &mut dyn FnMut(&mut Draft) -> Changes| {
        let changes = run(draft);
        look(name, draft, &changes);
    };
    step("polygons", draft, &mut |d| {
        polygons::split_polygons(d, soup, DegenerateFaces::Split, &budget).unwrap()
    });
    step("weld", draft, &mut |d| weld::weld(d, &budget).unwrap());
    step("degenerate", draft, &mut |d| degenerate::drop_degenerate(d));
    step("collinear", draft, &mut |d| collinear::split_collinear(d, &budget).unwrap());
    step("t vertices", draft, &mut |d| t_vertices::split_t_vertices(d, &budget).unwrap());
    step("duplicates", draft, &mut |d| {
        duplicates::drop_duplicates(d, OppositePairs::default(), &budget).unwrap()
    });
    step("orient", draft, &mut |d| orient::orient(d, &budget).unwrap());
    step("pair sheets", draft, &mut |d| pair_sheets::pair_sheets(d, Across::Solid, &budget).unwrap());
    step("cut", draft, &mut |d| cut::cut(d, &CutOptions::default(), &budget).unwrap());
    step("pinch", draft, &mut |d| pinch::pinch(d, &Default::default(), Default::default(), &budget).unwrap());
    step("snap", draft, &mut |d| {
        snap::snap(d, &SnapOptions { epsilon: Some(0.0), ..SnapOptions::default() }, &budget).unwrap()
    });
    step("fill", draft, &mut |d| fill::fill_holes(d, &budget).unwrap());
    step("contacts", draft, &mut |d| contact::open_contacts(d, &budget).unwrap());
    step("nest", draft, &mut |d| nest::nest(d, &NestOptions::default(), &budget).unwrap());
}

/// Faces turned and taken away by chance, so that steps meet what no body is.
pub(crate) fn break_up(random: &mut Random, mesh: &mut Mesh) {
    mesh.faces.retain(|_| !random.one_in(8));
    for face in &mut mesh.faces {
        if random.one_in(6) {
            face.reverse();
        }
        if random.one_in(12) {
            let (i, j) = (random.below(face.len()), random.below(face.len()));
            face.swap(i, j);
        }
    }
}

#[test]
fn every_step_keeps_a_draft_of_random_polygons_sound() {
    let mut random = Random::new(71);
    for case in 0..cases(1_500, 60_000) {
        let mut mesh = Mesh::default();
        for _ in 0..1 + random.below(2) {
            let at = [0, 1, 2].map(|_| random.pick(&[0, 0, 3, 6, 20]));
            prism(&mut random, &mut mesh, at);
        }
        disguise(&mut random, &mut mesh);
        break_up(&mut random, &mut mesh);
        let soup = soup_of(&mesh);
        let (mut draft, _) = Draft::from_soup(&soup);
        steps(&mut draft, &soup, |name, draft, _| {
            assert_eq!(draft.check(), Vec::<String>::new(), "case {case}, {name}: {mesh:?}");
        });
    }
}

#[test]
fn a_disguised_body_of_polygons_is_itself_again_without_a_vertex_that_moves() {
    let mut random = Random::new(72);
    for case in 0..cases(400, 20_000) {
        let mut mesh = Mesh::default();
        let mut six_volumes = 0;
        for i in 0..1 + random.below(3) as i32 {
            six_volumes += prism(&mut random, &mut mesh, [20 * i, 0, 0]);
        }
        disguise(&mut random, &mut mesh);
        let text = mesh.obj();
        let answer =
            run(Operation::Repair, text.as_bytes(), &Options::default(), &Budget::unlimited()).unwrap();
        let report = answer.report;
        let is_local = matches!(report.outcome, Some(Outcome::Repaired | Outcome::Identical));
        assert!(is_local, "case {case}: {:?} {:?}\n{text}", report.outcome, report.refusal);
        let described = report.after.or(report.before).unwrap();
        assert_eq!(described.measures.volume, Some(f64::from(six_volumes) / 2.0), "case {case}\n{text}");
        assert!(report.actions.iter().all(|action| action.move_max == 0.0), "case {case}\n{text}");
    }
}
