// Determines the state of a kiosk's link.

import type { Kiosk } from "../core/protocol.gen";

/**
 * A kiosk is silent if it has sent no report for this time. A kiosk sends a report every
 * half minute. The server stores the time of the last report to the minute. A silent kiosk shows
 * nothing, or has no network.
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
