import { beforeEach, describe, expect, it, vi } from "vitest";

import { Measuring, type MeasuringHost } from "../../../src/features/measuring/measuring";
import { notices } from "../../../src/ui/notices";
import { texts } from "../../../src/texts";
import { Api } from "../../../src/net/api";
import { OrbitCamera } from "../../../src/math/camera";
import { MeasureTool, type MeasureHost } from "../../../src/features/measuring/measure-tool";

// The model is a wall in the plane y = 0, 100 mm wide and high. The camera sees it from the front
// in parallel projection, so a pixel is a millimeter.
const comes = (check: () => void): Promise<void> => vi.waitFor(check, { timeout: 20_000 });
const atMm = (x: number, z: number): { x: number; y: number } => ({ x: 200 + x, y: 200 - z });

let camera: OrbitCamera;
let asked: { path: string; body: Record<string, unknown> }[];
let hold: Promise<void> | null; // delays responses
let sees: (x: number, z: number) => boolean;
let measuring: Measuring;

function answer(path: string, body: Record<string, unknown>): object {
  const place = ([x, z]: readonly [number, number]): object =>
    Math.abs(x) <= 50 && Math.abs(z) <= 50 && sees(x, z)
      ? {
          hit: true,
          position: [x, 0, z],
          normal: [0, -1, 0],
          values: { wet: { valid: x < 0, value: 7 } },
        }
      : { hit: false };
  if (path.endsWith("/pick")) return place([Number(body["x"]) - 200, 200 - Number(body["y"])]);
  const corners = (body["path"] as [number, number][] | undefined)?.map(
    ([x, y]): [number, number] => [x - 200, 200 - y],
  );
  const places = (body["places"] as [number, number, number][] | undefined)?.map(
    ([x, , z]): [number, number] => [x, z],
  );
  const line = corners ?? places!;
  const points = line
    .slice(1)
    .flatMap(([x, z], at) =>
      Array.from({ length: 101 }, (_, n): [number, number] => [
        line[at]![0] + ((x - line[at]![0]) * n) / 100,
        line[at]![1] + ((z - line[at]![1]) * n) / 100,
      ]),
    );
  const all = (point: [number, number]): object => ({
    hit: true,
    position: [point[0], 0, point[1]],
    normal: [0, -1, 0],
    values: { wet: { valid: point[0] < 0, value: 7 } },
  });
  return {
    length_mm: 0,
    samples: points.map((point) => ({ along_mm: 0, point: places ? all(point) : place(point) })),
  };
}

beforeEach(() => {
  camera = new OrbitCamera();
  camera.setModel({ min: [-50, 0, -50], max: [50, 0, 50] }, "z");
  camera.resize(400, 400);
  camera.perspective = false;
  camera.distance = 200 / camera.halfField;
  [asked, hold, sees] = [[], null, () => true];
  const api = new Api(async (path, init) => {
    const body = JSON.parse(String(init!.body)) as Record<string, unknown>;
    asked.push({ path, body });
    const told = JSON.stringify(answer(path, body));
    await hold;
    return new Response(
      (init!.headers as Record<string, string>)["Accept"] === "text/csv" ? "along_mm,x" : told,
    );
  });
  const layers = [
    { id: 4, slug: "wet", kind: "numeric", palette: { mode: "linear" } },
    { id: 5, slug: "units", kind: "database", palette: { mode: "categorical" } },
  ];
  measuring = new Measuring(api, {
    view: { camera, scale: 1 },
    layers: { all: layers },
    model: () => ({ id: 9, unit: "mm", up: "z" }),
    changed: () => {},
  } as unknown as MeasuringHost);
});

