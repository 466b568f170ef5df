//! Rows of the tables as the store speaks of them.

use std::time::Duration;

use jiff::Timestamp;
use serde::Serialize;
use serde::de::DeserializeOwned;
use tokio_postgres::Row;
use tokio_postgres::types::FromSql;
use uuid::Uuid;

use super::session::Session;
use crate::jobs::store::{JobId, JobRow, Lane, StoreError, Tenant};
use crate::jobs::trace::TraceParent;
use crate::wire::{JobState, Operation};

/// The columns that [`job`] reads, in its order.
pub(super) const COLUMNS: &str = "id, operation, options, file_name, owner, labels, webhook, input, material, \
     lane, state, epoch, attempts, created_at, cancel_at, started_at, finished_at, expires_at, ending, is_cached, trace, tenant, \
     is_outgrown, now_ms()";

/// The row of a job.
pub(super) async fn get(session: &Session, id: JobId) -> Result<JobRow, StoreError> {
    let row = session.row(&format!("SELECT {COLUMNS} FROM jobs WHERE id = $1"), &[&Uuid::from(id)]).await?;
    job(&row)
}

/// A row of [`COLUMNS`].
pub(super) fn job(row: &Row) -> Result<JobRow, StoreError> {
    let state = state(row, 10)?;
    let now: i64 = value(row, 23)?;
    let expires_at = time_if_any(row, 17)?;
    let left = |at: i64| Duration::from_millis(u64::try_from(at.saturating_sub(now)).unwrap_or_default());
    Ok(JobRow {
        id: id(row, 0)?,
        operation: word(row, 1, Operation::from_word)?,
        options: json(row, 2)?,
        file_name: json_if_any(row, 3)?,
        owner: value(row, 4)?,
        labels: json(row, 5)?,
        webhook: json_if_any(row, 6)?,
        input: json(row, 7)?,
        material: json_if_any(row, 8)?,
        lane: lane(value(row, 9)?),
        state,
        epoch: number(row, 11)?,
        attempts: number(row, 12)?,
        created_at: time(row, 13)?,
        time_left: value::<Option<i64>>(row, 14)?.map(left),
        started_at: time_if_any(row, 15)?,
        finished_at: time_if_any(row, 16)?,
        expires_at,
        is_due: state != JobState::Expired && expires_at.is_some_and(|at| at.as_millisecond() <= now),
        ending: json_if_any(row, 18)?,
        is_cached: value(row, 19)?,
        trace: value::<Option<&str>>(row, 20)?.and_then(TraceParent::parse),
        tenant: Tenant::named(value::<&str>(row, 21)?),
        is_outgrown: value(row, 22)?,
    })
}

/// A value as the database has it.
pub(super) fn value<'r, T: FromSql<'r>>(row: &'r Row, column: usize) -> Result<T, StoreError> {
    row.try_get(column).map_err(|error| unreadable(column, &error))
}

/// A number that is never negative.
pub(super) fn number<T: TryFrom<i64>>(row: &Row, column: usize) -> Result<T, StoreError> {
    let number = value::<i64>(row, column)?;
    T::try_from(number).map_err(|_| unreadable(column, &format_args!("{number} is out of range")))
}

/// An id.
pub(super) fn id(row: &Row, column: usize) -> Result<JobId, StoreError> {
    value::<Uuid>(row, column).map(JobId::from)
}

/// A lane as a number.
pub(super) fn number_of(lane: Lane) -> i64 {
    match lane {
        Lane::Interactive => 0,
        Lane::Bulk => 1,
    }
}

/// A lane, by its number.
pub(super) fn lane(number: i64) -> Lane {
    if number == number_of(Lane::Bulk) { Lane::Bulk } else { Lane::Interactive }
}

/// A state, by its word.
pub(super) fn state(row: &Row, column: usize) -> Result<JobState, StoreError> {
    word(row, column, JobState::from_word)
}

/// A value, by its word.
pub(super) fn word<T>(
    row: &Row,
    column: usize,
    from_word: impl Fn(&str) -> Option<T>,
) -> Result<T, StoreError> {
    let text: &str = value(row, column)?;
    from_word(text).ok_or_else(|| unreadable(column, &format_args!("unknown word `{text}`")))
}

/// A value that is kept as JSON.
pub(super) fn json<T: DeserializeOwned>(row: &Row, column: usize) -> Result<T, StoreError> {
    serde_json::from_str(value(row, column)?).map_err(|error| unreadable(column, &error))
}

/// The same, if there is one.
pub(super) fn json_if_any<T: DeserializeOwned>(row: &Row, column: usize) -> Result<Option<T>, StoreError> {
    let text: Option<&str> = value(row, column)?;
    text.map(serde_json::from_str).transpose().map_err(|error| unreadable(column, &error))
}

/// The JSON of a value to be kept.
pub(super) fn to_json(value: &(impl Serialize + ?Sized)) -> Result<String, StoreError> {
    serde_json::to_string(value).map_err(|error| StoreError::Unavailable(error.to_string()))
}

/// A time.
pub(super) fn time(row: &Row, column: usize) -> Result<Timestamp, StoreError> {
    Timestamp::from_millisecond(value(row, column)?).map_err(|error| unreadable(column, &error))
}

/// The same, if there is one.
pub(super) fn time_if_any(row: &Row, column: usize) -> Result<Option<Timestamp>, StoreError> {
    let ms: Option<i64> = value(row, column)?;
    ms.map(Timestamp::from_millisecond).transpose().map_err(|error| unreadable(column, &error))
}

/// The time `after` another, at most the last one there is.
pub(super) fn later(ms: i64, after: Duration) -> i64 {
    ms.saturating_add(i64::try_from(after.as_millis()).unwrap_or(i64::MAX)).min(last_ms())
}

/// The last time there is.
pub(super) fn last_ms() -> i64 {
    Timestamp::MAX.as_second() * 1000
}

fn unreadable(column: usize, error: &dyn std::fmt::Display) -> StoreError {
    StoreError::Unavailable(format!("column {column} cannot be read: {error}"))
}
