//! Small scenes whose pictures are known.

use super::*;
use crate::geom::DVec3;
use crate::par;

const PALETTE: [Rgb; 2] = [[200, 200, 200], [0, 200, 0]];
const STYLE: Style = Style { edges: DrawnEdges::None, background: [255; 3], back: Some([220, 0, 0]) };

/// A square in the plane z = `z`, of side 2 around the origin, its front above.
fn square(z: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    (corners.map(|(x, y)| DVec3::new(x, y, z)).to_vec(), vec![[0, 1, 2], [0, 2, 3]])
}

fn picture_of(scene: Scene<'_>, view: View, style: &Style) -> Canvas {
    let budget = Budget::unlimited();
    let model = FramedScene::of(scene, SceneFrame::around([scene.bounds()]), Shade::Flat, &budget).unwrap();
    let camera = Camera::at(&[&model], view.direction(), Projection::Orthographic, 1.0, &budget).unwrap();
    draw(&model, &camera, 40, 40, style, &budget).unwrap()
}

fn is_red([r, g, b]: Rgb) -> bool {
    r > 100 && g < 30 && b < 30
}

#[test]
fn a_front_has_its_colour_a_back_is_red_and_around_them_is_nothing() {
    let (positions, triangles) = square(0.0);
    let scene = Scene { positions: &positions, triangles: &triangles, palette: &PALETTE, ..Scene::default() };
    let above = picture_of(scene, View::Top, &STYLE);
    let [r, g, b] = above.pixel(20, 20).unwrap();
    assert!(r == g && g == b && r < 255, "grey");
    assert_eq!(above.pixel(0, 0), Some([255; 3]));
    assert!(is_red(picture_of(scene, View::Bottom, &STYLE).pixel(20, 20).unwrap()));
    let other = Style { back: None, ..STYLE };
    assert!(!is_red(picture_of(scene, View::Bottom, &other).pixel(20, 20).unwrap()));
}

#[test]
fn of_two_the_nearer_one_is_seen_from_either_side() {
    let (mut positions, mut triangles) = square(0.0);
    let (upper, more) = square(1.0);
    positions.extend(upper);
    triangles.extend(more.iter().map(|corners| corners.map(|v| v + 4)));
    let budget = Budget::unlimited();
    let scene = Scene { positions: &positions, triangles: &triangles, palette: &PALETTE, ..Scene::default() };
    let model = FramedScene::of(scene, SceneFrame::around([scene.bounds()]), Shade::Flat, &budget).unwrap();
    for (view, nearer) in [(View::Top, [2, 3]), (View::Bottom, [0, 1])] {
        for projection in [Projection::Orthographic, Projection::Perspective] {
            let camera = Camera::at(&[&model], view.direction(), projection, 1.0, &budget).unwrap();
            let seen = visible_triangles(&model, &camera, 32, 32, &budget).unwrap();
            assert!(nearer.contains(&seen[16 * 32 + 16].unwrap()), "{view:?} {projection:?}");
        }
    }
}

#[test]
fn triangles_that_share_edges_leave_no_gap() {
    // A fan of needles around a point in the middle of a disc.
    let rim = 97;
    let mut positions = vec![DVec3::new(0.013, -0.021, 0.0)];
    positions.extend((0..rim).map(|i| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / f64::from(rim));
        DVec3::new(cos, sin, 0.0)
    }));
    let triangles: Vec<_> = (0..rim).map(|i| [0, 1 + i, 1 + (i + 1) % rim]).collect();
    let budget = Budget::unlimited();
    let scene = Scene { positions: &positions, triangles: &triangles, palette: &PALETTE, ..Scene::default() };
    let model = FramedScene::of(scene, SceneFrame::around([scene.bounds()]), Shade::Flat, &budget).unwrap();
    let camera =
        Camera::at(&[&model], View::Top.direction(), Projection::Orthographic, 1.0, &budget).unwrap();
    let side = 501_i32;
    let seen = visible_triangles(&model, &camera, side as u32, side as u32, &budget).unwrap();
    for (at, triangle) in seen.iter().enumerate() {
        let [x, y] = [at as i32 % side, at as i32 / side].map(|i| f64::from(2 * i + 1 - side) / 2.0);
        // The disc takes nine tenths of the picture.
        let is_well_inside = x.hypot(y) < 0.45 * f64::from(side) - 2.0;
        assert!(!is_well_inside || triangle.is_some(), "a gap at {x}, {y}");
    }
}

#[test]
fn a_line_and_a_spot_are_seen_where_nothing_is_before_them() {
    let (positions, triangles) = square(0.0);
    let ends = [DVec3::new(-0.8, 0.0, 0.0), DVec3::new(0.8, 0.0, 0.0)];
    let lines = [Line { ends, color: [0, 0, 255] }];
    let spots = [Spot { at: DVec3::new(0.0, 0.5, 0.0), color: [255, 0, 255] }];
    let (lower, more) = square(-1.0);
    let all: Vec<_> = positions.iter().chain(&lower).copied().collect();
    let both: Vec<_> = triangles.iter().copied().chain(more.iter().map(|c| c.map(|v| v + 4))).collect();
    let scene = Scene {
        positions: &all,
        triangles: &both,
        palette: &PALETTE,
        lines: &lines,
        spots: &spots,
        ..Scene::default()
    };
    let above = picture_of(scene, View::Top, &STYLE);
    assert_eq!(above.pixel(10, 20), Some([0, 0, 255]));
    assert_eq!(above.pixel(20, 11), Some([255, 0, 255]));
    let below = picture_of(scene, View::Bottom, &STYLE);
    let row = |y: usize| (0..40).filter(|&x| below.pixel(x, y) == Some([0, 0, 255])).count();
    assert_eq!((0..40).map(row).sum::<usize>(), 0, "the line is hidden");
    let colors = (0..1600).filter_map(|at| below.pixel(at % 40, at / 40));
    assert!(colors.filter(|[_, g, b]| *b > g.saturating_add(60)).count() > 0, "a ring shines through");
}

