//! A certified solid around any triangles: the lattice wrap.
//!
//! A lattice of cubes, each cut in six tetrahedra, is laid around the input. Every vertex of the lattice is decided to be
//! inside or outside, and the surface between them is built tetrahedron by tetrahedron. For any signs it is closed,
//! oriented, 2-manifold, non-degenerate and embedded, and all its coordinates are float32; docs/lattice-wrap.md has the
//! proof. The signs follow generalized winding numbers (Jacobson, Kavan and Sorkine-Hornung 2013), and the cuts lie on
//! the input.

mod columns;
mod cut;
mod fit;
mod lattice;
mod link;
mod raster;
mod seams;
mod signs;
mod surface;
mod tetrahedra;

#[cfg(test)]
mod tests;

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3, triangle_area};
use crate::winding::{self, OpenShells};
use cut::LatticeCut;
pub use fit::FitCounts;
use lattice::Lattice;
pub use lattice::TooCoarse;
pub use signs::OwnDefects;
use signs::Signs;
use surface::InputSurface;
use tetrahedra::Patches;

/// The settings of a wrap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WrapOptions {
    /// Cubes along the longest side of the input; 4 to 1024. Fewer where the lattice or the triangles would be too many.
    pub cells: u32,
    /// How open shells are read.
    pub open_shells: OpenShells,
    /// Thickness of the walls that sheets become, in the unit of the input; `None`: 0.4 % of the diagonal.
    pub wall: Option<f64>,
    /// Most vertices of the lattice, each of which takes two bytes.
    pub vertices_max: usize,
    /// Most cubes and columns to go through for all triangles together.
    pub visits_max: u64,
    /// Most cubes that the area of the triangles would cover; about six triangles come out for each.
    pub area_max: f64,
    /// Whether vertices move onto the input and its creases.
    pub is_fitted: bool,
}

impl Default for WrapOptions {
    fn default() -> Self {
        Self {
            cells: 256,
            open_shells: OpenShells::Auto,
            wall: None,
            vertices_max: 1 << 25,
            visits_max: 1 << 27,
            area_max: 30_000.0,
            is_fitted: true,
        }
    }
}

/// A closed surface around the input.
#[derive(Debug, Clone, PartialEq)]
pub struct Wrapped {
    /// Vertex positions, all float32, in the unit of the input.
    pub positions: Vec<DVec3>,
    /// Positions before the fit: with these the surface is valid by construction. Empty without a fit.
    pub unfitted: Vec<DVec3>,
    /// Vertex ids of each triangle's corners, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// How it came to be.
    pub account: Account,
}

/// What was decided on the way to a wrap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Account {
    /// Side of a cube, in the unit of the input.
    pub spacing: f64,
    /// All coordinates are multiples of this.
    pub pitch: f64,
    /// Cubes along the longest side of the input.
    pub cells: u32,
    /// Parts of the input that are closed.
    pub closed_parts: u32,
    /// Open parts that were closed.
    pub open_parts: u32,
    /// Open parts that became walls.
    pub sheet_parts: u32,
    /// Triangles of walls that grew because they are thinner than about two cubes.
    pub thin_triangles: u64,
    /// Thickness of the walls that sheets became, in the unit of the input.
    pub wall: f64,
    /// How clearly open parts bound a volume: 1 for a closed shell, 0 for a flat sheet. `None`: there are none.
    pub closedness: Option<f64>,
    /// What the lattice made itself and what was taken away again.
    pub own: OwnDefects,
    /// What the fit did.
    pub fit: FitCounts,
}

/// Why there is no wrap.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum WrapError {
    /// No triangle has an extent.
    #[error("no triangle with an extent")]
    Empty,
    /// The part is too small for its distance from the origin, or its coordinates are beyond float32.
    #[error("not representable in float32: pitch {} at a diagonal of {}", .0.pitch, .0.diagonal)]
    NotRepresentable(TooCoarse),
    /// The budget stopped the run.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// How far beside a triangle its sides are looked at, in cells.
const BESIDE: f64 = 1e-3;

/// Thickness of the walls that sheets become when the caller does not say, as a share of the diagonal.
pub const WALL_OF_DIAGONAL: f64 = 0.004;

/// Thinnest and thickest walls, in cells; for a thicker one the cells are larger.
const WALLS: [f64; 2] = [0.25, 16.0];

/// Cells below which no crowd of triangles pushes the resolution.
const CELLS_LEAST: u32 = 24;

