-- migrate:up
-- readable-from: 44

-- Jobs that clean up the regions of a layer or create records of its pieces, and jobs that compare a
-- layer with another survey (`changes`). Programs that lack this migration can read these jobs, too.
-- They only show another message for a job that ended because the server restarted.
ALTER TABLE jobs
  DROP CONSTRAINT jobs_kind_check,
  ADD CONSTRAINT jobs_kind_check CHECK (kind IN ('import', 'layers', 'look', 'figure', 'regions', 'changes'));
-- Earlier programs stored these jobs as jobs on layers. Only their reports name an operation.
UPDATE jobs SET kind = 'regions' WHERE kind = 'layers' AND result -> 'report' ? 'operation';
