// The kiosk's storage in its browser. It contains the page's files, the last response about the
// tour, and all contents of the stops. So the tour continues while the server is unreachable.
// Browsers do not provide this storage for addresses without TLS, except localhost.

import { Api, type Fetch } from "../net/api";
import { ApiError } from "../net/api-error";
import type { KioskSelf, TourFile } from "../core/protocol.gen";
import { asKiosk, patientFetch, pictureOfView } from "./as-kiosk";
import { cardOf } from "./cards";
import { addressOfFile, thumbnailOfFile } from "./media";

/** The parts of the browser's CacheStorage and Cache that the kiosk uses. */
export interface KioskCache {
  match(key: string): Promise<Response | undefined>;
  put(key: string, response: Response): Promise<void>;
  delete(key: string): Promise<unknown>;
  /** Returns the stored paths with their queries. */
  keys(): Promise<string[]>;
}

export interface StoreOptions {
  openCache: () => Promise<KioskCache | null>;
  secret: string;
  fetch?: Fetch;
  /** Returns the loaded files of the page. */
  files?: () => string[];
}

const kCache = "strata-kiosk";
/**
 * The key of the stored page, which is the same for every secret. It is also the scope of the
 * worker.
 */
const kPageKey = "/kiosk/";
// limit for stored sounds and videos; further ones need the server
const kMediaBytes = 400 * 2 ** 20;
const kSlowBytesPerMs = 200;
const kFilePatienceMs = 30_000;
const kAgainMs = 6 * 3600_000; // records may change without a new version of the tour

export class KioskStore {
  private _kept = ""; // the last state that was stored completely
  private _keptMs = 0;
  private _keeping = false;

  constructor(private readonly _options: StoreOptions) {}

  /**
   * Returns the last response of the server for this link. Returns null if none is stored, or if
   * the link has expired.
   */
  async lastTold(now: Date = new Date()): Promise<KioskSelf | null> {
    const found = await (await this._options.openCache())?.match(await this.selfKey());
    if (!found) return null;
    const self = (await found.json()) as KioskSelf;
    return self.expires && new Date(self.expires) <= now ? null : self;
  }

  /** Deletes all stored items, after the link became invalid. */
  async forget(): Promise<void> {
    this._kept = "";
    const cache = await this._options.openCache();
    for (const key of (await cache?.keys()) ?? []) await cache?.delete(key);
  }

  /**
   * Stores the tour with all its contents, one item after the other, and deletes items of earlier
   * versions. The tour is stored again if `state` differs from the last stored state. The next call
   * retries failed items.
   */
  async keep(self: KioskSelf, state: string): Promise<void> {
    const nowMs = performance.now();
    if (this._keeping || (state === this._kept && nowMs - this._keptMs < kAgainMs)) return;
    this._keeping = true;
    try {
      const cache = await this._options.openCache();
      if (cache && (await this.keepOn(cache, self))) {
        this._kept = state;
        this._keptMs = nowMs;
      }
    } finally {
      this._keeping = false;
    }
  }

  private async keepOn(cache: KioskCache, self: KioskSelf): Promise<boolean> {
    const kept = new Set<string>();
    let complete = true;
    const put = async (key: string, ask: () => Promise<Response>): Promise<void> => {
      if (kept.has(key)) return;
      try {
        const response = await ask();
        if (!response.ok) complete &&= response.status < 500;
        else {
          await cache.put(key, response);
          kept.add(key);
        }
      } catch {
        complete = false;
      }
    };
    const get = this._options.fetch ?? patientFetch;
    await put(await this.selfKey(), async () => new Response(JSON.stringify(self)));
    await put(kPageKey, () => get(kPageKey));
    for (const file of (this._options.files ?? filesOfPage)()) await put(file, () => get(file));
    const putFile = async (key: string, bytes: number): Promise<void> => {
      if (await cache.match(key))
        kept.add(key); // the content of a file with this id never changes
      else
        await put(key, () =>
          this._options.fetch
            ? this._options.fetch(key)
            : fetch(key, {
                signal: AbortSignal.timeout(kFilePatienceMs + bytes / kSlowBytesPerMs),
              }),
        );
    };
    try {
      await keepTour(self, get, put);
      await keepFiles(self, putFile);
    } catch {
      complete = false;
    }
    if (complete) for (const key of await cache.keys()) if (!kept.has(key)) await cache.delete(key);
    return complete;
  }

