//! What goes in and what comes out.

use super::layout::InputNumbers;
use super::report::TargetReport;
use super::surface::{CollapseSurface, NEW};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::Color;
use crate::mesh::corner_table::NONE;
use crate::mesh::half_edge::BuildError;
use crate::par;

/// A manifold mesh to simplify.
#[derive(Debug, Clone, Copy)]
pub struct SimplifyInput<'a> {
    /// Vertex positions.
    pub positions: &'a [DVec3],
    /// Vertex ids of each triangle's corners; a coherently oriented manifold with or without boundary. Positions that
    /// it uses are finite.
    pub triangles: &'a [[u32; 3]],
    /// A number for each triangle: between triangles with different numbers (face colours, say) the border is kept as
    /// borders are. Empty when all are one.
    pub face_groups: &'a [u32],
    /// Colour of each vertex; empty when there are none.
    pub vertex_colors: &'a [Option<Color>],
    /// Texture coordinates of each triangle's corners, or [`NO_TEXTURE`](super::NO_TEXTURE) at all three; empty when there are none. Edges
    /// whose triangles differ in them are kept as borders are.
    pub texture: &'a [[[f64; 2]; 3]],
}

impl<'a> SimplifyInput<'a> {
    /// Without groups, colours and texture.
    pub fn new(positions: &'a [DVec3], triangles: &'a [[u32; 3]]) -> Self {
        Self { positions, triangles, face_groups: &[], vertex_colors: &[], texture: &[] }
    }
}

impl SimplifyInput<'_> {
    /// True when lines may part it into regions.
    pub(super) fn has_regions(&self) -> bool {
        !self.face_groups.is_empty() || !self.texture.is_empty()
    }
}

/// A simplified mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Simplified {
    /// Vertex positions, in the unit of the input. Vertices that did not move have the input's very numbers.
    pub positions: Vec<DVec3>,
    /// The vertex of the input at each position, or [`NEW`].
    pub vertex_origin: Vec<u32>,
    /// Colour of each vertex; empty when the input has none.
    pub vertex_colors: Vec<Option<Color>>,
    /// For each vertex the least cost of the collapses of its edges, infinite where it must stay; empty unless it was
    /// [asked for](super::SimplifyOptions::priorities).
    pub priorities: Vec<f64>,
    /// Vertex ids of each triangle's corners.
    pub triangles: Vec<[u32; 3]>,
    /// The triangle of the input that each triangle was.
    pub triangle_origin: Vec<u32>,
    /// Texture coordinates of each triangle's corners; empty when the input has none.
    pub texture: Vec<[[f64; 2]; 3]>,
    /// How it came to be.
    pub report: TargetReport,
}

/// Why there is no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SimplifyError {
    /// The input is no manifold; cut it first.
    #[error("not a manifold: {0}")]
    NotManifold(BuildError),
    /// The budget stopped the run.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl From<BuildError> for SimplifyError {
    fn from(error: BuildError) -> Self {
        match error {
            BuildError::Stopped(stopped) => Self::Stopped(stopped),
            other => Self::NotManifold(other),
        }
    }
}

impl Simplified {
    /// The state of `surface`, with the vertices that it uses in the order of the input and so the triangles. `colors`
    /// and `priorities` are those of all its vertices, or none.
    pub(super) fn snapshot<S: Copy + Default>(
        surface: &CollapseSurface<S>,
        layout: &InputNumbers,
        input: &SimplifyInput<'_>,
        colors: &[Option<Color>],
        priorities: &[f64],
        report: TargetReport,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let mut renumbered = vec![NONE; surface.vertices.len()];
        let mut result = Self {
            positions: Vec::new(),
            vertex_origin: Vec::new(),
            vertex_colors: Vec::new(),
            priorities: Vec::new(),
            triangles: Vec::with_capacity(surface.table.triangle_count()),
            triangle_origin: Vec::with_capacity(surface.table.triangle_count()),
            texture: Vec::new(),
            report,
        };
        let is_left = |&t: &u32| surface.table.corners(t).is_some();
        for t in in_order_of(&layout.triangles, is_left) {
            if result.triangles.len().is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            if let Some(corners) = surface.table.corners(t) {
                corners.iter().for_each(|&v| renumbered[v as usize] = 0);
                result.triangles.push(corners);
                result.triangle_origin.push(layout.triangles[t as usize]);
                result.texture.extend(surface.wedges.0.get(t as usize));
            }
        }
        for v in in_order_of(&layout.vertices, |&v| renumbered[v as usize] != NONE) {
            let v = v as usize;
            renumbered[v] = result.positions.len() as u32;
            let vertex = &surface.vertices[v];
            result.vertex_origin.push(vertex.origin);
            result.positions.push(match vertex.origin {
                NEW => vertex.position / surface.scale,
                origin => input.positions[origin as usize],
            });
            result.vertex_colors.extend(colors.get(v));
            result.priorities.extend(priorities.get(v));
        }
        for v in result.triangles.as_flattened_mut() {
            *v = renumbered[*v as usize];
        }
        Ok(result)
    }
}

/// The places that `is_meant`, in the order of the `numbers` there.
fn in_order_of(numbers: &[u32], is_meant: impl Fn(&u32) -> bool) -> Vec<u32> {
    let mut places: Vec<u64> = (0..numbers.len() as u32)
        .filter(is_meant)
        .map(|place| u64::from(numbers[place as usize]) << 32 | u64::from(place))
        .collect();
    par::sort_unstable(&mut places);
    places.into_iter().map(|place| place as u32).collect()
}
