//! Pictures of small files.

use super::*;
use crate::formats::Format;
use crate::pipeline::{FillHoles, run};

/// A cube without its top, as OBJ.
const BOX: &[u8] = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    f 1 3 2\nf 1 4 3\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";

fn pixels(png: &[u8]) -> (usize, usize, Vec<Rgb>) {
    let mut read = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
    let mut bytes = vec![0; read.output_buffer_size().unwrap()];
    read.next_frame(&mut bytes).unwrap();
    let info = read.info();
    (info.width as usize, info.height as usize, bytes.chunks(3).map(|p| [p[0], p[1], p[2]]).collect())
}

fn picture_of(operation: Operation, options: &Options) -> Vec<u8> {
    run(operation, BOX, options, &Budget::unlimited()).unwrap().picture.unwrap()
}

fn count(pixels: &[Rgb], is: impl Fn(i32, i32, i32) -> bool) -> usize {
    pixels.iter().filter(|p| is(p[0].into(), p[1].into(), p[2].into())).count()
}

fn is_orange(r: i32, g: i32, b: i32) -> bool {
    r > 200 && (90..140).contains(&g) && b < 60
}

fn is_red(r: i32, g: i32, b: i32) -> bool {
    r > g + 60 && r > b + 60 && (g - b).abs() < 30
}

fn is_green(r: i32, g: i32, b: i32) -> bool {
    g > r + 50 && g > b
}

#[test]
fn the_size_is_in_millimetres_whatever_the_unit() {
    let positions = vec![DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 2.0, 0.5)];
    let soup = Soup { positions, triangles: vec![[0, 1, 2]], face_count: 1, ..Soup::default() };
    let drawn = Drawn { soup: &soup, findings: &[], meshes: &[] };
    let size = |units| Painted::before(&drawn, true, false, units, &Budget::unlimited()).unwrap().size;
    assert_eq!(size(Units::Millimetre), "1 x 2 x 0.5 mm");
    assert_eq!(size(Units::Inch), "25.4 x 50.8 x 12.7 mm");
}

#[test]
fn an_open_box_shows_its_rim_and_its_inside() {
    let (width, height, pixels) = pixels(&picture_of(Operation::Render, &Options::default()));
    assert_eq!((width, height), (640, 480));
    assert!(count(&pixels, is_orange) > 500, "the rim");
    assert!(count(&pixels, is_red) > 5000, "the inside");
    assert_eq!(count(&pixels, is_green), 0);
}

#[test]
fn a_repair_shows_before_and_after_with_what_is_new() {
    let options = Options {
        picture: Some(PictureChoices::default()),
        fill_holes: FillHoles::Simple,
        ..Options::default()
    };
    let (width, height, pixels) = pixels(&picture_of(Operation::Repair, &options));
    assert_eq!((width, height), (960, 360));
    let half = |right: usize| -> Vec<Rgb> {
        pixels.iter().enumerate().filter(|(at, _)| at % width / 480 == right).map(|(_, &p)| p).collect()
    };
    let [before, after] = [half(0), half(1)];
    assert!(count(&before, is_red) > 5000 && count(&before, is_green) == 0);
    assert!(count(&after, is_green) > 5000 && count(&after, is_red) == 0);
}

#[test]
fn a_triangle_that_was_turned_is_not_new() {
    let positions = vec![DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 2.0, 0.5)];
    let soup = |triangle| Soup {
        positions: positions.clone(),
        triangles: vec![triangle],
        face_count: 1,
        ..Soup::default()
    };
    let after = |after: &Soup| {
        let painted =
            Painted::after(&soup([0, 1, 2]), after, Units::Millimetre, &Budget::unlimited()).unwrap();
        painted.legend.into_iter().map(|(_, words)| words).collect::<Vec<_>>()
    };
    assert_eq!(after(&soup([2, 1, 0])), ["no new triangle"]);
    let mut moved = soup([2, 1, 0]);
    moved.positions[1].x = 1.5;
    assert_eq!(after(&moved), ["all 1 triangles are new"]);
}

