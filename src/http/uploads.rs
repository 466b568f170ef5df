//! `/v1/uploads` and below: a mesh that comes before its job, over as many requests as it takes, by the protocol tus 1.0.0
//! (<https://tus.io/protocols/resumable-upload>) with its extensions creation, creation-with-upload, expiration and
//! termination.

use axum::Extension;
use axum::body::Body;
use axum::extract::Request;
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse as _, Response};
use jiff::Timestamp;
use tracing::Instrument as _;

use super::body::{BodyLimits, IncomingBody};
use super::intake::check_encoding;
use super::lifecycle::Id;
use super::problem::{Handled, ProblemAnswer};
use super::query;
use super::state::{Caller, HttpService, State};
use crate::jobs::{AskedUpload, Jobs, UploadId, UploadPieces, UploadRow};
use crate::wire::{Problem, ProblemCode, UploadInfo};

/// The version of the protocol.
const VERSION: &str = "1.0.0";
const EXTENSIONS: &str = "creation,creation-with-upload,expiration,termination";
/// Media type of bytes of an upload.
const BYTES: &str = "application/offset+octet-stream";
/// Longest `Upload-Metadata`, in bytes.
const METADATA_BYTES_MAX: usize = 4 << 10;
/// What the name of the file is called in it.
const FILE_NAMES: [&str; 2] = ["filename", "name"];

const RESUMABLE: HeaderName = HeaderName::from_static("tus-resumable");
const VERSIONS: HeaderName = HeaderName::from_static("tus-version");
const EXTENSION: HeaderName = HeaderName::from_static("tus-extension");
const MAX_SIZE: HeaderName = HeaderName::from_static("tus-max-size");
const CONCAT: HeaderName = HeaderName::from_static("upload-concat");
const LENGTH: HeaderName = HeaderName::from_static("upload-length");
const OFFSET: HeaderName = HeaderName::from_static("upload-offset");
const METADATA: HeaderName = HeaderName::from_static("upload-metadata");
const EXPIRES: HeaderName = HeaderName::from_static("upload-expires");

/// Tells the version of the protocol with every answer.
pub(super) async fn tell_version(mut response: Response) -> Response {
    for name in [RESUMABLE, VERSIONS] {
        response.headers_mut().insert(name, HeaderValue::from_static(VERSION));
    }
    response
}

/// Ask what uploads may be.
///
/// The versions and extensions of the protocol (tus) that are spoken here, and the largest upload, as headers.
#[utoipa::path(options, path = "/v1/uploads", operation_id = "get_upload_protocol", tag = "uploads", responses(
    (status = 204, description = "As the headers say.", headers(
        ("Tus-Version" = String, description = "Versions."),
        ("Tus-Extension" = String, description = "Extensions."),
        ("Tus-Max-Size" = String, description = "Largest upload, in bytes.")))))]
pub(super) async fn protocol(state: State, request: Request) -> Handled {
    query::none(request.uri())?;
    let size = state.jobs.settings().upload_bytes_max.to_string();
    let headers = [(EXTENSION, EXTENSIONS.to_owned()), (MAX_SIZE, size)];
    Ok((StatusCode::NO_CONTENT, headers).into_response())
}

/// Begin an upload.
///
/// `Location` is where its bytes are then sent. What is sent at once with `Content-Type: application/offset+octet-stream` are its
/// first bytes.
#[utoipa::path(post, path = "/v1/uploads", operation_id = "create_upload", tag = "uploads", responses(
    (status = 201, description = "The upload.", body = UploadInfo, headers(
        ("Location" = String, description = "The upload."),
        ("Upload-Offset" = String, description = "Bytes that are stored."),
        ("Upload-Expires" = String, description = "When it goes, unless more of it comes.")))))]
