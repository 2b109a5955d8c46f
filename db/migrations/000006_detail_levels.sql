-- migrate:up

-- Coarser copies of a model's geometry for moving cameras: level 1 is the finest of them.
CREATE TABLE detail_levels (
  model_id bigint NOT NULL REFERENCES models ON DELETE CASCADE,
  level integer NOT NULL CHECK (level > 0),
  geometry bytea NOT NULL REFERENCES blobs,
  PRIMARY KEY (model_id, level)
);
CREATE INDEX detail_levels_geometry ON detail_levels (geometry);
