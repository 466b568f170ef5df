//! Rows in memory: gone with the process.

use std::collections::{BTreeSet, HashMap};
use std::sync::{Mutex, PoisonError};

use jiff::Timestamp;

use super::store::{BlobRef, Finish, JobCounts, JobId, JobRow, JobStore, Kept, StoreError, StoreFuture};
use crate::wire::JobState;

/// A store for one process.
#[derive(Debug, Default)]
pub struct MemoryStore(Mutex<Rows>);

/// The rows, and the orders in which they are asked for.
#[derive(Debug, Default)]
struct Rows {
    by_id: HashMap<JobId, JobRow>,
    queued: BTreeSet<JobId>,
    running: usize,
    /// All ended jobs by the time they ended.
    ended: BTreeSet<(Timestamp, JobId)>,
    /// Those of them that keep files.
    with_files: BTreeSet<(Timestamp, JobId)>,
    /// Those of them that may be found by the digest of their input.
    by_input: HashMap<[u8; 32], BTreeSet<JobId>>,
    /// How many times rows name a blob.
    names: HashMap<String, usize>,
}

impl MemoryStore {
    /// Runs `body` on the rows at once; the future only carries its result.
    fn with<T: Send + 'static>(
        &self,
        body: impl FnOnce(&mut Rows) -> Result<T, StoreError>,
    ) -> StoreFuture<'_, T> {
        // Nothing inside a body panics half-way through a change.
        let result = body(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner));
        Box::pin(std::future::ready(result))
    }
}

impl JobStore for MemoryStore {
    fn create(&self, row: JobRow, source: Option<JobId>, queue_max: usize) -> StoreFuture<'_, ()> {
        self.with(|rows| {
            if let Some(source) = source
                && rows.get(source)?.state == JobState::Expired
            {
                return Err(StoreError::NotFound);
            }
            if row.state == JobState::Queued && rows.queued.len() >= queue_max {
                return Err(StoreError::QueueFull { queued: rows.queued.len() });
            }
            rows.add(row);
            Ok(())
        })
    }

    fn get(&self, id: JobId) -> StoreFuture<'_, JobRow> {
        self.with(|rows| rows.get(id).cloned())
    }

    fn claim(&self, now: Timestamp) -> StoreFuture<'_, Option<JobRow>> {
        self.with(|rows| {
            let Some(&id) = rows.queued.first() else { return Ok(None) };
            let mut row = rows.take(id)?;
            row.state = JobState::Running;
            row.epoch += 1;
            row.started_at = Some(now);
            rows.add(row.clone());
            Ok(Some(row))
        })
    }

    fn finish(&self, id: JobId, epoch: u32, finish: Finish) -> StoreFuture<'_, ()> {
        self.with(|rows| match rows.get(id) {
            Ok(row) if row.state == JobState::Running && row.epoch == epoch => rows.end(id, finish),
            _ => Err(StoreError::ClaimVoid),
        })
    }

    fn finish_queued(&self, id: JobId, finish: Finish) -> StoreFuture<'_, bool> {
        self.with(|rows| {
            let is_queued = rows.get(id)?.state == JobState::Queued;
            if is_queued {
                rows.end(id, finish)?;
            }
            Ok(is_queued)
        })
    }

    fn expire(&self, id: JobId) -> StoreFuture<'_, Vec<BlobRef>> {
        self.with(|rows| {
            if !rows.get(id)?.state.is_final() {
                return Ok(Vec::new());
            }
            let before = rows.take(id)?;
            let mut row = before.clone();
            row.state = JobState::Expired;
            rows.add(row);
            Ok(rows.orphans_of(&before))
        })
    }

    fn delete(&self, id: JobId) -> StoreFuture<'_, Vec<BlobRef>> {
        self.with(|rows| {
            let row = rows.take(id)?;
            Ok(rows.orphans_of(&row))
        })
    }

    fn due(&self, now: Timestamp) -> StoreFuture<'_, Vec<JobId>> {
        self.with(|rows| {
            let is_due = |id: &JobId| {
                rows.by_id
                    .get(id)
                    .and_then(|row| row.finish.as_ref())
                    .is_some_and(|finish| finish.expires_at <= now)
            };
            Ok(rows.with_files.iter().map(|&(_, id)| id).filter(is_due).collect())
        })
    }

    fn oldest_ended(&self, kept: Kept) -> StoreFuture<'_, Option<JobId>> {
        self.with(|rows| {
            let order = match kept {
                Kept::WithFiles => &rows.with_files,
                Kept::Any => &rows.ended,
            };
            Ok(order.first().map(|&(_, id)| id))
        })
    }

    fn find_equal(&self, row: &JobRow) -> StoreFuture<'_, Option<JobRow>> {
        self.with(|rows| {
            let ids = rows.by_input.get(&row.input.sha256).into_iter().flatten();
            let mut equal = ids
                .filter_map(|id| rows.by_id.get(id))
                .filter(|found| found.state == JobState::Succeeded && found.does_the_same_as(row));
            Ok(equal.next_back().cloned())
        })
    }

    fn counts(&self) -> StoreFuture<'_, JobCounts> {
        self.with(|rows| {
            Ok(JobCounts { queued: rows.queued.len(), running: rows.running, all: rows.by_id.len() })
        })
    }
}

impl Rows {
    fn get(&self, id: JobId) -> Result<&JobRow, StoreError> {
        self.by_id.get(&id).ok_or(StoreError::NotFound)
    }

    /// Puts a row into every order it belongs to.
    fn add(&mut self, row: JobRow) {
        match (row.state, &row.finish) {
            (JobState::Queued, _) => drop(self.queued.insert(row.id)),
            (JobState::Running, _) => self.running += 1,
            (state, Some(finish)) => {
                self.ended.insert((finish.at, row.id));
                if state != JobState::Expired {
                    self.with_files.insert((finish.at, row.id));
                    self.by_input.entry(row.input.sha256).or_default().insert(row.id);
                }
            }
            (_, None) => {}
        }
        for blob in row.blobs() {
            *self.names.entry(blob.key.clone()).or_default() += 1;
        }
        self.by_id.insert(row.id, row);
    }

    /// Takes a row out of every order; the counterpart of [`add`](Self::add).
    fn take(&mut self, id: JobId) -> Result<JobRow, StoreError> {
        let row = self.by_id.remove(&id).ok_or(StoreError::NotFound)?;
        match row.state {
            JobState::Queued => drop(self.queued.remove(&id)),
            JobState::Running => self.running -= 1,
            _ => {}
        }
        if let Some(finish) = &row.finish {
            self.ended.remove(&(finish.at, id));
            self.with_files.remove(&(finish.at, id));
        }
        if let Some(ids) = self.by_input.get_mut(&row.input.sha256) {
            ids.remove(&id);
            if ids.is_empty() {
                self.by_input.remove(&row.input.sha256);
            }
        }
        for blob in row.blobs() {
            if let Some(names) = self.names.get_mut(&blob.key) {
                *names -= 1;
            }
        }
        Ok(row)
    }

    fn end(&mut self, id: JobId, finish: Finish) -> Result<(), StoreError> {
        let mut row = self.take(id)?;
        row.state = finish.state;
        row.finish = Some(finish);
        self.add(row);
        Ok(())
    }

    /// The blobs of a row that was taken out which no row names any longer, each once.
    fn orphans_of(&mut self, row: &JobRow) -> Vec<BlobRef> {
        let mut orphans = Vec::new();
        for blob in row.blobs() {
            if self.names.get(&blob.key) == Some(&0) {
                self.names.remove(&blob.key);
                orphans.push(blob.clone());
            }
        }
        orphans
    }
}
