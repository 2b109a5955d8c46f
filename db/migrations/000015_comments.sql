-- migrate:up

-- Comments on a model. The first one of a thread has a place on the surface (world coordinates) and the thread's state; replies name it. A
-- first one that is deleted while it has replies stays without its text. What a person wrote goes on under the name that is left of them.
CREATE TABLE comments (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  model_id bigint NOT NULL REFERENCES models ON DELETE CASCADE,
  thread_id bigint REFERENCES comments ON DELETE CASCADE,
  position double precision[] CHECK (cardinality(position) = 3),
  normal double precision[] CHECK (cardinality(normal) = 3),
  -- what it is about; a record is one of the table
  layer_id bigint REFERENCES layers ON DELETE SET NULL,
  table_id bigint REFERENCES record_tables ON DELETE SET NULL,
  record_key bigint CHECK (record_key BETWEEN 0 AND 4294967295),
  text text NOT NULL CHECK (char_length(text) <= 10000),
  user_name text NOT NULL,
  time timestamptz NOT NULL DEFAULT clock_timestamp(),
  edited timestamptz,
  deleted timestamptz,
  resolved timestamptz,
  resolved_by text,
  -- when anything of it was changed last
  changed timestamptz NOT NULL DEFAULT clock_timestamp(),
  version bigint NOT NULL DEFAULT 1,
  CHECK ((thread_id IS NULL) = (position IS NOT NULL AND normal IS NOT NULL)),
  CHECK ((resolved IS NULL) = (resolved_by IS NULL)),
  CHECK (thread_id IS NULL OR (resolved IS NULL AND deleted IS NULL))
);
CREATE INDEX comments_model ON comments (model_id, id);
CREATE INDEX comments_thread ON comments (thread_id, id);
CREATE INDEX comments_layer ON comments (layer_id);
CREATE INDEX comments_table ON comments (table_id);
