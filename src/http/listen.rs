//! The accept loop: bounded connections, each with header and write timeouts, and an orderly end.
//!
//! `axum::serve` installs no header timer, so silent, half-header and idle connections would stay open for ever. Here
//! HTTP/1 is spoken directly and the header timer runs from the first moment of every request, also between two.

use std::net::IpAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use hyper_util::service::TowerToHyperService;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio_util::task::TaskTracker;

use super::connection::{self, ConnectionLimits};
use super::connection_shares::ConnectionShares;
use super::metrics::OpenConnection;
use super::shutdown::Shutdown;

/// Rest after an accept that failed, so that a lack of file descriptors does not spin.
const ACCEPT_PAUSE: Duration = Duration::from_millis(50);

/// Serves `router` on `listener` until `shutdown` drains, then waits for the requests under way.
pub(super) async fn serve(
    listener: TcpListener,
    router: Router,
    limits: ConnectionLimits,
    connections_max: usize,
    shares: ConnectionShares,
    shutdown: &Shutdown,
) {
    let shares = Arc::new(shares);
    let places = Arc::new(Semaphore::new(connections_max));
    let connections = TaskTracker::new();
    let service = TowerToHyperService::new(router);
    while let Some((stream, address, place)) = next(&listener, &places, shutdown).await {
        // Closed at once: it takes no place from others.
        let Some(share) = shares.take(address) else { continue };
        let (service, shutdown) = (service.clone(), shutdown.clone());
        connections.spawn(async move {
            let _open = OpenConnection::new();
            connection::serve(stream, service, limits, &shutdown).await;
            drop((share, place));
        });
    }
    drop(listener);
    connections.close();
    connections.wait().await;
}

/// The next connection, once there is a place for it; `None` when no more are to be taken. Clients beyond the places
/// wait in the system's backlog.
async fn next(
    listener: &TcpListener,
    places: &Arc<Semaphore>,
    shutdown: &Shutdown,
) -> Option<(TcpStream, IpAddr, tokio::sync::OwnedSemaphorePermit)> {
    let accepted = async {
        let place = Arc::clone(places).acquire_owned().await.ok()?;
        loop {
            match listener.accept().await {
                Ok((stream, address)) => return Some((stream, address.ip(), place)),
                Err(error) => {
                    tracing::warn!(%error, "a connection could not be accepted");
                    tokio::time::sleep(ACCEPT_PAUSE).await;
                }
            }
        }
    };
    tokio::select! {
        biased;
        () = shutdown.drain.cancelled() => None,
        accepted = accepted => accepted,
    }
}
