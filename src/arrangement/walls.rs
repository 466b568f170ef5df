//! Walls: what pieces form over the edges that only two of them share. Each side of a wall looks into one cell, so that the cells
//! follow from the few edges where more pieces meet.

use super::Arrangement;
use super::error::ArrangementError;
use super::radial::{Normal, around};
use crate::budget::{Budget, CHECK_EVERY, Charge};
use crate::mesh::{Components, EdgeGroups, ParityUnionFind, UnionFind, edge_of, triangle_of};
use crate::par;

/// A side of a piece is `2 f` where the piece `f` turns counter-clockwise, `2 f + 1` on the other.
pub(super) type PieceSide = u32;
/// A side of a wall is that side of its first piece, with the number of the wall instead.
pub(super) type WallSide = u32;

/// The walls of an arrangement and where their sides look at each other.
pub(super) struct Walls<'b> {
    /// For each piece the side of its wall that its front is a part of.
    fronts: Vec<WallSide>,
    /// The first piece of each wall.
    first_pieces: Vec<u32>,
    /// Two sides that look at each other, either way round; ascending, each once.
    neighbours: Vec<[WallSide; 2]>,
    /// Where those of each side begin in `neighbours`, and the end.
    starts: Vec<u32>,
    _charges: [Charge<'b>; 2],
}

/// Where sides of walls look at each other.
enum Join {
    /// This piece has an edge of its own, or its wall comes back to itself turned around: both sides look into one cell.
    OneSided(u32),
    /// More than two pieces meet at this edge.
    Many(usize),
}

impl<'b> Walls<'b> {
    /// Those of `arrangement`, of which these are the edges and which was made of `triangles`.
    pub(super) fn find(
        arrangement: &Arrangement,
        triangles: &[[u32; 3]],
        groups: &EdgeGroups,
        budget: &'b Budget,
    ) -> Result<Self, ArrangementError> {
        let count = arrangement.pieces.len();
        let pieces_charge = budget.charge(count as u64 * 8)?;
        let mut parities = ParityUnionFind::new(count);
        let mut joins = Vec::new();
        for (e, group) in groups.iter().enumerate() {
            if e % CHECK_EVERY == 0 {
                budget.spend(CHECK_EVERY as u64)?;
            }
            match *group {
                [h] => joins.push(Join::OneSided(triangle_of(h))),
                [h, other] => {
                    let [from, other_from] = [h, other].map(|h| edge_of(&arrangement.pieces, h)[0]);
                    let [f, other_f] = [h, other].map(triangle_of);
                    if !parities.relate(f, other_f, from == other_from) {
                        joins.push(Join::OneSided(f));
                    }
                }
                _ => joins.push(Join::Many(e)),
            }
        }
        let (mut fronts, mut first_pieces) = (vec![0; count], Vec::new());
        for f in 0..count as u32 {
            let (first, is_turned) = parities.find(f);
            fronts[f as usize] = if first == f {
                first_pieces.push(f);
                2 * (first_pieces.len() - 1) as u32
            } else {
                fronts[first as usize] ^ u32::from(is_turned)
            };
        }
        drop(parities);
        let _joins_charge = budget.charge(joins.len() as u64 * 32)?;
        let side = |side: PieceSide| fronts[side as usize / 2] ^ (side % 2);
        let pairs = par::try_map_ranges(joins.len(), 256, |range| {
            let mut pairs = Vec::new();
            for join in &joins[range] {
                match *join {
                    Join::OneSided(f) => pairs.push([side(2 * f), side(2 * f + 1)]),
                    Join::Many(e) => {
                        let facing = facing(arrangement, triangles, groups.group(e), budget)?;
                        pairs.extend(facing.into_iter().map(|pair| pair.map(side)));
                    }
                }
            }
            Ok::<_, ArrangementError>(pairs)
        })?;
        let found: usize = pairs.iter().map(Vec::len).sum();
        let neighbours_charge = budget.charge(found as u64 * 16 + first_pieces.len() as u64 * 8)?;
        let mut neighbours: Vec<[WallSide; 2]> = Vec::with_capacity(2 * found);
        neighbours.extend(pairs.into_iter().flatten().flat_map(|[a, b]| [[a, b], [b, a]]));
        par::sort_unstable(&mut neighbours);
        neighbours.dedup();
        let mut starts = vec![0; 2 * first_pieces.len() + 1];
        for &[side, _] in &neighbours {
            starts[side as usize + 1] += 1;
        }
        for side in 1..starts.len() {
            starts[side] += starts[side - 1];
        }
        Ok(Self { fronts, first_pieces, neighbours, starts, _charges: [pieces_charge, neighbours_charge] })
    }

    /// The number of walls.
    pub(super) fn count(&self) -> usize {
        self.first_pieces.len()
    }

    /// A piece of each wall, of which the front is the first side of the wall.
    pub(super) fn first_pieces(&self) -> &[u32] {
        &self.first_pieces
    }

    /// The side of a wall that a side of a piece is a part of.
    pub(super) fn side(&self, side: PieceSide) -> WallSide {
        self.fronts[side as usize / 2] ^ (side % 2)
    }

    /// The sides that a side of a wall looks at where it ends.
    pub(super) fn facing(&self, side: WallSide) -> impl Iterator<Item = WallSide> {
        let range = self.starts[side as usize] as usize..self.starts[side as usize + 1] as usize;
        self.neighbours[range].iter().map(|&[_, to]| to)
    }

    /// The walls that are connected, over all edges.
    pub(super) fn parts(&self) -> Components {
        let mut parts = UnionFind::new(self.count());
        for [a, b] in &self.neighbours {
            parts.unite(a / 2, b / 2);
        }
        parts.into_components()
    }
}

/// The sides of pieces that look at each other around an edge, of which `group` are the half-edges.
fn facing(
    arrangement: &Arrangement,
    triangles: &[[u32; 3]],
    group: &[u32],
    budget: &Budget,
) -> Result<Vec<[PieceSide; 2]>, ArrangementError> {
    let [from, to] = edge_of(&arrangement.pieces, group[0]);
    let edge = [from.min(to), from.max(to)];
    let is_along = |h: u32| edge_of(&arrangement.pieces, h)[0] == edge[0];
    let normal = |&h: &u32| {
        let plane = arrangement.planes[triangle_of(h) as usize];
        let corners = triangles[plane as usize].map(|v| arrangement.positions[v as usize]);
        Normal::of(corners, !is_along(h))
    };
    let normals: Vec<Normal> = group.iter().map(normal).collect();
    budget.spend(8 * group.len() as u64)?;
    let order = around(arrangement, edge, &normals)
        .ok_or(ArrangementError::Inconsistent("two pieces lie on each other"))?;
    let pair = |(k, &i): (usize, &usize)| {
        let (h, next) = (group[i], group[order[(k + 1) % order.len()]]);
        // Counter-clockwise around the edge comes the front of a piece that runs along it.
        let ahead = 2 * triangle_of(h) + u32::from(!is_along(h));
        [ahead, 2 * triangle_of(next) + u32::from(is_along(next))]
    };
    Ok(order.iter().enumerate().map(pair).collect())
}
