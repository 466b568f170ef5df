//! Sharp edges and short ones.

use super::surface::WeldedSurface;
use super::{Limit, PrintingWitness};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::{EdgeGroups, edge_of, next_corner, triangle_of};

/// Edges with less material than this are counted as sharp when a policy does not say, in degrees.
const ANGLE_DEFAULT: f64 = 30.0;

/// Angles closer than this are the same, in degrees: rounding of normals.
const ANGLE_SLACK: f64 = 1e-6;

/// Edges by the angle of the material at them, and by length.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Edges {
    /// Edges with less material than this are counted, in degrees.
    pub angle_limit: f64,
    /// How many.
    pub sharp_count: u64,
    /// Their length, in the unit of the file.
    pub sharp_length: f64,
    /// The smallest angle of material at an edge with two faces, in degrees; `None`: there is no such edge.
    pub angle_min: Option<f64>,
    /// Length of the shortest edge.
    pub shortest: Option<f64>,
    /// The sharpest edges, with their angles.
    pub witnesses: Vec<PrintingWitness>,
}

/// Looks at every edge that two triangles share in opposite directions.
pub(super) fn edges(
    surface: &WeldedSurface<'_>,
    groups: &EdgeGroups,
    limit: &Limit,
    witnesses: usize,
    budget: &Budget,
) -> Result<Edges, Stopped> {
    let angle_limit = limit.first_below().unwrap_or(ANGLE_DEFAULT);
    let mut found = Edges { angle_limit, ..Edges::default() };
    let mut sharp: Vec<(f64, u32)> = Vec::new();
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let Some(&h) = group.first() else { continue };
        let [from, to] = edge_of(&surface.triangles, h).map(|v| surface.positions[v as usize]);
        let length = from.distance(to);
        found.shortest = Some(found.shortest.map_or(length, |shortest| shortest.min(length)));
        let Some(angle) = material_angle(surface, group) else { continue };
        found.angle_min = Some(found.angle_min.map_or(angle, |least| least.min(angle)));
        if angle < angle_limit - ANGLE_SLACK {
            found.sharp_count += 1;
            found.sharp_length += length;
            sharp.push((angle, h));
        }
    }
    sharp.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    found.witnesses = sharp.iter().take(witnesses).map(|&(angle, h)| witness(surface, h, angle)).collect();
    Ok(found)
}

fn witness(surface: &WeldedSurface<'_>, h: u32, angle: f64) -> PrintingWitness {
    let [from, to] = edge_of(&surface.triangles, h).map(|v| surface.positions[v as usize]);
    surface.witness(triangle_of(h), (from + to) / 2.0, angle)
}

/// Angle inside the material at an edge, from 0 (a knife) over 180 (flat) to 360 (a slit), in degrees.
fn material_angle(surface: &WeldedSurface<'_>, group: &[u32]) -> Option<f64> {
    let &[h, other] = group else { return None };
    let [a, b] = edge_of(&surface.triangles, h);
    if edge_of(&surface.triangles, other) != [b, a] {
        return None;
    }
    let position = |v: u32| surface.positions[v as usize];
    let along = (position(b) - position(a)).normalize_or_zero();
    let [n, m] = [h, other].map(|h| surface.normals[triangle_of(h) as usize]);
    let turn = libm::atan2(n.cross(m).dot(along), n.dot(m));
    // A fold without a side of its own: the tip of the other triangle tells on which side of the first it is.
    let is_folded = n.dot(m) < 0.0 && n.cross(m).length() < 1e-12;
    if is_folded {
        return Some(if tip(surface, other, position(a), n) > 0.0 { 360.0 } else { 0.0 });
    }
    Some(180.0 - turn.to_degrees())
}

/// How far the corner opposite of half-edge `h` is above the plane through `origin`.
fn tip(surface: &WeldedSurface<'_>, h: u32, origin: DVec3, normal: DVec3) -> f64 {
    let corner = next_corner(next_corner(h));
    let v = surface.triangles[triangle_of(corner) as usize][(corner % 3) as usize];
    (surface.positions[v as usize] - origin).dot(normal)
}
