//! From a request's body to an upload on disk and options.

use axum::body::Body;
use axum::http::{HeaderMap, header};

use super::body::{BodyLimits, IncomingBody};
use super::form;
use super::multipart;
use super::state::Service;
use crate::jobs::Uploaded;
use crate::wire::{
    Format, JobRequest, Labels, Operation, Options, Problem, ProblemCode, WebhookRequest,
    format_of_media_type,
};

/// Largest body that is JSON, in bytes.
pub(super) const JSON_BYTES_MAX: u64 = 1 << 20;

/// What a request brings.
#[derive(Debug, Default)]
pub(super) struct Intake {
    /// The mesh, on disk.
    pub(super) upload: Option<Uploaded>,
    /// The MTL file of an OBJ, on disk.
    pub(super) material: Option<Uploaded>,
    /// The name that the client gave the mesh.
    pub(super) file_name: Option<String>,
    /// The format that the mesh's media type names.
    pub(super) named: Option<Format>,
    /// What to do, as the body says.
    pub(super) operation: Option<Operation>,
    /// Whom to tell of the end, as the body says.
    pub(super) webhook: Option<WebhookRequest>,
    /// What to write on the job, as the body says.
    pub(super) labels: Option<Labels>,
    /// How, as the body says.
    pub(super) options: Options,
}

/// What a body is.
#[derive(Debug, PartialEq, Eq)]
enum BodyKind {
    /// A mesh, perhaps with the format that its media type names.
    Mesh(Option<Format>),
    /// Parts, divided by this boundary.
    Form(String),
    /// Options as JSON.
    Json,
}

impl BodyKind {
    /// Reads `Content-Type`. What curl sends by default is taken for a mesh.
    fn of(headers: &HeaderMap) -> Result<Self, Problem> {
        let Some(value) = headers.get(header::CONTENT_TYPE) else { return Ok(Self::Mesh(None)) };
        let text = value.to_str().unwrap_or_default();
        let essence = text.split(';').next().unwrap_or_default().trim().to_ascii_lowercase();
        match essence.as_str() {
            "" | "application/octet-stream" | "application/x-www-form-urlencoded" => Ok(Self::Mesh(None)),
            "application/json" => Ok(Self::Json),
            "multipart/form-data" => multipart::boundary_of(text).map(Self::Form).ok_or_else(|| {
                Problem::new(ProblemCode::UnsupportedMediaType, "`multipart/form-data` needs a `boundary`")
            }),
            other => match format_of_media_type(other) {
                Some(format) => Ok(Self::Mesh(Some(format))),
                None => Err(Problem::new(
                    ProblemCode::UnsupportedMediaType,
                    format!(
                        "`{other}` is not read here; send the mesh as `application/octet-stream`, as a media type \
                         of `/v1/formats` or as part `mesh` of `multipart/form-data`"
                    ),
                )),
            },
        }
    }
}

/// Receives the body. `operation` is what the path means; `None`: the body says it.
pub(super) async fn receive(
    service: &Service,
    headers: &HeaderMap,
    body: Body,
    operation: Option<Operation>,
) -> Result<Intake, Problem> {
    match BodyKind::of(headers)? {
        BodyKind::Mesh(named) => {
            let body = IncomingBody::new(headers, body, service.upload_limits(0))?;
            Ok(Intake { upload: receive_mesh(service, body).await?, named, ..Intake::default() })
        }
        BodyKind::Form(boundary) => {
            let body = IncomingBody::new(headers, body, service.upload_limits(form::EXTRA_BYTES_MAX))?;
            form::receive(service, body, &boundary, operation).await
        }
        BodyKind::Json => {
            let limits = BodyLimits {
                bytes_max: JSON_BYTES_MAX,
                bytes_max_name: "json_bytes_max",
                ..service.upload_limits(0)
            };
            let text = IncomingBody::new(headers, body, limits)?.into_bytes().await?;
            let mut intake = Intake::default();
            intake.take_json(&text, operation)?;
            Ok(intake)
        }
    }
}

