// 3D models for other programs: the options, and the request to the server.

import type { LayerOverride, LookShown, ModelExportRequest } from "../core/protocol.gen";

export const kTextureFormats = ["jpeg", "png"] as const;
/** The widths of textures that the dialog offers, in pixels. */
export const kTextureSizes: readonly number[] = [1024, 2048, 4096, 8192];

/** The input of the dialog. */
export interface ExportInput {
  layers: readonly number[] | null; // null for the layers that the user sees
  features: number | null; // the layer whose records or classes become features
  size: number | null; // null: the server chooses
  format: (typeof kTextureFormats)[number];
  unlit: boolean;
}

/** The input before the first file. */
export const kUsualExport: ExportInput = {
  layers: null,
  features: null,
  size: null,
  format: "jpeg",
  unlit: false,
};

/** What the user sees: settings of layers, and surface images. */
export interface ShownLayers {
  layers?: LayerOverride[];
  looks?: LookShown[];
}

/**
 * Returns the request. The texture shows those of all layers that are `chosen`, with the settings of
 * the user.
 */
export function exportRequest(
  input: ExportInput,
  all: readonly number[],
  chosen: readonly number[],
  shown: ShownLayers,
): ModelExportRequest {
  const settings = new Map((shown.layers ?? []).map((each) => [Number(each.layer), each]));
  return {
    layers: all.map((layer) => ({
      ...settings.get(layer),
      layer,
      visible: chosen.includes(layer),
    })),
    ...(shown.looks ? { looks: shown.looks } : {}),
    ...(input.features === null ? {} : { features: input.features }),
    ...(input.size === null ? {} : { texture_size: input.size }),
    texture_format: input.format,
    unlit: input.unlit,
  };
}
