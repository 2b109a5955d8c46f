-- migrate:up

-- Tours of a model: its named views one after the other, with what is said of each. `content` is what the protocol's Tour has of languages, the time until it plays by
-- itself, and stops; views, layers, tables and columns are named by id, and those that are gone by then are left out when a tour is read.
CREATE TABLE tours (
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

-- Screens that show one tour to whoever stands before them, each by a secret link of which the SHA-256 is kept.
CREATE TABLE kiosks (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  tour_id bigint NOT NULL REFERENCES tours ON DELETE CASCADE,
  hash bytea NOT NULL UNIQUE CHECK (octet_length(hash) = 32),
  name text NOT NULL CHECK (char_length(name) BETWEEN 1 AND 200),
  user_name text NOT NULL,
  created timestamptz NOT NULL DEFAULT clock_timestamp(),
  expires timestamptz,
  last_seen timestamptz,
  revoked timestamptz,
  wants_reload boolean NOT NULL DEFAULT false
);
CREATE INDEX kiosks_by_tour ON kiosks (tour_id);
