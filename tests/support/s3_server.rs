//! An S3 server in this process, with its files in a directory and one bucket.

use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::Path;

use hyper::server::conn::http1;
use hyper_util::rt::TokioIo;
use s3s::auth::SimpleAuth;
use s3s::service::S3ServiceBuilder;
use tokio_util::sync::{CancellationToken, DropGuard};

/// Its bucket.
pub(crate) const BUCKET: &str = "meshes";
/// Id and secret of the key to it.
pub(crate) const KEY: (&str, &str) = ("an-id", "a secret");

/// A server, until it is dropped.
pub(crate) struct S3Server {
    pub(crate) address: SocketAddr,
    _running: DropGuard,
}

impl S3Server {
    /// Starts one on a port of loopback; 0: on a free one.
    pub(crate) fn start(dir: &Path, port: u16) -> Self {
        std::fs::create_dir_all(dir.join(BUCKET)).unwrap();
        let mut service = S3ServiceBuilder::new(s3s_fs::FileSystem::new(dir).unwrap());
        service.set_auth(SimpleAuth::from_single(KEY.0, KEY.1));
        let service = service.build();
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).unwrap();
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
        Self { address, _running: stop.drop_guard() }
    }
}
