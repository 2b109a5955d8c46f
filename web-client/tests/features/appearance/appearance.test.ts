import { beforeEach, describe, expect, it, vi } from "vitest";

import { Appearance } from "../../../src/features/appearance/appearance";
import { notices } from "../../../src/ui/notices";
import { Api } from "../../../src/net/api";
import { OrbitCamera } from "../../../src/math/camera";
import { anglesOf, directionOf, onPad, padPoint } from "../../../src/math/light";
import type { Light, Look, LookShown, Plane } from "../../../src/core/protocol.gen";
import { noSection, sectionPlanes, withBoxSide } from "../../../src/math/section";
import { withRange } from "../../../src/domain/palette";

const bounds = {
  min: [0, 10, -4] as [number, number, number],
  max: [2, 20, 4] as [number, number, number],
};
const above = (plane: Plane, [x, y, z]: [number, number, number]): boolean =>
  plane[0] * x + plane[1] * y + plane[2] * z + plane[3] >= 0;

describe("sections", () => {
  it("cuts across an axis and keeps the lower side, or the other when flipped", () => {
    const [plane] = sectionPlanes({ ...noSection(), mode: "y", position: 0.25 }, bounds);
    expect(above(plane!, [1, 12, 0])).toBe(true);
    expect(above(plane!, [1, 13, 0])).toBe(false);
    const [other] = sectionPlanes(
      { ...noSection(), mode: "y", position: 0.25, flipped: true },
      bounds,
    );
    expect(above(other!, [1, 12, 0])).toBe(false);
  });

  it("makes a box of the sides that were moved, six at most", () => {
    const whole = { ...noSection(), mode: "box" as const };
    expect(sectionPlanes(whole, bounds)).toEqual([]);
    const one = withBoxSide(whole, "min", 0, 0.5);
    expect(sectionPlanes(one, bounds)).toEqual([[1, 0, 0, -1]]);
    let all = whole as ReturnType<typeof noSection>;
    for (const axis of [0, 1, 2])
      all = withBoxSide(withBoxSide(all, "min", axis, 0.2), "max", axis, 0.8);
    const planes = sectionPlanes(all, bounds);
    expect(planes).toHaveLength(6);
    expect(planes.every((plane) => above(plane, [1, 15, 0]))).toBe(true);
    expect(planes.every((plane) => above(plane, [1.9, 15, 0]))).toBe(false);
  });

  it("never turns a box inside out", () => {
    const narrow = withBoxSide(withBoxSide(noSection(), "max", 2, 0.3), "min", 2, 0.9);
    expect(narrow.box.min[2]).toBeLessThan(narrow.box.max[2]);
    expect(withBoxSide(noSection(), "max", 0, -5).box.max[0]).toBeGreaterThan(0);
  });

  it("go out with the camera, and only where there are some", () => {
    const camera = new OrbitCamera();
    expect("section" in camera.message()).toBe(false);
    camera.section = [[0, 0, 1, 2]];
    expect(camera.message().section).toEqual([[0, 0, 1, 2]]);
  });
});

describe("the light's pad", () => {
  it("is the hemisphere before the viewer", () => {
    expect(directionOf({ x: 0, y: 0 })).toEqual([0, 0, 1]);
    const [x, y, z] = directionOf({ x: 3, y: 4 });
    expect(Math.hypot(x, y, z)).toBeCloseTo(1);
    expect(y / x).toBeCloseTo(4 / 3);
    expect(z).toBeGreaterThan(0.05);
  });

  it("finds the point of a direction again, of any length", () => {
    const point = padPoint([-0.6, 0.2, 2]);
    const again = padPoint(directionOf(point));
    expect(again.x).toBeCloseTo(point.x);
    expect(again.y).toBeCloseTo(point.y);
    expect(onPad({ x: 0.1, y: 0.2 })).toEqual({ x: 0.1, y: 0.2 });
  });

  it("is told in words", () => {
    expect(anglesOf({ x: 0, y: 1 }).from).toBe(0);
    expect(anglesOf({ x: 1, y: 0 }).from).toBe(90);
    expect(anglesOf({ x: -1, y: 0 }).from).toBe(270);
    expect(anglesOf({ x: 0, y: 0 }).above).toBe(90);
  });
});

const look = (id: number, visible: boolean): Look => ({
  id,
  name: `L${id}`,
  slug: `l${id}`,
  description: "",
  media_type: "image/png",
  width: 8,
  height: 8,
  bytes: 9,
  sha256: "a".repeat(64),
  opacity: 1,
  visible,
  order: id,
});

