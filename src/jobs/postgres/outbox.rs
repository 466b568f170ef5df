//! Deliveries of webhooks.

use tokio_postgres::Row;
use uuid::Uuid;

use super::locks::{self, OUTBOX};
use super::rows::{id as id_of, json, later, number, time, time_if_any, to_json, value, word};
use super::session::Session;
use crate::jobs::store::{
    Delivery, DeliveryRequest, DeliveryState, DeliveryTry, JobId, NextTry, Sealer, StoreError, TryOutcome,
    Webhook,
};

const COLUMNS: &str = "id, job, webhook, state, created_at, next_at, epoch, receiver";

/// Puts the webhook of a job into the outbox, if it has one: a part of the statement that ends it, whose `ended` has the job, and whose
/// value 10 is [`new_id`].
pub(super) const POST_ENDED: &str =
    "INSERT INTO deliveries (id, job, webhook, receiver, state, created_at, next_at)
    SELECT $10::text, id, webhook, lower(split_part(substr(url, strpos(url, '://') + 3), '/', 1)), 'pending', finished_at, finished_at
    FROM (SELECT id, webhook, finished_at, webhook::json ->> 'url' AS url FROM ended WHERE webhook IS NOT NULL) AS called";

/// The id of a new delivery.
pub(super) fn new_id() -> String {
    format!("msg_{}", Uuid::now_v7().simple())
}

/// A claimed delivery is due again when the lease is over, should nothing be heard of it.
pub(super) async fn claim(session: &Session, request: DeliveryRequest) -> Result<Vec<Delivery>, StoreError> {
    let DeliveryRequest { limit, lease, share, mut busy } = request;
    locks::hold(session, OUTBOX).await?;
    // The first few of each receiver: thousands that wait for one that does not answer hide nobody else's.
    let sql = "SELECT id, receiver FROM (
            SELECT id, receiver, next_at, row_number() OVER (PARTITION BY receiver ORDER BY next_at, id) AS place
            FROM deliveries WHERE next_at IS NOT NULL AND next_at <= $1
        ) AS due WHERE place <= $2 ORDER BY next_at, id";
    let share_number = i64::try_from(share).unwrap_or(i64::MAX);
    let due = session.rows(sql, &[&session.now, &share_number]).await?;
    let mut claimed = Vec::new();
    for row in &due {
        if claimed.len() >= limit {
            break;
        }
        let sent = busy.entry(value(row, 1)?).or_default();
        if *sent >= share {
            continue;
        }
        let sql = "UPDATE deliveries SET epoch = epoch + 1, next_at = $2 WHERE id = $1 AND next_at <= $3";
        let id: String = value(row, 0)?;
        if session.change(sql, &[&id, &later(session.now, lease), &session.now]).await? > 0 {
            *sent += 1;
            claimed.push(get(session, &id).await?);
        }
    }
    Ok(claimed)
}

pub(super) async fn note_try(
    session: &Session,
    id: String,
    epoch: u32,
    outcome: TryOutcome,
    next: NextTry,
) -> Result<bool, StoreError> {
    let (state, next_at) = match next {
        NextTry::Delivered => (DeliveryState::Delivered, None),
        NextTry::After(pause) => (DeliveryState::Pending, Some(later(session.now, pause))),
        NextTry::GiveUp => (DeliveryState::Failed, None),
    };
    // Tries of one delivery are numbered one after the other.
    session.row_if_any("SELECT 1 FROM deliveries WHERE id = $1 FOR UPDATE", &[&id]).await?;
    let epoch = i64::from(epoch);
    let sql =
        "UPDATE deliveries SET state = $3, next_at = $4 WHERE id = $1 AND epoch = $2 AND state = 'pending'";
    let is_noted = session.change(sql, &[&id, &epoch, &word_of(state), &next_at]).await? > 0;
    let (status, error) = match outcome {
        TryOutcome::Answered(status) => (Some(i32::from(status)), None),
        TryOutcome::Failed(error) => (None, Some(to_json(&error)?)),
    };
    // The receiver heard a try that was overtaken all the same.
    let sql = "INSERT INTO tries (delivery, number, at, status, error)
        SELECT id, 1 + (SELECT count(*) FROM tries WHERE delivery = $1), $2::bigint, $3::integer, $4::text FROM deliveries
        WHERE id = $1 AND ($5 OR epoch <> $6)";
    session.change(sql, &[&id, &session.now, &status, &error, &is_noted, &epoch]).await?;
    Ok(is_noted)
}

