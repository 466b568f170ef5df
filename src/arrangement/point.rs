//! Points by name: what a point is the intersection of, where that is about, and where it is exactly.

use super::ball::Ball;
use super::exact::Homogeneous;
use std::sync::OnceLock;

/// What a point is. Vertices and triangles are those of the [`ClusterKernel`](super::kernel::ClusterKernel).
/// Edges name their smaller vertex first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Definition {
    /// A vertex of the input.
    Vertex(u32),
    /// Where an edge passes through the plane of a triangle.
    EdgePlane {
        /// The edge.
        edge: [u32; 2],
        /// The triangle.
        plane: u32,
    },
    /// Where two edges of one plane cross, seen along an axis along which neither plane nor edges vanish.
    EdgeEdge {
        /// The edges.
        edges: [[u32; 2]; 2],
        /// The coordinates that are seen.
        axes: [u8; 2],
    },
    /// Where the planes of three triangles meet.
    Planes([u32; 3]),
    /// A corner of the triangle around everything in a plane, which has no place in space.
    Far(u8),
}

/// A point with what is known of its place.
#[derive(Debug, Clone)]
pub(super) struct ArrangementPoint {
    pub(super) definition: Definition,
    /// The coordinates from the origin of the kernel, in the unit of the file.
    pub(super) near: [Ball; 3],
    /// The coordinates in the integers of the kernel, once they are asked for.
    pub(super) exact: OnceLock<Box<Homogeneous>>,
}

impl ArrangementPoint {
    /// Gives back the memory of the coordinates in integers, which are found again when they are asked for.
    pub(super) fn forget_integers(&mut self) {
        self.exact = OnceLock::new();
    }
}

impl Definition {
    /// True when the point lies on the line of `edge` by its name.
    fn is_on_edge(&self, edge: [u32; 2]) -> bool {
        match self {
            Self::Vertex(v) => edge.contains(v),
            Self::EdgePlane { edge: own, .. } => *own == edge,
            Self::EdgeEdge { edges, .. } => edges.contains(&edge),
            Self::Planes(_) | Self::Far(_) => false,
        }
    }

    /// The edges on whose lines the point lies by its name.
    fn edges(&self) -> impl Iterator<Item = [u32; 2]> {
        let edges = match self {
            Self::EdgePlane { edge, .. } => [Some(*edge), None],
            Self::EdgeEdge { edges: [a, b], .. } => [Some(*a), Some(*b)],
            _ => [None, None],
        };
        edges.into_iter().flatten()
    }

    fn is_on_plane(&self, plane: u32) -> bool {
        match self {
            Self::EdgePlane { plane: own, .. } => *own == plane,
            Self::Planes(planes) => planes.contains(&plane),
            _ => false,
        }
    }

    /// True when three points lie on the line of one edge by their names.
    pub(super) fn are_on_one_edge(points: [&Self; 3]) -> bool {
        let on_one_edge = |p: &Self| p.edges().any(|edge| points.iter().all(|q| q.is_on_edge(edge)));
        points.iter().any(|p| on_one_edge(p))
    }

    /// True when three points in a plane lie on one line by their names; `crosses` tells whether the plane of a triangle is another
    /// one. Triangles in one plane that do not overlap have planes of different names.
    pub(super) fn are_collinear(points: [&Self; 3], crosses: impl Fn(u32) -> bool) -> bool {
        let on_another_plane =
            |other: u32| points.iter().all(|point| point.is_on_plane(other)) && crosses(other);
        let on_one_line = |p: &Self| match p {
            Self::EdgePlane { plane: own, .. } => on_another_plane(*own),
            Self::Planes(planes) => planes.iter().any(|&other| on_another_plane(other)),
            _ => false,
        };
        Self::are_on_one_edge(points) || on_one_line(points[0])
    }
}
