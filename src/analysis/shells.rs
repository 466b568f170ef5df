//! The closed, coherently oriented parts of a mesh, and their volumes.

use super::members::Members;
use super::sum::CompensatedSum;
use super::welded::{Welded, indices_where};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{DVec3, Sign, volume_sign};
use crate::par;

/// A closed part whose triangles all agree on what is inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OrientedShell {
    /// Number of the part.
    pub(super) part: u32,
    /// Rounded; positive when the shell points outward, infinite when out of range.
    pub(super) volume: f64,
    /// Exact.
    pub(super) volume_sign: Sign,
}

/// All shells of `mesh`, by part.
pub(super) fn shells(
    mesh: &Welded<'_>,
    members: &Members,
    budget: &Budget,
) -> Result<Vec<OrientedShell>, Stopped> {
    let is_shell = |p: usize| mesh.parts[p].is_closed && mesh.parts[p].is_oriented;
    let parts = indices_where(mesh.parts.len(), budget, is_shell)?;
    par::try_map_ranges(parts.len(), 1, |range| {
        let part = parts[range.start];
        let triangles = members.part(part);
        let (volume, sign) = par::join(
            || volume(mesh, triangles, budget),
            || volume_sign(triangles.iter().map(|&t| mesh.corners(t)), || budget.check()),
        );
        Ok(OrientedShell { part, volume: volume?, volume_sign: sign? })
    })
}

/// The volume that `triangles` enclose; infinite when out of range.
fn volume(mesh: &Welded<'_>, triangles: &[u32], budget: &Budget) -> Result<f64, Stopped> {
    // Near the shell, so that a part far from the origin keeps its digits.
    let origin = triangles.first().map_or(DVec3::ZERO, |&t| mesh.corners(t)[0]);
    let sums = par::try_map_ranges(triangles.len(), CHECK_EVERY, |range| {
        budget.check()?;
        let six_volumes = triangles[range].iter().map(|&t| {
            let [a, b, c] = mesh.corners(t).map(|p| p - origin);
            a.cross(b).dot(c)
        });
        Ok(six_volumes.collect::<CompensatedSum>().value())
    })?;
    let volume = sums.into_iter().collect::<CompensatedSum>().value() / 6.0;
    Ok(if volume.is_nan() { f64::INFINITY } else { volume })
}
