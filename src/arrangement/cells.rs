//! Winding numbers of both sides of every piece: the pieces around each edge tell which sides look at each other, one ray for each
//! connected part tells the number on one side, and the jumps tell all others.
//!
//! Every side that is reached twice must have one number; otherwise there is a fault, and no result.

use super::Arrangement;
use super::error::ArrangementError;
use super::radial::{Normal, around};
use super::ray;
use crate::budget::{Budget, CHECK_EVERY};
use crate::mesh::{EdgeGroups, edge_of, triangle_of};
use crate::par;
use crate::spatial::Bvh;

/// A side of a piece is `2 f` where the piece `f` turns counter-clockwise, `2 f + 1` on the other.
pub(super) type PieceSide = u32;

const UNKNOWN: i32 = i32::MIN;

/// Finds the winding numbers of `arrangement`, which was made of `triangles`.
pub(super) fn wind(
    arrangement: &mut Arrangement,
    triangles: &[[u32; 3]],
    operand_of: impl Fn(u32) -> u8 + Sync,
    bvh: Bvh,
    budget: &Budget,
) -> Result<(), ArrangementError> {
    let operands = arrangement.operands;
    let count = arrangement.pieces.len();
    let _charge = budget.charge((count * (24 + 12 * operands)) as u64)?;
    let jumps = jumps(arrangement, &operand_of);
    let groups = EdgeGroups::build(&arrangement.pieces, arrangement.point_count(), budget)?;
    check_closed(arrangement, &groups, &jumps, budget)?;
    let rays = || {
        let anchors = anchors(arrangement, &groups, budget)?;
        let starts = par::try_map_ranges(anchors.len(), 4, |range| {
            range
                .map(|i| ray::beside(arrangement, anchors[i] as usize, triangles, &operand_of, &bvh, budget))
                .collect::<Result<Vec<_>, _>>()
        })?;
        drop(bvh);
        Ok::<_, ArrangementError>((anchors, starts))
    };
    let (rays, links) = par::join(rays, || links(arrangement, triangles, &groups, budget));
    let ((anchors, starts), links) = (rays?, links?);
    drop(groups);
    let mut windings = vec![UNKNOWN; 2 * count * operands];
    for (&anchor, (is_front, start)) in anchors.iter().zip(starts.into_iter().flatten()) {
        let side = 2 * anchor + u32::from(!is_front);
        spread(side, start, &links, &jumps, &mut windings, budget)?;
    }
    arrangement.windings = windings;
    Ok(())
}

/// By how much the winding number of each operand is larger behind a piece than in front of it.
fn jumps(arrangement: &Arrangement, operand_of: &impl Fn(u32) -> u8) -> Vec<i32> {
    let operands = arrangement.operands;
    let mut jumps = vec![0; arrangement.pieces.len() * operands];
    for piece in 0..arrangement.pieces.len() {
        for &(t, is_turned) in arrangement.sources(piece) {
            if let Some(jump) = jumps[piece * operands..][..operands].get_mut(usize::from(operand_of(t))) {
                *jump += if is_turned { -1 } else { 1 };
            }
        }
    }
    jumps
}

/// Each operand must run along each edge as often one way as the other.
fn check_closed(
    arrangement: &Arrangement,
    groups: &EdgeGroups,
    jumps: &[i32],
    budget: &Budget,
) -> Result<(), ArrangementError> {
    let operands = arrangement.operands;
    let mut edges = vec![0; operands];
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.spend(CHECK_EVERY as u64)?;
        }
        let balance = |operand: usize| {
            let of = |&h: &u32| {
                let [from, to] = edge_of(&arrangement.pieces, h);
                let jump = jumps[triangle_of(h) as usize * operands + operand];
                if from < to { jump } else { -jump }
            };
            group.iter().map(of).sum::<i32>()
        };
        for (operand, edges) in edges.iter_mut().enumerate() {
            *edges += u64::from(balance(operand) != 0);
        }
    }
    match edges.iter().enumerate().find(|&(_, &edges)| edges > 0) {
        Some((operand, &edges)) => Err(ArrangementError::NotClosed { operand: operand as u8, edges }),
        None => Ok(()),
    }
}

