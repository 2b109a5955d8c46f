import fc from "fast-check";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { OpenModelSession } from "../../../src/shell/open-model-session";
import { notices, type Notice } from "../../../src/ui/notices";
import { hashOfView, viewOf } from "../../../src/ui/routes";
import { discardUnsaved } from "../../../src/session/sessions";
import { texts } from "../../../src/texts";
import { Api } from "../../../src/net/api";
import type { CameraMessage } from "../../../src/math/camera";
import { presencePalette } from "../../../src/domain/palette";
import type { Look, Plane, Role, View, Welcome } from "../../../src/core/protocol.gen";
import {
  kAxes,
  noSection,
  sectionChoice,
  sectionPlanes,
  withBoxSide,
  type SectionChoice,
} from "../../../src/math/section";
import type { Layer } from "../../../src/core/types";
import {
  layersOfView,
  layersToKeep,
  looksOfView,
  type ViewContent,
} from "../../../src/domain/views";
import { FakeSocket, welcome } from "../../fake-socket";

const words = texts.kept_views;
// A building in UTM coordinates. Doubles must resolve millimeters there.
const bounds = {
  min: [500_000, 4_100_000, 600] as [number, number, number],
  max: [500_040, 4_100_020, 612] as [number, number, number],
};
const model = {
  id: 1,
  name: "House",
  unit: "m",
  up: "z",
  scale_verified: true,
  bounds,
} as unknown as Welcome["model"];
const layer = (id: number, more: Partial<Layer> = {}): Layer => ({
  id,
  model: 1,
  name: `L${id}`,
  slug: `l${id}`,
  kind: "numeric",
  type: "u8",
  resolution: 2048,
  unit: "",
  description: "",
  labels: {},
  descriptions: {},
  palette: presencePalette("x", "#ff0000ff"),
  opacity: 1,
  visible: true,
  locked: false,
  review: false,
  visibility: "public",
  order: id,
  sequence: 0,
  ...more,
});
const look = (id: number, more: Partial<Look> = {}): Look =>
  ({
    id,
    model: 1,
    name: `Look ${id}`,
    slug: `look-${id}`,
    description: "",
    media_type: "image/png",
    visible: id === 1,
    opacity: 1,
    order: id,
    ...more,
  }) as Look;

// the range of the page's sliders
const share = fc.integer({ min: 0, max: 1000 }).map((step) => step / 1000);
const sideShares = fc
  .tuple(share, share)
  .map(([a, b]) => [Math.min(a, b) * 0.9, 0.05 + Math.max(a, b) * 0.95] as const);
const aSection: fc.Arbitrary<SectionChoice> = fc.oneof(
  fc.constant(noSection()),
  fc
    .record({ axis: fc.constantFrom(...kAxes), position: share, flipped: fc.boolean() })
    .map(({ axis, ...rest }) => ({ ...noSection(), mode: axis, ...rest })),
  fc
    .array(sideShares, { minLength: 3, maxLength: 3 })
    .map((sides) =>
      sides.reduce<SectionChoice>(
        (choice, [min, max], axis) =>
          withBoxSide(withBoxSide(choice, "max", axis, max), "min", axis, min),
        { ...noSection(), mode: "box" },
      ),
    ),
  fc.constant<SectionChoice>({
    ...noSection(),
    mode: "planes",
    planes: [
      [0.6, 0.8, 0, -3_580_012],
      [0, 0, 1, -604],
    ],
  }),
);

const settlesAt = (choice: SectionChoice): Plane[] => sectionPlanes(choice, bounds);

