//! The cases on PostgreSQL.

mod older;
mod pace;
#[path = "../../../../../tests/support/postgres_server.rs"]
mod server;

use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio_postgres::{Client, NoTls};
use uuid::Uuid;

use super::super::PATIENCE;
use super::{StoreHouse, admit, cases, claim, contract, job, leave_out};
use crate::jobs::{
    ClaimRequest, Created, DatabaseAccess, JobStore, Lane, ListQuery, NewJob, PostgresOpenError,
    PostgresStore, StoreError, Tenant,
};
use crate::wire::JobState;
use server::Server;

/// What must be installed.
const PROGRAMS: &str = "PostgreSQL (Debian's package postgresql)";

struct PostgresHouse {
    store: Arc<PostgresStore>,
    /// Another connection to the same database.
    aside: Client,
    url: String,
}

async fn open_store(url: &str) -> Result<PostgresStore, PostgresOpenError> {
    let access = DatabaseAccess { url: url.to_owned(), password: None, connections_max: 8 };
    PostgresStore::open(&access).await
}

async fn connect(url: &str) -> Client {
    let (client, connection) = tokio_postgres::connect(url, NoTls).await.unwrap();
    tokio::spawn(connection);
    client
}

/// The server, for tests beside the cases.
pub(in crate::jobs::tests) struct Database(());

impl Database {
    /// Where it is installed; otherwise what is missing.
    pub(in crate::jobs::tests) fn installed() -> Result<Self, &'static str> {
        PostgresHouse::missing().map_or(Ok(Self(())), Err)
    }

    /// A new database.
    pub(in crate::jobs::tests) async fn access(&self) -> DatabaseAccess {
        let Self(()) = self;
        DatabaseAccess { url: database(Server::shared()).await, password: None, connections_max: 8 }
    }
}

/// A new database of this server.
async fn database(server: &Server) -> String {
    let name = format!("d{}", Uuid::now_v7().simple());
    let sql = format!("CREATE DATABASE {name} TEMPLATE template0");
    connect(&server.url("postgres")).await.batch_execute(&sql).await.unwrap();
    server.url(&name)
}

impl PostgresHouse {
    async fn at(url: String) -> Self {
        let store = Arc::new(open_store(&url).await.unwrap());
        Self { store, aside: connect(&url).await, url }
    }

    /// A house in which time goes on.
    async fn with_the_time_of_day(server: &Server) -> Self {
        Self::at(database(server).await).await
    }
}

impl StoreHouse for PostgresHouse {
    fn missing() -> Option<&'static str> {
        server::programs().is_none().then_some(PROGRAMS)
    }

    async fn open() -> Self {
        let house = Self::with_the_time_of_day(Server::shared()).await;
        // Any time will do; this one is in 2027.
        let another_clock = "CREATE TABLE clock AS SELECT 1800000000000 AS ms;
            CREATE OR REPLACE FUNCTION now_ms() RETURNS bigint LANGUAGE sql VOLATILE AS 'SELECT ms FROM clock'";
        house.aside.batch_execute(another_clock).await.unwrap();
        house
    }

    fn store(&self) -> Arc<dyn JobStore> {
        Arc::clone(&self.store) as Arc<dyn JobStore>
    }

    async fn advance_ms(&self, by: i64) {
        self.aside.execute("UPDATE clock SET ms = ms + $1", &[&by]).await.unwrap();
    }

    async fn reopen(self) -> Self {
        let Self { store, aside, url } = self;
        drop((store, aside));
        Self::at(url).await
    }
}

contract!(PostgresHouse);

/// A test that is left out where there is no PostgreSQL.
macro_rules! postgres_tests {
    ($(async fn $name:ident() $body:block)+) => { $(
        #[tokio::test]
        async fn $name() {
            match PostgresHouse::missing() {
                None => $body,
                Some(what) => leave_out(what),
            }
        }
    )+ };
}
use postgres_tests;

