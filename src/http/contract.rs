//! The contract: the OpenAPI document that is made from the routes and the wire types.
//!
//! Handlers say their path, parameters and plain answers. What several of them share is said once here: bodies of
//! uploads, answers in several media types, headers, and the problems each may answer with.

use std::collections::BTreeMap;

use utoipa::openapi::content::ContentBuilder;
use utoipa::openapi::encoding::Encoding;
use utoipa::openapi::header::HeaderBuilder;
use utoipa::openapi::path::{Operation, Parameter, ParameterBuilder, ParameterIn};
use utoipa::openapi::request_body::{RequestBody, RequestBodyBuilder};
use utoipa::openapi::response::{Response, ResponseBuilder};
use utoipa::openapi::schema::{
    AdditionalProperties, ArrayBuilder, KnownFormat, Object, ObjectBuilder, Schema, SchemaFormat, Type,
};
use utoipa::openapi::security::{
    ApiKey, ApiKeyValue, Http, HttpAuthScheme, SecurityRequirement, SecurityScheme,
};
use utoipa::openapi::{Content, Header, InfoBuilder, OpenApi, Ref, RefOr, Required};
use utoipa::{PartialSchema as _, ToSchema};

use super::representation::OCTET_STREAM;
use crate::wire::{
    self, Format, Job, JobRequest, LABELS_MAX, Options, Outcome, PlanRequest, Problem, ProblemCode, Report,
    StageEvent, StateEvent,
};

/// Problems that any path may answer with.
const COMMON: &[ProblemCode] = &[
    ProblemCode::InvalidParameter,
    ProblemCode::UnknownParameter,
    ProblemCode::Unauthenticated,
    ProblemCode::Forbidden,
    ProblemCode::NotAcceptable,
    ProblemCode::HeadTooLarge,
    ProblemCode::RateLimited,
    ProblemCode::Internal,
];
/// Problems of an upload.
const UPLOAD: &[ProblemCode] = &[
    ProblemCode::BodyIncomplete,
    ProblemCode::NotFound,
    ProblemCode::UploadTimeout,
    ProblemCode::Expired,
    ProblemCode::IdempotencyKeyReused,
    ProblemCode::BodyTooLarge,
    ProblemCode::UnsupportedMediaType,
    ProblemCode::MeshEmpty,
    ProblemCode::QueueFull,
    ProblemCode::Draining,
    ProblemCode::StoreUnavailable,
    ProblemCode::StorageFull,
];
/// Problems of a job that was run.
const RUN: &[ProblemCode] = &[
    ProblemCode::Cancelled,
    ProblemCode::PlanMismatch,
    ProblemCode::MeshTooLarge,
    ProblemCode::EngineOutOfMemory,
    ProblemCode::MeshUnparseable,
    ProblemCode::MeshEmpty,
    ProblemCode::MeshTruncated,
    ProblemCode::EngineCrashed,
    ProblemCode::WorkerLost,
    ProblemCode::StorageFull,
    ProblemCode::EngineTimeout,
];
/// Further problems of a job whose product is a mesh.
const MESH_OUT: &[ProblemCode] = &[ProblemCode::NotRepairable, ProblemCode::MeshNonFinite];
/// Problems of a path that names a job.
const JOB: &[ProblemCode] = &[ProblemCode::NotFound, ProblemCode::StoreUnavailable];
/// Problems of what a job has produced.
const PRODUCT: &[ProblemCode] = &[ProblemCode::JobNotFinished, ProblemCode::Expired];

/// Upload of a mesh as a form.
#[derive(ToSchema)]
#[allow(dead_code, reason = "describes the parts of a form, which are read one by one")]
pub(super) struct MeshForm {
    /// The mesh.
    #[schema(value_type = String, format = Binary, min_length = 1)]
    mesh: Vec<u8>,
    /// Options.
    #[schema(schema_with = options_without_input, required = false)]
    params: Option<Options>,
    /// The MTL file of an OBJ: its diffuse colours become face colours, which OFF and PLY hold.
    #[schema(value_type = String, format = Binary, required = false)]
    material: Option<Vec<u8>>,
}

