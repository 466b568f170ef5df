//! Triangle soups as read from files, and their connectivity.

mod boundary;
mod color;
mod components;
pub mod corner_table;
mod corners;
mod cut;
mod divide;
mod edges;
mod fans;
pub mod half_edge;
mod joined;
mod materials;
mod outlines;
mod parity;
mod polygon_copies;
pub mod polyhedron;
mod soup;
mod stitch;
mod texture;
mod units;

pub use boundary::{Boundary, BoundaryLoop};
pub use color::Color;
pub use components::{Components, UnionFind};
pub use corners::{edge_of, next_corner, prev_corner, triangle_of};
pub use cut::{ChosenEdges, Cut, CutMethod, Marks, cut, cut_singular};
pub use divide::divide;
pub use edges::EdgeGroups;
pub use fans::{Fan, NO_TWIN, fan_heads, singular_vertices, twins};
pub use materials::{Descriptions, Materials, NO_MATERIAL};
pub use outlines::{Outlines, PolygonRuns};
pub use parity::ParityUnionFind;
pub use polygon_copies::{PolygonCopy, polygon_copies};
pub use soup::{FaceFault, FaceFaultReason, Places, Polygons, Segment, Soup};
pub use stitch::{AnyJoin, JoinRule, Stitched, Validity, stitch, stitch_faces};
pub use texture::{NO_POINT, Texture};
pub use units::Units;
