//! The exact arrangement of triangles: all of them divided where they meet, and the winding number on both sides of each piece.
//!
//! What is exact is the input as it is, its f64 coordinates: none is moved. Triangles that meet others beyond common vertices
//! and edges form clusters; those of one plane that overlap share one triangulation, the others have one each. A new point is
//! a name (where an edge passes through a plane, two edges cross, three planes meet) with its place in f64 up to a known error
//! and, where that does not decide, in integers. Triangles that meet no other stay what they are.
//!
//! Then every edge of the pieces is surrounded in the order of the input planes, which gives the cells; one exact ray for each
//! connected part gives a winding number, and the jumps at the pieces all others.
//!
//! After Zhou et al. 2016 (cells and winding numbers), Cherchi et al. 2020, Attene 2020 (points by what they are the intersection
//! of). What is different: planes as carriers of one triangulation for all copies, integers of any size instead of expansions, and
//! points made one by exact comparison in the order of a linear form.

mod ball;
mod build;
mod carrier;
mod cells;
mod cluster;
mod constraints;
mod enclosed;
mod error;
mod exact;
mod extract;
mod intern;
mod kernel;
mod merge;
mod pairs;
mod place;
mod point;
mod radial;
mod ray;
#[cfg(test)]
mod tests;
mod triangulation;
mod walls;
mod welded;

pub use build::{ArrangementOptions, arrange, arrange_enclosed, arrange_in};
pub use error::ArrangementError;
pub use extract::{BoundaryPiece, SolidBoundary};
pub use merge::MergedBoundary;
pub use place::{PlacedBoundary, place};

use crate::geom::DVec3;
use kernel::ClusterKernel;
use num_bigint::BigInt;
use num_rational::Ratio;
use point::ArrangementPoint;
use std::cmp::Ordering;

/// Triangles divided where they meet, with winding numbers. Made by [`arrange`].
///
/// Points are numbered as the positions of the input, then the new ones. No two points that pieces use are at one place.
#[derive(Debug)]
pub struct Arrangement {
    positions: Vec<DVec3>,
    clusters: Vec<Cluster>,
    /// Cluster, and number in it, of each new point.
    new_points: Vec<[u32; 2]>,
    /// The rounded positions of the new points.
    new_positions: Vec<DVec3>,
    /// Corners of each piece.
    pieces: Vec<[u32; 3]>,
    /// An input triangle in the plane of each piece that turns the same way.
    planes: Vec<u32>,
    /// Where the triangles that cover each piece begin in `sources`; one more entry than pieces.
    source_starts: Vec<u32>,
    /// Triangles, with `true` where they turn the other way than the piece.
    sources: Vec<(u32, bool)>,
    /// Number of operands.
    operands: usize,
    /// For each piece, on the side that it turns counter-clockwise seen from and then on the other: the winding number of each
    /// operand.
    windings: Vec<i32>,
}

/// The numbers of a cluster and its points.
#[derive(Debug)]
struct Cluster {
    kernel: ClusterKernel,
    points: Vec<ArrangementPoint>,
    /// The vertex of the input that each vertex of the kernel is, ascending.
    vertices: Vec<u32>,
    /// The triangle of the input that each triangle of the kernel is, ascending.
    triangles: Vec<u32>,
}

impl Arrangement {
    /// Number of points: positions of the input and new ones.
    pub fn point_count(&self) -> usize {
        self.positions.len() + self.new_points.len()
    }

    /// The corners of the pieces, as points.
    pub fn pieces(&self) -> &[[u32; 3]] {
        &self.pieces
    }

    /// The input triangles that cover a piece, with `true` where they turn the other way.
    pub fn sources(&self, piece: usize) -> &[(u32, bool)] {
        &self.sources[self.source_starts[piece] as usize..self.source_starts[piece + 1] as usize]
    }

    /// The winding number of each operand on the side from which a piece turns counter-clockwise, and on the other.
    pub fn windings(&self, piece: usize) -> [&[i32]; 2] {
        let n = self.operands;
        let both = &self.windings[2 * n * piece..2 * n * (piece + 1)];
        [&both[..n], &both[n..]]
    }

    /// The position of a point; that of a new one is rounded.
    pub fn position(&self, point: u32) -> DVec3 {
        match (point as usize).checked_sub(self.positions.len()) {
            None => self.positions[point as usize],
            Some(new) => self.new_positions[new],
        }
    }

    /// The coordinates of a point without rounding.
    pub fn coordinates(&self, point: u32) -> [Ratio<BigInt>; 3] {
        let (place, low) = self.absolute(point);
        let unit = BigInt::from(1) << low.unsigned_abs();
        place.x.map(|x| match low >= 0 {
            true => Ratio::new(x * &unit, place.w.clone()),
            false => Ratio::new(x, &place.w * &unit),
        })
    }

    /// The most bits of a coordinate of the input in a cluster, in units of the last bit that one uses.
    pub fn bits_max(&self) -> u32 {
        self.clusters.iter().map(|cluster| cluster.kernel.bits()).max().unwrap_or(0)
    }

    fn new_point(&self, point: u32) -> Option<(&Cluster, &ArrangementPoint)> {
        let [cluster, point] = *self.new_points.get((point as usize).checked_sub(self.positions.len())?)?;
        let cluster = &self.clusters[cluster as usize];
        Some((cluster, &cluster.points[point as usize]))
    }

    /// A point as integers over an integer, in units of two to a power.
    fn absolute(&self, point: u32) -> (exact::Homogeneous, i32) {
        match self.new_point(point) {
            Some((cluster, point)) => cluster.kernel.absolute(point),
            None => {
                let (x, low) = exact::integers([self.positions[point as usize]]);
                let [x] = x;
                (exact::Homogeneous { x, w: BigInt::from(1) }, low)
            }
        }
    }

    /// How coordinate `axis` of two ends of an edge compares.
    fn compare(&self, axis: usize, a: u32, b: u32) -> Ordering {
        let Some((cluster, _)) = self.new_point(a).or_else(|| self.new_point(b)) else {
            return self.positions[a as usize][axis].total_cmp(&self.positions[b as usize][axis]);
        };
        let own = |point: u32| match self.new_point(point) {
            Some((_, point)) => Some(point),
            None => cluster.vertices.binary_search(&point).ok().map(|v| &cluster.points[v]),
        };
        match own(a).zip(own(b)) {
            Some((a, b)) => cluster.kernel.compare(axis, a, b),
            None => Ordering::Equal,
        }
    }
}
