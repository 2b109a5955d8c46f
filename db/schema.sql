CREATE SCHEMA analysis;

CREATE SCHEMA records;

CREATE DOMAIN public.slug AS text
	CONSTRAINT slug_check CHECK (((VALUE ~ '^[a-z0-9-]+$'::text) AND (VALUE !~ '^[0-9]+$'::text)));

CREATE FUNCTION analysis.srid(crs text) RETURNS integer
    LANGUAGE sql IMMUTABLE PARALLEL SAFE
    AS $_$
  SELECT substring(crs FROM '^EPSG:([0-9]{1,9})$')::integer
$_$;

CREATE FUNCTION analysis.wkt(places jsonb, of_model bigint DEFAULT NULL::bigint) RETURNS text
    LANGUAGE sql IMMUTABLE PARALLEL SAFE
    AS $$
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

CREATE FUNCTION public.account_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.account_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM send_to_nodes('access', node_event(TG_OP), NULL, NULL, '{}', CASE WHEN TG_OP = 'INSERT' THEN NEW.name ELSE OLD.name END);
  RETURN NULL;
END $$;

CREATE FUNCTION public.activity_author() RETURNS text
    LANGUAGE sql STABLE
    AS $$ SELECT coalesce(current_setting('strata.user', true), '') $$;

CREATE TABLE public.activities (
    id bigint NOT NULL,
    project_id bigint NOT NULL,
    model_id bigint,
    layer_id bigint,
    table_id bigint,
    record_key bigint,
    comment_id bigint,
    subject text NOT NULL,
    user_name text NOT NULL,
    kind text NOT NULL,
    op text NOT NULL,
    begun timestamp with time zone NOT NULL,
    "time" timestamp with time zone NOT NULL,
    count bigint DEFAULT 1 NOT NULL,
    texels bigint,
    area_m2 double precision,
    last_stroke uuid,
    person text,
    role text,
    changed text[],
    visibility text DEFAULT 'public'::text NOT NULL,
    group_name text,
    CONSTRAINT activities_kind_check CHECK ((kind = ANY (ARRAY['edit'::text, 'layer'::text, 'look'::text, 'view'::text, 'tour'::text, 'snapshot'::text, 'selection'::text, 'model'::text, 'table'::text, 'columns'::text, 'records'::text, 'comment'::text, 'member'::text, 'project'::text])))
);

CREATE FUNCTION public.activity_of(of_project bigint, of_kind text, of_op text, of_subject text) RETURNS public.activities
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.analysis_make_way(held regclass) RETURNS void
    LANGUAGE plpgsql
    AS $$
BEGIN
  IF pg_has_role(current_user, 'pg_signal_backend', 'USAGE') THEN
    PERFORM pg_terminate_backend(l.pid) FROM pg_locks l JOIN pg_stat_activity a ON a.pid = l.pid
      WHERE l.locktype = 'relation' AND l.relation = held AND a.usename = 'strata_reader';
  END IF;
END $$;

CREATE FUNCTION public.analysis_name(name text, suffix text) RETURNS text
    LANGUAGE plpgsql IMMUTABLE
    AS $$
DECLARE
  kept text := left(name, 63);
BEGIN
  WHILE octet_length(kept) + octet_length(suffix) > 63 LOOP
    kept := left(kept, -1);
  END LOOP;
  RETURN kept || suffix;
END $$;

CREATE FUNCTION public.analysis_show_table(shown bigint) RETURNS void
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.analysis_table_changed() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM analysis_show_table(CASE TG_TABLE_NAME WHEN 'record_tables' THEN (to_jsonb(NEW) ->> 'id')::bigint ELSE (to_jsonb(NEW) ->> 'table_id')::bigint END);
  RETURN NULL;
END $$;

CREATE FUNCTION public.attachment_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM send_to_nodes('table', 'changed', t.project_id, NULL, ARRAY[t.id], activity_author())
  FROM record_tables t WHERE t.id = NEW.table_id;
  RETURN NULL;
END $$;

CREATE FUNCTION public.audit(of_action text, of_kind text, of_id bigint, of_subject text, of_project bigint, of_details jsonb DEFAULT '{}'::jsonb, author text DEFAULT NULL::text) RETURNS void
    LANGUAGE plpgsql
    AS $$
DECLARE
  actor text := coalesce(nullif(current_setting('strata.actor', true), ''), author, activity_author());
  kind text := coalesce(nullif(current_setting('strata.actor_kind', true), ''), CASE WHEN actor = '' THEN 'server' ELSE 'person' END);
BEGIN
  INSERT INTO audit_log (actor_kind, actor, person_id, address, action, subject_kind, subject_id, subject, project_id, details)
  VALUES (kind, audit_text(actor, 255), (SELECT u.id FROM users u WHERE u.name = actor AND u.deleted IS NULL),
    audit_text(current_setting('strata.address', true), 100), of_action, of_kind, of_id, audit_text(of_subject, 255), of_project,
    jsonb_strip_nulls(of_details));
END $$;

CREATE FUNCTION public.audit_failed_sign_in(tried text, way text) RETURNS void
    LANGUAGE plpgsql
    AS $$
DECLARE
  origin text := audit_text(current_setting('strata.address', true), 100);
  tried_name text := audit_text(tried, 255);
  minute timestamptz := date_trunc('minute', clock_timestamp());
  facts jsonb := jsonb_strip_nulls(jsonb_build_object('method', way, 'provider', nullif(current_setting('strata.provider', true), '')));
BEGIN
  -- One transaction at a time for each address, so that two attempts do not make two rows.
  PERFORM pg_advisory_xact_lock(hashtextextended('strata.audit ' || origin, 0));
  IF NOT EXISTS (SELECT 1 FROM audit_log l WHERE l.action = 'sign_in_failed' AND l.address = origin AND l.time >= minute AND l.actor = tried_name)
    AND (SELECT count(*) FROM audit_log l WHERE l.action = 'sign_in_failed' AND l.address = origin AND l.time >= minute) >= 20 THEN
    tried_name := '';
  END IF;
  UPDATE audit_log l SET count = l.count + 1 WHERE l.id = (SELECT f.id FROM audit_log f WHERE f.action = 'sign_in_failed'
    AND f.address = origin AND f.time >= minute AND f.actor = tried_name AND f.details = facts ORDER BY f.id LIMIT 1);
  IF NOT FOUND THEN
    INSERT INTO audit_log (actor_kind, actor, person_id, address, action, subject_kind, subject_id, subject, details)
    VALUES (CASE WHEN way = 'link' THEN 'link' ELSE 'person' END, tried_name,
      (SELECT u.id FROM users u WHERE lower(u.name) = lower(tried_name) AND u.deleted IS NULL), origin, 'sign_in_failed', 'session', NULL, '',
      facts);
  END IF;
END $$;

CREATE FUNCTION public.audit_is_kept() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.audit_purge(days integer, most integer) RETURNS bigint
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.audit_text(given text, longest integer) RETURNS text
    LANGUAGE plpgsql IMMUTABLE
    AS $$
DECLARE
  short text := left(coalesce(given, ''), longest);
BEGIN
  WHILE octet_length(short) > longest LOOP
    short := left(short, length(short) - greatest((octet_length(short) - longest) / 4, 1));
  END LOOP;
  RETURN short;
END $$;

CREATE FUNCTION public.bin_is_activity() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
DECLARE
  thing jsonb := to_jsonb(NEW);
  line activities;
  of_project bigint := (thing ->> 'project_id')::bigint;
BEGIN
  IF TG_ARGV[0] = 'layer' THEN
    SELECT m.project_id INTO of_project FROM all_models m WHERE m.id = NEW.model_id;
    UPDATE activities SET visibility = NEW.visibility WHERE model_id = NEW.model_id AND layer_id = NEW.id;
  END IF;
  line := activity_of(of_project, TG_ARGV[0], CASE WHEN NEW.binned IS NULL THEN 'restored' ELSE 'deleted' END, NEW.name);
  IF TG_ARGV[0] = 'layer' THEN
    line.model_id := NEW.model_id;
    line.layer_id := NEW.id;
    line.visibility := NEW.visibility;
  ELSE
    line.model_id := NEW.id;
  END IF;
  PERFORM note_activity(line);
  RETURN NULL;
END $$;

CREATE FUNCTION public.changed_columns(before jsonb, after jsonb) RETURNS text[]
    LANGUAGE sql IMMUTABLE
    AS $$
  SELECT array_agg(a.key ORDER BY a.key) FROM jsonb_each(after) a
  WHERE a.value IS DISTINCT FROM before -> a.key
    AND a.key NOT IN ('version', 'sequence', 'computed_sequence', 'summed', 'bounds_min', 'bounds_max', 'area')
$$;

CREATE FUNCTION public.column_deletion_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM audit(CASE WHEN NEW.hidden THEN 'deletion' ELSE 'restored' END, 'column', NEW.id, NEW.properties ->> 'name', t.project_id,
    jsonb_build_object('table', t.id)) FROM record_tables t WHERE t.id = NEW.table_id;
  RETURN NULL;
END $$;

CREATE FUNCTION public.comment_deletion_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  IF OLD.deleted IS NULL AND coalesce(nullif(current_setting('strata.actor', true), ''), activity_author()) <> '' THEN
    PERFORM audit('deletion', 'comment', OLD.id, '', m.project_id, jsonb_build_object('by', OLD.user_name))
      FROM all_models m WHERE m.id = OLD.model_id AND NOT m.erasing;
  END IF;
  RETURN NULL;
END $$;

CREATE FUNCTION public.comment_is_activity() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.comment_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM send_to_nodes('comment', node_event(TG_OP), NULL, NEW.model_id, ARRAY[NEW.id], activity_author());
  RETURN NULL;
END $$;

CREATE FUNCTION public.comments_gone_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM send_to_nodes('comment', 'deleted', NULL, part.model_id, part.ids, activity_author())
  FROM (
    SELECT one.model_id, array_agg(one.id ORDER BY one.id) AS ids
    FROM (SELECT g.model_id, g.id, (row_number() OVER (ORDER BY g.id) - 1) / 500 AS part FROM gone g JOIN models m ON m.id = g.model_id) one
    GROUP BY one.model_id, one.part
  ) part;
  RETURN NULL;
END $$;

CREATE FUNCTION public.deletion_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.edits_are_activity() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.group_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.group_person_is_activity() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.group_person_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.in_trash_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.kiosk_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.kiosk_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM send_to_nodes('kiosk', node_event(TG_OP), NULL, NULL, ARRAY[OLD.id], activity_author());
  RETURN NULL;
END $$;

CREATE FUNCTION public.member_is_activity() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.member_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
DECLARE
  person bigint := CASE WHEN TG_OP = 'DELETE' THEN OLD.user_id ELSE NEW.user_id END;
BEGIN
  PERFORM send_to_nodes('access', node_event(TG_OP), NULL, NULL, '{}', u.name) FROM users u WHERE u.id = person;
  RETURN NULL;
END $$;

CREATE FUNCTION public.model_access_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.named_part_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
DECLARE
  part_id bigint := CASE WHEN TG_OP = 'DELETE' THEN OLD.id ELSE NEW.id END;
  of_model bigint := CASE WHEN TG_OP = 'DELETE' THEN OLD.model_id ELSE NEW.model_id END;
BEGIN
  PERFORM send_to_nodes(TG_ARGV[0], node_event(TG_OP), NULL, m.id, ARRAY[part_id], activity_author()) FROM models m WHERE m.id = of_model;
  RETURN NULL;
END $$;

CREATE FUNCTION public.node_event(operation text) RETURNS text
    LANGUAGE sql IMMUTABLE
    AS $$ SELECT CASE operation WHEN 'INSERT' THEN 'created' WHEN 'UPDATE' THEN 'changed' ELSE 'deleted' END $$;

CREATE FUNCTION public.note_activity(line public.activities, first_stroke uuid DEFAULT NULL::uuid) RETURNS void
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.photograph_deletion_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  IF coalesce(nullif(current_setting('strata.actor', true), ''), activity_author()) = '' THEN
    RETURN NULL;
  END IF;
  PERFORM audit('deletion', 'photograph', CASE WHEN part.photographs = 1 THEN part.id END,
    CASE WHEN part.photographs = 1 THEN part.name ELSE '' END, part.project_id,
    jsonb_build_object('model', part.model_id, 'photographs', part.photographs))
  FROM (
    SELECT m.id AS model_id, m.project_id, count(*) AS photographs, min(g.id) AS id, min(g.name) AS name
    FROM gone g JOIN all_models m ON m.id = g.model_id AND NOT m.erasing GROUP BY m.id, m.project_id
  ) part;
  RETURN NULL;
END $$;

CREATE FUNCTION public.project_group_is_activity() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.project_group_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM send_to_nodes('access', node_event(TG_OP), NULL, NULL, '{}', '');
  RETURN NULL;
END $$;

CREATE FUNCTION public.project_settings_are_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM audit('setting_changed', 'project', NEW.id, NEW.name, NEW.id,
    jsonb_build_object('setting', 'require_if_match', 'before', OLD.require_if_match, 'after', NEW.require_if_match));
  RETURN NULL;
