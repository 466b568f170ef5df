//! Closes simple holes: boundary loops that pass each place once.
//!
//! Each region (a loop, or flat loops in each other) is offered patches by one method after another. A patch stays only if
//! it adds no defect and meets nothing (see [`accept`]); a region with no such patch stays open. A single triangle or a
//! flat sheet cannot be closed, because every patch would be its double or lie on it.

mod accept;
mod ears;
mod minimal;
mod options;
mod planar;
mod regions;
mod report;

use self::accept::{Proposal, Surface};
pub use self::options::{Extract, FillOptions, HoleChoice, Method};
use self::regions::{Region, regions};
pub use self::report::{Filled, HoleReport, Rejected, Rejection, Rim};
use super::{Changes, Draft, NEW, Selection};
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec3, triangle_area};
use crate::mesh::{Boundary, Soup, edge_of};
use crate::spatial::coincident_f64;
use std::ops::Range;

/// A way to triangulate a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Triangulation {
    Planar,
    Minimal,
    Ears,
}

/// A region and the methods that it has not been offered yet.
struct Open {
    region: Region,
    methods: &'static [Triangulation],
}

/// Closes the holes that can be closed soundly. Looks at places, so vertices need not be welded; triangles must not be
/// degenerate. New triangles use the vertices of the rim.
///
/// # Errors
/// When the budget stops the run.
pub fn fill_holes(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    fill_loops(draft, |_, _| true, budget)
}

/// As [`fill_holes`], but only holes that the caller chose in `soup`, from which `draft` was made.
///
/// # Errors
/// When the budget stops the run.
pub fn fill_chosen_holes(
    draft: &mut Draft,
    soup: &Soup,
    chosen: &Selection,
    budget: &Budget,
) -> Result<Changes, Stopped> {
    fill_loops(draft, |half_edges, draft| chosen.takes(half_edges, draft, soup), budget)
}

fn fill_loops(
    draft: &mut Draft,
    is_chosen: impl Fn(&[u32], &Draft) -> bool,
    budget: &Budget,
) -> Result<Changes, Stopped> {
    let mut surface = surface_of(draft, budget)?;
    let boundary = Boundary::trace(&surface.triangles, surface.positions.len(), &surface.groups, budget)?;
    let loops: Vec<_> = boundary.loops.into_iter().filter(|hole| is_chosen(hole, draft)).collect();
    let holes = loops.len() as u64;
    let regions = regions(loops, |h| surface.point(h), budget)?;
    let mut open: Vec<Open> = regions.into_iter().map(Open::new).collect();
    let (mut filled, mut added) = (0, 0);
    while !open.is_empty() {
        let proposals = propose(&mut open, &surface, budget)?;
        let is_sound = surface.accept(&proposals, budget)?;
        let mut is_filled = vec![false; open.len()];
        for (proposal, _) in proposals.iter().zip(&is_sound).filter(|&(_, &sound)| sound) {
            filled += open[proposal.region].region.loops.len() as u64;
            added += proposal.triangles.len() as u64;
            is_filled[proposal.region] = true;
            append(draft, &proposal.triangles);
        }
        open = still_open(open, &is_filled);
    }
    let left = holes - filled;
    let changes =
        Changes::counted([("holes_filled", filled), ("triangles_added", added), ("holes_left", left)]);
    let patches = share_of_patches(draft, added as usize);
    Ok(Changes { reason: reason(patches, left, boundary.stray_edges), ..changes })
}

/// In words, how much of the surface is new. Closing a sheet makes a body of it, which this shows.
fn share_of_patches(draft: &Draft, added: usize) -> Option<String> {
    let rim = draft.triangles.len() - added;
    let area = |triangles: Range<usize>| triangles.map(|t| triangle_area(draft.corners(t))).sum::<f64>();
    let percent = 100.0 * area(rim..draft.triangles.len()) / area(0..draft.triangles.len());
    (added > 0 && percent.is_finite()).then(|| format!("patches are {percent:.1} % of the surface"))
}

