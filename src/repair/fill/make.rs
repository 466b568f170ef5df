//! Makes the patch of a region in one way.

use super::accept::{PatchProposal, check_topology};
use super::caps::turn_caps;
use super::coarsen::coarsen;
use super::creased::{HoleDivision, creased};
use super::fair::{PatchSurroundings, fair};
use super::options::{Extract, FillOptions, Method};
use super::patch::PatchMesh;
use super::refine::{Lengths, refine, turn_edges};
use super::regions::Region;
use super::report::Rejection;
use super::surface::FillSurface;
use super::{bridge, ears, large, minimal, planar, rbf};
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec3, print_pitch};
use crate::implicit::{self, Field, FitFacts, Unmeshed};

/// A way to make a patch. Several may stand for one method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// By its view along the normal.
    Planar,
    /// The triangulation that bends least.
    Minimal,
    /// Between two loops, from the nearest pair of corners on.
    Zipped,
    /// Corner by corner, the shortest diagonal first.
    Ears,
    /// The minimal one, refined and faired.
    Smooth,
    /// Sharp edges carried on, each side between them closed on its own.
    Creased,
    /// The surface of a field.
    Rbf,
}

impl Way {
    /// The method that it is a way of.
    pub(super) fn method(self) -> Method {
        match self {
            Self::Planar => Method::Flat,
            Self::Minimal | Self::Zipped | Self::Ears => Method::Minimal,
            Self::Smooth => Method::Smooth,
            Self::Creased => Method::Creased,
            Self::Rbf => Method::Rbf,
        }
    }
}

/// What patches are made from.
pub(super) struct PatchInput<'a> {
    pub(super) surface: &'a FillSurface,
    /// `None`: no hole is to get the surface of a field.
    pub(super) mesh: Option<&'a rbf::FieldMesh<'a>>,
    pub(super) options: &'a FillOptions,
}

/// A patch and, for each of its new vertices, the vertices that it was born between; none when it was made at once.
pub(super) struct MadePatch {
    pub(super) proposal: PatchProposal,
    pub(super) parents: Vec<[u32; 2]>,
    /// The field on whose surface it is.
    pub(super) field: Option<FitFacts>,
}

/// Times that a faired patch is divided anew where it has grown.
const FAIRINGS: usize = 2;
/// Tensions of the plate that are tried, the least first.
const TENSIONS: [f64; 3] = [0.0, 0.1, 10.0];
/// Tension of a plate that is too large whatever was tried: all but a membrane.
const TENSION_MAX: f64 = 1000.0;
/// A plate swings out when an edge of it becomes longer than so many of the lengths wanted at its ends. Edges are divided
/// from 4/3 on, and a dome as high as it is wide stretches them by half. What is longer before may double.
const STRETCH_MAX: f64 = 4.0;
/// Times that vertices which came together are taken out after each.
const COARSENINGS: usize = 3;

/// A hole as a patch is made for it.
pub(super) struct HoleInput<'a> {
    pub(super) region: &'a Region,
    /// How creases divide it, if they do.
    pub(super) division: Option<&'a HoleDivision>,
    /// Rings of neighbours that a field is fitted to.
    pub(super) rings: u32,
    /// No method was asked for, so a patch that swings out is not wanted.
    pub(super) is_auto: bool,
    /// The smooth patch that a field was to move, so that it need not be made again.
    pub(super) faired: &'a mut Option<FairedPatch>,
}

/// The patch of a hole, or why there is none; what was tried before and not taken is put among `rejected`.
pub(super) fn make(
    hole: &mut HoleInput<'_>,
    way: Way,
    scene: &PatchInput<'_>,
    rejected: &mut Vec<Rejection>,
    budget: &Budget,
) -> Result<Result<MadePatch, Rejection>, Stopped> {
    let (region, surface) = (hole.region, scene.surface);
    budget.spend(region.rim().len() as u64)?;
    let made = match way {
        Way::Planar => planar_view(region, surface),
        Way::Minimal => least_bent(region, surface, budget)?,
        Way::Zipped => zipped(region, surface, budget)?,
        Way::Ears => corner_by_corner(region, surface, budget)?,
        Way::Smooth => return smooth(hole, surface, budget),
        Way::Creased => match hole.division {
            Some(division) => return creased(region, division, hole.area_limits(), surface, budget),
            None => Err(Rejection::NoPatch),
        },
        Way::Rbf => return of_field(hole, scene, rejected, budget),
    };
    Ok(made.map(|triangles| MadePatch::plain(region, triangles)))
}

