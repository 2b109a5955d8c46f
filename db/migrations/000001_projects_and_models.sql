-- migrate:up

-- A path takes an id in digits or a slug, so a slug is never all digits.
CREATE DOMAIN slug AS text CHECK (VALUE ~ '^[a-z0-9-]+$' AND VALUE !~ '^[0-9]+$');

CREATE TABLE projects (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  name text NOT NULL CHECK (name <> ''),
  slug slug NOT NULL UNIQUE,
  description text NOT NULL,
  version bigint NOT NULL DEFAULT 1
);
INSERT INTO projects (name, slug, description) VALUES ('Default', 'default', '');

-- Large immutable content, by its hash: the same scan imported twice is kept once. Chunks are at most 1 MiB, so that a
-- reader never holds more than one; they do not compress further.
CREATE TABLE blobs (
  sha256 bytea PRIMARY KEY CHECK (octet_length(sha256) = 32),
  bytes bigint NOT NULL
);
CREATE TABLE blob_chunks (
  sha256 bytea NOT NULL REFERENCES blobs ON DELETE CASCADE,
  chunk integer NOT NULL,
  data bytea NOT NULL,
  PRIMARY KEY (sha256, chunk)
);
ALTER TABLE blob_chunks ALTER COLUMN data SET STORAGE EXTERNAL;

CREATE TABLE models (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  project_id bigint NOT NULL REFERENCES projects,
  name text NOT NULL CHECK (name <> ''),
  slug slug NOT NULL UNIQUE,
  unit text NOT NULL CHECK (unit IN ('mm', 'cm', 'm')),
  unit_assumed boolean NOT NULL,
  scale_verified boolean NOT NULL,
  up text NOT NULL CHECK (up IN ('x', 'y', 'z')),
  north text NOT NULL,
  crs text NOT NULL,
  -- world coordinates in the model's unit: [x, y, z]
  origin double precision[] NOT NULL CHECK (cardinality(origin) = 3),
  bounds_min double precision[] NOT NULL CHECK (cardinality(bounds_min) = 3),
  bounds_max double precision[] NOT NULL CHECK (cardinality(bounds_max) = 3),
  triangles bigint NOT NULL,
  vertices bigint NOT NULL,
  area double precision NOT NULL,
  atlas jsonb NOT NULL,
  repairs jsonb NOT NULL,
  default_resolution integer NOT NULL,
  inventory_number text NOT NULL,
  owner text NOT NULL,
  creator text NOT NULL,
  captured text NOT NULL,
  method text NOT NULL,
  accuracy text NOT NULL,
  processing text NOT NULL,
  rights_uri text NOT NULL,
  credit text NOT NULL,
  geometry bytea NOT NULL REFERENCES blobs,
  -- of the last journal entry; the journal writer moves it by one, so that an entry can neither be lost nor come twice
  sequence bigint NOT NULL DEFAULT 0,
  version bigint NOT NULL DEFAULT 1
);
CREATE INDEX models_project ON models (project_id);
CREATE INDEX models_geometry ON models (geometry);

-- The files a model was imported from, bit for bit.
CREATE TABLE model_sources (
  model_id bigint NOT NULL REFERENCES models ON DELETE CASCADE,
  name text NOT NULL,
  position integer NOT NULL,
  sha256 bytea NOT NULL REFERENCES blobs,
  PRIMARY KEY (model_id, name)
);
CREATE INDEX model_sources_blob ON model_sources (sha256);
