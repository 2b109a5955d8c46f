// What the service worker answers in the server's place, and from where. The page puts things into
// the cache (store.ts); the worker only takes them out. Nothing of the page is imported here: a
// worker is one file, and has no part in common with it.

/**
 * page: any kiosk's address; it is the same page. file: named by its content, and never another.
 * data: as the server has it now, if it is there.
 */
export type Answered = "page" | "file" | "data" | "not";

/** `own`: the address beneath which the worker has a say: that of all kiosks. */
export function answered(
  { method, mode, url }: { method: string; mode: string; url: string },
  own: string,
): Answered {
  const { origin, pathname, searchParams } = new URL(url);
  if (method !== "GET" || origin !== new URL(own).origin) return "not";
  if (mode === "navigate") return url.startsWith(own) ? "page" : "not";
  if (pathname.startsWith("/assets/") || pathname === "/favicon.svg") return "file";
  // Whether the link is still good only the server knows.
  const isData =
    pathname.startsWith("/api/v1/") &&
    pathname !== "/api/v1/kiosk" &&
    searchParams.get("as") === "kiosk";
  return isData ? "data" : "not";
}

/** The answer is none of the server's, but of what stands before it. */
export const saysAway = (status: number): boolean =>
  status === 502 || status === 503 || status === 504;
