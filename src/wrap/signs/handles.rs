//! Handles that the lattice itself makes.
//!
//! Where two walls touch in a line, or leave a gap thinner than a cell, the vertices of the lattice find tunnels and bridges
//! as it happens. A tunnel one vertex wide is closed, and a bridge one vertex wide is cut, where what it
//! connects hangs together within a few cells anyway: then it is a handle of that size, and not a hole through the part,
//! the mouth of a cavity, or the neck between two bodies.

use super::super::link;
use super::{INSIDE, KNOWN, Signs};
use crate::budget::{Budget, Stopped};

/// A handle is searched up to so many cells from a vertex.
const REACH: isize = 4;

/// Side of the cube of vertices that is looked at.
const SIDE: usize = 2 * REACH as usize + 1;

/// Steps of all searches together, as a multiple of the vertices of the lattice. What is left then stays as it is.
const STEPS_OF_VERTICES: u64 = 8;

impl Signs<'_> {
    /// Closes tunnels and cuts bridges; gives their numbers. Every one takes a handle away, so this ends.
    pub(in crate::wrap) fn drop_handles(&mut self, budget: &Budget) -> Result<[u32; 2], Stopped> {
        let mut work = self.select(budget, |v| self.fork(v).is_some())?;
        work.reverse();
        let mut counts = [0; 2];
        let mut changed = Vec::new();
        let mut steps = 0u64;
        let mut search = HandleSearch::default();
        while let Some(v) = work.pop() {
            let v = v as usize;
            let Some((is_inside, pieces)) = self.fork(v) else { continue };
            let is_one = self.are_connected(v, is_inside, &pieces, &mut search);
            steps += search.reached.len() as u64;
            budget.spend(search.reached.len() as u64)?;
            if steps > STEPS_OF_VERTICES * self.state.len() as u64 {
                break;
            }
            if is_one {
                self.turn(v);
                counts[usize::from(is_inside)] += 1;
                changed.push(v as u32);
                work.extend(link::STEPS.map(|step| v.wrapping_add_signed(self.lattice.stride(step)) as u32));
            }
        }
        self.evaluate_from_known(changed, budget)?;
        Ok(counts)
    }

    /// Whether a vertex is inside, and what it connects of its own side, where that is more than one piece and the other side
    /// is one.
    fn fork(&self, v: usize) -> Option<(bool, Vec<u16>)> {
        let inside = self.inside_around(v)?;
        if inside == 0 || inside == link::ALL {
            return None;
        }
        let is_inside = self.is_inside(v);
        let (own, other) =
            if is_inside { (inside, !inside & link::ALL) } else { (!inside & link::ALL, inside) };
        if link::pieces(other).count() != 1 {
            return None;
        }
        let pieces: Vec<u16> = link::pieces(own).collect();
        (pieces.len() > 1).then_some((is_inside, pieces))
    }

    /// Whether pieces around a vertex are connected with each other on their side near it, but not by it.
    fn are_connected(&self, v: usize, is_inside: bool, pieces: &[u16], search: &mut HandleSearch) -> bool {
        let center = self.lattice.coordinates(v).map(|n| n as isize);
        let side = if is_inside { KNOWN | INSIDE } else { KNOWN };
        let number = |at: [isize; 3]| {
            let [i, j, k] = [0, 1, 2].map(|a| (at[a] + REACH) as usize);
            (i * SIDE + j) * SIDE + k
        };
        search.begin();
        search.is_seen[number([0; 3])] = true;
        search.reached.push([0; 3]);
        let first = pieces[0].trailing_zeros() as usize;
        search.is_seen[number(link::STEPS[first])] = true;
        search.reached.push(link::STEPS[first]);
        let mut missing: u16 = pieces[1..].iter().fold(0, |all, piece| all | piece & piece.wrapping_neg());
        let mut next = 1;
        while next < search.reached.len() && missing != 0 {
            let at = search.reached[next];
            next += 1;
            for step in link::STEPS {
                let to = [0, 1, 2].map(|a| at[a] + step[a]);
                if to.iter().any(|n| n.abs() > REACH) || search.is_seen[number(to)] {
                    continue;
                }
                let place = [0, 1, 2].map(|a| center[a] + to[a]);
                let is_in_lattice = (0..3).all(|a| place[a] >= 0 && place[a] < self.lattice.dims[a] as isize);
                if !is_in_lattice {
                    continue;
                }
                let index = self.lattice.index(place.map(|n| n as usize));
                if self.state[index] & (KNOWN | INSIDE) == side {
                    search.is_seen[number(to)] = true;
                    search.reached.push(to);
                    if let Some(n) = link::STEPS.iter().position(|&step| step == to) {
                        missing &= !(1 << n);
                    }
                }
            }
        }
        missing == 0
    }
}

/// The vertices that a search has reached, as steps from its beginning.
#[derive(Debug)]
struct HandleSearch {
    is_seen: Vec<bool>,
    reached: Vec<[isize; 3]>,
}

impl Default for HandleSearch {
    fn default() -> Self {
        Self { is_seen: vec![false; SIDE * SIDE * SIDE], reached: Vec::new() }
    }
}

impl HandleSearch {
    fn begin(&mut self) {
        self.is_seen.fill(false);
        self.reached.clear();
    }
}
