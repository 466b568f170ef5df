//! One connection of the pool: statements by their text, and transactions that end with the call that made them.

use std::pin::Pin;
use std::time::Duration;

use deadpool_postgres::{Client, Pool};
use tokio_postgres::types::ToSql;
use tokio_postgres::{Row, SimpleQueryMessage};

use super::failure;
use crate::jobs::store::StoreError;

/// Values of a statement.
pub(super) type StatementValues<'v> = &'v [&'v (dyn ToSql + Sync)];
/// What is done in a transaction, or beside one.
pub(super) type TransactionFuture<'s, T> = Pin<Box<dyn Future<Output = Result<T, StoreError>> + Send + 's>>;

/// Longest time for a whole call: longer than any statement or wait for a lock may take.
const CALL_MAX: Duration = Duration::from_secs(40);

/// A connection.
pub(super) struct Session {
    client: Client,
    /// The time of the database when the transaction began; 0 outside of one.
    pub(super) now: i64,
}

impl Session {
    /// Looks into the tables.
    pub(super) async fn look<T>(
        pool: &Pool,
        body: impl for<'s> FnOnce(&'s Self) -> TransactionFuture<'s, T>,
    ) -> Result<T, StoreError> {
        let looking = async {
            let client = connection(pool).await?;
            body(&Self { client, now: 0 }).await
        };
        tokio::time::timeout(CALL_MAX, looking).await.map_err(|_| too_late())?
    }

    /// Makes a change, all of it or nothing.
    pub(super) async fn transact<T>(
        pool: &Pool,
        body: impl for<'s> FnOnce(&'s Self) -> TransactionFuture<'s, T>,
    ) -> Result<T, StoreError> {
        let mut open = Open(None);
        let changing = async {
            let client = connection(pool).await?;
            let session = open.0.insert(Self { client, now: 0 });
            session.now = session.begin().await?;
            let result = body(session).await;
            let end = if result.is_ok() { "COMMIT" } else { "ROLLBACK" };
            let ended = session.client.batch_execute(end).await;
            if ended.is_ok() {
                // Only a connection without an open transaction goes back to the pool.
                drop(open.0.take());
            }
            let value = result?;
            ended.map_err(|error| failure(&error))?;
            Ok(value)
        };
        tokio::time::timeout(CALL_MAX, changing).await.map_err(|_| too_late())?
    }

    /// Begins a transaction. The time.
    async fn begin(&self) -> Result<i64, StoreError> {
        let answer = self.client.simple_query("BEGIN; SELECT now_ms()").await.map_err(|e| failure(&e))?;
        let time = answer.iter().find_map(|message| match message {
            SimpleQueryMessage::Row(row) => row.get(0)?.parse().ok(),
            _ => None,
        });
        time.ok_or_else(|| StoreError::Unavailable("the database does not tell the time".to_owned()))
    }

    /// Every row.
    pub(super) async fn rows(&self, sql: &str, values: StatementValues<'_>) -> Result<Vec<Row>, StoreError> {
        let rows = async { self.client.query(&self.client.prepare_cached(sql).await?, values).await };
        rows.await.map_err(|error| failure(&error))
    }

    /// The one row, if there is one.
    pub(super) async fn row_if_any(
        &self,
        sql: &str,
        values: StatementValues<'_>,
    ) -> Result<Option<Row>, StoreError> {
        let row = async { self.client.query_opt(&self.client.prepare_cached(sql).await?, values).await };
        row.await.map_err(|error| failure(&error))
    }

    /// The one row; [`StoreError::NotFound`] when there is none.
    pub(super) async fn row(&self, sql: &str, values: StatementValues<'_>) -> Result<Row, StoreError> {
        self.row_if_any(sql, values).await?.ok_or(StoreError::NotFound)
    }

    /// How many rows were changed.
    pub(super) async fn change(&self, sql: &str, values: StatementValues<'_>) -> Result<u64, StoreError> {
        let changed = async { self.client.execute(&self.client.prepare_cached(sql).await?, values).await };
        changed.await.map_err(|error| failure(&error))
    }
}

/// A session whose transaction may be open. Dropped with it, its connection is closed, which undoes the transaction.
struct Open(Option<Session>);

impl Drop for Open {
    fn drop(&mut self) {
        if let Some(session) = self.0.take() {
            drop(Client::take(session.client));
        }
    }
}

async fn connection(pool: &Pool) -> Result<Client, StoreError> {
    pool.get().await.map_err(|error| match error {
        deadpool_postgres::PoolError::Backend(error) => failure(&error),
        other => StoreError::Unavailable(format!("no connection to the database: {other}")),
    })
}

fn too_late() -> StoreError {
    StoreError::Unavailable(format!("the database did not answer within {CALL_MAX:?}"))
}
