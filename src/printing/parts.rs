//! Parts of their own, and cavities without a way out.

use super::surface::WeldedSurface;
use super::{Limit, PrintingWitness};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::{Components, EdgeGroups};
use crate::spatial::{Bvh, nest};

/// A part connected by edges.
#[derive(Debug, Clone, Copy, PartialEq)]
struct MeshPart {
    /// Its first triangle.
    first: u32,
    bounds: Aabb,
    /// Enclosed, if it is closed; positive when it points outward.
    volume: f64,
}

/// The parts of a mesh. Lengths are in the unit of the file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Parts {
    /// Parts connected by edges that bound material: all but cavities.
    pub bodies: u64,
    /// Longest side of the box around the smallest body.
    pub smallest_side: Option<f64>,
    /// Volume of the smallest body; `None` where volumes are not defined.
    pub smallest_volume: Option<f64>,
    /// Bodies whose longest side is below the limit.
    pub small_count: u64,
    /// Those bodies, with their longest sides.
    pub small: Vec<PrintingWitness>,
    /// Cavities without a way out; `None`: not told, because the mesh is not a valid solid.
    pub cavities: Option<Cavities>,
}

/// Shells that point inward inside of others: what is in them cannot leave.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cavities {
    /// How many.
    pub count: u64,
    /// Their volume, in cubic units of the file.
    pub volume: f64,
    /// The largest ones, with their volumes.
    pub witnesses: Vec<PrintingWitness>,
}

/// Finds the parts; with `is_solid`, which says that the mesh is certified to be one, also what is inside of what.
pub(super) fn parts(
    surface: &WeldedSurface<'_>,
    groups: &EdgeGroups,
    bvh: &Bvh,
    limit: &Limit,
    is_solid: bool,
    witnesses: usize,
    budget: &Budget,
) -> Result<Parts, Stopped> {
    let components = groups.components(budget)?;
    let parts = describe(surface, &components, budget)?;
    let mut is_cavity = vec![false; parts.len()];
    if is_solid {
        let nesting =
            nest(surface.positions, &surface.triangles, &components.of, components.count, Some(bvh), budget)?;
        for (is_cavity, depth) in is_cavity.iter_mut().zip(&nesting.depth) {
            *is_cavity = depth % 2 == 1;
        }
    }
    let side = |part: &MeshPart| (part.bounds.max - part.bounds.min).max_element();
    let bodies: Vec<&MeshPart> =
        parts.iter().zip(&is_cavity).filter(|(_, is)| !**is).map(|(p, _)| p).collect();
    let hollows: Vec<&MeshPart> =
        parts.iter().zip(&is_cavity).filter(|(_, is)| **is).map(|(p, _)| p).collect();
    let smallest = bodies.iter().min_by(|a, b| side(a).total_cmp(&side(b)));
    let mut small: Vec<(f64, &MeshPart)> = bodies.iter().map(|part| (side(part), *part)).collect();
    small.retain(|(side, _)| limit.first_below().is_some_and(|bound| *side < bound));
    small.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(Parts {
        bodies: bodies.len() as u64,
        smallest_side: smallest.map(|part| side(part)),
        smallest_volume: smallest.filter(|_| is_solid).map(|part| part.volume),
        small_count: small.len() as u64,
        small: small
            .iter()
            .take(witnesses)
            .map(|&(side, part)| surface.witness_in_middle(part.first, side))
            .collect(),
        cavities: is_solid.then(|| cavities(surface, hollows, witnesses)),
    })
}

fn cavities(surface: &WeldedSurface<'_>, mut hollows: Vec<&MeshPart>, witnesses: usize) -> Cavities {
    hollows.sort_by(|a, b| a.volume.total_cmp(&b.volume));
    let witness = |part: &&MeshPart| surface.witness_in_middle(part.first, -part.volume);
    Cavities {
        count: hollows.len() as u64,
        // From a zero without a sign, which the sum of nothing has.
        volume: hollows.iter().fold(0.0, |volume, part| volume - part.volume),
        witnesses: hollows.iter().take(witnesses).map(witness).collect(),
    }
}

fn describe(
    surface: &WeldedSurface<'_>,
    components: &Components,
    budget: &Budget,
) -> Result<Vec<MeshPart>, Stopped> {
    let unset = MeshPart { first: u32::MAX, bounds: Aabb::EMPTY, volume: 0.0 };
    let mut parts = vec![unset; components.count as usize];
    for (t, &component) in components.of.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let part = &mut parts[component as usize];
        part.first = part.first.min(t as u32);
        // From a corner of the part, so that one far from the origin keeps its digits.
        let origin: DVec3 = surface.corners(part.first)[0];
        let corners = surface.corners(t as u32);
        part.bounds = part.bounds.union(Aabb::of(corners));
        let [a, b, c] = corners.map(|corner| corner - origin);
        part.volume += a.cross(b).dot(c) / 6.0;
    }
    Ok(parts)
}
