//! What the new vertices of a patch are between: the corners of its rim, each with a share.

use super::make::MadePatch;
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::{Soup, edge_of, triangle_of};
use crate::par;
use crate::repair::{Blend, Draft, FIRST_BLEND, NEW};

/// Corners of the rim that a vertex is between, at most; those with the smallest shares are left out.
const CORNERS_MAX: usize = 16;
/// Vertices whose distances are looked at between two checks of the budget, for a rim of a thousand corners.
const VERTICES: usize = 64;

/// For each new vertex of a patch the corners of its rim that it is between. A vertex that has divided an edge has half
/// of what each end has, so that a linear texture of the triangulation that was refined stays so;
/// of a patch that was made at once, shares are by distance.
pub(super) fn shares(
    made: &MadePatch,
    rim_points: &[DVec3],
    budget: &Budget,
) -> Result<Vec<Vec<(u32, f64)>>, Stopped> {
    let points = &made.proposal.points;
    if made.parents.is_empty() {
        let of = |range: std::ops::Range<usize>| -> Result<Vec<_>, Stopped> {
            budget.spend((range.len() * rim_points.len()) as u64 / 64 + 1)?;
            Ok(points[range].iter().map(|&p| by_distance(p, rim_points)).collect())
        };
        return Ok(par::try_map_ranges(points.len(), VERTICES, of)?.into_iter().flatten().collect());
    }
    budget.spend(points.len() as u64)?;
    let rim = made.proposal.rim.len() as u32;
    let mut shares: Vec<Vec<(u32, f64)>> = Vec::with_capacity(made.parents.len());
    for parents in &made.parents {
        let mut own: Vec<(u32, f64)> = Vec::new();
        for &parent in parents {
            match parent.checked_sub(rim) {
                None => own.push((parent, 0.5)),
                Some(born) => own.extend(shares[born as usize].iter().map(|&(v, share)| (v, share / 2.0))),
            }
        }
        shares.push(normalized(own));
    }
    Ok(shares)
}

/// Shares by the inverse square of the distance, so that near the rim its nearest corner counts most.
fn by_distance(p: DVec3, rim_points: &[DVec3]) -> Vec<(u32, f64)> {
    let least = rim_points.iter().fold(f64::INFINITY, |least, q| p.distance_squared(*q).min(least));
    let share = |q: &DVec3| if least > 0.0 { least / p.distance_squared(*q) } else { 1.0 };
    let is_here = |q: &DVec3| least > 0.0 || *q == p;
    let mut all: Vec<(u32, f64)> =
        (0u32..).zip(rim_points).filter(|(_, q)| is_here(q)).map(|(v, q)| (v, share(q))).collect();
    // Only these stay, and there may be thousands.
    if all.len() > CORNERS_MAX {
        all.select_nth_unstable_by(CORNERS_MAX - 1, by_share);
        all.truncate(CORNERS_MAX);
    }
    normalized(all)
}

/// The larger share first, of equal ones that of the first corner.
fn by_share(a: &(u32, f64), b: &(u32, f64)) -> std::cmp::Ordering {
    b.1.total_cmp(&a.1).then(a.0.cmp(&b.0))
}

/// One share for each corner, the largest of them, with the sum 1.
fn normalized(mut shares: Vec<(u32, f64)>) -> Vec<(u32, f64)> {
    shares.sort_by_key(|&(v, _)| v);
    let mut own: Vec<(u32, f64)> =
        shares.chunk_by(|a, b| a.0 == b.0).map(|same| (same[0].0, same.iter().map(|s| s.1).sum())).collect();
    own.sort_by(by_share);
    own.truncate(CORNERS_MAX);
    let sum: f64 = own.iter().map(|s| s.1).sum();
    for (_, share) in &mut own {
        *share /= sum;
    }
    own
}

/// The corner of the soup behind the corner of the rim at boundary half-edge `h` of the draft, and its vertex.
pub(super) fn soup_corner(h: u32, draft: &Draft, soup: &Soup) -> Option<[u32; 2]> {
    let origin = draft.triangle_origin[triangle_of(h) as usize];
    let vertex = draft.vertex_origin[edge_of(&draft.triangles, h)[1] as usize];
    if origin == NEW || vertex >= FIRST_BLEND {
        return None;
    }
    let place = soup.positions.get(vertex as usize)?;
    let corners = soup.triangles.get(origin as usize)?;
    let c = (0..3).find(|&c| soup.positions[corners[c] as usize] == *place)?;
    Some([vertex, 3 * origin + c as u32])
}

/// What a new vertex is between by corners of the soup; `None` when a corner of the rim is none of them.
pub(super) fn of_soup(shares: &[(u32, f64)], rim: &[u32], draft: &Draft, soup: &Soup) -> Option<Blend> {
    let mut blend = Vec::new();
    for &(v, share) in shares {
        let h = rim[v as usize];
        let origin = draft.vertex_origin[edge_of(&draft.triangles, h)[1] as usize];
        match origin.checked_sub(FIRST_BLEND) {
            Some(number) => {
                let between = draft.blends.vertices.get(number as usize)?;
                blend.extend(between.iter().map(|&(corner, part)| (corner, part * share)));
            }
            None => blend.push((soup_corner(h, draft, soup)?[1], share)),
        }
    }
    Some(normalized(blend))
}
