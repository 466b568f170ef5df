//! Collapses inside one part of the mesh, in the order of their costs.
//!
//! A vertex is *free* when all its triangles are in the part and are one fan. Only edges between free vertices are
//! collapsed, so no part changes what another part reads.
//!
//! A sum of squares only grows when others are added to it, so what an edge was known to cost bounds from below what it
//! costs now. So nothing is evaluated again when a neighbour merges; an edge that comes up is evaluated as it is then,
//! and put back if it turns out to be more expensive. For a criterion of which this is not true an edge may come up
//! later than it could.

use super::allowance::Allowance;
use super::buckets::{Buckets, CLASSES, class_of};
use super::hubs::PlacedTriangle;
use super::region::CodeRegion;
use super::space::PartBoxes;
use super::strays::Strays;
use super::sweep::{Outside, Sweep};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::Color;
use crate::mesh::corner_table::{CornerTable, EdgeRings, NONE, next, prev, triangle_of};
use crate::simplify::criterion::{CollapseCriterion, PlacedVertex};
use crate::simplify::guard::check_faces;
use crate::simplify::marks::LINE;
use crate::simplify::options::SimplifyOptions;
use crate::simplify::report::{Refusals, SimplifyRefusal};
use crate::simplify::surface::{CollapseSurface, MergeRule};
use std::sync::Arc;

/// Units of work that an attempt to collapse an edge counts.
const ATTEMPT: u64 = 256;

/// The topology of a part.
#[derive(Debug)]
pub(super) struct PartTopology {
    pub(super) table: CornerTable,
    /// For each vertex, whether it is free.
    pub(super) is_free: Vec<bool>,
}

/// What is counted over all parts and rounds.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Tally {
    pub(super) collapses: u64,
    pub(super) refusals: Refusals,
    /// In squared working units.
    pub(super) error_squared_max: f64,
}

impl Tally {
    pub(super) fn add(&mut self, other: &Self) {
        self.collapses += other.collapses;
        self.refusals.add_all(&other.refusals);
        self.error_squared_max = self.error_squared_max.max(other.error_squared_max);
    }
}

/// What all parts are simplified by.
pub(super) struct Rules<'r, C> {
    pub(super) criterion: &'r C,
    pub(super) options: &'r SimplifyOptions<'r>,
    /// In squared working units.
    pub(super) error_squared_limit: f64,
    /// Surface must not go through surface.
    pub(super) is_guarded: bool,
}

impl<C> Rules<'_, C> {
    /// What a collapse sweeps must be free.
    pub(super) fn is_watched(&self) -> bool {
        self.is_guarded && self.options.sweeps
    }
}

impl<C> Clone for Rules<'_, C> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<C> Copy for Rules<'_, C> {}

/// What a part in the guarded mode knows of space.
pub(super) struct GuardedRegion {
    /// Number of the part.
    pub(super) part: u32,
    /// Place of the part's first vertex.
    pub(super) first_vertex: u32,
    /// What is swept must be inside of it.
    pub(super) region: CodeRegion,
    /// Of all parts.
    pub(super) strays: Arc<Strays>,
}

/// [`GuardedRegion`], with the part's own triangles.
struct Watch {
    room: GuardedRegion,
    space: PartBoxes,
    sweep: Sweep,
}

/// Why nothing is collapsed here and now.
enum NotCollapsed {
    Refused(SimplifyRefusal),
    /// It would leave the part's region: another round may do it.
    Elsewhere,
}

impl From<SimplifyRefusal> for NotCollapsed {
    fn from(reason: SimplifyRefusal) -> Self {
        Self::Refused(reason)
    }
}

/// A part that is being simplified.
pub(super) struct PartSimplifier<'r, C: CollapseCriterion> {
    pub(super) surface: CollapseSurface<C::State>,
    /// Of the vertices; empty when the input has none.
    pub(super) colors: Vec<Option<Color>>,
    pub(super) tally: Tally,
    /// Number of edges of each class at the start.
    pub(super) class_sizes: Vec<u32>,
    is_free: Vec<bool>,
    /// The vertex that each one was merged into, or itself; empty when nobody asks.
    merged_into: Vec<u32>,
    queue: Buckets,
    rings: EdgeRings,
    allowance: Allowance,
    watch: Option<Watch>,
    rules: Rules<'r, C>,
}

