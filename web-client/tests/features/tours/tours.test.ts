import fc from "fast-check";
import { describe, expect, it } from "vitest";

import { toldAgo } from "../../../src/domain/times";
import { Tours } from "../../../src/features/tours/tours";
import { Api } from "../../../src/net/api";
import { ApiError } from "../../../src/net/api-error";
import { kSilentMs, stateOfKiosk } from "../../../src/domain/kiosks";
import type { Tour, TourEntry } from "../../../src/core/protocol.gen";
import {
  bodyOf,
  differs,
  draftOf,
  emptyTour,
  isAbout,
  languageOfField,
  moved,
  newStop,
  placeOf,
  problemOf,
  untranslated,
  withoutLanguage,
  writesIn,
} from "../../../src/domain/tours";
import type { TourDraft } from "../../../src/domain/tours";

const stop = (more: Partial<Tour["stops"][number]> = {}): Tour["stops"][number] => ({
  view: "west",
  title: { en: "The west" },
  text: {},
  attract_s: 10,
  transition: "move",
  transition_s: 2,
  layers: [],
  records: [],
  ...more,
});
const tour = (more: Partial<Tour> = {}): Tour => ({
  id: 3,
  slug: "round",
  name: "Round",
  text: "",
  languages: ["en", "es"],
  idle_s: 60,
  stops: [stop()],
  user: "ada",
  time: "2026-05-04T12:00:00.000Z",
  version: 1,
  ...more,
});
const draft = (more: Partial<Tour> = {}): TourDraft => draftOf(tour(more));

describe("what is moved", () => {
  it("stands where it was wanted, and the others keep their order", () => {
    const all = fc.uniqueArray(fc.integer(), { minLength: 1, maxLength: 12 });
    fc.assert(
      fc.property(all, fc.nat(11), fc.nat(11), (things, a, b) => {
        const [from, to] = [a % things.length, b % things.length];
        const result = moved(things, from, to);
        expect(result[to]).toBe(things[from]);
        expect(result.filter((each) => each !== things[from])).toEqual(
          things.filter((each) => each !== things[from]),
        );
      }),
    );
    expect(moved([1, 2, 3], 0, 9)).toEqual([2, 3, 1]);
    expect(moved([1, 2, 3], 2, -4)).toEqual([3, 1, 2]);
  });
});

describe("a tour that is written", () => {
  it("says what was read, where nothing is changed", () => {
    const full = tour({
      text: "Of the pot.",
      stops: [
        stop({ text: { en: "Broken." }, transition: "cut", layers: ["cracks", "salts"] }),
        stop({
          view: "east",
          attract_s: 12.5,
          records: [
            {
              table: "pieces",
              keys: [2, 1],
              columns: [{ column: "name" }, { column: "state", labels: { es: "Estado" } }],
            },
          ],
        }),
      ],
    });
    const { name, text, languages, idle_s: idleS, stops } = full;
    expect(bodyOf(draftOf(full))).toEqual({
      name,
      text,
      languages,
      idle_s: idleS,
      stops: stops.map((each) => ({ ...each, media: [] })),
      theme: {},
      classes: [],
    });
    expect(differs(draftOf(full), draftOf(full))).toBe(false);
  });

  it("differs by what it says, not by blanks", () => {
    const before = draft();
    const written = (title: Record<string, string>): TourDraft => ({
      ...before,
      stops: [{ ...before.stops[0]!, title }],
    });
    expect(differs(before, { ...before, name: " Round " })).toBe(false);
    expect(differs(before, written({ es: " ", en: "The west" }))).toBe(false);
    expect(differs(before, written({ en: "The west", es: "El oeste" }))).toBe(true);
    expect(differs(before, { ...before, idle_s: "soon" })).toBe(true);
    expect(differs(before, { ...before, stops: [] })).toBe(true);
  });

  it("begins with a language, and stops with what their views are called", () => {
    const made = {
      ...emptyTour("de"),
      name: "Rundgang",
      stops: [newStop({ slug: "west", name: "Westwand", text: "" }, "de")],
    };
    expect(problemOf(made)).toBeNull();
    expect(bodyOf(made).stops[0]).toMatchObject({
      view: "west",
      title: { de: "Westwand" },
      text: {},
      attract_s: 10,
      transition: "move",
      transition_s: 2,
    });
  });

  it("sends no words that are blank, and the seconds of a cut only where they are some", () => {
    const [first] = draft().stops;
    const sent = bodyOf({
      ...draft(),
      stops: [
        { ...first!, title: { en: " The west ", es: "  " }, transition: "cut", transition_s: "x" },
      ],
    }).stops[0]!;
    expect(sent.title).toEqual({ en: "The west" });
    expect("transition_s" in sent).toBe(false);
  });
});

