//! The surface of [`Method::Rbf`](super::Method::Rbf): the field of the rim and the rings of vertices around it.

use super::options::FillOptions;
use super::patch::PatchMesh;
use super::refine::turn_edges;
use super::regions::Region;
use super::report::Rejection;
use super::surface::FillSurface;
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::implicit::{self, Band, BandSurroundings, Field, Kernel, RbfOptions, Unfit};
use crate::par;
use crate::spatial::{Bvh, NearestSearch};
use rustc_hash::FxHashSet;

/// Rings that a band may have.
const RINGS_MAX: u32 = 8;
/// Points of a band, at most; a ring that would make it larger is left out, but never the first.
const POINTS_MAX: usize = 1 << 15;
/// Vertices that one thread moves at a time.
const POINTS: usize = 16;
/// How far a vertex may go to the surface, as a share of the diagonal of the rim's box: a dome as high as its rim is wide.
const REACH: f64 = 0.5;

/// The mesh as a field sees it: what is near, and how large it all is.
pub(super) struct FieldMesh<'m> {
    nearest: NearestSearch<'m>,
    bounds: Aabb,
}

impl<'m> FieldMesh<'m> {
    pub(super) fn new(
        positions: &'m [DVec3],
        triangles: &'m [[u32; 3]],
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let used = triangles.as_flattened().iter().map(|&v| positions[v as usize]);
        Ok(Self { nearest: NearestSearch::build(positions, triangles, budget)?, bounds: Aabb::of(used) })
    }

    /// The boxes of its triangles.
    pub(super) fn bvh(&self) -> &Bvh {
        self.nearest.bvh()
    }
}

/// Fits the field of a region. Where a cubic one does not fit, because thin walls make lambda small, the thin plate is
/// tried, if the options say that plainer patches may be; why the cubic one does not fit is then put among `rejected`.
pub(super) fn field(
    region: &Region,
    rings: u32,
    surface: &FillSurface,
    mesh: &FieldMesh<'_>,
    options: &FillOptions,
    rejected: &mut Vec<Rejection>,
    budget: &Budget,
) -> Result<Result<Field, Rejection>, Stopped> {
    let band = band(region, rings, surface, budget)?;
    let around = BandSurroundings { surface: Some(&mesh.nearest), mesh_box: mesh.bounds };
    let unfit = match implicit::fit(&band, &around, &options.rbf, budget)? {
        Ok(field) => return Ok(Ok(field)),
        Err(unfit) => unfit,
    };
    let is_of_kernel = matches!(unfit, Unfit::Singular { .. } | Unfit::Residual { .. });
    if options.rbf.kernel != Kernel::Cubic || !options.falls_back || !is_of_kernel {
        return Ok(Err(reason(unfit)));
    }
    let plainer = RbfOptions { kernel: Kernel::ThinPlate, ..options.rbf };
    rejected.push(reason(unfit));
    Ok(implicit::fit(&band, &around, &plainer, budget)?.map_err(reason))
}

fn reason(unfit: Unfit) -> Rejection {
    match unfit {
        Unfit::TooFewPoints { .. } | Unfit::NotFinite { .. } | Unfit::Options | Unfit::Rank { .. } => {
            Rejection::TooFewPoints
        }
        Unfit::NoRoom => Rejection::NoRoom,
        Unfit::Singular { .. } => Rejection::Singular,
        Unfit::Residual { .. } => Rejection::Inexact,
    }
}

/// The vertices of the rim, then those of the rings around it, each once, with the normals that the mesh has there.
fn band(region: &Region, rings: u32, surface: &FillSurface, budget: &Budget) -> Result<Band, Stopped> {
    let mut seen = FxHashSet::default();
    let mut points: Vec<u32> =
        region.rim().iter().map(|&h| surface.corner(h)).filter(|&v| seen.insert(v)).collect();
    let mut last = 0..points.len();
    for ring in 0..rings.min(RINGS_MAX) {
        let mut next = Vec::new();
        for &v in &points[last] {
            budget.spend(surface.star(v).len() as u64 / 4 + 1)?;
            for &t in surface.star(v) {
                next.extend(surface.triangles[t as usize].into_iter().filter(|&w| seen.insert(w)));
            }
        }
        if ring > 0 && points.len() + next.len() > POINTS_MAX {
            break;
        }
        last = points.len()..points.len() + next.len();
        points.extend(next);
    }
    let with_normals = points.into_iter().map(|v| (v, surface.vertex_normal(v)));
    let (points, normals): (Vec<DVec3>, Vec<DVec3>) = with_normals
        .filter(|(_, normal)| normal.length_squared() > 0.0)
        .map(|(v, normal)| (surface.positions[v as usize], normal))
        .unzip();
    Ok(Band { points, normals })
}

/// Moves the new vertices of a smooth patch to where the field is zero. `false`: one of them finds no such place.
pub(super) fn project(
    mesh: &mut PatchMesh,
    field: &Field,
    is_free: &dyn Fn(u32, u32) -> bool,
    budget: &Budget,
) -> Result<bool, Stopped> {
    let reach = REACH * Aabb::of(mesh.points[..mesh.rim].iter().copied()).diagonal();
    let centres = field.facts().centres as u64;
    let points = &mesh.points[mesh.rim..];
    let on_surface = |range: std::ops::Range<usize>| -> Result<Vec<Option<DVec3>>, Stopped> {
        let projected = |&point: &DVec3| {
            budget.spend(centres / 16 + 1)?;
            Ok(field.project(point, reach))
        };
        points[range].iter().map(projected).collect()
    };
    let places = par::try_map_ranges(points.len(), POINTS, on_surface)?.concat();
    let Some(places) = places.into_iter().collect::<Option<Vec<_>>>() else { return Ok(false) };
    mesh.points.splice(mesh.rim.., places);
    turn_edges(mesh, is_free, budget)?;
    Ok(true)
}
