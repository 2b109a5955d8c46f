// The rules of the service worker: the requests that it answers in place of the server, and the
// source of each answer. The page stores items in the cache (store.ts); the worker only reads them.
// This file imports no code of the page: a worker is a single file without shared chunks.

/**
 * page: any kiosk's address; all have the same page. file: immutable, named by its content. data:
 * the server's current answer if it is reachable.
 */
export type Answered = "page" | "file" | "data" | "not";

/** `own`: the worker's scope, which is the path of all kiosks. */
export function answered(
  { method, mode, url }: { method: string; mode: string; url: string },
  own: string,
): Answered {
  const { origin, pathname, searchParams } = new URL(url);
  if (method !== "GET" || origin !== new URL(own).origin) return "not";
  if (mode === "navigate") return url.startsWith(own) ? "page" : "not";
  if (pathname.startsWith("/assets/") || pathname === "/favicon.svg") return "file";
  // Only the server can decide whether the link is valid.
  const isData =
    pathname.startsWith("/api/v1/") &&
    pathname !== "/api/v1/kiosk" &&
    searchParams.get("as") === "kiosk";
  return isData ? "data" : "not";
}

/** The answer comes from a proxy and not from the server. */
export const saysAway = (status: number): boolean =>
  status === 502 || status === 503 || status === 504;