impl<'r, C: CollapseCriterion> PartSimplifier<'r, C> {
    /// A part of which nothing is collapsed yet, with all its edges between free vertices in the queue.
    pub(super) fn new(
        surface: CollapseSurface<C::State>,
        is_free: Vec<bool>,
        colors: Vec<Option<Color>>,
        room: Option<GuardedRegion>,
        rules: Rules<'r, C>,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let bound = surface.table.triangle_bound();
        let vertex_count = if rules.is_guarded { surface.vertices.len() as u32 } else { 0 };
        let merged_into = (0..vertex_count).collect();
        let watch = room.map(|room| Watch { room, space: space_of(&surface), sweep: Sweep::default() });
        let mut part = Self {
            surface,
            colors,
            tally: Tally::default(),
            class_sizes: vec![0; CLASSES],
            is_free,
            merged_into,
            queue: Buckets::new(4 * bound),
            rings: EdgeRings::default(),
            allowance: Allowance::of(bound),
            watch,
            rules,
        };
        for t in 0..bound as u32 {
            if (t as usize).is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            (4 * t..4 * t + 3).for_each(|h| part.enter(h));
        }
        Ok(part)
    }

    /// Puts the edge of `h` in the queue, if `h` stands for it and it is between free vertices.
    fn enter(&mut self, h: u32) {
        let table = &self.surface.table;
        let is_free = |v: u32| self.is_free[v as usize];
        if table.edge(h) == h && is_free(table.origin(h)) && is_free(table.destination(h)) {
            match self.placed(h) {
                Ok((_, _, class)) => {
                    self.class_sizes[class] += 1;
                    self.queue.push(h, class);
                }
                Err(reason) => self.set_aside(h, reason),
            }
        }
    }

    /// The place for the edge of `h`, and the class of its cost.
    #[inline]
    fn placed(&self, h: u32) -> Result<(MergeRule, PlacedVertex, usize), SimplifyRefusal> {
        let rule = self.surface.rule(h).ok_or(SimplifyRefusal::Held)?;
        let placed = self.rules.criterion.place(&self.surface, h, rule, self.rules.options.placement);
        let class = class_of(placed.cost).ok_or(SimplifyRefusal::NotFinite)?;
        Ok((rule, placed, class))
    }

    fn set_aside(&mut self, h: u32, reason: SimplifyRefusal) {
        self.tally.refusals.add(reason);
        self.queue.set_aside(h);
        for v in [h, next(h)].map(|g| self.surface.table.origin(g)) {
            self.surface.vertices[v as usize].has_aside = true;
        }
    }

    /// Number of triangles that are left.
    pub(super) fn triangle_count(&self) -> usize {
        self.surface.table.triangle_count()
    }

    /// The smallest class that may have an edge.
    pub(super) fn lowest(&self) -> usize {
        self.queue.lowest()
    }

    /// Collapses edges of classes up to `class_max` until at most `triangles_min` triangles are left.
    pub(super) fn advance(
        &mut self,
        class_max: usize,
        triangles_min: usize,
        budget: &Budget,
    ) -> Result<(), Stopped> {
        let mut count = 0usize;
        while self.triangle_count() > triangles_min {
            if count.is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            count += 1;
            let Some((h, class)) = self.queue.pop(class_max) else { break };
            // The triangle has gone, or the twin stands for the edge too.
            if self.surface.table.corners(triangle_of(h)).is_none() || self.is_twin_queued(h) {
                continue;
            }
            match self.placed(h) {
                Ok((_, _, now)) if now > class => self.queue.push(h, now),
                Ok((rule, placed, _)) => match self.attempt(h, rule, placed, budget) {
                    Ok(()) => {}
                    Err(NotCollapsed::Refused(reason)) => self.set_aside(h, reason),
                    Err(NotCollapsed::Elsewhere) => self.queue.set_aside(h),
                },
                Err(reason) => self.set_aside(h, reason),
            }
        }
        budget.spend(count as u64 * ATTEMPT)
    }

    fn is_twin_queued(&self, h: u32) -> bool {
        let twin = self.surface.table.twin(h);
        twin != NONE && self.queue.is_queued(twin)
    }