impl HoleInput<'_> {
    fn area_limits(&self) -> AreaLimits {
        if self.is_auto { AreaLimits::OF_AUTO } else { AreaLimits::NONE }
    }
}

/// How large a patch with new vertices may be, as shares of the area of the triangulation that it is made of. Unlike an edge
/// that became too long, this tells also at a rim of long edges that a patch swings out.
#[derive(Debug, Clone, Copy)]
pub(super) struct AreaLimits {
    /// Beyond this the plate is put under tension. Plates over half a ball stay below: they are flatter than it.
    pub(super) plate: f64,
    /// Beyond this the patch is not taken.
    patch: f64,
}

impl AreaLimits {
    /// Half a ball has twice the area of the disk that closes it, and its rim may be ragged.
    const OF_AUTO: Self = Self { plate: 1.5, patch: 2.2 };
    /// Who asks for a method gets its patch however large it is.
    const NONE: Self = Self { plate: f64::INFINITY, patch: f64::INFINITY };

    /// False for a patch that swings out from a triangulation with this area.
    pub(super) fn admit(self, mesh: &PatchMesh, base_area: f64) -> bool {
        mesh.area() <= self.patch * base_area
    }
}

impl MadePatch {
    fn plain(region: &Region, triangles: Vec<[usize; 3]>) -> Self {
        let triangles = triangles.into_iter().map(|t| t.map(|i| i as u32)).collect();
        Self { proposal: proposal(region, Vec::new(), triangles), parents: Vec::new(), field: None }
    }

    /// A refined patch, its new vertices at places that float32 has.
    pub(super) fn refined(
        region: &Region,
        surface: &FillSurface,
        mut mesh: PatchMesh,
        budget: &Budget,
    ) -> Result<Result<Self, Rejection>, Stopped> {
        let points = match on_lattice(&mesh.points[mesh.rim..], surface) {
            Ok(points) => points,
            Err(reason) => return Ok(Err(reason)),
        };
        mesh.points.splice(mesh.rim.., points.iter().copied());
        let rim = region.rim();
        turn_caps(&mut mesh, &|a, b| surface.is_free(rim[a as usize], rim[b as usize]), budget)?;
        let proposal = proposal(region, points, mesh.triangles);
        Ok(Ok(Self { proposal, parents: mesh.parents, field: None }))
    }
}

/// The places nearest to new vertices that float32 has.
fn on_lattice(points: &[DVec3], surface: &FillSurface) -> Result<Vec<DVec3>, Rejection> {
    let reach = points.iter().fold(surface.reach, |reach, p| p.abs().max_element().max(reach));
    let pitch = print_pitch(reach).ok_or(Rejection::NotRepresentable)?;
    // A sum with 0 has no negative zero.
    Ok(points.iter().map(|&p| (p / pitch).round() * pitch + DVec3::ZERO).collect())
}