pub(super) async fn create(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    let (head, body) = request.into_parts();
    check_version(&head.headers)?;
    query::none(&head.uri)?;
    check_encoding(&head.headers)?;
    let brings_bytes = match media_type(&head.headers) {
        "" => false,
        BYTES => true,
        _ => return Err(not_bytes("an upload begins without a body, or with its first bytes").into()),
    };
    let metadata = metadata(&head.headers)?;
    let asked = AskedUpload {
        owner: caller.owner.clone(),
        tenant: caller.tenant.clone(),
        file_name: metadata.as_deref().and_then(file_name),
        metadata,
        length: length(&head.headers)?,
    };
    let mut row = state.jobs.create_upload(asked).await?;
    if brings_bytes {
        let pieces = state.jobs.receive_pieces(row.id, row.owner.as_deref(), 0).await?;
        // The upload is there: a client that hears of no offset asks where it stands.
        match received(&state, pieces, &head.headers, body).await {
            Ok(pieces) => (row.received, row.expires_at) = (pieces.received(), pieces.expires_at()),
            // The client does not know its own length.
            Err(problem) if problem.code == ProblemCode::BodyTooLarge => {
                state.jobs.delete_upload(row.id, caller.owner.as_deref()).await?;
                return Err(problem.into());
            }
            Err(_) => row = state.jobs.get_upload(row.id, caller.owner.as_deref()).await?,
        }
    }
    let place = [(header::LOCATION, format!("/v1/uploads/{}", row.id))];
    Ok((
        StatusCode::CREATED,
        place,
        standing(row.received, row.expires_at),
        super::answer::json_answer(&info(&row)),
    )
        .into_response())
}

/// Ask where an upload stands.
///
/// `Upload-Offset` is how many bytes are stored, from the first one on: the next one is to be sent then. Of a presigned upload all
/// are, once the bucket has them.
#[utoipa::path(head, path = "/v1/uploads/{id}", operation_id = "get_upload", tag = "uploads",
    params(("id" = String, Path, description = "Id of the upload.")),
    responses((status = 200, description = "As the headers say.", headers(
        ("Upload-Offset" = String, description = "Bytes that are stored."),
        ("Upload-Length" = String, description = "Bytes that it is to have."),
        ("Upload-Metadata" = String, description = "As it was sent."),
        ("Upload-Expires" = String, description = "When it goes, unless more of it comes.")))))]
pub(super) async fn stand(state: State, caller: Extension<Caller>, id: Id, request: Request) -> Handled {
    check_version(request.headers())?;
    query::none(request.uri())?;
    let row = state.jobs.get_upload(id_of(id)?, caller.owner.as_deref()).await?;
    let mut headers = standing(row.received, row.expires_at);
    headers.insert(LENGTH, HeaderValue::from(row.length));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    if let Some(metadata) = row.metadata.as_deref().and_then(|text| HeaderValue::from_str(text).ok()) {
        headers.insert(METADATA, metadata);
    }
    Ok((StatusCode::OK, headers).into_response())
}

/// Send bytes of an upload.
///
/// From `Upload-Offset` on, which is where the upload stands. What has come is kept, also when the connection breaks: ask where the
/// upload stands, and go on from there.
#[utoipa::path(patch, path = "/v1/uploads/{id}", operation_id = "append_to_upload", tag = "uploads",
    params(("id" = String, Path, description = "Id of the upload.")),
    responses((status = 204, description = "All that was sent is stored.", headers(
        ("Upload-Offset" = String, description = "Bytes that are stored."),
        ("Upload-Expires" = String, description = "When it goes, unless more of it comes.")))))]
pub(super) async fn append(state: State, caller: Extension<Caller>, id: Id, request: Request) -> Handled {
    let (head, body) = request.into_parts();
    check_version(&head.headers)?;
    query::none(&head.uri)?;
    if media_type(&head.headers) != BYTES {
        return Err(not_bytes("what is sent are bytes of an upload").into());
    }
    check_encoding(&head.headers)?;
    let at = number(&head.headers, &OFFSET)?;
    let pieces = state.jobs.receive_pieces(id_of(id)?, caller.owner.as_deref(), at).await?;
    let pieces = received(&state, pieces, &head.headers, body).await?;
    Ok((StatusCode::NO_CONTENT, standing(pieces.received(), pieces.expires_at())).into_response())
}

/// Delete an upload.
///
/// What has come of it goes. A job that was made of it keeps its mesh.
#[utoipa::path(delete, path = "/v1/uploads/{id}", operation_id = "delete_upload", tag = "uploads",
    params(("id" = String, Path, description = "Id of the upload.")),
    responses((status = 204, description = "The upload is gone.")))]
pub(super) async fn delete(state: State, caller: Extension<Caller>, id: Id, request: Request) -> Handled {
    check_version(request.headers())?;
    query::none(request.uri())?;
    state.jobs.delete_upload(id_of(id)?, caller.owner.as_deref()).await?;
    Ok(StatusCode::NO_CONTENT.into_response())
}

