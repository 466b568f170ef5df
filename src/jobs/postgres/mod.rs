//! Rows in a PostgreSQL database that any number of servers share.
//!
//! Every change is one transaction, durable when its method returns, and timed by the clock of the database. A change is made
//! to its end also when nobody waits for it any more.

mod access;
mod claims;
mod hints;
mod import;
mod keeping;
mod listing;
mod locks;
mod outbox;
mod rows;
mod schema;
mod session;
mod tenants;
mod uploads;

use std::collections::HashSet;
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use deadpool_postgres::Pool;
use jiff::Timestamp;
use tokio_postgres::error::SqlState;

use super::store::{
    AfterLoss, BlobRef, ClaimRef, ClaimRequest, Created, Delivery, DeliveryRequest, EndedJobs, Ending, Hint,
    Hints, Holding, IdempotencyKey, JobCounts, JobId, JobRow, JobStore, Leases, ListQuery, NewJob, NextTry,
    Sealer, StateChange, StoreError, StoreFuture, Tenant, TryOutcome,
};
use crate::wire::{JobState, Problem};
pub use access::DatabaseAccess;
use hints::HintLine;
pub(super) use import::Rows;
#[cfg(test)]
pub(super) use schema::schema_steps;
use session::{Session, TransactionFuture};

/// A store in a database.
pub struct PostgresStore {
    pool: Pool,
    mark: String,
    line: Arc<HintLine>,
}

impl fmt::Debug for PostgresStore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PostgresStore").field("mark", &self.mark).finish_non_exhaustive()
    }
}

/// A database that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PostgresOpenError {
    /// It is not named as a database is.
    #[error("the address cannot be read: {0}")]
    Address(String),
    /// It says why, or does not answer.
    #[error("{0}")]
    Database(String),
    /// A newer program made its tables, and no older one works with them.
    #[error(
        "its tables have version {found}, for programs from version {oldest} on; this program knows {known}"
    )]
    TooNew {
        /// Their version.
        found: i64,
        /// The oldest version whose programs work with them.
        oldest: i64,
        /// The newest one known.
        known: i64,
    },
}

impl From<tokio_postgres::Error> for PostgresOpenError {
    fn from(error: tokio_postgres::Error) -> Self {
        Self::Database(told(&error))
    }
}

impl PostgresStore {
    /// Opens the database; tables of an older version become those of this one.
    ///
    /// # Errors
    /// The database cannot be reached or used, or a newer program made its tables.
    pub async fn open(access: &DatabaseAccess) -> Result<Self, PostgresOpenError> {
        let pool = access::pool(access)?;
        let client = pool.get().await.map_err(|error| match error {
            deadpool_postgres::PoolError::Backend(error) => PostgresOpenError::from(error),
            other => PostgresOpenError::Database(other.to_string()),
        })?;
        schema::migrate(&client).await?;
        let mark = client.query_one("SELECT mark FROM identity", &[]).await?.try_get(0)?;
        drop(client);
        Ok(Self { pool, mark, line: Arc::new(HintLine::open(access.clone())) })
    }

    /// The mark that this store and its files have.
    pub fn mark(&self) -> &str {
        &self.mark
    }

    /// Makes a change that no other server waits for.
    fn write<T: Send + 'static>(
        &self,
        body: impl for<'s> FnOnce(&'s Session) -> TransactionFuture<'s, T> + Send + 'static,
    ) -> StoreFuture<'_, T> {
        self.write_and_tell(body, |_| Vec::new())
    }

    /// Makes a change, and tells other servers of it.
    fn write_and_tell<T: Send + 'static>(
        &self,
        body: impl for<'s> FnOnce(&'s Session) -> TransactionFuture<'s, T> + Send + 'static,
        hints: impl FnOnce(&T) -> Vec<Hint> + Send + 'static,
    ) -> StoreFuture<'_, T> {
        let (pool, line) = (self.pool.clone(), Arc::clone(&self.line));
        Box::pin(async move {
            let change = tokio::spawn(async move {
                Session::transact(&pool, body).await.inspect(|made| line.tell(hints(made)))
            });
            change.await.map_err(|error| StoreError::Unavailable(error.to_string()))?
        })
    }

    /// Makes a change of one statement, which is a transaction by itself, and tells other servers of it.
    fn write_at_once<T: Send + 'static>(
        &self,
        body: impl for<'s> FnOnce(&'s Session) -> TransactionFuture<'s, T> + Send + 'static,
        hint: Option<Hint>,
    ) -> StoreFuture<'_, T> {
        let (pool, line) = (self.pool.clone(), Arc::clone(&self.line));
        Box::pin(async move {
            let change =
                tokio::spawn(async move { Session::look(&pool, body).await.inspect(|_| line.tell(hint)) });
            change.await.map_err(|error| StoreError::Unavailable(error.to_string()))?
        })
    }

    /// Looks into the tables.
    fn read<T: Send + 'static>(
        &self,
        body: impl for<'s> FnOnce(&'s Session) -> TransactionFuture<'s, T> + Send + 'static,
    ) -> StoreFuture<'_, T> {
        Box::pin(Session::look(&self.pool, body))
    }
}

