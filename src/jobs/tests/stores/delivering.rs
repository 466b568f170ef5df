//! Webhooks wait in the outbox and are sent from it.

use std::collections::{HashMap, HashSet};

use super::*;
use crate::jobs::{Delivery, DeliveryRequest, DeliveryState, Leases, NextTry, TryOutcome};

fn hooked() -> NewJob {
    NewJob { webhook: webhook(), ..job() }
}

async fn due(store: &dyn JobStore) -> Vec<Delivery> {
    store.claim_deliveries(up_to(10)).await.unwrap()
}

fn up_to(limit: usize) -> DeliveryRequest {
    DeliveryRequest { limit, lease: LEASE, share: limit, busy: HashMap::new() }
}

/// A claimed delivery of a job that has ended.
async fn delivery(store: &dyn JobStore) -> Delivery {
    let row = succeeded(store, hooked()).await;
    let mut due = due(store).await;
    assert_eq!((due.len(), due[0].job), (1, row.id));
    due.remove(0)
}

pub(super) async fn a_delivery_is_made_with_every_kind_of_end<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = succeeded(&*store, hooked()).await;
    let mut ended = vec![row.id];
    let answered = NewJob { source: Some(row.id), ending: row.ending.clone(), ..hooked() };
    ended.push(admit(&*store, answered).await.id);
    let row = admit(&*store, hooked()).await;
    store.cancel(row.id, cancelled()).await.unwrap();
    ended.push(row.id);
    let row = running(&*store, hooked()).await;
    store.recover(Leases::OfWorker("w".to_owned()), problem(ProblemCode::WorkerLost), 1).await.unwrap();
    ended.push(row.id);
    admit(&*store, hooked()).await;
    let sent = due(&*store).await;
    assert_eq!(sent.iter().map(|delivery| delivery.job).collect::<Vec<_>>(), ended);
    assert!(sent.iter().all(|delivery| Some(&delivery.webhook) == webhook().as_ref()));
    assert_eq!(sent.iter().map(|delivery| &delivery.id).collect::<HashSet<_>>().len(), 4);
}

pub(super) async fn a_job_without_a_webhook_makes_no_delivery<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let row = succeeded(&*store, job()).await;
    assert!(due(&*store).await.is_empty() && store.deliveries(row.id).await.unwrap().is_empty());
    assert_eq!(store.next_delivery().await.unwrap(), None);
}

pub(super) async fn a_delivery_is_claimed_once_until_its_lease_is_over<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let first = delivery(&*store).await;
    assert!(due(&*store).await.is_empty());
    house.advance_ms(AFTER_LEASE_MS).await;
    let again = due(&*store).await;
    assert_eq!((again.len(), &again[0].id), (1, &first.id), "its sender is not heard of");
    assert!(again[0].epoch > first.epoch && again[0].tries.is_empty());
}

pub(super) async fn many_senders_claim_each_delivery_once<H: StoreHouse>() {
    let house = H::open().await;
    for _ in 0..20 {
        succeeded(&*house.store(), hooked()).await;
    }
    let senders = (0..6).map(|_| {
        let store = house.store();
        tokio::spawn(async move {
            let mut claimed = Vec::new();
            loop {
                let some = store.claim_deliveries(up_to(3)).await.unwrap();
                assert!(some.len() <= 3);
                if some.is_empty() {
                    return claimed;
                }
                claimed.extend(some.into_iter().map(|delivery| delivery.id));
            }
        })
    });
    let mut claimed = Vec::new();
    for sender in senders.collect::<Vec<_>>() {
        claimed.extend(sender.await.unwrap());
    }
    assert_eq!((claimed.len(), claimed.iter().collect::<HashSet<_>>().len()), (20, 20));
}

pub(super) async fn no_receiver_gets_more_than_its_share<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let to = |url: &str| NewJob { webhook: Some(Webhook { url: url.to_owned(), secret: None }), ..job() };
    for place in 0..30 {
        succeeded(&*store, to(&format!("https://Silent.example/{place}"))).await;
    }
    succeeded(&*store, to("https://prompt.example:444/hooks")).await;
    let request = |busy: &[(&str, usize)]| DeliveryRequest {
        share: 3,
        busy: busy.iter().map(|&(receiver, calls)| (receiver.to_owned(), calls)).collect(),
        ..up_to(10)
    };
    let receivers =
        |claimed: Vec<Delivery>| claimed.into_iter().map(|delivery| delivery.receiver).collect::<Vec<_>>();
    let first = store.claim_deliveries(request(&[("silent.example", 1)])).await.unwrap();
    assert_eq!(receivers(first), ["silent.example", "silent.example", "prompt.example:444"]);
    let none = store.claim_deliveries(request(&[("silent.example", 3)])).await.unwrap();
    assert!(none.is_empty());
    let more = store.claim_deliveries(request(&[])).await.unwrap();
    assert_eq!(receivers(more).len(), 3);
}

