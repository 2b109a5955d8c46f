-- migrate:up
-- readable-from: 44

-- A stroke has an edit for each batch of its path. After the stroke has ended, the server merges these edits into one (store/journal/journal_merger).
-- Programs that lack this migration cannot read the result. Before the first merge, the server sets `readable_from` of this migration accordingly.
ALTER TABLE edits
  -- sequence of the first batch of a merged edit. The edit has the sequence of its last batch
  ADD COLUMN first_sequence bigint,
  -- time of this batch
  ADD COLUMN first_time timestamptz,
  -- the tiles with a revision of the edit, as tile_y * 128 + tile_x. Null until the merger has read the edit
  ADD COLUMN tiles smallint[];

-- The time when the server marked a migration as no longer readable for older programs. Null: it did not.
ALTER TABLE schema_migrations ADD COLUMN unreadable_since timestamptz;

-- The batches of merged edits. A batch that is sent again must get its first response.
CREATE TABLE edit_batches (
  model_id bigint NOT NULL REFERENCES all_models ON DELETE CASCADE,
  id uuid NOT NULL,
  layer_id bigint NOT NULL REFERENCES all_layers ON DELETE CASCADE,
  -- sequence of the merged edit
  edit bigint NOT NULL,
  -- sequence that the batch had
  sequence bigint NOT NULL,
  area_m2 double precision NOT NULL,
  texels_changed integer NOT NULL,
  PRIMARY KEY (model_id, id)
);
CREATE INDEX edit_batches_edit ON edit_batches (layer_id, edit);

-- Consecutive revisions of one tile, which are no longer in `tile_revisions`: the tile before them, and what each of them wrote
-- (domain/layers/tile_segment).
CREATE TABLE tile_segments (
  layer_id bigint NOT NULL REFERENCES all_layers ON DELETE CASCADE,
  tile_y smallint NOT NULL,
  tile_x smallint NOT NULL,
  -- sequences of the first and the last revision
  first_sequence bigint NOT NULL,
  last_sequence bigint NOT NULL,
  content bytea NOT NULL,
  PRIMARY KEY (layer_id, tile_y, tile_x, first_sequence),
  CHECK (first_sequence <= last_sequence)
);
ALTER TABLE tile_segments ALTER COLUMN content SET STORAGE EXTERNAL;

-- How far the merger has read the journal of each model. The edits up to this sequence do not change any more, except for their state.
CREATE TABLE merged_journals (
  model_id bigint PRIMARY KEY REFERENCES all_models ON DELETE CASCADE,
  sequence bigint NOT NULL
);

-- The merger deletes most rows of these tables soon after they were written. With the default settings, the space of these rows would be reused
-- only after a fifth of a table had been deleted.
ALTER TABLE edits SET (autovacuum_vacuum_scale_factor = 0.01, autovacuum_vacuum_threshold = 20000,
  toast.autovacuum_vacuum_scale_factor = 0.01, toast.autovacuum_vacuum_threshold = 20000);
ALTER TABLE tile_revisions SET (autovacuum_vacuum_scale_factor = 0.05, autovacuum_vacuum_threshold = 20000,
  toast.autovacuum_vacuum_scale_factor = 0.05, toast.autovacuum_vacuum_threshold = 20000);
