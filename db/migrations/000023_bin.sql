-- migrate:up

-- The Bin: models and layers that were deleted stay here as they were until they are erased. Everything but the Bin reads and writes `models` and
-- `layers`, which are views of those that are not in it, so that nothing can forget to leave the others out. What hangs on them (edits, tiles, sums,
-- views, comments …) stays where it is and is found by no way that begins with a model or layer. A column that is added to one of the tables is
-- added to its view.
ALTER TABLE models RENAME TO all_models;
ALTER TABLE layers RENAME TO all_layers;

-- `erasing`: it is not in the Bin any more, and its content goes bit by bit.
ALTER TABLE all_models
  ADD COLUMN binned timestamptz,
  ADD COLUMN binned_by text,
  ADD COLUMN binned_bytes bigint,
  ADD COLUMN erasing boolean NOT NULL DEFAULT false,
  ADD CHECK ((binned IS NULL) = (binned_by IS NULL) AND (binned IS NULL) = (binned_bytes IS NULL) AND (binned IS NOT NULL OR NOT erasing)),
  DROP CONSTRAINT models_slug_key;
ALTER TABLE all_layers
  ADD COLUMN binned timestamptz,
  ADD COLUMN binned_by text,
  ADD COLUMN binned_bytes bigint,
  ADD COLUMN erasing boolean NOT NULL DEFAULT false,
  ADD CHECK ((binned IS NULL) = (binned_by IS NULL) AND (binned IS NULL) = (binned_bytes IS NULL) AND (binned IS NOT NULL OR NOT erasing)),
  DROP CONSTRAINT layers_model_id_slug_key;
-- Short names are free again.
CREATE UNIQUE INDEX models_slug ON all_models (slug) WHERE binned IS NULL;
CREATE UNIQUE INDEX layers_slug ON all_layers (model_id, slug) WHERE binned IS NULL;
CREATE INDEX layers_model ON all_layers (model_id);
CREATE INDEX models_binned ON all_models (binned) WHERE binned IS NOT NULL;
CREATE INDEX layers_binned ON all_layers (binned) WHERE binned IS NOT NULL;

CREATE VIEW models AS SELECT
    id, project_id, name, slug, unit, unit_assumed, scale_verified, up, north, crs, origin, bounds_min, bounds_max, triangles,
    vertices, area, atlas, repairs, default_resolution, inventory_number, owner, creator, captured, method, accuracy, processing,
    rights_uri, credit, geometry, sequence, version, source_download
  FROM all_models WHERE binned IS NULL;
CREATE VIEW layers AS SELECT
    id, model_id, name, slug, kind, type, resolution, unit, description, palette, opacity, visible, draw_order, sequence, version,
    table_id, expression, automatic, computed_sequence, summed, locked, visibility, review
  FROM all_layers WHERE binned IS NULL AND EXISTS (SELECT 1 FROM all_models m WHERE m.id = all_layers.model_id AND m.binned IS NULL);

-- What analysts read, of the views.
CREATE OR REPLACE VIEW analysis.models WITH (security_barrier) AS
  SELECT m.id AS model_id, m.project_id, p.name AS project, m.name AS model, m.slug::text AS slug, m.unit, m.up, nullif(m.crs, '') AS crs,
    m.area * pow(CASE m.unit WHEN 'mm' THEN 0.001 WHEN 'cm' THEN 0.01 ELSE 1 END, 2) AS area_m2, m.triangles,
    m.bounds_min[1] AS min_x, m.bounds_min[2] AS min_y, m.bounds_min[3] AS min_z,
    m.bounds_max[1] AS max_x, m.bounds_max[2] AS max_y, m.bounds_max[3] AS max_z,
    m.inventory_number, m.owner, m.creator, m.credit, m.sequence
  FROM public.models m JOIN public.projects p ON p.id = m.project_id;

CREATE OR REPLACE VIEW analysis.layers WITH (security_barrier) AS
  SELECT l.id AS layer_id, l.model_id, m.name AS model, l.name AS layer, l.slug::text AS slug, l.kind, l.type, l.resolution, l.unit,
    l.description, l.table_id, l.sequence, l.summed AS areas_current
  FROM public.layers l JOIN public.models m ON m.id = l.model_id WHERE l.visibility = 'public';

