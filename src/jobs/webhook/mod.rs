//! Webhooks: a call to a URL of the caller's when a job ends, signed as the Standard Webhooks specification says.
//!
//! `target` and `address` decide what may be called, `dial` calls exactly that, `signature` signs, `retry` says when a
//! delivery is tried again.

mod address;
mod dial;
mod retry;
mod signature;
mod target;

pub use retry::RetryPlan;
pub use signature::{SecretError, WebhookSecret};
pub use target::{PrivateHosts, Target, TargetError, URL_BYTES_MAX};
