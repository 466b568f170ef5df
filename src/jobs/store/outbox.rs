//! Webhooks to be sent: a row for each, made in the same step as the end of its job, and kept with its tries.

use std::collections::HashMap;
use std::time::Duration;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::id::JobId;

/// Whom to tell of the end of a job.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Webhook {
    /// Where to post to.
    pub url: String,
    /// What it is signed with; `None`: the server's own secrets.
    #[serde(default)]
    pub secret: Option<String>,
}

impl std::fmt::Debug for Webhook {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // Both may hold a secret.
        f.write_str("Webhook(..)")
    }
}

/// Where a delivery stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DeliveryState {
    /// To be sent, now or later.
    Pending,
    /// The receiver has taken it.
    Delivered,
    /// Given up.
    Failed,
}

/// Which deliveries a sender asks for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeliveryRequest {
    /// Most of them.
    pub limit: usize,
    /// Time for which nobody else gets them.
    pub lease: Duration,
    /// Most that one receiver is sent at one time.
    pub share: usize,
    /// How many the asker is sending now, by receiver.
    pub busy: HashMap<String, usize>,
}

/// A webhook of one job.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Delivery {
    /// Its id, which stays the same however often it is sent: the receiver tells repetitions by it.
    pub id: String,
    /// The job whose end it tells.
    pub job: JobId,
    /// Where to.
    pub webhook: Webhook,
    /// Who that is: host and port.
    pub receiver: String,
    /// Where it stands.
    pub state: DeliveryState,
    /// When it was made.
    pub created_at: Timestamp,
    /// When it is due next; `None`: it is not pending.
    pub next_at: Option<Timestamp>,
    /// The claim by which it is being sent; only the latest one counts.
    pub epoch: u32,
    /// The tries so far, the first one first.
    pub tries: Vec<DeliveryTry>,
}

/// One try to send a delivery.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeliveryTry {
    /// When it ended.
    pub at: Timestamp,
    /// What came of it.
    pub outcome: TryOutcome,
}

/// What came of a try.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TryOutcome {
    /// The receiver answered with this HTTP status.
    Answered(u16),
    /// It did not answer.
    Failed(String),
}

/// What to do after a try.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NextTry {
    /// Nothing: it is delivered.
    Delivered,
    /// Another try after this time.
    After(Duration),
    /// Nothing: it is given up.
    GiveUp,
}
