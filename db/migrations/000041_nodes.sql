-- migrate:up

-- The server processes of a site that has several. A node renews its lease every second. The clock of the database decides whether it is over.
CREATE TABLE nodes (
  id uuid PRIMARY KEY,
  -- the address for requests that only this node can answer
  url text NOT NULL CHECK (char_length(url) BETWEEN 1 AND 255),
  started timestamptz NOT NULL DEFAULT clock_timestamp(),
  lease_until timestamptz NOT NULL,
  -- a node that is about to stop: other nodes may claim its models at once
  draining boolean NOT NULL DEFAULT false,
  version text NOT NULL CHECK (char_length(version) <= 255),
  gpu text NOT NULL CHECK (char_length(gpu) <= 255),
  open_models integer NOT NULL DEFAULT 0 CHECK (open_models >= 0),
  participants integer NOT NULL DEFAULT 0 CHECK (participants >= 0),
  -- processor cores in use
  processor_share real NOT NULL DEFAULT 0 CHECK (processor_share >= 0 AND processor_share < 'Infinity')
);

-- The node that has the model open, and how many times the model was claimed. Each commit of the journal names the epoch of its room, so a
-- room that another server has replaced can write nothing. Epochs never decrease, also when a model is released. A server that is alone claims
-- models without a node.
ALTER TABLE all_models
  ADD COLUMN owner_node uuid REFERENCES nodes ON DELETE SET NULL,
  ADD COLUMN owner_epoch bigint NOT NULL DEFAULT 0 CHECK (owner_epoch >= 0);
CREATE INDEX all_models_owner_node ON all_models (owner_node) WHERE owner_node IS NOT NULL;

CREATE OR REPLACE VIEW models AS
  SELECT id, project_id, name, slug, unit, unit_assumed, scale_verified, up, north, crs, origin,
    bounds_min, bounds_max, triangles, vertices, area, atlas, repairs, default_resolution,
    inventory_number, owner, creator, captured, method, accuracy, processing, rights_uri, credit,
    geometry, sequence, version, source_download, proposal, open_edges, owner_node, owner_epoch
  FROM all_models
  WHERE binned IS NULL;

-- The node that runs the job. Another node must not call it lost while that node has a lease. No reference, because the job outlives the node.
ALTER TABLE jobs ADD COLUMN node uuid;
