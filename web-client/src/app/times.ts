// Moments of the server as people say them, in the time of this browser.

const time_of = (at: Date): string => at.toLocaleTimeString("en-GB", { hour: "2-digit", minute: "2-digit" });
const date_of = (at: Date): string => at.toLocaleDateString("en-GB", { day: "numeric", month: "short", year: "numeric" });

/** "today, 14:05", "yesterday, 9:30" or "4 May 2026, 14:05". */
export function told_time(iso: string, now = new Date()): string {
  const at = new Date(iso);
  const yesterday = new Date(now.getFullYear(), now.getMonth(), now.getDate() - 1);
  const day = date_of(at) === date_of(now) ? "today" : date_of(at) === date_of(yesterday) ? "yesterday" : date_of(at);
  return `${day}, ${time_of(at)}`;
}

/** "4 May 2026". */
export const told_date = (iso: string): string => date_of(new Date(iso));
