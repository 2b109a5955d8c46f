import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { Api } from "../../src/net/api";
import { between, OrbitCamera, placeOf } from "../../src/math/camera";
import type { Column, Table, TourStop, View } from "../../src/core/protocol.gen";
import type { Layer } from "../../src/core/types";
import { asKiosk } from "../../src/kiosk/as-kiosk";
import { AttractLoop } from "../../src/kiosk/attract";
import { cardOf } from "../../src/kiosk/cards";
import { IdleWatch, kAskedS } from "../../src/kiosk/idle";
import { directionOfLanguage, wordsIn } from "../../src/kiosk/languages";
import {
  choicesOf,
  firstChoice,
  layersShown,
  seenLayers,
  stepFrom,
  stopsOf,
  type Stop,
} from "../../src/kiosk/stops";
import { textsIn } from "../../src/kiosk/texts";
import { phoneAddress, phonePlaceOf } from "../../src/kiosk/phone";
import { answered, requestedBytes, saysAway } from "../../src/kiosk/worker-rules";

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe("who stands before the kiosk", () => {
  const watch = (idleS = 60) => {
    const host = { idleS: () => idleS, came: vi.fn(), left: vi.fn(), changed: vi.fn() };
    return { host, idle: new IdleWatch(host) };
  };

  it("is asked after the time without a touch, counted down, and gone when nobody answers", () => {
    const { host, idle } = watch();
    expect(idle.presence).toEqual({ is: "alone" });
    idle.touched();
    expect(host.came).toHaveBeenCalledTimes(1);
    vi.advanceTimersByTime(59_000);
    expect(idle.presence).toEqual({ is: "visited" });
    vi.advanceTimersByTime(1_100);
    expect(idle.presence).toEqual({ is: "asked", leftS: kAskedS });
    for (let left = kAskedS - 1; left > 0; --left) {
      vi.advanceTimersByTime(1000);
      expect(idle.presence).toEqual({ is: "asked", leftS: left });
    }
    expect(host.left).not.toHaveBeenCalled();
    vi.advanceTimersByTime(1000);
    expect(idle.presence).toEqual({ is: "alone" });
    expect(host.left).toHaveBeenCalledTimes(1);
    expect(vi.getTimerCount()).toBe(0);
  });

  it("stays as long as there are touches, by one timer however many they are", () => {
    const { host, idle } = watch();
    for (let second = 0; second < 600; ++second) {
      for (let touch = 0; touch < 20; ++touch) idle.touched();
      expect(vi.getTimerCount()).toBe(1);
      vi.advanceTimersByTime(1000);
    }
    expect(idle.presence).toEqual({ is: "visited" });
    expect(host.came).toHaveBeenCalledTimes(1);
    vi.advanceTimersByTime(59_500);
    expect(idle.presence.is).toBe("asked");
  });

  it("is still there who says so, and the whole time begins anew", () => {
    const { host, idle } = watch();
    idle.touched();
    vi.advanceTimersByTime(65_000);
    expect(idle.presence.is).toBe("asked");
    idle.touched();
    expect(idle.presence).toEqual({ is: "visited" });
    vi.advanceTimersByTime(59_000);
    expect(idle.presence).toEqual({ is: "visited" });
    expect([host.came.mock.calls.length, host.left.mock.calls.length]).toEqual([1, 0]);
  });

  it("has half a minute at least, and a stopped watch has no timer", () => {
    const { idle } = watch(1);
    idle.touched();
    vi.advanceTimersByTime(29_000);
    expect(idle.presence).toEqual({ is: "visited" });
    idle.stop();
    expect(vi.getTimerCount()).toBe(0);
  });
});

