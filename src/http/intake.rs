//! From a request's body to an upload on disk and options.

use axum::body::Body;
use axum::http::{HeaderMap, header};

use super::body::{BodyLimits, IncomingBody};
use super::entrance::{Entrance, Intake, finish_if_any};
use super::form;
use super::multipart;
use super::sizes::{FORM_EXTRA_BYTES_MAX, JSON_BYTES_MAX};
use super::state::{Caller, HttpService};
use crate::jobs::Uploaded;
use crate::wire::{Format, Operation, Problem, ProblemCode, format_of_media_type};

/// Longest `Idempotency-Key`.
const KEY_BYTES_MAX: usize = 255;

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
        check_encoding(headers)?;
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

/// Refuses a body in an encoding that nobody has undone.
pub(super) fn check_encoding(headers: &HeaderMap) -> Result<(), Problem> {
    let encoding =
        headers.get(header::CONTENT_ENCODING).map(|value| value.to_str().unwrap_or_default().trim());
    match encoding {
        None | Some("") => Ok(()),
        Some(encoding) if encoding.eq_ignore_ascii_case("identity") => Ok(()),
        Some(encoding) => Err(Problem::new(
            ProblemCode::UnsupportedMediaType,
            format!("`Content-Encoding: {encoding}` is not read here; send the body with `gzip` or as it is"),
        )
        .with_allowed(["gzip", "identity"])),
    }
}

/// Receives the body. `operation` is what the path means; `None`: the body says it.
pub(super) async fn receive(
    service: &HttpService,
    caller: &Caller,
    headers: &HeaderMap,
    body: Body,
    operation: Option<Operation>,
) -> Result<Intake, Problem> {
    let kind = BodyKind::of(headers)?;
    let key = idempotency_key(headers)?;
    let is_repeat = match &key {
        Some(key) => service.jobs.has_made(caller.owner.clone(), key.clone()).await?,
        None => false,
    };
    let entrance = Entrance { jobs: &service.jobs, tenant: &caller.tenant, is_repeat };
    let intake = match kind {
        BodyKind::Mesh(named) => {
            let body = IncomingBody::new(headers, body, service.upload_limits(0))?;
            Intake { upload: receive_mesh(&entrance, body).await?, named, ..Intake::default() }
        }
        BodyKind::Form(boundary) => {
            let body = IncomingBody::new(headers, body, service.upload_limits(FORM_EXTRA_BYTES_MAX))?;
            form::receive(&entrance, body, &boundary, operation).await?
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
            intake
        }
    };
    Ok(Intake { key, is_repeat, ..intake })
}

/// Streams a raw body to disk; `None` when it has no byte.
async fn receive_mesh(entrance: &Entrance<'_>, mut body: IncomingBody) -> Result<Option<Uploaded>, Problem> {
    let received = stream(entrance, &mut body).await;
    if received.is_err() {
        body.discard_small().await;
    }
    received
}

async fn stream(entrance: &Entrance<'_>, body: &mut IncomingBody) -> Result<Option<Uploaded>, Problem> {
    if body.is_over() {
        return Ok(None);
    }
    let mut upload = entrance.upload(body.announced()).await?;
    while let Some(piece) = body.next().await? {
        upload.write(&piece).await?;
    }
    finish_if_any(upload).await
}

/// The key of `Idempotency-Key`, as it stands there.
fn idempotency_key(headers: &HeaderMap) -> Result<Option<String>, Problem> {
    let Some(value) = headers.get("idempotency-key") else { return Ok(None) };
    let is_key = |key: &&str| {
        (1..=KEY_BYTES_MAX).contains(&key.len()) && key.bytes().all(|byte| byte.is_ascii_graphic())
    };
    let key = value.to_str().ok().filter(is_key);
    match key {
        Some(key) => Ok(Some(key.to_owned())),
        None => Err(Problem {
            parameter: Some("Idempotency-Key".to_owned()),
            ..Problem::new(
                ProblemCode::InvalidParameter,
                format!("`Idempotency-Key` is 1 to {KEY_BYTES_MAX} visible ASCII characters"),
            )
        }),
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
    fn an_encoding_that_nobody_has_undone_is_refused() {
        let of = |encoding| {
            let value = HeaderValue::from_static(encoding);
            BodyKind::of(&HeaderMap::from_iter([(header::CONTENT_ENCODING, value)])).map_err(|p| p.code)
        };
        assert_eq!(of("identity"), Ok(BodyKind::Mesh(None)));
        assert_eq!(of("br"), Err(ProblemCode::UnsupportedMediaType));
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
