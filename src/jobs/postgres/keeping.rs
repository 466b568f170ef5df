//! Which files rows name, and how rows and files go.

use std::collections::HashSet;

use uuid::Uuid;

use super::locks::{self, NAMES};
use super::rows::{id as id_of, json, to_json, value};
use super::session::Session;
use crate::jobs::store::{BlobRef, ClaimRef, JobId, StoreError};

/// Notes that the job names these files.
pub(super) async fn name<'b>(
    session: &Session,
    id: JobId,
    blobs: impl Iterator<Item = &'b BlobRef> + Send,
) -> Result<(), StoreError> {
    let id = Uuid::from(id);
    let mut named = 0;
    for blob in blobs {
        let sql = "INSERT INTO names VALUES ($1, $2, $3::text::numeric, $4) ON CONFLICT DO NOTHING";
        named += session.change(sql, &[&id, &blob.key, &blob.bytes.to_string(), &to_json(blob)?]).await?;
    }
    if named > 0 {
        let sql = "UPDATE jobs SET file_bytes = (SELECT coalesce(sum(bytes), 0) FROM names WHERE job = $1) WHERE id = $1";
        session.change(sql, &[&id]).await?;
    }
    Ok(())
}

/// The job, whose row is locked, names no file any longer. The files that no other one names.
async fn unname(session: &Session, id: JobId) -> Result<Vec<BlobRef>, StoreError> {
    // Of two jobs that name one file and lose it at one time, the second one is told that it is nobody's.
    locks::hold(session, NAMES).await?;
    let sql = "SELECT blob FROM names AS own WHERE job = $1
        AND NOT EXISTS (SELECT 1 FROM names AS other WHERE other.key = own.key AND other.job <> $1)";
    let rows = session.rows(sql, &[&Uuid::from(id)]).await?;
    session.change("DELETE FROM names WHERE job = $1", &[&Uuid::from(id)]).await?;
    rows.iter().map(|row| json(row, 0)).collect()
}

pub(super) async fn expire(session: &Session, id: JobId) -> Result<Vec<BlobRef>, StoreError> {
    let sql = "SELECT finished_at IS NOT NULL FROM jobs WHERE id = $1 FOR UPDATE";
    let has_ended: bool = value(&session.row(sql, &[&Uuid::from(id)]).await?, 0)?;
    if !has_ended {
        return Ok(Vec::new());
    }
    let sql = "UPDATE jobs SET state = 'expired', file_bytes = 0 WHERE id = $1";
    session.change(sql, &[&Uuid::from(id)]).await?;
    unname(session, id).await
}

pub(super) async fn delete(session: &Session, id: JobId) -> Result<Vec<BlobRef>, StoreError> {
    session.row("SELECT 1 FROM jobs WHERE id = $1 FOR UPDATE", &[&Uuid::from(id)]).await?;
    let orphans = unname(session, id).await?;
    session.change("DELETE FROM jobs WHERE id = $1", &[&Uuid::from(id)]).await?;
    Ok(orphans)
}

pub(super) async fn due(session: &Session) -> Result<Vec<JobId>, StoreError> {
    let sql = "SELECT id FROM jobs
        WHERE expires_at IS NOT NULL AND state <> 'expired' AND expires_at <= (SELECT now_ms())";
    session.rows(sql, &[]).await?.iter().map(|row| id_of(row, 0)).collect()
}

pub(super) async fn current(
    session: &Session,
    claims: Vec<ClaimRef>,
) -> Result<HashSet<ClaimRef>, StoreError> {
    let ids: Vec<Uuid> = claims.iter().map(|claim| claim.id.into()).collect();
    let epochs: Vec<i64> = claims.iter().map(|claim| claim.epoch.into()).collect();
    let sql =
        "SELECT asked.place FROM unnest($1::uuid[], $2::bigint[]) WITH ORDINALITY AS asked (id, epoch, place)
        JOIN jobs ON jobs.id = asked.id AND jobs.epoch = asked.epoch AND jobs.state = 'running'";
    let mut current = HashSet::new();
    for row in session.rows(sql, &[&ids, &epochs]).await? {
        let place: i64 = value(&row, 0)?;
        current.extend(usize::try_from(place - 1).ok().and_then(|place| claims.get(place)));
    }
    Ok(current)
}

pub(super) async fn named(session: &Session, keys: Vec<String>) -> Result<HashSet<String>, StoreError> {
    let sql = "SELECT key FROM unnest($1::text[]) AS asked (key)
        WHERE EXISTS (SELECT 1 FROM names WHERE names.key = asked.key)
            OR EXISTS (SELECT 1 FROM pieces WHERE pieces.key = asked.key)";
    session.rows(sql, &[&keys]).await?.iter().map(|row| value(row, 0)).collect()
}
