// What becomes of a kiosk's link, as far as it can be told from here.

import type { Kiosk } from "../core/protocol.gen";

/**
 * A kiosk tells of itself every half a minute, and is said to be seen to a minute: one that says
 * nothing for so long shows nothing, or has no network.
 */
export const kSilentMs = 3 * 60_000;

export type KioskState = "revoked" | "expired" | "unopened" | "running" | "silent";

export function stateOfKiosk(
  { revoked, expires, last_seen: lastSeen }: Pick<Kiosk, "revoked" | "expires" | "last_seen">,
  now = new Date(),
): KioskState {
  if (revoked) return "revoked";
  if (expires && new Date(expires) <= now) return "expired";
  if (!lastSeen) return "unopened";
  return now.getTime() - new Date(lastSeen).getTime() <= kSilentMs ? "running" : "silent";
}
