//! What pieces enclose, whichever way they turn: the sides that can be reached from outside, part by part.
//!
//! Each connected part is looked at alone. Nothing of it is above its highest vertex, nor near that above the flattest edge there:
//! around that edge the piece next to the upward direction shows one of its sides to the outside. What sides look at each other tells
//! all others. At an open edge a piece looks at its own back, so that an open part encloses nothing.

use super::Arrangement;
use super::error::ArrangementError;
use super::walls::{PieceSide, Walls};
use crate::budget::{Budget, CHECK_EVERY};
use crate::mesh::EdgeGroups;
use num_bigint::BigInt;
use num_rational::Ratio;
use num_traits::{Signed, Zero};

type Number = Ratio<BigInt>;
type RationalVector = [Number; 3];

/// Sets the winding numbers of `arrangement`, which has one operand and was made of `triangles`: 0 on the sides that can be reached
/// from outside of the connected part that they are of, 1 on the others.
pub(super) fn enclose(
    arrangement: &mut Arrangement,
    triangles: &[[u32; 3]],
    budget: &Budget,
) -> Result<(), ArrangementError> {
    let count = arrangement.pieces.len();
    let _charge = budget.charge((count * 8) as u64)?;
    let groups = EdgeGroups::build(&arrangement.pieces, arrangement.point_count(), budget)?;
    let walls = Walls::find(arrangement, triangles, &groups, budget)?;
    let _walls_charge = budget.charge((walls.count() * 8) as u64)?;
    let mut of_walls = vec![1; 2 * walls.count()];
    let mut outside = Vec::new();
    for top in tops(arrangement, &groups, budget)? {
        for side in top.shown_upward(arrangement, budget)? {
            let side = walls.side(side);
            if std::mem::replace(&mut of_walls[side as usize], 0) != 0 {
                outside.push(side);
            }
        }
    }
    while let Some(side) = outside.pop() {
        budget.spend(1)?;
        for next in walls.facing(side) {
            if std::mem::replace(&mut of_walls[next as usize], 0) != 0 {
                outside.push(next);
            }
        }
    }
    budget.spend(count as u64)?;
    arrangement.windings = (0..2 * count as u32).map(|side| of_walls[walls.side(side) as usize]).collect();
    Ok(())
}

/// The highest vertex of a connected part.
struct Top {
    /// It is one of the input, since every triangle is in one part as a whole.
    vertex: u32,
    /// The pieces that have it.
    pieces: Vec<u32>,
}

/// That of each connected part.
fn tops(
    arrangement: &Arrangement,
    groups: &EdgeGroups,
    budget: &Budget,
) -> Result<Vec<Top>, ArrangementError> {
    let parts = groups.components(budget)?;
    let inputs = arrangement.positions.len() as u32;
    let place = |p: u32| {
        let [x, y, z] = arrangement.positions[p as usize].to_array();
        [z, y, x]
    };
    let mut highest: Vec<Option<u32>> = vec![None; parts.count as usize];
    for (f, (&part, corners)) in parts.of.iter().zip(&arrangement.pieces).enumerate() {
        if f % CHECK_EVERY == 0 {
            budget.spend(CHECK_EVERY as u64)?;
        }
        for &p in corners.iter().filter(|&&p| p < inputs) {
            let highest = &mut highest[part as usize];
            if highest.is_none_or(|best| place(p) > place(best)) {
                *highest = Some(p);
            }
        }
    }
    let top = |vertex: Option<u32>| {
        let vertex = vertex.ok_or(ArrangementError::Inconsistent("a part has no vertex of the input"))?;
        Ok::<_, ArrangementError>(Top { vertex, pieces: Vec::new() })
    };
    let mut tops = highest.into_iter().map(top).collect::<Result<Vec<Top>, _>>()?;
    for (f, (&part, corners)) in parts.of.iter().zip(&arrangement.pieces).enumerate() {
        let top = &mut tops[part as usize];
        if corners.contains(&top.vertex) {
            top.pieces.push(f as u32);
        }
    }
    Ok(tops)
}

impl Top {
    /// The sides that the pieces around it show upward at the flattest edge there.
    fn shown_upward(
        &self,
        arrangement: &Arrangement,
        budget: &Budget,
    ) -> Result<Vec<PieceSide>, ArrangementError> {
        let Self { vertex: top, pieces } = self;
        let top = *top;
        budget.spend(32 * pieces.len() as u64)?;
        let origin = arrangement.coordinates(top);
        let from_top = |p: u32| -> RationalVector {
            let place = arrangement.coordinates(p);
            std::array::from_fn(|k| &place[k] - &origin[k])
        };
        let mut ends: Vec<u32> = pieces.iter().flat_map(|&f| arrangement.pieces[f as usize]).collect();
        ends.sort_unstable();
        ends.dedup();
        // Squares of how far an edge goes down for how far it goes aside.
        let steepness = |d: &RationalVector| {
            let aside = &d[0] * &d[0] + &d[1] * &d[1];
            (!aside.is_zero()).then(|| &d[2] * &d[2] / aside)
        };
        let slopes = ends.iter().filter(|&&p| p != top).filter_map(|&p| {
            let along = from_top(p);
            Some((steepness(&along)?, p, along))
        });
        let flattest = slopes.min_by(|a, b| a.0.cmp(&b.0));
        let (_, end, along) =
            flattest.ok_or(ArrangementError::Inconsistent("all edges at a vertex are vertical"))?;
        // Seen along the edge, x is upward and y aside; `e x z` and `z |e|^2 - e (e . z)` without their lengths.
        let square = along.iter().map(|x| x * x).sum::<Number>();
        let seen = |d: &RationalVector| {
            let y = &d[0] * &along[1] - &d[1] * &along[0];
            let x = &d[2] * &square - d.iter().zip(&along).map(|(d, e)| d * e).sum::<Number>() * &along[2];
            (x, y)
        };
        let mut next: [Option<(Number, PieceSide)>; 2] = [None, None];
        let mut below = Vec::new();
        for &f in pieces {
            let corners = arrangement.pieces[f as usize];
            let Some(k) =
                corners.iter().position(|&p| p != top && p != end).filter(|_| corners.contains(&end))
            else {
                continue;
            };
            let (x, y) = seen(&from_top(corners[k]));
            if y.is_zero() {
                below.extend([2 * f, 2 * f + 1]);
                continue;
            }
            // `z . (e x d)` is -y; a piece turns by `e x d` where its corners are the vertex, the end and this one.
            let is_along = corners[(k + 1) % 3] == top;
            let is_front = is_along == y.is_negative();
            let height = x / y.abs();
            let next = &mut next[usize::from(y.is_negative())];
            if next.as_ref().is_none_or(|(best, _)| height > *best) {
                *next = Some((height, 2 * f + u32::from(!is_front)));
            }
        }
        let shown: Vec<PieceSide> = next.into_iter().flatten().map(|(_, side)| side).collect();
        Ok(if shown.is_empty() { below } else { shown })
    }
}
