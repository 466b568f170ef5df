//! Edges along which the walls of sheets would touch in a line without width.
//!
//! A sheet becomes a wall behind it. Where sheets meet in an edge, the walls around that edge are sectors of a disk:
//!
//! ```text
//!   a fold           a Moebius band where it turns around
//!      |wall           wall |
//!   ---+               -----+-----
//!   wall                    | wall
//! ```
//!
//! On the right they have the edge alone in common, and a lattice that samples them finds tunnels along it. So a round bar
//! is put around such an edge.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::{EdgeGroups, edge_of, prev_corner, triangle_of};
use rustc_hash::FxHashMap;
use std::f64::consts::TAU;

/// Angle that the wall of a page is taken to reach over, in degrees. Where another page is nearer it ends half-way, which leaves
/// few tunnels and takes no bar.
const REACH: f64 = 90.0;

/// A gap between walls that is no wider, in degrees, is thinner than a cell.
const NARROW: f64 = 5.0;

/// The edges of `sheets` around which their walls are in several pieces, once each. Corners with the same bits are one.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn seams(sheets: &[[DVec3; 3]], budget: &Budget) -> Result<Vec<[DVec3; 2]>, Stopped> {
    let _charge = budget.charge(sheets.len() as u64 * 120)?;
    let (mut positions, mut numbers) = (Vec::new(), FxHashMap::default());
    let mut triangles = Vec::with_capacity(sheets.len());
    for block in sheets.chunks(CHECK_EVERY) {
        budget.check()?;
        triangles.extend(block.iter().map(|corners| {
            corners.map(|p| {
                // Zero has two patterns of bits.
                let bits = (p + 0.0).to_array().map(f64::to_bits);
                *numbers.entry(bits).or_insert_with(|| {
                    positions.push(p);
                    positions.len() as u32 - 1
                })
            })
        }));
    }
    triangles.iter_mut().filter(|[a, b, c]| a == b || b == c || c == a).for_each(|t| *t = [t[0]; 3]);
    let groups = EdgeGroups::build(&triangles, positions.len(), budget)?;
    let mut seams = Vec::new();
    let mut pages = Vec::new();
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let [from, to] = edge_of(&triangles, group[0]);
        let is_fold = |&[g, h]: &[u32; 2]| edge_of(&triangles, g) != edge_of(&triangles, h);
        if from == to || group.len() < 2 || <&[u32; 2]>::try_from(group).is_ok_and(is_fold) {
            continue;
        }
        budget.spend(group.len() as u64)?;
        let ends = [from, to].map(|v| positions[v as usize]);
        pages.clear();
        pages.extend(group.iter().filter_map(|&h| {
            let apex = positions[triangles[triangle_of(h) as usize][prev_corner(h) as usize % 3] as usize];
            SeamSheet::of(ends, apex, edge_of(&triangles, h) == [from, to])
        }));
        if pieces(&mut pages) > 1 {
            seams.push(ends);
        }
    }
    Ok(seams)
}

/// A sheet that ends at an edge, seen along it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SeamSheet {
    /// Its direction, in degrees from 0 to 360.
    angle: f64,
    /// Its wall is on the side of greater angles.
    is_wall_after: bool,
}

impl SeamSheet {
    /// The page between the edge and `apex`, which runs along the edge or against it; `None` without an area.
    fn of([from, to]: [DVec3; 2], apex: DVec3, is_along: bool) -> Option<Self> {
        let along = (to - from).normalize_or_zero();
        let away = apex - from - along * (apex - from).dot(along);
        if away.length_squared() == 0.0 {
            return None;
        }
        let across = along.any_orthonormal_vector();
        let angle = libm::atan2(away.dot(along.cross(across)), away.dot(across));
        // Counter-clockwise around `along` is toward the normal of a triangle that runs along the edge.
        Some(Self { angle: angle.rem_euclid(TAU).to_degrees(), is_wall_after: !is_along })
    }
}

