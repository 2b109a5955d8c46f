-- migrate:up

-- Named views of a model: where from, and what is shown how. `content` is what the protocol's View has of camera, layers, looks and light; layers
-- and looks are named by id, and those that are gone by then are left out when a view is read.
CREATE TABLE views (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  model_id bigint NOT NULL REFERENCES models ON DELETE CASCADE,
  slug text NOT NULL,
  name text NOT NULL CHECK (char_length(name) BETWEEN 1 AND 200),
  text text NOT NULL DEFAULT '' CHECK (char_length(text) <= 10000),
  content jsonb NOT NULL,
  user_name text NOT NULL,
  time timestamptz NOT NULL DEFAULT clock_timestamp(),
  version bigint NOT NULL DEFAULT 1,
  UNIQUE (model_id, slug)
);