postgres_tests! {
    async fn many_servers_make_the_tables_once() {
        let url = database(Server::shared()).await;
        let opening = (0..8).map(|_| {
            let url = url.clone();
            tokio::spawn(async move { open_store(&url).await.unwrap().mark().to_owned() })
        });
        let mut marks = Vec::new();
        for opened in opening.collect::<Vec<_>>() {
            marks.push(opened.await.unwrap());
        }
        marks.dedup();
        assert_eq!(marks.len(), 1, "all see one store");
    }

    async fn an_older_program_goes_on_until_a_step_takes_away_what_it_needs() {
        let house = PostgresHouse::open().await;
        house.aside.batch_execute("INSERT INTO versions VALUES (1000, 1)").await.unwrap();
        let older = open_store(&house.url).await.unwrap();
        admit(&older, job()).await;
        house.aside.batch_execute("INSERT INTO versions VALUES (1001, 1000)").await.unwrap();
        let error = open_store(&house.url).await.unwrap_err();
        assert!(matches!(error, PostgresOpenError::TooNew { found: 1001, oldest: 1000, .. }), "{error}");
    }

    async fn a_job_that_another_server_is_about_to_take_is_passed_over() {
        let house = PostgresHouse::open().await;
        let (first, second) = (admit(&*house.store, job()).await.id, admit(&*house.store, job()).await.id);
        let lock = "BEGIN; SELECT FROM jobs WHERE state = 'queued' ORDER BY id LIMIT 1 FOR UPDATE";
        house.aside.batch_execute(lock).await.unwrap();
        assert_eq!(claim(&*house.store).await.unwrap().id, second);
        assert!(claim(&*house.store).await.is_none(), "and nobody waits for it");
        house.aside.batch_execute("ROLLBACK").await.unwrap();
        assert_eq!(claim(&*house.store).await.unwrap().id, first);
    }

    async fn a_tenant_of_whom_another_server_claims_a_job_is_not_waited_for_while_others_have_some() {
        let house = PostgresHouse::open().await;
        let of = |tenant: &str| NewJob { tenant: Tenant::named(tenant), ..job() };
        let first = admit(&*house.store, of("a")).await.id;
        let second = admit(&*house.store, of("b")).await.id;
        // As a server does that claims a job of `a`.
        let lock = "BEGIN; SELECT pg_advisory_xact_lock(x'6d650003'::integer, hashtext('a'))";
        house.aside.batch_execute(lock).await.unwrap();
        assert_eq!(claim(&*house.store).await.unwrap().id, second);
        let store = Arc::clone(&house.store);
        let waiting = tokio::spawn(async move { claim(&*store).await });
        tokio::time::sleep(Duration::from_millis(200)).await;
        assert!(!waiting.is_finished(), "no other tenant has one: it is waited for");
        house.aside.batch_execute("ROLLBACK").await.unwrap();
        assert_eq!(waiting.await.unwrap().unwrap().id, first);
    }

    async fn no_limit_is_passed_by_servers_that_come_at_one_time() {
        let house = PostgresHouse::open().await;
        let other = Arc::new(open_store(&house.url).await.unwrap());
        let of = |tenant: &str| NewJob { tenant: Tenant::named(tenant), ..job() };
        let stores = [house.store, other];
        let creating = (0..60).map(|number| {
            let (store, job) = (Arc::clone(&stores[number % 2]), of(["a", "b"][number / 2 % 2]));
            tokio::spawn(async move { store.create(job, 12).await.is_ok() })
        });
        let mut made = 0;
        for created in creating.collect::<Vec<_>>() {
            made += usize::from(created.await.unwrap());
        }
        let counts = stores[1].counts().await.unwrap();
        assert_eq!(counts.queued, made);
        let queued = async |tenant| stores[0].holding(Tenant::named(tenant)).await.unwrap().queued;
        let (a, b) = (queued("a").await, queued("b").await);
        assert!(a + b < 12 && a.min(b) >= 3, "{a} and {b}: each as many as were free, and never all");
        let claiming = (0..20).map(|number| {
            let store = Arc::clone(&stores[number % 2]);
            let request = ClaimRequest {
                worker: "w".to_owned(),
                lease: super::LEASE,
                prefer: Lane::Interactive,
                is_only: false,
                share: 2,
                is_share_of_worker: false,
            };
            tokio::spawn(async move { store.claim(request).await.unwrap().map(|row| row.tenant) })
        });
        let mut claimed = Vec::new();
        for row in claiming.collect::<Vec<_>>() {
            claimed.extend(row.await.unwrap());
        }
        claimed.sort_unstable();
        let tenants: Vec<_> = claimed.iter().map(Tenant::name).collect();
        assert_eq!(tenants, ["a", "a", "b", "b"]);
    }

    async fn a_share_of_the_slots_of_one_server_does_not_count_what_runs_on_others() {
        let house = PostgresHouse::open().await;
        for _ in 0..5 {
            admit(&*house.store, NewJob { tenant: Tenant::named("a"), ..job() }).await;
        }
        let claim = async |worker: &str, share, is_share_of_worker| {
            let request = ClaimRequest {
                worker: worker.to_owned(),
                lease: super::LEASE,
                prefer: Lane::Interactive,
                is_only: false,
                share,
                is_share_of_worker,
            };
            house.store.claim(request).await.unwrap().is_some()
        };
        assert!(claim("first", 1, true).await);
        assert!(!claim("first", 1, true).await, "it has its share here");
        assert!(claim("second", 1, true).await && claim("third", 1, true).await);
        assert!(!claim("fourth", 3, false).await, "it has three of all");
        assert!(claim("fourth", 4, false).await);
    }

    async fn a_change_that_nobody_waits_for_is_made_all_the_same() {
        let house = PostgresHouse::open().await;
        let new = job();
        let id = new.id;
        let mut change = house.store.create(new, 10);
        // Handed over, and then dropped.
        tokio::select! {
            biased;
            _ = &mut change => {}
            () = std::future::ready(()) => {}
        }
        drop(change);
        let is_made = async {
            while house.store.get(id).await.is_err() {
                tokio::time::sleep(Duration::from_millis(5)).await;
            }
        };
        tokio::time::timeout(PATIENCE, is_made).await.expect("the change is lost");
    }

    async fn a_change_that_is_refused_leaves_no_transaction_open() {
        let house = PostgresHouse::open().await;
        for _ in 0..20 {
            assert!(matches!(house.store.create(job(), 0).await, Err(StoreError::QueueFull { queued: 0 })));
        }
        admit(&*house.store, job()).await;
        let open = "SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() AND state LIKE 'idle in%'";
        let open: i64 = house.aside.query_one(open, &[]).await.unwrap().get(0);
        assert_eq!(open, 0);
    }

    async fn a_row_that_cannot_be_read_fails_and_does_not_stand_in_the_way() {
        let house = PostgresHouse::open().await;
        let (strange, next) = (admit(&*house.store, job()).await.id, admit(&*house.store, job()).await.id);
        let sql = "UPDATE jobs SET options = '{\"an option of another version\":1}' WHERE id = $1";
        house.aside.execute(sql, &[&Uuid::from(strange)]).await.unwrap();
        assert_eq!(claim(&*house.store).await.unwrap().id, next);
        let changes = house.store.changes(strange, 0).await.unwrap();
        assert_eq!(changes.last().unwrap().state, JobState::Failed);
        let query = ListQuery { limit: 10, ..Default::default() };
        assert_eq!(house.store.list(query).await.unwrap().len(), 1);
        house.store.delete(strange).await.unwrap();
    }

    async fn times_are_those_of_the_database() {
        let house = PostgresHouse::with_the_time_of_day(Server::shared()).await;
        let before: i64 = house.aside.query_one("SELECT now_ms()", &[]).await.unwrap().get(0);
        let row = admit(&*house.store, job()).await;
        let after: i64 = house.aside.query_one("SELECT now_ms()", &[]).await.unwrap().get(0);
        assert!((before..=after).contains(&row.created_at.as_millisecond()));
    }

    async fn nothing_that_was_told_is_lost_when_the_database_crashes_under_load() {
        let server = Server::start();
        let house = PostgresHouse::with_the_time_of_day(&server).await;
        let creating = (0..4).map(|_| {
            let store = Arc::clone(&house.store);
            tokio::spawn(async move {
                let begun = Instant::now();
                let (mut told, mut refused, mut after) = (Vec::new(), 0, 0);
                // Until it has seen the crash and some of what comes after.
                while after < 20 {
                    assert!(begun.elapsed() < 3 * PATIENCE, "the database is not found again");
                    match store.create(job(), 1_000_000).await {
                        Ok(Created::New(row)) => {
                            told.push(row.id);
                            after += usize::from(refused > 0);
                        }
                        Err(StoreError::Unavailable(_)) => {
                            refused += 1;
                            tokio::time::sleep(Duration::from_millis(20)).await;
                        }
                        other => panic!("{other:?}"),
                    }
                }
                told
            })
        });
        let creating: Vec<_> = creating.collect();
        tokio::time::sleep(Duration::from_millis(300)).await;
        let crash = move || {
            server.crash_and_start();
            server
        };
        let server = tokio::task::spawn_blocking(crash).await.unwrap();
        let mut told = 0;
        for created in creating {
            for id in created.await.unwrap() {
                assert_eq!(house.store.get(id).await.unwrap().state, JobState::Queued);
                told += 1;
            }
        }
        assert!(told >= 4 * 20);
        drop(server);
    }
}