END $$;

CREATE FUNCTION public.record_deletion_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.records_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM send_to_nodes('records', 'changed', t.project_id, NULL, ARRAY[NEW.table_id], NEW.user_name, NEW.sequence)
  FROM record_tables t WHERE t.id = NEW.table_id;
  RETURN NULL;
END $$;

CREATE FUNCTION public.role_in_project_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.role_rank(role text) RETURNS integer
    LANGUAGE sql IMMUTABLE
    AS $$ SELECT array_position(ARRAY['guest', 'viewer', 'annotator', 'curator', 'administrator', 'owner'], role) $$;

CREATE FUNCTION public.selection_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.send_to_nodes(of_kind text, of_event text, of_project bigint, of_model bigint, of_subjects bigint[], of_user text, of_sequence bigint DEFAULT NULL::bigint) RETURNS void
    LANGUAGE plpgsql
    AS $_$
BEGIN
  IF NOT EXISTS (SELECT FROM nodes WHERE lease_until > clock_timestamp() - interval '10 minutes') THEN
    RETURN;
  END IF;
  INSERT INTO node_messages (from_node, kind, event, project_id, model_id, subject_ids, sequence, user_name)
  VALUES (substring(current_setting('application_name') FROM '^strata-([0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12})$')::uuid,
    of_kind, of_event, of_project, of_model, of_subjects, of_sequence, coalesce(of_user, ''));
  PERFORM pg_notify('strata_nodes', '');
END $_$;

CREATE FUNCTION public.sign_on_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM audit('oidc_bound', 'person', NEW.user_id, (SELECT u.name FROM users u WHERE u.id = NEW.user_id), NULL,
    jsonb_build_object('issuer', NEW.issuer, 'subject', NEW.subject));
  RETURN NULL;
END $$;

CREATE FUNCTION public.table_edit_is_activity() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.table_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
DECLARE
  changed record_tables := CASE WHEN TG_OP = 'DELETE' THEN OLD ELSE NEW END;
BEGIN
  PERFORM send_to_nodes('table', node_event(TG_OP), changed.project_id, NULL, ARRAY[changed.id], activity_author());
  RETURN NULL;
END $$;

CREATE FUNCTION public.thing_is_activity() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE FUNCTION public.token_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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
      jsonb_strip_nulls(jsonb_build_object('method', way, 'provider', nullif(current_setting('strata.provider', true), ''))));
  ELSIF NEW.kind = 'script' THEN
    PERFORM audit('token_created', 'token', NEW.id, label, NEW.project_id,
      jsonb_build_object('user', NEW.user_name, 'role', NEW.role, 'expires', NEW.expires));
  ELSE
    PERFORM audit('link_created', 'person', person, NEW.user_name, NULL, jsonb_build_object('link', NEW.kind, 'expires', NEW.expires));
  END IF;
  RETURN NULL;
END $$;

CREATE FUNCTION public.token_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM send_to_nodes('access', 'deleted', NULL, NULL, '{}', OLD.user_name);
  RETURN NULL;
END $$;

CREATE FUNCTION public.tool_deletion_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM audit('deletion', 'tool', OLD.id, OLD.name, NULL);
  RETURN NULL;
END $$;

CREATE FUNCTION public.tool_to_nodes() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
BEGIN
  PERFORM send_to_nodes('tool', CASE WHEN NEW.deleted IS NULL THEN node_event(TG_OP) ELSE 'deleted' END, NULL, NULL, ARRAY[NEW.id],
    activity_author());
  RETURN NULL;
END $$;

CREATE FUNCTION public.visibility_is_audited() RETURNS trigger
    LANGUAGE plpgsql
    AS $$
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

CREATE TABLE public.all_layers (
    id bigint NOT NULL,
    model_id bigint NOT NULL,
    name text NOT NULL,
    slug public.slug NOT NULL,
    kind text NOT NULL,
    type text NOT NULL,
    resolution integer NOT NULL,
    unit text NOT NULL,
    description text NOT NULL,
    palette jsonb NOT NULL,
    opacity double precision NOT NULL,
    visible boolean NOT NULL,
    draw_order integer NOT NULL,
    sequence bigint DEFAULT 0 NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    table_id bigint,
    expression text,
    automatic boolean DEFAULT false NOT NULL,
    computed_sequence bigint DEFAULT 0 NOT NULL,
    summed boolean DEFAULT true NOT NULL,
    locked boolean DEFAULT false NOT NULL,
    visibility text DEFAULT 'public'::text NOT NULL,
    review boolean DEFAULT false NOT NULL,
    binned timestamp with time zone,
    binned_by text,
    binned_bytes bigint,
    erasing boolean DEFAULT false NOT NULL,
    labels jsonb DEFAULT '{}'::jsonb NOT NULL,
    descriptions jsonb DEFAULT '{}'::jsonb NOT NULL,
    group_name text,
    blend text DEFAULT 'normal'::text NOT NULL,
    CONSTRAINT all_layers_blend_check CHECK ((blend = ANY (ARRAY['normal'::text, 'multiply'::text, 'screen'::text]))),
    CONSTRAINT all_layers_check CHECK ((((binned IS NULL) = (binned_by IS NULL)) AND ((binned IS NULL) = (binned_bytes IS NULL)) AND ((binned IS NOT NULL) OR (NOT erasing)))),
    CONSTRAINT all_layers_group_name_check CHECK (((char_length(group_name) >= 1) AND (char_length(group_name) <= 60))),
    CONSTRAINT layers_check CHECK (((kind = 'database'::text) = (table_id IS NOT NULL))),
    CONSTRAINT layers_check1 CHECK (((expression IS NOT NULL) OR (NOT automatic))),
    CONSTRAINT layers_expression_check CHECK ((expression <> ''::text)),
    CONSTRAINT layers_kind_check CHECK ((kind = ANY (ARRAY['numeric'::text, 'database'::text]))),
    CONSTRAINT layers_name_check CHECK ((name <> ''::text)),
    CONSTRAINT layers_opacity_check CHECK (((opacity >= (0)::double precision) AND (opacity <= (1)::double precision))),
    CONSTRAINT layers_resolution_check CHECK ((((resolution >= 128) AND (resolution <= 16384)) AND ((resolution & (resolution - 1)) = 0))),
    CONSTRAINT layers_type_check CHECK ((type = ANY (ARRAY['u8'::text, 'u16'::text, 'u32'::text, 'i8'::text, 'i16'::text, 'i32'::text, 'f16'::text, 'f32'::text]))),
    CONSTRAINT layers_visibility_check CHECK ((visibility = ANY (ARRAY['public'::text, 'team'::text, 'private'::text])))
);

CREATE TABLE public.all_models (
    id bigint NOT NULL,
    project_id bigint NOT NULL,
    name text NOT NULL,
    slug public.slug NOT NULL,
    unit text NOT NULL,
    unit_assumed boolean NOT NULL,
    scale_verified boolean NOT NULL,
    up text NOT NULL,
    north text NOT NULL,
    crs text NOT NULL,
    origin double precision[] NOT NULL,
    bounds_min double precision[] NOT NULL,
    bounds_max double precision[] NOT NULL,
    triangles bigint NOT NULL,
    vertices bigint NOT NULL,
    area double precision NOT NULL,
    atlas jsonb NOT NULL,
    repairs jsonb NOT NULL,
    default_resolution integer NOT NULL,
    inventory_number text NOT NULL,
    owner text NOT NULL,
    creator text NOT NULL,
    captured text NOT NULL,
    method text NOT NULL,
    accuracy text NOT NULL,
    processing text NOT NULL,
    rights_uri text NOT NULL,
    credit text NOT NULL,
    geometry bytea NOT NULL,
    sequence bigint DEFAULT 0 NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    source_download text DEFAULT 'annotator'::text NOT NULL,
    binned timestamp with time zone,
    binned_by text,
    binned_bytes bigint,
    erasing boolean DEFAULT false NOT NULL,
    proposal jsonb,
    open_edges jsonb,
    owner_node uuid,
    owner_epoch bigint DEFAULT 0 NOT NULL,
    object_id bigint,
    survey_date text DEFAULT ''::text NOT NULL,
    from_points jsonb,
    parts jsonb,
    CONSTRAINT all_models_check CHECK ((((binned IS NULL) = (binned_by IS NULL)) AND ((binned IS NULL) = (binned_bytes IS NULL)) AND ((binned IS NOT NULL) OR (NOT erasing)))),
    CONSTRAINT all_models_owner_epoch_check CHECK ((owner_epoch >= 0)),
    CONSTRAINT all_models_survey_date_check CHECK ((survey_date ~ '^([0-9]{4}(-[0-9]{2}){0,2})?$'::text)),
    CONSTRAINT models_bounds_max_check CHECK ((cardinality(bounds_max) = 3)),
    CONSTRAINT models_bounds_min_check CHECK ((cardinality(bounds_min) = 3)),
    CONSTRAINT models_name_check CHECK ((name <> ''::text)),
    CONSTRAINT models_origin_check CHECK ((cardinality(origin) = 3)),
    CONSTRAINT models_source_download_check CHECK ((source_download = ANY (ARRAY['viewer'::text, 'annotator'::text, 'curator'::text]))),
    CONSTRAINT models_survey_check CHECK (((object_id IS NULL) = (survey_date = ''::text))),
    CONSTRAINT models_unit_check CHECK ((unit = ANY (ARRAY['mm'::text, 'cm'::text, 'm'::text]))),
    CONSTRAINT models_up_check CHECK ((up = ANY (ARRAY['x'::text, 'y'::text, 'z'::text, '-x'::text, '-y'::text, '-z'::text])))
);

CREATE VIEW public.layers AS
 SELECT all_layers.id,
    all_layers.model_id,
    all_layers.name,
    all_layers.slug,
    all_layers.kind,
    all_layers.type,
    all_layers.resolution,
    all_layers.unit,
    all_layers.description,
    all_layers.palette,
    all_layers.opacity,
    all_layers.visible,
    all_layers.draw_order,
    all_layers.sequence,
    all_layers.version,
    all_layers.table_id,
    all_layers.expression,
    all_layers.automatic,
    all_layers.computed_sequence,
    all_layers.summed,
    all_layers.locked,
    all_layers.visibility,
    all_layers.review,
    all_layers.labels,
    all_layers.descriptions,
    all_layers.group_name,
    all_layers.blend
   FROM public.all_layers
  WHERE ((all_layers.binned IS NULL) AND (EXISTS ( SELECT 1
           FROM public.all_models m
          WHERE ((m.id = all_layers.model_id) AND (m.binned IS NULL)))));

CREATE VIEW public.models AS
 SELECT all_models.id,
    all_models.project_id,
    all_models.name,
    all_models.slug,
    all_models.unit,
    all_models.unit_assumed,
    all_models.scale_verified,
    all_models.up,
    all_models.north,
    all_models.crs,
    all_models.origin,
    all_models.bounds_min,
    all_models.bounds_max,
    all_models.triangles,
    all_models.vertices,
    all_models.area,
    all_models.atlas,
    all_models.repairs,
    all_models.default_resolution,
    all_models.inventory_number,
    all_models.owner,
    all_models.creator,
    all_models.captured,
    all_models.method,
    all_models.accuracy,
    all_models.processing,
    all_models.rights_uri,
    all_models.credit,
    all_models.geometry,
    all_models.sequence,
    all_models.version,
    all_models.source_download,
    all_models.proposal,
    all_models.open_edges,
    all_models.owner_node,
    all_models.owner_epoch,
    all_models.object_id,
    all_models.survey_date,
    all_models.from_points,
    all_models.parts
   FROM public.all_models
  WHERE (all_models.binned IS NULL);

CREATE TABLE public.tile_sums (
    layer_id bigint NOT NULL,
    tile_y smallint NOT NULL,
    tile_x smallint NOT NULL,
    keys bigint[] NOT NULL,
    texels bigint[] NOT NULL,
    areas double precision[] NOT NULL,
    moments_x double precision[] NOT NULL,
    moments_y double precision[] NOT NULL,
    moments_z double precision[] NOT NULL,
    low_x double precision[] NOT NULL,
    low_y double precision[] NOT NULL,
    low_z double precision[] NOT NULL,
    high_x double precision[] NOT NULL,
    high_y double precision[] NOT NULL,
    high_z double precision[] NOT NULL
);

