// Every model session that may still have something to save: the one on the page, and those that
// linger after their page is gone.

import type { ModelSession } from "./model-session";

const sessions = new Set<ModelSession>();

export const remember = (session: ModelSession): void => void sessions.add(session);
export const forget = (session: ModelSession): void => void sessions.delete(session);

export const unsavedChanges = (): number =>
  [...sessions].reduce((sum, session) => sum + session.saving.waiting, 0);

/** The network changed, or the page came back to the front. */
export function checkConnections(): void {
  for (const session of sessions) session.checkConnection();
}

/**
 * Somebody else signed in, in whose name they must not go out. Returns how many changes wait for
 * them to come back.
 */
export function discardUnsaved(): number {
  const lost = unsavedChanges();
  for (const session of [...sessions]) session.discard();
  return lost;
}

/** The page may be gone in a moment: how this person shows layers is told now. */
export function keepViews(): void {
  for (const session of sessions) session.layers.flush();
}