#[test]
fn without_a_wish_there_is_no_picture_and_with_one_the_rest_is_as_it_was() {
    let budget = Budget::unlimited();
    let plain = run(Operation::Analyze, BOX, &Options::default(), &budget).unwrap();
    assert_eq!(plain.picture, None);
    let options = Options { picture: Some(PictureChoices::default()), ..Options::default() };
    let with = run(Operation::Analyze, BOX, &options, &Budget::unlimited()).unwrap();
    assert_eq!(with.report.before, plain.report.before);
    assert!(with.picture.is_some());
}

#[test]
fn several_views_stand_in_a_grid_and_a_turn_is_an_animation() {
    let choices = PictureChoices { views: View::ALL.to_vec(), width: 100, height: 80, ..Default::default() };
    let options = Options { picture: Some(choices.clone()), ..Options::default() };
    let (width, height, _) = pixels(&picture_of(Operation::Render, &options));
    assert_eq!((width, height), (300, 240));
    let choices = PictureChoices { turn_pictures: 5, ..choices };
    let options = Options { picture: Some(choices), ..Options::default() };
    let turning = picture_of(Operation::Render, &options);
    let read = png::Decoder::new(std::io::Cursor::new(&turning)).read_info().unwrap();
    assert_eq!(read.info().animation_control().unwrap().num_frames, 5);
}

#[test]
fn what_the_colours_mean_stands_below_the_mesh_and_not_on_it() {
    let front = PictureChoices { views: vec![View::Front], width: 640, height: 480, ..Default::default() };
    let four = PictureChoices { views: vec![View::Front; 4], ..front.clone() };
    for choices in [front, four] {
        let options = Options { picture: Some(choices), ..Options::default() };
        let (width, height, pixels) = pixels(&picture_of(Operation::Render, &options));
        let row = |y: usize| &pixels[y * width..][..width];
        assert!(height % 480 == 0 && (height - 480 + 100..height - 80).all(|y| row(y)[320] != BACKGROUND));
        // Two short lines on the left: the hole and the size.
        let below = || (height - 50..height).flat_map(row);
        assert!(
            below().any(|&p| p == INK) && below().any(|p| is_orange(p[0].into(), p[1].into(), p[2].into()))
        );
        assert!((height - 50..height).all(|y| row(y)[320] == BACKGROUND));
    }
}

#[test]
fn a_second_file_stands_beside_the_first() {
    let options = Options { after: Some(BOX.to_vec()), ..Options::default() };
    let (width, _, pixels) = pixels(&picture_of(Operation::Render, &options));
    assert_eq!(width, 1280);
    assert_eq!(count(&pixels, is_green), 0, "every triangle is there before");
}

#[test]
fn a_second_file_in_metres_is_as_large_as_the_same_in_millimetres() {
    let options = Options { output_format: Some(Format::Glb), ..Options::default() };
    let glb = run(Operation::Convert, BOX, &options, &Budget::unlimited()).unwrap().output.unwrap().bytes;
    let options = Options { after: glb, ..Options::default() };
    let (width, _, pixels) = pixels(&picture_of(Operation::Render, &options));
    let seen = |right: usize| {
        let half = pixels.iter().enumerate().filter(|(at, _)| at % width / 640 == right);
        half.filter(|(_, p)| **p != BACKGROUND).count()
    };
    assert!(seen(0) > 20_000 && seen(1) * 10 > seen(0) * 9, "{} and {}", seen(0), seen(1));
    assert_eq!(count(&pixels, is_green), 0, "it is the same");
}

#[test]
fn a_second_file_that_cannot_be_read_is_named() {
    let options = Options { after: Some(b"OFF\n4 4 6\n0 0 zero\n".to_vec()), ..Options::default() };
    let failure = run(Operation::Render, BOX, &options, &Budget::unlimited()).unwrap_err();
    assert!(matches!(failure, Failure::InMesh { number: 2, .. }), "{failure}");
}

#[test]
fn the_same_picture_comes_with_any_number_of_threads() {
    let of =
        |threads| crate::par::with_threads(threads, || picture_of(Operation::Render, &Options::default()));
    assert_eq!(of(1), of(2));
    assert_eq!(of(1), of(8));
}

/// What a picture that is a mesh holds: its triangles and the name of the material of each.
fn read_model(glb: &[u8]) -> (Soup, Vec<String>) {
    let soup =
        formats::read(glb, formats::Encoding::Glb, &ReadOptions::default(), &Budget::unlimited()).unwrap();
    let name = |t: usize| {
        let material = soup.materials.of(soup.face_of(t as u32)).unwrap();
        String::from_utf8(soup.materials.names[material as usize].clone()).unwrap()
    };
    let names = (0..soup.triangles.len()).map(name).collect();
    (soup, names)
}

