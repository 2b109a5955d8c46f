import { describe, expect, it } from "vitest";
import type { Picture } from "../../src/math/edge-costs";
import { kInside, kOutside } from "../../src/math/random-walker";
import { colorLeaning, kMostLeaning } from "../../src/math/seed-colors";

const row = (channels: 1 | 4, ...colors: number[][]): Picture => ({
  width: colors.length,
  height: 1,
  channels,
  pixels: Uint8Array.from(colors.flat()),
});
const red = [200, 20, 20, 255];
const blue = [20, 20, 200, 255];
const green = [20, 200, 20, 255];

describe("The leaning of a pixel", () => {
  it("is to the side with its color, and weakly to the outside for an unseen color", () => {
    const picture = row(4, red, blue, red, [190, 26, 22, 0], blue, green);
    const given = Uint8Array.from([kInside, kOutside, 0, 0, 0, 0]);
    const [ofInside, ofOutside, same, similar, other, unseen] = colorLeaning(picture, given);
    expect([ofInside, ofOutside]).toEqual([0, 0]);
    expect(same).toBeGreaterThan(0.9 * kMostLeaning);
    expect(similar).toBeGreaterThan(0.9 * kMostLeaning);
    expect(other).toBeLessThan(-0.9 * kMostLeaning);
    expect(unseen).toBeCloseTo(-0.25 * kMostLeaning, 4);
  });

  it("is that of the gray value in a picture with one channel", () => {
    const given = Uint8Array.from([kInside, kOutside, 0, 0]);
    const leaning = colorLeaning(row(1, [0], [255], [3], [250]), given);
    expect(leaning[2]).toBeGreaterThan(0.9 * kMostLeaning);
    expect(leaning[3]).toBeLessThan(-0.9 * kMostLeaning);
  });

  it("is weak if the sides share most colors, and absent if they have the same", () => {
    const ofShared = (outside: number[][]): number => {
      const picture = row(4, red, red, blue, ...outside, blue);
      const given = new Uint8Array(picture.width);
      given.fill(kInside, 0, 3);
      given.fill(kOutside, 3, picture.width - 1);
      return colorLeaning(picture, given)[picture.width - 1]!;
    };
    expect(ofShared([red, red, green])).toBeGreaterThan(0.05 * kMostLeaning);
    expect(ofShared([red, red, green])).toBeLessThan(0.2 * kMostLeaning);
    expect(ofShared([red, red, blue])).toBeCloseTo(0, 9);
  });

  it("is absent while only one side is given", () => {
    const picture = row(4, red, red);
    expect([...colorLeaning(picture, Uint8Array.from([kInside, 0]))]).toEqual([0, 0]);
    expect([...colorLeaning(picture, Uint8Array.from([kOutside, 0]))]).toEqual([0, 0]);
  });
});
