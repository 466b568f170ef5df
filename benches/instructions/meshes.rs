//! The inputs: a dented sphere of radius 50 mm, and what befalls it. All coordinates are rounded to float32, so that the last
//! digits of the C library's sines do not matter.

use crate::dented_sphere::dented_sphere;
use meshmend::geom::DVec3;
use meshmend::mesh::Soup;

/// Rows of which one lies where the sphere has no dents, see [`halves`].
const ROWS: u32 = 52;

/// The radius in millimetres.
const RADIUS: f64 = 50.0;

pub(crate) fn soup(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Soup {
    Soup { face_count: triangles.len() as u32, positions, triangles, ..Soup::default() }
}

/// A sphere of `2 * columns * (rows - 1)` triangles.
pub(crate) fn sphere(columns: u32, rows: u32) -> Soup {
    let (positions, triangles) = dented_sphere(columns, rows);
    soup(positions.into_iter().map(|p| (p * RADIUS).as_vec3().as_dvec3()).collect(), triangles)
}

/// Both meshes as one.
pub(crate) fn together(mut one: Soup, other: &Soup) -> Soup {
    let base = one.positions.len() as u32;
    one.positions.extend(&other.positions);
    one.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + base)));
    soup(one.positions, one.triangles)
}

/// The mesh somewhere else.
pub(crate) fn moved(mut mesh: Soup, by: DVec3) -> Soup {
    mesh.positions.iter_mut().for_each(|p| *p = (*p + by).as_vec3().as_dvec3());
    mesh
}

/// Two spheres that pass through each other.
pub(crate) fn overlapping(columns: u32, rows: u32) -> Soup {
    together(sphere(columns, rows), &moved(sphere(columns, rows), DVec3::new(31.0, 17.0, 23.0)))
}

/// The mesh without the triangles whose corners are all within `radius` of one of the ends of the axes.
pub(crate) fn with_holes(mut mesh: Soup, radius: f64) -> Soup {
    let ends = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y].map(|axis| axis * RADIUS);
    let place = |v: u32| mesh.positions[v as usize];
    let is_in = |t: &[u32; 3], end: &DVec3| t.iter().all(|&v| place(v).distance(*end) < radius);
    mesh.triangles.retain(|t| !ends.iter().any(|end| is_in(t, end)));
    soup(mesh.positions, mesh.triangles)
}

/// Every 300th triangle is missing, turned or there twice.
pub(crate) fn damaged(mut mesh: Soup) -> Soup {
    let sound = std::mem::take(&mut mesh.triangles);
    for (i, [a, b, c]) in sound.into_iter().enumerate() {
        match i % 900 {
            300 => {}
            600 => mesh.triangles.push([a, c, b]),
            899 => mesh.triangles.extend([[a, b, c], [a, b, c]]),
            _ => mesh.triangles.push([a, b, c]),
        }
    }
    soup(mesh.positions, mesh.triangles)
}

/// Every triangle with vertices of its own, each up to `gap / 2` from its place along each axis.
pub(crate) fn apart(mesh: &Soup, gap: f64) -> Soup {
    let mut state = 7u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24) - 0.5
    };
    let corners = mesh.triangles.as_flattened().iter().map(|&v| mesh.positions[v as usize]);
    let mut at = |p: DVec3| (p + DVec3::from_array([0; 3].map(|_| gap * random()))).as_vec3().as_dvec3();
    let positions = corners.map(&mut at).collect();
    soup(positions, (0..mesh.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect())
}

/// The upper part of a sphere on the lower part of one with twice as many columns, where neither has dents: every other vertex
/// of the lower rim lies beside an edge of the upper one.
pub(crate) fn halves(columns: u32) -> Soup {
    // The sine of 13 times the latitude is zero.
    let border = (6.0 * std::f64::consts::PI / 13.0).cos() * RADIUS;
    let part = |columns: u32, is_upper: bool| {
        let mut mesh = sphere(columns, ROWS);
        let height = |v: u32| mesh.positions[v as usize].z - border;
        let is_in = |v: u32| if is_upper { height(v) > -1e-3 } else { height(v) < 1e-3 };
        mesh.triangles.retain(|t| t.iter().all(|&v| is_in(v)));
        soup(mesh.positions, mesh.triangles)
    };
    together(part(columns, true), &part(2 * columns, false))
}
