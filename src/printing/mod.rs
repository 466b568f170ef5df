//! What matters for printing a mesh: walls, gaps, overhangs, edges, cavities, size, and the figures of a quote, measured and
//! compared with the limits of a process.
//!
//! Read-only. Lengths are in the unit of the file, angles in degrees. All figures are rounded, and those of walls and
//! gaps are found by sampling: they are measured and reported, nothing is proved by them. What they mean presumes a
//! valid solid, on whose outside the normals are.

mod ball;
mod calipers;
mod edges;
mod hull;
mod judge;
mod oriented_box;
mod overhang;
mod parts;
mod policy;
mod ray;
mod shadow;
mod surface;
#[cfg(test)]
mod tests;
mod thickness;

pub use edges::Edges;
pub use judge::{Check, CheckCode, Fit, Status};
pub use oriented_box::OrientedBox;
pub use overhang::Overhang;
pub use parts::{Cavities, Parts};
pub use policy::{BuildDirection, BuildVolume, Limit, PrintingPolicy};
pub use thickness::{Spread, Thickness};

use crate::budget::{Budget, Stopped};
use crate::distance::{self, Areas};
use crate::geom::{Aabb, DVec3};
use crate::mesh::{EdgeGroups, Soup};
use crate::par;
use crate::spatial::NearestSearch;
use surface::WeldedSurface;
use thickness::{Probe, SurfaceSide};

/// Corners 12, source 4, normal 24, area 8, boxes 64, edges 18, component 4, and 8 for lists that come and go.
const BYTES_PER_TRIANGLE: u64 = 142;

/// Group and first vertex at each position 8, and a copy of the position 24.
const BYTES_PER_VERTEX: u64 = 32;

/// A place of the mesh, with what was measured there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrintingWitness {
    /// Triangle of the soup.
    pub triangle: u32,
    /// Where on it.
    pub place: DVec3,
    /// What was measured, in the unit of its check.
    pub measured: f64,
}

/// What a price depends on. Lengths are in the unit of the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quote {
    /// Volume of material; `None`: not defined, because the mesh is not a valid solid.
    pub volume: Option<f64>,
    /// Area of the surface.
    pub area: f64,
    /// Box along the axes.
    pub bounds: Aabb,
    /// Small box turned in any way.
    pub oriented_box: OrientedBox,
    /// Area that the part covers seen along the build direction.
    pub shadow_area: f64,
}

/// Everything that was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// Thickness of walls.
    pub walls: Thickness,
    /// Width of gaps between walls.
    pub gaps: Thickness,
    /// What hangs over nothing, for each direction in the order of [`BuildDirection::ALL`].
    pub overhangs: Vec<Overhang>,
    /// Angle below which a face needs support.
    pub overhang_limit: f64,
    /// Sharp and short edges.
    pub edges: Edges,
    /// Parts of their own and cavities.
    pub parts: Parts,
    /// What a price depends on.
    pub quote: Quote,
}

/// Figures, and how they stand to a policy.
#[derive(Debug, Clone, PartialEq)]
pub struct Printing {
    /// The limits.
    pub policy: PrintingPolicy,
    /// The mesh is certified to be a valid solid.
    pub is_solid: bool,
    /// One for each limit.
    pub checks: Vec<Check>,
    /// How the part fits the largest box of the policy; `None`: it has none.
    pub fit: Option<Fit>,
    /// What was measured.
    pub figures: Figures,
}

impl Printing {
    /// The worst of all checks.
    pub fn verdict(&self) -> Status {
        self.checks.iter().filter_map(|check| check.status).max().unwrap_or(Status::Ok)
    }

    /// P3: no check is an error, on a valid solid. `None`: no error was found, but the mesh is not a valid solid.
    pub fn holds(&self) -> Option<bool> {
        match (self.verdict(), self.is_solid) {
            (Status::Error, _) => Some(false),
            (_, true) => Some(true),
            (_, false) => None,
        }
    }
}

/// Measures `soup` and compares it with `policy`. `is_solid`: it is certified to be a valid solid. Keeps at most `samples`
/// witnesses of each check. `None`: there is no triangle with a side, or the size is out of range.
///
/// # Errors
/// When the budget stops the run.
pub fn measure(
    soup: &Soup,
    policy: &PrintingPolicy,
    is_solid: bool,
    samples: usize,
    budget: &Budget,
) -> Result<Option<Printing>, Stopped> {
    let _memory = budget.charge(
        soup.triangles.len() as u64 * BYTES_PER_TRIANGLE + soup.positions.len() as u64 * BYTES_PER_VERTEX,
    )?;
    let Some(surface) = WeldedSurface::of(soup, budget)? else { return Ok(None) };
    let figures = figures(&surface, policy, is_solid, samples, budget)?;
    let up = policy.build_direction;
    let overhangs = overhang::witnesses(&surface, up, figures.overhang_limit, samples, budget)?;
    let largest = policy.build_volume.error.or(policy.build_volume.warning);
    Ok(Some(Printing {
        policy: *policy,
        is_solid,
        checks: judge::checks(&figures, policy, overhangs),
        fit: largest.map(|sides| judge::fit(&figures, up, sides)),
        figures,
    }))
}

fn figures(
    surface: &WeldedSurface<'_>,
    policy: &PrintingPolicy,
    is_solid: bool,
    samples: usize,
    budget: &Budget,
) -> Result<Figures, Stopped> {
    let of = distance::Surface { positions: surface.positions, triangles: &surface.triangles };
    let areas = Areas::of(of, budget)?;
    let search = NearestSearch::build(surface.positions, &surface.triangles, budget)?;
    let probe = Probe::new(surface, &search, &areas, budget);
    let walls = probe.measure(SurfaceSide::Inside, &policy.wall, samples)?;
    let gaps = probe.measure(SurfaceSide::Outside, &policy.gap, samples)?;
    let groups = EdgeGroups::build(&surface.triangles, surface.positions.len(), budget)?;
    let edges = || edges::edges(surface, &groups, &policy.sharp_edge, samples, budget);
    let parts = || parts::parts(surface, &groups, search.bvh(), &policy.feature, is_solid, samples, budget);
    let (edges, parts) = par::join(edges, parts);
    let overhang_limit = overhang::angle_limit(&policy.overhang);
    let overhangs = BuildDirection::ALL.map(|up| overhang::overhang(surface, up, overhang_limit, budget));
    Ok(Figures {
        walls,
        gaps,
        overhangs: overhangs.into_iter().collect::<Result<_, _>>()?,
        overhang_limit,
        edges: edges?,
        parts: parts?,
        quote: quote(surface, policy.build_direction, is_solid, areas.total(), budget)?,
    })
}

fn quote(
    surface: &WeldedSurface<'_>,
    up: BuildDirection,
    is_solid: bool,
    area: f64,
    budget: &Budget,
) -> Result<Quote, Stopped> {
    Ok(Quote {
        volume: if is_solid { Some(surface.volume(budget)?) } else { None },
        area,
        bounds: surface.bounds,
        oriented_box: oriented_box::oriented_box(surface, budget)?,
        shadow_area: shadow::shadow(surface, up, is_solid, budget)?,
    })
}