#[test]
fn a_picture_that_is_a_mesh_has_the_surface_in_metres_and_a_rod_along_each_edge_of_a_rim() {
    let choices = PictureChoices { format: PictureFormat::Glb, ..Default::default() };
    let options = Options { picture: Some(choices), ..Options::default() };
    let (soup, names) = read_model(&picture_of(Operation::Render, &options));
    let of = |name: &str| (0..names.len()).filter(|&t| names[t] == name).collect::<Vec<_>>();
    let (surface, rim) = (of("surface"), of("open rims"));
    assert_eq!(surface.len(), 10);
    assert_eq!(surface.len() + rim.len(), names.len());
    let high = surface.iter().flat_map(|&t| soup.corners(t as u32)).fold(DVec3::ZERO, DVec3::max);
    assert!((high - DVec3::splat(1e-3)).length() < 1e-9, "{high}");
    // Four rods of six triangles.
    assert_eq!(rim.len(), 24);
    let middle =
        rim.iter().map(|&t| soup.corners(t as u32)[0]).fold(DVec3::ZERO, |a, b| a + b) / rim.len() as f64;
    assert!((middle.z - 1e-3).abs() < 2e-5, "they are at the rim: {middle}");
}

#[test]
fn a_place_of_a_defect_is_an_octahedron_with_its_outside_out() {
    // Two tetrahedra that pass through each other.
    let crossing = b"v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nv 1 1 -1\nv 5 1 -1\nv 1 5 -1\nv 1 1 3\n\
        f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n";
    let choices = PictureChoices { format: PictureFormat::Glb, ..Default::default() };
    let options = Options { picture: Some(choices), ..Options::default() };
    let glb = run(Operation::Render, crossing, &options, &Budget::unlimited()).unwrap().picture.unwrap();
    let (soup, names) = read_model(&glb);
    let of_defect: Vec<usize> = (0..names.len()).filter(|&t| names[t] == "crossing or touching").collect();
    let of_surface = names.len() - of_defect.len();
    let marks = &of_defect[8 - of_surface..];
    assert!(!marks.is_empty() && marks.len().is_multiple_of(8), "{}", marks.len());
    for mark in marks.chunks(8) {
        let inside = mark.iter().map(|&t| soup.corners(t as u32)[0]).sum::<DVec3>() / 8.0;
        for [a, b, c] in mark.iter().map(|&t| soup.corners(t as u32)) {
            assert!((b - a).cross(c - a).dot((a + b + c) / 3.0 - inside) > 0.0);
        }
    }
}

#[test]
fn a_rod_has_its_outside_out_in_every_direction() {
    for to in [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z, DVec3::new(1.0, -2.0, 3.0)] {
        let sides = model::rod_of_tests([DVec3::ONE, DVec3::ONE + to]);
        for [a, b, c] in sides {
            let (middle, normal) = ((a + b + c) / 3.0, (b - a).cross(c - a));
            let axis = DVec3::ONE + to * (middle - DVec3::ONE).dot(to) / to.length_squared();
            assert!(normal.dot(middle - axis) > 0.0, "{to}");
        }
    }
}

#[test]
fn before_and_after_stand_beside_each_other_in_a_picture_that_is_a_mesh() {
    let choices = PictureChoices { format: PictureFormat::Glb, ..Default::default() };
    let options = Options { picture: Some(choices), fill_holes: FillHoles::Simple, ..Options::default() };
    let (soup, names) = read_model(&picture_of(Operation::Repair, &options));
    let of = |name: &str| names.iter().filter(|known| *known == name).count();
    assert_eq!((of("before: surface"), of("after: surface"), of("after: new")), (10, 10, 2));
    let least = |name: &str| {
        let triangles = (0..names.len()).filter(|&t| names[t] == name);
        triangles.flat_map(|t| soup.corners(t as u32)).map(|p| p.x).fold(f64::MAX, f64::min)
    };
    assert!(least("after: surface") > 1.05e-3 && least("before: surface") < 1e-9);
}
