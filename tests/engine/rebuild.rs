//! Repairs that rebuild the surface, from bytes to bytes.

use crate::fidelity::ball;
use crate::oracle::RawSoup;
use crate::raw_files::encode;
use crate::repair::{answer, coarse, count, flat, refused, repaired, without};
use crate::solids::cube;
use meshmend::analysis::{Analysis, DefectCode};
use meshmend::formats::Encoding;
use meshmend::pipeline::{
    Answer, ChosenPlan, ChosenRemedy, Effort, FidelityLimits, FillHoles, Options, Outcome, Refusal, Remedy,
    Report, SimplifyChoices, WrapChoices,
};
use meshmend::simplify::Target;
use meshmend::winding::OpenShells;

/// The volume of a rebuilt mesh, which must be certified, with the number of its shells.
pub(crate) fn rebuilt(answer: &Answer) -> (f64, usize) {
    assert_eq!(answer.report.outcome, Some(Outcome::Rebuilt), "{:?}", answer.report.refusal);
    let certificate = answer.report.certificate.as_ref().unwrap();
    assert!(certificate.is_printable());
    assert!(answer.report.distance.is_some() && answer.report.losses.is_some());
    assert!(answer.report.actions.iter().any(|action| action.step == "wrap" && !action.reason.is_empty()));
    (certificate.shells.iter().map(|shell| shell.volume).sum(), certificate.shells.len())
}

/// Two cubes that pass through each other.
fn crossing() -> RawSoup {
    cube().with(&cube().moved([0.5; 3]))
}

/// A coarse lattice for all that meets.
pub(crate) fn rebuilding() -> Options {
    let chosen = ChosenRemedy {
        code: DefectCode::SelfIntersection,
        remedy: Some(Remedy::Rebuild),
        elements: Vec::new(),
        holes: Vec::new(),
    };
    Options { plan: Some(ChosenPlan { findings: vec![chosen], ..ChosenPlan::default() }), ..coarse() }
}

/// How often a step ran.
fn count_of(report: &Report, step: &str) -> usize {
    report.actions.iter().filter(|action| action.step == step).count()
}

fn square() -> RawSoup {
    flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], &[[0, 1, 2], [0, 2, 3]])
}

#[test]
fn what_no_step_makes_a_solid_is_rebuilt() {
    let moebius = RawSoup {
        positions: vec![
            [3.0, 0.0, 0.0],
            [1.0, 2.0, 1.0],
            [-2.0, 1.0, -1.0],
            [-2.0, -2.0, 2.0],
            [1.0, -2.0, 0.0],
        ],
        triangles: vec![[0, 1, 2], [1, 2, 3], [2, 3, 4], [3, 4, 0], [4, 0, 1]],
    };
    let (volume, shells) = rebuilt(&repaired(&moebius));
    assert!(volume > 0.0 && shells == 1, "{volume} in {shells}");
}

#[test]
fn bodies_that_pass_through_each_other_are_rebuilt_where_that_is_chosen() {
    let bytes = encode(&crossing(), Encoding::Obj);
    let (volume, shells) = rebuilt(&answer(&bytes, &rebuilding()));
    assert!((volume - 1.875).abs() < 0.05 && shells == 1, "{volume}");
    let united = answer(&bytes, &coarse()).report;
    assert_eq!((united.outcome, count_of(&united, "unite")), (Some(Outcome::Repaired), 1));
    assert_eq!(united.certificate.unwrap().shells[0].volume, 1.875);
}

#[test]
fn open_shells_are_closed_or_thickened_as_asked() {
    let bytes = encode(&without(cube(), &[2, 3]), Encoding::Obj);
    let volume = |open_shells| {
        let wrap = WrapChoices { cells: Some(32), open_shells, ..WrapChoices::default() };
        let options = Options { fill_holes: FillHoles::None, wrap, ..Options::default() };
        rebuilt(&answer(&bytes, &options)).0
    };
    let [auto, close, thicken] = [OpenShells::Auto, OpenShells::Close, OpenShells::Thicken].map(volume);
    assert_eq!(auto, close);
    assert!(close > 0.8 && thicken < 0.5, "{close} {thicken}");
}

#[test]
fn what_float32_cannot_hold_is_not_rebuilt() {
    let crossing = cube().with(&cube().moved([0.5; 3]));
    let answer = repaired(&crossing.moved([1e8, 0.0, 0.0]));
    assert!(matches!(refused(&answer), Refusal::BeyondFloat32 { .. }));
}

