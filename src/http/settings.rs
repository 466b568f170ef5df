//! What the operator may set about HTTP.

use std::net::{Ipv4Addr, SocketAddr};
use std::time::Duration;

use super::access::{Access, Neighbours};

/// Addresses, access and limits of the HTTP side. The names are those of the configuration.
#[derive(Debug, Clone)]
pub struct HttpSettings {
    /// Where the API listens.
    pub listen: SocketAddr,
    /// Where health and metrics listen; `None`: nowhere.
    pub admin_listen: Option<SocketAddr>,
    /// Who may use the API.
    pub access: Access,
    /// Most open connections of each listener; more wait in the system's backlog. Default 1,024.
    pub connections_max: usize,
    /// Time for a request's head, and for which a connection may be idle. Default 15 s.
    pub header_timeout: Duration,
    /// Longest pause between two pieces of an upload. Default 30 s.
    pub upload_timeout: Duration,
    /// Longest time for a whole upload. Default 1 h.
    pub upload_total_timeout: Duration,
    /// Time for which a client may take no byte of an answer. Default 60 s.
    pub write_timeout: Duration,
}

impl Default for HttpSettings {
    /// Loopback only, anonymous, no admin listener.
    fn default() -> Self {
        Self {
            listen: (Ipv4Addr::LOCALHOST, 8080).into(),
            admin_listen: None,
            access: Access::Anonymous(Neighbours::default()),
            connections_max: 1024,
            header_timeout: Duration::from_secs(15),
            upload_timeout: Duration::from_secs(30),
            upload_total_timeout: Duration::from_secs(60 * 60),
            write_timeout: Duration::from_secs(60),
        }
    }
}
