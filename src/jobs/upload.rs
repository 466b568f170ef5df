//! A mesh on its way in: streamed to disk, counted and hashed, in constant memory.

use std::io::{self, Write as _};
use std::sync::Arc;

use sha2::{Digest, Sha256};

use tokio::task::JoinHandle;

use super::arrivals::QueuePlace;
use super::blobs::{BlobWriter, MESHES};
use super::disk::{joined, on_disk};
use super::meters;
use super::service::Service;
use super::shares::IncomingBytes;
use super::spool::{ReservedSpace, Spool, Unnamed, Written};
use super::store::{BlobRef, Tenant, UploadId};
use crate::wire::Problem;

/// Bytes gathered before they are hashed and written, off the threads that serve connections and while more come in.
const BLOCK_BYTES: usize = 256 << 10;

/// An upload that is coming in. Dropped before [`finish`](Self::finish), it leaves nothing behind.
pub struct Upload {
    service: Arc<Service>,
    sink: Sink,
    block: Vec<u8>,
    bytes: u64,
    /// Sizes of the files that have ended.
    files: Vec<u64>,
    space: ReservedSpace,
    /// Where its file is put.
    folder: &'static str,
    /// It becomes a job, and has no place in the queue yet.
    needs_place: bool,
    place: Option<QueuePlace>,
    incoming: IncomingBytes,
}

impl std::fmt::Debug for Upload {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Upload").field("bytes", &self.bytes).finish_non_exhaustive()
    }
}

/// What the bytes are for.
#[derive(Debug, Clone, Copy)]
pub(super) struct UploadPurpose {
    /// Where the file is put.
    pub(super) folder: &'static str,
    /// It becomes a job, which needs a place in the queue.
    pub(super) needs_place: bool,
    /// Bytes of the tenant that go when these have come.
    pub(super) instead_of: u64,
}

impl UploadPurpose {
    /// The mesh of a job, or what comes beside it and needs no place of its own.
    pub(super) fn of_mesh(needs_place: bool) -> Self {
        Self { folder: MESHES, needs_place, instead_of: 0 }
    }
}

/// Where the bytes go.
enum Sink {
    /// Nothing has been written yet.
    Fresh,
    Open(Box<OpenSink>),
    /// A block is being written; what comes of it is the file, and the block empty again.
    Busy(JoinHandle<io::Result<(Box<OpenSink>, Vec<u8>)>>),
    /// A write was abandoned or has failed.
    Lost,
}

struct OpenSink {
    unnamed: Unnamed,
    writer: Box<dyn BlobWriter>,
    digest: Sha256,
}

impl Sink {
    /// The open file, begun when there is none. Blocks.
    fn open(self, spool: &Arc<Spool>, folder: &'static str) -> io::Result<Box<OpenSink>> {
        match self {
            Self::Fresh => {
                let (unnamed, writer) = spool.begin(folder)?;
                Ok(Box::new(OpenSink { unnamed, writer, digest: Sha256::new() }))
            }
            Self::Open(sink) => Ok(sink),
            Self::Busy(_) | Self::Lost => Err(io::ErrorKind::BrokenPipe.into()),
        }
    }
}

impl OpenSink {
    fn write(&mut self, block: &[u8]) -> io::Result<()> {
        self.digest.update(block);
        self.writer.write_all(block)
    }
}

impl Upload {
    pub(super) async fn begin(
        service: Arc<Service>,
        tenant: Tenant,
        purpose: UploadPurpose,
    ) -> Result<Self, Problem> {
        let space = service.make_room(&tenant, 0).await?;
        let UploadPurpose { folder, needs_place, instead_of } = purpose;
        Ok(Self {
            incoming: IncomingBytes::none(Arc::clone(&service.incoming), tenant, instead_of),
            folder,
            service,
            sink: Sink::Fresh,
            block: Vec::new(),
            bytes: 0,
            files: Vec::new(),
            space,
            needs_place,
            place: None,
        })
    }

