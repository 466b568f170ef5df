//! Joins two tips that meet in a point: both are cut off across the axis between them, and a belt of triangles joins the
//! cuts.
//!
//! ```text
//!    \     /            \     /
//!     \   /              a---b        the upper cut
//!      \ /     gives     |\  |        the belt: both cuts have a vertex wherever one of them has a corner, seen from
//!      / \               | \ |        the axis, so that no two triangles of it meet
//!     /   \              c---d        the lower cut
//!    /     \            /     \
//! ```

use super::{Draft, Star};
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec2, DVec3};
use crate::repair::NEW;
use crate::spatial::coincident_f64;

/// Share of the edges at a tip that may be cut off.
const SHARE_OF_EDGES: f64 = 1.0 / 3.0;

/// Cosine that an edge at a tip must have to the axis.
const ALONG_MIN: f64 = 0.1;

/// Angle, in radians, below which corners of the two cuts count as in one direction.
const SAME_ANGLE: f64 = 1e-4;

/// Joins pairs of tips that are alone at their place and share no triangle; gives the number of pairs, and how far the farthest corner
/// of a cut is from its tip.
pub(super) fn join_tips(
    draft: &mut Draft,
    size: f64,
    pitch: f64,
    budget: &Budget,
) -> Result<(u64, f64), Stopped> {
    let places = coincident_f64(&draft.positions, budget)?;
    let mut at_place: Vec<(u32, u32)> = places.group.iter().copied().zip(0..).collect();
    at_place.sort_unstable();
    let pairs: Vec<[u32; 2]> = at_place
        .chunk_by(|a, b| a.0 == b.0)
        .filter_map(|same| if let [(_, v), (_, w)] = *same { Some([v, w]) } else { None })
        .collect();
    let mut vertices = pairs.concat();
    vertices.sort_unstable();
    let stars = Star::of_each(draft, &vertices, budget)?;
    let star_of = |v: u32| vertices.binary_search(&v).ok().map(|i| &stars[i]);
    let mut is_touched = vec![false; draft.triangles.len()];
    let (mut joined, mut move_max) = (0, 0.0f64);
    for [v, w] in pairs {
        let (Some(a), Some(b)) = (star_of(v), star_of(w)) else { continue };
        budget.spend((a.triangles.len() + b.triangles.len()) as u64)?;
        let mut both = a.triangles.iter().chain(&b.triangles);
        if both.clone().any(|&t| is_touched[t as usize]) {
            continue;
        }
        if let Some(reach) = join(draft, [a, b], size, pitch) {
            move_max = move_max.max(reach);
            both.by_ref().for_each(|&t| is_touched[t as usize] = true);
            joined += 1;
        }
    }
    draft.drop_unused_vertices();
    Ok((joined, move_max))
}

/// One cut: the corners of the polygon that it makes, counter-clockwise about the axis from the lower tip to the upper.
struct Section {
    tip: u32,
    /// The far ends of the edges that are cut.
    ends: Vec<u32>,
    /// The triangle behind the side from each corner to the next.
    triangles: Vec<u32>,
    corners: Vec<DVec3>,
    /// The corners in the plane of the cut, about a point that sees all of them.
    flat: Vec<DVec2>,
}

/// A direction from the axis in which one of the cuts, or each, has a corner.
struct CutDirection {
    angle: f64,
    /// The corner of the lower cut and that of the upper.
    corners: [Option<usize>; 2],
}

/// How far the corners of the cuts are from the tips; `None` when they cannot be joined by cuts: then nothing has changed.
fn join(draft: &mut Draft, tips: [&Star; 2], size: f64, pitch: f64) -> Option<f64> {
    let rings = [tips[0].ring(draft)?, tips[1].ring(draft)?];
    let tip = draft.positions[tips[0].vertex as usize];
    let along = |ring: &[(u32, u32)], sign: f64| -> Vec<DVec3> {
        ring.iter().map(|&(v, _)| (draft.positions[v as usize] - tip) * sign).collect()
    };
    let edges = [along(&rings[0], -1.0), along(&rings[1], 1.0)];
    let directions: Vec<DVec3> = edges.iter().flatten().map(|edge| edge.normalize_or_zero()).collect();
    let axis = Star::in_front_of(&directions);
    if axis == DVec3::ZERO || directions.iter().any(|edge| edge.dot(axis) < ALONG_MIN) {
        return None;
    }
    let shortest = edges.iter().flatten().map(|edge| edge.dot(axis)).fold(f64::INFINITY, f64::min);
    let height = (size / 2.0).min(SHARE_OF_EDGES * shortest);
    if height < 64.0 * pitch {
        return None;
    }
    let lower = Section::new(draft, tips[0].vertex, &rings[0], -axis, axis, height)?;
    let upper = Section::new(draft, tips[1].vertex, &rings[1], axis, axis, height)?;
    let sections = [lower, upper];
    let rays = rays(&sections);
    build(draft, &sections, &rays, pitch);
    let corners = sections.iter().flat_map(|section| &section.corners);
    Some(corners.map(|corner| corner.distance(tip)).fold(0.0, f64::max))
}

