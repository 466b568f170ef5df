//! What every store must keep: one list of cases, run against each kind of store.

mod admitting;
mod claiming;
mod delivering;
mod ending;
mod finding;
mod keeping;
mod postgres;
mod sharing;
mod sqlite;
mod uploading;

pub(super) use postgres::Database;

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use crate::jobs::{
    BlobRef, ClaimRequest, Created, Ending, IdempotencyKey, JobId, JobRow, JobStore, Lane, NewJob, ResultRef,
    StoreError, Tenant, Webhook,
};
use crate::wire::{Encoding, JobState, Labels, Operation, Options, Outcome, Problem, ProblemCode, Progress};

/// A store to be tried, and the clock that it goes by.
pub(super) trait StoreHouse: Sized {
    /// Why such a store cannot be tried on this machine, if it cannot.
    fn missing() -> Option<&'static str> {
        None
    }
    /// An empty store.
    async fn open() -> Self;
    /// The store.
    fn store(&self) -> Arc<dyn JobStore>;
    /// Moves the store's clock by milliseconds, also back.
    async fn advance_ms(&self, by: i64);
    /// Closes the store and opens it again.
    async fn reopen(self) -> Self;
}

/// The lease of claims in cases.
const LEASE: Duration = Duration::from_secs(30);
/// A moment after the lease.
const AFTER_LEASE_MS: i64 = 30_001;
/// Lost runs after which a job fails, in cases.
const ATTEMPTS_MAX: u32 = 3;

/// Says on the terminal that a test is left out.
pub(super) fn leave_out(missing: &str) {
    use std::io::Write as _;
    // Not the output that a test which passes keeps to itself.
    let _ = writeln!(std::io::stderr(), "not run: {missing} is not installed");
}

/// Makes a test of each case.
macro_rules! cases {
    ($house:ty: $($group:ident { $($case:ident,)+ })+) => { $(
        mod $group {
            use super::*;
            $(#[tokio::test]
            async fn $case() {
                match <$house>::missing() {
                    None => super::super::$group::$case::<$house>().await,
                    Some(what) => super::super::leave_out(what),
                }
            })+
        }
    )+ };
}

/// Makes the tests of a store out of all cases.
macro_rules! contract {
    ($house:ty) => {
        cases! { $house:
            admitting {
                a_job_is_read_back_as_it_was_admitted,
                an_unknown_job_is_not_found,
                a_full_queue_refuses_and_only_waiting_jobs_count,
                a_job_whose_source_is_gone_or_expired_is_refused,
                an_answered_job_is_admitted_to_a_full_queue_and_has_ended,
                the_same_key_and_request_give_the_same_job,
                the_same_key_with_another_request_is_refused,
                sixty_four_creators_with_one_key_make_one_job,
                keys_of_two_owners_do_not_meet,
                a_known_key_is_answered_although_the_queue_is_full,
                a_key_is_free_again_once_its_job_is_deleted,
                a_key_outlasts_the_process,
            }
            claiming {
                nothing_is_claimed_when_nothing_waits,
                jobs_are_claimed_in_the_order_they_came,
                a_preferred_lane_comes_first_and_the_other_one_is_not_left,
                many_workers_claim_each_job_once,
                each_claim_has_a_larger_epoch,
                a_claim_that_is_not_renewed_is_taken_back_after_its_lease,
                a_renewed_claim_is_kept,
                a_void_claim_cannot_be_renewed,
                a_lost_job_runs_before_later_ones,
                a_job_that_is_lost_too_often_fails_with_the_problem,
                every_claim_of_a_worker_that_starts_anew_is_void_and_no_other,
                a_job_that_is_given_back_counts_no_attempt,
                a_crash_counts_an_attempt_and_ends_with_its_own_problem,
                a_paused_executor_is_fenced_and_one_result_is_seen,
                a_clock_that_is_set_back_takes_no_claim,
                a_job_that_is_lost_again_and_again_is_not_starved_and_starves_nobody,
            }
            ending {
                only_the_latest_claim_may_end_a_job,
                a_job_ends_once,
                a_job_that_waits_is_not_ended_by_an_old_claim,
                a_queued_job_is_cancelled_at_once,
                a_running_job_hears_of_its_cancellation_when_it_renews,
                a_cancelled_job_whose_run_is_lost_does_not_run_again,
                a_cancelled_job_that_is_given_back_has_ended,
                an_ended_job_is_not_cancelled,
                only_a_queued_job_is_ended_as_one,
                a_deadline_is_kept_as_a_time,
                every_change_is_noted_once_in_order,
                an_ending_is_read_back_as_it_was_told,
            }
            keeping {
                an_ended_job_is_due_after_its_time,
                an_expired_job_keeps_its_row_and_loses_its_files,
                a_running_job_does_not_expire,
                a_file_that_two_jobs_name_goes_with_the_second,
                a_deleted_job_is_gone_whatever_its_state,
                the_job_that_ended_first_is_the_oldest,
                files_are_known_by_their_names_and_runs_by_their_claims,
                everything_outlasts_the_process,
                a_result_that_is_stored_is_seen_by_the_next_process_once,
            }
            finding {
                an_equal_job_is_found_by_its_bytes_and_options,
                an_equal_job_of_another_owner_is_not_found,
                only_the_latest_jobs_with_the_same_bytes_are_looked_at,
                what_failed_or_has_expired_answers_nothing,
                jobs_are_listed_the_latest_first_page_by_page,
                jobs_are_listed_for_their_owner_only,
                jobs_are_listed_by_state_and_labels,
                counts_follow_the_jobs,
                who_waits_for_jobs_is_told_which_have_ended_or_are_gone,
            }
            sharing {
                tenants_are_served_in_turn_and_those_with_fewer_running_jobs_first,
                no_tenant_has_more_running_jobs_than_its_share_in_slots_of_a_kind,
                a_tenant_has_as_many_places_in_the_queue_as_are_free,
                nobody_loses_what_is_within_its_share,
                a_job_whose_webhook_is_still_to_be_sent_goes_last,
                what_a_tenant_has_follows_its_jobs,
                a_job_that_is_larger_than_was_thought_waits_among_the_large_ones,
                plain_secrets_are_sealed_once,
            }
            uploading {
                an_upload_is_read_back_as_it_was_made_and_outlasts_the_process,
                a_piece_goes_on_where_the_upload_stands_and_nowhere_else,
                of_many_pieces_at_one_offset_one_is_appended,
                an_upload_is_due_a_while_after_its_last_piece,
                a_job_takes_an_upload_once_and_takes_it_along_when_it_goes,
                uploads_are_as_many_as_may_be_and_count_for_their_tenant,
            }
            delivering {
                a_delivery_is_made_with_every_kind_of_end,
                a_job_without_a_webhook_makes_no_delivery,
                a_delivery_is_claimed_once_until_its_lease_is_over,
                many_senders_claim_each_delivery_once,
                no_receiver_gets_more_than_its_share,
                a_try_is_noted_and_the_next_one_waits,
                a_delivered_or_given_up_delivery_is_not_sent_again,
                a_delivery_is_sent_again_on_request_under_its_id,
                the_try_of_an_old_claim_does_not_count,
                deliveries_go_with_their_job,
                deliveries_outlast_the_process,
            }
        }
    };
}
use {cases, contract};

