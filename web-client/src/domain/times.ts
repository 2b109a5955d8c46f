// Formats times from the server, in the time zone of the browser.

import { pageLocale } from "../core/locale";

const timeOf = (at: Date): string =>
  at.toLocaleTimeString(pageLocale(), { hour: "2-digit", minute: "2-digit" });
const dayOf = (days: number): string =>
  new Intl.RelativeTimeFormat(pageLocale(), { numeric: "auto" }).format(days, "day");
const dateOf = (at: Date): string =>
  at.toLocaleDateString(pageLocale(), { day: "numeric", month: "short", year: "numeric" });

/** Formats a day: "today", "yesterday" or "4 May 2026". */
export function toldDay(iso: string, now = new Date()): string {
  const date = dateOf(new Date(iso));
  const yesterday = new Date(now.getFullYear(), now.getMonth(), now.getDate() - 1);
  return date === dateOf(now) ? dayOf(0) : date === dateOf(yesterday) ? dayOf(-1) : date;
}

/** Formats a day and time: "today, 14:05", "yesterday, 9:30" or "4 May 2026, 14:05". */
export const toldTime = (iso: string, now = new Date()): string =>
  `${toldDay(iso, now)}, ${timeOf(new Date(iso))}`;

const kAgo = [
  ["minute", 60],
  ["hour", 24],
] as const; // with the number of units in the next larger unit

/**
 * Formats a time as "2 minutes ago" or "3 hours ago". After a day, uses the format of
 * toldTime().
 */
export function toldAgo(iso: string, now = new Date()): string {
  let ago = Math.max(0, now.getTime() - new Date(iso).getTime()) / 60_000;
  for (const [unit, most] of kAgo) {
    if (ago < most)
      return new Intl.RelativeTimeFormat(pageLocale(), { numeric: "auto" }).format(
        -Math.floor(ago),
        unit,
      );
    ago /= most;
  }
  return toldTime(iso, now);
}

/** Formats a time of day, such as "14:05". */
export const toldClock = (iso: string): string => timeOf(new Date(iso));

/** Formats a date, such as "4 May 2026". */
export const toldDate = (iso: string): string => dateOf(new Date(iso));
