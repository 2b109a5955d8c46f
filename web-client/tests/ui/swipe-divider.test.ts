import { describe, expect, it } from "vitest";
import { shareAfter } from "../../src/ui/keyboard";

const after = (key: string, share: number, shiftKey = false): number | null =>
  shareAfter({ key, shiftKey }, share);

describe("the divider", () => {
  it("moves with the arrow keys, further with Shift, and not beyond the edges", () => {
    expect(after("ArrowRight", 0.5)).toBeCloseTo(0.52);
    expect(after("ArrowLeft", 0.5)).toBeCloseTo(0.48);
    expect(after("ArrowLeft", 0.5, true)).toBeCloseTo(0.4);
    expect(after("ArrowLeft", 0.01)).toBe(0);
    expect(after("ArrowRight", 0.99)).toBe(1);
  });

  it("moves to the edges with Home and End, and leaves other keys alone", () => {
    expect(after("Home", 0.3)).toBe(0);
    expect(after("End", 0.3)).toBe(1);
    expect(after("a", 0.3)).toBeNull();
    expect(after("ArrowUp", 0.3)).toBeNull();
  });
});
