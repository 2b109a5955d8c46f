-- migrate:up

-- Accounts that people use with an OpenID Connect provider. The issuer and the subject identify a person at a provider. A user name or an e-mail
-- address never does.
CREATE TABLE sign_ons (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  issuer text NOT NULL CHECK (octet_length(issuer) BETWEEN 1 AND 255),
  subject text NOT NULL CHECK (octet_length(subject) BETWEEN 1 AND 255),
  user_id bigint NOT NULL REFERENCES users,
  -- empty until the first sign-in, if an administrator made the row
  first_used timestamptz,
  last_used timestamptz,
  UNIQUE (issuer, subject)
);
CREATE INDEX sign_ons_user ON sign_ons (user_id);

-- Sign-ins that wait for the response of the provider. The response may reach another node. The columns `state` and `browser` are the SHA-256 of
-- the state in the address and of the secret in the browser's cookie.
CREATE TABLE pending_sign_ins (
  state bytea PRIMARY KEY CHECK (octet_length(state) = 32),
  browser bytea NOT NULL CHECK (octet_length(browser) = 32),
  provider text NOT NULL CHECK (octet_length(provider) <= 64),
  nonce text NOT NULL CHECK (octet_length(nonce) <= 128),
  code_verifier text NOT NULL CHECK (octet_length(code_verifier) <= 128),
  return_to text NOT NULL CHECK (octet_length(return_to) <= 1024),
  expires timestamptz NOT NULL
);
CREATE INDEX pending_sign_ins_expires ON pending_sign_ins (expires);

-- The sign-on whose claims put the person into the group. Each sign-in updates these memberships. A membership without a sign-on was given by hand
-- and stays.
ALTER TABLE group_people ADD COLUMN sign_on_id bigint REFERENCES sign_ons ON DELETE CASCADE;
CREATE INDEX group_people_sign_on ON group_people (sign_on_id) WHERE sign_on_id IS NOT NULL;

-- --- the audit log

CREATE FUNCTION sign_on_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  PERFORM audit('oidc_bound', 'person', NEW.user_id, (SELECT u.name FROM users u WHERE u.id = NEW.user_id), NULL,
    jsonb_build_object('issuer', NEW.issuer, 'subject', NEW.subject));
  RETURN NULL;
END $$;
CREATE TRIGGER sign_on_is_audited AFTER INSERT ON sign_ons FOR EACH ROW EXECUTE FUNCTION sign_on_is_audited();

-- As before, and with the provider (`strata.provider`) of a sign-in.
CREATE OR REPLACE FUNCTION token_is_audited() RETURNS trigger LANGUAGE plpgsql AS $$
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

-- As before, and with the provider. Failures with different providers have different rows.
CREATE OR REPLACE FUNCTION audit_failed_sign_in(tried text, way text) RETURNS void LANGUAGE plpgsql AS $$
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
