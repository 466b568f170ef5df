//! Where sharp edges of the mesh end at the rim of a hole, and in which direction they would go on.

use super::super::regions::Region;
use super::super::surface::FillSurface;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;

/// An edge is sharp when its faces turn by more, as the cosine of the angle (35 degrees).
const SHARP_COS_MAX: f64 = 0.82;
/// Two sharp edges are one line when it turns by less between them, as the cosine of the angle (40 degrees).
const LINE_COS_MIN: f64 = 0.766;
/// A sharp edge of so many mean edges of the rim is a line alone; shorter ones may be noise.
const LONG: f64 = 1.5;
/// A sharp edge runs on in the rim when that goes on within this of it, as the cosine of the angle (20 degrees).
const ALONG_COS_MIN: f64 = 0.94;
/// Corners of a rim that sharp edges may come to; each is followed along the rim.
const STARTS_MAX: usize = 32;
/// Triangles at a vertex that are looked at.
const STAR_MAX: usize = 64;

/// The end of a sharp edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct End {
    /// The corner of the rim.
    pub(super) corner: u32,
    /// The unit direction in which it goes on.
    pub(super) direction: DVec3,
}

/// The ends in the order of the rim; none for a rim that passes a place twice or that very many sharp edges come to.
pub(super) fn ends(region: &Region, surface: &FillSurface, budget: &Budget) -> Result<Vec<End>, Stopped> {
    let rim = region.rim();
    let n = rim.len();
    let point = |i: usize| surface.point(rim[i % n]);
    let mut vertices: Vec<u32> = rim.iter().map(|&h| surface.corner(h)).collect();
    vertices.sort_unstable();
    if region.walks.len() != 1 || vertices.windows(2).any(|pair| pair[0] == pair[1]) {
        return Ok(Vec::new());
    }
    let mean = (0..n).map(|i| point(i).distance(point(i + 1))).sum::<f64>() / n as f64;
    let mut starts: Vec<(usize, DVec3)> = Vec::new();
    for i in 0..n {
        if i.is_multiple_of(CHECK_EVERY) {
            budget.check()?;
        }
        starts.extend(direction(surface, [rim[(i + n - 1) % n], rim[i]], mean).map(|own| (i, own)));
        if starts.len() > STARTS_MAX {
            return Ok(Vec::new());
        }
    }
    let mut ends: Vec<End> = Vec::new();
    for (mut corner, mut direction) in starts {
        budget.check()?;
        // As far as it runs in the rim, it has not ended.
        for _ in 0..n {
            let along = |k: usize| (k, (point(k) - point(corner)).normalize_or_zero());
            let [one, other] = [corner + 1, corner + n - 1].map(along);
            let (k, edge) = if one.1.dot(direction) > other.1.dot(direction) { one } else { other };
            if edge.dot(direction) <= ALONG_COS_MIN {
                break;
            }
            (corner, direction) = (k % n, edge);
        }
        ends.push(End { corner: corner as u32, direction });
    }
    // Where two come from both sides, the whole edge is in the rim.
    let is_alone = |end: &End| ends.iter().filter(|other| other.corner == end.corner).count() == 1;
    let mut alone: Vec<End> = ends.iter().copied().filter(is_alone).collect();
    alone.sort_by_key(|end| end.corner);
    Ok(alone)
}

/// The direction in which the sharp edges at the corner between two half-edges of the rim go on; `None` when there is none,
/// or nothing tells how.
fn direction(surface: &FillSurface, [before, after]: [u32; 2], mean: f64) -> Option<DVec3> {
    let v = surface.corner(after);
    let [p, q] = match sharp_neighbours(surface, v)[..] {
        [w] => return onward(surface, v, w, mean),
        [p, q] => [p, q],
        _ => return None,
    };
    onward(surface, v, p, mean).zip(onward(surface, v, q, mean))?;
    let [at, p, q] = [v, p, q].map(|v| surface.positions[v as usize]);
    let is_passing = (at - p).normalize_or_zero().dot((q - at).normalize_or_zero()) >= LINE_COS_MIN;
    // A corner of a part: the third edge is where the faces to both sides of the hole meet.
    let [one, other] = [before, after].map(|h| surface.normal(h));
    if is_passing || one.dot(other) >= SHARP_COS_MAX {
        return None;
    }
    let line = one.cross(other).normalize_or_zero();
    let outward = surface.outward(before) + surface.outward(after);
    Some(if line.dot(outward) < 0.0 { -line } else { line })
}

/// The direction in which the sharp edge from vertex `w` to `v` goes on; `None` for one that is short and alone.
fn onward(surface: &FillSurface, v: u32, w: u32, mean: f64) -> Option<DVec3> {
    let [at, from] = [v, w].map(|v| surface.positions[v as usize]);
    let (length, last) = ((at - from).length(), (at - from).normalize_or_zero());
    let before = sharp_neighbours(surface, w)
        .into_iter()
        .filter(|&x| x != v)
        .map(|x| from - surface.positions[x as usize])
        .filter(|edge| edge.normalize_or_zero().dot(last) >= LINE_COS_MIN)
        .max_by(|a, b| a.normalize().dot(last).total_cmp(&b.normalize().dot(last)));
    match before {
        // A line that turns evenly has turned by half as much again where it ends.
        Some(edge) => {
            let share = length / (length + edge.length());
            Some((last + (last - edge.normalize()) * share).normalize_or_zero())
        }
        None => (length >= LONG * mean).then_some(last),
    }
}

/// The vertices to which sharp edges go from `v`; none for a vertex of very many triangles.
fn sharp_neighbours(surface: &FillSurface, v: u32) -> Vec<u32> {
    let star = surface.star(v);
    if star.len() > STAR_MAX {
        return Vec::new();
    }
    let normal = |t: u32| {
        let [a, b, c] = surface.triangles[t as usize].map(|v| surface.positions[v as usize]);
        (b - a).cross(c - a).normalize_or_zero()
    };
    // Of each neighbour the triangle to the left of the edge to it.
    let mut left: Vec<(u32, DVec3)> = Vec::with_capacity(star.len());
    let mut right: Vec<(u32, DVec3)> = Vec::with_capacity(star.len());
    for &t in star {
        let corners = surface.triangles[t as usize];
        let Some(c) = corners.iter().position(|&corner| corner == v) else { continue };
        let normal = normal(t);
        left.push((corners[(c + 1) % 3], normal));
        right.push((corners[(c + 2) % 3], normal));
    }
    let is_sharp = |&(w, beyond): &(u32, DVec3)| {
        left.iter().any(|&(other, normal)| other == w && normal.dot(beyond) < SHARP_COS_MAX)
    };
    right.into_iter().filter(is_sharp).map(|(w, _)| w).collect()
}