CREATE VIEW analysis.areas WITH (security_barrier='true') AS
 SELECT a.layer_id,
    a.model_id,
    a.model,
    a.layer,
    a.table_id,
    a.key,
    a.texels,
    a.area_m2,
    a.centroid_x,
    a.centroid_y,
    a.centroid_z,
    a.min_x,
    a.min_y,
    a.min_z,
    a.max_x,
    a.max_y,
    a.max_z,
    (((((('POINT Z ('::text || a.centroid_x) || ' '::text) || a.centroid_y) || ' '::text) || a.centroid_z) || ')'::text) AS geometry_wkt,
    a.srid
   FROM ( SELECT s.layer_id,
            l.model_id,
            m.name AS model,
            l.name AS layer,
            l.table_id,
            s.key,
            s.texels,
            (s.area * pow(u.metres, (2)::double precision)) AS area_m2,
            ((s.moment_x / NULLIF(s.area, (0)::double precision)) + m.origin[1]) AS centroid_x,
            ((s.moment_y / NULLIF(s.area, (0)::double precision)) + m.origin[2]) AS centroid_y,
            ((s.moment_z / NULLIF(s.area, (0)::double precision)) + m.origin[3]) AS centroid_z,
            (s.low_x + m.origin[1]) AS min_x,
            (s.low_y + m.origin[2]) AS min_y,
            (s.low_z + m.origin[3]) AS min_z,
            (s.high_x + m.origin[1]) AS max_x,
            (s.high_y + m.origin[2]) AS max_y,
            (s.high_z + m.origin[3]) AS max_z,
            analysis.srid(m.crs) AS srid
           FROM (((( SELECT t.layer_id,
                    e.key,
                    (sum(e.texels))::bigint AS texels,
                    sum(e.area) AS area,
                    sum(e.moment_x) AS moment_x,
                    sum(e.moment_y) AS moment_y,
                    sum(e.moment_z) AS moment_z,
                    min(e.low_x) AS low_x,
                    min(e.low_y) AS low_y,
                    min(e.low_z) AS low_z,
                    max(e.high_x) AS high_x,
                    max(e.high_y) AS high_y,
                    max(e.high_z) AS high_z
                   FROM public.tile_sums t,
                    LATERAL UNNEST(t.keys, t.texels, t.areas, t.moments_x, t.moments_y, t.moments_z, t.low_x, t.low_y, t.low_z, t.high_x, t.high_y, t.high_z) e(key, texels, area, moment_x, moment_y, moment_z, low_x, low_y, low_z, high_x, high_y, high_z)
                  GROUP BY t.layer_id, e.key) s
             JOIN public.layers l ON (((l.id = s.layer_id) AND l.summed AND (l.visibility = 'public'::text))))
             JOIN public.models m ON ((m.id = l.model_id)))
             CROSS JOIN LATERAL ( SELECT (
                        CASE m.unit
                            WHEN 'mm'::text THEN 0.001
                            WHEN 'cm'::text THEN 0.01
                            ELSE (1)::numeric
                        END)::double precision AS metres) u)) a;

CREATE TABLE public.edits (
    model_id bigint NOT NULL,
    sequence bigint NOT NULL,
    id uuid NOT NULL,
    layer_id bigint NOT NULL,
    stroke uuid NOT NULL,
    user_name text NOT NULL,
    op text NOT NULL,
    record jsonb NOT NULL,
    answer jsonb NOT NULL,
    "time" timestamp with time zone NOT NULL,
    in_force boolean DEFAULT true NOT NULL,
    undone_by bigint,
    review text,
    reviewed_by bigint,
    writer boolean GENERATED ALWAYS AS ((op <> ALL (ARRAY['undo'::text, 'redo'::text, 'accept'::text, 'reject'::text, 'reopen'::text]))) STORED NOT NULL,
    first_sequence bigint,
    first_time timestamp with time zone,
    tiles smallint[],
    CONSTRAINT edits_check CHECK ((in_force = (undone_by IS NULL))),
    CONSTRAINT edits_check1 CHECK (((reviewed_by IS NOT NULL) = COALESCE((review = ANY (ARRAY['accepted'::text, 'rejected'::text])), false))),
    CONSTRAINT edits_review_check CHECK ((review = ANY (ARRAY['pending'::text, 'accepted'::text, 'rejected'::text]))),
    CONSTRAINT edits_sequence_check CHECK ((sequence > 0))
)
WITH (autovacuum_vacuum_scale_factor='0.01', autovacuum_vacuum_threshold='20000', toast.autovacuum_vacuum_scale_factor='0.01', toast.autovacuum_vacuum_threshold='20000');

CREATE VIEW analysis.edits WITH (security_barrier='true') AS
 SELECT e.model_id,
    m.name AS model,
    e.layer_id,
    l.name AS layer,
    e.sequence,
    e."time",
    e.user_name AS "user",
    e.op,
    e.in_force,
    ((e.answer ->> 'texels_changed'::text))::bigint AS texels_changed,
    ((e.answer ->> 'area_m2'::text))::double precision AS area_m2,
    e.review
   FROM ((public.edits e
     JOIN public.models m ON ((m.id = e.model_id)))
     JOIN public.layers l ON (((l.id = e.layer_id) AND (l.visibility = 'public'::text))));

CREATE VIEW analysis.layers WITH (security_barrier='true') AS
 SELECT l.id AS layer_id,
    l.model_id,
    m.name AS model,
    l.name AS layer,
    (l.slug)::text AS slug,
    l.kind,
    l.type,
    l.resolution,
    l.unit,
    l.description,
    l.table_id,
    l.sequence,
    l.summed AS areas_current,
    l.labels,
    l.descriptions
   FROM (public.layers l
     JOIN public.models m ON ((m.id = l.model_id)))
  WHERE (l.visibility = 'public'::text);

CREATE TABLE public.objects (
    id bigint NOT NULL,
    project_id bigint NOT NULL,
    name text NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT objects_name_check CHECK (((char_length(name) >= 1) AND (char_length(name) <= 255)))
);

CREATE TABLE public.projects (
    id bigint NOT NULL,
    name text NOT NULL,
    slug public.slug NOT NULL,
    description text NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    require_if_match boolean DEFAULT false NOT NULL,
    CONSTRAINT projects_name_check CHECK ((name <> ''::text))
);

CREATE VIEW analysis.models WITH (security_barrier='true') AS
 SELECT m.id AS model_id,
    m.project_id,
    p.name AS project,
    m.name AS model,
    (m.slug)::text AS slug,
    m.unit,
    m.up,
    NULLIF(m.crs, ''::text) AS crs,
    (m.area * (pow(
        CASE m.unit
            WHEN 'mm'::text THEN 0.001
            WHEN 'cm'::text THEN 0.01
            ELSE (1)::numeric
        END, (2)::numeric))::double precision) AS area_m2,
    m.triangles,
    m.bounds_min[1] AS min_x,
    m.bounds_min[2] AS min_y,
    m.bounds_min[3] AS min_z,
    m.bounds_max[1] AS max_x,
    m.bounds_max[2] AS max_y,
    m.bounds_max[3] AS max_z,
    m.inventory_number,
    m.owner,
    m.creator,
    m.credit,
    m.sequence,
    analysis.srid(m.crs) AS srid,
    o.name AS object,
    NULLIF(m.survey_date, ''::text) AS survey_date
   FROM ((public.models m
     JOIN public.projects p ON ((p.id = m.project_id)))
     LEFT JOIN public.objects o ON ((o.id = m.object_id)));

CREATE VIEW analysis.projects WITH (security_barrier='true') AS
 SELECT projects.id AS project_id,
    projects.name AS project,
    (projects.slug)::text AS slug,
    projects.description
   FROM public.projects;

CREATE TABLE public.record_columns (
    id bigint NOT NULL,
    table_id bigint NOT NULL,
    kind text NOT NULL,
    target bigint,
    properties jsonb NOT NULL,
    hidden boolean DEFAULT false NOT NULL,
    visibility text DEFAULT 'public'::text NOT NULL,
    CONSTRAINT record_columns_kind_check CHECK ((kind = ANY (ARRAY['text'::text, 'integer'::text, 'numeric'::text, 'boolean'::text, 'date'::text, 'timestamp'::text, 'period'::text, 'enumeration'::text, 'url'::text, 'term'::text, 'relation'::text, 'picture'::text, 'document'::text, 'line'::text, 'point'::text]))),
    CONSTRAINT record_columns_visibility_check CHECK ((visibility = ANY (ARRAY['public'::text, 'team'::text, 'private'::text])))
);

CREATE TABLE public.record_tables (
    id bigint NOT NULL,
    project_id bigint NOT NULL,
    name text NOT NULL,
    slug public.slug NOT NULL,
    labels jsonb DEFAULT '{}'::jsonb NOT NULL,
    description text DEFAULT ''::text NOT NULL,
    next_key bigint DEFAULT 1 NOT NULL,
    records bigint DEFAULT 0 NOT NULL,
    sequence bigint DEFAULT 0 NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    title_column bigint,
    CONSTRAINT record_tables_name_check CHECK ((name <> ''::text))
);

CREATE TABLE public.table_changes (
    table_id bigint NOT NULL,
    subject text NOT NULL,
    subject_id bigint NOT NULL,
    sequence bigint NOT NULL,
    before jsonb NOT NULL,
    after jsonb NOT NULL,
    CONSTRAINT table_changes_subject_check CHECK ((subject = ANY (ARRAY['record'::text, 'column'::text])))
);

CREATE TABLE public.table_edits (
    table_id bigint NOT NULL,
    sequence bigint NOT NULL,
    user_name text NOT NULL,
    op text NOT NULL,
    record jsonb NOT NULL,
    "time" timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    in_force boolean DEFAULT true NOT NULL,
    undone_by bigint,
    writer boolean GENERATED ALWAYS AS ((op <> ALL (ARRAY['undo'::text, 'redo'::text]))) STORED NOT NULL,
    CONSTRAINT table_edits_check CHECK ((in_force = (undone_by IS NULL))),
    CONSTRAINT table_edits_sequence_check CHECK ((sequence > 0))
);

CREATE VIEW analysis.record_edits WITH (security_barrier='true') AS
 SELECT e.table_id,
    t.name AS "table",
    e.sequence,
    e."time",
    e.user_name AS "user",
    e.op,
    e.in_force,
    c.subject,
    c.subject_id AS key,
    (c.before - h.names) AS before,
    (c.after - h.names) AS after
   FROM (((public.table_edits e
     JOIN public.record_tables t ON ((t.id = e.table_id)))
     LEFT JOIN public.table_changes c ON (((c.table_id = e.table_id) AND (c.sequence = e.sequence) AND (c.subject = 'record'::text))))
     CROSS JOIN LATERAL ( SELECT ARRAY( SELECT (i.id)::text AS id
                   FROM public.record_columns i
                  WHERE ((i.table_id = e.table_id) AND (i.visibility <> 'public'::text))) AS names) h);

CREATE TABLE public.record_views (
    table_id bigint NOT NULL,
    name text NOT NULL
);

CREATE VIEW analysis.tables WITH (security_barrier='true') AS
 SELECT t.id AS table_id,
    t.project_id,
    p.name AS project,
    t.name AS "table",
    (t.slug)::text AS slug,
    v.name AS view,
    t.records,
    t.sequence
   FROM ((public.record_tables t
     JOIN public.projects p ON ((p.id = t.project_id)))
     LEFT JOIN public.record_views v ON ((v.table_id = t.id)));

ALTER TABLE public.activities ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.activities_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.answers (
    key text NOT NULL,
    answer jsonb NOT NULL,
    "time" timestamp with time zone DEFAULT now() NOT NULL
);

CREATE TABLE public.attachments (
    id bigint NOT NULL,
    table_id bigint NOT NULL,
    sha256 bytea NOT NULL,
    name text NOT NULL,
    media_type text NOT NULL,
    width integer,
    height integer,
    user_name text NOT NULL,
    "time" timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    visibility text DEFAULT 'public'::text NOT NULL,
    CONSTRAINT attachments_check CHECK (((width IS NULL) = (height IS NULL))),
    CONSTRAINT attachments_name_check CHECK ((name <> ''::text)),
    CONSTRAINT attachments_visibility_check CHECK ((visibility = ANY (ARRAY['public'::text, 'team'::text, 'private'::text])))
);

ALTER TABLE public.attachments ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.attachments_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.audit_log (
    id bigint NOT NULL,
    "time" timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    actor_kind text NOT NULL,
    actor text NOT NULL,
    person_id bigint,
    address text NOT NULL,
    action text NOT NULL,
    subject_kind text NOT NULL,
    subject_id bigint,
    subject text NOT NULL,
    project_id bigint,
    count bigint DEFAULT 1 NOT NULL,
    details jsonb DEFAULT '{}'::jsonb NOT NULL,
    CONSTRAINT audit_log_action_check CHECK ((action = ANY (ARRAY['sign_in'::text, 'sign_in_failed'::text, 'sign_out'::text, 'password_changed'::text, 'account_created'::text, 'account_deleted'::text, 'account_renamed'::text, 'account_disabled'::text, 'account_enabled'::text, 'role_changed'::text, 'member_added'::text, 'member_removed'::text, 'group_created'::text, 'group_renamed'::text, 'token_created'::text, 'token_revoked'::text, 'link_created'::text, 'export'::text, 'deletion'::text, 'erased'::text, 'restored'::text, 'visibility_changed'::text, 'kiosk_created'::text, 'kiosk_changed'::text, 'kiosk_deleted'::text, 'setting_changed'::text, 'oidc_bound'::text, 'audit_purged'::text]))),
    CONSTRAINT audit_log_actor_check CHECK ((octet_length(actor) <= 255)),
    CONSTRAINT audit_log_actor_kind_check CHECK ((actor_kind = ANY (ARRAY['person'::text, 'token'::text, 'kiosk'::text, 'link'::text, 'server'::text]))),
    CONSTRAINT audit_log_address_check CHECK ((octet_length(address) <= 100)),
    CONSTRAINT audit_log_count_check CHECK ((count >= 1)),
    CONSTRAINT audit_log_details_check CHECK (((jsonb_typeof(details) = 'object'::text) AND (octet_length((details)::text) <= 4096))),
    CONSTRAINT audit_log_subject_check CHECK ((octet_length(subject) <= 255)),
    CONSTRAINT audit_log_subject_kind_check CHECK ((octet_length(subject_kind) <= 30))
);

