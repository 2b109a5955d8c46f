-- migrate:up
-- readable-from: 44

-- Objects that were surveyed several times, such as a bust. Each model of an object is one survey of it.
CREATE TABLE objects (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  project_id bigint NOT NULL REFERENCES projects ON DELETE CASCADE,
  name text NOT NULL CHECK (char_length(name) BETWEEN 1 AND 255),
  version bigint NOT NULL DEFAULT 1,
  UNIQUE (project_id, id)
);
CREATE UNIQUE INDEX objects_name ON objects (project_id, lower(name));

ALTER TABLE all_models
  ADD COLUMN object_id bigint,
  -- the day, month or year of the survey: 2019-05-01, 2019-05 or 2019. Empty: the model belongs to no object
  ADD COLUMN survey_date text NOT NULL DEFAULT '' CHECK (survey_date ~ '^([0-9]{4}(-[0-9]{2}){0,2})?$'),
  ADD CONSTRAINT models_survey_check CHECK ((object_id IS NULL) = (survey_date = '')),
  -- a model and its object are in the same project
  ADD CONSTRAINT models_object_fkey FOREIGN KEY (project_id, object_id) REFERENCES objects (project_id, id);
CREATE INDEX models_object ON all_models (object_id) WHERE object_id IS NOT NULL;

CREATE OR REPLACE VIEW models AS SELECT
    id, project_id, name, slug, unit, unit_assumed, scale_verified, up, north, crs, origin, bounds_min, bounds_max, triangles,
    vertices, area, atlas, repairs, default_resolution, inventory_number, owner, creator, captured, method, accuracy, processing,
    rights_uri, credit, geometry, sequence, version, source_download, proposal, open_edges, owner_node, owner_epoch, object_id, survey_date
  FROM all_models WHERE binned IS NULL;

DROP TRIGGER model_is_activity ON all_models;
CREATE TRIGGER model_is_activity AFTER INSERT OR UPDATE OF name, slug, project_id, unit, unit_assumed, scale_verified, up, north,
  crs, default_resolution, inventory_number, owner, creator, captured, method, accuracy, processing, rights_uri, credit, source_download,
  object_id, survey_date ON all_models
  FOR EACH ROW EXECUTE FUNCTION thing_is_activity('model');

CREATE OR REPLACE VIEW analysis.models WITH (security_barrier) AS
  SELECT m.id AS model_id, m.project_id, p.name AS project, m.name AS model, m.slug::text AS slug, m.unit, m.up, nullif(m.crs, '') AS crs,
    m.area * pow(CASE m.unit WHEN 'mm' THEN 0.001 WHEN 'cm' THEN 0.01 ELSE 1 END, 2) AS area_m2, m.triangles,
    m.bounds_min[1] AS min_x, m.bounds_min[2] AS min_y, m.bounds_min[3] AS min_z,
    m.bounds_max[1] AS max_x, m.bounds_max[2] AS max_y, m.bounds_max[3] AS max_z,
    m.inventory_number, m.owner, m.creator, m.credit, m.sequence, analysis.srid(m.crs) AS srid,
    o.name AS object, nullif(m.survey_date, '') AS survey_date
  FROM public.models m JOIN public.projects p ON p.id = m.project_id LEFT JOIN public.objects o ON o.id = m.object_id;