/// Receives what the body brings. Also when the client goes away meanwhile, which ends the request, what has come is stored.
async fn received(
    service: &HttpService,
    mut pieces: UploadPieces,
    headers: &HeaderMap,
    body: Body,
) -> Result<UploadPieces, Problem> {
    let limits = BodyLimits {
        bytes_max: pieces.length() - pieces.received(),
        bytes_max_name: "upload_length",
        ..service.upload_limits(0)
    };
    let mut body = IncomingBody::new(headers, body, limits)?;
    let jobs = service.jobs.clone();
    let receiving = async move {
        let taken = take_all(&jobs, &mut pieces, &mut body).await;
        let kept = pieces.keep().await;
        if taken.is_err() || kept.is_err() {
            body.discard_small().await;
        }
        // Where a disk or another request is in the way, the body is not what is at fault.
        kept.and(taken).map(|()| pieces)
    };
    let receiving = tokio::spawn(receiving.in_current_span());
    receiving.await.map_err(|error| Problem::new(ProblemCode::Internal, error.to_string()))?
}

/// Takes what comes until the body or the service ends. The rest of an upload may take longer than a server that ends has; the client
/// sends it to another one.
async fn take_all(jobs: &Jobs, pieces: &mut UploadPieces, body: &mut IncomingBody) -> Result<(), Problem> {
    loop {
        tokio::select! {
            bytes = body.next() => match bytes? {
                Some(bytes) => pieces.write(&bytes).await?,
                None => return Ok(()),
            },
            () = pieces.patience() => pieces.keep().await?,
            problem = jobs.closed() => return Err(problem),
        }
    }
}

/// The upload as JSON.
pub(super) fn info(row: &UploadRow) -> UploadInfo {
    UploadInfo {
        id: row.id.to_string(),
        length: row.length,
        received: row.received,
        expires_at: row.expires_at,
        put: None,
    }
}

/// Where an upload stands, as headers.
fn standing(received: u64, expires_at: Timestamp) -> HeaderMap {
    let mut headers = HeaderMap::from_iter([(OFFSET, HeaderValue::from(received))]);
    let date = jiff::fmt::rfc2822::DateTimePrinter::new().timestamp_to_rfc9110_string(&expires_at);
    if let Some(date) = date.ok().and_then(|date| HeaderValue::from_str(&date).ok()) {
        headers.insert(EXPIRES, date);
    }
    headers
}

/// The id in a path.
fn id_of(id: Id) -> Result<UploadId, ProblemAnswer> {
    let id = id.ok().and_then(|path| path.0.parse().ok());
    id.ok_or_else(|| ProblemAnswer::new(ProblemCode::NotFound, "there is no such upload"))
}

fn check_version(headers: &HeaderMap) -> Result<(), Problem> {
    if headers.get(RESUMABLE).is_some_and(|version| version == VERSION) {
        return Ok(());
    }
    let detail = format!("uploads are sent with `Tus-Resumable: {VERSION}`");
    Err(about(&RESUMABLE, Problem::new(ProblemCode::UnsupportedVersion, detail)).with_allowed([VERSION]))
}

fn media_type(headers: &HeaderMap) -> &str {
    let text = headers.get(header::CONTENT_TYPE).map_or("", |value| value.to_str().unwrap_or("unreadable"));
    text.split(';').next().unwrap_or_default().trim()
}

fn not_bytes(what: &str) -> Problem {
    let detail = format!("{what}, with `Content-Type: {BYTES}`");
    Problem::new(ProblemCode::UnsupportedMediaType, detail).with_allowed([BYTES])
}

fn about(header: &HeaderName, problem: Problem) -> Problem {
    Problem { parameter: Some(header.to_string()), ..problem }
}

/// The number of bytes in a header.
fn number(headers: &HeaderMap, name: &HeaderName) -> Result<u64, Problem> {
    let value = headers.get(name).and_then(|value| value.to_str().ok());
    let digits = value.filter(|text| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit()));
    let Some(digits) = digits else {
        let detail = format!("`{name}` is to be a number of bytes");
        return Err(about(name, Problem::new(ProblemCode::InvalidParameter, detail)));
    };
    // More than can be counted is more than there may be.
    Ok(digits.parse().unwrap_or(u64::MAX))
}