describe("how a person sees the model", () => {
  let sent: [LookShown[] | null, Light][];
  let planes: Plane[];
  let hidden: readonly number[];
  let server: Look[];
  let refuseAfter: number;
  let appearance: Appearance;

  beforeEach(() => {
    sent = [];
    planes = [];
    hidden = [];
    server = [look(1, true), look(2, false), look(3, false)];
    refuseAfter = Infinity;
    const answer = (body: unknown): Response =>
      new Response(JSON.stringify(body), { headers: { ETag: '"1"' } });
    const api = new Api(async (path, init) => {
      const id = Number(/looks\/(\d+)/.exec(path)?.[1]);
      if (!id) return answer({ looks: server, total: server.length });
      if (init?.method === "PATCH") {
        if (refuseAfter-- <= 0) return new Response("", { status: 503 });
        server = server.map((each) =>
          each.id === id ? { ...each, ...(JSON.parse(String(init.body)) as Partial<Look>) } : each,
        );
      }
      return answer(server.find((each) => each.id === id));
    });
    appearance = new Appearance(api, "1", {
      send: (looks, light) => sent.push([looks, light]),
      sendSection: (of, parts) => ([planes, hidden] = [of, parts]),
      bounds: () => bounds,
      changed: vi.fn(),
    });
    appearance.takeLooks([look(1, true), look(2, false), look(3, false)]);
  });

  it("follows what everyone sees until something is chosen", () => {
    expect(sent.at(-1)![0]).toBeNull();
    appearance.setVisible(appearance.looks[1]!, true);
    appearance.setOpacity(appearance.looks[1]!, 0.5);
    expect(sent.at(-1)![0]).toEqual([
      { look: 1, opacity: 1 },
      { look: 2, opacity: 0.5 },
    ]);
    appearance.setVisible(appearance.looks[1]!, false);
    appearance.setOpacity(appearance.looks[1]!, 1);
    expect(sent.at(-1)![0]).toBeNull();
  });

  it("shows four looks and no more", () => {
    const told = vi.spyOn(notices, "show");
    appearance.takeLooks([1, 2, 3, 4, 5].map((id) => look(id, id < 5)));
    appearance.setVisible(appearance.looks[4]!, true);
    expect(appearance.visible(appearance.looks[4]!)).toBe(false);
    expect(told).toHaveBeenCalledOnce();
  });

  it("forgets a look that is gone", () => {
    appearance.setVisible(appearance.looks[2]!, true);
    appearance.onEvent({ op: "look", event: "deleted", look_id: 3 });
    expect(appearance.looks.map(({ id }) => id)).toEqual([1, 2]);
    expect(sent.at(-1)![0]).toBeNull();
    appearance.onEvent({ op: "look", event: "created", look_id: 9, look: look(9, false) });
    expect(appearance.looks.map(({ id }) => id)).toEqual([1, 2, 9]);
  });

  it("moves a look for everyone, and shows what the server has where that fails", async () => {
    await appearance.move(appearance.looks[2]!, 0);
    expect(appearance.looks.map(({ id }) => id)).toEqual([3, 1, 2]);
    expect([...server].sort((a, b) => a.order - b.order).map(({ id }) => id)).toEqual([3, 1, 2]);
    refuseAfter = 1;
    await expect(appearance.move(appearance.looks[2]!, 0)).rejects.toThrow();
    const kept = [...server].sort((a, b) => a.order - b.order || a.id - b.id).map(({ id }) => id);
    expect(appearance.looks.map(({ id }) => id)).toEqual(kept);
  });

  it("renames a look", async () => {
    await appearance.rename(appearance.looks[1]!, "Infrared");
    expect(appearance.looks[1]!.name).toBe("Infrared");
    expect(server[1]!.name).toBe("Infrared");
  });

  it("goes back to the beginning at once", () => {
    appearance.setLight({ mode: "raking", direction: [1, 0, 0.2] });
    appearance.setSection({ mode: "x" });
    appearance.setHiddenParts(new Set([12, 3]));
    expect(sent.at(-1)![1]).toEqual({
      mode: "raking",
      direction: [1, 0, 0.2],
      fill: 0.3,
      layer_opacity: 0.3,
    });
    expect(planes).toHaveLength(1);
    expect(hidden).toEqual([3, 12]);
    expect(appearance.isDefault).toBe(false);
    appearance.reset();
    expect(appearance.isDefault).toBe(true);
    expect(planes).toEqual([]);
    expect(hidden).toEqual([]);
    expect(sent.at(-1)![1].mode).toBe("museum");
  });

  it("counts an exposure as a change, in every light", () => {
    appearance.setLight({ exposure: -1.5 });
    expect(sent.at(-1)![1]).toMatchObject({ mode: "museum", exposure: -1.5 });
    expect(sent.at(-1)![1]).not.toHaveProperty("fill");
    expect(appearance.isDefault).toBe(false);
    appearance.reset();
    expect(sent.at(-1)![1]).not.toHaveProperty("exposure");
  });

  it("shows a view of an earlier release as it was", () => {
    const back = appearance.showView({
      camera: {},
      light: { mode: "raking", direction: [1, 0, 1] },
    });
    expect(sent.at(-1)![1]).toMatchObject({ fill: 0, layer_opacity: 1 });
    expect(appearance.toKeep().light).toEqual(sent.at(-1)![1]);
    back();
    appearance.setLight({ mode: "raking" });
    expect(sent.at(-1)![1]).toMatchObject({ fill: 0.3, layer_opacity: 0.3 });
  });

  it("steps through lights and cuts by a key each", () => {
    appearance.nextLight();
    expect(appearance.light.mode).toBe("headlight");
    for (let i = 0; i < 3; ++i) appearance.nextLight();
    expect(appearance.light.mode).toBe("museum");
    for (let i = 0; i < 4; ++i) appearance.nextSection();
    expect(appearance.section.mode).toBe("off");
  });
});

describe("the range of a palette", () => {
  it("moves with the same colours at the same shares of it", () => {
    const points = [
      { at: 10, color: "#000000ff" },
      { at: 15, color: "#888888ff" },
      { at: 20, color: "#ffffffff" },
    ];
    const moved = withRange({ mode: "linear", min: 10, max: 20, points }, 0, 4);
    expect([moved.min, moved.max, ...moved.points.map(({ at }) => at)]).toEqual([0, 4, 0, 2, 4]);
    expect(moved.points.map(({ color }) => color)).toEqual(points.map(({ color }) => color));
  });
});
