//! The materials of a document with their textures and pictures, kept as they stand.

use super::buffers::{Buffers, decode};
use super::part::{List, LocatedValue};
use super::references::is_reference;
use crate::budget::{Budget, Charge};
use crate::formats::{ReadError, ReadErrorKind};
use crate::mesh::{Color, Descriptions};
use serde_json::{Map, Value, json};

/// The materials of a document.
pub(super) struct FileMaterials<'b> {
    pub(super) names: Vec<Vec<u8>>,
    pub(super) descriptions: Descriptions,
    /// The set of texture coordinates that each takes.
    pub(super) uv_set_of: Vec<u64>,
    /// Textures on other sets of coordinates than the others of their material, and such without a picture in the file.
    pub(super) left_out: u64,
    _charges: Vec<Charge<'b>>,
}

impl<'b> FileMaterials<'b> {
    /// Reads the materials of `root`.
    pub(super) fn read(
        root: &LocatedValue<'_>,
        buffers: &Buffers<'_>,
        budget: &'b Budget,
    ) -> Result<Self, ReadError> {
        let materials = root.list("materials")?;
        let mut charges = Vec::new();
        let mut pictures = Vec::new();
        let mut images = Vec::new();
        let mut number_of_image = Vec::new();
        if materials.len() > 0 {
            for image in root.list("images")?.items() {
                let picture = picture_of(&image, buffers, budget)?;
                number_of_image.push(picture.as_ref().map(|_| images.len()));
                if let Some((bytes, media_type, charge)) = picture {
                    images.push(image_entry(&image, media_type, pictures.len()));
                    pictures.push(bytes);
                    charges.push(charge);
                }
            }
        }
        let textures: Vec<Option<Value>> = root
            .list("textures")?
            .items()
            .map(|texture| texture_entry(texture.value, &number_of_image))
            .collect();
        let is_usable = |index: u64| matches!(textures.get(index as usize), Some(Some(_)));
        let mut names = Vec::new();
        let mut colors = Vec::new();
        let mut uv_set_of = Vec::new();
        let mut left_out = 0;
        let mut kept = Vec::new();
        for (i, material) in materials.items().enumerate() {
            budget.check()?;
            let name = material.text("name").filter(|name| !name.is_empty());
            names.push(
                name.map_or_else(|| format!("material_{i}").into_bytes(), |name| name.as_bytes().to_vec()),
            );
            let uv_set = main_uv_set(material.value);
            let mut value = material.value.clone();
            keep_textures(&mut value, uv_set, &is_usable, &mut left_out);
            colors.push(color_of(&LocatedValue::root(&value))?);
            uv_set_of.push(uv_set);
            kept.push(value);
        }
        let textures: Vec<Value> =
            textures.into_iter().map(|texture| texture.unwrap_or_else(|| json!({}))).collect();
        let samplers: Vec<Value> = list_values(&root.list("samplers")?);
        let json = json!({ "materials": kept, "textures": textures, "samplers": samplers, "images": images });
        // A tree of values is always a text.
        let json = serde_json::to_vec(&json).unwrap_or_default();
        let descriptions = Descriptions { json, pictures, colors };
        Ok(Self { names, descriptions, uv_set_of, left_out, _charges: charges })
    }
}

fn list_values(list: &List<'_>) -> Vec<Value> {
    list.items().map(|part| part.value.clone()).collect()
}

/// The bytes and the media type of a picture; `None`: it is not in the file.
#[allow(clippy::type_complexity, reason = "a picture with what it is charged")]
fn picture_of<'b>(
    image: &LocatedValue<'_>,
    buffers: &Buffers<'_>,
    budget: &'b Budget,
) -> Result<Option<(Vec<u8>, Option<String>, Charge<'b>)>, ReadError> {
    let stated = image.text("mimeType").map(str::to_owned);
    if let Some(uri) = image.get("uri") {
        let of_uri = uri.value.as_str().and_then(|text| text.strip_prefix("data:")?.split(';').next());
        let media_type = stated.or_else(|| of_uri.map(str::to_owned));
        let decoded = decode(&uri, budget)?.ok().filter(|(bytes, _)| !bytes.is_empty());
        return Ok(decoded.map(|(bytes, charge)| (bytes, media_type, charge)));
    }
    let Some(view) = image.get("bufferView") else { return Ok(None) };
    // A picture says nothing of the shape: one that cannot be had is absent.
    let bytes = match buffers.view(&view) {
        Ok(view) if !view.bytes.is_empty() => view.bytes,
        Err(error) if matches!(error.kind, ReadErrorKind::Stopped(_)) => return Err(error),
        _ => return Ok(None),
    };
    let (mut copy, charge) = budget.vec::<u8>(bytes.len())?;
    copy.extend_from_slice(bytes);
    Ok(Some((copy, stated, charge)))
}