fn length(headers: &HeaderMap) -> Result<u64, Problem> {
    if headers.contains_key("upload-defer-length") {
        let detail = "the length of an upload is said when it begins, in `Upload-Length`";
        return Err(about(&LENGTH, Problem::new(ProblemCode::InvalidParameter, detail)));
    }
    if headers.contains_key(CONCAT) {
        let detail = "uploads are not put together of others here";
        return Err(about(&CONCAT, Problem::new(ProblemCode::InvalidParameter, detail)));
    }
    number(headers, &LENGTH)
}

/// `Upload-Metadata` as it stands there: pairs of a name and a value in base64, or names alone, with commas in between.
fn metadata(headers: &HeaderMap) -> Result<Option<String>, Problem> {
    let Some(value) = headers.get(METADATA) else { return Ok(None) };
    let is_pair = |pair: &str| {
        let mut words = pair.trim().splitn(2, ' ');
        let name = words.next().unwrap_or_default();
        let value = words.next().unwrap_or_default();
        !name.is_empty() && unpacked(value).is_some()
    };
    let text = value.to_str().ok().filter(|text| text.len() <= METADATA_BYTES_MAX);
    match text {
        Some(text) if text.trim().is_empty() => Ok(None),
        Some(text) if text.split(',').all(is_pair) => Ok(Some(text.to_owned())),
        _ => {
            let detail = format!(
                "`Upload-Metadata` is at most {METADATA_BYTES_MAX} bytes of pairs of a name and a value in base64, with commas \
                 in between"
            );
            Err(about(&METADATA, Problem::new(ProblemCode::InvalidParameter, detail)))
        }
    }
}

fn unpacked(base64: &str) -> Option<Vec<u8>> {
    use base64::Engine as _;
    base64::engine::general_purpose::STANDARD.decode(base64).ok()
}

/// The name of the file in the metadata.
fn file_name(metadata: &str) -> Option<String> {
    let pairs = metadata.split(',').filter_map(|pair| pair.trim().split_once(' '));
    let named = pairs.filter(|(name, _)| FILE_NAMES.contains(name));
    let names = named.filter_map(|(_, value)| String::from_utf8(unpacked(value)?).ok());
    names.into_iter().find(|name| !name.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(name: HeaderName, value: &'static str) -> HeaderMap {
        HeaderMap::from_iter([(name, HeaderValue::from_static(value))])
    }

    #[test]
    fn a_length_is_said_in_digits_when_an_upload_begins() {
        assert_eq!(length(&with(LENGTH, "17")).unwrap(), 17);
        assert_eq!(length(&with(LENGTH, "99999999999999999999")).unwrap(), u64::MAX);
        for text in ["", "-1", "1.5", "+1", "0x1"] {
            assert_eq!(
                length(&with(LENGTH, text)).unwrap_err().code,
                ProblemCode::InvalidParameter,
                "{text}"
            );
        }
        assert!(length(&HeaderMap::new()).is_err());
        assert!(length(&with(HeaderName::from_static("upload-defer-length"), "1")).is_err());
    }

    #[test]
    fn metadata_is_kept_as_it_came_and_names_the_file() {
        let text = "filename cGFydCBvbmUuc3Rs,is_confidential,type bW9kZWwvc3Rs";
        let kept = metadata(&with(METADATA, text)).unwrap().unwrap();
        assert_eq!((kept.as_str(), file_name(&kept).as_deref()), (text, Some("part one.stl")));
        assert_eq!(file_name("name YQ==").as_deref(), Some("a"));
        assert_eq!(file_name("other YQ=="), None);
        assert_eq!(metadata(&HeaderMap::new()).unwrap(), None);
        for text in ["filename not-base64!", ",", "a YQ==,,b YQ=="] {
            assert_eq!(
                metadata(&with(METADATA, text)).unwrap_err().code,
                ProblemCode::InvalidParameter,
                "{text}"
            );
        }
    }

    #[test]
    fn another_version_is_refused() {
        assert!(check_version(&with(RESUMABLE, "1.0.0")).is_ok());
        for headers in [HeaderMap::new(), with(RESUMABLE, "0.2.2")] {
            assert_eq!(check_version(&headers).unwrap_err().code, ProblemCode::UnsupportedVersion);
        }
    }
}