ALTER TABLE public.audit_log ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.audit_log_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.bills (
    id bigint NOT NULL,
    project_id bigint NOT NULL,
    name text NOT NULL,
    content jsonb NOT NULL,
    positions integer NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT bills_content_check CHECK ((jsonb_typeof(content) = 'object'::text)),
    CONSTRAINT bills_name_check CHECK (((char_length(name) >= 1) AND (char_length(name) <= 200))),
    CONSTRAINT bills_positions_check CHECK ((positions >= 0))
);

ALTER TABLE public.bills ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.bills_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.blob_chunks (
    sha256 bytea NOT NULL,
    chunk integer NOT NULL,
    data bytea NOT NULL
);
ALTER TABLE ONLY public.blob_chunks ALTER COLUMN data SET STORAGE EXTERNAL;

CREATE TABLE public.blobs (
    sha256 bytea NOT NULL,
    bytes bigint NOT NULL,
    is_outside boolean DEFAULT false NOT NULL,
    chunk_sums bytea,
    unused timestamp with time zone,
    removing timestamp with time zone,
    CONSTRAINT blobs_chunk_sums_check CHECK (((chunk_sums IS NOT NULL) = is_outside)),
    CONSTRAINT blobs_sha256_check CHECK ((octet_length(sha256) = 32))
);

CREATE TABLE public.comments (
    id bigint NOT NULL,
    model_id bigint NOT NULL,
    thread_id bigint,
    "position" double precision[],
    normal double precision[],
    layer_id bigint,
    table_id bigint,
    record_key bigint,
    text text NOT NULL,
    user_name text NOT NULL,
    "time" timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    edited timestamp with time zone,
    deleted timestamp with time zone,
    resolved timestamp with time zone,
    resolved_by text,
    changed timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    visibility text DEFAULT 'public'::text NOT NULL,
    CONSTRAINT comments_check CHECK (((thread_id IS NULL) = (("position" IS NOT NULL) AND (normal IS NOT NULL)))),
    CONSTRAINT comments_check1 CHECK (((resolved IS NULL) = (resolved_by IS NULL))),
    CONSTRAINT comments_check2 CHECK (((thread_id IS NULL) OR ((resolved IS NULL) AND (deleted IS NULL)))),
    CONSTRAINT comments_normal_check CHECK ((cardinality(normal) = 3)),
    CONSTRAINT comments_position_check CHECK ((cardinality("position") = 3)),
    CONSTRAINT comments_record_key_check CHECK (((record_key >= 0) AND (record_key <= '4294967295'::bigint))),
    CONSTRAINT comments_text_check CHECK ((char_length(text) <= 10000)),
    CONSTRAINT comments_visibility_check CHECK ((visibility = ANY (ARRAY['public'::text, 'team'::text, 'private'::text])))
);

ALTER TABLE public.comments ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.comments_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.detail_levels (
    model_id bigint NOT NULL,
    level integer NOT NULL,
    geometry bytea NOT NULL,
    CONSTRAINT detail_levels_level_check CHECK ((level > 0))
);

CREATE TABLE public.edit_batches (
    model_id bigint NOT NULL,
    id uuid NOT NULL,
    layer_id bigint NOT NULL,
    edit bigint NOT NULL,
    sequence bigint NOT NULL,
    area_m2 double precision NOT NULL,
    texels_changed integer NOT NULL,
    user_name text,
    provisional boolean
);

CREATE TABLE public.file_store (
    one boolean DEFAULT true NOT NULL,
    id uuid NOT NULL,
    place text NOT NULL,
    owner text NOT NULL,
    CONSTRAINT file_store_one_check CHECK (one),
    CONSTRAINT file_store_owner_check CHECK ((char_length(owner) <= 100)),
    CONSTRAINT file_store_place_check CHECK (((char_length(place) >= 1) AND (char_length(place) <= 4096)))
);

CREATE TABLE public.group_people (
    group_id bigint NOT NULL,
    user_id bigint NOT NULL,
    sign_on_id bigint
);

CREATE TABLE public.groups (
    id bigint NOT NULL,
    name text NOT NULL,
    created timestamp with time zone DEFAULT now() NOT NULL,
    CONSTRAINT groups_name_check CHECK (((name = btrim(name)) AND ((char_length(name) >= 1) AND (char_length(name) <= 100))))
);

ALTER TABLE public.groups ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.groups_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.jobs (
    id bigint NOT NULL,
    project_id bigint NOT NULL,
    user_name text NOT NULL,
    kind text NOT NULL,
    state text DEFAULT 'begun'::text NOT NULL,
    problem jsonb,
    result jsonb,
    begun timestamp with time zone DEFAULT now() NOT NULL,
    ended timestamp with time zone,
    node uuid,
    CONSTRAINT jobs_check CHECK (((ended IS NULL) = (state = 'begun'::text))),
    CONSTRAINT jobs_kind_check CHECK ((kind = ANY (ARRAY['import'::text, 'layers'::text, 'look'::text, 'figure'::text, 'regions'::text, 'changes'::text, 'analysis'::text]))),
    CONSTRAINT jobs_state_check CHECK ((state = ANY (ARRAY['begun'::text, 'done'::text, 'failed'::text, 'cancelled'::text, 'lost'::text])))
);

CREATE TABLE public.kiosks (
    id bigint NOT NULL,
    tour_id bigint NOT NULL,
    hash bytea NOT NULL,
    name text NOT NULL,
    user_name text NOT NULL,
    created timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    expires timestamp with time zone,
    last_seen timestamp with time zone,
    revoked timestamp with time zone,
    wants_reload boolean DEFAULT false NOT NULL,
    phone text,
    CONSTRAINT kiosks_hash_check CHECK ((octet_length(hash) = 32)),
    CONSTRAINT kiosks_name_check CHECK (((char_length(name) >= 1) AND (char_length(name) <= 200))),
    CONSTRAINT kiosks_phone_check CHECK ((char_length(phone) = 43))
);

ALTER TABLE public.kiosks ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.kiosks_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.layer_inputs (
    layer_id bigint NOT NULL,
    slug text NOT NULL,
    input_id bigint,
    table_id bigint,
    table_sequence bigint DEFAULT 0 NOT NULL
);

CREATE TABLE public.layer_origins (
    layer_id bigint NOT NULL,
    origin text NOT NULL,
    edited_by_hand boolean DEFAULT false NOT NULL,
    analysis jsonb,
    CONSTRAINT layer_origins_analysis_check CHECK ((jsonb_typeof(analysis) = 'object'::text)),
    CONSTRAINT layer_origins_origin_check CHECK ((origin = ANY (ARRAY['expression'::text, 'shape'::text])))
);

ALTER TABLE public.all_layers ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.layers_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.looks (
    id bigint NOT NULL,
    model_id bigint NOT NULL,
    name text NOT NULL,
    slug public.slug NOT NULL,
    description text NOT NULL,
    media_type text NOT NULL,
    width integer NOT NULL,
    height integer NOT NULL,
    opacity double precision NOT NULL,
    visible boolean NOT NULL,
    draw_order integer NOT NULL,
    picture bytea NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT looks_height_check CHECK ((height > 0)),
    CONSTRAINT looks_media_type_check CHECK ((media_type = ANY (ARRAY['image/jpeg'::text, 'image/png'::text]))),
    CONSTRAINT looks_name_check CHECK ((name <> ''::text)),
    CONSTRAINT looks_opacity_check CHECK (((opacity >= (0)::double precision) AND (opacity <= (1)::double precision))),
    CONSTRAINT looks_width_check CHECK ((width > 0))
);

ALTER TABLE public.looks ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.looks_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.merged_journals (
    model_id bigint NOT NULL,
    sequence bigint NOT NULL
);

CREATE TABLE public.model_sources (
    model_id bigint NOT NULL,
    name text NOT NULL,
    "position" integer NOT NULL,
    sha256 bytea NOT NULL
);

ALTER TABLE public.all_models ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.models_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.node_messages (
    id bigint NOT NULL,
    xid bigint DEFAULT ((pg_current_xact_id())::text)::bigint NOT NULL,
    "time" timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    from_node uuid,
    kind text NOT NULL,
    event text NOT NULL,
    project_id bigint,
    model_id bigint,
    subject_ids bigint[] DEFAULT '{}'::bigint[] NOT NULL,
    sequence bigint,
    user_name text NOT NULL,
    CONSTRAINT node_messages_event_check CHECK ((event = ANY (ARRAY['created'::text, 'changed'::text, 'deleted'::text]))),
    CONSTRAINT node_messages_kind_check CHECK ((kind = ANY (ARRAY['records'::text, 'table'::text, 'comment'::text, 'view'::text, 'snapshot'::text, 'selection'::text, 'tool'::text, 'access'::text, 'kiosk'::text]))),
    CONSTRAINT node_messages_subject_ids_check CHECK ((cardinality(subject_ids) <= 500))
);

ALTER TABLE public.node_messages ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.node_messages_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.nodes (
    id uuid NOT NULL,
    url text NOT NULL,
    started timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    lease_until timestamp with time zone NOT NULL,
    draining boolean DEFAULT false NOT NULL,
    version text NOT NULL,
    gpu text NOT NULL,
    open_models integer DEFAULT 0 NOT NULL,
    participants integer DEFAULT 0 NOT NULL,
    processor_share real DEFAULT 0 NOT NULL,
    CONSTRAINT nodes_gpu_check CHECK ((char_length(gpu) <= 255)),
    CONSTRAINT nodes_open_models_check CHECK ((open_models >= 0)),
    CONSTRAINT nodes_participants_check CHECK ((participants >= 0)),
    CONSTRAINT nodes_processor_share_check CHECK (((processor_share >= (0)::double precision) AND (processor_share < 'Infinity'::real))),
    CONSTRAINT nodes_url_check CHECK (((char_length(url) >= 1) AND (char_length(url) <= 255))),
    CONSTRAINT nodes_version_check CHECK ((char_length(version) <= 255))
);

ALTER TABLE public.objects ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.objects_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.pending_sign_ins (
    state bytea NOT NULL,
    browser bytea NOT NULL,
    provider text NOT NULL,
    nonce text NOT NULL,
    code_verifier text NOT NULL,
    return_to text NOT NULL,
    expires timestamp with time zone NOT NULL,
    CONSTRAINT pending_sign_ins_browser_check CHECK ((octet_length(browser) = 32)),
    CONSTRAINT pending_sign_ins_code_verifier_check CHECK ((octet_length(code_verifier) <= 128)),
    CONSTRAINT pending_sign_ins_nonce_check CHECK ((octet_length(nonce) <= 128)),
    CONSTRAINT pending_sign_ins_provider_check CHECK ((octet_length(provider) <= 64)),
    CONSTRAINT pending_sign_ins_return_to_check CHECK ((octet_length(return_to) <= 1024)),
    CONSTRAINT pending_sign_ins_state_check CHECK ((octet_length(state) = 32))
);

CREATE TABLE public.personal_views (
    user_id bigint NOT NULL,
    model_id bigint NOT NULL,
    content jsonb NOT NULL,
    CONSTRAINT personal_views_content_check CHECK ((octet_length((content)::text) <= 1048576))
);

CREATE TABLE public.photographs (
    id bigint NOT NULL,
    model_id bigint NOT NULL,
    name text NOT NULL COLLATE pg_catalog."C",
    lens text NOT NULL,
    unit text NOT NULL,
    calibrated_width integer NOT NULL,
    calibrated_height integer NOT NULL,
    calibration double precision[] NOT NULL,
    pose double precision[] NOT NULL,
    sha256 bytea,
    media_type text,
    width integer,
    height integer,
    version bigint DEFAULT 1 NOT NULL,
    rights_uri text DEFAULT ''::text NOT NULL,
    rights_holder text DEFAULT ''::text NOT NULL,
    CONSTRAINT photographs_calibrated_height_check CHECK ((calibrated_height >= 0)),
    CONSTRAINT photographs_calibrated_width_check CHECK ((calibrated_width >= 0)),
    CONSTRAINT photographs_calibration_check CHECK ((cardinality(calibration) = 15)),
    CONSTRAINT photographs_check CHECK ((num_nulls(sha256, media_type, width, height) = ANY (ARRAY[0, 4]))),
    CONSTRAINT photographs_lens_check CHECK ((lens = ANY (ARRAY['pinhole'::text, 'brown'::text, 'rational'::text, 'fisheye'::text, 'division'::text]))),
    CONSTRAINT photographs_name_check CHECK (((octet_length(name) >= 1) AND (octet_length(name) <= 1024))),
    CONSTRAINT photographs_pose_check CHECK ((cardinality(pose) = 12)),
    CONSTRAINT photographs_rights_holder_check CHECK ((octet_length(rights_holder) <= 2000)),
    CONSTRAINT photographs_rights_uri_check CHECK ((octet_length(rights_uri) <= 8000)),
    CONSTRAINT photographs_unit_check CHECK ((unit = ANY (ARRAY['pixel'::text, 'longest_side'::text])))
);