impl Section {
    /// The cut at `height` from the tip, whose edges go `forward`.
    fn new(
        draft: &Draft,
        tip: u32,
        ring: &[(u32, u32)],
        forward: DVec3,
        axis: DVec3,
        height: f64,
    ) -> Option<Self> {
        let from = draft.positions[tip as usize];
        let is_upper = forward == axis;
        let count = ring.len();
        // Seen from above, the triangles of the upper tip go clockwise around it.
        let at = |i: usize| if is_upper { count - 1 - i } else { i };
        let side = |i: usize| if is_upper { (count * 2 - 2 - i) % count } else { i };
        let ends: Vec<u32> = (0..count).map(|i| ring[at(i)].0).collect();
        let triangles: Vec<u32> = (0..count).map(|i| ring[side(i)].1).collect();
        let cut = |&v: &u32| {
            let edge = draft.positions[v as usize] - from;
            from + edge * (height / edge.dot(forward))
        };
        let corners: Vec<DVec3> = ends.iter().map(cut).collect();
        let x = axis.any_orthonormal_vector();
        let y = axis.cross(x);
        let seen = |p: &DVec3| DVec2::new((*p - from).dot(x), (*p - from).dot(y));
        let flat: Vec<DVec2> = corners.iter().map(seen).collect();
        let middle = flat.iter().sum::<DVec2>() / count as f64;
        let flat: Vec<DVec2> = flat.into_iter().map(|p| p - middle).collect();
        let sees_side = |i: usize| {
            let (a, b) = (flat[i], flat[(i + 1) % count]);
            a.perp_dot(b) > 1e-3 * a.length() * b.length()
        };
        (count >= 3 && (0..count).all(sees_side)).then_some(Self { tip, ends, triangles, corners, flat })
    }

    /// Where the side from corner `i` to the next is met at `angle`.
    fn on_side(&self, i: usize, angle: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(angle);
        let direction = DVec2::new(cos, sin);
        let next = (i + 1) % self.flat.len();
        let (from, to) = (self.flat[i].perp_dot(direction), self.flat[next].perp_dot(direction));
        self.corners[i].lerp(self.corners[next], from / (from - to))
    }
}

/// All directions in which a cut has a corner, counter-clockwise.
fn rays(sections: &[Section; 2]) -> Vec<CutDirection> {
    let of = |which: usize| {
        sections[which].flat.iter().enumerate().map(move |(i, p)| (libm::atan2(p.y, p.x), which, i))
    };
    let mut corners: Vec<(f64, usize, usize)> = of(0).chain(of(1)).collect();
    corners.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut rays: Vec<CutDirection> = Vec::with_capacity(corners.len());
    for (angle, which, i) in corners {
        match rays.last_mut() {
            Some(last) if angle - last.angle < SAME_ANGLE && last.corners[which].is_none() => {
                last.corners[which] = Some(i);
            }
            _ => {
                let mut ray = CutDirection { angle, corners: [None; 2] };
                ray.corners[which] = Some(i);
                rays.push(ray);
            }
        }
    }
    rays
}

/// Puts the cuts and the belt in the place of the tips.
fn build(draft: &mut Draft, sections: &[Section; 2], rays: &[CutDirection], pitch: f64) {
    let [lower, upper] = [0, 1].map(|which| cut_off(draft, &sections[which], which, rays, pitch));
    for k in 0..rays.len() as u32 {
        let next = (k + 1) % rays.len() as u32;
        draft.triangles.push([lower + k, lower + next, upper + next]);
        draft.triangles.push([lower + k, upper + next, upper + k]);
        draft.triangle_origin.extend([NEW; 2]);
    }
}

