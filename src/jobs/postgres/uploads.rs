//! Uploads that come before their job. A method that changes an upload locks its row first.

use std::time::Duration;

use jiff::Timestamp;
use uuid::Uuid;

use super::PostgresStore;
use super::locks::{self, UPLOADS};
use super::rows::{json, json_if_any, later, number, time, to_json, value};
use super::session::Session;
use crate::jobs::store::{
    BlobRef, JobId, NewUpload, StoreError, StoreFuture, Tenant, UploadId, UploadRow, UploadStore,
};

impl UploadStore for PostgresStore {
    fn create_upload(&self, upload: NewUpload, uploads_max: usize) -> StoreFuture<'_, UploadRow> {
        self.write(move |session| Box::pin(create(session, upload, uploads_max)))
    }

    fn get_upload(&self, id: UploadId) -> StoreFuture<'_, UploadRow> {
        self.read(move |session| Box::pin(get(session, id)))
    }

    fn pieces(&self, id: UploadId) -> StoreFuture<'_, Vec<BlobRef>> {
        self.read(move |session| Box::pin(pieces(session, id)))
    }

    fn append_piece(
        &self,
        id: UploadId,
        at: u64,
        piece: BlobRef,
        keep_for: Duration,
    ) -> StoreFuture<'_, Timestamp> {
        self.write(move |session| Box::pin(append(session, id, at, piece, keep_for)))
    }

    fn delete_upload(&self, id: UploadId) -> StoreFuture<'_, Vec<BlobRef>> {
        self.write(move |session| Box::pin(delete(session, id)))
    }

    fn drop_due_upload(&self, id: UploadId) -> StoreFuture<'_, Vec<BlobRef>> {
        self.write(move |session| {
            Box::pin(async move {
                let sql =
                    "SELECT 1 FROM uploads WHERE id = $1 AND expires_at <= $2 AND job IS NULL FOR UPDATE";
                session.row(sql, &[&Uuid::from(id), &session.now]).await?;
                delete(session, id).await
            })
        })
    }

    fn due_uploads(&self) -> StoreFuture<'_, Vec<UploadId>> {
        self.read(|session| {
            Box::pin(async move {
                let sql = "SELECT id FROM uploads WHERE expires_at <= (SELECT now_ms()) AND job IS NULL";
                let rows = session.rows(sql, &[]).await?;
                rows.iter().map(|row| value::<Uuid>(row, 0).map(UploadId::from)).collect()
            })
        })
    }
}

/// A number of bytes as the database has it. No upload has more than it holds.
fn integer(bytes: u64) -> i64 {
    i64::try_from(bytes).unwrap_or(i64::MAX)
}

async fn create(session: &Session, new: NewUpload, uploads_max: usize) -> Result<UploadRow, StoreError> {
    locks::hold(session, UPLOADS).await?;
    let sql = "SELECT count(*), count(*) FILTER (WHERE tenant = $1) FROM uploads WHERE job IS NULL";
    let row = session.row(sql, &[&new.tenant.name()]).await?;
    let (all, own): (usize, usize) = (number(&row, 0)?, number(&row, 1)?);
    let free = uploads_max.saturating_sub(all);
    if free == 0 || (!new.tenant.is_nobody() && own >= free) {
        return Err(StoreError::UploadsFull { open: all, limit: uploads_max });
    }
    session
        .change(
            "INSERT INTO uploads (id, owner, tenant, file_name, metadata, length, is_presigned, expires_at)
             VALUES ($1, $2, $3, $4, $5, $6, $7, $8)",
            &[
                &Uuid::from(new.id),
                &new.owner,
                &new.tenant.name(),
                &new.file_name.as_ref().map(to_json).transpose()?,
                &new.metadata,
                &integer(new.length),
                &new.presigned.is_some(),
                &later(session.now, new.keep_for),
            ],
        )
        .await?;
    if let Some(file) = &new.presigned {
        insert_piece(session, new.id, file).await?;
    }
    get(session, new.id).await
}

