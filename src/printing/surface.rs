//! The triangles that have a side, with their normals.

use super::PrintingWitness;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::Soup;
use crate::par;
use crate::spatial::coincident_f64;

/// Diagonals, in the unit of the file, whose squares and cubes are well inside the range of numbers.
const DIAGONALS: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// Of the least angle between the normals of opposite walls, 150 degrees.
const OPPOSITE_COSINE_MAX: f64 = -0.866_025_403_784_438_6;

/// A mesh after the exact weld, without triangles whose normal cannot be told.
#[derive(Debug)]
pub(super) struct WeldedSurface<'s> {
    pub(super) positions: &'s [DVec3],
    /// Corners are the first vertex at their position.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The soup's triangle behind each.
    pub(super) source: Vec<u32>,
    /// Outward unit normals.
    pub(super) normals: Vec<DVec3>,
    pub(super) bounds: Aabb,
}

impl<'s> WeldedSurface<'s> {
    /// `None` when nothing is left, or when the size is out of range.
    pub(super) fn of(soup: &'s Soup, budget: &Budget) -> Result<Option<Self>, Stopped> {
        let group = coincident_f64(&soup.positions, budget)?.group;
        let mut first_of = vec![u32::MAX; soup.positions.len()];
        for (v, &g) in group.iter().enumerate() {
            let first = &mut first_of[g as usize];
            *first = (*first).min(v as u32);
        }
        let mut surface = Self {
            positions: &soup.positions,
            triangles: Vec::with_capacity(soup.triangles.len()),
            source: Vec::with_capacity(soup.triangles.len()),
            normals: Vec::with_capacity(soup.triangles.len()),
            bounds: Aabb::EMPTY,
        };
        for (t, corners) in soup.triangles.iter().enumerate() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            surface.add(t as u32, corners.map(|v| first_of[group[v as usize] as usize]));
        }
        Ok((!surface.triangles.is_empty() && DIAGONALS.contains(&surface.diagonal())).then_some(surface))
    }

    fn add(&mut self, source: u32, triangle: [u32; 3]) {
        let corners @ [a, b, c] = triangle.map(|v| self.positions[v as usize]);
        // Of edges of about the same length 1, so that nothing overflows.
        let unit = |edge: DVec3| edge / edge.abs().max_element();
        let normal = unit(b - a).cross(unit(c - a)).normalize_or_zero();
        if normal.is_finite() && normal != DVec3::ZERO {
            self.triangles.push(triangle);
            self.source.push(source);
            self.normals.push(normal);
            self.bounds = self.bounds.union(Aabb::of(corners));
        }
    }

    pub(super) fn corners(&self, t: u32) -> [DVec3; 3] {
        self.triangles[t as usize].map(|v| self.positions[v as usize])
    }

    pub(super) fn diagonal(&self) -> f64 {
        self.bounds.diagonal()
    }

    /// True when two triangles are on opposite walls: their normals are at least 150 degrees apart, so that the walls
    /// converge at 30 degrees or less. Others, such as the sides of a box at its edges, are no wall; edges sharper than
    /// that are what design guides call sharp.
    pub(super) fn are_opposite(&self, a: u32, b: u32) -> bool {
        self.normals[a as usize].dot(self.normals[b as usize]) <= OPPOSITE_COSINE_MAX
    }

    /// Volume enclosed by all triangles together, in cubic units of the file.
    pub(super) fn volume(&self, budget: &Budget) -> Result<f64, Stopped> {
        let origin = self.bounds.min.midpoint(self.bounds.max);
        let parts = par::try_map_ranges(self.triangles.len(), CHECK_EVERY, |range| {
            budget.check()?;
            let corners = range.map(|t| self.corners(t as u32).map(|corner| corner - origin));
            Ok(corners.map(|[a, b, c]| a.cross(b).dot(c)).sum::<f64>())
        })?;
        Ok(parts.into_iter().sum::<f64>() / 6.0)
    }

    /// A place on triangle `t`, where something was measured.
    pub(super) fn witness(&self, t: u32, place: DVec3, measured: f64) -> PrintingWitness {
        PrintingWitness { triangle: self.source[t as usize], place, measured }
    }

    /// The middle of triangle `t`, where something was measured.
    pub(super) fn witness_in_middle(&self, t: u32, measured: f64) -> PrintingWitness {
        self.witness(t, self.corners(t).iter().sum::<DVec3>() / 3.0, measured)
    }
}