fn proposal(region: &Region, points: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> PatchProposal {
    PatchProposal { rim: region.rim().to_vec(), loop_starts: region.loop_starts(), points, triangles }
}

fn rim_points(region: &Region, surface: &FillSurface) -> Vec<DVec3> {
    region.rim().iter().map(|&h| surface.point(h)).collect()
}

type TriangulationResult = Result<Vec<[usize; 3]>, Rejection>;

fn planar_view(region: &Region, surface: &FillSurface) -> TriangulationResult {
    if region.rim().len() > planar::CORNERS_MAX {
        return Err(Rejection::TooLarge);
    }
    let loops: Vec<Vec<DVec3>> =
        region.loops().map(|l| l.iter().map(|&h| surface.point(h)).collect()).collect();
    planar::triangulate(&loops, region.normal).ok_or(Rejection::NoPatch)
}

/// The corners of the region as one polygon.
fn polygon(region: &Region, surface: &FillSurface, budget: &Budget) -> Result<Option<Vec<usize>>, Stopped> {
    if region.walks.len() == 1 {
        return Ok(Some((0..region.rim().len()).collect()));
    }
    let (rim, points) = (region.rim(), rim_points(region, surface));
    bridge::one_polygon(&points, &region.ranges(), |i, k| surface.is_free(rim[i], rim[k]), budget)
}

/// The triangles between two loops that are no region of a plane, from the nearest pair of corners on.
fn zipped(region: &Region, surface: &FillSurface, budget: &Budget) -> Result<TriangulationResult, Stopped> {
    match &region.ranges()[..] {
        [outer, inner] if !region.is_flat => {
            Ok(Ok(bridge::zip(&rim_points(region, surface), [outer.clone(), inner.clone()], budget)?))
        }
        _ => Ok(Err(Rejection::NoPatch)),
    }
}

fn least_bent(
    region: &Region,
    surface: &FillSurface,
    budget: &Budget,
) -> Result<TriangulationResult, Stopped> {
    if region.rim().len() > minimal::CORNERS_MAX
        && let Ok(triangles) = zipped(region, surface, budget)?
    {
        return Ok(Ok(triangles));
    }
    of_one_polygon(region, surface, budget)
}

/// True when triangles between the corners of the region are a surface with just its loops as boundary.
fn closes(region: &Region, triangles: &[[usize; 3]]) -> bool {
    let triangles = triangles.iter().map(|t| t.map(|i| i as u32)).collect();
    check_topology(&proposal(region, Vec::new(), triangles)).is_ok()
}

/// The triangulation that bends least of the polygon that passes all loops.
fn of_one_polygon(
    region: &Region,
    surface: &FillSurface,
    budget: &Budget,
) -> Result<TriangulationResult, Stopped> {
    let Some(polygon) = polygon(region, surface, budget)? else { return Ok(Err(Rejection::NoPatch)) };
    let (rim, next) = (region.rim(), region.next_corners());
    let points: Vec<DVec3> = polygon.iter().map(|&i| surface.point(rim[i])).collect();
    // A cut has no surface beyond it.
    let normal = |at: usize| match polygon[(at + 1) % polygon.len()] {
        to if next[polygon[at]] as usize == to => surface.normal(rim[polygon[at]]),
        _ => DVec3::ZERO,
    };
    // The half-edge at a corner goes to it, from where the next corner is.
    let normals: Vec<DVec3> = (0..polygon.len()).map(normal).collect();
    let is_free = |i: usize, k: usize| surface.is_free(rim[polygon[i]], rim[polygon[k]]);
    let triangles = match polygon.len() <= minimal::CORNERS_MAX {
        true => minimal::triangulate(&points, &normals, is_free, budget)?,
        false => large::triangulate(&points, &normals, region.normal, is_free, budget)?,
    };
    let corners = triangles.map(|triangles| triangles.into_iter().map(|t| t.map(|i| polygon[i])).collect());
    Ok(corners.ok_or(Rejection::NoPatch))
}

fn corner_by_corner(
    region: &Region,
    surface: &FillSurface,
    budget: &Budget,
) -> Result<TriangulationResult, Stopped> {
    let Some(polygon) = polygon(region, surface, budget)? else { return Ok(Err(Rejection::NoPatch)) };
    let rim = region.rim();
    let points: Vec<DVec3> = polygon.iter().map(|&i| surface.point(rim[i])).collect();
    let is_free = |i: usize, k: usize| surface.is_free(rim[polygon[i]], rim[polygon[k]]);
    let triangles = ears::triangulate(&points, is_free, budget)?;
    let corners = triangles.map(|triangles| triangles.into_iter().map(|t| t.map(|i| polygon[i])).collect());
    Ok(corners.ok_or(Rejection::NoPatch))
}

/// A triangulation without new vertices to begin with.
fn base(region: &Region, surface: &FillSurface, budget: &Budget) -> Result<TriangulationResult, Stopped> {
    if region.is_flat
        && let Ok(triangles) = planar_view(region, surface)
    {
        return Ok(Ok(triangles));
    }
    // Between two loops, what bends least is bent at the rims most, and twists for that.
    if let Ok(triangles) = zipped(region, surface, budget)?
        && closes(region, &triangles)
    {
        return Ok(Ok(triangles));
    }
    match least_bent(region, surface, budget)? {
        Ok(triangles) => Ok(Ok(triangles)),
        Err(_) => corner_by_corner(region, surface, budget),
    }
}

fn smooth(
    hole: &mut HoleInput<'_>,
    surface: &FillSurface,
    budget: &Budget,
) -> Result<Result<MadePatch, Rejection>, Stopped> {
    match faired(hole, surface, budget)? {
        Ok(FairedPatch { mesh, base_area }) if hole.area_limits().admit(&mesh, base_area) => {
            MadePatch::refined(hole.region, surface, mesh, budget)
        }
        Ok(_) => Ok(Err(Rejection::NoFit)),
        Err(reason) => Ok(Err(reason)),
    }
}

/// A patch on the surface of a field.
fn of_field(
    hole: &mut HoleInput<'_>,
    scene: &PatchInput<'_>,
    rejected: &mut Vec<Rejection>,
    budget: &Budget,
) -> Result<Result<MadePatch, Rejection>, Stopped> {
    let PatchInput { surface, mesh: Some(mesh), options } = *scene else {
        return Ok(Err(Rejection::NoPatch));
    };
    let (region, rings) = (hole.region, hole.rings);
    let mut fit = || rbf::field(region, rings, surface, mesh, options, rejected, budget);
    if options.extract == Extract::Project {
        return projected(hole, fit, surface, budget);
    }
    let field = match fit()? {
        Ok(field) => field,
        Err(reason) => return Ok(Err(reason)),
    };
    let rims: Vec<Vec<DVec3>> =
        region.loops().map(|l| l.iter().map(|&h| surface.point(h)).collect()).collect();
    let length = edge_length(&rims);
    let extracted = match options.extract {
        Extract::Mesh => implicit::mesh_surface(&field, &rims, length, budget)?,
        Extract::March | Extract::Project => implicit::march(&field, &rims, length, budget)?,
    };
    Ok(match extracted {
        Ok(patch) => {
            let points = &patch.points[region.rim().len()..];
            on_lattice(points, surface).map(|points| {
                let proposal = proposal(region, points, patch.triangles);
                MadePatch { proposal, parents: Vec::new(), field: Some(*field.facts()) }
            })
        }
        Err(Unmeshed::TooFine { .. }) => Err(Rejection::TooLarge),
        Err(_) => Err(Rejection::NoPatch),
    })
}

/// The mean length of the edges of rims.
fn edge_length(rims: &[Vec<DVec3>]) -> f64 {
    let edges: usize = rims.iter().map(Vec::len).sum();
    let length = |rim: &Vec<DVec3>| {
        rim.iter().zip(rim.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b)).sum::<f64>()
    };
    rims.iter().map(length).sum::<f64>() / edges as f64
}

