//! The cases on S3: a server of its own for each test, in this process, with its files in a temporary directory.

use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;

use hyper::server::conn::http1;
use hyper_util::rt::TokioIo;
use s3s::auth::SimpleAuth;
use s3s::service::S3ServiceBuilder;
use tokio_util::sync::{CancellationToken, DropGuard};

use super::{BlobHouse, blob_contract, listed, read, write};
use crate::jobs::{BlobStore, BucketAccess, S3Blobs};

/// A server with one bucket, until it is dropped.
pub(in crate::jobs::tests) struct S3Server {
    address: SocketAddr,
    dir: tempfile::TempDir,
    _running: DropGuard,
}

const BUCKET: &str = "meshes";
const KEY: (&str, &str) = ("an-id", "a secret");

impl S3Server {
    pub(in crate::jobs::tests) fn start() -> Self {
        let dir = tempfile::tempdir().unwrap();
        std::fs::create_dir(dir.path().join(BUCKET)).unwrap();
        let mut service = S3ServiceBuilder::new(s3s_fs::FileSystem::new(dir.path()).unwrap());
        service.set_auth(SimpleAuth::from_single(KEY.0, KEY.1));
        let service = service.build();
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        listener.set_nonblocking(true).unwrap();
        let address = listener.local_addr().unwrap();
        let stop = CancellationToken::new();
        let stopped = stop.clone();
        std::thread::spawn(move || {
            let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
            runtime.block_on(async {
                let listener = tokio::net::TcpListener::from_std(listener).unwrap();
                loop {
                    let stream = tokio::select! {
                        () = stopped.cancelled() => return,
                        accepted = listener.accept() => accepted.unwrap().0,
                    };
                    let service = service.clone();
                    tokio::spawn(async move {
                        // A client that goes away is none of this server's business.
                        drop(http1::Builder::new().serve_connection(TokioIo::new(stream), service).await);
                    });
                }
            });
        });
        Self { address, dir, _running: stop.drop_guard() }
    }

    pub(in crate::jobs::tests) fn access(&self) -> BucketAccess {
        BucketAccess {
            url: format!("s3://{BUCKET}/a-shop"),
            endpoint: Some(format!("http://{}", self.address)),
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
    assert!(listed(&*house.store).is_empty());
}
