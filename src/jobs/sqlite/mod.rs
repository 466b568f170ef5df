//! Rows in one SQLite file: durable when a method returns, for one process.
//!
//! One thread writes, some connections read. The file is in write-ahead mode with `synchronous=FULL`: a commit is on the
//! disk before it is told, and readers see whole changes only.

mod claims;
mod export;
mod identity;
mod keeping;
mod listing;
mod outbox;
mod rows;
mod schema;
mod secrets;
mod tenants;
mod uploads;
mod wall;
mod writer;

use std::collections::HashSet;
use std::fmt;
use std::fs::{File, Permissions};
use std::os::unix::fs::{OpenOptionsExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use jiff::Timestamp;
use rusqlite::{Connection, ErrorCode, OpenFlags};

use super::store::{
    AfterLoss, BlobRef, ClaimRef, ClaimRequest, Created, Delivery, DeliveryRequest, EndedJobs, Ending,
    Holding, IdempotencyKey, JobCounts, JobId, JobRow, JobStore, Leases, ListQuery, NewJob, NextTry, Sealer,
    StateChange, StoreError, StoreFuture, Tenant, TryOutcome,
};
use crate::wire::Problem;
pub(super) use export::Export;
pub use identity::StoreFile;
pub use schema::SqliteOpenError;
use writer::WriterHandle;

/// Time for which a connection waits for another process that looks into the file.
const BUSY_PATIENCE: Duration = Duration::from_secs(5);
/// Most connections that are kept for reading.
const READERS_MAX: usize = 8;

/// The clock of a store: milliseconds since 1970.
pub type StoreClock = Arc<dyn Fn() -> i64 + Send + Sync>;

/// A store in a file.
pub struct SqliteStore {
    clock: StoreClock,
    /// By which leases end: one that goes on evenly, however the time of day is set. It begins anew with
    /// each process.
    lease_clock: StoreClock,
    connections: Arc<Connections>,
}

/// The connections to one file. A reader closes before the writer, also when it still looks into the file as the store is
/// dropped: the last connection takes the log file with it, which one that only reads cannot do.
struct Connections {
    // Dropped in this order.
    readers: Readers,
    writer: WriterHandle,
}

impl fmt::Debug for SqliteStore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SqliteStore").field("path", &self.connections.readers.path).finish_non_exhaustive()
    }
}

impl SqliteStore {
    /// Opens the file, or makes it; one of an older version becomes one of this version. The leases of an earlier process are
    /// over. Blocks.
    ///
    /// # Errors
    /// The file cannot be used, or a newer program made it.
    pub fn open(path: &Path) -> Result<Self, SqliteOpenError> {
        let connection = connect(path)?;
        claims::end_leases(&connection)?;
        Self::over(path, connection, Arc::new(wall::now_ms), Arc::new(wall::even_ms))
    }

    /// As [`open`](Self::open), with another clock, which is taken to go on from the earlier process to this one.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn open_with(path: &Path, clock: StoreClock) -> Result<Self, SqliteOpenError> {
        Self::over(path, connect(path)?, Arc::clone(&clock), clock)
    }

    fn over(
        path: &Path,
        connection: Connection,
        clock: StoreClock,
        lease_clock: StoreClock,
    ) -> Result<Self, SqliteOpenError> {
        let writer = WriterHandle::start(connection)
            .map_err(|error| rusqlite::Error::ToSqlConversionFailure(Box::new(error)))?;
        let readers = Readers { path: path.to_owned(), idle: Mutex::default() };
        Ok(Self { clock, lease_clock, connections: Arc::new(Connections { readers, writer }) })
    }

    /// What the file at `path` is, before it is opened or made. Blocks.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn look_at(path: &Path) -> Result<StoreFile, SqliteOpenError> {
        identity::look_at(path)
    }

    /// Whether a row of the store at `path` names one of these files. Blocks.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn names_any(path: &Path, keys: &[&str]) -> Result<bool, SqliteOpenError> {
        identity::names_any(path, keys)
    }

    /// The mark that this store and its files have, given when it has none yet. Blocks.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn set_mark(path: &Path, mark: &str) -> Result<(), SqliteOpenError> {
        identity::set_mark(path, mark)
    }

    /// Makes a change, at the time of the store's clock.
    fn write<T: Send + 'static>(
        &self,
        body: impl FnOnce(&Connection, i64) -> Result<T, StoreError> + Send + 'static,
    ) -> StoreFuture<'_, T> {
        let clock = Arc::clone(&self.clock);
        self.connections.writer.write(move |connection| body(connection, clock()))
    }

    /// Looks one row or a few numbers up, at once: they are in memory nearly always, and take less time than handing the
    /// question to another thread.
    fn look_up<T: Send + 'static>(
        &self,
        body: impl FnOnce(&Connection, i64) -> Result<T, StoreError>,
    ) -> StoreFuture<'_, T> {
        let now = (self.clock)();
        Box::pin(std::future::ready(self.connections.readers.with(|connection| body(connection, now))))
    }

    /// Looks into the file, at the time of the store's clock.
    fn read<T: Send + 'static>(
        &self,
        body: impl FnOnce(&Connection, i64) -> Result<T, StoreError> + Send + 'static,
    ) -> StoreFuture<'_, T> {
        let (clock, connections) = (Arc::clone(&self.clock), Arc::clone(&self.connections));
        let look = move || connections.readers.with(|connection| body(connection, clock()));
        Box::pin(async move {
            let looked = tokio::task::spawn_blocking(look).await;
            looked.map_err(|error| StoreError::Unavailable(error.to_string()))?
        })
    }
}

