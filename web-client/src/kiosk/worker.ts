// The service worker of the kiosks' page: while the server is away it answers with what the page
// has stored. It has no say over any other page.

import { answered, saysAway } from "./worker-rules";

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

const kPatienceMs = 10_000; // a picture takes a moment; a server that is away takes for ever

scope.addEventListener("install", (event) => event.waitUntil(scope.skipWaiting()));
scope.addEventListener("activate", (event) => event.waitUntil(scope.clients.claim()));
scope.addEventListener("fetch", (event) => {
  const { request } = event;
  const own = scope.registration.scope;
  switch (answered(request, own)) {
    case "page":
      return event.respondWith(newest(request, own)); // one page, whatever the secret
    case "file":
      return event.respondWith(stored(request.url).then((found) => found ?? fetch(request)));
    case "data":
      return event.respondWith(newest(request, request.url));
    case "not":
  }
});

const stored = (key: string): Promise<Response | undefined> =>
  caches.match(key, { ignoreVary: true });

/** The server's, or what is stored where it has none within a moment. */
async function newest(request: Request, key: string): Promise<Response> {
  const asked = fetch(request);
  asked.catch(() => {}); // it may fail after the moment, when nobody waits for it any more
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
