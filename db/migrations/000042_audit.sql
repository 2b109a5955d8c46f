-- migrate:up

-- The audit log: one row for each security-relevant action. Triggers write most rows in the transaction of the change, so that no change can be
-- missing. The server writes sign-ins that failed, and exports. Rows are never changed. They keep the names of actors and subjects, also after the
-- account or the object is deleted. They contain no passwords, tokens or contents.
CREATE TABLE audit_log (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  time timestamptz NOT NULL DEFAULT clock_timestamp(),
  -- 'link': a sign-in with a link or an invitation; 'server': the server itself, or its command line
  actor_kind text NOT NULL CHECK (actor_kind IN ('person', 'token', 'kiosk', 'link', 'server')),
  actor text NOT NULL CHECK (octet_length(actor) <= 255),
  person_id bigint,
  -- of the client; empty if no client caused the action
  address text NOT NULL CHECK (octet_length(address) <= 100),
  action text NOT NULL CHECK (action IN ('sign_in', 'sign_in_failed', 'sign_out', 'password_changed', 'account_created', 'account_deleted',
    'account_renamed', 'account_disabled', 'account_enabled', 'role_changed', 'member_added', 'member_removed', 'group_created',
    'group_renamed', 'token_created', 'token_revoked', 'link_created', 'export', 'deletion', 'erased', 'restored', 'visibility_changed',
    'kiosk_created', 'kiosk_changed', 'kiosk_deleted', 'setting_changed', 'oidc_bound', 'audit_purged')),
  subject_kind text NOT NULL CHECK (octet_length(subject_kind) <= 30),
  subject_id bigint,
  subject text NOT NULL CHECK (octet_length(subject) <= 255),
  project_id bigint,
  -- above 1 only for failed sign-ins, of which the log has one row for each address, name and minute
  count bigint NOT NULL DEFAULT 1 CHECK (count >= 1),
  details jsonb NOT NULL DEFAULT '{}' CHECK (jsonb_typeof(details) = 'object' AND octet_length(details::text) <= 4096)
);
CREATE INDEX audit_log_time ON audit_log (time, id);
CREATE INDEX audit_log_actor ON audit_log (lower(actor), id);
CREATE INDEX audit_log_project ON audit_log (project_id, id) WHERE project_id IS NOT NULL;
CREATE INDEX audit_log_failed ON audit_log (address, time) WHERE action = 'sign_in_failed';

-- Returns the first bytes of the text, without a part of a character at the end.
CREATE FUNCTION audit_text(given text, longest integer) RETURNS text LANGUAGE plpgsql IMMUTABLE AS $$
DECLARE
  short text := left(coalesce(given, ''), longest);
BEGIN
  WHILE octet_length(short) > longest LOOP
    short := left(short, length(short) - greatest((octet_length(short) - longest) / 4, 1));
  END LOOP;
  RETURN short;
END $$;

-- Allows one change: the count of failed sign-ins rises by one within the minute of its row.
CREATE FUNCTION audit_is_kept() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  IF TG_OP = 'UPDATE' THEN
    IF OLD.action = 'sign_in_failed' AND NEW.count = OLD.count + 1 AND OLD.time > clock_timestamp() - interval '2 minutes'
      AND to_jsonb(NEW) - 'count' = to_jsonb(OLD) - 'count' THEN
      RETURN NEW;
    END IF;
  ELSIF TG_OP = 'DELETE' THEN
    -- `audit_purge` sets the limit. A row of the last day can never be deleted.
    IF OLD.time < least(nullif(current_setting('strata.audit_limit', true), '')::timestamptz, clock_timestamp() - interval '1 day')
      AND coalesce(current_setting('strata.audit_limit', true), '') <> '' THEN
      RETURN OLD;
    END IF;
  END IF;
  RAISE EXCEPTION 'rows of the audit log cannot be changed or deleted' USING ERRCODE = 'insufficient_privilege';
END $$;
CREATE TRIGGER audit_is_kept BEFORE UPDATE OR DELETE ON audit_log FOR EACH ROW EXECUTE FUNCTION audit_is_kept();
CREATE TRIGGER audit_is_not_emptied BEFORE TRUNCATE ON audit_log FOR EACH STATEMENT EXECUTE FUNCTION audit_is_kept();

