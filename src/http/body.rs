//! The body of a request as it comes in: bounded in size, in the pauses it may make, and in time.

use std::time::Duration;

use axum::body::Body;
use axum::http::{HeaderMap, header};
use bytes::Bytes;
use http_body_util::BodyExt as _;
use tokio::time::Instant;

use crate::wire::{Problem, ProblemCode};

/// What a body may take.
#[derive(Debug, Clone, Copy)]
pub(super) struct BodyLimits {
    /// Longest pause between two pieces.
    pub(super) idle_timeout: Duration,
    /// Longest time from the first piece to the last.
    pub(super) total_timeout: Duration,
    /// Most bytes.
    pub(super) bytes_max: u64,
    /// Name of that limit in `/v1/limits`.
    pub(super) bytes_max_name: &'static str,
}

/// A body that is being received.
pub(super) struct IncomingBody {
    body: Body,
    limits: BodyLimits,
    /// Size by `Content-Length`.
    announced: Option<u64>,
    /// Bytes received so far.
    received: u64,
    /// When the whole of it must be there.
    deadline: Instant,
}

impl IncomingBody {
    /// Begins to receive `body`. A size over the limit that is announced is refused here, before the client is told
    /// to go on (`100 Continue` is sent with the first read).
    pub(super) fn new(headers: &HeaderMap, body: Body, limits: BodyLimits) -> Result<Self, Problem> {
        let announced =
            headers.get(header::CONTENT_LENGTH).and_then(|value| value.to_str().ok()?.parse().ok());
        if announced.is_some_and(|bytes: u64| bytes > limits.bytes_max) {
            return Err(limits.too_large(announced));
        }
        Ok(Self { body, limits, announced, received: 0, deadline: Instant::now() + limits.total_timeout })
    }

    /// The next piece; `None` at the end.
    pub(super) async fn next(&mut self) -> Result<Option<Bytes>, Problem> {
        loop {
            let latest = self.deadline.min(Instant::now() + self.limits.idle_timeout);
            let frame =
                tokio::time::timeout_at(latest, self.body.frame()).await.map_err(|_| self.timed_out())?;
            let Some(frame) = frame else { return Ok(None) };
            // Trailers have no meaning here.
            let Ok(piece) = frame.map_err(|error| incomplete(&error))?.into_data() else { continue };
            self.received += piece.len() as u64;
            if self.received > self.limits.bytes_max {
                return Err(self.limits.too_large(None));
            }
            return Ok(Some(piece));
        }
    }

    /// The whole body in memory; only for bodies whose limit is small.
    pub(super) async fn into_bytes(mut self) -> Result<Vec<u8>, Problem> {
        let mut bytes = Vec::new();
        while let Some(piece) = self.next().await? {
            bytes.extend_from_slice(&piece);
        }
        Ok(bytes)
    }

    /// The size that the client announced.
    pub(super) fn announced(&self) -> Option<u64> {
        self.announced
    }

    fn timed_out(&self) -> Problem {
        let (name, limit) = if Instant::now() >= self.deadline {
            ("upload_total_timeout_s", self.limits.total_timeout)
        } else {
            ("upload_timeout_s", self.limits.idle_timeout)
        };
        Problem::new(ProblemCode::UploadTimeout, format!("the body stopped after {} bytes", self.received))
            .with_limit(name, limit.as_secs(), None)
    }
}

impl BodyLimits {
    fn too_large(&self, actual: Option<u64>) -> Problem {
        let detail = format!("the body is over the limit of {} bytes", self.bytes_max);
        Problem::new(ProblemCode::BodyTooLarge, detail).with_limit(
            self.bytes_max_name,
            self.bytes_max,
            actual,
        )
    }
}

fn incomplete(error: &axum::Error) -> Problem {
    Problem::new(ProblemCode::BodyIncomplete, format!("the body could not be received: {error}"))
}
