-- migrate:up

-- Places of areas and records as well-known text (ISO 13249-3), which QGIS draws without PostGIS, and names of layers in other languages. A
-- column of PostGIS would make the views, and every backup that has them, need an extension that a server may not have.

-- The number of an EPSG code; nothing: no coordinate system is known.
CREATE FUNCTION analysis.srid(crs text) RETURNS integer LANGUAGE sql IMMUTABLE PARALLEL SAFE AS $$
  SELECT substring(crs FROM '^EPSG:([0-9]{1,9})$')::integer
$$;

-- The lines or points of a record's cell, in world coordinates; of one model, or of all. Nothing where there are none.
CREATE FUNCTION analysis.wkt(places jsonb, of_model bigint DEFAULT NULL) RETURNS text LANGUAGE sql IMMUTABLE PARALLEL SAFE AS $$
  SELECT CASE WHEN bool_and(one.number = 1) THEN 'MULTIPOINT' ELSE 'MULTILINESTRING' END || ' Z (' ||
    string_agg('(' || one.path || ')', ', ' ORDER BY one.place) || ')'
  FROM (
    SELECT mark.place, count(*) AS number,
      string_agg(concat_ws(' ', corner.at ->> 0, corner.at ->> 1, corner.at ->> 2), ', ' ORDER BY corner.place) AS path
    FROM jsonb_array_elements(places) WITH ORDINALITY AS mark (of, place),
      jsonb_array_elements(mark.of -> 'coordinates') WITH ORDINALITY AS corner (at, place)
    WHERE of_model IS NULL OR (mark.of ->> 'model')::bigint = of_model
    GROUP BY mark.place
  ) one
$$;

CREATE OR REPLACE VIEW analysis.models WITH (security_barrier) AS
  SELECT m.id AS model_id, m.project_id, p.name AS project, m.name AS model, m.slug::text AS slug, m.unit, m.up, nullif(m.crs, '') AS crs,
    m.area * pow(CASE m.unit WHEN 'mm' THEN 0.001 WHEN 'cm' THEN 0.01 ELSE 1 END, 2) AS area_m2, m.triangles,
    m.bounds_min[1] AS min_x, m.bounds_min[2] AS min_y, m.bounds_min[3] AS min_z,
    m.bounds_max[1] AS max_x, m.bounds_max[2] AS max_y, m.bounds_max[3] AS max_z,
    m.inventory_number, m.owner, m.creator, m.credit, m.sequence, analysis.srid(m.crs) AS srid
  FROM public.models m JOIN public.projects p ON p.id = m.project_id;

CREATE OR REPLACE VIEW analysis.layers WITH (security_barrier) AS
  SELECT l.id AS layer_id, l.model_id, m.name AS model, l.name AS layer, l.slug::text AS slug, l.kind, l.type, l.resolution, l.unit,
    l.description, l.table_id, l.sequence, l.summed AS areas_current, l.labels, l.descriptions
  FROM public.layers l JOIN public.models m ON m.id = l.model_id WHERE l.visibility = 'public';

CREATE OR REPLACE VIEW analysis.areas WITH (security_barrier) AS
  SELECT a.layer_id, a.model_id, a.model, a.layer, a.table_id, a.key, a.texels, a.area_m2, a.centroid_x, a.centroid_y, a.centroid_z,
    a.min_x, a.min_y, a.min_z, a.max_x, a.max_y, a.max_z,
    -- nothing where there is no area to have a middle
    'POINT Z (' || a.centroid_x || ' ' || a.centroid_y || ' ' || a.centroid_z || ')' AS geometry_wkt, a.srid
  FROM (
    SELECT s.layer_id, l.model_id, m.name AS model, l.name AS layer, l.table_id, s.key, s.texels,
      s.area * pow(u.metres, 2) AS area_m2,
      s.moment_x / nullif(s.area, 0) + m.origin[1] AS centroid_x,
      s.moment_y / nullif(s.area, 0) + m.origin[2] AS centroid_y,
      s.moment_z / nullif(s.area, 0) + m.origin[3] AS centroid_z,
      s.low_x + m.origin[1] AS min_x, s.low_y + m.origin[2] AS min_y, s.low_z + m.origin[3] AS min_z,
      s.high_x + m.origin[1] AS max_x, s.high_y + m.origin[2] AS max_y, s.high_z + m.origin[3] AS max_z,
      analysis.srid(m.crs) AS srid
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
    CROSS JOIN LATERAL (SELECT CASE m.unit WHEN 'mm' THEN 0.001 WHEN 'cm' THEN 0.01 ELSE 1 END::double precision AS metres) u
  ) a;

-- As 000017_visibility.sql has it, and after the columns one of text for each that holds lines or points: "Crack (wkt)".
CREATE OR REPLACE FUNCTION analysis_show_table(shown bigint) RETURNS void LANGUAGE plpgsql AS $$
DECLARE
  rows_table text := 't' || shown;
  old_name text;
  new_name text;
  col record;
  col_name text;
  used text[] := ARRAY['key'];
  list text := 'key';
  places text := '';
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
  FOR col IN
    SELECT c.id, c.properties ->> 'name' AS name FROM record_columns c
    WHERE c.table_id = shown AND NOT c.hidden AND c.visibility = 'public' AND c.kind IN ('line', 'point')
    ORDER BY (c.properties ->> 'order')::integer, c.id
  LOOP
    col_name := analysis_name(col.name, ' (wkt)');
    IF col_name = ANY (used) THEN
      col_name := analysis_name(col.name, ' (c' || col.id || ', wkt)');
    END IF;
    used := used || col_name;
    places := places || format(', analysis.wkt(%I) AS %I', 'c' || col.id, col_name);
  END LOOP;
  EXECUTE format('CREATE VIEW analysis.%I WITH (security_barrier) AS SELECT %s FROM records.%I', new_name, list || places, rows_table);
  INSERT INTO record_views VALUES (shown, new_name) ON CONFLICT (table_id) DO UPDATE SET name = excluded.name;
END $$;

SELECT analysis_show_table(table_id) FROM record_views;
