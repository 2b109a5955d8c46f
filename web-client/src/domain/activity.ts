// Lines of a project's activity. This file has no user interface.

import type { Activity } from "../core/protocol.gen";

/** The loaded lines, the newest first, and the server's cursor for the next page. */
export interface ActivityLog {
  lines: readonly Activity[];
  next: string | undefined; // undefined if the log is complete
}

const isNewer = (a: Activity, b: Activity): number =>
  a.time < b.time ? 1 : a.time > b.time ? -1 : b.id - a.id;

/**
 * Merges a newer first page into the log. A line with new events has moved to the top. If no line
 * of the page is in the log, the page replaces the log.
 */
export function withFirstPage(log: ActivityLog, page: ActivityLog): ActivityLog {
  const ids = new Set(page.lines.map(({ id }) => id));
  const oldest = page.lines[page.lines.length - 1];
  const known = log.lines.filter(({ id }) => !ids.has(id));
  const meets = page.next === undefined || known.length < log.lines.length;
  if (!oldest || !meets) return page;
  return {
    lines: [...page.lines, ...known.filter((line) => isNewer(line, oldest) > 0)],
    next: log.next,
  };
}

export function withNextPage(log: ActivityLog, page: ActivityLog): ActivityLog {
  const ids = new Set(log.lines.map(({ id }) => id));
  return { lines: [...log.lines, ...page.lines.filter(({ id }) => !ids.has(id))], next: page.next };
}

/** Groups lines by day. `dayOf` returns the name of a line's day. */
export function byDay(
  lines: readonly Activity[],
  dayOf: (iso: string) => string,
): { day: string; lines: Activity[] }[] {
  const days: { day: string; lines: Activity[] }[] = [];
  for (const line of lines) {
    const day = dayOf(line.time);
    const last = days[days.length - 1];
    if (last?.day === day) last.lines.push(line);
    else days.push({ day, lines: [line] });
  }
  return days;
}
