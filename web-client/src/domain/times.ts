// Moments of the server as people say them, in the time of this browser.

import { page_locale } from "../core/locale";

const time_of = (at: Date): string =>
  at.toLocaleTimeString(page_locale(), { hour: "2-digit", minute: "2-digit" });
const day_of = (days: number): string =>
  new Intl.RelativeTimeFormat(page_locale(), { numeric: "auto" }).format(days, "day");
const date_of = (at: Date): string =>
  at.toLocaleDateString(page_locale(), { day: "numeric", month: "short", year: "numeric" });

/** "today", "yesterday" or "4 May 2026". */
export function told_day(iso: string, now = new Date()): string {
  const date = date_of(new Date(iso));
  const yesterday = new Date(now.getFullYear(), now.getMonth(), now.getDate() - 1);
  return date === date_of(now) ? day_of(0) : date === date_of(yesterday) ? day_of(-1) : date;
}

/** "today, 14:05", "yesterday, 9:30" or "4 May 2026, 14:05". */
export const told_time = (iso: string, now = new Date()): string =>
  `${told_day(iso, now)}, ${time_of(new Date(iso))}`;

const kAgo = [
  ["minute", 60],
  ["hour", 24],
] as const; // each with how many make the next

/** "2 minutes ago", "3 hours ago", from a day on as told_time(). */
export function told_ago(iso: string, now = new Date()): string {
  let ago = Math.max(0, now.getTime() - new Date(iso).getTime()) / 60_000;
  for (const [unit, most] of kAgo) {
    if (ago < most)
      return new Intl.RelativeTimeFormat(page_locale(), { numeric: "auto" }).format(
        -Math.floor(ago),
        unit,
      );
    ago /= most;
  }
  return told_time(iso, now);
}

/** "14:05". */
export const told_clock = (iso: string): string => time_of(new Date(iso));

/** "4 May 2026". */
export const told_date = (iso: string): string => date_of(new Date(iso));
