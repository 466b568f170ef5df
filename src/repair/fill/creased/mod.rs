//! Carries sharp edges of the mesh on through a hole, and closes what is between them on its own.
//!
//! Where a hole was torn into an edge of a part, a smooth patch rounds the edge off, and the triangulation that bends least
//! chamfers it. Here each sharp edge that ends at the rim is a curve through the hole: two that go on towards each other are
//! one curve, three or more that are left meet in a point. Curves divide the hole into sides. One in a plane gets triangles
//! without new vertices; any other is refined and faired, clamped at the rim and free to turn about the curves.

mod division;
mod ends;

pub(in crate::repair::fill) use self::division::HoleDivision;
use self::division::normal_beyond;
use super::make::{AreaLimits, MadePatch, refine_and_fair};
use super::minimal::{self, CORNERS_MAX};
use super::patch::PatchMesh;
use super::regions::Region;
use super::report::Rejection;
use super::surface::FillSurface;
use super::{large, planar};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;

/// The patch of a region that creases divide, or why there is none. No side is larger than `limits` say.
pub(super) fn creased(
    region: &Region,
    division: &HoleDivision,
    limits: AreaLimits,
    surface: &FillSurface,
    budget: &Budget,
) -> Result<Result<MadePatch, Rejection>, Stopped> {
    let HoleDivision { points, parents, .. } = division;
    let mut patch = PartialPatch { points: points.clone(), parents: parents.clone(), triangles: Vec::new() };
    for corners in &division.sides {
        let side = CreaseSide { corners, division, region, limits, surface };
        match side.close(budget)? {
            Ok(mesh) => patch.sew(corners, &mesh),
            Err(reason) => return Ok(Err(reason)),
        }
    }
    let Some(mut mesh) = PatchMesh::new(patch.points, patch.triangles) else {
        return Ok(Err(Rejection::Topology));
    };
    (mesh.rim, mesh.parents) = (region.rim().len(), patch.parents);
    MadePatch::refined(region, surface, mesh, budget)
}

/// The sides that are closed so far.
struct PartialPatch {
    /// Those of the rim's corners, of curves, then of sides.
    points: Vec<DVec3>,
    parents: Vec<[u32; 2]>,
    triangles: Vec<[u32; 3]>,
}

impl PartialPatch {
    fn sew(&mut self, corners: &[u32], side: &PatchMesh) {
        let first = self.points.len() as u32;
        let id = |v: u32| match corners.get(v as usize) {
            Some(&corner) => corner,
            None => first + v - corners.len() as u32,
        };
        self.triangles.extend(side.triangles.iter().map(|t| t.map(id)));
        self.parents.extend(side.parents.iter().map(|ends| ends.map(id)));
        self.points.extend(&side.points[side.rim..]);
    }
}

/// What is between curves and the rim.
struct CreaseSide<'a> {
    /// Points of the division, in the direction of the rim.
    corners: &'a [u32],
    division: &'a HoleDivision,
    region: &'a Region,
    limits: AreaLimits,
    surface: &'a FillSurface,
}

impl CreaseSide<'_> {
    fn close(&self, budget: &Budget) -> Result<Result<PatchMesh, Rejection>, Stopped> {
        let points: Vec<DVec3> = self.corners.iter().map(|&v| self.division.points[v as usize]).collect();
        let plane = self.division.plane_of(self.corners, self.region, self.surface);
        let flat = plane.and_then(|normal| planar::triangulate(std::slice::from_ref(&points), normal));
        let is_flat = flat.is_some();
        let triangles = match flat {
            Some(triangles) => Some(triangles),
            None => self.least_bent(&points, budget)?,
        };
        let Some(triangles) = triangles else { return Ok(Err(Rejection::NoPatch)) };
        let triangles = triangles.into_iter().map(|t| t.map(|i| i as u32)).collect();
        let next: Vec<u32> = (1..points.len() as u32).chain([0]).collect();
        let Some(mut mesh) = PatchMesh::new(points, triangles) else { return Ok(Err(Rejection::Topology)) };
        if is_flat {
            return Ok(Ok(mesh));
        }
        let base_area = mesh.area();
        let area_max = self.limits.plate * base_area;
        let around = self.surface.around(&self.half_edges(), self.is_clamped(), budget)?;
        let is_free = |a: u32, b: u32| self.is_free(a as usize, b as usize);
        let is_fair = refine_and_fair(&mut mesh, &next, &around, area_max, &is_free, budget)?;
        let is_fit = is_fair && self.limits.admit(&mesh, base_area);
        Ok(if is_fit { Ok(mesh) } else { Err(Rejection::NoFit) })
    }

    fn least_bent(&self, points: &[DVec3], budget: &Budget) -> Result<Option<Vec<[usize; 3]>>, Stopped> {
        let normals: Vec<DVec3> =
            (0..points.len()).map(|i| normal_beyond(self.corners, i, self.region, self.surface)).collect();
        let is_free = |i: usize, k: usize| self.is_free(i, k);
        if points.len() <= CORNERS_MAX {
            return minimal::triangulate(points, &normals, is_free, budget);
        }
        let normal = normals.iter().sum::<DVec3>().normalize_or_zero();
        large::triangulate(points, &normals, normal, is_free, budget)
    }

    /// The half-edge of the rim at each corner; `None` for those on curves.
    fn half_edges(&self) -> Vec<Option<u32>> {
        self.corners.iter().map(|&v| self.region.rim().get(v as usize).copied()).collect()
    }

    /// Where the surface goes on smoothly: not where a curve ends or runs.
    fn is_clamped(&self) -> Vec<bool> {
        self.corners.iter().map(|&v| !self.division.is_on_curve(v)).collect()
    }

    /// Whether there may be an edge between two corners: not between two of one curve, as the side beyond may have it too.
    fn is_free(&self, i: usize, k: usize) -> bool {
        let [a, b] = [self.corners[i], self.corners[k]];
        let rim = self.region.rim();
        if self.division.are_on_one_curve(a, b) {
            return false;
        }
        match [rim.get(a as usize), rim.get(b as usize)] {
            [Some(&g), Some(&h)] => self.surface.is_free(g, h),
            _ => true,
        }
    }
}