CREATE OR REPLACE VIEW analysis.areas WITH (security_barrier) AS
  SELECT s.layer_id, l.model_id, m.name AS model, l.name AS layer, l.table_id, s.key, s.texels,
    s.area * pow(u.metres, 2) AS area_m2,
    s.moment_x / nullif(s.area, 0) + m.origin[1] AS centroid_x,
    s.moment_y / nullif(s.area, 0) + m.origin[2] AS centroid_y,
    s.moment_z / nullif(s.area, 0) + m.origin[3] AS centroid_z,
    s.low_x + m.origin[1] AS min_x, s.low_y + m.origin[2] AS min_y, s.low_z + m.origin[3] AS min_z,
    s.high_x + m.origin[1] AS max_x, s.high_y + m.origin[2] AS max_y, s.high_z + m.origin[3] AS max_z
  FROM (
    SELECT t.layer_id, e.key, sum(e.texels)::bigint AS texels, sum(e.area) AS area,
      sum(e.moment_x) AS moment_x, sum(e.moment_y) AS moment_y, sum(e.moment_z) AS moment_z,
      min(e.low_x) AS low_x, min(e.low_y) AS low_y, min(e.low_z) AS low_z,
      max(e.high_x) AS high_x, max(e.high_y) AS high_y, max(e.high_z) AS high_z
    FROM public.tile_sums t,
      unnest(t.keys, t.texels, t.areas, t.moments_x, t.moments_y, t.moments_z, t.low_x, t.low_y, t.low_z, t.high_x, t.high_y, t.high_z)
        AS e (key, texels, area, moment_x, moment_y, moment_z, low_x, low_y, low_z, high_x, high_y, high_z)
    GROUP BY t.layer_id, e.key
  ) s
  JOIN public.layers l ON l.id = s.layer_id AND l.summed AND l.visibility = 'public'
  JOIN public.models m ON m.id = l.model_id
  CROSS JOIN LATERAL (SELECT CASE m.unit WHEN 'mm' THEN 0.001 WHEN 'cm' THEN 0.01 ELSE 1 END::double precision AS metres) u;

CREATE OR REPLACE VIEW analysis.edits WITH (security_barrier) AS
  SELECT e.model_id, m.name AS model, e.layer_id, l.name AS layer, e.sequence, e.time, e.user_name AS "user", e.op, e.in_force,
    (e.answer ->> 'texels_changed')::bigint AS texels_changed, (e.answer ->> 'area_m2')::double precision AS area_m2, e.review
  FROM public.edits e JOIN public.models m ON m.id = e.model_id JOIN public.layers l ON l.id = e.layer_id AND l.visibility = 'public';

-- Into the Bin and out of it is told; what leaves it for ever was told when it came.
CREATE FUNCTION bin_is_activity() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  thing jsonb := to_jsonb(NEW);
  line activities;
  of_project bigint := (thing ->> 'project_id')::bigint;
BEGIN
  IF TG_ARGV[0] = 'layer' THEN
    SELECT m.project_id INTO of_project FROM all_models m WHERE m.id = NEW.model_id;
    UPDATE activities SET visibility = NEW.visibility WHERE model_id = NEW.model_id AND layer_id = NEW.id;
  END IF;
  line := activity_of(of_project, TG_ARGV[0], CASE WHEN NEW.binned IS NULL THEN 'restored' ELSE 'deleted' END, NEW.name);
  IF TG_ARGV[0] = 'layer' THEN
    line.model_id := NEW.model_id;
    line.layer_id := NEW.id;
    line.visibility := NEW.visibility;
  ELSE
    line.model_id := NEW.id;
  END IF;
  PERFORM note_activity(line);
  RETURN NULL;
END $$;
CREATE TRIGGER layer_in_bin_is_activity AFTER UPDATE OF binned ON all_layers FOR EACH ROW
  WHEN ((OLD.binned IS NULL) <> (NEW.binned IS NULL)) EXECUTE FUNCTION bin_is_activity('layer');
CREATE TRIGGER model_in_bin_is_activity AFTER UPDATE OF binned ON all_models FOR EACH ROW
  WHEN ((OLD.binned IS NULL) <> (NEW.binned IS NULL)) EXECUTE FUNCTION bin_is_activity('model');

DROP TRIGGER layer_is_activity ON all_layers;
CREATE TRIGGER layer_is_activity AFTER INSERT OR UPDATE OF
  name, slug, type, unit, description, palette, opacity, visible, draw_order, expression, automatic, locked, review, visibility ON all_layers
  FOR EACH ROW EXECUTE FUNCTION thing_is_activity('layer');
CREATE TRIGGER layer_gone_is_activity AFTER DELETE ON all_layers
  FOR EACH ROW WHEN (OLD.binned IS NULL) EXECUTE FUNCTION thing_is_activity('layer');
DROP TRIGGER model_is_activity ON all_models;
CREATE TRIGGER model_is_activity AFTER INSERT OR UPDATE OF name, slug, project_id, unit, unit_assumed, scale_verified, up, north,
  crs, default_resolution, inventory_number, owner, creator, captured, method, accuracy, processing, rights_uri, credit, source_download ON all_models
  FOR EACH ROW EXECUTE FUNCTION thing_is_activity('model');
CREATE TRIGGER model_gone_is_activity AFTER DELETE ON all_models
  FOR EACH ROW WHEN (OLD.binned IS NULL) EXECUTE FUNCTION thing_is_activity('model');