    /// Takes the next bytes.
    ///
    /// # Errors
    /// `body-too-large`, `queue-full`, `storage-full`, `internal` when the disk fails. The upload cannot go on after that.
    pub async fn write(&mut self, mut bytes: &[u8]) -> Result<(), Problem> {
        self.bytes += bytes.len() as u64;
        self.service.settings.check_upload_size(self.bytes)?;
        while !bytes.is_empty() {
            let (now, later) = bytes.split_at(bytes.len().min(BLOCK_BYTES - self.block.len()));
            self.block.extend_from_slice(now);
            bytes = later;
            if self.block.len() == BLOCK_BYTES {
                let (sink, spare) = self.next_sink().await?;
                let mut block = std::mem::replace(&mut self.block, spare);
                let (spool, folder) = (Arc::clone(&self.service.spool), self.folder);
                self.sink = Sink::Busy(tokio::task::spawn_blocking(move || {
                    let mut sink = sink.open(&spool, folder)?;
                    sink.write(&block)?;
                    block.clear();
                    Ok((sink, block))
                }));
            }
        }
        Ok(())
    }

    /// Number of bytes so far.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Ends a file of several that come one behind the other. It is the last one, unless more bytes or ends follow.
    pub fn end_file(&mut self) {
        self.files.push(self.bytes - self.files.iter().sum::<u64>());
    }

    /// Ends the upload. What fits into one block is not on the disk until a job is made of it: an answer that is known needs
    /// no file.
    ///
    /// # Errors
    /// `queue-full`, `storage-full`, `internal` when the disk fails.
    pub async fn finish(mut self) -> Result<Uploaded, Problem> {
        let (sink, _) = self.next_sink().await?;
        let block = std::mem::take(&mut self.block);
        let files = if self.files.len() > 1 { self.files } else { Vec::new() };
        let blob_of = |unnamed: &Unnamed, sha256| BlobRef {
            key: unnamed.key.clone(),
            bytes: self.bytes,
            sha256,
            files,
        };
        let content = if let Sink::Fresh = sink {
            let unnamed = self.service.spool.new_name(self.folder);
            let blob = blob_of(&unnamed, Sha256::digest(&block).into());
            let spool = Arc::clone(&self.service.spool);
            UploadContent::InMemory(Box::new(SmallUpload { spool, unnamed, blob, block, space: self.space }))
        } else {
            let (spool, folder) = (Arc::clone(&self.service.spool), self.folder);
            let written = on_disk(move || {
                let mut sink = sink.open(&spool, folder)?;
                sink.write(&block)?;
                let OpenSink { unnamed, writer, digest } = *sink;
                writer.commit()?;
                Ok((unnamed, digest.finalize().into()))
            });
            let (unnamed, sha256) = written.await?;
            let blob = blob_of(&unnamed, sha256);
            UploadContent::Stored(Written::upload(unnamed, blob, self.space))
        };
        Ok(Uploaded { content, taken: None, place: self.place, incoming: Some(self.incoming) })
    }

    /// Where the block is to be written now, for which there is room, and an empty block.
    async fn next_sink(&mut self) -> Result<(Sink, Vec<u8>), Problem> {
        if self.needs_place {
            let place = self.service.arrivals.take_place(self.incoming.tenant()).await;
            let place = place.map_err(|error| self.service.not_admitted(&error));
            self.place = Some(place.inspect_err(meters::refused)?);
            self.needs_place = false;
        }
        self.incoming.grow(self.block.len() as u64).await.inspect_err(meters::refused)?;
        let room = self.service.make_room(self.incoming.tenant(), self.block.len() as u64).await?;
        self.space.absorb(room);
        match std::mem::replace(&mut self.sink, Sink::Lost) {
            Sink::Busy(writing) => {
                let (sink, spare) = joined(writing).await?;
                Ok((Sink::Open(sink), spare))
            }
            sink => Ok((sink, Vec::new())),
        }
    }
}