-- Adds a row about the person, token, kiosk or link for which the transaction runs (Pool::write and Store's changes set them), or else about the
-- `author` of the change. An empty name means the server.
CREATE FUNCTION audit(of_action text, of_kind text, of_id bigint, of_subject text, of_project bigint, of_details jsonb DEFAULT '{}',
  author text DEFAULT NULL) RETURNS void LANGUAGE plpgsql AS $$
DECLARE
  actor text := coalesce(nullif(current_setting('strata.actor', true), ''), author, activity_author());
  kind text := coalesce(nullif(current_setting('strata.actor_kind', true), ''), CASE WHEN actor = '' THEN 'server' ELSE 'person' END);
BEGIN
  INSERT INTO audit_log (actor_kind, actor, person_id, address, action, subject_kind, subject_id, subject, project_id, details)
  VALUES (kind, audit_text(actor, 255), (SELECT u.id FROM users u WHERE u.name = actor AND u.deleted IS NULL),
    audit_text(current_setting('strata.address', true), 100), of_action, of_kind, of_id, audit_text(of_subject, 255), of_project,
    jsonb_strip_nulls(of_details));
END $$;

-- Counts a failed sign-in in the row of its address, name and minute. An address can fill at most 20 rows in one minute. Further names are counted
-- in one row without a name.
CREATE FUNCTION audit_failed_sign_in(tried text, way text) RETURNS void LANGUAGE plpgsql AS $$
DECLARE
  origin text := audit_text(current_setting('strata.address', true), 100);
  tried_name text := audit_text(tried, 255);
  minute timestamptz := date_trunc('minute', clock_timestamp());
BEGIN
  -- One transaction at a time for each address, so that two attempts do not make two rows.
  PERFORM pg_advisory_xact_lock(hashtextextended('strata.audit ' || origin, 0));
  IF NOT EXISTS (SELECT 1 FROM audit_log l WHERE l.action = 'sign_in_failed' AND l.address = origin AND l.time >= minute AND l.actor = tried_name)
    AND (SELECT count(*) FROM audit_log l WHERE l.action = 'sign_in_failed' AND l.address = origin AND l.time >= minute) >= 20 THEN
    tried_name := '';
  END IF;
  UPDATE audit_log l SET count = l.count + 1 WHERE l.id = (SELECT f.id FROM audit_log f WHERE f.action = 'sign_in_failed'
    AND f.address = origin AND f.time >= minute AND f.actor = tried_name AND f.details ->> 'method' = way ORDER BY f.id LIMIT 1);
  IF NOT FOUND THEN
    INSERT INTO audit_log (actor_kind, actor, person_id, address, action, subject_kind, subject_id, subject, details)
    VALUES (CASE WHEN way = 'link' THEN 'link' ELSE 'person' END, tried_name,
      (SELECT u.id FROM users u WHERE lower(u.name) = lower(tried_name) AND u.deleted IS NULL), origin, 'sign_in_failed', 'session', NULL, '',
      jsonb_build_object('method', way));
  END IF;
END $$;

-- Deletes rows that are older than `days` whole days, at most `most` of them, and returns their number. The first part of a day's deletion writes
-- a row.
CREATE FUNCTION audit_purge(days integer, most integer) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE
  older_than timestamptz := date_trunc('day', clock_timestamp()) - days * interval '1 day';
  deleted bigint;
BEGIN
  IF days < 1 THEN
    RAISE EXCEPTION 'the audit log keeps its rows for at least one day' USING ERRCODE = 'invalid_parameter_value';
  END IF;
  PERFORM set_config('strata.audit_limit', older_than::text, true);
  DELETE FROM audit_log l WHERE l.id IN (SELECT o.id FROM audit_log o WHERE o.time < older_than ORDER BY o.time, o.id LIMIT most);
  GET DIAGNOSTICS deleted = ROW_COUNT;
  PERFORM set_config('strata.audit_limit', '', true);
  IF deleted > 0 THEN
    PERFORM audit('audit_purged', 'audit', NULL, '', NULL, jsonb_build_object('rows', deleted, 'before', older_than, 'days', days));
  END IF;
  RETURN deleted;
END $$;

-- --- accounts and roles

CREATE FUNCTION account_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  IF TG_OP = 'INSERT' THEN
    PERFORM audit('account_created', 'person', NEW.id, NEW.name, NULL, jsonb_build_object('role', NEW.role));
    RETURN NULL;
  END IF;
  IF NEW.deleted IS NOT NULL AND OLD.deleted IS NULL THEN
    PERFORM audit('account_deleted', 'person', OLD.id, OLD.name, NULL, jsonb_build_object('role', OLD.role));
    RETURN NULL;
  END IF;
  IF NEW.role <> OLD.role THEN
    PERFORM audit('role_changed', 'person', NEW.id, NEW.name, NULL, jsonb_build_object('before', OLD.role, 'after', NEW.role));
  END IF;
  IF (NEW.disabled IS NULL) <> (OLD.disabled IS NULL) THEN
    PERFORM audit(CASE WHEN NEW.disabled IS NULL THEN 'account_enabled' ELSE 'account_disabled' END, 'person', NEW.id, NEW.name, NULL);
  END IF;
  IF NEW.password IS DISTINCT FROM OLD.password THEN
    PERFORM audit('password_changed', 'person', NEW.id, NEW.name, NULL);
  END IF;
  IF NEW.name <> OLD.name OR NEW.full_name <> OLD.full_name THEN
    PERFORM audit('account_renamed', 'person', NEW.id, NEW.name, NULL,
      jsonb_build_object('name', CASE WHEN NEW.name = OLD.name THEN 'full_name' ELSE 'user' END));
  END IF;
  RETURN NULL;
END $$;
CREATE TRIGGER account_is_audited AFTER INSERT OR UPDATE OF name, full_name, role, password, disabled, deleted ON users
  FOR EACH ROW EXECUTE FUNCTION account_is_audited();

-- Roles of persons and groups in projects. Roles that end with their project have no rows, because the deletion of the project has one.
CREATE FUNCTION role_in_project_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  member jsonb := CASE WHEN TG_OP = 'DELETE' THEN to_jsonb(OLD) ELSE to_jsonb(NEW) END;
  member_id bigint := coalesce((member ->> 'user_id')::bigint, (member ->> 'group_id')::bigint);
  member_name text;
  project_name text;
BEGIN
  SELECT p.name INTO project_name FROM projects p WHERE p.id = (member ->> 'project_id')::bigint;
  IF NOT FOUND OR (TG_OP = 'UPDATE' AND to_jsonb(OLD) ->> 'role' = member ->> 'role') THEN
    RETURN NULL;
  END IF;
  IF TG_ARGV[0] = 'person' THEN
    SELECT u.name INTO member_name FROM users u WHERE u.id = member_id;
  ELSE
    SELECT g.name INTO member_name FROM groups g WHERE g.id = member_id;
  END IF;
  PERFORM audit(CASE TG_OP WHEN 'INSERT' THEN 'member_added' WHEN 'UPDATE' THEN 'role_changed' ELSE 'member_removed' END,
    TG_ARGV[0], member_id, member_name, (member ->> 'project_id')::bigint,
    jsonb_build_object('project', audit_text(project_name, 255),
      'before', CASE WHEN TG_OP <> 'INSERT' THEN to_jsonb(OLD) ->> 'role' END,
      'after', CASE WHEN TG_OP <> 'DELETE' THEN member ->> 'role' END));
  RETURN NULL;
END $$;
CREATE TRIGGER member_is_audited AFTER INSERT OR DELETE OR UPDATE OF role ON project_members
  FOR EACH ROW EXECUTE FUNCTION role_in_project_is_audited('person');
CREATE TRIGGER project_group_is_audited AFTER INSERT OR DELETE OR UPDATE OF role ON project_groups
  FOR EACH ROW EXECUTE FUNCTION role_in_project_is_audited('group');

CREATE FUNCTION group_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  IF TG_OP = 'INSERT' THEN
    PERFORM audit('group_created', 'group', NEW.id, NEW.name, NULL);
  ELSIF TG_OP = 'DELETE' THEN
    PERFORM audit('deletion', 'group', OLD.id, OLD.name, NULL);
  ELSIF NEW.name <> OLD.name THEN
    PERFORM audit('group_renamed', 'group', NEW.id, NEW.name, NULL, jsonb_build_object('before', audit_text(OLD.name, 255)));
  END IF;
  RETURN NULL;
END $$;
CREATE TRIGGER group_is_audited AFTER INSERT OR DELETE OR UPDATE OF name ON groups FOR EACH ROW EXECUTE FUNCTION group_is_audited();

-- The end of a group has one row, without a row for each of its persons.
CREATE FUNCTION group_person_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  member group_people := CASE WHEN TG_OP = 'DELETE' THEN OLD ELSE NEW END;
  group_name text;
BEGIN
  SELECT g.name INTO group_name FROM groups g WHERE g.id = member.group_id;
  IF FOUND THEN
    PERFORM audit(CASE TG_OP WHEN 'INSERT' THEN 'member_added' ELSE 'member_removed' END, 'person', member.user_id,
      (SELECT u.name FROM users u WHERE u.id = member.user_id), NULL, jsonb_build_object('group', audit_text(group_name, 255)));
  END IF;
  RETURN NULL;
END $$;
CREATE TRIGGER group_person_is_audited AFTER INSERT OR DELETE ON group_people FOR EACH ROW EXECUTE FUNCTION group_person_is_audited();

-- --- sessions, tokens and links

-- The actor of a sign-in is the person who has the session then. `strata.sign_in` is the way of the sign-in.
CREATE FUNCTION token_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  person bigint;
  label text := audit_text(NEW.label, 255);
  way text := coalesce(nullif(current_setting('strata.sign_in', true), ''), 'password');
BEGIN
  SELECT u.id INTO person FROM users u WHERE u.name = NEW.user_name;
  IF TG_OP = 'UPDATE' THEN
    IF OLD.revoked IS NULL AND NEW.revoked IS NOT NULL THEN
      IF NEW.kind = 'script' THEN
        PERFORM audit('token_revoked', 'token', NEW.id, label, NEW.project_id, jsonb_build_object('user', NEW.user_name));
      ELSIF NEW.kind = 'session' THEN
        PERFORM audit('sign_out', 'session', NEW.id, NEW.user_name, NULL);
      END IF;
    END IF;
    RETURN NULL;
  END IF;
  IF NEW.kind = 'session' THEN
    INSERT INTO audit_log (actor_kind, actor, person_id, address, action, subject_kind, subject_id, subject, details)
    VALUES (CASE WHEN way IN ('link', 'invitation') THEN 'link' WHEN way = 'token' THEN 'token' ELSE 'person' END, NEW.user_name, person,
      audit_text(current_setting('strata.address', true), 100), 'sign_in', 'session', NEW.id, NEW.user_name,
      jsonb_build_object('method', way));
  ELSIF NEW.kind = 'script' THEN
    PERFORM audit('token_created', 'token', NEW.id, label, NEW.project_id,
      jsonb_build_object('user', NEW.user_name, 'role', NEW.role, 'expires', NEW.expires));
  ELSE
    PERFORM audit('link_created', 'person', person, NEW.user_name, NULL, jsonb_build_object('link', NEW.kind, 'expires', NEW.expires));
  END IF;
  RETURN NULL;
END $$;
CREATE TRIGGER token_is_audited AFTER INSERT OR UPDATE OF revoked ON tokens FOR EACH ROW EXECUTE FUNCTION token_is_audited();

CREATE FUNCTION kiosk_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  kiosk kiosks := CASE WHEN TG_OP = 'DELETE' THEN OLD ELSE NEW END;
  tour record;
BEGIN
  SELECT t.name, m.project_id INTO tour FROM tours t JOIN all_models m ON m.id = t.model_id WHERE t.id = kiosk.tour_id;
  IF TG_OP = 'INSERT' THEN
    PERFORM audit('kiosk_created', 'kiosk', kiosk.id, kiosk.name, tour.project_id,
      jsonb_build_object('tour', audit_text(tour.name, 255), 'expires', kiosk.expires, 'phones', kiosk.phone IS NOT NULL));
  ELSIF TG_OP = 'DELETE' THEN
    -- Old links, which were no longer valid, already have a row.
    IF least(kiosk.revoked, kiosk.expires) IS NULL OR least(kiosk.revoked, kiosk.expires) > clock_timestamp() THEN
      PERFORM audit('kiosk_deleted', 'kiosk', kiosk.id, kiosk.name, tour.project_id);
    END IF;
  ELSIF OLD.revoked IS NULL AND NEW.revoked IS NOT NULL THEN
    PERFORM audit('kiosk_deleted', 'kiosk', kiosk.id, kiosk.name, tour.project_id);
  ELSIF (NEW.phone IS NULL) <> (OLD.phone IS NULL) THEN
    PERFORM audit('kiosk_changed', 'kiosk', kiosk.id, kiosk.name, tour.project_id, jsonb_build_object('phones', NEW.phone IS NOT NULL));
  ELSIF NEW.wants_reload AND NOT OLD.wants_reload THEN
    PERFORM audit('kiosk_changed', 'kiosk', kiosk.id, kiosk.name, tour.project_id, jsonb_build_object('reload', true));
  END IF;
  RETURN NULL;
END $$;
CREATE TRIGGER kiosk_is_audited AFTER INSERT OR DELETE OR UPDATE OF revoked, phone, wants_reload ON kiosks
  FOR EACH ROW EXECUTE FUNCTION kiosk_is_audited();

-- --- deletions

CREATE FUNCTION in_trash_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  thing jsonb := to_jsonb(NEW);
  of_project bigint := coalesce((thing ->> 'project_id')::bigint,
    (SELECT m.project_id FROM all_models m WHERE m.id = (thing ->> 'model_id')::bigint));
BEGIN
  IF (OLD.binned IS NULL) <> (NEW.binned IS NULL) THEN
    PERFORM audit(CASE WHEN NEW.binned IS NULL THEN 'restored' ELSE 'deletion' END, TG_ARGV[0], NEW.id, NEW.name, of_project);
  END IF;
  IF NEW.erasing AND NOT OLD.erasing THEN
    PERFORM audit('erased', TG_ARGV[0], NEW.id, NEW.name, of_project);
  END IF;
  RETURN NULL;
END $$;
CREATE TRIGGER layer_in_trash_is_audited AFTER UPDATE OF binned, erasing ON all_layers
  FOR EACH ROW EXECUTE FUNCTION in_trash_is_audited('layer');
CREATE TRIGGER model_in_trash_is_audited AFTER UPDATE OF binned, erasing ON all_models
  FOR EACH ROW EXECUTE FUNCTION in_trash_is_audited('model');

-- Objects that a person deletes without the Trash. Objects that end with their model, table or project have no rows, because its deletion has one.
-- Nor has the result of a job that failed, which the server itself removes.
CREATE FUNCTION deletion_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  thing jsonb := to_jsonb(OLD);
  of_project bigint := CASE WHEN TG_TABLE_NAME = 'projects' THEN OLD.id ELSE (thing ->> 'project_id')::bigint END;
BEGIN
  IF coalesce(nullif(current_setting('strata.actor', true), ''), activity_author()) = '' OR coalesce((thing ->> 'erasing')::boolean, false) THEN
    RETURN NULL;
  END IF;
  IF thing ? 'model_id' THEN
    SELECT m.project_id INTO of_project FROM all_models m WHERE m.id = (thing ->> 'model_id')::bigint AND NOT m.erasing;
    IF NOT FOUND THEN
      RETURN NULL;
    END IF;
  ELSIF TG_TABLE_NAME <> 'projects' AND of_project IS NOT NULL AND NOT EXISTS (SELECT 1 FROM projects p WHERE p.id = of_project) THEN
    RETURN NULL;
  END IF;
  PERFORM audit('deletion', TG_ARGV[0], OLD.id, coalesce(thing ->> 'name', ''), of_project);
  RETURN NULL;
END $$;
CREATE TRIGGER layer_deletion_is_audited AFTER DELETE ON all_layers FOR EACH ROW EXECUTE FUNCTION deletion_is_audited('layer');
CREATE TRIGGER model_deletion_is_audited AFTER DELETE ON all_models FOR EACH ROW EXECUTE FUNCTION deletion_is_audited('model');
CREATE TRIGGER table_deletion_is_audited AFTER DELETE ON record_tables FOR EACH ROW EXECUTE FUNCTION deletion_is_audited('table');
CREATE TRIGGER look_deletion_is_audited AFTER DELETE ON looks FOR EACH ROW EXECUTE FUNCTION deletion_is_audited('surface_image');
CREATE TRIGGER view_deletion_is_audited AFTER DELETE ON views FOR EACH ROW EXECUTE FUNCTION deletion_is_audited('view');
CREATE TRIGGER tour_deletion_is_audited AFTER DELETE ON tours FOR EACH ROW EXECUTE FUNCTION deletion_is_audited('tour');
CREATE TRIGGER snapshot_deletion_is_audited AFTER DELETE ON snapshots FOR EACH ROW EXECUTE FUNCTION deletion_is_audited('snapshot');
CREATE TRIGGER project_deletion_is_audited AFTER DELETE ON projects FOR EACH ROW EXECUTE FUNCTION deletion_is_audited('project');

-- The last comment of a thread may delete the thread too.
CREATE FUNCTION comment_deletion_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  IF OLD.deleted IS NULL AND coalesce(nullif(current_setting('strata.actor', true), ''), activity_author()) <> '' THEN
    PERFORM audit('deletion', 'comment', OLD.id, '', m.project_id, jsonb_build_object('by', OLD.user_name))
      FROM all_models m WHERE m.id = OLD.model_id AND NOT m.erasing;
  END IF;
  RETURN NULL;
END $$;
CREATE TRIGGER comment_deletion_is_audited AFTER DELETE ON comments FOR EACH ROW EXECUTE FUNCTION comment_deletion_is_audited();
CREATE TRIGGER comment_emptied_is_audited AFTER UPDATE OF deleted ON comments FOR EACH ROW
  WHEN (OLD.deleted IS NULL AND NEW.deleted IS NOT NULL) EXECUTE FUNCTION comment_deletion_is_audited();

CREATE FUNCTION tool_deletion_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM audit('deletion', 'tool', OLD.id, OLD.name, NULL);
  RETURN NULL;
END $$;
CREATE TRIGGER tool_deletion_is_audited AFTER UPDATE OF deleted ON tool_shapes FOR EACH ROW
  WHEN (OLD.deleted IS NULL AND NEW.deleted IS NOT NULL) EXECUTE FUNCTION tool_deletion_is_audited();

-- Records that were deleted or restored, also by undo and redo, and files that were detached from records. One row for each entry of the table's
-- journal.
CREATE FUNCTION record_deletion_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  of_table record;
  ended record;
BEGIN
  SELECT t.project_id, t.name INTO of_table FROM record_tables t WHERE t.id = NEW.table_id;
  IF NOT FOUND THEN
    RETURN NULL;
  END IF;
  SELECT count(*) FILTER (WHERE c.after -> 'exists' = 'false') AS deleted, count(*) FILTER (WHERE c.after -> 'exists' = 'true') AS restored,
      count(*) AS records, min(c.subject_id) AS key
    INTO ended FROM table_changes c WHERE c.table_id = NEW.table_id AND c.sequence = NEW.sequence AND c.subject = 'record';
  IF NEW.op = 'detach' THEN
    PERFORM audit('deletion', 'attachment', (NEW.record -> 'attachments' ->> 0)::bigint, of_table.name, of_table.project_id,
      jsonb_build_object('table', NEW.table_id, 'records', ended.records, 'sequence', NEW.sequence), NEW.user_name);
  END IF;
  IF ended.deleted > 0 THEN
    PERFORM audit('deletion', 'record', CASE WHEN ended.records = 1 THEN ended.key END, of_table.name, of_table.project_id,
      jsonb_build_object('table', NEW.table_id, 'records', ended.deleted, 'sequence', NEW.sequence), NEW.user_name);
  END IF;
  IF ended.restored > 0 THEN
    PERFORM audit('restored', 'record', CASE WHEN ended.records = 1 THEN ended.key END, of_table.name, of_table.project_id,
      jsonb_build_object('table', NEW.table_id, 'records', ended.restored, 'sequence', NEW.sequence), NEW.user_name);
  END IF;
  RETURN NULL;
END $$;
CREATE CONSTRAINT TRIGGER record_deletion_is_audited AFTER INSERT ON table_edits DEFERRABLE INITIALLY DEFERRED
  FOR EACH ROW WHEN (NEW.op IN ('delete', 'detach', 'restore', 'undo', 'redo')) EXECUTE FUNCTION record_deletion_is_audited();

-- A deleted column stays hidden in the table, for its history.
CREATE FUNCTION column_deletion_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM audit(CASE WHEN NEW.hidden THEN 'deletion' ELSE 'restored' END, 'column', NEW.id, NEW.properties ->> 'name', t.project_id,
    jsonb_build_object('table', t.id)) FROM record_tables t WHERE t.id = NEW.table_id;
  RETURN NULL;
END $$;
CREATE TRIGGER column_deletion_is_audited AFTER UPDATE OF hidden ON record_columns FOR EACH ROW
  WHEN (OLD.hidden <> NEW.hidden) EXECUTE FUNCTION column_deletion_is_audited();

-- --- visibility and settings

CREATE FUNCTION visibility_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  thing jsonb := to_jsonb(NEW);
  of_project bigint;
BEGIN
  IF TG_TABLE_NAME = 'all_layers' THEN
    SELECT m.project_id INTO of_project FROM all_models m WHERE m.id = (thing ->> 'model_id')::bigint;
  ELSE
    SELECT t.project_id INTO of_project FROM record_tables t WHERE t.id = (thing ->> 'table_id')::bigint;
  END IF;
  PERFORM audit('visibility_changed', TG_ARGV[0], NEW.id, coalesce(thing ->> 'name', thing -> 'properties' ->> 'name'), of_project,
    jsonb_build_object('before', OLD.visibility, 'after', NEW.visibility));
  RETURN NULL;
END $$;
CREATE TRIGGER layer_visibility_is_audited AFTER UPDATE OF visibility ON all_layers FOR EACH ROW
  WHEN (OLD.visibility <> NEW.visibility) EXECUTE FUNCTION visibility_is_audited('layer');
CREATE TRIGGER column_visibility_is_audited AFTER UPDATE OF visibility ON record_columns FOR EACH ROW
  WHEN (OLD.visibility <> NEW.visibility) EXECUTE FUNCTION visibility_is_audited('column');
CREATE TRIGGER attachment_visibility_is_audited AFTER UPDATE OF visibility ON attachments FOR EACH ROW
  WHEN (OLD.visibility <> NEW.visibility) EXECUTE FUNCTION visibility_is_audited('attachment');

-- A model shows all that it has to other people when it moves to another project, and its files when the role for downloads changes.
CREATE FUNCTION model_access_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  IF NEW.project_id <> OLD.project_id THEN
    PERFORM audit('visibility_changed', 'model', NEW.id, NEW.name, NEW.project_id,
      jsonb_build_object('project_before', OLD.project_id, 'project_after', NEW.project_id));
  END IF;
  IF NEW.source_download <> OLD.source_download THEN
    PERFORM audit('visibility_changed', 'model', NEW.id, NEW.name, NEW.project_id,
      jsonb_build_object('files_before', OLD.source_download, 'files_after', NEW.source_download));
  END IF;
  RETURN NULL;
END $$;
CREATE TRIGGER model_access_is_audited AFTER UPDATE OF project_id, source_download ON all_models
  FOR EACH ROW EXECUTE FUNCTION model_access_is_audited();

CREATE FUNCTION project_settings_are_audited() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM audit('setting_changed', 'project', NEW.id, NEW.name, NEW.id,
    jsonb_build_object('setting', 'require_if_match', 'before', OLD.require_if_match, 'after', NEW.require_if_match));
  RETURN NULL;
END $$;
CREATE TRIGGER project_settings_are_audited AFTER UPDATE OF require_if_match ON projects FOR EACH ROW
  WHEN (OLD.require_if_match <> NEW.require_if_match) EXECUTE FUNCTION project_settings_are_audited();
