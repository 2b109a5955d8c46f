// The rules of the service worker: the requests that it handles instead of the server, and the
// source of each response. The page stores items in the cache (store.ts), and the worker only reads
// them. This file imports no code of the page, because a worker is a single file without shared
// chunks.

/**
 * page: the address of any kiosk. All kiosks have the same page. file: an immutable file, whose
 * name depends on its content. data: the server's current response, if the server is reachable.
 * media: a file of the tour, or a part of it. Its content never changes.
 */
export type Answered = "page" | "file" | "media" | "data" | "not";

/** Classifies a request. `own` is the worker's scope, which is the path of all kiosks. */
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
  if (!isData) return "not";
  return /\/tours\/\d+\/files\/\d+$/.test(pathname) ? "media" : "data";
}

/**
 * Returns the bytes that a Range header requests of a file with `size` bytes, including the last
 * one. Returns null for the whole file, also if the header is not a single range of bytes.
 */
export function requestedBytes(
  header: string | null,
  size: number,
): { first: number; last: number } | null {
  const found = /^bytes=(\d*)-(\d*)$/.exec(header ?? "");
  if (!found || (found[1] === "" && found[2] === "")) return null;
  const [from, to] = [found[1]!, found[2]!];
  const first = from === "" ? Math.max(0, size - Number(to)) : Number(from);
  const last = from === "" || to === "" ? size - 1 : Math.min(Number(to), size - 1);
  return first <= last ? { first, last } : null;
}

/** Whether the response comes from a proxy that cannot reach the server. */
export const saysAway = (status: number): boolean =>
  status === 502 || status === 503 || status === 504;
