-- migrate:up

-- The timeline of a model counts its edits by time, author and layer. With this index it reads no row of the journal, whose records are large.
CREATE INDEX edits_timeline ON edits (model_id, time) INCLUDE (sequence, layer_id, user_name);