/// The smooth patch with its vertices moved to the zeros of the field that `fit` gives. A patch without new vertices, as at a
/// rim of few corners, needs none.
fn projected(
    hole: &mut HoleInput<'_>,
    fit: impl FnOnce() -> Result<Result<Field, Rejection>, Stopped>,
    surface: &FillSurface,
    budget: &Budget,
) -> Result<Result<MadePatch, Rejection>, Stopped> {
    let FairedPatch { mesh: mut patch, base_area } = match faired(hole, surface, budget)? {
        Ok(patch) => patch,
        Err(reason) => return Ok(Err(reason)),
    };
    let (region, rim) = (hole.region, hole.region.rim());
    let is_free = |a: u32, b: u32| surface.is_free(rim[a as usize], rim[b as usize]);
    if patch.points.len() == patch.rim {
        turn_edges(&mut patch, &is_free, budget)?;
        return MadePatch::refined(region, surface, patch, budget);
    }
    *hole.faired = Some(FairedPatch { mesh: patch.clone(), base_area });
    let field = match fit()? {
        Ok(field) => field,
        Err(reason) => return Ok(Err(reason)),
    };
    if !rbf::project(&mut patch, &field, &is_free, budget)? {
        return Ok(Err(Rejection::NoZero));
    }
    if !hole.area_limits().admit(&patch, base_area) {
        return Ok(Err(Rejection::NoFit));
    }
    let made = MadePatch::refined(region, surface, patch, budget)?;
    Ok(made.map(|made| MadePatch { field: Some(*field.facts()), ..made }))
}

