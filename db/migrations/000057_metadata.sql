-- migrate:up
-- readable-from: 44

-- The metadata of a project for a repository, in the form of DataCite: DepositRecord in protocol/messages/http.schema.json.
CREATE TABLE project_metadata (
  project_id bigint PRIMARY KEY REFERENCES projects ON DELETE CASCADE,
  record jsonb NOT NULL CHECK (jsonb_typeof(record) = 'object' AND octet_length(record::text) <= 1048576),
  version bigint NOT NULL DEFAULT 1
);

-- The license and the rights holder of a photograph. Empty: those of its model.
ALTER TABLE photographs
  ADD COLUMN rights_uri text NOT NULL DEFAULT '' CHECK (octet_length(rights_uri) <= 8000),
  ADD COLUMN rights_holder text NOT NULL DEFAULT '' CHECK (octet_length(rights_holder) <= 2000);
