//! Rounds: cut the mesh in parts, collapse edges inside them in step, put the rest together.

use super::Settings;
use super::buckets::CLASSES;
use super::fans::are_fans_between;
use super::guard::{Guard, RoundConditions};
use super::lines::LineMarking;
use super::mesh::{Mesh, MeshDivision};
use super::outcome::PartOutcome;
use super::part::{GuardedRegion, PartSimplifier, PartTopology, Rules, Tally};
use super::shells::ClosedShells;
use super::space::PartBoxes;
use super::strays::Strays;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::corner_table::{CornerTable, NONE};
use crate::par;
use crate::simplify::criterion::CollapseCriterion;
use crate::simplify::marks::LINE;
use crate::simplify::options::{SimplifyOptions, Target};
use crate::simplify::priority::costs_of_vertices;
use crate::simplify::result::{SimplifyError, SimplifyInput};
use crate::simplify::surface::{CollapseSurface, Vertex};
use crate::spatial::Bvh;
use std::sync::Arc;

/// Share of the triangles that a round leaves, so that what is between parts does not fall far behind.
const LEFT_BY_ROUND: f64 = 0.45;

/// Rounds end this far above the target; the rest is done in one part.
const ABOVE_TARGET: f64 = 1.04;

/// Rounds in parts end when one leaves more than this share of the triangles: a round on a scan leaves 0.45, and one that leaves nearly
/// all costs as much and does next to nothing.
const LITTLE_LEFT: f64 = 0.95;

/// Rounds in one part that the guarded mode does at the end, while they find something to collapse.
const LAST_ROUNDS_GUARDED: usize = 4;

/// Classes that parts go through between two looks at their total.
const CLASSES_AT_A_TIME: usize = 8;

/// A run of rounds.
pub(super) struct Rounds<'r, C: CollapseCriterion> {
    pub(super) mesh: Mesh<C::State>,
    pub(super) tally: Tally,
    /// A surface without triangles, for the working units.
    pub(super) frame: CollapseSurface<C::State>,
    rules: Rules<'r, C>,
    pub(super) input: SimplifyInput<'r>,
    /// Where vertices stay; `None`: nowhere.
    held: Option<Bvh>,
    /// Vertices of a part.
    part_len: usize,
    /// Rounds so far.
    count: u32,
    /// In the guarded mode, from the first round on.
    guard: Option<Guard>,
    pub(super) budget: &'r Budget,
}

impl<'r, C: CollapseCriterion> Rounds<'r, C> {
    /// Prepares a run.
    pub(super) fn begin(
        input: &SimplifyInput<'r>,
        options: &'r SimplifyOptions<'r>,
        criterion: &'r C,
        settings: Settings,
        budget: &'r Budget,
    ) -> Result<Self, Stopped> {
        let mut frame = CollapseSurface::new(
            input.positions,
            input.positions.len(),
            |i| i as u32,
            CornerTable::unpaired(&[], 0),
            budget,
        )?;
        frame.has_regions = input.has_regions();
        let mesh = Mesh {
            vertices: std::mem::take(&mut frame.vertices),
            colors: input.vertex_colors.to_vec(),
            triangles: input.triangles.to_vec(),
            numbers: (0..input.triangles.len() as u32).collect(),
            lines: vec![0; input.triangles.len()],
            texture: input.texture.to_vec(),
        };
        let rules =
            Rules { criterion, options, error_squared_limit: f64::INFINITY, is_guarded: settings.is_guarded };
        let tally = Tally::default();
        let held = held_boxes(options.held, frame.scale, budget)?;
        Ok(Self {
            held,
            mesh,
            tally,
            frame,
            rules,
            input: *input,
            count: 0,
            part_len: settings.part_len,
            guard: None,
            budget,
        })
    }

    /// Collapses until `target` is reached or nothing more can be collapsed; true when it is reached.
    pub(super) fn reach(&mut self, target: Target, faces_before: usize) -> Result<bool, SimplifyError> {
        let wanted = match target {
            Target::Faces(count) => count,
            Target::Ratio(share) => (faces_before as f64 * share.clamp(0.0, 1.0)) as usize,
            Target::Error(_) => 0,
        };
        self.rules.error_squared_limit = match target {
            Target::Error(limit) => (limit * self.frame.scale).powi(2),
            _ => f64::INFINITY,
        };
        let near = ((wanted as f64 * ABOVE_TARGET) as usize).max(wanted);
        let mut is_whole = false;
        while self.mesh.triangles.len() > near {
            let before = self.mesh.triangles.len();
            is_whole |= before <= 4 * self.part_len;
            if is_whole && !self.rules.is_guarded {
                break;
            }
            let goal = near.max((before as f64 * LEFT_BY_ROUND) as usize);
            self.round(if is_whole { usize::MAX } else { self.part_len }, goal)?;
            // A round that leaves nearly all: little is inside of parts, or little can be collapsed at all.
            if self.mesh.triangles.len() as f64 > before as f64 * LITTLE_LEFT {
                if is_whole {
                    break;
                }
                is_whole = true;
            }
        }
        let last_rounds = if self.rules.is_guarded { LAST_ROUNDS_GUARDED } else { 1 };
        let mut before = usize::MAX;
        for _ in 0..last_rounds {
            if self.mesh.triangles.len() > wanted && self.mesh.triangles.len() < before {
                before = self.mesh.triangles.len();
                self.round(usize::MAX, wanted)?;
            }
        }
        Ok(self.mesh.triangles.len() <= wanted || matches!(target, Target::Error(_)))
    }

