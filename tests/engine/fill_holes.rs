//! Filling holes from bytes to bytes: what stays, what is added, and what is told of each hole.

use meshmend::analysis::HoleClass;
use meshmend::budget::Budget;
use meshmend::formats::{Encoding, Format, ReadOptions, read};
use meshmend::geom::DVec3;
use meshmend::implicit::{Kernel, RbfOptions};
use meshmend::mesh::{Color, Soup};
use meshmend::pipeline::{
    Answer, ChosenHole, ChosenPlan, Failure, FillHolesChoices, HoleFate, HoleOutcome, Operation, Options,
    Outcome, Require, run,
};
use meshmend::repair::fill::{FillOptions, Method, Rejection};
use std::fmt::Write as _;

/// A sphere of radius 1 as rings of quadrangles between two poles, in OFF, without the faces for which `is_gone` holds by
/// ring and place in it. `is_turned`: all faces the other way around.
fn sphere(n: u32, is_turned: bool, is_gone: impl Fn(u32, u32) -> bool) -> Vec<u8> {
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
        if is_turned {
            corners.reverse();
        }
        corners
    };
    let cells = (0..n).flat_map(|ring| (0..n).map(move |i| (ring, i)));
    let faces: Vec<Vec<u32>> =
        cells.filter(|&(ring, i)| !is_gone(ring, i)).map(|(ring, i)| quad(ring, i)).collect();
    let mut text = format!("OFF\n{} {} 0\n0 0 1\n0 0 -1\n", 2 + (n - 1) * n, faces.len());
    for (ring, i) in (1..n).flat_map(|ring| (0..n).map(move |i| (ring, i))) {
        let (polar, angle) = (
            f64::from(ring) / f64::from(n) * std::f64::consts::PI,
            f64::from(i) / f64::from(n) * std::f64::consts::TAU,
        );
        writeln!(text, "{} {} {}", polar.sin() * angle.cos(), polar.sin() * angle.sin(), polar.cos())
            .unwrap();
    }
    for face in faces {
        let corners: Vec<String> = face.iter().map(u32::to_string).collect();
        writeln!(text, "{} {}", face.len(), corners.join(" ")).unwrap();
    }
    text.into_bytes()
}

/// Two holes: one quadrangle, and three by four of them.
fn with_two_holes() -> Vec<u8> {
    sphere(24, false, |ring, i| (ring, i) == (16, 12) || is_region(ring, i))
}

fn is_region(ring: u32, i: u32) -> bool {
    (8..11).contains(&ring) && (2..6).contains(&i)
}

fn filled(bytes: &[u8], filling: FillHolesChoices) -> Result<Answer, Failure> {
    let options = Options { filling, ..Options::default() };
    run(Operation::FillHoles, bytes, &options, &Budget::unlimited())
}

fn by(method: Method) -> FillHolesChoices {
    FillHolesChoices { fill: FillOptions { method, ..FillOptions::default() }, ..FillHolesChoices::default() }
}

fn only(holes: &[ChosenHole]) -> FillHolesChoices {
    FillHolesChoices { holes: Some(holes.to_vec()), ..FillHolesChoices::default() }
}

fn holes(answer: &Answer) -> &[HoleOutcome] {
    &answer.report.filling.as_ref().unwrap().holes
}

fn soup_of(bytes: &[u8]) -> Soup {
    read(bytes, Encoding::Off, &ReadOptions::default(), &Budget::unlimited()).unwrap()
}

fn output(answer: &Answer) -> &[u8] {
    answer.output.as_ref().unwrap().bytes.as_deref().unwrap()
}

/// Every vertex of `before` is in `after` with the same bits, and every triangle.
fn all_stay(before: &[u8], after: &[u8]) {
    let (before, after) = (soup_of(before), soup_of(after));
    let bits = |soup: &Soup, t: &[u32; 3]| t.map(|v| soup.positions[v as usize].to_array().map(f64::to_bits));
    let kept: std::collections::HashSet<_> = after.triangles.iter().map(|t| bits(&after, t)).collect();
    let lost = before.triangles.iter().filter(|t| !kept.contains(&bits(&before, t))).count();
    assert_eq!(lost, 0, "triangles are gone");
}

