//! The picture of a project: every part at each of its places, with the defects that were found of it by itself.

use super::{Failure, ProjectRun, Stage};
use crate::analysis::Finding;
use crate::formats::threemf::read_scene;
use crate::pipeline::Answer;
use crate::pipeline::picture::{self, Drawn, Shift};

/// Witnesses that are shown at all places together: a part may be at very many.
const WITNESSES_MAX: usize = 20_000;

/// The picture of the file of `run`, and of the result beside it; `None`: none is asked for.
pub(super) fn picture(run: &ProjectRun<'_>, answer: &Answer) -> Result<Option<Vec<u8>>, Failure> {
    let Some(choices) = picture::choices(run.operation, run.options) else { return Ok(None) };
    let budget = run.budget;
    let (soup, placed) = budget.stage(Stage::Read, || read_scene(run.bytes, &run.options.read, budget))?;
    // Triangles that are out of range at their place are left out, after which the numbers of others say nothing.
    let all_are_there = soup.non_finite_vertices.is_empty();
    let bodies = &run.project.bodies;
    let mut reports = vec![None; bodies.len()];
    for (body, part) in run.solids().into_iter().zip(&answer.report.parts) {
        reports[body] = part.report.before.as_ref();
    }
    let mut findings: Vec<Finding> = Vec::new();
    // A part counts once however often it is there.
    let mut is_counted = vec![false; bodies.len()];
    let mut left = WITNESSES_MAX;
    for place in &placed {
        budget.spend(1)?;
        // Volumes of one object stand one after the other, and so do all objects in their order.
        let first = bodies.partition_point(|body| body.source < place.source);
        let (mut face, mut triangle) = (place.first_face, place.first_triangle);
        for (number, body) in bodies.iter().enumerate().skip(first) {
            if body.source != place.source {
                break;
            }
            let shift = Shift { face, triangle: all_are_there.then_some(triangle) };
            let is_known = std::mem::replace(&mut is_counted[number], true);
            for finding in reports[number].iter().flat_map(|analysis| &analysis.findings) {
                if is_known && left == 0 {
                    break;
                }
                let shown = shift.shifted(finding, left, |p| place.apply(p));
                if is_known && shown.witnesses.is_empty() {
                    continue;
                }
                left -= shown.witnesses.len();
                findings.push(Finding { count: if is_known { 0 } else { shown.count }, ..shown });
            }
            face += body.soup.face_count;
            triangle += body.soup.triangles.len() as u32;
        }
    }
    let meshes: Vec<u32> = placed.iter().map(|place| place.first_vertex).collect();
    let drawn = Drawn { soup: &soup, findings: &findings, meshes: &meshes };
    picture::make(&drawn, answer, &choices, run.options, budget).map(Some)
}