fn image_entry(image: &LocatedValue<'_>, media_type: Option<String>, picture: usize) -> Value {
    let mut entry = Map::new();
    if let Some(name) = image.text("name") {
        entry.insert("name".into(), name.into());
    }
    entry.insert("mimeType".into(), media_type.unwrap_or_else(|| "image/png".to_owned()).into());
    entry.insert("bufferView".into(), picture.into());
    entry.into()
}

/// The texture with the new numbers of its images; `None`: the file has none of them.
fn texture_entry(texture: &Value, number_of_image: &[Option<usize>]) -> Option<Value> {
    let mut entry = texture.as_object()?.clone();
    let renumbered = |entry: &mut Map<String, Value>| {
        let image = entry.get("source").and_then(Value::as_u64);
        match image.and_then(|image| number_of_image.get(image as usize).copied().flatten()) {
            Some(number) => {
                entry.insert("source".into(), number.into());
                true
            }
            None => {
                entry.remove("source");
                false
            }
        }
    };
    let mut is_usable = renumbered(&mut entry);
    if let Some(extensions) = entry.get_mut("extensions").and_then(Value::as_object_mut) {
        extensions.retain(|_, extension| {
            extension.as_object_mut().is_none_or(|extension| {
                let has_source = extension.contains_key("source");
                let is_there = has_source && renumbered(extension);
                is_usable |= is_there;
                is_there || !has_source
            })
        });
    }
    is_usable.then_some(entry.into())
}

/// The set of coordinates that a reference to a texture takes.
fn uv_set(reference: &Map<String, Value>) -> u64 {
    let transformed =
        reference.get("extensions").and_then(|e| e.get("KHR_texture_transform")?.get("texCoord"));
    transformed.or_else(|| reference.get("texCoord")).and_then(Value::as_u64).unwrap_or(0)
}

/// The set of coordinates of the picture of the base colour, or else of the first picture.
fn main_uv_set(material: &Value) -> u64 {
    let base = material.get("pbrMetallicRoughness").and_then(|pbr| pbr.get("baseColorTexture"));
    let first = || first_reference(material);
    base.and_then(Value::as_object).or_else(first).map_or(0, uv_set)
}

/// The first reference to a texture. No deeper than the reader of JSON goes, which is 128 levels.
fn first_reference(value: &Value) -> Option<&Map<String, Value>> {
    let members = value.as_object()?;
    members.iter().find_map(
        |(key, value)| if is_reference(key, value) { value.as_object() } else { first_reference(value) },
    )
}

/// Drops the references to textures that are not usable or on another set of coordinates, which becomes the first one. No
/// deeper than the reader of JSON goes.
fn keep_textures(value: &mut Value, set: u64, is_usable: &dyn Fn(u64) -> bool, left_out: &mut u64) {
    let Some(members) = value.as_object_mut() else { return };
    members.retain(|key, value| {
        if !is_reference(key, value) {
            keep_textures(value, set, is_usable, left_out);
            return true;
        }
        let Some(reference) = value.as_object_mut() else { return true };
        let index = reference.get("index").and_then(Value::as_u64);
        let is_kept = index.is_some_and(is_usable) && uv_set(reference) == set;
        reference.remove("texCoord");
        let transform =
            reference.get_mut("extensions").and_then(|e| e.get_mut("KHR_texture_transform")?.as_object_mut());
        if let Some(transform) = transform {
            transform.remove("texCoord");
        }
        *left_out += u64::from(!is_kept);
        is_kept
    });
}

/// The base colour that a material states, if it has no picture for it.
fn color_of(material: &LocatedValue<'_>) -> Result<Option<Color>, ReadError> {
    let Some(pbr) = material.get("pbrMetallicRoughness") else { return Ok(None) };
    if pbr.get("baseColorTexture").is_some() {
        return Ok(None);
    }
    let factor = pbr.numbers::<4>("baseColorFactor")?;
    Ok(factor.map(|[r, g, b, a]| Color::Linear([r as f32, g as f32, b as f32], Some(a as f32))))
}
