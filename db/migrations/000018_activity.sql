-- migrate:up

-- What was done in a project, newest first, a line for what one person did to one thing in one go: within ten minutes of the line's last
-- time. Lines are written by the triggers below, in the transaction of what they tell, so that no path can forget them. What was done to
-- texels, records and comments stands in their own journals; a line of it is their sum, so that a page costs the same however much was
-- painted. Ids of what was deleted stay here and mean nothing any more; its name does.
CREATE TABLE activities (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  project_id bigint NOT NULL REFERENCES projects ON DELETE CASCADE,
  model_id bigint,
  layer_id bigint,
  table_id bigint,
  -- where all of the line is about that one
  record_key bigint,
  comment_id bigint,
  -- what its subject was called
  subject text NOT NULL,
  -- empty: the server itself, by its command line
  user_name text NOT NULL,
  kind text NOT NULL CHECK (kind IN ('edit', 'layer', 'look', 'model', 'table', 'columns', 'records', 'comment', 'member', 'project')),
  op text NOT NULL,
  begun timestamptz NOT NULL,
  time timestamptz NOT NULL,
  -- strokes and other edits; records; changes
  count bigint NOT NULL DEFAULT 1,
  -- edits: what they changed one after the other
  texels bigint,
  area_m2 double precision,
  last_stroke uuid,
  -- whose membership, and the role that they have now
  person text,
  role text,
  -- columns of what was changed
  changed text[],
  -- of the layer that it is about, when that was deleted; one that is there tells itself who sees it
  visibility text NOT NULL DEFAULT 'public'
);
CREATE INDEX activities_project ON activities (project_id, time, id);
CREATE INDEX activities_model ON activities (model_id, time, id) WHERE model_id IS NOT NULL;
CREATE INDEX activities_table ON activities (table_id, time, id) WHERE table_id IS NOT NULL;
CREATE INDEX activities_author ON activities (project_id, user_name, time);
CREATE INDEX activities_comment ON activities (comment_id) WHERE comment_id IS NOT NULL;