ALTER TABLE public.photographs ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.photographs_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.presence_channel (
    one boolean DEFAULT true NOT NULL,
    name text NOT NULL,
    CONSTRAINT presence_channel_name_check CHECK ((name ~ '^strata_presence_[0-9a-f]{32}$'::text)),
    CONSTRAINT presence_channel_one_check CHECK (one)
);

CREATE TABLE public.project_groups (
    project_id bigint NOT NULL,
    group_id bigint NOT NULL,
    role text NOT NULL,
    CONSTRAINT project_groups_role_check CHECK ((role = ANY (ARRAY['viewer'::text, 'annotator'::text, 'curator'::text])))
);

CREATE TABLE public.project_members (
    project_id bigint NOT NULL,
    user_id bigint NOT NULL,
    role text NOT NULL,
    CONSTRAINT project_members_role_check CHECK ((role = ANY (ARRAY['viewer'::text, 'annotator'::text, 'curator'::text])))
);

CREATE TABLE public.project_metadata (
    project_id bigint NOT NULL,
    record jsonb NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT project_metadata_record_check CHECK (((jsonb_typeof(record) = 'object'::text) AND (octet_length((record)::text) <= 1048576)))
);

CREATE VIEW public.project_roles AS
 SELECT project_members.project_id,
    project_members.user_id,
    project_members.role,
    NULL::bigint AS group_id
   FROM public.project_members
UNION ALL
 SELECT g.project_id,
    p.user_id,
    g.role,
    g.group_id
   FROM (public.project_groups g
     JOIN public.group_people p ON ((p.group_id = g.group_id)));

ALTER TABLE public.projects ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.projects_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

ALTER TABLE public.record_columns ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.record_columns_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

ALTER TABLE public.record_tables ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.record_tables_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.schema_checksums (
    version character varying(128) NOT NULL,
    sha256 text NOT NULL
);

CREATE TABLE public.schema_migrations (
    version character varying(128) NOT NULL,
    readable_from bigint,
    applied_by text,
    unreadable_since timestamp with time zone,
    CONSTRAINT schema_migrations_applied_by_check CHECK ((char_length(applied_by) <= 255)),
    CONSTRAINT schema_migrations_readable_from_check CHECK ((readable_from > 0))
);

CREATE TABLE public.selections (
    id bigint NOT NULL,
    model_id bigint NOT NULL,
    slug text NOT NULL,
    name text NOT NULL,
    text text DEFAULT ''::text NOT NULL,
    content jsonb NOT NULL,
    user_name text NOT NULL,
    "time" timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT selections_content_check CHECK (((content ->> 'audience'::text) = ANY (ARRAY['personal'::text, 'everyone'::text]))),
    CONSTRAINT selections_name_check CHECK (((char_length(name) >= 1) AND (char_length(name) <= 200))),
    CONSTRAINT selections_text_check CHECK ((char_length(text) <= 10000))
);

ALTER TABLE public.selections ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.selections_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.sign_ons (
    id bigint NOT NULL,
    issuer text NOT NULL,
    subject text NOT NULL,
    user_id bigint NOT NULL,
    first_used timestamp with time zone,
    last_used timestamp with time zone,
    CONSTRAINT sign_ons_issuer_check CHECK (((octet_length(issuer) >= 1) AND (octet_length(issuer) <= 255))),
    CONSTRAINT sign_ons_subject_check CHECK (((octet_length(subject) >= 1) AND (octet_length(subject) <= 255)))
);

ALTER TABLE public.sign_ons ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.sign_ons_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.snapshots (
    id bigint NOT NULL,
    model_id bigint NOT NULL,
    slug text NOT NULL,
    name text NOT NULL,
    text text DEFAULT ''::text NOT NULL,
    content jsonb NOT NULL,
    user_name text NOT NULL,
    "time" timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT snapshots_name_check CHECK (((char_length(name) >= 1) AND (char_length(name) <= 200))),
    CONSTRAINT snapshots_text_check CHECK ((char_length(text) <= 10000))
);

ALTER TABLE public.snapshots ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.snapshots_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.thinned_layers (
    layer_id bigint NOT NULL,
    count bigint NOT NULL
);

CREATE TABLE public.thumbnails (
    sha256 bytea NOT NULL,
    side integer NOT NULL,
    picture bytea NOT NULL
);
ALTER TABLE ONLY public.thumbnails ALTER COLUMN picture SET STORAGE EXTERNAL;

CREATE TABLE public.tile_revisions (
    layer_id bigint NOT NULL,
    tile_y smallint NOT NULL,
    tile_x smallint NOT NULL,
    sequence bigint NOT NULL,
    difference bytea NOT NULL,
    key_tile bytea
)
WITH (autovacuum_vacuum_scale_factor='0.05', autovacuum_vacuum_threshold='20000', toast.autovacuum_vacuum_scale_factor='0.05', toast.autovacuum_vacuum_threshold='20000');
ALTER TABLE ONLY public.tile_revisions ALTER COLUMN difference SET STORAGE EXTERNAL;
ALTER TABLE ONLY public.tile_revisions ALTER COLUMN key_tile SET STORAGE EXTERNAL;

CREATE TABLE public.tile_segments (
    layer_id bigint NOT NULL,
    tile_y smallint NOT NULL,
    tile_x smallint NOT NULL,
    first_sequence bigint NOT NULL,
    last_sequence bigint NOT NULL,
    content bytea NOT NULL,
    CONSTRAINT tile_segments_check CHECK ((first_sequence <= last_sequence))
);
ALTER TABLE ONLY public.tile_segments ALTER COLUMN content SET STORAGE EXTERNAL;

CREATE TABLE public.tokens (
    hash bytea NOT NULL,
    kind text NOT NULL,
    user_name text NOT NULL,
    role text NOT NULL,
    created timestamp with time zone DEFAULT now() NOT NULL,
    expires timestamp with time zone,
    revoked timestamp with time zone,
    id bigint NOT NULL,
    label text DEFAULT ''::text NOT NULL,
    last_used timestamp with time zone,
    project_id bigint,
    CONSTRAINT tokens_check CHECK (((project_id IS NULL) OR (kind = 'script'::text))),
    CONSTRAINT tokens_hash_check CHECK ((octet_length(hash) = 32)),
    CONSTRAINT tokens_kind_check CHECK ((kind = ANY (ARRAY['session'::text, 'script'::text, 'owner_link'::text, 'invitation'::text])))
);

ALTER TABLE public.tokens ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.tokens_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.tool_shapes (
    id bigint NOT NULL,
    name text NOT NULL,
    slug public.slug NOT NULL,
    cells bytea NOT NULL,
    created timestamp with time zone DEFAULT now() NOT NULL,
    deleted timestamp with time zone,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT tool_shapes_cells_check CHECK ((octet_length(cells) = 8192)),
    CONSTRAINT tool_shapes_name_check CHECK ((name <> ''::text)),
    CONSTRAINT tool_shapes_slug_check CHECK (((slug)::text <> ALL (ARRAY['disc'::text, 'square'::text])))
);

ALTER TABLE public.tool_shapes ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.tool_shapes_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.tour_files (
    id bigint NOT NULL,
    tour_id bigint NOT NULL,
    sha256 bytea NOT NULL,
    name text NOT NULL,
    media_type text NOT NULL,
    width integer,
    height integer,
    user_name text NOT NULL,
    "time" timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    CONSTRAINT tour_files_check CHECK (((width IS NULL) = (height IS NULL))),
    CONSTRAINT tour_files_name_check CHECK ((name <> ''::text))
);

ALTER TABLE public.tour_files ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.tour_files_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.tours (
    id bigint NOT NULL,
    model_id bigint NOT NULL,
    slug text NOT NULL,
    name text NOT NULL,
    text text DEFAULT ''::text NOT NULL,
    content jsonb NOT NULL,
    user_name text NOT NULL,
    "time" timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT tours_name_check CHECK (((char_length(name) >= 1) AND (char_length(name) <= 200))),
    CONSTRAINT tours_text_check CHECK ((char_length(text) <= 10000))
);

ALTER TABLE public.tours ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.tours_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.users (
    id bigint NOT NULL,
    name text NOT NULL,
    role text NOT NULL,
    created timestamp with time zone DEFAULT now() NOT NULL,
    full_name text DEFAULT ''::text NOT NULL,
    password text,
    last_seen timestamp with time zone,
    disabled timestamp with time zone,
    deleted timestamp with time zone,
    CONSTRAINT users_name_check CHECK ((name <> ''::text)),
    CONSTRAINT users_password_check CHECK ((password <> ''::text)),
    CONSTRAINT users_role_check CHECK ((role = ANY (ARRAY['guest'::text, 'viewer'::text, 'annotator'::text, 'curator'::text, 'administrator'::text, 'owner'::text])))
);

ALTER TABLE public.users ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.users_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

CREATE TABLE public.views (
    id bigint NOT NULL,
    model_id bigint NOT NULL,
    slug text NOT NULL,
    name text NOT NULL,
    text text DEFAULT ''::text NOT NULL,
    content jsonb NOT NULL,
    user_name text NOT NULL,
    "time" timestamp with time zone DEFAULT clock_timestamp() NOT NULL,
    version bigint DEFAULT 1 NOT NULL,
    CONSTRAINT views_name_check CHECK (((char_length(name) >= 1) AND (char_length(name) <= 200))),
    CONSTRAINT views_text_check CHECK ((char_length(text) <= 10000))
);

ALTER TABLE public.views ALTER COLUMN id ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME public.views_id_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);

ALTER TABLE ONLY public.activities
    ADD CONSTRAINT activities_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.answers
    ADD CONSTRAINT answers_pkey PRIMARY KEY (key);

ALTER TABLE ONLY public.attachments
    ADD CONSTRAINT attachments_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.audit_log
    ADD CONSTRAINT audit_log_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.bills
    ADD CONSTRAINT bills_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.blob_chunks
    ADD CONSTRAINT blob_chunks_pkey PRIMARY KEY (sha256, chunk);

ALTER TABLE ONLY public.blobs
    ADD CONSTRAINT blobs_pkey PRIMARY KEY (sha256);

ALTER TABLE ONLY public.comments
    ADD CONSTRAINT comments_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.detail_levels
    ADD CONSTRAINT detail_levels_pkey PRIMARY KEY (model_id, level);

ALTER TABLE ONLY public.edit_batches
    ADD CONSTRAINT edit_batches_pkey PRIMARY KEY (model_id, id);

ALTER TABLE ONLY public.edits
    ADD CONSTRAINT edits_model_id_id_key UNIQUE (model_id, id);

ALTER TABLE ONLY public.edits
    ADD CONSTRAINT edits_pkey PRIMARY KEY (model_id, sequence);

ALTER TABLE ONLY public.file_store
    ADD CONSTRAINT file_store_pkey PRIMARY KEY (one);

ALTER TABLE ONLY public.group_people
    ADD CONSTRAINT group_people_pkey PRIMARY KEY (group_id, user_id);

ALTER TABLE ONLY public.groups
    ADD CONSTRAINT groups_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.jobs
    ADD CONSTRAINT jobs_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.kiosks
    ADD CONSTRAINT kiosks_hash_key UNIQUE (hash);

ALTER TABLE ONLY public.kiosks
    ADD CONSTRAINT kiosks_phone_key UNIQUE (phone);

ALTER TABLE ONLY public.kiosks
    ADD CONSTRAINT kiosks_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.layer_inputs
    ADD CONSTRAINT layer_inputs_pkey PRIMARY KEY (layer_id, slug);

ALTER TABLE ONLY public.layer_origins
    ADD CONSTRAINT layer_origins_pkey PRIMARY KEY (layer_id);

ALTER TABLE ONLY public.all_layers
    ADD CONSTRAINT layers_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.looks
    ADD CONSTRAINT looks_model_id_slug_key UNIQUE (model_id, slug);

ALTER TABLE ONLY public.looks
    ADD CONSTRAINT looks_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.merged_journals
    ADD CONSTRAINT merged_journals_pkey PRIMARY KEY (model_id);

ALTER TABLE ONLY public.model_sources
    ADD CONSTRAINT model_sources_pkey PRIMARY KEY (model_id, name);

ALTER TABLE ONLY public.all_models
    ADD CONSTRAINT models_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.node_messages
    ADD CONSTRAINT node_messages_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.nodes
    ADD CONSTRAINT nodes_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.objects
    ADD CONSTRAINT objects_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.objects
    ADD CONSTRAINT objects_project_id_id_key UNIQUE (project_id, id);

ALTER TABLE ONLY public.pending_sign_ins
    ADD CONSTRAINT pending_sign_ins_pkey PRIMARY KEY (state);