/// Upload of a mesh with the job to make of it, as a form.
#[derive(ToSchema)]
#[allow(dead_code, reason = "describes the parts of a form, which are read one by one")]
pub(super) struct JobForm {
    /// The mesh.
    #[schema(value_type = String, format = Binary, min_length = 1)]
    mesh: Vec<u8>,
    /// What to do, with options.
    #[schema(schema_with = request_without_input, required = false)]
    job: Option<JobRequest>,
    /// As `job`.
    #[schema(schema_with = request_without_input, required = false)]
    params: Option<JobRequest>,
    /// The MTL file of an OBJ: its diffuse colours become face colours, which OFF and PLY hold.
    #[schema(value_type = String, format = Binary, required = false)]
    material: Option<Vec<u8>>,
}

/// The document that the routes gave, with all that they share.
pub(super) fn complete(mut document: OpenApi) -> OpenApi {
    document.info = InfoBuilder::new()
        .title("Meshmend")
        .version(wire::ENGINE_VERSION)
        .description(Some(
            "Repairs triangle meshes for 3D printing and proves it: every returned file carries a certificate, made \
             from its own bytes, that it is a valid solid. Otherwise the answer is a typed refusal.",
        ))
        .build();
    document.servers = None;
    let components = document.components.get_or_insert_default();
    for (name, schema) in schemas() {
        components.schemas.entry(name).or_insert(schema);
    }
    components.add_security_scheme("bearer", SecurityScheme::Http(Http::new(HttpAuthScheme::Bearer)));
    components
        .add_security_scheme("key", SecurityScheme::ApiKey(ApiKey::Header(ApiKeyValue::new("X-API-Key"))));
    for (path, item) in &mut document.paths.paths {
        for operation in [&mut item.get, &mut item.post, &mut item.delete].into_iter().flatten() {
            complete_operation(path, operation);
        }
    }
    document
}

/// Schemas that only shared parts name, and the schemas that those name.
fn schemas() -> Vec<(String, RefOr<Schema>)> {
    let mut schemas = Vec::new();
    macro_rules! add {
        ($($type:ty),+) => { $(
            schemas.push((<$type>::name().into_owned(), <$type>::schema()));
            <$type>::schemas(&mut schemas);
        )+ };
    }
    add!(MeshForm, JobForm, JobRequest, Options, PlanRequest, Job, Report, Problem, StateEvent, StageEvent);
    let is_form = |name: &str| name == MeshForm::name() || name == JobForm::name();
    let closed = |schema| {
        changed(schema, |form| {
            form.additional_properties = Some(Box::new(AdditionalProperties::FreeForm(false)));
        })
    };
    schemas
        .into_iter()
        .map(|(name, schema)| if is_form(&name) { (name, closed(schema)) } else { (name, schema) })
        .collect()
}

fn complete_operation(path: &str, operation: &mut Operation) {
    let id = operation.operation_id.clone().unwrap_or_default();
    if !path.starts_with("/v1/") {
        return;
    }
    operation.security = Some(vec![
        SecurityRequirement::default(),
        SecurityRequirement::new("bearer", [""; 0]),
        SecurityRequirement::new("key", [""; 0]),
    ]);
    add_problems(operation, COMMON);
    match id.as_str() {
        "analyze" | "plan" | "verify" => complete_run(operation, &[]),
        "repair" | "convert" | "simplify" | "cut_stitch" => {
            complete_run(operation, MESH_OUT);
            add_answer(operation, "200", mesh_answer().build());
        }
        "create_job" => {
            operation.request_body = Some(RefOr::T(upload_body::<JobForm>(requiring_input::<JobRequest>())));
            add_parameter(operation, cancel_after());
            add_parameter(operation, idempotency_key());
            add_problems(operation, UPLOAD);
            add_problems(operation, &[ProblemCode::WebhookRefused]);
            add_answer(operation, "202", accepted());
        }
        "list_jobs" => {
            add_problems(operation, &[ProblemCode::StoreUnavailable]);
            let label = text().pattern(Some("^[A-Za-z0-9._/-]{1,63}:[ -~]{0,255}$"));
            let labels = ArrayBuilder::new().items(label).min_items(Some(1)).max_items(Some(LABELS_MAX));
            let about =
                "Only jobs with this label, as NAME:VALUE; with all of them when it is given several times.";
            let parameter = ParameterBuilder::new()
                .name("label")
                .parameter_in(ParameterIn::Query)
                .description(Some(about))
                .schema(Some(labels));
            add_parameter(operation, parameter.build());
        }
        "events" => {
            add_problems(operation, JOB);
            let id = text().pattern(Some(r"^[0-9]{1,9}(\.[0-9]{1,9})?$"));
            let about = "Id of the last event that the client has seen; those after it follow. Default: all.";
            add_parameter(operation, header_parameter("Last-Event-ID", about, id));
            add_answer(operation, "200", event_stream());
        }
        "report" => {
            add_problems(operation, &[JOB, PRODUCT, RUN].concat());
            add_answer(operation, "200", report_answer());
        }
        "result" => {
            add_problems(
                operation,
                &[JOB, PRODUCT, RUN, MESH_OUT, &[ProblemCode::RangeNotSatisfiable]].concat(),
            );
            add_answer(operation, "200", file_answer("The mesh."));
            add_answer(operation, "206", file_answer("The part of the mesh that `Range` asks for."));
            add_answer(operation, "304", Response::new("Not changed."));
            add_parameter(operation, header_parameter("Range", "One range of bytes.", text()));
        }
        _ if path.starts_with("/v1/jobs/") => add_problems(operation, JOB),
        _ => {}
    }
}

