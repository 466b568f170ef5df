//! Bodies within one cube of the lattice that the lattice itself makes.
//!
//! Where the surface is thinner than a cell, single vertices fall inside and become crumbs. They go, unless a whole part of
//! the input is there: then it is that part. Crumbs go before thin walls grow, so that a wall grows where they were.

use super::super::link;
use super::super::surface::{InputSurface, SearchAllowance};
use super::{INSIDE, KNOWN, LISTED, Signs};
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};
use rustc_hash::FxHashSet;

/// A crumb is within a cube.
const CRUMB: Small = Small { vertices: 8, extent: 1.0 };

/// A part that is larger than its piece of the lattice by so many cells on each side may have made it.
const ROOM: f64 = 1.0;

/// Triangles that a search looks at, as a multiple of the vertices of the lattice.
const LOOKS_OF_VERTICES: u64 = 8;

impl Signs<'_> {
    /// Drops crumbs; gives their number.
    pub(in crate::wrap) fn drop_crumbs(
        &mut self,
        surface: &InputSurface,
        budget: &Budget,
    ) -> Result<u32, Stopped> {
        let crumbs = self.small_pieces(true, CRUMB, budget)?;
        let in_crumbs: usize = crumbs.iter().map(Vec::len).sum();
        // Something always stays.
        if self.state.iter().filter(|&state| state & INSIDE != 0).count() == in_crumbs {
            return Ok(0);
        }
        if crumbs.is_empty() {
            return Ok(0);
        }
        let (boxes, _charge) = surface.boxes_of_parts(budget)?;
        let mut looks = self.looks();
        let mut dropped = Vec::new();
        let mut count = 0;
        for crumb in crumbs {
            if !self.is_part(&crumb, surface, &boxes, &mut looks, budget)? {
                count += 1;
                dropped.extend(crumb.into_iter().map(|v| v as u32));
            }
        }
        dropped.iter().for_each(|&v| self.turn(v as usize));
        self.evaluate_from_known(dropped, budget)?;
        Ok(count)
    }

    /// What a search for the own defects of the lattice may look at. What is left then stays as it is.
    pub(super) fn looks(&self) -> SearchAllowance {
        SearchAllowance(LOOKS_OF_VERTICES * self.state.len() as u64)
    }

    /// Whether a whole part of the input, whose boxes are given, is or may be where a piece is.
    pub(super) fn is_part(
        &self,
        piece: &[usize],
        surface: &InputSurface,
        boxes: &[Aabb],
        looks: &mut SearchAllowance,
        budget: &Budget,
    ) -> Result<bool, Stopped> {
        let bounds = Aabb::of(piece.iter().map(|&v| self.lattice.units(v)));
        let room = Aabb { min: bounds.min - ROOM, max: bounds.max + ROOM };
        surface.may_have_part(room, looks, budget, |part| {
            let part = boxes[part as usize];
            part.min.cmpge(room.min).all() && part.max.cmple(room.max).all()
        })
    }

    /// The connected pieces of one side that are small.
    pub(super) fn small_pieces(
        &mut self,
        is_inside: bool,
        small: Small,
        budget: &Budget,
    ) -> Result<Vec<Vec<usize>>, Stopped> {
        let starts = self.select(budget, |v| self.is_inside(v) == is_inside && self.is_thin(v))?;
        let (mut pieces, mut piece, mut seen) = (Vec::new(), FxHashSet::default(), Vec::new());
        for start in starts.into_iter().map(|v| v as usize) {
            if self.state[start] & LISTED == 0 {
                let first = seen.len();
                if self.reach(start, small, &mut piece, &mut seen) {
                    pieces.push(seen[first..].to_vec());
                }
                budget.spend((seen.len() - first) as u64)?;
            }
        }
        seen.iter().for_each(|&v| self.state[v] &= !LISTED);
        Ok(pieces)
    }

    /// Whether a vertex has the other side beside it, and nothing unknown.
    fn is_thin(&self, v: usize) -> bool {
        let all = if self.is_inside(v) { link::ALL } else { 0 };
        self.inside_around(v).is_some_and(|inside| inside != all)
    }

    /// Adds what is connected with `start` on its side to `seen` and marks it, until that is not small; true when it is.
    /// Each vertex is reached once, whatever it is started from.
    fn reach(
        &mut self,
        start: usize,
        small: Small,
        piece: &mut FxHashSet<usize>,
        seen: &mut Vec<usize>,
    ) -> bool {
        let side = self.state[start] & (KNOWN | INSIDE);
        let mut next = seen.len();
        piece.clear();
        piece.insert(start);
        seen.push(start);
        self.state[start] |= LISTED;
        let mut bounds = Aabb::EMPTY;
        while next < seen.len() {
            let v = seen[next];
            next += 1;
            bounds = bounds.union(Aabb::of([self.lattice.units(v)]));
            let is_small = (bounds.max - bounds.min).cmple(DVec3::splat(small.extent)).all()
                && piece.len() <= small.vertices
                && self.is_thin(v);
            if !is_small {
                return false;
            }
            for step in link::STEPS {
                let to = v.wrapping_add_signed(self.lattice.stride(step));
                if self.state[to] & (KNOWN | INSIDE) == side && piece.insert(to) {
                    // What was reached before is not small.
                    if self.state[to] & LISTED != 0 {
                        return false;
                    }
                    self.state[to] |= LISTED;
                    seen.push(to);
                }
            }
        }
        true
    }
}

/// Which pieces of the lattice are small; each of their vertices has the other side beside it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Small {
    pub(super) vertices: usize,
    /// Largest side of their box, in cells.
    pub(super) extent: f64,
}
