//! Segments that a triangulation of a plane must have as edges.

use super::error::ArrangementError;
use super::kernel::EXACT;
use super::point::Definition;
use super::triangulation::{CarrierView, NONE, Triangulation};
use crate::budget::{Budget, Charge, Stopped};
use crate::geom::Sign;
use std::cmp::Ordering;
use std::collections::VecDeque;
use std::sync::atomic::{self, AtomicU64};

/// Bytes for a point where constraints cross: its name and ball, and the triangles and pieces that it makes.
pub(super) const BYTES_OF_CROSSING: u64 = 320;

/// The points where constraints cross, in all carriers of an arrangement.
#[derive(Debug)]
pub(super) struct CrossingAccount<'b> {
    pub(super) budget: &'b Budget,
    count: AtomicU64,
    max: u64,
}

impl<'b> CrossingAccount<'b> {
    /// An account of at most `max` points.
    pub(super) fn new(max: usize, budget: &'b Budget) -> Self {
        Self { budget, count: AtomicU64::new(0), max: max as u64 }
    }

    /// Charges so many more points.
    fn charge(&self, crossings: u64) -> Result<Charge<'b>, ArrangementError> {
        if self.count.fetch_add(crossings, atomic::Ordering::Relaxed) + crossings > self.max {
            return Err(ArrangementError::TooManyCrossings { limit: self.max });
        }
        Ok(self.budget.charge(BYTES_OF_CROSSING * crossings)?)
    }
}

/// The line of a constraint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ConstraintLine {
    /// That of an edge of the input, which names its smaller vertex first.
    Edge([u32; 2]),
    /// Where the plane of a triangle passes through.
    Plane(u32),
}

/// A segment between two vertices of a triangulation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Constraint {
    pub(super) ends: [u32; 2],
    pub(super) line: ConstraintLine,
}

/// Sets of constraints, numbered from 1.
#[derive(Debug, Default)]
pub(super) struct TagSets {
    sets: Vec<Vec<u32>>,
}

impl TagSets {
    /// The members of a set.
    pub(super) fn of(&self, set: u32) -> &[u32] {
        if set == 0 { &[] } else { &self.sets[set as usize - 1] }
    }

    /// The set with one more member.
    fn with(&mut self, set: u32, member: u32) -> u32 {
        if self.of(set).contains(&member) {
            return set;
        }
        let mut members = self.of(set).to_vec();
        members.push(member);
        // Mostly the next half-edge of the same constraint asks for the same.
        if self.sets.last() != Some(&members) {
            self.sets.push(members);
        }
        self.sets.len() as u32
    }
}

/// How a segment goes on from a vertex.
enum Leaving {
    /// Along this half-edge.
    Along(u32),
    /// Along the edge of this half-edge, which is at the rim and runs the other way.
    Back(u32),
    /// Across this half-edge, opposite to the vertex.
    Across(u32),
}

/// A triangulation and the constraints that are put into it one by one.
#[derive(Debug)]
pub(super) struct Constrained<'k, 'b> {
    pub(super) sight: CarrierView<'k>,
    pub(super) mesh: Triangulation,
    pub(super) sets: TagSets,
    lines: Vec<ConstraintLine>,
    crossings: u64,
    crossings_charged: u64,
    /// What crossings take, also once they are pieces.
    pub(super) charges: Vec<Charge<'b>>,
    account: &'k CrossingAccount<'b>,
}

impl<'k, 'b> Constrained<'k, 'b> {
    pub(super) fn new(sight: CarrierView<'k>, mesh: Triangulation, account: &'k CrossingAccount<'b>) -> Self {
        let (sets, lines, charges) = (TagSets::default(), Vec::new(), Vec::new());
        Self { sight, mesh, sets, lines, crossings: 0, crossings_charged: 0, charges, account }
    }

