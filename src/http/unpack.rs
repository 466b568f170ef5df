//! Undoes the compression of bodies.

use std::error::Error as _;
use std::io;

use async_compression::tokio::bufread::GzipDecoder;
use axum::body::Body;
use axum::extract::Request;
use axum::http::header;
use futures_util::TryStreamExt as _;
use tokio_util::io::{ReaderStream, StreamReader};

/// Bytes of a piece of an unpacked body.
const PIECE_BYTES: usize = 64 << 10;

/// The request with its body as it was before gzip, which may have packed it as several members one after the other (RFC 1952,
/// section 2.2). Bodies in other encodings stay as they are; they are refused where they are read.
pub(super) async fn unpack(request: Request) -> Request {
    if request.headers().get(header::CONTENT_ENCODING).is_none_or(|encoding| encoding != "gzip") {
        return request;
    }
    let (mut head, body) = request.into_parts();
    head.headers.remove(header::CONTENT_ENCODING);
    head.headers.remove(header::CONTENT_LENGTH);
    let packed = StreamReader::new(body.into_data_stream().map_err(io::Error::other));
    let mut unpacked = GzipDecoder::new(packed);
    unpacked.multiple_members(true);
    Request::from_parts(head, Body::from_stream(ReaderStream::with_capacity(unpacked, PIECE_BYTES)))
}

/// The error of the packing, where a body has failed for that and not for the connection that it came through.
pub(super) fn fault_of_packing(error: &axum::Error) -> Option<&io::Error> {
    let mut cause = error.source()?;
    while let Some(wrapped) = cause.downcast_ref::<axum::Error>() {
        cause = wrapped.source()?;
    }
    // That of a connection holds the error of the body that was to be unpacked.
    let fault = cause.downcast_ref::<io::Error>()?;
    let of_connection = fault.get_ref().and_then(|inner| inner.downcast_ref::<axum::Error>());
    of_connection.is_none().then_some(fault)
}

#[cfg(test)]
mod tests {
    use super::*;
    use async_compression::tokio::bufread::GzipEncoder;
    use axum::http::{HeaderMap, HeaderValue};
    use http_body_util::BodyExt as _;
    use tokio::io::AsyncReadExt as _;

    async fn packed(text: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        GzipEncoder::new(text).read_to_end(&mut bytes).await.unwrap();
        bytes
    }

    async fn unpacked(bytes: Vec<u8>) -> Result<(HeaderMap, Vec<u8>), axum::Error> {
        let mut request = Request::new(Body::from(bytes));
        let gzip = HeaderValue::from_static("gzip");
        request.headers_mut().insert(header::CONTENT_ENCODING, gzip);
        let (head, body) = unpack(request).await.into_parts();
        Ok((head.headers, body.collect().await?.to_bytes().to_vec()))
    }

    #[tokio::test]
    async fn all_members_are_unpacked_and_what_is_none_is_an_error() {
        let long = b"v 0 0 0\n".repeat(100_000);
        let two = [packed(&long).await, packed(b"v 1 0 0\n").await].concat();
        let (headers, text) = unpacked(two.clone()).await.unwrap();
        assert!(headers.is_empty(), "{headers:?}");
        assert!(text == [&long[..], b"v 1 0 0\n"].concat());
        for wrong in [[&two[..], b"xx"].concat(), two[..two.len() - 3].to_vec(), b"v 1 0 0\n".to_vec()] {
            let error = unpacked(wrong).await.unwrap_err();
            assert!(fault_of_packing(&error).is_some(), "{error:?}");
        }
    }

    #[tokio::test]
    async fn an_error_of_the_connection_is_none_of_the_packing() {
        let broken = futures_util::stream::iter([Err::<&[u8], _>(io::Error::other("reset"))]);
        let mut request = Request::new(Body::from_stream(broken));
        request.headers_mut().insert(header::CONTENT_ENCODING, HeaderValue::from_static("gzip"));
        let error = unpack(request).await.into_body().collect().await.unwrap_err();
        assert!(fault_of_packing(&error).is_none(), "{error:?}");
    }
}
