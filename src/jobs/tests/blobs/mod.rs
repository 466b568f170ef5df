//! What every store of files must keep: one list of cases, run against each kind of store.

mod local;
pub(super) mod s3;

use std::fs;
use std::io::{self, Read as _, Write as _};
use std::path::PathBuf;
use std::sync::Arc;

use super::PATIENCE;
use crate::jobs::{BlobStore, StoredBlob};

/// A store to be tried.
pub(super) trait BlobHouse: Sized {
    /// An empty store.
    fn open() -> Self;
    /// The store.
    fn store(&self) -> Arc<dyn BlobStore>;
    /// Closes the store and opens it again, as the next server does.
    fn reopen(self) -> Self;
    /// A path for a file that the store is to take over.
    fn path_of_a_made_file(&self) -> PathBuf;
}

/// Makes the tests of a store out of all cases.
macro_rules! blob_contract {
    ($house:ty: $($case:ident,)+) => { $(
        #[test]
        fn $case() {
            super::$case::<$house>();
        }
    )+ };
    ($house:ty) => {
        blob_contract! { $house:
            a_file_is_there_once_from_its_commit_to_its_removal,
            a_file_that_is_taken_over_moves_and_takes_no_other_s_place,
            a_file_that_is_given_up_leaves_nothing,
            a_file_that_is_not_there_cannot_be_read,
            a_large_file_comes_back_as_it_was,
            files_outlast_the_process,
            every_file_is_listed_with_its_size,
            a_name_can_be_removed_while_its_file_is_read,
            a_store_says_how_much_room_it_has,
        }
    };
}
use blob_contract;

/// Writes a file.
fn write(store: &dyn BlobStore, key: &str, content: &[u8]) -> io::Result<()> {
    let mut writer = store.create(key)?;
    writer.write_all(content)?;
    writer.commit()
}

fn read(store: &dyn BlobStore, key: &str) -> io::Result<Vec<u8>> {
    fs::read(store.local(key)?)
}

/// Names and sizes of all files, in order.
fn listed(store: &dyn BlobStore) -> Vec<(String, u64)> {
    let mut files: Vec<_> =
        store.list().unwrap().into_iter().map(|StoredBlob { key, bytes, .. }| (key, bytes)).collect();
    files.sort();
    files
}

fn a_file_is_there_once_from_its_commit_to_its_removal<H: BlobHouse>() {
    let house = H::open();
    let store = house.store();
    let key = "out/job.1.mesh";
    write(&*store, key, b"hello").unwrap();
    assert_eq!(read(&*store, key).unwrap(), b"hello");
    assert_eq!(listed(&*store), [(key.to_owned(), 5)]);
    let again = write(&*store, key, b"other");
    assert_eq!(again.unwrap_err().kind(), io::ErrorKind::AlreadyExists, "a file is written once");
    assert_eq!(read(&*store, key).unwrap(), b"hello");
    store.remove(key).unwrap();
    assert!(listed(&*store).is_empty());
    assert_eq!(read(&*store, key).unwrap_err().kind(), io::ErrorKind::NotFound);
}

fn a_file_that_is_taken_over_moves_and_takes_no_other_s_place<H: BlobHouse>() {
    let house = H::open();
    let store = house.store();
    let (file, key) = (house.path_of_a_made_file(), "out/job.1.mesh");
    fs::write(&file, b"hello").unwrap();
    store.adopt(&file, key).unwrap();
    assert!(!file.exists());
    assert_eq!(read(&*store, key).unwrap(), b"hello");
    fs::write(&file, b"other").unwrap();
    assert!(store.adopt(&file, key).is_err(), "a file is written once");
    assert_eq!(read(&*store, key).unwrap(), b"hello");
}

fn a_file_that_is_given_up_leaves_nothing<H: BlobHouse>() {
    let house = H::open();
    let store = house.store();
    let mut writer = store.create("in/upload").unwrap();
    writer.write_all(b"hello").unwrap();
    drop(writer);
    assert!(listed(&*store).is_empty());
    assert!(read(&*store, "in/upload").is_err());
    write(&*store, "in/upload", b"again").unwrap();
}

fn a_file_that_is_not_there_cannot_be_read<H: BlobHouse>() {
    let house = H::open();
    assert_eq!(read(&*house.store(), "in/nobody-s").unwrap_err().kind(), io::ErrorKind::NotFound);
}

fn a_large_file_comes_back_as_it_was<H: BlobHouse>() {
    let house = H::open();
    let (key, file) = ("out/job.1.mesh", house.path_of_a_made_file());
    // Two parts and a bit of S3, no two words of it the same.
    let content: Vec<u8> = (0..(33_u32 << 18) + 1).flat_map(u32::to_le_bytes).collect();
    write(&*house.store(), key, &content).unwrap();
    fs::write(&file, &content).unwrap();
    house.store().adopt(&file, "out/job.2.mesh").unwrap();
    assert!(write(&*house.store(), key, &content).is_err(), "a file is written once");
    let house = house.reopen();
    for key in [key, "out/job.2.mesh"] {
        assert!(read(&*house.store(), key).unwrap() == content, "{key}");
    }
}

fn files_outlast_the_process<H: BlobHouse>() {
    let house = H::open();
    write(&*house.store(), "in/upload", b"hello").unwrap();
    write(&*house.store(), "in/removed", b"hello").unwrap();
    house.store().remove("in/removed").unwrap();
    // What goes soon is gone before the store closes.
    let begun = std::time::Instant::now();
    while listed(&*house.store()).len() > 1 {
        assert!(begun.elapsed() < PATIENCE);
    }
    let house = house.reopen();
    assert_eq!(read(&*house.store(), "in/upload").unwrap(), b"hello");
    assert!(read(&*house.store(), "out/upload").is_err());
}

fn every_file_is_listed_with_its_size<H: BlobHouse>() {
    let house = H::open();
    let store = house.store();
    let mut expected = Vec::new();
    for number in 0..40_usize {
        let key = format!("{}/{number:02}.1.report.json", ["in", "out"][number % 2]);
        write(&*store, &key, &vec![b'a'; number]).unwrap();
        expected.push((key, number as u64));
    }
    expected.sort();
    assert_eq!(listed(&*store), expected);
}

fn a_name_can_be_removed_while_its_file_is_read<H: BlobHouse>() {
    let house = H::open();
    let store = house.store();
    write(&*store, "in/upload", b"hello").unwrap();
    let mut file = fs::File::open(store.local("in/upload").unwrap()).unwrap();
    store.remove("in/upload").unwrap();
    let mut content = String::new();
    file.read_to_string(&mut content).unwrap();
    assert_eq!(content, "hello");
}

fn a_store_says_how_much_room_it_has<H: BlobHouse>() {
    assert!(H::open().store().free_bytes() > Some(0));
}
