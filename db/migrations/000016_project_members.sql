-- migrate:up

-- What people may do in one project beside what they may do everywhere. A guest may do nothing anywhere else.
ALTER TABLE users
  DROP CONSTRAINT users_role_check,
  ADD CONSTRAINT users_role_check CHECK (role IN ('guest', 'viewer', 'annotator', 'curator', 'administrator', 'owner'));
CREATE TABLE project_members (
  project_id bigint NOT NULL REFERENCES projects ON DELETE CASCADE,
  user_id bigint NOT NULL REFERENCES users,
  role text NOT NULL CHECK (role IN ('viewer', 'annotator', 'curator')),
  PRIMARY KEY (user_id, project_id)
);
CREATE INDEX project_members_project ON project_members (project_id);
