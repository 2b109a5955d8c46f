import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { PeopleCursors } from "../../../src/features/presence/people-cursors";
import { OrbitCamera, type CameraMessage } from "../../../src/math/camera";
import type { PresenceUser } from "../../../src/core/protocol.gen";
import type { Vec3 } from "../../../src/math/vector";

let camera: OrbitCamera;
let asked: { id: string; x: number; y: number; camera: CameraMessage }[];
let cursors: PeopleCursors;
let calm: boolean;
let ready: boolean;

const bea = (position: Vec3, radius?: number, session = "b"): PresenceUser => ({
  session,
  name: session,
  color: "#0072b2",
  pointer: { position: [...position], ...(radius === undefined ? {} : { radius }) },
});
const answer = (position: Vec3 | null): boolean =>
  cursors.answer({
    op: "picked",
    id: asked.at(-1)!.id,
    hit: position !== null,
    ...(position ? { position: [...position] } : {}),
  });
const only = () => {
  const [cursor, ...rest] = cursors.now();
  expect(rest).toEqual([]);
  return cursor!;
};

beforeEach(() => {
  vi.useFakeTimers();
  camera = new OrbitCamera();
  camera.setModel({ min: [-10, -10, -10], max: [10, 10, 10] }, "z");
  camera.resize(1600, 1200);
  camera.standardView("front"); // looks along +y, with x to the right and z up
  asked = [];
  calm = false;
  ready = true;
  cursors = new PeopleCursors({
    camera: () => camera,
    scale: () => 2,
    ready: () => ready,
    ask: (id, x, y, seenBy) => void asked.push({ id, x, y, camera: seenBy }),
    wantsLessMotion: () => calm,
  });
});
afterEach(() => {
  cursors.stop();
  vi.useRealTimers();
});

describe("where others point", () => {
  it("is where this camera sees the place, in pixels of the page", () => {
    cursors.receive([bea([0, 0, 0])]);
    expect([only().x, only().y, only().radius]).toEqual([400, 300, null]);
    cursors.receive([bea([2, -5, 3], 1.5)]);
    vi.advanceTimersByTime(1000);
    // Computed by hand: half the field of view is tan(17.5°), and the eye is at −distance.
    const pxPerUnit = 300 / Math.tan((17.5 * Math.PI) / 180) / (camera.distance - 5);
    expect(only().x).toBeCloseTo(400 + 2 * pxPerUnit, 6);
    expect(only().y).toBeCloseTo(300 - 3 * pxPerUnit, 6);
    expect(only().radius).toBeCloseTo(1.5 * pxPerUnit, 6);
  });

  it("is not drawn beside the window or behind the eye, nor when they point nowhere or leave", () => {
    for (const place of [
      [1000, 0, 0],
      [0, 0, 900],
      [0, -1e4, 0],
    ] as Vec3[]) {
      cursors.receive([bea(place)]);
      vi.advanceTimersByTime(1000);
      expect(cursors.now()).toEqual([]);
    }
    cursors.receive([bea([0, 0, 0])]);
    vi.advanceTimersByTime(1000);
    expect(only().viewer.session).toBe("b");
    cursors.receive([{ session: "b", name: "b", color: "#0072b2" }]);
    expect(cursors.now()).toEqual([]);
  });

  it("glides on the surface, as long as what comes takes, and jumps for who wants less motion", () => {
    cursors.receive([bea([0, 0, 0])]);
    vi.advanceTimersByTime(200);
    cursors.receive([bea([4, 0, 0])]);
    expect([only().x, cursors.gliding]).toEqual([400, true]);
    vi.advanceTimersByTime(100);
    const half = only().x - 400;
    vi.advanceTimersByTime(100);
    expect(cursors.gliding).toBe(false);
    expect(only().x - 400).toBeCloseTo(2 * half, 6);
    calm = true;
    cursors.receive([bea([0, 0, 0])]);
    expect([only().x, cursors.gliding]).toEqual([400, false]);
  });

  it("fades when it rests for ten seconds, is drawn then, and comes back with the next move", () => {
    let drawn = 0;
    cursors.receive([bea([0, 0, 0])]);
    cursors.onChange = () => ++drawn;
    vi.advanceTimersByTime(9000);
    cursors.receive([bea([0, 0, 0])]); // the participants moved, except this one
    drawn = 0;
    expect(only().faded).toBe(false);
    vi.advanceTimersByTime(1100);
    expect([only().faded, drawn]).toEqual([true, 1]);
    cursors.receive([bea([1, 0, 0])]);
    expect(only().faded).toBe(false);
  });
});

