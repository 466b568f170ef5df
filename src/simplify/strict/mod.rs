//! The strict mode: always the cheapest collapse of all that are possible.

mod merge;
mod near;

use super::criterion::{CollapseCriterion, PlacedVertex};
use super::guard::check_faces;
use super::key::CostKey;
use super::layout::InputNumbers;
use super::length::SquaredLength;
use super::lines::mark_lines;
use super::memoryless::Memoryless;
use super::options::{CriterionKind, SimplifyOptions, Target};
use super::priority::costs_of_vertices;
use super::quadric_error::QuadricError;
use super::queue::Queue;
use super::report::{Refusals, SimplifyRefusal, TargetReport};
use super::result::{Simplified, SimplifyError, SimplifyInput};
use super::surface::{CollapseSurface, MergeRule, Vertex};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::mesh::Color;
use crate::mesh::corner_table::{CornerTable, EdgeRings};

/// Units of work that a step counts.
const STEP: u64 = 256;

/// Simplifies `input` by collapsing the cheapest edge again and again: by the exact order of costs (to 24 bits, then by
/// edge). One result for each target, from one run. The topology of the input is kept: its Euler characteristic, its
/// components, its boundary loops. A collapse that is refused is set aside and tried again when something around it
/// has changed.
///
/// # Errors
/// When the input is not a manifold, or the budget stops the run.
pub fn simplify_strict(
    input: &SimplifyInput<'_>,
    options: &SimplifyOptions<'_>,
    budget: &Budget,
) -> Result<Vec<Simplified>, SimplifyError> {
    match options.criterion {
        CriterionKind::Quadric => {
            run(input, options, QuadricError { wall_weight: options.wall_weight }, budget)
        }
        CriterionKind::Memoryless => run(input, options, Memoryless, budget),
        CriterionKind::Length => run(input, options, SquaredLength, budget),
    }
}

fn run<C: CollapseCriterion>(
    input: &SimplifyInput<'_>,
    options: &SimplifyOptions<'_>,
    criterion: C,
    budget: &Budget,
) -> Result<Vec<Simplified>, SimplifyError> {
    let _charge = budget.charge(bytes_of::<C>(input))?;
    let (layout, table) = laid_out(input, budget)?;
    let origins = &layout.vertices;
    let mut surface =
        CollapseSurface::<C::State>::new(input.positions, origins.len(), |i| origins[i], table, budget)?;
    surface.wedges.0 = layout.of_triangles(input.texture);
    surface.has_regions = input.has_regions();
    mark_lines(&mut surface, &layout.of_triangles(input.face_groups), options, budget)?;
    criterion.prepare(&mut surface, budget)?;
    let mut strict = Strict {
        queue: Queue::new(&[], 0),
        rings: EdgeRings::default(),
        affected: Vec::new(),
        collapses: 0,
        refusals: Refusals::default(),
        error_squared_max: 0.0,
        error_squared_limit: f64::INFINITY,
        colors: layout.of_vertices(input.vertex_colors),
        surface,
        criterion,
        options,
        budget,
    };
    strict.fill_queue()?;
    let levels = options.targets.iter().map(|&target| {
        let report = strict.run_to(target, input.triangles.len())?;
        let priorities = match options.priorities {
            true => costs_of_vertices(&strict.surface, &strict.criterion, options.placement, budget)?,
            false => Vec::new(),
        };
        Simplified::snapshot(&strict.surface, &layout, input, &strict.colors, &priorities, report, budget)
    });
    Ok(levels.collect::<Result<Vec<_>, Stopped>>()?)
}

/// The table of the input's triangles along a curve.
fn laid_out(
    input: &SimplifyInput<'_>,
    budget: &Budget,
) -> Result<(InputNumbers, CornerTable), SimplifyError> {
    let SimplifyInput { positions, triangles, .. } = *input;
    let in_input = || CornerTable::build(triangles, positions.len(), budget);
    if triangles.as_flattened().iter().any(|&v| v as usize >= positions.len()) {
        in_input()?;
    }
    let _charge = budget.charge(size_of_val(triangles) as u64)?;
    let (layout, sorted) = InputNumbers::of(positions, triangles, budget)?;
    match CornerTable::build(&sorted, layout.vertices.len(), budget) {
        Ok(table) => Ok((layout, table)),
        // Said with the numbers of the input.
        Err(error) => Err(in_input().err().unwrap_or(error).into()),
    }
}

/// What a run takes beside its input and its results.
fn bytes_of<C: CollapseCriterion>(input: &SimplifyInput<'_>) -> u64 {
    // The table and the keys; for each edge a place in a bucket, and its first cost, listed twice.
    let per_triangle =
        32 + 4 * size_of::<u32>() + 3 * (size_of::<u32>() + 2 * size_of::<(u32, CostKey)>()) / 2;
    let per_vertex = size_of::<Vertex<C::State>>();
    let layout = InputNumbers::bytes(input.positions.len(), input.triangles.len());
    let own = input.triangles.len() * per_triangle + input.positions.len() * per_vertex;
    layout + own as u64 + size_of_val(input.texture) as u64
}

