//! A small box around a part, turned in any way.
//!
//! The smallest one has two adjacent sides that each hold an edge of the convex hull (O'Rourke 1985); his search over all
//! pairs of edges takes cubic time. Here boxes are looked at that have a side along every face of the hull, and, for
//! hulls with few edges, along every two of its edges; in the plane of that side the rectangle is the smallest. The best ones are then
//! improved: the side along each of the three axes in turn gets its smallest rectangle, until nothing gets smaller. What is given
//! is a box that holds every point, never larger than the one along the axes; on boxes turned in any way and on all
//! solids of the tests it is the smallest one, but that is not proved in general.

use super::calipers::least_rectangle;
use super::hull::hull;
use super::surface::WeldedSurface;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec2, DVec3};
use crate::par;

/// Points beyond which only those farthest in many directions go into the hull. The box is around all points anyway.
const HULL_POINTS_MAX: usize = 1 << 12;

/// Those directions: neighbours are about 9 degrees apart.
const DIRECTIONS: usize = 1 << 9;

/// Sides that are looked at.
const SIDES_MAX: usize = 1 << 11;

/// Edges of a hull of which every two are looked at.
const PAIRED_EDGES_MAX: usize = 48;

/// Boxes that are improved, and how often at most.
const IMPROVED: usize = 8;
const ROUNDS_MAX: usize = 16;

/// A box in any orientation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrientedBox {
    /// Directions of its sides, of length 1, the longest first.
    pub axes: [DVec3; 3],
    /// Lengths of its sides, in the unit of the file.
    pub size: [f64; 3],
    /// Its middle.
    pub centre: DVec3,
}

impl OrientedBox {
    /// Volume, in cubic units of the file.
    pub fn volume(&self) -> f64 {
        self.size.iter().product()
    }
}

/// A small box around `surface`.
pub(super) fn oriented_box(surface: &WeldedSurface<'_>, budget: &Budget) -> Result<OrientedBox, Stopped> {
    // About the middle, so that a part far from the origin keeps its digits.
    let middle = surface.bounds.min.midpoint(surface.bounds.max);
    let points = used_positions(surface, middle, budget)?;
    let few = if points.len() > HULL_POINTS_MAX { extremes(&points, budget)? } else { points.clone() };
    let faces = hull(&few, budget)?;
    let corners = corners_of(&faces, &few);
    let sides = sides(&faces, &few, surface.normals[0]);
    let boxes = par::try_map_ranges(sides.len(), 16, |range| {
        budget.spend((range.len() * corners.len()) as u64 / 64 + 1)?;
        Ok(range.filter_map(|i| BoxAxes::along(sides[i], &corners)).collect::<Vec<_>>())
    })?;
    let mut boxes: Vec<BoxAxes> = boxes.into_iter().flatten().collect();
    boxes.sort_by(|a, b| a.volume.total_cmp(&b.volume));
    boxes.truncate(IMPROVED);
    let mut best = around(&points, [DVec3::X, DVec3::Y, DVec3::Z], budget)?;
    for start in boxes {
        budget.spend(1)?;
        let found = around(&points, start.improved(&corners).axes, budget)?;
        if found.volume() < best.volume() {
            best = found;
        }
    }
    Ok(OrientedBox { centre: best.centre + middle, ..best })
}

/// Three directions at right angles, and the volume of the box along them.
#[derive(Debug, Clone, Copy)]
struct BoxAxes {
    axes: [DVec3; 3],
    volume: f64,
}

impl BoxAxes {
    /// The smallest box around `points` with a side at right angles to `normal`.
    fn along(normal: DVec3, points: &[DVec3]) -> Option<Self> {
        let (u, v) = normal.any_orthonormal_pair();
        let mut seen: Vec<DVec2> = points.iter().map(|p| DVec2::new(p.dot(u), p.dot(v))).collect();
        let (side, area) = least_rectangle(&mut seen);
        let heights = points.iter().map(|p| p.dot(normal));
        let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), h| (low.min(h), high.max(h)));
        let first = (u * side.x + v * side.y).try_normalize()?;
        let volume = area * (high - low);
        volume.is_finite().then(|| Self { axes: [first, normal.cross(first).normalize(), normal], volume })
    }

    fn improved(self, points: &[DVec3]) -> Self {
        let mut best = self;
        for _ in 0..ROUNDS_MAX {
            let better = best.axes.iter().filter_map(|&axis| Self::along(axis, points));
            let better = better.min_by(|a, b| a.volume.total_cmp(&b.volume));
            match better.filter(|better| better.volume < best.volume * (1.0 - 1e-9)) {
                Some(better) => best = better,
                None => break,
            }
        }
        best
    }
}

