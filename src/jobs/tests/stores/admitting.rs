//! Jobs come in.

use super::*;
use crate::wire::InputRef;

pub(super) async fn a_job_is_read_back_as_it_was_admitted<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let source = succeeded(&*store, job()).await;
    let new = NewJob {
        operation: Operation::Simplify,
        options: Options {
            ratio: Some(0.1 + 0.2),
            input: Some(InputRef::Job(source.id.to_string())),
            ..Options::default()
        },
        file_name: Some("part \"ü\"\n\0.stl".to_owned()),
        owner: Some("shop".to_owned()),
        trace: crate::jobs::TraceParent::parse("00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"),
        labels: Labels::from([("order".to_owned(), "17\0".to_owned())]),
        webhook: webhook(),
        material: Some(BlobRef {
            key: "in/material".to_owned(),
            bytes: u64::MAX,
            sha256: [9; 32],
            files: Vec::new(),
        }),
        lane: Lane::Bulk,
        cancel_after: Some(Duration::from_millis(1500)),
        source: Some(source.id),
        ..job()
    };
    let row = admit(&*store, new.clone()).await;
    let read = store.get(new.id).await.unwrap();
    for row in [row, read] {
        assert_eq!((row.id, row.operation, &row.options), (new.id, new.operation, &new.options));
        assert_eq!((&row.file_name, &row.owner, &row.labels), (&new.file_name, &new.owner, &new.labels));
        assert!(row.trace.is_some() && row.trace == new.trace);
        assert_eq!((&row.webhook, &row.input, &row.material), (&new.webhook, &new.input, &new.material));
        assert_eq!((row.lane, row.state, row.epoch, row.attempts), (new.lane, JobState::Queued, 0, 0));
        assert_eq!(row.time_left, new.cancel_after);
        assert_eq!(
            (row.started_at, row.finished_at, row.expires_at, row.is_cached),
            (None, None, None, false)
        );
        assert!(row.ending.is_none());
    }
}

pub(super) async fn an_unknown_job_is_not_found<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let id = JobId::unique();
    assert_eq!(store.get(id).await.unwrap_err(), StoreError::NotFound);
    assert_eq!(store.cancel(id, cancelled()).await.unwrap_err(), StoreError::NotFound);
    assert_eq!(store.end_queued(id, failure()).await.unwrap_err(), StoreError::NotFound);
    assert_eq!(store.expire(id).await.unwrap_err(), StoreError::NotFound);
    assert_eq!(store.delete(id).await.unwrap_err(), StoreError::NotFound);
    assert!(store.changes(id, 0).await.unwrap().is_empty());
}

pub(super) async fn a_full_queue_refuses_and_only_waiting_jobs_count<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    running(&*store, job()).await;
    succeeded(&*store, job()).await;
    for _ in 0..2 {
        store.create(job(), 2).await.unwrap();
    }
    let refused = job();
    assert_eq!(store.create(refused.clone(), 2).await.unwrap_err(), StoreError::QueueFull { queued: 2 });
    assert_eq!(store.get(refused.id).await.unwrap_err(), StoreError::NotFound);
    assert!(store.named(vec![refused.input.key]).await.unwrap().is_empty());
    claim(&*store).await.unwrap();
    store.create(job(), 2).await.unwrap();
}

pub(super) async fn a_job_whose_source_is_gone_or_expired_is_refused<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let (gone, expired) = (succeeded(&*store, job()).await.id, succeeded(&*store, job()).await.id);
    store.delete(gone).await.unwrap();
    store.expire(expired).await.unwrap();
    for source in [gone, expired] {
        let new = NewJob { source: Some(source), ..job() };
        assert_eq!(store.create(new, 10).await.unwrap_err(), StoreError::NotFound);
    }
}

