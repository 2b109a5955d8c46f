-- migrate:up

-- Whether changes in a project must name the version that they were made for (If-Match; otherwise 428, RFC 6585).
ALTER TABLE projects ADD COLUMN require_if_match boolean NOT NULL DEFAULT false;
