//! What is kept, and how it goes.

use std::collections::HashSet;

use super::*;
use crate::jobs::{ClaimRef, EndedJobs, Leases, Tenant};

pub(super) async fn an_ended_job_is_due_after_its_time<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let short = succeeded(&*store, NewJob { keep_for: Duration::from_secs(60), ..job() }).await.id;
    succeeded(&*store, job()).await;
    admit(&*store, NewJob { keep_for: Duration::ZERO, ..job() }).await;
    house.advance_ms(59_999).await;
    assert!(store.due().await.unwrap().is_empty());
    house.advance_ms(1).await;
    assert_eq!(store.due().await.unwrap(), [short]);
    assert!(store.get(short).await.unwrap().is_due);
    store.expire(short).await.unwrap();
    assert!(store.due().await.unwrap().is_empty());
    assert!(!store.get(short).await.unwrap().is_due, "it has expired");
}

pub(super) async fn an_expired_job_keeps_its_row_and_loses_its_files<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = succeeded(&*store, job()).await;
    let orphans = store.expire(row.id).await.unwrap();
    let (report, mesh) = (blob(&row, "report.json"), blob(&row, "mesh-0"));
    assert_eq!(keys(&orphans), keys(&[row.input.clone(), report.clone(), mesh]));
    assert_eq!(orphans.iter().map(|blob| blob.bytes).sum::<u64>(), 5 + 7 + 7);
    let row = store.get(row.id).await.unwrap();
    assert_eq!((row.state, row.ending.unwrap().outcome), (JobState::Expired, Some(Outcome::Repaired)));
    assert!(store.expire(row.id).await.unwrap().is_empty(), "only once");
    assert!(store.named(vec![report.key]).await.unwrap().is_empty());
}

pub(super) async fn a_running_job_does_not_expire<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    let queued = admit(&*store, job()).await;
    for id in [row.id, queued.id] {
        assert!(store.expire(id).await.unwrap().is_empty());
    }
    assert_eq!(state(&*store, row.id).await, JobState::Running);
    assert_eq!(store.first_to_go(EndedJobs::Any, Tenant::nobody()).await.unwrap(), None);
}

pub(super) async fn a_file_that_two_jobs_name_goes_with_the_second<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let first = succeeded(&*store, job()).await;
    let again = NewJob { input: first.input.clone(), source: Some(first.id), ..job() };
    let second = admit(&*store, again).await;
    let orphans = store.delete(first.id).await.unwrap();
    assert!(!keys(&orphans).contains(&first.input.key.as_str()));
    assert_eq!(store.delete(second.id).await.unwrap(), [first.input]);
}

pub(super) async fn a_deleted_job_is_gone_whatever_its_state<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let labels = Labels::from([("a".to_owned(), "b".to_owned())]);
    let ended = succeeded(&*store, NewJob { labels: labels.clone(), webhook: webhook(), ..job() }).await;
    let running = running(&*store, NewJob { labels, ..job() }).await;
    let queued = admit(&*store, job()).await;
    for id in [ended.id, running.id, queued.id] {
        assert!(!store.delete(id).await.unwrap().is_empty());
        assert_eq!(store.get(id).await.unwrap_err(), StoreError::NotFound);
        assert_eq!(store.delete(id).await.unwrap_err(), StoreError::NotFound);
        assert!(store.changes(id, 0).await.unwrap().is_empty());
    }
    assert_eq!(store.finish(running.claim(), success(&running)).await, VOID);
    assert_eq!(store.counts().await.unwrap(), crate::jobs::JobCounts::default());
}

pub(super) async fn the_job_that_ended_first_is_the_oldest<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let (a, b) = (running(&*store, job()).await, running(&*store, job()).await);
    store.finish(b.claim(), success(&b)).await.unwrap();
    house.advance_ms(1).await;
    store.finish(a.claim(), success(&a)).await.unwrap();
    assert_eq!(store.first_to_go(EndedJobs::WithFiles, Tenant::nobody()).await.unwrap(), Some(b.id));
    store.expire(b.id).await.unwrap();
    assert_eq!(store.first_to_go(EndedJobs::WithFiles, Tenant::nobody()).await.unwrap(), Some(a.id));
    assert_eq!(store.first_to_go(EndedJobs::Any, Tenant::nobody()).await.unwrap(), Some(b.id));
}

pub(super) async fn files_are_known_by_their_names_and_runs_by_their_claims<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let ended = succeeded(&*store, job()).await;
    let running = running(&*store, job()).await;
    let old = ClaimRef { epoch: 0, ..running.claim() };
    let asked = vec![ended.claim(), running.claim(), old, ClaimRef { id: JobId::unique(), epoch: 1 }];
    assert_eq!(store.current(asked).await.unwrap(), HashSet::from([running.claim()]));
    let (report, input) = (blob(&ended, "report.json").key, running.input.key.clone());
    let asked = vec![report.clone(), input.clone(), "in/nobody's".to_owned()];
    assert_eq!(store.named(asked).await.unwrap(), HashSet::from([report, input]));
}

pub(super) async fn everything_outlasts_the_process<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let ended = succeeded(&*store, NewJob { webhook: webhook(), ..job() }).await;
    let running = running(&*store, job()).await;
    let queued = admit(&*store, job()).await;
    drop(store);
    let house = house.reopen().await;
    let store = house.store();
    for (row, expected) in
        [(&ended, JobState::Succeeded), (&running, JobState::Running), (&queued, JobState::Queued)]
    {
        assert_eq!(state(&*store, row.id).await, expected);
        assert!(store.named(vec![row.input.key.clone()]).await.unwrap().contains(&row.input.key));
    }
    assert_eq!(store.deliveries(ended.id).await.unwrap().len(), 1);
    let counts = store.counts().await.unwrap();
    assert_eq!((counts.queued, counts.running, counts.all), (1, 1, 3));
}

pub(super) async fn a_result_that_is_stored_is_seen_by_the_next_process_once<H: StoreHouse>() {
    let house = H::open().await;
    let row = succeeded(&*house.store(), job()).await;
    let house = house.reopen().await;
    let store = house.store();
    assert!(
        recover(&*store, Leases::OfWorker("w".to_owned())).await.is_empty(),
        "an ended job is not run again"
    );
    assert!(claim(&*store).await.is_none());
    let finals = store.changes(row.id, 0).await.unwrap().into_iter().filter(|change| change.state.is_final());
    assert_eq!(finals.count(), 1);
}
