-- migrate:up

-- A token for scripts that is good in one project alone goes with it.
ALTER TABLE tokens ADD COLUMN project_id bigint REFERENCES projects ON DELETE CASCADE CHECK (project_id IS NULL OR kind = 'script');
CREATE INDEX tokens_project ON tokens (project_id) WHERE project_id IS NOT NULL;
