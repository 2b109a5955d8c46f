-- migrate:up

-- Accounts: whoever has a password (Argon2id, as libsodium writes it) may sign in by name, in any case. What was done by somebody who
-- was deleted stays, under the name `former-ID`; their row keeps the id and that name.
ALTER TABLE users
  ADD COLUMN full_name text NOT NULL DEFAULT '',
  ADD COLUMN password text CHECK (password <> ''),
  ADD COLUMN last_seen timestamptz,
  ADD COLUMN disabled timestamptz,
  ADD COLUMN deleted timestamptz,
  ADD CONSTRAINT users_role_check CHECK (role IN ('viewer', 'annotator', 'curator', 'administrator', 'owner'));
CREATE UNIQUE INDEX users_name_in_any_case ON users (lower(name));

-- Sessions and tokens are shown to their person, who ends them one by one. `label`: what the browser calls itself, or what the token is for.
ALTER TABLE tokens
  ADD COLUMN id bigint GENERATED ALWAYS AS IDENTITY UNIQUE,
  ADD COLUMN label text NOT NULL DEFAULT '',
  ADD COLUMN last_used timestamptz,
  DROP CONSTRAINT tokens_kind_check,
  ADD CONSTRAINT tokens_kind_check CHECK (kind IN ('session', 'script', 'owner_link', 'invitation'));