#[test]
fn each_method_closes_both_holes_and_leaves_every_triangle_as_it_was() {
    let bytes = with_two_holes();
    for method in [Method::Auto, Method::Flat, Method::Minimal, Method::Smooth, Method::Rbf] {
        let answer = filled(&bytes, by(method)).unwrap();
        assert_eq!(answer.report.outcome, Some(Outcome::Filled), "{method:?}");
        assert!(answer.report.certificate.as_ref().unwrap().is_printable(), "{method:?}");
        assert_eq!(answer.report.identical_triangle_share, Some(1.0));
        all_stay(&bytes, output(&answer));
        let told = holes(&answer);
        assert_eq!(told.iter().map(|hole| hole.loops.clone()).collect::<Vec<_>>(), [[0], [1]]);
        let classes: Vec<_> = told.iter().map(|hole| hole.guess.unwrap().class).collect();
        assert_eq!(classes, [HoleClass::MissingRegion, HoleClass::MissingFace]);
        let share = answer.report.filling.as_ref().unwrap().interpolated_area_share;
        let area: f64 = told.iter().map(|hole| hole.told.as_ref().unwrap().area).sum();
        let all = answer.report.after.as_ref().unwrap().measures.area;
        assert!((share - area / all).abs() < 1e-9 && share > 0.005 && share < 0.05, "{share}");
        for hole in told {
            let report = hole.told.as_ref().unwrap();
            assert_eq!((hole.fate, report.asked), (HoleFate::Filled, method));
            let rejected = report.rejected.len();
            assert!(rejected > 0 || method == Method::Auto || report.used == Some(method), "{report:?}");
        }
    }
}

#[test]
fn smooth_patches_follow_the_sphere_where_flat_ones_cut_across() {
    let bytes = with_two_holes();
    let volume = |method| {
        let answer = filled(&bytes, by(method)).unwrap();
        answer.report.after.unwrap().measures.volume.unwrap()
    };
    let whole =
        run(Operation::Analyze, sphere(24, false, |_, _| false), &Options::default(), &Budget::unlimited());
    let whole = whole.unwrap().report.before.unwrap().measures.volume.unwrap();
    let lost = |method| (volume(method) - whole).abs();
    assert!(lost(Method::Smooth) < lost(Method::Flat) / 2.0);
}

#[test]
fn the_holes_that_are_chosen_are_filled_as_chosen_and_the_others_stay() {
    let bytes = with_two_holes();
    let flat = ChosenHole { number: 0, method: Some(Method::Flat), band_rings: None };
    let answer = filled(&bytes, only(&[flat])).unwrap();
    let told = holes(&answer);
    assert_eq!((told[0].fate, told[1].fate), (HoleFate::Filled, HoleFate::Kept));
    assert_eq!(told[0].told.as_ref().unwrap().asked, Method::Flat);
    assert!(told[1].told.is_none());
    assert_eq!(answer.report.after.as_ref().unwrap().counts.boundary_loops, 1);
    assert!(!answer.report.certificate.as_ref().unwrap().is_printable());
    let both = [flat, ChosenHole { number: 1, method: Some(Method::Smooth), ..flat }];
    let answer = filled(&bytes, only(&both)).unwrap();
    let asked: Vec<Method> = holes(&answer).iter().map(|hole| hole.told.as_ref().unwrap().asked).collect();
    assert_eq!(asked, [Method::Flat, Method::Smooth]);
}

#[test]
fn a_hole_that_is_not_there_is_an_error_that_says_how_many_there_are() {
    let hole = ChosenHole { number: 2, ..ChosenHole::default() };
    let failure = filled(&with_two_holes(), only(&[hole])).unwrap_err();
    assert_eq!(failure, Failure::NoSuchHole { number: 2, holes: 2 });
    let solid = sphere(8, false, |_, _| false);
    assert_eq!(filled(&solid, only(&[hole])), Err(Failure::NoSuchHole { number: 2, holes: 0 }));
}