/// Connections that only read.
struct Readers {
    path: PathBuf,
    idle: Mutex<Vec<Connection>>,
}

impl Readers {
    fn with<T>(&self, body: impl FnOnce(&Connection) -> Result<T, StoreError>) -> Result<T, StoreError> {
        let kept = self.idle().pop();
        let connection = match kept {
            Some(connection) => connection,
            None => reader(&self.path).map_err(|error| failure(&error))?,
        };
        let result = body(&connection);
        if !matches!(result, Err(StoreError::Unavailable(_))) {
            let mut idle = self.idle();
            if idle.len() < READERS_MAX {
                idle.push(connection);
            }
        }
        result
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Connection>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The connection that writes, to a file of this version.
fn connect(path: &Path) -> Result<Connection, SqliteOpenError> {
    make_private(path)?;
    let mut connection = Connection::open(path)?;
    connection.busy_timeout(BUSY_PATIENCE)?;
    connection.pragma_update(None, "journal_mode", "WAL")?;
    connection.pragma_update(None, "synchronous", "FULL")?;
    connection.pragma_update(None, "foreign_keys", "ON")?;
    keep_temporary_data_in_memory(&connection)?;
    connection.set_prepared_statement_cache_capacity(128);
    schema::migrate(&mut connection)?;
    Ok(connection)
}

/// Makes the file for this user alone, if there is none; SQLite gives the files beside it the same rights.
fn make_private(path: &Path) -> Result<(), SqliteOpenError> {
    let file =
        File::options().create(true).append(true).mode(0o600).open(path).map_err(SqliteOpenError::File)?;
    // The file of another user, who lets this one write, stays as it is.
    let _ = file.set_permissions(Permissions::from_mode(0o600));
    Ok(())
}

fn reader(path: &Path) -> rusqlite::Result<Connection> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = Connection::open_with_flags(path, flags)?;
    connection.busy_timeout(BUSY_PATIENCE)?;
    keep_temporary_data_in_memory(&connection)?;
    connection.set_prepared_statement_cache_capacity(64);
    Ok(connection)
}

/// What undoes a change that fails would go to a file in `/var/tmp` otherwise, with each change, as far as there is such a
/// folder to write to.
fn keep_temporary_data_in_memory(connection: &Connection) -> rusqlite::Result<()> {
    connection.pragma_update(None, "temp_store", "MEMORY")
}

/// What SQLite says, as every store says it.
fn failure(error: &rusqlite::Error) -> StoreError {
    match error.sqlite_error_code() {
        Some(ErrorCode::DiskFull) => StoreError::Full(error.to_string()),
        _ => StoreError::Unavailable(error.to_string()),
    }
}

impl From<rusqlite::Error> for StoreError {
    fn from(error: rusqlite::Error) -> Self {
        match error {
            rusqlite::Error::QueryReturnedNoRows => Self::NotFound,
            other => failure(&other),
        }
    }
}

impl JobStore for SqliteStore {
    fn create(&self, job: NewJob, queue_max: usize) -> StoreFuture<'_, Created> {
        self.write(move |connection, now| claims::create(connection, &job, queue_max, now))
    }

