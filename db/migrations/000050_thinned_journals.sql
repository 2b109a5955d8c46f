-- migrate:up
-- readable-from: 44

-- An administrator can thin the old part of a journal (store/journal/journal_thinner). Consecutive edits of a layer then become one edit with the
-- op 'checkpoint' and without a user. Its `first_sequence` is the first state that is no longer available: the layer has no states from
-- `first_sequence` up to, but not including, `sequence`. Programs that lack this migration would return wrong texels for such states. Before the
-- first checkpoint, the server sets `readable_from` of this migration accordingly.

ALTER TABLE edit_batches
  -- the author of an edit that is now in a checkpoint. Null: the author of the merged edit
  ADD COLUMN user_name text,
  -- whether that edit waited for review when it was made. Null: as the merged edit
  ADD COLUMN provisional boolean;

-- How often the thinner has replaced rows of a layer. The merger compares this number, because the thinner may have replaced rows that it has read.
CREATE TABLE thinned_layers (
  layer_id bigint PRIMARY KEY REFERENCES all_layers ON DELETE CASCADE,
  count bigint NOT NULL
);
