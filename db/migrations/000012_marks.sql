-- migrate:up

-- Columns of lines and points: lists of places on models (server/core/mark.h), as JSON in the rows.
ALTER TABLE record_columns DROP CONSTRAINT record_columns_kind_check;
ALTER TABLE record_columns ADD CONSTRAINT record_columns_kind_check CHECK (kind IN (
  'text', 'integer', 'numeric', 'boolean', 'date', 'timestamp', 'period', 'enumeration', 'url', 'term', 'relation', 'picture', 'document',
  'line', 'point'));
