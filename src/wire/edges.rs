//! Edges of a file, as a list of options says them: `[[u,v],…]`, by the numbers of their vertices from 0.

use super::whole_number::whole_number;
use utoipa::openapi::schema::{ArrayBuilder, ObjectBuilder, Schema, Type};

/// Most edges that may be listed.
const EDGES_MAX: usize = 100_000;

/// The edges of a JSON list; `None` when it is no such list.
pub(super) fn edges_from_json(text: &str) -> Option<Vec<[u32; 2]>> {
    let edges: Vec<[f64; 2]> = serde_json::from_str(text).ok()?;
    let whole = |[a, b]: [f64; 2]| Some([whole_number(a)?, whole_number(b)?]).filter(|[a, b]| a != b);
    let is_valid = (1..=EDGES_MAX).contains(&edges.len());
    edges.into_iter().map(whole).collect::<Option<Vec<_>>>().filter(|_| is_valid)
}

/// Schema of such a list.
pub(super) fn edges_schema(about: &str) -> Schema {
    let vertex = ObjectBuilder::new().schema_type(Type::Integer).minimum(Some(0)).maximum(Some(u32::MAX));
    let edge = ArrayBuilder::new().items(vertex).min_items(Some(2)).max_items(Some(2)).unique_items(true);
    let list = ArrayBuilder::new().description(Some(about)).items(edge);
    Schema::Array(list.min_items(Some(1)).max_items(Some(EDGES_MAX)).build())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_of_pairs_of_different_numbers_is_taken_and_nothing_else() {
        assert_eq!(edges_from_json("[[0,1],[7.0,3]]"), Some(vec![[0, 1], [7, 3]]));
        for text in [
            "[]",
            "[[0]]",
            "[[0,0]]",
            "[[0,1,2]]",
            "[[0,-1]]",
            "[[0,1.5]]",
            "[0,1]",
            "{}",
            "[[0,4294967296]]",
            "",
        ] {
            assert_eq!(edges_from_json(text), None, "{text}");
        }
    }
}
