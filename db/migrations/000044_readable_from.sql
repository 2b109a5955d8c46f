-- migrate:up

-- For sites whose nodes are updated one after the other, so that programs of two versions use one database (server/store/cluster/migrations.h).
-- dbmate does not fill these columns.
ALTER TABLE schema_migrations
  -- a program whose newest migration is this one, or a later one, can use the database after the migration; null: only a program that has the
  -- migration itself
  ADD COLUMN readable_from bigint CHECK (readable_from > 0),
  -- version of the program that applied the migration
  ADD COLUMN applied_by text CHECK (char_length(applied_by) <= 255);
