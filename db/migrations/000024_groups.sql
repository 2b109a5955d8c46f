-- migrate:up

-- Groups of people, of the whole site. A project gives a group a role as it gives one to a person; the highest of a person's roles counts.
CREATE TABLE groups (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  name text NOT NULL CHECK (name = btrim(name) AND char_length(name) BETWEEN 1 AND 100),
  created timestamptz NOT NULL DEFAULT now()
);
CREATE UNIQUE INDEX groups_name_in_any_case ON groups (lower(name));
CREATE TABLE group_people (
  group_id bigint NOT NULL REFERENCES groups ON DELETE CASCADE,
  user_id bigint NOT NULL REFERENCES users,
  PRIMARY KEY (group_id, user_id)
);
CREATE INDEX group_people_user ON group_people (user_id);
CREATE TABLE project_groups (
  project_id bigint NOT NULL REFERENCES projects ON DELETE CASCADE,
  group_id bigint NOT NULL REFERENCES groups ON DELETE CASCADE,
  role text NOT NULL CHECK (role IN ('viewer', 'annotator', 'curator')),
  PRIMARY KEY (group_id, project_id)
);
CREATE INDEX project_groups_project ON project_groups (project_id);

-- All that gives somebody a role in a project: no group where it is their own. Who asks what a person may do asks this.
CREATE VIEW project_roles AS
  SELECT project_id, user_id, role, NULL::bigint AS group_id FROM project_members
  UNION ALL
  SELECT g.project_id, p.user_id, g.role, g.group_id FROM project_groups g JOIN group_people p ON p.group_id = g.group_id;

CREATE FUNCTION role_rank(role text) RETURNS integer LANGUAGE sql IMMUTABLE AS
$$ SELECT array_position(ARRAY['guest', 'viewer', 'annotator', 'curator', 'administrator', 'owner'], role) $$;

-- The group that was given the role, or, with a person, that they were put into or taken out of.
ALTER TABLE activities ADD COLUMN group_name text;

-- As before, and of another group is another line.
CREATE OR REPLACE FUNCTION note_activity(line activities, first_stroke uuid DEFAULT NULL) RETURNS void LANGUAGE plpgsql AS $$
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
      AND (line.kind NOT IN ('layer', 'look', 'view', 'tour', 'model', 'table') OR (line.op = 'changed' AND l.subject = line.subject))
    ORDER BY l.time DESC, l.id DESC LIMIT 1);
  IF NOT FOUND THEN
    INSERT INTO activities (project_id, model_id, layer_id, table_id, record_key, comment_id, subject, user_name, kind, op, begun, time,
      count, texels, area_m2, last_stroke, person, group_name, role, changed, visibility)
    VALUES (line.project_id, line.model_id, line.layer_id, line.table_id, line.record_key, line.comment_id, line.subject, line.user_name,
      line.kind, line.op, line.begun, line.time, line.count, line.texels, line.area_m2, line.last_stroke, line.person, line.group_name,
      line.role, line.changed, coalesce(line.visibility, 'public'));
  END IF;
END $$;

-- As of people's own roles: what ends with the project is told by nobody.
CREATE FUNCTION project_group_is_activity() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  line activities;
  given record;
BEGIN
  IF activity_author() = '' OR (TG_OP = 'UPDATE' AND NEW.role = OLD.role) THEN
    RETURN NULL;
  END IF;
  SELECT p.id, p.name, g.name AS group_name INTO given FROM projects p, groups g
    WHERE p.id = CASE WHEN TG_OP = 'DELETE' THEN OLD.project_id ELSE NEW.project_id END
      AND g.id = CASE WHEN TG_OP = 'DELETE' THEN OLD.group_id ELSE NEW.group_id END;
  IF NOT FOUND THEN
    RETURN NULL;
  END IF;
  line := activity_of(given.id, 'member', CASE TG_OP WHEN 'INSERT' THEN 'added' WHEN 'UPDATE' THEN 'changed' ELSE 'removed' END, given.name);
  line.group_name := given.group_name;
  IF TG_OP <> 'DELETE' THEN
    line.role := NEW.role;
  END IF;
  PERFORM note_activity(line);
  RETURN NULL;
END $$;
CREATE TRIGGER project_group_is_activity AFTER INSERT OR DELETE OR UPDATE OF role ON project_groups
  FOR EACH ROW EXECUTE FUNCTION project_group_is_activity();

-- In each project in which the group has a role.
CREATE FUNCTION group_person_is_activity() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  line activities;
  given record;
BEGIN
  IF activity_author() = '' THEN
    RETURN NULL;
  END IF;
  FOR given IN
    SELECT p.id, p.name, g.name AS group_name, u.name AS person, r.role
    FROM project_groups r JOIN projects p ON p.id = r.project_id JOIN groups g ON g.id = r.group_id, users u
    WHERE r.group_id = CASE WHEN TG_OP = 'DELETE' THEN OLD.group_id ELSE NEW.group_id END
      AND u.id = CASE WHEN TG_OP = 'DELETE' THEN OLD.user_id ELSE NEW.user_id END
  LOOP
    line := activity_of(given.id, 'member', CASE TG_OP WHEN 'INSERT' THEN 'added' ELSE 'removed' END, given.name);
    line.person := given.person;
    line.group_name := given.group_name;
    IF TG_OP = 'INSERT' THEN
      line.role := given.role;
    END IF;
    PERFORM note_activity(line);
  END LOOP;
  RETURN NULL;
END $$;
CREATE TRIGGER group_person_is_activity AFTER INSERT OR DELETE ON group_people
  FOR EACH ROW EXECUTE FUNCTION group_person_is_activity();