/// The positions that triangles use, seen from `origin`.
fn used_positions(
    surface: &WeldedSurface<'_>,
    origin: DVec3,
    budget: &Budget,
) -> Result<Vec<DVec3>, Stopped> {
    let mut is_used = vec![false; surface.positions.len()];
    for block in surface.triangles.chunks(CHECK_EVERY) {
        budget.check()?;
        block.iter().flatten().for_each(|&v| is_used[v as usize] = true);
    }
    let used = surface.positions.iter().zip(&is_used).filter(|(_, is_used)| **is_used);
    Ok(used.map(|(p, _)| *p - origin).collect())
}

/// The points farthest in directions spread evenly over the sphere (Fibonacci lattice), and along the axes.
fn extremes(points: &[DVec3], budget: &Budget) -> Result<Vec<DVec3>, Stopped> {
    let directions: Vec<DVec3> = (0..DIRECTIONS + 6).map(direction).collect();
    // All directions for one block of points after another: a block stays in the cache.
    let found = par::try_map_ranges(points.len(), CHECK_EVERY, |range| {
        budget.check()?;
        let (start, block) = (range.start, &points[range]);
        Ok(directions.iter().map(|&direction| farthest(block, start, direction)).collect::<Vec<_>>())
    })?;
    let mut best = vec![(f64::MIN, 0); directions.len()];
    for of_block in found {
        for (best, found) in best.iter_mut().zip(of_block) {
            *best = if found.0 > best.0 { found } else { *best };
        }
    }
    let mut places: Vec<usize> = best.into_iter().map(|(_, place)| place).collect();
    places.sort_unstable();
    places.dedup();
    Ok(places.into_iter().map(|place| points[place]).collect())
}

/// How far the farthest of `points` is along `direction`, and its place, counted from `start`.
fn farthest(points: &[DVec3], start: usize, direction: DVec3) -> (f64, usize) {
    let mut best = (f64::MIN, start);
    for (i, p) in points.iter().enumerate() {
        let height = p.dot(direction);
        if height > best.0 {
            best = (height, start + i);
        }
    }
    best
}

fn direction(i: usize) -> DVec3 {
    if i >= DIRECTIONS {
        let (axis, sign) = super::BuildDirection::ALL[i - DIRECTIONS].axis();
        return DVec3::AXES[axis] * sign;
    }
    let z = 1.0 - (2.0 * i as f64 + 1.0) / DIRECTIONS as f64;
    // The golden angle.
    let turn = i as f64 * 2.399_963_229_728_653;
    let radius = (1.0 - z * z).sqrt();
    DVec3::new(radius * libm::cos(turn), radius * libm::sin(turn), z)
}

fn corners_of(faces: &[[u32; 3]], points: &[DVec3]) -> Vec<DVec3> {
    let mut used: Vec<u32> = faces.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    if used.is_empty() { points.to_vec() } else { used.into_iter().map(|v| points[v as usize]).collect() }
}

/// Normals of sides to look at: those of the faces, and at right angles to every two edges. `flat` is the normal of a mesh
/// in one plane, which has no hull in space.
fn sides(faces: &[[u32; 3]], points: &[DVec3], flat: DVec3) -> Vec<DVec3> {
    let at = |v: u32| points[v as usize];
    let normal = |&[a, b, c]: &[u32; 3]| (at(b) - at(a)).cross(at(c) - at(a)).try_normalize();
    let step = faces.len().div_ceil(SIDES_MAX).max(1);
    let mut sides: Vec<DVec3> = faces.iter().step_by(step).filter_map(normal).collect();
    sides.push(flat);
    let edges = faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).filter(|[a, b]| a < b);
    let edges: Vec<DVec3> = edges.map(|[a, b]| at(b) - at(a)).collect();
    if edges.len() <= PAIRED_EDGES_MAX {
        let pairs = edges.iter().enumerate().flat_map(|(i, &e)| edges[..i].iter().map(move |&f| e.cross(f)));
        sides.extend(pairs.filter_map(DVec3::try_normalize));
    }
    sides
}

/// The box along `axes` around all `points`.
fn around(points: &[DVec3], axes: [DVec3; 3], budget: &Budget) -> Result<OrientedBox, Stopped> {
    let mut bounds = Aabb::EMPTY;
    for block in points.chunks(CHECK_EVERY) {
        budget.check()?;
        bounds = bounds.union(Aabb::of(block.iter().map(|&p| DVec3::from(axes.map(|axis| axis.dot(p))))));
    }
    let (size, middle) = (bounds.max - bounds.min, bounds.min.midpoint(bounds.max));
    let centre = (0..3).map(|k| axes[k] * middle[k]).sum();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| size[b].total_cmp(&size[a]));
    Ok(OrientedBox { axes: order.map(|k| axes[k]), size: order.map(|k| size[k]), centre })
}
