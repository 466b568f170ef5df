//! Jobs are taken by workers, and taken back from those that are not heard of.

use std::collections::HashSet;

use super::*;
use crate::jobs::{AfterLoss, Leases};

pub(super) async fn nothing_is_claimed_when_nothing_waits<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    assert!(claim(&*store).await.is_none());
    running(&*store, job()).await;
    succeeded(&*store, job()).await;
    assert!(claim(&*store).await.is_none());
}

pub(super) async fn jobs_are_claimed_in_the_order_they_came<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let mut came = Vec::new();
    for _ in 0..5 {
        came.push(admit(&*store, job()).await.id);
        house.advance_ms(1).await;
    }
    let mut claimed = Vec::new();
    while let Some(row) = claim(&*store).await {
        assert_eq!((row.state, row.epoch), (JobState::Running, 1));
        assert!(row.started_at >= Some(row.created_at));
        claimed.push(row.id);
    }
    assert_eq!(claimed, came);
}

pub(super) async fn a_preferred_lane_comes_first_and_the_other_one_is_not_left<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let mut ids = Vec::new();
    for lane in [Lane::Bulk, Lane::Interactive, Lane::Bulk, Lane::Interactive] {
        ids.push(admit(&*store, NewJob { lane, ..job() }).await.id);
    }
    let ask = async |prefer, is_only| {
        let request = ClaimRequest {
            worker: "w".to_owned(),
            lease: LEASE,
            prefer,
            is_only,
            share: 1,
            is_share_of_worker: false,
        };
        store.claim(request).await.unwrap().map(|row| row.id)
    };
    let claim = async |prefer| ask(prefer, false).await;
    assert_eq!(claim(Lane::Interactive).await, Some(ids[1]));
    assert_eq!(claim(Lane::Bulk).await, Some(ids[0]));
    assert_eq!(claim(Lane::Interactive).await, Some(ids[3]));
    assert_eq!(ask(Lane::Interactive, true).await, None, "unless only one of them will do");
    assert_eq!(claim(Lane::Interactive).await, Some(ids[2]), "rather the other lane than none");
}

pub(super) async fn many_workers_claim_each_job_once<H: StoreHouse>() {
    let house = H::open().await;
    for _ in 0..40 {
        admit(&*house.store(), job()).await;
    }
    let workers = (0..8).map(|_| {
        let store = house.store();
        tokio::spawn(async move {
            let mut claimed = Vec::new();
            while let Some(row) = claim(&*store).await {
                claimed.push(row.id);
                tokio::task::yield_now().await;
            }
            claimed
        })
    });
    let mut claimed = Vec::new();
    for worker in workers.collect::<Vec<_>>() {
        claimed.extend(worker.await.unwrap());
    }
    assert_eq!((claimed.len(), claimed.iter().collect::<HashSet<_>>().len()), (40, 40));
}

pub(super) async fn each_claim_has_a_larger_epoch<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    admit(&*store, job()).await;
    for epoch in 1..=4 {
        let row = claim(&*store).await.unwrap();
        assert_eq!(row.epoch, epoch);
        assert_eq!(store.release(row.claim()).await, Ok(AfterLoss::Queued));
    }
}

pub(super) async fn a_claim_that_is_not_renewed_is_taken_back_after_its_lease<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    house.advance_ms(29_999).await;
    assert!(recover(&*store, Leases::Expired).await.is_empty());
    house.advance_ms(2).await;
    assert_eq!(recover(&*store, Leases::Expired).await, [(row.id, AfterLoss::Queued)]);
    let again = claim(&*store).await.unwrap();
    assert_eq!((again.id, again.epoch, again.attempts), (row.id, 2, 1));
}

pub(super) async fn a_renewed_claim_is_kept<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    for _ in 0..5 {
        house.advance_ms(20_000).await;
        assert_eq!(store.renew(row.claim(), LEASE).await, Ok(false));
        assert!(recover(&*store, Leases::Expired).await.is_empty());
    }
    house.advance_ms(AFTER_LEASE_MS).await;
    assert_eq!(recover(&*store, Leases::Expired).await.len(), 1);
}

pub(super) async fn a_void_claim_cannot_be_renewed<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    house.advance_ms(AFTER_LEASE_MS).await;
    recover(&*store, Leases::Expired).await;
    assert_eq!(store.renew(row.claim(), LEASE).await, Err(StoreError::ClaimVoid));
    let again = claim(&*store).await.unwrap();
    assert_eq!(store.renew(row.claim(), LEASE).await, Err(StoreError::ClaimVoid));
    assert_eq!(store.renew(again.claim(), LEASE).await, Ok(false));
    store.delete(row.id).await.unwrap();
    assert_eq!(store.renew(again.claim(), LEASE).await, Err(StoreError::ClaimVoid));
}

pub(super) async fn a_lost_job_runs_before_later_ones<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let lost = running(&*store, job()).await;
    admit(&*store, job()).await;
    house.advance_ms(AFTER_LEASE_MS).await;
    recover(&*store, Leases::Expired).await;
    assert_eq!(claim(&*store).await.unwrap().id, lost.id);
}

