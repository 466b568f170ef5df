//! A stored mesh as an answer: whole or in part, with what tells its version and its bytes.

use axum::body::Body;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse as _, Response};
use tokio::io::{AsyncReadExt as _, AsyncSeekExt as _};
use tokio_util::io::ReaderStream;

use super::problem;
use super::range::HttpRange;
use crate::jobs::StoredFile;
use crate::wire::{Format, Problem, ProblemCode, media_type_of};

/// Bytes read from disk at a time.
const PIECE_BYTES: usize = 128 << 10;

/// The media type of the stored mesh.
pub(super) fn media_type(stored: &StoredFile) -> &'static str {
    media_type_of(Format::from(crate::formats::Encoding::from(stored.encoding).format()))
}

/// The whole mesh.
pub(super) fn whole(stored: StoredFile, media_type: &'static str) -> Response {
    let headers = headers_of(&stored, media_type);
    let length = (header::CONTENT_LENGTH, HeaderValue::from(stored.bytes));
    (headers, [length], Body::from_stream(ReaderStream::with_capacity(stored.file, PIECE_BYTES)))
        .into_response()
}

/// What `request` asks of the mesh: all, a part, or nothing because the client has this version.
pub(super) async fn asked_for(
    mut stored: StoredFile,
    media_type: &'static str,
    request: &HeaderMap,
) -> Response {
    let headers = headers_of(&stored, media_type);
    let etag = etag_of(&stored);
    if let Err(problem) = check_if_match(request, &etag) {
        return problem::respond(problem);
    }
    if matches_etag(request, &etag) {
        return (StatusCode::NOT_MODIFIED, headers).into_response();
    }
    match part(request, &etag, stored.bytes) {
        HttpRange::Whole => whole(stored, media_type),
        HttpRange::Beyond => beyond(stored.bytes),
        HttpRange::Bytes(range) => {
            let (first, last) = (*range.start(), *range.end());
            if let Err(error) = stored.file.seek(std::io::SeekFrom::Start(first)).await {
                return problem::respond(Problem::new(ProblemCode::Internal, format!("result: {error}")));
            }
            let len = last - first + 1;
            let own = [
                (header::CONTENT_RANGE, text(&format!("bytes {first}-{last}/{}", stored.bytes))),
                (header::CONTENT_LENGTH, HeaderValue::from(len)),
            ];
            let body = Body::from_stream(ReaderStream::with_capacity(stored.file.take(len), PIECE_BYTES));
            (StatusCode::PARTIAL_CONTENT, headers, own, body).into_response()
        }
    }
}

/// The part that is asked for, unless it is one of another version (`If-Range`).
fn part(request: &HeaderMap, etag: &str, len: u64) -> HttpRange {
    let is_other = request.get(header::IF_RANGE).is_some_and(|version| version.as_bytes() != etag.as_bytes());
    let asked = request.get(header::RANGE).filter(|_| !is_other).and_then(|value| value.to_str().ok());
    HttpRange::parse(asked, len)
}

fn beyond(len: u64) -> Response {
    let detail = format!("the file has {len} bytes");
    let mut response = problem::respond(Problem::new(ProblemCode::RangeNotSatisfiable, detail));
    response.headers_mut().insert(header::CONTENT_RANGE, text(&format!("bytes */{len}")));
    response
}

fn headers_of(stored: &StoredFile, media_type: &'static str) -> HeaderMap {
    HeaderMap::from_iter([
        (header::CONTENT_TYPE, HeaderValue::from_static(media_type)),
        (header::CONTENT_DISPOSITION, text(&disposition(&stored.file_name))),
        (header::ETAG, text(&etag_of(stored))),
        (header::CACHE_CONTROL, HeaderValue::from_static("private, no-cache")),
        (header::ACCEPT_RANGES, HeaderValue::from_static("bytes")),
        (
            header::HeaderName::from_static("repr-digest"),
            text(&format!("sha-256=:{}:", base64(&stored.sha256))),
        ),
    ])
}

/// A strong validator: the digest of the bytes.
fn etag_of(stored: &StoredFile) -> String {
    format!("\"{}\"", base64(&stored.sha256))
}