describe("the section of a view", () => {
  it("comes back as the cut, box or planes that it was", () => {
    fc.assert(
      fc.property(aSection, (choice) => {
        const planes = settlesAt(choice);
        const again = sectionChoice(planes, bounds);
        const expected = settlesAt(again);
        expect(expected).toHaveLength(planes.length);
        planes.forEach((plane, index) =>
          plane.forEach((part, at) =>
            expect(Math.abs(part - expected[index]![at]!)).toBeLessThan(1e-6),
          ),
        );
        if (choice.mode !== "box") expect(again.mode).toBe(choice.mode);
        // a box with one side is the same as a cut
        else expect(planes.length > 1 ? again.mode : "box").toBe("box");
      }),
    );
  });

  const kept: [string, Plane[]][] = [
    ["oblique", [[0.6, 0.8, 0, -3_580_012]]],
    ["beside the model", [[1, 0, 0, -400_000]]],
    [
      "twice across one axis, to the same side",
      [
        [1, 0, 0, -500_010],
        [1, 0, 0, -500_020],
      ],
    ],
    [
      "of which nothing is left",
      [
        [1, 0, 0, -500_030],
        [-1, 0, 0, 500_010],
      ],
    ],
    ["without a direction", [[0, 0, 0, 1]]],
  ];
  it.each(kept)("that is none of the page's (%s) stays as it is", (_, planes) => {
    const choice = sectionChoice(planes, bounds);
    expect([choice.mode, settlesAt(choice)]).toEqual(["planes", planes]);
  });

  it("is a cut, too, where the plane is written otherwise, and where the model is flat", () => {
    expect(sectionChoice([[0, 0, -2, 2 * 603]], bounds)).toEqual({
      ...noSection(),
      mode: "z",
      position: 0.25,
      flipped: false,
    });
    const flat = {
      min: bounds.min,
      max: [bounds.max[0], bounds.max[1], bounds.min[2]] as [number, number, number],
    };
    expect(sectionChoice([[0, 0, 1, -600]], flat).mode).toBe("planes");
  });
});

describe("what a view keeps", () => {
  it("says of each layer whether and how much it is seen, and palettes only where they are one's own", () => {
    const own = presencePalette("x", "#00ff00ff");
    const layers = [layer(1), layer(2, { visible: false, opacity: 0.5 })];
    const kept = layersToKeep(layers, ({ id }) =>
      id === 1 ? { palette: own, highlight: { keys: [3] } } : { palette: layers[1]!.palette },
    );
    expect(kept).toEqual([
      { layer: 1, visible: true, opacity: 1, palette: own, highlight: { keys: [3] } },
      { layer: 2, visible: false, opacity: 0.5 },
    ]);
  });

  it("means only layers and looks that are there", () => {
    expect([
      ...layersOfView({ layers: [{ layer: 1, opacity: 0.5 }, { layer: 9 }] }, [layer(1)]),
    ]).toEqual([[1, { opacity: 0.5 }]]);
    const { settings, stack } = looksOfView(
      { looks: [{ look: 2, opacity: 0.5 }, { look: 9 }, { look: 1 }] },
      [look(1), look(2), look(3)],
    );
    expect([...settings]).toEqual([
      [1, { visible: true, opacity: 1 }],
      [2, { visible: true, opacity: 0.5 }],
      [3, { visible: false }],
    ]);
    expect(stack).toEqual([2, 1]);
  });
});

describe("the address of a view", () => {
  it("is read as it is written, and others are none", () => {
    fc.assert(
      fc.property(
        fc.string({ minLength: 1, maxLength: 40 }),
        (slug) => void expect(viewOf(hashOfView(slug))).toBe(slug),
      ),
    );
    for (const hash of ["", "#view=", "#view=%E0%A4", "#comment=3", "#view=a&b"])
      expect(viewOf(hash)).toBeNull();
  });
});

// ── in a session ─────────────────────────────────────────────────────────────────────────────────

let sockets: FakeSocket[];
let answers: Map<string, [status: number, body: unknown]>; // keyed by method and path
let calls: { method: string; path: string; body: unknown; headers: Record<string, string> }[];
let session: OpenModelSession;
let told: readonly Notice[];
let unsubscribe: () => void;
let lessMotion: boolean;

const socket = (): FakeSocket => sockets[sockets.length - 1]!;
const settle = (): Promise<unknown> => vi.advanceTimersByTimeAsync(0);
const path = "/api/v1/models/1/views";
const listed = (...views: View[]): void =>
  void answers.set(`GET ${path}?limit=1000`, [200, { views, total: views.length }]);
const viewWith = (id: number, content: ViewContent, more: Partial<View> = {}): View =>
  JSON.parse(
    JSON.stringify({
      id,
      slug: `v${id}`,
      name: `V${id}`,
      text: "",
      ...content,
      user: "owner",
      time: "2026-05-04T12:00:00.000Z",
      version: 1,
      ...more,
    }),
  ) as View;

