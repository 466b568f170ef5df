//! What several tenants share.

use super::*;
use crate::jobs::{AfterLoss, EndedJobs, Holding};

fn of(tenant: &str) -> NewJob {
    NewJob { tenant: Tenant::named(tenant), ..job() }
}

async fn claim_with(store: &dyn JobStore, share: usize, is_only: bool) -> Option<JobRow> {
    let prefer = if is_only { Lane::Interactive } else { Lane::Bulk };
    let request = ClaimRequest {
        worker: "w".to_owned(),
        lease: LEASE,
        prefer,
        is_only,
        share,
        is_share_of_worker: false,
    };
    store.claim(request).await.unwrap()
}

pub(super) async fn tenants_are_served_in_turn_and_those_with_fewer_running_jobs_first<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    for tenant in ["a", "a", "a", "a", "b", "b"] {
        admit(&*store, of(tenant)).await;
    }
    let mut served = String::new();
    while let Some(row) = claim_with(&*store, 10, false).await {
        served += row.tenant.name();
        // As with one slot.
        store.finish(row.claim(), success(&row)).await.unwrap();
    }
    assert_eq!(served, "ababaa");
    for tenant in ["a", "a", "a", "b"] {
        admit(&*store, of(tenant)).await;
    }
    let mut running = String::new();
    while let Some(row) = claim_with(&*store, 10, false).await {
        running += row.tenant.name();
    }
    assert_eq!(running, "baaa", "the one whose turn was longer ago");
}

pub(super) async fn no_tenant_has_more_running_jobs_than_its_share_in_slots_of_a_kind<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    for tenant in ["a", "a", "a", "", ""] {
        admit(&*store, of(tenant)).await;
    }
    let small = claim_with(&*store, 1, true).await.unwrap();
    let general = claim_with(&*store, 1, false).await.unwrap();
    assert_eq!(
        [small.tenant.name(), general.tenant.name()],
        ["a", ""],
        "the one without a job in a slot comes first"
    );
    let another = claim_with(&*store, 1, true).await.unwrap();
    assert_eq!(another.tenant.name(), "", "no share is kept from nobody");
    assert!(claim_with(&*store, 1, true).await.is_none());
    let own = claim_with(&*store, 1, false).await.unwrap();
    assert_eq!(own.tenant.name(), "a", "in a slot of another kind");
    assert!(claim_with(&*store, 1, false).await.is_none());
    store.finish(own.claim(), success(&own)).await.unwrap();
    assert!(claim_with(&*store, 1, true).await.is_none());
    assert!(claim_with(&*store, 1, false).await.is_some());
}

pub(super) async fn a_tenant_has_as_many_places_in_the_queue_as_are_free<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let fill = async |tenant: &str| {
        let mut taken = 0;
        loop {
            match store.create(of(tenant), 12).await {
                Ok(_) => taken += 1,
                Err(error) => return (taken, error),
            }
        }
    };
    assert_eq!(fill("a").await, (6, StoreError::ShareFull { queued: 6, limit: 6 }));
    assert_eq!(fill("b").await, (3, StoreError::ShareFull { queued: 3, limit: 3 }));
    assert_eq!(fill("c").await.0, 2);
    assert_eq!(fill("d").await.0, 1, "there is room for another one until all is full");
    assert_eq!(fill("e").await, (0, StoreError::QueueFull { queued: 12 }));
}

pub(super) async fn nobody_loses_what_is_within_its_share<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let oldest = succeeded(&*store, of("quiet")).await.id;
    let mut loud = Vec::new();
    for _ in 0..3 {
        loud.push(succeeded(&*store, of("loud")).await.id);
    }
    let first = async |kept, asker: &str| store.first_to_go(kept, Tenant::named(asker)).await.unwrap();
    for kept in [EndedJobs::Any, EndedJobs::WithFiles] {
        assert_eq!(first(kept, "loud").await, Some(loud[0]), "who has its share makes room by itself");
        assert_eq!(first(kept, "quiet").await, Some(loud[0]), "who has less takes it from who has more");
        assert_eq!(first(kept, "new").await, Some(loud[0]));
        let own = store.first_to_go_of(kept, Tenant::named("quiet")).await.unwrap();
        assert_eq!(own, Some(oldest));
    }
    for &id in &loud {
        store.expire(id).await.unwrap();
    }
    assert_eq!(
        first(EndedJobs::WithFiles, "loud").await,
        Some(oldest),
        "by bytes it is the other one that has more"
    );
    for id in loud.into_iter().chain([oldest]) {
        store.delete(id).await.unwrap();
    }
    for _ in 0..3 {
        running(&*store, of("busy")).await;
    }
    let small = succeeded(&*store, of("small")).await.id;
    assert_eq!(
        first(EndedJobs::Any, "busy").await,
        None,
        "nothing of its own has ended, and others have their share"
    );
    assert!(first(EndedJobs::Any, "small").await != Some(small));
}

