//! The table of options in the words of OpenAPI: each option is one parameter and one schema, which the operations that
//! take it refer to.

use utoipa::openapi::path::{Parameter, ParameterBuilder, ParameterIn};
use utoipa::openapi::schema::{AdditionalProperties, ArrayBuilder, ObjectBuilder, Schema, SchemaType, Type};
use utoipa::openapi::{Ref, RefOr, Required};
use utoipa::{PartialSchema, ToSchema};

use super::edges::edges_schema;
use super::holes::holes_schema;
use super::input_ref::InputRef;
use super::modeller::{edits_schema, ranges_schema};
use super::options::{OptionKind, OptionSpec, Options, SPECS};
use super::plan::PlanRequest;
use super::target::TargetSpec;
use super::words::Operation;

impl OptionSpec {
    /// The schema of its value, by its name alone: generators of clients do not understand a description beside it.
    fn reference(&self) -> Ref {
        Ref::from_schema_name(match self.kind {
            OptionKind::Word { name, .. } => name.to_owned(),
            OptionKind::Plan => PlanRequest::name().into_owned(),
            OptionKind::Input => InputRef::name().into_owned(),
            _ => camel_case(self.name),
        })
    }

    /// The schema that only this option uses, if there is one.
    fn own_schema(&self) -> Option<Schema> {
        let described = ObjectBuilder::new().description(Some(self.about));
        let typed = match self.kind {
            OptionKind::Integer { min, max } => {
                described.schema_type(Type::Integer).minimum(Some(min as f64)).maximum(Some(max as f64))
            }
            OptionKind::Number { min, max } => {
                described.schema_type(Type::Number).minimum(Some(min)).maximum(Some(max))
            }
            OptionKind::Flag => described.schema_type(Type::Boolean),
            OptionKind::Targets => return Some(targets_schema(self.about)),
            OptionKind::Edges => return Some(edges_schema(self.about)),
            OptionKind::Holes => return Some(holes_schema(self.about)),
            OptionKind::Edits => return Some(edits_schema(self.about)),
            OptionKind::Ranges => return Some(ranges_schema(self.about)),
            OptionKind::Word { .. } | OptionKind::Plan | OptionKind::Input => return None,
        };
        Some(Schema::Object(typed.build()))
    }

    /// The value in a query: as in JSON, but a structured value is its JSON text.
    fn query_schema(&self) -> RefOr<Schema> {
        let (pattern, about) = match self.kind {
            OptionKind::Input => (r#"^\{"(job|upload)":"[0-9a-f-]{36}"\}$"#, "JSON text of the object."),
            OptionKind::Targets => (r#"^\[\{"ratio":0\.[0-9]{1,3}\}\]$"#, "JSON text of the list."),
            OptionKind::Plan => (
                r#"^\{"findings":\[\{"code":"boundary-loop","remedy":"(keep|fill)"\}\]\}$"#,
                "JSON text of the plan.",
            ),
            OptionKind::Edges => (r"^\[\[0,[1-9][0-9]{0,5}\](,\[1,[2-9]\])?\]$", "JSON text of the list."),
            OptionKind::Edits => (
                r#"^\[(\{"shift":\{"faces":\[\{"face":[0-3],"by_mm":0\.[0-9]{1,3}\}\]\}\})?\]$"#,
                "JSON text of the list.",
            ),
            OptionKind::Ranges => (r"^\[([0-9](,[0-9]){0,3})?\]$", "JSON text of the list."),
            OptionKind::Holes => {
                (r"^(all|\[0(,[1-9][0-9]{0,3}){0,3}\])$", "`all`, or JSON text of the list.")
            }
            _ => return RefOr::Ref(self.reference()),
        };
        let text = ObjectBuilder::new().schema_type(Type::String).pattern(Some(pattern));
        RefOr::T(Schema::Object(text.description(Some(about)).build()))
    }
}

/// `max_deviation_mm` as `MaxDeviationMm`, `cut-stitch` as `CutStitch`.
pub fn camel_case(name: &str) -> String {
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    name.split(['-', '_']).filter(|word| !word.is_empty()).map(capital).collect()
}

/// A list of targets, each an object with one member.
fn targets_schema(about: &str) -> Schema {
    Schema::Array(
        ArrayBuilder::new()
            .description(Some(about))
            .items(RefOr::from(Ref::from_schema_name(TargetSpec::name())))
            .min_items(Some(1))
            .max_items(Some(16))
            .build(),
    )
}

/// The schemas that options alone use, by name.
pub fn option_schemas() -> impl Iterator<Item = (String, Schema)> {
    SPECS.iter().filter_map(|spec| Some((camel_case(spec.name), spec.own_schema()?)))
}

/// Every option as a parameter of a query, by name.
pub fn option_parameters() -> impl Iterator<Item = (&'static str, Parameter)> {
    let parameter = |spec: &'static OptionSpec| {
        ParameterBuilder::new()
            .name(spec.name)
            .parameter_in(ParameterIn::Query)
            .required(Required::False)
            .description(Some(spec.about))
            .schema(Some(spec.query_schema()))
            .build()
    };
    SPECS.iter().map(move |spec| (spec.name, parameter(spec)))
}

/// The options that `operation` takes; without one, all of them.
pub fn options_of(operation: Option<Operation>) -> impl Iterator<Item = &'static OptionSpec> {
    SPECS.iter().filter(move |spec| operation.is_none_or(|operation| spec.is_taken_by(operation)))
}

