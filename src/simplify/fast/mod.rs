//! The fast mode: collapses in independent parts of the mesh, at the same time.
//!
//! In each round the vertices are cut along a space-filling curve into parts of the same size, and edges between
//! vertices with all their triangles in one part are collapsed, in all parts at the same time and from cheap to
//! expensive in step. The next round cuts elsewhere, so what was between parts comes inside one. The last percents are
//! done in one part that is the whole mesh, up to the exact target. Parts, their order and the steps depend on the mesh
//! alone, so the result is the same whatever the thread count.

mod allowance;
mod boxes;
mod buckets;
mod check;
mod fans;
mod guard;
mod hubs;
mod lines;
mod mesh;
mod outcome;
mod part;
mod region;
mod rollback;
mod rounds;
mod shells;
mod space;
mod strays;
mod sweep;
#[cfg(test)]
mod tests;

use super::criterion::CollapseCriterion;
use super::length::SquaredLength;
use super::memoryless::Memoryless;
use super::options::{CriterionKind, SimplifyOptions};
use super::quadric_error::QuadricError;
use super::report::TargetReport;
use super::result::{Simplified, SimplifyError, SimplifyInput};
use super::surface::NEW;
use crate::budget::Budget;
use crate::mesh::corner_table::NONE;
use mesh::Mesh;
use rounds::Rounds;

/// Simplifies `input` by collapsing the cheapest edges of all parts of it at the same time: in the order of costs, as
/// far as classes of costs within a quarter of each other and the borders between parts allow. One result for each
/// target, from one run. The topology of the input is kept: its Euler characteristic, its components, its boundary
/// loops.
///
/// The same result whatever the thread count.
///
/// # Errors
/// When the input is not a manifold, or the budget stops the run.
pub fn simplify_fast(
    input: &SimplifyInput<'_>,
    options: &SimplifyOptions<'_>,
    budget: &Budget,
) -> Result<Vec<Simplified>, SimplifyError> {
    by_criterion(input, options, Settings { is_guarded: false, part_len: PART_LEN }, budget)
}

/// As [`simplify_fast`], but takes back collapses by which the surface would meet itself, and those by which a closed
/// shell would turn inside out or come to lie in others than before. What is valid stays valid, in the coordinates as
/// they are and rounded to f32: a solid that the certificate accepts gives a solid that it accepts.
///
/// Where the input meets itself it is left as it is.
///
/// # Errors
/// When the input is not a manifold, or the budget stops the run.
pub fn simplify_guarded(
    input: &SimplifyInput<'_>,
    options: &SimplifyOptions<'_>,
    budget: &Budget,
) -> Result<Vec<Simplified>, SimplifyError> {
    by_criterion(input, options, Settings { is_guarded: true, part_len: PART_LEN }, budget)
}

/// What tells the modes apart, and parts from whole meshes in tests.
#[derive(Debug, Clone, Copy)]
struct Settings {
    /// Take back what makes the surface unsound.
    is_guarded: bool,
    /// Vertices of a part.
    part_len: usize,
}

/// Vertices of a part: about what a core's own cache holds, with their triangles.
const PART_LEN: usize = 6144;

fn by_criterion(
    input: &SimplifyInput<'_>,
    options: &SimplifyOptions<'_>,
    settings: Settings,
    budget: &Budget,
) -> Result<Vec<Simplified>, SimplifyError> {
    match options.criterion {
        CriterionKind::Quadric => {
            run(input, options, &QuadricError { wall_weight: options.wall_weight }, settings, budget)
        }
        CriterionKind::Memoryless => run(input, options, &Memoryless, settings, budget),
        CriterionKind::Length => run(input, options, &SquaredLength, settings, budget),
    }
}

fn run<C: CollapseCriterion>(
    input: &SimplifyInput<'_>,
    options: &SimplifyOptions<'_>,
    criterion: &C,
    settings: Settings,
    budget: &Budget,
) -> Result<Vec<Simplified>, SimplifyError> {
    // The components of the input.
    let guarded = if settings.is_guarded { 4 * input.triangles.len() } else { 0 };
    let _charge = budget.charge(bytes_of::<C>(input) + guarded as u64)?;
    let mut rounds = Rounds::begin(input, options, criterion, settings, budget)?;
    let mut levels = Vec::with_capacity(options.targets.len());
    for &target in &options.targets {
        let is_reached = rounds.reach(target, input.triangles.len())?;
        let report = TargetReport {
            target,
            is_reached,
            faces_before: input.triangles.len(),
            faces_after: rounds.mesh.triangles.len(),
            collapses: rounds.tally.collapses,
            refusals: rounds.tally.refusals,
            error_max: rounds.tally.error_squared_max.sqrt() / rounds.frame.scale,
        };
        let priorities = if options.priorities { rounds.priorities()? } else { Vec::new() };
        levels.push(snapshot(&rounds.mesh, rounds.frame.scale, &priorities, input, report));
    }
    Ok(levels)
}

/// What a run takes beside its input, its results and its rounds: vertices and their order; triangles before and after
/// they are sorted.
fn bytes_of<C: CollapseCriterion>(input: &SimplifyInput<'_>) -> u64 {
    let per_triangle = 2 * (12 + 4 + 1);
    let per_vertex = size_of::<super::surface::Vertex<C::State>>() + 4 + 8;
    let texture = 3 * size_of_val(input.texture);
    (input.triangles.len() * per_triangle + input.positions.len() * per_vertex + texture) as u64
}

/// The mesh as a result: triangles in the order of the input, vertices in the order of their first use.
fn snapshot<S>(
    mesh: &Mesh<S>,
    scale: f64,
    priorities: &[f64],
    input: &SimplifyInput<'_>,
    report: TargetReport,
) -> Simplified {
    let mut order: Vec<(u32, u32)> = mesh.numbers.iter().copied().zip(0..).collect();
    order.sort_unstable();
    let mut renumbered = vec![NONE; mesh.vertices.len()];
    let mut result = Simplified {
        positions: Vec::new(),
        vertex_origin: Vec::new(),
        vertex_colors: Vec::new(),
        priorities: Vec::new(),
        triangles: Vec::with_capacity(order.len()),
        triangle_origin: Vec::with_capacity(order.len()),
        texture: Vec::new(),
        report,
    };
    for (number, t) in order {
        let corners = mesh.triangles[t as usize].map(|v| {
            let renumbered = &mut renumbered[v as usize];
            if *renumbered == NONE {
                *renumbered = result.positions.len() as u32;
                let vertex = &mesh.vertices[v as usize];
                result.vertex_origin.push(vertex.origin);
                result.positions.push(match vertex.origin {
                    NEW => vertex.position / scale,
                    origin => input.positions[origin as usize],
                });
                result.vertex_colors.extend(mesh.colors.get(v as usize));
                result.priorities.extend(priorities.get(v as usize));
            }
            *renumbered
        });
        result.triangles.push(corners);
        result.triangle_origin.push(number);
        result.texture.extend(mesh.texture.get(t as usize));
    }
    result
}
