// The state of a kiosk's link, as far as the page can determine it.

import type { Kiosk } from "../core/protocol.gen";

/**
 * A kiosk reports every half minute, and the server keeps the time of its last report to the
 * minute. A kiosk without a report for this time shows nothing, or has no network.
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
