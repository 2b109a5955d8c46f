-- migrate:up

-- Where the surface of a model ends, as its import measured it.
ALTER TABLE all_models ADD COLUMN open_edges jsonb;  -- null: it was imported before they were measured

CREATE OR REPLACE VIEW models AS SELECT
    id, project_id, name, slug, unit, unit_assumed, scale_verified, up, north, crs, origin, bounds_min, bounds_max, triangles,
    vertices, area, atlas, repairs, default_resolution, inventory_number, owner, creator, captured, method, accuracy, processing,
    rights_uri, credit, geometry, sequence, version, source_download, proposal, open_edges
  FROM all_models WHERE binned IS NULL;
