//! Which faces are near a place.

use super::contact::{do_meet, grown};
use super::solid::Solid;
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::polyhedron::FaceId;
use crate::spatial::Bvh;
use std::sync::Arc;

/// The box of a face, a little larger than rounding could make it too small.
pub(super) fn face_box(solid: &Solid, f: FaceId) -> Aabb {
    let topology = &solid.topology;
    let corners = topology.loop_of(topology.loops(f).exterior).map(|h| solid.point(topology.origin(h)).near);
    grown(Aabb::of(corners))
}

fn build(solid: &Solid, budget: &Budget) -> Result<Arc<Bvh>, Stopped> {
    let boxes = solid.topology.faces().map(|f| face_box(solid, f));
    let corners: Vec<DVec3> = boxes.flat_map(|b| [b.min, b.max]).collect();
    // A triangle has the box of its corners: two opposite ones of the face's box, one of them twice.
    let triangles: Vec<[u32; 3]> = (0..corners.len() as u32 / 2).map(|f| [2 * f, 2 * f + 1, 2 * f]).collect();
    budget.spend(triangles.len() as u64)?;
    Ok(Arc::new(Bvh::build(&corners, &triangles, None, budget)?))
}

/// The tree, built if it is not there: before a solid is copied, so that the copies share it.
pub(super) fn tree<'s>(solid: &'s Solid, budget: &Budget) -> Result<&'s Bvh, Stopped> {
    if let Some(tree) = solid.index.tree.get() {
        return Ok(tree);
    }
    let built = build(solid, budget)?;
    Ok(solid.index.tree.get_or_init(|| built))
}

/// The faces whose boxes meet `query`, ascending.
pub(super) fn faces_near(solid: &Solid, query: &Aabb, budget: &Budget) -> Result<Vec<FaceId>, Stopped> {
    let tree = tree(solid, budget)?;
    let mut near = solid.index.stale.clone();
    tree.visit_box(*query, budget, |f| near.push(FaceId::new(f as usize)))?;
    near.sort_unstable();
    near.dedup();
    near.retain(|&f| do_meet(&face_box(solid, f), query));
    Ok(near)
}