describe("what is wrong with a tour", () => {
  const ofStop = (more: object): TourDraft => ({
    ...draft(),
    stops: [draft().stops[0]!, { ...draft().stops[0]!, ...more }],
  });
  const cases: [string, TourDraft, string, string][] = [
    ["no name", { ...draft(), name: " " }, "name", "name_missing"],
    ["no language", { ...draft(), languages: [] }, "languages", "language_missing"],
    ["no stop", { ...draft(), stops: [] }, "stops", "stops_missing"],
    ["too short a rest", { ...draft(), idle_s: "29" }, "idle_s", "seconds"],
    ["a rest that is not whole", { ...draft(), idle_s: "60.5" }, "idle_s", "seconds"],
    ["a view that is gone", ofStop({ view: "" }), "stops[1].view", "view_missing"],
    [
      "no title in the first language",
      ofStop({ title: { es: "El oeste" } }),
      "stops[1].title.en",
      "title_missing",
    ],
    ["no number", ofStop({ attract_s: "a while" }), "stops[1].attract_s", "seconds"],
    ["too long a flight", ofStop({ transition_s: "31" }), "stops[1].transition_s", "seconds"],
  ];
  it.each(cases)("is told at its field: %s", (_, wrong, field, what) =>
    expect(problemOf(wrong)).toMatchObject({ field, wrong: what }),
  );

  it("is not how long a cut takes", () =>
    expect(problemOf(ofStop({ transition: "cut", transition_s: "" }))).toBeNull());
  it("is a stop of the server whose view is gone", () => {
    const { view: _, ...gone } = stop();
    expect(problemOf(draft({ stops: [gone] }))).toMatchObject({ field: "stops[0].view" });
  });
});

describe("languages of a tour", () => {
  it("are told to be incomplete where a title is missing, or a text that the first one has", () => {
    const of = (title: Record<string, string>, text: Record<string, string> = {}): string[] =>
      untranslated({ ...draft().stops[0]!, title, text }, ["en", "es", "fr"]);
    expect(of({ en: "West", es: "Oeste", fr: "Ouest" })).toEqual([]);
    expect(of({ en: "West", es: " " })).toEqual(["es", "fr"]);
    expect(of({ en: "West", es: "Oeste", fr: "Ouest" }, { en: "Broken.", fr: "Brisé." })).toEqual([
      "es",
    ]);
  });

  it("take along all that was written in them", () => {
    const records = [
      {
        table: "pieces",
        keys: [],
        columns: [{ column: "state", labels: { en: "State", es: "Estado" } }],
      },
    ];
    const before = draft({
      stops: [stop({ title: { en: "West", es: "Oeste" }, text: { es: "Roto." }, records })],
    });
    expect(writesIn(before, "es")).toBe(true);
    const after = withoutLanguage(before, "es");
    expect(writesIn(after, "es")).toBe(false);
    expect([after.languages, JSON.stringify(bodyOf(after)).includes('"es"')]).toEqual([
      ["en"],
      false,
    ]);
    expect(bodyOf(after).stops[0]!.records![0]!.columns).toEqual([
      { column: "state", labels: { en: "State" } },
    ]);
  });
});

describe("a refusal of the server", () => {
  it("is about a field of a stop, or of the tour", () => {
    expect(placeOf("stops[12].title.fr")).toEqual({ stop: 12, within: "title.fr" });
    expect(placeOf("stops[0]")).toEqual({ stop: 0, within: "" });
    expect(placeOf("languages[1]")).toEqual({ stop: null, within: "languages[1]" });
    expect([
      isAbout("layers[2]", "layers"),
      isAbout("title.fr", "title"),
      isAbout("text", "text"),
      isAbout("text_more", "text"),
    ]).toEqual([true, true, true, false]);
    expect(
      [
        "title.fr",
        "text.pt-BR",
        "records[0].columns[1].labels.es",
        "attract_s",
        "records[0].table",
        "title",
      ].map(languageOfField),
    ).toEqual(["fr", "pt-BR", "es", null, null, null]);
  });
});

