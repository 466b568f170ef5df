//! Labels: what the caller writes on a job, to find it by later.

use std::collections::BTreeMap;

use serde_json::Value;
use utoipa::openapi::schema::{AdditionalProperties, ObjectBuilder, Schema, Type};

use super::problem::Problem;
use super::problem_code::ProblemCode;

/// Words of the caller about a job, by name.
pub type Labels = BTreeMap<String, String>;

/// Most labels of a job.
pub const LABELS_MAX: usize = 16;
/// Longest name of a label, in characters.
const NAME_CHARS_MAX: usize = 63;
/// Longest value of a label, in characters.
const VALUE_CHARS_MAX: usize = 255;
/// Names of labels.
const NAME_PATTERN: &str = "^[A-Za-z0-9._/-]{1,63}$";

/// Values of labels.
const VALUE_PATTERN: &str = r"^[^\u0000-\u001F\u007F-\u009F]*$";

/// The labels of a JSON object.
///
/// # Errors
/// `invalid-parameter`.
pub(super) fn labels_from_json(value: &Value) -> Result<Labels, Problem> {
    let members = value.as_object().filter(|members| members.len() <= LABELS_MAX).ok_or_else(about_labels)?;
    let label = |(name, value): (&String, &Value)| {
        let value = value.as_str().filter(|value| is_value(value))?;
        is_name(name).then(|| (name.clone(), value.to_owned()))
    };
    members.iter().map(label).collect::<Option<Labels>>().ok_or_else(about_labels)
}

/// A label of a query: `name:value`; `None` when it is none.
pub fn label_from_text(text: &str) -> Option<(String, String)> {
    let (name, value) = text.split_once(':')?;
    (is_name(name) && is_value(value)).then(|| (name.to_owned(), value.to_owned()))
}

fn is_name(name: &str) -> bool {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '/' | '-');
    (1..=NAME_CHARS_MAX).contains(&name.len()) && name.chars().all(is_plain)
}

fn is_value(value: &str) -> bool {
    value.chars().count() <= VALUE_CHARS_MAX && !value.contains(char::is_control)
}

pub(super) fn about_labels() -> Problem {
    let expected = format!(
        "an object of at most {LABELS_MAX} texts: names of 1 to {NAME_CHARS_MAX} letters, digits and ._/-, values of at \
         most {VALUE_CHARS_MAX} characters, none of which is a control character"
    );
    Problem {
        parameter: Some("labels".to_owned()),
        ..Problem::new(ProblemCode::InvalidParameter, format!("`labels` must be {expected}")).with_limit(
            "labels_max",
            LABELS_MAX as u64,
            None,
        )
    }
}

/// Schema of labels in a request.
pub(super) fn labels_schema() -> Schema {
    let value = ObjectBuilder::new()
        .schema_type(Type::String)
        .max_length(Some(VALUE_CHARS_MAX))
        .pattern(Some(VALUE_PATTERN));
    let name = ObjectBuilder::new().schema_type(Type::String).pattern(Some(NAME_PATTERN));
    let labels = ObjectBuilder::new()
        .schema_type(Type::Object)
        .description(Some("What to write on the job, by name; jobs can be listed by it."))
        .max_properties(Some(LABELS_MAX))
        .property_names(Some(Schema::Object(name.build())))
        .additional_properties(Some(AdditionalProperties::RefOr(Schema::Object(value.build()).into())));
    Schema::Object(labels.build())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn labels_are_few_short_texts_with_plain_names() {
        let labels = labels_from_json(&json!({"order": "17", "shop/part": "über"})).unwrap();
        assert_eq!(labels["shop/part"], "über");
        let many: serde_json::Map<_, _> = (0..=LABELS_MAX).map(|i| (format!("n{i}"), json!(""))).collect();
        for wrong in [
            json!([]),
            json!({"a": 1}),
            json!({"": "x"}),
            json!({"a b": "x"}),
            json!({"a": "x\u{0}"}),
            json!({"x": "y".repeat(VALUE_CHARS_MAX + 1)}),
            json!({"x".repeat(NAME_CHARS_MAX + 1): ""}),
            json!(many),
        ] {
            let problem = labels_from_json(&wrong).unwrap_err();
            assert_eq!(problem.parameter.as_deref(), Some("labels"), "{wrong}");
        }
    }

    #[test]
    fn a_label_of_a_query_is_cut_at_its_first_colon() {
        assert_eq!(label_from_text("url:a:b"), Some(("url".into(), "a:b".into())));
        assert_eq!(label_from_text("order:"), Some(("order".into(), String::new())));
        assert_eq!(
            (label_from_text("order"), label_from_text(":x"), label_from_text("a b:x")),
            (None, None, None)
        );
    }
}
