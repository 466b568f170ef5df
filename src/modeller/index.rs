//! Which faces are near a place: the boxes of all faces in a tree, and beside it the faces that moved since it was built.

use super::contact::{do_meet, grown};
use super::solid::Solid;
use crate::budget::{Budget, Stopped};
use crate::geom::{Aabb, DVec3};
use crate::mesh::polyhedron::FaceId;
use crate::spatial::Bvh;
use std::sync::{Arc, OnceLock};

/// The tree is built anew when more faces than this, and more than one of sixteen, moved.
const STALE_MAX: usize = 64;

/// The tree, built when it is first needed.
#[derive(Debug, Clone, Default)]
pub(super) struct Index {
    tree: OnceLock<Arc<Bvh>>,
    /// Faces whose boxes in the tree may be wrong, ascending.
    stale: Vec<FaceId>,
}

impl Index {
    /// Notes that `faces` moved.
    pub(super) fn touch(&mut self, faces: &[FaceId], face_count: usize) {
        self.stale.extend(faces);
        self.stale.sort_unstable();
        self.stale.dedup();
        if self.stale.len() > STALE_MAX.max(face_count / 16) {
            *self = Self::default();
        }
    }
}

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
