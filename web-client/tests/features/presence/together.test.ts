import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { OpenModelSession } from "../../../src/shell/open-model-session";
import { notices, type Notice } from "../../../src/ui/notices";
import { texts } from "../../../src/texts";
import { Api } from "../../../src/net/api";
import { OrbitCamera } from "../../../src/math/camera";
import { presencePalette } from "../../../src/domain/palette";
import type { PresenceUpdate, PresenceUser, Welcome } from "../../../src/core/protocol.gen";
import { length, subtract } from "../../../src/math/vector";
import { FakeSocket, welcome } from "../../fake-socket";

const bounds = { min: [0, 0, 0], max: [100, 100, 100] } as const;
const model = {
  id: 1,
  name: "Pot",
  unit: "mm",
  up: "z",
  scale_verified: true,
  bounds,
} as unknown as Welcome["model"];
const layer = {
  id: 7,
  model: 1,
  name: "L",
  slug: "l",
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
  visibility: "public",
  order: 0,
  sequence: 0,
} as unknown as Welcome["layers"][number];
const words = texts.together;

let sockets: FakeSocket[];
let session: OpenModelSession;
let told: readonly Notice[];
let unsubscribe: () => void;
let calm: boolean;

const socket = (): FakeSocket => sockets[sockets.length - 1]!;
const said = (): PresenceUpdate => socket().of("presence").at(-1)!;
const own = welcome().session;
const me: PresenceUser = { session: own, name: "owner", color: "#0072b2" };
const bea = (more: Partial<PresenceUser> = {}): PresenceUser => ({
  session: "b",
  name: "bea",
  full_name: "Bea Ost",
  color: "#d55e00",
  ...more,
});
const here = (...users: PresenceUser[]): void =>
  socket().receive({ op: "presence", users: [me, ...users] });

/** Returns a camera of Bea's, from another side. */
function hers(azimuth: number): OrbitCamera {
  const camera = new OrbitCamera();
  camera.setModel({ min: [...bounds.min], max: [...bounds.max] }, "z");
  camera.resize(900, 500);
  camera.firstView();
  camera.azimuth = azimuth;
  return camera;
}
const farFrom = (camera: OrbitCamera): number =>
  length(subtract(session.view.camera.eye(), camera.eye()));

function join(): void {
  socket().open();
  socket().receive({ ...welcome(), role: "owner", model, layers: [layer] });
}

