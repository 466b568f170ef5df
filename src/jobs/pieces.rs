//! Uploads that come before their job, in pieces and over as many requests as it takes.
//!
//! What comes is stored piece by piece. A piece counts once its file is complete and the row of the upload names it, so an
//! upload goes on where it stands, at any server, whatever became of the request or the server before. A job that names the
//! upload gets its pieces as one file, and they go.

use std::io::Read as _;
use std::sync::Arc;
use std::time::Duration;

use jiff::Timestamp;
use tokio::time::Instant;

use super::blobs::PIECES;
use super::disk::on_disk;
use super::handle::Jobs;
use super::meters;
use super::problems::{disk_problem, store_problem, upload_gone};
use super::service::Service;
use super::soundness::Unsound;
use super::store::{BlobRef, JobId, NewUpload, StoreError, Tenant, UploadId, UploadRow};
use super::upload::{ClaimedUpload, StoredUpload, Upload, UploadPurpose, Uploaded};
use crate::wire::{Problem, ProblemCode};

/// Most pieces of one upload.
pub const UPLOAD_PIECES_MAX: usize = 10_000;
/// Largest piece: what a server that is killed may lose of what has come, where it comes quickly.
const PIECE_BYTES_MAX: u64 = 8 << 20;
/// Time after which a piece ends however small it is: the same where it comes slowly.
const PIECE_PATIENCE: Duration = Duration::from_secs(10);
/// Bytes of a piece that are copied at a time.
const COPIED_BYTES: usize = 256 << 10;

/// An upload that is asked for.
#[derive(Debug, Clone)]
pub struct AskedUpload {
    /// Who asks, by the name of the key.
    pub owner: Option<String>,
    /// Whom it is charged to.
    pub tenant: Tenant,
    /// Name of the file, if the caller gives one.
    pub file_name: Option<String>,
    /// What the caller writes beside it, as it came.
    pub metadata: Option<String>,
    /// Bytes that it is to have.
    pub length: u64,
}

/// What there is of an upload that a request for a job names.
#[derive(Debug)]
pub enum NamedUpload {
    /// Its mesh, and the name of the file if the caller gave one.
    Mesh(Box<Uploaded>, Option<String>),
    /// An earlier job has taken it.
    TakenBy(JobId),
}

/// There is no such upload.
fn no_such_upload() -> Problem {
    Problem::new(ProblemCode::NotFound, "there is no such upload, or its time is over")
}

pub(super) fn unfinished(detail: String) -> Problem {
    Problem::new(ProblemCode::UploadUnfinished, detail)
}

/// A store's failure about an upload.
pub(super) fn upload_problem(error: &StoreError) -> Problem {
    if *error == StoreError::NotFound { no_such_upload() } else { store_problem(error) }
}

impl Jobs {
    /// Makes an upload whose bytes are to come in pieces.
    ///
    /// # Errors
    /// `body-too-large`, `storage-full`, `draining`, `store-unavailable`.
    pub async fn create_upload(&self, asked: AskedUpload) -> Result<UploadRow, Problem> {
        self.0.make_upload(asked, UploadId::unique(), None).await.inspect_err(meters::refused)
    }

    /// The upload as it stands, if it is this owner's.
    ///
    /// # Errors
    /// `not-found`, `store-unavailable`.
    pub async fn get_upload(&self, id: UploadId, owner: Option<&str>) -> Result<UploadRow, Problem> {
        let row = self.0.upload_of(id, owner).await?;
        if row.is_presigned && row.job.is_none() {
            let received = self.0.bytes_in_bucket(&row).await?.unwrap_or_default();
            return Ok(UploadRow { received: received.min(row.length), ..row });
        }
        Ok(row)
    }

    /// Removes the upload. A job that has taken it keeps its bytes.
    ///
    /// # Errors
    /// `not-found`, `store-unavailable`.
    pub async fn delete_upload(&self, id: UploadId, owner: Option<&str>) -> Result<(), Problem> {
        self.0.upload_of(id, owner).await?;
        let orphans = self.0.store.delete_upload(id).await.map_err(|error| upload_problem(&error))?;
        self.0.remove_pieces(orphans).await;
        Ok(())
    }

    /// Begins to receive the bytes of an upload from byte `at` on.
    ///
    /// # Errors
    /// `not-found`, `upload-conflict` (other bytes are the next ones), `body-too-large` (it has all pieces that it may have),
    /// `draining`, `store-unavailable`.
    pub async fn receive_pieces(
        &self,
        id: UploadId,
        owner: Option<&str>,
        at: u64,
    ) -> Result<UploadPieces, Problem> {
        self.0.check_open()?;
        let row = self.0.upload_of(id, owner).await?;
        if row.is_presigned {
            let detail = "this upload goes to the bucket, by the presigned URL that was given for it";
            return Err(Problem::new(ProblemCode::UploadConflict, detail));
        }
        if row.received != at {
            return Err(store_problem(&StoreError::UploadMoved { received: row.received }));
        }
        if row.pieces >= UPLOAD_PIECES_MAX {
            let (limit, detail) =
                (UPLOAD_PIECES_MAX as u64, "the upload came in too many pieces; send larger ones");
            return Err(Problem::new(ProblemCode::BodyTooLarge, detail).with_limit(
                "upload_pieces_max",
                limit,
                None,
            ));
        }
        Ok(UploadPieces {
            service: Arc::clone(&self.0),
            id,
            tenant: row.tenant,
            length: row.length,
            received: row.received,
            expires_at: row.expires_at,
            open: None,
        })
    }

