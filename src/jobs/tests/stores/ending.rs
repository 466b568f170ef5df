//! Jobs end, once.

use super::*;
use crate::jobs::{AfterLoss, ClaimRef, Leases};
use crate::wire::{Stage, TimingMs};

pub(super) async fn only_the_latest_claim_may_end_a_job<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    for epoch in [0, 2, u32::MAX] {
        assert_eq!(store.finish(ClaimRef { id: row.id, epoch }, success(&row)).await, VOID);
    }
    store.finish(row.claim(), success(&row)).await.unwrap();
    assert_eq!(state(&*store, row.id).await, JobState::Succeeded);
}

pub(super) async fn a_job_ends_once<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = succeeded(&*store, job()).await;
    assert_eq!(store.finish(row.claim(), failure()).await, VOID);
    assert_eq!(
        store.lose(row.claim(), problem(ProblemCode::WorkerLost), 1).await,
        Err(StoreError::ClaimVoid)
    );
    assert_eq!(state(&*store, row.id).await, JobState::Succeeded);
}

pub(super) async fn a_job_that_waits_is_not_ended_by_an_old_claim<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    store.release(row.claim()).await.unwrap();
    assert_eq!(store.finish(row.claim(), success(&row)).await, VOID);
    assert_eq!(state(&*store, row.id).await, JobState::Queued);
}

pub(super) async fn a_queued_job_is_cancelled_at_once<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let id = admit(&*store, job()).await.id;
    assert_eq!(store.cancel(id, cancelled()).await, Ok(true));
    assert_eq!(state(&*store, id).await, JobState::Cancelled);
    assert!(claim(&*store).await.is_none());
}

pub(super) async fn a_running_job_hears_of_its_cancellation_when_it_renews<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    assert_eq!(store.renew(row.claim(), LEASE).await, Ok(false));
    assert_eq!(store.cancel(row.id, cancelled()).await, Ok(false));
    assert_eq!(state(&*store, row.id).await, JobState::Running);
    assert_eq!(store.renew(row.claim(), LEASE).await, Ok(true));
    store.finish(row.claim(), cancelled()).await.unwrap();
    assert_eq!(state(&*store, row.id).await, JobState::Cancelled);
}

pub(super) async fn a_cancelled_job_whose_run_is_lost_does_not_run_again<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    store.cancel(row.id, cancelled()).await.unwrap();
    assert_eq!(recover(&*store, Leases::OfWorker("w".to_owned())).await, [(row.id, AfterLoss::Ended)]);
    assert_eq!(state(&*store, row.id).await, JobState::Cancelled);
}

pub(super) async fn a_cancelled_job_that_is_given_back_has_ended<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    store.cancel(row.id, cancelled()).await.unwrap();
    assert_eq!(store.release(row.claim()).await, Ok(AfterLoss::Ended));
    assert_eq!(state(&*store, row.id).await, JobState::Cancelled);
}

pub(super) async fn an_ended_job_is_not_cancelled<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = succeeded(&*store, job()).await;
    assert_eq!(store.cancel(row.id, cancelled()).await, Ok(false));
    assert_eq!(state(&*store, row.id).await, JobState::Succeeded);
}

pub(super) async fn only_a_queued_job_is_ended_as_one<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let queued = admit(&*store, job()).await.id;
    assert_eq!(store.end_queued(queued, failure()).await, Ok(true));
    assert_eq!(store.end_queued(queued, failure()).await, Ok(false));
    let running = running(&*store, job()).await;
    assert_eq!(store.end_queued(running.id, failure()).await, Ok(false));
    assert_eq!(state(&*store, running.id).await, JobState::Running);
}

pub(super) async fn a_deadline_is_kept_as_a_time<H: StoreHouse>() {
    let house = H::open().await;
    let new = NewJob { cancel_after: Some(Duration::from_secs(60)), ..job() };
    let row = admit(&*house.store(), new).await;
    admit(&*house.store(), job()).await;
    house.advance_ms(10_000).await;
    let house = house.reopen().await;
    let store = house.store();
    assert_eq!(row.time_left, Some(Duration::from_secs(60)));
    assert_eq!(store.deadlines().await.unwrap(), [(row.id, Duration::from_secs(50))]);
    let claimed = claim(&*store).await.unwrap();
    assert_eq!(claimed.time_left, Some(Duration::from_secs(50)));
    assert!(store.deadlines().await.unwrap().is_empty(), "beside a run its claim is watched");
    store.release(claimed.claim()).await.unwrap();
    let far = NewJob { cancel_after: Some(Duration::MAX), keep_for: Duration::MAX, ..job() };
    let far = admit(&*store, far).await;
    assert!(far.time_left > row.time_left);
    store.end_queued(far.id, failure()).await.unwrap();
    let far = store.get(far.id).await.unwrap();
    assert!(far.expires_at > row.finished_at.or(Some(far.created_at)) && !far.is_due);
    house.advance_ms(100_000).await;
    assert_eq!(store.get(row.id).await.unwrap().time_left, Some(Duration::ZERO), "it is over");
}

pub(super) async fn every_change_is_noted_once_in_order<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    store.release(row.claim()).await.unwrap();
    let row = claim(&*store).await.unwrap();
    store.finish(row.claim(), success(&row)).await.unwrap();
    store.expire(row.id).await.unwrap();
    let changes = store.changes(row.id, 0).await.unwrap();
    let seen: Vec<_> = changes.iter().map(|change| (change.number, change.state, change.epoch)).collect();
    assert_eq!(
        seen,
        [
            (1, JobState::Queued, 0),
            (2, JobState::Running, 1),
            (3, JobState::Queued, 1),
            (4, JobState::Running, 2),
            (5, JobState::Succeeded, 2)
        ]
    );
    assert_eq!(store.changes(row.id, 3).await.unwrap(), changes[3..]);
    assert!(store.changes(row.id, 5).await.unwrap().is_empty());
}

pub(super) async fn an_ending_is_read_back_as_it_was_told<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    let told = Ending {
        timing_ms: Some(TimingMs { read: Some(0.1 + 0.2), total: 12.345, ..TimingMs::default() }),
        progress: Progress { stage: Some(Stage::Certify), fraction: 1.0 / 3.0 },
        problem: Some(problem(ProblemCode::NotRepairable).with_limit("queue_max", 1, Some(2))),
        levels: vec![ResultRef { blob: blob(&row, "mesh-1"), encoding: Encoding::Obj }],
        ..success(&row)
    };
    store.finish(row.claim(), told.clone()).await.unwrap();
    let house = house.reopen().await;
    let row = house.store().get(row.id).await.unwrap();
    let read = row.ending.unwrap();
    assert_eq!((read.state, read.progress, read.outcome), (told.state, told.progress, told.outcome));
    assert_eq!((read.problem, read.timing_ms), (told.problem, told.timing_ms));
    assert_eq!((read.report, read.result, read.levels), (told.report, told.result, told.levels));
    assert_eq!(
        row.expires_at.unwrap().as_millisecond(),
        row.finished_at.unwrap().as_millisecond() + 3_600_000
    );
}