describe("the tour that plays by itself", () => {
  it("shows each stop for its time after the way there, for ever, by one timer", () => {
    const times = [
      { transition_s: 2, attract_s: 10 },
      { transition_s: 0, attract_s: 5 },
    ];
    let at = 0;
    const loop = new AttractLoop({ times: () => times[at]!, next: () => void (at = (at + 1) % 2) });
    loop.start();
    const shown: number[] = [];
    for (let second = 0; second < 34; ++second) {
      shown.push(at);
      vi.advanceTimersByTime(1000);
    }
    expect(shown).toEqual(
      [0, 1, 0, 1].flatMap((stop) => Array<number>(stop === 0 ? 12 : 5).fill(stop)),
    );
    expect(vi.getTimerCount()).toBe(1);
    loop.stop();
    expect([vi.getTimerCount(), loop.playing]).toEqual([0, false]);
  });

  it("does not spin where there is nothing to show, and ends when the next stop ends it", () => {
    const next = vi.fn();
    const loop = new AttractLoop({ times: () => null, next });
    loop.start();
    vi.advanceTimersByTime(10_000);
    expect(next.mock.calls.length).toBeLessThanOrEqual(10);
    next.mockImplementation(() => loop.stop());
    vi.advanceTimersByTime(10_000);
    expect(vi.getTimerCount()).toBe(0);
  });
});

describe("the way between two stops", () => {
  it("turns the shorter way round, comes nearer by a constant factor, and arrives", () => {
    const [from, to] = [new OrbitCamera(), new OrbitCamera()];
    Object.assign(from, { azimuth: 3, distance: 1 });
    Object.assign(to, { azimuth: -3, distance: 100 });
    const middle = between(placeOf(from), placeOf(to), 0.5);
    expect(Math.abs(middle.azimuth)).toBeCloseTo(Math.PI, 6);
    expect(middle.distance).toBeCloseTo(10, 6);
    expect(between(placeOf(from), placeOf(to), 1).distance).toBeCloseTo(100, 6);
  });
});

describe("the languages of a tour", () => {
  it("fall back to the tour's own order, not to another one", () => {
    const words = { de: "Topf", es: "Vasija" };
    expect(wordsIn(words, "es", ["en", "de", "es"])).toBe("Vasija");
    expect(wordsIn(words, "en", ["en", "de", "es"])).toBe("Topf");
    expect(wordsIn({}, "en", ["en"])).toBe("");
    expect(wordsIn(undefined, "en", ["en"])).toBe("");
  });

  it("have buttons in a language that the page is written in", () => {
    expect(textsIn("es", ["en", "es"]).next).toBe("Siguiente");
    expect(textsIn("de-CH", ["de-CH"]).next).toBe("Weiter");
    expect(textsIn("fr", ["de", "fr"]).next).toBe("Weiter");
    expect(textsIn("fr", ["fr"]).next).toBe("Next");
    expect([directionOfLanguage("ar-EG"), directionOfLanguage("de")]).toEqual(["rtl", "ltr"]);
  });
});

const layer = (id: number, slug: string, visible: boolean, order = id): Layer =>
  ({
    id,
    slug,
    name: slug,
    visible,
    order,
    palette: { min: 0, max: 1, points: [] },
  }) as unknown as Layer;
const view = (id: number, slug: string, layers: View["layers"] = []): View =>
  ({ id, slug, name: slug, layers, light: { mode: "museum" }, version: 1 }) as unknown as View;
const tourStop = (change: Partial<TourStop>): TourStop => ({
  title: { en: "A" },
  text: {},
  attract_s: 10,
  transition: "move",
  transition_s: 2,
  layers: [],
  records: [],
  ...change,
});

