-- migrate:up

CREATE TABLE users (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  name text NOT NULL UNIQUE CHECK (name <> ''),
  role text NOT NULL,
  created timestamptz NOT NULL DEFAULT now()
);
INSERT INTO users (name, role) VALUES ('owner', 'owner');

-- Secrets are 256 random bits, so that a plain SHA-256 keeps them as well as a slow hash would.
CREATE TABLE tokens (
  hash bytea PRIMARY KEY CHECK (octet_length(hash) = 32),
  kind text NOT NULL CHECK (kind IN ('session', 'script', 'owner_link')),
  user_name text NOT NULL REFERENCES users (name) ON DELETE CASCADE ON UPDATE CASCADE,
  role text NOT NULL,
  created timestamptz NOT NULL DEFAULT now(),
  expires timestamptz,
  revoked timestamptz
);
CREATE INDEX tokens_user ON tokens (user_name);

-- First answers to changing HTTP calls, by their Idempotency-Key.
CREATE TABLE answers (
  key text PRIMARY KEY,
  answer jsonb NOT NULL,
  time timestamptz NOT NULL DEFAULT now()
);
CREATE INDEX answers_time ON answers (time);
