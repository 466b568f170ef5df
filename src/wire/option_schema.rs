//! The table of options in the words of OpenAPI.

use utoipa::openapi::path::{Parameter, ParameterBuilder, ParameterIn};
use utoipa::openapi::schema::{
    AdditionalProperties, AllOfBuilder, ArrayBuilder, ObjectBuilder, Schema, SchemaType, Type,
};
use utoipa::openapi::{Ref, RefOr, Required};
use utoipa::{IntoParams, PartialSchema, ToSchema};

use super::edges::edges_schema;
use super::options::{OptionKind, OptionSpec, Options, SPECS};
use super::plan::PlanRequest;
use super::target::TargetSpec;

impl OptionSpec {
    /// Schema of the value in JSON.
    fn schema(&self) -> Schema {
        let described = ObjectBuilder::new().description(Some(self.about));
        let typed = match self.kind {
            OptionKind::Word(words) => {
                described.schema_type(Type::String).enum_values(Some(words.iter().copied()))
            }
            OptionKind::Integer { min, max } => {
                described.schema_type(Type::Integer).minimum(Some(min as f64)).maximum(Some(max as f64))
            }
            OptionKind::Number { min, max } => {
                described.schema_type(Type::Number).minimum(Some(min)).maximum(Some(max))
            }
            OptionKind::Flag => described.schema_type(Type::Boolean),
            OptionKind::Targets => return targets_schema(self.about),
            OptionKind::Edges => return edges_schema(self.about),
            OptionKind::Plan => return plan_schema(self.about),
            OptionKind::Input => described
                .schema_type(Type::Object)
                .property(
                    "job",
                    ObjectBuilder::new().schema_type(Type::String).description(Some("Id of the job.")),
                )
                .required("job")
                .additional_properties(Some(AdditionalProperties::FreeForm(false))),
        };
        Schema::Object(typed.build())
    }

    /// Schema of the value in a query: as in JSON, but a structured value is its JSON text.
    fn query_schema(&self) -> Schema {
        match self.kind {
            OptionKind::Input => Schema::Object(
                ObjectBuilder::new()
                    .schema_type(Type::String)
                    .pattern(Some(r#"^\{"job":"[0-9a-f-]{36}"\}$"#))
                    .build(),
            ),
            OptionKind::Targets => Schema::Object(
                ObjectBuilder::new()
                    .schema_type(Type::String)
                    .pattern(Some(r#"^\[\{"ratio":0\.[0-9]{1,3}\}\]$"#))
                    .description(Some("JSON text of the list."))
                    .build(),
            ),
            OptionKind::Plan => Schema::Object(
                ObjectBuilder::new()
                    .schema_type(Type::String)
                    .pattern(Some(
                        r#"^\{"findings":\[\{"code":"boundary-loop","remedy":"(keep|fill)"\}\]\}$"#,
                    ))
                    .description(Some("JSON text of the plan."))
                    .build(),
            ),
            OptionKind::Edges => Schema::Object(
                ObjectBuilder::new()
                    .schema_type(Type::String)
                    .pattern(Some(r"^\[\[0,[1-9][0-9]{0,5}\](,\[1,[2-9]\])?\]$"))
                    .description(Some("JSON text of the list."))
                    .build(),
            ),
            _ => self.schema(),
        }
    }
}

/// A plan, by reference.
fn plan_schema(about: &str) -> Schema {
    let plan = RefOr::from(Ref::from_schema_name(PlanRequest::name()));
    Schema::AllOf(AllOfBuilder::new().description(Some(about)).item(plan).build())
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

impl PartialSchema for Options {
    fn schema() -> RefOr<Schema> {
        RefOr::T(Schema::Object(object_of_options().build()))
    }
}

impl ToSchema for Options {}

/// A closed object with every option as a member.
pub(super) fn object_of_options() -> ObjectBuilder {
    let object = ObjectBuilder::new()
        .schema_type(SchemaType::Type(Type::Object))
        .description(Some("Options; the same names are query parameters and command-line flags."))
        .additional_properties(Some(AdditionalProperties::FreeForm(false)));
    SPECS.iter().fold(object, |object, spec| object.property(spec.name, spec.schema()))
}

impl IntoParams for Options {
    fn into_params(parameter_in: impl Fn() -> Option<ParameterIn>) -> Vec<Parameter> {
        let parameter = |spec: &OptionSpec| {
            ParameterBuilder::new()
                .name(spec.name)
                .parameter_in(parameter_in().unwrap_or(ParameterIn::Query))
                .required(Required::False)
                .description(Some(spec.about))
                .schema(Some(spec.query_schema()))
                .build()
        };
        SPECS.iter().map(parameter).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_and_the_query_parameters_list_every_option() {
        let RefOr::T(Schema::Object(object)) = Options::schema() else { panic!("an object") };
        let params = Options::into_params(|| None);
        assert_eq!(object.properties.len(), SPECS.len());
        assert_eq!(
            params.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(),
            SPECS.iter().map(|s| s.name).collect::<Vec<_>>()
        );
    }
}
