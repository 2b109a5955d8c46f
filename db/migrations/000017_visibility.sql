-- migrate:up

-- Who sees a layer, a column or an attachment, of those who see its project: all (`public`), annotators and above (`team`), curators and
-- above (`private`). To the others it is not there.
ALTER TABLE layers ADD COLUMN visibility text NOT NULL DEFAULT 'public' CHECK (visibility IN ('public', 'team', 'private'));
ALTER TABLE record_columns ADD COLUMN visibility text NOT NULL DEFAULT 'public' CHECK (visibility IN ('public', 'team', 'private'));
ALTER TABLE attachments ADD COLUMN visibility text NOT NULL DEFAULT 'public' CHECK (visibility IN ('public', 'team', 'private'));

-- Of threads about a layer that is deleted: who saw that layer. Those about a layer that is there are seen by who sees it.
ALTER TABLE comments ADD COLUMN visibility text NOT NULL DEFAULT 'public' CHECK (visibility IN ('public', 'team', 'private'));

-- The least role that gets the scan's own files.
ALTER TABLE models ADD COLUMN source_download text NOT NULL DEFAULT 'annotator' CHECK (source_download IN ('viewer', 'annotator', 'curator'));

-- Who reads with SQL sees what everybody sees.
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
    (e.answer ->> 'texels_changed')::bigint AS texels_changed, (e.answer ->> 'area_m2')::double precision AS area_m2
  FROM public.edits e JOIN public.models m ON m.id = e.model_id JOIN public.layers l ON l.id = e.layer_id AND l.visibility = 'public';

CREATE OR REPLACE VIEW analysis.record_edits WITH (security_barrier) AS
  SELECT e.table_id, t.name AS "table", e.sequence, e.time, e.user_name AS "user", e.op, e.in_force,
    c.subject, c.subject_id AS key, c.before - h.names AS before, c.after - h.names AS after
  FROM public.table_edits e JOIN public.record_tables t ON t.id = e.table_id
  LEFT JOIN public.table_changes c ON c.table_id = e.table_id AND c.sequence = e.sequence AND c.subject = 'record'
  CROSS JOIN LATERAL (SELECT ARRAY(SELECT i.id::text FROM public.record_columns i WHERE i.table_id = e.table_id AND i.visibility <> 'public') AS names) h;

CREATE OR REPLACE FUNCTION analysis_show_table(shown bigint) RETURNS void LANGUAGE plpgsql AS $$
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
    SELECT c.id, c.kind, c.properties ->> 'name' AS name FROM record_columns c
    WHERE c.table_id = shown AND NOT c.hidden AND c.visibility = 'public'
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

CREATE CONSTRAINT TRIGGER column_is_hidden_or_seen AFTER UPDATE ON record_columns DEFERRABLE INITIALLY DEFERRED
  FOR EACH ROW WHEN (OLD.visibility <> NEW.visibility) EXECUTE FUNCTION analysis_table_changed();
