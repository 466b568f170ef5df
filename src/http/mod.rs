//! The only place that knows HTTP: requests come in here, become jobs, and jobs go out as answers.
//!
//! [`start`] opens the public listener and, if there is one, the admin listener. The routes are one table in
//! `router.rs`; the contract, `openapi.yaml`, is made from them.

mod about;
mod accept;
mod access;
mod admin;
mod agreed;
mod answer;
mod body;
mod both;
mod connection;
mod connection_shares;
mod contract;
mod cors;
mod deliveries;
mod descriptors;
mod docs;
mod entrance;
mod envelope;
mod events;
mod form;
mod framing;
mod healthcheck;
mod intake;
mod keys;
mod lifecycle;
mod listen;
mod listing;
mod mesh_file;
mod metrics;
mod migrate;
mod multipart;
mod operations;
#[cfg(feature = "otel")]
mod otel;
mod page;
mod prefer;
mod presigned;
mod problem;
mod query;
mod range;
mod rate;
mod representation;
mod router;
mod scope;
mod server;
mod settings;
mod shared_stores;
mod shutdown;
mod sizes;
mod start;
mod state;
mod tenant;
mod trace;
mod unpack;
mod unread;
mod uploads;

pub use access::{Access, TrustedPeers};
pub use healthcheck::healthcheck;
pub use keys::{ApiKeys, KeyFileError};
pub use migrate::migrate;
pub use rate::RateSettings;
pub use server::Server;
pub use settings::HttpSettings;
pub use shutdown::Shutdown;
pub use start::{check, start};

/// The contract, as it is committed and served.
pub fn openapi_yaml() -> String {
    contract::yaml(&router::openapi())
}
