//! Deliveries of webhooks.

use rusqlite::{Connection, OptionalExtension as _, Row, params};
use uuid::Uuid;

use super::rows::{json, later, parsed, time, time_if_any, word};
use crate::jobs::store::{
    Delivery, DeliveryRequest, DeliveryState, DeliveryTry, JobId, NextTry, StoreError, TryOutcome,
};

const COLUMNS: &str = "id, job, webhook, state, created_at, next_at, epoch, receiver";

/// Puts the webhook of a job that has ended into the outbox, if it has one.
pub(super) fn post(connection: &Connection, job: JobId, now: i64) -> Result<(), StoreError> {
    let mut statement = connection.prepare_cached(
        "INSERT INTO deliveries (id, job, webhook, state, created_at, next_at)
         SELECT ?2, id, webhook, 'pending', ?3, ?3 FROM jobs WHERE id = ?1 AND webhook IS NOT NULL",
    )?;
    let id = format!("msg_{}", Uuid::now_v7().simple());
    statement.execute(params![job.to_string(), id, now])?;
    Ok(())
}

/// A claimed delivery is due again when the lease is over, should nothing be heard of it.
pub(super) fn claim(
    connection: &Connection,
    request: DeliveryRequest,
    now: i64,
) -> Result<Vec<Delivery>, StoreError> {
    let DeliveryRequest { limit, lease, share, mut busy } = request;
    // The first few of each receiver: thousands that wait for one that does not answer hide nobody else's.
    let mut statement = connection.prepare_cached(
        "SELECT id, receiver FROM (
             SELECT id, receiver, next_at, row_number() OVER (PARTITION BY receiver ORDER BY next_at, id) AS place
             FROM deliveries WHERE next_at IS NOT NULL AND next_at <= ?1
         ) WHERE place <= ?2 ORDER BY next_at, id",
    )?;
    let mut due = statement.query(params![now, i64::try_from(share).unwrap_or(i64::MAX)])?;
    let mut ids = Vec::<String>::new();
    while ids.len() < limit
        && let Some(row) = due.next()?
    {
        let sent = busy.entry(row.get(1)?).or_default();
        if *sent < share {
            *sent += 1;
            ids.push(row.get(0)?);
        }
    }
    drop(due);
    let mut statement =
        connection.prepare_cached("UPDATE deliveries SET epoch = epoch + 1, next_at = ?2 WHERE id = ?1")?;
    for id in &ids {
        statement.execute(params![id, later(now, lease)])?;
    }
    ids.iter().map(|id| get(connection, id)).collect()
}

pub(super) fn note_try(
    connection: &Connection,
    id: &str,
    epoch: u32,
    outcome: &TryOutcome,
    next: NextTry,
    now: i64,
) -> Result<bool, StoreError> {
    let (state, next_at) = match next {
        NextTry::Delivered => (DeliveryState::Delivered, None),
        NextTry::After(pause) => (DeliveryState::Pending, Some(later(now, pause))),
        NextTry::GiveUp => (DeliveryState::Failed, None),
    };
    let noted = connection
        .prepare_cached(
            "UPDATE deliveries SET state = ?3, next_at = ?4 WHERE id = ?1 AND epoch = ?2 AND state = 'pending'",
        )?
        .execute(params![id, epoch, word_of(state), next_at])?;
    let (status, error) = match outcome {
        TryOutcome::Answered(status) => (Some(*status), None),
        TryOutcome::Failed(error) => (None, Some(error)),
    };
    connection
        .prepare_cached(
            "INSERT INTO tries (delivery, number, at, status, error)
             SELECT id, 1 + (SELECT count(*) FROM tries WHERE delivery = ?1), ?2, ?3, ?4 FROM deliveries
             WHERE id = ?1 AND (?5 OR epoch <> ?6)",
        )?
        // The receiver heard a try that was overtaken all the same.
        .execute(params![id, now, status, error, noted > 0, epoch])?;
    Ok(noted > 0)
}

pub(super) fn of_job(connection: &Connection, job: JobId) -> Result<Vec<Delivery>, StoreError> {
    let mut statement =
        connection.prepare_cached("SELECT id FROM deliveries WHERE job = ?1 ORDER BY created_at, id")?;
    let ids = statement
        .query_map([job.to_string()], |row| row.get(0))?
        .collect::<rusqlite::Result<Vec<String>>>()?;
    ids.iter().map(|id| get(connection, id)).collect()
}

/// A delivery that is being sent keeps that claim: it becomes void, so that its outcome does not end the new round.
pub(super) fn redeliver(
    connection: &Connection,
    job: JobId,
    id: &str,
    now: i64,
) -> Result<Delivery, StoreError> {
    let found = connection
        .prepare_cached(
            "UPDATE deliveries SET state = 'pending', next_at = ?3, epoch = epoch + 1 WHERE id = ?1 AND job = ?2",
        )?
        .execute(params![id, job.to_string(), now])?;
    if found == 0 { Err(StoreError::NotFound) } else { get(connection, id) }
}

pub(super) fn next_due(connection: &Connection) -> Result<Option<jiff::Timestamp>, StoreError> {
    let mut statement = connection.prepare_cached(
        "SELECT next_at FROM deliveries WHERE next_at IS NOT NULL ORDER BY next_at LIMIT 1",
    )?;
    Ok(statement.query_row([], |row| time(row, 0)).optional()?)
}

fn get(connection: &Connection, id: &str) -> Result<Delivery, StoreError> {
    let mut statement =
        connection.prepare_cached(&format!("SELECT {COLUMNS} FROM deliveries WHERE id = ?1"))?;
    let delivery = statement.query_row([id], delivery)?;
    let mut statement = connection
        .prepare_cached("SELECT at, status, error FROM tries WHERE delivery = ?1 ORDER BY number")?;
    let tries = statement.query_map([id], |row| {
        let outcome = match row.get(1)? {
            Some(status) => TryOutcome::Answered(status),
            None => TryOutcome::Failed(row.get::<_, Option<String>>(2)?.unwrap_or_default()),
        };
        Ok(DeliveryTry { at: time(row, 0)?, outcome })
    })?;
    Ok(Delivery { tries: tries.collect::<rusqlite::Result<_>>()?, ..delivery })
}

fn delivery(row: &Row<'_>) -> rusqlite::Result<Delivery> {
    Ok(Delivery {
        id: row.get(0)?,
        job: parsed(row, 1)?,
        webhook: json(row, 2)?,
        state: word(row, 3, state_of_word)?,
        created_at: time(row, 4)?,
        next_at: time_if_any(row, 5)?,
        epoch: row.get(6)?,
        receiver: row.get(7)?,
        tries: Vec::new(),
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
