//! Uploads that come before the job that they are for: rows of their own, until a job takes their bytes.

use std::time::Duration;

use jiff::Timestamp;

use super::StoreFuture;
use super::id::{JobId, UploadId};
use super::row::BlobRef;
use super::tenant::Tenant;

/// An upload that is to come.
#[derive(Debug, Clone)]
pub struct NewUpload {
    /// Its id.
    pub id: UploadId,
    /// Who makes it, by the name of the key.
    pub owner: Option<String>,
    /// Whom it is charged to.
    pub tenant: Tenant,
    /// Name of the file, if the caller gave one.
    pub file_name: Option<String>,
    /// What the caller wrote beside it, as it came.
    pub metadata: Option<String>,
    /// Bytes that it is to have.
    pub length: u64,
    /// Time for which it is kept.
    pub keep_for: Duration,
    /// The one file that the caller writes to the bucket by itself; `None`: pieces come through a server.
    pub presigned: Option<BlobRef>,
}

/// What is kept about an upload.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UploadRow {
    /// Its id.
    pub id: UploadId,
    /// Who makes it, by the name of the key.
    pub owner: Option<String>,
    /// Whom it is charged to.
    pub tenant: Tenant,
    /// Name of the file, if the caller gave one.
    pub file_name: Option<String>,
    /// What the caller wrote beside it, as it came.
    pub metadata: Option<String>,
    /// Bytes that it is to have.
    pub length: u64,
    /// Bytes that are stored, from the first one on; of a presigned one none are known of.
    pub received: u64,
    /// Number of pieces in which they are stored.
    pub pieces: usize,
    /// The caller writes it to the bucket by itself.
    pub is_presigned: bool,
    /// The job that has taken its bytes.
    pub job: Option<JobId>,
    /// When it goes.
    pub expires_at: Timestamp,
    /// It should have gone when the row was read.
    pub is_due: bool,
}

/// Rows of uploads. As with those of jobs, every method is atomic and outlasts the process, and times are those of the
/// store's clock. A piece is written before it is appended, and whoever is not the one to append it removes it again.
pub trait UploadStore: Send + Sync {
    /// Makes an upload. [`StoreError::UploadsFull`](super::StoreError::UploadsFull) when there are `uploads_max` that no job
    /// has taken, or the tenant has as many as there are free places.
    fn create_upload(&self, upload: NewUpload, uploads_max: usize) -> StoreFuture<'_, UploadRow>;

    /// The row.
    fn get_upload(&self, id: UploadId) -> StoreFuture<'_, UploadRow>;

    /// The files that it is made of, the first bytes first; none once a job has taken them.
    fn pieces(&self, id: UploadId) -> StoreFuture<'_, Vec<BlobRef>>;

    /// Appends a piece whose first byte is byte `at`, and keeps the upload for `keep_for` from now. When that is the next one.
    /// When it goes. [`StoreError::UploadMoved`](super::StoreError::UploadMoved) when another byte is the next one, or the
    /// upload has no room for the piece.
    fn append_piece(
        &self,
        id: UploadId,
        at: u64,
        piece: BlobRef,
        keep_for: Duration,
    ) -> StoreFuture<'_, Timestamp>;

    /// Removes the row. Its files, which nobody names any longer.
    fn delete_upload(&self, id: UploadId) -> StoreFuture<'_, Vec<BlobRef>>;

    /// The same, but [`StoreError::NotFound`](super::StoreError::NotFound) where its time is not over, or a job has taken it.
    fn drop_due_upload(&self, id: UploadId) -> StoreFuture<'_, Vec<BlobRef>>;

    /// Uploads that no job has taken and that should have gone by now. What a job has taken goes with it.
    fn due_uploads(&self) -> StoreFuture<'_, Vec<UploadId>>;
}
