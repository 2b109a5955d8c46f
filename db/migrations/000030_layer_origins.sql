-- migrate:up

-- Layers whose values were computed, from an expression over others or from the shape. They are locked against everybody until somebody unlocks them
-- to edit them by hand, which stays known.
CREATE TABLE layer_origins (
  layer_id bigint PRIMARY KEY REFERENCES all_layers ON DELETE CASCADE,
  origin text NOT NULL CHECK (origin IN ('expression', 'shape')),
  edited_by_hand boolean NOT NULL DEFAULT false
);

INSERT INTO layer_origins (layer_id, origin) SELECT id, 'expression' FROM all_layers WHERE expression IS NOT NULL;
-- What was made from the shape says so in its first edit. Whoever changed it since did so by hand.
INSERT INTO layer_origins (layer_id, origin, edited_by_hand)
  SELECT e.layer_id, 'shape', EXISTS (SELECT 1 FROM edits o WHERE o.layer_id = e.layer_id AND o.sequence <> e.sequence)
  FROM edits e JOIN (SELECT layer_id, min(sequence) AS sequence FROM edits GROUP BY layer_id) f USING (layer_id, sequence)
  WHERE e.op = 'import' AND e.record -> 'recipe' ->> 'kind' <> 'transfer'
  ON CONFLICT DO NOTHING;
UPDATE all_layers SET locked = true, version = version + 1
  WHERE NOT locked AND id IN (SELECT layer_id FROM layer_origins WHERE NOT edited_by_hand);
