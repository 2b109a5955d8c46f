// What becomes of a kiosk's link, as far as it can be told from here.

import type { Kiosk } from "../core/protocol.gen";

/**
 * A kiosk tells of itself every half a minute, and is said to be seen to a minute: one that says
 * nothing for so long shows nothing, or has no network.
 */
export const kSilent_ms = 3 * 60_000;

export type KioskState = "revoked" | "expired" | "unopened" | "running" | "silent";

export function state_of_kiosk(
  { revoked, expires, last_seen }: Pick<Kiosk, "revoked" | "expires" | "last_seen">,
  now = new Date(),
): KioskState {
  if (revoked) return "revoked";
  if (expires && new Date(expires) <= now) return "expired";
  if (!last_seen) return "unopened";
  return now.getTime() - new Date(last_seen).getTime() <= kSilent_ms ? "running" : "silent";
}