#[test]
fn a_file_without_holes_comes_back_as_it_is_and_one_that_cannot_be_filled_too() {
    let solid = sphere(8, false, |_, _| false);
    let answer = filled(&solid, FillHolesChoices::default()).unwrap();
    assert_eq!((answer.report.outcome, answer.output.unwrap().bytes), (Some(Outcome::Identical), None));
    // Every patch of a flat sheet would lie on it.
    let sheet = b"OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
    let answer = filled(sheet, FillHolesChoices::default()).unwrap();
    assert_eq!(answer.report.outcome, Some(Outcome::Partial), "nothing was filled, and it is no solid");
    let [hole] = holes(&answer) else { panic!("one hole") };
    assert_eq!(hole.fate, HoleFate::Rejected);
    assert!(!hole.rejected.is_empty(), "with its reasons");
    assert_eq!(answer.output.unwrap().bytes, None);
    let stl = Options { output_format: Some(Format::Stl), ..Options::default() };
    let answer = run(Operation::FillHoles, sheet, &stl, &Budget::unlimited()).unwrap();
    assert_eq!(answer.report.outcome, Some(Outcome::Partial));
    for require in [Require::Printable, Require::Faithful] {
        for output_format in [None, Some(Format::Stl)] {
            let strict = Options { require: Some(require), output_format, ..Options::default() };
            let refused = run(Operation::FillHoles, sheet, &strict, &Budget::unlimited()).unwrap();
            assert_eq!(
                (refused.report.outcome, refused.output),
                (Some(Outcome::Refused), None),
                "{require:?}"
            );
        }
    }
}

/// A bent plate of 20 by 20 squares with a hole of 5 by 5 in its upper side.
fn bent_plate(thickness: f64) -> Vec<u8> {
    const N: usize = 20;
    let vertex = |i: usize, k: usize, side: usize| (i * (N + 1) + k) * 2 + side;
    let mut lines = Vec::new();
    for (i, k) in (0..=N).flat_map(|i| (0..=N).map(move |k| (i, k))) {
        let [x, y] = [i, k].map(|i| 10.0 * i as f64 / N as f64);
        let z = 0.05 * ((x - 5.0).powi(2) + (y - 5.0).powi(2));
        lines.extend([z, z - thickness].map(|z| format!("{x} {y} {z}")));
    }
    let mut faces: Vec<[usize; 4]> = Vec::new();
    for (i, k) in (0..N).flat_map(|i| (0..N).map(move |k| (i, k))) {
        let square = |side| [(i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1)].map(|(i, k)| vertex(i, k, side));
        let [a, b, c, d] = square(1);
        faces.push([d, c, b, a]);
        if !((7..12).contains(&i) && (7..12).contains(&k)) {
            faces.push(square(0));
        }
    }
    for i in 0..N {
        for [(i, k), (m, n)] in
            [[(i, 0), (i + 1, 0)], [(N, i), (N, i + 1)], [(i + 1, N), (i, N)], [(0, i + 1), (0, i)]]
        {
            faces.push([vertex(i, k, 0), vertex(i, k, 1), vertex(m, n, 1), vertex(m, n, 0)]);
        }
    }
    lines.extend(faces.iter().flat_map(|&[a, b, c, d]| [format!("3 {a} {b} {c}"), format!("3 {a} {c} {d}")]));
    let head = format!("OFF\n{} {} 0\n", 2 * (N + 1) * (N + 1), 2 * faces.len());
    (head + &lines.join("\n")).into_bytes()
}

#[test]
fn a_field_that_does_not_fit_a_thin_wall_is_told_and_where_the_next_ones_meet_the_other_side() {
    let told = |thickness| {
        let rbf = RbfOptions { share: 1.0, ..RbfOptions::default() };
        let fill = FillOptions { method: Method::Rbf, rbf, ..FillOptions::default() };
        let filling = FillHolesChoices { fill, ..FillHolesChoices::default() };
        let answer = filled(&bent_plate(thickness), filling).unwrap();
        let [hole] = holes(&answer) else { panic!("one hole") };
        (hole.told.as_ref().unwrap().used, hole.rejected.clone(), hole.told.as_ref().unwrap().field)
    };
    let (used, rejected, field) = told(0.1);
    assert_eq!((used, rejected.len(), field.unwrap().kernel), (Some(Method::Rbf), 0, Kernel::Cubic));
    let (used, rejected, _) = told(0.001);
    let reasons: Vec<_> = rejected.iter().map(|one| (one.method, one.reason)).collect();
    let meets = Rejection::MeetsOther;
    let wanted = [(Method::Rbf, Rejection::Inexact), (Method::Rbf, meets), (Method::Smooth, meets)];
    assert_eq!((used, &reasons[..]), (Some(Method::Minimal), &wanted[..]));
    for one in &rejected {
        let is_over_hole = |at: DVec3| (3.4..6.1).contains(&at.x) && (3.4..6.1).contains(&at.y);
        assert_eq!(one.at.is_some_and(is_over_hole), one.reason == meets, "{one:?}");
    }
    // Another kernel would have no more room, so none is tried.
    let (_, rejected, _) = told(2e-5);
    let of_fields: Vec<_> = rejected.iter().filter(|one| one.method == Method::Rbf).collect();
    assert_eq!(of_fields.iter().map(|one| one.reason).collect::<Vec<_>>(), [Rejection::NoRoom]);
}

