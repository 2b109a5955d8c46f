-- migrate:up
-- readable-from: 44

-- What the nodes of a site report to each other: the subjects of changes, never their contents. A node that receives a message reads the subject
-- itself, and shows each user only what this user may see. Triggers write the messages in the transaction of the change, so that no change can be
-- missing, whichever program makes it. A site without nodes has no messages.
CREATE TABLE node_messages (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  -- the transaction; messages become visible in the order of commits, not of ids (server/store/nodes/node_messages.h)
  xid bigint NOT NULL DEFAULT pg_current_xact_id()::text::bigint,
  time timestamptz NOT NULL DEFAULT clock_timestamp(),
  -- null: a program that is not a node, such as the command line
  from_node uuid,
  kind text NOT NULL CHECK (kind IN ('records', 'table', 'comment', 'view', 'snapshot', 'tool', 'access', 'kiosk')),
  event text NOT NULL CHECK (event IN ('created', 'changed', 'deleted')),
  project_id bigint,
  model_id bigint,
  subject_ids bigint[] NOT NULL DEFAULT '{}' CHECK (cardinality(subject_ids) <= 500),
  -- of the entry in the journal of the table
  sequence bigint,
  -- the author of the change; for 'access' the user whose rights changed, or empty for all users
  user_name text NOT NULL
);
CREATE INDEX node_messages_xid ON node_messages (xid);

CREATE FUNCTION node_event(operation text) RETURNS text LANGUAGE sql IMMUTABLE AS
$$ SELECT CASE operation WHEN 'INSERT' THEN 'created' WHEN 'UPDATE' THEN 'changed' ELSE 'deleted' END $$;

-- The notification only wakes the nodes. They also read the messages once a second.
CREATE FUNCTION send_to_nodes(of_kind text, of_event text, of_project bigint, of_model bigint, of_subjects bigint[], of_user text,
  of_sequence bigint DEFAULT NULL) RETURNS void LANGUAGE plpgsql AS $$
BEGIN
  IF NOT EXISTS (SELECT FROM nodes) THEN
    RETURN;
  END IF;
  INSERT INTO node_messages (from_node, kind, event, project_id, model_id, subject_ids, sequence, user_name)
  VALUES (substring(current_setting('application_name') FROM '^strata-([0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12})$')::uuid,
    of_kind, of_event, of_project, of_model, of_subjects, of_sequence, coalesce(of_user, ''));
  PERFORM pg_notify('strata_nodes', '');
END $$;

CREATE FUNCTION records_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM send_to_nodes('records', 'changed', t.project_id, NULL, ARRAY[NEW.table_id], NEW.user_name, NEW.sequence)
  FROM record_tables t WHERE t.id = NEW.table_id;
  RETURN NULL;
END $$;
CREATE TRIGGER records_to_nodes AFTER INSERT ON table_edits FOR EACH ROW EXECUTE FUNCTION records_to_nodes();

CREATE FUNCTION table_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  changed record_tables := CASE WHEN TG_OP = 'DELETE' THEN OLD ELSE NEW END;
BEGIN
  PERFORM send_to_nodes('table', node_event(TG_OP), changed.project_id, NULL, ARRAY[changed.id], activity_author());
  RETURN NULL;
END $$;
CREATE TRIGGER table_to_nodes AFTER INSERT OR DELETE ON record_tables FOR EACH ROW EXECUTE FUNCTION table_to_nodes();
-- A change with a new sequence is in the journal, and already has a message.
CREATE TRIGGER table_change_to_nodes AFTER UPDATE OF version ON record_tables FOR EACH ROW
  WHEN (OLD.version <> NEW.version AND OLD.sequence = NEW.sequence) EXECUTE FUNCTION table_to_nodes();

CREATE FUNCTION attachment_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM send_to_nodes('table', 'changed', t.project_id, NULL, ARRAY[t.id], activity_author())
  FROM record_tables t WHERE t.id = NEW.table_id;
  RETURN NULL;
END $$;
CREATE TRIGGER attachment_to_nodes AFTER UPDATE OF visibility ON attachments FOR EACH ROW
  WHEN (OLD.visibility <> NEW.visibility) EXECUTE FUNCTION attachment_to_nodes();

CREATE FUNCTION comment_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM send_to_nodes('comment', node_event(TG_OP), NULL, NEW.model_id, ARRAY[NEW.id], activity_author());
  RETURN NULL;
END $$;
CREATE TRIGGER comment_to_nodes AFTER INSERT ON comments FOR EACH ROW EXECUTE FUNCTION comment_to_nodes();
CREATE TRIGGER comment_change_to_nodes AFTER UPDATE OF version ON comments FOR EACH ROW
  WHEN (OLD.version <> NEW.version) EXECUTE FUNCTION comment_to_nodes();

-- One message for up to 500 comments. None for those that disappear with their model, because its page closes.
CREATE FUNCTION comments_gone_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM send_to_nodes('comment', 'deleted', NULL, part.model_id, part.ids, activity_author())
  FROM (
    SELECT one.model_id, array_agg(one.id ORDER BY one.id) AS ids
    FROM (SELECT g.model_id, g.id, (row_number() OVER (ORDER BY g.id) - 1) / 500 AS part FROM gone g JOIN models m ON m.id = g.model_id) one
    GROUP BY one.model_id, one.part
  ) part;
  RETURN NULL;