/// Streams a raw body to disk; `None` when it has no byte.
async fn receive_mesh(service: &Service, mut body: IncomingBody) -> Result<Option<Uploaded>, Problem> {
    let received = stream(service, &mut body).await;
    if received.is_err() {
        body.discard_small().await;
    }
    received
}

async fn stream(service: &Service, body: &mut IncomingBody) -> Result<Option<Uploaded>, Problem> {
    let Some(first) = body.next().await? else { return Ok(None) };
    let mut upload = service.jobs.upload(body.announced()).await?;
    upload.write(&first).await?;
    while let Some(piece) = body.next().await? {
        upload.write(&piece).await?;
    }
    upload.finish().await.map(Some)
}

impl Intake {
    /// Takes options from JSON.
    pub(super) fn take_json(&mut self, text: &[u8], operation: Option<Operation>) -> Result<(), Problem> {
        match operation {
            Some(operation) => self.options = JobRequest::params_from_json(text, operation)?,
            None => {
                let request = JobRequest::from_json(text)?;
                self.operation = agreed(self.operation, request.operation)?;
                self.webhook = agreed_member("webhook", self.webhook.take(), request.webhook)?;
                self.labels = agreed_member("labels", self.labels.take(), request.labels)?;
                let said_before = std::mem::take(&mut self.options);
                self.options = said_before.join(request.options).map_err(|error| Problem::from(&error))?;
            }
        }
        Ok(())
    }
}

/// The operation that two parts of a request name: one of them, or both the same.
pub(super) fn agreed(a: Option<Operation>, b: Option<Operation>) -> Result<Option<Operation>, Problem> {
    match (a, b) {
        (Some(a), Some(b)) if a != b => {
            Err(about_operation("`operation` is given twice with different values"))
        }
        _ => Ok(a.or(b)),
    }
}

/// What two parts of a request say about `name`: that of one of them, or of both the same.
pub(super) fn agreed_member<T: PartialEq>(
    name: &str,
    a: Option<T>,
    b: Option<T>,
) -> Result<Option<T>, Problem> {
    match (a, b) {
        (Some(a), Some(b)) if a != b => Err(Problem {
            parameter: Some(name.to_owned()),
            ..Problem::new(
                ProblemCode::InvalidParameter,
                format!("`{name}` is given twice with different values"),
            )
        }),
        (a, b) => Ok(a.or(b)),
    }
}

/// A problem with the operation that a request names.
pub(super) fn about_operation(detail: &str) -> Problem {
    Problem {
        parameter: Some("operation".to_owned()),
        ..Problem::new(ProblemCode::InvalidParameter, detail).with_allowed(Operation::WORDS.iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderValue;

    fn kind(content_type: &'static str) -> Result<BodyKind, ProblemCode> {
        let headers = HeaderMap::from_iter([(header::CONTENT_TYPE, HeaderValue::from_static(content_type))]);
        BodyKind::of(&headers).map_err(|problem| problem.code)
    }

    #[test]
    fn what_curl_sends_by_default_is_a_mesh_of_any_format() {
        assert_eq!(BodyKind::of(&HeaderMap::new()).unwrap(), BodyKind::Mesh(None));
        assert_eq!(kind("application/x-www-form-urlencoded"), Ok(BodyKind::Mesh(None)));
        assert_eq!(kind("application/octet-stream"), Ok(BodyKind::Mesh(None)));
    }

    #[test]
    fn a_mesh_media_type_names_the_format() {
        assert_eq!(kind("Model/STL; x=y"), Ok(BodyKind::Mesh(Some(Format::Stl))));
        assert_eq!(kind("text/off"), Ok(BodyKind::Mesh(Some(Format::Off))));
    }

    #[test]
    fn a_form_needs_its_boundary_and_foreign_types_are_refused() {
        assert_eq!(kind("multipart/form-data; boundary=cut"), Ok(BodyKind::Form("cut".into())));
        assert_eq!(kind("multipart/form-data"), Err(ProblemCode::UnsupportedMediaType));
        assert_eq!(kind("text/html"), Err(ProblemCode::UnsupportedMediaType));
    }
}
