//! The way to the bucket: its address and the key to it.

use std::fmt;
use std::io;
use std::time::Duration;

use object_store::aws::{AmazonS3, AmazonS3Builder, S3ConditionalPut};
use object_store::path::Path;
use object_store::{BackoffConfig, ClientOptions, RetryConfig};

/// Longest time for a connection to be made.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);
/// Longest time in which nothing is heard of a request. A large file may take long.
const SILENCE: Duration = Duration::from_secs(60);
/// For how long a request that failed is made again.
const RETRY_TIMEOUT: Duration = Duration::from_secs(30);

/// Where files are, and how they are reached.
#[derive(Clone)]
pub struct BucketAccess {
    /// The bucket, and perhaps a folder in it: `s3://bucket/folder`.
    pub url: String,
    /// The server, when it is not Amazon's; `http` is taken where it is said.
    pub endpoint: Option<String>,
    /// The same server as clients reach it by presigned URLs, where that is another address.
    pub public_endpoint: Option<String>,
    /// The region.
    pub region: String,
    /// Id and secret of the key; `None`: what the machine has been given by its host or its environment.
    pub key: Option<(String, String)>,
    /// Most bytes of copies on this machine.
    pub cache_bytes_max: u64,
}

impl fmt::Debug for BucketAccess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("BucketAccess")
            .field("url", &self.url)
            .field("endpoint", &self.endpoint)
            .field("region", &self.region)
            .finish_non_exhaustive()
    }
}

/// A bucket that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum BucketError {
    /// It is not named as a bucket is.
    #[error("the address cannot be read: {0}")]
    Address(String),
    /// What speaks to it cannot be set up.
    #[error("it cannot be used: {0}")]
    SetUp(String),
    /// The folder of copies cannot be used.
    #[error("the folder of copies cannot be used: {0}")]
    Disk(io::Error),
}

impl BucketAccess {
    /// Why the address cannot be used, if it cannot.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn check(&self) -> Result<(), BucketError> {
        self.bucket_and_folder().map(drop)
    }

    fn bucket_and_folder(&self) -> Result<(&str, Path), BucketError> {
        let about = || BucketError::Address("expected s3://bucket or s3://bucket/folder".to_owned());
        let rest = self.url.strip_prefix("s3://").ok_or_else(about)?;
        let (bucket, folder) = rest.split_once('/').unwrap_or((rest, ""));
        let is_name = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '.' | '_');
        if bucket.is_empty() || !bucket.chars().all(is_name) || folder.contains(['?', '#', '@']) {
            return Err(about());
        }
        Ok((bucket, Path::parse(folder.trim_end_matches('/')).map_err(|_| about())?))
    }

    /// What speaks to the bucket, what signs URLs for clients, and the folder in the bucket.
    pub(super) fn connect(&self) -> Result<(AmazonS3, AmazonS3, Path), BucketError> {
        let (bucket, folder) = self.bucket_and_folder()?;
        // Another part of the process may have chosen the same already.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let store = self.connect_to(bucket, self.endpoint.as_deref())?;
        let signer = match &self.public_endpoint {
            Some(endpoint) => self.connect_to(bucket, Some(endpoint))?,
            None => store.clone(),
        };
        Ok((store, signer, folder))
    }

    fn connect_to(&self, bucket: &str, endpoint: Option<&str>) -> Result<AmazonS3, BucketError> {
        let is_http = endpoint.is_some_and(|endpoint| endpoint.starts_with("http://"));
        let client = ClientOptions::new()
            .with_allow_http(is_http)
            .with_connect_timeout(CONNECT_TIMEOUT)
            .with_timeout_disabled()
            .with_read_timeout(SILENCE);
        let retry =
            RetryConfig { backoff: BackoffConfig::default(), max_retries: 8, retry_timeout: RETRY_TIMEOUT };
        let mut builder = match &self.key {
            Some((id, secret)) => {
                AmazonS3Builder::new().with_access_key_id(id).with_secret_access_key(secret)
            }
            None => AmazonS3Builder::from_env(),
        };
        if let Some(endpoint) = endpoint {
            builder = builder.with_endpoint(endpoint);
        }
        builder
            .with_bucket_name(bucket)
            .with_region(&self.region)
            .with_conditional_put(S3ConditionalPut::ETagMatch)
            .with_client_options(client)
            .with_retry(retry)
            .build()
            .map_err(|error| BucketError::SetUp(error.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn access(url: &str) -> BucketAccess {
        BucketAccess {
            url: url.to_owned(),
            endpoint: None,
            public_endpoint: None,
            region: "us-east-1".to_owned(),
            key: Some(("id".to_owned(), "hidden".to_owned())),
            cache_bytes_max: 1,
        }
    }

    #[test]
    fn a_bucket_is_named_with_or_without_a_folder() {
        for (url, expected) in [
            ("s3://meshes", Some(("meshes", ""))),
            ("s3://meshes/", Some(("meshes", ""))),
            ("s3://meshes/shop/a/", Some(("meshes", "shop/a"))),
            ("s3:///a", None),
            ("https://meshes.example", None),
            ("s3://id:secret@meshes", None),
            ("s3://meshes/a?b", None),
        ] {
            let access = access(url);
            let found = access.bucket_and_folder().ok();
            let found = found.as_ref().map(|(bucket, folder)| (*bucket, folder.as_ref()));
            assert_eq!(found, expected, "{url}");
        }
    }

    #[test]
    fn nothing_shows_the_key() {
        assert!(!format!("{:?}", access("s3://meshes")).contains("hidden"));
    }
}