/// Number of pieces of the walls of `pages` around their edge. Sorts them.
fn pieces(pages: &mut [SeamSheet]) -> usize {
    pages.sort_by(|p, q| p.angle.total_cmp(&q.angle));
    let count = pages.len();
    // Twice around, so that every wall is met on the way.
    let angle = |n: usize| pages[n % count].angle + 360.0 * (n / count) as f64;
    // Sector `n` follows page `n`. How far walls reach into it from both of its sides:
    let mut filled: Vec<f64> = vec![0.0; count];
    let mut reach = f64::NEG_INFINITY;
    for n in 0..2 * count {
        if pages[n % count].is_wall_after {
            reach = angle(n) + REACH;
        }
        if n >= count {
            filled[n % count] += (reach - angle(n)).max(0.0);
        }
    }
    let mut reach = f64::INFINITY;
    for n in (1..=2 * count).rev() {
        if !pages[n % count].is_wall_after {
            reach = angle(n) - REACH;
        }
        if n <= count {
            filled[n - 1] += (angle(n) - reach).max(0.0);
        }
    }
    let is_filled = |n: &usize| {
        // Between two walls that face each other everything is inside, whatever the angle.
        let is_between = pages[*n].is_wall_after && !pages[(*n + 1) % count].is_wall_after;
        is_between || filled[*n] + NARROW >= angle(*n + 1) - angle(*n)
    };
    (count - (0..count).filter(is_filled).count()).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Walls of pages at these angles, in pieces of a degree each: behind the nearest page, or squarely behind any.
    fn pieces_by_degrees(pages: &[SeamSheet]) -> usize {
        let apart = |page: &SeamSheet, at: f64| (at - page.angle + 180.0).rem_euclid(360.0) - 180.0;
        let is_behind = |page: &SeamSheet, at: f64| (apart(page, at) > 0.0) == page.is_wall_after;
        let is_inside = |degree: usize| {
            let at = degree as f64 + 0.5;
            let nearest = pages.iter().min_by(|p, q| apart(p, at).abs().total_cmp(&apart(q, at).abs()));
            let is_squarely = |page: &SeamSheet| is_behind(page, at) && apart(page, at).abs() < 90.0;
            nearest.is_some_and(|page| is_behind(page, at)) || pages.iter().any(is_squarely)
        };
        // A piece begins after a gap that is not narrow.
        let begins = |n: &usize| is_inside(*n) && (1..=6).all(|back| !is_inside((*n + 360 - back) % 360));
        (0..360).filter(begins).count().max(1)
    }

    #[test]
    fn pieces_of_walls_are_those_of_the_definition() {
        let page = |angle: usize, is_wall_after| SeamSheet { angle: angle as f64, is_wall_after };
        let mut counts = [0; 4];
        for a in (0..360).step_by(45) {
            for b in (a + 10..a + 360).step_by(40) {
                for c in (b + 30..a + 360).step_by(30) {
                    for sides in 0..8 {
                        let side = |n: usize| sides >> n & 1 == 1;
                        let mut pages = [page(a, side(0)), page(b % 360, side(1)), page(c % 360, side(2))];
                        let expected = pieces_by_degrees(&pages);
                        assert_eq!(pieces(&mut pages), expected, "{pages:?}");
                        counts[expected] += 1;
                    }
                }
            }
        }
        assert!(counts[1] > 100 && counts[2] > 100 && counts[3] > 10, "{counts:?}");
    }

    #[test]
    fn only_where_a_sheet_turns_around_there_is_a_seam() {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let (a, b) = (at(0.0, 0.0, 0.0), at(0.0, 1.0, 0.0));
        let (left, right, up) = (at(-1.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 0.0, 1.0));
        let seams = |sheets: &[[DVec3; 3]]| seams(sheets, &Budget::unlimited()).unwrap().len();
        assert_eq!(seams(&[[a, b, left], [b, a, right]]), 0);
        assert_eq!(seams(&[[a, b, left], [a, b, right]]), 1);
        // A page on a sheet; also where it is upside down.
        assert_eq!(seams(&[[a, b, left], [b, a, right], [a, b, up]]), 0);
        assert_eq!(seams(&[[a, b, left], [b, a, right], [b, a, up]]), 0);
    }
}