describe("the stops", () => {
  const layers = [layer(1, "cracks", true), layer(2, "sherds", false), layer(3, "moisture", false)];
  const stop = (slugs: string[], shown: View["layers"]): Stop => ({
    stop: tourStop({ layers: slugs }),
    view: view(1, "a", shown),
  });

  it("without a view are passed over", () => {
    const tour = {
      stops: [
        tourStop({ view: "a" }),
        tourStop({}),
        tourStop({ view: "gone" }),
        tourStop({ view: "b" }),
      ],
    };
    const found = stopsOf(
      tour,
      new Map([
        ["a", view(1, "a")],
        ["b", view(2, "b")],
      ]),
    );
    expect(found.map(({ view: { slug } }) => slug)).toEqual(["a", "b"]);
    expect([stepFrom(1, 1, 2), stepFrom(0, -1, 2), stepFrom(0, 1, 1)]).toEqual([0, 1, 0]);
  });

  it("offer their layers; where the view shows one of them, that is the first choice", () => {
    const one = stop(
      ["sherds", "cracks"],
      [
        { layer: 2, visible: true },
        { layer: 1, visible: false },
      ],
    );
    expect(choicesOf(one, layers).map((each) => each?.slug)).toEqual(["sherds", "cracks"]);
    expect(firstChoice(one, choicesOf(one, layers))?.slug).toBe("sherds");
    const both = stop(["sherds", "cracks"], [{ layer: 2, visible: true }]);
    expect(choicesOf(both, layers).map((each) => each?.slug)).toEqual([
      undefined,
      "sherds",
      "cracks",
    ]);
    expect(firstChoice(both, choicesOf(both, layers))).toBeNull();
    expect(choicesOf(stop([], []), layers)).toEqual([]);
    expect(choicesOf(stop(["gone"], []), layers)).toEqual([]);
  });

  it("show of these layers the chosen one, and the others as the view has them", () => {
    const both = stop(
      ["sherds", "cracks"],
      [
        { layer: 2, visible: true, opacity: 0.5 },
        { layer: 3, visible: true },
        { layer: 9, visible: true },
      ],
    );
    const choices = choicesOf(both, layers);
    expect(layersShown(both, layers, choices, null)).toEqual([
      { layer: 2, visible: true, opacity: 0.5 },
      { layer: 3, visible: true },
    ]);
    const shown = layersShown(both, layers, choices, layers[0]!);
    expect(shown).toContainEqual({ layer: 2, visible: false, opacity: 0.5 });
    expect(shown).toContainEqual({ layer: 1, visible: true });
    expect(seenLayers(layers, shown).map(({ slug }) => slug)).toEqual(["moisture", "cracks"]);
  });
});

describe("the card of a record", () => {
  const column = (slug: string, kind: string, more: Partial<Column> = {}): Column =>
    ({
      id: 1,
      slug,
      name: slug.toUpperCase(),
      kind,
      labels: {},
      required: false,
      unique: false,
      comment: "",
      order: 0,
      visibility: "public",
      ...more,
    }) as Column;
  const sherds = {
    id: 7,
    slug: "sherds",
    kind: "records",
    labels: {},
    name: "Sherds",
    columns: [
      column("name", "text"),
      column("depth", "numeric", { unit: "m", labels: { de: "Tiefe" } }),
      column("damage", "term", { target: 8 }),
      column("wet", "boolean"),
      column("photo", "picture"),
      column("line", "line"),
    ],
  } as unknown as Table;
  const damage = {
    id: 8,
    slug: "damage",
    kind: "terms",
    labels: {},
    name: "Damage",
    columns: [column("label", "text"), column("label-de", "text")],
  } as unknown as Table;
  const answers: Record<string, unknown> = {
    "/api/v1/tables/sherds": sherds,
    "/api/v1/tables/7": sherds,
    "/api/v1/tables/7/records/3": {
      key: 3,
      version: 1,
      values: { name: "Sherd 3", depth: 1.5, damage: 2, wet: true, photo: [5, 6, 9], line: [] },
    },
    "/api/v1/tables/7/records/3/attachments": {
      attachments: [
        { id: 6, name: "b.jpg", media_type: "image/jpeg" },
        { id: 5, name: "a.pdf", media_type: "application/pdf" },
      ],
      total: 2,
    },
    "/api/v1/tables/8": damage,
    "/api/v1/tables/8/records/2": {
      key: 2,
      version: 1,
      values: { label: "Loss", "label-de": "Verlust" },
    },
  };
  const api = new Api(
    async (address) =>
      new Response(JSON.stringify(answers[address] ?? { title: "Not found", status: 404 }), {
        status: address in answers ? 200 : 404,
      }),
  );
  const languages = ["en", "de"];

  it("tells what the tour chose, in the visitor's language where there are words", async () => {
    const stop = tourStop({
      records: [
        {
          table: "sherds",
          keys: [3],
          columns: [
            { column: "depth" },
            { column: "damage", labels: { en: "What is wrong" } },
            { column: "gone" },
            { column: "photo" },
          ],
        },
      ],
    });
    const card = await cardOf(api, { table: "sherds", key: 3, stop, language: "de", languages });
    expect(card).toMatchObject({
      title: "Sherd 3",
      lines: [
        { label: "Tiefe", text: "1.5 m" },
        { label: "What is wrong", text: "Verlust" },
      ],
    });
    // browsers cannot display the other picture, and its link would leave the page
    expect(card?.pictures.map(({ name }) => name)).toEqual(["b.jpg"]);
    expect(card?.pictures[0]?.small).toBe("/api/v1/attachments/6?thumbnail=256&as=kiosk");
  });

  it("tells all of a table of which nothing was chosen, but not its heading again", async () => {
    const card = await cardOf(api, {
      table: "7",
      key: 3,
      stop: tourStop({}),
      language: "en",
      languages,
    });
    expect(card?.lines).toEqual([
      { label: "DEPTH", text: "1.5 m" },
      { label: "DAMAGE", text: "Loss" },
      { label: "WET", text: "yes" },
    ]);
  });

  it("is none where there is no such record", async () => {
    expect(
      await cardOf(api, { table: "7", key: 4, stop: tourStop({}), language: "en", languages }),
    ).toBeNull();
  });
});

