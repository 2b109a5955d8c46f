-- migrate:up

-- What a layer is called, and what is said of it, in other languages, by language tag (BCP 47). `name` and `description` stay what
-- they are; a language without an entry shows them.
ALTER TABLE all_layers
  ADD COLUMN labels jsonb NOT NULL DEFAULT '{}',
  ADD COLUMN descriptions jsonb NOT NULL DEFAULT '{}';

-- The view keeps the columns that it has, whichever they are by now.
DO $$ BEGIN
  EXECUTE format(
    'CREATE OR REPLACE VIEW layers AS SELECT %s, labels, descriptions FROM all_layers '
    'WHERE binned IS NULL AND EXISTS (SELECT 1 FROM all_models m WHERE m.id = all_layers.model_id AND m.binned IS NULL)',
    (SELECT string_agg(quote_ident(attname), ', ' ORDER BY attnum) FROM pg_attribute
     WHERE attrelid = 'layers'::regclass AND attnum > 0 AND NOT attisdropped));
END $$;
