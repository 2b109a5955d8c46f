// The saved selections of an open model, made at their first use.

import type { ModelSession } from "./model-session";
import { SavedSelections } from "./saved-selections";

/** Returns the saved selections of an open model. */
export const savedSelectionsOf = (session: ModelSession): SavedSelections =>
  (session.savedSelections ??= new SavedSelections(session.api, session.modelId, {
    user: () => session.user,
    canCurate: () => session.canCurate,
    changed: () => session.painting.changed(),
  }));