describe("the tours of a model", () => {
  const entry = (more: Partial<TourEntry> = {}): TourEntry => {
    const { stops: _, idle_s: __, ...rest } = tour();
    return { ...rest, stop_count: 1, ...more };
  };
  const madeOf = (
    answer: (method: string, path: string, init: RequestInit) => [number, unknown],
  ): { tours: Tours; told: () => number } => {
    let told = 0;
    const api = new Api(async (path, init) => {
      const [status, body] = answer(init!.method!, path.replace("/api/v1/models/1", ""), init!);
      return new Response(status === 204 ? null : JSON.stringify(body), { status });
    });
    return { tours: new Tours(api, "1", () => (told += 1)), told: () => told };
  };

  it("are read, changed with the version that was read, and deleted", async () => {
    const asked: string[] = [];
    const { tours } = madeOf((method, path, { headers }) => {
      asked.push(
        `${method} ${path} ${(headers as Record<string, string>)["If-Match"] ?? ""}`.trim(),
      );
      if (method === "DELETE") return [204, null];
      return method === "GET"
        ? [200, { tours: [entry()], total: 1 }]
        : [200, tour({ name: "Again", version: 2, stops: [stop(), stop()] })];
    });
    await tours.load();
    expect(tours.all).toEqual([entry()]);
    await tours.change(tour(), bodyOf(draft()));
    expect(tours.all).toEqual([entry({ name: "Again", version: 2, stop_count: 2 })]);
    await tours.remove(tours.all[0]!);
    expect(tours.all).toEqual([]);
    expect(asked).toEqual(["GET /tours?limit=1000", 'PATCH /tours/3 "v1"', 'DELETE /tours/3 "v2"']);
  });

  it("are read again where somebody changed one that was to be deleted, and are gone where it is", async () => {
    let [status, version] = [412, 2];
    const { tours } = madeOf((method) =>
      method === "DELETE"
        ? [status, { title: "No" }]
        : [200, { tours: [entry({ version })], total: 1 }],
    );
    await tours.load();
    version = 3;
    await expect(tours.remove(tours.all[0]!)).rejects.toThrow(ApiError);
    expect(tours.all[0]!.version).toBe(3);
    status = 404;
    await tours.remove(tours.all[0]!);
    expect(tours.all).toEqual([]);
  });

  it("are said to have failed, and are none then", async () => {
    const { tours, told } = madeOf(() => [500, { title: "No" }]);
    await tours.load();
    expect([tours.failed, tours.loaded, tours.all, told()]).toEqual([true, false, [], 1]);
  });
});

describe("a kiosk's link", () => {
  const now = new Date("2026-05-04T12:00:00Z");
  const ago = (ms: number): string => new Date(now.getTime() - ms).toISOString();
  it("is told to be what it is", () => {
    expect(stateOfKiosk({}, now)).toBe("unopened");
    expect(stateOfKiosk({ last_seen: ago(kSilentMs) }, now)).toBe("running");
    expect(stateOfKiosk({ last_seen: ago(kSilentMs + 1) }, now)).toBe("silent");
    expect(stateOfKiosk({ last_seen: ago(0), expires: ago(0) }, now)).toBe("expired");
    expect(stateOfKiosk({ expires: ago(-1) }, now)).toBe("unopened");
    expect(stateOfKiosk({ revoked: ago(5), expires: ago(9), last_seen: ago(0) }, now)).toBe(
      "revoked",
    );
  });

  it("was seen so long ago, in words", () => {
    expect(toldAgo(ago(30_000), now)).toBe("this minute");
    expect(toldAgo(ago(-30_000), now)).toBe("this minute"); // the kiosk's clock may differ
    expect(toldAgo(ago(5 * 60_000), now)).toBe("5 minutes ago");
    expect(toldAgo(ago(3 * 3_600_000), now)).toBe("3 hours ago");
    expect(toldAgo(ago(50 * 3_600_000), now)).toMatch(/^2 May 2026, /);
  });

  it("is asked for without a key by which the server would keep the answer", async () => {
    let keys: (string | undefined)[] = [];
    const api = new Api(async (_, init) => {
      keys = [...keys, (init!.headers as Record<string, string>)["Idempotency-Key"]];
      return new Response("{}", { status: 201 });
    });
    await api.json("POST /models/{model}/tours/{tour}/kiosks", {
      path: { model: "pot", tour: "round" },
      body: { name: "Hall" },
    });
    await api.json("POST /kiosks/{kiosk}/reload", { path: { kiosk: 3 } });
    expect([keys[0], typeof keys[1]]).toEqual([undefined, "string"]);
  });
});
