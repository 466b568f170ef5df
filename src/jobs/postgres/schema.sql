-- Times are milliseconds since 1970, digests 32 bytes; what is only kept and given back is JSON as text, in which no character
-- is refused. Texts of callers outside of it are JSON too: PostgreSQL takes no text with a zero byte.

-- The mark that the files of this store have too.
CREATE TABLE identity (mark TEXT NOT NULL);
INSERT INTO identity VALUES (replace(gen_random_uuid()::text, '-', ''));

-- The clock of every time in these tables.
CREATE FUNCTION now_ms() RETURNS bigint LANGUAGE sql VOLATILE
    AS $$ SELECT floor(extract(epoch FROM clock_timestamp()) * 1000)::bigint $$;

-- Whose turn it was last: each claim has a number.
CREATE SEQUENCE turns;

CREATE TABLE jobs (
    id UUID PRIMARY KEY,
    owner TEXT,
    tenant TEXT NOT NULL,
    operation TEXT NOT NULL,
    options TEXT NOT NULL,
    file_name TEXT,
    labels TEXT NOT NULL,
    webhook TEXT,
    trace TEXT,
    input TEXT NOT NULL,
    input_sha256 BYTEA NOT NULL,
    input_bytes NUMERIC(20) NOT NULL,
    -- Of all files that it names.
    file_bytes NUMERIC(40) NOT NULL DEFAULT 0,
    material TEXT,
    lane BIGINT NOT NULL,
    state TEXT NOT NULL,
    epoch BIGINT NOT NULL DEFAULT 0,
    attempts BIGINT NOT NULL DEFAULT 0,
    worker TEXT,
    lease_until BIGINT,
    -- The ending that a caller asked for while the job ran.
    stop TEXT,
    turn BIGINT,
    -- It runs in a slot for small ones that somebody waits for.
    is_quick BOOLEAN NOT NULL DEFAULT false,
    -- A run of it took more memory than was thought.
    is_outgrown BOOLEAN NOT NULL DEFAULT false,
    created_at BIGINT NOT NULL,
    cancel_at BIGINT,
    started_at BIGINT,
    finished_at BIGINT,
    keep_for BIGINT NOT NULL,
    expires_at BIGINT,
    ending TEXT,
    -- The engine that ended it.
    engine TEXT,
    is_cached BOOLEAN NOT NULL DEFAULT false,
    idempotency_key TEXT,
    fingerprint BYTEA
);
CREATE INDEX jobs_queued ON jobs (tenant, lane, id) WHERE state = 'queued';
CREATE INDEX jobs_running ON jobs (tenant, is_quick) WHERE state = 'running';
CREATE INDEX jobs_open ON jobs (state) INCLUDE (input_bytes) WHERE state IN ('queued', 'running');
CREATE INDEX jobs_by_tenant ON jobs (tenant) INCLUDE (state, input_bytes, file_bytes);
CREATE INDEX jobs_by_turn ON jobs (tenant, turn) WHERE turn IS NOT NULL;
CREATE INDEX jobs_ended ON jobs (tenant, finished_at, id) WHERE finished_at IS NOT NULL;
CREATE INDEX jobs_expiring ON jobs (expires_at) WHERE expires_at IS NOT NULL AND state <> 'expired';
CREATE INDEX jobs_by_input ON jobs (input_sha256) WHERE state = 'succeeded';
CREATE INDEX jobs_by_owner ON jobs (owner, id);
CREATE UNIQUE INDEX jobs_by_key ON jobs (coalesce(owner, ''), idempotency_key) WHERE idempotency_key IS NOT NULL;

CREATE TABLE labels (
    job UUID NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
    name TEXT NOT NULL,
    value TEXT NOT NULL,
    PRIMARY KEY (job, name)
);

-- Which row names which blob.
CREATE TABLE names (
    job UUID NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
    key TEXT NOT NULL,
    bytes NUMERIC(20) NOT NULL,
    blob TEXT NOT NULL,
    PRIMARY KEY (job, key)
);
CREATE INDEX names_by_key ON names (key);

CREATE TABLE changes (
    job UUID NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
    number BIGINT NOT NULL,
    state TEXT NOT NULL,
    epoch BIGINT NOT NULL,
    at BIGINT NOT NULL,
    PRIMARY KEY (job, number)
);

CREATE TABLE deliveries (
    id TEXT PRIMARY KEY,
    job UUID NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
    webhook TEXT NOT NULL,
    -- What stands between `://` and the next slash of its URL.
    receiver TEXT NOT NULL,
    state TEXT NOT NULL,
    created_at BIGINT NOT NULL,
    next_at BIGINT,
    epoch BIGINT NOT NULL DEFAULT 0
);
CREATE INDEX deliveries_by_job ON deliveries (job);
CREATE INDEX deliveries_due ON deliveries (next_at) WHERE next_at IS NOT NULL;
CREATE INDEX deliveries_by_receiver ON deliveries (receiver, next_at, id) WHERE next_at IS NOT NULL;

CREATE TABLE tries (
    delivery TEXT NOT NULL REFERENCES deliveries (id) ON DELETE CASCADE,
    number BIGINT NOT NULL,
    at BIGINT NOT NULL,
    status INTEGER,
    error TEXT,
    PRIMARY KEY (delivery, number)
);
