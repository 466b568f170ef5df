//! Whether a request was read to its end before it was answered: if not, the connection ends with the answer, and the client
//! is told so.

use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll};

use axum::body::{Body, HttpBody};
use axum::extract::Request;
use bytes::Bytes;
use hyper::body::{Frame, SizeHint};

/// Whether there is more of a body than was read.
#[derive(Debug, Clone)]
pub(super) struct Unread(Arc<AtomicBool>);

impl Unread {
    /// Watches the body of a request.
    pub(super) fn watch(request: &mut Request) -> Self {
        let unread = Self(Arc::new(AtomicBool::new(!request.body().is_end_stream())));
        let body = std::mem::take(request.body_mut());
        *request.body_mut() = Body::new(Watched { body, unread: unread.clone() });
        unread
    }

    pub(super) fn is_so(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

struct Watched {
    body: Body,
    unread: Unread,
}

impl HttpBody for Watched {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        let polled = Pin::new(&mut self.body).poll_frame(cx);
        if self.body.is_end_stream() || matches!(polled, Poll::Ready(None)) {
            self.unread.0.store(false, Ordering::Relaxed);
        }
        polled
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use http_body_util::BodyExt as _;

    #[tokio::test]
    async fn a_body_is_unread_until_its_end() {
        let mut request = Request::new(Body::from("mesh"));
        let unread = Unread::watch(&mut request);
        assert!(unread.is_so());
        assert_eq!(request.into_body().collect().await.unwrap().to_bytes(), "mesh");
        assert!(!unread.is_so());
        assert!(!Unread::watch(&mut Request::new(Body::empty())).is_so());
    }
}
