//! Jobs are found again.

use super::*;
use crate::jobs::ListQuery;
use crate::jobs::store::EQUAL_JOBS_LOOKED_AT;

pub(super) async fn an_equal_job_is_found_by_its_bytes_and_options<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let first = succeeded(&*store, job()).await;
    let same = NewJob { input: BlobRef { key: "in/again".into(), ..first.input.clone() }, ..job() };
    assert_eq!(store.find_equal(&same).await.unwrap().unwrap().id, first.id);
    let kept_shorter = Options { result_ttl: Some(5), ..Options::default() };
    let same_result = NewJob { options: kept_shorter, ..same.clone() };
    assert!(store.find_equal(&same_result).await.unwrap().is_some());
    let others = [
        NewJob { operation: Operation::Verify, ..same.clone() },
        NewJob { options: Options { samples: Some(1), ..Options::default() }, ..same.clone() },
        NewJob { material: Some(first.input.clone()), ..same.clone() },
        NewJob { input: BlobRef { files: vec![2, 3], ..same.input.clone() }, ..same.clone() },
        job(),
    ];
    for other in others {
        assert!(store.find_equal(&other).await.unwrap().is_none());
    }
}

pub(super) async fn an_equal_job_of_another_owner_is_not_found<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let first = succeeded(&*store, NewJob { owner: Some("a".to_owned()), ..job() }).await;
    let of =
        |owner: Option<&str>| NewJob { owner: owner.map(str::to_owned), input: first.input.clone(), ..job() };
    for owner in [None, Some("b")] {
        assert!(store.find_equal(&of(owner)).await.unwrap().is_none(), "{owner:?}");
    }
    assert!(store.find_equal(&of(Some("a"))).await.unwrap().is_some());
}

pub(super) async fn only_the_latest_jobs_with_the_same_bytes_are_looked_at<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let first = succeeded(&*store, job()).await;
    let same = NewJob { input: first.input.clone(), ..job() };
    for number in 1..=EQUAL_JOBS_LOOKED_AT {
        assert_eq!(store.find_equal(&same).await.unwrap().map(|row| row.id), Some(first.id));
        let options = Options { samples: Some(number), ..Options::default() };
        let other = NewJob { id: JobId::unique(), options, ending: Some(success(&first)), ..same.clone() };
        store.create(other, usize::MAX).await.unwrap();
    }
    assert!(store.find_equal(&same).await.unwrap().is_none());
}

pub(super) async fn what_failed_or_has_expired_answers_nothing<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let failed = running(&*store, job()).await;
    store.finish(failed.claim(), failure()).await.unwrap();
    let expired = succeeded(&*store, job()).await;
    store.expire(expired.id).await.unwrap();
    let due = succeeded(&*store, NewJob { keep_for: Duration::from_secs(1), ..job() }).await;
    house.advance_ms(1000).await;
    for row in [failed, expired, due] {
        let same = NewJob { input: row.input, ..job() };
        assert!(store.find_equal(&same).await.unwrap().is_none());
    }
}

pub(super) async fn jobs_are_listed_the_latest_first_page_by_page<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let mut came = Vec::new();
    for _ in 0..7 {
        came.push(admit(&*store, job()).await.id);
    }
    came.reverse();
    let (mut listed, mut before) = (Vec::new(), None);
    loop {
        let page = store.list(ListQuery { before, limit: 3, ..ListQuery::default() }).await.unwrap();
        assert!(page.len() <= 3);
        let Some(last) = page.last() else { break };
        before = Some(last.id);
        listed.extend(page.iter().map(|row| row.id));
        // Who comes meanwhile is on no later page.
        admit(&*store, job()).await;
    }
    assert_eq!(listed, came);
}

pub(super) async fn jobs_are_listed_for_their_owner_only<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let mut ids = Vec::new();
    for owner in [None, Some("a"), Some("b")] {
        ids.push(admit(&*store, NewJob { owner: owner.map(str::to_owned), ..job() }).await.id);
    }
    for (id, owner) in ids.into_iter().zip([None, Some("a"), Some("b")]) {
        let query = ListQuery { owner: owner.map(str::to_owned), limit: 10, ..ListQuery::default() };
        let listed = store.list(query).await.unwrap();
        assert_eq!(listed.iter().map(|row| row.id).collect::<Vec<_>>(), [id]);
    }
}

pub(super) async fn jobs_are_listed_by_state_and_labels<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let label = |pairs: &[(&str, &str)]| {
        pairs.iter().map(|&(name, value)| (name.to_owned(), value.to_owned())).collect::<Labels>()
    };
    let red =
        succeeded(&*store, NewJob { labels: label(&[("order", "1"), ("colour", "red")]), ..job() }).await.id;
    let blue =
        admit(&*store, NewJob { labels: label(&[("order", "1"), ("colour", "blue")]), ..job() }).await.id;
    let plain = admit(&*store, job()).await.id;
    let list = async |state, labels: &[(&str, &str)]| {
        let labels = label(labels).into_iter().collect();
        let query = ListQuery { state, labels, limit: 10, ..ListQuery::default() };
        store.list(query).await.unwrap().into_iter().map(|row| row.id).collect::<Vec<_>>()
    };
    assert_eq!(list(None, &[("order", "1")]).await, [blue, red]);
    assert_eq!(list(None, &[("order", "1"), ("colour", "red")]).await, [red]);
    assert_eq!(list(Some(JobState::Queued), &[]).await, [plain, blue]);
    assert_eq!(list(Some(JobState::Queued), &[("colour", "red")]).await, []);
    assert_eq!(list(None, &[("colour", "' OR 1 = 1 --")]).await, []);
}

pub(super) async fn counts_follow_the_jobs<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let counts = async || {
        let counts = store.counts().await.unwrap();
        assert_eq!(counts.queued_bytes, counts.queued as u64 * job().input.bytes);
        (counts.queued, counts.running, counts.all)
    };
    assert_eq!(counts().await, (0, 0, 0));
    let first = running(&*store, job()).await;
    admit(&*store, job()).await;
    assert_eq!(counts().await, (1, 1, 2));
    store.release(first.claim()).await.unwrap();
    assert_eq!(counts().await, (2, 0, 2));
    let first = claim(&*store).await.unwrap();
    store.finish(first.claim(), success(&first)).await.unwrap();
    store.expire(first.id).await.unwrap();
    assert_eq!(counts().await, (1, 0, 2));
    store.delete(first.id).await.unwrap();
    assert_eq!(counts().await, (1, 0, 1));
}

pub(super) async fn who_waits_for_jobs_is_told_which_have_ended_or_are_gone<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let ended = succeeded(&*store, job()).await.id;
    let expired = succeeded(&*store, job()).await.id;
    store.expire(expired).await.unwrap();
    let running = running(&*store, job()).await.id;
    let queued = admit(&*store, job()).await.id;
    let gone = JobId::unique();
    let mut told = store.ended(vec![queued, gone, running, ended, expired]).await.unwrap();
    let mut expected = vec![ended, expired, gone];
    told.sort_unstable();
    expected.sort_unstable();
    assert_eq!(told, expected);
    assert!(store.ended(Vec::new()).await.unwrap().is_empty());
}
