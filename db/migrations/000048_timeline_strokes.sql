-- migrate:up
-- readable-from: 44

-- The timeline counts strokes, because a merged stroke has fewer edits. As before (000036_timeline.sql), it reads only the index.
--
-- The new index is built before the old one is dropped. The build blocks only statements that write to edits. DROP INDEX blocks
-- all statements until the end of the transaction, and takes only milliseconds at the end.
CREATE INDEX edits_timeline_strokes ON edits (model_id, time) INCLUDE (sequence, layer_id, user_name, stroke);
DROP INDEX edits_timeline;
ALTER INDEX edits_timeline_strokes RENAME TO edits_timeline;