    /// Makes a segment a chain of edges and tags its half-edges with the number of the constraint, at a rim those that there
    /// are. What it crosses is divided there.
    pub(super) fn insert(&mut self, constraint: Constraint) -> Result<u32, ArrangementError> {
        let tag = self.lines.len() as u32;
        self.lines.push(constraint.line);
        let [mut from, to] = constraint.ends;
        let mut crossed = VecDeque::new();
        while from != to {
            match self.leaving(from, to)? {
                Leaving::Along(h) => {
                    self.tag(h, tag)?;
                    from = self.mesh.to(h);
                }
                Leaving::Back(h) => {
                    self.tag(h, tag)?;
                    from = self.mesh.from(h);
                }
                Leaving::Across(h) => {
                    let end = self.cross(from, to, h, constraint.line, &mut crossed)?;
                    let h = self.clear(from, end, &mut crossed)?;
                    self.tag(h, tag)?;
                    from = end;
                }
            }
        }
        Ok(tag)
    }

    /// Counts a step, and what was looked at since the last one.
    fn spend(&self) -> Result<(), Stopped> {
        self.account.budget.spend(2 + self.sight.take_units())
    }

    fn tag(&mut self, h: u32, tag: u32) -> Result<(), ArrangementError> {
        let set = &mut self.mesh.tags[h as usize];
        // A set is copied for each member that it gets: many copies of a triangle are dear.
        self.account.budget.spend(4 * self.sets.of(*set).len() as u64)?;
        *set = self.sets.with(*set, tag);
        Ok(())
    }

    fn leaving(&self, from: u32, to: u32) -> Result<Leaving, ArrangementError> {
        let mesh = &self.mesh;
        for h in mesh.around(from) {
            self.spend()?;
            let (x, y) = (mesh.to(h), mesh.apex(h));
            if x == to {
                return Ok(Leaving::Along(h));
            }
            let is_last = mesh.twin(mesh.prev(h)) == NONE;
            if is_last && y == to {
                return Ok(Leaving::Back(mesh.prev(h)));
            }
            match mesh.orient(&self.sight, [from, x, to]) {
                Sign::Zero if self.is_towards(from, x, to) => return Ok(Leaving::Along(h)),
                Sign::Negative => continue,
                _ => {}
            }
            match mesh.orient(&self.sight, [from, y, to]) {
                Sign::Negative if mesh.orient(&self.sight, [from, x, to]) == Sign::Positive => {
                    return Ok(Leaving::Across(mesh.next(h)));
                }
                Sign::Zero if is_last && self.is_towards(from, y, to) => {
                    return Ok(Leaving::Back(mesh.prev(h)));
                }
                _ => {}
            }
        }
        Err(ArrangementError::Inconsistent("a constraint leaves its plane's triangles"))
    }

    /// True when `x` and `to`, on one line with `from`, are on the same side of it.
    fn is_towards(&self, from: u32, x: u32, to: u32) -> bool {
        let [from, x, to] = [from, x, to].map(|v| self.sight.point(self.mesh.points[v as usize]));
        if matches!(x.definition, Definition::Far(_)) {
            return false;
        }
        [self.sight.view.u, self.sight.view.v].into_iter().any(|axis| {
            let a = self.sight.kernel.compare(axis, from, x);
            a != Ordering::Equal && a == self.sight.kernel.compare(axis, from, to)
        })
    }

    /// Goes from vertex `from` towards `to`, first across `h`: collects the edges that are crossed until there is a vertex on the
    /// segment, which may be one that divides a constraint.
    fn cross(
        &mut self,
        from: u32,
        to: u32,
        h: u32,
        line: ConstraintLine,
        crossed: &mut VecDeque<u32>,
    ) -> Result<u32, ArrangementError> {
        crossed.clear();
        let mut h = h;
        loop {
            self.spend()?;
            if self.mesh.is_constrained(h) {
                self.count_crossing()?;
                let definition = self.crossing(h, line);
                self.account.budget.spend(EXACT)?;
                let point = self.sight.kernel.point(definition);
                let point = self.sight.push(point);
                return Ok(self.mesh.split_edge(h, point));
            }
            crossed.push_back(h);
            let g = self.mesh.twin(h);
            if g == NONE {
                return Err(ArrangementError::Inconsistent("a constraint crosses the rim of its plane"));
            }
            let apex = self.mesh.apex(g);
            if apex == to {
                return Ok(apex);
            }
            h = match self.mesh.orient(&self.sight, [from, to, apex]) {
                Sign::Zero => return Ok(apex),
                Sign::Positive => self.mesh.next(g),
                Sign::Negative => self.mesh.prev(g),
            };
        }
    }

