//! URLs by which clients read and write files of the bucket themselves.

use std::io;
use std::sync::Arc;
use std::time::Duration;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use object_store::ObjectStoreExt as _;
use object_store::signer::{SignedUrlOptions, Signer as _};
use reqwest::Method;
use reqwest::header::{HeaderName, HeaderValue};

use super::S3Blobs;
use crate::jobs::blobs::{PresignedPut, PresignedUrls};
use crate::jobs::store::BlobRef;

/// The header by which S3 compares what comes with its SHA-256.
const CHECKSUM: HeaderName = HeaderName::from_static("x-amz-checksum-sha256");

impl PresignedUrls for S3Blobs {
    /// The digest is signed: S3 takes nothing else. A server that knows no checksums takes other bytes, which is found out when they
    /// are read.
    fn put(&self, blob: &BlobRef, lasts: Duration) -> io::Result<PresignedPut> {
        let digest = STANDARD.encode(blob.sha256);
        let value = HeaderValue::from_str(&digest).map_err(io::Error::other)?;
        let options = SignedUrlOptions::new().with_signed_header(CHECKSUM, value);
        let url = self.signed(Method::PUT, &blob.key, lasts, options)?;
        Ok(PresignedPut { url, headers: vec![(CHECKSUM.to_string(), digest)] })
    }

    fn get(&self, key: &str, disposition: &str, lasts: Duration) -> io::Result<String> {
        let options = SignedUrlOptions::new().with_query([("response-content-disposition", disposition)]);
        self.signed(Method::GET, key, lasts, options)
    }

    fn copy(&self, from: &str, to: &str) -> io::Result<()> {
        let (from, to) = (self.parts.place(from), self.parts.place(to));
        self.parts.run(move |parts| async move { parts.bucket.copy(&from, &to).await })
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
