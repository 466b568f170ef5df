//! Sends what is in the outbox.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

use jiff::Timestamp;
use tokio::task::JoinSet;
use tokio_util::sync::CancellationToken;

use super::dial::{Dialer, SignedMessage};
use super::retry::{Next, RetryPlan};
use super::settings::WebhookSettings;
use super::signature::{self, WebhookSecret};
use super::target::WebhookTarget;
use super::vault::Vault;
use crate::jobs::meters;
use crate::jobs::store::{Delivery, DeliveryRequest, JobRow, JobStore, NextTry, TryOutcome, Webhook};
use crate::jobs::view;
use crate::wire::{JobState, WebhookEvent, WebhookMessage};

/// Most calls at one time.
const CALLS_MAX: usize = 32;
/// Most calls to one receiver at one time: one that does not answer leaves the others three quarters.
const SHARE: usize = 8;
/// Pause between two looks into the outbox. The store tells nobody when a row is added to it, since any of several
/// servers may have done so.
const LOOK_EVERY: Duration = Duration::from_millis(500);
/// Time that a claim of a delivery lasts longer than its call may.
const CLAIM_MARGIN: Duration = Duration::from_secs(20);

/// Sends webhooks.
pub(in crate::jobs) struct Sender {
    store: Arc<dyn JobStore>,
    settings: WebhookSettings,
    vault: Arc<Vault>,
    dialer: Dialer,
}

impl Sender {
    /// # Errors
    /// The system has no root certificates that can be used.
    pub(in crate::jobs) fn new(
        settings: WebhookSettings,
        vault: Arc<Vault>,
        store: Arc<dyn JobStore>,
    ) -> Result<Self, reqwest::Error> {
        let dialer = Dialer::new(settings.timeout)?;
        Ok(Self { store, settings, vault, dialer })
    }

    /// Sends what is due until `stopping` is raised.
    pub(in crate::jobs) async fn send_forever(self: Arc<Self>, stopping: CancellationToken) {
        let mut calls = JoinSet::new();
        let mut receivers = HashMap::new();
        loop {
            if calls.len() < CALLS_MAX {
                let request = DeliveryRequest {
                    limit: CALLS_MAX - calls.len(),
                    lease: self.settings.timeout + CLAIM_MARGIN,
                    share: SHARE,
                    busy: counted(receivers.values()),
                };
                match self.store.claim_deliveries(request).await {
                    Ok(due) => {
                        for delivery in due {
                            let receiver = delivery.receiver.clone();
                            let sender = Arc::clone(&self);
                            let call = calls.spawn(async move { sender.send(delivery).await });
                            receivers.insert(call.id(), receiver);
                        }
                    }
                    Err(error) => tracing::warn!(%error, "the outbox cannot be read"),
                }
            }
            let look = tokio::time::sleep(LOOK_EVERY);
            tokio::pin!(look);
            // By then there may be new ones. Whoever had to wait for the end of a call does not wait for that.
            loop {
                tokio::select! {
                    () = stopping.cancelled() => return,
                    Some(ended) = calls.join_next_with_id() => {
                        let ended = receivers.remove(&ended.map_or_else(|lost| lost.id(), |(id, ())| id));
                        let to_same = receivers.values().filter(|&other| Some(other) == ended.as_ref()).count();
                        if to_same + 1 == SHARE || calls.len() + 1 == CALLS_MAX {
                            break;
                        }
                    }
                    () = &mut look, if calls.len() < CALLS_MAX => break,
                }
            }
        }
    }