/// A smooth patch before its vertices are rounded.
pub(super) struct FairedPatch {
    mesh: PatchMesh,
    /// Area of the triangulation that it was made of.
    base_area: f64,
}

/// The smooth patch, which is that of the last call where the mesh has not got an edge of it since.
fn faired(
    hole: &mut HoleInput<'_>,
    surface: &FillSurface,
    budget: &Budget,
) -> Result<Result<FairedPatch, Rejection>, Stopped> {
    let (region, rim) = (hole.region, hole.region.rim());
    let is_free = |a: u32, b: u32| surface.is_free(rim[a as usize], rim[b as usize]);
    if let Some(patch) = hole.faired.take().filter(|patch| patch.mesh.chords().all(|[a, b]| is_free(a, b))) {
        return Ok(Ok(patch));
    }
    let triangles = match base(region, surface, budget)? {
        Ok(triangles) => triangles.into_iter().map(|t| t.map(|i| i as u32)).collect(),
        Err(reason) => return Ok(Err(reason)),
    };
    let Some(mut mesh) = PatchMesh::new(rim_points(region, surface), triangles) else {
        return Ok(Err(Rejection::Topology));
    };
    let base_area = mesh.area();
    let area_max = hole.area_limits().plate * base_area;
    let half_edges: Vec<Option<u32>> = rim.iter().copied().map(Some).collect();
    let around = surface.around(&half_edges, vec![true; rim.len()], budget)?;
    let is_fair = refine_and_fair(&mut mesh, &region.next_corners(), &around, area_max, &is_free, budget)?;
    Ok(if is_fair { Ok(FairedPatch { mesh, base_area }) } else { Err(Rejection::NoFit) })
}

/// Divides what is longer than the edges of the rim, whose next corners are `next`, and fairs, if possible to an area of at
/// most `area_max`; `false`: the system has no solution. `is_free(a, b)` says whether there may be an edge between two corners
/// of the rim.
pub(super) fn refine_and_fair(
    mesh: &mut PatchMesh,
    next: &[u32],
    around: &PatchSurroundings,
    area_max: f64,
    is_free: &dyn Fn(u32, u32) -> bool,
    budget: &Budget,
) -> Result<bool, Stopped> {
    let mut lengths = Lengths::of_rim(mesh, next);
    for round in 0..FAIRINGS {
        if !refine(mesh, &mut lengths, is_free, budget)? && round > 0 {
            break;
        }
        if !fair_within_reach(mesh, &lengths, around, area_max, budget)? {
            return Ok(false);
        }
        for _ in 0..COARSENINGS {
            if !coarsen(mesh, &mut lengths, is_free, budget)? {
                break;
            }
            turn_edges(mesh, is_free, budget)?;
            if !fair_within_reach(mesh, &lengths, around, area_max, budget)? {
                return Ok(false);
            }
        }
    }
    Ok(true)
}

/// Fairs with the least tension with which no edge becomes far too long and the patch not too large; with the largest whatever
/// becomes of it.
fn fair_within_reach(
    mesh: &mut PatchMesh,
    lengths: &Lengths,
    around: &PatchSurroundings,
    area_max: f64,
    budget: &Budget,
) -> Result<bool, Stopped> {
    let before = mesh.points.clone();
    let reach = STRETCH_MAX.max(2.0 * lengths.largest_stretch(mesh));
    let mut is_fair = false;
    for tension in TENSIONS {
        mesh.points.clone_from(&before);
        is_fair = fair(mesh, around, tension, budget)?;
        if is_fair && lengths.largest_stretch(mesh) <= reach && mesh.area() <= area_max {
            return Ok(true);
        }
    }
    // What is only long in one place is not drawn in any further, as that would bend it at the rim.
    if is_fair && mesh.area() > area_max {
        mesh.points.clone_from(&before);
        is_fair = fair(mesh, around, TENSION_MAX, budget)?;
    }
    Ok(is_fair)
}

#[cfg(test)]
mod tests;