    /// The mesh of an upload that a request for a job names; `is_repeat`: it makes no new job, so no place in the queue is
    /// needed.
    ///
    /// # Errors
    /// `not-found`, `upload-unfinished`, `mesh-empty`, `expired` (bytes of it were lost), `queue-full`, `storage-full`,
    /// `store-unavailable`.
    pub async fn take_upload(
        &self,
        id: &str,
        owner: Option<&str>,
        is_repeat: bool,
    ) -> Result<NamedUpload, Problem> {
        let taking = async {
            let id = id.parse().map_err(|_| no_such_upload())?;
            let row = self.0.upload_of(id, owner).await?;
            self.0.mesh_of(row, !is_repeat).await
        };
        let about_input = |problem: Problem| match problem.code {
            ProblemCode::NotFound | ProblemCode::UploadUnfinished | ProblemCode::Expired => {
                Problem { parameter: Some("input".to_owned()), ..problem }
            }
            _ => problem,
        };
        taking.await.map_err(about_input)
    }
}

impl Service {
    /// Makes the row of an upload; `presigned`: of one that the caller writes to the bucket.
    pub(super) async fn make_upload(
        &self,
        asked: AskedUpload,
        id: UploadId,
        presigned: Option<BlobRef>,
    ) -> Result<UploadRow, Problem> {
        self.check_open()?;
        let AskedUpload { owner, tenant, file_name, metadata, length } = asked;
        self.settings.check_upload_size(length)?;
        // Its pieces and the mesh that a job gets are there at one time.
        let needed = length.saturating_mul(2);
        if needed > self.spool.bytes_max() || (presigned.is_none() && self.spool.is_disk_short_of(needed)) {
            return Err(self.storage_full(needed));
        }
        self.incoming.check(&tenant, 0, 0, length).await?;
        if presigned.is_some() {
            // It comes at any time and past this server: there is to be room for it from now on.
            drop(self.make_room_in_store(&tenant, length).await?);
        }
        let keep_for = self.settings.upload_ttl;
        let new = NewUpload { id, owner, tenant, file_name, metadata, length, keep_for, presigned };
        let made = self.store.create_upload(new, self.settings.uploads_max).await;
        made.map_err(|error| upload_problem(&error))
    }

    /// The row of an upload that is this owner's and whose time is not over.
    pub(super) async fn upload_of(&self, id: UploadId, owner: Option<&str>) -> Result<UploadRow, Problem> {
        let row = self.store.get_upload(id).await.map_err(|error| upload_problem(&error))?;
        if row.owner.as_deref() == owner && !row.is_due { Ok(row) } else { Err(no_such_upload()) }
    }

    /// Removes files of an upload, which may be many.
    pub(super) async fn remove_pieces(&self, pieces: Vec<BlobRef>) {
        let spool = Arc::clone(&self.spool);
        let removed = on_disk(move || {
            spool.remove_all(&pieces);
            Ok(())
        });
        if let Err(problem) = removed.await {
            tracing::warn!(detail = problem.detail, "files of an upload could not be removed");
        }
    }

    async fn mesh_of(self: &Arc<Self>, row: UploadRow, needs_place: bool) -> Result<NamedUpload, Problem> {
        if let Some(job) = row.job {
            return Ok(NamedUpload::TakenBy(job));
        }
        let pieces = self.store.pieces(row.id).await.map_err(|error| upload_problem(&error))?;
        let mesh = if row.is_presigned {
            self.mesh_in_bucket(&row, pieces).await
        } else {
            self.joined_pieces(&row, pieces, needs_place).await
        };
        match mesh {
            Ok(mesh) => Ok(NamedUpload::Mesh(Box::new(mesh), row.file_name)),
            Err(problem) => {
                // Its files may have gone to a job in this moment.
                let now = self.upload_of(row.id, row.owner.as_deref()).await?;
                now.job.map(NamedUpload::TakenBy).ok_or(problem)
            }
        }
    }

