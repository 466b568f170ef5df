//! Looking for rows.

use std::time::Duration;

use rusqlite::types::Value;
use rusqlite::{Connection, OptionalExtension as _, params, params_from_iter};

use super::rows::{COLUMNS, get, job, parsed, state, time, time_left, word};
use crate::jobs::store::{
    EQUAL_JOBS_LOOKED_AT, IdempotencyKey, JobCounts, JobId, JobRow, ListQuery, NewJob, StateChange,
    StoreError,
};
use crate::wire::{ENGINE_VERSION, JobState};

pub(super) fn find_keyed(
    connection: &Connection,
    owner: Option<&str>,
    key: &IdempotencyKey,
    now: i64,
) -> Result<Option<JobRow>, StoreError> {
    let mut statement = connection.prepare_cached(
        "SELECT id, fingerprint FROM jobs WHERE coalesce(owner, '') = coalesce(?1, '') AND idempotency_key = ?2",
    )?;
    let found = statement
        .query_row(params![owner, key.key], |row| Ok((parsed(row, 0)?, row.get::<_, [u8; 32]>(1)?)))
        .optional()?;
    match found {
        None => Ok(None),
        Some((_, fingerprint)) if fingerprint != key.fingerprint => Err(StoreError::KeyReused),
        Some((id, _)) => get(connection, id, now).map(Some),
    }
}

pub(super) fn find_equal(
    connection: &Connection,
    new: &NewJob,
    now: i64,
) -> Result<Option<JobRow>, StoreError> {
    let mut statement = connection.prepare_cached(&equal_jobs_sql())?;
    let operation = new.operation.word();
    let given = params![new.input.sha256, new.owner, operation, ENGINE_VERSION, now];
    let mut rows = statement.query_map(given, |row| job(row, now))?;
    // What cannot be read is not equal.
    Ok(rows.find_map(|row| row.ok().filter(|row| row.does_the_same_as(new))))
}

/// Jobs that may have done the same, the latest first. Left to itself, SQLite may walk through all jobs of the owner.
fn equal_jobs_sql() -> String {
    format!(
        "SELECT {COLUMNS} FROM jobs INDEXED BY jobs_by_input
         WHERE state = 'succeeded' AND input_sha256 = ?1 AND owner IS ?2 AND operation = ?3 AND engine = ?4
             AND expires_at > ?5
         ORDER BY id DESC LIMIT {EQUAL_JOBS_LOOKED_AT}"
    )
}

pub(super) fn list(connection: &Connection, query: &ListQuery, now: i64) -> Result<Vec<JobRow>, StoreError> {
    let mut sql = format!("SELECT {COLUMNS} FROM jobs WHERE owner IS ?");
    let mut values = vec![query.owner.clone().map_or(Value::Null, Value::Text)];
    if let Some(state) = query.state {
        sql.push_str(" AND state = ?");
        values.push(Value::Text(state.word().to_owned()));
    }
    if let Some(before) = query.before {
        sql.push_str(" AND id < ?");
        values.push(Value::Text(before.to_string()));
    }
    for (name, value) in &query.labels {
        sql.push_str(" AND EXISTS (SELECT 1 FROM labels WHERE job = jobs.id AND name = ? AND value = ?)");
        values.extend([Value::Text(name.clone()), Value::Text(value.clone())]);
    }
    sql.push_str(" ORDER BY id DESC LIMIT ?");
    values.push(Value::Integer(i64::try_from(query.limit).unwrap_or(i64::MAX)));
    let mut statement = connection.prepare_cached(&sql)?;
    let rows = statement.query_map(params_from_iter(values), |row| job(row, now))?;
    let readable = |row: rusqlite::Result<JobRow>| match row {
        // A row of another version must not keep the others from being listed.
        Err(error @ rusqlite::Error::FromSqlConversionFailure(..)) => {
            tracing::warn!(%error, "a row cannot be read");
            None
        }
        row => Some(row),
    };
    Ok(rows.filter_map(readable).collect::<rusqlite::Result<_>>()?)
}

