//! The boxes of all faces in a tree, and beside it the faces that moved since it was built.

use crate::mesh::polyhedron::FaceId;
use crate::spatial::Bvh;
use std::sync::{Arc, OnceLock};

/// The tree is built anew when more faces than this, and more than one of sixteen, moved.
const STALE_MAX: usize = 64;

/// The tree, built when it is first needed.
#[derive(Debug, Clone, Default)]
pub(super) struct Index {
    pub(super) tree: OnceLock<Arc<Bvh>>,
    /// Faces whose boxes in the tree may be wrong, ascending.
    pub(super) stale: Vec<FaceId>,
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
