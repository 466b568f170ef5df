//! The tables, and how those of an older version become newer ones: one step of SQL for each version, all in one
//! transaction that one server makes while others wait.

use deadpool_postgres::Client;

use super::PostgresOpenError;
use super::locks::SCHEMA;

/// What makes version `n + 1` out of version `n`.
struct SchemaMigration {
    sql: &'static str,
    /// The oldest version whose programs work with the tables after this step: a step adds what older programs do not see,
    /// and a later one, when none of them runs any more, takes away what they needed.
    oldest: i64,
}

/// Steps are added, never changed.
const STEPS: &[SchemaMigration] = &[
    SchemaMigration { sql: include_str!("schema.sql"), oldest: 1 },
    SchemaMigration { sql: include_str!("uploads.sql"), oldest: 1 },
    // Jobs that did the same come in the order in which they are looked at, the latest first.
    SchemaMigration {
        sql: "DROP INDEX jobs_by_input;
            CREATE INDEX jobs_by_input ON jobs (input_sha256, operation, coalesce(owner, ''), id)
                WHERE state = 'succeeded';",
        oldest: 1,
    },
];

/// The SQL of each step and the oldest version whose programs work after it.
#[cfg(test)]
pub(in crate::jobs) fn schema_steps() -> impl Iterator<Item = (&'static str, i64)> {
    STEPS.iter().map(|step| (step.sql, step.oldest))
}

/// Brings the tables to the newest version, all steps or none.
pub(super) async fn migrate(client: &Client) -> Result<(), PostgresOpenError> {
    client.batch_execute("BEGIN").await?;
    let migrated = migrate_within(client).await;
    let end = if migrated.is_ok() { "COMMIT" } else { "ROLLBACK" };
    client.batch_execute(end).await.map_err(PostgresOpenError::from).and(migrated)
}

async fn migrate_within(client: &Client) -> Result<(), PostgresOpenError> {
    let known = i64::try_from(STEPS.len()).unwrap_or(i64::MAX);
    client.execute("SELECT pg_advisory_xact_lock($1, 0)", &[&SCHEMA]).await?;
    let has_versions = client.query_one("SELECT to_regclass('versions') IS NOT NULL", &[]).await?;
    let (found, oldest): (i64, i64) = if has_versions.try_get(0)? {
        let sql = "SELECT coalesce(max(number), 0), coalesce(max(oldest), 0) FROM versions";
        let row = client.query_one(sql, &[]).await?;
        (row.try_get(0)?, row.try_get(1)?)
    } else {
        client
            .batch_execute("CREATE TABLE versions (number BIGINT PRIMARY KEY, oldest BIGINT NOT NULL)")
            .await?;
        (0, 0)
    };
    if oldest > known {
        return Err(PostgresOpenError::TooNew { found, oldest, known });
    }
    for (number, step) in (1..).zip(STEPS).skip_while(|&(number, _)| number <= found) {
        let number: i64 = number;
        client.batch_execute(step.sql).await?;
        client.execute("INSERT INTO versions VALUES ($1, $2)", &[&number, &step.oldest]).await?;
        tracing::info!(version = number, "the tables of jobs are brought to a new version");
    }
    Ok(())
}
