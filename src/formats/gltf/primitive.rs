//! Meshes as lists of primitives, and the triangles of these.

use super::accessor::{Accessor, Accessors, Component};
use super::buffers::{compressed_by_draco, has_extension};
use super::part::{List, LocatedValue};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::formats::ReadError;
use crate::par;
use rustc_hash::FxHashMap;

/// Vertices that primitives share: numbers of accessors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct VertexSet {
    pub(super) positions: usize,
    pub(super) colors: Option<usize>,
    pub(super) points: Option<usize>,
}

/// What a primitive is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PrimitiveMode {
    Triangles,
    Strip,
    Fan,
}

/// Triangles of one material.
#[derive(Debug)]
pub(super) struct Primitive {
    pub(super) mode: PrimitiveMode,
    /// Which of the vertex sets of the mesh.
    pub(super) set: usize,
    /// Number of an accessor; `None`: the vertices in their order.
    pub(super) indices: Option<usize>,
    pub(super) material: Option<u32>,
    /// The most triangles that it has.
    pub(super) triangles: u64,
}

/// A mesh, without the primitives that have no triangle.
#[derive(Debug, Default)]
pub(super) struct GltfMesh {
    /// Each with its number of vertices as the file claims it.
    pub(super) sets: Vec<(VertexSet, u64)>,
    pub(super) primitives: Vec<Primitive>,
    /// Primitives of points or lines.
    pub(super) points_and_lines: u64,
    pub(super) morph_targets: u64,
    /// Sets of texture coordinates and of colours beyond those that are read, and attributes of the maker's own.
    pub(super) further_attributes: u64,
}

impl GltfMesh {
    /// Reads the mesh `part`. `uv_set_of` is the set of texture coordinates that each material takes.
    pub(super) fn read(
        part: &LocatedValue<'_>,
        accessors: &Accessors<'_>,
        materials: &List<'_>,
        uv_set_of: &[u64],
    ) -> Result<Self, ReadError> {
        let mut mesh = Self::default();
        let mut numbers = FxHashMap::default();
        for part in part.list("primitives")?.items() {
            mesh.add(&part, accessors, materials, uv_set_of, &mut numbers)?;
        }
        Ok(mesh)
    }

    fn add(
        &mut self,
        part: &LocatedValue<'_>,
        accessors: &Accessors<'_>,
        materials: &List<'_>,
        uv_set_of: &[u64],
        numbers: &mut FxHashMap<VertexSet, usize>,
    ) -> Result<(), ReadError> {
        let mode = match part.count("mode")? {
            None | Some(4) => PrimitiveMode::Triangles,
            Some(5) => PrimitiveMode::Strip,
            Some(6) => PrimitiveMode::Fan,
            Some(0..=3) => {
                self.points_and_lines += 1;
                return Ok(());
            }
            Some(_) => return Err(part.need("mode")?.wrong("a mode from 0 to 6")),
        };
        let Some(attributes) = part.get("attributes") else { return Ok(()) };
        let list = &accessors.list;
        // Without positions there is nothing to draw.
        let Some(positions) = attributes.index("POSITION", list)? else { return Ok(()) };
        let is_stored =
            |i: usize| list.item(i).get("bufferView").is_some() || list.item(i).get("sparse").is_some();
        if has_extension(part, "KHR_draco_mesh_compression") && !is_stored(positions) {
            return Err(compressed_by_draco());
        }
        let material = part.index("material", materials)?.map(|material| material as u32);
        let uv_set = material.map_or(0, |material| uv_set_of[material as usize]);
        let set = VertexSet {
            positions,
            colors: attributes.index("COLOR_0", list)?,
            points: attributes.index(&format!("TEXCOORD_{uv_set}"), list)?,
        };
        let indices = part.index("indices", list)?;
        let vertices = accessors.claimed(positions)?;
        let corners = indices.map_or(Ok(vertices), |indices| accessors.claimed(indices))?;
        let triangles =
            if mode == PrimitiveMode::Triangles { corners / 3 } else { corners.saturating_sub(2) };
        self.morph_targets += part.list("targets")?.len() as u64;
        let is_further = |name: &&String| {
            name.starts_with('_')
                || (name.starts_with("TEXCOORD_") || name.starts_with("COLOR_")) && {
                    **name != format!("TEXCOORD_{uv_set}") && *name != "COLOR_0"
                }
        };
        let names = attributes.value.as_object().map(|members| members.keys().filter(is_further).count());
        self.further_attributes += names.unwrap_or(0) as u64;
        if triangles == 0 {
            return Ok(());
        }
        let set = *numbers.entry(set).or_insert_with(|| {
            self.sets.push((set, vertices));
            self.sets.len() - 1
        });
        self.primitives.push(Primitive { mode, set, indices, material, triangles });
        Ok(())
    }
}

impl Primitive {
    /// Appends the triangles of the primitive, whose vertices are `vertices` from `first` on; `is_mirrored`: turned around.
    /// A corner without a vertex gets the number [`u32::MAX`].
    pub(super) fn triangles_into(
        &self,
        triangles: &mut Vec<[u32; 3]>,
        indices: Option<&Accessor<'_>>,
        first: u32,
        vertices: u32,
        is_mirrored: bool,
        budget: &Budget,
    ) -> Result<(), Stopped> {
        let corner = |i: usize| {
            let v = indices.map_or(i as u32, |indices| indices.integer(i));
            if v < vertices { first + v } else { u32::MAX }
        };
        let turned = |[a, b, c]: [u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
        let count = self.triangles as usize;
        if self.mode == PrimitiveMode::Triangles {
            let begin = triangles.len();
            triangles.resize(begin + count, [0; 3]);
            budget.check()?;
            par::for_each_chunk_mut(&mut triangles[begin..], 16 * CHECK_EVERY, |from, part| {
                for (t, triangle) in (from..).zip(part) {
                    *triangle = turned([corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)]);
                }
            });
            return Ok(());
        }
        for t in 0..count {
            if t.is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            let corners = match self.mode {
                PrimitiveMode::Fan => [t + 1, t + 2, 0],
                _ => [t, t + 1 + t % 2, t + 2 - t % 2],
            };
            let [a, b, c] = corners.map(corner);
            // A strip repeats a vertex to turn a corner; that triangle is not meant.
            let is_meant = a != b && b != c && c != a || [a, b, c].contains(&u32::MAX);
            if is_meant {
                triangles.push(turned([a, b, c]));
            }
        }
        Ok(())
    }
}

/// Checks that indices are whole numbers without a sign.
pub(super) fn check_indices(part: &LocatedValue<'_>, indices: &Accessor<'_>) -> Result<(), ReadError> {
    match indices.component {
        Component::U8 | Component::U16 | Component::U32 => Ok(()),
        _ => Err(part.need("componentType")?.wrong("5121, 5123 or 5125 for indices")),
    }
}
