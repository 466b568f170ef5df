//! Tables that programs of different ages share: each step leaves alone what the programs need that may still run after it.

use std::collections::{BTreeMap, BTreeSet};

use tokio_postgres::Client;
use uuid::Uuid;

use super::super::{StoreHouse as _, VOID, claim_of_many, failure, job, leave_out, running, state, success};
use super::{PostgresHouse, Server, connect, database, open_store, postgres_tests};
use crate::jobs::postgres::schema_steps;
use crate::jobs::{JobId, JobStore as _, NewJob};
use crate::wire::JobState;

/// What a program may rely on.
#[derive(Debug, Clone, Default)]
struct Tables {
    /// Type and nullability of each column, and whether a row may be made without it, by the names of table and column.
    columns: BTreeMap<(String, String), (String, bool)>,
    /// What rows must keep, beside the name of their table.
    rules: BTreeSet<(String, String)>,
    /// Functions and sequences.
    others: BTreeSet<String>,
}

impl Tables {
    async fn of(client: &Client) -> Self {
        let columns = "SELECT table_name, column_name,
                concat_ws(' ', data_type, numeric_precision, is_nullable),
                is_nullable = 'YES' OR column_default IS NOT NULL
            FROM information_schema.columns WHERE table_schema = 'public'";
        let rules = "SELECT conrelid::regclass::text, pg_get_constraintdef(oid) FROM pg_constraint
                WHERE conrelid <> 0 AND contype <> 'n' AND connamespace = 'public'::regnamespace
            UNION ALL SELECT tablename, regexp_replace(indexdef, 'INDEX \\w+ ', '') FROM pg_indexes
                WHERE schemaname = 'public' AND indexdef LIKE 'CREATE UNIQUE%'
            UNION ALL SELECT tgrelid::regclass::text, pg_get_triggerdef(oid) FROM pg_trigger WHERE NOT tgisinternal";
        let others = "SELECT proname || pg_get_function_arguments(oid) FROM pg_proc
                WHERE pronamespace = 'public'::regnamespace
            UNION ALL SELECT sequencename FROM pg_sequences WHERE schemaname = 'public'";
        let rows = async |sql| client.query(sql, &[]).await.unwrap();
        Self {
            columns: rows(columns)
                .await
                .iter()
                .map(|row| ((row.get(0), row.get(1)), (row.get(2), row.get(3))))
                .collect(),
            rules: rows(rules).await.iter().map(|row| (row.get(0), row.get(1))).collect(),
            others: rows(others).await.iter().map(|row| row.get(0)).collect(),
        }
    }

    /// What a program that was made for these tables misses in newer ones, or must not do any longer.
    fn broken_in(&self, newer: &Self) -> Vec<String> {
        let mut broken = Vec::new();
        for (name, (kind, _)) in &self.columns {
            match newer.columns.get(name) {
                Some((now, _)) if now == kind => {}
                now => broken.push(format!("{name:?}: {kind}, now {now:?}")),
            }
        }
        let tables: BTreeSet<&str> = self.columns.keys().map(|(table, _)| table.as_str()).collect();
        for (name, (kind, may_be_left_out)) in &newer.columns {
            if tables.contains(name.0.as_str()) && !self.columns.contains_key(name) && !may_be_left_out {
                broken.push(format!("{name:?}: {kind}, which each row needs now"));
            }
        }
        let new_rules = newer.rules.difference(&self.rules);
        broken.extend(
            new_rules.filter(|rule| tables.contains(rule.0.as_str())).map(|rule| format!("{rule:?} is new")),
        );
        broken.extend(self.others.difference(&newer.others).map(|other| format!("{other} is gone")));
        broken
    }
}

/// An empty database.
async fn empty() -> (Client, String) {
    let url = database(Server::shared()).await;
    (connect(&url).await, url)
}

/// Makes a job as programs of version 1 of the tables do.
async fn admit_as_version_1(client: &Client, new: &NewJob) {
    let json = |value: Result<String, serde_json::Error>| value.unwrap();
    let (id, tenant, bytes) = (Uuid::from(new.id), new.tenant.name(), new.input.bytes.to_string());
    let input = json(serde_json::to_string(&new.input));
    let (options, labels) =
        (json(serde_json::to_string(&new.options)), json(serde_json::to_string(&new.labels)));
    let sql = "INSERT INTO jobs (id, owner, tenant, operation, options, file_name, labels, webhook, trace, input,
            input_sha256, input_bytes, material, lane, state, created_at, cancel_at, keep_for, idempotency_key, fingerprint)
        VALUES ($1, NULL, $2, 'repair', $3, NULL, $4, NULL, NULL, $5,
            $6, $7::text::numeric, NULL, 0, 'queued', now_ms(), NULL, 3600000, NULL, NULL)";
    let sha256 = &new.input.sha256[..];
    client.execute(sql, &[&id, &tenant, &options, &labels, &input, &sha256, &bytes]).await.unwrap();
    let sql = "INSERT INTO names VALUES ($1, $2, $3::text::numeric, $4) ON CONFLICT DO NOTHING";
    client.execute(sql, &[&id, &new.input.key, &bytes, &input]).await.unwrap();
    let sql = "INSERT INTO changes (job, number, state, epoch, at)
        SELECT id, 1 + (SELECT coalesce(max(number), 0) FROM changes WHERE job = $1), state, epoch, $2::bigint
        FROM jobs WHERE id = $1";
    client.execute(sql, &[&id, &1_800_000_000_000_i64]).await.unwrap();
}

