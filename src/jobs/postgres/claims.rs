//! The life of a row: made, claimed, and ended, given back or lost. A method that changes a job locks its row first.

use std::time::Duration;

use tokio_postgres::Row;
use uuid::Uuid;

use super::locks::{self, ARRIVALS};
use super::rows::{
    self, COLUMNS, get, id as id_of, json_if_any, last_ms, later, number, number_of, state, to_json, value,
};
use super::session::Session;
use super::{keeping, listing, outbox, tenants, uploads};
use crate::jobs::store::{
    AfterLoss, BlobRef, ClaimRef, ClaimRequest, Created, Ending, JobId, JobRow, Lane, Leases, NewJob,
    StoreError,
};
use crate::wire::{ENGINE_VERSION, JobState, Problem, ProblemCode};

pub(super) async fn create(session: &Session, new: NewJob, queue_max: usize) -> Result<Created, StoreError> {
    if new.key.is_some() || new.ending.is_none() {
        locks::hold(session, ARRIVALS).await?;
    }
    if let Some(key) = &new.key
        && let Some(known) = listing::find_keyed(session, new.owner.as_deref(), key).await?
    {
        return Ok(Created::Known(known));
    }
    if let Some(source) = new.source {
        // Its files do not lose their names before this job has named them.
        let sql = "SELECT state FROM jobs WHERE id = $1 FOR SHARE";
        let row = session.row(sql, &[&Uuid::from(source)]).await?;
        if state(&row, 0)? == JobState::Expired {
            return Err(StoreError::NotFound);
        }
    }
    if new.ending.is_none() {
        let row = session.row("SELECT count(*) FROM jobs WHERE state = 'queued'", &[]).await?;
        let queued: usize = number(&row, 0)?;
        if queued >= queue_max {
            return Err(StoreError::QueueFull { queued });
        }
        tenants::check_share(session, &new.tenant, queue_max - queued).await?;
    }
    insert(session, &new).await?;
    if let Some(upload) = new.taken {
        uploads::take(session, upload, new.id).await?;
    }
    change(session, new.id).await?;
    if let Some(ending) = &new.ending {
        let sql = "UPDATE jobs SET started_at = $2, is_cached = true WHERE id = $1";
        session.change(sql, &[&Uuid::from(new.id), &session.now]).await?;
        end(session, new.id, None, ending).await?;
    }
    get(session, new.id).await.map(Created::New)
}

async fn insert(session: &Session, new: &NewJob) -> Result<(), StoreError> {
    let id = Uuid::from(new.id);
    session
        .change(
            "INSERT INTO jobs (id, owner, tenant, operation, options, file_name, labels, webhook, trace, input,
                 input_sha256, input_bytes, material, lane, state, created_at, cancel_at, keep_for, idempotency_key, fingerprint)
             VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10,
                 $11, $12::text::numeric, $13, $14, 'queued', $15, $16, $17, $18, $19)",
            &[
                &id,
                &new.owner,
                &new.tenant.name(),
                &new.operation.word(),
                &to_json(&new.options)?,
                &new.file_name.as_ref().map(to_json).transpose()?,
                &to_json(&new.labels)?,
                &new.webhook.as_ref().map(to_json).transpose()?,
                &new.trace.as_ref().map(ToString::to_string),
                &to_json(&new.input)?,
                &&new.input.sha256[..],
                &new.input.bytes.to_string(),
                &new.material.as_ref().map(to_json).transpose()?,
                &number_of(new.lane),
                &session.now,
                &new.cancel_after.map(|patience| later(session.now, patience)),
                &later(0, new.keep_for),
                &new.key.as_ref().map(|key| &key.key),
                &new.key.as_ref().map(|key| &key.fingerprint[..]),
            ],
        )
        .await?;
    for (name, text) in &new.labels {
        session
            .change("INSERT INTO labels VALUES ($1, $2, $3)", &[&id, &to_json(name)?, &to_json(text)?])
            .await?;
    }
    keeping::name(session, new.id, new.blobs()).await
}

/// Notes the state that a job has come into.
async fn change(session: &Session, id: JobId) -> Result<(), StoreError> {
    let sql = "INSERT INTO changes (job, number, state, epoch, at)
        SELECT id, 1 + (SELECT coalesce(max(number), 0) FROM changes WHERE job = $1), state, epoch, $2::bigint
        FROM jobs WHERE id = $1";
    session.change(sql, &[&Uuid::from(id), &session.now]).await.map(drop)
}

