-- migrate:up

CREATE TABLE layers (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  model_id bigint NOT NULL REFERENCES models ON DELETE CASCADE,
  name text NOT NULL CHECK (name <> ''),
  slug slug NOT NULL,
  kind text NOT NULL CHECK (kind IN ('numeric', 'database')),
  type text NOT NULL CHECK (type IN ('u8', 'u16', 'u32', 'i8', 'i16', 'i32', 'f16', 'f32')),
  resolution integer NOT NULL CHECK (resolution BETWEEN 128 AND 16384 AND (resolution & (resolution - 1)) = 0),
  unit text NOT NULL,
  description text NOT NULL,
  palette jsonb NOT NULL,
  opacity double precision NOT NULL CHECK (opacity BETWEEN 0 AND 1),
  visible boolean NOT NULL,
  draw_order integer NOT NULL,
  records_table text,
  sequence bigint NOT NULL DEFAULT 0,
  version bigint NOT NULL DEFAULT 1,
  UNIQUE (model_id, slug)
);

-- The journal: one row an edit, in the order of its model.
CREATE TABLE edits (
  model_id bigint NOT NULL REFERENCES models ON DELETE CASCADE,
  sequence bigint NOT NULL CHECK (sequence > 0),
  id uuid NOT NULL,
  layer_id bigint NOT NULL REFERENCES layers ON DELETE CASCADE,
  stroke uuid NOT NULL,
  user_name text NOT NULL,
  op text NOT NULL,
  record jsonb NOT NULL,
  answer jsonb NOT NULL,
  time timestamptz NOT NULL,
  in_force boolean NOT NULL DEFAULT true,
  -- sequence of the entry that undid it, while it is undone: gives the order in which redo takes strokes back
  undone_by bigint,
  -- paint, not the moving of content that undo and redo do; a restore is a writer, so that later undos see what it brought back
  writer boolean NOT NULL GENERATED ALWAYS AS (op NOT IN ('undo', 'redo')) STORED,
  PRIMARY KEY (model_id, sequence),
  UNIQUE (model_id, id),
  CHECK (in_force = (undone_by IS NULL))
);
CREATE INDEX edits_layer ON edits (layer_id, sequence);
CREATE INDEX edits_author ON edits (layer_id, user_name, in_force, sequence) WHERE writer;
CREATE INDEX edits_undone ON edits (layer_id, user_name, undone_by) WHERE NOT in_force;

-- What an edit did to a tile: XOR of before and after with the mask of written texels, zstd. Every 64th revision of a
-- tile carries the whole tile, too, so that a state is read from the nearest one on.
CREATE TABLE tile_revisions (
  layer_id bigint NOT NULL REFERENCES layers ON DELETE CASCADE,
  tile_y smallint NOT NULL,
  tile_x smallint NOT NULL,
  sequence bigint NOT NULL,
  difference bytea NOT NULL,
  key_tile bytea,
  PRIMARY KEY (layer_id, tile_y, tile_x, sequence)
);
ALTER TABLE tile_revisions ALTER COLUMN difference SET STORAGE EXTERNAL, ALTER COLUMN key_tile SET STORAGE EXTERNAL;
CREATE INDEX tile_revisions_edit ON tile_revisions (layer_id, sequence);
