//! Uploads that come before their job.

use std::time::Duration;

use jiff::Timestamp;
use rusqlite::{Connection, OptionalExtension as _, Row, named_params, params};

use super::SqliteStore;
use super::rows::{json, later, time, to_json};
use crate::jobs::store::{
    BlobRef, JobId, NewUpload, StoreError, StoreFuture, Tenant, UploadId, UploadRow, UploadStore,
};

impl UploadStore for SqliteStore {
    fn create_upload(&self, upload: NewUpload, uploads_max: usize) -> StoreFuture<'_, UploadRow> {
        self.write(move |connection, now| create(connection, &upload, uploads_max, now))
    }

    fn get_upload(&self, id: UploadId) -> StoreFuture<'_, UploadRow> {
        self.look_up(move |connection, now| get(connection, id, now))
    }

    fn pieces(&self, id: UploadId) -> StoreFuture<'_, Vec<BlobRef>> {
        self.read(move |connection, _| pieces(connection, id))
    }

    fn append_piece(
        &self,
        id: UploadId,
        at: u64,
        piece: BlobRef,
        keep_for: Duration,
    ) -> StoreFuture<'_, Timestamp> {
        self.write(move |connection, now| append(connection, id, at, &piece, later(now, keep_for)))
    }

    fn delete_upload(&self, id: UploadId) -> StoreFuture<'_, Vec<BlobRef>> {
        self.write(move |connection, _| delete(connection, id))
    }

    fn drop_due_upload(&self, id: UploadId) -> StoreFuture<'_, Vec<BlobRef>> {
        self.write(move |connection, now| {
            let is_due = connection
                .prepare_cached("SELECT 1 FROM uploads WHERE id = ?1 AND expires_at <= ?2 AND job IS NULL")?
                .exists(params![id.to_string(), now])?;
            if is_due { delete(connection, id) } else { Err(StoreError::NotFound) }
        })
    }

    fn due_uploads(&self) -> StoreFuture<'_, Vec<UploadId>> {
        self.read(|connection, now| {
            let sql = "SELECT id FROM uploads WHERE expires_at <= ?1 AND job IS NULL";
            let mut statement = connection.prepare_cached(sql)?;
            Ok(statement.query_map([now], |row| id(row, 0))?.collect::<rusqlite::Result<_>>()?)
        })
    }
}

/// A number of bytes as the file has it. No upload has more than it holds.
fn integer(bytes: u64) -> i64 {
    i64::try_from(bytes).unwrap_or(i64::MAX)
}

fn bytes(row: &Row<'_>, column: usize) -> rusqlite::Result<u64> {
    Ok(row.get::<_, i64>(column)?.max(0).unsigned_abs())
}

fn count(row: &Row<'_>, column: usize) -> rusqlite::Result<usize> {
    Ok(usize::try_from(row.get::<_, i64>(column)?).unwrap_or_default())
}

fn id(row: &Row<'_>, column: usize) -> rusqlite::Result<UploadId> {
    super::rows::parsed(row, column).map(|id: JobId| uuid::Uuid::from(id).into())
}

fn create(
    connection: &Connection,
    new: &NewUpload,
    uploads_max: usize,
    now: i64,
) -> Result<UploadRow, StoreError> {
    let (all, own) = connection
        .prepare_cached(
            "SELECT count(*), count(*) FILTER (WHERE tenant = ?1) FROM uploads WHERE job IS NULL",
        )?
        .query_row([new.tenant.name()], |row| Ok((count(row, 0)?, count(row, 1)?)))?;
    let free = uploads_max.saturating_sub(all);
    if free == 0 || (!new.tenant.is_nobody() && own >= free) {
        return Err(StoreError::UploadsFull { open: all, limit: uploads_max });
    }
    connection
        .prepare_cached(
            "INSERT INTO uploads (id, owner, tenant, file_name, metadata, length, is_presigned, expires_at)
             VALUES (:id, :owner, :tenant, :file_name, :metadata, :length, :is_presigned, :expires_at)",
        )?
        .execute(named_params! {
            ":id": new.id.to_string(),
            ":owner": new.owner,
            ":tenant": new.tenant.name(),
            ":file_name": new.file_name,
            ":metadata": new.metadata,
            ":length": integer(new.length),
            ":is_presigned": new.presigned.is_some(),
            ":expires_at": later(now, new.keep_for),
        })?;
    if let Some(file) = &new.presigned {
        insert_piece(connection, new.id, file)?;
    }
    get(connection, new.id, now)
}