/// Cuts a tip off; the rim gets a vertex on each ray. Gives the first of these vertices.
fn cut_off(draft: &mut Draft, section: &Section, which: usize, rays: &[CutDirection], pitch: f64) -> u32 {
    let base = draft.positions.len() as u32;
    let origin = draft.vertex_origin[section.tip as usize];
    draft.positions.resize(draft.positions.len() + rays.len(), DVec3::ZERO);
    draft.vertex_origin.resize(draft.positions.len(), origin);
    let first = rays.iter().position(|ray| ray.corners[which].is_some()).unwrap_or(0);
    let mut rims: Vec<Vec<u32>> = vec![Vec::new(); section.corners.len()];
    let mut side = 0;
    for r in (first..rays.len()).chain(0..first) {
        let place = match rays[r].corners[which] {
            Some(corner) => {
                side = corner;
                section.corners[corner]
            }
            None => section.on_side(side, rays[r].angle),
        };
        draft.positions[base as usize + r] = place.map(|x| (x / pitch).round_ties_even() * pitch);
        rims[side].push(base + r as u32);
    }
    for i in 0..rims.len() {
        let end = rims[(i + 1) % rims.len()][0];
        section.replace(draft, i, &[&rims[i][..], &[end]].concat(), which == 1);
    }
    base
}

impl Section {
    /// What is left of the triangle behind side `i` when `side` cuts it, which runs from corner `i` to the next.
    fn replace(&self, draft: &mut Draft, i: usize, side: &[u32], is_upper: bool) {
        let next = (i + 1) % self.ends.len();
        // The triangle runs from the tip to the far end `a` and on to `b`.
        let (a, b) = if is_upper { (self.ends[next], self.ends[i]) } else { (self.ends[i], self.ends[next]) };
        let path: Vec<u32> = if is_upper { side.to_vec() } else { side.iter().rev().copied().collect() };
        let mut parts = vec![[a, b, path[0]]];
        parts.extend(path.windows(2).map(|step| [a, step[0], step[1]]));
        draft.replace(self.triangles[i], &parts);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::EdgeGroups;

    /// A pyramid over a polygon of these corners at height `z`, its tip at the origin, with a bottom of its own.
    fn pyramid(corners: &[[f64; 2]], z: f64, draft: &mut Draft) {
        let (base, count) = (draft.positions.len() as u32, corners.len() as u32);
        draft.positions.push(DVec3::ZERO);
        draft.positions.extend(corners.iter().map(|&[x, y]| DVec3::new(x, y, z)));
        draft.positions.push(DVec3::Z * z);
        for i in 0..count {
            let (a, b) = (base + 1 + i, base + 1 + (i + 1) % count);
            let sides = [[base, b, a], [base + count + 1, a, b]];
            draft.triangles.extend(if z > 0.0 { sides } else { sides.map(|[p, a, b]| [p, b, a]) });
        }
        draft.triangle_origin = (0..draft.triangles.len() as u32).collect();
        draft.vertex_origin = (0..draft.positions.len() as u32).collect();
    }

    fn polygon(count: u32, turn: f64) -> Vec<[f64; 2]> {
        let angle = |i| turn + std::f64::consts::TAU * f64::from(i) / f64::from(count);
        (0..count).map(|i| [angle(i).cos(), angle(i).sin()]).collect()
    }

    #[test]
    fn two_tips_become_one_solid_whatever_their_sections() {
        let star = [[3.0, 0.0], [0.5, 0.5], [0.0, 3.0], [-0.5, 0.5], [-3.0, 0.0], [0.0, -3.0]];
        for (lower, upper) in [
            (polygon(4, 0.1), polygon(4, 0.1)),
            (polygon(3, 0.0), polygon(7, 0.3)),
            (polygon(5, 2.0), star.to_vec()),
            (star.to_vec(), polygon(12, 0.01)),
        ] {
            let mut draft = Draft::default();
            pyramid(&lower, -2.0, &mut draft);
            pyramid(&upper, 1.5, &mut draft);
            let pitch = 2f64.powi(-20);
            let (joined, _) = join_tips(&mut draft, 0.2, pitch, &Budget::unlimited()).unwrap();
            assert_eq!(joined, 1, "{} and {} corners", lower.len(), upper.len());
            assert!(draft.check().is_empty());
            let groups =
                EdgeGroups::build(&draft.triangles, draft.positions.len(), &Budget::unlimited()).unwrap();
            assert!(groups.iter().all(|group| group.len() == 2));
            // One sphere: Euler's formula.
            let [v, e, f] = [draft.positions.len(), groups.len(), draft.triangles.len()];
            assert_eq!(v + f, e + 2);
        }
    }

    #[test]
    fn a_tip_inside_out_is_not_joined() {
        let mut draft = Draft::default();
        pyramid(&polygon(4, 0.0), -2.0, &mut draft);
        pyramid(&polygon(4, 0.0), 2.0, &mut draft);
        draft.triangles.iter_mut().take(8).for_each(|t| t.swap(0, 1));
        let before = draft.clone();
        assert_eq!(join_tips(&mut draft, 0.2, 1e-6, &Budget::unlimited()).unwrap(), (0, 0.0));
        assert_eq!(draft, before);
    }
}