/// A job that nobody has seen before.
fn job() -> NewJob {
    static NUMBER: AtomicU32 = AtomicU32::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let mut sha256 = [0; 32];
    sha256[..4].copy_from_slice(&number.to_le_bytes());
    NewJob {
        id: JobId::unique(),
        operation: Operation::Repair,
        options: Options::default(),
        file_name: None,
        owner: None,
        tenant: Tenant::nobody(),
        trace: None,
        labels: Labels::new(),
        webhook: None,
        input: BlobRef { key: format!("in/{number}"), bytes: 5, sha256, files: Vec::new() },
        material: None,
        lane: Lane::Interactive,
        cancel_after: None,
        keep_for: Duration::from_secs(3600),
        key: None,
        source: None,
        taken: None,
        ending: None,
    }
}

fn webhook() -> Option<Webhook> {
    Some(Webhook { url: "https://shop.example/done".to_owned(), secret: None })
}

fn key(key: &str, asked: u8) -> Option<IdempotencyKey> {
    Some(IdempotencyKey { key: key.to_owned(), fingerprint: [asked; 32] })
}

/// Admits a job to a queue with room.
async fn admit(store: &dyn JobStore, job: NewJob) -> JobRow {
    match store.create(job, 1000).await.unwrap() {
        Created::New(row) => row,
        Created::Known(row) => panic!("known already: {row:?}"),
    }
}

async fn claim(store: &dyn JobStore) -> Option<JobRow> {
    claim_of_many(store, 1).await
}

/// A claim where one tenant may have so many running jobs.
async fn claim_of_many(store: &dyn JobStore, share: usize) -> Option<JobRow> {
    let request = ClaimRequest {
        worker: "w".to_owned(),
        lease: LEASE,
        prefer: Lane::Interactive,
        is_only: false,
        share,
        is_share_of_worker: false,
    };
    store.claim(request).await.unwrap()
}

/// A job that runs.
async fn running(store: &dyn JobStore, job: NewJob) -> JobRow {
    let id = admit(store, job).await.id;
    let row = claim_of_many(store, 64).await.unwrap();
    assert_eq!(row.id, id, "nothing else waits");
    row
}

/// A job that has succeeded.
async fn succeeded(store: &dyn JobStore, job: NewJob) -> JobRow {
    let row = running(store, job).await;
    store.finish(row.claim(), success(&row)).await.unwrap();
    store.get(row.id).await.unwrap()
}

fn blob(row: &JobRow, name: &str) -> BlobRef {
    BlobRef {
        key: format!("out/{}.{}.{name}", row.id, row.epoch),
        bytes: 7,
        sha256: [7; 32],
        files: Vec::new(),
    }
}

fn success(row: &JobRow) -> Ending {
    Ending {
        outcome: Some(Outcome::Repaired),
        progress: Progress { stage: None, fraction: 1.0 },
        report: Some(blob(row, "report.json")),
        result: Some(ResultRef { blob: blob(row, "mesh-0"), encoding: Encoding::StlBinary }),
        ..Ending::without_files(JobState::Succeeded, None)
    }
}

fn problem(code: ProblemCode) -> Problem {
    Problem::new(code, "it went wrong")
}

fn failure() -> Ending {
    Ending::without_files(JobState::Failed, Some(problem(ProblemCode::MeshEmpty)))
}

fn cancelled() -> Ending {
    Ending::without_files(JobState::Cancelled, Some(problem(ProblemCode::Cancelled)))
}

/// Takes void claims back, as a sweep does.
async fn recover(store: &dyn JobStore, leases: crate::jobs::Leases) -> Vec<(JobId, crate::jobs::AfterLoss)> {
    store.recover(leases, problem(ProblemCode::WorkerLost), ATTEMPTS_MAX).await.unwrap()
}

async fn state(store: &dyn JobStore, id: JobId) -> JobState {
    store.get(id).await.unwrap().state
}

fn keys(blobs: &[BlobRef]) -> Vec<&str> {
    let mut keys: Vec<_> = blobs.iter().map(|blob| blob.key.as_str()).collect();
    keys.sort_unstable();
    keys
}

const VOID: Result<(), StoreError> = Err(StoreError::ClaimVoid);
