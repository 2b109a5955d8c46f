import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { BrushSettings } from "../../src/features/painting/brush-settings";
import { describeValue, valueProblem } from "../../src/session/layer-values";
import type { DroppedFile } from "../../src/ui/drop";
import { chooseScans, tellLeftOut } from "../../src/features/home/imports";
import { arrowStep } from "../../src/ui/keyboard";
import { layerChanges } from "../../src/features/layers/layer-changes";
import { notices } from "../../src/ui/notices";
import { PickProbe, type PickPurpose } from "../../src/session/pick-probe";
import { pathOfProject, routeOf } from "../../src/ui/routes";
import { texts } from "../../src/texts";
import {
  classPalette,
  measurementPalette,
  presencePalette,
  recordPalette,
} from "../../src/domain/palette";
import type { Layer, Palette, ValueType } from "../../src/core/types";

const layer = (type: ValueType, palette: Palette, unit = ""): Layer => ({
  id: 7,
  model: 1,
  name: "L",
  slug: "l",
  kind: "numeric",
  type,
  resolution: 2048,
  unit,
  description: "",
  labels: {},
  descriptions: {},
  palette,
  opacity: 1,
  visible: true,
  locked: false,
  review: false,
  visibility: "public",
  order: 0,
  sequence: 0,
});
const classes = classPalette([
  { at: 2, label: "Plaster", color: "#ffffffff" },
  { at: 5, label: "", color: "#000000ff" },
]);

describe("the brush's value", () => {
  it("starts with the first class, presence, or the middle of a measurement", () => {
    const brush = new BrushSettings();
    expect(brush.valueFor(layer("u8", classes))).toBe(2);
    expect(new BrushSettings().valueFor(layer("u8", presencePalette("Salt", "#ffffffff")))).toBe(1);
    expect(new BrushSettings().valueFor(layer("f32", measurementPalette(0, 0.3)))).toBe(0.15);
    expect(new BrushSettings().valueFor(layer("i16", measurementPalette(0, 5)))).toBe(3);
  });
  it("is kept per layer", () => {
    const brush = new BrushSettings();
    const one = layer("u8", classes);
    brush.setValue(one, 5);
    expect(brush.valueFor(one)).toBe(5);
    expect(brush.valueFor({ ...one, id: 8 })).toBe(2);
  });
  it("is refused in plain words where the layer cannot hold it", () => {
    expect(valueProblem(layer("u8", classes), 256)).toBe(texts.brush.out_of_range("0", "255"));
    expect(valueProblem(layer("u8", classes), 1.5)).toBe(texts.brush.whole_number);
    expect(valueProblem(layer("f32", classes), Number.NaN)).toBe(texts.brush.bad_value);
    expect(valueProblem(layer("f32", classes), 1.5)).toBeNull();
  });
  it("is told by its label, or with its unit", () => {
    expect(describeValue(layer("u8", classes), 2)).toBe("Plaster");
    expect(describeValue(layer("u8", classes), 5)).toBe("Class 5");
    expect(describeValue(layer("f32", measurementPalette(0, 1), "%"), 12.3456)).toBe("12.35 %");
  });
  it("a width stays within its limits, and each step of the keys changes it", () => {
    const brush = new BrushSettings();
    brush.setWidth("px", 1e9);
    expect(brush.width.px).toBe(2000);
    brush.setWidth("px", Number.NaN);
    expect(brush.width.px).toBe(2000);
    brush.setWidth("px", 2);
    brush.stepWidth(1);
    expect(brush.width.px).toBeGreaterThan(2);
    brush.unit = "mm";
    brush.setWidth("mm", 10);
    brush.stepWidth(-1);
    expect(brush.width.mm).toBeLessThan(10);
  });
});

describe("records", () => {
  it("are painted by number, and told by it", () => {
    const finds: Layer = { ...layer("u32", recordPalette()), kind: "database" };
    expect(new BrushSettings().valueFor(finds)).toBe(1);
    expect(describeValue(finds, 4711)).toBe("Record 4711");
    const names = {
      label: (table: number, key: number) => (table === 3 && key === 4711 ? "Fibula" : null),
      term: () => null,
    };
    expect(describeValue({ ...finds, table: 3 }, 4711, names)).toBe("Fibula");
    expect(describeValue({ ...finds, table: 3 }, 4712, names)).toBe("Record 4712");
    expect(valueProblem(finds, 4_294_967_296)).not.toBeNull();
  });
});

