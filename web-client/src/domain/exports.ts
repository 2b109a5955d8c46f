// 3D models for other programs: the options, and the request to the server.

import type { ModelExportRequest } from "../core/protocol.gen";

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

/** Returns the request. `layers` are the layers in the texture, from bottom to top. */
export function exportRequest(input: ExportInput, layers: readonly number[]): ModelExportRequest {
  return {
    layers: [...layers],
    ...(input.features === null ? {} : { features: input.features }),
    ...(input.size === null ? {} : { texture_size: input.size }),
    texture_format: input.format,
    unlit: input.unlit,
  };
}
