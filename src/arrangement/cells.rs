//! Winding numbers of both sides of every piece: the pieces around each edge tell which sides of walls look at each other, one ray
//! for each connected part tells the number on one side, and the jumps tell all others.
//!
//! Every side that is reached twice must have one number; otherwise there is a fault, and no result.

use super::Arrangement;
use super::error::ArrangementError;
use super::ray;
use super::walls::{WallSide, Walls};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::{EdgeGroups, edge_of, triangle_of};
use crate::par;
use crate::spatial::Bvh;

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
    let _charge = budget.charge((count * 12 * operands) as u64)?;
    let jumps = jumps(arrangement, &operand_of);
    let groups = EdgeGroups::build(&arrangement.pieces, arrangement.point_count(), budget)?;
    check_closed(arrangement, &groups, &jumps, budget)?;
    let walls = Walls::find(arrangement, triangles, &groups, budget)?;
    drop(groups);
    let anchors = anchors(arrangement, &walls);
    let starts = par::try_map_ranges(anchors.len(), 4, |range| {
        range
            .map(|i| ray::beside(arrangement, anchors[i] as usize, triangles, &operand_of, &bvh, budget))
            .collect::<Result<Vec<_>, _>>()
    })?;
    drop(bvh);
    // Along an edge of two pieces the jumps cancel out: all pieces of a wall have one, but for the way they turn.
    let _walls_charge = budget.charge((walls.count() * 12 * operands) as u64)?;
    let mut spreading = Spreading {
        jumps: walls.first_pieces().iter().flat_map(|&f| jumps_of(f, &jumps, operands)).copied().collect(),
        windings: vec![UNKNOWN; 2 * walls.count() * operands],
        walls: &walls,
    };
    for (&anchor, (is_front, start)) in anchors.iter().zip(starts.into_iter().flatten()) {
        spreading.spread(walls.side(2 * anchor + u32::from(!is_front)), start, budget)?;
    }
    let of_walls = spreading.windings;
    budget.spend(2 * count as u64)?;
    let mut windings = vec![UNKNOWN; 2 * count * operands];
    par::for_each_chunk_mut(&mut windings, 2 * operands * CHECK_EVERY, |begin, part| {
        for (side, windings) in (begin / operands..).zip(part.chunks_mut(operands)) {
            let of_wall = walls.side(side as u32) as usize;
            windings.copy_from_slice(&of_walls[of_wall * operands..][..operands]);
        }
    });
    arrangement.windings = windings;
    Ok(())
}

fn jumps_of(piece: u32, jumps: &[i32], operands: usize) -> &[i32] {
    &jumps[piece as usize * operands..][..operands]
}

/// By how much the winding number of each operand is larger behind a piece than in front of it.
fn jumps(arrangement: &Arrangement, operand_of: &(impl Fn(u32) -> u8 + Sync)) -> Vec<i32> {
    let operands = arrangement.operands;
    let mut jumps = vec![0; arrangement.pieces.len() * operands];
    par::for_each_chunk_mut(&mut jumps, operands * CHECK_EVERY, |begin, part| {
        for (piece, jumps) in (begin / operands..).zip(part.chunks_mut(operands)) {
            for &(t, is_turned) in arrangement.sources(piece) {
                if let Some(jump) = jumps.get_mut(usize::from(operand_of(t))) {
                    *jump += if is_turned { -1 } else { 1 };
                }
            }
        }
    });
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
    let edges_of_ranges = par::try_map_ranges(groups.len(), CHECK_EVERY, |range| {
        budget.spend(range.len() as u64)?;
        let mut edges = vec![0; operands];
        for group in range.map(|e| groups.group(e)) {
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
        Ok::<_, Stopped>(edges)
    })?;
    for operand in 0..operands {
        let edges = edges_of_ranges.iter().map(|edges| edges[operand]).sum();
        if edges > 0 {
            return Err(ArrangementError::NotClosed { operand: operand as u8, edges });
        }
    }
    Ok(())
}

/// A piece of each connected part: the first of those whose corners are all vertices of the input, or else the first.
fn anchors(arrangement: &Arrangement, walls: &Walls<'_>) -> Vec<u32> {
    let parts = walls.parts();
    let mut anchors = vec![(true, u32::MAX); parts.count as usize];
    for (f, corners) in (0u32..).zip(&arrangement.pieces) {
        let has_new = corners.iter().any(|&p| p as usize >= arrangement.positions.len());
        let anchor = &mut anchors[parts.of[walls.side(2 * f) as usize / 2] as usize];
        *anchor = (*anchor).min((has_new, f));
    }
    anchors.into_iter().map(|(_, f)| f).collect()
}

/// Winding numbers that go from wall to wall.
struct Spreading<'w, 'b> {
    walls: &'w Walls<'b>,
    /// By how much the winding number of each operand is larger behind the first piece of each wall than in front of it.
    jumps: Vec<i32>,
    /// Those of each operand on each side of each wall, or [`UNKNOWN`].
    windings: Vec<i32>,
}

impl Spreading<'_, '_> {
    /// Gives every side that is connected with `start`, of which these are the winding numbers, its own.
    fn spread(
        &mut self,
        start: WallSide,
        mut current: Vec<i32>,
        budget: &Budget,
    ) -> Result<(), ArrangementError> {
        let operands = current.len();
        let mut stack = Vec::new();
        self.reach(start, &current, &mut stack)?;
        while let Some(wall) = stack.pop() {
            budget.spend(2)?;
            for side in [2 * wall, 2 * wall + 1] {
                current.copy_from_slice(&self.windings[side as usize * operands..][..operands]);
                for facing in self.walls.facing(side) {
                    self.reach(facing, &current, &mut stack)?;
                }
            }
        }
        Ok(())
    }

    /// Notes that these are the winding numbers of a side, and with it those of the other side of its wall.
    fn reach(
        &mut self,
        side: WallSide,
        current: &[i32],
        stack: &mut Vec<u32>,
    ) -> Result<(), ArrangementError> {
        let (operands, wall, is_behind) = (current.len(), side / 2, side % 2 == 1);
        let first = wall as usize * operands;
        let (front, behind) = self.windings[2 * first..2 * (first + operands)].split_at_mut(operands);
        let (known, other) = if is_behind { (behind, front) } else { (front, behind) };
        if known[0] == UNKNOWN {
            known.copy_from_slice(current);
            for ((other, &known), &jump) in other.iter_mut().zip(current).zip(&self.jumps[first..]) {
                *other = if is_behind { known - jump } else { known + jump };
            }
            stack.push(wall);
        } else if *known != *current {
            return Err(ArrangementError::Inconsistent("the sides of a wall do not differ by its jump"));
        }
        Ok(())
    }
}
