//! Bodies (crumbs) and cavities (bubbles) within one cube of the lattice that the lattice itself makes.
//!
//! Where the surface is thinner than a cell, or a gap in it, single vertices fall on the other side and become crumbs and
//! bubbles. They go, unless a whole part of the input is there: then it is that part. Crumbs go before thin walls grow, so
//! that a wall grows where they were. Bubbles are opened rather than filled, because the gap that they are in is real.

use super::super::link;
use super::super::surface::InputSurface;
use super::{INSIDE, KNOWN, LISTED, Signs};
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};

/// Vertices of a cube: a piece of the lattice with more is larger than a cell.
const VERTICES_MAX: usize = 8;

/// A part that is larger than its piece of the lattice by so many cells on each side may have made it.
const ROOM: f64 = 1.0;

/// A bubble is filled where other space outside is within so many cells: so far what it showed can move.
const FILL_REACH: usize = 3;

/// Bubbles of one gap that are opened one after the other.
const OPENINGS: usize = 16;

impl Signs<'_> {
    /// Drops crumbs; gives their number.
    pub(in crate::wrap) fn drop_crumbs(
        &mut self,
        surface: &InputSurface,
        budget: &Budget,
    ) -> Result<u32, Stopped> {
        let crumbs = self.small_pieces(true, budget)?;
        let in_crumbs: usize = crumbs.iter().map(Vec::len).sum();
        // Something always stays.
        if self.state.iter().filter(|&state| state & INSIDE != 0).count() == in_crumbs {
            return Ok(0);
        }
        let boxes = surface.boxes_of_parts();
        let mut dropped = Vec::new();
        let mut count = 0;
        for crumb in crumbs {
            if !self.is_part(&crumb, surface, &boxes, budget)? {
                count += 1;
                dropped.extend(crumb);
            }
        }
        self.turn_all(&dropped, budget)?;
        Ok(count)
    }

    /// Opens bubbles that one vertex parts from the space outside, and fills others that are near it; gives both numbers.
    pub(in crate::wrap) fn clear_bubbles(
        &mut self,
        surface: &InputSurface,
        budget: &Budget,
    ) -> Result<[u32; 2], Stopped> {
        let boxes = surface.boxes_of_parts();
        let mut bubbles = Vec::new();
        for bubble in self.small_pieces(false, budget)? {
            if !self.is_part(&bubble, surface, &boxes, budget)? {
                bubble.iter().for_each(|&v| self.state[v] |= LISTED);
                bubbles.push(bubble);
            }
        }
        let mut turned = Vec::new();
        // A bubble that was opened may be what opens the next one in the same gap.
        let count = bubbles.len();
        for _ in 0..OPENINGS {
            let before = bubbles.len();
            bubbles.retain(|bubble| {
                let wall = self.wall_of(bubble);
                if let Some(wall) = wall {
                    bubble.iter().for_each(|&v| self.state[v] &= !LISTED);
                    self.turn(wall);
                    turned.push(wall as u32);
                }
                wall.is_none()
            });
            budget.spend(before as u64 * 64)?;
            if bubbles.len() == before {
                break;
            }
        }
        let opened = count - bubbles.len();
        let mut filled = Vec::new();
        let mut fills = 0;
        for bubble in bubbles {
            budget.spend(bubble.len() as u64)?;
            let is_filled = self.is_beside_outside(bubble[0]);
            bubble.iter().for_each(|&v| self.state[v] &= !LISTED);
            if is_filled {
                fills += 1;
                bubble.iter().for_each(|&v| self.turn(v));
                filled.extend(bubble.iter().map(|&v| v as u32));
            }
        }
        self.evaluate_from_known([turned, filled].concat(), budget)?;
        Ok([opened as u32, fills])
    }

    fn turn_all(&mut self, vertices: &[usize], budget: &Budget) -> Result<(), Stopped> {
        vertices.iter().for_each(|&v| self.turn(v));
        self.evaluate_from_known(vertices.iter().map(|&v| v as u32).collect(), budget)
    }

    /// A vertex inside that alone parts a bubble, whose vertices are listed, from the space outside.
    fn wall_of(&self, bubble: &[usize]) -> Option<usize> {
        let beside = |v: usize| link::STEPS.map(|step| v.wrapping_add_signed(self.lattice.stride(step)));
        bubble.iter().flat_map(|&v| beside(v)).filter(|&wall| self.is_inside(wall)).find(|&wall| {
            let Some(inside) = self.inside_around(wall) else { return false };
            let around = beside(wall);
            let members =
                |piece: u16| (0..link::COUNT).filter(move |n| piece >> n & 1 == 1).map(|n| around[n]);
            let outside: Vec<u16> = link::pieces(!inside & link::ALL).collect();
            let is_of_bubble = |&piece: &u16| members(piece).all(|v| bubble.contains(&v));
            let is_space = |&piece: &u16| members(piece).all(|v| self.state[v] & LISTED == 0);
            outside.len() == 2
                && link::pieces(inside).count() == 1
                && outside.iter().any(is_of_bubble)
                && outside.iter().any(is_space)
        })
    }

    /// Whether a whole part of the input, whose boxes are given, is where a piece is.
    fn is_part(
        &self,
        piece: &[usize],
        surface: &InputSurface,
        boxes: &[Aabb],
        budget: &Budget,
    ) -> Result<bool, Stopped> {
        let bounds = Aabb::of(piece.iter().map(|&v| self.lattice.units(v)));
        let room = Aabb { min: bounds.min - ROOM, max: bounds.max + ROOM };
        let mut is_part = false;
        surface.parts_in(room, budget, |part| {
            let part = boxes[part as usize];
            is_part |= part.min.cmpge(room.min).all() && part.max.cmple(room.max).all();
        })?;
        Ok(is_part)
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

    /// The connected pieces of one side within a cube each.
    fn small_pieces(&mut self, is_inside: bool, budget: &Budget) -> Result<Vec<Vec<usize>>, Stopped> {
        // In a cube a vertex has at most the seven other ones beside it.
        let has_few = |v: usize| {
            let own = |inside: u16| if is_inside { inside } else { !inside & link::ALL };
            let is_few = |inside| (own(inside).count_ones() as usize) < VERTICES_MAX;
            self.is_inside(v) == is_inside && self.inside_around(v).is_some_and(is_few)
        };
        let starts = self.select(budget, has_few)?;
        let (mut small, mut seen) = (Vec::new(), Vec::new());
        for start in starts.into_iter().map(|v| v as usize) {
            if self.state[start] & LISTED != 0 {
                continue;
            }
            let first = seen.len();
            if self.reach(start, &mut seen) {
                small.push(seen[first..].to_vec());
            }
        }
        seen.iter().for_each(|&v| self.state[v] &= !LISTED);
        Ok(small)
    }

    /// Adds what is connected with `start` on its side to `seen` and marks it, until that is more than a cube; true when it is
    /// not.
    fn reach(&mut self, start: usize, seen: &mut Vec<usize>) -> bool {
        let side = self.state[start] & (KNOWN | INSIDE);
        let mut next = seen.len();
        seen.push(start);
        self.state[start] |= LISTED;
        let mut bounds = Aabb::EMPTY;
        let first = next;
        let mut is_small = true;
        while next < seen.len() {
            let v = seen[next];
            next += 1;
            bounds = bounds.union(Aabb::of([self.lattice.units(v)]));
            let is_cube = (bounds.max - bounds.min).cmple(DVec3::ONE).all() && next - first <= VERTICES_MAX;
            if !is_cube || self.lattice_border(v) {
                is_small = false;
                break;
            }
            for step in link::STEPS {
                let to = v.wrapping_add_signed(self.lattice.stride(step));
                let state = self.state[to];
                if state & KNOWN == 0 || state & (KNOWN | INSIDE | LISTED) == side | LISTED {
                    // What is not known is large; and so is what was reached before.
                    is_small &= state & KNOWN != 0 && seen[first..].contains(&to);
                } else if state & (KNOWN | INSIDE) == side {
                    self.state[to] |= LISTED;
                    seen.push(to);
                }
            }
        }
        is_small
    }
}