/// Whether the client has this version already (`If-None-Match`).
pub(super) fn matches_etag(request: &HeaderMap, etag: &str) -> bool {
    let is_same = |tag: &str| tag == "*" || tag.strip_prefix("W/").unwrap_or(tag) == etag;
    let lines = request.get_all(header::IF_NONE_MATCH).iter().filter_map(|value| value.to_str().ok());
    lines.flat_map(|line| line.split(',')).any(|tag| is_same(tag.trim()))
}

/// Refuses a request that is about another version (`If-Match`). Weak tags match nothing here (RFC 9110, section 13.1.1).
pub(super) fn check_if_match(request: &HeaderMap, etag: &str) -> Result<(), Problem> {
    let mut lines = request.get_all(header::IF_MATCH).iter().peekable();
    let is_same = |tag: &str| tag == "*" || tag == etag;
    let is_met = lines.peek().is_none()
        || lines
            .filter_map(|value| value.to_str().ok())
            .flat_map(|line| line.split(','))
            .any(|tag| is_same(tag.trim()));
    if is_met {
        return Ok(());
    }
    Err(Problem::new(
        ProblemCode::PreconditionFailed,
        "none of the tags in `If-Match` is that of what is there",
    ))
}

/// `Content-Disposition` with the name in plain letters, and as it is where that differs (RFC 6266).
pub(super) fn disposition(file_name: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || " -_.()+,".contains(c);
    let plain: String = file_name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    if plain == file_name {
        return format!("attachment; filename=\"{plain}\"");
    }
    let mut encoded = String::new();
    for byte in file_name.bytes() {
        if byte.is_ascii_alphanumeric() || b"-_.".contains(&byte) {
            encoded.push(char::from(byte));
        } else {
            encoded.push_str(&format!("%{byte:02X}"));
        }
    }
    format!("attachment; filename=\"{plain}\"; filename*=UTF-8''{encoded}")
}

/// A header value; what is no header text (it never is) becomes empty.
fn text(value: &str) -> HeaderValue {
    HeaderValue::from_str(value).unwrap_or(HeaderValue::from_static(""))
}

/// Base64 (RFC 4648, with padding), as digests are written in headers.
pub(super) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut encoded = String::new();
    for chunk in bytes.chunks(3) {
        let bits = (0..3).fold(0_u32, |bits, i| bits << 8 | u32::from(chunk.get(i).copied().unwrap_or(0)));
        for letter in 0..4 {
            let is_padding = letter > chunk.len();
            let sextet = (bits >> (18 - 6 * letter)) & 63;
            encoded.push(if is_padding { '=' } else { char::from(LETTERS[sextet as usize]) });
        }
    }
    encoded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_pads_what_is_not_a_multiple_of_three() {
        // RFC 4648, section 10.
        let pairs = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("foobar", "Zm9vYmFy"),
        ];
        for (plain, encoded) in pairs {
            assert_eq!(base64(plain.as_bytes()), encoded);
        }
    }

    #[test]
    fn a_file_name_cannot_break_out_of_its_header() {
        assert_eq!(disposition("part (2).stl"), "attachment; filename=\"part (2).stl\"");
        assert_eq!(
            disposition("a\"\r\nü.stl"),
            "attachment; filename=\"a____.stl\"; filename*=UTF-8''a%22%0D%0A%C3%BC.stl"
        );
    }

    #[test]
    fn a_request_about_another_version_is_refused() {
        let is_refused = |lines: &[&'static str]| {
            let lines = lines.iter().map(|line| (header::IF_MATCH, HeaderValue::from_static(line)));
            check_if_match(&HeaderMap::from_iter(lines), "\"abc\"").is_err()
        };
        assert!(!is_refused(&[]) && !is_refused(&["*"]) && !is_refused(&["\"x\", \"abc\""]));
        assert!(is_refused(&["\"x\""]) && is_refused(&["W/\"abc\""]) && is_refused(&[""]));
    }

    #[test]
    fn a_known_version_is_recognised_in_a_list_and_when_weak() {
        let request =
            |value| HeaderMap::from_iter([(header::IF_NONE_MATCH, HeaderValue::from_static(value))]);
        assert!(matches_etag(&request("\"x\", W/\"abc\""), "\"abc\""));
        assert!(matches_etag(&request("*"), "\"abc\""));
        assert!(!matches_etag(&request("\"ab\""), "\"abc\""));
        assert!(!matches_etag(&HeaderMap::new(), "\"abc\""));
    }
}