#[test]
fn what_is_too_far_away_is_moved_to_the_origin_where_that_is_allowed() {
    let bytes = encode(&crossing().moved([1e6, -3e7, 0.0]), Encoding::Obj);
    let wrap = WrapChoices { may_recenter: true, ..coarse().wrap };
    let answer = answer(&bytes, &Options { wrap, ..Options::default() });
    let (volume, shells) = rebuilt(&answer);
    assert!((volume - 1.875).abs() < 0.05 && shells == 1, "{volume}");
    let moved = answer.report.actions.iter().find(|action| action.step == "recenter").unwrap();
    assert!((moved.move_max - 3.0017e7).abs() < 1e4, "{}", moved.move_max);
    let bounds = answer.report.after.as_ref().unwrap().measures.bounds.unwrap();
    assert!(bounds.min.abs().max(bounds.max.abs()).max_element() < 2.0);
    assert!(answer.report.distance.unwrap().upper() < 0.1);
}

#[test]
fn what_is_farther_than_the_caller_allows_is_refused_with_the_least_there_is() {
    let bytes = encode(&crossing(), Encoding::Obj);
    let with = |limits| answer(&bytes, &Options { limits, ..rebuilding() });
    let deviation = |limit| with(FidelityLimits { deviation_max: Some(limit), ..FidelityLimits::default() });
    let Refusal::DeviationBeyondLimit { deviation: least, found, limit } = *refused(&deviation(1e-6)) else {
        panic!("another refusal")
    };
    assert!(limit == 1e-6 && least > 1e-6 && least < 0.1, "{least}");
    assert!(found <= least && found > 0.9 * least, "{found} to {least}");
    rebuilt(&deviation(least * 1.01));
}

#[test]
fn a_change_of_a_defined_volume_beyond_the_limit_is_refused() {
    let bytes = encode(&ball(12), Encoding::Obj);
    let fewer = SimplifyChoices { targets: vec![Target::Faces(40)], ..SimplifyChoices::default() };
    let change = |limit| {
        let limits = FidelityLimits { volume_change_max: Some(limit), ..FidelityLimits::default() };
        answer(&bytes, &Options { limits, simplify: fewer.clone(), ..coarse() })
    };
    let made = change(0.9).report;
    let volume = |analysis: Option<Analysis>| analysis.unwrap().measures.volume.unwrap();
    let (before, after) = (volume(made.before), volume(made.after));
    assert!((0.05..0.5).contains(&(1.0 - after / before)), "{before} {after}");
    let Refusal::VolumeChangeBeyondLimit { change: least, .. } = *refused(&change(0.01)) else {
        panic!("another refusal")
    };
    assert!((least.abs() - (1.0 - after / before)).abs() < 1e-9, "{least}");
}

#[test]
fn a_sheet_becomes_a_wall_of_the_thickness_that_is_asked_for() {
    let bytes = encode(&square(), Encoding::Obj);
    let volume = |wall| {
        let wrap = WrapChoices { cells: Some(64), wall, ..WrapChoices::default() };
        // Where holes stay as they are, no wall is made but by the lattice.
        let options = Options { fill_holes: FillHoles::None, wrap, ..Options::default() };
        let answer = answer(&bytes, &options);
        let bounds = answer.report.after.as_ref().unwrap().measures.bounds.unwrap();
        assert!(bounds.max.z.abs() < 4e-3, "the sheet remains a side: {}", bounds.max.z);
        rebuilt(&answer).0
    };
    // The rim is rounded, half a wall to each side.
    for wall in [0.02, 0.1] {
        let got = volume(Some(wall));
        let least = wall;
        let most = wall * (1.0 + 2.0 * wall) * (1.0 + 2.0 * wall);
        assert!((0.9 * least..1.1 * most).contains(&got), "{wall}: {got}");
    }
    // 0.4 % of the diagonal.
    let got = volume(None);
    assert!((0.0050..0.0066).contains(&got), "{got}");
}

