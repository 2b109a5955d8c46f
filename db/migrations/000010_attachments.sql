-- migrate:up

-- Files that records have: photos, drawings, reports. A cell of a picture or document column lists ids of its table's attachments. They stay
-- with the table, since its journal names them: undo and `at=` bring them back. Their content is a blob, once for all that are the same.
CREATE TABLE attachments (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  table_id bigint NOT NULL REFERENCES record_tables ON DELETE CASCADE,
  sha256 bytea NOT NULL REFERENCES blobs,
  name text NOT NULL CHECK (name <> ''),
  -- what the bytes are, whatever the sender called them
  media_type text NOT NULL,
  -- of pictures that can be read
  width integer,
  height integer,
  user_name text NOT NULL,
  time timestamptz NOT NULL DEFAULT clock_timestamp(),
  CHECK ((width IS NULL) = (height IS NULL))
);
CREATE INDEX attachments_table ON attachments (table_id);
CREATE INDEX attachments_blob ON attachments (sha256);

-- Made when first asked for.
CREATE TABLE thumbnails (
  sha256 bytea NOT NULL REFERENCES blobs ON DELETE CASCADE,
  side integer NOT NULL,
  picture bytea NOT NULL,
  PRIMARY KEY (sha256, side)
);
ALTER TABLE thumbnails ALTER COLUMN picture SET STORAGE EXTERNAL;

ALTER TABLE record_columns DROP CONSTRAINT record_columns_kind_check;
ALTER TABLE record_columns ADD CONSTRAINT record_columns_kind_check CHECK (kind IN (
  'text', 'integer', 'numeric', 'boolean', 'date', 'timestamp', 'period', 'enumeration', 'url', 'term', 'relation', 'picture', 'document'));
