-- migrate:up
-- readable-from: 44

-- How the import made the surface of a model from a point cloud.
ALTER TABLE all_models ADD COLUMN from_points jsonb;  -- null: the file contained triangles

CREATE OR REPLACE VIEW models AS SELECT
    id, project_id, name, slug, unit, unit_assumed, scale_verified, up, north, crs, origin, bounds_min, bounds_max, triangles,
    vertices, area, atlas, repairs, default_resolution, inventory_number, owner, creator, captured, method, accuracy, processing,
    rights_uri, credit, geometry, sequence, version, source_download, proposal, open_edges, owner_node, owner_epoch, object_id, survey_date,
    from_points
  FROM all_models WHERE binned IS NULL;