#[test]
fn a_spot_behind_the_eye_is_not_seen() {
    let (positions, triangles) = square(0.0);
    let picture = |at: DVec3| {
        let spots = [Spot { at, color: [255, 0, 255] }];
        let scene = Scene {
            positions: &positions,
            triangles: &triangles,
            palette: &PALETTE,
            spots: &spots,
            ..Scene::default()
        };
        let budget = Budget::unlimited();
        let model =
            FramedScene::of(scene, SceneFrame::around([scene.bounds()]), Shade::Flat, &budget).unwrap();
        let camera =
            Camera::at(&[&model], View::Top.direction(), Projection::Perspective, 1.0, &budget).unwrap();
        let canvas = draw(&model, &camera, 40, 40, &STYLE, &budget).unwrap();
        (0..1600).filter(|at| canvas.pixel(at % 40, at / 40) == Some([255, 0, 255])).count()
    };
    assert!(picture(DVec3::ZERO) > 0);
    assert_eq!(picture(DVec3::new(0.0, 0.0, 1e6)), 0);
}

#[test]
fn the_picture_is_the_same_with_any_number_of_threads() {
    let (positions, triangles) = square(0.0);
    let scene = Scene { positions: &positions, triangles: &triangles, palette: &PALETTE, ..Scene::default() };
    let of = |threads| par::with_threads(threads, || picture_of(scene, View::Iso, &STYLE));
    assert_eq!(of(1), of(2));
    assert_eq!(of(1), of(8));
}

#[test]
fn coordinates_of_any_size_make_a_picture() {
    for scale in [1e-310, 1e-30, 1.0, 1e200, 1.7e308] {
        let (positions, triangles) = square(0.0);
        let positions: Vec<_> = positions.iter().map(|&p| p * scale).collect();
        let scene =
            Scene { positions: &positions, triangles: &triangles, palette: &PALETTE, ..Scene::default() };
        let middle = picture_of(scene, View::Top, &STYLE).pixel(20, 20).unwrap();
        assert_ne!(middle, [255; 3], "{scale}");
    }
}

#[test]
fn nothing_and_what_has_no_area_make_an_empty_picture() {
    let point = [DVec3::splat(3.0)];
    for triangles in [&[][..], &[[0, 0, 0]]] {
        let scene = Scene { positions: &point, triangles, palette: &PALETTE, ..Scene::default() };
        for view in View::ALL {
            assert_eq!(picture_of(scene, view, &STYLE), Canvas::filled(40, 40, [255; 3]));
        }
    }
}

#[test]
fn a_run_that_is_to_end_ends() {
    let budget = Budget::new(crate::budget::StopFlag::default(), u64::MAX, 1000);
    let (positions, triangles) = square(0.0);
    let scene = Scene { positions: &positions, triangles: &triangles, palette: &PALETTE, ..Scene::default() };
    let model = FramedScene::of(scene, SceneFrame::around([scene.bounds()]), Shade::Flat, &budget).unwrap();
    let camera = Camera::turning(&[&model], 20.0, 1.0, &budget).unwrap()(30.0);
    assert!(matches!(draw(&model, &camera, 640, 480, &STYLE, &budget), Err(Stopped::Memory { .. })));
}

#[test]
fn a_picture_is_a_png_and_several_are_an_animation() {
    let mut canvas = Canvas::filled(30, 20, [255; 3]);
    canvas.write("A", 2, 2, 2, [0; 3]);
    assert_eq!(canvas.pixel(2, 14), Some([0; 3]), "a foot of the letter");
    assert_eq!(canvas.pixel(2, 2), Some([255; 3]), "its corner is round");
    let one = picture(&canvas);
    let mut read = ::png::Decoder::new(std::io::Cursor::new(&one)).read_info().unwrap();
    let mut pixels = vec![0; read.output_buffer_size().unwrap()];
    read.next_frame(&mut pixels).unwrap();
    assert_eq!(pixels, canvas.bytes);
    let mut sizes = Vec::new();
    let many = animation::<()>(3, 50, |number, size| {
        sizes.push((number, size));
        Ok(canvas.clone())
    })
    .unwrap();
    assert_eq!(sizes.iter().map(|(number, _)| *number).collect::<Vec<_>>(), [0, 1, 2]);
    assert!(sizes.is_sorted_by(|a, b| a.1 < b.1) && sizes[2].1 < many.len(), "{sizes:?}");
    assert_eq!(animation(2, 50, |number, _| if number == 0 { Ok(canvas.clone()) } else { Err(7) }), Err(7));
    assert_eq!(animation::<()>(0, 50, |_, _| Err(())), Ok(Vec::new()));
    let read = ::png::Decoder::new(std::io::Cursor::new(&many)).read_info().unwrap();
    assert_eq!(read.info().animation_control().unwrap().num_frames, 3);
}
