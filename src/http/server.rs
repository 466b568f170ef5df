//! The listeners and their common end.

use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use tokio::net::TcpListener;
use tokio_util::sync::CancellationToken;

use super::connection::ConnectionLimits;
use super::connection_shares::ConnectionShares;
use super::settings::HttpSettings;
use super::shutdown::Shutdown;
use super::state::HttpService;
use super::{admin, listen, metrics, router};
use crate::jobs::Jobs;

/// Connections of the admin listener.
const ADMIN_CONNECTIONS_MAX: usize = 64;
/// Pause between two looks for callers that can be forgotten.
const FORGET_EVERY: Duration = Duration::from_secs(60);
/// Time that clients get for the last answers, once no job is left.
const LAST_ANSWERS: Duration = Duration::from_secs(5);

/// Listeners that are bound and not yet served.
#[derive(Debug)]
pub struct Server {
    settings: HttpSettings,
    jobs: Jobs,
    listener: Option<TcpListener>,
    admin: Option<TcpListener>,
}

impl Server {
    /// Binds the listeners.
    ///
    /// # Errors
    /// An address that cannot be bound.
    pub async fn bind(settings: HttpSettings, jobs: Jobs) -> io::Result<Self> {
        // Before the first request, so that every one is counted.
        metrics::recorder();
        let listener = listen_on(settings.listen).await?;
        let admin = listen_on(settings.admin_listen).await?;
        Ok(Self { settings, jobs, listener, admin })
    }

    /// Where the API listens, if it does.
    ///
    /// # Errors
    /// When the system does not say.
    pub fn address(&self) -> io::Result<Option<SocketAddr>> {
        self.listener.as_ref().map(TcpListener::local_addr).transpose()
    }

    /// Where health and metrics listen.
    ///
    /// # Errors
    /// When the system does not say.
    pub fn admin_address(&self) -> io::Result<Option<SocketAddr>> {
        self.admin.as_ref().map(TcpListener::local_addr).transpose()
    }

    /// Serves until `shutdown` drains, then ends in order: no new connections and jobs, running jobs get their grace,
    /// requests under way are answered. The admin listener answers until the end.
    pub async fn run(self, shutdown: Shutdown) {
        let limits = ConnectionLimits {
            header_timeout: self.settings.header_timeout,
            write_timeout: self.settings.write_timeout,
        };
        let connections_max = self.settings.connections_max;
        let of_one = self.settings.connections_share();
        let shares = ConnectionShares::new(of_one, self.settings.trusted_proxies.clone());
        let service = router::service(self.settings, self.jobs.clone());
        let public = router::router(Arc::clone(&service));
        let limited = Arc::clone(&service);
        let answered = CancellationToken::new();
        let serving = async {
            match self.listener {
                Some(listener) => {
                    listen::serve(listener, public, limits, connections_max, shares, &shutdown).await;
                }
                None => shutdown.drain.cancelled().await,
            }
            answered.cancel();
        };
        let ending = async {
            shutdown.drain.cancelled().await;
            tokio::select! {
                () = self.jobs.drain() => (),
                () = shutdown.abort.cancelled() => self.jobs.abandon().await,
            }
            tokio::select! {
                () = answered.cancelled() => (),
                () = tokio::time::sleep(LAST_ANSWERS) => shutdown.abort.cancel(),
            }
        };
        let ended = CancellationToken::new();
        let api = async {
            tokio::join!(serving, ending);
            ended.cancel();
        };
        let admin_shutdown = Shutdown { drain: ended.clone(), abort: ended.clone() };
        let admin = async {
            if let Some(listener) = self.admin {
                let routes = admin::router(service);
                let shares = ConnectionShares::new(ADMIN_CONNECTIONS_MAX, Vec::new());
                listen::serve(listener, routes, limits, ADMIN_CONNECTIONS_MAX, shares, &admin_shutdown).await;
            }
        };
        tokio::select! {
            _ = async { tokio::join!(api, admin) } => (),
            () = metrics::keep_up() => (),
            () = forget_idle_callers(&limited) => (),
        }
    }
}

/// Forgets callers that have not been heard of for long enough. Never ends.
async fn forget_idle_callers(service: &HttpService) {
    loop {
        tokio::time::sleep(FORGET_EVERY).await;
        if let Some(rates) = &service.rates {
            rates.forget_idle();
        }
    }
}

async fn listen_on(address: Option<SocketAddr>) -> io::Result<Option<TcpListener>> {
    let Some(address) = address else { return Ok(None) };
    let told =
        |error: io::Error| io::Error::new(error.kind(), format!("cannot listen on {address}: {error}"));
    TcpListener::bind(address).await.map(Some).map_err(told)
}