/// A complete upload, to be handed to [`Jobs::submit`](super::Jobs::submit). Dropped instead, it leaves nothing behind.
#[derive(Debug)]
pub struct Uploaded {
    content: UploadContent,
    /// The upload that it was made of, which goes when it is a job's.
    taken: Option<ClaimedUpload>,
    /// Given up when this is dropped, as are its bytes among those that come in.
    place: Option<QueuePlace>,
    incoming: Option<IncomingBytes>,
}

/// Where the bytes of a complete upload are.
#[derive(Debug)]
enum UploadContent {
    InMemory(Box<SmallUpload>),
    Stored(Written),
}

/// An upload of one block, and what its file will be.
#[derive(Debug)]
struct SmallUpload {
    spool: Arc<Spool>,
    unnamed: Unnamed,
    blob: BlobRef,
    block: Vec<u8>,
    space: ReservedSpace,
}

impl SmallUpload {
    /// Writes the file. Blocks.
    fn write(self) -> io::Result<Written> {
        let mut writer = self.spool.create(&self.unnamed)?;
        writer.write_all(&self.block)?;
        writer.commit()?;
        Ok(Written::upload(self.unnamed, self.blob, self.space))
    }
}

/// A complete upload that outlasts a loss of power. Dropped before a row names it, it leaves nothing behind.
#[derive(Debug)]
pub(super) struct StoredUpload {
    written: Written,
    taken: Option<ClaimedUpload>,
    _place: Option<QueuePlace>,
    _incoming: Option<IncomingBytes>,
}

/// An upload whose bytes become a job's.
#[derive(Debug)]
pub(super) struct ClaimedUpload {
    pub(super) id: UploadId,
    /// Its files, which nobody names once a job has taken it.
    pub(super) pieces: Vec<BlobRef>,
    pub(super) spool: Arc<Spool>,
}

impl ClaimedUpload {
    /// Removes its files, which may be many, off the threads that serve connections. What a process that ends before leaves goes as
    /// orphans.
    fn remove(self) {
        tokio::task::spawn_blocking(move || self.spool.remove_all(&self.pieces));
    }
}

impl Uploaded {
    /// A file that came into the bucket without this service.
    pub(super) fn of_bucket(written: Written) -> Self {
        Self { content: UploadContent::Stored(written), taken: None, place: None, incoming: None }
    }

    /// The same, made of the pieces of an upload.
    pub(super) fn made_of(self, taken: ClaimedUpload) -> Self {
        Self { taken: Some(taken), ..self }
    }

    /// The upload that it was made of.
    pub(super) fn taken(&self) -> Option<UploadId> {
        self.taken.as_ref().map(|taken| taken.id)
    }

    /// The same on the disk, where a row may name it.
    ///
    /// # Errors
    /// `storage-full`, `internal` when the disk fails.
    pub(super) async fn stored(self) -> Result<StoredUpload, Problem> {
        let Self { content, taken, place, incoming } = self;
        let written = match content {
            UploadContent::InMemory(small) => on_disk(move || small.write()).await?,
            UploadContent::Stored(written) => written,
        };
        Ok(StoredUpload { written, taken, _place: place, _incoming: incoming })
    }

    /// A row was made that has taken the upload and names another file with the same bytes.
    pub(super) fn not_needed(self) {
        self.taken.into_iter().for_each(ClaimedUpload::remove);
    }

    /// Its file, or what that will be.
    pub(super) fn blob(&self) -> Option<&BlobRef> {
        match &self.content {
            UploadContent::InMemory(small) => Some(&small.blob),
            UploadContent::Stored(written) => written.blob(),
        }
    }
}

impl StoredUpload {
    /// A row names the file now.
    pub(super) fn named(self) {
        self.written.named();
        self.taken.into_iter().for_each(ClaimedUpload::remove);
    }

    /// A row may name the file now, and have taken the upload: what it was made of stays as well.
    pub(super) fn maybe_named(self) {
        self.written.named();
    }

    /// Its file.
    pub(super) fn blob(&self) -> Option<&BlobRef> {
        self.written.blob()
    }
}
