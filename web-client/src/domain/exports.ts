// 3D models for other programs: the options, and the request to the server.

import type { LayerOverride, LookShown, ModelExportRequest } from "../core/protocol.gen";

export const kFileFormats = ["glb", "obj"] as const;
export const kTextureFormats = ["jpeg", "png"] as const;
/** The widths of textures that the dialog offers, in pixels. */
export const kTextureSizes: readonly number[] = [1024, 2048, 4096, 8192];

const kTriangleCounts: readonly number[] = [1e4, 5e4, 1e5, 2e5, 5e5, 1e6, 2e6, 5e6, 1e7, 2e7];

/**
 * Returns the largest numbers of triangles that the dialog offers for a model with `all` triangles,
 * beginning with the largest.
 */
export const triangleCounts = (all: number): number[] =>
  kTriangleCounts.filter((count) => count < all).reverse();

/** The input of the dialog. */
export interface ExportInput {
  file: (typeof kFileFormats)[number];
  layers: readonly number[] | null; // null for the layers that the user sees
  features: number | null; // the layer whose records or classes become features; only in GLB
  part: number | null; // a saved selection; null for the whole model
  triangles: number | null; // null for all
  size: number | null; // null: the server chooses
  format: (typeof kTextureFormats)[number];
  unlit: boolean;
}

/** The input before the first file. */
export const kUsualExport: ExportInput = {
  file: "glb",
  layers: null,
  features: null,
  part: null,
  triangles: null,
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
    format: input.file,
    ...(input.features === null || input.file !== "glb" ? {} : { features: input.features }),
    ...(input.part === null ? {} : { within: { selection: input.part } }),
    ...(input.triangles === null ? {} : { max_triangles: input.triangles }),
    ...(input.size === null ? {} : { texture_size: input.size }),
    texture_format: input.format,
    unlit: input.unlit,
  };
}
