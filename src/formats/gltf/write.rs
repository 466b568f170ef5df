//! glTF output: a node and a mesh for each object, a primitive for each look of it, all data in one buffer.

use super::looks::{Look, Looks};
use super::references::without_textures;
use super::vertices::Vertices;
use crate::budget::{Budget, CHECK_EVERY, Charge};
use crate::formats::{Encoding, WriteError, float32};
use crate::mesh::Soup;
use base64::Engine as _;
use rustc_hash::FxHashMap;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::ops::Range;

const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const U8: u32 = 5121;
const U32: u32 = 5125;
const F32: u32 = 5126;

/// About what a primitive takes in the document, as values and as text, and what an object takes beside its primitives.
const PER_PRIMITIVE: u64 = 1 << 10;
const PER_OBJECT: u64 = 4 << 10;

/// Most bytes that one byte of a name takes in the document, as a value and as text.
const ESCAPED: usize = 9;

/// The triangles of `soup`, sorted by objects and by what they look like, with float32 positions and the colours, texture coordinates and
/// materials that they have.
pub(in crate::formats) fn write(
    soup: &Soup,
    encoding: Encoding,
    budget: &Budget,
) -> Result<Vec<u8>, WriteError> {
    let looks = Looks::of(soup);
    let _charge = budget.charge((soup.triangles.len() * size_of::<u32>()) as u64)?;
    let triangles = looks.sorted(soup);
    let primitives = triangles.chunk_by(|&a, &b| looks.primitive_of(soup, a) == looks.primitive_of(soup, b));
    let of_names: usize =
        soup.objects.names.iter().map(|name| ESCAPED * (name.object.len() + name.group.len())).sum();
    let of_objects = PER_OBJECT * soup.objects.names.len() as u64 + of_names as u64;
    let _charge = budget.charge(PER_PRIMITIVE * primitives.count() as u64 + of_objects)?;
    let (vertices, _charge) = Vertices::of(soup, &looks, &triangles, budget)?;
    let (mut file, _charge) = GltfBuilder::with_room(soup, &vertices, &looks, encoding, budget)?;
    if !soup.triangles.is_empty() {
        file.put_meshes(soup, &vertices, &looks, &triangles, encoding, budget)?;
    }
    match encoding {
        Encoding::Glb => file.into_glb(budget),
        _ => file.into_text(budget),
    }
}

/// A file under way.
struct GltfBuilder {
    /// The header of a GLB if it is one, then the buffer.
    bytes: Vec<u8>,
    /// Where the buffer begins.
    begin: usize,
    views: Vec<Value>,
    accessors: Vec<Value>,
    /// Members of the document beside these lists.
    members: Map<String, Value>,
}

