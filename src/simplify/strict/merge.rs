//! What one collapse changes in the queue, and which edges are looked at again.

use super::Strict;
use crate::mesh::corner_table::{NONE, next, prev, triangle_of};
use crate::simplify::criterion::{CollapseCriterion, CostReach};
use crate::simplify::report::SimplifyRefusal;

impl<C: CollapseCriterion> Strict<'_, C> {
    /// Collapses the edge of `h` in the table; in the queue, the edges that become one become one entry.
    #[inline]
    pub(super) fn merge_edges(&mut self, h: u32) {
        let table = &self.surface.table;
        let twin = table.twin(h);
        for side in [h, twin].into_iter().filter(|&side| side != NONE) {
            let before = [next(side), prev(side)];
            let after = before.map(|g| table.twin(g)).into_iter().min().unwrap_or(NONE);
            let keys = before.map(|g| {
                let edge = table.edge(g);
                let key = self.queue.key(edge);
                self.queue.take_out(edge);
                key
            });
            // The merged edge costs at least as much as each of the two.
            match keys.into_iter().max().flatten() {
                Some(key) => self.queue.set(after, key),
                // Both were set aside.
                None => {
                    self.queue.set_aside(after);
                    self.surface.vertices[table.destination(h) as usize].has_aside = true;
                }
            }
        }
        self.surface.table.collapse(h, &self.rings);
    }

    /// Gives the edges around the merged vertex new costs where these may be lower now, and takes back what was set
    /// aside: whether an edge can be collapsed depends on the faces around its ends, so on all edges of the merged
    /// vertex and of its neighbours.
    pub(super) fn look_around(&mut self) {
        let rings = std::mem::take(&mut self.rings);
        let mut affected = std::mem::take(&mut self.affected);
        for &corner in rings.origin.corners.iter().chain(&rings.destination.corners) {
            if self.surface.table.corners(triangle_of(corner)).is_none() {
                continue;
            }
            self.list_affected(corner, next(corner), &mut affected);
            let last = prev(corner);
            if self.surface.table.twin(last) == NONE {
                self.list_affected(last, last, &mut affected);
            }
        }
        if C::REACH == CostReach::Neighbours {
            affected.sort_unstable();
            affected.dedup();
        }
        for edge in affected.drain(..) {
            self.reconsider(edge);
        }
        (self.rings, self.affected) = (rings, affected);
    }

    /// Lists what is to be considered anew of the edge of the half-edge `spoke` of the merged vertex and of the edges
    /// of its other end, which `outer` leaves.
    #[inline]
    fn list_affected(&mut self, spoke: u32, outer: u32, affected: &mut Vec<u32>) {
        if C::REACH == CostReach::Star {
            affected.push(self.surface.table.edge(spoke));
        }
        // Both ends of an edge that is set aside say so.
        let neighbour = self.surface.table.origin(outer) as usize;
        let has_aside = std::mem::replace(&mut self.surface.vertices[neighbour].has_aside, false);
        if has_aside || C::REACH == CostReach::Neighbours {
            let is_due = |edge: &u32| C::REACH == CostReach::Neighbours || self.queue.is_aside(*edge);
            affected.extend(self.surface.star(outer).filter(is_due));
        }
    }

    /// Computes the cost of an edge anew and puts it in the queue.
    pub(super) fn reconsider(&mut self, edge: u32) {
        match self.cost(edge) {
            Ok(key) => self.queue.set(edge, key),
            Err(reason) => self.set_aside(edge, reason),
        }
    }

    /// Sets an edge aside.
    pub(super) fn set_aside(&mut self, edge: u32, reason: SimplifyRefusal) {
        self.refusals.add(reason);
        self.queue.set_aside(edge);
        for v in [edge, next(edge)].map(|g| self.surface.table.origin(g)) {
            self.surface.vertices[v as usize].has_aside = true;
        }
    }
}
