-- migrate:up
-- readable-from: 44

-- The timeline counts strokes, because a merged stroke has fewer edits. As before (000036_timeline.sql), it reads only the index.
DROP INDEX edits_timeline;
CREATE INDEX edits_timeline ON edits (model_id, time) INCLUDE (sequence, layer_id, user_name, stroke);