ALTER TABLE ONLY public.personal_views
    ADD CONSTRAINT personal_views_pkey PRIMARY KEY (user_id, model_id);

ALTER TABLE ONLY public.photographs
    ADD CONSTRAINT photographs_model_id_name_key UNIQUE (model_id, name);

ALTER TABLE ONLY public.photographs
    ADD CONSTRAINT photographs_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.presence_channel
    ADD CONSTRAINT presence_channel_pkey PRIMARY KEY (one);

ALTER TABLE ONLY public.project_groups
    ADD CONSTRAINT project_groups_pkey PRIMARY KEY (group_id, project_id);

ALTER TABLE ONLY public.project_members
    ADD CONSTRAINT project_members_pkey PRIMARY KEY (user_id, project_id);

ALTER TABLE ONLY public.project_metadata
    ADD CONSTRAINT project_metadata_pkey PRIMARY KEY (project_id);

ALTER TABLE ONLY public.projects
    ADD CONSTRAINT projects_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.projects
    ADD CONSTRAINT projects_slug_key UNIQUE (slug);

ALTER TABLE ONLY public.record_columns
    ADD CONSTRAINT record_columns_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.record_tables
    ADD CONSTRAINT record_tables_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.record_tables
    ADD CONSTRAINT record_tables_slug_key UNIQUE (slug);

ALTER TABLE ONLY public.record_views
    ADD CONSTRAINT record_views_name_key UNIQUE (name);

ALTER TABLE ONLY public.record_views
    ADD CONSTRAINT record_views_pkey PRIMARY KEY (table_id);

ALTER TABLE ONLY public.schema_checksums
    ADD CONSTRAINT schema_checksums_pkey PRIMARY KEY (version);

ALTER TABLE ONLY public.schema_migrations
    ADD CONSTRAINT schema_migrations_pkey PRIMARY KEY (version);

ALTER TABLE ONLY public.selections
    ADD CONSTRAINT selections_model_id_slug_key UNIQUE (model_id, slug);

ALTER TABLE ONLY public.selections
    ADD CONSTRAINT selections_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.sign_ons
    ADD CONSTRAINT sign_ons_issuer_subject_key UNIQUE (issuer, subject);

ALTER TABLE ONLY public.sign_ons
    ADD CONSTRAINT sign_ons_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.snapshots
    ADD CONSTRAINT snapshots_model_id_slug_key UNIQUE (model_id, slug);

ALTER TABLE ONLY public.snapshots
    ADD CONSTRAINT snapshots_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.table_changes
    ADD CONSTRAINT table_changes_pkey PRIMARY KEY (table_id, subject, subject_id, sequence);

ALTER TABLE ONLY public.table_edits
    ADD CONSTRAINT table_edits_pkey PRIMARY KEY (table_id, sequence);

ALTER TABLE ONLY public.thinned_layers
    ADD CONSTRAINT thinned_layers_pkey PRIMARY KEY (layer_id);

ALTER TABLE ONLY public.thumbnails
    ADD CONSTRAINT thumbnails_pkey PRIMARY KEY (sha256, side);

ALTER TABLE ONLY public.tile_revisions
    ADD CONSTRAINT tile_revisions_pkey PRIMARY KEY (layer_id, tile_y, tile_x, sequence);

ALTER TABLE ONLY public.tile_segments
    ADD CONSTRAINT tile_segments_pkey PRIMARY KEY (layer_id, tile_y, tile_x, first_sequence);

ALTER TABLE ONLY public.tile_sums
    ADD CONSTRAINT tile_sums_pkey PRIMARY KEY (layer_id, tile_y, tile_x);

ALTER TABLE ONLY public.tokens
    ADD CONSTRAINT tokens_id_key UNIQUE (id);

ALTER TABLE ONLY public.tokens
    ADD CONSTRAINT tokens_pkey PRIMARY KEY (hash);

ALTER TABLE ONLY public.tool_shapes
    ADD CONSTRAINT tool_shapes_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.tour_files
    ADD CONSTRAINT tour_files_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.tours
    ADD CONSTRAINT tours_model_id_slug_key UNIQUE (model_id, slug);

ALTER TABLE ONLY public.tours
    ADD CONSTRAINT tours_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.users
    ADD CONSTRAINT users_name_key UNIQUE (name);

ALTER TABLE ONLY public.users
    ADD CONSTRAINT users_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.views
    ADD CONSTRAINT views_model_id_slug_key UNIQUE (model_id, slug);

ALTER TABLE ONLY public.views
    ADD CONSTRAINT views_pkey PRIMARY KEY (id);

CREATE INDEX activities_author ON public.activities USING btree (project_id, user_name, "time");

CREATE INDEX activities_comment ON public.activities USING btree (comment_id) WHERE (comment_id IS NOT NULL);

CREATE INDEX activities_model ON public.activities USING btree (model_id, "time", id) WHERE (model_id IS NOT NULL);

CREATE INDEX activities_project ON public.activities USING btree (project_id, "time", id);

CREATE INDEX activities_table ON public.activities USING btree (table_id, "time", id) WHERE (table_id IS NOT NULL);

CREATE INDEX all_models_owner_node ON public.all_models USING btree (owner_node) WHERE (owner_node IS NOT NULL);

CREATE INDEX answers_time ON public.answers USING btree ("time");

CREATE INDEX attachments_blob ON public.attachments USING btree (sha256);

CREATE INDEX attachments_table ON public.attachments USING btree (table_id);

CREATE INDEX audit_log_actor ON public.audit_log USING btree (lower(actor), id);

CREATE INDEX audit_log_failed ON public.audit_log USING btree (address, "time") WHERE (action = 'sign_in_failed'::text);

CREATE INDEX audit_log_project ON public.audit_log USING btree (project_id, id) WHERE (project_id IS NOT NULL);

CREATE INDEX audit_log_time ON public.audit_log USING btree ("time", id);

CREATE UNIQUE INDEX bills_name ON public.bills USING btree (project_id, lower(name));

CREATE INDEX blobs_removing ON public.blobs USING btree (removing) WHERE (removing IS NOT NULL);

CREATE INDEX blobs_unused ON public.blobs USING btree (unused) WHERE (unused IS NOT NULL);

CREATE INDEX comments_layer ON public.comments USING btree (layer_id);

CREATE INDEX comments_model ON public.comments USING btree (model_id, id);

CREATE INDEX comments_table ON public.comments USING btree (table_id);

CREATE INDEX comments_thread ON public.comments USING btree (thread_id, id);

CREATE INDEX detail_levels_geometry ON public.detail_levels USING btree (geometry);

CREATE INDEX edit_batches_edit ON public.edit_batches USING btree (layer_id, edit);

CREATE INDEX edits_author ON public.edits USING btree (layer_id, user_name, in_force, sequence) WHERE writer;

CREATE INDEX edits_layer ON public.edits USING btree (layer_id, sequence);

CREATE INDEX edits_pending ON public.edits USING btree (layer_id, sequence) WHERE ((review = 'pending'::text) AND in_force);

CREATE INDEX edits_timeline ON public.edits USING btree (model_id, "time") INCLUDE (sequence, layer_id, user_name, stroke);

CREATE INDEX edits_undone ON public.edits USING btree (layer_id, user_name, undone_by) WHERE (NOT in_force);

CREATE INDEX group_people_sign_on ON public.group_people USING btree (sign_on_id) WHERE (sign_on_id IS NOT NULL);

CREATE INDEX group_people_user ON public.group_people USING btree (user_id);

CREATE UNIQUE INDEX groups_name_in_any_case ON public.groups USING btree (lower(name));

CREATE INDEX jobs_begun ON public.jobs USING btree (state) WHERE (state = 'begun'::text);

CREATE INDEX jobs_project ON public.jobs USING btree (project_id);

CREATE INDEX kiosks_by_tour ON public.kiosks USING btree (tour_id);

CREATE INDEX layer_inputs_input ON public.layer_inputs USING btree (input_id);

CREATE INDEX layer_inputs_table ON public.layer_inputs USING btree (table_id);

CREATE INDEX layers_automatic ON public.all_layers USING btree (id) WHERE automatic;

CREATE INDEX layers_binned ON public.all_layers USING btree (binned) WHERE (binned IS NOT NULL);

CREATE INDEX layers_model ON public.all_layers USING btree (model_id);

CREATE UNIQUE INDEX layers_slug ON public.all_layers USING btree (model_id, slug) WHERE (binned IS NULL);

CREATE INDEX layers_table ON public.all_layers USING btree (table_id);

CREATE INDEX layers_unsummed ON public.all_layers USING btree (id) WHERE (NOT summed);

CREATE INDEX looks_picture ON public.looks USING btree (picture);

CREATE INDEX model_sources_blob ON public.model_sources USING btree (sha256);

CREATE INDEX models_binned ON public.all_models USING btree (binned) WHERE (binned IS NOT NULL);

CREATE INDEX models_geometry ON public.all_models USING btree (geometry);

CREATE INDEX models_object ON public.all_models USING btree (object_id) WHERE (object_id IS NOT NULL);

CREATE INDEX models_project ON public.all_models USING btree (project_id);

CREATE UNIQUE INDEX models_slug ON public.all_models USING btree (slug) WHERE (binned IS NULL);

CREATE INDEX node_messages_xid ON public.node_messages USING btree (xid);

CREATE UNIQUE INDEX objects_name ON public.objects USING btree (project_id, lower(name));

CREATE INDEX pending_sign_ins_expires ON public.pending_sign_ins USING btree (expires);

CREATE INDEX personal_views_model ON public.personal_views USING btree (model_id);

CREATE INDEX photographs_blob ON public.photographs USING btree (sha256) WHERE (sha256 IS NOT NULL);

CREATE INDEX project_groups_project ON public.project_groups USING btree (project_id);

CREATE INDEX project_members_project ON public.project_members USING btree (project_id);

CREATE UNIQUE INDEX record_columns_slug ON public.record_columns USING btree (table_id, ((properties ->> 'slug'::text))) WHERE (NOT hidden);

CREATE INDEX record_columns_target ON public.record_columns USING btree (target);

CREATE INDEX record_tables_project ON public.record_tables USING btree (project_id);

CREATE INDEX sign_ons_user ON public.sign_ons USING btree (user_id);

CREATE INDEX table_changes_edit ON public.table_changes USING btree (table_id, sequence);

CREATE INDEX table_edits_author ON public.table_edits USING btree (table_id, user_name, in_force, sequence) WHERE writer;

CREATE INDEX table_edits_time ON public.table_edits USING btree (table_id, "time");

CREATE INDEX tile_revisions_edit ON public.tile_revisions USING btree (layer_id, sequence);

CREATE INDEX tile_revisions_key ON public.tile_revisions USING btree (layer_id, tile_y, tile_x, sequence) WHERE (key_tile IS NOT NULL);

CREATE INDEX tokens_project ON public.tokens USING btree (project_id) WHERE (project_id IS NOT NULL);

CREATE INDEX tokens_user ON public.tokens USING btree (user_name);

CREATE UNIQUE INDEX tool_shapes_slug ON public.tool_shapes USING btree (slug) WHERE (deleted IS NULL);

CREATE INDEX tour_files_blob ON public.tour_files USING btree (sha256);

CREATE INDEX tour_files_tour ON public.tour_files USING btree (tour_id);

CREATE UNIQUE INDEX users_name_in_any_case ON public.users USING btree (lower(name));

CREATE TRIGGER account_change_to_nodes AFTER UPDATE OF name, role, password, disabled, deleted ON public.users FOR EACH ROW WHEN ((((((old.name IS DISTINCT FROM new.name) OR (old.role IS DISTINCT FROM new.role)) OR (old.password IS DISTINCT FROM new.password)) OR (old.disabled IS DISTINCT FROM new.disabled)) OR (old.deleted IS DISTINCT FROM new.deleted))) EXECUTE FUNCTION public.account_to_nodes();

CREATE TRIGGER account_is_audited AFTER INSERT OR UPDATE OF name, full_name, role, password, disabled, deleted ON public.users FOR EACH ROW EXECUTE FUNCTION public.account_is_audited();

CREATE TRIGGER account_to_nodes AFTER INSERT ON public.users FOR EACH ROW EXECUTE FUNCTION public.account_to_nodes();

CREATE TRIGGER attachment_to_nodes AFTER UPDATE OF visibility ON public.attachments FOR EACH ROW WHEN ((old.visibility <> new.visibility)) EXECUTE FUNCTION public.attachment_to_nodes();

CREATE TRIGGER attachment_visibility_is_audited AFTER UPDATE OF visibility ON public.attachments FOR EACH ROW WHEN ((old.visibility <> new.visibility)) EXECUTE FUNCTION public.visibility_is_audited('attachment');

CREATE TRIGGER audit_is_kept BEFORE DELETE OR UPDATE ON public.audit_log FOR EACH ROW EXECUTE FUNCTION public.audit_is_kept();

CREATE TRIGGER audit_is_not_emptied BEFORE TRUNCATE ON public.audit_log FOR EACH STATEMENT EXECUTE FUNCTION public.audit_is_kept();