    /// For each vertex the least cost of the collapses of its edges.
    pub(super) fn priorities(&self) -> Result<Vec<f64>, SimplifyError> {
        let (mesh, budget) = (&self.mesh, self.budget);
        let mut table = CornerTable::build(&mesh.triangles, mesh.vertices.len(), budget)?;
        mark(&mut table, &mesh.lines);
        let surface = self.frame.of_part(table, mesh.vertices.clone());
        Ok(costs_of_vertices(&surface, self.rules.criterion, self.rules.options.placement, budget)?)
    }

    /// Cuts the mesh in parts, collapses edges inside them, and puts what is left together.
    fn round(&mut self, part_len: usize, goal: usize) -> Result<(), SimplifyError> {
        let division = self.mesh.divide(part_len, self.shift(), self.budget)?;
        let of_parts = self.bytes_of_parts(&self.mesh.triangles, division.order.len());
        let of_parts = self.budget.charge(of_parts)?;
        let pieces = self.pieces(&division)?;
        let is_first = self.count == 0;
        self.count += 1;
        if is_first {
            self.mark_lines(&division, &pieces)?;
            self.prepare_between(&division)?;
        }
        let strays = match self.rules.is_watched() {
            true => Some(Arc::new(Strays::of(&self.mesh, &division, self.budget)?)),
            false => None,
        };
        let _of_strays = self.budget.charge(strays.as_ref().map_or(0, |strays| strays.bytes()))?;
        let parts = par::map_items(pieces, |i, piece| self.part(&division, i, piece, &strays, is_first));
        let mut parts = parts.into_iter().collect::<Result<Vec<_>, Stopped>>()?;
        let between = self.mesh.triangles.len() - division.first_between();
        let class_max = advance(&mut parts, between, goal, self.budget)?;
        let mut parts = par::map_items(parts, |i, part| self.outcome(&division, i, &part));
        drop(of_parts);
        let _of_outcomes = self.budget.charge(parts.iter().map(PartOutcome::bytes).sum())?;
        if let Some(mut guard) = self.guard.take() {
            let conditions = RoundConditions { is_first, class_max, strays };
            self.roll_back(&mut guard, &division, &mut parts, &conditions)?;
            self.guard = Some(guard);
        }
        self.collect(&division, parts);
        Ok(())
    }

    /// Bytes that parts with these triangles, and as many vertices, take while edges are collapsed.
    pub(super) fn bytes_of_parts(&self, triangles: &[[u32; 3]], vertices: usize) -> u64 {
        let of_boxes = if self.rules.is_watched() { PartBoxes::bytes(triangles) } else { 0 };
        let of_merges = if self.rules.is_guarded { 4 } else { 0 };
        let per_vertex = size_of::<Vertex<C::State>>() + of_merges;
        // Triangles are in corner tables, with places in the queue.
        of_boxes + (triangles.len() * (32 + 16) + vertices * per_vertex) as u64
    }

    /// What is left of part `i`.
    pub(super) fn outcome(
        &self,
        division: &MeshDivision,
        i: usize,
        part: &PartSimplifier<'r, C>,
    ) -> PartOutcome<C::State> {
        PartOutcome::of(part, division, i, &self.mesh.numbers[division.starts[i]..])
    }

    /// Where the curve of a round begins: multiples of the powers of the reciprocal of the plastic number are spread
    /// evenly (Roberts 2018).
    fn shift(&self) -> DVec3 {
        let spread = |step: f64| (f64::from(self.count) * step).fract();
        DVec3::new(
            spread(0.819_172_513_396_164_4),
            spread(0.671_043_606_703_789_3),
            spread(0.549_700_477_901_970_3),
        )
    }

    fn pieces(&self, division: &MeshDivision) -> Result<Vec<PartTopology>, Stopped> {
        par::try_map_ranges(division.starts.len() - 1, 1, |range| self.piece(division, range.start))
    }