    /// The pieces of an upload as one file.
    async fn joined_pieces(
        self: &Arc<Self>,
        row: &UploadRow,
        pieces: Vec<BlobRef>,
        needs_place: bool,
    ) -> Result<Uploaded, Problem> {
        if row.received < row.length {
            let detail = format!("the upload has {} of {} bytes", row.received, row.length);
            return Err(unfinished(detail));
        }
        if row.length == 0 {
            return Err(Problem::new(ProblemCode::MeshEmpty, "the upload has no byte"));
        }
        self.check_open()?;
        let purpose = UploadPurpose { instead_of: row.length, ..UploadPurpose::of_mesh(needs_place) };
        let mut upload = Upload::begin(Arc::clone(self), row.tenant.clone(), purpose).await?;
        for piece in &pieces {
            let mut file = match self.open_sound(piece).await {
                Ok(file) => file,
                Err(Unsound::Disk(error)) => return Err(disk_problem(&error)),
                Err(unsound) => {
                    // Also where another request has taken the upload meanwhile, which its row tells.
                    tracing::warn!(upload = %row.id, "{unsound}: the upload cannot be read");
                    return Err(upload_gone());
                }
            };
            loop {
                let (rest, block) = on_disk(move || {
                    let mut block = vec![0; COPIED_BYTES];
                    let read = file.read(&mut block)?;
                    block.truncate(read);
                    Ok((file, block))
                })
                .await?;
                file = rest;
                if block.is_empty() {
                    break;
                }
                upload.write(&block).await?;
            }
        }
        if upload.bytes() != row.length {
            tracing::error!(upload = %row.id, bytes = upload.bytes(), "the pieces of an upload are not all of it");
            return Err(upload_gone());
        }
        let taken = ClaimedUpload { id: row.id, pieces, spool: Arc::clone(&self.spool) };
        Ok(upload.finish().await?.made_of(taken))
    }
}

/// A piece that a row may name already, also when the store did not say so or this ends before it does: its file stays, and
/// goes as an orphan where no row names it.
struct MaybeNamed(Option<StoredUpload>);

impl Drop for MaybeNamed {
    fn drop(&mut self) {
        self.0.take().into_iter().for_each(StoredUpload::maybe_named);
    }
}

/// Bytes of an upload on their way to it. Dropped before [`keep`](Self::keep), the last piece is lost.
#[derive(Debug)]
pub struct UploadPieces {
    service: Arc<Service>,
    id: UploadId,
    tenant: Tenant,
    length: u64,
    received: u64,
    expires_at: Timestamp,
    /// The piece that comes in, and when it began.
    open: Option<(Upload, Instant)>,
}

impl UploadPieces {
    /// Bytes that are stored, from the first one on.
    pub fn received(&self) -> u64 {
        self.received
    }

    /// Bytes that the upload is to have.
    pub fn length(&self) -> u64 {
        self.length
    }

    /// When the upload goes unless more of it comes.
    pub fn expires_at(&self) -> Timestamp {
        self.expires_at
    }

    /// Takes the next bytes. The first ones of them may be stored when it fails, and the last ones may not be when it does not.
    ///
    /// # Errors
    /// `upload-conflict` (another request was quicker), `not-found` (it was deleted), `storage-full`, `store-unavailable`,
    /// `internal` when the disk fails.
    pub async fn write(&mut self, mut bytes: &[u8]) -> Result<(), Problem> {
        while !bytes.is_empty() {
            if self.open.is_none() {
                let purpose = UploadPurpose { folder: PIECES, ..UploadPurpose::of_mesh(false) };
                let piece = Upload::begin(Arc::clone(&self.service), self.tenant.clone(), purpose).await?;
                self.open = Some((piece, Instant::now()));
            }
            let Some((piece, _)) = &mut self.open else { return Ok(()) };
            let room = usize::try_from(PIECE_BYTES_MAX - piece.bytes()).unwrap_or(usize::MAX);
            let (now, later) = bytes.split_at(bytes.len().min(room));
            let written = piece.write(now).await;
            let is_complete = piece.bytes() == PIECE_BYTES_MAX;
            if written.is_err() {
                // It cannot go on.
                self.open = None;
            }
            written?;
            bytes = later;
            if is_complete {
                self.keep().await?;
            }
        }
        Ok(())
    }

    /// Returns when what has come has waited for more for long enough, and is to be kept as it is.
    pub fn patience(&self) -> impl Future<Output = ()> + use<> {
        let due = self.open.as_ref().map(|(_, begun)| *begun + PIECE_PATIENCE);
        async move {
            match due {
                Some(due) => tokio::time::sleep_until(due).await,
                None => std::future::pending().await,
            }
        }
    }

    /// Stores all that has come; it outlasts this process then.
    ///
    /// # Errors
    /// As [`write`](Self::write).
    pub async fn keep(&mut self) -> Result<(), Problem> {
        let Some((piece, _)) = self.open.take() else { return Ok(()) };
        let piece = piece.finish().await?.stored().await?;
        let Some(blob) = piece.blob().cloned() else { return Ok(()) };
        let (bytes, keep_for) = (blob.bytes, self.service.settings.upload_ttl);
        let (service, id, at) = (Arc::clone(&self.service), self.id, self.received);
        // Who sends may go away, but what is begun is done: a row must not name a file that goes.
        let appending = tokio::spawn(async move {
            let mut piece = MaybeNamed(Some(piece));
            let appended = service.store.append_piece(id, at, blob, keep_for).await;
            if matches!(&appended, Err(error) if !matches!(error, StoreError::Unavailable(_))) {
                drop(piece.0.take());
            }
            appended
        });
        let lost = |error: tokio::task::JoinError| StoreError::Unavailable(error.to_string());
        let appended = appending.await.map_err(lost).and_then(|appended| appended);
        self.expires_at = appended.map_err(|error| upload_problem(&error))?;
        self.received += bytes;
        Ok(())
    }
}