describe("a changed layer", () => {
  const old = layer("u8", classes);
  const same = {
    name: "L",
    unit: "",
    description: "",
    labels: {},
    descriptions: {},
    group: "",
    palette: classPalette(classes.points as never),
    blend: "normal" as const,
    visibility: "public" as const,
  };
  it("sends only what was changed", () => {
    expect(layerChanges(old, same)).toEqual({});
    expect(layerChanges(old, { ...same, description: "by eye" })).toEqual({
      description: "by eye",
    });
    expect(layerChanges(old, { ...same, group: "Salts" })).toEqual({ group: "Salts" });
    expect(layerChanges({ ...old, group: "Salts" }, same)).toEqual({ group: "" });
    expect(layerChanges(old, { ...same, blend: "multiply" })).toEqual({ blend: "multiply" });
    expect(layerChanges({ ...old, blend: "screen" }, same)).toEqual({ blend: "normal" });
    expect(layerChanges(old, { ...same, visibility: "team" })).toEqual({ visibility: "team" });
    expect(
      layerChanges(old, {
        ...same,
        labels: { de: "Ebene" },
        descriptions: { de: "nach Augenschein" },
      }),
    ).toEqual({ labels: { de: "Ebene" }, descriptions: { de: "nach Augenschein" } });
    const palette = classPalette([{ at: 2, label: "Lime", color: "#ffffffff" }]);
    expect(layerChanges(old, { ...same, name: "M", palette })).toEqual({ name: "M", palette });
  });
});

describe("radio buttons", () => {
  it("the arrow keys go round, other keys are not theirs", () => {
    expect(
      ["ArrowRight", "ArrowDown", "ArrowLeft", "ArrowUp"].map((key) => arrowStep(key, 0, 3)),
    ).toEqual([1, 1, 2, 2]);
    expect(arrowStep("ArrowRight", 2, 3)).toBe(0);
    expect(arrowStep("Home", 0, 3)).toBeNull();
  });
});

describe("addresses", () => {
  it("name the gallery or a model", () => {
    expect(routeOf("/")).toEqual({ page: "home", project: null });
    expect(routeOf("/projects/villa-giulia")).toEqual({ page: "home", project: "villa-giulia" });
    expect(routeOf(pathOfProject("Día 2/3"))).toEqual({ page: "home", project: "Día 2/3" });
    expect(routeOf("/projects/%")).toEqual({ page: "home", project: null });
    expect(routeOf("/models/12")).toEqual({ page: "model", model: "12" });
    expect(routeOf("/models/muro%203/")).toEqual({ page: "model", model: "muro 3" });
    expect(routeOf("/models/%")).toEqual({ page: "home", project: null });
  });
});

describe("dropped files", () => {
  const named = (...paths: string[]): DroppedFile[] =>
    paths.map((path) => ({ path, file: { name: path.split("/").at(-1)! } as File }));
  const chosen = (...paths: string[]): string[][] =>
    chooseScans(named(...paths)).map((scan) => scan.files.map(({ path }) => path));
  const names = (...paths: string[]): string[] =>
    chooseScans(named(...paths)).map((scan) => scan.name);
  const told = (): string => {
    let titles = "";
    notices.subscribe((shown) => (titles = shown.map((notice) => notice.title).join()))();
    return titles;
  };
  it("one mesh brings all that may belong to it, under the names it knows", () => {
    expect(chosen("a.mtl", "a.obj", "tex.JPG")).toEqual([["a.obj", "a.mtl", "tex.JPG"]]);
    expect(chosen("pot/in/a.gltf", "pot/in/a.bin", "pot/in/tex/c.png", "pot/d.png")).toEqual([
      ["a.gltf", "a.bin", "tex/c.png", "pot/d.png"],
    ]);
  });
  it("of several meshes each brings what is called like it", () => {
    expect(chosen("a.obj", "b.obj", "a.mtl", "b_0.png")).toEqual([
      ["a.obj", "a.mtl"],
      ["b.obj", "b_0.png"],
    ]);
    expect(chosen("x/a.ply", "y/a.ply", "y/a.png")).toEqual([["a.ply"], ["a.ply", "a.png"]]);
  });
  it("of meshes that are called the same each is named with the folders that tell them apart", () => {
    expect(names("a/mesh.obj", "b/mesh.obj", "c/other_pot.ply")).toEqual([
      "a/mesh",
      "b/mesh",
      "other pot",
    ]);
    expect(names("x/in/mesh.obj", "y/in/mesh.obj")).toEqual(["x/in/mesh", "y/in/mesh"]);
    expect(names("mesh.obj", "b/mesh.obj")).toEqual(["mesh", "b/mesh"]);
    expect(names("deep/down/mesh_1.obj")).toEqual(["mesh 1"]);
  });
  it("what is left over is told", () => {
    const files = named("a.obj", "readme.txt");
    const scans = chooseScans(files);
    expect(scans.map((scan) => scan.files.map(({ path }) => path))).toEqual([["a.obj"]]);
    tellLeftOut(files, scans);
    expect(told()).toContain(texts.import.left_out(1, "readme.txt"));
  });
  it("without a mesh each is refused by its own name", () => {
    expect(chosen("a.jpg", "b.txt")).toEqual([["a.jpg"], ["b.txt"]]);
  });
});

