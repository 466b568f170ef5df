//! Shapes whose measures have ties: round ones, where everything is as far from the centre or the axis, and flat ones.

use meshmend::geom::DVec3;
use meshmend::mesh::Soup;
use std::f64::consts::{PI, TAU};

/// Every shape, with about `triangles` triangles.
pub(crate) fn all(triangles: u32) -> Vec<(&'static str, Soup)> {
    // Columns around and half as many rows, of two triangles each.
    let columns = f64::from(triangles).sqrt() as u32;
    let rows = columns / 2;
    let share = |row: u32| f64::from(row) / f64::from(rows);
    let sides = triangles / 4;
    vec![
        (
            "sphere",
            turned(columns, rows, |row| ((PI * share(row)).sin() * 50.0, (PI * share(row)).cos() * 50.0)),
        ),
        ("cone", turned(columns, rows, |row| (share(row) * 30.0, -share(row) * 80.0))),
        ("cone of one fan on another", peak(triangles / 2, 80.0)),
        ("two cones, tip to tip", tip_to_tip(triangles / 4)),
        ("torus", torus(columns, rows)),
        ("cylinder", extruded(&circle(sides, |_| 20.0), 100.0)),
        ("gear", extruded(&circle(sides, |angle| if (angle * 24.0).sin() > 0.0 { 40.0 } else { 35.0 }), 8.0)),
        (
            "flat plate",
            turned(columns, rows, |row| (share(row) * 100.0, if row == rows { 0.0 } else { 2.0 })),
        ),
        ("text on a plate", text(triangles)),
    ]
}

/// A surface of revolution: radius and height for each row.
fn turned(columns: u32, rows: u32, at: impl Fn(u32) -> (f64, f64)) -> Soup {
    let place = |column: u32, row: u32| {
        let (sin, cos) = (TAU * f64::from(column) / f64::from(columns)).sin_cos();
        let (radius, height) = at(row);
        DVec3::new(cos * radius, sin * radius, height)
    };
    grid(columns, rows, place)
}

fn torus(columns: u32, rows: u32) -> Soup {
    let place = |column: u32, row: u32| {
        let (sin, cos) = (TAU * f64::from(column) / f64::from(columns)).sin_cos();
        let (up, out) = (TAU * f64::from(row) / f64::from(rows)).sin_cos();
        let radius = 40.0 + 10.0 * out;
        DVec3::new(cos * radius, sin * radius, up * 10.0)
    };
    grid(columns, rows, place)
}

/// Squares between rows of places, each cut in two, closed around.
fn grid(columns: u32, rows: u32, place: impl Fn(u32, u32) -> DVec3) -> Soup {
    let positions = (0..=rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let positions: Vec<DVec3> = positions.map(|(column, row)| place(column, row)).collect();
    let id = |column: u32, row: u32| row * columns + column % columns;
    let quads = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let triangles = quads.flat_map(|(column, row)| {
        let [a, b] = [id(column, row), id(column + 1, row)];
        let [c, d] = [id(column, row + 1), id(column + 1, row + 1)];
        [[a, c, d], [a, d, b]]
    });
    soup(positions, triangles.collect())
}

fn circle(sides: u32, radius: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    let corner = |i: u32| {
        let angle = TAU * f64::from(i) / f64::from(sides);
        let (sin, cos) = angle.sin_cos();
        [cos * radius(angle), sin * radius(angle)]
    };
    (0..sides).map(corner).collect()
}

/// A solid over an outline around the origin: four triangles for each side.
fn extruded(outline: &[[f64; 2]], height: f64) -> Soup {
    let n = outline.len() as u32;
    let ring = |z: f64| outline.iter().map(move |&[x, y]| DVec3::new(x, y, z));
    let ends = [DVec3::ZERO, DVec3::Z * height];
    let positions: Vec<DVec3> = ring(0.0).chain(ring(height)).chain(ends).collect();
    let side = |i: u32| {
        let j = (i + 1) % n;
        [[i, j, j + n], [i, j + n, i + n], [2 * n, j, i], [2 * n + 1, i + n, j + n]]
    };
    soup(positions, (0..n).flat_map(side).collect())
}

/// A cone of two fans: half of the triangles around the tip, half around the centre of the floor.
fn peak(sides: u32, height: f64) -> Soup {
    let rim = circle(sides, |_| 30.0).into_iter().map(|[x, y]| DVec3::new(x, y, 0.0));
    let positions = rim.chain([DVec3::Z * height, DVec3::ZERO]).collect();
    let side = |i: u32| {
        let j = (i + 1) % sides;
        [[i, j, sides], [j, i, sides + 1]]
    };
    soup(positions, (0..sides).flat_map(side).collect())
}

/// Two cones whose tips are nearly at one place.
fn tip_to_tip(sides: u32) -> Soup {
    let (mut all, other) = (peak(sides, 80.0), peak(sides, -80.0));
    let base = all.positions.len() as u32;
    all.positions.extend(other.positions.iter().map(|&p| p + DVec3::Z * 160.000_01));
    all.triangles.extend(other.triangles.iter().map(|&[a, b, c]| [a + base, c + base, b + base]));
    soup(all.positions, all.triangles)
}

/// Many small blocks, as strokes of letters, above a plate.
fn text(triangles: u32) -> Soup {
    let strokes = triangles / 12;
    let across = f64::from(strokes).sqrt().ceil() as u32;
    let mut all = cuboid(DVec3::new(-1.0, -1.0, -3.0), DVec3::new(f64::from(across), f64::from(across), 2.9));
    for i in 0..strokes {
        let low = DVec3::new(f64::from(i % across), f64::from(i / across), 0.0);
        let size = if i % 3 == 0 { DVec3::new(0.2, 0.7, 1.0) } else { DVec3::new(0.7, 0.2, 1.0) };
        let stroke = cuboid(low, size);
        let base = all.positions.len() as u32;
        all.positions.extend(stroke.positions);
        all.triangles.extend(stroke.triangles.iter().map(|t| t.map(|v| v + base)));
    }
    soup(all.positions, all.triangles)
}

fn cuboid(low: DVec3, size: DVec3) -> Soup {
    let corner = |i: u32| low + DVec3::from([i & 1, i >> 1 & 1, i >> 2].map(f64::from)) * size;
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    soup(
        (0..8).map(corner).collect(),
        quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
    )
}

fn soup(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Soup {
    Soup { face_count: triangles.len() as u32, positions, triangles, ..Soup::default() }
}
