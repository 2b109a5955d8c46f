-- migrate:up

-- Tables of a project: what the keys of its database layers stand for. Each is a real table records.t<id> with columns c<id>; what
-- people call them stands here, in any language, so that names may be anything and change freely.
CREATE SCHEMA records;

CREATE TABLE record_tables (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  project_id bigint NOT NULL REFERENCES projects,
  name text NOT NULL CHECK (name <> ''),
  slug slug NOT NULL UNIQUE,
  labels jsonb NOT NULL DEFAULT '{}',
  description text NOT NULL DEFAULT '',
  -- keys are given once: the next one is greater than all that ever were
  next_key bigint NOT NULL DEFAULT 1,
  records bigint NOT NULL DEFAULT 0,
  sequence bigint NOT NULL DEFAULT 0,
  version bigint NOT NULL DEFAULT 1
);
CREATE INDEX record_tables_project ON record_tables (project_id);

CREATE TABLE record_columns (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  table_id bigint NOT NULL REFERENCES record_tables ON DELETE CASCADE,
  kind text NOT NULL CHECK (kind IN ('text', 'integer', 'numeric', 'boolean', 'date', 'timestamp', 'period', 'enumeration', 'url',
                                     'term', 'relation')),
  target bigint REFERENCES record_tables,
  -- name, slug, labels, unit, required, unique, default, comment, choices, minimum, maximum, order: what people change, each for itself
  properties jsonb NOT NULL,
  -- dropped columns keep their values for undo and for reading the past
  hidden boolean NOT NULL DEFAULT false
);
CREATE INDEX record_columns_target ON record_columns (target);
CREATE UNIQUE INDEX record_columns_slug ON record_columns (table_id, (properties ->> 'slug')) WHERE NOT hidden;

-- The journal of a table: who changed what, and whether it is in force. As for layers, undo and redo are entries of their own.
CREATE TABLE table_edits (
  table_id bigint NOT NULL REFERENCES record_tables ON DELETE CASCADE,
  sequence bigint NOT NULL CHECK (sequence > 0),
  user_name text NOT NULL,
  op text NOT NULL,
  record jsonb NOT NULL,
  time timestamptz NOT NULL DEFAULT clock_timestamp(),
  in_force boolean NOT NULL DEFAULT true,
  undone_by bigint,
  writer boolean NOT NULL GENERATED ALWAYS AS (op <> ALL (ARRAY['undo', 'redo'])) STORED,
  PRIMARY KEY (table_id, sequence),
  CHECK (in_force = (undone_by IS NULL))
);
CREATE INDEX table_edits_author ON table_edits (table_id, user_name, in_force, sequence) WHERE writer;
CREATE INDEX table_edits_time ON table_edits (table_id, time);

-- What an edit did to one record or column: the cells that it wrote, before and after. A record's cells are named by column id, and
-- `exists` tells whether it is there; a column's by property, and `hidden`.
CREATE TABLE table_changes (
  table_id bigint NOT NULL,
  subject text NOT NULL CHECK (subject IN ('record', 'column')),
  subject_id bigint NOT NULL,
  sequence bigint NOT NULL,
  before jsonb NOT NULL,
  after jsonb NOT NULL,
  PRIMARY KEY (table_id, subject, subject_id, sequence),
  FOREIGN KEY (table_id, sequence) REFERENCES table_edits ON DELETE CASCADE
);
CREATE INDEX table_changes_edit ON table_changes (table_id, sequence);

ALTER TABLE layers ADD COLUMN table_id bigint REFERENCES record_tables;
CREATE INDEX layers_table ON layers (table_id);

-- Database layers had the name of a table at most. Those of a project that named the same one share it now; the others get one of
-- their own name. Its records are the keys that the layer's legend names and those that were painted by hand, with the legend's labels.
DO $$
DECLARE
  layer record;
  wished text;
  free text;
  made bigint;
  name_column bigint;
BEGIN
  FOR layer IN
    SELECT l.id, l.palette, m.project_id, coalesce(nullif(l.records_table, ''), l.name) AS table_name, l.type
    FROM layers l JOIN models m ON m.id = l.model_id WHERE l.kind = 'database' ORDER BY l.id
  LOOP
    SELECT t.id INTO made FROM record_tables t WHERE t.project_id = layer.project_id AND t.name = layer.table_name;
    IF made IS NULL THEN
      wished := trim(both '-' from left(regexp_replace(lower(layer.table_name), '[^a-z0-9]+', '-', 'g'), 48));
      wished := CASE WHEN wished = '' THEN 'n' WHEN wished ~ '^[0-9]+$' THEN 'n-' || wished ELSE wished END;
      free := wished;
      FOR n IN 2..1000000 LOOP
        EXIT WHEN NOT EXISTS (SELECT 1 FROM record_tables WHERE slug = free);
        free := wished || '-' || n;
      END LOOP;
      INSERT INTO record_tables (project_id, name, slug) VALUES (layer.project_id, layer.table_name, free) RETURNING id INTO made;
      EXECUTE format('CREATE TABLE records.%I (key bigint PRIMARY KEY CHECK (key BETWEEN 0 AND 4294967295), version bigint NOT NULL)',
                     't' || made);
      INSERT INTO record_columns (table_id, kind, properties) VALUES (made, 'text',
        '{"name": "Name", "slug": "name", "labels": {}, "unit": "", "required": false, "unique": false, "default": null, "comment": "", "choices": [], "minimum": null, "maximum": null, "order": 0}')
        RETURNING id INTO name_column;
      EXECUTE format('ALTER TABLE records.%I ADD COLUMN %I text', 't' || made, 'c' || name_column);
    ELSE
      SELECT c.id INTO name_column FROM record_columns c WHERE c.table_id = made;
    END IF;
    EXECUTE format(
      'INSERT INTO records.%1$I (key, version, %2$I) '
      'SELECT k.key, 0, max(nullif(k.label, '''')) FROM ('
      'SELECT (p ->> ''at'')::numeric AS key, left(p ->> ''label'', 1000) AS label FROM jsonb_array_elements($1 -> ''points'') p '
      'WHERE jsonb_typeof(p -> ''at'') = ''number'' UNION ALL '
      'SELECT (e.record ->> ''value'')::numeric, NULL FROM edits e WHERE e.layer_id = $2 AND jsonb_typeof(e.record -> ''value'') = ''number'') k '
      'WHERE k.key = trunc(k.key) AND k.key BETWEEN 0 AND 4294967295 GROUP BY k.key '
      'ON CONFLICT (key) DO UPDATE SET %2$I = coalesce(%1$I.%2$I, excluded.%2$I)', 't' || made, 'c' || name_column)
      USING layer.palette, layer.id;
    UPDATE layers SET table_id = made WHERE id = layer.id;
    EXECUTE format('UPDATE record_tables SET records = (SELECT count(*) FROM records.%1$I), '
                   'next_key = (SELECT coalesce(max(key), 0) + 1 FROM records.%1$I) WHERE id = $1', 't' || made) USING made;
  END LOOP;
END $$;

ALTER TABLE layers DROP COLUMN records_table;
ALTER TABLE layers ADD CHECK ((kind = 'database') = (table_id IS NOT NULL));
