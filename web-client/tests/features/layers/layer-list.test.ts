import { describe, expect, it, vi } from "vitest";

import type { Api } from "../../../src/net/api";
import type { Layer, LayerPatch } from "../../../src/core/types";
import { presencePalette } from "../../../src/domain/palette";
import { PersonalViewKeeper } from "../../../src/features/layers/personal-view";
import { LayerList } from "../../../src/features/layers/layer-list";

const red = presencePalette("x", "#ff0000ff");
const blue = presencePalette("x", "#0000ffff");
const green = presencePalette("x", "#00ff00ff");

function layerList(): { list: LayerList; changes: LayerPatch[]; cracks: Layer; pieces: Layer } {
  const changes: LayerPatch[] = [];
  const list = new LayerList({} as Api, "1", { sendOverrides: vi.fn(), changed: vi.fn() });
  const layer = (id: number): Layer =>
    ({ id, slug: `l${id}`, palette: red, opacity: 1, visible: true, order: id }) as Layer;
  list.all = [layer(1), layer(2)];
  vi.spyOn(list, "change").mockImplementation((_layer, patch) => {
    changes.push(patch);
    return Promise.resolve();
  });
  const [cracks, pieces] = list.all as [Layer, Layer];
  return { list, changes, cracks, pieces };
}

describe("layers that are shown like those of another model", () => {
  it("are stored only if they differ from what the user sees", async () => {
    const { list, cracks, pieces } = layerList();
    const keep = vi.spyOn(PersonalViewKeeper.prototype, "keep").mockImplementation(() => {});
    [cracks.name, pieces.name] = ["Cracks", "Pieces"];
    list.showAlike(new Map([["Cracks", { visible: true, opacity: 1 }]]));
    expect(keep).not.toHaveBeenCalled();
    const hidden = { visible: false, opacity: 1 };
    list.showAlike(
      new Map([
        ["Cracks", { visible: true, opacity: 1 }],
        ["Pieces", hidden],
      ]),
    );
    expect(keep).toHaveBeenCalledExactlyOnceWith({ layers: [{ layer: 2, visible: false }] });
    expect([list.visible(cracks), list.visible(pieces)]).toEqual([true, false]);
    keep.mockRestore();
  });
});

describe("the default of the layers", () => {
  it("has the palettes that the user chose", async () => {
    const { list, changes, cracks } = layerList();
    list.setPalette(cracks, blue);
    await list.saveOverridesAsDefault();
    expect(changes).toEqual([{ visible: true, opacity: 1, order: 1, palette: blue }]);
  });

  it("leaves out a palette that a dialog only previews, and still shows it", async () => {
    const { list, changes, cracks, pieces } = layerList();
    list.previewPalette(cracks, green);
    list.setPalette(pieces, blue);
    await list.saveOverridesAsDefault();
    expect(changes).toEqual([{ visible: true, opacity: 1, order: 2, palette: blue }]);
    expect(list.palette(cracks)).toEqual(green);
  });

  it("has a previewed palette after the user chose it", async () => {
    const { list, changes, cracks } = layerList();
    list.previewPalette(cracks, green);
    list.setPalette(cracks, green);
    await list.saveOverridesAsDefault();
    expect(changes).toEqual([{ visible: true, opacity: 1, order: 1, palette: green }]);
  });
});
