//! References of materials to textures.

use serde_json::Value;

/// True for a member that names a texture.
pub(super) fn is_reference(key: &str, value: &Value) -> bool {
    key.ends_with("Texture") && value.get("index").is_some()
}

/// The material without its textures, for triangles that have no coordinates for them; `None`: it has no textures. No deeper
/// than the reader of JSON goes.
pub(super) fn without_textures(material: &Value) -> Option<Value> {
    let mut bare = material.clone();
    (drop_references(&mut bare) > 0).then_some(bare)
}

fn drop_references(value: &mut Value) -> usize {
    let Some(members) = value.as_object_mut() else { return 0 };
    let before = members.len();
    members.retain(|key, value| !is_reference(key, value));
    before - members.len() + members.values_mut().map(drop_references).sum::<usize>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_material_without_textures_keeps_all_else() {
        let sheen = json!({ "sheenRoughnessTexture": { "index": 2 }, "sheenRoughnessFactor": 0.5 });
        let material = json!({
            "name": "skin",
            "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "roughnessFactor": 0.25 },
            "extensions": { "KHR_materials_sheen": sheen },
        });
        let bare = json!({
            "name": "skin",
            "pbrMetallicRoughness": { "roughnessFactor": 0.25 },
            "extensions": { "KHR_materials_sheen": { "sheenRoughnessFactor": 0.5 } },
        });
        assert_eq!(without_textures(&material), Some(bare.clone()));
        assert_eq!(without_textures(&bare), None);
    }
}
