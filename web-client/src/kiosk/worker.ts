// The service worker of the kiosk page: while the server is unreachable, it answers with stored
// items. Other pages are out of its scope.

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

const kPatienceMs = 10_000; // pictures need a moment; an unreachable server never answers

scope.addEventListener("install", (event) => event.waitUntil(scope.skipWaiting()));
scope.addEventListener("activate", (event) => event.waitUntil(scope.clients.claim()));
scope.addEventListener("fetch", (event) => {
  const { request } = event;
  const own = scope.registration.scope;
  switch (answered(request, own)) {
    case "page":
      return event.respondWith(newest(request, own)); // the same page for every secret
    case "file":
      return event.respondWith(stored(request.url).then((found) => found ?? fetch(request)));
    case "data":
      return event.respondWith(newest(request, request.url));
    case "not":
  }
});

const stored = (key: string): Promise<Response | undefined> =>
  caches.match(key, { ignoreVary: true });

/** The server's answer, or the stored one if the server does not answer within kPatienceMs. */
async function newest(request: Request, key: string): Promise<Response> {
  const asked = fetch(request);
  asked.catch(() => {}); // a failure after the time limit is ignored
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