    /// The topology of part `i`.
    pub(super) fn piece(&self, division: &MeshDivision, i: usize) -> Result<PartTopology, Stopped> {
        let triangles = division.starts[i]..division.starts[i + 1];
        let (first, count) = (i * division.part_len, division.vertices(i).len());
        let (mut table, mut is_free) = CornerTable::build_part(
            &self.mesh.triangles[triangles.clone()],
            first as u32,
            count,
            self.budget,
        )?;
        mark(&mut table, &self.mesh.lines[triangles]);
        for (is_free, is_between) in is_free.iter_mut().zip(&division.is_between[first..]) {
            *is_free &= !is_between;
        }
        Ok(PartTopology { table, is_free })
    }

    fn mark_lines(&mut self, division: &MeshDivision, pieces: &[PartTopology]) -> Result<(), SimplifyError> {
        let free_or_between = |(i, piece): (usize, &PartTopology)| {
            let between = &division.is_between[i * division.part_len..];
            piece.is_free.iter().zip(between).all(|(is_free, is_between)| *is_free || *is_between)
        };
        let lines = LineMarking {
            mesh: &mut self.mesh,
            division,
            pieces,
            groups: self.input.face_groups,
            options: self.rules.options,
            budget: self.budget,
        };
        let borders = if pieces.iter().enumerate().all(free_or_between) { lines.mark()? } else { None };
        let are_fans = borders.is_some() && are_fans_between(&self.mesh, division, self.budget)?;
        if !are_fans {
            // Says what is wrong and where.
            CornerTable::build(self.input.triangles, self.input.positions.len(), self.budget)?;
        }
        if self.rules.is_guarded {
            let shells = ClosedShells::of(&self.input, &borders.unwrap_or_default(), self.budget)?;
            let is_f32 = |p: &DVec3| p.as_vec3().as_dvec3() == *p || !p.is_finite();
            let is_f32_exact = self.rules.options.round && self.input.positions.iter().all(is_f32);
            self.guard = Some(Guard::new(shells, is_f32_exact));
        }
        Ok(())
    }

    /// Gives the vertices of triangles between parts what these triangles add to their states.
    fn prepare_between(&mut self, division: &MeshDivision) -> Result<(), Stopped> {
        let first = division.first_between();
        let triangles: Vec<[u32; 3]> =
            self.mesh.triangles[first..].iter().map(|t| t.map(|v| division.order[v as usize])).collect();
        let mut table = CornerTable::unpaired(&triangles, 0);
        mark(&mut table, &self.mesh.lines[first..]);
        let vertices = std::mem::take(&mut self.mesh.vertices);
        let mut surface = self.frame.of_part(table, vertices);
        let prepared = self.rules.criterion.prepare(&mut surface, self.budget);
        self.mesh.vertices = surface.vertices;
        prepared
    }

    pub(super) fn part(
        &self,
        division: &MeshDivision,
        i: usize,
        PartTopology { mut table, mut is_free }: PartTopology,
        strays: &Option<Arc<Strays>>,
        is_first: bool,
    ) -> Result<PartSimplifier<'r, C>, Stopped> {
        self.budget.check()?;
        if is_first {
            mark(&mut table, &self.mesh.lines[division.starts[i]..division.starts[i + 1]]);
        }
        let own = division.vertices(i);
        let vertices: Vec<_> = own.iter().map(|&v| self.mesh.vertices[v as usize]).collect();
        if let Some(held) = &self.held {
            for (vertex, is_free) in vertices.iter().zip(&mut is_free) {
                held.visit_box(Aabb::of([vertex.position]), self.budget, |_| *is_free = false)?;
            }
        }
        let colors = own.iter().filter_map(|&v| self.mesh.colors.get(v as usize).copied()).collect();
        let mut surface = self.frame.of_part(table, vertices);
        if !self.mesh.texture.is_empty() {
            surface
                .wedges
                .0
                .extend_from_slice(&self.mesh.texture[division.starts[i]..division.starts[i + 1]]);
        }
        if is_first {
            self.rules.criterion.prepare(&mut surface, self.budget)?;
        }
        let room = strays.as_ref().map(|strays| GuardedRegion {
            part: i as u32,
            first_vertex: (i * division.part_len) as u32,
            region: division.region(i),
            strays: Arc::clone(strays),
        });
        PartSimplifier::new(surface, is_free, colors, room, self.rules, self.budget)
    }

    /// Puts what is left of the parts together, and after it the triangles between them.
    fn collect(&mut self, division: &MeshDivision, parts: Vec<PartOutcome<C::State>>) {
        // Not needed any more, and as large as what is made here.
        self.mesh.vertices = Vec::new();
        let mut renumbered = vec![NONE; division.order.len()];
        let mut starts = Vec::with_capacity(parts.len());
        let mut count = 0;
        for part in &parts {
            starts.push(count as usize);
            for &place in &part.places {
                renumbered[place as usize] = count;
                count += 1;
            }
        }
        let vertices = par::map_indices(count as usize, CHECK_EVERY, |v| {
            let part = starts.partition_point(|&start| start <= v) - 1;
            parts[part].left.vertices[v - starts[part]]
        });
        let first = division.first_between();
        let count = parts.iter().map(|part| part.left.triangles.len()).sum::<usize>();
        let mut left = Mesh { vertices, ..Mesh::default() };
        left.triangles.reserve_exact(count + self.mesh.triangles.len() - first);
        left.numbers.reserve_exact(count + self.mesh.triangles.len() - first);
        for part in parts {
            self.tally.add(&part.tally);
            left.colors.extend(part.left.colors);
            left.triangles.extend(part.left.triangles);
            left.numbers.extend(part.left.numbers);
            left.lines.extend(part.left.lines);
            left.texture.extend(part.left.texture);
        }
        left.triangles.extend(&self.mesh.triangles[first..]);
        left.numbers.extend(&self.mesh.numbers[first..]);
        left.lines.extend(&self.mesh.lines[first..]);
        left.texture.extend(self.mesh.texture.get(first..).unwrap_or_default());
        par::for_each_chunk_mut(&mut left.triangles, CHECK_EVERY, |_, triangles| {
            triangles.as_flattened_mut().iter_mut().for_each(|v| *v = renumbered[*v as usize]);
        });
        self.mesh = left;
    }
}

