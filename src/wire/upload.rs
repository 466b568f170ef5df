//! Uploads that come before their job.

use std::collections::BTreeMap;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::certificate::digest_of_hex;
use super::problem::Problem;
use super::problem_code::ProblemCode;

/// Longest name of a file, in characters.
const FILE_NAME_MAX: usize = 1024;

/// An upload that comes before its job.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct UploadInfo {
    /// Its id, which a request names in `input`: `{"upload":"ID"}`.
    pub id: String,
    /// Bytes that it is to have.
    pub length: u64,
    /// Bytes that are stored, from the first one on.
    pub received: u64,
    /// When it goes, unless more of it comes.
    #[schema(value_type = String, format = DateTime)]
    pub expires_at: Timestamp,
    /// How to write it to the bucket, when it does not come through this service.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub put: Option<PutRequest>,
}

/// The request by which a client writes an upload to the bucket: `PUT`, with these headers as they stand here.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct PutRequest {
    /// Where.
    pub url: String,
    /// Headers by their names.
    pub headers: BTreeMap<String, String>,
    /// Time from now for which the URL is valid, in seconds.
    pub valid_s: u64,
}

/// An upload that the client writes to the bucket by itself.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct PresignedRequest {
    /// Number of its bytes.
    pub length: u64,
    /// SHA-256 of its bytes, 64 hexadecimal digits.
    #[schema(pattern = "^[0-9a-f]{64}$")]
    pub sha256: String,
    /// Name of the file.
    #[serde(default)]
    #[schema(max_length = 1024)]
    pub file_name: Option<String>,
}

impl PresignedRequest {
    /// Reads the request.
    ///
    /// # Errors
    /// `invalid-parameter`.
    pub fn from_json(text: &[u8]) -> Result<Self, Problem> {
        let asked: Self = serde_json::from_slice(text).map_err(|error| Problem {
            line: Some(error.line() as u64),
            ..Problem::new(
                ProblemCode::InvalidParameter,
                format!("expected a JSON object with `length`, `sha256` and perhaps `file_name`: {error}"),
            )
        })?;
        if asked.file_name.as_ref().is_some_and(|name| name.chars().count() > FILE_NAME_MAX) {
            return Err(Problem {
                parameter: Some("file_name".to_owned()),
                ..Problem::new(
                    ProblemCode::InvalidParameter,
                    format!("`file_name` has at most {FILE_NAME_MAX} characters"),
                )
            });
        }
        Ok(asked)
    }

    /// The SHA-256.
    ///
    /// # Errors
    /// `invalid-parameter`.
    pub fn digest(&self) -> Result<[u8; 32], Problem> {
        digest_of_hex(&self.sha256).ok_or_else(|| Problem {
            parameter: Some("sha256".to_owned()),
            ..Problem::new(ProblemCode::InvalidParameter, "`sha256` is 64 hexadecimal digits in lower case")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_presigned_upload_says_its_size_and_digest() {
        let digest = "0a".repeat(32);
        let read = |text: &str| PresignedRequest::from_json(text.as_bytes());
        let asked = read(&format!(r#"{{"length":7,"sha256":"{digest}"}}"#)).unwrap();
        assert_eq!((asked.length, asked.digest().unwrap(), asked.file_name), (7, [10; 32], None));
        for text in [
            "",
            "[]",
            r#"{"length":7}"#,
            r#"{"length":-1,"sha256":"0a"}"#,
            r#"{"length":7,"sha256":"0a","a":1}"#,
        ] {
            assert_eq!(read(text).unwrap_err().code, ProblemCode::InvalidParameter, "{text}");
        }
        let named = |letters| {
            read(&format!(r#"{{"length":7,"sha256":"{digest}","file_name":"{}"}}"#, "ä".repeat(letters)))
        };
        assert!(named(FILE_NAME_MAX).is_ok());
        assert_eq!(named(FILE_NAME_MAX + 1).unwrap_err().parameter.as_deref(), Some("file_name"));
        let problem = read(r#"{"length":7,"sha256":"0A"}"#).unwrap().digest().unwrap_err();
        assert_eq!(problem.parameter.as_deref(), Some("sha256"));
    }
}
