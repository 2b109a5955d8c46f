-- migrate:up

-- Pictures, sounds, videos and subtitles of tours, and logos. Tours name them by id in `content`.
CREATE TABLE tour_files (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  tour_id bigint NOT NULL REFERENCES tours ON DELETE CASCADE,
  sha256 bytea NOT NULL REFERENCES blobs,
  name text NOT NULL CHECK (name <> ''),
  media_type text NOT NULL,
  width integer,
  height integer,
  user_name text NOT NULL,
  time timestamptz NOT NULL DEFAULT clock_timestamp(),
  CHECK ((width IS NULL) = (height IS NULL))
);
CREATE INDEX tour_files_tour ON tour_files (tour_id);
CREATE INDEX tour_files_blob ON tour_files (sha256);

-- The secret of the link for visitors' phones. It is not a hash, since the screen shows it to
-- everybody. Null: the screen shows no QR code.
ALTER TABLE kiosks ADD COLUMN phone text UNIQUE CHECK (char_length(phone) = 43);
