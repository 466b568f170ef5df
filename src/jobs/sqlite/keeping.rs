//! Which files rows name, and how rows and files go.

use std::collections::HashSet;

use rusqlite::{Connection, params};

use super::rows::{json, parsed, to_json};
use crate::jobs::store::{BlobRef, ClaimRef, JobId, StoreError};

/// Notes that the job names these files.
pub(super) fn name<'b>(
    connection: &Connection,
    id: JobId,
    blobs: impl Iterator<Item = &'b BlobRef>,
) -> Result<(), StoreError> {
    let mut statement = connection.prepare_cached("INSERT OR IGNORE INTO names VALUES (?1, ?2, ?3)")?;
    for blob in blobs {
        statement.execute(params![id.to_string(), blob.key, to_json(blob)?])?;
    }
    Ok(())
}

/// The job names no file any longer. The files that no other one names.
fn unname(connection: &Connection, id: JobId) -> Result<Vec<BlobRef>, StoreError> {
    let mut statement = connection.prepare_cached(
        "SELECT blob FROM names AS own WHERE job = ?1
             AND NOT EXISTS (SELECT 1 FROM names AS other WHERE other.key = own.key AND other.job <> ?1)",
    )?;
    let orphans =
        statement.query_map([id.to_string()], |row| json(row, 0))?.collect::<rusqlite::Result<_>>()?;
    connection.prepare_cached("DELETE FROM names WHERE job = ?1")?.execute([id.to_string()])?;
    Ok(orphans)
}

pub(super) fn expire(connection: &Connection, id: JobId) -> Result<Vec<BlobRef>, StoreError> {
    let mut statement =
        connection.prepare_cached("SELECT finished_at IS NOT NULL FROM jobs WHERE id = ?1")?;
    let has_ended: bool = statement.query_row([id.to_string()], |row| row.get(0))?;
    if !has_ended {
        return Ok(Vec::new());
    }
    connection
        .prepare_cached("UPDATE jobs SET state = 'expired' WHERE id = ?1")?
        .execute([id.to_string()])?;
    unname(connection, id)
}

pub(super) fn delete(connection: &Connection, id: JobId) -> Result<Vec<BlobRef>, StoreError> {
    let orphans = unname(connection, id)?;
    let deleted = connection.prepare_cached("DELETE FROM jobs WHERE id = ?1")?.execute([id.to_string()])?;
    if deleted == 0 { Err(StoreError::NotFound) } else { Ok(orphans) }
}

pub(super) fn due(connection: &Connection, now: i64) -> Result<Vec<JobId>, StoreError> {
    let mut statement = connection.prepare_cached(
        "SELECT id FROM jobs WHERE expires_at IS NOT NULL AND state <> 'expired' AND expires_at <= ?1",
    )?;
    Ok(statement.query_map([now], |row| parsed(row, 0))?.collect::<rusqlite::Result<_>>()?)
}

pub(super) fn current(connection: &Connection, claims: &[ClaimRef]) -> Result<HashSet<ClaimRef>, StoreError> {
    let mut statement =
        connection.prepare_cached("SELECT 1 FROM jobs WHERE id = ?1 AND epoch = ?2 AND state = 'running'")?;
    let mut current = HashSet::new();
    for &claim in claims {
        if statement.exists(params![claim.id.to_string(), claim.epoch])? {
            current.insert(claim);
        }
    }
    Ok(current)
}

pub(super) fn named(connection: &Connection, keys: Vec<String>) -> Result<HashSet<String>, StoreError> {
    let mut statement = connection
        .prepare_cached("SELECT 1 FROM names WHERE key = ?1 UNION ALL SELECT 1 FROM pieces WHERE key = ?1")?;
    let mut named = HashSet::new();
    for key in keys {
        if statement.exists([&key])? {
            named.insert(key);
        }
    }
    Ok(named)
}
