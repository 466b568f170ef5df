//! Typed numbers of vertices, half-edges and faces: one cannot be taken for another.

/// Stands for "none" inside the arrays; never handed out.
const NONE: u32 = u32::MAX;

macro_rules! handle {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(u32);

        impl $name {
            pub(in crate::mesh) const NONE: Self = Self(NONE);

            /// Number `index`, which must be below `u32::MAX`.
            #[inline]
            pub fn new(index: usize) -> Self {
                debug_assert!(index < NONE as usize, "too many elements for 32-bit handles");
                Self(index as u32)
            }

            /// Its number, from 0.
            #[inline]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

handle! {
    /// A vertex.
    VertexId
}
handle! {
    /// A half-edge: an edge in one of its two directions.
    HalfEdgeId
}
handle! {
    /// A face.
    FaceId
}