struct Strict<'a, C: CollapseCriterion> {
    surface: CollapseSurface<C::State>,
    criterion: C,
    options: &'a SimplifyOptions<'a>,
    budget: &'a Budget,
    /// The edges that may be collapsed, by cost.
    queue: Queue,
    /// Around the edge that is being collapsed.
    rings: EdgeRings,
    /// Edges to be considered anew after a collapse; empty in between.
    affected: Vec<u32>,
    collapses: u64,
    refusals: Refusals,
    error_squared_max: f64,
    error_squared_limit: f64,
    /// Of the vertices; empty when the input has none.
    colors: Vec<Option<Color>>,
}

impl<C: CollapseCriterion> Strict<'_, C> {
    /// Collapses until `target` is reached or nothing more can be collapsed.
    fn run_to(&mut self, target: Target, faces_before: usize) -> Result<TargetReport, Stopped> {
        let faces_wanted = match target {
            Target::Faces(count) => count,
            Target::Ratio(share) => (faces_before as f64 * share.clamp(0.0, 1.0)) as usize,
            Target::Error(_) => 0,
        };
        self.limit_error(target);
        let mut since_check = 0;
        let mut is_exhausted = false;
        while self.surface.table.triangle_count() > faces_wanted && !is_exhausted {
            since_check += 1;
            if since_check == CHECK_EVERY {
                self.budget.spend(CHECK_EVERY as u64 * STEP)?;
                since_check = 0;
            }
            is_exhausted = !self.step();
        }
        Ok(TargetReport {
            target,
            is_reached: !is_exhausted || matches!(target, Target::Error(_)),
            faces_before,
            faces_after: self.surface.table.triangle_count(),
            collapses: self.collapses,
            refusals: self.refusals,
            error_max: self.error_squared_max.sqrt() / self.surface.scale,
        })
    }

    /// Sets the limit on the error that `target` implies, and lets in what an earlier limit kept out.
    fn limit_error(&mut self, target: Target) {
        let before = self.error_squared_limit;
        self.error_squared_limit = match target {
            Target::Error(limit) => (limit * self.surface.scale).powi(2),
            _ => f64::INFINITY,
        };
        if self.error_squared_limit > before {
            for h in self.queue.aside() {
                self.reconsider(h);
            }
        }
    }

    /// Handles the edge whose turn it is; false when there is none.
    fn step(&mut self) -> bool {
        self.fetch_ahead();
        let Some((h, _)) = self.queue.pop() else { return false };
        let attempt = self.placed(h).and_then(|(rule, placed, _)| self.attempt(h, rule, placed));
        match attempt {
            Ok(()) => self.collapses += 1,
            Err(reason) => self.set_aside(h, reason),
        }
        true
    }

    /// The place for the edge of `h` and its key.
    #[inline]
    fn placed(&self, h: u32) -> Result<(MergeRule, PlacedVertex, CostKey), SimplifyRefusal> {
        let rule = self.surface.rule(h).ok_or(SimplifyRefusal::Held)?;
        let placed = self.criterion.place(&self.surface, h, rule, self.options.placement);
        let key = CostKey::of(placed.cost).ok_or(SimplifyRefusal::NotFinite)?;
        Ok((rule, placed, key))
    }

    fn cost(&self, h: u32) -> Result<CostKey, SimplifyRefusal> {
        self.placed(h).map(|(_, _, key)| key)
    }

    /// Collapses the edge of `h`, unless something speaks against it.
    fn attempt(&mut self, h: u32, rule: MergeRule, placed: PlacedVertex) -> Result<(), SimplifyRefusal> {
        if placed.error_squared > self.error_squared_limit {
            return Err(SimplifyRefusal::Error);
        }
        let (position, origin) = self.surface.landing(h, rule, placed.position, self.options.round)?;
        self.rings.walk(&self.surface.table, h);
        self.surface.table.link_condition(h, &self.rings).map_err(SimplifyRefusal::Link)?;
        if !self.surface.keeps_regions(h) {
            return Err(SimplifyRefusal::Held);
        }
        check_faces(&self.surface, h, &self.rings, position, &self.options.guards)?;
        self.error_squared_max = self.error_squared_max.max(placed.error_squared);
        self.surface.merge_colors(h, position, &mut self.colors);
        self.surface.merge_wedges(h, &self.rings, position);
        self.surface.merge_vertices(&self.criterion, h, position, origin);
        self.merge_edges(h);
        self.look_around();
        Ok(())
    }
}
