//! The body of a request as it comes in: bounded in size, in the pauses it may make, in its rate, and in time.

use std::io;
use std::time::Duration;

use axum::body::{Body, HttpBody as _};
use axum::http::{HeaderMap, header};
use bytes::Bytes;
use http_body_util::BodyExt as _;
use tokio::time::Instant;

use super::unpack::fault_of_packing;
use crate::wire::{Problem, ProblemCode};

/// Largest rest of an unwanted body that is taken in.
const DISCARD_BYTES_MAX: u64 = 256 << 10;
/// How long it may take to come.
const DISCARD_PATIENCE: Duration = Duration::from_millis(20);

/// What a body may take.
#[derive(Debug, Clone, Copy)]
pub(super) struct BodyLimits {
    /// Longest pause between two pieces.
    pub(super) idle_timeout: Duration,
    /// Fewest bytes a second on average, after a first `idle_timeout` in which any number will do; 0: any number.
    pub(super) rate_min: u64,
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
    /// The client waits to be told to go on before it sends the body.
    is_asked_for: bool,
    /// Bytes received so far.
    received: u64,
    begun: Instant,
}

/// What a body was too slow for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Patience {
    Pause,
    Rate,
    Total,
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
        let is_asked_for = headers.contains_key(header::EXPECT);
        Ok(Self { body, limits, announced, is_asked_for, received: 0, begun: Instant::now() })
    }

    /// Whether it is known, without a read, that no more comes.
    pub(super) fn is_over(&self) -> bool {
        self.body.is_end_stream()
    }

    /// The next piece; `None` at the end.
    pub(super) async fn next(&mut self) -> Result<Option<Bytes>, Problem> {
        loop {
            let (latest, patience) = self.next_deadline();
            let frame = tokio::time::timeout_at(latest, self.body.frame())
                .await
                .map_err(|_| self.timed_out(patience))?;
            let Some(frame) = frame else { return Ok(None) };
            // Trailers have no meaning here.
            let Ok(piece) = frame.map_err(|error| self.incomplete(&error))?.into_data() else { continue };
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

    /// Takes in the rest of a small body that nobody wants, if it comes at once: the answer then does not cost the
    /// client its connection.
    pub(super) async fn discard_small(mut self) {
        let is_small =
            self.announced.is_some_and(|bytes| bytes - self.received.min(bytes) <= DISCARD_BYTES_MAX);
        // A client that asked first has sent nothing, and is not to begin with it.
        let has_begun = !self.is_asked_for || self.received > 0;
        if is_small && has_begun {
            let rest = async { while let Ok(Some(_)) = self.next().await {} };
            // What comes later is cut off.
            let _ = tokio::time::timeout(DISCARD_PATIENCE, rest).await;
        }
    }

    /// The size that the client announced.
    pub(super) fn announced(&self) -> Option<u64> {
        self.announced
    }

    /// Until when the next piece is waited for, and what is over then.
    fn next_deadline(&self) -> (Instant, Patience) {
        let BodyLimits { idle_timeout, total_timeout, rate_min, .. } = self.limits;
        let pause = (Instant::now() + idle_timeout, Patience::Pause);
        let total = (self.begun + total_timeout, Patience::Total);
        // What has come by now lasts that long at the lowest rate.
        let rate = self
            .received
            .checked_div(rate_min)
            .map(|seconds| idle_timeout.saturating_add(Duration::from_secs(seconds)));
        let rate =
            rate.filter(|&lasts| lasts < total_timeout).map(|lasts| (self.begun + lasts, Patience::Rate));
        [pause, total].into_iter().chain(rate).min().unwrap_or(pause)
    }

    /// Why no more comes. What a connection does not send has the connection's own error; what cannot be unpacked has none but
    /// that of the unpacking.
    fn incomplete(&self, error: &axum::Error) -> Problem {
        let detail = match fault_of_packing(error) {
            Some(fault) => {
                let what = match fault.kind() {
                    io::ErrorKind::UnexpectedEof => "its data ends early",
                    _ => "its data is damaged",
                };
                format!(
                    "the body is compressed with gzip, but {what}; {} bytes could be unpacked before that",
                    self.received
                )
            }
            None => format!("the body could not be received: {error}"),
        };
        Problem::new(ProblemCode::BodyIncomplete, detail)
    }

    fn timed_out(&self, patience: Patience) -> Problem {
        let limits = &self.limits;
        let (name, limit) = match patience {
            Patience::Pause => ("upload_timeout_s", limits.idle_timeout.as_secs()),
            Patience::Rate => ("upload_rate_min", limits.rate_min),
            Patience::Total => ("upload_total_timeout_s", limits.total_timeout.as_secs()),
        };
        let detail = format!("the body stopped or was too slow after {} bytes", self.received);
        Problem::new(ProblemCode::UploadTimeout, detail).with_limit(name, limit, None)
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

    const LIMITS: BodyLimits = BodyLimits {
        idle_timeout: Duration::from_secs(30),
        rate_min: 1000,
        total_timeout: Duration::from_secs(3600),
        bytes_max: 10_000_000,
        bytes_max_name: "upload_bytes_max",
    };

    /// Sends `bytes` every ten seconds, and gives what stopped it and when.
    async fn stopped(bytes: usize, limits: BodyLimits) -> (String, u64) {
        let pieces = futures_util::stream::unfold((), move |()| async move {
            tokio::time::sleep(Duration::from_secs(10)).await;
            Some((Ok::<_, std::io::Error>(Bytes::from(vec![0; bytes])), ()))
        });
        let begun = Instant::now();
        let mut body = IncomingBody::new(&HeaderMap::new(), Body::from_stream(pieces), limits).unwrap();
        loop {
            if let Err(problem) = body.next().await {
                assert_eq!(problem.code, ProblemCode::UploadTimeout);
                return (problem.limit_name.unwrap().to_string(), begun.elapsed().as_secs());
            }
        }
    }

    /// How many bytes of a body of four pieces, `pause` apart, are taken in once its first piece is refused.
    async fn discarded(piece: usize, pause: Duration) -> usize {
        let taken = Arc::new(AtomicUsize::new(0));
        let count = Arc::clone(&taken);
        let pieces = futures_util::stream::unfold(0, move |number| {
            let count = Arc::clone(&count);
            async move {
                tokio::time::sleep(pause).await;
                count.fetch_add(piece, Relaxed);
                (number < 4).then(|| (Ok::<_, std::io::Error>(Bytes::from(vec![0; piece])), number + 1))
            }
        });
        let headers = HeaderMap::from_iter([(header::CONTENT_LENGTH, (4 * piece).into())]);
        let mut body = IncomingBody::new(&headers, Body::from_stream(pieces), LIMITS).unwrap();
        body.next().await.unwrap();
        body.discard_small().await;
        taken.load(Relaxed) / piece
    }

    #[tokio::test(start_paused = true)]
    async fn the_rest_of_a_small_body_is_taken_in_when_it_comes_at_once() {
        let at_once = Duration::from_millis(1);
        assert_eq!(discarded(1000, at_once).await, 5, "four pieces and the end");
        assert_eq!(discarded(1 << 20, at_once).await, 1, "three mebibytes are too much");
        assert_eq!(discarded(1000, DISCARD_PATIENCE * 2 / 3).await, 2, "the rest is late");
    }

    #[tokio::test(start_paused = true)]
    async fn a_body_that_drips_is_ended_after_its_first_pause_and_one_that_flows_is_not() {
        assert_eq!(stopped(1, LIMITS).await, ("upload_rate_min".to_owned(), 30));
        assert_eq!(stopped(5000, LIMITS).await, ("upload_rate_min".to_owned(), 55));
        assert_eq!(stopped(11_000, LIMITS).await, ("upload_total_timeout_s".to_owned(), 3600));
    }

    #[tokio::test(start_paused = true)]
    async fn without_a_lowest_rate_only_pauses_and_time_count() {
        let any = BodyLimits { rate_min: 0, ..LIMITS };
        assert_eq!(stopped(1, any).await, ("upload_total_timeout_s".to_owned(), 3600));
        let quick = BodyLimits { idle_timeout: Duration::from_secs(5), ..LIMITS };
        assert_eq!(stopped(1, quick).await, ("upload_timeout_s".to_owned(), 5));
    }
}
