//! Looking for rows.

use std::time::Duration;

use tokio_postgres::types::ToSql;
use uuid::Uuid;

use super::rows::{COLUMNS, get, id as id_of, job, number, state, time, to_json, value};
use super::session::Session;
use crate::jobs::store::{
    EQUAL_JOBS_LOOKED_AT, IdempotencyKey, JobCounts, JobId, JobRow, ListQuery, NewJob, StateChange,
    StoreError,
};
use crate::wire::ENGINE_VERSION;

pub(super) async fn find_keyed(
    session: &Session,
    owner: Option<&str>,
    key: &IdempotencyKey,
) -> Result<Option<JobRow>, StoreError> {
    let sql = "SELECT id, fingerprint FROM jobs WHERE coalesce(owner, '') = $1 AND idempotency_key = $2";
    let found = session.row_if_any(sql, &[&owner.unwrap_or_default(), &key.key]).await?;
    let Some(row) = found else { return Ok(None) };
    if value::<&[u8]>(&row, 1)? != key.fingerprint {
        return Err(StoreError::KeyReused);
    }
    get(session, id_of(&row, 0)?).await.map(Some)
}

pub(super) async fn find_equal(session: &Session, new: NewJob) -> Result<Option<JobRow>, StoreError> {
    let sql = format!(
        "SELECT {COLUMNS} FROM jobs
         WHERE state = 'succeeded' AND input_sha256 = $1 AND coalesce(owner, '') = $2 AND operation = $3
             AND engine = $4 AND expires_at > (SELECT now_ms())
         ORDER BY id DESC LIMIT {EQUAL_JOBS_LOOKED_AT}"
    );
    let (digest, operation) = (&new.input.sha256[..], new.operation.word());
    let owner = new.owner.as_deref().unwrap_or_default();
    let rows = session.rows(&sql, &[&digest, &owner, &operation, &ENGINE_VERSION]).await?;
    // What cannot be read is not equal.
    Ok(rows.iter().find_map(|row| job(row).ok().filter(|row| row.does_the_same_as(&new))))
}

pub(super) async fn list(session: &Session, query: ListQuery) -> Result<Vec<JobRow>, StoreError> {
    let mut sql = format!("SELECT {COLUMNS} FROM jobs WHERE ");
    let mut values: Vec<Box<dyn ToSql + Sync + Send>> = Vec::new();
    let mut place = |value: Box<dyn ToSql + Sync + Send>| {
        values.push(value);
        format!("${}", values.len())
    };
    match query.owner {
        Some(owner) => sql += &format!("owner = {}", place(Box::new(owner))),
        None => sql += "owner IS NULL",
    }
    if let Some(state) = query.state {
        sql += &format!(" AND state = {}", place(Box::new(state.word())));
    }
    if let Some(before) = query.before {
        sql += &format!(" AND id < {}", place(Box::new(Uuid::from(before))));
    }
    for (name, text) in &query.labels {
        let (name, text) = (place(Box::new(to_json(name)?)), place(Box::new(to_json(text)?)));
        sql += &format!(
            " AND EXISTS (SELECT 1 FROM labels WHERE job = jobs.id AND name = {name} AND value = {text})"
        );
    }
    let limit = i64::try_from(query.limit).unwrap_or(i64::MAX);
    sql += &format!(" ORDER BY id DESC LIMIT {}", place(Box::new(limit)));
    let values: Vec<&(dyn ToSql + Sync)> = values.iter().map(|value| &**value as _).collect();
    let rows = session.rows(&sql, &values).await?;
    let readable = |row| match job(row) {
        Ok(row) => Some(row),
        // A row of another version must not keep the others from being listed.
        Err(error) => {
            tracing::warn!(%error, "a row cannot be read");
            None
        }
    };
    Ok(rows.iter().filter_map(readable).collect())
}

pub(super) async fn deadlines(session: &Session) -> Result<Vec<(JobId, Duration)>, StoreError> {
    let sql = "SELECT id, greatest(cancel_at - now_ms(), 0) FROM jobs WHERE state = 'queued' AND cancel_at IS NOT NULL";
    let rows = session.rows(sql, &[]).await?;
    rows.iter().map(|row| Ok((id_of(row, 0)?, Duration::from_millis(number(row, 1)?)))).collect()
}

pub(super) async fn changes(
    session: &Session,
    id: JobId,
    after: u64,
) -> Result<Vec<StateChange>, StoreError> {
    let sql = "SELECT number, state, epoch, at FROM changes WHERE job = $1 AND number > $2 ORDER BY number";
    let after = i64::try_from(after).unwrap_or(i64::MAX);
    let rows = session.rows(sql, &[&Uuid::from(id), &after]).await?;
    let change = |row| {
        Ok(StateChange {
            number: number(row, 0)?,
            state: state(row, 1)?,
            epoch: number(row, 2)?,
            at: time(row, 3)?,
        })
    };
    rows.iter().map(change).collect()
}

pub(super) async fn ended(session: &Session, jobs: Vec<JobId>) -> Result<Vec<JobId>, StoreError> {
    let asked: Vec<Uuid> = jobs.into_iter().map(Uuid::from).collect();
    let sql = "SELECT id FROM unnest($1::uuid[]) AS asked (id)
        WHERE NOT EXISTS (SELECT 1 FROM jobs WHERE jobs.id = asked.id AND finished_at IS NULL)";
    session.rows(sql, &[&asked]).await?.iter().map(|row| id_of(row, 0)).collect()
}

pub(super) async fn counts(session: &Session) -> Result<JobCounts, StoreError> {
    let sql = "SELECT (SELECT count(*) FROM jobs WHERE state = 'queued'), (SELECT count(*) FROM jobs WHERE state = 'running'),
        (SELECT count(*) FROM jobs),
        (SELECT greatest(now_ms() - created_at, 0) FROM jobs WHERE state = 'queued' ORDER BY id LIMIT 1),
        (SELECT least(coalesce(sum(input_bytes), 0), 9223372036854775807)::bigint FROM jobs WHERE state = 'queued')";
    let row = session.row(sql, &[]).await?;
    let longest: Option<i64> = value(&row, 3)?;
    Ok(JobCounts {
        queued: number(&row, 0)?,
        running: number(&row, 1)?,
        all: number(&row, 2)?,
        queued_bytes: number(&row, 4)?,
        longest_queued: longest.map(|ms| Duration::from_millis(ms.unsigned_abs())),
    })
}