pub(super) async fn an_answered_job_is_admitted_to_a_full_queue_and_has_ended<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let first = succeeded(&*store, job()).await;
    admit(&*store, job()).await;
    let again =
        NewJob { input: first.input.clone(), source: Some(first.id), ending: first.ending.clone(), ..job() };
    let Created::New(row) = store.create(again, 1).await.unwrap() else { panic!("it is new") };
    assert_eq!((row.state, row.is_cached, row.epoch), (JobState::Succeeded, true, 0));
    assert!(row.finished_at.is_some() && row.started_at == row.finished_at);
    assert_eq!(store.counts().await.unwrap().all, 3);
}

pub(super) async fn the_same_key_and_request_give_the_same_job<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let first = admit(&*store, NewJob { key: key("k", 1), ..job() }).await;
    let again = NewJob { key: key("k", 1), ..job() };
    let Created::Known(known) = store.create(again.clone(), 10).await.unwrap() else { panic!("it is known") };
    assert_eq!(known.id, first.id);
    assert_eq!(store.get(again.id).await.unwrap_err(), StoreError::NotFound);
    let found = store.find_keyed(None, key("k", 1).unwrap()).await.unwrap().unwrap();
    assert_eq!(found.id, first.id);
    assert!(store.find_keyed(None, key("other", 1).unwrap()).await.unwrap().is_none());
}

pub(super) async fn the_same_key_with_another_request_is_refused<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    admit(&*store, NewJob { key: key("k", 1), ..job() }).await;
    let other = NewJob { key: key("k", 2), ..job() };
    assert_eq!(store.create(other, 10).await.unwrap_err(), StoreError::KeyReused);
    assert_eq!(store.find_keyed(None, key("k", 2).unwrap()).await.unwrap_err(), StoreError::KeyReused);
    assert_eq!(store.counts().await.unwrap().all, 1);
}

pub(super) async fn sixty_four_creators_with_one_key_make_one_job<H: StoreHouse>() {
    let house = H::open().await;
    let creators = (0..64).map(|_| {
        let store = house.store();
        tokio::spawn(async move { store.create(NewJob { key: key("k", 1), ..job() }, 100).await.unwrap() })
    });
    let mut ids = Vec::new();
    let mut made = 0;
    for creator in creators.collect::<Vec<_>>() {
        match creator.await.unwrap() {
            Created::New(row) => {
                made += 1;
                ids.push(row.id);
            }
            Created::Known(row) => ids.push(row.id),
        }
    }
    ids.dedup();
    assert_eq!((made, ids.len(), house.store().counts().await.unwrap().all), (1, 1, 1));
}

pub(super) async fn keys_of_two_owners_do_not_meet<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    for (asked, owner) in [None, Some("a"), Some("b")].into_iter().enumerate() {
        let owner = owner.map(str::to_owned);
        admit(&*store, NewJob { key: key("k", asked as u8), owner, ..job() }).await;
    }
    let found = store.find_keyed(Some("b".to_owned()), key("k", 2).unwrap()).await.unwrap().unwrap();
    assert_eq!(found.owner.as_deref(), Some("b"));
}

pub(super) async fn a_known_key_is_answered_although_the_queue_is_full<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let first = NewJob { key: key("k", 1), ..job() };
    store.create(first.clone(), 1).await.unwrap();
    let again = store.create(NewJob { key: key("k", 1), ..job() }, 1).await.unwrap();
    assert!(matches!(again, Created::Known(row) if row.id == first.id));
}

pub(super) async fn a_key_is_free_again_once_its_job_is_deleted<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let first = admit(&*store, NewJob { key: key("k", 1), ..job() }).await;
    store.delete(first.id).await.unwrap();
    admit(&*store, NewJob { key: key("k", 2), ..job() }).await;
}

pub(super) async fn a_key_outlasts_the_process<H: StoreHouse>() {
    let house = H::open().await;
    let first = admit(&*house.store(), NewJob { key: key("k", 1), ..job() }).await;
    let house = house.reopen().await;
    let found = house.store().find_keyed(None, key("k", 1).unwrap()).await.unwrap().unwrap();
    assert_eq!(found.id, first.id);
}
