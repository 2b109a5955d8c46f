-- migrate:up

-- Up may be the opposite of an axis, too, and an import keeps which unit and up direction the file states or lets one guess.
ALTER TABLE all_models
  DROP CONSTRAINT models_up_check,
  ADD CONSTRAINT models_up_check CHECK (up IN ('x', 'y', 'z', '-x', '-y', '-z')),
  ADD COLUMN proposal jsonb;  -- null: it was imported before there were any

CREATE OR REPLACE VIEW models AS SELECT
    id, project_id, name, slug, unit, unit_assumed, scale_verified, up, north, crs, origin, bounds_min, bounds_max, triangles,
    vertices, area, atlas, repairs, default_resolution, inventory_number, owner, creator, captured, method, accuracy, processing,
    rights_uri, credit, geometry, sequence, version, source_download, proposal
  FROM all_models WHERE binned IS NULL;