fn reason(patches: Option<String>, left: u64, stray_edges: u64) -> String {
    let left = (left > 0).then(|| format!("{left} holes stay open: no patch meets the rest only at its rim"));
    let stray = (stray_edges > 0).then(|| format!("{stray_edges} boundary edges are in no simple loop"));
    patches.into_iter().chain(left).chain(stray).collect::<Vec<_>>().join("; ")
}

/// The draft with one vertex at each place.
fn surface_of(draft: &Draft, budget: &Budget) -> Result<Surface, Stopped> {
    let places = coincident_f64(&draft.positions, budget)?;
    let positions = places.first.iter().map(|&v| draft.positions[v as usize]).collect();
    let triangles = draft.triangles.iter().map(|t| t.map(|v| places.group[v as usize])).collect();
    Surface::new(positions, triangles, budget)
}

impl Open {
    fn new(region: Region) -> Self {
        let methods: &[Triangulation] = match (region.loops.len(), region.is_flat) {
            (1, true) => &[Triangulation::Planar, Triangulation::Minimal, Triangulation::Ears],
            (1, false) => &[Triangulation::Minimal, Triangulation::Planar, Triangulation::Ears],
            _ => &[Triangulation::Planar],
        };
        Self { region, methods }
    }
}

/// The next patch for each region that has one.
fn propose(open: &mut [Open], surface: &Surface, budget: &Budget) -> Result<Vec<Proposal>, Stopped> {
    let mut proposals = Vec::new();
    for (i, Open { region, methods }) in open.iter_mut().enumerate() {
        while let Some((method, rest)) = methods.split_first() {
            *methods = rest;
            if let Some(triangles) = triangulate(region, *method, surface, budget)? {
                proposals.push(Proposal { region: i, triangles });
                break;
            }
        }
    }
    Ok(proposals)
}

/// The triangles of a region by one method, their corners as half-edges.
fn triangulate(
    region: &Region,
    method: Triangulation,
    surface: &Surface,
    budget: &Budget,
) -> Result<Option<Vec<[u32; 3]>>, Stopped> {
    let rim = region.loops.concat();
    budget.spend(rim.len() as u64)?;
    let points: Vec<DVec3> = rim.iter().map(|&h| surface.point(h)).collect();
    let is_free = |i: usize, k: usize| surface.is_free(rim[i], rim[k]);
    let triangles = match method {
        Triangulation::Planar => {
            let loops: Vec<Vec<DVec3>> =
                region.loops.iter().map(|l| l.iter().map(|&h| surface.point(h)).collect()).collect();
            planar::triangulate(&loops, region.normal)
        }
        Triangulation::Minimal => {
            let normals: Vec<DVec3> = rim.iter().map(|&h| surface.normal(h)).collect();
            minimal::triangulate(&points, &normals, is_free, budget)?
        }
        Triangulation::Ears => ears::triangulate(&points, is_free, budget)?,
    };
    Ok(triangles.map(|triangles| triangles.into_iter().map(|t| t.map(|i| rim[i])).collect()))
}

/// The regions that have neither a patch nor run out of methods. Islands that could not be filled with their outer loop
/// are tried without it.
fn still_open(open: Vec<Open>, is_filled: &[bool]) -> Vec<Open> {
    let mut left = Vec::new();
    for (open, _) in open.into_iter().zip(is_filled).filter(|&(_, &filled)| !filled) {
        if !open.methods.is_empty() {
            left.push(open);
        } else if open.region.loops.len() > 1 {
            left.extend(open.region.into_single_loops().map(Open::new));
        }
    }
    left
}

/// Adds triangles whose corners are given as boundary half-edges.
fn append(draft: &mut Draft, triangles: &[[u32; 3]]) {
    for corners in triangles {
        let triangle = corners.map(|h| edge_of(&draft.triangles, h)[1]);
        draft.triangles.push(triangle);
        draft.triangle_origin.push(NEW);
    }
}