CREATE TRIGGER bill_deletion_is_audited AFTER DELETE ON public.bills FOR EACH ROW EXECUTE FUNCTION public.deletion_is_audited('bill');

CREATE TRIGGER column_deletion_is_audited AFTER UPDATE OF hidden ON public.record_columns FOR EACH ROW WHEN ((old.hidden <> new.hidden)) EXECUTE FUNCTION public.column_deletion_is_audited();

CREATE CONSTRAINT TRIGGER column_is_changed AFTER UPDATE ON public.record_columns DEFERRABLE INITIALLY DEFERRED FOR EACH ROW WHEN (((old.hidden <> new.hidden) OR ((old.properties -> 'name'::text) <> (new.properties -> 'name'::text)) OR ((old.properties -> 'order'::text) <> (new.properties -> 'order'::text)))) EXECUTE FUNCTION public.analysis_table_changed();

CREATE CONSTRAINT TRIGGER column_is_hidden_or_seen AFTER UPDATE ON public.record_columns DEFERRABLE INITIALLY DEFERRED FOR EACH ROW WHEN ((old.visibility <> new.visibility)) EXECUTE FUNCTION public.analysis_table_changed();

CREATE CONSTRAINT TRIGGER column_is_shown AFTER INSERT ON public.record_columns DEFERRABLE INITIALLY DEFERRED FOR EACH ROW WHEN ((NOT new.hidden)) EXECUTE FUNCTION public.analysis_table_changed();

CREATE TRIGGER column_visibility_is_audited AFTER UPDATE OF visibility ON public.record_columns FOR EACH ROW WHEN ((old.visibility <> new.visibility)) EXECUTE FUNCTION public.visibility_is_audited('column');

CREATE TRIGGER comment_change_to_nodes AFTER UPDATE OF version ON public.comments FOR EACH ROW WHEN ((old.version <> new.version)) EXECUTE FUNCTION public.comment_to_nodes();

CREATE TRIGGER comment_deletion_is_audited AFTER DELETE ON public.comments FOR EACH ROW EXECUTE FUNCTION public.comment_deletion_is_audited();

CREATE TRIGGER comment_emptied_is_audited AFTER UPDATE OF deleted ON public.comments FOR EACH ROW WHEN (((old.deleted IS NULL) AND (new.deleted IS NOT NULL))) EXECUTE FUNCTION public.comment_deletion_is_audited();

CREATE TRIGGER comment_is_activity AFTER INSERT OR DELETE OR UPDATE OF resolved, deleted ON public.comments FOR EACH ROW EXECUTE FUNCTION public.comment_is_activity();

CREATE TRIGGER comment_to_nodes AFTER INSERT ON public.comments FOR EACH ROW EXECUTE FUNCTION public.comment_to_nodes();

CREATE TRIGGER comments_gone_to_nodes AFTER DELETE ON public.comments REFERENCING OLD TABLE AS gone FOR EACH STATEMENT EXECUTE FUNCTION public.comments_gone_to_nodes();

CREATE TRIGGER edits_are_activity AFTER INSERT ON public.edits REFERENCING NEW TABLE AS added FOR EACH STATEMENT EXECUTE FUNCTION public.edits_are_activity();

CREATE TRIGGER group_is_audited AFTER INSERT OR DELETE OR UPDATE OF name ON public.groups FOR EACH ROW EXECUTE FUNCTION public.group_is_audited();

CREATE TRIGGER group_person_is_activity AFTER INSERT OR DELETE ON public.group_people FOR EACH ROW EXECUTE FUNCTION public.group_person_is_activity();

CREATE TRIGGER group_person_is_audited AFTER INSERT OR DELETE ON public.group_people FOR EACH ROW EXECUTE FUNCTION public.group_person_is_audited();

CREATE TRIGGER group_person_to_nodes AFTER INSERT OR DELETE ON public.group_people FOR EACH ROW EXECUTE FUNCTION public.member_to_nodes();

CREATE TRIGGER kiosk_change_to_nodes AFTER UPDATE OF revoked, phone ON public.kiosks FOR EACH ROW WHEN (((old.revoked IS DISTINCT FROM new.revoked) OR (old.phone IS DISTINCT FROM new.phone))) EXECUTE FUNCTION public.kiosk_to_nodes();

CREATE TRIGGER kiosk_is_audited AFTER INSERT OR DELETE OR UPDATE OF revoked, phone, wants_reload ON public.kiosks FOR EACH ROW EXECUTE FUNCTION public.kiosk_is_audited();

CREATE TRIGGER kiosk_to_nodes AFTER DELETE ON public.kiosks FOR EACH ROW EXECUTE FUNCTION public.kiosk_to_nodes();

CREATE TRIGGER layer_deletion_is_audited AFTER DELETE ON public.all_layers FOR EACH ROW EXECUTE FUNCTION public.deletion_is_audited('layer');

CREATE TRIGGER layer_gone_is_activity AFTER DELETE ON public.all_layers FOR EACH ROW WHEN ((old.binned IS NULL)) EXECUTE FUNCTION public.thing_is_activity('layer');

CREATE TRIGGER layer_in_bin_is_activity AFTER UPDATE OF binned ON public.all_layers FOR EACH ROW WHEN (((old.binned IS NULL) <> (new.binned IS NULL))) EXECUTE FUNCTION public.bin_is_activity('layer');

CREATE TRIGGER layer_in_trash_is_audited AFTER UPDATE OF binned, erasing ON public.all_layers FOR EACH ROW EXECUTE FUNCTION public.in_trash_is_audited('layer');

CREATE TRIGGER layer_is_activity AFTER INSERT OR UPDATE OF name, slug, type, unit, description, palette, opacity, blend, visible, draw_order, group_name, expression, automatic, locked, review, visibility ON public.all_layers FOR EACH ROW EXECUTE FUNCTION public.thing_is_activity('layer');

CREATE TRIGGER layer_visibility_is_audited AFTER UPDATE OF visibility ON public.all_layers FOR EACH ROW WHEN ((old.visibility <> new.visibility)) EXECUTE FUNCTION public.visibility_is_audited('layer');

CREATE TRIGGER look_deletion_is_audited AFTER DELETE ON public.looks FOR EACH ROW EXECUTE FUNCTION public.deletion_is_audited('surface_image');

CREATE TRIGGER look_is_activity AFTER INSERT OR DELETE OR UPDATE OF name, slug, description, opacity, visible, draw_order ON public.looks FOR EACH ROW EXECUTE FUNCTION public.thing_is_activity('look');

CREATE TRIGGER member_is_activity AFTER INSERT OR DELETE OR UPDATE OF role ON public.project_members FOR EACH ROW EXECUTE FUNCTION public.member_is_activity();

CREATE TRIGGER member_is_audited AFTER INSERT OR DELETE OR UPDATE OF role ON public.project_members FOR EACH ROW EXECUTE FUNCTION public.role_in_project_is_audited('person');

CREATE TRIGGER member_to_nodes AFTER INSERT OR DELETE OR UPDATE OF role ON public.project_members FOR EACH ROW EXECUTE FUNCTION public.member_to_nodes();

CREATE TRIGGER model_access_is_audited AFTER UPDATE OF project_id, source_download ON public.all_models FOR EACH ROW EXECUTE FUNCTION public.model_access_is_audited();

CREATE TRIGGER model_deletion_is_audited AFTER DELETE ON public.all_models FOR EACH ROW EXECUTE FUNCTION public.deletion_is_audited('model');

CREATE TRIGGER model_gone_is_activity AFTER DELETE ON public.all_models FOR EACH ROW WHEN ((old.binned IS NULL)) EXECUTE FUNCTION public.thing_is_activity('model');

CREATE TRIGGER model_in_bin_is_activity AFTER UPDATE OF binned ON public.all_models FOR EACH ROW WHEN (((old.binned IS NULL) <> (new.binned IS NULL))) EXECUTE FUNCTION public.bin_is_activity('model');

CREATE TRIGGER model_in_trash_is_audited AFTER UPDATE OF binned, erasing ON public.all_models FOR EACH ROW EXECUTE FUNCTION public.in_trash_is_audited('model');

CREATE TRIGGER model_is_activity AFTER INSERT OR UPDATE OF name, slug, project_id, unit, unit_assumed, scale_verified, up, north, crs, default_resolution, inventory_number, owner, creator, captured, method, accuracy, processing, rights_uri, credit, source_download, object_id, survey_date ON public.all_models FOR EACH ROW EXECUTE FUNCTION public.thing_is_activity('model');

CREATE TRIGGER new_selection_is_activity AFTER INSERT ON public.selections FOR EACH ROW WHEN (((new.content ->> 'audience'::text) = 'everyone'::text)) EXECUTE FUNCTION public.thing_is_activity('selection');

CREATE TRIGGER photograph_deletion_is_audited AFTER DELETE ON public.photographs REFERENCING OLD TABLE AS gone FOR EACH STATEMENT EXECUTE FUNCTION public.photograph_deletion_is_audited();

CREATE TRIGGER project_deletion_is_audited AFTER DELETE ON public.projects FOR EACH ROW EXECUTE FUNCTION public.deletion_is_audited('project');

CREATE TRIGGER project_group_is_activity AFTER INSERT OR DELETE OR UPDATE OF role ON public.project_groups FOR EACH ROW EXECUTE FUNCTION public.project_group_is_activity();

CREATE TRIGGER project_group_is_audited AFTER INSERT OR DELETE OR UPDATE OF role ON public.project_groups FOR EACH ROW EXECUTE FUNCTION public.role_in_project_is_audited('group');

CREATE TRIGGER project_group_to_nodes AFTER INSERT OR DELETE OR UPDATE OF role ON public.project_groups FOR EACH ROW EXECUTE FUNCTION public.project_group_to_nodes();

CREATE TRIGGER project_is_activity AFTER INSERT OR UPDATE OF name, slug, description ON public.projects FOR EACH ROW EXECUTE FUNCTION public.thing_is_activity('project');

CREATE TRIGGER project_settings_are_audited AFTER UPDATE OF require_if_match ON public.projects FOR EACH ROW WHEN ((old.require_if_match <> new.require_if_match)) EXECUTE FUNCTION public.project_settings_are_audited();

CREATE CONSTRAINT TRIGGER record_deletion_is_audited AFTER INSERT ON public.table_edits DEFERRABLE INITIALLY DEFERRED FOR EACH ROW WHEN ((new.op = ANY (ARRAY['delete'::text, 'detach'::text, 'restore'::text, 'undo'::text, 'redo'::text]))) EXECUTE FUNCTION public.record_deletion_is_audited();

CREATE TRIGGER records_to_nodes AFTER INSERT ON public.table_edits FOR EACH ROW EXECUTE FUNCTION public.records_to_nodes();

CREATE TRIGGER selection_change_is_activity AFTER UPDATE OF name, text, content ON public.selections FOR EACH ROW WHEN (((new.content ->> 'audience'::text) = 'everyone'::text)) EXECUTE FUNCTION public.thing_is_activity('selection');

CREATE TRIGGER selection_change_to_nodes AFTER UPDATE OF version ON public.selections FOR EACH ROW WHEN ((old.version <> new.version)) EXECUTE FUNCTION public.selection_to_nodes();

CREATE TRIGGER selection_deletion_is_activity AFTER DELETE ON public.selections FOR EACH ROW WHEN (((old.content ->> 'audience'::text) = 'everyone'::text)) EXECUTE FUNCTION public.thing_is_activity('selection');

CREATE TRIGGER selection_deletion_is_audited AFTER DELETE ON public.selections FOR EACH ROW EXECUTE FUNCTION public.deletion_is_audited('selection');

CREATE TRIGGER selection_to_nodes AFTER INSERT OR DELETE ON public.selections FOR EACH ROW EXECUTE FUNCTION public.selection_to_nodes();

CREATE TRIGGER sign_on_is_audited AFTER INSERT ON public.sign_ons FOR EACH ROW EXECUTE FUNCTION public.sign_on_is_audited();

CREATE TRIGGER snapshot_change_to_nodes AFTER UPDATE OF version ON public.snapshots FOR EACH ROW WHEN ((old.version <> new.version)) EXECUTE FUNCTION public.named_part_to_nodes('snapshot');

CREATE TRIGGER snapshot_deletion_is_audited AFTER DELETE ON public.snapshots FOR EACH ROW EXECUTE FUNCTION public.deletion_is_audited('snapshot');

CREATE TRIGGER snapshot_is_activity AFTER INSERT OR DELETE OR UPDATE OF name, text, content ON public.snapshots FOR EACH ROW EXECUTE FUNCTION public.thing_is_activity('snapshot');

CREATE TRIGGER snapshot_to_nodes AFTER INSERT OR DELETE ON public.snapshots FOR EACH ROW EXECUTE FUNCTION public.named_part_to_nodes('snapshot');

CREATE TRIGGER table_change_to_nodes AFTER UPDATE OF version ON public.record_tables FOR EACH ROW WHEN (((old.version <> new.version) AND (old.sequence = new.sequence))) EXECUTE FUNCTION public.table_to_nodes();