describe("a place behind the surface", () => {
  it("is asked for at its pixel with the camera that sees it there, and hidden when something is nearer", () => {
    cursors.receive([bea([2, 5, 3])]);
    const seen = camera.project([2, 5, 3])!;
    expect([asked[0]!.x, asked[0]!.y, asked[0]!.camera]).toEqual([
      seen.x,
      seen.y,
      camera.message(),
    ]);
    expect(only().hidden).toBe(false);
    expect(answer([2, -5, 3])).toBe(true);
    expect(only().hidden).toBe(true);
    camera.orbit(Math.PI, 0);
    cursors.lookAgain();
    vi.advanceTimersByTime(200);
    answer([2, 5, 3]);
    expect(only().hidden).toBe(false);
  });

  it("is shown where the ray meets it to some pixels, something behind it, or nothing", () => {
    const slack = camera.unitPerPixel(camera.depthOf([0, 0, 0])) * 3;
    for (const met of [[0, -slack, 0], [0, 4, 0], null] as (Vec3 | null)[]) {
      cursors.receive([bea([0, 0, 0])]);
      cursors.lookAgain();
      vi.advanceTimersByTime(200);
      answer(met);
      expect(only().hidden).toBe(false);
    }
  });

  it("is hidden where the own section has cut it away", () => {
    cursors.receive([bea([2, 0, 0])]);
    camera.section = [[-1, 0, 0, 1]]; // keeps the part with x ≤ 1
    expect(only().hidden).toBe(true);
    camera.section = [[1, 0, 0, 1]];
    expect(only().hidden).toBe(false);
  });

  it("of many people one is asked for at a time, each in turn, and never again while nothing changes", () => {
    const people = ["b", "c", "d"].map((session, index) => bea([index, 0, 0], undefined, session));
    cursors.receive(people);
    for (let i = 0; i < 20; ++i) {
      cursors.receive(people);
      vi.advanceTimersByTime(30);
    }
    expect(asked.length).toBe(1);
    for (let i = 0; i < 5; ++i) {
      answer(null);
      vi.advanceTimersByTime(150);
    }
    expect(new Set(asked.map(({ x }) => x)).size).toBe(3);
    expect(asked.length).toBe(3);
    cursors.receive([people[0]!, bea([5, 0, 0], undefined, "c"), people[2]!]);
    expect(asked.length).toBe(4);
  });

  it("that has moved on is not judged by the answer to where it was", () => {
    cursors.receive([bea([2, 5, 3])]);
    cursors.receive([bea([2, 5, 2])]);
    answer([2, -5, 3]);
    expect(only().hidden).toBe(false);
    vi.advanceTimersByTime(200);
    expect(asked.length).toBe(2);
  });

  it("waits for the connection, and asks anew when an answer was refused or got lost", () => {
    ready = false;
    cursors.receive([bea([0, 0, 0])]);
    expect(asked).toEqual([]);
    ready = true;
    cursors.lookAgain();
    expect(asked.length).toBe(1);
    expect([cursors.refused("another"), cursors.refused(asked[0]!.id)]).toEqual([false, true]);
    vi.advanceTimersByTime(200);
    cursors.lookAgain();
    expect(asked.length).toBe(2);
    vi.advanceTimersByTime(2100);
    cursors.lookAgain();
    expect(asked.length).toBe(3);
    expect(cursors.answer({ op: "picked", id: asked[1]!.id, hit: false })).toBe(false);
  });
});