/// Ends a job and puts its webhook into the outbox, in one statement: whatever its state, or only if it runs by its claim of this
/// `epoch`. Whether it was ended.
async fn end(session: &Session, id: JobId, epoch: Option<u32>, ending: &Ending) -> Result<bool, StoreError> {
    let sql = format!(
        "WITH clock AS MATERIALIZED (SELECT now_ms() AS now),
        named AS MATERIALIZED (SELECT key, bytes::numeric, blob FROM unnest($7::text[], $8::text[], $9::text[]) AS named (key, bytes, blob)),
        ended AS (UPDATE jobs SET state = $2, ending = $3, engine = $4, finished_at = clock.now,
                 expires_at = least(clock.now + keep_for, $5), worker = NULL, lease_until = NULL, stop = NULL,
                 file_bytes = (SELECT coalesce(sum(bytes), 0) FROM
                     (SELECT key, bytes FROM names WHERE job = $1 UNION SELECT key, bytes FROM named) AS files)
             FROM clock WHERE id = $1 AND ($6::bigint IS NULL OR epoch = $6 AND state = 'running')
             RETURNING id, state, epoch, webhook, finished_at),
        kept AS (INSERT INTO names SELECT id, key, bytes, blob FROM ended, named ON CONFLICT DO NOTHING),
        noted AS (INSERT INTO changes (job, number, state, epoch, at)
             SELECT id, 1 + (SELECT coalesce(max(number), 0) FROM changes WHERE job = $1), state, epoch, finished_at FROM ended),
        posted AS ({})
        SELECT 1 FROM ended",
        outbox::POST_ENDED
    );
    let blobs: Vec<&BlobRef> = ending.blobs().collect();
    let keys: Vec<&str> = blobs.iter().map(|blob| blob.key.as_str()).collect();
    let bytes: Vec<String> = blobs.iter().map(|blob| blob.bytes.to_string()).collect();
    let texts = blobs.iter().map(to_json).collect::<Result<Vec<String>, StoreError>>()?;
    let ended = session
        .row_if_any(
            &sql,
            &[
                &Uuid::from(id),
                &ending.state.word(),
                &to_json(ending)?,
                &ENGINE_VERSION,
                &last_ms(),
                &epoch.map(i64::from),
                &keys,
                &bytes,
                &texts,
                &outbox::new_id(),
            ],
        )
        .await?;
    Ok(ended.is_some())
}

/// Claims a job of the first tenant that has one and that nobody else claims one of at this moment: many who claim do not wait for
/// each other. The tenants before it that are left.
pub(super) async fn claim_in_turn(
    session: &Session,
    request: ClaimRequest,
    turns: Vec<(String, Lane)>,
) -> Result<(Option<JobRow>, Vec<(String, Lane)>), StoreError> {
    let mut left = Vec::new();
    for (tenant, lane) in turns {
        if !tenants::try_hold(session, &request, &tenant).await? {
            left.push((tenant, lane));
        } else if let Some(row) = claim_held(session, &request, &tenant, lane).await? {
            return Ok((Some(row), left));
        }
    }
    Ok((None, left))
}

/// Claims a job of this tenant in this lane, if one is still there and the tenant has not got its share meanwhile.
pub(super) async fn claim(
    session: &Session,
    request: ClaimRequest,
    tenant: String,
    lane: Lane,
) -> Result<Option<JobRow>, StoreError> {
    tenants::hold(session, &request, &tenant).await?;
    claim_held(session, &request, &tenant, lane).await
}

async fn claim_held(
    session: &Session,
    request: &ClaimRequest,
    tenant: &str,
    lane: Lane,
) -> Result<Option<JobRow>, StoreError> {
    let sql = format!(
        "WITH claimed AS (UPDATE jobs SET state = 'running', epoch = epoch + 1, worker = $2, lease_until = $3, started_at = $4,
                 is_quick = $5, turn = nextval('turns')
             WHERE id = $1 RETURNING *),
         noted AS (INSERT INTO changes (job, number, state, epoch, at)
             SELECT id, 1 + (SELECT coalesce(max(number), 0) FROM changes WHERE job = $1), state, epoch, $4 FROM claimed)
         SELECT {COLUMNS} FROM claimed"
    );
    loop {
        let Some(id) = tenants::take(session, request, tenant, lane).await? else { return Ok(None) };
        let lease_until = later(session.now, request.lease);
        let row = session
            .row(&sql, &[&Uuid::from(id), &request.worker, &lease_until, &session.now, &request.is_only])
            .await?;
        match rows::job(&row) {
            Ok(row) => return Ok(Some(row)),
            // A row that an older program wrote and this one cannot read must not stand in the way of the others.
            Err(StoreError::Unavailable(error)) => {
                tracing::error!(job = %id, error, "a row cannot be read");
                let problem = Problem::new(ProblemCode::Internal, "the job cannot be read by this version");
                end(session, id, None, &Ending::without_files(JobState::Failed, Some(problem))).await?;
            }
            Err(error) => return Err(error),
        }
    }
}

pub(super) async fn renew(session: &Session, claim: ClaimRef, lease: Duration) -> Result<bool, StoreError> {
    let sql = "UPDATE jobs SET lease_until = least(now_ms() + $3, $4) WHERE id = $1 AND epoch = $2 AND state = 'running'
        RETURNING stop IS NOT NULL";
    let (id, epoch) = (Uuid::from(claim.id), i64::from(claim.epoch));
    let renewed = session.row_if_any(sql, &[&id, &epoch, &later(0, lease), &last_ms()]).await?;
    value(&renewed.ok_or(StoreError::ClaimVoid)?, 0)
}

