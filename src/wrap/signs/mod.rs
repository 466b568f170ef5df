//! Which vertices of the lattice are inside.
//!
//! A vertex is inside when the surface winds around it at least half a time, or when it is close to a part of the surface
//! that would otherwise be lost: a sheet, or a wall thinner than a cell. Signs are known at all vertices when every shell
//! is closed. Otherwise they are evaluated near the surface, and from there on wherever signs differ, until no cube with
//! a known vertex of each sign has an unknown one: the surface between the signs is then closed.

mod bubbles;
mod crumbs;
mod handles;
mod walls;

use super::lattice::Lattice;
use super::surface::InputSurface;
use super::{columns, link, raster};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::par;
use crate::winding::{WindingTree, turned};

/// Least distance in cells up to which a sheet grows: what the vertices of every cube that it goes through are within. It
/// grows behind the sheet, so that the sheet itself remains one side, and around seams.
const SHEET: f64 = 1.733;

/// Distance in cells up to which a thin wall grows to both sides. The plane in the middle of a slab twice as thick, and
/// a line in a tube, have vertices of the lattice that hang together beside them everywhere.
pub(super) const THIN: f64 = 1.0;

/// Thickness in cells below which a wall grows, to this thickness: vertices of a lattice in a slab that is thicker hang together,
/// whatever its direction, and in a thinner one they may not.
const SLAB: f64 = 1.75;

const KNOWN: u8 = 1;
const INSIDE: u8 = 2;
/// The cube above this vertex meets a triangle that bounds a volume, or a sheet.
const TOUCHED: u8 = 4;
const TOUCHED_BY_SHEET: u8 = 8;
const SHEET_SIDE: u8 = 16;
const THIN_SIDE: u8 = 32;
const LISTED: u8 = 64;
/// Walls grow in the cube above this vertex.
const GROWING: u8 = 128;

/// Width in cells to which a gap between walls that grow is left open, for the same reason.
const GAP: f64 = SLAB;

/// Why a vertex is inside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Inside {
    /// The surface winds around it.
    Wound,
    /// It is close behind a sheet.
    NearSheet,
    /// It is close to a wall that is thinner than a cell.
    NearThin,
}

/// What sampling on a lattice made, below the size of a cell, and what was taken away again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct OwnDefects {
    /// Bodies within one cube that no part of the input is.
    pub crumbs_dropped: u32,
    /// Cavities within one cube that no part of the input is, and that became a part of the space outside.
    pub bubbles_opened: u32,
    /// The same, filled.
    pub bubbles_filled: u32,
    /// Tunnels one vertex wide around a handle of a few cells.
    pub tunnels_closed: u32,
    /// Bridges one vertex wide that made a handle of a few cells.
    pub bridges_cut: u32,
}

/// Signs, and what they were made of.
#[derive(Debug)]
pub(super) struct Signs<'l> {
    lattice: &'l Lattice,
    state: Vec<u8>,
    /// Thickness in cells of the walls that sheets become.
    pub(super) wall: f64,
    /// Distance in cells up to which sheets grew.
    pub(super) sheet_reach: f64,
    /// Winding number of all that bounds a volume, closed by cones.
    closed: Vec<i8>,
    /// The cones, turned around.
    open: WindingTree,
    /// Triangles of walls that grew.
    pub(super) thin: Vec<[DVec3; 3]>,
    /// What the lattice made itself and what was taken away again.
    pub(super) own: OwnDefects,
}