fn get(connection: &Connection, id: UploadId, now: i64) -> Result<UploadRow, StoreError> {
    let mut statement = connection.prepare_cached(
        "SELECT owner, tenant, file_name, metadata, length, received, is_presigned, job, expires_at,
             (SELECT count(*) FROM pieces WHERE upload = ?1) FROM uploads WHERE id = ?1",
    )?;
    let row = |row: &Row<'_>| {
        let expires_at = time(row, 8)?;
        let job = match row.get::<_, Option<String>>(7)? {
            Some(_) => Some(super::rows::parsed(row, 7)?),
            None => None,
        };
        Ok(UploadRow {
            id,
            owner: row.get(0)?,
            tenant: Tenant::named(row.get::<_, String>(1)?),
            file_name: row.get(2)?,
            metadata: row.get(3)?,
            length: bytes(row, 4)?,
            received: bytes(row, 5)?,
            is_presigned: row.get(6)?,
            is_due: job.is_none() && expires_at.as_millisecond() <= now,
            job,
            expires_at,
            pieces: count(row, 9)?,
        })
    };
    Ok(statement.query_row([id.to_string()], row)?)
}

fn pieces(connection: &Connection, id: UploadId) -> Result<Vec<BlobRef>, StoreError> {
    let mut statement =
        connection.prepare_cached("SELECT blob FROM pieces WHERE upload = ?1 ORDER BY number")?;
    let pieces = statement.query_map([id.to_string()], |row| json(row, 0))?;
    Ok(pieces.collect::<rusqlite::Result<_>>()?)
}

fn insert_piece(connection: &Connection, id: UploadId, piece: &BlobRef) -> Result<(), StoreError> {
    connection
        .prepare_cached(
            "INSERT INTO pieces (upload, number, key, blob)
             SELECT ?1, 1 + coalesce(max(number), 0), ?2, ?3 FROM pieces WHERE upload = ?1",
        )?
        .execute(params![id.to_string(), piece.key, to_json(piece)?])?;
    Ok(())
}

fn append(
    connection: &Connection,
    id: UploadId,
    at: u64,
    piece: &BlobRef,
    expires_at: i64,
) -> Result<Timestamp, StoreError> {
    let changed = connection
        .prepare_cached(
            "UPDATE uploads SET received = received + ?3, expires_at = ?4
             WHERE id = ?1 AND received = ?2 AND received + ?3 <= length AND job IS NULL AND NOT is_presigned",
        )?
        .execute(params![id.to_string(), integer(at), integer(piece.bytes), expires_at])?;
    if changed == 0 {
        let received = connection
            .prepare_cached("SELECT received FROM uploads WHERE id = ?1")?
            .query_row([id.to_string()], |row| bytes(row, 0))?;
        return Err(StoreError::UploadMoved { received });
    }
    insert_piece(connection, id, piece)?;
    Timestamp::from_millisecond(expires_at).map_err(|error| StoreError::Unavailable(error.to_string()))
}

/// A job takes the files of an upload, which names none from then on. [`StoreError::NotFound`] when there is no such upload, or
/// another job was quicker.
pub(super) fn take(connection: &Connection, upload: UploadId, job: JobId) -> Result<(), StoreError> {
    let taken = connection
        .prepare_cached("UPDATE uploads SET job = ?2, received = length WHERE id = ?1 AND job IS NULL")?
        .execute([upload.to_string(), job.to_string()])?;
    if taken == 0 {
        return Err(StoreError::NotFound);
    }
    connection.prepare_cached("DELETE FROM pieces WHERE upload = ?1")?.execute([upload.to_string()])?;
    Ok(())
}

fn delete(connection: &Connection, id: UploadId) -> Result<Vec<BlobRef>, StoreError> {
    let files = pieces(connection, id)?;
    let deleted =
        connection.prepare_cached("DELETE FROM uploads WHERE id = ?1")?.execute([id.to_string()])?;
    if deleted == 0 { Err(StoreError::NotFound) } else { Ok(files) }
}

/// Bytes of the uploads of a tenant that no job has taken, and of all of them.
pub(super) fn held(connection: &Connection, tenant: &Tenant) -> Result<(u64, u64), StoreError> {
    let sums = connection
        .prepare_cached(
            "SELECT coalesce(sum(n) FILTER (WHERE tenant = ?1), 0), coalesce(sum(n), 0)
             FROM (SELECT tenant, iif(is_presigned, length, received) AS n FROM uploads WHERE job IS NULL)",
        )?
        .query_row([tenant.name()], |row| Ok((bytes(row, 0)?, bytes(row, 1)?)))
        .optional()?;
    Ok(sums.unwrap_or_default())
}
