//! The cases on SQLite.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};

use super::{StoreHouse, cases, contract};
use crate::jobs::{JobStore, SqliteStore, StoreClock};

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
    fn open() -> Self {
        let dir = Arc::new(tempfile::tempdir().unwrap());
        // Any time will do; this one is in 2027.
        Self::at(dir, Arc::new(AtomicI64::new(1_800_000_000_000)))
    }

    fn store(&self) -> Arc<dyn JobStore> {
        Arc::clone(&self.store) as Arc<dyn JobStore>
    }

    fn advance_ms(&self, by: i64) {
        self.clock.fetch_add(by, Ordering::SeqCst);
    }

    fn reopen(self) -> Self {
        let Self { store, clock, path, _dir } = self;
        drop(store);
        assert!(path.exists());
        Self::at(_dir, clock)
    }
}

contract!(SqliteHouse);
