-- migrate:up

-- What each tile of a layer holds, key by key, for analysts who read areas with SQL: written with the revisions of the tile, in their
-- transaction, so that areas are those of the last edit that was committed, at the cost of the tiles that it touched. Model space and
-- units; a view turns them into metres. Keys of database layers and the values of layers of 8 bits are told apart; of other layers there
-- is one element, without a key.
CREATE TABLE tile_sums (
  layer_id bigint NOT NULL REFERENCES layers ON DELETE CASCADE,
  tile_y smallint NOT NULL,
  tile_x smallint NOT NULL,
  keys bigint[] NOT NULL,
  texels bigint[] NOT NULL,
  areas double precision[] NOT NULL,
  -- sums of area × coordinate
  moments_x double precision[] NOT NULL,
  moments_y double precision[] NOT NULL,
  moments_z double precision[] NOT NULL,
  low_x double precision[] NOT NULL,
  low_y double precision[] NOT NULL,
  low_z double precision[] NOT NULL,
  high_x double precision[] NOT NULL,
  high_y double precision[] NOT NULL,
  high_z double precision[] NOT NULL,
  PRIMARY KEY (layer_id, tile_y, tile_x)
);

-- False: an edit was journalled without the sums of its tiles; the server counts the layer anew.
ALTER TABLE layers ADD COLUMN summed boolean NOT NULL DEFAULT false;
UPDATE layers SET summed = true WHERE sequence = 0;
ALTER TABLE layers ALTER COLUMN summed SET DEFAULT true;
CREATE INDEX layers_unsummed ON layers (id) WHERE NOT summed;

-- The views that analysts read, with names as people say them. Readers have rights on this schema alone.
CREATE SCHEMA analysis;

-- Which view shows a project's table.
CREATE TABLE record_views (
  table_id bigint PRIMARY KEY REFERENCES record_tables ON DELETE CASCADE,
  name text NOT NULL UNIQUE
);

CREATE VIEW analysis.projects WITH (security_barrier) AS
  SELECT id AS project_id, name AS project, slug::text AS slug, description FROM public.projects;

CREATE VIEW analysis.models WITH (security_barrier) AS
  SELECT m.id AS model_id, m.project_id, p.name AS project, m.name AS model, m.slug::text AS slug, m.unit, m.up, nullif(m.crs, '') AS crs,
    m.area * pow(CASE m.unit WHEN 'mm' THEN 0.001 WHEN 'cm' THEN 0.01 ELSE 1 END, 2) AS area_m2, m.triangles,
    m.bounds_min[1] AS min_x, m.bounds_min[2] AS min_y, m.bounds_min[3] AS min_z,
    m.bounds_max[1] AS max_x, m.bounds_max[2] AS max_y, m.bounds_max[3] AS max_z,
    m.inventory_number, m.owner, m.creator, m.credit, m.sequence
  FROM public.models m JOIN public.projects p ON p.id = m.project_id;

CREATE VIEW analysis.layers WITH (security_barrier) AS
  SELECT l.id AS layer_id, l.model_id, m.name AS model, l.name AS layer, l.slug::text AS slug, l.kind, l.type, l.resolution, l.unit,
    l.description, l.table_id, l.sequence, l.summed AS areas_current
  FROM public.layers l JOIN public.models m ON m.id = l.model_id;

CREATE VIEW analysis.tables WITH (security_barrier) AS
  SELECT t.id AS table_id, t.project_id, p.name AS project, t.name AS "table", t.slug::text AS slug, v.name AS view, t.records, t.sequence
  FROM public.record_tables t JOIN public.projects p ON p.id = t.project_id LEFT JOIN public.record_views v ON v.table_id = t.id;

CREATE VIEW analysis.areas WITH (security_barrier) AS
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
  JOIN public.layers l ON l.id = s.layer_id AND l.summed
  JOIN public.models m ON m.id = l.model_id
  CROSS JOIN LATERAL (SELECT CASE m.unit WHEN 'mm' THEN 0.001 WHEN 'cm' THEN 0.01 ELSE 1 END::double precision AS metres) u;

CREATE VIEW analysis.edits WITH (security_barrier) AS
  SELECT e.model_id, m.name AS model, e.layer_id, l.name AS layer, e.sequence, e.time, e.user_name AS "user", e.op, e.in_force,
    (e.answer ->> 'texels_changed')::bigint AS texels_changed, (e.answer ->> 'area_m2')::double precision AS area_m2
  FROM public.edits e JOIN public.models m ON m.id = e.model_id JOIN public.layers l ON l.id = e.layer_id;

CREATE VIEW analysis.record_edits WITH (security_barrier) AS
  SELECT e.table_id, t.name AS "table", e.sequence, e.time, e.user_name AS "user", e.op, e.in_force,
    c.subject, c.subject_id AS key, c.before, c.after
  FROM public.table_edits e JOIN public.record_tables t ON t.id = e.table_id
  LEFT JOIN public.table_changes c ON c.table_id = e.table_id AND c.sequence = e.sequence AND c.subject = 'record';

