//! Colours, paint and texture of a 3MF where triangles become fewer, parts of others or new: what is at a place stays there.

use crate::threemf::{cuboid, file, mesh, model, part, project, result, run};
use meshmend::formats::threemf::{Body, NO_NUMBER};
use meshmend::geom::{DVec3, closest_point_on_triangle};
use meshmend::mesh::Soup;
use meshmend::pipeline::{Answer, Operation, Options, SimplifyChoices};
use meshmend::simplify::Target;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

const COLORS: [&str; 6] = ["FF0000", "00FF00", "0000FF", "FFFF00", "00FFFF", "FF00FF"];

/// A shape with the number of a colour for each triangle.
struct Painted {
    points: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    colors: Vec<usize>,
    /// How much of the area of a colour may change, as a share of all, and how far from seams colours may be others.
    tolerance: [f64; 2],
}

impl Painted {
    /// The points of a grid of `n` by `m` squares around an axis, `m + 1` rings of `n` points, closed by a point at each end.
    fn around(n: u32, m: u32, point: impl Fn(f64, f64) -> [f64; 3], ends: [[f64; 3]; 2]) -> Self {
        let float = f64::from;
        let ring = |j: u32| (0..n).map(move |i| (float(i) / float(n), float(j) / float(m)));
        let mut points: Vec<[f64; 3]> = (0..=m).flat_map(ring).map(|(u, v)| point(u, v)).collect();
        let first_end = points.len() as u32;
        points.extend(ends);
        let at = |i: u32, j: u32| j * n + i % n;
        let mut triangles = Vec::new();
        for j in 0..m {
            for i in 0..n {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        for i in 0..n {
            triangles.push([at(i + 1, 0), at(i, 0), first_end]);
            triangles.push([at(i, m), at(i + 1, m), first_end + 1]);
        }
        let points = points.into_iter().map(|p| p.map(|x| f64::from(x as f32))).collect();
        Self { points, triangles, colors: Vec::new(), tolerance: [0.0; 2] }
    }

    fn colored(mut self, tolerance: [f64; 2], color: impl Fn(DVec3) -> usize) -> Self {
        let middle =
            |t: &[u32; 3]| t.iter().map(|&v| DVec3::from(self.points[v as usize])).sum::<DVec3>() / 3.0;
        self.colors = self.triangles.iter().map(|t| color(middle(t))).collect();
        self.tolerance = tolerance;
        self
    }

    /// A cube of fine triangles, each side in a colour of its own, and a round spot of another on the top.
    fn cube() -> Self {
        const N: u32 = 12;
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        let mut numbers: BTreeMap<[u32; 3], u32> = BTreeMap::new();
        for axis in 0..3 {
            for side in [0, N] {
                for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
                    let mut vertex = |i: u32, j: u32| {
                        let mut place = [0; 3];
                        (place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3]) = (side, i, j);
                        *numbers.entry(place).or_insert_with(|| {
                            points.push(place.map(f64::from));
                            points.len() as u32 - 1
                        })
                    };
                    let [a, b, c, d] =
                        [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
                    triangles.extend(if side == 0 { [[a, c, b], [a, d, c]] } else { [[a, b, c], [a, c, d]] });
                }
            }
        }
        let n = f64::from(N);
        Self { points, triangles, colors: Vec::new(), tolerance: [0.0; 2] }.colored([0.003, 0.5], |p| {
            let axis = (0..3).find(|&k| p[k] == 0.0 || p[k] == n).unwrap_or(0);
            let is_spot = p.z == n && (p.x - 6.0).hypot(p.y - 6.0) < 4.0;
            if is_spot { 0 } else { 2 * axis + usize::from(p[axis] == n) }
        })
    }

    /// A ball of the radius 10 like a chessboard.
    fn ball() -> Self {
        let point = |u: f64, v: f64| {
            let (turn, rise) = (TAU * u, PI * (v * 30.0 + 1.0) / 32.0);
            [10.0 * rise.sin() * turn.cos(), 10.0 * rise.sin() * turn.sin(), -10.0 * rise.cos()]
        };
        let ball = Self::around(40, 30, point, [[0.0, 0.0, -10.0], [0.0, 0.0, 10.0]]);
        ball.colored([0.005, 0.5], |p| {
            let (turn, rise) = ((p.y.atan2(p.x) + PI) / TAU, (p.z / p.length()).acos() / PI);
            ((turn * 8.0) as usize + (rise * 4.0) as usize) % 2 * 3 + usize::from(p.z > 0.0)
        })
    }

    /// A rod of the radius 10 with stripes along it, and a screw thread above.
    fn rod() -> Self {
        let point = |u: f64, v: f64| [10.0 * (TAU * u).cos(), 10.0 * (TAU * u).sin(), 40.0 * v];
        let rod = Self::around(48, 40, point, [[0.0; 3], [0.0, 0.0, 40.0]]);
        rod.colored([0.005, 0.8], |p| match (p.y.atan2(p.x) + PI) / TAU {
            _ if p.z == 0.0 || p.z == 40.0 => 4,
            turn if p.z < 20.0 => (turn * 8.0) as usize % 2,
            turn => 2 + (turn * 4.0 + p.z / 10.0) as usize % 2,
        })
    }

    /// The same the other way around.
    fn turned(mut self) -> Self {
        self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        self
    }

    fn bytes(&self, mark: impl Fn(usize) -> String) -> Vec<u8> {
        let mut group = "<m:colorgroup id=\"2\">".to_owned();
        COLORS.iter().for_each(|color| write!(group, "<m:color color=\"#{color}\"/>").unwrap());
        let object = mesh(&self.points, &self.triangles, |t| mark(self.colors[t]));
        let resources =
            format!("{group}</m:colorgroup><object id=\"1\" pid=\"2\" pindex=\"5\">{object}</object>");
        file(&model("", &resources, "<item objectid=\"1\"/>"))
    }
}

fn simplified(bytes: &[u8], ratio: f64) -> Answer {
    let simplify = SimplifyChoices { targets: vec![Target::Ratio(ratio)], ..SimplifyChoices::default() };
    run(Operation::Simplify, bytes, &Options { simplify, ..Options::default() })
}

/// The number of the colour of each triangle, stated by a property or by paint.
fn colors_of(body: &Body) -> Vec<usize> {
    let attributes = &body.attributes;
    let of = |t: usize| match attributes.properties.get(t) {
        Some(property) => property.members[0] as usize,
        None => {
            let text = &attributes.texts[attributes.others[t] as usize];
            text.trim_start_matches("paint_color=\"").trim_end_matches('"').len() - 1
        }
    };
    (0..body.soup.triangles.len()).map(of).collect()
}

fn areas(soup: &Soup, colors: &[usize]) -> BTreeMap<usize, f64> {
    let mut areas = BTreeMap::new();
    for (t, &color) in (0..).zip(colors) {
        let [a, b, c] = soup.corners(t);
        *areas.entry(color).or_insert(0.0) += 0.5 * (b - a).cross(c - a).length();
    }
    areas
}

/// The edges between triangles of different colours.
fn seams(soup: &Soup, colors: &[usize]) -> Vec<[DVec3; 2]> {
    let mut sides: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for ([a, b, c], &color) in soup.triangles.iter().copied().zip(colors) {
        for [v, w] in [[a, b], [b, c], [c, a]] {
            sides.entry([v.min(w), v.max(w)]).or_default().push(color);
        }
    }
    let seams = sides.into_iter().filter(|(_, colors)| colors.iter().any(|color| *color != colors[0]));
    seams.map(|(ends, _)| ends.map(|v| soup.positions[v as usize])).collect()
}

/// That each colour keeps its area, and each place its colour where no seam is near.
fn check(shape: &Painted, answer: &Answer, before: &[u8], what: &str) {
    let (old, new) = (project(before), project(result(answer)));
    let (old, new) = (&old.bodies[0], &new.bodies[0]);
    assert!(new.soup.triangles.len() < old.soup.triangles.len(), "{what}");
    let colors = colors_of(new);
    let (old_areas, new_areas) = (areas(&old.soup, &shape.colors), areas(&new.soup, &colors));
    let whole: f64 = old_areas.values().sum();
    let [share, far] = shape.tolerance;
    assert_eq!(old_areas.len(), new_areas.len(), "{what}: no colour comes or goes");
    for (color, area) in &old_areas {
        let change = (new_areas[color] - area).abs() / whole;
        assert!(change <= share, "{what}: colour {color} changes by {change}");
    }
    let seams = seams(&old.soup, &shape.colors);
    for (t, &color) in (0..).zip(&colors) {
        let corners = new.soup.corners(t);
        let middle = corners.iter().sum::<DVec3>() / 3.0;
        for p in
            [middle, corners[0].lerp(middle, 0.3), corners[1].lerp(middle, 0.3), corners[2].lerp(middle, 0.3)]
        {
            let distance = |&t: &u32| closest_point_on_triangle(p, old.soup.corners(t)).distance_squared(p);
            let nearest =
                (0..old.soup.triangles.len() as u32).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            if shape.colors[nearest.unwrap() as usize] == color {
                continue;
            }
            let to_seam = |&[a, b]: &[DVec3; 2]| closest_point_on_triangle(p, [a, b, b]).distance(p);
            let nearest_seam = seams.iter().map(to_seam).fold(f64::INFINITY, f64::min);
            assert!(nearest_seam <= far, "{what}: {p} has the colour {color}, {nearest_seam} from a seam");
        }
    }
    let counts = answer.report.parts[0].attributes.unwrap();
    assert_eq!(counts.kept + counts.from_face, new.soup.triangles.len() as u64, "{what}: {counts:?}");
    assert_eq!((counts.from_nearest, counts.lost), (0, 0), "{what}");
}

#[test]
fn each_colour_keeps_its_place_where_triangles_become_fewer() {
    for (name, shape) in
        [("cube", Painted::cube as fn() -> Painted), ("ball", Painted::ball), ("rod", Painted::rod)]
    {
        for (way, shape) in [("outward", shape()), ("inward", shape().turned())] {
            let by_group = shape.bytes(|color| format!(" pid=\"2\" p1=\"{color}\""));
            let by_paint = shape.bytes(|color| format!(" paint_color=\"{:8<1$}\"", "", color + 1));
            for (how, bytes) in [("group", by_group), ("paint", by_paint)] {
                let what = format!("{name} {way} by {how}");
                check(&shape, &simplified(&bytes, 0.3), &bytes, &what);
            }
        }
    }
}

#[test]
fn triangles_become_as_few_as_without_colours_where_all_have_one() {
    let shape = Painted::ball();
    let triangles = |bytes: &[u8]| {
        let new = project(result(&simplified(bytes, 0.2)));
        let soup = &new.bodies[0].soup;
        (soup.positions.clone(), soup.triangles.clone())
    };
    let plain = triangles(&shape.bytes(|_| String::new()));
    assert!(plain == triangles(&shape.bytes(|_| " paint_color=\"4\"".to_owned())));
    assert!(plain == triangles(&shape.bytes(|_| " pid=\"2\" p1=\"1\"".to_owned())));
}

#[test]
fn paint_that_divides_a_triangle_stays_with_it() {
    let mut shape = Painted::cube();
    shape.colors = (0..shape.triangles.len()).map(|t| usize::from(t % 97 < 2)).collect();
    let bytes =
        shape.bytes(|color| if color == 1 { " paint_color=\"4843\"".to_owned() } else { String::new() });
    let answer = simplified(&bytes, 0.3);
    let new = project(result(&answer));
    let body = &new.bodies[0];
    let painted = body.attributes.others.iter().filter(|&&number| number != NO_NUMBER).count();
    assert_eq!(painted, shape.colors.iter().sum::<usize>());
    let counts = answer.report.parts[0].attributes.unwrap();
    assert!(counts.kept >= painted as u64 && counts.lost == 0 && counts.lost_area_share == 0.0, "{counts:?}");
}

#[test]
fn texture_stays_where_it_is_on_both_sides_of_its_seam() {
    let mut rod = Painted::rod();
    let side = rod.triangles.len() - 2 * 48;
    // The picture goes once around, and begins again at the last column of squares.
    let places: String =
        (0..=48).flat_map(|i| (0..=40).map(move |j| (i, j))).fold(String::new(), |text, (i, j)| {
            text + &format!("<m:tex2coord u=\"{}\" v=\"{}\"/>", f64::from(i) / 48.0, f64::from(j) / 40.0)
        });
    for is_turned in [false, true] {
        if is_turned {
            rod = rod.turned();
        }
        let place = |t: usize, v: u32| {
            let is_last = t / 2 % 48 == 47;
            let (i, j) = (v % 48, v / 48);
            (if is_last && i == 0 { 48 } else { i }) * 41 + j
        };
        let object = mesh(&rod.points, &rod.triangles, |t| match t {
            t if t < side => {
                let [a, b, c] = rod.triangles[t].map(|v| place(t, v));
                format!(" pid=\"3\" p1=\"{a}\" p2=\"{b}\" p3=\"{c}\"")
            }
            _ => String::new(),
        });
        let resources = format!(
            "<m:texture2d id=\"2\" path=\"/3D/a.png\" contenttype=\"image/png\"/><m:texture2dgroup id=\"3\" texid=\"2\">\
             {places}</m:texture2dgroup><object id=\"1\">{object}</object>"
        );
        let bytes = file(&model("", &resources, "<item objectid=\"1\"/>"));
        let answer = simplified(&bytes, 0.3);
        let new = project(result(&answer));
        let soup = &new.bodies[0].soup;
        let mut textured = 0;
        for t in 0..soup.triangles.len() {
            let corners = soup.corners(t as u32);
            let middle = corners.iter().sum::<DVec3>() / 3.0;
            let Some(points) = soup.texture.of_triangle(t) else {
                assert!(middle.z < 1e-6 || middle.z > 40.0 - 1e-6, "{middle}");
                continue;
            };
            textured += 1;
            let around = |p: DVec3| p.y.atan2(p.x) / TAU;
            for ([u, v], p) in points.into_iter().zip(corners) {
                // Where the turn is that of the middle, no corner is on the other side of the seam.
                let turn = around(middle).rem_euclid(1.0);
                let want = turn + (around(p) - turn + 0.5).rem_euclid(1.0) - 0.5;
                assert!((u - want).abs() < 0.02 && (v - p.z / 40.0).abs() < 0.02, "{u} {v} at {p}, {want}");
            }
        }
        assert!(textured > 100);
        assert_eq!(answer.report.parts[0].attributes.unwrap().lost, 0);
    }
}

/// The colour of a place: an even function of it, so that what is between two is known.
fn shade(p: DVec3) -> [f64; 3] {
    [20.0 + 10.0 * p.x, 30.0 + 8.0 * p.y, 40.0 + 6.0 * p.z]
}

/// The members of the colour group with the id 2.
fn members(bytes: &[u8]) -> Vec<[f64; 3]> {
    let text = String::from_utf8(part(bytes, "3D/3dmodel.model")).unwrap();
    let group =
        text.split("<m:colorgroup id=\"2\">").nth(1).unwrap().split("</m:colorgroup>").next().unwrap();
    let byte = |color: &str, k: usize| f64::from(u8::from_str_radix(&color[2 * k..2 * k + 2], 16).unwrap());
    group.split('#').skip(1).map(|color| [0, 1, 2].map(|k| byte(color, k))).collect()
}

/// A body of these triangles with the colour of its place at each corner; a base material under it where `is_layered`.
fn shaded(points: &[[f64; 3]], triangles: &[[u32; 3]], is_layered: bool) -> Vec<u8> {
    let mut group = "<m:colorgroup id=\"2\">".to_owned();
    for p in points {
        let [r, g, b] = shade(DVec3::from(*p)).map(|x| x.round() as u8);
        write!(group, "<m:color color=\"#{r:02X}{g:02X}{b:02X}\"/>").unwrap();
    }
    group += "</m:colorgroup>";
    if is_layered {
        group += "<basematerials id=\"4\"><base name=\"oak\" displaycolor=\"#00FF00\"/></basematerials>\
                  <m:multiproperties id=\"3\" pids=\"4 2\">";
        (0..points.len()).for_each(|v| write!(group, "<m:multi pindices=\"0 {v}\"/>").unwrap());
        group += "</m:multiproperties>";
    }
    let id = if is_layered { 3 } else { 2 };
    let object = mesh(points, triangles, |t| {
        let [a, b, c] = triangles[t];
        format!(" pid=\"{id}\" p1=\"{a}\" p2=\"{b}\" p3=\"{c}\"")
    });
    file(&model("", &format!("{group}<object id=\"1\">{object}</object>"), "<item objectid=\"1\"/>"))
}

/// That each corner of a result of [`shaded`] has the colour of its place; gives the number of new members.
fn check_shades(before: &[u8], answer: &Answer, is_layered: bool) -> usize {
    let after = result(answer);
    let colors = members(after);
    let text = String::from_utf8(part(after, "3D/3dmodel.model")).unwrap();
    let layers: Vec<usize> = text
        .split("pindices=\"0 ")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap().parse().unwrap())
        .collect();
    let new = project(after);
    let body = &new.bodies[0];
    for t in 0..body.soup.triangles.len() {
        let property = body.attributes.properties[t];
        for (member, p) in property.members.into_iter().zip(body.soup.corners(t as u32)) {
            let member = if member == NO_NUMBER { property.members[0] } else { member } as usize;
            let found = colors[if is_layered { layers[member] } else { member }];
            let want = shade(p);
            let is_near = (0..3).all(|k| (found[k] - want[k]).abs() <= 2.0);
            assert!(is_near, "triangle {t}: {found:?} at {p}, not {want:?}");
        }
    }
    colors.len() - members(before).len()
}

