//! The contract: the OpenAPI document that is made from the routes and the wire types.
//!
//! Handlers say their path, parameters and plain answers. What several of them share is said once here: bodies of
//! uploads, answers in several media types, headers, and the problems each may answer with.

mod bodies;
mod uploads;
mod yaml;

use std::collections::BTreeMap;

use utoipa::openapi::header::HeaderBuilder;
use utoipa::openapi::path::{Operation, Parameter, ParameterBuilder, ParameterIn};
use utoipa::openapi::response::{Response, ResponseBuilder};
use utoipa::openapi::schema::{ArrayBuilder, KnownFormat, ObjectBuilder, Schema, SchemaFormat, Type};
use utoipa::openapi::security::{
    ApiKey, ApiKeyValue, Http, HttpAuthScheme, SecurityRequirement, SecurityScheme,
};
use utoipa::openapi::{Content, Header, InfoBuilder, OpenApi, Ref, RefOr, Required};
use utoipa::{PartialSchema as _, ToSchema};

pub(super) use self::yaml::yaml;
use super::representation::PNG;
use crate::wire::{
    self, BuildDirection, Contact, Criterion, Cut, Degenerate, DrawnEdges, DualEmbedding, EditSpec, Effort,
    Fidelity, FillHoles, Format, InputRef, Job, JobRequest, LABELS_MAX, Mode, Nesting, OpenShells, Options,
    Outcome, PictureFormat, Placement, PlanRequest, PolicyName, Problem, ProblemCode, Projection, RangeSpec,
    Reader, Report, Require, SetOperation, Shade, SolidParts, StageEvent, StateEvent, Stitch, StitchValidity,
    TargetSpec, Units, VertexColors, Views, WebhookMessage, Weld,
};