impl GltfBuilder {
    fn with_room<'b>(
        soup: &Soup,
        vertices: &Vertices,
        looks: &Looks,
        encoding: Encoding,
        budget: &'b Budget,
    ) -> Result<(Self, Charge<'b>), WriteError> {
        let pictures = soup.materials.descriptions.iter().flat_map(|d| &d.pictures);
        let of_pictures: usize = pictures.map(|picture| picture.len() + 4).sum();
        let per_vertex = 12
            + if vertices.points.is_empty() { 0 } else { 8 }
            + if vertices.colors.is_empty() { 0 } else { 16 };
        let of_mesh = vertices.len(soup) as u64 * per_vertex + 12 * soup.triangles.len() as u64;
        let room = of_mesh + of_pictures as u64;
        // Lengths in a file have 32 bits; a part of them is for the document.
        const BYTES_MAX: u64 = u32::MAX as u64 - (64 << 20);
        if room > BYTES_MAX {
            return Err(WriteError::TooLarge {
                bytes: room,
                bytes_max: BYTES_MAX,
                encoding: encoding.name(),
            });
        }
        let (bytes, charge) = budget.vec::<u8>(room as usize + 512 * (looks.list.len() + 8))?;
        let file = Self { bytes, begin: 0, views: Vec::new(), accessors: Vec::new(), members: Map::new() };
        Ok((file, charge))
    }

    /// Ends a view that began at byte `begin` of the buffer; gives its number.
    fn end_view(&mut self, begin: usize, target: Option<u32>) -> usize {
        let length = self.bytes.len() - self.begin - begin;
        let mut view = json!({ "buffer": 0, "byteOffset": begin, "byteLength": length });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.views.push(view);
        while !(self.bytes.len() - self.begin).is_multiple_of(4) {
            self.bytes.push(0);
        }
        self.views.len() - 1
    }

    fn next(&self) -> usize {
        self.bytes.len() - self.begin
    }

    /// Adds an accessor; gives its number.
    fn add_accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// `triangles` are all, as [`Looks::sorted`] has them.
    fn put_meshes(
        &mut self,
        soup: &Soup,
        vertices: &Vertices,
        looks: &Looks,
        triangles: &[u32],
        encoding: Encoding,
        budget: &Budget,
    ) -> Result<(), WriteError> {
        let color_bytes = vertices.color_bytes();
        let objects = vertices.of_objects(soup);
        let _charge = budget.charge(4 * vertices.colors.len() as u64)?;
        let mut attributes = Vec::with_capacity(objects.len());
        let object_of = |t: u32| looks.primitive_of(soup, t).0;
        let lists = triangles.chunk_by(|&a, &b| object_of(a) == object_of(b));
        for (of_object, list) in objects.iter().zip(lists) {
            let has_texture = list.iter().any(|&t| soup.texture.of_triangle(t as usize).is_some());
            let mut plain = Map::new();
            let positions = self.put_positions(soup, vertices, of_object, encoding, budget)?;
            plain.insert("POSITION".into(), positions.into());
            if !vertices.colors.is_empty() {
                let colors = self.put_colors(vertices, color_bytes.as_deref(), of_object, budget)?;
                plain.insert("COLOR_0".into(), colors.into());
            }
            let mut textured = plain.clone();
            if has_texture {
                let points = self.put_points(vertices, of_object, budget)?;
                textured.insert("TEXCOORD_0".into(), points.into());
            }
            attributes.push((plain, textured, of_object.start as u32));
        }
        let materials = self.put_materials(soup, &looks.list, budget)?;
        let begin = self.next();
        let view = self.views.len();
        let (mut meshes, mut nodes, mut primitives) = (Vec::new(), Vec::new(), Vec::new());
        let mut attributes = attributes.into_iter();
        let of_primitive = |&a: &u32, &b: &u32| looks.primitive_of(soup, a) == looks.primitive_of(soup, b);
        let mut lists = triangles.chunk_by(of_primitive).peekable();
        let mut of_object = attributes.next();
        while let (Some(list), Some((plain, textured, first))) = (lists.next(), &of_object) {
            let (object, look) = looks.primitive_of(soup, list[0]);
            let from = self.next() - begin;
            for block in list.chunks(CHECK_EVERY) {
                budget.check()?;
                for &t in block {
                    let corners = vertices.corners(soup, t as usize).map(|v| v - first);
                    self.bytes.extend(corners.iter().flat_map(|v| v.to_le_bytes()));
                }
            }
            let mut accessor = json!({ "bufferView": view, "componentType": U32, "count": 3 * list.len(), "type": "SCALAR" });
            if from > 0 {
                accessor["byteOffset"] = from.into();
            }
            let indices = self.add_accessor(accessor);
            let attributes_of_look = if looks.list[look as usize].has_texture { textured } else { plain };
            let mut primitive = json!({ "attributes": attributes_of_look, "indices": indices });
            if let Some(material) = materials[look as usize] {
                primitive["material"] = material.into();
            }
            primitives.push(primitive);
            let next = lists.peek().map(|list| looks.primitive_of(soup, list[0]).0);
            if next != Some(object) {
                let names = object.checked_sub(1).and_then(|object| soup.objects.names.get(object as usize));
                let mut mesh = json!({ "primitives": std::mem::take(&mut primitives) });
                let mut node = json!({ "mesh": meshes.len() });
                for (value, name) in [
                    (&mut node, names.map(|names| &names.object)),
                    (&mut mesh, names.map(|names| &names.group)),
                ] {
                    if let Some(name) = name.filter(|name| !name.is_empty()) {
                        value["name"] = String::from_utf8_lossy(name).into();
                    }
                }
                meshes.push(mesh);
                nodes.push(node);
                of_object = attributes.next();
            }
        }
        self.end_view(begin, Some(ELEMENT_ARRAY_BUFFER));
        let all: Vec<usize> = (0..nodes.len()).collect();
        self.members.insert("scenes".into(), json!([{ "nodes": all }]));
        self.members.insert("nodes".into(), nodes.into());
        self.members.insert("meshes".into(), meshes.into());
        Ok(())
    }

    fn put_positions(
        &mut self,
        soup: &Soup,
        vertices: &Vertices,
        of_object: &Range<usize>,
        encoding: Encoding,
        budget: &Budget,
    ) -> Result<usize, WriteError> {
        let begin = self.next();
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for i in of_object.clone() {
            if i.is_multiple_of(CHECK_EVERY) {
                budget.check()?;
            }
            let v = vertices.position(i);
            let position = float32::rounded(v, soup.positions[v as usize], encoding.name())?;
            for (k, c) in position.into_iter().enumerate() {
                (low[k], high[k]) = (low[k].min(c), high[k].max(c));
                self.bytes.extend_from_slice(&c.to_le_bytes());
            }
        }
        let view = self.end_view(begin, Some(ARRAY_BUFFER));
        let count = of_object.len();
        Ok(self.add_accessor(json!({
            "bufferView": view, "componentType": F32, "count": count, "type": "VEC3", "min": low, "max": high
        })))
    }

    /// Colours as bytes, if they are given, otherwise as float32.
    fn put_colors(
        &mut self,
        vertices: &Vertices,
        color_bytes: Option<&[[u8; 4]]>,
        of_object: &Range<usize>,
        budget: &Budget,
    ) -> Result<usize, WriteError> {
        let (begin, count) = (self.next(), of_object.len());
        if let Some(colors) = color_bytes {
            self.bytes.extend_from_slice(colors[of_object.clone()].as_flattened());
            let view = self.end_view(begin, Some(ARRAY_BUFFER));
            return Ok(self.add_accessor(json!({
                "bufferView": view, "componentType": U8, "normalized": true, "count": count, "type": "VEC4"
            })));
        }
        let channels = if vertices.has_alpha { 4 } else { 3 };
        for block in vertices.colors[of_object.clone()].chunks(CHECK_EVERY) {
            budget.check()?;
            self.bytes
                .extend(block.iter().flat_map(|color| &color[..channels]).flat_map(|c| c.to_le_bytes()));
        }
        let view = self.end_view(begin, Some(ARRAY_BUFFER));
        let kind = if vertices.has_alpha { "VEC4" } else { "VEC3" };
        Ok(self
            .add_accessor(json!({ "bufferView": view, "componentType": F32, "count": count, "type": kind })))
    }

    fn put_points(
        &mut self,
        vertices: &Vertices,
        of_object: &Range<usize>,
        budget: &Budget,
    ) -> Result<usize, WriteError> {
        let begin = self.next();
        for block in vertices.points[of_object.clone()].chunks(CHECK_EVERY) {
            budget.check()?;
            self.bytes.extend(block.as_flattened().iter().flat_map(|c| c.to_le_bytes()));
        }
        let view = self.end_view(begin, Some(ARRAY_BUFFER));
        let count = of_object.len();
        Ok(self.add_accessor(
            json!({ "bufferView": view, "componentType": F32, "count": count, "type": "VEC2" }),
        ))
    }

    /// The materials of the soup, as described or by name, and one for each further colour; gives that of each look.
    fn put_materials(
        &mut self,
        soup: &Soup,
        looks: &[Look],
        budget: &Budget,
    ) -> Result<Vec<Option<usize>>, WriteError> {
        let described = soup.materials.descriptions.as_ref();
        let mut document = described
            .and_then(|d| serde_json::from_slice::<Map<String, Value>>(&d.json).ok())
            .unwrap_or_default();
        let mut materials = match document.remove("materials") {
            Some(Value::Array(materials)) => materials,
            _ => Vec::new(),
        };
        let mut numbers: FxHashMap<(Option<u32>, Option<[u32; 4]>), usize> = FxHashMap::default();
        if described.is_some() {
            numbers.extend((0..materials.len()).map(|i| ((Some(i as u32), None), i)));
        }
        let mut of_look = Vec::new();
        let mut bare: FxHashMap<u32, Option<usize>> = FxHashMap::default();
        for look in looks {
            if look.material.is_none() && look.color.is_none() {
                of_look.push(None);
                continue;
            }
            if let (Some(material), None, false) = (look.material, look.color, look.has_texture)
                && described.is_some()
            {
                let number = *bare.entry(material).or_insert_with(|| {
                    materials.push(without_textures(materials.get(material as usize)?)?);
                    Some(materials.len() - 1)
                });
                if number.is_some() {
                    of_look.push(number);
                    continue;
                }
            }
            of_look.push(Some(*numbers.entry((look.material, look.color)).or_insert_with(|| {
                let name = look.material.and_then(|material| soup.materials.names.get(material as usize));
                materials.push(plain_material(name.map(Vec::as_slice), look.color));
                materials.len() - 1
            })));
        }
        if let Some(described) = described {
            self.put_pictures(&mut document, &described.pictures, budget)?;
        }
        let mut extensions = BTreeSet::new();
        for value in materials.iter().chain(document.values()) {
            names_of_extensions(value, &mut extensions);
        }
        if !extensions.is_empty() {
            self.members.insert("extensionsUsed".into(), json!(extensions));
        }
        for (key, list) in std::iter::once(("materials".to_owned(), Value::Array(materials))).chain(document)
        {
            if list.as_array().is_some_and(|list| !list.is_empty()) {
                self.members.insert(key, list);
            }
        }
        Ok(of_look)
    }

    /// Puts the pictures into the buffer, where the images of `document` find them.
    fn put_pictures(
        &mut self,
        document: &mut Map<String, Value>,
        pictures: &[Vec<u8>],
        budget: &Budget,
    ) -> Result<(), WriteError> {
        let mut views = Vec::new();
        for picture in pictures {
            budget.check()?;
            let begin = self.next();
            self.bytes.extend_from_slice(picture);
            views.push(self.end_view(begin, None));
        }
        for image in document.get_mut("images").and_then(Value::as_array_mut).into_iter().flatten() {
            let picture = image.get("bufferView").and_then(Value::as_u64).unwrap_or(u64::MAX);
            if let Some(&view) = views.get(picture as usize) {
                image["bufferView"] = view.into();
            }
        }
        Ok(())
    }

    /// The document, whose buffer is in the file or is `uri`.
    fn document(&mut self, uri: Option<String>) -> Value {
        let mut document = Map::new();
        document.insert("asset".into(), json!({ "version": "2.0", "generator": "Meshmend" }));
        if self.accessors.is_empty() {
            return document.into();
        }
        document.insert("scene".into(), 0.into());
        document.append(&mut self.members);
        document.insert("accessors".into(), std::mem::take(&mut self.accessors).into());
        document.insert("bufferViews".into(), std::mem::take(&mut self.views).into());
        let mut buffer = json!({ "byteLength": self.next() });
        if let Some(uri) = uri {
            buffer["uri"] = uri.into();
        }
        document.insert("buffers".into(), json!([buffer]));
        document.into()
    }

    fn into_glb(mut self, budget: &Budget) -> Result<Vec<u8>, WriteError> {
        let mut text = serde_json::to_vec(&self.document(None)).unwrap_or_default();
        text.resize(text.len().next_multiple_of(4), b' ');
        let buffer = self.bytes.len() as u64;
        let of_buffer = if buffer > 0 { 8 + buffer } else { 0 };
        let length = 12 + 8 + text.len() as u64 + of_buffer;
        let bytes_max = u64::from(u32::MAX);
        if length > bytes_max {
            return Err(WriteError::TooLarge { bytes: length, bytes_max, encoding: "glb" });
        }
        let (mut out, _charge) = budget.vec::<u8>(length as usize)?;
        let word = |out: &mut Vec<u8>, value: u64| out.extend_from_slice(&(value as u32).to_le_bytes());
        out.extend_from_slice(b"glTF");
        word(&mut out, 2);
        word(&mut out, length);
        word(&mut out, text.len() as u64);
        out.extend_from_slice(b"JSON");
        out.extend_from_slice(&text);
        if buffer > 0 {
            word(&mut out, buffer);
            out.extend_from_slice(b"BIN\0");
            out.extend_from_slice(&self.bytes);
        }
        Ok(out)
    }

    fn into_text(mut self, budget: &Budget) -> Result<Vec<u8>, WriteError> {
        // The text of the buffer, once by itself and once in the document.
        let _charge = budget.charge(2 * (self.bytes.len() as u64).div_ceil(3) * 4)?;
        let mut uri = "data:application/octet-stream;base64,".to_owned();
        base64::engine::general_purpose::STANDARD.encode_string(&self.bytes, &mut uri);
        let document = self.document(Some(uri));
        Ok(serde_json::to_vec(&document).unwrap_or_default())
    }
}

/// A material with a name and a colour that has nothing of a metal.
fn plain_material(name: Option<&[u8]>, color: Option<[u32; 4]>) -> Value {
    let mut material = Map::new();
    if let Some(name) = name {
        material.insert("name".into(), String::from_utf8_lossy(name).into());
    }
    if let Some(color) = color {
        let factor = color.map(f32::from_bits);
        let pbr = json!({ "baseColorFactor": factor, "metallicFactor": 0, "roughnessFactor": 1 });
        material.insert("pbrMetallicRoughness".into(), pbr);
        if factor[3] < 1.0 {
            material.insert("alphaMode".into(), "BLEND".into());
        }
    }
    material.into()
}

/// Notes the extensions that `value` uses, each once. No deeper than the reader of JSON goes.
fn names_of_extensions(value: &Value, names: &mut BTreeSet<String>) {
    match value {
        Value::Array(items) => items.iter().for_each(|item| names_of_extensions(item, names)),
        Value::Object(members) => {
            for (key, value) in members {
                if let ("extensions", Some(extensions)) = (key.as_str(), value.as_object()) {
                    names.extend(extensions.keys().cloned());
                }
                names_of_extensions(value, names);
            }
        }
        _ => {}
    }
}
