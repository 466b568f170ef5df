-- The mark that the folder of files has too.
CREATE TABLE identity (mark TEXT NOT NULL);

-- Whom the job is charged to: the name of a key, or an address. Empty: nobody is known.
ALTER TABLE jobs ADD COLUMN tenant TEXT NOT NULL DEFAULT '';
UPDATE jobs SET tenant = 'key:' || owner WHERE owner IS NOT NULL;
-- A running job is in a slot for small ones that somebody waits for.
ALTER TABLE jobs ADD COLUMN is_quick INTEGER NOT NULL DEFAULT 0;
-- A run of it took more memory than was thought.
ALTER TABLE jobs ADD COLUMN is_outgrown INTEGER NOT NULL DEFAULT 0;
CREATE INDEX jobs_queued_by_tenant ON jobs (tenant, lane, id) WHERE state = 'queued';
CREATE INDEX jobs_ended_by_tenant ON jobs (tenant, finished_at, id) WHERE finished_at IS NOT NULL;
CREATE INDEX jobs_with_files_by_tenant ON jobs (tenant, finished_at, id)
    WHERE finished_at IS NOT NULL AND state <> 'expired';

-- What each tenant has here. `open_bytes`: uploads of jobs that have not ended; `bytes`: all files, each counted for every job
-- that names it; `served`: number of the claim by which a job of it ran last.
CREATE TABLE holdings (
    tenant TEXT PRIMARY KEY,
    jobs INTEGER NOT NULL DEFAULT 0,
    queued INTEGER NOT NULL DEFAULT 0,
    running INTEGER NOT NULL DEFAULT 0,
    open_bytes INTEGER NOT NULL DEFAULT 0,
    bytes INTEGER NOT NULL DEFAULT 0,
    served INTEGER NOT NULL DEFAULT 0
) WITHOUT ROWID;
CREATE INDEX holdings_queued ON holdings (tenant) WHERE queued > 0;
CREATE INDEX holdings_open ON holdings (open_bytes) WHERE open_bytes > 0;
CREATE INDEX holdings_by_jobs ON holdings (jobs);
CREATE INDEX holdings_by_bytes ON holdings (bytes);
INSERT INTO holdings (tenant, jobs, queued, running, open_bytes)
    SELECT tenant, count(*), sum(state = 'queued'), sum(state = 'running'),
        sum(CASE WHEN state IN ('queued', 'running') THEN input ->> 'bytes' ELSE 0 END)
    FROM jobs GROUP BY tenant;
UPDATE holdings SET bytes = coalesce((SELECT sum(names.blob ->> 'bytes') FROM names JOIN jobs ON jobs.id = names.job
    WHERE jobs.tenant = holdings.tenant), 0);

CREATE TRIGGER holding_insert AFTER INSERT ON jobs BEGIN
    INSERT INTO holdings (tenant) VALUES (new.tenant) ON CONFLICT DO NOTHING;
    UPDATE holdings SET jobs = jobs + 1, queued = queued + (new.state = 'queued'),
        running = running + (new.state = 'running'),
        open_bytes = open_bytes + iif(new.state IN ('queued', 'running'), new.input ->> 'bytes', 0)
    WHERE tenant = new.tenant;
END;
CREATE TRIGGER holding_delete AFTER DELETE ON jobs BEGIN
    UPDATE holdings SET jobs = jobs - 1, queued = queued - (old.state = 'queued'),
        running = running - (old.state = 'running'),
        open_bytes = open_bytes - iif(old.state IN ('queued', 'running'), old.input ->> 'bytes', 0)
    WHERE tenant = old.tenant;
    DELETE FROM holdings WHERE tenant = old.tenant AND jobs <= 0;
END;
CREATE TRIGGER holding_update AFTER UPDATE OF state ON jobs WHEN old.state <> new.state BEGIN
    UPDATE holdings SET queued = queued - (old.state = 'queued') + (new.state = 'queued'),
        running = running - (old.state = 'running') + (new.state = 'running'),
        open_bytes = open_bytes - iif(old.state IN ('queued', 'running'), old.input ->> 'bytes', 0)
            + iif(new.state IN ('queued', 'running'), new.input ->> 'bytes', 0)
    WHERE tenant = new.tenant;
END;
CREATE TRIGGER holding_name AFTER INSERT ON names BEGIN
    UPDATE holdings SET bytes = bytes + (new.blob ->> 'bytes')
    WHERE tenant = (SELECT tenant FROM jobs WHERE id = new.job);
END;
-- Names go before their job.
CREATE TRIGGER holding_unname AFTER DELETE ON names BEGIN
    UPDATE holdings SET bytes = bytes - (old.blob ->> 'bytes')
    WHERE tenant = (SELECT tenant FROM jobs WHERE id = old.job);
END;
