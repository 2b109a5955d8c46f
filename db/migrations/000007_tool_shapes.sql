-- migrate:up

-- Shapes for the brush, of the whole site. What a tool is never changes, and a deleted one stays: journals name tools by id.
CREATE TABLE tool_shapes (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  name text NOT NULL CHECK (name <> ''),
  slug slug NOT NULL CHECK (slug NOT IN ('disc', 'square')),
  -- 256 × 256 bits, row by row from the top, the lowest bit of a byte first; few enough to lie in the row
  cells bytea NOT NULL CHECK (octet_length(cells) = 8192),
  created timestamptz NOT NULL DEFAULT now(),
  deleted timestamptz,
  version bigint NOT NULL DEFAULT 1
);
CREATE UNIQUE INDEX tool_shapes_slug ON tool_shapes (slug) WHERE deleted IS NULL;
