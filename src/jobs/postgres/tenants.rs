//! Shares: whose job runs next, whose results go first, and how many places of the queue one tenant may have. What a tenant
//! has is counted, not kept: a row of sums would be one that all who change anything wait for.

use super::locks;
use super::rows::{id as id_of, lane, number, number_of, value};
use super::session::Session;
use super::uploads;
use crate::jobs::store::{ClaimRequest, EndedJobs, Holding, JobId, Lane, StoreError, Tenant};

/// Refuses when the tenant has as many jobs in the queue as there are `free` places.
pub(super) async fn check_share(session: &Session, tenant: &Tenant, free: usize) -> Result<(), StoreError> {
    if tenant.is_nobody() {
        return Ok(());
    }
    let sql = "SELECT count(*) FROM jobs WHERE state = 'queued' AND tenant = $1";
    let queued: usize = number(&session.row(sql, &[&tenant.name()]).await?, 0)?;
    if queued < free { Ok(()) } else { Err(StoreError::ShareFull { queued, limit: free }) }
}

pub(super) async fn holding(session: &Session, tenant: Tenant) -> Result<Holding, StoreError> {
    // Sums of what callers claim may be larger than an integer holds.
    let sql = "SELECT count(*), count(*) FILTER (WHERE state = 'queued'),
            least(coalesce(sum(input_bytes) FILTER (WHERE state IN ('queued', 'running')), 0), 9223372036854775807)::bigint,
            (SELECT least(coalesce(sum(input_bytes), 0), 9223372036854775807)::bigint FROM jobs
             WHERE state IN ('queued', 'running')),
            least(coalesce(sum(file_bytes), 0), 9223372036854775807)::bigint
        FROM jobs WHERE tenant = $1";
    let row = session.row(sql, &[&tenant.name()]).await?;
    let (own_uploads, all_uploads) = uploads::held(session, &tenant).await?;
    let of_jobs = Holding {
        jobs: number(&row, 0)?,
        queued: number(&row, 1)?,
        open_bytes: number(&row, 2)?,
        open_bytes_of_all: number(&row, 3)?,
        bytes: number(&row, 4)?,
    };
    Ok(of_jobs.with_uploads(own_uploads, all_uploads))
}

/// The tenants that a job may be claimed of, whose turn it is first, each with the lane of its job. A claim tries one after
/// the other: what another worker takes meanwhile is not there any more.
pub(super) async fn in_turn(
    session: &Session,
    request: ClaimRequest,
) -> Result<Vec<(String, Lane)>, StoreError> {
    let other = match request.prefer {
        Lane::Interactive => Lane::Bulk,
        Lane::Bulk => Lane::Interactive,
    };
    let lanes: Vec<i64> = [Some(request.prefer), (!request.is_only).then_some(other)]
        .into_iter()
        .flatten()
        .map(number_of)
        .collect();
    // From tenant to tenant and lane to lane, past their jobs: a long queue costs no more than its tenants do.
    let sql = "WITH RECURSIVE first (tenant, lane, id) AS (
            (SELECT tenant, lane, id FROM jobs WHERE state = 'queued' ORDER BY tenant, lane, id LIMIT 1)
            UNION ALL
            SELECT next.tenant, next.lane, next.id FROM first, LATERAL (SELECT tenant, lane, id FROM jobs
                WHERE state = 'queued' AND (jobs.tenant, jobs.lane) > (first.tenant, first.lane)
                ORDER BY tenant, lane, id LIMIT 1) AS next),
        running AS (SELECT tenant, count(*) AS jobs,
                count(*) FILTER (WHERE is_quick = $2 AND worker = coalesce($4::text, worker)) AS counted
            FROM jobs WHERE state = 'running' GROUP BY tenant)
        SELECT first.tenant, first.lane FROM first LEFT JOIN running ON running.tenant = first.tenant
        WHERE first.lane = ANY ($1::bigint[]) AND (first.tenant = '' OR $3 > coalesce(running.counted, 0))
        ORDER BY array_position($1, first.lane), coalesce(running.jobs, 0),
            coalesce((SELECT max(turn) FROM jobs WHERE tenant = first.tenant), 0), first.id";
    let share = i64::try_from(request.share).unwrap_or(i64::MAX);
    let rows = session.rows(sql, &[&lanes, &request.is_only, &share, &counted_of(&request)]).await?;
    rows.iter().map(|row| Ok((value(row, 0)?, lane(value(row, 1)?)))).collect()
}

