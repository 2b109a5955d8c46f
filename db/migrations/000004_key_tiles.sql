-- migrate:up

-- The last whole tile of each tile is found without reading the revisions before it.
CREATE INDEX tile_revisions_key ON tile_revisions (layer_id, tile_y, tile_x, sequence) WHERE key_tile IS NOT NULL;