  /** Returns a key with a digest of the secret, so the storage does not reveal the secret. */
  private async selfKey(): Promise<string> {
    const digest = await crypto.subtle.digest(
      "SHA-256",
      new TextEncoder().encode(this._options.secret),
    );
    return `/kiosk/told/${[...new Uint8Array(digest)].map((byte) => byte.toString(16).padStart(2, "0")).join("")}`;
  }
}

type Put = (key: string, ask: () => Promise<Response>) => Promise<void>;

/** Requests all items that visitors can open at the stops, and stores the responses. */
async function keepTour({ model, tour }: KioskSelf, get: Fetch, put: Put): Promise<void> {
  const api = new Api(async (address, init) => {
    const response = await get(asKiosk(address), init);
    const copy = response.clone();
    await put(asKiosk(address), async () => copy);
    return response;
  });
  const picture = (address: string): Promise<void> => put(address, () => get(address));
  for (const view of new Set(tour.stops.flatMap((stop) => stop.view ?? []))) {
    await unlessGone(api.json("GET /models/{model}/views/{view}", { path: { model, view } }));
    await picture(pictureOfView(model, view));
  }
  for (const stop of tour.stops)
    for (const { table, keys } of stop.records)
      for (const key of keys) {
        const card = await cardOf(api, {
          table,
          key,
          stop,
          language: tour.languages[0]!,
          languages: tour.languages,
        });
        for (const { small, large } of card?.pictures ?? []) {
          await picture(small);
          await picture(large);
        }
      }
}

/**
 * Stores images and subtitles, then as many sounds and videos as the limit permits, in their order.
 */
async function keepFiles(
  self: KioskSelf,
  put: (key: string, bytes: number) => Promise<void>,
): Promise<void> {
  let left = kMediaBytes;
  const files = self.tour.files ?? [];
  const plays = ({ kind }: TourFile): boolean => kind === "sound" || kind === "video";
  for (const file of files.filter((each) => !plays(each))) {
    await put(addressOfFile(self, file.id), file.bytes);
    if (file.kind === "picture") await put(thumbnailOfFile(self, file.id), file.bytes);
  }
  for (const file of files.filter(plays))
    if (file.bytes <= left) {
      left -= file.bytes;
      await put(addressOfFile(self, file.id), file.bytes);
    }
}

async function unlessGone(asked: Promise<unknown>): Promise<void> {
  try {
    await asked;
  } catch (error) {
    if (!(error instanceof ApiError) || error.status !== 404) throw error;
  }
}

/** Returns the loaded files with immutable names, and the icon. */
function filesOfPage(): string[] {
  const loaded = performance.getEntriesByType("resource").map(({ name }) => new URL(name));
  const own = loaded.filter(
    ({ origin, pathname }) => origin === location.origin && pathname.startsWith("/assets/"),
  );
  return [...new Set([...own.map(({ pathname }) => pathname), "/favicon.svg"])];
}

export async function openBrowserCache(): Promise<KioskCache | null> {
  if (!("caches" in globalThis) || !("subtle" in crypto)) return null;
  const cache = await caches.open(kCache);
  return {
    match: (key) => cache.match(key, { ignoreVary: true }),
    put: (key, response) => cache.put(key, response),
    delete: (key) => cache.delete(key, { ignoreVary: true }),
    keys: async () =>
      (await cache.keys())
        .map(({ url }) => new URL(url))
        .map(({ pathname, search }) => pathname + search),
  };
}

/** Starts the worker that serves stored items. Without it, the page works until it is reloaded. */
export async function startWorker(): Promise<void> {
  try {
    await navigator.serviceWorker?.register("/kiosk-worker.js", { scope: kPageKey });
  } catch (error) {
    // The browser does not support workers, or workers are disabled.
    console.info("no service worker:", String(error));
  }
}