-- An identifier of 63 bytes at most: the name, cut at a character, with the suffix.
CREATE FUNCTION analysis_name(name text, suffix text) RETURNS text LANGUAGE plpgsql IMMUTABLE AS $$
DECLARE
  kept text := left(name, 63);
BEGIN
  WHILE octet_length(kept) + octet_length(suffix) > 63 LOOP
    kept := left(kept, -1);
  END LOOP;
  RETURN kept || suffix;
END $$;

-- People who work go first: sessions of readers that hold a table which is about to change are ended.
CREATE FUNCTION analysis_make_way(held regclass) RETURNS void LANGUAGE plpgsql AS $$
BEGIN
  IF pg_has_role(current_user, 'pg_signal_backend', 'USAGE') THEN
    PERFORM pg_terminate_backend(l.pid) FROM pg_locks l JOIN pg_stat_activity a ON a.pid = l.pid
      WHERE l.locktype = 'relation' AND l.relation = held AND a.usename = 'strata_reader';
  END IF;
END $$;

-- The view of a project's table with people's names for it and its columns; names that stand already, or are too long, are told apart by
-- the numbers of ours.
CREATE FUNCTION analysis_show_table(shown bigint) RETURNS void LANGUAGE plpgsql AS $$
DECLARE
  rows_table text := 't' || shown;
  old_name text;
  new_name text;
  col record;
  col_name text;
  used text[] := ARRAY['key'];
  list text := 'key';
BEGIN
  SELECT t.name INTO new_name FROM record_tables t WHERE t.id = shown;
  IF new_name IS NULL OR to_regclass('records.' || rows_table) IS NULL THEN
    RETURN;
  END IF;
  PERFORM pg_advisory_xact_lock(hashtext('analysis_show_table'));
  SELECT v.name INTO old_name FROM record_views v WHERE v.table_id = shown;
  IF old_name IS NOT NULL AND to_regclass(format('analysis.%I', old_name)) IS NOT NULL THEN
    PERFORM analysis_make_way(to_regclass(format('analysis.%I', old_name)));
    EXECUTE format('DROP VIEW analysis.%I', old_name);
  END IF;
  new_name := analysis_name(new_name, '');
  IF to_regclass(format('analysis.%I', new_name)) IS NOT NULL THEN
    new_name := analysis_name(new_name, ' (' || rows_table || ')');
  END IF;
  FOR col IN
    SELECT c.id, c.kind, c.properties ->> 'name' AS name FROM record_columns c WHERE c.table_id = shown AND NOT c.hidden
    ORDER BY (c.properties ->> 'order')::integer, c.id
  LOOP
    col_name := analysis_name(col.name, '');
    IF col_name = ANY (used) THEN
      col_name := analysis_name(col.name, ' (c' || col.id || ')');
    END IF;
    used := used || col_name;
    list := list || format(', %I AS %I', 'c' || col.id, col_name);
  END LOOP;
  EXECUTE format('CREATE VIEW analysis.%I WITH (security_barrier) AS SELECT %s FROM records.%I', new_name, list, rows_table);
  INSERT INTO record_views VALUES (shown, new_name) ON CONFLICT (table_id) DO UPDATE SET name = excluded.name;
END $$;

-- At the end of the transaction, when table and columns are what they will be.
CREATE FUNCTION analysis_table_changed() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM analysis_show_table(CASE TG_TABLE_NAME WHEN 'record_tables' THEN (to_jsonb(NEW) ->> 'id')::bigint ELSE (to_jsonb(NEW) ->> 'table_id')::bigint END);
  RETURN NULL;
END $$;
CREATE CONSTRAINT TRIGGER table_is_shown AFTER INSERT ON record_tables DEFERRABLE INITIALLY DEFERRED
  FOR EACH ROW EXECUTE FUNCTION analysis_table_changed();
CREATE CONSTRAINT TRIGGER table_is_renamed AFTER UPDATE ON record_tables DEFERRABLE INITIALLY DEFERRED
  FOR EACH ROW WHEN (OLD.name <> NEW.name) EXECUTE FUNCTION analysis_table_changed();
CREATE CONSTRAINT TRIGGER column_is_shown AFTER INSERT ON record_columns DEFERRABLE INITIALLY DEFERRED
  FOR EACH ROW WHEN (NOT NEW.hidden) EXECUTE FUNCTION analysis_table_changed();
CREATE CONSTRAINT TRIGGER column_is_changed AFTER UPDATE ON record_columns DEFERRABLE INITIALLY DEFERRED
  FOR EACH ROW WHEN (OLD.hidden <> NEW.hidden OR OLD.properties -> 'name' <> NEW.properties -> 'name' OR OLD.properties -> 'order' <> NEW.properties -> 'order')
  EXECUTE FUNCTION analysis_table_changed();

SELECT analysis_show_table(id) FROM record_tables ORDER BY id;
