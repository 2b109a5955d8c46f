// The design of kiosks: its colors, and the colors that are refused.
import { describe, expect, it } from "vitest";
import {
  contrast,
  kModeColors,
  problemOfTheme,
  propertiesOf,
  roomOf,
} from "../../src/domain/tour-theme";

describe("the design of a tour", () => {
  it("measures contrast as WCAG does", () => {
    expect(contrast("#000000", "#ffffff")).toBeCloseTo(21, 5);
    expect(contrast("#777777", "#ffffff")).toBeCloseTo(4.48, 2);
    expect(contrast("#123456", "#123456")).toBe(1);
  });

  it("is readable without own colors, in both modes", () => {
    for (const mode of ["light", "dark"] as const) expect(problemOfTheme({ mode })).toBeNull();
    expect(roomOf(undefined).bottom).toBe(kModeColors.light.background);
    expect(roomOf({ mode: "dark" }).bottom).toBe(kModeColors.dark.background);
  });

  it("refuses a background on which the text of the mode is hard to read", () => {
    expect(problemOfTheme({ background: "#202020" })?.field).toBe("background");
    expect(problemOfTheme({ mode: "dark", background: "#f0f0f0" })?.field).toBe("background");
    expect(problemOfTheme({ mode: "dark", background: "#a04030" })?.needed).toBe(7);
    expect(problemOfTheme({ mode: "dark", background: "#3a0810" })).toBeNull();
  });

  it("refuses an accent that disappears in the background, and names the color that was chosen", () => {
    expect(problemOfTheme({ accent: "#ffe680" })?.field).toBe("accent");
    expect(problemOfTheme({ accent: "#a02020" })).toBeNull();
    expect(problemOfTheme({ mode: "dark", accent: "#203040" })?.field).toBe("accent");
  });

  it("writes on the accent color with whichever of black and white is easier to read", () => {
    expect(propertiesOf({ accent: "#a02020" })["--accent-ink"]).toBe("#ffffff");
    expect(propertiesOf({ mode: "dark", accent: "#ffd23f" })["--accent-ink"]).not.toBe("#ffffff");
    expect(propertiesOf({ font: "sans" })["--heading"]).toBe("var(--sans)");
  });
});