beforeEach(async () => {
  vi.useFakeTimers();
  calm = true;
  vi.stubGlobal("window", { location: { protocol: "http:", host: "here" }, devicePixelRatio: 1 });
  vi.stubGlobal("matchMedia", () => ({ matches: calm }));
  vi.stubGlobal("requestAnimationFrame", (callback: () => void) => setTimeout(callback, 16));
  vi.stubGlobal("cancelAnimationFrame", (id: ReturnType<typeof setTimeout>) => clearTimeout(id));
  sockets = [];
  const api = new Api(async (path) => {
    const [, list] = /\/(comments|views)\?/.exec(String(path)) ?? [];
    const body = list ? { [list]: [], total: 0 } : model;
    return new Response(JSON.stringify(body), { status: 200, headers: { ETag: '"1"' } });
  });
  session = new OpenModelSession(api, "1", (url, protocol) => {
    sockets.push(new FakeSocket(url, protocol));
    return socket();
  });
  told = [];
  unsubscribe = notices.subscribe((shown) => (told = shown));
  await session.open();
  session.view.setViewport(800, 600, 1);
  join();
});
afterEach(() => {
  session.close();
  vi.advanceTimersByTime(60_000); // time after which the notices close
  unsubscribe();
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

const follow = (camera: OrbitCamera): void => {
  here(bea());
  session.together.follow(session.together.people[1]!.viewer!);
  here(bea({ camera: camera.message() }));
};

describe("following somebody", () => {
  it("tells the server whom, and goes where they look from", () => {
    follow(hers(2));
    expect(said()).toEqual({ op: "presence", pointer: null, follow: "b" });
    expect(farFrom(hers(2))).toBeLessThan(1e-6);
    here(bea({ camera: hers(2.5).message() }));
    expect(farFrom(hers(2.5))).toBeLessThan(1e-6);
  });

  it("goes there smoothly, and arrives", () => {
    calm = false;
    const start = session.view.camera.eye();
    follow(hers(2));
    vi.advanceTimersByTime(50);
    expect(length(subtract(session.view.camera.eye(), start))).toBeGreaterThan(1);
    const halfWay = farFrom(hers(2));
    expect(halfWay).toBeGreaterThan(1);
    vi.advanceTimersByTime(5000);
    expect(farFrom(hers(2))).toBeLessThan(1e-6);
    expect([session.view.gliding, session.together.followed?.session]).toEqual([false, "b"]);
  });

  it("is heard of with every pointer, and says nothing of it when it has stopped", () => {
    follow(hers(2));
    session.gestures.hover({ x: 30, y: 40 });
    vi.advanceTimersByTime(200);
    expect(said()).toEqual({ op: "presence", pointer: [30, 40], follow: "b" });
    session.together.stopFollowing();
    expect(said()).toEqual({ op: "presence", pointer: [30, 40] });
  });

  const moves: [string, () => void][] = [
    ["turning", () => session.gestures.orbit(10, 0)],
    ["zooming", () => session.gestures.zoom(0.9, 5, 5)],
    ["a standard view", () => session.view.standardView("top")],
    ["flying to a record", () => session.view.flyTo({ min: [0, 0, 0], max: [5, 5, 5] })],
  ];
  it.each(moves)("stops with one's own %s", (_, move) => {
    follow(hers(2));
    move();
    expect([session.together.followed, said()]).toEqual([null, { op: "presence", pointer: null }]);
    const mine = session.view.camera.eye();
    here(bea({ camera: hers(3).message() })); // the request was pending
    vi.advanceTimersByTime(1000);
    expect(session.view.camera.eye()).toEqual(mine);
  });

  it("goes on from what was seen, turning around it, with the usual field", () => {
    session.view.setViewport(300, 600, 1);
    const usual = session.view.camera.halfField;
    follow(hers(2));
    expect(session.view.camera.halfField).toBeGreaterThan(1.5 * usual);
    vi.advanceTimersByTime(200);
    const asked = socket()
      .of("pick")
      .find(({ x, y }) => x === 150 && y === 300)!;
    const { camera } = session.view;
    const seen = subtract(camera.eye(), camera.axes().back.map((c) => c * 40) as never);
    socket().receive({ op: "picked", id: asked.id!, hit: true, position: [...seen] });
    session.together.stopFollowing();
    expect(camera.halfField).toBe(usual);
    expect(length(subtract(camera.target, seen))).toBeLessThan(1e-6);
  });

  it("waits while one paints, and catches up", () => {
    follow(hers(2));
    session.chooseTool("brush");
    session.gestures.toolDown({ x: 5, y: 5 });
    here(bea({ camera: hers(1).message() }));
    expect(farFrom(hers(2))).toBeLessThan(1e-6);
    session.gestures.toolUp();
    expect(farFrom(hers(1))).toBeLessThan(1e-6);
    expect(session.together.followed?.session).toBe("b");
  });

  it("fits a window that changes its shape meanwhile", () => {
    follow(hers(2));
    const field = session.view.camera.halfField;
    session.view.setViewport(200, 600, 1);
    expect(session.view.camera.halfField).toBeGreaterThan(2 * field);
    expect(farFrom(hers(2))).toBeLessThan(1e-6);
  });

  it("ends when they leave, and the person is told, by whichever message comes first", () => {
    follow(hers(2));
    here();
    expect([session.together.followed, told.map(({ title }) => title)]).toEqual([
      null,
      [words.left("Bea Ost")],
    ]);
    socket().receive({
      op: "problem",
      title: "Not here",
      status: 404,
      detail: "",
      field: "follow",
    });
    expect(told.length).toBe(1);
    follow(hers(2));
    socket().receive({
      op: "problem",
      title: "Not here",
      status: 404,
      detail: "",
      field: "follow",
    });
    expect([session.together.followed, told.length]).toEqual([null, 1]);
  });

  it("that the server refuses ends, and says why", () => {
    follow(hers(2));
    socket().receive({
      op: "problem",
      title: "Follows you already",
      status: 409,
      detail: "They do.",
      field: "follow",
    });
    expect([session.together.followed, told.map(({ title, detail }) => [title, detail])]).toEqual([
      null,
      [[words.refused("Bea Ost"), "They do."]],
    ]);
  });

  it("that the server has ended ends, and the person is told", () => {
    follow(hers(2));
    const report = (following?: string): void =>
      socket().receive({
        op: "presence",
        users: [following === undefined ? me : { ...me, following }, bea()],
      });
    report(); // the server has not received the request yet
    expect(session.together.followed?.session).toBe("b");
    report("b");
    report();
    expect([session.together.followed, told.map(({ title }) => title), said()]).toEqual([
      null,
      [words.ended("Bea Ost")],
      { op: "presence", pointer: null },
    ]);
  });

  it("of who follows this window is not offered", () => {
    here(bea({ following: own }), { session: "c", name: "carl", color: "#009e73" });
    expect(session.together.people.map((person) => session.together.canFollow(person))).toEqual([
      false,
      false,
      true,
    ]);
  });

  it("goes on after a lost connection, if they are still there", async () => {
    follow(hers(2));
    socket().lose();
    expect(session.together.people).toEqual([]);
    await vi.advanceTimersByTimeAsync(1000);
    join();
    expect(said()).toEqual({ op: "presence", pointer: null, follow: "b" });
    here(bea({ camera: hers(1).message() }));
    expect([session.together.followed?.session, farFrom(hers(1)) < 1e-6, told.length > 1]).toEqual([
      "b",
      true,
      false,
    ]);
  });
});

describe("asking others to look along", () => {
  it("is told, counts who follows, and ends", () => {
    session.together.lead(true);
    expect(said()).toEqual({ op: "presence", pointer: null, leading: true });
    here(bea({ following: own }), { ...bea({ following: own }), session: "b2" });
    expect(session.together.followers.map(({ user }) => user)).toEqual(["bea"]);
    session.together.lead(false);
    expect(said()).toEqual({ op: "presence", pointer: null });
  });

  it("is asked once, with a button that follows", () => {
    here(bea({ leading: true }));
    here(bea({ leading: true, pointer: { position: [1, 2, 3] } }));
    expect(told.map(({ title }) => title)).toEqual([words.invites("Bea Ost")]);
    const { link } = told[0]!;
    if (!link || !("act" in link)) throw new Error("there is no button");
    link.act();
    expect([said().follow, told.length]).toEqual(["b", 0]);
  });

  it("is no longer offered when they take it back, and anew when they ask again", () => {
    here(bea({ leading: true }));
    here(bea());
    expect(told).toEqual([]);
    here(bea({ leading: true }));
    expect(told.length).toBe(1);
    here();
    expect(told).toEqual([]);
  });

  it("ends with following, which ends with asking", () => {
    session.together.lead(true);
    follow(hers(2));
    expect([session.together.leading, said().leading]).toEqual([false, undefined]);
    session.together.lead(true);
    expect([session.together.followed, said().leading]).toEqual([null, true]);
  });
});

describe("leaving the model", () => {
  it("ends asking and following, also while something is still to be saved", () => {
    here(bea({ leading: true }));
    session.together.lead(true);
    session.chooseTool("brush");
    session.gestures.toolDown({ x: 5, y: 5 });
    session.gestures.toolUp();
    session.close();
    expect([said(), told.length]).toEqual([{ op: "presence" }, 0]);
    here(bea({ leading: true }), { ...bea({ leading: true }), session: "c", name: "carl" });
    expect(told.length).toBe(0);
    const { stroke } = socket().of("stroke.begin").at(-1)!;
    socket().receive({ op: "saved", stroke, n: 0, sequence: 1, texels_changed: 0, area_m2: 0 });
    expect(socket().closed).toBe(true);
  });
});

describe("the page", () => {
  it("is drawn again when somebody comes, goes or leads, not when they only move", () => {
    let drawn = 0;
    const stop = session.subscribe(() => ++drawn);
    for (let i = 0; i < 5; ++i) here(bea({ pointer: { position: [i, 0, 0] } }));
    expect(drawn).toBe(1);
    here(bea({ leading: true }));
    here();
    expect(drawn).toBe(3);
    stop();
  });
});

describe("what others see of the pointer", () => {
  it("is the brush as large as it is on the surface, while it is in hand", () => {
    session.chooseTool("brush");
    session.gestures.hover({ x: 400, y: 300 });
    const { position } = { position: [50, 50, 50] as [number, number, number] };
    socket().receive({ op: "picked", id: socket().of("pick").at(-1)!.id!, hit: true, position });
    vi.advanceTimersByTime(200);
    const { camera } = session.view;
    expect(said().radius).toBeCloseTo(
      session.painting.radiusWindowPx() * camera.unitPerPixel(camera.depthOf(position)),
      9,
    );
    // The surface under the pointer may become known after the position was sent.
    session.gestures.hover({ x: 402, y: 300 });
    vi.advanceTimersByTime(200);
    const nearer: [number, number, number] = [50, 20, 60];
    socket().receive({
      op: "picked",
      id: socket().of("pick").at(-1)!.id!,
      hit: true,
      position: nearer,
    });
    vi.advanceTimersByTime(200);
    expect(said().radius).toBeCloseTo(
      session.painting.radiusWindowPx() * camera.unitPerPixel(camera.depthOf(nearer)),
      9,
    );
    session.chooseTool("orbit");
    session.gestures.hover({ x: 401, y: 300 });
    vi.advanceTimersByTime(200);
    expect(said()).toEqual({ op: "presence", pointer: [401, 300] });
  });
});
