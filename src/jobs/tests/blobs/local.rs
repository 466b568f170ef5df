//! The cases on the files of one machine.

use std::path::PathBuf;
use std::sync::Arc;

use super::{BlobHouse, blob_contract};
use crate::jobs::{BlobStore, LocalBlobs};

struct LocalHouse {
    store: Arc<LocalBlobs>,
    dir: tempfile::TempDir,
}

impl LocalHouse {
    fn at(dir: tempfile::TempDir) -> Self {
        Self { store: Arc::new(LocalBlobs::open(&dir.path().join("spool")).unwrap()), dir }
    }
}

impl BlobHouse for LocalHouse {
    fn open() -> Self {
        Self::at(tempfile::tempdir().unwrap())
    }

    fn store(&self) -> Arc<dyn BlobStore> {
        Arc::clone(&self.store) as Arc<dyn BlobStore>
    }

    fn reopen(self) -> Self {
        Self::at(self.dir)
    }

    fn path_of_a_made_file(&self) -> PathBuf {
        self.dir.path().join("made")
    }
}

blob_contract!(LocalHouse);

#[test]
fn a_listing_shows_what_is_not_committed() {
    let house = LocalHouse::open();
    let writer = house.store.create("in/upload").unwrap();
    assert_eq!(super::listed(&*house.store).len(), 1, "so that what a crash leaves is found");
    drop(writer);
}