    /// Collapses the edge of `h`, unless something speaks against it.
    fn attempt(
        &mut self,
        h: u32,
        rule: MergeRule,
        placed: PlacedVertex,
        budget: &Budget,
    ) -> Result<(), NotCollapsed> {
        let Rules { criterion, options, error_squared_limit, .. } = self.rules;
        if placed.error_squared > error_squared_limit {
            return Err(SimplifyRefusal::Error.into());
        }
        let ends = [h, next(h)].map(|g| self.surface.table.origin(g));
        if !ends.into_iter().all(|end| self.allowance.lets(end)) {
            return Err(NotCollapsed::Elsewhere);
        }
        let (position, origin) = self.surface.landing(h, rule, placed.position, options.round)?;
        self.rings.walk(&self.surface.table, h);
        self.allowance.walked(ends[0], self.rings.origin.corners.len());
        self.allowance.walked(ends[1], self.rings.destination.corners.len());
        self.surface.table.link_condition(h, &self.rings).map_err(SimplifyRefusal::Link)?;
        if !self.surface.keeps_regions(h) {
            return Err(SimplifyRefusal::Held.into());
        }
        check_faces(&self.surface, h, &self.rings, position, &options.guards)?;
        if let Some(watch) = &mut self.watch {
            let bounds = watch.sweep(&self.surface, h, &self.rings, position);
            watch.check(&self.surface, h, bounds, &mut self.allowance, budget)?;
        }
        self.tally.collapses += 1;
        self.tally.error_squared_max = self.tally.error_squared_max.max(placed.error_squared);
        self.surface.merge_colors(h, position, &mut self.colors);
        self.surface.merge_wedges(h, &self.rings, position);
        self.surface.merge_vertices(criterion, h, position, origin);
        self.merge_edges(h);
        self.allowance.merged(ends[0], ends[1]);
        if let Some(watch) = &mut self.watch {
            watch.follow(&self.surface, &self.rings, ends);
        }
        self.look_around();
        Ok(())
    }

    /// Collapses the edge of `h` in the table. The edges that become one stay in the queue when one of them was.
    fn merge_edges(&mut self, h: u32) {
        let table = &self.surface.table;
        if let Some(into) = self.merged_into.get_mut(table.origin(h) as usize) {
            *into = table.destination(h);
        }
        let sides =
            [h, table.twin(h)].map(|side| (side != NONE).then(|| Joint::of(table, &self.queue, side)));
        self.surface.table.collapse(h, &self.rings);
        let class = self.queue.lowest().min(CLASSES - 1);
        for joint in sides.into_iter().flatten() {
            joint.keep(&mut self.queue, class);
        }
    }

    /// Puts back into the queue what had been set aside and may have become possible: whether an edge can be collapsed
    /// depends on the faces around its ends, so on all edges of the merged vertex and of its neighbours.
    fn look_around(&mut self) {
        let class = self.queue.lowest().min(CLASSES - 1);
        let Self { rings, queue, surface, allowance, .. } = self;
        let CollapseSurface { table, vertices, .. } = surface;
        for &corner in rings.origin.corners.iter().chain(&rings.destination.corners) {
            if table.corners(triangle_of(corner)).is_none() {
                continue;
            }
            queue.put_back([corner, prev(corner)], class);
            // Both ends of an edge that is set aside say so.
            for outer in [next(corner), prev(corner)] {
                let v = table.origin(outer);
                let has_aside = &mut vertices[v as usize].has_aside;
                if *has_aside && allowance.lets(v) {
                    *has_aside = false;
                    let put_back = table.fan(outer).map(|c| queue.put_back([c, prev(c)], class));
                    allowance.walked(v, put_back.count());
                }
            }
        }
    }

    /// For each vertex, the one that is left of it. Only for a part whose collapses may be taken back.
    pub(super) fn roots(&self) -> Vec<u32> {
        let mut roots = self.merged_into.clone();
        for v in 0..roots.len() {
            let mut root = roots[v];
            while roots[root as usize] != root {
                // Shorter for the next one.
                roots[root as usize] = roots[roots[root as usize] as usize];
                root = roots[root as usize];
            }
            roots[v] = root;
        }
        roots
    }

    /// The triangles that are left, by their numbers in the part, with bits for their edges that are lines.
    pub(super) fn triangles(&self) -> impl Iterator<Item = (u32, [u32; 3], u8)> {
        let table = &self.surface.table;
        (0..table.triangle_bound() as u32).filter_map(move |t| {
            let lines = (0..3).map(|k| (table.marks(4 * t + k) & LINE) << k).sum();
            table.corners(t).map(|corners| (t, corners, lines))
        })
    }
}

/// The space of the triangles of a part.
fn space_of<S: Copy + Default>(surface: &CollapseSurface<S>) -> PartBoxes {
    let table = &surface.table;
    let corners = |t: u32| [4 * t, 4 * t + 1, 4 * t + 2].map(|h| table.origin(h));
    let triangles: Vec<[u32; 3]> = (0..table.triangle_bound() as u32).map(corners).collect();
    PartBoxes::new(triangles, |v| surface.position(v))
}

