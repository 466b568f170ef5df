//! The life of a row: made, claimed, and ended, given back or lost.

use std::time::Duration;

use rusqlite::{Connection, OptionalExtension as _, named_params, params};

use super::rows::{get, later, number_of, parsed, state, to_json};
use super::{keeping, listing, outbox, tenants, uploads};
use crate::jobs::store::{
    AfterLoss, ClaimRef, ClaimRequest, Created, Ending, JobId, JobRow, Lane, Leases, NewJob, StoreError,
};
use crate::wire::{ENGINE_VERSION, JobState, Problem, ProblemCode};

pub(super) fn create(
    connection: &Connection,
    new: &NewJob,
    queue_max: usize,
    now: i64,
) -> Result<Created, StoreError> {
    if let Some(key) = &new.key
        && let Some(known) = listing::find_keyed(connection, new.owner.as_deref(), key, now)?
    {
        return Ok(Created::Known(known));
    }
    if let Some(source) = new.source
        && get(connection, source, now)?.state == JobState::Expired
    {
        return Err(StoreError::NotFound);
    }
    if new.ending.is_none() {
        let queued = listing::counts(connection, now)?.queued;
        if queued >= queue_max {
            return Err(StoreError::QueueFull { queued });
        }
        tenants::check_share(connection, &new.tenant, queue_max - queued)?;
    }
    insert(connection, new, now)?;
    if let Some(upload) = new.taken {
        uploads::take(connection, upload, new.id)?;
    }
    change(connection, new.id, now)?;
    if let Some(ending) = &new.ending {
        connection
            .prepare_cached("UPDATE jobs SET started_at = ?2, is_cached = 1 WHERE id = ?1")?
            .execute(params![new.id.to_string(), now])?;
        end(connection, new.id, ending, now)?;
    }
    get(connection, new.id, now).map(Created::New)
}

fn insert(connection: &Connection, new: &NewJob, now: i64) -> Result<(), StoreError> {
    let id = new.id.to_string();
    let mut statement = connection.prepare_cached(
        "INSERT INTO jobs (id, owner, operation, options, file_name, labels, webhook, input, input_sha256, material,
             lane, state, created_at, cancel_at, keep_for, is_cached, idempotency_key, fingerprint, trace, tenant)
         VALUES (:id, :owner, :operation, :options, :file_name, :labels, :webhook, :input, :input_sha256, :material,
             :lane, 'queued', :created_at, :cancel_at, :keep_for, 0, :key, :fingerprint, :trace, :tenant)",
    )?;
    statement.execute(named_params! {
        ":id": id,
        ":owner": new.owner,
        ":operation": new.operation.word(),
        ":options": to_json(&new.options)?,
        ":file_name": new.file_name,
        ":labels": to_json(&new.labels)?,
        ":webhook": new.webhook.as_ref().map(to_json).transpose()?,
        ":input": to_json(&new.input)?,
        ":input_sha256": new.input.sha256,
        ":material": new.material.as_ref().map(to_json).transpose()?,
        ":lane": number_of(new.lane),
        ":created_at": now,
        ":cancel_at": new.cancel_after.map(|patience| later(now, patience)),
        ":keep_for": later(0, new.keep_for),
        ":key": new.key.as_ref().map(|key| &key.key),
        ":fingerprint": new.key.as_ref().map(|key| key.fingerprint),
        ":trace": new.trace.as_ref().map(ToString::to_string),
        ":tenant": new.tenant.name(),
    })?;
    let mut statement = connection.prepare_cached("INSERT INTO labels VALUES (?1, ?2, ?3)")?;
    for (name, value) in &new.labels {
        statement.execute(params![id, name, value])?;
    }
    keeping::name(connection, new.id, new.blobs())
}

/// Notes the state that a job has come into.
fn change(connection: &Connection, id: JobId, now: i64) -> Result<(), StoreError> {
    let mut statement = connection.prepare_cached(
        "INSERT INTO changes (job, number, state, epoch, at)
         SELECT id, 1 + (SELECT coalesce(max(number), 0) FROM changes WHERE job = ?1), state, epoch, ?2
         FROM jobs WHERE id = ?1",
    )?;
    statement.execute(params![id.to_string(), now])?;
    Ok(())
}

