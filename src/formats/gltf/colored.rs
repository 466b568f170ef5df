//! Materials that are made here: one colour each, and seen from both sides.

use crate::formats::colors::as_linear;
use crate::mesh::{Color, Descriptions, Materials};
use serde_json::json;
use std::sync::Arc;

/// Materials with these names and colours (sRGB); `of_face` has the number of each face's. A surface of them that is open shows what
/// is behind it.
pub fn two_sided_materials(materials: Vec<(String, [u8; 3])>, of_face: Vec<u32>) -> Materials {
    let material = |(name, color): &(String, [u8; 3])| {
        let [r, g, b, _] = as_linear(Some(Color::Bytes(*color, None)));
        let pbr = json!({ "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0, "roughnessFactor": 1 });
        json!({ "name": name, "doubleSided": true, "pbrMetallicRoughness": pbr })
    };
    let described = json!({ "materials": materials.iter().map(material).collect::<Vec<_>>() });
    let descriptions = Descriptions {
        json: described.to_string().into_bytes(),
        colors: vec![None; materials.len()],
        ..Descriptions::default()
    };
    let names = materials.into_iter().map(|(name, _)| name.into_bytes()).collect();
    Materials { names, of_face, descriptions: Some(Arc::new(descriptions)), ..Materials::default() }
}
