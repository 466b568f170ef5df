-- Uploads that come before their job. `received`: bytes that are stored; `is_presigned`: the caller writes the file to a bucket.
CREATE TABLE uploads (
    id TEXT PRIMARY KEY,
    owner TEXT,
    tenant TEXT NOT NULL,
    file_name TEXT,
    metadata TEXT,
    length INTEGER NOT NULL,
    received INTEGER NOT NULL DEFAULT 0,
    is_presigned INTEGER NOT NULL,
    -- The job that has taken its files.
    job TEXT REFERENCES jobs (id) ON DELETE CASCADE,
    expires_at INTEGER NOT NULL
);
-- With all that the sums over open uploads need. `job` is in it because SQLite asks for it although it is always null.
CREATE INDEX uploads_open ON uploads (job, tenant, is_presigned, length, received) WHERE job IS NULL;
CREATE INDEX uploads_by_job ON uploads (job) WHERE job IS NOT NULL;
CREATE INDEX uploads_expiring ON uploads (expires_at);

-- The files that an upload is made of.
CREATE TABLE pieces (
    upload TEXT NOT NULL REFERENCES uploads (id) ON DELETE CASCADE,
    number INTEGER NOT NULL,
    key TEXT NOT NULL,
    blob TEXT NOT NULL,
    PRIMARY KEY (upload, number)
) WITHOUT ROWID;
CREATE INDEX pieces_by_key ON pieces (key);