/// Problems that any path may answer with.
const COMMON: &[ProblemCode] = &[
    ProblemCode::InvalidParameter,
    ProblemCode::UnknownParameter,
    ProblemCode::Unauthenticated,
    ProblemCode::Forbidden,
    ProblemCode::NotAcceptable,
    ProblemCode::HeadTooLarge,
    ProblemCode::UnsupportedMediaType,
    ProblemCode::RateLimited,
    ProblemCode::Internal,
];
/// Problems of an upload.
const UPLOAD: &[ProblemCode] = &[
    ProblemCode::BodyIncomplete,
    ProblemCode::NotFound,
    ProblemCode::UploadTimeout,
    ProblemCode::Expired,
    ProblemCode::UploadConflict,
    ProblemCode::UploadUnfinished,
    ProblemCode::IdempotencyKeyReused,
    ProblemCode::BodyTooLarge,
    ProblemCode::MeshEmpty,
    ProblemCode::QueueFull,
    ProblemCode::Draining,
    ProblemCode::StoreUnavailable,
    ProblemCode::StorageFull,
];
/// Problems of a job that was run.
const RUN: &[ProblemCode] = &[
    ProblemCode::Expired,
    ProblemCode::Cancelled,
    ProblemCode::PlanMismatch,
    ProblemCode::MeshTooLarge,
    ProblemCode::OverBudget,
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
/// Further problems of a path that changes a job.
const CHANGE: &[ProblemCode] = &[ProblemCode::StorageFull];
/// Problems of what a job has produced.
const PRODUCT: &[ProblemCode] = &[ProblemCode::JobNotFinished, ProblemCode::Expired];

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
    let options = wire::option_parameters().map(|(name, parameter)| (name.to_owned(), RefOr::T(parameter)));
    components.parameters.extend(options);
    components.add_security_scheme("bearer", SecurityScheme::Http(Http::new(HttpAuthScheme::Bearer)));
    components
        .add_security_scheme("key", SecurityScheme::ApiKey(ApiKey::Header(ApiKeyValue::new("X-API-Key"))));
    for (path, item) in &mut document.paths.paths {
        let [get, head, post] = [&mut item.get, &mut item.head, &mut item.post];
        let [patch, delete, options] = [&mut item.patch, &mut item.delete, &mut item.options];
        for operation in [get, head, post, patch, delete, options].into_iter().flatten() {
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
    add!(
        JobRequest,
        Options,
        PlanRequest,
        TargetSpec,
        EditSpec,
        RangeSpec,
        InputRef,
        Job,
        Report,
        Problem,
        StateEvent,
        StageEvent,
        WebhookMessage
    );
    add!(Format, Reader, Units, Require, FillHoles, OpenShells, Effort, Nesting, Contact, Mode, Criterion);
    add!(Placement, VertexColors, Cut, Stitch, StitchValidity, Degenerate, PolicyName, BuildDirection);
    add!(DualEmbedding, Weld, SetOperation, SolidParts, Views, Shade, DrawnEdges, Projection, PictureFormat);
    let own = wire::option_schemas().map(|(name, schema)| (name, RefOr::T(schema)));
    schemas.into_iter().chain(own).chain(bodies::schemas()).collect()
}

fn complete_operation(path: &str, operation: &mut Operation) {
    let id = operation.operation_id.clone().unwrap_or_default();
    let Some(name) = path.strip_prefix("/v1/") else { return };
    operation.security = Some(vec![
        SecurityRequirement::default(),
        SecurityRequirement::new("bearer", [""; 0]),
        SecurityRequirement::new("key", [""; 0]),
    ]);
    add_problems(operation, COMMON);
    if let Some(on_mesh) = wire::Operation::from_word(name) {
        return complete_run(operation, on_mesh);
    }
    match id.as_str() {
        "create_job" => {
            operation.request_body = Some(RefOr::T(bodies::of_job()));
            add_options(operation, None);
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
        "get_job_events" => {
            add_problems(operation, JOB);
            let id = text().pattern(Some(r"^[0-9]{1,9}(\.[0-9]{1,9})?$"));
            let about = "Id of the last event that the client has seen; those after it follow. Default: all.";
            add_parameter(operation, header_parameter("Last-Event-ID", about, id));
            add_answer(operation, "200", event_stream());
        }
        "get_job_report" => {
            add_problems(operation, &[JOB, PRODUCT, RUN].concat());
            add_answer(operation, "200", report_answer());
        }
        "get_job_thumbnail" | "get_job_thumbnail_mesh" => {
            let media_type = if id == "get_job_thumbnail" { PNG } else { wire::media_type_of(Format::Glb) };
            add_problems(operation, &[JOB, PRODUCT, RUN].concat());
            add_answer(operation, "200", picture_answer("The picture.", &[media_type]).build());
            add_answer(operation, "304", Response::new("Not changed."));
        }
        "get_job_result" => {
            add_problems(
                operation,
                &[JOB, PRODUCT, RUN, MESH_OUT, &[ProblemCode::RangeNotSatisfiable]].concat(),
            );
            add_answer(operation, "200", file_answer("The mesh."));
            add_answer(operation, "206", file_answer("The part of the mesh that `Range` asks for."));
            add_answer(operation, "304", Response::new("Not changed."));
            add_problems(operation, &[ProblemCode::PresignedRefused]);
            add_parameter(operation, header_parameter("Range", "One range of bytes.", text()));
        }
        "create_upload" | "append_to_upload" | "get_upload" | "delete_upload" | "create_presigned_upload" => {
            uploads::complete(&id, operation);
        }
        "cancel_job" | "delete_job" => add_problems(operation, &[JOB, CHANGE].concat()),
        _ if path.starts_with("/v1/jobs/") => add_problems(operation, JOB),
        _ => {}
    }
    if ["get_job", "cancel_job", "delete_job", "get_job_result"].contains(&id.as_str()) {
        let about = "The `ETag` that the client has seen: 412 when there is another version by now.";
        add_parameter(operation, header_parameter("If-Match", about, text()));
        add_problems(operation, &[ProblemCode::PreconditionFailed]);
    }
}

/// An operation that runs an upload.
fn complete_run(operation: &mut Operation, on_mesh: wire::Operation) {
    operation.request_body = Some(RefOr::T(bodies::of_operation(on_mesh)));
    add_options(operation, Some(on_mesh));
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
    add_problems(operation, &[UPLOAD, RUN].concat());
    add_answer(operation, "202", accepted());
    if on_mesh == wire::Operation::Render {
        let types = [PNG, wire::media_type_of(Format::Glb)];
        let answer = picture_answer("The picture, or the report, as `Accept` asks for.", &types);
        let answer = answer.content("application/json", Content::new(Some(reference::<Report>())));
        add_answer(operation, "200", with_headers_of_run(answer).build());
    } else if on_mesh.makes_mesh() {
        add_problems(operation, MESH_OUT);
        add_answer(operation, "200", mesh_answer().build());
    } else {
        let report = Content::new(Some(reference::<Report>()));
        let answer = ResponseBuilder::new().description("The report.").content("application/json", report);
        add_answer(operation, "200", with_headers_of_run(answer).build());
    }
}

/// Refers to the options that `on_mesh` takes.
fn add_options(operation: &mut Operation, on_mesh: Option<wire::Operation>) {
    let references = wire::options_of(on_mesh)
        .map(|spec| RefOr::Ref(Ref::new(format!("#/components/parameters/{}", spec.name))));
    operation.parameters.get_or_insert_default().extend(references);
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
    let fidelity = HeaderBuilder::new()
        .description(Some("How true the result is to the file."))
        .schema(Some(RefOr::from(reference::<Fidelity>())))
        .build();
    let answer = mesh_contents(
        ResponseBuilder::new().description("The mesh, its report, or both, as `Accept` asks for."),
    )
    .content("application/json", Content::new(Some(reference::<Report>())))
    .content("multipart/mixed", Content::new(Some(binary())))
    .content("application/zip", Content::new(Some(binary())))
    .header("Meshmend-Outcome", outcome)
    .header("Meshmend-Fidelity", fidelity);
    with_headers_of_run(answer)
}

/// With the headers of every answer about a run that has ended.
fn with_headers_of_run(answer: ResponseBuilder) -> ResponseBuilder {
    answer
        .header("Link", header("The report, as `describedby`."))
        .header("Preference-Applied", header("Which preferences were followed."))
        .header("Server-Timing", header("Time of each pass."))
}

/// 200 of the events of a job: text that a client reads as it comes.
fn event_stream() -> Response {
    let events = text().description(Some(
        "Events, each with `event` (`state` or `stage`), `id` (what to come back with as `Last-Event-ID`) and `data` \
         (JSON: a `StateEvent` or a `StageEvent`).",
    ));
    ResponseBuilder::new()
        .description("Server-sent events.")
        .content("text/event-stream", Content::new(Some(Schema::Object(events.build()))))
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

fn picture_answer(description: &str, media_types: &[&str]) -> ResponseBuilder {
    let answer = ResponseBuilder::new().description(description);
    let with = |answer: ResponseBuilder, media_type: &&str| {
        answer.content(*media_type, Content::new(Some(binary())))
    };
    media_types.iter().fold(answer, with).header("ETag", header("The digest of the picture."))
}

fn file_answer(description: &str) -> Response {
    mesh_contents(ResponseBuilder::new().description(description))
        .header("ETag", header("The digest of the whole mesh."))
        .header("Repr-Digest", header("The SHA-256 of the whole mesh (RFC 9530)."))
        .header("Accept-Ranges", header("`bytes`."))
        .build()
}

/// A mesh in any format. The type that every mesh has stands first: generators of clients look no further, but for a name
/// that ends in `+json`, which they would ask for first. So glTF is only one of `model/*` here.
fn mesh_contents(answer: ResponseBuilder) -> ResponseBuilder {
    let media_types =
        bodies::mesh_media_types().map(|name| if name.ends_with("+json") { "model/*" } else { name });
    media_types.fold(answer, |answer, media_type| answer.content(media_type, Content::new(Some(binary()))))
}

fn binary() -> Schema {
    let format = SchemaFormat::KnownFormat(KnownFormat::Binary);
    Schema::Object(text().format(Some(format)).build())
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
        let lines = codes.iter().map(|code| format!("`{code}`: {}", code.explanation()));
        let answers = &mut operation.responses.responses;
        let answer = answers.entry(status.to_string()).or_insert_with(|| RefOr::T(problem_answer()));
        if let RefOr::T(answer) = answer {
            let mut told: Vec<String> = answer.description.lines().map(str::to_owned).collect();
            for line in lines {
                if !told.contains(&line) {
                    told.push(line);
                }
            }
            answer.description = told.join("\n");
        }
    }
}

fn problem_answer() -> Response {
    ResponseBuilder::new()
        .content("application/problem+json", Content::new(Some(reference::<Problem>())))
        .build()
}
