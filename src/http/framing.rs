//! What a head says about itself and about the bytes behind it, before anybody else believes it.

use axum::extract::Request;
use axum::http::uri::Authority;
use axum::http::{HeaderMap, HeaderValue, Version, header};

use crate::wire::{Problem, ProblemCode};

/// Refuses heads that others may read in another way, and writes the encoding of the body in its one spelling.
pub(super) fn check(request: &mut Request) -> Result<(), Problem> {
    check_host(request.version(), request.headers())?;
    check_transfer(request.headers())?;
    plain_encoding(request.headers_mut());
    Ok(())
}

/// HTTP/1.1 asks for exactly one `Host` (RFC 9112, section 3.2).
fn check_host(version: Version, headers: &HeaderMap) -> Result<(), Problem> {
    let hosts: Vec<&HeaderValue> = headers.get_all(header::HOST).iter().collect();
    let detail = match hosts[..] {
        [host] if is_host(host) => return Ok(()),
        [] if version < Version::HTTP_11 => return Ok(()),
        [_] => "the header `Host` is no host with or without a port",
        [] => "the header `Host` is missing",
        _ => "the header `Host` is there twice",
    };
    Err(Problem { parameter: Some("Host".to_owned()), ..Problem::new(ProblemCode::InvalidParameter, detail) })
}

/// Whether this is a host with or without a port, or nothing, which means that there is none.
fn is_host(value: &HeaderValue) -> bool {
    let Ok(text) = value.to_str() else { return false };
    let (host, port) = match text.rsplit_once(':') {
        Some((host, port)) if !port.contains(']') => (host, port),
        _ => (text, ""),
    };
    let is_whole = host.split_once(']').is_none_or(|(_, rest)| rest.is_empty()) && !text.contains('@');
    let is_authority = is_whole && port.bytes().all(|digit| digit.is_ascii_digit());
    text.is_empty() || is_authority && Authority::try_from(text).is_ok()
}

/// A body is sent as it is or in chunks; other transfer codings would be taken for a part of the mesh.
fn check_transfer(headers: &HeaderMap) -> Result<(), Problem> {
    let codings = items(headers, &header::TRANSFER_ENCODING);
    if codings.iter().all(|coding| coding == "chunked") && codings.len() <= 1 {
        return Ok(());
    }
    let detail =
        "`Transfer-Encoding` is not read here but for `chunked`; `Content-Encoding: gzip` compresses a body";
    Err(Problem::new(ProblemCode::UnsupportedMediaType, detail).with_allowed(["chunked"]))
}

/// One line without `identity` and in lower case, so that `GZIP` and `gzip` are one.
fn plain_encoding(headers: &mut HeaderMap) {
    let encodings = items(headers, &header::CONTENT_ENCODING);
    headers.remove(header::CONTENT_ENCODING);
    let encodings: Vec<&str> = encodings
        .iter()
        .filter(|encoding| *encoding != "identity")
        // RFC 9110, section 8.4.1.3.
        .map(|encoding| if encoding == "x-gzip" { "gzip" } else { encoding })
        .collect();
    if let Ok(value) = HeaderValue::from_str(&encodings.join(", "))
        && !encodings.is_empty()
    {
        headers.insert(header::CONTENT_ENCODING, value);
    }
}

/// The items of a list over all of its lines, in lower case.
fn items(headers: &HeaderMap, name: &header::HeaderName) -> Vec<String> {
    let lines =
        headers.get_all(name).iter().map(|value| String::from_utf8_lossy(value.as_bytes()).to_lowercase());
    lines
        .flat_map(|line| line.split(',').map(|item| item.trim().to_owned()).collect::<Vec<_>>())
        .filter(|item| !item.is_empty())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::body::Body;

    fn checked(version: Version, lines: &[(&'static str, &'static str)]) -> Result<HeaderMap, ProblemCode> {
        let mut request = Request::new(Body::empty());
        *request.version_mut() = version;
        for &(name, value) in lines {
            request.headers_mut().append(name, HeaderValue::from_static(value));
        }
        check(&mut request).map_err(|problem| problem.code)?;
        Ok(request.headers().clone())
    }

    #[test]
    fn a_head_has_one_host() {
        let of = |version, lines: &[_]| checked(version, lines).map(drop);
        assert_eq!(of(Version::HTTP_11, &[("host", "a")]), Ok(()));
        assert_eq!(of(Version::HTTP_10, &[]), Ok(()));
        for host in ["", "localhost:8080", "[::1]", "[::1]:8080", "127.0.0.1:1"] {
            assert_eq!(of(Version::HTTP_11, &[("host", host)]), Ok(()), "{host}");
        }
        for host in
            ["[::1]evil.example", "[::1]:80evil.example", "a:b", "a b", "user@a", "a/b", "[::1", "a, b"]
        {
            let refused = Err(ProblemCode::InvalidParameter);
            assert_eq!(of(Version::HTTP_11, &[("host", host)]), refused, "{host}");
        }
        assert_eq!(of(Version::HTTP_11, &[]), Err(ProblemCode::InvalidParameter));
        assert_eq!(of(Version::HTTP_11, &[("host", "a"), ("host", "a")]), Err(ProblemCode::InvalidParameter));
    }

    #[test]
    fn a_body_comes_in_chunks_or_as_it_is() {
        let of =
            |coding| checked(Version::HTTP_11, &[("host", "a"), ("transfer-encoding", coding)]).map(drop);
        assert_eq!(of("Chunked"), Ok(()));
        for coding in ["gzip, chunked", "gzip", "chunked, chunked", "identity"] {
            assert_eq!(of(coding), Err(ProblemCode::UnsupportedMediaType), "{coding}");
        }
    }

    #[test]
    fn encodings_of_all_lines_are_one_list_in_one_spelling() {
        let of = |lines: &[&'static str]| {
            let lines: Vec<_> = lines.iter().map(|&line| ("content-encoding", line)).collect();
            let headers = checked(Version::HTTP_10, &lines).unwrap();
            headers.get(header::CONTENT_ENCODING).map(|value| value.to_str().unwrap().to_owned())
        };
        assert_eq!(of(&["GZip"]).as_deref(), Some("gzip"));
        assert_eq!(of(&["identity", "x-gzip"]).as_deref(), Some("gzip"));
        assert_eq!(of(&["identity, "]), None);
        assert_eq!(of(&["gzip", "br"]).as_deref(), Some("gzip, br"));
    }
}