/// Ends a job, whatever its state, and puts its webhook into the outbox.
fn end(connection: &Connection, id: JobId, ending: &Ending, now: i64) -> Result<(), StoreError> {
    let mut statement = connection.prepare_cached(
        "UPDATE jobs SET state = :state, ending = :ending, engine = :engine, finished_at = :now,
             expires_at = min(:now + keep_for, :last), worker = NULL, lease_until = NULL, stop = NULL
         WHERE id = :id",
    )?;
    statement.execute(named_params! {
        ":id": id.to_string(),
        ":state": ending.state.word(),
        ":ending": to_json(ending)?,
        ":engine": ENGINE_VERSION,
        ":now": now,
        ":last": jiff::Timestamp::MAX.as_second() * 1000,
    })?;
    keeping::name(connection, id, ending.blobs())?;
    change(connection, id, now)?;
    outbox::post(connection, id, now)
}

pub(super) fn claim(
    connection: &Connection,
    request: &ClaimRequest,
    lease_now: i64,
    now: i64,
) -> Result<Option<JobRow>, StoreError> {
    loop {
        let Some(id) = tenants::next_job(connection, request)? else { return Ok(None) };
        connection
            .prepare_cached(
                "UPDATE jobs SET state = 'running', epoch = epoch + 1, worker = ?2, lease_until = ?3, started_at = ?4,
                     is_quick = ?5
                 WHERE id = ?1",
            )?
            .execute(params![id.to_string(), request.worker, later(lease_now, request.lease), now, request.is_only])?;
        change(connection, id, now)?;
        match get(connection, id, now) {
            Ok(row) => return Ok(Some(row)),
            // A row that an older program wrote and this one cannot read must not stand in the way of the others.
            Err(StoreError::Unavailable(error)) => {
                tracing::error!(job = %id, error, "a row cannot be read");
                let problem = Problem::new(ProblemCode::Internal, "the job cannot be read by this version");
                end(connection, id, &Ending::without_files(JobState::Failed, Some(problem)), now)?;
            }
            Err(error) => return Err(error),
        }
    }
}

pub(super) fn renew(
    connection: &Connection,
    claim: ClaimRef,
    lease: Duration,
    lease_now: i64,
) -> Result<bool, StoreError> {
    let mut statement = connection.prepare_cached(
        "UPDATE jobs SET lease_until = ?3 WHERE id = ?1 AND epoch = ?2 AND state = 'running'
         RETURNING stop IS NOT NULL",
    )?;
    let renewed = statement
        .query_row(params![claim.id.to_string(), claim.epoch, later(lease_now, lease)], |row| row.get(0))
        .optional()?;
    renewed.ok_or(StoreError::ClaimVoid)
}

/// [`StoreError::ClaimVoid`] unless the job runs by this claim.
fn check(connection: &Connection, claim: ClaimRef) -> Result<(), StoreError> {
    let mut statement =
        connection.prepare_cached("SELECT 1 FROM jobs WHERE id = ?1 AND epoch = ?2 AND state = 'running'")?;
    let is_current = statement.exists(params![claim.id.to_string(), claim.epoch])?;
    if is_current { Ok(()) } else { Err(StoreError::ClaimVoid) }
}

pub(super) fn finish(
    connection: &Connection,
    claim: ClaimRef,
    ending: &Ending,
    now: i64,
) -> Result<(), StoreError> {
    check(connection, claim)?;
    end(connection, claim.id, ending, now)
}

pub(super) fn release(connection: &Connection, claim: ClaimRef, now: i64) -> Result<AfterLoss, StoreError> {
    check(connection, claim)?;
    give_back(connection, claim.id, now)
}

/// A running job is queued again, unless it was to be cancelled.
fn give_back(connection: &Connection, id: JobId, now: i64) -> Result<AfterLoss, StoreError> {
    let mut statement = connection.prepare_cached("SELECT stop FROM jobs WHERE id = ?1")?;
    let stop: Option<String> = statement.query_row([id.to_string()], |row| row.get(0))?;
    if let Some(ending) = stop.and_then(|text| serde_json::from_str(&text).ok()) {
        end(connection, id, &ending, now)?;
        return Ok(AfterLoss::Ended);
    }
    connection
        .prepare_cached(
            "UPDATE jobs SET state = 'queued', worker = NULL, lease_until = NULL, stop = NULL WHERE id = ?1",
        )?
        .execute([id.to_string()])?;
    change(connection, id, now)?;
    Ok(AfterLoss::Queued)
}