    fn get(&self, id: JobId) -> StoreFuture<'_, JobRow> {
        self.look_up(move |connection, now| rows::get(connection, id, now))
    }

    fn find_keyed(&self, owner: Option<String>, key: IdempotencyKey) -> StoreFuture<'_, Option<JobRow>> {
        self.look_up(move |connection, now| listing::find_keyed(connection, owner.as_deref(), &key, now))
    }

    fn find_equal(&self, job: &NewJob) -> StoreFuture<'_, Option<JobRow>> {
        let job = job.clone();
        self.look_up(move |connection, now| listing::find_equal(connection, &job, now))
    }

    fn list(&self, query: ListQuery) -> StoreFuture<'_, Vec<JobRow>> {
        self.read(move |connection, now| listing::list(connection, &query, now))
    }

    fn deadlines(&self) -> StoreFuture<'_, Vec<(JobId, Duration)>> {
        self.read(listing::deadlines)
    }

    fn changes(&self, id: JobId, after: u64) -> StoreFuture<'_, Vec<StateChange>> {
        self.read(move |connection, _| listing::changes(connection, id, after))
    }

    fn ended(&self, jobs: Vec<JobId>) -> StoreFuture<'_, Vec<JobId>> {
        self.read(move |connection, _| listing::ended(connection, jobs))
    }

    fn is_shared(&self) -> bool {
        false
    }

    fn counts(&self) -> StoreFuture<'_, JobCounts> {
        self.look_up(listing::counts)
    }

    fn holding(&self, tenant: Tenant) -> StoreFuture<'_, Holding> {
        self.look_up(move |connection, _| tenants::holding(connection, &tenant))
    }

    fn claim(&self, request: ClaimRequest) -> StoreFuture<'_, Option<JobRow>> {
        let lease_clock = Arc::clone(&self.lease_clock);
        self.write(move |connection, now| claims::claim(connection, &request, lease_clock(), now))
    }

    fn renew(&self, claim: ClaimRef, lease: Duration) -> StoreFuture<'_, bool> {
        let lease_clock = Arc::clone(&self.lease_clock);
        self.write(move |connection, _| claims::renew(connection, claim, lease, lease_clock()))
    }

    fn finish(&self, claim: ClaimRef, ending: Ending) -> StoreFuture<'_, ()> {
        self.write(move |connection, now| claims::finish(connection, claim, &ending, now))
    }

    fn release(&self, claim: ClaimRef) -> StoreFuture<'_, AfterLoss> {
        self.write(move |connection, now| claims::release(connection, claim, now))
    }

    fn demote(&self, claim: ClaimRef, is_outgrown: bool) -> StoreFuture<'_, AfterLoss> {
        self.write(move |connection, now| claims::demote(connection, claim, is_outgrown, now))
    }

    fn lose(&self, claim: ClaimRef, problem: Problem, attempts_max: u32) -> StoreFuture<'_, AfterLoss> {
        self.write(move |connection, now| claims::lose(connection, claim, problem, attempts_max, now))
    }

    fn recover(
        &self,
        leases: Leases,
        problem: Problem,
        attempts_max: u32,
    ) -> StoreFuture<'_, Vec<(JobId, AfterLoss)>> {
        let lease_clock = Arc::clone(&self.lease_clock);
        self.write(move |connection, now| {
            claims::recover(connection, &leases, lease_clock(), &problem, attempts_max, now)
        })
    }

    fn end_queued(&self, id: JobId, ending: Ending) -> StoreFuture<'_, bool> {
        self.write(move |connection, now| claims::end_queued(connection, id, &ending, now))
    }

    fn cancel(&self, id: JobId, ending: Ending) -> StoreFuture<'_, bool> {
        self.write(move |connection, now| claims::cancel(connection, id, &ending, now))
    }

    fn expire(&self, id: JobId) -> StoreFuture<'_, Vec<BlobRef>> {
        self.write(move |connection, _| keeping::expire(connection, id))
    }

    fn delete(&self, id: JobId) -> StoreFuture<'_, Vec<BlobRef>> {
        self.write(move |connection, _| keeping::delete(connection, id))
    }

    fn due(&self) -> StoreFuture<'_, Vec<JobId>> {
        self.read(keeping::due)
    }

    fn first_to_go(&self, kept: EndedJobs, asker: Tenant) -> StoreFuture<'_, Option<JobId>> {
        self.read(move |connection, _| tenants::first_to_go(connection, kept, &asker))
    }

    fn first_to_go_of(&self, kept: EndedJobs, tenant: Tenant) -> StoreFuture<'_, Option<JobId>> {
        self.read(move |connection, _| tenants::first_to_go_of(connection, kept, &tenant))
    }

    fn current(&self, claims: Vec<ClaimRef>) -> StoreFuture<'_, HashSet<ClaimRef>> {
        self.read(move |connection, _| keeping::current(connection, &claims))
    }

    fn seal_secrets(&self, seal: Sealer) -> StoreFuture<'_, usize> {
        self.write(move |connection, _| secrets::seal(connection, &*seal))
    }

    fn named(&self, keys: Vec<String>) -> StoreFuture<'_, HashSet<String>> {
        self.read(move |connection, _| keeping::named(connection, keys))
    }

    fn claim_deliveries(&self, request: DeliveryRequest) -> StoreFuture<'_, Vec<Delivery>> {
        self.write(move |connection, now| outbox::claim(connection, request, now))
    }

    fn note_try(
        &self,
        delivery: String,
        epoch: u32,
        outcome: TryOutcome,
        next: NextTry,
    ) -> StoreFuture<'_, bool> {
        self.write(move |connection, now| outbox::note_try(connection, &delivery, epoch, &outcome, next, now))
    }

    fn deliveries(&self, job: JobId) -> StoreFuture<'_, Vec<Delivery>> {
        self.read(move |connection, _| outbox::of_job(connection, job))
    }

    fn redeliver(&self, job: JobId, delivery: String) -> StoreFuture<'_, Delivery> {
        self.write(move |connection, now| outbox::redeliver(connection, job, &delivery, now))
    }

    fn next_delivery(&self) -> StoreFuture<'_, Option<Timestamp>> {
        self.read(|connection, _| outbox::next_due(connection))
    }
}