/// [`StoreError::ClaimVoid`] unless the job runs by this claim, which it does until the transaction ends.
async fn check(session: &Session, claim: ClaimRef) -> Result<(), StoreError> {
    let sql = "SELECT 1 FROM jobs WHERE id = $1 AND epoch = $2 AND state = 'running' FOR UPDATE";
    let found = session.row_if_any(sql, &[&Uuid::from(claim.id), &i64::from(claim.epoch)]).await?;
    found.map(drop).ok_or(StoreError::ClaimVoid)
}

pub(super) async fn finish(session: &Session, claim: ClaimRef, ending: Ending) -> Result<(), StoreError> {
    let is_ended = end(session, claim.id, Some(claim.epoch), &ending).await?;
    is_ended.then_some(()).ok_or(StoreError::ClaimVoid)
}

pub(super) async fn release(session: &Session, claim: ClaimRef) -> Result<AfterLoss, StoreError> {
    check(session, claim).await?;
    give_back(session, claim.id).await
}

/// A running job is queued again, unless it was to be cancelled.
async fn give_back(session: &Session, id: JobId) -> Result<AfterLoss, StoreError> {
    let row = session.row("SELECT stop FROM jobs WHERE id = $1", &[&Uuid::from(id)]).await?;
    // One that cannot be read is of another version: the job goes on.
    if let Some(ending) = json_if_any(&row, 0).unwrap_or_default() {
        end(session, id, None, &ending).await?;
        return Ok(AfterLoss::Ended);
    }
    let sql =
        "UPDATE jobs SET state = 'queued', worker = NULL, lease_until = NULL, stop = NULL WHERE id = $1";
    session.change(sql, &[&Uuid::from(id)]).await?;
    change(session, id).await?;
    Ok(AfterLoss::Queued)
}

pub(super) async fn demote(
    session: &Session,
    claim: ClaimRef,
    is_outgrown: bool,
) -> Result<AfterLoss, StoreError> {
    check(session, claim).await?;
    let sql = "UPDATE jobs SET lane = $2, is_outgrown = is_outgrown OR $3 WHERE id = $1";
    session.change(sql, &[&Uuid::from(claim.id), &number_of(Lane::Bulk), &is_outgrown]).await?;
    give_back(session, claim.id).await
}

pub(super) async fn lose(
    session: &Session,
    claim: ClaimRef,
    problem: Problem,
    attempts_max: u32,
) -> Result<AfterLoss, StoreError> {
    check(session, claim).await?;
    let sql = "UPDATE jobs SET attempts = attempts + 1 WHERE id = $1 RETURNING attempts";
    let attempts: u32 = number(&session.row(sql, &[&Uuid::from(claim.id)]).await?, 0)?;
    if attempts < attempts_max {
        return give_back(session, claim.id).await;
    }
    end(session, claim.id, None, &Ending::without_files(JobState::Failed, Some(problem))).await?;
    Ok(AfterLoss::Ended)
}

/// What another server recovers at the same time is left to it.
pub(super) async fn recover(
    session: &Session,
    leases: Leases,
    problem: Problem,
    attempts_max: u32,
) -> Result<Vec<(JobId, AfterLoss)>, StoreError> {
    let rows = match &leases {
        Leases::Expired => {
            let sql = "SELECT id, epoch FROM jobs WHERE state = 'running' AND lease_until <= $1
                ORDER BY id FOR UPDATE SKIP LOCKED";
            session.rows(sql, &[&session.now]).await?
        }
        Leases::OfWorker(worker) => {
            let sql = "SELECT id, epoch FROM jobs WHERE state = 'running' AND worker = $1
                ORDER BY id FOR UPDATE SKIP LOCKED";
            session.rows(sql, &[worker]).await?
        }
    };
    let claim = |row: &Row| Ok(ClaimRef { id: id_of(row, 0)?, epoch: number(row, 1)? });
    let mut recovered = Vec::with_capacity(rows.len());
    for claim in rows.iter().map(claim).collect::<Result<Vec<_>, StoreError>>()? {
        recovered.push((claim.id, lose(session, claim, problem.clone(), attempts_max).await?));
    }
    Ok(recovered)
}

pub(super) async fn end_queued(session: &Session, id: JobId, ending: Ending) -> Result<bool, StoreError> {
    let is_queued = locked_state(session, id).await? == JobState::Queued;
    if is_queued {
        end(session, id, None, &ending).await?;
    }
    Ok(is_queued)
}

pub(super) async fn cancel(session: &Session, id: JobId, ending: Ending) -> Result<bool, StoreError> {
    match locked_state(session, id).await? {
        JobState::Queued => end(session, id, None, &ending).await,
        JobState::Running => {
            let sql = "UPDATE jobs SET stop = $2 WHERE id = $1";
            session.change(sql, &[&Uuid::from(id), &to_json(&ending)?]).await?;
            Ok(false)
        }
        _ => Ok(false),
    }
}

async fn locked_state(session: &Session, id: JobId) -> Result<JobState, StoreError> {
    let row = session.row("SELECT state FROM jobs WHERE id = $1 FOR UPDATE", &[&Uuid::from(id)]).await?;
    state(&row, 0)
}
