//! One connection, from accept to a close that lets the last answer arrive.

use std::convert::Infallible;
use std::future::Future as _;
use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll, ready};
use std::time::Duration;

use axum::Router;
use axum::http::Request;
use axum::response::Response;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::{Service, service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _, ReadBuf};
use tokio::net::TcpStream;
use tokio::time::{Instant, Sleep};

use super::envelope::Peer;
use super::shutdown::Shutdown;

/// Room for a request head. Answers to heads over [`HEAD_BYTES_MAX`](super::sizes::HEAD_BYTES_MAX) are problem
/// documents; only over this room hyper answers by itself, without a body.
const HEAD_ROOM_BYTES: usize = 128 << 10;
/// Header fields of a request that hyper takes in.
const HEADERS_MAX: usize = 200;
/// How long a client that is still sending when its answer is complete may go on before the connection is cut.
const LINGER: Duration = Duration::from_secs(5);
/// How much it may send in that time, in bytes.
const LINGER_BYTES: u64 = 64 << 20;

/// What one connection may take.
#[derive(Debug, Clone, Copy)]
pub(super) struct ConnectionLimits {
    /// From the accept, or from the last answer, to the end of a request head.
    pub(super) header_timeout: Duration,
    /// How long a client may not take any byte of an answer.
    pub(super) write_timeout: Duration,
}

/// Answers the requests of `stream` until it ends or `shutdown` says so.
pub(super) async fn serve(
    stream: TcpStream,
    service: TowerToHyperService<Router>,
    limits: ConnectionLimits,
    shutdown: &Shutdown,
) {
    let peer = stream.peer_addr().map(|address| Peer(address.ip())).ok();
    // Answers are written whole; waiting for more to send only delays them.
    let _ = stream.set_nodelay(true);
    let spoken = Arc::new(AtomicBool::new(false));
    let io = TokioIo::new(StallGuard::new(stream, limits.write_timeout, Arc::clone(&spoken)));
    let service = with_peer(service, peer);
    let mut connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(limits.header_timeout)
        .max_headers(HEADERS_MAX)
        .max_buf_size(HEAD_ROOM_BYTES)
        .serve_connection(io, service);
    let mut is_draining = false;
    let ended = loop {
        tokio::select! {
            biased;
            () = shutdown.abort.cancelled() => return,
            () = shutdown.drain.cancelled(), if !is_draining => {
                if !spoken.load(Ordering::Relaxed) {
                    return;
                }
                is_draining = true;
                Pin::new(&mut connection).graceful_shutdown();
            }
            ended = std::future::poll_fn(|cx| connection.poll_without_shutdown(cx)) => break ended,
        }
    };
    match ended {
        Ok(()) => close(connection.into_parts().io.into_inner().stream).await,
        Err(error) => tracing::debug!(%error, "connection ended early"),
    }
}

/// The service, with the connection's other end told to every request.
fn with_peer(
    service: TowerToHyperService<Router>,
    peer: Option<Peer>,
) -> impl Service<Request<Incoming>, Response = Response, Error = Infallible, Future: Send + Unpin> {
    service_fn(move |mut request: Request<Incoming>| {
        if let Some(peer) = peer {
            request.extensions_mut().insert(peer);
        }
        service.call(request)
    })
}

/// Ends our side, then takes in what the client still sends: closing a socket that has unread bytes resets the
/// connection, and the client would lose the answer (a 413 above all).
async fn close(mut stream: TcpStream) {
    if stream.shutdown().await.is_err() {
        return;
    }
    let mut rest = stream.take(LINGER_BYTES);
    let _ = tokio::time::timeout(LINGER, tokio::io::copy(&mut rest, &mut tokio::io::sink())).await;
}

/// A stream whose writes fail when the client takes no byte for `patience`.
struct StallGuard {
    stream: TcpStream,
    patience: Duration,
    /// Runs while a write is waiting.
    stalled: Option<Pin<Box<Sleep>>>,
    /// Set when the client has sent anything at all.
    spoken: Arc<AtomicBool>,
}

impl StallGuard {
    fn new(stream: TcpStream, patience: Duration, spoken: Arc<AtomicBool>) -> Self {
        Self { stream, patience, stalled: None, spoken }
    }

    /// Passes on what a write has to say, unless it has been waiting for too long.
    fn watch<T>(&mut self, cx: &mut Context<'_>, written: Poll<io::Result<T>>) -> Poll<io::Result<T>> {
        if written.is_ready() {
            self.stalled = None;
            return written;
        }
        let deadline = Instant::now() + self.patience;
        let timer = self.stalled.get_or_insert_with(|| Box::pin(tokio::time::sleep_until(deadline)));
        ready!(timer.as_mut().poll(cx));
        Poll::Ready(Err(io::Error::new(io::ErrorKind::TimedOut, "the client takes no bytes")))
    }
}

impl AsyncRead for StallGuard {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        ready!(Pin::new(&mut self.stream).poll_read(cx, buffer))?;
        self.spoken.store(true, Ordering::Relaxed);
        Poll::Ready(Ok(()))
    }
}

impl AsyncWrite for StallGuard {
    fn poll_write(mut self: Pin<&mut Self>, cx: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write(cx, bytes);
        self.watch(cx, written)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        slices: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write_vectored(cx, slices);
        self.watch(cx, written)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}