pub(super) async fn a_job_that_is_lost_too_often_fails_with_the_problem<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let id = admit(&*store, job()).await.id;
    for attempt in 1..=ATTEMPTS_MAX {
        claim(&*store).await.unwrap();
        house.advance_ms(AFTER_LEASE_MS).await;
        let after = recover(&*store, Leases::Expired).await;
        let expected = if attempt < ATTEMPTS_MAX { AfterLoss::Queued } else { AfterLoss::Ended };
        assert_eq!(after, [(id, expected)]);
    }
    let row = store.get(id).await.unwrap();
    assert_eq!((row.state, row.attempts), (JobState::Failed, ATTEMPTS_MAX));
    assert_eq!(row.ending.unwrap().problem.unwrap().code, ProblemCode::WorkerLost);
    assert!(claim(&*store).await.is_none());
}

pub(super) async fn every_claim_of_a_worker_that_starts_anew_is_void_and_no_other<H: StoreHouse>() {
    let house = H::open().await;
    let first = running(&*house.store(), job()).await;
    let second = running(&*house.store(), job()).await;
    let other = Leases::OfWorker("another".to_owned());
    assert!(recover(&*house.store(), other).await.is_empty());
    let house = house.reopen().await;
    let store = house.store();
    let after = recover(&*store, Leases::OfWorker("w".to_owned())).await;
    assert_eq!(after, [(first.id, AfterLoss::Queued), (second.id, AfterLoss::Queued)]);
    assert_eq!(store.finish(first.claim(), success(&first)).await, VOID);
    let again = claim(&*store).await.unwrap();
    assert_eq!((again.id, again.attempts), (first.id, 1), "no lease was waited for");
}

pub(super) async fn a_job_that_is_given_back_counts_no_attempt<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    assert_eq!(store.release(row.claim()).await, Ok(AfterLoss::Queued));
    assert_eq!(store.release(row.claim()).await, Err(StoreError::ClaimVoid), "only once");
    let again = claim(&*store).await.unwrap();
    assert_eq!((again.id, again.attempts, again.epoch), (row.id, 0, 2));
}

pub(super) async fn a_crash_counts_an_attempt_and_ends_with_its_own_problem<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let id = admit(&*store, job()).await.id;
    for attempt in 1..=2 {
        let row = claim(&*store).await.unwrap();
        let crash = problem(ProblemCode::EngineCrashed);
        let after = store.lose(row.claim(), crash.clone(), 2).await.unwrap();
        assert_eq!(after, if attempt < 2 { AfterLoss::Queued } else { AfterLoss::Ended });
        assert_eq!(store.lose(row.claim(), crash, 2).await, Err(StoreError::ClaimVoid));
    }
    let row = store.get(id).await.unwrap();
    assert_eq!(row.ending.unwrap().problem.unwrap().code, ProblemCode::EngineCrashed);
}

pub(super) async fn a_paused_executor_is_fenced_and_one_result_is_seen<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let paused = running(&*store, job()).await;
    house.advance_ms(AFTER_LEASE_MS).await;
    recover(&*store, Leases::Expired).await;
    let other = claim(&*store).await.unwrap();
    assert_eq!(store.finish(paused.claim(), success(&paused)).await, VOID, "it wakes too late");
    assert_eq!(store.release(paused.claim()).await, Err(StoreError::ClaimVoid));
    store.finish(other.claim(), success(&other)).await.unwrap();
    assert_eq!(store.finish(paused.claim(), success(&paused)).await, VOID);
    let row = store.get(paused.id).await.unwrap();
    assert_eq!(row.ending.unwrap().report, Some(blob(&other, "report.json")));
    assert!(store.named(vec![blob(&paused, "report.json").key]).await.unwrap().is_empty());
}

pub(super) async fn a_clock_that_is_set_back_takes_no_claim<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    house.advance_ms(-3_600_000).await;
    assert!(recover(&*store, Leases::Expired).await.is_empty());
    assert_eq!(store.renew(row.claim(), LEASE).await, Ok(false));
    house.advance_ms(3_600_000).await;
    assert_eq!(recover(&*store, Leases::Expired).await.len(), 1, "the lease counts from its renewal");
}

pub(super) async fn a_job_that_is_lost_again_and_again_is_not_starved_and_starves_nobody<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let poison = admit(&*store, job()).await.id;
    let mut others = Vec::new();
    for _ in 0..3 {
        others.push(admit(&*store, job()).await.id);
    }
    let mut order = Vec::new();
    while let Some(row) = claim(&*store).await {
        order.push(row.id);
        if row.id == poison {
            store.lose(row.claim(), problem(ProblemCode::WorkerLost), ATTEMPTS_MAX).await.unwrap();
        } else {
            store.finish(row.claim(), success(&row)).await.unwrap();
        }
    }
    assert_eq!(order[..3], [poison; 3]);
    assert_eq!(order[3..], others);
}