impl Watch {
    /// Notes what the collapse of `h` to `position` sweeps; gives its box.
    fn sweep<S: Copy + Default>(
        &mut self,
        surface: &CollapseSurface<S>,
        h: u32,
        rings: &EdgeRings,
        position: DVec3,
    ) -> Aabb {
        let table = &surface.table;
        let twin = table.twin(h);
        let removed = [triangle_of(h), if twin == NONE { NONE } else { triangle_of(twin) }];
        self.sweep.begin(position, table.destination(h));
        for (ring, is_first) in [(&rings.origin, true), (&rings.destination, false)] {
            for &corner in &ring.corners {
                let stays = !removed.contains(&triangle_of(corner));
                // What goes is swept by the first move, and has no area in the second.
                if stays || is_first {
                    let [q, r] = [table.origin(next(corner)), table.origin(prev(corner))];
                    let from = surface.position(table.origin(corner));
                    self.sweep.add(from, [surface.position(q), surface.position(r)], [q, r], stays);
                }
            }
        }
        self.sweep.finish()
    }

    /// Whether what is swept is free.
    fn check<S: Copy + Default>(
        &self,
        surface: &CollapseSurface<S>,
        h: u32,
        bounds: Aabb,
        allowance: &mut Allowance,
        budget: &Budget,
    ) -> Result<(), NotCollapsed> {
        let Self { room, space, sweep } = self;
        let table = &surface.table;
        if bounds.is_empty() {
            return Ok(());
        }
        if !room.region.holds(bounds) {
            return Err(NotCollapsed::Elsewhere);
        }
        let ends = [table.origin(h), table.destination(h)];
        let mut answer = Ok(());
        let mut passes = |other: &Outside| match allowance.compares(sweep.len()) {
            true => sweep.passes(other).map_err(NotCollapsed::Refused),
            false => Err(NotCollapsed::Elsewhere),
        };
        space.visit(bounds, sweep, ends, |t| {
            let Some(ids) = table.corners(t) else { return true };
            if !ids.iter().any(|v| ends.contains(v)) {
                let [a, b, c] = ids;
                let corners = [surface.position(a), surface.position(b), surface.position(c)];
                answer = passes(&Outside { ids, corners });
            }
            answer.is_ok()
        });
        std::mem::replace(&mut answer, Ok(()))?;
        let visited = room.strays.visit(room.part, bounds, budget, |stray, corners| {
            if answer.is_ok() {
                let ids = stray.places.map(|place| place.wrapping_sub(room.first_vertex));
                answer = passes(&Outside { ids, corners });
            }
        });
        // The caller will see that the run was stopped.
        visited.map_err(|_| NotCollapsed::Elsewhere)?;
        answer
    }

    /// Has the space follow the triangles around the vertex into which `ends` have been merged, the second one.
    fn follow<S: Copy + Default>(
        &mut self,
        surface: &CollapseSurface<S>,
        rings: &EdgeRings,
        [from, into]: [u32; 2],
    ) {
        let now = |t: u32| -> Option<PlacedTriangle> {
            surface.table.corners(t).map(|ids| (ids, ids.map(|v| surface.position(v))))
        };
        for &corner in rings.origin.corners.iter().chain(&rings.destination.corners) {
            let t = triangle_of(corner);
            match now(t) {
                Some(corners) => self.space.set(t, corners),
                None => self.space.forget(t),
            }
        }
        let corners = |t: u32| now(t).unwrap_or(([into; 3], [surface.position(into); 3]));
        self.space.merge(from, into, surface.position(into), corners);
    }
}

/// The two edges that become one when a triangle of the collapsed edge goes.
struct Joint {
    /// Their half-edges outside the triangle.
    outer: [u32; 2],
    /// One of the edges is known to the queue by its half-edge inside.
    is_known_inside: bool,
}

impl Joint {
    fn of(table: &CornerTable, queue: &Buckets, side: u32) -> Self {
        let inner = [next(side), prev(side)];
        Self {
            outer: inner.map(|g| table.twin(g)),
            is_known_inside: inner.into_iter().any(|g| queue.is_queued(g) || queue.is_aside(g)),
        }
    }

    /// Puts the edge in the queue again if the half-edge that stood for it has gone.
    fn keep(&self, queue: &mut Buckets, class: usize) {
        let mut outer = self.outer.into_iter().filter(|&g| g != NONE);
        if self.is_known_inside && !outer.clone().any(|g| queue.is_queued(g)) {
            outer.next().into_iter().for_each(|g| queue.push(g, class));
        }
    }
}
