//! Cavities that the lattice itself makes.
//!
//! In a gap thinner than a cell the lattice finds the space outside here and there: bubbles that hang together in truth, and
//! with the space outside. They are opened by the one vertex that parts them from it, or along a straight way that crosses
//! nothing of the input. Specks, which are within a cube, are filled where there is neither.
//! A bubble that is a whole part of the input stays.

use super::super::link;
use super::super::surface::{InputSurface, SearchAllowance};
use super::crumbs::Small;
use super::{INSIDE, KNOWN, LISTED, Signs};
use crate::budget::{Budget, Stopped};
use crate::geom::Aabb;

/// A bubble is as thin as a vertex or two, and no wider than this.
const BUBBLE: Small = Small { vertices: 512, extent: 64.0 };

/// A bubble is filled where other space outside is within so many cells: so far what it showed can move.
const FILL_REACH: usize = 3;

/// Largest step of a way out, in cells along each axis.
const WAY: isize = 3;

/// Ways out of a bubble that are tried, the shortest first.
const TRIES: usize = 128;

/// Bubbles of one gap that are opened one after the other.
const OPENINGS: usize = 16;

impl Signs<'_> {
    /// Opens bubbles to the space outside, and fills others that are near it; gives both numbers.
    pub(in crate::wrap) fn clear_bubbles(
        &mut self,
        surface: &InputSurface,
        budget: &Budget,
    ) -> Result<[u32; 2], Stopped> {
        let pieces = self.small_pieces(false, BUBBLE, budget)?;
        if pieces.is_empty() {
            return Ok([0; 2]);
        }
        let (boxes, _charge) = surface.boxes_of_parts(budget)?;
        let mut looks = self.looks();
        let mut bubbles = Vec::new();
        for bubble in pieces {
            if !self.is_part(&bubble, surface, &boxes, &mut looks, budget)? {
                bubble.iter().for_each(|&v| self.state[v] |= LISTED);
                bubbles.push(bubble);
            }
        }
        let count = bubbles.len();
        let mut turned = Vec::new();
        let left = self.open(bubbles, surface, &mut turned, &mut looks, budget)?;
        // What stays shows its gap: specks in the same gap are opened to it.
        let (specks, large): (Vec<_>, Vec<_>) = left.into_iter().partition(|bubble| self.is_speck(bubble));
        large.iter().flatten().for_each(|&v| self.state[v] &= !LISTED);
        let specks = self.open(specks, surface, &mut turned, &mut looks, budget)?;
        let opened = count - large.len() - specks.len();
        let mut fills = 0;
        for speck in specks {
            budget.spend(FILL_REACH as u64 * 64)?;
            let is_filled = self.is_beside_outside(speck[0]);
            speck.iter().for_each(|&v| self.state[v] &= !LISTED);
            if is_filled {
                fills += 1;
                speck.iter().for_each(|&v| self.turn(v));
                turned.extend(speck.iter().map(|&v| v as u32));
            }
        }
        self.evaluate_from_known(turned, budget)?;
        Ok([opened as u32, fills])
    }

    /// Opens bubbles, whose vertices are listed, to the space outside, as far as that is found; gives those that are left. Adds the
    /// vertices that changed sides to `turned`.
    fn open(
        &mut self,
        mut bubbles: Vec<Vec<usize>>,
        surface: &InputSurface,
        turned: &mut Vec<u32>,
        looks: &mut SearchAllowance,
        budget: &Budget,
    ) -> Result<Vec<Vec<usize>>, Stopped> {
        let ways = ways();
        // A bubble that was opened may be what opens the next one in the same gap.
        for _ in 0..OPENINGS {
            let (before, mut left) = (bubbles.len(), Vec::new());
            for bubble in bubbles {
                let opening = match self.wall_of(&bubble, surface, looks, budget)? {
                    Some(wall) => Some(vec![wall]),
                    None => self.way_out(&bubble, &ways, surface, looks, budget)?,
                };
                let Some(opening) = opening else {
                    left.push(bubble);
                    continue;
                };
                bubble.iter().for_each(|&v| self.state[v] &= !LISTED);
                for v in opening {
                    self.turn(v);
                    turned.push(v as u32);
                }
            }
            bubbles = left;
            if bubbles.len() == before {
                break;
            }
        }
        Ok(bubbles)
    }

    /// The vertices inside along a straight way that crosses nothing of the input, from a bubble, whose vertices are listed,
    /// to the space outside.
    fn way_out(
        &self,
        bubble: &[usize],
        ways: &[[isize; 3]],
        surface: &InputSurface,
        looks: &mut SearchAllowance,
        budget: &Budget,
    ) -> Result<Option<Vec<usize>>, Stopped> {
        budget.spend(bubble.len() as u64 * 16)?;
        let mut tries = 0;
        for &way in ways {
            for &from in bubble {
                let Some(to) = self.step(from, way) else { continue };
                if self.state[to] & (KNOWN | INSIDE | LISTED) != KNOWN {
                    continue;
                }
                let ends = [from, to].map(|v| self.lattice.units(v));
                if !surface.may_cross(ends, looks, budget)? {
                    let mut along = self.along(from, way);
                    along.retain(|&v| self.is_inside(v));
                    along.dedup();
                    return Ok(Some(along));
                }
                tries += 1;
                if tries == TRIES {
                    return Ok(None);
                }
            }
        }
        Ok(None)
    }

    /// The vertex that a step leads to.
    fn step(&self, from: usize, step: [isize; 3]) -> Option<usize> {
        let place = self.lattice.coordinates(from);
        let to = [0, 1, 2].map(|a| place[a].wrapping_add_signed(step[a]));
        (0..3).all(|a| to[a] < self.lattice.dims[a]).then(|| self.lattice.index(to))
    }

    /// The vertices nearest to a straight way, each beside the one before it.
    fn along(&self, from: usize, way: [isize; 3]) -> Vec<usize> {
        let steps = way.map(isize::abs).into_iter().max().unwrap_or(0);
        let mut at = [0; 3];
        let mut along = Vec::new();
        for n in 1..=steps {
            let next = way.map(|length| (length as f64 * n as f64 / steps as f64).round() as isize);
            // Two vertices of a cube are beside each other where no axis runs against another one.
            let forward = [0, 1, 2].map(|a| at[a].max(next[a]));
            along.extend([forward, next].into_iter().filter_map(|place| self.step(from, place)));
            at = next;
        }
        along
    }

    /// A vertex inside that alone parts a bubble, whose vertices are listed, from the space outside, so that opening it there makes
    /// no handle. If the bubble is more than a speck, a way past the vertex must cross nothing of the input.
    fn wall_of(
        &self,
        bubble: &[usize],
        surface: &InputSurface,
        looks: &mut SearchAllowance,
        budget: &Budget,
    ) -> Result<Option<usize>, Stopped> {
        let beside = |v: usize| link::STEPS.map(|step| v.wrapping_add_signed(self.lattice.stride(step)));
        let is_speck = self.is_speck(bubble);
        let mut tries = 0;
        for wall in bubble.iter().flat_map(|&v| beside(v)).filter(|&wall| self.is_inside(wall)) {
            let Some(inside) = self.inside_around(wall) else { continue };
            let around = beside(wall);
            let outside: Vec<u16> = link::pieces(!inside & link::ALL).collect();
            let &[a, b] = &outside[..] else { continue };
            if link::pieces(inside).count() != 1 {
                continue;
            }
            // A piece is connected, so that any of its vertices tells where it is.
            let [first, second] = [a, b].map(|piece| around[piece.trailing_zeros() as usize]);
            let is_listed = |v: usize| self.state[v] & LISTED != 0;
            let is_of_bubble = |v: usize| is_listed(v) && bubble.contains(&v);
            let is_between =
                is_of_bubble(first) && !is_listed(second) || is_of_bubble(second) && !is_listed(first);
            if !is_between {
                continue;
            }
            if is_speck {
                return Ok(Some(wall));
            }
            let members =
                |piece: u16| (0..link::COUNT).filter(move |n| piece >> n & 1 == 1).map(|n| around[n]);
            for (from, to) in members(a).flat_map(|from| members(b).map(move |to| (from, to))) {
                let ends = [from, to].map(|v| self.lattice.units(v));
                tries += 1;
                if !surface.may_cross(ends, looks, budget)? {
                    return Ok(Some(wall));
                }
                if tries == TRIES {
                    return Ok(None);
                }
            }
        }
        Ok(None)
    }

    /// Whether a bubble is within a cube.
    fn is_speck(&self, bubble: &[usize]) -> bool {
        let bounds = Aabb::of(bubble.iter().map(|&v| self.lattice.units(v)));
        (bounds.max - bounds.min).max_element() <= 1.0
    }

    /// Whether space outside that is no bubble is within reach of a vertex of a bubble. A bubble without is deep in a gap that
    /// nothing else shows.
    fn is_beside_outside(&self, v: usize) -> bool {
        let center = self.lattice.coordinates(v);
        let range = |a: usize| {
            center[a].saturating_sub(FILL_REACH)..=(center[a] + FILL_REACH).min(self.lattice.dims[a] - 1)
        };
        range(0).any(|i| {
            range(1).any(|j| {
                range(2)
                    .any(|k| self.state[self.lattice.index([i, j, k])] & (KNOWN | INSIDE | LISTED) == KNOWN)
            })
        })
    }
}

