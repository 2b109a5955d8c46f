-- migrate:up

-- Heading under which the page lists the layer. Null: none.
ALTER TABLE all_layers
  ADD COLUMN group_name text CHECK (char_length(group_name) BETWEEN 1 AND 60);

CREATE OR REPLACE VIEW layers AS
  SELECT id, model_id, name, slug, kind, type, resolution, unit, description, palette, opacity,
    visible, draw_order, sequence, version, table_id, expression, automatic, computed_sequence,
    summed, locked, visibility, review, labels, descriptions, group_name
  FROM all_layers
  WHERE binned IS NULL AND EXISTS (
    SELECT 1 FROM all_models m WHERE m.id = all_layers.model_id AND m.binned IS NULL);