#[test]
fn parts_of_triangles_have_the_colours_between_their_corners() {
    let (mut points, mut triangles) = cuboid([0.0; 3], [10.0; 3]);
    let (more, second) = cuboid([4.0, 5.0, 6.0], [14.0, 15.0, 16.0]);
    points.extend(more);
    triangles.extend(second.iter().map(|t| t.map(|v| v + 8)));
    for is_layered in [false, true] {
        let bytes = shaded(&points, &triangles, is_layered);
        let answer = run(Operation::Repair, &bytes, &Options::default());
        assert!(answer.report.certificate.as_ref().unwrap().is_printable());
        assert!(check_shades(&bytes, &answer, is_layered) > 0);
        let counts = answer.report.parts[0].attributes.unwrap();
        assert!(counts.kept > 0 && counts.from_face > 0 && counts.from_nearest == 0, "{counts:?}");
    }
}

/// Two boxes that cross, whose corners have members of `layers` layers of colours.
fn layered(layers: usize) -> Vec<u8> {
    let (mut points, mut triangles) = cuboid([0.0; 3], [10.0; 3]);
    let (more, second) = cuboid([4.0, 5.0, 6.0], [14.0, 15.0, 16.0]);
    points.extend(more);
    triangles.extend(second.iter().map(|t| t.map(|v| v + 8)));
    let mut groups = String::new();
    for layer in 0..layers {
        write!(groups, "<m:colorgroup id=\"{}\">", 10 + layer).unwrap();
        // So far apart that what is between two of them is none of the others.
        let color = |v: usize| format!("<m:color color=\"#{:02X}{:02X}00\"/>", 10 * layer, 16 * v);
        groups.extend((0..points.len()).map(color));
        groups += "</m:colorgroup>";
    }
    let ids: Vec<String> = (0..layers).map(|layer| (10 + layer).to_string()).collect();
    write!(groups, "<m:multiproperties id=\"3\" pids=\"{}\">", ids.join(" ")).unwrap();
    for v in 0..points.len() {
        write!(groups, "<m:multi pindices=\"{}\"/>", vec![v.to_string(); layers].join(" ")).unwrap();
    }
    groups += "</m:multiproperties>";
    let object = mesh(&points, &triangles, |t| {
        let [a, b, c] = triangles[t];
        format!(" pid=\"3\" p1=\"{a}\" p2=\"{b}\" p3=\"{c}\"")
    });
    file(&model("", &format!("{groups}<object id=\"1\">{object}</object>"), "<item objectid=\"1\"/>"))
}

#[test]
fn members_of_up_to_sixteen_layers_are_mixed_and_those_of_more_stay_as_they_are() {
    for (layers, are_mixed) in [(2, true), (16, true), (17, false)] {
        let bytes = layered(layers);
        let answer = run(Operation::Repair, &bytes, &Options::default());
        assert!(answer.report.certificate.as_ref().unwrap().is_printable());
        let count = |bytes: &[u8]| {
            String::from_utf8(part(bytes, "3D/3dmodel.model")).unwrap().matches("<m:multi ").count()
        };
        assert_eq!(count(result(&answer)) > count(&bytes), are_mixed, "{layers} layers");
    }
}

#[test]
fn a_patch_has_the_colours_between_those_of_its_rim() {
    let (points, mut triangles) = cuboid([0.0; 3], [10.0; 3]);
    triangles.drain(2..4);
    let bytes = shaded(&points, &triangles, false);
    let answer = run(Operation::Repair, &bytes, &Options::default());
    assert!(answer.report.certificate.as_ref().unwrap().is_printable());
    check_shades(&bytes, &answer, false);
    assert_eq!(answer.report.parts[0].attributes.unwrap().from_nearest, 2);
}