pub(super) async fn of_job(session: &Session, job: JobId) -> Result<Vec<Delivery>, StoreError> {
    let sql = "SELECT id FROM deliveries WHERE job = $1 ORDER BY created_at, id";
    let mut deliveries = Vec::new();
    for row in session.rows(sql, &[&Uuid::from(job)]).await? {
        deliveries.push(get(session, value(&row, 0)?).await?);
    }
    Ok(deliveries)
}

/// A delivery that is being sent keeps that claim: it becomes void, so that its outcome does not end the new round.
pub(super) async fn redeliver(session: &Session, job: JobId, id: String) -> Result<Delivery, StoreError> {
    let sql =
        "UPDATE deliveries SET state = 'pending', next_at = $3, epoch = epoch + 1 WHERE id = $1 AND job = $2";
    let found = session.change(sql, &[&id, &Uuid::from(job), &session.now]).await?;
    if found == 0 { Err(StoreError::NotFound) } else { get(session, &id).await }
}

pub(super) async fn next_due(session: &Session) -> Result<Option<jiff::Timestamp>, StoreError> {
    let sql = "SELECT next_at FROM deliveries WHERE next_at IS NOT NULL ORDER BY next_at LIMIT 1";
    session.row_if_any(sql, &[]).await?.map(|row| time(&row, 0)).transpose()
}

/// Seals the secrets of jobs and deliveries that are not sealed. How many there were.
pub(super) async fn seal(session: &Session, seal: Sealer) -> Result<usize, StoreError> {
    let mut sealed = 0;
    for (select, update) in [
        (
            "SELECT id::text, webhook FROM jobs WHERE webhook IS NOT NULL ORDER BY id FOR UPDATE",
            "UPDATE jobs SET webhook = $2 WHERE id = ($1::text)::uuid",
        ),
        (
            "SELECT id, webhook FROM deliveries ORDER BY id FOR UPDATE",
            "UPDATE deliveries SET webhook = $2 WHERE id = $1",
        ),
    ] {
        for row in session.rows(select, &[]).await? {
            let webhook: Webhook = json(&row, 1)?;
            let secret = webhook.secret.as_deref().and_then(&*seal);
            if let Some(secret) = secret {
                let webhook = to_json(&Webhook { secret: Some(secret), ..webhook })?;
                let id: &str = value(&row, 0)?;
                sealed += session.change(update, &[&id, &webhook]).await?;
            }
        }
    }
    Ok(usize::try_from(sealed).unwrap_or(usize::MAX))
}

async fn get(session: &Session, id: &str) -> Result<Delivery, StoreError> {
    let row = session.row(&format!("SELECT {COLUMNS} FROM deliveries WHERE id = $1"), &[&id]).await?;
    let sql = "SELECT at, status, error FROM tries WHERE delivery = $1 ORDER BY number";
    let tries = session.rows(sql, &[&id]).await?;
    delivery(&row, tries.iter().map(one_try).collect::<Result<_, _>>()?)
}

fn one_try(row: &Row) -> Result<DeliveryTry, StoreError> {
    let outcome = match value::<Option<i32>>(row, 1)? {
        Some(status) => TryOutcome::Answered(u16::try_from(status).unwrap_or(u16::MAX)),
        None => TryOutcome::Failed(json(row, 2)?),
    };
    Ok(DeliveryTry { at: time(row, 0)?, outcome })
}

fn delivery(row: &Row, tries: Vec<DeliveryTry>) -> Result<Delivery, StoreError> {
    Ok(Delivery {
        id: value(row, 0)?,
        job: id_of(row, 1)?,
        webhook: json(row, 2)?,
        state: word(row, 3, state_of_word)?,
        created_at: time(row, 4)?,
        next_at: time_if_any(row, 5)?,
        epoch: number(row, 6)?,
        receiver: value(row, 7)?,
        tries,
    })
}

fn word_of(state: DeliveryState) -> &'static str {
    match state {
        DeliveryState::Pending => "pending",
        DeliveryState::Delivered => "delivered",
        DeliveryState::Failed => "failed",
    }
}

fn state_of_word(word: &str) -> Option<DeliveryState> {
    let states = [DeliveryState::Pending, DeliveryState::Delivered, DeliveryState::Failed];
    states.into_iter().find(|&state| word_of(state) == word)
}