END $$;
CREATE TRIGGER comments_gone_to_nodes AFTER DELETE ON comments REFERENCING OLD TABLE AS gone
  FOR EACH STATEMENT EXECUTE FUNCTION comments_gone_to_nodes();

-- Views and snapshots.
CREATE FUNCTION named_part_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  part_id bigint := CASE WHEN TG_OP = 'DELETE' THEN OLD.id ELSE NEW.id END;
  of_model bigint := CASE WHEN TG_OP = 'DELETE' THEN OLD.model_id ELSE NEW.model_id END;
BEGIN
  PERFORM send_to_nodes(TG_ARGV[0], node_event(TG_OP), NULL, m.id, ARRAY[part_id], activity_author()) FROM models m WHERE m.id = of_model;
  RETURN NULL;
END $$;
CREATE TRIGGER view_to_nodes AFTER INSERT OR DELETE ON views FOR EACH ROW EXECUTE FUNCTION named_part_to_nodes('view');
CREATE TRIGGER view_change_to_nodes AFTER UPDATE OF version ON views FOR EACH ROW
  WHEN (OLD.version <> NEW.version) EXECUTE FUNCTION named_part_to_nodes('view');
CREATE TRIGGER snapshot_to_nodes AFTER INSERT OR DELETE ON snapshots FOR EACH ROW EXECUTE FUNCTION named_part_to_nodes('snapshot');
CREATE TRIGGER snapshot_change_to_nodes AFTER UPDATE OF version ON snapshots FOR EACH ROW
  WHEN (OLD.version <> NEW.version) EXECUTE FUNCTION named_part_to_nodes('snapshot');

-- Deleted tools keep their rows.
CREATE FUNCTION tool_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM send_to_nodes('tool', CASE WHEN NEW.deleted IS NULL THEN node_event(TG_OP) ELSE 'deleted' END, NULL, NULL, ARRAY[NEW.id],
    activity_author());
  RETURN NULL;
END $$;
CREATE TRIGGER tool_to_nodes AFTER INSERT OR UPDATE OF name, deleted ON tool_shapes FOR EACH ROW EXECUTE FUNCTION tool_to_nodes();

-- Accounts, roles and secrets. A node that receives the message checks the live connections of the user again.
CREATE FUNCTION account_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM send_to_nodes('access', node_event(TG_OP), NULL, NULL, '{}', CASE WHEN TG_OP = 'INSERT' THEN NEW.name ELSE OLD.name END);
  RETURN NULL;
END $$;
CREATE TRIGGER account_to_nodes AFTER INSERT ON users FOR EACH ROW EXECUTE FUNCTION account_to_nodes();
CREATE TRIGGER account_change_to_nodes AFTER UPDATE OF name, role, password, disabled, deleted ON users FOR EACH ROW
  WHEN ((OLD.name, OLD.role, OLD.password, OLD.disabled, OLD.deleted) IS DISTINCT FROM
    (NEW.name, NEW.role, NEW.password, NEW.disabled, NEW.deleted)) EXECUTE FUNCTION account_to_nodes();

CREATE FUNCTION token_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM send_to_nodes('access', 'deleted', NULL, NULL, '{}', OLD.user_name);
  RETURN NULL;
END $$;
CREATE TRIGGER token_to_nodes AFTER UPDATE OF revoked ON tokens FOR EACH ROW
  WHEN (OLD.revoked IS NULL AND NEW.revoked IS NOT NULL) EXECUTE FUNCTION token_to_nodes();
CREATE TRIGGER token_gone_to_nodes AFTER DELETE ON tokens FOR EACH ROW WHEN (OLD.revoked IS NULL) EXECUTE FUNCTION token_to_nodes();

-- Of members of projects and of groups.
CREATE FUNCTION member_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
DECLARE
  person bigint := CASE WHEN TG_OP = 'DELETE' THEN OLD.user_id ELSE NEW.user_id END;
BEGIN
  PERFORM send_to_nodes('access', node_event(TG_OP), NULL, NULL, '{}', u.name) FROM users u WHERE u.id = person;
  RETURN NULL;
END $$;
CREATE TRIGGER member_to_nodes AFTER INSERT OR DELETE OR UPDATE OF role ON project_members FOR EACH ROW EXECUTE FUNCTION member_to_nodes();
CREATE TRIGGER group_person_to_nodes AFTER INSERT OR DELETE ON group_people FOR EACH ROW EXECUTE FUNCTION member_to_nodes();

CREATE FUNCTION project_group_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM send_to_nodes('access', node_event(TG_OP), NULL, NULL, '{}', '');
  RETURN NULL;
END $$;
CREATE TRIGGER project_group_to_nodes AFTER INSERT OR DELETE OR UPDATE OF role ON project_groups
  FOR EACH ROW EXECUTE FUNCTION project_group_to_nodes();

CREATE FUNCTION kiosk_to_nodes() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM send_to_nodes('kiosk', node_event(TG_OP), NULL, NULL, ARRAY[OLD.id], activity_author());
  RETURN NULL;
END $$;
CREATE TRIGGER kiosk_to_nodes AFTER DELETE ON kiosks FOR EACH ROW EXECUTE FUNCTION kiosk_to_nodes();
CREATE TRIGGER kiosk_change_to_nodes AFTER UPDATE OF revoked, phone ON kiosks FOR EACH ROW
  WHEN ((OLD.revoked, OLD.phone) IS DISTINCT FROM (NEW.revoked, NEW.phone)) EXECUTE FUNCTION kiosk_to_nodes();
