-- migrate:up
-- readable-from: 44

-- Jobs that run several steps of an analysis. Programs that lack this migration can read these jobs,
-- too. They return the report of an analysis as `report`, and show another message for a job that
-- ended because the server restarted. If they change the expression of a layer, it keeps its analysis.
ALTER TABLE jobs
  DROP CONSTRAINT jobs_kind_check,
  ADD CONSTRAINT jobs_kind_check CHECK (kind IN ('import', 'layers', 'look', 'figure', 'regions', 'changes', 'analysis'));
-- The analysis that computed the layer: its `name`, the number of the `step`, the number `of` steps,
-- and the id of the `job`.
ALTER TABLE layer_origins ADD COLUMN analysis jsonb CHECK (jsonb_typeof(analysis) = 'object');
