//! A mesh on its way in: streamed to disk, counted and hashed, in constant memory.

use std::fs::File;
use std::io::{self, Write};
use std::sync::Arc;

use sha2::{Digest, Sha256};

use super::service::Service;
use super::spool::{Space, Spool};
use super::store::BlobRef;
use crate::wire::{Problem, ProblemCode};

/// Bytes gathered before they are hashed and written, off the threads that serve connections.
const BLOCK_BYTES: usize = 256 << 10;

/// An upload that is coming in. Dropped before [`finish`](Self::finish), it leaves nothing behind.
#[derive(Debug)]
pub struct Upload {
    service: Arc<Service>,
    key: String,
    /// `None` while a block is being written; it stays so when that write is abandoned or fails.
    sink: Option<Sink>,
    block: Vec<u8>,
    bytes: u64,
    /// Reserved room; `None` once it belongs to an [`Uploaded`].
    space: Option<Space>,
}

#[derive(Debug)]
struct Sink {
    file: File,
    digest: Sha256,
}

impl Sink {
    fn write(&mut self, block: &[u8]) -> io::Result<()> {
        self.digest.update(block);
        self.file.write_all(block)
    }
}

impl Upload {
    pub(super) async fn begin(service: Arc<Service>) -> Result<Self, Problem> {
        let space = service.make_room(0).await?;
        let key = Spool::new_key();
        let file = File::create_new(service.spool.path(&key)).map_err(|error| disk_problem(&error))?;
        let sink = Sink { file, digest: Sha256::new() };
        Ok(Self { service, key, sink: Some(sink), block: Vec::new(), bytes: 0, space: Some(space) })
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

    /// Ends the upload.
    ///
    /// # Errors
    /// `storage-full`, `internal` when the disk fails.
    pub async fn finish(mut self) -> Result<Uploaded, Problem> {
        self.flush().await?;
        let sink = self.sink.take().ok_or_else(broken)?;
        let space = self.space.take().ok_or_else(broken)?;
        let blob =
            BlobRef { key: self.key.clone(), bytes: self.bytes, sha256: sink.digest.finalize().into() };
        space.hand_over(&blob);
        Ok(Uploaded { spool: Arc::clone(&self.service.spool), blob: Some(blob) })
    }

    async fn flush(&mut self) -> Result<(), Problem> {
        if self.block.is_empty() {
            return Ok(());
        }
        let room = self.service.make_room(self.block.len() as u64).await?;
        let (Some(mut sink), Some(space)) = (self.sink.take(), &mut self.space) else { return Err(broken()) };
        space.absorb(room);
        let mut block = std::mem::take(&mut self.block);
        let written = tokio::task::spawn_blocking(move || {
            sink.write(&block)?;
            block.clear();
            io::Result::Ok((sink, block))
        });
        let (sink, block) = written.await.map_err(|_| broken())?.map_err(|error| disk_problem(&error))?;
        self.sink = Some(sink);
        self.block = block;
        Ok(())
    }
}

impl Drop for Upload {
    fn drop(&mut self) {
        if self.space.is_some() {
            // Nobody hears of an unfinished upload; a file that stays goes at the next start.
            let _ = std::fs::remove_file(self.service.spool.path(&self.key));
        }
    }
}

/// A complete upload, to be handed to [`Jobs::submit`](super::Jobs::submit). Dropped instead, it leaves nothing behind.
#[derive(Debug)]
pub struct Uploaded {
    spool: Arc<Spool>,
    blob: Option<BlobRef>,
}

impl Uploaded {
    /// The file, which is no longer removed on drop.
    pub(super) fn keep(mut self) -> Option<BlobRef> {
        self.blob.take()
    }

    pub(super) fn blob(&self) -> Option<&BlobRef> {
        self.blob.as_ref()
    }
}

impl Drop for Uploaded {
    fn drop(&mut self) {
        if let Some(blob) = &self.blob {
            self.spool.remove(blob);
        }
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