describe("the kiosk's service worker", () => {
  const own = "https://strata.example/kiosk/";
  const ask = (path: string, more: { method?: string; mode?: string } = {}) =>
    answered({ method: "GET", mode: "cors", url: new URL(path, own).href, ...more }, own);

  it("answers for the page of kiosks, its files and what it reads, and for nothing else", () => {
    expect(ask("/kiosk/SECRET", { mode: "navigate" })).toBe("page");
    expect(ask("/models/pot", { mode: "navigate" })).toBe("not");
    expect([ask("/assets/main-1.js"), ask("/favicon.svg")]).toEqual(["file", "file"]);
    expect(ask(asKiosk("/api/v1/models/pot/views/west/picture"))).toBe("data");
    expect(ask(asKiosk("/api/v1/attachments/6?thumbnail=256"))).toBe("data");
    expect(ask("/api/v1/models/pot")).toBe("not");
    expect(ask(asKiosk("/api/v1/kiosk"))).toBe("not");
    expect(ask(asKiosk("/api/v1/auth/kiosk"), { method: "POST" })).toBe("not");
    expect(ask("https://elsewhere.example/assets/a.js")).toBe("not");
  });

  it("tells a server that is away from one that refuses", () => {
    expect([502, 503, 504].every(saysAway)).toBe(true);
    expect([200, 304, 401, 403, 404, 500].some(saysAway)).toBe(false);
  });
});

describe("a part of a stored sound or video", () => {
  it("is the range that a player requests", () => {
    expect(requestedBytes("bytes=4-7", 100)).toEqual({ first: 4, last: 7 });
    expect(requestedBytes("bytes=90-", 100)).toEqual({ first: 90, last: 99 });
    expect(requestedBytes("bytes=-10", 100)).toEqual({ first: 90, last: 99 });
    expect(requestedBytes("bytes=0-999", 100)).toEqual({ first: 0, last: 99 });
  });
  it("is the whole file for anything else", () => {
    for (const header of [null, "", "bytes=-", "bytes=7-4", "bytes=0-1,4-5", "lines=1-2"])
      expect(requestedBytes(header, 100)).toBeNull();
    expect(requestedBytes("bytes=100-", 100)).toBeNull();
  });
});

describe("the code for phones", () => {
  it("leads to the stop and language of the screen, without a word to the server", () => {
    const address = phoneAddress("https://strata.example", "/kiosk/abc", {
      stop: 2,
      language: "de",
    });
    expect(address).toBe("https://strata.example/kiosk/abc#stop=3&language=de");
    expect(phonePlaceOf(new URL(address).hash)).toEqual({ stop: 2, language: "de" });
    for (const hash of ["", "#", "#stop=0", "#stop=x", "#stop=1.5", "#stop=99999"])
      expect(phonePlaceOf(hash)).toBeNull();
  });
});
