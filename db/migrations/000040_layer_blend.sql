-- migrate:up

-- How the layer's colors are combined with what is below them.
ALTER TABLE all_layers
  ADD COLUMN blend text DEFAULT 'normal' NOT NULL CHECK (blend IN ('normal', 'multiply', 'screen'));

CREATE OR REPLACE VIEW layers AS
  SELECT id, model_id, name, slug, kind, type, resolution, unit, description, palette, opacity,
    visible, draw_order, sequence, version, table_id, expression, automatic, computed_sequence,
    summed, locked, visibility, review, labels, descriptions, group_name, blend
  FROM all_layers
  WHERE binned IS NULL AND EXISTS (
    SELECT 1 FROM all_models m WHERE m.id = all_layers.model_id AND m.binned IS NULL);

DROP TRIGGER layer_is_activity ON all_layers;
CREATE TRIGGER layer_is_activity AFTER INSERT OR UPDATE OF
  name, slug, type, unit, description, palette, opacity, blend, visible, draw_order, group_name, expression, automatic, locked, review, visibility ON all_layers
  FOR EACH ROW EXECUTE FUNCTION thing_is_activity('layer');
