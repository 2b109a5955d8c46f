// All model sessions that may have unsaved changes: the session on the page, and earlier sessions
// whose connection is still open.

import type { ModelSession } from "./model-session";

const sessions = new Set<ModelSession>();

export const remember = (session: ModelSession): void => void sessions.add(session);
export const forget = (session: ModelSession): void => void sessions.delete(session);

export const unsavedChanges = (): number =>
  [...sessions].reduce((sum, session) => sum + session.saving.waiting, 0);

/** Checks all connections. Call this when the network has changed, or the page is visible again. */
export function checkConnections(): void {
  for (const session of sessions) session.checkConnection();
}

/**
 * Ends all sessions after another user has signed in, so unsaved changes are not sent in that
 * user's name. Returns the number of changes that wait until their author signs in again.
 */
export function discardUnsaved(): number {
  const lost = unsavedChanges();
  for (const session of [...sessions]) session.discard();
  return lost;
}

/** Sends this user's layer settings now, because the page may close. */
export function keepViews(): void {
  for (const session of sessions) session.layers.flush();
}
