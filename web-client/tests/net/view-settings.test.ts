import { describe, expect, it } from "vitest";
import { ViewSettings } from "../../src/net/view-settings";
import type { Light, Welcome } from "../../src/core/protocol.gen";

const museum = { mode: "museum" } as Light;
const raking = { mode: "raking" } as unknown as Light;

describe("the settings of a view", () => {
  it("are new only where they change what is drawn", () => {
    const settings = new ViewSettings();
    expect([settings.setAppearance(null, museum), settings.differ]).toEqual([false, false]);
    expect([settings.setAppearance(null, raking), settings.differ]).toEqual([true, true]);
    expect(settings.message()).toEqual({ op: "layers", layers: [], light: raking });
    expect([settings.setAppearance(null, museum), settings.differ]).toEqual([true, false]);
    const background = { top: "#000000", bottom: "#ffffff" };
    expect(settings.setBackground(background)).toBe(true);
    expect(settings.setBackground({ ...background })).toBe(false);
    expect(settings.message()).toEqual({ op: "layers", layers: [], background });
  });

  it("lose what is gone, and not the background when nobody looks", () => {
    const settings = new ViewSettings();
    settings.overrides = [{ layer: 1 }, { layer: 2 }];
    settings.setAppearance([{ look: 5 }, { look: 6 }] as never, museum);
    settings.setBackground({ top: "#000000", bottom: "#ffffff" });
    settings.keepOnly({ layers: [{ id: 2 }], looks: [{ id: 5 }] } as unknown as Welcome);
    expect(settings.message()).toMatchObject({ layers: [{ layer: 2 }], looks: [{ look: 5 }] });
    settings.forgetShown();
    expect(settings.message()).toEqual({
      op: "layers",
      layers: [],
      background: { top: "#000000", bottom: "#ffffff" },
    });
  });
});