    /// Charges as many crossings ahead as there were until then.
    fn count_crossing(&mut self) -> Result<(), ArrangementError> {
        if self.crossings == self.crossings_charged {
            let ahead = self.crossings_charged.max(1);
            self.charges.push(self.account.charge(ahead)?);
            self.crossings_charged += ahead;
        }
        self.crossings += 1;
        Ok(())
    }

    /// Where a line crosses the constraint on the edge of `h`.
    fn crossing(&self, h: u32, line: ConstraintLine) -> Definition {
        let set = self.mesh.tags[h as usize];
        let set = if set == 0 { self.mesh.tags[self.mesh.twin(h) as usize] } else { set };
        // All of a set are on one line.
        let other = self.sets.of(set).iter().map(|&c| self.lines[c as usize]).min().unwrap_or(line);
        let view = self.sight.view;
        match (line.min(other), line.max(other)) {
            (ConstraintLine::Edge(a), ConstraintLine::Edge(b)) => {
                Definition::EdgeEdge { edges: [a, b], axes: [view.u as u8, view.v as u8] }
            }
            (ConstraintLine::Edge(edge), ConstraintLine::Plane(plane))
            | (ConstraintLine::Plane(plane), ConstraintLine::Edge(edge)) => {
                Definition::EdgePlane { edge, plane }
            }
            (ConstraintLine::Plane(a), ConstraintLine::Plane(b)) => {
                let mut planes = [view.plane, a, b];
                planes.sort_unstable();
                Definition::Planes(planes)
            }
        }
    }

    /// Flips the crossed edges away until there is an edge between two vertices (Sloan 1993).
    fn clear(&mut self, from: u32, to: u32, crossed: &mut VecDeque<u32>) -> Result<u32, ArrangementError> {
        let mut left = (crossed.len() as u64 + 4).pow(2) * 4;
        while let Some(h) = crossed.pop_front() {
            self.spend()?;
            left -= 1;
            if left == 0 {
                return Err(ArrangementError::Inconsistent("flips do not end"));
            }
            let (a, b) = (self.mesh.from(h), self.mesh.to(h));
            let (c, d) = (self.mesh.apex(h), self.mesh.apex(self.mesh.twin(h)));
            let side = |v: u32, w: u32, x: u32| self.mesh.orient(&self.sight, [v, w, x]);
            if side(d, c, a) * side(d, c, b) != Sign::Negative {
                crossed.push_back(h);
                continue;
            }
            let ends_there = [c, d].iter().any(|v| [from, to].contains(v));
            let crosses = !ends_there && side(from, to, c) * side(from, to, d) == Sign::Negative;
            self.mesh.flip(h);
            if crosses {
                crossed.push_back(h);
            }
        }
        self.mesh.between(from, to).ok_or(ArrangementError::Inconsistent("flips made no edge"))
    }
}

/// Rounds of flips that make triangles rounder, at most.
const ROUNDS_MAX: usize = 8;

impl Constrained<'_, '_> {
    /// Flips edges that no constraint holds while that makes triangles rounder.
    pub(super) fn improve(&mut self) -> Result<(), ArrangementError> {
        for _ in 0..ROUNDS_MAX {
            let mut is_changed = false;
            for h in 0..self.mesh.half_edges() {
                self.spend()?;
                let g = self.mesh.twin(h);
                if g == NONE || g < h || self.mesh.is_constrained(h) {
                    continue;
                }
                if self.mesh.is_rounder_flipped(&self.sight, h) {
                    self.mesh.flip(h);
                    is_changed = true;
                }
            }
            if !is_changed {
                break;
            }
        }
        Ok(())
    }
}
