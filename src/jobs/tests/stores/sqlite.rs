//! The cases on SQLite.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};
use std::time::Duration;

use super::super::PATIENCE;
use super::{StoreHouse, cases, contract};
use crate::jobs::{JobStore, ListQuery, SqliteStore, StoreClock};

struct SqliteHouse {
    store: Arc<SqliteStore>,
    clock: Arc<AtomicI64>,
    path: PathBuf,
    _dir: Arc<tempfile::TempDir>,
}

impl SqliteHouse {
    fn at(dir: Arc<tempfile::TempDir>, clock: Arc<AtomicI64>) -> Self {
        let path = dir.path().join("jobs.sqlite3");
        let time = Arc::clone(&clock);
        let now: StoreClock = Arc::new(move || time.load(Ordering::SeqCst));
        let store = Arc::new(SqliteStore::open_with(&path, now).unwrap());
        Self { store, clock, path, _dir: dir }
    }
}

impl StoreHouse for SqliteHouse {
    async fn open() -> Self {
        let dir = Arc::new(tempfile::tempdir().unwrap());
        // Any time will do; this one is in 2027.
        Self::at(dir, Arc::new(AtomicI64::new(1_800_000_000_000)))
    }

    fn store(&self) -> Arc<dyn JobStore> {
        Arc::clone(&self.store) as Arc<dyn JobStore>
    }

    async fn advance_ms(&self, by: i64) {
        self.clock.fetch_add(by, Ordering::SeqCst);
    }

    async fn reopen(self) -> Self {
        let Self { store, clock, path, _dir } = self;
        drop(store);
        assert!(path.exists());
        Self::at(_dir, clock)
    }
}

contract!(SqliteHouse);

#[tokio::test]
async fn a_file_that_another_process_holds_is_written_again_once_it_is_free() {
    use super::{admit, job};
    use crate::jobs::StoreError;
    let house = SqliteHouse::open().await;
    let other = rusqlite::Connection::open(&house.path).unwrap();
    other.execute_batch("BEGIN IMMEDIATE").unwrap();
    let refused = house.store.create(job(), 10).await.unwrap_err();
    assert!(matches!(refused, StoreError::Unavailable(_)), "{refused}");
    assert_eq!(house.store.counts().await.unwrap().all, 0, "it can be read all the while");
    other.execute_batch("ROLLBACK").unwrap();
    admit(&*house.store, job()).await;
}

#[tokio::test]
async fn a_row_that_cannot_be_read_fails_and_does_not_stand_in_the_way() {
    use super::{admit, claim, job};
    use crate::wire::JobState;
    let house = SqliteHouse::open().await;
    let (strange, next) = (admit(&*house.store, job()).await.id, admit(&*house.store, job()).await.id);
    let other = rusqlite::Connection::open(&house.path).unwrap();
    let options = r#"{"an option of another version":1}"#;
    other.execute("UPDATE jobs SET options = ?1 WHERE id = ?2", [options, &strange.to_string()]).unwrap();
    assert_eq!(claim(&*house.store).await.unwrap().id, next);
    let changes = house.store.changes(strange, 0).await.unwrap();
    assert_eq!(changes.last().unwrap().state, JobState::Failed);
    let query = ListQuery { limit: 10, ..Default::default() };
    assert_eq!(house.store.list(query).await.unwrap().len(), 1);
    house.store.delete(strange).await.unwrap();
}

#[tokio::test]
async fn a_store_that_is_closed_leaves_one_file_also_while_it_is_read() {
    let dir = tempfile::tempdir().unwrap();
    let (path, log) = (dir.path().join("jobs.sqlite3"), dir.path().join("jobs.sqlite3-wal"));
    for _ in 0..200 {
        let store = Arc::new(SqliteStore::open(&path).unwrap());
        store.counts().await.unwrap();
        let reading = Arc::clone(&store);
        let reading = tokio::spawn(async move { drop(reading.list(ListQuery::default()).await) });
        tokio::task::yield_now().await;
        // The call ends; what it asked of another thread goes on.
        reading.abort();
        let _ = reading.await;
        drop(store);
        let is_gone = async {
            while log.exists() {
                tokio::time::sleep(Duration::from_millis(1)).await;
            }
        };
        tokio::time::timeout(PATIENCE, is_gone).await.expect("the log stays beside the store");
    }
}
