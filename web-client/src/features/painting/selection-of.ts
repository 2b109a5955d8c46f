// The selection and its strokes of an open model.

import type { ModelSession } from "../../session/model-session";
import { texts } from "../../texts";
import { notices } from "../../ui/notices";
import { Selection } from "./selection";
import { isOutline, kMostParts, stepsOf } from "./selection-steps";
import type { SharpFrame } from "./sharp-frame";
import { Strokes } from "./strokes";

/** Returns the selection of an open model. */
export const selectionOf = (session: ModelSession): Selection =>
  (session.selection ??= makeSelection(session));

const kSoonMs = 40; // The browser has drawn the page by then.

/** Makes the strokes of an open model. They find areas in the frame. */
export function makeStrokes(session: ModelSession, frame: () => SharpFrame | null): Strokes {
  const { view, painting } = session;
  return new Strokes({
    selection: selectionOf(session),
    frame,
    camera: () => view.camera.message(),
    scale: () => view.scale,
    through: () => painting.brush.through,
    begin: (at) => painting.beginOutline({ ...at, alt: false }),
    ended: () => painting.strokeEnded(),
    later: (callback) => void setTimeout(callback, kSoonMs),
    changed: () => painting.changed(),
  });
}

function makeSelection(session: ModelSession): Selection {
  const { api, lit, view, layers, painting, modelId: model } = session;
  const selection = new Selection({
    lit,
    camera: () => view.camera.message(),
    scale: () => view.scale,
    selected: () => layers.selected,
    layer: (id) => layers.find(id),
    mayPaint: () => painting.areaTarget(true) !== null,
    erases: () => painting.brush.areas.erases,
    paint: async (within, erases) => {
      const target = painting.areaTarget(erases);
      if (!target) return false;
      // Outlines alone are an edit of the live connection, which also waits for a lost server.
      if (stepsOf(within).every(isOutline)) {
        painting.paintOutlines(target, within);
        return true;
      }
      const body = { within, into: { layer: target.layer.id, ...target.paint } };
      const { edit } = await api.json("POST /models/{model}/select", { path: { model }, body });
      painting.showChange(edit?.texels_changed, edit?.area_m2);
      return true;
    },
    full: () => notices.show("problem", texts.selection.full(kMostParts)),
    failed: (error) => notices.error(error),
    changed: () => painting.changed(),
  });
  let layer = layers.selected?.id;
  session.subscribe(() => {
    if (layer === layers.selected?.id) return;
    layer = layers.selected?.id;
    selection.measureAgain();
  }, ["layers"]);
  return selection;
}