#[test]
fn a_sheet_on_both_sides_beside_a_cube_is_not_dropped_with_its_copies() {
    let mut sheet = square().moved([3.0, 0.0, 0.0]);
    let back: Vec<[u32; 3]> = sheet.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    sheet.triangles.extend(back);
    let answer = repaired(&cube().with(&sheet));
    let shells = answer.report.certificate.as_ref().unwrap().shells.len();
    assert_eq!((answer.report.outcome, shells), (Some(Outcome::Repaired), 2));
    assert_eq!(count(&answer, "sheets_thickened"), 1);
    let losses = answer.report.losses.unwrap();
    assert!(losses.visible_loss < 0.01 && losses.bodies_lost == 0, "{losses:?}");
}

#[test]
fn a_wall_between_two_bodies_is_hidden_and_its_removal_no_loss() {
    // Two cubes face to face: the common face is there in both directions.
    let answer = repaired(&cube().with(&cube().moved([1.0, 0.0, 0.0])));
    assert_eq!(answer.report.outcome, Some(Outcome::Repaired));
    let losses = answer.report.losses.unwrap();
    assert_eq!((losses.visible_loss, losses.bodies_lost), (0.0, 0));
    assert!((losses.hidden_area - 2.0).abs() < 1e-9, "{}", losses.hidden_area);
}

#[test]
fn more_effort_comes_closer_where_the_caller_demands_it() {
    let bytes = encode(&crossing(), Encoding::Obj);
    let least = |effort| {
        let wrap = WrapChoices { effort, ..WrapChoices::default() };
        let limits = FidelityLimits { deviation_max: Some(1e-9), ..FidelityLimits::default() };
        let answer = answer(&bytes, &Options { wrap, limits, ..rebuilding() });
        let Refusal::DeviationBeyondLimit { deviation, .. } = *refused(&answer) else {
            panic!("another refusal")
        };
        deviation
    };
    let (low, normal) = (least(Effort::Low), least(Effort::Normal));
    assert!(normal < 0.8 * low, "{low} {normal}");
}

#[test]
fn a_hole_in_a_sheet_is_a_part_of_its_shape() {
    // A square frame, two wide and three tenths of that inside.
    let ring = |r: f64| [[-r, -r], [r, -r], [r, r], [-r, r]];
    let points = [ring(1.0), ring(0.3)].concat();
    let quad = |i: u32| [[i, (i + 1) % 4, (i + 1) % 4 + 4], [i, (i + 1) % 4 + 4, i + 4]];
    let frame = flat(&points, &(0..4).flat_map(quad).collect::<Vec<_>>());
    let walled = answer(&encode(&frame, Encoding::Off), &coarse());
    assert_eq!((walled.report.outcome, count(&walled, "sheets_thickened")), (Some(Outcome::Repaired), 1));
    assert_eq!(walled.report.certificate.as_ref().unwrap().shells[0].genus, 1, "the hole goes through");
    assert_eq!(walled.report.identical_triangle_share, Some(1.0));
    // So does that of two frames that cross, which become walls before they are united.
    let across = frame.clone().map(|[x, y, _]| [x, 0.1, y]);
    let crossed = answer(&encode(&frame.with(&across), Encoding::Off), &coarse());
    assert_eq!((crossed.report.outcome, count(&crossed, "holes_filled")), (Some(Outcome::Repaired), 0));
    let shells = &crossed.report.certificate.as_ref().unwrap().shells;
    // Each frame has one handle, and two crossings of their sides make one more.
    assert_eq!(shells.iter().map(|shell| shell.genus).collect::<Vec<_>>(), [3]);
}

#[test]
fn a_sheet_becomes_a_wall_of_which_it_is_one_side_bit_for_bit() {
    let fan = flat(
        &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.4, 0.5]],
        &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    );
    for (soup, area) in
        [(square(), 1.0), (fan, 1.0), (flat(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], &[[0, 1, 2]]), 0.5)]
    {
        for encoding in [Encoding::Obj, Encoding::StlBinary] {
            let wrap = WrapChoices { wall: Some(0.125), ..coarse().wrap };
            let answer = answer(&encode(&soup, encoding), &Options { wrap, ..coarse() });
            assert_eq!(answer.report.outcome, Some(Outcome::Repaired), "{:?}", answer.report.refusal);
            assert_eq!(answer.report.identical_triangle_share, Some(1.0));
            let after = answer.report.after.as_ref().unwrap();
            let bounds = after.measures.bounds.unwrap();
            // The offset of the rim is straight down, so the sides stand upright.
            assert_eq!((after.measures.volume, bounds.min.z, bounds.max.z), (Some(area / 8.0), -0.125, 0.0));
        }
    }
}