/// Wraps `triangles`, whose corners are finite; positions that are equal must be one.
///
/// # Errors
/// When there is nothing to wrap, float32 cannot hold it, or the budget stops the run.
pub fn wrap(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    options: &WrapOptions,
    budget: &Budget,
) -> Result<Wrapped, WrapError> {
    let bounds = Aabb::of(triangles.as_flattened().iter().map(|&v| positions[v as usize]));
    if bounds.is_empty() || bounds.max == bounds.min {
        return Err(WrapError::Empty);
    }
    let lattice = choose(bounds, positions, triangles, options, budget)?;
    let _charge = budget.charge(lattice.len() as u64 * 2 + triangles.len() as u64 * 200)?;
    let units: Vec<DVec3> = positions.iter().map(|&p| lattice.units_of(p)).collect();
    let shells = winding::sort(&units, triangles, options.open_shells, BESIDE, budget)?;
    let mut account = Account {
        spacing: lattice.side(),
        pitch: lattice.pitch,
        cells: ((bounds.max - bounds.min).max_element() / lattice.side()).round() as u32,
        closed_parts: shells.parts[0],
        open_parts: shells.parts[1],
        sheet_parts: shells.parts[2],
        thin_triangles: 0,
        wall: wall_of(options, bounds, &lattice) * lattice.side(),
        closedness: shells.closedness,
        own: OwnDefects::default(),
        fit: FitCounts::default(),
    };
    let surface = InputSurface::new(shells, budget)?;
    let wall = wall_of(options, bounds, &lattice);
    let signs = Signs::decide(&lattice, &surface, wall, budget)?;
    account.thin_triangles = signs.thin.len() as u64;
    account.own = signs.own;
    let patches = tetrahedra::march(&lattice, &signs, budget)?;
    let cuts = cut::cuts(&lattice, &signs, &surface, &patches.edges, budget)?;
    let mut positions = places(&lattice, &patches, &cuts);
    let triangles = triangulate(&patches, &positions, budget)?;
    let mut unfitted = Vec::new();
    if options.is_fitted {
        unfitted.clone_from(&positions);
        account.fit = fit::fit(&lattice, &signs, &surface, &cuts, &mut positions, &triangles, budget)?;
    }
    Ok(Wrapped { positions, unfitted, triangles, account })
}

/// Thickness of the walls that sheets become, in cells.
fn wall_of(options: &WrapOptions, bounds: Aabb, lattice: &Lattice) -> f64 {
    let wall = options.wall.unwrap_or((bounds.max - bounds.min).length() * WALL_OF_DIAGONAL);
    (wall / lattice.side()).clamp(WALLS[0], WALLS[1])
}

/// The finest lattice up to what is asked that the limits allow.
fn choose(
    bounds: Aabb,
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    options: &WrapOptions,
    budget: &Budget,
) -> Result<Lattice, WrapError> {
    // Room for thick walls, which are no more than so many cells.
    let longest = (bounds.max - bounds.min).max_element();
    let wall = options.wall.unwrap_or(0.0).min(longest);
    let bounds = Aabb { min: bounds.min - wall, max: bounds.max + wall };
    let mut cells = options.cells.min((WALLS[1] * longest / wall) as u32);
    let mut is_first = true;
    loop {
        let lattice =
            Lattice::around(bounds, cells, options.vertices_max).map_err(WrapError::NotRepresentable)?;
        let (mut visits, mut area) = (0u64, 0.0);
        for block in triangles.chunks(CHECK_EVERY) {
            budget.check()?;
            for corners in block {
                let corners = corners.map(|v| lattice.units_of(positions[v as usize]));
                visits += raster::cost(corners);
                area += triangle_area(corners);
            }
        }
        if std::mem::take(&mut is_first) && area > options.area_max {
            let fewer = f64::from(cells) * (options.area_max / area).sqrt();
            cells = (fewer as u32).max(CELLS_LEAST).min(cells);
            continue;
        }
        if visits <= options.visits_max || cells <= CELLS_LEAST {
            return Ok(lattice);
        }
        cells = (cells / 2).max(CELLS_LEAST);
    }
}

/// The vertices where the lattice's edges are cut.
fn places(lattice: &Lattice, patches: &Patches, cuts: &[LatticeCut]) -> Vec<DVec3> {
    let place = |(edge, cut): (&tetrahedra::CutEdge, &LatticeCut)| {
        let base = lattice.coordinates(edge.base as usize);
        lattice.place([0, 1, 2].map(|a| {
            let along = if edge.direction >> a & 1 == 1 { i64::from(cut.steps) } else { 0 };
            ((base[a] as i64) << lattice.steps_log2) + along
        }))
    };
    patches.edges.iter().zip(cuts).map(place).collect()
}

/// The triangles, with each quad cut along its shorter diagonal.
fn triangulate(patches: &Patches, positions: &[DVec3], budget: &Budget) -> Result<Vec<[u32; 3]>, Stopped> {
    let mut triangles = patches.triangles.clone();
    triangles.reserve(patches.quads.len() * 2);
    for block in patches.quads.chunks(CHECK_EVERY) {
        budget.check()?;
        for &[p, q, r, s] in block {
            let length = |a: u32, b: u32| positions[a as usize].distance_squared(positions[b as usize]);
            let is_first = length(p, r) <= length(q, s);
            triangles.extend(if is_first { [[p, q, r], [p, r, s]] } else { [[q, r, s], [q, s, p]] });
        }
    }
    Ok(triangles)
}
