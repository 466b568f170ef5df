//! URLs by which clients read and write files of the bucket themselves.

use std::io;
use std::sync::Arc;
use std::time::Duration;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use object_store::ObjectStoreExt as _;
use object_store::signer::{SignedUrlOptions, Signer as _};
use reqwest::Method;
use reqwest::header::{CONTENT_LENGTH, HeaderName, HeaderValue};

use super::S3Blobs;
use crate::jobs::blobs::{PresignedPut, PresignedUrls};
use crate::jobs::store::BlobRef;

/// The header by which S3 compares what comes with its SHA-256.
const CHECKSUM: HeaderName = HeaderName::from_static("x-amz-checksum-sha256");

impl PresignedUrls for S3Blobs {
    /// Size and digest are signed: S3 takes nothing else. A server that knows no checksums takes other bytes of that size, which
    /// is found out when they are read.
    fn put(&self, blob: &BlobRef, lasts: Duration) -> io::Result<PresignedPut> {
        let headers =
            [(CONTENT_LENGTH, blob.bytes.to_string()), (CHECKSUM, STANDARD.encode(blob.sha256))];
        let mut options = SignedUrlOptions::new();
        for (name, value) in &headers {
            let value = HeaderValue::from_str(value).map_err(io::Error::other)?;
            options = options.with_signed_header(name.clone(), value);
        }
        let url = self.signed(Method::PUT, &blob.key, lasts, options)?;
        let headers = headers.map(|(name, value)| (name.to_string(), value));
        Ok(PresignedPut { url, headers: headers.into() })
    }

    fn get(&self, key: &str, disposition: &str, lasts: Duration) -> io::Result<String> {
        let options = SignedUrlOptions::new().with_query([("response-content-disposition", disposition)]);
        self.signed(Method::GET, key, lasts, options)
    }

    fn size(&self, key: &str) -> io::Result<Option<u64>> {
        let place = self.parts.place(key);
        self.parts.run(|parts| async move {
            match parts.bucket.head(&place).await {
                Ok(file) => Ok(Some(file.size)),
                Err(object_store::Error::NotFound { .. }) => Ok(None),
                Err(error) => Err(error),
            }
        })
    }
}

impl S3Blobs {
    fn signed(
        &self,
        method: Method,
        key: &str,
        lasts: Duration,
        options: SignedUrlOptions,
    ) -> io::Result<String> {
        let place = self.parts.place(key);
        // The key may have to be asked for.
        Arc::clone(&self.parts).run(move |parts| async move {
            parts.signer.signed_url_opts(method, &place, lasts, &options).await.map(String::from)
        })
    }
}