pub(super) fn demote(
    connection: &Connection,
    claim: ClaimRef,
    is_outgrown: bool,
    now: i64,
) -> Result<AfterLoss, StoreError> {
    check(connection, claim)?;
    connection
        .prepare_cached("UPDATE jobs SET lane = ?2, is_outgrown = max(is_outgrown, ?3) WHERE id = ?1")?
        .execute(params![claim.id.to_string(), number_of(Lane::Bulk), is_outgrown])?;
    give_back(connection, claim.id, now)
}

pub(super) fn lose(
    connection: &Connection,
    claim: ClaimRef,
    problem: Problem,
    attempts_max: u32,
    now: i64,
) -> Result<AfterLoss, StoreError> {
    check(connection, claim)?;
    let mut statement = connection
        .prepare_cached("UPDATE jobs SET attempts = attempts + 1 WHERE id = ?1 RETURNING attempts")?;
    let attempts: u32 = statement.query_row([claim.id.to_string()], |row| row.get(0))?;
    if attempts < attempts_max {
        return give_back(connection, claim.id, now);
    }
    end(connection, claim.id, &Ending::without_files(JobState::Failed, Some(problem)), now)?;
    Ok(AfterLoss::Ended)
}

/// Ends the leases that an earlier process gave out: they were counted by its clock.
pub(super) fn end_leases(connection: &Connection) -> rusqlite::Result<()> {
    connection.execute("UPDATE jobs SET lease_until = ?1 WHERE state = 'running'", [i64::MIN]).map(drop)
}

pub(super) fn recover(
    connection: &Connection,
    leases: &Leases,
    lease_now: i64,
    problem: &Problem,
    attempts_max: u32,
    now: i64,
) -> Result<Vec<(JobId, AfterLoss)>, StoreError> {
    let (until, worker) = match leases {
        Leases::Expired => (lease_now, None),
        Leases::OfWorker(name) => (i64::MAX, Some(name)),
    };
    let mut statement = connection.prepare_cached(
        "SELECT id, epoch FROM jobs INDEXED BY jobs_running
         WHERE state = 'running' AND lease_until <= ?1 AND (?2 IS NULL OR worker = ?2) ORDER BY id",
    )?;
    let claims = statement
        .query_map(params![until, worker], |row| Ok(ClaimRef { id: parsed(row, 0)?, epoch: row.get(1)? }))?
        .collect::<rusqlite::Result<Vec<_>>>()?;
    claims
        .into_iter()
        .map(|claim| Ok((claim.id, lose(connection, claim, problem.clone(), attempts_max, now)?)))
        .collect()
}

pub(super) fn end_queued(
    connection: &Connection,
    id: JobId,
    ending: &Ending,
    now: i64,
) -> Result<bool, StoreError> {
    let is_queued = state_of(connection, id)? == JobState::Queued;
    if is_queued {
        end(connection, id, ending, now)?;
    }
    Ok(is_queued)
}

pub(super) fn cancel(
    connection: &Connection,
    id: JobId,
    ending: &Ending,
    now: i64,
) -> Result<bool, StoreError> {
    match state_of(connection, id)? {
        JobState::Queued => end(connection, id, ending, now).map(|()| true),
        JobState::Running => {
            connection
                .prepare_cached("UPDATE jobs SET stop = ?2 WHERE id = ?1")?
                .execute(params![id.to_string(), to_json(ending)?])?;
            Ok(false)
        }
        _ => Ok(false),
    }
}

fn state_of(connection: &Connection, id: JobId) -> Result<JobState, StoreError> {
    let mut statement = connection.prepare_cached("SELECT state FROM jobs WHERE id = ?1")?;
    Ok(statement.query_row([id.to_string()], |row| state(row, 0))?)
}
