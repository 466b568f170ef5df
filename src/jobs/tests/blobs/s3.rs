//! The cases on S3: a server of its own for each test, in this process, with its files in a temporary directory.

use std::path::PathBuf;
use std::sync::Arc;

use super::{BlobHouse, blob_contract, listed, read, write};
use crate::jobs::{BlobStore, BucketAccess, S3Blobs};
use server::{BUCKET, KEY};

#[path = "../../../../tests/support/s3_server.rs"]
mod server;

/// A server with one bucket, until it is dropped.
pub(in crate::jobs::tests) struct S3Server {
    running: server::S3Server,
    dir: tempfile::TempDir,
}

impl S3Server {
    pub(in crate::jobs::tests) fn start() -> Self {
        let dir = tempfile::tempdir().unwrap();
        Self { running: server::S3Server::start(dir.path(), 0), dir }
    }

    pub(in crate::jobs::tests) fn access(&self) -> BucketAccess {
        BucketAccess {
            url: format!("s3://{BUCKET}/a-shop"),
            endpoint: Some(format!("http://{}", self.running.address)),
            public_endpoint: None,
            region: "us-east-1".to_owned(),
            key: Some((KEY.0.to_owned(), KEY.1.to_owned())),
            cache_bytes_max: 1 << 30,
        }
    }
}

struct S3House {
    store: Arc<S3Blobs>,
    server: S3Server,
    copies: tempfile::TempDir,
}

impl S3House {
    fn at(server: S3Server) -> Self {
        let copies = tempfile::tempdir().unwrap();
        let store = S3Blobs::open(&server.access(), &copies.path().join("copies")).unwrap();
        Self { store: Arc::new(store), server, copies }
    }

    /// The same bucket as another server sees it.
    fn other(&self) -> S3Blobs {
        S3Blobs::open(&self.server.access(), &self.copies.path().join("others")).unwrap()
    }
}

impl BlobHouse for S3House {
    fn open() -> Self {
        Self::at(S3Server::start())
    }

    fn store(&self) -> Arc<dyn BlobStore> {
        Arc::clone(&self.store) as Arc<dyn BlobStore>
    }

    fn reopen(self) -> Self {
        Self::at(self.server)
    }

    fn path_of_a_made_file(&self) -> PathBuf {
        self.copies.path().join("made")
    }
}

blob_contract!(S3House);

#[test]
fn a_file_is_read_and_removed_by_servers_that_did_not_write_it() {
    let house = S3House::open();
    let other = house.other();
    write(&*house.store, "in/upload", b"hello").unwrap();
    assert_eq!(read(&other, "in/upload").unwrap(), b"hello");
    let all = other.list().unwrap();
    assert!(all.len() == 1 && all[0].is_recent, "its writer may be about to name it");
    other.remove("in/upload").unwrap();
    while !listed(&*house.store).is_empty() {
        std::thread::yield_now();
    }
    let third = S3Blobs::open(&house.server.access(), &house.copies.path().join("third")).unwrap();
    assert_eq!(read(&third, "in/upload").unwrap_err().kind(), std::io::ErrorKind::NotFound);
}

#[test]
fn what_stands_beside_the_folder_is_not_touched() {
    let house = S3House::open();
    let access = BucketAccess { url: format!("s3://{BUCKET}/a-shop/inner"), ..house.server.access() };
    let inner = S3Blobs::open(&access, &house.copies.path().join("inner")).unwrap();
    write(&inner, "in/upload", b"hello").unwrap();
    assert!(listed(&*house.store).is_empty());
    house.store.set_mark("one").unwrap();
    assert_eq!(inner.mark().unwrap(), None);
    assert!(house.server.dir.path().join(BUCKET).join("a-shop/inner/in/upload").exists());
}

#[test]
fn the_first_mark_stays() {
    let house = S3House::open();
    assert_eq!(house.store.mark().unwrap(), None);
    assert_eq!(house.store.set_mark("one").unwrap(), "one");
    assert_eq!(house.other().set_mark("two").unwrap(), "one");
    assert_eq!(house.store.mark().unwrap().as_deref(), Some("one"));
    assert!(listed(&*house.store).is_empty(), "it is none of the files");
}

#[test]
fn a_wrong_key_is_refused_and_said() {
    let house = S3House::open();
    let access =
        BucketAccess { key: Some(("an-id".to_owned(), "wrong".to_owned())), ..house.server.access() };
    let refused = S3Blobs::open(&access, &house.copies.path().join("others")).unwrap();
    let error = write(&refused, "in/upload", b"hello").unwrap_err();
    assert!(!error.to_string().contains("wrong"), "{error}");
    assert_eq!(error.kind(), std::io::ErrorKind::HostUnreachable, "callers are to come again");
    assert!(listed(&*house.store).is_empty());
}