describe("the page's words", () => {
  const all = (value: unknown): string =>
    typeof value === "string"
      ? value
      : typeof value === "function"
        ? String((value as (...args: string[]) => unknown)("a", "b"))
        : typeof value === "object" && value !== null
          ? Object.values(value).map(all).join("\n")
          : "";
  it("are those of people who study objects", () => {
    expect(all(texts)).not.toMatch(/texel|atlas|\bu8\b|\bf32\b|shader|websocket/i);
  });
});

describe("the probe under the pointer", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  const setup = () => {
    const asked: { id: string; x: number }[] = [];
    const answered: [number | undefined, PickPurpose][] = [];
    const probe = new PickProbe({
      ready: () => true,
      ask: (id, { x }) => void asked.push({ id, x }),
      answered: (message, purpose) => void answered.push([message.position?.[0], purpose]),
    });
    const answer = (id: string, x: number): boolean =>
      probe.answer({ op: "picked", id, hit: true, position: [x, 0, 0] });
    return { asked, answered, probe, answer };
  };

  it("asks one question at a time, and the newest place next", () => {
    const { asked, probe, answer } = setup();
    for (const x of [1, 2, 3]) probe.ask({ x, y: 0 });
    vi.advanceTimersByTime(500);
    expect(asked.map(({ x }) => x)).toEqual([1]);
    answer(asked[0]!.id, 1);
    expect(asked.map(({ x }) => x)).toEqual([1, 3]);
  });
  it("asks no more often than every 60 ms", () => {
    const { asked, probe, answer } = setup();
    probe.ask({ x: 1, y: 0 });
    answer(asked[0]!.id, 1);
    probe.ask({ x: 2, y: 0 });
    expect(asked.length).toBe(1);
    vi.advanceTimersByTime(70);
    expect(asked.length).toBe(2);
  });
  it("a press is not forgotten when the pointer moves on before the question leaves", () => {
    const { asked, answered, probe, answer } = setup();
    probe.ask({ x: 1, y: 0 });
    probe.ask({ x: 2, y: 0 }, "take");
    probe.ask({ x: 3, y: 0 });
    vi.advanceTimersByTime(70);
    answer(asked[0]!.id, 1);
    answer("another's question", 9);
    answer(asked[1]!.id, 3);
    expect(answered).toEqual([
      [1, "hover"],
      [3, "take"],
    ]);
  });
  it("an answer that never comes, or a refusal, does not stop it", () => {
    const { asked, probe } = setup();
    probe.ask({ x: 1, y: 0 });
    vi.advanceTimersByTime(2100);
    probe.ask({ x: 2, y: 0 });
    expect(probe.refused("something else")).toBe(false);
    expect(probe.refused(asked[1]!.id)).toBe(true);
    vi.advanceTimersByTime(70);
    probe.ask({ x: 3, y: 0 });
    expect(asked.map(({ x }) => x)).toEqual([1, 2, 3]);
  });
});
