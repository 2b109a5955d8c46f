import { expect, it } from "vitest";

import { kappaMeaning } from "../../src/domain/kappa";

it("names the strength of agreement on the scale of Landis and Koch", () => {
  for (const [kappa, meaning] of [
    [-1, "poor"],
    [-0.01, "poor"],
    [-0.004, "slight"], // shown as 0.00
    [0, "slight"],
    [0.2, "slight"],
    [0.204, "slight"], // shown as 0.20
    [0.21, "fair"],
    [0.4, "fair"],
    [0.41, "moderate"],
    [0.6, "moderate"],
    [0.61, "substantial"],
    [0.8, "substantial"],
    [0.81, "almost_perfect"],
    [1, "almost_perfect"],
  ] as const)
    expect(kappaMeaning(kappa), String(kappa)).toBe(meaning);
});