async function open(
  role: Role = "owner",
  layers = [layer(7), layer(8)],
  looks = [look(1), look(2), look(3)],
): Promise<void> {
  if (!session.model) {
    await session.open();
    session.view.setViewport(800, 600, 1);
  }
  socket().open();
  socket().receive({ ...welcome(), role, model, layers, looks });
  await settle();
}

beforeEach(() => {
  vi.useFakeTimers();
  lessMotion = true;
  vi.stubGlobal("window", { location: { protocol: "http:", host: "here" }, devicePixelRatio: 1 });
  vi.stubGlobal("location", { origin: "http://here" });
  vi.stubGlobal("matchMedia", () => ({ matches: lessMotion }));
  vi.stubGlobal("requestAnimationFrame", (callback: () => void) => setTimeout(callback, 16));
  vi.stubGlobal("cancelAnimationFrame", (id: number) => clearTimeout(id));
  sockets = [];
  calls = [];
  answers = new Map([["GET /api/v1/models/1", [200, model]]]);
  listed();
  const api = new Api(async (asked, init) => {
    const body = init!.body ? (JSON.parse(init!.body as string) as unknown) : undefined;
    calls.push({
      method: init!.method!,
      path: asked,
      body,
      headers: init!.headers as Record<string, string>,
    });
    const [status, answer] = answers.get(`${init!.method} ${asked}`) ?? [
      500,
      { title: `no answer for ${init!.method} ${asked}` },
    ];
    return new Response(status === 204 ? null : JSON.stringify(answer), {
      status,
      headers: { ETag: '"1"' },
    });
  });
  session = new OpenModelSession(api, "1", (url, protocol) => {
    sockets.push(new FakeSocket(url, protocol));
    return socket();
  });
  unsubscribe = notices.subscribe((shown) => (told = shown));
});
afterEach(() => {
  discardUnsaved();
  vi.advanceTimersByTime(60_000); // time after which the notices close
  unsubscribe();
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

interface Seen {
  azimuth: number;
  elevation: number;
  zoom: number;
  perspective: boolean;
  section: SectionChoice;
  light: "museum" | "headlight" | "raking" | "unlit";
  direction: [number, number, number];
  exposure: number;
  fill: number;
  hiddenParts: number[];
  layers: { visible: boolean; opacity: number; ownPalette: boolean; key: number | null }[];
  looks: { visible: boolean; opacity: number }[];
}
const anOpacity = fc.double({ min: 0, max: 1, noNaN: true });
const whatIsSeen: fc.Arbitrary<Seen> = fc.record({
  azimuth: fc.double({ min: -3, max: 3, noNaN: true }),
  elevation: fc.double({ min: -1.5, max: 1.5, noNaN: true }),
  zoom: fc.double({ min: 0.05, max: 5, noNaN: true }),
  perspective: fc.boolean(),
  section: aSection,
  light: fc.constantFrom(
    "museum" as const,
    "headlight" as const,
    "raking" as const,
    "unlit" as const,
  ),
  direction: fc.tuple(share, share, fc.constant(0.5)),
  exposure: fc.double({ min: -3, max: 3, noNaN: true }),
  fill: share,
  layers: fc.array(
    fc.record({
      visible: fc.boolean(),
      opacity: anOpacity,
      ownPalette: fc.boolean(),
      key: fc.option(fc.nat(9)),
    }),
    { minLength: 2, maxLength: 2 },
  ),
  hiddenParts: fc.uniqueArray(fc.nat(255), { maxLength: 5 }),
  looks: fc.array(fc.record({ visible: fc.boolean(), opacity: anOpacity }), {
    minLength: 3,
    maxLength: 3,
  }),
});

function see(seen: Seen): void {
  const { view, layers, appearance } = session;
  view.fit();
  Object.assign(view.camera, { azimuth: seen.azimuth, elevation: seen.elevation });
  view.setPerspective(seen.perspective);
  view.zoomAt(seen.zoom, 300, 200);
  appearance.setSection(seen.section);
  appearance.setHiddenParts(new Set(seen.hiddenParts));
  const { light: mode, direction, exposure, fill } = seen;
  appearance.setLight({ mode, direction, exposure, fill });
  layers.all.forEach((each, index) => {
    const { visible, opacity, ownPalette, key } = seen.layers[index]!;
    layers.setVisible(each, visible);
    layers.setOpacity(each, opacity);
    layers.setPalette(each, ownPalette ? presencePalette("y", "#0000ffff") : null);
    layers.setHighlight(each.id, key === null ? null : { keys: [key] });
  });
  appearance.looks.forEach((each, index) => {
    appearance.setVisible(each, seen.looks[index]!.visible);
    appearance.setOpacity(each, seen.looks[index]!.opacity);
  });
}

/** Returns the window positions of the corners of the model's bounding box. */
function places({ view, projection }: Pick<CameraMessage, "view" | "projection">): number[] {
  const points = [0, 1, 2, 3, 4, 5, 6, 7].map((corner) =>
    [0, 1, 2].map((axis) => (corner & (1 << axis) ? bounds.max : bounds.min)[axis]!),
  );
  const times = (m: number[], [x, y, z, w]: number[]): number[] =>
    [0, 1, 2, 3].map((r) => m[r]! * x! + m[4 + r]! * y! + m[8 + r]! * z! + m[12 + r]! * w!);
  return points.flatMap((point) => {
    const clip = times(projection, times(view, [...point, 1]));
    return [clip[0]! / clip[3]!, clip[1]! / clip[3]!, clip[2]! / clip[3]!];
  });
}
function expectSame({ camera, ...rest }: ViewContent, then: ViewContent | View): void {
  const { camera: cameraThen, layers, looks, light } = then;
  expect(rest).toEqual({ layers, looks, light });
  expect([camera.width, camera.height, camera.section?.length]).toEqual([
    cameraThen.width,
    cameraThen.height,
    cameraThen.section?.length,
  ]);
  expect(camera.hidden_parts).toEqual(cameraThen.hidden_parts);
  (camera.section ?? []).forEach((plane, index) =>
    plane.forEach((part, at) =>
      expect(Math.abs(part - cameraThen.section![index]![at]!)).toBeLessThan(1e-6),
    ),
  );
  const [placesNow, placesThen] = [places(camera), places(cameraThen)];
  placesThen.forEach((place, index) =>
    expect(Math.abs(placesNow[index]! - place) / Math.max(1, Math.abs(place))).toBeLessThan(1e-6),
  );
}
/** Returns the settings in the last message to the server. */
const sent = (): ViewContent["layers"] =>
  [...(socket().of("layers").at(-1)?.layers ?? [])].sort(
    (a, b) => Number(a.layer) - Number(b.layer),
  );

describe("going to a view", () => {
  it("shows what was kept, whatever was set up before, and leads back to that", async () => {
    await open();
    fc.assert(
      fc.property(whatIsSeen, whatIsSeen, (kept, before) => {
        see(kept);
        const content = JSON.parse(JSON.stringify(session.views.content())) as ViewContent;
        const view = viewWith(3, content);
        see(before);
        const own = session.views.content();
        session.views.goTo(view);
        expectSame(session.views.content(), content);
        expect(sent()).toEqual(content.layers);
        session.views.goBack();
        const back = session.views.content();
        // highlights are omitted, because no table is open
        expectSame(
          { ...back, layers: back.layers.map(({ highlight: _, ...rest }) => rest) },
          { ...own, layers: own.layers.map(({ highlight: _, ...rest }) => rest) },
        );
        session.layers.all.forEach(({ id }) => session.layers.setHighlight(id, null));
      }),
      { numRuns: 60 },
    );
  });

  it("goes out to the server as camera, section, layers, looks and light", async () => {
    await open();
    session.appearance.setSection({ mode: "z", position: 0.25 });
    session.appearance.setLight({ mode: "raking", direction: [1, 0, 1] });
    session.layers.setVisible(session.layers.all[0]!, false);
    session.appearance.setVisible(session.appearance.looks[1]!, true);
    const view = viewWith(3, session.views.content());
    session.appearance.reset();
    session.layers.resetOverrides();
    session.view.standardView("top");
    await vi.advanceTimersByTimeAsync(500);
    expect(socket().of("layers").at(-1)).toEqual({ op: "layers", layers: [] });
    session.views.goTo(view);
    await vi.advanceTimersByTimeAsync(500);
    const camera = socket().of("camera").at(-1)!;
    expect(places(camera)).toEqual(
      places(view.camera).map((place) => expect.closeTo(place, 6) as unknown),
    );
    expect(camera.section).toEqual(view.camera.section);
    expect(socket().of("layers").at(-1)).toEqual({
      op: "layers",
      layers: [
        { layer: 7, visible: false, opacity: 1 },
        { layer: 8, visible: true, opacity: 1 },
      ],
      looks: [
        { look: 1, opacity: 1 },
        { look: 2, opacity: 1 },
      ],
      light: { mode: "raking", direction: [1, 0, 1], fill: 0.3, layer_opacity: 0.3 },
    });
  });

  it("is the same when the defaults are others by then", async () => {
    await open();
    const view = viewWith(3, session.views.content());
    await open(
      "owner",
      [layer(7, { visible: false, opacity: 0.2 }), layer(8)],
      [look(1, { visible: false }), look(2, { visible: true, order: 0 })],
    );
    session.views.goTo(view);
    expect(sent().find(({ layer }) => layer === 7)).toEqual({
      layer: 7,
      visible: true,
      opacity: 1,
    });
    expect(socket().of("layers").at(-1)!.looks).toEqual([{ look: 1, opacity: 1 }]);
  });

  it("keeps the order in which the looks lie, until it is left", async () => {
    await open();
    const view = viewWith(3, {
      ...session.views.content(),
      looks: [
        { look: 2, opacity: 1 },
        { look: 1, opacity: 1 },
      ],
    });
    session.views.goTo(view);
    expect(socket().of("layers").at(-1)!.looks).toEqual([
      { look: 2, opacity: 1 },
      { look: 1, opacity: 1 },
    ]);
    expect(session.appearance.hasLookOverrides).toBe(true);
    session.appearance.reset();
    expect(socket().of("layers").at(-1)!.looks).toBeUndefined();
  });

  it("in a window of another shape shows all that was seen", async () => {
    await open();
    session.view.zoomAt(0.4, 100, 100);
    const view = viewWith(3, session.views.content());
    const { camera } = session.view;
    const corner = camera.pointOnFocusPlane(0, 0);
    session.view.setViewport(300, 700, 1);
    session.view.standardView("top");
    session.views.goTo(view);
    const at = camera.project(corner)!;
    expect(at.x).toBeCloseTo(0, 3);
    expect(at.y).toBeGreaterThan(0);
    session.view.fit();
    expect(camera.halfField).toBeCloseTo(Math.tan((17.5 * Math.PI) / 180), 12);
  });

  it("flies there, unless less motion is wanted, and counts as there from the beginning", async () => {
    lessMotion = false;
    await open();
    const view = viewWith(3, session.views.content());
    listed(view);
    await session.views.load();
    session.view.standardView("top");
    const start = session.view.camera.eye();
    session.views.goTo(view);
    expect(session.view.camera.eye()).toEqual(start);
    expect(session.views.current).toEqual(view);
    await vi.advanceTimersByTimeAsync(300);
    expect(session.view.camera.elevation).toBeGreaterThan(0.3);
    expect(session.views.current).toEqual(view);
    await vi.advanceTimersByTimeAsync(1000);
    expectSame(session.views.content(), view);
    expect(session.views.current).toEqual(view);
    session.view.orbitPixels(4, 0);
    expect(session.views.current).toBeNull();
  });

  it("waits while one paints", async () => {
    await open();
    const view = viewWith(3, session.views.content());
    session.view.standardView("top");
    session.chooseTool("brush");
    session.gestures.toolDown({ x: 5, y: 5 });
    session.layers.setVisible(session.layers.all[1]!, true);
    const before = session.views.content();
    session.views.goTo(view);
    expect(session.views.content()).toEqual(before);
    session.gestures.toolUp();
    expectSame(session.views.content(), view);
  });

  it("from one to the next leads back to what was seen before the first, until something was changed", async () => {
    await open();
    const first = viewWith(1, session.views.content());
    session.view.standardView("left");
    const second = viewWith(2, session.views.content());
    listed(first, second);
    await session.views.load();
    session.view.standardView("top");
    const own = session.views.content();
    session.views.step(1);
    expect(session.views.current).toEqual(first);
    session.views.step(1);
    expect(session.views.current).toEqual(second);
    session.views.step(1);
    expect(session.views.current).toEqual(first);
    session.views.step(-1);
    expect(session.views.current).toEqual(second);
    expect(told.map(({ title }) => title)).toEqual([words.shown("V2")]);
    session.views.goBack();
    expectSame(session.views.content(), own);
    expect([session.views.leadsBack, session.views.current, told]).toEqual([false, null, []]);

    session.views.goTo(first);
    session.appearance.nextLight();
    const changed = session.views.content();
    session.views.goTo(second);
    session.views.goBack();
    expectSame(session.views.content(), changed);
  });

  it("leaves out on the way back what was deleted meanwhile, and shows the rows again that are chosen then", async () => {
    await open();
    session.layers.setOpacity(session.layers.find(8)!, 0.5);
    session.layers.setHighlight(7, { keys: [1] });
    const view = viewWith(3, {
      ...session.views.content(),
      layers: [{ layer: 7, highlight: { keys: [2], isolate: true } }],
    });
    session.views.goTo(view);
    expect(sent()).toEqual([{ layer: 7, highlight: { keys: [2], isolate: true } }]);
    expect(session.layers.hasOverrides).toBe(true);
    session.layers.setHighlight(7, { keys: [5] });
    expect(sent()).toEqual([{ layer: 7, highlight: { keys: [5] } }]);
    session.layers.setHighlight(7, null);
    expect(sent()).toEqual([{ layer: 7, highlight: { keys: [2], isolate: true } }]);
    socket().receive({ op: "layer", event: "deleted", layer_id: 8 });
    session.tables.view = { layerId: 7, highlight: { keys: [6] } } as never;
    session.views.goBack();
    expect(sent()).toEqual([{ layer: 7, highlight: { keys: [6] } }]);
    session.tables.view = null;
  });
});

describe("the list of views", () => {
  it("is that of the server, and follows what happens", async () => {
    const content = {
      camera: { view: [], projection: [], width: 1, height: 1 } as never,
      layers: [],
      looks: [],
      light: { mode: "museum" as const },
    };
    const names = (): string[] => session.views.all.map(({ name }) => name);
    listed(viewWith(2, content), viewWith(1, content));
    await open();
    expect([session.views.loaded, names()]).toEqual([true, ["V1", "V2"]]);
    answers.set(`GET ${path}/3`, [200, viewWith(3, content)]);
    socket().receive({ op: "view", event: "created", view: 3 });
    await settle();
    answers.set(`GET ${path}/1`, [200, viewWith(1, content, { name: "West", version: 2 })]);
    socket().receive({ op: "view", event: "changed", view: 1 });
    await settle();
    socket().receive({ op: "view", event: "deleted", view: 2 });
    expect(names()).toEqual(["West", "V3"]);
    answers.set(`GET ${path}/1`, [200, viewWith(1, content)]); // the response to a pending request
    socket().receive({ op: "view", event: "changed", view: 1 });
    await settle();
    answers.set(`GET ${path}/3`, [404, { title: "Not found" }]);
    socket().receive({ op: "view", event: "changed", view: 3 });
    await settle();
    expect(names()).toEqual(["West"]);
  });

  it("outlives a lost connection, and what happened meanwhile is known afterwards", async () => {
    await open();
    const content = session.views.content();
    listed(viewWith(1, content), viewWith(2, content));
    await session.views.load();
    socket().lose();
    expect(session.views.all).toHaveLength(2);
    listed(viewWith(2, content, { name: "New", version: 2 }));
    await vi.advanceTimersByTimeAsync(1000);
    await open();
    expect(session.views.all.map(({ name }) => name)).toEqual(["New"]);
  });

  it("that cannot be read says so, and is read when asked again", async () => {
    answers.delete(`GET ${path}?limit=1000`);
    await open();
    expect([session.views.failed, session.views.loaded]).toEqual([true, false]);
    listed();
    await session.views.load();
    expect([session.views.failed, session.views.loaded]).toEqual([false, true]);
  });

  it("is followed by addresses with slug or id, and tells when there is none", async () => {
    await open();
    const view = viewWith(3, session.views.content(), { slug: "west-wall" });
    listed(view);
    await session.views.load();
    for (const ref of ["west-wall", "3"]) {
      session.view.standardView("top");
      session.views.follow(ref);
      expect(session.views.current).toEqual(view);
    }
    expect(session.views.linkTo(view)).toBe("http://here/models/1#view=west-wall");
    session.views.follow("gone");
    expect(told.at(-1)!.title).toBe(words.missing);
    listed();
    await session.views.load();
    session.views.step(1);
    expect(told.at(-1)!.title).toBe(words.none);
  });
});

describe("keeping views", () => {
  it("sends what is seen, with the call's own key, and counts as being there", async () => {
    await open();
    const content = session.views.content();
    const made = viewWith(4, content);
    answers.set(`POST ${path}`, [201, made]);
    await session.views.keep({ name: "V4", text: "" }, content, "key-1");
    expect(calls.at(-1)).toMatchObject({
      body: { name: "V4", text: "", ...content },
      headers: { "Idempotency-Key": "key-1" },
    });
    expect([session.views.current, session.views.leadsBack]).toEqual([made, false]);
    const other = viewWith(5, { ...content, light: { mode: "unlit" } });
    session.views.goTo(other);
    session.views.goBack();
    expectSame(session.views.content(), content);
  });

  it("is changed by who made them and by curators", async () => {
    await open("annotator");
    const content = session.views.content();
    const [mine, hers] = [viewWith(1, content), viewWith(2, content, { user: "ada" })];
    expect([mine, hers].map((view) => session.views.mayChange(view))).toEqual([true, false]);
    await open("curator");
    expect([mine, hers].map((view) => session.views.mayChange(view))).toEqual([true, true]);
  });

  it("shows something else under a name, and takes that back", async () => {
    await open();
    const view = viewWith(1, session.views.content());
    listed(view);
    await session.views.load();
    session.appearance.setLight({ mode: "unlit" });
    answers.set(`PATCH ${path}/1`, [200, viewWith(1, session.views.content(), { version: 2 })]);
    await session.views.replace(view);
    expect(calls.at(-1)).toMatchObject({
      body: session.views.content(),
      headers: { "If-Match": '"v1"' },
    });
    expect(session.views.current?.version).toBe(2);
    const { link } = told.at(-1)!;
    if (link && "act" in link) link.act();
    await settle();
    const { camera, layers, looks, light } = view;
    expect(calls.at(-1)).toMatchObject({
      method: "PATCH",
      body: { camera, layers, looks, light },
      headers: { "If-Match": '"v2"' },
    });
  });

  it("of what somebody else changed since is refused, and is then as it is now", async () => {
    await open();
    const view = viewWith(1, session.views.content());
    listed(view);
    await session.views.load();
    const stale: [number, unknown] = [412, { status: 412, title: "Stale" }];
    for (const method of ["PATCH", "DELETE"]) answers.set(`${method} ${path}/1`, stale);
    const attempts = [
      () => session.views.describe(view, { name: "Mine", text: "" }),
      () => session.views.replace(view),
      () => session.views.remove(view),
    ];
    for (const [index, attempt] of attempts.entries()) {
      const theirs = viewWith(1, session.views.content(), {
        name: `Theirs ${index}`,
        version: index + 2,
      });
      answers.set(`GET ${path}/1`, [200, theirs]);
      await expect(attempt()).rejects.toMatchObject({ status: 412 });
      expect(session.views.find(1)).toEqual(theirs);
    }
    answers.set(`DELETE ${path}/1`, [204, null]);
    await session.views.remove(session.views.find(1)!);
    expect(calls.at(-1)!.headers["If-Match"]).toBe('"v4"');
    expect(session.views.all).toEqual([]);
  });
});