/// A Moebius band of 48 segments, as indexed quads of an OBJ.
fn moebius_band() -> Vec<u8> {
    const AROUND: usize = 48;
    let mut text = String::new();
    for n in 0..AROUND {
        let angle = n as f64 * std::f64::consts::TAU / AROUND as f64;
        for side in [-3.0, 0.0, 3.0] {
            let radius = 10.0 + side * (angle / 2.0).cos();
            let place = [radius * angle.cos(), radius * angle.sin(), side * (angle / 2.0).sin()];
            text += &format!("v {} {} {}\n", place[0], place[1], place[2]);
        }
    }
    for n in 0..AROUND {
        for side in 0..2 {
            let [a, b] = [3 * n + side + 1, 3 * n + side + 2];
            let [c, d] = if n + 1 == AROUND { [3 - side, 2 - side] } else { [a + 3, b + 3] };
            text += &format!("f {a} {c} {d} {b}\n");
        }
    }
    text.into_bytes()
}

/// The genus of each shell of a certified result.
fn genera(answer: &Answer) -> Vec<u32> {
    assert!(answer.report.certificate.as_ref().unwrap().is_printable());
    answer.report.certificate.as_ref().unwrap().shells.iter().map(|shell| shell.genus).collect()
}

#[test]
fn a_moebius_band_comes_back_with_the_one_handle_that_a_thick_one_has() {
    let bytes = moebius_band();
    for cells in [None, Some(48), Some(90)] {
        let wrap = WrapChoices { cells, ..WrapChoices::default() };
        let answer = answer(&bytes, &Options { wrap, ..Options::default() });
        assert_eq!(genera(&answer), [1], "{cells:?}");
    }
}

#[test]
fn a_quad_taken_crosswise_makes_no_handles() {
    let cube = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 0 0 10\nv 10 0 10\nv 10 10 10\nv 0 10 10\n\
        f 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let beside = "f 1 4 3 2\nv 20 0 5\nv 30 0 5\nv 30 10 5\nv 20 10 5\nf 9 10 12 11\n";
    for (name, text, expected) in [
        ("as a face of the cube", format!("{cube}f 1 4 2 3\n"), vec![0]),
        ("over a face of the cube", format!("{cube}f 1 4 3 2\nf 1 3 2 4\n"), vec![0]),
        ("beside the cube", format!("{cube}{beside}"), vec![0, 0]),
    ] {
        let answer = answer(text.as_bytes(), &Options::default());
        assert_eq!(genera(&answer), expected, "{name}");
        let certificate = answer.report.certificate.as_ref().unwrap();
        assert!(certificate.shells.iter().all(|shell| shell.depth == 0), "{name}: {:?}", certificate.shells);
    }
}

#[test]
fn gaps_thinner_than_a_cell_leave_no_cavities_and_are_no_further_away() {
    // A fan of leaves, each a thin plate, askew to the lattice: the gaps between them end in an edge.
    let (tilt_sine, tilt_cosine) = 0.4_f64.sin_cos();
    let leaf = |turn: f64| {
        let mut plate = cube();
        for p in &mut plate.positions {
            let [x, y, z] = [p[0] * 10.0 + 0.37, p[1] * 4.0, p[2] * 0.11];
            let (sine, cosine) = turn.to_radians().sin_cos();
            let [x, z] = [x * cosine - z * sine, x * sine + z * cosine];
            let [x, y] = [x * tilt_cosine - y * tilt_sine, x * tilt_sine + y * tilt_cosine];
            *p = [x, y * tilt_cosine - z * tilt_sine, y * tilt_sine + z * tilt_cosine];
        }
        plate
    };
    let leaves = (0..7).map(|n| leaf(1.3 * f64::from(n))).reduce(|all, one| all.with(&one)).unwrap();
    let bytes = encode(&leaves, Encoding::Obj);
    let wrap = WrapChoices { cells: Some(96), ..WrapChoices::default() };
    let answer = answer(&bytes, &Options { wrap, ..rebuilding() });
    rebuilt(&answer);
    let shells = &answer.report.certificate.as_ref().unwrap().shells;
    assert_eq!(shells.len(), 1, "{shells:?}");
    assert!(count(&answer, "bubbles_opened") > 100 && count(&answer, "tunnels_closed") > 100);
    // A cell is 0.11 wide.
    assert!(answer.report.distance.unwrap().upper() < 0.22, "{:?}", answer.report.distance);
}
