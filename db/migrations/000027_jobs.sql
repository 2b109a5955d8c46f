-- migrate:up

-- Long work (imports, computed layers, transfers, figures), so that a job which a restart of the server ended still answers what happened to it.
-- `begun` turns into the end that it came to; what is still `begun` when a server starts was lost with the server before. Rows go after seven days.
CREATE TABLE jobs (
  id bigint PRIMARY KEY,  -- given by the server: higher than those before
  project_id bigint NOT NULL REFERENCES projects ON DELETE CASCADE,
  user_name text NOT NULL,  -- who started it; empty: the server, or nobody whom it is kept for
  kind text NOT NULL CHECK (kind IN ('import', 'layers', 'look', 'figure')),
  state text NOT NULL DEFAULT 'begun' CHECK (state IN ('begun', 'done', 'failed', 'cancelled', 'lost')),
  problem jsonb,  -- why it failed
  result jsonb,   -- what it made: ids, and what was said of them
  begun timestamptz NOT NULL DEFAULT now(),
  ended timestamptz,
  CHECK ((ended IS NULL) = (state = 'begun'))
);
CREATE INDEX jobs_begun ON jobs (state) WHERE state = 'begun';
CREATE INDEX jobs_project ON jobs (project_id);