/// The worker whose running jobs count for a share; `None`: those of all do.
fn counted_of(request: &ClaimRequest) -> Option<&str> {
    request.is_share_of_worker.then_some(request.worker.as_str())
}

/// Waits until nobody else claims a job of the tenant, so that its share is exact.
pub(super) async fn hold(session: &Session, request: &ClaimRequest, tenant: &str) -> Result<(), StoreError> {
    if tenant.is_empty() { Ok(()) } else { locks::hold_share(session, tenant, counted_of(request)).await }
}

/// The same without a wait: whether nobody else does.
pub(super) async fn try_hold(
    session: &Session,
    request: &ClaimRequest,
    tenant: &str,
) -> Result<bool, StoreError> {
    if tenant.is_empty() {
        Ok(true)
    } else {
        locks::try_hold_share(session, tenant, counted_of(request)).await
    }
}

/// Locks the first job of a tenant that is held and that nobody else is about to take, if the tenant may have another one.
pub(super) async fn take(
    session: &Session,
    request: &ClaimRequest,
    tenant: &str,
    lane: Lane,
) -> Result<Option<JobId>, StoreError> {
    let sql = "SELECT id FROM jobs WHERE state = 'queued' AND tenant = $1 AND lane = $2
            AND ($1 = '' OR $4 > (SELECT count(*) FROM jobs
                WHERE state = 'running' AND tenant = $1 AND is_quick = $3 AND worker = coalesce($5::text, worker)))
        ORDER BY id LIMIT 1 FOR UPDATE SKIP LOCKED";
    let share = i64::try_from(request.share).unwrap_or(i64::MAX);
    let worker = counted_of(request);
    let found =
        session.row_if_any(sql, &[&tenant, &number_of(lane), &request.is_only, &share, &worker]).await?;
    found.map(|row| id_of(&row, 0)).transpose()
}

/// The ended job that makes room for one of `asker`.
pub(super) async fn first_to_go(
    session: &Session,
    kept: EndedJobs,
    asker: Tenant,
) -> Result<Option<JobId>, StoreError> {
    let what = match kept {
        EndedJobs::WithFiles => "sum(file_bytes)",
        EndedJobs::Any => "count(*)",
    };
    let held = format!("WITH held AS (SELECT tenant, {what} AS n FROM jobs GROUP BY tenant)");
    let sql = format!(
        "{held} SELECT n * (SELECT count(*) FROM held) >= (SELECT sum(n) FROM held) FROM held WHERE tenant = $1"
    );
    let has_share = session.row_if_any(&sql, &[&asker.name()]).await?;
    if let Some(row) = has_share
        && value(&row, 0)?
        && let Some(own) = first_to_go_of(session, kept, &asker).await?
    {
        return Ok(Some(own));
    }
    let sql = format!(
        "{held} SELECT tenant FROM held WHERE n * (SELECT count(*) FROM held) > (SELECT sum(n) FROM held)
         ORDER BY n DESC, tenant"
    );
    for row in session.rows(&sql, &[]).await? {
        let tenant = Tenant::named(value::<&str>(&row, 0)?);
        if let Some(id) = first_to_go_of(session, kept, &tenant).await? {
            return Ok(Some(id));
        }
    }
    Ok(None)
}

/// The ended job of a tenant that is to go first.
pub(super) async fn first_to_go_of(
    session: &Session,
    kept: EndedJobs,
    tenant: &Tenant,
) -> Result<Option<JobId>, StoreError> {
    let statements = match kept {
        // Webhooks stay with their row.
        EndedJobs::WithFiles => &["SELECT id FROM jobs
             WHERE tenant = $1 AND finished_at IS NOT NULL AND state <> 'expired' ORDER BY finished_at, id LIMIT 1"][..],
        EndedJobs::Any => &[
            "SELECT id FROM jobs AS own
             WHERE tenant = $1 AND finished_at IS NOT NULL AND NOT EXISTS
                 (SELECT 1 FROM deliveries WHERE deliveries.job = own.id AND next_at IS NOT NULL)
             ORDER BY finished_at, id LIMIT 1",
            "SELECT id FROM jobs WHERE tenant = $1 AND finished_at IS NOT NULL ORDER BY finished_at, id LIMIT 1",
        ],
    };
    for statement in statements {
        if let Some(row) = session.row_if_any(statement, &[&tenant.name()]).await? {
            return id_of(&row, 0).map(Some);
        }
    }
    Ok(None)
}
