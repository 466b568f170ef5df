//! Meshes that clients send to the bucket, and fetch from it, without this service in between.

use std::sync::Arc;
use std::time::Duration;

use super::blobs::{MESHES, PIECES, PresignedPut};
use super::disk::on_disk;
use super::handle::Jobs;
use super::meters;
use super::pieces::{AskedUpload, unfinished};
use super::problems::upload_gone;
use super::service::Service;
use super::spool::Written;
use super::store::{BlobRef, JobId, UploadId, UploadRow};
use super::upload::{ClaimedUpload, Uploaded};
use crate::wire::{Problem, ProblemCode};

fn refused(detail: &str) -> Problem {
    Problem::new(ProblemCode::PresignedRefused, detail)
}

impl Jobs {
    /// Makes an upload that the caller writes to the bucket by itself, with exactly these bytes. What it is written by.
    ///
    /// # Errors
    /// `presigned-refused`, `body-too-large`, `storage-full`, `draining`, `store-unavailable`.
    pub async fn presign_upload(
        &self,
        asked: AskedUpload,
        sha256: [u8; 32],
    ) -> Result<(UploadRow, PresignedPut), Problem> {
        let presigning = async {
            let lasts = self.0.presigned_ttl()?;
            let id = UploadId::unique();
            let key = format!("{PIECES}/{}", uuid::Uuid::from(id).simple());
            let blob = BlobRef { key, bytes: asked.length, sha256, files: Vec::new() };
            let (spool, signed) = (Arc::clone(&self.0.spool), blob.clone());
            let put = on_disk(move || match spool.presigned() {
                Some(urls) => urls.put(&signed, lasts),
                None => Err(std::io::ErrorKind::Unsupported.into()),
            })
            .await?;
            Ok((self.0.make_upload(asked, id, Some(blob)).await?, put))
        };
        presigning.await.inspect_err(meters::refused)
    }

    /// A URL of one of the job's meshes in the bucket, by the place of its target, from 0. `disposition` makes a
    /// `Content-Disposition` of the file's name.
    ///
    /// # Errors
    /// `presigned-refused`, and those of [`level`](Self::level).
    pub async fn presign_level(
        &self,
        id: JobId,
        level: usize,
        disposition: fn(&str) -> String,
    ) -> Result<String, Problem> {
        let lasts = self.0.presigned_ttl()?;
        let (blob, name) = self.level_of(id, level).await?;
        let (spool, disposition) = (Arc::clone(&self.0.spool), disposition(&name));
        on_disk(move || match spool.presigned() {
            Some(urls) => urls.get(&blob.key, &disposition, lasts),
            None => Err(std::io::ErrorKind::Unsupported.into()),
        })
        .await
    }
}

impl Service {
    /// For how long URLs are valid.
    fn presigned_ttl(&self) -> Result<Duration, Problem> {
        if self.spool.presigned().is_none() {
            return Err(refused("the server keeps its files on its own disk: there is no bucket"));
        }
        let off = || refused("the server gives no presigned URLs: `presigned_ttl` is off");
        self.settings.presigned_ttl.ok_or_else(off)
    }

    /// How many bytes the bucket has of a presigned upload.
    pub(super) async fn bytes_in_bucket(&self, row: &UploadRow) -> Result<Option<u64>, Problem> {
        let pieces = self.store.pieces(row.id).await.map_err(|e| super::pieces::upload_problem(&e))?;
        let (spool, file) = (Arc::clone(&self.spool), pieces.into_iter().next());
        on_disk(move || match (file, spool.presigned()) {
            (Some(file), Some(urls)) => urls.size(&file.key),
            _ => Ok(None),
        })
        .await
    }

    /// The mesh of a presigned upload, once the bucket has it. Its bytes are looked at when a job reads them.
    pub(super) async fn mesh_in_bucket(
        &self,
        row: &UploadRow,
        pieces: Vec<BlobRef>,
    ) -> Result<Uploaded, Problem> {
        let file = pieces.into_iter().next().ok_or_else(upload_gone)?;
        match self.bytes_in_bucket(row).await? {
            Some(bytes) if bytes == file.bytes => {}
            Some(bytes) => {
                let detail =
                    format!("the bucket has {bytes} bytes of the upload, which is to have {}", file.bytes);
                return Err(unfinished(detail));
            }
            None => {
                return Err(unfinished("nothing has come into the bucket by the presigned URL".to_owned()));
            }
        }
        if file.bytes == 0 {
            return Err(Problem::new(ProblemCode::MeshEmpty, "the upload has no byte"));
        }
        // Whoever has the URL may still write to that name: the job gets a copy, which is within the limit.
        let space = self.make_room_in_store(&row.tenant, file.bytes).await?;
        let name = self.spool.new_name(MESHES);
        let (from, to) = (file.key.clone(), name.key.clone());
        let written = Written::unseen(name, BlobRef { key: to.clone(), ..file.clone() }, space);
        let spool = Arc::clone(&self.spool);
        let copied = on_disk(move || match spool.presigned() {
            Some(urls) => {
                urls.copy(&from, &to)?;
                urls.size(&to)
            }
            None => Err(std::io::ErrorKind::Unsupported.into()),
        });
        if copied.await? != Some(file.bytes) {
            return Err(unfinished("the bucket has other bytes than it had a moment ago".to_owned()));
        }
        let taken = ClaimedUpload { id: row.id, pieces: vec![file], spool: Arc::clone(&self.spool) };
        Ok(Uploaded::of_bucket(written).made_of(taken))
    }
}
