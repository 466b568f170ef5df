//! Shares: whose job runs next, whose results go first, and how many places of the queue one tenant may have.

use rusqlite::{Connection, OptionalExtension as _, params};

use super::rows::{number_of, parsed};
use super::uploads;
use crate::jobs::store::{ClaimRequest, EndedJobs, Holding, JobId, Lane, StoreError, Tenant};

/// Refuses when the tenant has as many jobs in the queue as there are `free` places.
pub(super) fn check_share(connection: &Connection, tenant: &Tenant, free: usize) -> Result<(), StoreError> {
    if tenant.is_nobody() {
        return Ok(());
    }
    let queued: i64 = connection
        .prepare_cached("SELECT queued FROM holdings WHERE tenant = ?1")?
        .query_row([tenant.name()], |row| row.get(0))
        .optional()?
        .unwrap_or_default();
    let queued = usize::try_from(queued).unwrap_or_default();
    if queued < free { Ok(()) } else { Err(StoreError::ShareFull { queued, limit: free }) }
}

pub(super) fn holding(connection: &Connection, tenant: &Tenant) -> Result<Holding, StoreError> {
    // What is nobody's may be larger than an integer holds.
    let number = |row: &rusqlite::Row<'_>, column| {
        Ok::<_, rusqlite::Error>(row.get::<_, i64>(column)?.max(0).unsigned_abs())
    };
    let open_bytes_of_all = connection
        .prepare_cached(
            "SELECT CAST(coalesce(sum(open_bytes), 0) AS INTEGER) FROM holdings INDEXED BY holdings_open
             WHERE open_bytes > 0",
        )?
        .query_row([], |row| number(row, 0))?;
    let own = connection
        .prepare_cached(
            "SELECT jobs, queued, CAST(open_bytes AS INTEGER), CAST(bytes AS INTEGER) FROM holdings WHERE tenant = ?1",
        )?
        .query_row([tenant.name()], |row| {
            Ok(Holding {
                jobs: number(row, 0)?,
                queued: number(row, 1)?,
                open_bytes: number(row, 2)?,
                bytes: number(row, 3)?,
                open_bytes_of_all,
            })
        })
        .optional()?;
    let own = own.unwrap_or(Holding { open_bytes_of_all, ..Holding::default() });
    let (own_uploads, all_uploads) = uploads::held(connection, tenant)?;
    Ok(own.with_uploads(own_uploads, all_uploads))
}

/// The queued job whose turn it is.
pub(super) fn next_job(connection: &Connection, request: &ClaimRequest) -> Result<Option<JobId>, StoreError> {
    let other = match request.prefer {
        Lane::Interactive => Lane::Bulk,
        Lane::Bulk => Lane::Interactive,
    };
    let lanes = [Some(request.prefer), (!request.is_only).then_some(other)];
    for lane in lanes.into_iter().flatten() {
        let mut statement = connection.prepare_cached(
            "SELECT (SELECT id FROM jobs INDEXED BY jobs_queued_by_tenant
                     WHERE state = 'queued' AND tenant = own.tenant AND lane = ?1 ORDER BY id LIMIT 1) AS first, tenant
             FROM holdings AS own INDEXED BY holdings_queued
             WHERE queued > 0 AND first IS NOT NULL
                 AND (tenant = '' OR ?3 > (SELECT count(*) FROM jobs INDEXED BY jobs_running
                      WHERE state = 'running' AND tenant = own.tenant AND is_quick = ?2))
             ORDER BY running, served, first LIMIT 1",
        )?;
        let share = i64::try_from(request.share).unwrap_or(i64::MAX);
        let found = statement
            .query_row(params![number_of(lane), request.is_only, share], |row| {
                Ok((parsed(row, 0)?, row.get::<_, String>(1)?))
            })
            .optional()?;
        if let Some((id, tenant)) = found {
            connection
                .prepare_cached(
                    "UPDATE holdings SET served = 1 + (SELECT max(served) FROM holdings) WHERE tenant = ?1",
                )?
                .execute([tenant])?;
            return Ok(Some(id));
        }
    }
    Ok(None)
}

/// The ended job that makes room for one of `asker`.
pub(super) fn first_to_go(
    connection: &Connection,
    kept: EndedJobs,
    asker: &Tenant,
) -> Result<Option<JobId>, StoreError> {
    let (has_share, over_share) = match kept {
        EndedJobs::WithFiles => (
            "SELECT bytes * (SELECT count(*) FROM holdings) >= (SELECT sum(bytes) FROM holdings)
             FROM holdings WHERE tenant = ?1",
            "SELECT tenant FROM holdings WHERE bytes * (SELECT count(*) FROM holdings) > (SELECT sum(bytes) FROM holdings)
             ORDER BY bytes DESC, tenant",
        ),
        EndedJobs::Any => (
            "SELECT jobs * (SELECT count(*) FROM holdings) >= (SELECT sum(jobs) FROM holdings)
             FROM holdings WHERE tenant = ?1",
            "SELECT tenant FROM holdings WHERE jobs * (SELECT count(*) FROM holdings) > (SELECT sum(jobs) FROM holdings)
             ORDER BY jobs DESC, tenant",
        ),
    };
    let has_share: Option<bool> =
        connection.prepare_cached(has_share)?.query_row([asker.name()], |row| row.get(0)).optional()?;
    if has_share == Some(true)
        && let Some(own) = first_to_go_of(connection, kept, asker)?
    {
        return Ok(Some(own));
    }
    let mut statement = connection.prepare_cached(over_share)?;
    let mut tenants = statement.query([])?;
    while let Some(row) = tenants.next()? {
        let tenant = Tenant::named(row.get::<_, String>(0)?);
        if let Some(id) = first_to_go_of(connection, kept, &tenant)? {
            return Ok(Some(id));
        }
    }
    Ok(None)
}

/// The ended job of a tenant that is to go first.
pub(super) fn first_to_go_of(
    connection: &Connection,
    kept: EndedJobs,
    tenant: &Tenant,
) -> Result<Option<JobId>, StoreError> {
    let statements = match kept {
        // Webhooks stay with their row.
        EndedJobs::WithFiles => &["SELECT id FROM jobs INDEXED BY jobs_with_files_by_tenant
             WHERE tenant = ?1 AND finished_at IS NOT NULL AND state <> 'expired' ORDER BY finished_at, id LIMIT 1"][..],
        EndedJobs::Any => &[
            "SELECT id FROM jobs AS own INDEXED BY jobs_ended_by_tenant
             WHERE tenant = ?1 AND finished_at IS NOT NULL AND NOT EXISTS
                 (SELECT 1 FROM deliveries WHERE deliveries.job = own.id AND next_at IS NOT NULL)
             ORDER BY finished_at, id LIMIT 1",
            "SELECT id FROM jobs INDEXED BY jobs_ended_by_tenant
             WHERE tenant = ?1 AND finished_at IS NOT NULL ORDER BY finished_at, id LIMIT 1",
        ],
    };
    for statement in statements {
        let found = connection
            .prepare_cached(statement)?
            .query_row([tenant.name()], |row| parsed(row, 0))
            .optional()?;
        if found.is_some() {
            return Ok(found);
        }
    }
    Ok(None)
}
