//! Webhooks: a call to a URL of the caller's when a job ends, signed as the Standard Webhooks specification says.
//!
//! `target` and `address` decide what may be called, `dial` calls exactly that, `signature` signs, `retry` says when a
//! delivery is tried again, and `sender` does all this for what is in the outbox of the
//! store. `vault` keeps the secrets of jobs sealed while they are stored.

mod address;
mod dial;
mod retry;
mod sender;
mod settings;
mod signature;
mod target;
mod vault;
mod view;

pub use retry::RetryPlan;
pub(super) use sender::Sender;
pub use settings::WebhookSettings;
pub use signature::{SecretError, WebhookSecret};
pub use target::{PrivateHosts, TargetError, URL_BYTES_MAX, WebhookTarget};
pub(super) use vault::Vault;
pub use vault::VaultError;
pub(super) use view::view;