/// For each side of each half-edge, `2 h` in front of it and `2 h + 1` behind it, the side that it looks at.
pub(super) fn links(
    arrangement: &Arrangement,
    triangles: &[[u32; 3]],
    groups: &EdgeGroups,
    budget: &Budget,
) -> Result<Vec<PieceSide>, ArrangementError> {
    let mut links = vec![0; arrangement.pieces.len() * 6];
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.spend(CHECK_EVERY as u64)?;
        }
        let [from, to] = edge_of(&arrangement.pieces, group[0]);
        let edge = [from.min(to), from.max(to)];
        let is_along = |h: u32| edge_of(&arrangement.pieces, h)[0] == edge[0];
        let order: Vec<usize> = if group.len() <= 2 {
            (0..group.len()).collect()
        } else {
            let normal = |&h: &u32| {
                let plane = arrangement.planes[triangle_of(h) as usize];
                let corners = triangles[plane as usize].map(|v| arrangement.positions[v as usize]);
                Normal::of(corners, !is_along(h))
            };
            let normals: Vec<Normal> = group.iter().map(normal).collect();
            budget.spend(8 * group.len() as u64)?;
            around(arrangement, edge, &normals)
                .ok_or(ArrangementError::Inconsistent("two pieces lie on each other"))?
        };
        for (k, &i) in order.iter().enumerate() {
            let (h, next) = (group[i], group[order[(k + 1) % order.len()]]);
            // Counter-clockwise around the edge comes the front of a piece that runs along it.
            let ahead = u32::from(!is_along(h));
            let behind = u32::from(is_along(next));
            links[(2 * h + ahead) as usize] = 2 * triangle_of(next) + behind;
            links[(2 * next + behind) as usize] = 2 * triangle_of(h) + ahead;
        }
    }
    Ok(links)
}

/// A piece of each connected part: the first of those whose corners are all vertices of the input, or else the first.
fn anchors(
    arrangement: &Arrangement,
    groups: &EdgeGroups,
    budget: &Budget,
) -> Result<Vec<u32>, ArrangementError> {
    let parts = groups.components(budget)?;
    let mut anchors = vec![(true, u32::MAX); parts.count as usize];
    for (f, (&part, corners)) in parts.of.iter().zip(&arrangement.pieces).enumerate() {
        let has_new = corners.iter().any(|&p| p as usize >= arrangement.positions.len());
        let anchor = &mut anchors[part as usize];
        *anchor = (*anchor).min((has_new, f as u32));
    }
    Ok(anchors.into_iter().map(|(_, f)| f).collect())
}

/// Gives every side that is connected with `start`, of which these are the winding numbers, its own.
fn spread(
    start: PieceSide,
    mut current: Vec<i32>,
    links: &[PieceSide],
    jumps: &[i32],
    windings: &mut [i32],
    budget: &Budget,
) -> Result<(), ArrangementError> {
    let operands = current.len();
    let mut stack = Vec::new();
    reach(start, &current, jumps, windings, &mut stack)?;
    while let Some(piece) = stack.pop() {
        budget.spend(2)?;
        for side in [2 * piece, 2 * piece + 1] {
            current.copy_from_slice(&windings[side as usize * operands..][..operands]);
            for h in 3 * piece..3 * piece + 3 {
                reach(links[(2 * h + side % 2) as usize], &current, jumps, windings, &mut stack)?;
            }
        }
    }
    Ok(())
}

/// Notes that these are the winding numbers of a side, and with it those of the other side of its piece.
fn reach(
    side: PieceSide,
    current: &[i32],
    jumps: &[i32],
    windings: &mut [i32],
    stack: &mut Vec<u32>,
) -> Result<(), ArrangementError> {
    let (operands, piece, is_behind) = (current.len(), side / 2, side % 2 == 1);
    let first = piece as usize * operands;
    let (front, behind) = windings[2 * first..2 * (first + operands)].split_at_mut(operands);
    let (known, other) = if is_behind { (behind, front) } else { (front, behind) };
    if known[0] == UNKNOWN {
        known.copy_from_slice(current);
        for ((other, &known), &jump) in other.iter_mut().zip(current).zip(&jumps[first..]) {
            *other = if is_behind { known - jump } else { known + jump };
        }
        stack.push(piece);
    } else if *known != *current {
        return Err(ArrangementError::Inconsistent("the sides of a wall do not differ by its jump"));
    }
    Ok(())
}
