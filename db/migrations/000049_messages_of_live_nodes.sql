-- migrate:up
-- readable-from: 44

-- A site without nodes writes no messages, although rows of former nodes may remain: those of a restored backup, or of nodes that were killed. Only a
-- node deletes such rows, and old messages. A node that has had no lease for 10 minutes has missed messages in any case, and reads everything again
-- (server/store/nodes/node_messages.h).
CREATE OR REPLACE FUNCTION send_to_nodes(of_kind text, of_event text, of_project bigint, of_model bigint, of_subjects bigint[], of_user text,
  of_sequence bigint DEFAULT NULL) RETURNS void LANGUAGE plpgsql AS $$
BEGIN
  IF NOT EXISTS (SELECT FROM nodes WHERE lease_until > clock_timestamp() - interval '10 minutes') THEN
    RETURN;
  END IF;
  INSERT INTO node_messages (from_node, kind, event, project_id, model_id, subject_ids, sequence, user_name)
  VALUES (substring(current_setting('application_name') FROM '^strata-([0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12})$')::uuid,
    of_kind, of_event, of_project, of_model, of_subjects, of_sequence, coalesce(of_user, ''));
  PERFORM pg_notify('strata_nodes', '');
END $$;
