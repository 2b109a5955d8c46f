-- migrate:up
-- readable-from: 44

-- Programs that lack this migration would delete the rows of files. Before the first use of a folder or bucket, the server sets `readable_from` of this
-- migration accordingly.

-- The folder or bucket with the content of blobs that is outside the database. A site has at most one. Its file strata-files.json has the same id,
-- so a server does not use a wrong folder.
CREATE TABLE file_store (
  one boolean PRIMARY KEY DEFAULT true CHECK (one),
  id uuid NOT NULL,
  -- for people: the folder, or s3://BUCKET/PREFIX
  place text NOT NULL CHECK (char_length(place) BETWEEN 1 AND 4096),
  -- The database that may write and delete files: the identifier of its cluster, its oid and a random text, which is also in the file
  -- strata-files.json. A restored copy of the database has another identifier, and changes nothing that the original needs.
  owner text NOT NULL CHECK (char_length(owner) <= 100)
);

ALTER TABLE blobs
  -- the content is in the file store, not in blob_chunks
  ADD COLUMN is_outside boolean NOT NULL DEFAULT false,
  -- the SHA-256 of each MiB, one after the other, so that the server can check a part of a file without the rest
  ADD COLUMN chunk_sums bytea,
  -- When the server noticed that nothing uses the content, or when an upload began. For content in the database: when it moved there, if its file
  -- still exists. Otherwise null.
  ADD COLUMN unused timestamptz,
  -- the file store may lose this file at any time, so new content with this hash goes into blob_chunks
  ADD COLUMN removing timestamptz,
  ADD CONSTRAINT blobs_chunk_sums_check CHECK ((chunk_sums IS NOT NULL) = is_outside);
CREATE INDEX blobs_unused ON blobs (unused) WHERE unused IS NOT NULL;
CREATE INDEX blobs_removing ON blobs (removing) WHERE removing IS NOT NULL;