    async fn send(&self, delivery: Delivery) {
        // A job that was deleted meanwhile has taken its deliveries with it.
        let Ok(row) = self.store.get(delivery.job).await else { return };
        let called = self.call(&row, &delivery).await;
        let attempts = u32::try_from(delivery.tries.len()).unwrap_or(u32::MAX).saturating_add(1);
        let (outcome, next) = judged(&self.settings.retry, attempts, called);
        meters::delivery_tried(&outcome, next);
        tracing::info!(
            job = %delivery.job,
            delivery = delivery.id,
            attempt = attempts,
            status = status_of(&outcome),
            error = error_of(&outcome),
            next = ?next,
            "webhook tried"
        );
        match self.store.note_try(delivery.id.clone(), delivery.epoch, outcome, next).await {
            Ok(true) => {}
            Ok(false) => tracing::info!(delivery = delivery.id, "sent again or gone meanwhile"),
            Err(error) => {
                tracing::warn!(delivery = delivery.id, %error, "a try of a webhook could not be noted");
            }
        }
    }

    async fn call(&self, row: &JobRow, delivery: &Delivery) -> Result<super::dial::Reply, String> {
        // The settings may have changed since the job was taken.
        let target = WebhookTarget::parse(&delivery.webhook.url, &self.settings.private_hosts)
            .map_err(|error| error.to_string())?;
        let secrets = self.secrets(&delivery.webhook)?;
        let payload = payload(row, delivery.created_at)?;
        let timestamp = Timestamp::now().as_second();
        let signature = signature::signatures(&secrets, &delivery.id, timestamp, &payload);
        self.dialer
            .call(&target, SignedMessage { id: delivery.id.clone(), timestamp, signature, payload })
            .await
    }

    fn secrets(&self, webhook: &Webhook) -> Result<Vec<WebhookSecret>, String> {
        match &webhook.secret {
            Some(own) => {
                let own = self.vault.unsealed(own).map_err(|error| error.to_string())?;
                WebhookSecret::parse(&own).map(|own| vec![own]).map_err(|error| error.to_string())
            }
            None if self.settings.secrets.is_empty() => Err("the server has no secret any more".to_owned()),
            None => Ok(self.settings.secrets.clone()),
        }
    }
}

/// How often each of them occurs.
fn counted<'r>(receivers: impl Iterator<Item = &'r String>) -> HashMap<String, usize> {
    receivers.fold(HashMap::new(), |mut counts, receiver| {
        *counts.entry(receiver.clone()).or_default() += 1;
        counts
    })
}

fn judged(
    retry: &RetryPlan,
    attempts: u32,
    called: Result<super::dial::Reply, String>,
) -> (TryOutcome, NextTry) {
    let (status, wish) = match &called {
        Ok(reply) => (Some(reply.status), reply.retry_after_s.map(Duration::from_secs)),
        Err(_) => (None, None),
    };
    let next = match retry.after(attempts, status, wish, fastrand::f64()) {
        Next::Delivered => NextTry::Delivered,
        Next::Retry(pause) => NextTry::After(pause),
        Next::GiveUp => NextTry::GiveUp,
    };
    let outcome = match called {
        Ok(reply) => TryOutcome::Answered(reply.status),
        Err(error) => TryOutcome::Failed(error),
    };
    (outcome, next)
}

fn status_of(outcome: &TryOutcome) -> Option<u16> {
    match outcome {
        TryOutcome::Answered(status) => Some(*status),
        TryOutcome::Failed(_) => None,
    }
}

fn error_of(outcome: &TryOutcome) -> Option<&str> {
    match outcome {
        TryOutcome::Answered(_) => None,
        TryOutcome::Failed(error) => Some(error),
    }
}

/// What is told of a job that has ended.
fn payload(row: &JobRow, timestamp: Timestamp) -> Result<Vec<u8>, String> {
    let event = match row.ending.as_ref().map(|ending| ending.state) {
        Some(JobState::Succeeded) => WebhookEvent::Succeeded,
        Some(JobState::Cancelled) => WebhookEvent::Cancelled,
        _ => WebhookEvent::Failed,
    };
    let message = WebhookMessage { event, timestamp, data: view::job(row, None) };
    serde_json::to_vec(&message).map_err(|error| error.to_string())
}
