-- Uploads that come before their job. `received`: bytes that are stored; `is_presigned`: the caller writes the file to the
-- bucket.
CREATE TABLE uploads (
    id UUID PRIMARY KEY,
    owner TEXT,
    tenant TEXT NOT NULL,
    file_name TEXT,
    metadata TEXT,
    length BIGINT NOT NULL,
    received BIGINT NOT NULL DEFAULT 0,
    is_presigned BOOLEAN NOT NULL,
    -- The job that has taken its files.
    job UUID REFERENCES jobs (id) ON DELETE CASCADE,
    expires_at BIGINT NOT NULL
);
CREATE INDEX uploads_open ON uploads (tenant) INCLUDE (length, received, is_presigned) WHERE job IS NULL;
CREATE INDEX uploads_by_job ON uploads (job) WHERE job IS NOT NULL;
CREATE INDEX uploads_expiring ON uploads (expires_at);

-- The files that an upload is made of.
CREATE TABLE pieces (
    upload UUID NOT NULL REFERENCES uploads (id) ON DELETE CASCADE,
    number BIGINT NOT NULL,
    key TEXT NOT NULL,
    blob TEXT NOT NULL,
    PRIMARY KEY (upload, number)
);
CREATE INDEX pieces_by_key ON pieces (key);
