-- migrate:up
-- readable-from: 44

-- Named definitions of a part of the surface of a model. `content` has the `within` and the
-- `audience` of the protocol's SavedSelection. Layers, surface images and selections have ids,
-- except in conditions. Only its user sees a selection with the audience 'personal'.
CREATE TABLE selections (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  model_id bigint NOT NULL REFERENCES all_models ON DELETE CASCADE,
  slug text NOT NULL,
  name text NOT NULL CHECK (char_length(name) BETWEEN 1 AND 200),
  text text NOT NULL DEFAULT '' CHECK (char_length(text) <= 10000),
  content jsonb NOT NULL CHECK ((content ->> 'audience') IN ('personal', 'everyone')),
  user_name text NOT NULL,
  time timestamptz NOT NULL DEFAULT clock_timestamp(),
  version bigint NOT NULL DEFAULT 1,
  UNIQUE (model_id, slug)
);

CREATE TRIGGER selection_deletion_is_audited AFTER DELETE ON selections
  FOR EACH ROW EXECUTE FUNCTION deletion_is_audited('selection');

-- The activity lists the selections for everyone like views and snapshots.
ALTER TABLE activities DROP CONSTRAINT activities_kind_check, ADD CONSTRAINT activities_kind_check
  CHECK (kind IN ('edit', 'layer', 'look', 'view', 'tour', 'snapshot', 'selection', 'model', 'table', 'columns', 'records', 'comment',
    'member', 'project'));

CREATE OR REPLACE FUNCTION note_activity(line activities, first_stroke uuid DEFAULT NULL::uuid) RETURNS void LANGUAGE plpgsql AS $$
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
      AND l.person IS NOT DISTINCT FROM line.person AND l.group_name IS NOT DISTINCT FROM line.group_name
      -- what is made or deleted, looks among them, which have no id here, is a line of its own
      AND (line.kind NOT IN ('layer', 'look', 'view', 'tour', 'snapshot', 'selection', 'model', 'table') OR (line.op = 'changed' AND l.subject = line.subject))
    ORDER BY l.time DESC, l.id DESC LIMIT 1);
  IF NOT FOUND THEN
    INSERT INTO activities (project_id, model_id, layer_id, table_id, record_key, comment_id, subject, user_name, kind, op, begun, time,
      count, texels, area_m2, last_stroke, person, group_name, role, changed, visibility)
    VALUES (line.project_id, line.model_id, line.layer_id, line.table_id, line.record_key, line.comment_id, line.subject, line.user_name,
      line.kind, line.op, line.begun, line.time, line.count, line.texels, line.area_m2, line.last_stroke, line.person, line.group_name,
      line.role, line.changed, coalesce(line.visibility, 'public'));
  END IF;
END $$;

CREATE OR REPLACE FUNCTION thing_is_activity() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  of_kind text := TG_ARGV[0];
  thing jsonb := CASE WHEN TG_OP = 'DELETE' THEN to_jsonb(OLD) ELSE to_jsonb(NEW) END;
  line activities;
  of_project bigint := (thing ->> 'project_id')::bigint;
  own_id bigint := (thing ->> 'id')::bigint;
