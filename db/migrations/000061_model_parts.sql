-- migrate:up
-- readable-from: 44

-- The scans from which a model was imported: names, folders, sizes.
ALTER TABLE all_models ADD COLUMN parts jsonb;  -- null: the model was imported from one scan

CREATE OR REPLACE VIEW models AS SELECT
    id, project_id, name, slug, unit, unit_assumed, scale_verified, up, north, crs, origin, bounds_min, bounds_max, triangles,
    vertices, area, atlas, repairs, default_resolution, inventory_number, owner, creator, captured, method, accuracy, processing,
    rights_uri, credit, geometry, sequence, version, source_download, proposal, open_edges, owner_node, owner_epoch, object_id, survey_date,
    from_points, parts
  FROM all_models WHERE binned IS NULL;