/// A closed object of the options that `operation` takes beside a mesh; without an operation, of all of them.
pub fn options_object(operation: Option<Operation>) -> ObjectBuilder {
    let object = ObjectBuilder::new()
        .schema_type(SchemaType::Type(Type::Object))
        .description(Some("Options; the same names are query parameters and command-line flags."))
        .additional_properties(Some(AdditionalProperties::FreeForm(false)));
    let beside_mesh = options_of(operation).filter(|spec| spec.kind != OptionKind::Input);
    beside_mesh.fold(object, |object, spec| object.property(spec.name, spec.reference()))
}

/// `object` without a mesh: it must name the earlier job whose upload is used again.
pub fn with_input(object: ObjectBuilder) -> ObjectBuilder {
    let inputs = SPECS.iter().filter(|spec| spec.kind == OptionKind::Input);
    inputs.fold(object, |object, spec| object.property(spec.name, spec.reference()).required(spec.name))
}

impl PartialSchema for Options {
    fn schema() -> RefOr<Schema> {
        RefOr::T(Schema::Object(options_object(None).build()))
    }
}

impl ToSchema for Options {}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn members(operation: Option<Operation>) -> Vec<String> {
        options_object(operation).build().properties.keys().cloned().collect()
    }

    #[test]
    fn an_operation_lists_the_options_that_it_takes_and_no_other() {
        assert_eq!(members(None).len(), SPECS.len() - 1, "all but `input`");
        assert_eq!(option_parameters().count(), SPECS.len());
        let verify = members(Some(Operation::Verify));
        assert!(verify.contains(&"samples".to_owned()) && !verify.contains(&"wall_mm".to_owned()));
        assert!(members(Some(Operation::Repair)).contains(&"wall_mm".to_owned()));
    }

    #[test]
    fn every_option_refers_to_a_schema() {
        let own: Vec<_> = option_schemas().map(|(name, _)| name).collect();
        for spec in SPECS {
            let reference = serde_json::to_value(spec.reference()).unwrap();
            let name = reference["$ref"].as_str().unwrap().rsplit('/').next().unwrap();
            assert_eq!(own.iter().any(|own| own == name), spec.own_schema().is_some(), "{name}");
        }
    }

    #[test]
    fn words_refer_to_their_type() {
        let object = serde_json::to_value(options_object(Some(Operation::Convert)).build()).unwrap();
        let format = &object["properties"]["output_format"];
        assert_eq!(format, &json!({"$ref": "#/components/schemas/Format"}));
    }

    #[test]
    fn options_without_a_mesh_must_name_an_input() {
        let object = with_input(options_object(Some(Operation::Verify))).build();
        let object = serde_json::to_value(object).unwrap();
        assert_eq!(object["required"], json!(["input"]));
        assert_ne!(object["properties"]["input"], Value::Null);
    }

    #[test]
    fn names_of_options_become_names_of_types() {
        assert_eq!(camel_case("max_deviation_mm"), "MaxDeviationMm");
        assert_eq!(camel_case("cut-stitch"), "CutStitch");
    }
}