/// An operation that runs an upload.
fn complete_run(operation: &mut Operation, more_problems: &[ProblemCode]) {
    operation.request_body = Some(RefOr::T(upload_body::<MeshForm>(requiring_input::<Options>())));
    add_parameter(
        operation,
        header_parameter(
            "Prefer",
            "`wait=N`: answer 202 after N seconds, at most 300, if the job has not ended (default 60). \
             `respond-async`: at once.",
            text(),
        ),
    );
    add_parameter(operation, cancel_after());
    add_parameter(operation, idempotency_key());
    add_problems(operation, &[UPLOAD, RUN, more_problems].concat());
    add_answer(operation, "202", accepted());
}

fn upload_body<Form: ToSchema>(json: impl Into<RefOr<Schema>>) -> RequestBody {
    let mesh = || Content::new(Some(binary()));
    let raw = [OCTET_STREAM, "application/x-www-form-urlencoded"].into_iter();
    let named = Format::ALL.iter().map(|&format| wire::media_type_of(format));
    let body = RequestBodyBuilder::new()
        .description(Some(
            "The mesh itself, with or without a media type that names its format; or a form; or, to use an earlier \
             upload again, options with `input` as JSON.",
        ))
        .required(Some(Required::True));
    let body = raw.chain(named).fold(body, |body, media_type| body.content(media_type, mesh()));
    let json_part = || Encoding::builder().content_type(Some("application/json")).build();
    let form = ContentBuilder::new()
        .schema(Some(reference::<Form>()))
        .encoding("params", json_part())
        .encoding("job", json_part());
    body.content("multipart/form-data", form.build())
        .content("application/json", Content::new(Some(json)))
        .build()
}

/// JSON that comes without a mesh: it must name the earlier job whose upload is used again.
fn requiring_input<T: ToSchema>() -> RefOr<Schema> {
    changed(T::schema(), |object| object.required.push("input".to_owned()))
}

/// Options that come beside a mesh.
fn options_without_input() -> RefOr<Schema> {
    changed(Options::schema(), without_input)
}

/// A request that comes beside a mesh.
fn request_without_input() -> RefOr<Schema> {
    changed(JobRequest::schema(), |object| {
        without_input(object);
        object.properties.insert("params".to_owned(), options_without_input());
    })
}

fn without_input(object: &mut Object) {
    object.properties.shift_remove("input");
}

fn changed(schema: RefOr<Schema>, change: impl FnOnce(&mut Object)) -> RefOr<Schema> {
    match schema {
        RefOr::T(Schema::Object(mut object)) => {
            change(&mut object);
            RefOr::T(Schema::Object(object))
        }
        other => other,
    }
}

fn binary() -> Schema {
    let format = SchemaFormat::KnownFormat(KnownFormat::Binary);
    Schema::Object(text().format(Some(format)).build())
}

fn reference<T: ToSchema>() -> Ref {
    Ref::from_schema_name(T::name())
}

/// 202 of every operation.
fn accepted() -> Response {
    ResponseBuilder::new()
        .description("The job is under way; `Location` is where.")
        .content("application/json", Content::new(Some(reference::<Job>())))
        .header("Location", header("The job."))
        .header("Preference-Applied", header("Which preferences were followed."))
        .build()
}

