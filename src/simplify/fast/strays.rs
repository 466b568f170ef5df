//! Triangles that reach into the space of other parts.
//!
//! The guarded mode moves vertices only inside the region of their own part. So what a collapse could meet of other
//! parts are these triangles alone, and they stay as they are for the whole round: a collapse that changes one would
//! leave its region.

use super::mesh::{Mesh, MeshDivision};
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::par;
use crate::spatial::Bvh;

/// Part of the triangles between parts.
const NO_PART: u32 = u32::MAX;

/// The triangles between parts, and those of parts that are not inside of their part's region.
pub(super) struct Strays {
    triangles: Vec<Stray>,
    /// Three for each of the triangles.
    corners: Vec<DVec3>,
    /// Over the triangles; empty when there is one part only.
    bvh: Option<Bvh>,
}

/// A triangle that stays.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stray {
    /// Places of the corners in the division.
    pub(super) places: [u32; 3],
    part: u32,
}

impl Strays {
    /// Bytes that they take, with those that it took to make them.
    pub(super) fn bytes(&self) -> u64 {
        let per_triangle = size_of::<Stray>() + 3 * size_of::<DVec3>() + size_of::<[u32; 3]>();
        self.triangles.len() as u64 * (per_triangle as u64 + Bvh::BYTES_PER_TRIANGLE)
    }

    pub(super) fn of<S: Copy + Send + Sync>(
        mesh: &Mesh<S>,
        division: &MeshDivision,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let parts = division.starts.len() - 1;
        if parts <= 1 {
            return Ok(Self { triangles: Vec::new(), corners: Vec::new(), bvh: None });
        }
        let position = |place: u32| mesh.vertices[division.order[place as usize] as usize].position;
        let of_part = par::try_map_ranges(parts + 1, 1, |range| {
            budget.check()?;
            let i = range.start;
            let end = division.starts.get(i + 1).copied().unwrap_or(mesh.triangles.len());
            let region = (i < parts).then(|| division.region(i));
            let part = if i < parts { i as u32 } else { NO_PART };
            let all = mesh.triangles[division.starts[i]..end].iter().copied();
            let strays = all.filter(|places| region.is_none_or(|r| !r.holds(Aabb::of(places.map(position)))));
            Ok(strays.map(|places| Stray { places, part }).collect::<Vec<_>>())
        })?;
        let triangles = of_part.concat();
        let corners: Vec<DVec3> = triangles.iter().flat_map(|stray| stray.places.map(position)).collect();
        let ids: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let bvh = Some(Bvh::build(&corners, &ids, None, budget)?);
        Ok(Self { triangles, corners, bvh })
    }

    /// Calls `visit` with the strays of other parts than `part` whose boxes may meet `query`, and their corners.
    pub(super) fn visit(
        &self,
        part: u32,
        query: Aabb,
        budget: &Budget,
        mut visit: impl FnMut(&Stray, [DVec3; 3]),
    ) -> Result<(), Stopped> {
        let Some(bvh) = &self.bvh else { return Ok(()) };
        bvh.visit_box(query, budget, |t| {
            let stray = &self.triangles[t as usize];
            if stray.part != part {
                let first = 3 * t as usize;
                visit(stray, [self.corners[first], self.corners[first + 1], self.corners[first + 2]]);
            }
        })
    }
}
