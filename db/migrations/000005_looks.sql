-- migrate:up

-- Pictures of a model's surface on its texture coordinates: the scan's own colours and further ones (UV light, infrared).
CREATE TABLE looks (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  model_id bigint NOT NULL REFERENCES models ON DELETE CASCADE,
  name text NOT NULL CHECK (name <> ''),
  slug slug NOT NULL,
  description text NOT NULL,
  media_type text NOT NULL CHECK (media_type IN ('image/jpeg', 'image/png')),
  width integer NOT NULL CHECK (width > 0),
  height integer NOT NULL CHECK (height > 0),
  -- what a view shows of it until its viewer chooses otherwise
  opacity double precision NOT NULL CHECK (opacity BETWEEN 0 AND 1),
  visible boolean NOT NULL,
  draw_order integer NOT NULL,
  picture bytea NOT NULL REFERENCES blobs,
  version bigint NOT NULL DEFAULT 1,
  UNIQUE (model_id, slug)
);
CREATE INDEX looks_picture ON looks (picture);
