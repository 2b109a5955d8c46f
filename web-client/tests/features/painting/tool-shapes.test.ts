import { beforeEach, describe, expect, it } from "vitest";

import { BrushSettings } from "../../../src/features/painting/brush-settings";
import { notices } from "../../../src/ui/notices";
import { texts } from "../../../src/texts";
import { ToolShapes } from "../../../src/features/painting/tool-shapes";
import { Api } from "../../../src/net/api";
import type { Tool, ToolShape } from "../../../src/core/protocol.gen";
import { inSquare, likelyPart, toShape, type ShapePart } from "../../../src/domain/shape";

const tool = (id: number, name: string): Tool => ({
  id,
  name,
  slug: name.toLowerCase(),
  deleted: false,
});

describe("the shapes that all people share", () => {
  let asked: [string, string][];
  let answer: unknown;
  let chosen: ToolShape;
  let shapes: ToolShapes;
  const settle = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

  beforeEach(() => {
    asked = [];
    chosen = "disc";
    answer = { tools: [tool(1, "Star"), tool(2, "Leaf")], total: 2 };
    const api = new Api(async (path, init) => {
      asked.push([init!.method!, path]);
      return new Response(init!.method === "DELETE" ? null : JSON.stringify(answer), {
        status: init!.method === "DELETE" ? 204 : 200,
      });
    });
    shapes = new ToolShapes(api, {
      chosen: () => chosen,
      choose: (shape) => (chosen = shape),
      changed: () => {},
    });
  });

  it("are asked for once somebody looks at them, and after each new connection", async () => {
    shapes.refresh();
    expect(asked).toEqual([]);
    shapes.want();
    shapes.want();
    await settle();
    expect(asked).toEqual([["GET", "/api/v1/tools?limit=1000"]]);
    expect(shapes.list.map(({ name }) => name)).toEqual(["Leaf", "Star"]);
    shapes.refresh();
    expect(asked).toHaveLength(2);
  });

  it("follow what others do, and the brush is round where its shape is gone", async () => {
    shapes.want();
    await settle();
    chosen = 2;
    const told: string[] = [];
    const unsubscribe = notices.subscribe((shown) => told.push(...shown.map(({ title }) => title)));
    shapes.onEvent({ op: "tool", event: "created", tool_id: 3, tool: tool(3, "Axe") });
    shapes.onEvent({ op: "tool", event: "changed", tool_id: 2, tool: tool(2, "Oak leaf") });
    expect(shapes.list.map(({ name }) => name)).toEqual(["Axe", "Oak leaf", "Star"]);
    shapes.onEvent({ op: "tool", event: "deleted", tool_id: 1 });
    expect(chosen).toBe(2);
    expect(told).toEqual([]);
    shapes.onEvent({ op: "tool", event: "deleted", tool_id: 2 });
    expect(chosen).toBe("disc");
    expect(told).toContain(texts.shapes.gone("Oak leaf"));
    unsubscribe();
  });

  it("a new one is chosen; one's own deletion tells nothing", async () => {
    answer = tool(7, "Ring");
    await shapes.add(new Blob(["x"], { type: "image/png" }), "Ring", "dark");
    expect(asked).toEqual([["POST", "/api/v1/tools?name=Ring&part=dark"]]);
    expect(chosen).toBe(7);
    answer = tool(7, "Circle");
    await shapes.rename(shapes.list[0]!, "Circle");
    expect(shapes.find(7)!.name).toBe("Circle");
    await shapes.remove(shapes.list[0]!);
    expect(chosen).toBe("disc");
    expect(shapes.list).toEqual([]);
  });
});

describe("a picture as a shape", () => {
  /** Makes pixels from gray levels. A level below 0 is transparent. */
  const pixels = (
    width: number,
    levels: number[],
  ): { width: number; height: number; data: Uint8ClampedArray } => ({
    width,
    height: levels.length / width,
    data: new Uint8ClampedArray(
      levels.flatMap((level) => (level < 0 ? [0, 0, 0, 0] : [level, level, level, 255])),
    ),
  });

  it("is what is opaque, or what differs from its rim", () => {
    const ring = (outside: number, inside: number): number[] => [
      outside,
      outside,
      outside,
      outside,
      inside,
      outside,
      outside,
      outside,
      outside,
    ];
    expect(likelyPart(pixels(3, ring(255, 0)))).toBe("dark");
    expect(likelyPart(pixels(3, ring(0, 255)))).toBe("light");
    expect(likelyPart(pixels(3, ring(-1, 0)))).toBe("opaque");
  });

  it("takes what is the part by half and more", () => {
    const alpha = (part: ShapePart, levels: number[]): number[] => {
      const picture = pixels(levels.length, levels);
      expect(toShape(picture, part)).toBe(
        picture.data.some((value, at) => at % 4 === 3 && value === 255),
      );
      return levels.map((_, at) => picture.data[4 * at + 3]!);
    };
    expect(alpha("light", [255, 128, 127, 0, -1])).toEqual([255, 255, 0, 0, 0]);
    expect(alpha("dark", [255, 128, 127, 0, -1])).toEqual([0, 0, 255, 255, 0]);
    expect(alpha("opaque", [255, 0, -1])).toEqual([255, 255, 0]);
    expect(alpha("light", [0, 3])).toEqual([0, 0]);
  });

  it("lies in the middle of its square", () => {
    expect(inSquare(100, 50, 256)).toEqual({ x: 0, y: 64, width: 256, height: 128 });
    expect(inSquare(50, 100, 256)).toEqual({ x: 64, y: 0, width: 128, height: 256 });
  });
});

describe("the limit of the slant", () => {
  it("is off at first and stays between 1° and 90°", () => {
    const brush = new BrushSettings();
    expect(brush.slant.limited).toBe(false);
    brush.setSlant(120);
    expect(brush.slant.maxDeg).toBe(90);
    brush.setSlant(0);
    expect(brush.slant.maxDeg).toBe(1);
    brush.setSlant(Number.NaN);
    expect(brush.slant.maxDeg).toBe(1);
  });
});
