-- migrate:up
-- readable-from: 44

-- Bills of quantities of a project. `content` has the `currency` and the `items` of the protocol's
-- BillWrite: groups and positions in their order, with rules and hand measurements.
CREATE TABLE bills (
  id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  project_id bigint NOT NULL REFERENCES projects ON DELETE CASCADE,
  name text NOT NULL CHECK (char_length(name) BETWEEN 1 AND 200),
  content jsonb NOT NULL CHECK (jsonb_typeof(content) = 'object'),
  -- the number of positions in `content`, for lists
  positions integer NOT NULL CHECK (positions >= 0),
  version bigint NOT NULL DEFAULT 1
);
CREATE UNIQUE INDEX bills_name ON bills (project_id, lower(name));

CREATE TRIGGER bill_deletion_is_audited AFTER DELETE ON bills
  FOR EACH ROW EXECUTE FUNCTION deletion_is_audited('bill');
