//! The rasteriser against rays: for the middle of each pixel every triangle is asked, one by one.

use crate::random::Random;
use crate::support::{cases, on_all_cores};
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::par;
use meshmend::render::{
    Camera, DrawnEdges, FramedScene, PictureAxes, Projection, Scene, SceneFrame, Shade, Style, View, draw,
    visible_triangles,
};

const SIDE: u32 = 48;
const PALETTE: [[u8; 3]; 1] = [[180; 3]];

/// Triangles of all sizes, and some that share corners.
fn soup(random: &mut Random) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let count = 3 + random.below(40);
    let spread = random.pick(&[0.05, 0.3, 1.0]);
    let mut positions: Vec<DVec3> = Vec::new();
    let mut triangles = Vec::new();
    for _ in 0..count {
        let middle = DVec3::new(random.unit(), random.unit(), random.unit());
        let mut corner = |positions: &mut Vec<DVec3>| {
            if !positions.is_empty() && random.one_in(3) {
                return random.below(positions.len()) as u32;
            }
            let off = DVec3::new(random.unit(), random.unit(), random.unit()) - DVec3::splat(0.5);
            positions.push(middle + off * spread);
            positions.len() as u32 - 1
        };
        triangles.push([corner(&mut positions), corner(&mut positions), corner(&mut positions)]);
    }
    (positions, triangles)
}

fn direction(random: &mut Random) -> PictureAxes {
    if random.one_in(2) {
        return random.pick(&View::ALL).direction();
    }
    PictureAxes::around(360.0 * random.unit(), 170.0 * random.unit() - 85.0)
}

/// How far along the ray it meets the triangle.
fn meeting([a, b, c]: [DVec3; 3], (from, along): (DVec3, DVec3)) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let slope = normal.dot(along);
    if slope == 0.0 {
        return None;
    }
    let at = normal.dot(a - from) / slope;
    let p = from + along * at;
    let sides = [(a, b), (b, c), (c, a)].map(|(a, b)| (b - a).cross(p - a).dot(normal));
    let is_inside = sides.iter().all(|&side| side >= 0.0);
    (is_inside && at.is_finite()).then_some(at)
}

/// The triangles that are nearest along a ray, with all that are hardly farther; none where there is none.
fn nearest(model: &FramedScene<'_>, triangles: &[[u32; 3]], ray: (DVec3, DVec3)) -> Vec<u32> {
    let corners = |t: &[u32; 3]| t.map(|v| model.points()[v as usize]);
    let met: Vec<(u32, f64)> = (0..)
        .zip(triangles)
        .filter_map(|(t, triangle)| Some((t, meeting(corners(triangle), ray)?)))
        .collect();
    let first = met.iter().map(|&(_, at)| at).fold(f64::INFINITY, f64::min);
    // Backs are moved away by a millionth of the depth, and depths are kept as float32.
    met.into_iter().filter(|&(_, at)| at <= first + 2e-5 * first.abs()).map(|(t, _)| t).collect()
}

/// Corners lie on a grid of 1/256 pixel, so an edge may be that far from where it is.
const SHIFTS: [f64; 3] = [0.003, 0.006, 0.012];

fn round(seed: u64, number: usize) -> (usize, usize) {
    let random = &mut Random::of_round(seed, number);
    let (positions, triangles) = soup(random);
    let scene = Scene { positions: &positions, triangles: &triangles, palette: &PALETTE, ..Scene::default() };
    let budget = Budget::unlimited();
    let model = FramedScene::of(scene, SceneFrame::around([scene.bounds()]), Shade::Flat, &budget).unwrap();
    let projection = random.pick(&[Projection::Orthographic, Projection::Perspective]);
    let camera = Camera::at(&[&model], direction(random), projection, 1.0, &budget).unwrap();
    let seen = visible_triangles(&model, &camera, SIDE, SIDE, &budget).unwrap();
    let (mut covered, mut near_edges) = (0, 0);
    for (at, &triangle) in seen.iter().enumerate() {
        let [x, y] = [at as u32 % SIDE, at as u32 / SIDE].map(|i| f64::from(i) + 0.5);
        let along = |x: f64, y: f64| nearest(&model, &triangles, camera.ray(x, y, SIDE, SIDE));
        let agrees = |nearest: &[u32]| match triangle {
            Some(triangle) => nearest.contains(&triangle),
            None => nearest.is_empty(),
        };
        let middle = along(x, y);
        covered += usize::from(!middle.is_empty());
        if agrees(&middle) {
            continue;
        }
        near_edges += 1;
        let around = SHIFTS.iter().flat_map(|shift| {
            (0..16).map(move |i| {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / 16.0).sin_cos();
                (shift * cos, shift * sin)
            })
        });
        let is_explained = around.into_iter().any(|(dx, dy)| agrees(&along(x + dx, y + dy)));
        assert!(is_explained, "round {number}: {triangle:?} is seen at {x}, {y}, and rays meet {middle:?}");
    }
    (covered, near_edges)
}

#[test]
fn at_the_middle_of_each_pixel_the_triangle_is_seen_that_a_ray_meets_first() {
    let rounds = cases(60, 3000);
    let counts = on_all_cores(rounds, |number| round(0x7e, number));
    let (covered, near_edges) = counts.iter().fold((0, 0), |(a, b), (c, d)| (a + c, b + d));
    assert!(covered > rounds * 100, "{covered} pixels show something");
    // Only where an edge passes within a hundredth of a pixel may rays and pixels differ.
    assert!(near_edges * 100 < covered, "{near_edges} of {covered} pixels differ");
}

#[test]
fn pictures_of_random_soups_are_the_same_with_one_two_and_eight_threads() {
    let style = Style { edges: DrawnEdges::All, background: [255; 3], back: Some([200, 0, 0]) };
    for number in 0..cases(10, 300) {
        let picture = |threads| {
            par::with_threads(threads, || {
                let random = &mut Random::of_round(0x7f, number);
                let (positions, triangles) = soup(random);
                let scene = Scene {
                    positions: &positions,
                    triangles: &triangles,
                    palette: &PALETTE,
                    ..Scene::default()
                };
                let budget = Budget::unlimited();
                let frame = SceneFrame::around([scene.bounds()]);
                let model = FramedScene::of(scene, frame, Shade::Smooth, &budget).unwrap();
                let camera =
                    Camera::at(&[&model], direction(random), Projection::Perspective, 1.5, &budget).unwrap();
                draw(&model, &camera, 96, 64, &style, &budget).unwrap()
            })
        };
        let one = picture(1);
        assert!(one == picture(2) && one == picture(8), "round {number}");
    }
}
