//! Vertices that are put inside although nothing winds around them: where the surface would be lost.

use super::super::surface::{InputSurface, separate};
use super::super::{raster, seams};
use super::*;
use crate::geom::closest_point_on_triangle;
use crate::spatial::{Nearest, NearestSearch};

/// A place farther than this before a triangle, in cells, is in front of it.
const BESIDE: f64 = 1e-3;

impl Signs<'_> {
    /// Puts vertices inside where the surface would be lost; gives those that are inside by this.
    pub(super) fn keep_what_is_lost(
        &mut self,
        surface: &InputSurface,
        budget: &Budget,
    ) -> Result<Vec<u32>, Stopped> {
        let mut changed = Vec::new();
        if !surface.sheets().is_empty() {
            let near = self.near(TOUCHED_BY_SHEET, budget)?;
            let near = self.widen(near, (self.sheet_reach - SHEET).ceil() as usize, budget)?;
            self.grow_sheets(&near, surface.sheets(), &mut changed, budget)?;
        }
        let mut thin = Vec::new();
        if self.mark_thin_solid(surface, budget)? {
            thin.extend(self.grow_thin(surface, Why::IsThin, &mut changed, budget)?);
        }
        // Also sheets that grew into each other's front and so not at all.
        if self.mark_lost(budget)? {
            thin.extend(self.grow_thin(surface, Why::IsLost, &mut changed, budget)?);
        }
        thin.sort_unstable();
        thin.dedup();
        self.thin = thin.into_iter().map(|t| surface.corners[t as usize]).collect();
        Ok(changed)
    }

    /// Puts vertices beside the marked cubes inside that are close to the triangles which go through those; takes the marks
    /// away and gives the triangles.
    fn grow_thin(
        &mut self,
        surface: &InputSurface,
        why: Why,
        changed: &mut Vec<u32>,
        budget: &Budget,
    ) -> Result<Vec<u32>, Stopped> {
        let mut thin = Vec::new();
        for (t, &corners) in surface.corners.iter().enumerate() {
            let (mut count, mut is_marked) = (1, false);
            raster::cubes(corners, self.lattice.dims, |cube| {
                is_marked |= self.state[self.lattice.index(cube)] & GROWING != 0;
                count += 1;
            });
            budget.spend(count)?;
            if is_marked {
                thin.push(t as u32);
            }
        }
        let near = self.near(GROWING, budget)?;
        self.state.iter_mut().for_each(|state| *state &= !GROWING);
        let is_taken = |place: DVec3, nearest: &Nearest, search: &NearestSearch<'_>| match why {
            Why::IsLost => Ok(true),
            Why::IsThin => {
                let away = place - nearest.point;
                let normal = normal_of(search.corners(nearest.triangle));
                // Behind the triangle it is in the solid, or where there is next to none.
                let outward = if normal.dot(away) > BESIDE { away.normalize_or_zero() } else { normal };
                let thickness = surface.thickness(nearest.point, -outward, SLAB, budget)?;
                let Some(reach) = thickness.map(|thickness| (SLAB - thickness) / 2.0) else {
                    return Ok(false);
                };
                if nearest.distance > reach {
                    return Ok(false);
                }
                // A gap stays, where there is room.
                let gap = surface.gap(nearest.point, outward, GAP + 2.0 * reach, budget)?;
                Ok(gap.is_none_or(|gap| nearest.distance <= (gap - GAP) / 2.0))
            }
        };
        let corners: Vec<[DVec3; 3]> = thin.iter().map(|&t| surface.corners[t as usize]).collect();
        let wall = Wall { reach: THIN, mark: THIN_SIDE };
        self.grow(&near, &corners, wall, is_taken, changed, budget)?;
        Ok(thin)
    }

    /// Marks the cubes behind whose surface the solid is thinner than [`SLAB`]; true when there is one.
    fn mark_thin_solid(&mut self, surface: &InputSurface, budget: &Budget) -> Result<bool, Stopped> {
        let (mut seen, _charge) = budget.vec::<u8>(self.lattice.len())?;
        seen.resize(self.lattice.len(), 0);
        // One place in each cube for each of six directions.
        let mut places = Vec::new();
        for &corners in surface.boundary() {
            let normal = normal_of(corners);
            let axis = (0..3).fold(0, |most, a| if normal[a].abs() > normal[most].abs() { a } else { most });
            let direction = 1u8 << (2 * axis + usize::from(normal[axis] < 0.0));
            let mut count = 1;
            raster::cubes(corners, self.lattice.dims, |cube| {
                let index = self.lattice.index(cube);
                count += 1;
                if seen[index] & direction == 0 {
                    seen[index] |= direction;
                    let middle = DVec3::from_array(cube.map(|n| n as f64 + 0.5));
                    places.push((index, closest_point_on_triangle(middle, corners), -normal));
                }
            });
            budget.spend(count)?;
        }
        let _charge = budget.charge(places.len() as u64 * 56)?;
        let is_thin = par::try_map_ranges(places.len(), 256, |range| {
            budget.spend(range.len() as u64 * 4)?;
            let is_thin = |&(_, place, inward): &(usize, DVec3, DVec3)| {
                Ok(surface.thickness(place, inward, SLAB, budget)?.is_some())
            };
            places[range].iter().map(is_thin).collect::<Result<Vec<bool>, Stopped>>()
        })?;
        let mut is_any = false;
        for (&(cube, ..), is_thin) in places.iter().zip(is_thin.into_iter().flatten()) {
            if is_thin {
                self.state[cube] |= GROWING;
                is_any = true;
            }
        }
        Ok(is_any)
    }

    /// Marks the touched cubes with no vertex inside in them and their neighbours; true when there is one.
    fn mark_lost(&mut self, budget: &Budget) -> Result<bool, Stopped> {
        let mut is_any = false;
        for cube in 0..self.state.len() {
            if cube % CHECK_EVERY == 0 {
                budget.check()?;
            }
            if self.state[cube] & (TOUCHED | TOUCHED_BY_SHEET) != 0 {
                let mut all = 0;
                self.around_cube(cube, |state, _| all |= *state);
                if all & INSIDE == 0 {
                    self.state[cube] |= GROWING;
                    is_any = true;
                }
            }
        }
        Ok(is_any)
    }

    /// Puts those of `near` inside that are in the walls of `sheets`: behind the nearest one, or in the bar
    /// around a seam.
    fn grow_sheets(
        &mut self,
        near: &[u32],
        sheets: &[[DVec3; 3]],
        changed: &mut Vec<u32>,
        budget: &Budget,
    ) -> Result<(), Stopped> {
        let seams: Vec<[DVec3; 3]> =
            seams::seams(sheets, budget)?.into_iter().map(|[from, to]| [from, to, to]).collect();
        let names = separate(seams.len());
        let seams = NearestSearch::build(seams.as_flattened(), &names, budget)?;
        let is_taken = |place: DVec3, nearest: &Nearest, search: &NearestSearch<'_>| {
            Ok(is_behind(place, nearest.point, search.corners(nearest.triangle))
                || seams.find(place, None, budget)?.is_some_and(|seam| seam.distance <= THIN))
        };
        let reach = self.sheet_reach;
        self.grow(near, sheets, Wall { reach, mark: SHEET_SIDE }, is_taken, changed, budget)
    }

    /// Puts those of `near` inside that are within reach of `triangles`, and that `is_taken` takes of these: it is given the
    /// place, the nearest point, and the search that found it.
    fn grow(
        &mut self,
        near: &[u32],
        triangles: &[[DVec3; 3]],
        wall: Wall,
        is_taken: impl Fn(DVec3, &Nearest, &NearestSearch<'_>) -> Result<bool, Stopped> + Sync,
        changed: &mut Vec<u32>,
        budget: &Budget,
    ) -> Result<(), Stopped> {
        let names = separate(triangles.len());
        let search = NearestSearch::build(triangles.as_flattened(), &names, budget)?;
        let grown = par::try_map_ranges(near.len(), 1024, |range| {
            budget.spend(range.len() as u64 * 4)?;
            let mut hint = None;
            let mut grown = Vec::new();
            for &v in near[range].iter().filter(|&&v| !self.is_inside(v as usize)) {
                let place = self.lattice.units(v as usize);
                let Some(nearest) = search.find(place, hint, budget)? else { continue };
                hint = Some(nearest.triangle);
                let is_near = nearest.distance <= wall.reach;
                if is_near && is_taken(place, &nearest, &search)? {
                    grown.push(v);
                }
            }
            Ok(grown)
        })?;
        for v in grown.into_iter().flatten() {
            if !self.lattice_border(v as usize) {
                self.state[v as usize] |= KNOWN | INSIDE | wall.mark;
                changed.push(v);
            }
        }
        Ok(())
    }

    /// Adds to a list what is beside it, and again, as many `times`.
    fn widen(&mut self, mut near: Vec<u32>, times: usize, budget: &Budget) -> Result<Vec<u32>, Stopped> {
        near.iter().for_each(|&v| self.state[v as usize] |= LISTED);
        let mut last = 0;
        for _ in 0..times {
            let end = near.len();
            for n in last..end {
                if n % CHECK_EVERY == 0 {
                    budget.check()?;
                }
                let index = near[n] as usize;
                if self.lattice_border(index) {
                    continue;
                }
                for offset in beside() {
                    let beside = index.wrapping_add_signed(self.lattice.stride(offset));
                    if self.state[beside] & LISTED == 0 {
                        self.state[beside] |= LISTED;
                        near.push(beside as u32);
                    }
                }
            }
            last = end;
        }
        near.iter().for_each(|&v| self.state[v as usize] &= !LISTED);
        Ok(near)
    }
}

/// Why a wall grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Why {
    /// The solid is thin there: as far as it takes to be as thick as a slab.
    IsThin,
    /// No vertex is inside there.
    IsLost,
}

/// How far a wall grows in cells, and what the vertices in it are marked with.
#[derive(Debug, Clone, Copy)]
struct Wall {
    reach: f64,
    mark: u8,
}

/// Whether `place`, whose closest point is `closest` of a triangle, is behind that triangle or in its plane.
fn is_behind(place: DVec3, closest: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    (b - a).cross(c - a).dot(place - closest) <= 0.0
}

/// Unit normal, zero for a triangle without area.
fn normal_of([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}
