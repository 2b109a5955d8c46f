import { describe, expect, it } from "vitest";

import { cellText, namedKeys } from "../../src/domain/cells";
import { describeMark, markLength, marksOf, simplifyLine, summaryOf } from "../../src/domain/marks";
import type { Mark, MarkPlace } from "../../src/core/protocol.gen";

const line = (model: number, ...coordinates: MarkPlace[]): Mark => ({ model, coordinates });
const one = (): number => 1;
/** Returns points along x, in steps of 1. */
const row = (from: number, to: number, z = 0): MarkPlace[] =>
  Array.from({ length: to - from + 1 }, (_, at) => [from + at, 0, z]);

describe("lines and points of a cell", () => {
  const cell = [
    line(1, [0, 0, 0], [3, 4, 0], [3, 4, 12]),
    line(1, [0, 0, 0], [0, 0, 3]),
    line(2, [0, 0, 0], [9, 0, 0]),
  ];

  it("are measured on one model and counted on the others", () => {
    expect(markLength(cell[0]!)).toBe(17);
    expect(summaryOf(cell, { id: 1, unit: "cm" })).toEqual({ here: 2, elsewhere: 1, metres: 0.2 });
    expect(summaryOf(null, { id: 1, unit: "cm" })).toEqual({ here: 0, elsewhere: 0, metres: 0 });
  });

  it("are told one by one by their length or place, in the model's unit", () => {
    expect(describeMark(cell[0]!, "line", { unit: "mm" })).toBe("1.7 cm");
    expect(describeMark(line(1, [1.234567, -2, 300_000.4]), "point", { unit: "m" })).toBe(
      "1.2346, -2, 300000 m",
    );
  });

  it("are no keys of records or files, and those are no marks", () => {
    expect(namedKeys(cell)).toEqual([]);
    expect(marksOf([3, 4])).toEqual([]);
    expect(marksOf(cell)).toBe(cell);
    expect([cellText(cell), cellText([3, 4])]).toEqual(["3", "3 4"]);
  });
});

describe("a line that was seen pixel by pixel", () => {
  it("keeps its ends and what bends it by more than the tolerance, in order", () => {
    const bent = [...row(0, 10), [10, 5, 0], [10, 10, 0.4], [10, 20, 0]] as MarkPlace[];
    expect(simplifyLine(bent, () => 0.5)).toEqual([
      [0, 0, 0],
      [10, 0, 0],
      [10, 20, 0],
    ]);
    expect(simplifyLine(bent, () => 0.3)).toEqual([
      [0, 0, 0],
      [10, 0, 0],
      [10, 10, 0.4],
      [10, 20, 0],
    ]);
    expect(
      simplifyLine(
        [
          [1, 2, 3],
          [4, 5, 6],
        ],
        one,
      ),
    ).toEqual([
      [1, 2, 3],
      [4, 5, 6],
    ]);
  });

  it("stays within the tolerance of each place that is left out", () => {
    const wavy: MarkPlace[] = Array.from({ length: 3000 }, (_, at) => [
      at / 10,
      4 * Math.sin(at / 40),
      Math.cos(at / 90),
    ]);
    const kept = simplifyLine(wavy, () => 0.25);
    expect(kept.length).toBeLessThan(wavy.length / 10);
    const distance = ([x, y, z]: MarkPlace, a: MarkPlace, b: MarkPlace): number => {
      const [dx, dy, dz] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
      const t = Math.min(
        1,
        Math.max(
          0,
          ((x - a[0]) * dx + (y - a[1]) * dy + (z - a[2]) * dz) / (dx * dx + dy * dy + dz * dz),
        ),
      );
      return Math.hypot(x - a[0] - t * dx, y - a[1] - t * dy, z - a[2] - t * dz);
    };
    for (const place of wavy)
      expect(
        Math.min(...kept.slice(1).map((to, at) => distance(place, kept[at]!, to))),
      ).toBeLessThan(0.2501);
  });

  it("closes up where it ends at its beginning", () => {
    const thereAndBack = [...row(0, 20), ...row(0, 20).reverse()];
    expect(simplifyLine(thereAndBack, one)).toEqual([
      [0, 0, 0],
      [20, 0, 0],
      [0, 0, 0],
    ]);
  });
});
