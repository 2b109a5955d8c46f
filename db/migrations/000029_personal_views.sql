-- migrate:up

-- How a person shows the layers of a model: what they hid, made fainter, recoloured or put in another order. `content` is the `layers` of the
-- protocol's PersonalView, with layers by id; those that are gone, or not for the person's eyes, are left out when it is read. No row: as everybody
-- sees the model at first.
CREATE TABLE personal_views (
  user_id bigint NOT NULL REFERENCES users ON DELETE CASCADE,
  model_id bigint NOT NULL REFERENCES all_models ON DELETE CASCADE,
  content jsonb NOT NULL CHECK (octet_length(content::text) <= 1048576),
  PRIMARY KEY (user_id, model_id)
);
CREATE INDEX personal_views_model ON personal_views (model_id);