describe("measuring", () => {
  it("sets places where taps see the surface, and follows it under the straight lines", async () => {
    measuring.setAt(atMm(-30, 0));
    measuring.setAt(atMm(30, 0));
    measuring.setAt(atMm(30, 40));
    await comes(() => expect(measuring.along).toBeCloseTo(100, 6));
    expect(measuring.positions.map((place) => place.map(Math.round))).toEqual([
      [-30, 0, 0],
      [30, 0, 0],
      [30, 0, 40],
    ]);
    expect(measuring.profile!.way).toBe("seen");
    expect(measuring.ended).toBe(false);
  });

  it("ends with a second tap on the last place, also when its answer is still on its way; the next tap begins anew", async () => {
    measuring.setAt(atMm(-30, 0));
    measuring.setAt(atMm(30, 0));
    measuring.setAt(atMm(32, 1));
    await comes(() => expect(measuring.ended).toBe(true));
    expect(measuring.places).toHaveLength(2);
    measuring.setAt(atMm(0, 10));
    await comes(() =>
      expect(measuring.positions.map((place) => place.map(Math.round))).toEqual([[0, 0, 10]]),
    );
    expect([measuring.ended, measuring.profile]).toEqual([false, null]);
  });

  it("ends with a tap on the first of three, but not on a place that is seen from behind", async () => {
    for (const [x, z] of [
      [-30, 0],
      [30, 0],
      [0, 30],
      [-30, 0],
    ] as const)
      measuring.setAt(atMm(x, z));
    await comes(() => expect(measuring.ended).toBe(true));
    expect(measuring.places).toHaveLength(3);
    measuring.clear();
    measuring.setAt(atMm(0, 0));
    await comes(() => expect(measuring.places).toHaveLength(1));
    camera.azimuth = Math.PI;
    measuring.setAt(atMm(0, 0));
    await comes(() => expect(measuring.places).toHaveLength(2));
  });

  it("takes the last place back, and goes on", async () => {
    for (const x of [-30, 0, 30]) measuring.setAt(atMm(x, 0));
    measuring.end();
    measuring.takeBack();
    await comes(() => expect(measuring.along).toBeCloseTo(30, 6));
    expect([measuring.places.length, measuring.ended]).toEqual([2, false]);
  });

  it("forgets what is answered after it was cleared", async () => {
    let go = (): void => {};
    hold = new Promise((done) => (go = done));
    measuring.setAt(atMm(0, 0));
    expect(measuring.begun).toBe(true); // Escape also cancels a pending tap
    await comes(() => expect(asked).toHaveLength(1));
    measuring.clear();
    expect(measuring.begun).toBe(false);
    go();
    hold = null;
    measuring.setAt(atMm(20, 0));
    await comes(() =>
      expect(measuring.positions.map((place) => place.map(Math.round))).toEqual([[20, 0, 0]]),
    );
  });

  it("has not begun where its only place is taken back, or was missed", async () => {
    measuring.setAt(atMm(0, 0));
    measuring.takeBack();
    await comes(() => expect(measuring.begun).toBe(false));
    measuring.setAt(atMm(70, 0));
    expect(measuring.begun).toBe(true);
    await comes(() => expect(measuring.begun).toBe(false));
  });

  it("says where there is no surface, and sets nothing", async () => {
    let told = "";
    const stop = notices.subscribe((now) => (told = now.at(-1)?.title ?? told));
    measuring.setAt(atMm(90, 0));
    await comes(() => expect(told).toBe(texts.marks.missed));
    expect(measuring.places).toEqual([]);
    stop();
  });

  it("follows what is nearest where not all places are seen from here, or where that is wanted", async () => {
    measuring.setAt(atMm(-30, 0));
    await comes(() => expect(measuring.places).toHaveLength(1));
    sees = (x) => x > 0; // an obstacle is now in front of the first point
    measuring.setAt(atMm(30, 0));
    await comes(() => expect(measuring.profile?.way).toBe("nearest"));
    expect(measuring.along).toBeCloseTo(60, 6);
    expect(asked.at(-1)!.body).toMatchObject({
      step_mm: expect.closeTo(0.06, 6) as number,
      layers: [],
    });
    sees = () => true;
    measuring.chooseWay("seen");
    await comes(() => expect(measuring.profile?.way).toBe("seen"));
    measuring.chooseWay("nearest");
    await comes(() => expect(measuring.profile?.way).toBe("nearest"));
  });

  it("tells no way over the surface where what is nearest is in patches, but parts of what was seen", async () => {
    sees = (x) => Math.abs(x) > 10;
    measuring.setAt(atMm(-30, 0));
    measuring.setAt(atMm(30, 0));
    await comes(() => expect(measuring.profile?.parts).toHaveLength(2));
    expect(measuring.along).toBeGreaterThan(37);
    expect(measuring.along).toBeLessThan(40.1);
    expect(measuring.hasWay).toBe(true);
    measuring.profile = { ...measuring.profile!, way: "nearest" };
    expect(measuring.hasWay).toBe(false);
  });

  it("has values of the layer that is plotted, and saves the same line as CSV with those of all", async () => {
    measuring.setAt(atMm(-30, 0));
    measuring.setAt(atMm(30, 0));
    await comes(() => expect(measuring.profile).not.toBeNull());
    expect(measuring.layers.map(({ id }) => id)).toEqual([4]);
    measuring.chooseLayer(4);
    await comes(() => expect(measuring.profile!.places[0]!.value).toBe(7));
    expect(measuring.profile!.places.at(-1)!.value).toBeNull();
    expect(await (await measuring.csv()).text()).toBe("along_mm,x");
    const { path } = asked.at(-1)!.body;
    expect(asked.at(-1)!.body).not.toHaveProperty("layers");
    expect(path).toEqual(asked.find(({ path: to }) => to.endsWith("/profile"))!.body["path"]);
  });
});

describe("the tool for measuring", () => {
  const done: string[] = [];
  const host = new Proxy({} as MeasureHost, {
    get: (_, name) =>
      name === "begun" ? () => begun : (..._args: unknown[]) => void done.push(String(name)),
  });
  let begun = false;
  const tool = new MeasureTool(host);
  beforeEach(() => {
    done.length = 0;
    begun = false;
  });

  it("sets a place with a tap, and turns the model with a drag", () => {
    tool.down({ x: 10, y: 10 });
    tool.move([{ x: 12, y: 11 }]);
    tool.up();
    expect(done).toEqual(["orbit", "tap"]);
    done.length = 0;
    tool.down({ x: 10, y: 10 });
    tool.move([{ x: 60, y: 10 }]);
    tool.up();
    expect(done).toEqual(["orbit"]);
  });

  it("has keys of its own while something is measured, and leaves them to the page otherwise", () => {
    expect(["Enter", "Backspace", "Escape", "b"].map((key) => tool.key(key))).toEqual([
      false,
      false,
      false,
      false,
    ]);
    begun = true;
    expect(["Enter", "Backspace", "Delete", "Escape", "b"].map((key) => tool.key(key))).toEqual([
      true,
      true,
      true,
      true,
      false,
    ]);
    expect(tool.key("m")).toBe(true);
    tool.deactivate();
    expect(done).toEqual(["end", "takeBack", "takeBack", "clear", "setInMiddle", "clear"]);
  });
});