#[test]
fn the_other_winding_and_a_body_beside_do_not_matter() {
    let turned = sphere(24, true, is_region);
    let answer = filled(&turned, FillHolesChoices::default()).unwrap();
    all_stay(&turned, output(&answer));
    let volume = answer.report.after.as_ref().unwrap().measures.volume.unwrap();
    assert!(volume < -4.0, "the patch points as the rest does: {volume}");
    // A body with a hole beside a closed one.
    let holed = String::from_utf8(sphere(24, false, is_region)).unwrap();
    let mut lines = holed.lines();
    let counts: Vec<usize> = lines.nth(1).unwrap().split(' ').map(|count| count.parse().unwrap()).collect();
    let body: Vec<&str> = holed.lines().skip(2).collect();
    let (points, faces) = body.split_at(counts[0]);
    let first = counts[0];
    let text = format!(
        "OFF\n{} {} 0\n{}\n9 0 0\n10 0 0\n9 1 0\n9 0 1\n{}\n3 {} {} {}\n3 {} {} {}\n3 {} {} {}\n3 {} {} {}\n",
        counts[0] + 4,
        counts[1] + 4,
        points.join("\n"),
        faces.join("\n"),
        first,
        first + 2,
        first + 1,
        first,
        first + 1,
        first + 3,
        first,
        first + 3,
        first + 2,
        first + 1,
        first + 2,
        first + 3,
    );
    let answer = filled(text.as_bytes(), FillHolesChoices::default()).unwrap();
    assert!(answer.report.certificate.as_ref().unwrap().is_printable());
    assert_eq!(answer.report.certificate.as_ref().unwrap().shells.len(), 2);
    all_stay(text.as_bytes(), output(&answer));
}

#[test]
fn faces_that_contradict_their_neighbours_at_a_rim_stay_and_the_hole_is_closed() {
    let text = String::from_utf8(sphere(24, false, is_region)).unwrap();
    // A face at the rim runs the other way around.
    let at_rim = format!("4 {} {} {} {}", 2 + 6 * 24 + 2, 2 + 7 * 24 + 2, 2 + 7 * 24 + 3, 2 + 6 * 24 + 3);
    let turned = format!("4 {} {} {} {}", 2 + 6 * 24 + 3, 2 + 7 * 24 + 3, 2 + 7 * 24 + 2, 2 + 6 * 24 + 2);
    assert!(text.contains(&at_rim));
    let text = text.replace(&at_rim, &turned);
    let answer = filled(text.as_bytes(), FillHolesChoices::default()).unwrap();
    all_stay(text.as_bytes(), output(&answer));
    assert_eq!(answer.report.after.as_ref().unwrap().counts.boundary_loops, 0);
    let action = answer.report.actions.iter().find(|action| action.step == "fill-holes").unwrap();
    assert!(action.reason.contains("as if they were turned"), "{}", action.reason);
}

#[test]
fn a_mesh_with_many_holes_has_an_entry_for_each() {
    let bytes = sphere(40, false, |ring, i| ring % 3 == 1 && i % 3 == 0 && ring < 39);
    let answer = filled(&bytes, FillHolesChoices::default()).unwrap();
    let count = answer.report.before.as_ref().unwrap().counts.boundary_loops;
    assert!(count > 100);
    assert_eq!(holes(&answer).len() as u64, count);
    assert!(holes(&answer).iter().all(|hole| hole.fate == HoleFate::Filled));
    assert!(answer.report.certificate.as_ref().unwrap().is_printable());
    let listed = &answer.report.before.as_ref().unwrap().findings[0].witnesses;
    assert_eq!(listed.len(), 16, "the report keeps as many witnesses as it does elsewhere");
}