CREATE TRIGGER table_deletion_is_audited AFTER DELETE ON public.record_tables FOR EACH ROW EXECUTE FUNCTION public.deletion_is_audited('table');

CREATE CONSTRAINT TRIGGER table_edit_is_activity AFTER INSERT ON public.table_edits DEFERRABLE INITIALLY DEFERRED FOR EACH ROW EXECUTE FUNCTION public.table_edit_is_activity();

CREATE TRIGGER table_is_activity AFTER INSERT OR DELETE OR UPDATE OF name, labels, description ON public.record_tables FOR EACH ROW EXECUTE FUNCTION public.thing_is_activity('table');

CREATE CONSTRAINT TRIGGER table_is_renamed AFTER UPDATE ON public.record_tables DEFERRABLE INITIALLY DEFERRED FOR EACH ROW WHEN ((old.name <> new.name)) EXECUTE FUNCTION public.analysis_table_changed();

CREATE CONSTRAINT TRIGGER table_is_shown AFTER INSERT ON public.record_tables DEFERRABLE INITIALLY DEFERRED FOR EACH ROW EXECUTE FUNCTION public.analysis_table_changed();

CREATE TRIGGER table_to_nodes AFTER INSERT OR DELETE ON public.record_tables FOR EACH ROW EXECUTE FUNCTION public.table_to_nodes();

CREATE TRIGGER token_gone_to_nodes AFTER DELETE ON public.tokens FOR EACH ROW WHEN ((old.revoked IS NULL)) EXECUTE FUNCTION public.token_to_nodes();

CREATE TRIGGER token_is_audited AFTER INSERT OR UPDATE OF revoked ON public.tokens FOR EACH ROW EXECUTE FUNCTION public.token_is_audited();

CREATE TRIGGER token_to_nodes AFTER UPDATE OF revoked ON public.tokens FOR EACH ROW WHEN (((old.revoked IS NULL) AND (new.revoked IS NOT NULL))) EXECUTE FUNCTION public.token_to_nodes();

CREATE TRIGGER tool_deletion_is_audited AFTER UPDATE OF deleted ON public.tool_shapes FOR EACH ROW WHEN (((old.deleted IS NULL) AND (new.deleted IS NOT NULL))) EXECUTE FUNCTION public.tool_deletion_is_audited();

CREATE TRIGGER tool_to_nodes AFTER INSERT OR UPDATE OF name, deleted ON public.tool_shapes FOR EACH ROW EXECUTE FUNCTION public.tool_to_nodes();

CREATE TRIGGER tour_deletion_is_audited AFTER DELETE ON public.tours FOR EACH ROW EXECUTE FUNCTION public.deletion_is_audited('tour');

CREATE TRIGGER tour_is_activity AFTER INSERT OR DELETE OR UPDATE OF name, text, content ON public.tours FOR EACH ROW EXECUTE FUNCTION public.thing_is_activity('tour');

CREATE TRIGGER view_change_to_nodes AFTER UPDATE OF version ON public.views FOR EACH ROW WHEN ((old.version <> new.version)) EXECUTE FUNCTION public.named_part_to_nodes('view');

CREATE TRIGGER view_deletion_is_audited AFTER DELETE ON public.views FOR EACH ROW EXECUTE FUNCTION public.deletion_is_audited('view');

CREATE TRIGGER view_is_activity AFTER INSERT OR DELETE OR UPDATE OF name, text, content ON public.views FOR EACH ROW EXECUTE FUNCTION public.thing_is_activity('view');

CREATE TRIGGER view_to_nodes AFTER INSERT OR DELETE ON public.views FOR EACH ROW EXECUTE FUNCTION public.named_part_to_nodes('view');

ALTER TABLE ONLY public.activities
    ADD CONSTRAINT activities_project_id_fkey FOREIGN KEY (project_id) REFERENCES public.projects(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.all_models
    ADD CONSTRAINT all_models_owner_node_fkey FOREIGN KEY (owner_node) REFERENCES public.nodes(id) ON DELETE SET NULL;

ALTER TABLE ONLY public.attachments
    ADD CONSTRAINT attachments_sha256_fkey FOREIGN KEY (sha256) REFERENCES public.blobs(sha256);

ALTER TABLE ONLY public.attachments
    ADD CONSTRAINT attachments_table_id_fkey FOREIGN KEY (table_id) REFERENCES public.record_tables(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.bills
    ADD CONSTRAINT bills_project_id_fkey FOREIGN KEY (project_id) REFERENCES public.projects(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.blob_chunks
    ADD CONSTRAINT blob_chunks_sha256_fkey FOREIGN KEY (sha256) REFERENCES public.blobs(sha256) ON DELETE CASCADE;

ALTER TABLE ONLY public.comments
    ADD CONSTRAINT comments_layer_id_fkey FOREIGN KEY (layer_id) REFERENCES public.all_layers(id) ON DELETE SET NULL;

ALTER TABLE ONLY public.comments
    ADD CONSTRAINT comments_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.comments
    ADD CONSTRAINT comments_table_id_fkey FOREIGN KEY (table_id) REFERENCES public.record_tables(id) ON DELETE SET NULL;

ALTER TABLE ONLY public.comments
    ADD CONSTRAINT comments_thread_id_fkey FOREIGN KEY (thread_id) REFERENCES public.comments(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.detail_levels
    ADD CONSTRAINT detail_levels_geometry_fkey FOREIGN KEY (geometry) REFERENCES public.blobs(sha256);

ALTER TABLE ONLY public.detail_levels
    ADD CONSTRAINT detail_levels_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.edit_batches
    ADD CONSTRAINT edit_batches_layer_id_fkey FOREIGN KEY (layer_id) REFERENCES public.all_layers(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.edit_batches
    ADD CONSTRAINT edit_batches_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.edits
    ADD CONSTRAINT edits_layer_id_fkey FOREIGN KEY (layer_id) REFERENCES public.all_layers(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.edits
    ADD CONSTRAINT edits_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.group_people
    ADD CONSTRAINT group_people_group_id_fkey FOREIGN KEY (group_id) REFERENCES public.groups(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.group_people
    ADD CONSTRAINT group_people_sign_on_id_fkey FOREIGN KEY (sign_on_id) REFERENCES public.sign_ons(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.group_people
    ADD CONSTRAINT group_people_user_id_fkey FOREIGN KEY (user_id) REFERENCES public.users(id);

ALTER TABLE ONLY public.jobs
    ADD CONSTRAINT jobs_project_id_fkey FOREIGN KEY (project_id) REFERENCES public.projects(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.kiosks
    ADD CONSTRAINT kiosks_tour_id_fkey FOREIGN KEY (tour_id) REFERENCES public.tours(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.layer_inputs
    ADD CONSTRAINT layer_inputs_input_id_fkey FOREIGN KEY (input_id) REFERENCES public.all_layers(id) ON DELETE SET NULL;

ALTER TABLE ONLY public.layer_inputs
    ADD CONSTRAINT layer_inputs_layer_id_fkey FOREIGN KEY (layer_id) REFERENCES public.all_layers(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.layer_inputs
    ADD CONSTRAINT layer_inputs_table_id_fkey FOREIGN KEY (table_id) REFERENCES public.record_tables(id) ON DELETE SET NULL;

ALTER TABLE ONLY public.layer_origins
    ADD CONSTRAINT layer_origins_layer_id_fkey FOREIGN KEY (layer_id) REFERENCES public.all_layers(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.all_layers
    ADD CONSTRAINT layers_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.all_layers
    ADD CONSTRAINT layers_table_id_fkey FOREIGN KEY (table_id) REFERENCES public.record_tables(id);

ALTER TABLE ONLY public.looks
    ADD CONSTRAINT looks_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.looks
    ADD CONSTRAINT looks_picture_fkey FOREIGN KEY (picture) REFERENCES public.blobs(sha256);

ALTER TABLE ONLY public.merged_journals
    ADD CONSTRAINT merged_journals_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.model_sources
    ADD CONSTRAINT model_sources_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.model_sources
    ADD CONSTRAINT model_sources_sha256_fkey FOREIGN KEY (sha256) REFERENCES public.blobs(sha256);

ALTER TABLE ONLY public.all_models
    ADD CONSTRAINT models_geometry_fkey FOREIGN KEY (geometry) REFERENCES public.blobs(sha256);

ALTER TABLE ONLY public.all_models
    ADD CONSTRAINT models_object_fkey FOREIGN KEY (project_id, object_id) REFERENCES public.objects(project_id, id);

ALTER TABLE ONLY public.all_models
    ADD CONSTRAINT models_project_id_fkey FOREIGN KEY (project_id) REFERENCES public.projects(id);

ALTER TABLE ONLY public.objects
    ADD CONSTRAINT objects_project_id_fkey FOREIGN KEY (project_id) REFERENCES public.projects(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.personal_views
    ADD CONSTRAINT personal_views_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.personal_views
    ADD CONSTRAINT personal_views_user_id_fkey FOREIGN KEY (user_id) REFERENCES public.users(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.photographs
    ADD CONSTRAINT photographs_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.photographs
    ADD CONSTRAINT photographs_sha256_fkey FOREIGN KEY (sha256) REFERENCES public.blobs(sha256);

ALTER TABLE ONLY public.project_groups
    ADD CONSTRAINT project_groups_group_id_fkey FOREIGN KEY (group_id) REFERENCES public.groups(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.project_groups
    ADD CONSTRAINT project_groups_project_id_fkey FOREIGN KEY (project_id) REFERENCES public.projects(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.project_members
    ADD CONSTRAINT project_members_project_id_fkey FOREIGN KEY (project_id) REFERENCES public.projects(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.project_members
    ADD CONSTRAINT project_members_user_id_fkey FOREIGN KEY (user_id) REFERENCES public.users(id);

ALTER TABLE ONLY public.project_metadata
    ADD CONSTRAINT project_metadata_project_id_fkey FOREIGN KEY (project_id) REFERENCES public.projects(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.record_columns
    ADD CONSTRAINT record_columns_table_id_fkey FOREIGN KEY (table_id) REFERENCES public.record_tables(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.record_columns
    ADD CONSTRAINT record_columns_target_fkey FOREIGN KEY (target) REFERENCES public.record_tables(id);

ALTER TABLE ONLY public.record_tables
    ADD CONSTRAINT record_tables_project_id_fkey FOREIGN KEY (project_id) REFERENCES public.projects(id);

ALTER TABLE ONLY public.record_tables
    ADD CONSTRAINT record_tables_title_column_fkey FOREIGN KEY (title_column) REFERENCES public.record_columns(id) ON DELETE SET NULL;

ALTER TABLE ONLY public.record_views
    ADD CONSTRAINT record_views_table_id_fkey FOREIGN KEY (table_id) REFERENCES public.record_tables(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.selections
    ADD CONSTRAINT selections_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.sign_ons
    ADD CONSTRAINT sign_ons_user_id_fkey FOREIGN KEY (user_id) REFERENCES public.users(id);

ALTER TABLE ONLY public.snapshots
    ADD CONSTRAINT snapshots_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.table_changes
    ADD CONSTRAINT table_changes_table_id_sequence_fkey FOREIGN KEY (table_id, sequence) REFERENCES public.table_edits(table_id, sequence) ON DELETE CASCADE;

ALTER TABLE ONLY public.table_edits
    ADD CONSTRAINT table_edits_table_id_fkey FOREIGN KEY (table_id) REFERENCES public.record_tables(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.thinned_layers
    ADD CONSTRAINT thinned_layers_layer_id_fkey FOREIGN KEY (layer_id) REFERENCES public.all_layers(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.thumbnails
    ADD CONSTRAINT thumbnails_sha256_fkey FOREIGN KEY (sha256) REFERENCES public.blobs(sha256) ON DELETE CASCADE;

ALTER TABLE ONLY public.tile_revisions
    ADD CONSTRAINT tile_revisions_layer_id_fkey FOREIGN KEY (layer_id) REFERENCES public.all_layers(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.tile_segments
    ADD CONSTRAINT tile_segments_layer_id_fkey FOREIGN KEY (layer_id) REFERENCES public.all_layers(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.tile_sums
    ADD CONSTRAINT tile_sums_layer_id_fkey FOREIGN KEY (layer_id) REFERENCES public.all_layers(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.tokens
    ADD CONSTRAINT tokens_project_id_fkey FOREIGN KEY (project_id) REFERENCES public.projects(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.tokens
    ADD CONSTRAINT tokens_user_name_fkey FOREIGN KEY (user_name) REFERENCES public.users(name) ON UPDATE CASCADE ON DELETE CASCADE;

ALTER TABLE ONLY public.tour_files
    ADD CONSTRAINT tour_files_sha256_fkey FOREIGN KEY (sha256) REFERENCES public.blobs(sha256);

ALTER TABLE ONLY public.tour_files
    ADD CONSTRAINT tour_files_tour_id_fkey FOREIGN KEY (tour_id) REFERENCES public.tours(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.tours
    ADD CONSTRAINT tours_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.views
    ADD CONSTRAINT views_model_id_fkey FOREIGN KEY (model_id) REFERENCES public.all_models(id) ON DELETE CASCADE;