async fn get(session: &Session, id: UploadId) -> Result<UploadRow, StoreError> {
    let sql = "SELECT owner, tenant, file_name, metadata, length, received, is_presigned, job, expires_at,
            (SELECT count(*) FROM pieces WHERE upload = $1), now_ms() FROM uploads WHERE id = $1";
    let row = session.row(sql, &[&Uuid::from(id)]).await?;
    let expires_at = time(&row, 8)?;
    let job = value::<Option<Uuid>>(&row, 7)?.map(JobId::from);
    Ok(UploadRow {
        id,
        owner: value(&row, 0)?,
        tenant: Tenant::named(value::<&str>(&row, 1)?),
        file_name: json_if_any(&row, 2)?,
        metadata: value(&row, 3)?,
        length: number(&row, 4)?,
        received: number(&row, 5)?,
        is_presigned: value(&row, 6)?,
        is_due: job.is_none() && expires_at.as_millisecond() <= value::<i64>(&row, 10)?,
        job,
        expires_at,
        pieces: number(&row, 9)?,
    })
}

async fn pieces(session: &Session, id: UploadId) -> Result<Vec<BlobRef>, StoreError> {
    let sql = "SELECT blob FROM pieces WHERE upload = $1 ORDER BY number";
    session.rows(sql, &[&Uuid::from(id)]).await?.iter().map(|row| json(row, 0)).collect()
}

async fn insert_piece(session: &Session, id: UploadId, piece: &BlobRef) -> Result<(), StoreError> {
    let sql = "INSERT INTO pieces (upload, number, key, blob)
        SELECT $1, 1 + coalesce(max(number), 0), $2, $3 FROM pieces WHERE upload = $1";
    session.change(sql, &[&Uuid::from(id), &piece.key, &to_json(piece)?]).await.map(drop)
}

async fn append(
    session: &Session,
    id: UploadId,
    at: u64,
    piece: BlobRef,
    keep_for: Duration,
) -> Result<Timestamp, StoreError> {
    // Of two that append at one offset, the second one waits here and finds that it is too late.
    let sql = "SELECT received FROM uploads WHERE id = $1 FOR UPDATE";
    let received = number(&session.row(sql, &[&Uuid::from(id)]).await?, 0)?;
    let sql = "UPDATE uploads SET received = received + $3, expires_at = $4
        WHERE id = $1 AND received = $2 AND received + $3 <= length AND job IS NULL AND NOT is_presigned";
    let expires_at = later(session.now, keep_for);
    let values = (Uuid::from(id), integer(at), integer(piece.bytes));
    if session.change(sql, &[&values.0, &values.1, &values.2, &expires_at]).await? == 0 {
        return Err(StoreError::UploadMoved { received });
    }
    insert_piece(session, id, &piece).await?;
    Timestamp::from_millisecond(expires_at).map_err(|error| StoreError::Unavailable(error.to_string()))
}

/// A job takes the files of an upload, which names none from then on. [`StoreError::NotFound`] when there is no such upload, or
/// another job was quicker.
pub(super) async fn take(session: &Session, upload: UploadId, job: JobId) -> Result<(), StoreError> {
    let sql = "UPDATE uploads SET job = $2, received = length WHERE id = $1 AND job IS NULL";
    if session.change(sql, &[&Uuid::from(upload), &Uuid::from(job)]).await? == 0 {
        return Err(StoreError::NotFound);
    }
    session.change("DELETE FROM pieces WHERE upload = $1", &[&Uuid::from(upload)]).await.map(drop)
}

async fn delete(session: &Session, id: UploadId) -> Result<Vec<BlobRef>, StoreError> {
    session.row("SELECT 1 FROM uploads WHERE id = $1 FOR UPDATE", &[&Uuid::from(id)]).await?;
    let files = pieces(session, id).await?;
    session.change("DELETE FROM uploads WHERE id = $1", &[&Uuid::from(id)]).await?;
    Ok(files)
}

/// Bytes of the uploads of a tenant that no job has taken, and of all of them.
pub(super) async fn held(session: &Session, tenant: &Tenant) -> Result<(u64, u64), StoreError> {
    let sql = "SELECT least(coalesce(sum(n) FILTER (WHERE tenant = $1), 0), 9223372036854775807)::bigint,
            least(coalesce(sum(n), 0), 9223372036854775807)::bigint
        FROM (SELECT tenant, CASE WHEN is_presigned THEN length ELSE received END AS n FROM uploads WHERE job IS NULL) AS open";
    let row = session.row(sql, &[&tenant.name()]).await?;
    Ok((number(&row, 0)?, number(&row, 1)?))
}
