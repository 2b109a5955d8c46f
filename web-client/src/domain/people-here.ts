// Groups the connections to the open model by user, in the order and with the colors that the page
// shows.

import type { PresenceUser } from "../core/protocol.gen";
import type { Vec3 } from "../math/vector";

/** A user, with all windows in which this user has the model open. */
export interface PersonHere {
  user: string;
  full_name: string; // empty if the account has no full name
  color: string;
  own: boolean;
  /** A connection from another window, which can be followed. Null if there is no other window. */
  viewer: PresenceUser | null;
  leading: boolean;
  /** The sessions that the user follows in any window. */
  following: string[];
}

/** Returns each user once: first the user of this window, then the others by time of joining. */
export function peopleHere(viewers: readonly PresenceUser[], ownSession: string): PersonHere[] {
  const own = viewers.find(({ session }) => session === ownSession)?.name;
  const byName = new Map<string, PresenceUser[]>();
  for (const viewer of viewers)
    byName.set(viewer.name, [...(byName.get(viewer.name) ?? []), viewer]);
  const people = [...byName].map(([user, windows]): PersonHere => {
    const others = windows.filter(({ session }) => session !== ownSession);
    return {
      user,
      full_name: windows.find(({ full_name: fullName }) => fullName)?.full_name ?? "",
      color: windows[0]!.color,
      own: user === own,
      viewer:
        others.find(({ leading }) => leading) ??
        others.find(({ pointer }) => pointer) ??
        others[0] ??
        null,
      leading: windows.some(({ leading }) => leading),
      following: windows.flatMap(({ following }) => following ?? []),
    };
  });
  return people.sort((a, b) => Number(b.own) - Number(a.own));
}

/** Returns the users who follow this session. */
export const followersOf = (people: readonly PersonHere[], session: string): PersonHere[] =>
  people.filter(({ following }) => following.includes(session));

/**
 * Whether following `session` would create a cycle that includes this window. The server refuses
 * cycles.
 */
export function leadsBack(
  viewers: readonly PresenceUser[],
  session: string,
  ownSession: string,
): boolean {
  let ahead: string | undefined = session;
  for (let steps = 0; ahead !== undefined && steps <= viewers.length; ++steps) {
    if (ahead === ownSession) return true;
    const here: string = ahead;
    ahead = viewers.find((viewer) => viewer.session === here)?.following;
  }
  return false;
}

const kDarkInk = "#20292a";
const kLightInk = "#ffffff";

/**
 * Returns the text color that is most readable on a color (#rrggbb): the one with the larger
 * contrast ratio according to WCAG 2.
 */
export const inkOn = (color: string): string =>
  contrast(color, kLightInk) >= contrast(color, kDarkInk) ? kLightInk : kDarkInk;

export function contrast(a: string, b: string): number {
  const [less, more] = [luminance(a), luminance(b)].sort((x, y) => x - y) as [number, number];
  return (more + 0.05) / (less + 0.05);
}

function luminance(color: string): number {
  const [r, g, b] = [1, 3, 5].map((at) => {
    const share = parseInt(color.slice(at, at + 2), 16) / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  }) as unknown as Vec3;
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
