-- migrate:up
-- readable-from: 44

-- Programs that lack this migration would delete the images of photographs, or their files outside the database. Before the first image, the server
-- sets `readable_from` of this migration accordingly.

-- Photographs of a model, with the poses of their cameras (server/store/content/photographs.h).
CREATE TABLE photographs (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  model_id bigint NOT NULL REFERENCES all_models ON DELETE CASCADE,
  name text COLLATE "C" NOT NULL CHECK (octet_length(name) BETWEEN 1 AND 1024),
  -- the calibration as the export states it, which may be for another size of the photograph
  lens text NOT NULL CHECK (lens IN ('pinhole', 'brown', 'rational', 'fisheye', 'division')),
  -- pixel: lengths are in pixels; longest_side: in longest sides of the photograph
  unit text NOT NULL CHECK (unit IN ('pixel', 'longest_side')),
  -- pixels; 0: the export does not state the size
  calibrated_width integer NOT NULL CHECK (calibrated_width >= 0),
  calibrated_height integer NOT NULL CHECK (calibrated_height >= 0),
  -- focal x and y, offset x and y, skew, 6 radial and 4 tangential coefficients
  calibration float8[] NOT NULL CHECK (cardinality(calibration) = 15),
  -- the rotation from world to camera axes row by row, and the center in world coordinates
  pose float8[] NOT NULL CHECK (cardinality(pose) = 12),
  -- the original; null: there is only a pose
  sha256 bytea REFERENCES blobs,
  media_type text,
  width integer,
  height integer,
  version bigint NOT NULL DEFAULT 1,
  UNIQUE (model_id, name),
  CHECK (num_nulls(sha256, media_type, width, height) IN (0, 4))
);
CREATE INDEX photographs_blob ON photographs (sha256) WHERE sha256 IS NOT NULL;

-- One row for all photographs that a statement deletes. None for those that disappear with their model.
CREATE FUNCTION photograph_deletion_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  IF coalesce(nullif(current_setting('strata.actor', true), ''), activity_author()) = '' THEN
    RETURN NULL;
  END IF;
  PERFORM audit('deletion', 'photograph', CASE WHEN part.photographs = 1 THEN part.id END,
    CASE WHEN part.photographs = 1 THEN part.name ELSE '' END, part.project_id,
    jsonb_build_object('model', part.model_id, 'photographs', part.photographs))
  FROM (
    SELECT m.id AS model_id, m.project_id, count(*) AS photographs, min(g.id) AS id, min(g.name) AS name
    FROM gone g JOIN all_models m ON m.id = g.model_id AND NOT m.erasing GROUP BY m.id, m.project_id
  ) part;
  RETURN NULL;
END $$;
CREATE TRIGGER photograph_deletion_is_audited AFTER DELETE ON photographs REFERENCING OLD TABLE AS gone
  FOR EACH STATEMENT EXECUTE FUNCTION photograph_deletion_is_audited();