-- Who the transaction is for (Store's changes say so); empty: nobody asked.
CREATE FUNCTION activity_author() RETURNS text LANGUAGE sql STABLE AS
$$ SELECT coalesce(current_setting('strata.user', true), '') $$;

-- Adds to the line that this belongs to, or makes one. `first_stroke`: with which the edits begin; its batches are counted once.
CREATE FUNCTION note_activity(line activities, first_stroke uuid DEFAULT NULL) RETURNS void LANGUAGE plpgsql AS $$
BEGIN
  UPDATE activities a SET
    time = greatest(a.time, line.time),
    begun = least(a.begun, line.begun),
    count = a.count + line.count - (first_stroke IS NOT NULL AND a.last_stroke = first_stroke)::integer,
    texels = a.texels + line.texels,
    area_m2 = a.area_m2 + line.area_m2,
    last_stroke = line.last_stroke,
    subject = line.subject,
    record_key = CASE WHEN a.record_key = line.record_key THEN a.record_key END,
    role = line.role,
    changed = CASE WHEN line.changed IS NULL THEN a.changed
      ELSE (SELECT array_agg(DISTINCT name ORDER BY name) FROM unnest(a.changed || line.changed) name) END
  WHERE line.comment_id IS NULL AND a.id = (
    SELECT l.id FROM activities l
    WHERE l.project_id = line.project_id AND l.user_name = line.user_name AND l.time >= line.begun - interval '10 minutes'
      AND l.kind = line.kind AND l.op = line.op AND l.model_id IS NOT DISTINCT FROM line.model_id
      AND l.layer_id IS NOT DISTINCT FROM line.layer_id AND l.table_id IS NOT DISTINCT FROM line.table_id
      AND l.person IS NOT DISTINCT FROM line.person
      -- what is made or deleted, looks among them, which have no id here, is a line of its own
      AND (line.kind NOT IN ('layer', 'look', 'model', 'table') OR (line.op = 'changed' AND l.subject = line.subject))
    ORDER BY l.time DESC, l.id DESC LIMIT 1);
  IF NOT FOUND THEN
    INSERT INTO activities (project_id, model_id, layer_id, table_id, record_key, comment_id, subject, user_name, kind, op, begun, time,
      count, texels, area_m2, last_stroke, person, role, changed, visibility)
    VALUES (line.project_id, line.model_id, line.layer_id, line.table_id, line.record_key, line.comment_id, line.subject, line.user_name,
      line.kind, line.op, line.begun, line.time, line.count, line.texels, line.area_m2, line.last_stroke, line.person, line.role,
      line.changed, coalesce(line.visibility, 'public'));
  END IF;
END $$;

-- A line that begins now, of whom the transaction is for.
CREATE FUNCTION activity_of(of_project bigint, of_kind text, of_op text, of_subject text) RETURNS activities LANGUAGE plpgsql AS $$
DECLARE
  line activities;
BEGIN
  line.project_id := of_project;
  line.kind := of_kind;
  line.op := of_op;
  line.subject := of_subject;
  line.user_name := activity_author();
  line.begun := clock_timestamp();
  line.time := line.begun;
  line.count := 1;
  RETURN line;
END $$;

-- One line for each layer, person and operation of a commit; the batches of a stroke count once.
CREATE FUNCTION edits_are_activity() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  run record;
  line activities;
BEGIN
  FOR run IN
    SELECT m.project_id, e.model_id, e.layer_id, l.name, e.user_name, e.op, min(e.time) AS begun, max(e.time) AS time,
      count(DISTINCT e.stroke) AS strokes, (array_agg(e.stroke ORDER BY e.sequence))[1] AS first_stroke,
      (array_agg(e.stroke ORDER BY e.sequence DESC))[1] AS last_stroke,
      sum((e.answer ->> 'texels_changed')::bigint) AS texels, sum((e.answer ->> 'area_m2')::double precision) AS area
    FROM added e JOIN models m ON m.id = e.model_id JOIN layers l ON l.id = e.layer_id
    GROUP BY m.project_id, e.model_id, e.layer_id, l.name, e.user_name, e.op ORDER BY max(e.sequence)
  LOOP
    line.project_id := run.project_id;
    line.kind := 'edit';
    line.op := run.op;
    line.subject := run.name;
    line.model_id := run.model_id;
    line.layer_id := run.layer_id;
    line.user_name := run.user_name;
    line.begun := run.begun;
    line.time := run.time;
    line.texels := coalesce(run.texels, 0);
    line.area_m2 := coalesce(run.area, 0);
    line.last_stroke := run.last_stroke;
    line.count := run.strokes;
    PERFORM note_activity(line, run.first_stroke);
  END LOOP;
  RETURN NULL;
END $$;
CREATE TRIGGER edits_are_activity AFTER INSERT ON edits REFERENCING NEW TABLE AS added
  FOR EACH STATEMENT EXECUTE FUNCTION edits_are_activity();

-- When it is committed, as its changes come after it.
CREATE FUNCTION table_edit_is_activity() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  line activities;
  written record;
  of_table record;
BEGIN
  SELECT count(*) FILTER (WHERE subject = 'record') AS records, count(*) FILTER (WHERE subject = 'column') AS columns,
    min(subject_id) FILTER (WHERE subject = 'record') AS record
    INTO written FROM table_changes WHERE table_id = NEW.table_id AND sequence = NEW.sequence;
  SELECT t.project_id, t.name INTO of_table FROM record_tables t WHERE t.id = NEW.table_id;
  IF NOT FOUND THEN
    RETURN NULL;
  END IF;
  line := activity_of(of_table.project_id, CASE WHEN written.columns > 0 THEN 'columns' ELSE 'records' END, NEW.op, of_table.name);
  line.table_id := NEW.table_id;
  line.user_name := NEW.user_name;
  line.begun := NEW.time;
  line.time := NEW.time;
  line.count := CASE WHEN written.columns > 0 THEN written.columns ELSE written.records END;
  IF line.kind = 'records' AND written.records = 1 THEN
    line.record_key := written.record;
  END IF;
  PERFORM note_activity(line);
  RETURN NULL;
END $$;
CREATE CONSTRAINT TRIGGER table_edit_is_activity AFTER INSERT ON table_edits DEFERRABLE INITIALLY DEFERRED
  FOR EACH ROW EXECUTE FUNCTION table_edit_is_activity();

CREATE FUNCTION comment_is_activity() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  line activities;
BEGIN
  IF TG_OP = 'DELETE' OR NEW.deleted IS NOT NULL THEN
    DELETE FROM activities WHERE comment_id = OLD.id;
    RETURN NULL;
  END IF;
  IF TG_OP = 'UPDATE' AND (NEW.resolved IS NULL) = (OLD.resolved IS NULL) THEN
    RETURN NULL;
  END IF;
  line := activity_of((SELECT m.project_id FROM models m WHERE m.id = NEW.model_id), 'comment', '', '');
  line.model_id := NEW.model_id;
  line.comment_id := NEW.id;
  IF TG_OP = 'INSERT' THEN
    line.op := CASE WHEN NEW.thread_id IS NULL THEN 'written' ELSE 'replied' END;
    line.user_name := NEW.user_name;
  ELSIF NEW.resolved IS NOT NULL THEN
    line.op := 'resolved';
    line.user_name := NEW.resolved_by;
  ELSE
    line.op := 'reopened';
  END IF;
  PERFORM note_activity(line);
  RETURN NULL;
END $$;
CREATE TRIGGER comment_is_activity AFTER INSERT OR UPDATE OF resolved, deleted OR DELETE ON comments
  FOR EACH ROW EXECUTE FUNCTION comment_is_activity();

-- Which columns of what people set are others now.
CREATE FUNCTION changed_columns(before jsonb, after jsonb) RETURNS text[] LANGUAGE sql IMMUTABLE AS $$
  SELECT array_agg(a.key ORDER BY a.key) FROM jsonb_each(after) a
  WHERE a.value IS DISTINCT FROM before -> a.key
    AND a.key NOT IN ('version', 'sequence', 'computed_sequence', 'summed', 'bounds_min', 'bounds_max', 'area')
$$;

-- What people made, changed or deleted. Changes that nobody asked for are no activity, and a layer or table that nobody asked to delete is
-- taken back by work that failed: it never was.
CREATE FUNCTION thing_is_activity() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  thing jsonb := CASE WHEN TG_OP = 'DELETE' THEN to_jsonb(OLD) ELSE to_jsonb(NEW) END;
  line activities;
  of_project bigint := (thing ->> 'project_id')::bigint;
  own_id bigint := (thing ->> 'id')::bigint;
BEGIN
  IF TG_TABLE_NAME = 'layers' AND TG_OP = 'DELETE' THEN
    UPDATE activities SET visibility = thing ->> 'visibility' WHERE model_id = (thing ->> 'model_id')::bigint AND layer_id = own_id;
  END IF;
  IF TG_TABLE_NAME IN ('layers', 'looks') THEN
    SELECT m.project_id INTO of_project FROM models m WHERE m.id = (thing ->> 'model_id')::bigint;
  ELSIF TG_TABLE_NAME = 'projects' THEN
    of_project := own_id;
  END IF;
  -- Gone with their model or project, which has a line of its own.
  IF of_project IS NULL OR NOT EXISTS (SELECT 1 FROM projects p WHERE p.id = of_project) THEN
    RETURN NULL;
  END IF;
  line := activity_of(of_project, TG_ARGV[0], CASE TG_OP WHEN 'INSERT' THEN 'created' WHEN 'UPDATE' THEN 'changed' ELSE 'deleted' END,
    thing ->> 'name');
  line.model_id := CASE WHEN TG_TABLE_NAME = 'models' THEN own_id ELSE (thing ->> 'model_id')::bigint END;
  IF TG_TABLE_NAME = 'layers' THEN
    line.layer_id := own_id;
    line.visibility := thing ->> 'visibility';
  ELSIF TG_TABLE_NAME = 'record_tables' THEN
    line.table_id := own_id;
  END IF;
  IF TG_OP = 'DELETE' AND line.user_name = '' AND TG_TABLE_NAME IN ('layers', 'record_tables') THEN
    DELETE FROM activities WHERE layer_id = line.layer_id OR table_id = line.table_id;
    RETURN NULL;
  END IF;
  IF TG_OP = 'UPDATE' THEN
    line.changed := changed_columns(to_jsonb(OLD), thing);
    -- Its lines go where it goes, so that those who do not see it there do not see them either.
    IF TG_TABLE_NAME = 'models' AND 'project_id' = ANY (line.changed) THEN
      UPDATE activities SET project_id = of_project WHERE model_id = line.model_id;
    END IF;
    -- The formula of a new layer is set after the layer is made.
    IF line.changed IS NULL OR line.user_name = '' OR (TG_TABLE_NAME = 'layers' AND EXISTS (
      SELECT 1 FROM activities a WHERE a.project_id = of_project AND a.time >= transaction_timestamp()
        AND a.layer_id = line.layer_id AND a.kind = 'layer' AND a.op = 'created')) THEN
      RETURN NULL;
    END IF;
  END IF;
  PERFORM note_activity(line);
  RETURN NULL;
END $$;
CREATE TRIGGER layer_is_activity AFTER INSERT OR DELETE OR UPDATE OF
  name, slug, type, unit, description, palette, opacity, visible, draw_order, expression, automatic, locked, visibility ON layers
  FOR EACH ROW EXECUTE FUNCTION thing_is_activity('layer');
CREATE TRIGGER look_is_activity AFTER INSERT OR DELETE OR UPDATE OF name, slug, description, opacity, visible, draw_order ON looks
  FOR EACH ROW EXECUTE FUNCTION thing_is_activity('look');
CREATE TRIGGER model_is_activity AFTER INSERT OR DELETE OR UPDATE OF name, slug, project_id, unit, unit_assumed, scale_verified, up, north,
  crs, default_resolution, inventory_number, owner, creator, captured, method, accuracy, processing, rights_uri, credit, source_download ON models
  FOR EACH ROW EXECUTE FUNCTION thing_is_activity('model');
CREATE TRIGGER table_is_activity AFTER INSERT OR DELETE OR UPDATE OF name, labels, description ON record_tables
  FOR EACH ROW EXECUTE FUNCTION thing_is_activity('table');
CREATE TRIGGER project_is_activity AFTER INSERT OR UPDATE OF name, slug, description ON projects
  FOR EACH ROW EXECUTE FUNCTION thing_is_activity('project');

-- Those that end with the person, or the project, are told by nobody.
CREATE FUNCTION member_is_activity() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  line activities;
  membership record;
BEGIN
  IF activity_author() = '' OR (TG_OP = 'UPDATE' AND NEW.role = OLD.role) THEN
    RETURN NULL;
  END IF;
  SELECT p.id, p.name, u.name AS person INTO membership FROM projects p, users u
    WHERE p.id = CASE WHEN TG_OP = 'DELETE' THEN OLD.project_id ELSE NEW.project_id END
      AND u.id = CASE WHEN TG_OP = 'DELETE' THEN OLD.user_id ELSE NEW.user_id END;
  IF NOT FOUND THEN
    RETURN NULL;
  END IF;
  line := activity_of(membership.id, 'member', CASE TG_OP WHEN 'INSERT' THEN 'added' WHEN 'UPDATE' THEN 'changed' ELSE 'removed' END,
    membership.name);
  line.person := membership.person;
  IF TG_OP <> 'DELETE' THEN
    line.role := NEW.role;
  END IF;
  PERFORM note_activity(line);
  RETURN NULL;
END $$;
CREATE TRIGGER member_is_activity AFTER INSERT OR DELETE OR UPDATE OF role ON project_members
  FOR EACH ROW EXECUTE FUNCTION member_is_activity();

-- What was done before there were lines, as far as the journals tell.
INSERT INTO activities (project_id, model_id, layer_id, subject, user_name, kind, op, begun, time, count, texels, area_m2, last_stroke)
SELECT m.project_id, r.model_id, r.layer_id, l.name, r.user_name, 'edit', r.op, min(r.time), max(r.time), count(DISTINCT r.stroke),
  coalesce(sum((r.answer ->> 'texels_changed')::bigint), 0), coalesce(sum((r.answer ->> 'area_m2')::double precision), 0),
  (array_agg(r.stroke ORDER BY r.sequence DESC))[1]
FROM (SELECT g.*, count(*) FILTER (WHERE g.begins) OVER (PARTITION BY layer_id, user_name, op ORDER BY sequence) AS run
  FROM (SELECT e.*, coalesce(e.time - lag(e.time) OVER (PARTITION BY layer_id, user_name, op ORDER BY sequence) > interval '10 minutes', true)
    AS begins FROM edits e) g) r
JOIN models m ON m.id = r.model_id JOIN layers l ON l.id = r.layer_id
GROUP BY m.project_id, r.model_id, r.layer_id, l.name, r.user_name, r.op, r.run;

INSERT INTO activities (project_id, table_id, record_key, subject, user_name, kind, op, begun, time, count)
SELECT t.project_id, r.table_id, CASE WHEN min(r.first) = max(r.last) AND r.kind = 'records' THEN min(r.first) END, t.name, r.user_name,
  r.kind, r.op, min(r.time), max(r.time), sum(r.written)
FROM (SELECT g.*, count(*) FILTER (WHERE g.begins) OVER (PARTITION BY table_id, user_name, kind, op ORDER BY sequence) AS run
  FROM (SELECT c.*, coalesce(c.time - lag(c.time) OVER (PARTITION BY table_id, user_name, kind, op ORDER BY sequence)
      > interval '10 minutes', true) AS begins
    FROM (SELECT e.table_id, e.sequence, e.user_name, e.op, e.time,
        CASE WHEN count(*) FILTER (WHERE c.subject = 'column') > 0 THEN 'columns' ELSE 'records' END AS kind,
        coalesce(nullif(count(*) FILTER (WHERE c.subject = 'column'), 0), count(c.subject)) AS written,
        min(c.subject_id) AS first, max(c.subject_id) AS last
      FROM table_edits e LEFT JOIN table_changes c ON c.table_id = e.table_id AND c.sequence = e.sequence
      GROUP BY e.table_id, e.sequence, e.user_name, e.op, e.time) c) g) r
JOIN record_tables t ON t.id = r.table_id
GROUP BY t.project_id, r.table_id, t.name, r.user_name, r.kind, r.op, r.run;

INSERT INTO activities (project_id, model_id, comment_id, subject, user_name, kind, op, begun, time)
SELECT m.project_id, c.model_id, c.id, '', c.user_name, 'comment', CASE WHEN c.thread_id IS NULL THEN 'written' ELSE 'replied' END, c.time, c.time
FROM comments c JOIN models m ON m.id = c.model_id WHERE c.deleted IS NULL
UNION ALL
SELECT m.project_id, c.model_id, c.id, '', c.resolved_by, 'comment', 'resolved', c.resolved, c.resolved
FROM comments c JOIN models m ON m.id = c.model_id WHERE c.resolved IS NOT NULL AND c.deleted IS NULL;
