//! The way to the database: address, encryption, and the pool of connections.

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use deadpool_postgres::{Hook, HookError, Manager, ManagerConfig, Pool, RecyclingMethod, Runtime};
use rustls_platform_verifier::BuilderVerifierExt;
use tokio_postgres::config::{Host, SslMode};
use tokio_postgres::tls::MakeTlsConnect;
use tokio_postgres::{Client, Config, Connection, Socket};
use tokio_postgres_rustls::MakeRustlsConnect;

use super::PostgresOpenError;

/// Longest time for a connection to be made, and for one of the pool to be free.
const CONNECTION_PATIENCE: Duration = Duration::from_secs(10);
/// A connection whose other side is silent for so long is looked after, and given up soon.
const SILENCE: Duration = Duration::from_secs(10);
/// How every connection is set. Statements see what was committed before they began, whatever the database has as its default, and
/// are planned once: to plan the longest ones takes several times as long as to run them.
const SET_UP: &str = "SET statement_timeout = '30s'; SET lock_timeout = '20s'; \
     SET idle_in_transaction_session_timeout = '60s'; SET default_transaction_isolation = 'read committed'; \
     SET client_min_messages = 'warning'; SET plan_cache_mode = 'force_generic_plan'";

/// An encrypted stream to the database.
pub(super) type TlsStream = <MakeRustlsConnect as MakeTlsConnect<Socket>>::Stream;

/// Where the database is, and how it is used.
#[derive(Clone)]
pub struct DatabaseAccess {
    /// Its address: `postgresql://user@host:port/name`, perhaps with parameters. Other hosts than this one are spoken to by TLS
    /// with a certificate that this system trusts, unless `sslmode` says otherwise.
    pub url: String,
    /// The password, if there is one.
    pub password: Option<String>,
    /// Most connections of this server.
    pub connections_max: usize,
}

impl fmt::Debug for DatabaseAccess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Both may hold a secret.
        f.debug_struct("DatabaseAccess")
            .field("connections_max", &self.connections_max)
            .finish_non_exhaustive()
    }
}

impl DatabaseAccess {
    /// Why the address cannot be used, if it cannot.
    ///
    /// # Errors
    /// It cannot be read, or there is a password in it.
    pub fn check(&self) -> Result<(), PostgresOpenError> {
        self.config().map(drop)
    }

    fn config(&self) -> Result<Config, PostgresOpenError> {
        let mut config: Config = self.url.parse().map_err(|error: tokio_postgres::Error| {
            use std::error::Error as _;
            PostgresOpenError::Address(error.source().map_or_else(|| error.to_string(), ToString::to_string))
        })?;
        if config.get_password().is_some() {
            let why = "it has a password, which would be shown with the settings: name a file of it instead";
            return Err(PostgresOpenError::Address(why.to_owned()));
        }
        if let Some(password) = &self.password {
            config.password(password);
        }
        if !self.url.contains("sslmode") {
            config.ssl_mode(if config.get_hosts().iter().all(is_this_machine) {
                SslMode::Disable
            } else {
                SslMode::Require
            });
        }
        config.application_name("meshmend").connect_timeout(CONNECTION_PATIENCE);
        config.keepalives_idle(SILENCE).keepalives_interval(SILENCE / 2).keepalives_retries(3);
        config.tcp_user_timeout(SILENCE);
        Ok(config)
    }
}

fn is_this_machine(host: &Host) -> bool {
    match host {
        Host::Unix(_) => true,
        Host::Tcp(name) => {
            name == "localhost" || name.parse::<std::net::IpAddr>().is_ok_and(|address| address.is_loopback())
        }
    }
}

/// What connections are encrypted with, where they are.
fn tls() -> Result<MakeRustlsConnect, PostgresOpenError> {
    let config =
        rustls::ClientConfig::builder_with_provider(Arc::new(rustls::crypto::ring::default_provider()))
            .with_safe_default_protocol_versions()
            .and_then(BuilderVerifierExt::with_platform_verifier)
            .map_err(|error| PostgresOpenError::Database(format!("TLS cannot be used: {error}")))?
            .with_no_client_auth();
    Ok(MakeRustlsConnect::new(config))
}

/// A connection beside the pool, which goes on as long as both are kept.
pub(super) async fn connect(
    access: &DatabaseAccess,
) -> Result<(Client, Connection<Socket, TlsStream>), PostgresOpenError> {
    let mut config = access.config()?;
    Ok(config.application_name("meshmend hints").connect(tls()?).await?)
}

/// The pool; no connection is made yet.
pub(super) fn pool(access: &DatabaseAccess) -> Result<Pool, PostgresOpenError> {
    let how = ManagerConfig { recycling_method: RecyclingMethod::Fast };
    let manager = Manager::from_config(access.config()?, tls()?, how);
    let set_up = Hook::async_fn(|client, _| {
        Box::pin(async move { client.batch_execute(SET_UP).await.map_err(HookError::Backend) })
    });
    Pool::builder(manager)
        .max_size(access.connections_max)
        .runtime(Runtime::Tokio1)
        .wait_timeout(Some(CONNECTION_PATIENCE))
        .create_timeout(Some(CONNECTION_PATIENCE))
        .post_create(set_up)
        .build()
        .map_err(|error| PostgresOpenError::Database(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn access(url: &str) -> DatabaseAccess {
        DatabaseAccess { url: url.to_owned(), password: Some("hidden".to_owned()), connections_max: 1 }
    }

    #[test]
    fn other_hosts_are_spoken_to_by_tls_unless_the_address_says_otherwise() {
        for (url, mode) in [
            ("postgresql://a@localhost/b", SslMode::Disable),
            ("postgresql://a@127.0.0.1:5433/b", SslMode::Disable),
            ("host=/run/postgresql user=a", SslMode::Disable),
            ("postgresql://a@db.example/b", SslMode::Require),
            ("postgresql://a@localhost,db.example/b", SslMode::Require),
            ("postgresql://a@db.example/b?sslmode=disable", SslMode::Disable),
        ] {
            assert_eq!(access(url).config().unwrap().get_ssl_mode(), mode, "{url}");
        }
    }

    #[test]
    fn an_address_with_a_password_is_refused_and_nothing_shows_one() {
        let refused = access("postgresql://a:open@localhost/b").check().unwrap_err().to_string();
        assert!(refused.contains("file") && !refused.contains("open"), "{refused}");
        assert!(access("postgresql://a@localhost/b?what=open").check().is_err());
        let shown = format!("{:?}", access("postgresql://a:open@localhost/b"));
        assert!(!shown.contains("open") && !shown.contains("hidden"), "{shown}");
    }
}