pub(super) fn deadlines(connection: &Connection, now: i64) -> Result<Vec<(JobId, Duration)>, StoreError> {
    let mut statement = connection
        .prepare_cached("SELECT id, cancel_at FROM jobs WHERE state = 'queued' AND cancel_at IS NOT NULL")?;
    let rows = statement.query_map([], |row| Ok((parsed(row, 0)?, time_left(row, 1, now)?)))?;
    Ok(rows.collect::<rusqlite::Result<_>>()?)
}

pub(super) fn changes(
    connection: &Connection,
    id: JobId,
    after: u64,
) -> Result<Vec<StateChange>, StoreError> {
    let mut statement = connection.prepare_cached(
        "SELECT number, state, epoch, at FROM changes WHERE job = ?1 AND number > ?2 ORDER BY number",
    )?;
    let after = i64::try_from(after).unwrap_or(i64::MAX);
    let rows = statement.query_map(params![id.to_string(), after], |row| {
        let number: i64 = row.get(0)?;
        Ok(StateChange {
            number: number.unsigned_abs(),
            state: state(row, 1)?,
            epoch: row.get(2)?,
            at: time(row, 3)?,
        })
    })?;
    Ok(rows.collect::<rusqlite::Result<_>>()?)
}

pub(super) fn ended(connection: &Connection, jobs: Vec<JobId>) -> Result<Vec<JobId>, StoreError> {
    let mut statement =
        connection.prepare_cached("SELECT 1 FROM jobs WHERE id = ?1 AND finished_at IS NULL")?;
    let mut ended = Vec::new();
    for id in jobs {
        if !statement.exists([id.to_string()])? {
            ended.push(id);
        }
    }
    Ok(ended)
}

pub(super) fn counts(connection: &Connection, now: i64) -> Result<JobCounts, StoreError> {
    let mut statement = connection.prepare_cached("SELECT state, jobs FROM tallies")?;
    let mut counts = JobCounts::default();
    let mut rows = statement.query([])?;
    while let Some(row) = rows.next()? {
        let jobs: i64 = row.get(1)?;
        let jobs = usize::try_from(jobs).unwrap_or_default();
        counts.all += jobs;
        match word(row, 0, JobState::from_word)? {
            JobState::Queued => counts.queued = jobs,
            JobState::Running => counts.running = jobs,
            _ => {}
        }
    }
    let mut statement = connection
        .prepare_cached("SELECT created_at FROM jobs WHERE state = 'queued' ORDER BY id LIMIT 1")?;
    let oldest: Option<i64> = statement.query_row([], |row| row.get(0)).optional()?;
    counts.longest_queued =
        oldest.map(|at| Duration::from_millis(u64::try_from(now.saturating_sub(at)).unwrap_or_default()));
    // All open ones but those that run, of which there are few.
    let mut statement = connection.prepare_cached(
        "SELECT (SELECT coalesce(sum(open_bytes), 0) FROM holdings WHERE open_bytes > 0)
            - (SELECT coalesce(sum(input ->> 'bytes'), 0) FROM jobs WHERE state = 'running')",
    )?;
    let queued_bytes: i64 = statement.query_row([], |row| row.get(0))?;
    counts.queued_bytes = u64::try_from(queued_bytes).unwrap_or_default();
    Ok(counts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jobs_that_did_the_same_are_found_without_sorting_them() {
        let mut connection = Connection::open_in_memory().unwrap();
        super::super::schema::migrate(&mut connection).unwrap();
        let mut plan = connection.prepare(&format!("EXPLAIN QUERY PLAN {}", equal_jobs_sql())).unwrap();
        let steps =
            plan.query_map(params![[0_u8; 32], "owner", "repair", ENGINE_VERSION, 0], |row| row.get(3));
        let steps = steps.unwrap().collect::<rusqlite::Result<Vec<String>>>().unwrap();
        let lookup = "SEARCH jobs USING INDEX jobs_by_input (input_sha256=? AND operation=? AND owner=?)";
        assert_eq!(steps, [lookup]);
    }
}
