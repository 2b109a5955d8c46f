-- migrate:up

-- On such a layer the edits of those below curator are provisional: in force and marked, until a curator accepts or rejects them.
ALTER TABLE layers ADD COLUMN review boolean NOT NULL DEFAULT false;

-- Decisions are entries of the journal like undo: they move content or nothing, and paint nothing themselves. A generated column cannot be given
-- another expression, so it is made anew.
DROP INDEX edits_author;
ALTER TABLE edits DROP COLUMN writer;
ALTER TABLE edits
  -- nothing: it never waited for anybody
  ADD COLUMN review text CHECK (review IN ('pending', 'accepted', 'rejected')),
  -- sequence of the entry that decided: who, when and why stands there
  ADD COLUMN reviewed_by bigint,
  ADD COLUMN writer boolean NOT NULL GENERATED ALWAYS AS (op NOT IN ('undo', 'redo', 'accept', 'reject', 'reopen')) STORED,
  ADD CHECK ((reviewed_by IS NOT NULL) = coalesce(review IN ('accepted', 'rejected'), false));
CREATE INDEX edits_author ON edits (layer_id, user_name, in_force, sequence) WHERE writer;
CREATE INDEX edits_pending ON edits (layer_id, sequence) WHERE review = 'pending' AND in_force;

DROP TRIGGER layer_is_activity ON layers;
CREATE TRIGGER layer_is_activity AFTER INSERT OR DELETE OR UPDATE OF
  name, slug, type, unit, description, palette, opacity, visible, draw_order, expression, automatic, locked, review, visibility ON layers
  FOR EACH ROW EXECUTE FUNCTION thing_is_activity('layer');

CREATE OR REPLACE VIEW analysis.edits WITH (security_barrier) AS
  SELECT e.model_id, m.name AS model, e.layer_id, l.name AS layer, e.sequence, e.time, e.user_name AS "user", e.op, e.in_force,
    (e.answer ->> 'texels_changed')::bigint AS texels_changed, (e.answer ->> 'area_m2')::double precision AS area_m2, e.review
  FROM public.edits e JOIN public.models m ON m.id = e.model_id JOIN public.layers l ON l.id = e.layer_id AND l.visibility = 'public';