BEGIN
  IF of_kind = 'layer' AND TG_OP = 'DELETE' THEN
    UPDATE activities SET visibility = thing ->> 'visibility' WHERE model_id = (thing ->> 'model_id')::bigint AND layer_id = own_id;
  END IF;
  IF of_kind IN ('layer', 'look', 'view', 'tour', 'snapshot', 'selection') THEN
    SELECT m.project_id INTO of_project FROM models m WHERE m.id = (thing ->> 'model_id')::bigint;
  ELSIF of_kind = 'project' THEN
    of_project := own_id;
  END IF;
  -- Gone with their model or project, which has a line of its own.
  IF of_project IS NULL OR NOT EXISTS (SELECT 1 FROM projects p WHERE p.id = of_project) THEN
    RETURN NULL;
  END IF;
  line := activity_of(of_project, of_kind, CASE TG_OP WHEN 'INSERT' THEN 'created' WHEN 'UPDATE' THEN 'changed' ELSE 'deleted' END,
    thing ->> 'name');
  line.model_id := CASE WHEN of_kind = 'model' THEN own_id ELSE (thing ->> 'model_id')::bigint END;
  IF of_kind = 'layer' THEN
    line.layer_id := own_id;
    line.visibility := thing ->> 'visibility';
  ELSIF of_kind = 'table' THEN
    line.table_id := own_id;
  END IF;
  IF TG_OP = 'DELETE' AND line.user_name = '' AND of_kind IN ('layer', 'table') THEN
    DELETE FROM activities WHERE layer_id = line.layer_id OR table_id = line.table_id;
    RETURN NULL;
  END IF;
  IF TG_OP = 'UPDATE' THEN
    line.changed := changed_columns(to_jsonb(OLD), thing);
    -- Its lines go where it goes, so that those who do not see it there do not see them either.
    IF of_kind = 'model' AND 'project_id' = ANY (line.changed) THEN
      UPDATE activities SET project_id = of_project WHERE model_id = line.model_id;
    END IF;
    -- The formula of a new layer is set after the layer is made.
    IF line.changed IS NULL OR line.user_name = '' OR (of_kind = 'layer' AND EXISTS (
      SELECT 1 FROM activities a WHERE a.project_id = of_project AND a.time >= transaction_timestamp()
        AND a.layer_id = line.layer_id AND a.kind = 'layer' AND a.op = 'created')) THEN
      RETURN NULL;
    END IF;
  END IF;
  PERFORM note_activity(line);
  RETURN NULL;
END $$;

CREATE TRIGGER new_selection_is_activity AFTER INSERT ON selections FOR EACH ROW
  WHEN (NEW.content ->> 'audience' = 'everyone') EXECUTE FUNCTION thing_is_activity('selection');
CREATE TRIGGER selection_change_is_activity AFTER UPDATE OF name, text, content ON selections FOR EACH ROW
  WHEN (NEW.content ->> 'audience' = 'everyone') EXECUTE FUNCTION thing_is_activity('selection');
CREATE TRIGGER selection_deletion_is_activity AFTER DELETE ON selections FOR EACH ROW
  WHEN (OLD.content ->> 'audience' = 'everyone') EXECUTE FUNCTION thing_is_activity('selection');

-- Nodes report the selections for everyone to each other. One that becomes personal counts as
-- deleted, and one that was personal as created. Older nodes ignore these messages.
ALTER TABLE node_messages DROP CONSTRAINT node_messages_kind_check, ADD CONSTRAINT node_messages_kind_check
  CHECK (kind IN ('records', 'table', 'comment', 'view', 'snapshot', 'selection', 'tool', 'access', 'kiosk'));
CREATE FUNCTION selection_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  was boolean := TG_OP <> 'INSERT' AND OLD.content ->> 'audience' = 'everyone';
  is_now boolean := TG_OP <> 'DELETE' AND NEW.content ->> 'audience' = 'everyone';
  own_id bigint := CASE WHEN TG_OP = 'DELETE' THEN OLD.id ELSE NEW.id END;
  of_model bigint := CASE WHEN TG_OP = 'DELETE' THEN OLD.model_id ELSE NEW.model_id END;
BEGIN
  IF was OR is_now THEN
    PERFORM send_to_nodes('selection', CASE WHEN was AND is_now THEN 'changed' WHEN is_now THEN 'created' ELSE 'deleted' END, NULL, m.id,
      ARRAY[own_id], activity_author())
    FROM models m WHERE m.id = of_model;
  END IF;
  RETURN NULL;
END $$;
CREATE TRIGGER selection_to_nodes AFTER INSERT OR DELETE ON selections FOR EACH ROW EXECUTE FUNCTION selection_to_nodes();
CREATE TRIGGER selection_change_to_nodes AFTER UPDATE OF version ON selections FOR EACH ROW
  WHEN (OLD.version <> NEW.version) EXECUTE FUNCTION selection_to_nodes();