/// Marks the edges of a table for whose triangles `lines` has bits.
fn mark(table: &mut CornerTable, lines: &[u8]) {
    for (t, &lines) in lines.iter().enumerate().filter(|(_, lines)| **lines != 0) {
        (0..3).filter(|k| lines >> k & 1 != 0).for_each(|k| table.mark(4 * t as u32 + k, LINE));
    }
}

/// Collapses edges class by class, in all parts before the next, until at most `goal` are left with the
/// `between` ones that are in no part. At each look a part may take its share of what is above the goal.
fn advance<C: CollapseCriterion>(
    parts: &mut [PartSimplifier<'_, C>],
    between: usize,
    goal: usize,
    budget: &Budget,
) -> Result<usize, Stopped> {
    let lowest =
        |parts: &[PartSimplifier<'_, C>]| parts.iter().map(PartSimplifier::lowest).min().unwrap_or(CLASSES);
    let total = |parts: &[PartSimplifier<'_, C>]| {
        between + parts.iter().map(PartSimplifier::triangle_count).sum::<usize>()
    };
    let mut class_max = first_stop(parts, total(parts).saturating_sub(goal));
    while total(parts) > goal && lowest(parts) < CLASSES {
        let all = total(parts);
        let above = all - goal;
        let advanced = par::map_items(parts.iter_mut().collect(), |_, part: &mut PartSimplifier<'_, C>| {
            let triangles = part.triangle_count();
            let share = (above * triangles).div_ceil(all - between);
            part.advance(class_max, triangles.saturating_sub(share), budget)
        });
        advanced.into_iter().collect::<Result<(), Stopped>>()?;
        if lowest(parts) > class_max {
            class_max = lowest(parts) + CLASSES_AT_A_TIME;
        }
    }
    Ok(class_max)
}

/// A class at which certainly no more than `triangles` are gone, so that the parts can go there without a look at one
/// another: a collapse takes two triangles and three edges, most of them dear ones.
fn first_stop<C: CollapseCriterion>(parts: &[PartSimplifier<'_, C>], triangles: usize) -> usize {
    let mut edges = 0;
    let mut class = 0;
    while class < CLASSES && edges < triangles {
        edges += parts.iter().map(|part| part.class_sizes[class] as usize).sum::<usize>();
        class += 1;
    }
    class
}

/// The boxes in which vertices stay, in the coordinates of the run. A box is that of a triangle with two corners in one.
fn held_boxes(boxes: &[Aabb], scale: f64, budget: &Budget) -> Result<Option<Bvh>, Stopped> {
    if boxes.is_empty() {
        return Ok(None);
    }
    let corners: Vec<DVec3> = boxes.iter().flat_map(|b| [b.min * scale, b.max * scale]).collect();
    let triangles: Vec<[u32; 3]> = (0..boxes.len() as u32).map(|n| [2 * n, 2 * n + 1, 2 * n + 1]).collect();
    Bvh::build(&corners, &triangles, None, budget).map(Some)
}