/// 200 of an operation whose product is a mesh: the mesh, the report, or both.
fn mesh_answer() -> ResponseBuilder {
    let outcome = HeaderBuilder::new()
        .description(Some("What became of the file."))
        .schema(Some(RefOr::from(reference::<Outcome>())))
        .build();
    mesh_contents(ResponseBuilder::new().description("The mesh, its report, or both, as `Accept` asks for."))
        .content("application/json", Content::new(Some(reference::<Report>())))
        .content("multipart/mixed", Content::new(Some(binary())))
        .content("application/zip", Content::new(Some(binary())))
        .header("Meshmend-Outcome", outcome)
        .header("Link", header("The report, as `describedby`."))
        .header("Preference-Applied", header("Which preferences were followed."))
        .header("Server-Timing", header("Time of each pass."))
}

/// 200 of the events of a job: the schema is that of one event.
fn event_stream() -> Response {
    let event = ObjectBuilder::new()
        .property("event", text().enum_values(Some(["state", "stage"])))
        .property("id", text().description(Some("What to come back with as `Last-Event-ID`.")))
        .property("data", text().description(Some("JSON: a `StateEvent` or a `StageEvent`.")))
        .required("event")
        .required("id")
        .required("data");
    ResponseBuilder::new()
        .description("Server-sent events.")
        .content("text/event-stream", Content::new(Some(Schema::Object(event.build()))))
        .build()
}

/// 200 of a kept report: for programs, or for people.
fn report_answer() -> Response {
    ResponseBuilder::new()
        .description("The report, as `Accept` asks for.")
        .content("application/json", Content::new(Some(reference::<Report>())))
        .content("text/html", Content::new(Some(Schema::Object(text().build()))))
        .build()
}

fn file_answer(description: &str) -> Response {
    mesh_contents(ResponseBuilder::new().description(description))
        .header("ETag", header("The digest of the whole mesh."))
        .header("Repr-Digest", header("The SHA-256 of the whole mesh (RFC 9530)."))
        .header("Accept-Ranges", header("`bytes`."))
        .build()
}

fn mesh_contents(answer: ResponseBuilder) -> ResponseBuilder {
    let media_types = Format::ALL.iter().map(|&format| wire::media_type_of(format)).chain([OCTET_STREAM]);
    media_types.fold(answer, |answer, media_type| answer.content(media_type, Content::new(Some(binary()))))
}

fn text() -> ObjectBuilder {
    ObjectBuilder::new().schema_type(Type::String)
}

fn header(description: &str) -> Header {
    HeaderBuilder::new().description(Some(description)).schema(Some(Schema::Object(text().build()))).build()
}

fn cancel_after() -> Parameter {
    let seconds = ObjectBuilder::new().schema_type(Type::Integer).minimum(Some(0));
    header_parameter("Cancel-After", "Seconds after which the job is to be ended.", seconds)
}

fn idempotency_key() -> Parameter {
    let key = text().pattern(Some("^[!-~]{1,255}$"));
    let about = "A key of the client's own for this request: sent again with it, the same request gives the same job, \
                 as long as that is kept.";
    header_parameter("Idempotency-Key", about, key)
}

fn header_parameter(name: &str, description: &str, schema: ObjectBuilder) -> Parameter {
    ParameterBuilder::new()
        .name(name)
        .parameter_in(ParameterIn::Header)
        .required(Required::False)
        .description(Some(description))
        .schema(Some(Schema::Object(schema.build())))
        .build()
}

fn add_parameter(operation: &mut Operation, parameter: Parameter) {
    operation.parameters.get_or_insert_default().push(RefOr::T(parameter));
}

fn add_answer(operation: &mut Operation, status: &str, answer: Response) {
    operation.responses.responses.insert(status.to_owned(), RefOr::T(answer));
}

/// Adds an answer for each status of `codes`, which names them all.
fn add_problems(operation: &mut Operation, codes: &[ProblemCode]) {
    let mut by_status = BTreeMap::<u16, Vec<ProblemCode>>::new();
    for &code in codes {
        let listed = by_status.entry(code.status()).or_default();
        if !listed.contains(&code) {
            listed.push(code);
        }
    }
    for (status, codes) in by_status {
        let lines: Vec<_> = codes.iter().map(|code| format!("`{code}`: {}", code.explanation())).collect();
        let answers = &mut operation.responses.responses;
        let answer = answers.entry(status.to_string()).or_insert_with(|| RefOr::T(problem_answer()));
        if let RefOr::T(answer) = answer {
            let known =
                if answer.description.is_empty() { Vec::new() } else { vec![answer.description.clone()] };
            answer.description = [known, lines].concat().join("\n");
        }
    }
}

fn problem_answer() -> Response {
    ResponseBuilder::new()
        .content("application/problem+json", Content::new(Some(reference::<Problem>())))
        .build()
}
