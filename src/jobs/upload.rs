//! A mesh on its way in: streamed to disk, counted and hashed, in constant memory.

use std::io::{self, Write as _};
use std::sync::Arc;

use sha2::{Digest, Sha256};

use super::blobs::BlobWriter;
use super::retention::on_disk;
use super::service::Service;
use super::spool::{Space, Unnamed, Written};
use super::store::BlobRef;
use crate::wire::{Problem, ProblemCode};

/// Bytes gathered before they are hashed and written, off the threads that serve connections.
const BLOCK_BYTES: usize = 256 << 10;

/// An upload that is coming in. Dropped before [`finish`](Self::finish), it leaves nothing behind.
pub struct Upload {
    service: Arc<Service>,
    /// `None` while a block is being written; it stays so when that write is abandoned or fails.
    sink: Option<Sink>,
    block: Vec<u8>,
    bytes: u64,
    space: Space,
    unnamed: Unnamed,
}

impl std::fmt::Debug for Upload {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Upload")
            .field("key", &self.unnamed.key)
            .field("bytes", &self.bytes)
            .finish_non_exhaustive()
    }
}

struct Sink {
    writer: Box<dyn BlobWriter>,
    digest: Sha256,
}

impl Sink {
    fn write(&mut self, block: &[u8]) -> io::Result<()> {
        self.digest.update(block);
        self.writer.write_all(block)
    }

    fn commit(self) -> io::Result<[u8; 32]> {
        self.writer.commit()?;
        Ok(self.digest.finalize().into())
    }
}

impl Upload {
    pub(super) async fn begin(service: Arc<Service>) -> Result<Self, Problem> {
        let space = service.make_room(0).await?;
        let spool = Arc::clone(&service.spool);
        let (unnamed, writer) = on_disk(move || spool.begin()).await?;
        let sink = Sink { writer, digest: Sha256::new() };
        Ok(Self { service, sink: Some(sink), block: Vec::new(), bytes: 0, space, unnamed })
    }

    /// Takes the next bytes.
    ///
    /// # Errors
    /// `body-too-large`, `storage-full`, `internal` when the disk fails. The upload cannot go on after that.
    pub async fn write(&mut self, mut bytes: &[u8]) -> Result<(), Problem> {
        self.bytes += bytes.len() as u64;
        self.service.check_upload_size(self.bytes)?;
        while !bytes.is_empty() {
            let (now, later) = bytes.split_at(bytes.len().min(BLOCK_BYTES - self.block.len()));
            self.block.extend_from_slice(now);
            bytes = later;
            if self.block.len() == BLOCK_BYTES {
                self.flush().await?;
            }
        }
        Ok(())
    }

    /// Number of bytes so far.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Ends the upload; it is on the disk then.
    ///
    /// # Errors
    /// `storage-full`, `internal` when the disk fails.
    pub async fn finish(mut self) -> Result<Uploaded, Problem> {
        self.flush().await?;
        let Self { sink, bytes, space, unnamed, .. } = self;
        let sink = sink.ok_or_else(broken)?;
        let sha256 = on_disk(move || sink.commit()).await?;
        let blob = BlobRef { key: unnamed.key.clone(), bytes, sha256 };
        Ok(Uploaded(Written::upload(unnamed, blob, space)))
    }

    async fn flush(&mut self) -> Result<(), Problem> {
        if self.block.is_empty() {
            return Ok(());
        }
        let room = self.service.make_room(self.block.len() as u64).await?;
        let Some(mut sink) = self.sink.take() else { return Err(broken()) };
        self.space.absorb(room);
        let mut block = std::mem::take(&mut self.block);
        let (sink, block) = on_disk(move || {
            sink.write(&block)?;
            block.clear();
            Ok((sink, block))
        })
        .await?;
        self.sink = Some(sink);
        self.block = block;
        Ok(())
    }
}

/// A complete upload, to be handed to [`Jobs::submit`](super::Jobs::submit). Dropped instead, it leaves nothing behind.
#[derive(Debug)]
pub struct Uploaded(Written);

impl Uploaded {
    /// A row names the file now.
    pub(super) fn named(self) {
        self.0.named();
    }

    pub(super) fn blob(&self) -> Option<&BlobRef> {
        self.0.blob()
    }
}

fn broken() -> Problem {
    Problem::new(ProblemCode::Internal, "the upload was broken off")
}

/// A failure of the disk, told to the caller without paths and to the log with them.
pub(super) fn disk_problem(error: &io::Error) -> Problem {
    tracing::error!(%error, "the data directory failed");
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            Problem::new(ProblemCode::StorageFull, "the disk is full")
        }
        _ => Problem::new(ProblemCode::Internal, "the data directory failed"),
    }
}
