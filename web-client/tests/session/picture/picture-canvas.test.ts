import { describe, expect, it } from "vitest";
import { StrataPictureCanvas } from "../../../src/session/picture/picture-canvas";
import type { PicturePart, PictureTool } from "../../../src/session/picture/picture-drawing";

/** A canvas in a page without a layout. Its picture is 100 × 100 CSS pixels and units large. */
class Page {
  readonly canvas = new StrataPictureCanvas();
  readonly drawn: PicturePart[] = [];

  constructor(tool: PictureTool) {
    const { canvas } = this;
    const img = { getBoundingClientRect: () => ({ left: 0, top: 0, width: 100, height: 100 }) };
    Object.defineProperty(canvas, "renderRoot", { value: { querySelector: () => img } });
    Object.assign(canvas, { origin: [0, 100], tool, label: "Paint", alt: "A wall" });
    canvas.addEventListener("drawn", (event) =>
      this.drawn.push((event as CustomEvent<PicturePart>).detail),
    );
    this.load();
  }

  /** Returns the value of an attribute or event in the template. */
  attribute(name: string): unknown {
    const { strings, values } = this.canvas.render();
    return values[strings.findIndex((text) => text.endsWith(` ${name}=`))];
  }

  load(size = 100): void {
    this.fire("load", { target: { naturalWidth: size, naturalHeight: size } });
  }

  at(type: "pointerdown" | "pointermove" | "pointerup" | "pointercancel", x = 0, y = 0): void {
    this.fire(type, {
      button: 0,
      isPrimary: true,
      clientX: x,
      clientY: y,
      currentTarget: { setPointerCapture: () => {} },
    });
  }

  click(x: number, y: number): void {
    this.at("pointerdown", x, y);
    this.at("pointerup");
  }

  /** Returns whether the canvas used the key. */
  key(key: string): boolean {
    let calls = 0;
    const call = (): void => void ++calls;
    this.fire("keydown", { key, preventDefault: call, stopPropagation: call });
    return calls === 2;
  }

  private fire(type: string, event: object): void {
    (this.attribute(`@${type}`) as (event: object) => void).call(this.canvas, event);
  }
}

const dab = (x: number, y: number): PicturePart => ({
  stroke: { path: [[x, y]], radius: 1 },
});

describe("the canvas of a picture", () => {
  it("does not draw until a picture of another size is loaded", () => {
    const page = new Page("brush");
    page.click(10, 20);
    page.canvas.unitPerPixel = 0.5;
    page.canvas.willUpdate(new Map([["unitPerPixel", 1]]));
    page.click(30, 40);
    page.load(200);
    page.click(50, 60);
    expect(page.drawn).toEqual([dab(10, 80), dab(50, 40)]);
  });

  it("discards an open stroke if the size of the picture changes", () => {
    const page = new Page("brush");
    page.at("pointerdown", 10, 20);
    page.canvas.willUpdate(new Map([["unitPerPixel", 1]]));
    page.load();
    page.at("pointermove", 30, 20);
    page.at("pointerup");
    expect(page.drawn).toEqual([]);
  });

  it("continues a stroke on a newer picture of the same place", () => {
    const page = new Page("brush");
    page.at("pointerdown", 10, 20);
    page.canvas.willUpdate(new Map([["picture", "blob:1"]]));
    page.at("pointerup");
    expect(page.drawn).toEqual([dab(10, 80)]);
  });

  it("discards an open stroke or area with Escape, and leaves other Escapes to the dialog", () => {
    const brush = new Page("brush");
    expect(brush.key("Escape")).toBe(false);
    brush.at("pointerdown", 10, 20);
    expect(brush.key("Escape")).toBe(true);
    brush.at("pointerup");
    expect(brush.drawn).toEqual([]);
    expect(brush.key("Escape")).toBe(false);
    const area = new Page("area");
    expect(area.key("Enter")).toBe(false);
    area.click(10, 20);
    expect(area.key("Escape")).toBe(true);
    expect(area.key("Escape")).toBe(false);
  });

  it("keeps the corners of an area if a pointer is canceled", () => {
    const page = new Page("area");
    for (const [x, y] of [
      [0, 0],
      [90, 0],
      [90, 90],
    ])
      page.click(x!, y!);
    page.at("pointerdown", 0, 90);
    page.at("pointercancel");
    expect(page.key("Enter")).toBe(true);
    expect(page.drawn).toEqual([
      {
        polygon: [
          [0, 100],
          [90, 100],
          [90, 10],
        ],
      },
    ]);
  });

  it("has one label", () => {
    const drawing = new Page("area");
    expect(drawing.attribute("aria-label")).toBe("Paint");
    expect(drawing.attribute("alt")).toBe("");
    expect(new Page("move").attribute("alt")).toBe("A wall");
  });
});
