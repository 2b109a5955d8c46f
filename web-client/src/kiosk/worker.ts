// The service worker of the kiosk page. While the server is unreachable, it responds with stored
// items. Other pages are outside its scope.

import { answered, requestedBytes, saysAway } from "./worker-rules";

interface WorkerEvent extends Event {
  waitUntil(done: Promise<unknown>): void;
}
interface WorkerFetch extends WorkerEvent {
  readonly request: Request;
  respondWith(answer: Promise<Response>): void;
}
interface WorkerScope {
  readonly registration: { scope: string };
  readonly clients: { claim(): Promise<void> };
  skipWaiting(): Promise<void>;
  addEventListener(name: "install" | "activate", listener: (event: WorkerEvent) => void): void;
  addEventListener(name: "fetch", listener: (event: WorkerFetch) => void): void;
}
const scope = globalThis as unknown as WorkerScope;

const kPatienceMs = 10_000; // long enough for images; an unreachable server may never respond

scope.addEventListener("install", (event) => event.waitUntil(scope.skipWaiting()));
scope.addEventListener("activate", (event) => event.waitUntil(scope.clients.claim()));
scope.addEventListener("fetch", (event) => {
  const { request } = event;
  const own = scope.registration.scope;
  switch (answered(request, own)) {
    case "page":
      return event.respondWith(newest(request, own)); // the page is the same for every secret
    case "file":
      return event.respondWith(stored(request.url).then((found) => found ?? fetch(request)));
    case "media":
      return event.respondWith(
        stored(request.url).then((found) => (found ? partOf(found, request) : fetch(request))),
      );
    case "data":
      return event.respondWith(newest(request, request.url));
    case "not":
  }
});

const stored = (key: string): Promise<Response | undefined> =>
  caches.match(key, { ignoreVary: true });

/** Returns the requested part of a file. Players read sounds and videos in parts. */
async function partOf(whole: Response, request: Request): Promise<Response> {
  const header = request.headers.get("Range");
  if (header === null) return whole;
  const content = await whole.blob();
  const part = requestedBytes(header, content.size);
  if (!part) return new Response(content, { headers: whole.headers });
  const headers = new Headers(whole.headers);
  headers.set("Content-Range", `bytes ${part.first}-${part.last}/${content.size}`);
  headers.set("Content-Length", String(part.last - part.first + 1));
  return new Response(content.slice(part.first, part.last + 1), { status: 206, headers });
}

/**
 * Returns the server's response, or the stored one if the server does not respond within
 * kPatienceMs.
 */
async function newest(request: Request, key: string): Promise<Response> {
  const asked = fetch(request);
  asked.catch(() => {}); // ignores a failure after the time limit
  let timer: ReturnType<typeof setTimeout> | undefined;
  const late = new Promise<null>(
    (resolve) => (timer = setTimeout(() => resolve(null), kPatienceMs)),
  );
  try {
    const answer = await Promise.race([asked, late]);
    if (answer && !saysAway(answer.status)) return answer;
    return (await stored(key)) ?? answer ?? (await asked);
  } catch (error) {
    const found = await stored(key);
    if (found) return found;
    throw error;
  } finally {
    clearTimeout(timer);
  }
}
