//! Webhooks: whom to tell of the end of a job, and what became of it.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::job::Job;
use super::words::words;

/// Whom to tell of the end of a job.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct WebhookRequest {
    /// An https URL of a public host. It is called with POST, signed as Standard Webhooks says.
    #[schema(max_length = 2048)]
    pub url: String,
    /// Key of the signature: `whsec_` and 24 to 64 bytes in base64. Default: that of the server, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(pattern = "^whsec_[A-Za-z0-9+/]{32,88}={0,2}$")]
    pub secret: Option<String>,
}

impl std::fmt::Debug for WebhookRequest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // Both may hold a secret.
        f.write_str("WebhookRequest(..)")
    }
}

words! {
    /// What a webhook tells.
    WebhookEvent {
        /// The job is done; report and result are there.
        Succeeded = "job.succeeded",
        /// The job is done without what was asked; `problem` says why.
        Failed = "job.failed",
        /// The job was ended by the caller.
        Cancelled = "job.cancelled",
    }
}

/// The body of a webhook.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct WebhookMessage {
    /// What happened.
    #[serde(rename = "type")]
    pub event: WebhookEvent,
    /// When.
    #[schema(value_type = String, format = DateTime)]
    pub timestamp: Timestamp,
    /// The job, as `GET /v1/jobs/{id}` shows it.
    pub data: Job,
}

words! {
    /// Where a delivery stands.
    DeliveryState {
        /// To be sent, now or later.
        Pending = "pending",
        /// The receiver has taken it.
        Delivered = "delivered",
        /// Given up.
        Failed = "failed",
    }
}

/// One try to deliver a webhook.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct DeliveryTry {
    /// When it ended.
    #[schema(value_type = String, format = DateTime)]
    pub at: Timestamp,
    /// HTTP status of the answer; null without one.
    #[schema(required)]
    pub status: Option<u16>,
    /// Why there was no answer; null when there was one.
    #[schema(required)]
    pub error: Option<String>,
}

/// A webhook of a job, with its tries.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Delivery {
    /// The `webhook-id` that it is sent with, however often.
    pub id: String,
    /// Where it stands.
    pub state: DeliveryState,
    /// Where to, without the query.
    pub url: String,
    /// When the job ended.
    #[schema(value_type = String, format = DateTime)]
    pub created_at: Timestamp,
    /// When it is tried next; null when it is not.
    #[schema(value_type = Option<String>, format = DateTime, required)]
    pub next_at: Option<Timestamp>,
    /// The tries so far, the first one first.
    pub tries: Vec<DeliveryTry>,
}

/// The webhooks of a job.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Deliveries {
    /// Each of them; none before the job ends, and none for a job that names no webhook.
    pub deliveries: Vec<Delivery>,
}