pub(super) async fn a_job_whose_webhook_is_still_to_be_sent_goes_last<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let told = succeeded(&*store, NewJob { webhook: webhook(), ..of("a") }).await.id;
    let plain = succeeded(&*store, of("a")).await.id;
    let first = async || store.first_to_go(EndedJobs::Any, Tenant::named("a")).await.unwrap();
    assert_eq!(first().await, Some(plain));
    store.delete(plain).await.unwrap();
    assert_eq!(first().await, Some(told));
}

pub(super) async fn what_a_tenant_has_follows_its_jobs<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let holding = async |tenant: &str| store.holding(Tenant::named(tenant)).await.unwrap();
    assert_eq!(holding("a").await, Holding::default());
    let ended = succeeded(&*store, of("a")).await;
    let running = running(&*store, of("a")).await;
    admit(&*store, of("a")).await;
    admit(&*store, of("b")).await;
    let expected =
        Holding { jobs: 3, queued: 1, open_bytes: 10, open_bytes_of_all: 15, bytes: 5 + 7 + 7 + 5 + 5 };
    assert_eq!(holding("a").await, expected);
    store.expire(ended.id).await.unwrap();
    store.finish(running.claim(), failure()).await.unwrap();
    let expected = Holding { jobs: 3, queued: 1, open_bytes: 5, open_bytes_of_all: 10, bytes: 10 };
    assert_eq!(holding("a").await, expected);
    for job in store.list(crate::jobs::ListQuery { limit: 9, ..Default::default() }).await.unwrap() {
        store.delete(job.id).await.unwrap();
    }
    assert_eq!((holding("a").await, holding("b").await), Default::default());
}

pub(super) async fn a_job_that_is_larger_than_was_thought_waits_among_the_large_ones<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = running(&*store, job()).await;
    assert_eq!(store.demote(row.claim(), false).await, Ok(AfterLoss::Queued));
    assert_eq!(store.demote(row.claim(), true).await, Err(StoreError::ClaimVoid), "only once");
    assert!(claim_with(&*store, 1, true).await.is_none());
    let row = claim_with(&*store, 1, false).await.unwrap();
    assert_eq!((row.lane, row.is_outgrown, row.attempts, row.epoch), (Lane::Bulk, false, 0, 2));
    store.demote(row.claim(), true).await.unwrap();
    assert!(claim_with(&*store, 1, false).await.unwrap().is_outgrown);
}

pub(super) async fn plain_secrets_are_sealed_once<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let hook = Webhook { url: "https://shop.example/done".to_owned(), secret: Some("plain".to_owned()) };
    let ended = succeeded(&*store, NewJob { webhook: Some(hook.clone()), ..job() }).await.id;
    succeeded(&*store, NewJob { webhook: webhook(), ..job() }).await;
    let seal =
        || -> crate::jobs::Sealer { Box::new(|secret| (secret == "plain").then(|| "sealed".to_owned())) };
    assert_eq!(store.seal_secrets(seal()).await, Ok(2), "of the job and of its delivery");
    assert_eq!(store.seal_secrets(seal()).await, Ok(0));
    let sealed = Some("sealed".to_owned());
    let row = store.get(ended).await.unwrap();
    assert_eq!(row.webhook, Some(Webhook { secret: sealed.clone(), ..hook }));
    assert_eq!(store.deliveries(ended).await.unwrap()[0].webhook.secret, sealed);
}