#[test]
fn colours_of_new_vertices_are_between_those_of_the_rim() {
    let plain = String::from_utf8(sphere(24, false, is_region)).unwrap();
    let mut colored = String::from("COFF\n");
    for (number, line) in plain.lines().enumerate().skip(1) {
        let is_vertex = line.split(' ').count() == 3 && number > 1;
        colored.push_str(line);
        colored.push_str(if is_vertex { " 200 100 50 255\n" } else { "\n" });
    }
    let answer = filled(colored.as_bytes(), by(Method::Smooth)).unwrap();
    let after = soup_of(output(&answer));
    assert!(after.positions.len() > soup_of(colored.as_bytes()).positions.len());
    let one = Some(Color::Bytes([200, 100, 50], Some(255)));
    assert!(after.vertex_colors.iter().all(|color| *color == one), "{:?}", after.vertex_colors.last());
}

/// A tube of `n` by 8 squares as OBJ whose texture goes once around, with two by two squares missing at the seam and as many
/// across from it.
fn textured_tube(n: u32) -> String {
    let rows = 8;
    let turn = |i: u32| f64::from(i) / f64::from(n) * std::f64::consts::TAU;
    let mut text = String::new();
    for (row, i) in (0..=rows).flat_map(|row| (0..n).map(move |i| (row, i))) {
        writeln!(text, "v {} {} {}", turn(i).cos(), turn(i).sin(), f64::from(row) / 4.0).unwrap();
    }
    // One point more than places, so that the seam has two at each.
    for (row, i) in (0..=rows).flat_map(|row| (0..=n).map(move |i| (row, i))) {
        writeln!(text, "vt {} {}", f64::from(i) / f64::from(n), f64::from(row) / f64::from(rows)).unwrap();
    }
    let is_gone = |row: u32, i: u32| {
        (3..5).contains(&row) && ([0, n - 1].contains(&i) || (n / 2 - 1..=n / 2).contains(&i))
    };
    for (row, i) in
        (0..rows).flat_map(|row| (0..n).map(move |i| (row, i))).filter(|&(row, i)| !is_gone(row, i))
    {
        let corner = |row: u32, i: u32| format!("{}/{}", row * n + i % n + 1, row * (n + 1) + i + 1);
        let [a, b, c, d] = [corner(row, i), corner(row, i + 1), corner(row + 1, i + 1), corner(row + 1, i)];
        writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
    }
    text
}

#[test]
fn a_patch_has_texture_between_that_of_its_rim_and_over_a_seam_each_triangle_has_that_of_one_side() {
    let text = textured_tube(24);
    for method in [Method::Minimal, Method::Smooth, Method::Rbf] {
        let answer = filled(text.as_bytes(), by(method)).unwrap();
        assert_eq!(
            holes(&answer).iter().filter(|hole| hole.fate == HoleFate::Filled).count(),
            4,
            "{method:?}"
        );
        let soup = |bytes| read(bytes, Encoding::Obj, &ReadOptions::default(), &Budget::unlimited()).unwrap();
        let (before, after) = (soup(text.as_bytes()), soup(output(&answer)));
        let (mut across, mut at_seam) = (0, 0);
        for t in before.triangles.len()..after.triangles.len() {
            let corners = after.triangles[t].map(|v| after.positions[v as usize]);
            let points = after.texture.of_triangle(t).unwrap();
            if !corners.iter().all(|p| p.x.abs() > 0.5 && (0.5..1.5).contains(&p.z)) {
                continue;
            }
            let is_across = corners[0].x < 0.0;
            *if is_across { &mut across } else { &mut at_seam } += 1;
            for ([u, v], p) in points.into_iter().zip(corners) {
                // The texture is linear in the angle and the height; shares are of the rim around.
                let angle = libm::atan2(p.y, p.x).rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
                let apart = (u - angle).abs().min(1.0 - (u - angle).abs());
                // At the seam it is that of the nearest place of the rim, on one side.
                let [along, up] = if is_across { [0.03, 0.06] } else { [2.0 / 24.0, 0.13] };
                assert!(apart < along && (v - p.z / 2.0).abs() < up, "{method:?}: {u} {v} at {p}");
            }
            let across = points.map(|[u, _]| u);
            let spread = across.into_iter().fold(0.0, f64::max) - across.into_iter().fold(1.0, f64::min);
            assert!(spread < 0.25, "{method:?}: {points:?} reach over the seam");
        }
        assert!(across >= 6 && at_seam >= 6, "{method:?}: {across} across, {at_seam} at the seam");
        assert!(answer.report.actions.iter().all(|action| action.step != "texture"), "{method:?}");
        let taken = answer.report.actions.iter().find(|action| action.step == "taken_over").unwrap();
        let new = (after.triangles.len() - before.triangles.len()) as u64;
        assert_eq!(taken.changes.last(), Some(&("triangles_with_texture", new)), "{method:?}");
    }
}

