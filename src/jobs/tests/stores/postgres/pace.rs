//! How long claims take while jobs are claimed at a steady pace, sleep and end; a campaign prints the figures.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::super::{StoreHouse as _, claim_of_many, job, leave_out, success};
use super::{PostgresHouse, Server, open_store};
use crate::jobs::{JobStore, NewJob, Tenant};
use crate::wire::JobState;

#[path = "../../../../../tests/support/mod.rs"]
#[allow(dead_code, reason = "each place uses a part of it")]
mod support;

/// Stores, each as of a server of its own.
const SERVERS: usize = 8;
/// Connections of each.
const CONNECTIONS: usize = 8;
/// Callers who share the jobs evenly.
const TENANTS: usize = 40;
/// How long a job sleeps.
const SLEEP: Duration = Duration::from_millis(50);

/// Times of claims, shortest first, of so many jobs that are claimed, sleep and end at `rate` a second, after some on each
/// connection that do not count.
async fn times_of_claims(house: &PostgresHouse, rate: usize, count: usize) -> Vec<Duration> {
    // Their admission is not what is measured.
    let set = |value| {
        format!(
            "DO $$ BEGIN EXECUTE format('ALTER DATABASE %I SET synchronous_commit = {value}', current_database()); END $$"
        )
    };
    house.aside.batch_execute(&set("off")).await.unwrap();
    let quick = open_store(&house.url).await.unwrap();
    for number in 0..count + SERVERS * CONNECTIONS {
        let tenant = Tenant::named(format!("caller {}", number % TENANTS));
        quick.create(NewJob { tenant, ..job() }, 1_000_000).await.unwrap();
    }
    house.aside.batch_execute(&set("on")).await.unwrap();
    let mut stores: Vec<Arc<dyn JobStore>> = Vec::new();
    for _ in 0..SERVERS {
        stores.push(Arc::new(open_store(&house.url).await.unwrap()));
    }
    // Each connection has made its plans before the time counts.
    let warm = |store: &Arc<dyn JobStore>| {
        let store = Arc::clone(store);
        tokio::spawn(async move {
            let row = claim_of_many(&*store, count).await.expect("as many wait as are claimed");
            store.finish(row.claim(), success(&row)).await.unwrap();
        })
    };
    let warmed: Vec<_> = stores.iter().flat_map(|store| [store; CONNECTIONS].map(warm)).collect();
    for claim in warmed {
        claim.await.unwrap();
    }
    let begun = Instant::now();
    let mut runs = Vec::with_capacity(count);
    for number in 0..count {
        let due = begun + Duration::from_secs(number as u64) / rate as u32;
        tokio::time::sleep_until(due.into()).await;
        let store = Arc::clone(&stores[number % SERVERS]);
        runs.push(tokio::spawn(async move {
            // Nobody is waited for before: what is late counts.
            let row = claim_of_many(&*store, count).await.expect("as many wait as are claimed");
            let took = due.elapsed();
            tokio::time::sleep(SLEEP).await;
            store.finish(row.claim(), success(&row)).await.unwrap();
            assert_eq!(store.get(row.id).await.unwrap().state, JobState::Succeeded);
            took
        }));
    }
    let mut times = Vec::with_capacity(count);
    for run in runs {
        times.push(run.await.unwrap());
    }
    times.sort_unstable();
    times
}

#[tokio::test(flavor = "multi_thread")]
async fn claims_at_a_steady_pace_are_each_made_once() {
    if let Some(missing) = PostgresHouse::missing() {
        return leave_out(missing);
    }
    let seconds = support::cases(1, 10);
    println!("| what a sync costs | claims a second | claims | median ms | p99 ms | longest ms |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for (is_synced, disk) in [(true, "as the disk has it"), (false, "nothing (`fsync = off`)")] {
        let server = Server::start();
        let house = PostgresHouse::with_the_time_of_day(&server).await;
        if !is_synced {
            house.aside.batch_execute("ALTER SYSTEM SET fsync = off").await.unwrap();
            house.aside.batch_execute("SELECT pg_reload_conf()").await.unwrap();
        }
        for rate in [20, 100, 200, 500].into_iter().take(support::cases(1, 4)) {
            let times = times_of_claims(&house, rate, rate * seconds).await;
            let ms = |part: usize| times[(times.len() - 1) * part / 100].as_secs_f64() * 1e3;
            println!(
                "| {disk} | {rate} | {} | {:.1} | {:.1} | {:.1} |",
                times.len(),
                ms(50),
                ms(99),
                ms(100)
            );
        }
        let left = claim_of_many(&*house.store, 1).await;
        assert!(left.is_none(), "each job was claimed once");
    }
}
