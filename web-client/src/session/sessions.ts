// All model sessions that may have unsaved changes: the one on the page, and earlier ones whose
// connection is still open.

import type { ModelSession } from "./model-session";

const sessions = new Set<ModelSession>();

export const remember = (session: ModelSession): void => void sessions.add(session);
export const forget = (session: ModelSession): void => void sessions.delete(session);

export const unsavedChanges = (): number =>
  [...sessions].reduce((sum, session) => sum + session.saving.waiting, 0);

/** Call this when the network has changed, or the page is visible again. */
export function checkConnections(): void {
  for (const session of sessions) session.checkConnection();
}

/**
 * Another person has signed in; unsaved changes must not be sent in their name. Returns the number
 * of changes that wait for their author's return.
 */
export function discardUnsaved(): number {
  const lost = unsavedChanges();
  for (const session of [...sessions]) session.discard();
  return lost;
}

/** The page may close: this person's layer settings are sent now. */
export function keepViews(): void {
  for (const session of sessions) session.layers.flush();
}
