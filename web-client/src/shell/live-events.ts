// Passes the server's events to the parts of an open model.

import type { ConnectionCallbacks } from "../net/connection";
import type { ModelSession } from "../session/model-session";

/** The events for the parts. The session itself handles all other events. */
export type EventsOfParts = Omit<
  ConnectionCallbacks,
  "state" | "welcome" | "frame" | "saving" | "model" | "problem" | "takenUp"
>;

export function eventsOfParts(session: ModelSession): EventsOfParts {
  return {
    applied: (message) => {
      session.visits.saw(message.sequence);
      session.painting.onApplied(message);
      session.pointer.askAgain();
    },
    saved: () => {
      session.reviews.saved();
      session.tables.refreshAreas(); // also the areas that this user's own strokes have changed
      session.activity.outdated();
      session.past.outdated();
    },
    layer: (event) => {
      session.layers.onEvent(event);
      session.reviews.onEvent(event);
      session.activity.outdated(event.user);
      session.past.outdated();
      if (event.event === "edited") {
        session.visits.saw(event.sequence ?? 0);
        session.pointer.askAgain();
        session.measuring.onLayerEdited(event.layer_id);
        session.tables.onLayerEdited(event.layer_id);
      } else if (event.event === "deleted") {
        session.tables.onLayerDeleted(event.layer_id);
      }
    },
    look: (event) => {
      session.appearance.onEvent(event);
      session.activity.outdated();
    },
    tool: (event) => session.shapes.onEvent(event),
    record: (event) => {
      session.tables.onRecord(event);
      session.activity.outdated(event.user);
    },
    table: (event) => {
      session.tables.onTable(event);
      session.activity.outdated(event.user);
    },
    comment: (event) => {
      session.comments.onEvent(event);
      session.activity.outdated(event.user);
    },
    view: (event) => session.views.onEvent(event),
    snapshot: (event) => {
      session.past.onSnapshot();
      session.activity.outdated(event.user);
    },
    selection: (event) => {
      session.savedSelections?.onEvent(event);
      session.activity.outdated(event.user);
    },
    editors: (message) => session.editors.onMessage(message),
    presence: ({ users }) => {
      session.together.receive(users);
      session.cursors.receive(users.filter((user) => user.session !== session.session));
    },
    picked: (message) => {
      if (!session.cursors.answer(message) && !session.together.answer(message))
        session.pointer.answer(message);
    },
  };
}
