-- migrate:up

-- Computed layers: their texels are what an expression over other layers, records and the surface says.
ALTER TABLE layers
  ADD COLUMN expression text CHECK (expression <> ''),
  ADD COLUMN automatic boolean NOT NULL DEFAULT false,
  -- sequence of the model when it was computed last: everything up to it is in. 0: never
  ADD COLUMN computed_sequence bigint NOT NULL DEFAULT 0,
  ADD CHECK (expression IS NOT NULL OR NOT automatic);
CREATE INDEX layers_automatic ON layers (id) WHERE automatic;

-- What an expression reads. A layer that was deleted leaves its name, so that the message can tell it.
CREATE TABLE layer_inputs (
  layer_id bigint NOT NULL REFERENCES layers ON DELETE CASCADE,
  slug text NOT NULL,
  input_id bigint REFERENCES layers ON DELETE SET NULL,
  -- the table whose records are read by the input's keys, and where it stood
  table_id bigint REFERENCES record_tables ON DELETE SET NULL,
  table_sequence bigint NOT NULL DEFAULT 0,
  PRIMARY KEY (layer_id, slug)
);
CREATE INDEX layer_inputs_input ON layer_inputs (input_id);
CREATE INDEX layer_inputs_table ON layer_inputs (table_id);