/// Ends a running job as programs of version 1 do. Whether it was there.
async fn finish_as_version_1(client: &Client, id: JobId, epoch: i64) -> bool {
    let sql = "UPDATE jobs SET state = 'failed', ending = $2, engine = '0.1.0', finished_at = now_ms(),
            expires_at = least(now_ms() + keep_for, 9000000000000), worker = NULL, lease_until = NULL, stop = NULL
        WHERE id = $1 AND epoch = $3 AND state = 'running'";
    let ending = serde_json::to_string(&failure()).unwrap();
    client.execute(sql, &[&Uuid::from(id), &ending, &epoch]).await.unwrap() == 1
}

postgres_tests! {
    async fn a_step_leaves_alone_what_programs_need_that_may_still_run() {
        let (client, _) = empty().await;
        let mut versions = Vec::new();
        for (sql, oldest) in schema_steps() {
            client.batch_execute(sql).await.unwrap();
            versions.push(Tables::of(&client).await);
            let newest = &versions[versions.len() - 1];
            assert!(!newest.columns.is_empty() && !newest.rules.is_empty() && !newest.others.is_empty());
            for (number, older) in (1..).zip(&versions).skip_while(|&(number, _)| number < oldest) {
                let broken = older.broken_in(newest);
                assert!(broken.is_empty(), "from {number} to {}: {broken:#?}", versions.len());
            }
        }
    }

    async fn a_step_that_older_programs_do_not_survive_is_seen() {
        let (client, _) = empty().await;
        for (sql, _) in schema_steps() {
            client.batch_execute(sql).await.unwrap();
        }
        let before = Tables::of(&client).await;
        for (step, is_fine) in [
            ("ALTER TABLE jobs ADD COLUMN a BIGINT", true),
            ("ALTER TABLE jobs ADD COLUMN a BIGINT NOT NULL DEFAULT 0", true),
            ("CREATE TABLE a (job UUID NOT NULL UNIQUE REFERENCES jobs (id) ON DELETE CASCADE)", true),
            ("CREATE INDEX a ON jobs (material)", true),
            ("ALTER TABLE jobs ADD COLUMN a BIGINT NOT NULL", false),
            ("ALTER TABLE jobs DROP COLUMN trace", false),
            ("ALTER TABLE jobs RENAME COLUMN trace TO a", false),
            ("ALTER TABLE jobs ALTER COLUMN turn TYPE INTEGER", false),
            ("ALTER TABLE jobs ALTER COLUMN trace SET NOT NULL", false),
            ("ALTER TABLE names ADD CHECK (bytes > 0)", false),
            ("CREATE UNIQUE INDEX a ON names (key)", false),
            ("DROP TABLE tries", false),
            ("DROP SEQUENCE turns", false),
            ("ALTER FUNCTION now_ms() RENAME TO a", false),
        ] {
            client.batch_execute(&format!("BEGIN; {step}")).await.unwrap();
            let broken = before.broken_in(&Tables::of(&client).await);
            client.batch_execute("ROLLBACK").await.unwrap();
            assert_eq!(broken.is_empty(), is_fine, "{step}: {broken:#?}");
        }
    }

    async fn jobs_of_an_older_program_run_while_it_goes_on_making_and_ending_jobs() {
        let (older, url) = empty().await;
        older.batch_execute("CREATE TABLE versions (number BIGINT PRIMARY KEY, oldest BIGINT NOT NULL)").await.unwrap();
        older.batch_execute(schema_steps().next().unwrap().0).await.unwrap();
        older.batch_execute("INSERT INTO versions VALUES (1, 1)").await.unwrap();
        let before = job();
        admit_as_version_1(&older, &before).await;
        let newer = open_store(&url).await.unwrap();
        let oldest: i64 = older.query_one("SELECT max(oldest) FROM versions", &[]).await.unwrap().get(0);
        assert_eq!(oldest, 1, "a program of version 1 still starts");
        let after = job();
        admit_as_version_1(&older, &after).await;
        for id in [before.id, after.id] {
            let row = claim_of_many(&newer, 64).await.unwrap();
            assert_eq!((row.id, row.input.bytes), (id, 5));
            newer.finish(row.claim(), success(&row)).await.unwrap();
            let told: String =
                older.query_one("SELECT state FROM jobs WHERE id = $1", &[&Uuid::from(id)]).await.unwrap().get(0);
            assert_eq!(told, "succeeded");
        }
        let row = running(&newer, job()).await;
        assert!(finish_as_version_1(&older, row.id, i64::from(row.epoch)).await);
        assert_eq!(newer.finish(row.claim(), success(&row)).await, VOID, "it has ended");
        assert_eq!(state(&newer, row.id).await, JobState::Failed);
    }
}
