//! glTF input: the meshes of a scene as one soup.

use super::accessor::{Accessor, Accessors, Component};
use super::buffers::Buffers;
use super::container::ContainerContent;
use super::materials::FileMaterials;
use super::part::LocatedValue;
use super::primitive::{GltfMesh, VertexSet, check_indices};
use super::scene::{PlacedMesh, placed_meshes};
use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::formats::faces::Faces;
use crate::formats::{Encoding, Precision, ReadError, ReadErrorKind, ReadOptions};
use crate::geom::DVec3;
use crate::mesh::{
    Color, Materials, NAME_BYTES_MAX, NO_MATERIAL, NO_POINT, OBJECTS_MAX, ObjectName, Objects, Soup, Texture,
};
use crate::par;
use crate::spatial::{Coincident, coincident_f64};
use glam::DAffine3;
use std::sync::Arc;

/// Reads the meshes of the scene that the file shows, each where its nodes put it. Bit-equal positions become one vertex;
/// colours and texture coordinates stay with the corners they belong to.
pub(in crate::formats) fn read(
    bytes: &[u8],
    encoding: Encoding,
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Soup, ReadError> {
    let content = if encoding == Encoding::Glb {
        ContainerContent::of_glb(bytes)?
    } else {
        ContainerContent::of_text(bytes)
    };
    let (tree, _charge) = content.tree(budget)?;
    let root = LocatedValue::root(&tree);
    check_version(&root)?;
    let buffers = Buffers::of(&root, content.binary, budget)?;
    let materials = FileMaterials::read(&root, &buffers, budget)?;
    let accessors = Accessors { list: root.list("accessors")?, buffers, file_bytes: bytes.len(), budget };
    let (placed, nodes_left_out) = placed_meshes(&root, budget)?;
    let meshes = read_meshes(&root, &placed, &accessors, &materials)?;
    let (mut raw, _charges) = Raw::with_room(&placed, &meshes, options, budget)?;
    let (names, _charge) = object_names(&root, &placed, budget)?.unzip();
    for (object, place) in placed.iter().enumerate() {
        raw.add(&meshes[place.mesh], place.transform.as_ref(), &accessors, options.precision)?;
        if names.is_some() {
            raw.objects.resize(raw.triangles.len(), object as u32);
        }
    }
    let mut left_out = left_out(&root, &placed, &meshes)?;
    if placed.len() > OBJECTS_MAX {
        left_out.push(("objects", placed.len() as u64));
    }
    left_out.push(("meshes_outside_of_the_scene", nodes_left_out));
    left_out.push(("textures", materials.left_out));
    left_out.push(("compressed_views", accessors.buffers.compressed_views()));
    let objects = std::mem::take(&mut raw.objects);
    let mut soup = raw.into_soup(materials, &mut left_out, options, budget)?;
    if let Some(names) = names {
        soup.objects = Objects { names, of_face: objects };
    }
    soup.left_out = left_out.into_iter().filter(|&(_, count)| count > 0).collect();
    Ok(soup)
}

/// The names of the nodes that place a mesh and of their meshes; `None` where one node without any name does, or too many.
fn object_names<'b>(
    root: &LocatedValue<'_>,
    placed: &[PlacedMesh<'_>],
    budget: &'b Budget,
) -> Result<Option<(Vec<ObjectName>, Charge<'b>)>, ReadError> {
    if placed.len() > OBJECTS_MAX {
        return Ok(None);
    }
    let list = root.list("meshes")?;
    let usable = |name: &str| if name.len() > NAME_BYTES_MAX { Vec::new() } else { name.as_bytes().to_vec() };
    let of_mesh = |place: &PlacedMesh<'_>| list.item(place.mesh).text("name").unwrap_or_default();
    let kept = |name: &str| if name.len() > NAME_BYTES_MAX { 0 } else { name.len() };
    let bytes = |place: &PlacedMesh<'_>| size_of::<ObjectName>() + kept(place.name) + kept(of_mesh(place));
    let charge = budget.charge(placed.iter().map(bytes).sum::<usize>() as u64)?;
    let name =
        |place: &PlacedMesh<'_>| ObjectName { object: usable(place.name), group: usable(of_mesh(place)) };
    let names: Vec<ObjectName> = placed.iter().map(name).collect();
    let has_names = names.len() > 1 || names.iter().any(|name| *name != ObjectName::default());
    Ok(has_names.then_some((names, charge)))
}

/// Extensions that a file may require: those that do not concern the shape, and those that are read or refused where a mesh
/// uses them.
const KNOWN: &[&str] = &[
    "KHR_mesh_quantization",
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",
    "KHR_animation_pointer",
    "KHR_texture_transform",
    "KHR_texture_basisu",
    "KHR_xmp_json_ld",
    "EXT_texture_webp",
    "EXT_texture_avif",
];

fn check_version(root: &LocatedValue<'_>) -> Result<(), ReadError> {
    let asset = root.need("asset")?;
    let version = asset.text("version").unwrap_or_default();
    if !version.starts_with("2.") {
        return Err(asset.wrong_with(&format!("version `{version}`"), "glTF 2.0"));
    }
    for extension in root.list("extensionsRequired")?.items() {
        let name = extension.value.as_str().unwrap_or_default();
        if !KNOWN.contains(&name) && !name.starts_with("KHR_materials_") {
            let found = format!("the required extension `{name}`");
            return Err(extension.wrong_with(&found, "a file that can be read without it"));
        }
    }
    Ok(())
}

/// The meshes that are placed, by number; the others are empty.
fn read_meshes(
    root: &LocatedValue<'_>,
    placed: &[PlacedMesh<'_>],
    accessors: &Accessors<'_>,
    materials: &FileMaterials<'_>,
) -> Result<Vec<GltfMesh>, ReadError> {
    let list = root.list("meshes")?;
    let material_list = root.list("materials")?;
    let mut meshes: Vec<Option<GltfMesh>> = (0..list.len()).map(|_| None).collect();
    for place in placed.iter().map(|place| place.mesh) {
        accessors.budget.check()?;
        if meshes[place].is_none() {
            meshes[place] =
                Some(GltfMesh::read(&list.item(place), accessors, &material_list, &materials.uv_set_of)?);
        }
    }
    Ok(meshes.into_iter().map(Option::unwrap_or_default).collect())
}

/// What the file has that the soup does not hold.
fn left_out(
    root: &LocatedValue<'_>,
    placed: &[PlacedMesh<'_>],
    meshes: &[GltfMesh],
) -> Result<Vec<(&'static str, u64)>, ReadError> {
    let count = |name| root.list(name).map(|list| list.len() as u64);
    let lights = root.get("extensions").and_then(|all| all.get("KHR_lights_punctual"));
    let lights = lights.map_or(Ok(0), |lights| lights.list("lights").map(|list| list.len() as u64))?;
    let mut is_placed = vec![false; meshes.len()];
    placed.iter().for_each(|place| is_placed[place.mesh] = true);
    let of = |f: fn(&GltfMesh) -> u64| {
        meshes.iter().zip(&is_placed).filter(|(_, is_placed)| **is_placed).map(|(m, _)| f(m)).sum::<u64>()
    };
    Ok(vec![
        ("animations", count("animations")?),
        ("skins", count("skins")?),
        ("morph_targets", of(|mesh| mesh.morph_targets)),
        ("cameras", count("cameras")?),
        ("lights", lights),
        ("points_and_lines", of(|mesh| mesh.points_and_lines)),
        ("further_attributes", of(|mesh| mesh.further_attributes)),
    ])
}

/// Vertices and triangles as the primitives list them.
#[derive(Default)]
struct Raw {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// Of each vertex; empty when none has one.
    colors: Vec<Option<Color>>,
    /// Texture coordinates of each vertex, [`ABSENT`] where it has none; empty when none has some.
    points: Vec<[f64; 2]>,
    /// The material of each triangle.
    materials: Vec<u32>,
    /// The object of each triangle; empty where the file has no names.
    objects: Vec<u32>,
}

const ABSENT: [f64; 2] = [f64::NAN; 2];

impl Raw {
    /// Room for everything that is placed, within the limits.
    fn with_room<'b>(
        placed: &[PlacedMesh<'_>],
        meshes: &[GltfMesh],
        options: &ReadOptions,
        budget: &'b Budget,
    ) -> Result<(Self, Vec<Charge<'b>>), ReadError> {
        let (mut vertices, mut triangles) = (0u64, 0u64);
        let sum = |counts: &mut dyn Iterator<Item = u64>| counts.fold(0u64, u64::saturating_add);
        let of_meshes: Vec<[u64; 2]> = meshes
            .iter()
            .map(|mesh| {
                let vertices = sum(&mut mesh.sets.iter().map(|set| set.1));
                [vertices, sum(&mut mesh.primitives.iter().map(|primitive| primitive.triangles))]
            })
            .collect();
        for place in placed {
            let [more_vertices, more_triangles] = of_meshes[place.mesh];
            vertices = vertices.saturating_add(more_vertices);
            triangles = triangles.saturating_add(more_triangles);
        }
        options.limits.check_vertices(vertices)?;
        options.limits.check_triangles(triangles)?;
        let has =
            |is: fn(&VertexSet) -> bool| meshes.iter().flat_map(|mesh| &mesh.sets).any(|(set, _)| is(set));
        let mut charges = Vec::new();
        let mut raw = Self::default();
        // Numbers of vertices are below u32::MAX, which stands for none.
        let (vertices, triangles) = (vertices.min(u64::from(u32::MAX - 1)) as usize, triangles as usize);
        charges.push(budget.reserve(&mut raw.positions, vertices)?);
        charges.push(budget.reserve(&mut raw.triangles, triangles)?);
        charges.push(budget.reserve(&mut raw.materials, triangles)?);
        charges.push(budget.reserve(&mut raw.objects, triangles)?);
        if has(|set| set.colors.is_some()) {
            charges.push(budget.reserve(&mut raw.colors, vertices)?);
        }
        if has(|set| set.points.is_some()) {
            charges.push(budget.reserve(&mut raw.points, vertices)?);
            charges.push(budget.charge(12 * triangles as u64)?);
        }
        Ok((raw, charges))
    }

    /// Adds `mesh` where `transform` puts it.
    fn add(
        &mut self,
        mesh: &GltfMesh,
        transform: Option<&DAffine3>,
        accessors: &Accessors<'_>,
        precision: Precision,
    ) -> Result<(), ReadError> {
        let budget = accessors.budget;
        // The sets of vertices come when the first primitive uses them.
        let mut first_of: Vec<Option<u32>> = vec![None; mesh.sets.len()];
        let is_mirrored = transform.is_some_and(|transform| transform.matrix3.determinant() < 0.0);
        for primitive in &mesh.primitives {
            let (set, count) = mesh.sets[primitive.set];
            let first = match first_of[primitive.set] {
                Some(first) => first,
                None => self.add_vertices(set, transform, accessors, precision)?,
            };
            first_of[primitive.set] = Some(first);
            let indices = primitive.indices.map(|index| -> Result<_, ReadError> {
                let indices = accessors.get(index, &[1])?;
                check_indices(&accessors.list.item(index), &indices)?;
                Ok(indices)
            });
            let indices = indices.transpose()?;
            primitive.triangles_into(
                &mut self.triangles,
                indices.as_ref(),
                first,
                count as u32,
                is_mirrored,
                budget,
            )?;
            self.materials.resize(self.triangles.len(), primitive.material.unwrap_or(NO_MATERIAL));
        }
        Ok(())
    }

    /// Adds the vertices of `set`; gives the number of the first.
    fn add_vertices(
        &mut self,
        set: VertexSet,
        transform: Option<&DAffine3>,
        accessors: &Accessors<'_>,
        precision: Precision,
    ) -> Result<u32, ReadError> {
        let positions = accessors.get(set.positions, &[3])?;
        let first = self.positions.len();
        let end = first + positions.len;
        if end >= u32::MAX as usize {
            let kind = ReadErrorKind::TooLarge {
                what: "vertices",
                limit_name: "vertices_max",
                limit: u64::from(u32::MAX) - 1,
                actual: end as u64,
            };
            return Err(ReadError { kind, place: crate::formats::Place::Whole, expected: String::new() });
        }
        accessors.budget.check()?;
        self.positions.resize(end, DVec3::ZERO);
        par::for_each_chunk_mut(&mut self.positions[first..], 4 * CHECK_EVERY, |begin, part| {
            for (i, position) in (begin..).zip(part) {
                let at = place(DVec3::from_array(positions.numbers(i)), transform);
                *position = match precision {
                    Precision::F64 => at,
                    Precision::F32 => at.as_vec3().as_dvec3(),
                };
            }
        });
        if let Some(colors) = set.colors {
            let colors = accessors.get(colors, &[3, 4])?;
            check_count(&colors, positions.len)?;
            self.colors.resize(first, None);
            self.colors.extend((0..positions.len).map(|i| Some(color(&colors, i))));
        } else if self.colors.capacity() > 0 {
            self.colors.resize(end, None);
        }
        if let Some(points) = set.points {
            let points = accessors.get(points, &[2])?;
            check_count(&points, positions.len)?;
            self.points.resize(first, ABSENT);
            let across_and_up = |[u, v]: [f64; 2]| [u, 1.0 - v];
            self.points.extend((0..positions.len).map(|i| across_and_up(points.numbers(i))));
        } else if self.points.capacity() > 0 {
            self.points.resize(end, ABSENT);
        }
        Ok(first as u32)
    }

    /// The soup of these triangles, with bit-equal positions as one vertex.
    fn into_soup(
        mut self,
        materials: FileMaterials<'_>,
        left_out: &mut Vec<(&'static str, u64)>,
        options: &ReadOptions,
        budget: &Budget,
    ) -> Result<Soup, ReadError> {
        if self.triangles.is_empty() {
            return Err(ReadError::empty("a mesh with triangles in the scene"));
        }
        let texture = self.texture(budget)?;
        let _charge = budget.charge(8 * self.positions.len() as u64)?;
        let groups = coincident_f64(&self.positions, budget)?;
        let colors = self.weld_colors(&groups, budget)?;
        if groups.first.len() < self.positions.len() {
            let (mut positions, _charge) = budget.vec::<DVec3>(groups.first.len())?;
            positions.extend(groups.first.iter().map(|&v| self.positions[v as usize]));
            self.positions = positions;
            let group = |v: u32| groups.group.get(v as usize).copied().unwrap_or(u32::MAX);
            par::for_each_chunk_mut(&mut self.triangles, 16 * CHECK_EVERY, |_, part| {
                part.iter_mut().for_each(|corners| *corners = corners.map(group));
            });
        }
        drop(groups);
        let faces = Faces::of_triangles(std::mem::take(&mut self.triangles));
        let mut soup = faces.into_soup(std::mem::take(&mut self.positions), &options.limits, budget)?;
        soup.is_welded_by_format = true;
        soup.texture = of_triangles(texture, &soup);
        let mut descriptions = materials.descriptions;
        match colors {
            ColorSource::None => {}
            ColorSource::OfVertices { colors, lost } => {
                soup.vertex_colors = colors;
                left_out.push(("colors_at_seams", lost));
            }
            ColorSource::OfFaces(colors) => {
                soup.face_colors = colors;
                // These are beside the colours of the materials.
                descriptions.colors.iter_mut().for_each(|color| *color = None);
            }
        }
        if self.materials.iter().any(|&material| material != NO_MATERIAL) {
            let color = |&m: &u32| descriptions.colors.get(m as usize).copied().flatten();
            if soup.face_colors.is_empty() && self.materials.iter().any(|m| color(m).is_some()) {
                soup.face_colors = self.materials.iter().map(color).collect();
            }
            soup.materials = Materials {
                libraries: Vec::new(),
                names: materials.names,
                of_face: self.materials,
                descriptions: Some(Arc::new(descriptions)),
            };
        }
        Ok(soup)
    }

    /// The texture of all triangles.
    fn texture(&mut self, budget: &Budget) -> Result<Texture, Stopped> {
        if self.points.is_empty() {
            return Ok(Texture::default());
        }
        let points = std::mem::take(&mut self.points);
        let is_there = |&v: &u32| points.get(v as usize).is_some_and(|p| p.iter().all(|c| c.is_finite()));
        let mut corners = Vec::with_capacity(self.triangles.len());
        for block in self.triangles.chunks(CHECK_EVERY) {
            budget.check()?;
            corners.extend(block.iter().map(|t| if t.iter().all(is_there) { *t } else { [NO_POINT; 3] }));
        }
        Ok(Texture { points, corners }.without_unused_points())
    }

    /// The colours of the welded vertices, or of the faces, if positions have several colours and each face has one.
    fn weld_colors(&mut self, groups: &Coincident, budget: &Budget) -> Result<ColorSource, Stopped> {
        let colors = std::mem::take(&mut self.colors);
        if colors.iter().all(Option::is_none) {
            return Ok(ColorSource::None);
        }
        let mut lost = 0;
        for (begin, block) in (0..).step_by(CHECK_EVERY).zip(colors.chunks(CHECK_EVERY)) {
            budget.check()?;
            let differs = |(v, color): (usize, &Option<Color>)| {
                *color != colors[groups.first[groups.group[v] as usize] as usize]
            };
            lost += (begin..).zip(block).filter(|&at| differs(at)).count() as u64;
        }
        if lost > 0 {
            let color = |v: u32| colors.get(v as usize).copied().flatten();
            let is_of_one = |t: &[u32; 3]| color(t[0]) == color(t[1]) && color(t[0]) == color(t[2]);
            budget.check()?;
            if self.triangles.iter().all(is_of_one) {
                return Ok(ColorSource::OfFaces(self.triangles.iter().map(|t| color(t[0])).collect()));
            }
        }
        Ok(ColorSource::OfVertices {
            colors: groups.first.iter().map(|&v| colors[v as usize]).collect(),
            lost,
        })
    }
}

/// What has the colours of a file.
enum ColorSource {
    None,
    /// `lost`: vertices whose colour differs from that of another one at their place.
    OfVertices {
        colors: Vec<Option<Color>>,
        lost: u64,
    },
    OfFaces(Vec<Option<Color>>),
}

/// The texture of the triangles that became some of the soup.
fn of_triangles(texture: Texture, soup: &Soup) -> Texture {
    if texture.is_empty() || soup.triangle_face.is_empty() {
        return texture;
    }
    let corners = soup.triangle_face.iter().map(|&face| texture.corners[face as usize]).collect();
    Texture { corners, ..texture }.without_unused_points()
}

/// Where `transform` puts `p`. Products and sums in an order that is the same on all machines.
#[inline]
fn place(p: DVec3, transform: Option<&DAffine3>) -> DVec3 {
    let Some(t) = transform else { return p };
    let (x, y, z) = (t.matrix3.x_axis, t.matrix3.y_axis, t.matrix3.z_axis);
    let row = |k: usize| x[k] * p.x + y[k] * p.y + z[k] * p.z + t.translation[k];
    DVec3::new(row(0), row(1), row(2))
}

fn color(colors: &Accessor<'_>, i: usize) -> Color {
    let largest = match colors.component {
        Component::U8 => 255.0,
        Component::U16 => 65535.0,
        _ => 1.0,
    };
    // Whole numbers mean shares, whether the file says so or not.
    let scale = if colors.is_normalized { 1.0 } else { largest };
    let channel = |k: usize| (colors.number(i, k) / scale) as f32;
    Color::Linear([channel(0), channel(1), channel(2)], (colors.components == 4).then(|| channel(3)))
}

fn check_count(attribute: &Accessor<'_>, vertices: usize) -> Result<(), ReadError> {
    if attribute.len == vertices {
        return Ok(());
    }
    let found = format!("{} elements at {}", attribute.len, attribute.pointer);
    let expected = format!("{vertices}, as many as the primitive has positions");
    Err(ReadError::unparseable(crate::formats::Place::Whole, found, expected))
}
