//! The tables, and how an older file becomes a newer one: one step of SQL for each version.

use rusqlite::Connection;

/// Step `n` makes version `n + 1` out of version `n`, which `user_version` names. Steps are added, never changed.
const MIGRATIONS: &[&str] = &[
    // Times are milliseconds since 1970, digests 32 bytes; what is only kept and given back is JSON.
    "CREATE TABLE jobs (
        id TEXT PRIMARY KEY,
        owner TEXT,
        operation TEXT NOT NULL,
        options TEXT NOT NULL,
        file_name TEXT,
        labels TEXT NOT NULL,
        webhook TEXT,
        input TEXT NOT NULL,
        input_sha256 BLOB NOT NULL,
        material TEXT,
        lane INTEGER NOT NULL,
        state TEXT NOT NULL,
        epoch INTEGER NOT NULL DEFAULT 0,
        attempts INTEGER NOT NULL DEFAULT 0,
        worker TEXT,
        lease_until INTEGER,
        -- The ending that a caller asked for while the job ran.
        stop TEXT,
        created_at INTEGER NOT NULL,
        cancel_at INTEGER,
        started_at INTEGER,
        finished_at INTEGER,
        keep_for INTEGER NOT NULL,
        expires_at INTEGER,
        ending TEXT,
        -- The engine that ended it.
        engine TEXT,
        is_cached INTEGER NOT NULL,
        idempotency_key TEXT,
        fingerprint BLOB
    );
    CREATE INDEX jobs_queued ON jobs (id) WHERE state = 'queued';
    CREATE INDEX jobs_running ON jobs (lease_until) WHERE state = 'running';
    CREATE INDEX jobs_ended ON jobs (finished_at, id) WHERE finished_at IS NOT NULL;
    CREATE INDEX jobs_with_files ON jobs (finished_at, id)
        WHERE finished_at IS NOT NULL AND state <> 'expired';
    CREATE INDEX jobs_expiring ON jobs (expires_at) WHERE expires_at IS NOT NULL AND state <> 'expired';
    CREATE INDEX jobs_by_input ON jobs (input_sha256) WHERE state = 'succeeded';
    CREATE INDEX jobs_by_owner ON jobs (owner, id);
    CREATE UNIQUE INDEX jobs_by_key ON jobs (coalesce(owner, ''), idempotency_key)
        WHERE idempotency_key IS NOT NULL;

    CREATE TABLE labels (
        job TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
        name TEXT NOT NULL,
        value TEXT NOT NULL,
        PRIMARY KEY (job, name)
    ) WITHOUT ROWID;

    -- Which row names which blob.
    CREATE TABLE names (
        job TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
        key TEXT NOT NULL,
        blob TEXT NOT NULL,
        PRIMARY KEY (job, key)
    ) WITHOUT ROWID;
    CREATE INDEX names_by_key ON names (key);

    CREATE TABLE changes (
        job TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
        number INTEGER NOT NULL,
        state TEXT NOT NULL,
        epoch INTEGER NOT NULL,
        at INTEGER NOT NULL,
        PRIMARY KEY (job, number)
    ) WITHOUT ROWID;

    CREATE TABLE deliveries (
        id TEXT PRIMARY KEY,
        job TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
        webhook TEXT NOT NULL,
        state TEXT NOT NULL,
        created_at INTEGER NOT NULL,
        next_at INTEGER,
        epoch INTEGER NOT NULL DEFAULT 0
    );
    CREATE INDEX deliveries_by_job ON deliveries (job);
    CREATE INDEX deliveries_due ON deliveries (next_at) WHERE next_at IS NOT NULL;

    CREATE TABLE tries (
        delivery TEXT NOT NULL REFERENCES deliveries (id) ON DELETE CASCADE,
        number INTEGER NOT NULL,
        at INTEGER NOT NULL,
        status INTEGER,
        error TEXT,
        PRIMARY KEY (delivery, number)
    ) WITHOUT ROWID;

    -- How many jobs are in each state: counting them anew for each request would take longer the more there are.
    CREATE TABLE tallies (state TEXT PRIMARY KEY, jobs INTEGER NOT NULL) WITHOUT ROWID;
    CREATE TRIGGER tally_insert AFTER INSERT ON jobs BEGIN
        INSERT INTO tallies VALUES (new.state, 1) ON CONFLICT DO UPDATE SET jobs = jobs + 1;
    END;
    CREATE TRIGGER tally_delete AFTER DELETE ON jobs BEGIN
        UPDATE tallies SET jobs = jobs - 1 WHERE state = old.state;
    END;
    CREATE TRIGGER tally_update AFTER UPDATE OF state ON jobs WHEN old.state <> new.state BEGIN
        UPDATE tallies SET jobs = jobs - 1 WHERE state = old.state;
        INSERT INTO tallies VALUES (new.state, 1) ON CONFLICT DO UPDATE SET jobs = jobs + 1;
    END;",
    // Who receives a webhook: what stands between `://` and the next slash of its URL.
    "ALTER TABLE deliveries ADD COLUMN receiver TEXT GENERATED ALWAYS AS (lower(substr(
        substr(webhook ->> 'url', instr(webhook ->> 'url', '://') + 3), 1,
        instr(substr(webhook ->> 'url', instr(webhook ->> 'url', '://') + 3) || '/', '/') - 1)));
    CREATE INDEX deliveries_by_receiver ON deliveries (receiver, next_at, id) WHERE next_at IS NOT NULL;
    -- The `traceparent` of its request.
    ALTER TABLE jobs ADD COLUMN trace TEXT;",
    // Who is charged with a job, what that comes to, and the mark by which the store knows its files.
    include_str!("tenants.sql"),
    // Uploads that come before their job.
    include_str!("uploads.sql"),
    // Jobs that did the same come in the order in which they are looked at, the latest first.
    "DROP INDEX jobs_by_input;
    CREATE INDEX jobs_by_input ON jobs (input_sha256, operation, owner, id) WHERE state = 'succeeded';",
];

