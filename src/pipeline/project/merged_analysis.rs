//! The description of a file out of those of its parts, each of which is in its own coordinates.

use super::PartReport;
use crate::analysis::{Analysis, Element, Finding, HoleCounts, Watertight, Witness};
use crate::pipeline::Report;

/// The sum of what `of` gives for each part, with at most so many `samples` of each defect; `None` unless it gives something
/// for all. Elements are numbered through all
/// parts, and places are in the coordinates of their part.
pub(super) fn merged_analysis<'r>(
    parts: &'r [PartReport],
    samples: usize,
    of: impl Fn(&'r Report) -> Option<&'r Analysis>,
) -> Option<Analysis> {
    let mut merged: Option<Analysis> = None;
    let (mut faces, mut vertices) = (0_u64, 0_u64);
    for part in parts {
        let one = of(&part.report)?;
        match &mut merged {
            None => merged = Some(Analysis { proximity: None, loop_edges: Vec::new(), ..one.clone() }),
            Some(merged) => add(merged, one, [faces, vertices], samples),
        }
        faces += one.counts.faces;
        vertices += one.counts.vertices;
    }
    if let Some(merged) = &mut merged {
        merged.findings.sort_by_key(|finding| finding.code);
        // Half-edges are those of single meshes, so none is named.
        for witness in merged.findings.iter_mut().flat_map(|finding| &mut finding.witnesses) {
            witness.anchor = None;
        }
    }
    merged
}

fn add(sum: &mut Analysis, one: &Analysis, [faces, vertices]: [u64; 2], samples: usize) {
    let (counts, more) = (&mut sum.counts, &one.counts);
    counts.vertices += more.vertices;
    counts.faces += more.faces;
    counts.triangles += more.triangles;
    counts.welded_vertices += more.welded_vertices;
    counts.edges += more.edges;
    counts.components += more.components;
    counts.closed_components += more.closed_components;
    counts.boundary_loops += more.boundary_loops;
    counts.boundary_edges += more.boundary_edges;
    let (measures, more) = (&mut sum.measures, &one.measures);
    // Boxes in the coordinates of different parts say nothing of the size of all.
    measures.bounds = None;
    measures.area += more.area;
    measures.volume = measures.volume.zip(more.volume).map(|(a, b)| a + b);
    measures.euler_characteristic += more.euler_characteristic;
    sum.volume_interval = sum.volume_interval.zip(one.volume_interval).map(|(mut a, b)| {
        a.low += b.low;
        a.high += b.high;
        a.is_exact &= b.is_exact;
        a
    });
    let (properties, more) = (&mut sum.properties, &one.properties);
    properties.is_closed &= more.is_closed;
    properties.is_edge_manifold &= more.is_edge_manifold;
    properties.is_vertex_manifold &= more.is_vertex_manifold;
    properties.is_oriented &= more.is_oriented;
    properties.is_embedded = both(properties.is_embedded, more.is_embedded);
    let Watertight { by_index, after_exact_weld, after_epsilon_weld, in_float32 } = one.watertight;
    sum.watertight = Watertight {
        by_index: both(sum.watertight.by_index, by_index),
        after_exact_weld: sum.watertight.after_exact_weld && after_exact_weld,
        after_epsilon_weld: both(sum.watertight.after_epsilon_weld, after_epsilon_weld),
        in_float32: sum.watertight.in_float32 && in_float32,
    };
    let HoleCounts { cracks, missing_faces, planar_cuts, missing_regions, intended_openings, open_chains } =
        one.holes;
    sum.holes.cracks += cracks;
    sum.holes.missing_faces += missing_faces;
    sum.holes.planar_cuts += planar_cuts;
    sum.holes.missing_regions += missing_regions;
    sum.holes.intended_openings += intended_openings;
    sum.holes.open_chains += open_chains;
    for finding in &one.findings {
        let witnesses = finding.witnesses.iter().map(|witness| shifted(witness, [faces, vertices]));
        match sum.findings.iter_mut().find(|known| known.code == finding.code) {
            Some(known) => {
                known.count += finding.count;
                known.is_at_least |= finding.is_at_least;
                known.severity = known.severity.max(finding.severity);
                known.witnesses.extend(witnesses.take(samples.saturating_sub(known.witnesses.len())));
            }
            None => sum.findings.push(Finding { witnesses: witnesses.collect(), ..finding.clone() }),
        }
    }
}

fn both(a: Option<bool>, b: Option<bool>) -> Option<bool> {
    match (a, b) {
        (Some(false), _) | (_, Some(false)) => Some(false),
        (Some(true), Some(true)) => Some(true),
        _ => None,
    }
}

fn shifted(witness: &Witness, [faces, vertices]: [u64; 2]) -> Witness {
    let shift = |elements: &[Element], by: u64| {
        let shifted =
            |element: &Element| Element { index: element.index.saturating_add(by as u32), ..*element };
        elements.iter().map(shifted).collect()
    };
    Witness {
        faces: shift(&witness.faces, faces),
        vertices: shift(&witness.vertices, vertices),
        ..witness.clone()
    }
}