/// What others are told of a job whose run is over.
fn after_run(id: JobId, after: AfterLoss) -> Vec<Hint> {
    match after {
        AfterLoss::Queued => vec![Hint::Job(id), Hint::Work],
        AfterLoss::Ended => vec![Hint::Job(id)],
    }
}

/// What the database says, as every store says it.
fn failure(error: &tokio_postgres::Error) -> StoreError {
    let told = told(error);
    match error.code() {
        Some(code) if *code == SqlState::DISK_FULL => StoreError::Full(told),
        _ => StoreError::Unavailable(told),
    }
}

/// What the database says, without the values that it would show.
fn told(error: &tokio_postgres::Error) -> String {
    use std::error::Error as _;
    match (error.as_db_error(), error.source()) {
        (Some(error), _) => format!("the database says: {} ({})", error.message(), error.code().code()),
        (None, Some(source)) => format!("the database does not answer: {source}"),
        (None, None) => format!("the database does not answer: {error}"),
    }
}

impl JobStore for PostgresStore {
    fn create(&self, job: NewJob, queue_max: usize) -> StoreFuture<'_, Created> {
        self.write_and_tell(
            move |session| Box::pin(claims::create(session, job, queue_max)),
            |created| match created {
                Created::New(row) if row.state == JobState::Queued => vec![Hint::Work],
                Created::New(_) | Created::Known(_) => Vec::new(),
            },
        )
    }

    fn get(&self, id: JobId) -> StoreFuture<'_, JobRow> {
        self.read(move |session| Box::pin(rows::get(session, id)))
    }

    fn find_keyed(&self, owner: Option<String>, key: IdempotencyKey) -> StoreFuture<'_, Option<JobRow>> {
        self.read(move |session| {
            Box::pin(async move { listing::find_keyed(session, owner.as_deref(), &key).await })
        })
    }

    fn find_equal(&self, job: &NewJob) -> StoreFuture<'_, Option<JobRow>> {
        let job = job.clone();
        self.read(move |session| Box::pin(listing::find_equal(session, job)))
    }

    fn list(&self, query: ListQuery) -> StoreFuture<'_, Vec<JobRow>> {
        self.read(move |session| Box::pin(listing::list(session, query)))
    }

    fn deadlines(&self) -> StoreFuture<'_, Vec<(JobId, Duration)>> {
        self.read(|session| Box::pin(listing::deadlines(session)))
    }

    fn changes(&self, id: JobId, after: u64) -> StoreFuture<'_, Vec<StateChange>> {
        self.read(move |session| Box::pin(listing::changes(session, id, after)))
    }

    fn ended(&self, jobs: Vec<JobId>) -> StoreFuture<'_, Vec<JobId>> {
        self.read(move |session| Box::pin(listing::ended(session, jobs)))
    }

    fn is_shared(&self) -> bool {
        true
    }

    fn hints(&self) -> Option<Hints> {
        Some(self.line.hints())
    }

    fn counts(&self) -> StoreFuture<'_, JobCounts> {
        self.read(|session| Box::pin(listing::counts(session)))
    }

    fn holding(&self, tenant: Tenant) -> StoreFuture<'_, Holding> {
        self.read(move |session| Box::pin(tenants::holding(session, tenant)))
    }

    fn claim(&self, request: ClaimRequest) -> StoreFuture<'_, Option<JobRow>> {
        Box::pin(async move {
            let asked = request.clone();
            let turns = self.read(move |session| Box::pin(tenants::in_turn(session, asked))).await?;
            if turns.is_empty() {
                return Ok(None);
            }
            let asked = request.clone();
            let claim = self.write_and_tell(
                move |session| Box::pin(claims::claim_in_turn(session, asked, turns)),
                |(row, _)| row.iter().map(|row| Hint::Job(row.id)).collect(),
            );
            let (row, left) = claim.await?;
            if row.is_some() {
                return Ok(row);
            }
            // Jobs may be left to those of whom others have claimed one meanwhile.
            for (tenant, lane) in left {
                let request = request.clone();
                let claim = self.write_and_tell(
                    move |session| Box::pin(claims::claim(session, request, tenant, lane)),
                    |row| row.iter().map(|row| Hint::Job(row.id)).collect(),
                );
                if let Some(row) = claim.await? {
                    return Ok(Some(row));
                }
            }
            Ok(None)
        })
    }

    fn renew(&self, claim: ClaimRef, lease: Duration) -> StoreFuture<'_, bool> {
        self.write_at_once(move |session| Box::pin(claims::renew(session, claim, lease)), None)
    }

    fn finish(&self, claim: ClaimRef, ending: Ending) -> StoreFuture<'_, ()> {
        let hint = Some(Hint::Job(claim.id));
        self.write_at_once(move |session| Box::pin(claims::finish(session, claim, ending)), hint)
    }

    fn release(&self, claim: ClaimRef) -> StoreFuture<'_, AfterLoss> {
        self.write_and_tell(
            move |session| Box::pin(claims::release(session, claim)),
            move |&after| after_run(claim.id, after),
        )
    }

    fn demote(&self, claim: ClaimRef, is_outgrown: bool) -> StoreFuture<'_, AfterLoss> {
        self.write_and_tell(
            move |session| Box::pin(claims::demote(session, claim, is_outgrown)),
            move |&after| after_run(claim.id, after),
        )
    }

    fn lose(&self, claim: ClaimRef, problem: Problem, attempts_max: u32) -> StoreFuture<'_, AfterLoss> {
        self.write_and_tell(
            move |session| Box::pin(claims::lose(session, claim, problem, attempts_max)),
            move |&after| after_run(claim.id, after),
        )
    }

    fn recover(
        &self,
        leases: Leases,
        problem: Problem,
        attempts_max: u32,
    ) -> StoreFuture<'_, Vec<(JobId, AfterLoss)>> {
        self.write_and_tell(
            move |session| Box::pin(claims::recover(session, leases, problem, attempts_max)),
            |recovered| recovered.iter().flat_map(|&(id, after)| after_run(id, after)).collect(),
        )
    }

    fn end_queued(&self, id: JobId, ending: Ending) -> StoreFuture<'_, bool> {
        self.write_and_tell(
            move |session| Box::pin(claims::end_queued(session, id, ending)),
            move |_| vec![Hint::Job(id)],
        )
    }

    fn cancel(&self, id: JobId, ending: Ending) -> StoreFuture<'_, bool> {
        self.write_and_tell(
            move |session| Box::pin(claims::cancel(session, id, ending)),
            move |_| vec![Hint::Job(id)],
        )
    }

    fn expire(&self, id: JobId) -> StoreFuture<'_, Vec<BlobRef>> {
        self.write(move |session| Box::pin(keeping::expire(session, id)))
    }

    fn delete(&self, id: JobId) -> StoreFuture<'_, Vec<BlobRef>> {
        self.write_and_tell(
            move |session| Box::pin(keeping::delete(session, id)),
            move |_| vec![Hint::Job(id)],
        )
    }

    fn due(&self) -> StoreFuture<'_, Vec<JobId>> {
        self.read(|session| Box::pin(keeping::due(session)))
    }

    fn first_to_go(&self, kept: EndedJobs, asker: Tenant) -> StoreFuture<'_, Option<JobId>> {
        self.read(move |session| Box::pin(tenants::first_to_go(session, kept, asker)))
    }

    fn first_to_go_of(&self, kept: EndedJobs, tenant: Tenant) -> StoreFuture<'_, Option<JobId>> {
        self.read(move |session| {
            Box::pin(async move { tenants::first_to_go_of(session, kept, &tenant).await })
        })
    }

    fn current(&self, claims: Vec<ClaimRef>) -> StoreFuture<'_, HashSet<ClaimRef>> {
        self.read(move |session| Box::pin(keeping::current(session, claims)))
    }

    fn seal_secrets(&self, seal: Sealer) -> StoreFuture<'_, usize> {
        self.write(move |session| Box::pin(outbox::seal(session, seal)))
    }

    fn named(&self, keys: Vec<String>) -> StoreFuture<'_, HashSet<String>> {
        self.read(move |session| Box::pin(keeping::named(session, keys)))
    }

    fn claim_deliveries(&self, request: DeliveryRequest) -> StoreFuture<'_, Vec<Delivery>> {
        self.write(move |session| Box::pin(outbox::claim(session, request)))
    }

    fn note_try(
        &self,
        delivery: String,
        epoch: u32,
        outcome: TryOutcome,
        next: NextTry,
    ) -> StoreFuture<'_, bool> {
        self.write(move |session| Box::pin(outbox::note_try(session, delivery, epoch, outcome, next)))
    }

    fn deliveries(&self, job: JobId) -> StoreFuture<'_, Vec<Delivery>> {
        self.read(move |session| Box::pin(outbox::of_job(session, job)))
    }

    fn redeliver(&self, job: JobId, delivery: String) -> StoreFuture<'_, Delivery> {
        self.write(move |session| Box::pin(outbox::redeliver(session, job, delivery)))
    }

    fn next_delivery(&self) -> StoreFuture<'_, Option<Timestamp>> {
        self.read(|session| Box::pin(outbox::next_due(session)))
    }
}