impl<'l> Signs<'l> {
    /// Decides the signs; sheets become walls of a thickness of `wall` cells or more, which the fit makes thinner.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub(super) fn decide(
        lattice: &'l Lattice,
        surface: &InputSurface,
        wall: f64,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let (closed, open) = par::join(
            || columns::winding(lattice, [surface.boundary(), &surface.cones], budget),
            || WindingTree::build(turned(&surface.cones), budget),
        );
        let state = vec![0u8; lattice.len()];
        let sheet_reach = wall.max(SHEET);
        let mut signs = Self {
            lattice,
            state,
            wall,
            sheet_reach,
            closed: closed?,
            open: open?,
            thin: Vec::new(),
            own: OwnDefects::default(),
        };
        signs.border();
        signs.touch(surface.closed(), TOUCHED, budget)?;
        signs.touch(surface.open(), TOUCHED, budget)?;
        signs.touch(surface.sheets(), TOUCHED_BY_SHEET, budget)?;
        if signs.open.is_empty() {
            signs.take_closed(budget)?;
        } else {
            let near = signs.near(TOUCHED | TOUCHED_BY_SHEET, budget)?;
            signs.evaluate_from(near, budget)?;
        }
        let crumbs = signs.drop_crumbs(surface, budget)?;
        let changed = signs.keep_what_is_lost(surface, budget)?;
        signs.evaluate_from_known(changed, budget)?;
        let crumbs_dropped = crumbs + signs.drop_crumbs(surface, budget)?;
        let [bubbles_opened, bubbles_filled] = signs.clear_bubbles(surface, budget)?;
        let [tunnels_closed, bridges_cut] = signs.drop_handles(budget)?;
        signs.own =
            OwnDefects { crumbs_dropped, bubbles_opened, bubbles_filled, tunnels_closed, bridges_cut };
        Ok(signs)
    }

    /// Signs as they are told.
    #[cfg(test)]
    pub(super) fn of_field(lattice: &'l Lattice, inside: &[bool]) -> Self {
        let state = inside.iter().map(|&is_inside| if is_inside { KNOWN | INSIDE } else { KNOWN }).collect();
        let (closed, open) = (Vec::new(), WindingTree::default());
        Self {
            lattice,
            state,
            wall: SHEET,
            sheet_reach: SHEET,
            closed,
            open,
            thin: Vec::new(),
            own: OwnDefects::default(),
        }
    }

    /// True when the vertex is known to be inside.
    pub(super) fn is_inside(&self, index: usize) -> bool {
        self.state[index] & INSIDE != 0
    }

    pub(super) fn is_known(&self, index: usize) -> bool {
        self.state[index] & KNOWN != 0
    }

    /// Why it is inside, for one that is.
    pub(super) fn why(&self, index: usize) -> Inside {
        match self.state[index] {
            state if state & SHEET_SIDE != 0 => Inside::NearSheet,
            state if state & THIN_SIDE != 0 => Inside::NearThin,
            _ => Inside::Wound,
        }
    }

    /// Winding number at a vertex.
    pub(super) fn winding(&self, index: usize, budget: &Budget) -> Result<f64, Stopped> {
        let place = self.lattice.units(index);
        self.open.at(place, f64::from(self.closed[index]), budget)
    }

    /// Whether the winding number at a vertex is at least 1/2.
    fn is_wound(&self, index: usize, budget: &Budget) -> Result<bool, Stopped> {
        let place = self.lattice.units(index);
        self.open.is_inside(place, f64::from(self.closed[index]), budget)
    }

    /// The outermost vertices are outside, whatever winds around them.
    fn border(&mut self) {
        let [x, y, z] = self.lattice.dims;
        for i in 0..x {
            for j in 0..y {
                let start = self.lattice.index([i, j, 0]);
                if i == 0 || j == 0 || i == x - 1 || j == y - 1 {
                    self.state[start..start + z].fill(KNOWN);
                    self.closed[start..start + z].fill(0);
                } else {
                    for k in [start, start + z - 1] {
                        self.state[k] = KNOWN;
                        self.closed[k] = 0;
                    }
                }
            }
        }
    }

    fn touch(&mut self, triangles: &[[DVec3; 3]], mark: u8, budget: &Budget) -> Result<(), Stopped> {
        let (lattice, state) = (self.lattice, &mut self.state);
        for &corners in triangles {
            let mut count = 1;
            raster::cubes(corners, lattice.dims, |cube| {
                state[lattice.index(cube)] |= mark;
                count += 1;
            });
            budget.spend(count)?;
        }
        Ok(())
    }

    /// Every vertex by the closed shells alone.
    fn take_closed(&mut self, budget: &Budget) -> Result<(), Stopped> {
        for (states, windings) in self.state.chunks_mut(CHECK_EVERY).zip(self.closed.chunks(CHECK_EVERY)) {
            budget.check()?;
            for (state, &winding) in states.iter_mut().zip(windings) {
                *state |= if winding >= 1 { KNOWN | INSIDE } else { KNOWN };
            }
        }
        Ok(())
    }

    /// The vertices of the marked cubes and of their neighbours, each once, ascending in blocks.
    fn near(&mut self, marks: u8, budget: &Budget) -> Result<Vec<u32>, Stopped> {
        let mut near = Vec::new();
        for start in (0..self.state.len()).step_by(CHECK_EVERY) {
            budget.check()?;
            for cube in start..(start + CHECK_EVERY).min(self.state.len()) {
                if self.state[cube] & marks != 0 {
                    self.around_cube(cube, |state, index| {
                        if *state & LISTED == 0 {
                            *state |= LISTED;
                            near.push(index as u32);
                        }
                    });
                }
            }
        }
        near.iter().for_each(|&v| self.state[v as usize] &= !LISTED);
        Ok(near)
    }

    /// Calls `body` with each of the 64 vertices of a cube and its neighbours. Marked cubes are never at the border.
    fn around_cube(&mut self, cube: usize, mut body: impl FnMut(&mut u8, usize)) {
        for i in -1..=2 {
            for j in -1..=2 {
                let start = cube.wrapping_add_signed(self.lattice.stride([i, j, -1]));
                for (n, state) in self.state[start..start + 4].iter_mut().enumerate() {
                    body(state, start + n);
                }
            }
        }
    }

    /// Evaluates the vertices of `wanted` that are unknown, and from there on.
    fn evaluate_from(&mut self, mut wanted: Vec<u32>, budget: &Budget) -> Result<(), Stopped> {
        wanted.retain(|&v| self.state[v as usize] & KNOWN == 0);
        let _charge = budget.charge(wanted.len() as u64 * 8)?;
        self.evaluate(&wanted, budget)?;
        self.evaluate_from_known(wanted, budget)
    }

    /// Evaluates vertices that are unknown.
    fn evaluate(&mut self, wanted: &[u32], budget: &Budget) -> Result<(), Stopped> {
        let signs = par::try_map_ranges(wanted.len(), 1024, |range| {
            budget.spend(range.len() as u64 * 8)?;
            let is_inside = |&v: &u32| self.is_wound(v as usize, budget);
            wanted[range].iter().map(is_inside).collect::<Result<Vec<bool>, Stopped>>()
        })?;
        for (&v, is_inside) in wanted.iter().zip(signs.into_iter().flatten()) {
            self.state[v as usize] |= if is_inside { KNOWN | INSIDE } else { KNOWN };
        }
        Ok(())
    }

    /// Evaluates every unknown vertex of a cube that has known ones of both signs, starting around `known`.
    fn evaluate_from_known(&mut self, known: Vec<u32>, budget: &Budget) -> Result<(), Stopped> {
        if self.open.is_empty() {
            return Ok(());
        }
        let mut known = known;
        while !known.is_empty() {
            let mut wanted = Vec::new();
            for (n, &v) in known.iter().enumerate() {
                if n % CHECK_EVERY == 0 {
                    budget.check()?;
                }
                if !self.lattice_border(v as usize) && self.has_other_sign_beside(v as usize) {
                    self.list_unknown_beside(v as usize, &mut wanted);
                }
            }
            wanted.iter().for_each(|&v| self.state[v as usize] &= !LISTED);
            self.evaluate(&wanted, budget)?;
            known = wanted;
        }
        Ok(())
    }

    fn lattice_border(&self, index: usize) -> bool {
        let place = self.lattice.coordinates(index);
        (0..3).any(|a| place[a] == 0 || place[a] == self.lattice.dims[a] - 1)
    }

    fn has_other_sign_beside(&self, index: usize) -> bool {
        let other = if self.is_inside(index) { KNOWN } else { KNOWN | INSIDE };
        beside().any(|offset| {
            let beside = self.state[index.wrapping_add_signed(self.lattice.stride(offset))];
            beside & (KNOWN | INSIDE) == other
        })
    }

    /// The neighbours of a vertex that are inside, as bits in the order of [`link::STEPS`]; `None` where some are unknown, at
    /// the border too.
    fn inside_around(&self, v: usize) -> Option<u16> {
        if !self.is_known(v) || self.lattice_border(v) {
            return None;
        }
        let mut inside = 0;
        for (n, &step) in link::STEPS.iter().enumerate() {
            let state = self.state[v.wrapping_add_signed(self.lattice.stride(step))];
            if state & KNOWN == 0 {
                return None;
            }
            inside |= u16::from(state & INSIDE != 0) << n;
        }
        Some(inside)
    }

    /// The vertices that `is_wanted`, ascending.
    fn select(&self, budget: &Budget, is_wanted: impl Fn(usize) -> bool + Sync) -> Result<Vec<u32>, Stopped> {
        let blocks = par::try_map_ranges(self.state.len(), CHECK_EVERY, |range| {
            budget.check()?;
            Ok(range.filter(|&v| is_wanted(v)).map(|v| v as u32).collect::<Vec<u32>>())
        })?;
        Ok(blocks.concat())
    }

    /// Puts a vertex on the other side.
    fn turn(&mut self, v: usize) {
        self.state[v] &= !(SHEET_SIDE | THIN_SIDE);
        self.state[v] ^= INSIDE;
    }

    fn list_unknown_beside(&mut self, index: usize, wanted: &mut Vec<u32>) {
        for offset in beside() {
            let beside = index.wrapping_add_signed(self.lattice.stride(offset));
            if self.state[beside] & (KNOWN | LISTED) == 0 {
                self.state[beside] |= LISTED;
                wanted.push(beside as u32);
            }
        }
    }
}

/// The 26 neighbours of a vertex.
fn beside() -> impl Iterator<Item = [isize; 3]> {
    (0..27).filter(|&n| n != 13).map(|n| [n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1])
}