#[test]
fn the_result_is_written_in_another_format_where_that_is_asked() {
    let options = Options { output_format: Some(Format::Stl), ..Options::default() };
    let solid = sphere(8, false, |_, _| false);
    let answer = run(Operation::FillHoles, &solid, &options, &Budget::unlimited()).unwrap();
    assert_eq!(answer.report.outcome, Some(Outcome::Converted));
    let answer = run(Operation::FillHoles, with_two_holes(), &options, &Budget::unlimited()).unwrap();
    assert_eq!(answer.report.outcome, Some(Outcome::Filled));
    assert!(answer.report.certificate.unwrap().is_printable());
}

#[test]
fn a_plan_fills_each_hole_by_its_own_method_and_its_steps_give_the_same_bytes_again() {
    use meshmend::analysis::DefectCode;
    use meshmend::pipeline::{ChosenRemedy, Remedy};
    let bytes = with_two_holes();
    let repaired = |plan: ChosenPlan| {
        let options = Options { plan: Some(plan), ..Options::default() };
        run(Operation::Repair, &bytes, &options, &Budget::unlimited())
    };
    let finding = |number, method| ChosenRemedy {
        code: DefectCode::BoundaryLoop,
        remedy: None,
        elements: vec![(number, Remedy::Fill)],
        holes: vec![ChosenHole { number, method: Some(method), band_rings: Some(1) }],
    };
    let by = |number, method| ChosenPlan { findings: vec![finding(number, method)], ..ChosenPlan::default() };
    let plan = |number| by(number, Method::Smooth);
    let plain = repaired(ChosenPlan::default()).unwrap();
    let smooth = repaired(plan(0)).unwrap();
    let auto = repaired(by(0, Method::Auto)).unwrap();
    let vertices = |answer: &Answer| answer.report.after.as_ref().unwrap().counts.vertices;
    let corners: Vec<u32> = soup_of(&bytes).triangles.concat();
    let used = corners.iter().collect::<std::collections::BTreeSet<_>>().len() as u64;
    assert_eq!(vertices(&plain), used, "a repair adds no vertex by itself");
    assert!(vertices(&smooth) > vertices(&plain));
    assert!(vertices(&auto) > vertices(&plain), "automatic as `fill-holes` does it, where it is asked for");
    for (answer, asked, other) in
        [(&plain, Method::Auto, Method::Auto), (&smooth, Method::Smooth, Method::Auto)]
    {
        let told = holes(answer);
        let methods = |hole: &HoleOutcome| {
            let report = hole.told.as_ref().unwrap();
            (hole.loops.clone(), hole.fate, report.asked, report.used.is_some())
        };
        let wanted = [(vec![0], HoleFate::Filled, asked, true), (vec![1], HoleFate::Filled, other, true)];
        assert_eq!(told.iter().map(methods).collect::<Vec<_>>(), wanted);
        let share = answer.report.filling.as_ref().unwrap().interpolated_area_share;
        let patches: f64 = told.iter().map(|hole| hole.told.as_ref().unwrap().area).sum();
        let all = answer.report.after.as_ref().unwrap().measures.area;
        assert!((share - patches / all).abs() < 1e-6, "{share}");
    }
    let steps = smooth.report.plan.as_ref().unwrap().steps.clone();
    let again = repaired(ChosenPlan { steps, ..ChosenPlan::default() }).unwrap();
    assert_eq!(output(&again), output(&smooth));
    assert!(matches!(repaired(plan(7)), Err(Failure::PlanMismatch(_))));
}
