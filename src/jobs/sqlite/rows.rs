//! Rows of the tables as the store speaks of them.

use std::time::Duration;

use jiff::Timestamp;
use rusqlite::types::Type;
use rusqlite::{Connection, Row};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::jobs::store::{JobId, JobRow, Lane, StoreError, Tenant};
use crate::jobs::trace::TraceParent;
use crate::wire::{JobState, Operation};

/// The columns that [`job`] reads, in its order.
pub(super) const COLUMNS: &str = "id, operation, options, file_name, owner, labels, webhook, input, material, \
     lane, state, epoch, attempts, created_at, cancel_at, started_at, finished_at, expires_at, ending, is_cached, trace, tenant, \
     is_outgrown";

/// The row of a job, read at the time `now`.
pub(super) fn get(connection: &Connection, id: JobId, now: i64) -> Result<JobRow, StoreError> {
    let mut statement = connection.prepare_cached(&format!("SELECT {COLUMNS} FROM jobs WHERE id = ?1"))?;
    Ok(statement.query_row([id.to_string()], |row| job(row, now))?)
}

/// A row of [`COLUMNS`], read at the time `now`.
pub(super) fn job(row: &Row<'_>, now: i64) -> rusqlite::Result<JobRow> {
    let state = state(row, 10)?;
    let expires_at = time_if_any(row, 17)?;
    Ok(JobRow {
        id: parsed(row, 0)?,
        operation: word(row, 1, Operation::from_word)?,
        options: json(row, 2)?,
        file_name: row.get(3)?,
        owner: row.get(4)?,
        labels: json(row, 5)?,
        webhook: json_if_any(row, 6)?,
        input: json(row, 7)?,
        material: json_if_any(row, 8)?,
        lane: lane(row.get(9)?),
        state,
        epoch: row.get(11)?,
        attempts: row.get(12)?,
        created_at: time(row, 13)?,
        time_left: time_left_if_any(row, 14, now)?,
        started_at: time_if_any(row, 15)?,
        finished_at: time_if_any(row, 16)?,
        expires_at,
        is_due: state != JobState::Expired && expires_at.is_some_and(|at| at.as_millisecond() <= now),
        ending: json_if_any(row, 18)?,
        is_cached: row.get(19)?,
        trace: row.get::<_, Option<String>>(20)?.as_deref().and_then(TraceParent::parse),
        tenant: Tenant::named(row.get::<_, String>(21)?),
        is_outgrown: row.get(22)?,
    })
}

/// A lane as a number.
pub(super) fn number_of(lane: Lane) -> i64 {
    match lane {
        Lane::Interactive => 0,
        Lane::Bulk => 1,
    }
}

fn lane(number: i64) -> Lane {
    if number == number_of(Lane::Bulk) { Lane::Bulk } else { Lane::Interactive }
}

/// A state, by its word.
pub(super) fn state(row: &Row<'_>, column: usize) -> rusqlite::Result<JobState> {
    word(row, column, JobState::from_word)
}

/// An id, by its text.
pub(super) fn parsed(row: &Row<'_>, column: usize) -> rusqlite::Result<JobId> {
    let text: String = row.get(column)?;
    text.parse().map_err(|error| unreadable(column, error))
}

/// A value, by its word.
pub(super) fn word<T>(
    row: &Row<'_>,
    column: usize,
    from_word: impl Fn(&str) -> Option<T>,
) -> rusqlite::Result<T> {
    let text: String = row.get(column)?;
    from_word(&text).ok_or_else(|| unreadable(column, format!("unknown word `{text}`")))
}

/// A value that is kept as JSON.
pub(super) fn json<T: DeserializeOwned>(row: &Row<'_>, column: usize) -> rusqlite::Result<T> {
    let text: String = row.get(column)?;
    serde_json::from_str(&text).map_err(|error| unreadable(column, error))
}

fn json_if_any<T: DeserializeOwned>(row: &Row<'_>, column: usize) -> rusqlite::Result<Option<T>> {
    let text: Option<String> = row.get(column)?;
    text.map(|text| serde_json::from_str(&text)).transpose().map_err(|error| unreadable(column, error))
}

/// The JSON of a value to be kept.
pub(super) fn to_json(value: &impl Serialize) -> Result<String, StoreError> {
    serde_json::to_string(value).map_err(|error| StoreError::Unavailable(error.to_string()))
}

/// A time.
pub(super) fn time(row: &Row<'_>, column: usize) -> rusqlite::Result<Timestamp> {
    Timestamp::from_millisecond(row.get(column)?).map_err(|error| unreadable(column, error))
}

pub(super) fn time_if_any(row: &Row<'_>, column: usize) -> rusqlite::Result<Option<Timestamp>> {
    let ms: Option<i64> = row.get(column)?;
    ms.map(Timestamp::from_millisecond).transpose().map_err(|error| unreadable(column, error))
}

/// How long a time is from now; nothing when it is over.
pub(super) fn time_left(row: &Row<'_>, column: usize, now: i64) -> rusqlite::Result<Duration> {
    let ms = row.get::<_, i64>(column)?.saturating_sub(now);
    Ok(Duration::from_millis(u64::try_from(ms).unwrap_or_default()))
}

fn time_left_if_any(row: &Row<'_>, column: usize, now: i64) -> rusqlite::Result<Option<Duration>> {
    let is_set = row.get::<_, Option<i64>>(column)?.is_some();
    is_set.then(|| time_left(row, column, now)).transpose()
}

/// The time `after` another, at most the last one there is.
pub(super) fn later(ms: i64, after: Duration) -> i64 {
    let last = Timestamp::MAX.as_second() * 1000;
    ms.saturating_add(i64::try_from(after.as_millis()).unwrap_or(i64::MAX)).min(last)
}

fn unreadable(column: usize, error: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> rusqlite::Error {
    rusqlite::Error::FromSqlConversionFailure(column, Type::Text, error.into())
}