pub(super) async fn a_try_is_noted_and_the_next_one_waits<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let first = delivery(&*store).await;
    let outcome = TryOutcome::Failed("no answer".to_owned());
    let next = NextTry::After(Duration::from_secs(5));
    store.note_try(first.id.clone(), first.epoch, outcome.clone(), next).await.unwrap();
    house.advance_ms(4999).await;
    assert!(due(&*store).await.is_empty());
    assert!(store.next_delivery().await.unwrap().is_some());
    house.advance_ms(1).await;
    let second = due(&*store).await.remove(0);
    assert_eq!((&second.id, second.tries.len(), &second.tries[0].outcome), (&first.id, 1, &outcome));
    let answered = TryOutcome::Answered(503);
    store.note_try(second.id.clone(), second.epoch, answered.clone(), next).await.unwrap();
    let listed = store.deliveries(first.job).await.unwrap();
    let outcomes: Vec<_> = listed[0].tries.iter().map(|one| &one.outcome).collect();
    assert_eq!((outcomes, listed[0].state), (vec![&outcome, &answered], DeliveryState::Pending));
}

pub(super) async fn a_delivered_or_given_up_delivery_is_not_sent_again<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    for (next, state) in
        [(NextTry::Delivered, DeliveryState::Delivered), (NextTry::GiveUp, DeliveryState::Failed)]
    {
        let one = delivery(&*store).await;
        store.note_try(one.id, one.epoch, TryOutcome::Answered(200), next).await.unwrap();
        house.advance_ms(AFTER_LEASE_MS).await;
        assert!(due(&*store).await.is_empty());
        let listed = store.deliveries(one.job).await.unwrap();
        assert_eq!((listed[0].state, listed[0].next_at), (state, None));
    }
    assert_eq!(store.next_delivery().await.unwrap(), None);
}

pub(super) async fn a_delivery_is_sent_again_on_request_under_its_id<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let one = delivery(&*store).await;
    let outcome = TryOutcome::Answered(410);
    store.note_try(one.id.clone(), one.epoch, outcome, NextTry::GiveUp).await.unwrap();
    let again = store.redeliver(one.job, one.id.clone()).await.unwrap();
    assert_eq!((again.state, again.tries.len()), (DeliveryState::Pending, 1));
    let sent = due(&*store).await;
    assert_eq!((sent.len(), &sent[0].id), (1, &one.id));
    let other = succeeded(&*store, job()).await.id;
    assert_eq!(store.redeliver(other, one.id).await.unwrap_err(), StoreError::NotFound);
    assert_eq!(store.redeliver(one.job, "msg_x".to_owned()).await.unwrap_err(), StoreError::NotFound);
}

pub(super) async fn the_try_of_an_old_claim_does_not_count<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let old = delivery(&*store).await;
    house.advance_ms(AFTER_LEASE_MS).await;
    let new = due(&*store).await.remove(0);
    let note = async |one: &Delivery| {
        store.note_try(one.id.clone(), one.epoch, TryOutcome::Answered(200), NextTry::Delivered).await
    };
    assert_eq!(note(&old).await, Ok(false));
    let listed = store.deliveries(new.job).await.unwrap();
    assert_eq!(
        (listed[0].state, listed[0].tries.len()),
        (DeliveryState::Pending, 1),
        "it is kept all the same"
    );
    assert_eq!(note(&new).await, Ok(true));
    assert_eq!(note(&new).await, Ok(false), "only once");
    assert_eq!(store.deliveries(new.job).await.unwrap()[0].tries.len(), 2);
}

pub(super) async fn deliveries_go_with_their_job<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let one = delivery(&*store).await;
    store.delete(one.job).await.unwrap();
    assert!(store.deliveries(one.job).await.unwrap().is_empty());
    let outcome = TryOutcome::Answered(200);
    assert_eq!(store.note_try(one.id, one.epoch, outcome, NextTry::Delivered).await, Ok(false));
}

pub(super) async fn deliveries_outlast_the_process<H: StoreHouse>() {
    let house = H::open().await;
    let one = delivery(&*house.store()).await;
    let next = NextTry::After(Duration::from_secs(1));
    house.store().note_try(one.id.clone(), one.epoch, TryOutcome::Answered(500), next).await.unwrap();
    let house = house.reopen().await;
    house.advance_ms(1000).await;
    let again = due(&*house.store()).await.remove(0);
    assert_eq!((again.id, again.tries.len(), again.created_at), (one.id, 1, one.created_at));
}