/// Steps of a way out, the shortest first.
fn ways() -> Vec<[isize; 3]> {
    let axis = || -WAY..=WAY;
    let mut ways: Vec<[isize; 3]> =
        axis().flat_map(|x| axis().flat_map(move |y| axis().map(move |z| [x, y, z]))).collect();
    ways.sort_by_key(|way| way.iter().map(|n| n * n).sum::<isize>());
    ways.split_off(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::DVec3;
    use crate::wrap::lattice::Lattice;

    #[test]
    fn a_way_is_a_chain_of_neighbours() {
        let lattice = Lattice::around(Aabb { min: DVec3::ZERO, max: DVec3::ONE }, 8, usize::MAX).unwrap();
        let signs = Signs::of_field(&lattice, &vec![false; lattice.len()]);
        let from = lattice.index([8, 8, 8]);
        let ways = ways();
        assert_eq!(ways.len(), 342);
        for way in ways {
            let mut chain = vec![from];
            chain.extend(signs.along(from, way));
            chain.dedup();
            assert_eq!(chain.last().copied(), signs.step(from, way));
            for pair in chain.windows(2) {
                let stride = pair[1].wrapping_sub(pair[0]) as isize;
                assert!(link::STEPS.iter().any(|&step| lattice.stride(step) == stride), "{way:?}");
            }
        }
        assert_eq!(signs.step(lattice.index([1, 8, 8]), [-2, 0, 0]), None);
    }
}
