//! Bodies of uploads: the mesh itself, a form, or JSON that names an earlier upload.

use utoipa::ToSchema as _;
use utoipa::openapi::content::ContentBuilder;
use utoipa::openapi::encoding::Encoding;
use utoipa::openapi::request_body::{RequestBody, RequestBodyBuilder};
use utoipa::openapi::schema::{AdditionalProperties, ArrayBuilder, ObjectBuilder, Schema, Type};
use utoipa::openapi::{Content, Ref, RefOr, Required};

use super::{binary, text};
use crate::http::representation::OCTET_STREAM;
use crate::wire::{self, Format, JobRequest, Operation, camel_case, options_object, with_input};

/// Every media type of a mesh, the one that any mesh has first.
pub(super) fn mesh_media_types() -> impl Iterator<Item = &'static str> {
    [OCTET_STREAM].into_iter().chain(Format::ALL.iter().map(|&format| wire::media_type_of(format)))
}

/// The body of `operation`.
pub(super) fn of_operation(operation: Operation) -> RequestBody {
    let named = |what: &str| Ref::from_schema_name(name_of(operation, what));
    upload(named("Form"), named("OptionsWithInput"), operation.meshes_max() > 1)
}

/// The body of a request for a job.
pub(super) fn of_job() -> RequestBody {
    upload(Ref::from_schema_name("JobForm"), Ref::from_schema_name("JobRequestWithInput"), false)
}

/// The schemas that the bodies refer to, by name.
pub(super) fn schemas() -> Vec<(String, RefOr<Schema>)> {
    let mut schemas = vec![
        ("JobForm".to_owned(), form(&["job", "params"], &JobRequest::name(), "What to do, with options.", 1)),
        ("JobRequestWithInput".to_owned(), with_input(JobRequest::object())),
    ];
    for &operation in Operation::ALL {
        let options = name_of(operation, "Options");
        let meshes = operation.meshes_max();
        schemas.push((name_of(operation, "Form"), form(&["params"], &options, "Options.", meshes)));
        schemas.push((options, options_object(Some(operation))));
        let again = with_input(options_object(Some(operation)));
        schemas.push((name_of(operation, "OptionsWithInput"), again));
    }
    schemas.into_iter().map(|(name, object)| (name, RefOr::T(Schema::Object(object.build())))).collect()
}

fn name_of(operation: Operation, what: &str) -> String {
    camel_case(operation.word()) + what
}

/// A form with a mesh, or two to so many, and, in each of `parts`, a `schema`.
fn form(parts: &[&str], schema: &str, about: &str, meshes: usize) -> ObjectBuilder {
    let part = |part: ObjectBuilder, name: &&str| {
        let reference = Ref::builder().ref_location_from_schema_name(schema).description(Some(about));
        part.property(*name, reference.build())
    };
    let mesh = RefOr::T(Schema::Object(ObjectBuilder::from(bytes("The mesh.")).min_length(Some(1)).build()));
    let mesh = match meshes {
        1 => mesh,
        most => {
            let several = ArrayBuilder::new().items(mesh).min_items(Some(2)).max_items(Some(most));
            RefOr::T(Schema::Array(several.build()))
        }
    };
    let begun = ObjectBuilder::new()
        .schema_type(Type::Object)
        .description(Some("Upload of a mesh as a form."))
        .additional_properties(Some(AdditionalProperties::FreeForm(false)))
        .property("mesh", mesh)
        .required("mesh");
    parts.iter().fold(begun, part).property(
        "material",
        bytes(
            "The MTL file of an OBJ: its diffuse colours become face colours, which OFF, PLY, 3MF and glTF hold.",
        ),
    )
}

fn bytes(about: &str) -> utoipa::openapi::Object {
    let format = utoipa::openapi::SchemaFormat::KnownFormat(utoipa::openapi::KnownFormat::Binary);
    text().format(Some(format)).description(Some(about)).build()
}

fn upload(form: Ref, json: Ref, takes_several: bool) -> RequestBody {
    let about = match takes_several {
        true => {
            "A form with the meshes; or, to use an earlier upload of several meshes again, options with `input` as JSON."
        }
        false => {
            "The mesh itself, with or without a media type that names its format; or a form; or, to use an earlier \
             upload again, options with `input` as JSON."
        }
    };
    let body = RequestBodyBuilder::new().description(Some(about)).required(Some(Required::True));
    let mesh = |body: RequestBodyBuilder, media_type| body.content(media_type, Content::new(Some(binary())));
    let json_part = || Encoding::builder().content_type(Some("application/json")).build();
    let form =
        ContentBuilder::new().schema(Some(form)).encoding("params", json_part()).encoding("job", json_part());
    // Generators take what ends in `+json` for a JSON document of theirs; such a mesh goes as bytes like any other.
    let bare = mesh_media_types().filter(|media_type| !takes_several && !media_type.ends_with("+json"));
    bare.fold(body, mesh)
        .content("multipart/form-data", form.build())
        .content("application/json", Content::new(Some(json)))
        .build()
}