/// A file that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SqliteOpenError {
    /// SQLite says why.
    #[error(transparent)]
    Sqlite(#[from] rusqlite::Error),
    /// The system says why.
    #[error(transparent)]
    File(std::io::Error),
    /// A newer program made it.
    #[error("its version is {found}; this program knows versions up to {known}")]
    TooNew {
        /// Its version.
        found: usize,
        /// The newest one known.
        known: usize,
    },
}

/// Brings the file to the newest version, all steps or none.
pub(super) fn migrate(connection: &mut Connection) -> Result<(), SqliteOpenError> {
    let known = MIGRATIONS.len();
    let transaction = connection.transaction()?;
    let found: i64 = transaction.pragma_query_value(None, "user_version", |row| row.get(0))?;
    let found = usize::try_from(found).unwrap_or_default();
    if found > known {
        return Err(SqliteOpenError::TooNew { found, known });
    }
    if found == known {
        // Nothing is written: also a full disk lets a server start.
        return Ok(());
    }
    for step in &MIGRATIONS[found..] {
        transaction.execute_batch(step)?;
    }
    transaction.pragma_update(None, "user_version", i64::try_from(known).unwrap_or_default())?;
    Ok(transaction.commit()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_brought_to_the_newest_version_once() {
        let mut connection = Connection::open_in_memory().unwrap();
        migrate(&mut connection).unwrap();
        migrate(&mut connection).unwrap();
        let version: i64 = connection.pragma_query_value(None, "user_version", |row| row.get(0)).unwrap();
        assert_eq!(version, MIGRATIONS.len() as i64);
    }

    #[test]
    fn deliveries_of_the_first_version_get_their_receivers() {
        let mut connection = Connection::open_in_memory().unwrap();
        connection.pragma_update(None, "foreign_keys", "OFF").unwrap();
        connection.execute_batch(MIGRATIONS[0]).unwrap();
        connection.pragma_update(None, "user_version", 1).unwrap();
        for (url, receiver) in [
            ("https://Shop.example/hooks/1", "shop.example"),
            ("http://127.0.0.1:8000", "127.0.0.1:8000"),
            ("https://[::1]:9/a//b", "[::1]:9"),
        ] {
            let webhook = serde_json::json!({ "url": url }).to_string();
            connection
                .execute_batch(&format!(
                    "INSERT INTO deliveries VALUES ('{receiver}', 'job', '{webhook}', 'pending', 0, 0, 0)"
                ))
                .unwrap();
        }
        migrate(&mut connection).unwrap();
        let mut found = connection.prepare("SELECT id, receiver FROM deliveries").unwrap();
        let mut rows = found.query([]).unwrap();
        for _ in 0..3 {
            let row = rows.next().unwrap().unwrap();
            assert_eq!(row.get::<_, String>(0).unwrap(), row.get::<_, String>(1).unwrap());
        }
    }

    #[test]
    fn a_file_of_a_newer_program_is_left_alone() {
        let mut connection = Connection::open_in_memory().unwrap();
        connection.pragma_update(None, "user_version", 1000).unwrap();
        let error = migrate(&mut connection).unwrap_err();
        assert!(matches!(error, SqliteOpenError::TooNew { found: 1000, .. }), "{error}");
    }
}
