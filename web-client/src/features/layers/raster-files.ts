// A layer's texels as files, to save and to load, and its outlines for maps.

import { newId } from "../../core/ids";
import { labelOf } from "../../domain/cells";
import { pageLocale } from "../../core/locale";
import type { Layer, Model } from "../../core/types";
import type { Axis } from "../../math/section";
import { formatArea } from "../../domain/measure";
import { ask } from "../../ui/dialog";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { saveFrom } from "../../ui/save-from";
import { texts } from "../../texts";

export const kRasterFormats = ["tif", "png", "npy"] as const;
export type RasterFormat = (typeof kRasterFormats)[number];

/** Returns the format by the file's name, or null if a layer cannot load it. */
export function rasterFormat(filename: string): RasterFormat | null {
  const extension = /\.([a-z]+)$/i.exec(filename)?.[1]?.toLowerCase();
  if (extension === "tiff") return "tif";
  return kRasterFormats.find((format) => format === extension) ?? null;
}

/** Returns the formats for a layer. PNG stores only numbers of 8 and 16 bits. */
export const formatsOf = (layer: Layer): RasterFormat[] =>
  kRasterFormats.filter(
    (format) => format !== "png" || layer.type === "u8" || layer.type === "u16",
  );

export function saveRaster(session: ModelSession, layer: Layer, format: RasterFormat): void {
  saveFrom(
    session.api.url("GET /models/{model}/layers/{layer}/texels.{format}", {
      path: { model: session.modelId, layer: layer.id, format },
    }),
    `${layer.slug}.${format}`,
  );
}

export const kFeatureFormats = ["geojson", "gpkg"] as const;
export type FeatureFormat = (typeof kFeatureFormats)[number];

/** Returns the direction of the plan view. The plan of a wall model with `y` up is in x and z. */
export const planOf = (up: Model["up"]): `-${Axis}` => `-${up.at(-1) as Axis}`;

export function saveFeatures(session: ModelSession, layer: Layer, format: FeatureFormat): void {
  const query = { f: format, along: planOf(session.model?.up ?? "z"), lang: pageLocale() };
  saveFrom(
    session.api.url("GET /models/{model}/layers/{layer}/features", {
      path: { model: session.modelId, layer: layer.id },
      query,
    }),
    `${layer.slug}.${format}`,
  );
}

/** Asks for a file and replaces the layer's content by the file's content. */
export function chooseRaster(session: ModelSession, layer: Layer): void {
  const input = document.createElement("input");
  input.type = "file";
  input.accept = ".tif,.tiff,.png,.npy";
  input.addEventListener("change", () => {
    const [file] = input.files ?? [];
    if (file) void importRaster(session, layer, file);
  });
  input.click();
}

export async function importRaster(session: ModelSession, layer: Layer, file: File): Promise<void> {
  const words = texts.rasters;
  const format = rasterFormat(file.name);
  if (!format) {
    notices.show("problem", words.unknown(file.name), words.known);
    return;
  }
  if (
    !(await ask({
      heading: words.title(labelOf(layer)),
      lead: words.lead(file.name),
      yes: words.replace,
    }))
  )
    return;
  try {
    const { texels_changed: texelsChanged, area_m2: areaM2 } = await session.api.json(
      "PUT /models/{model}/layers/{layer}/texels.{format}",
      {
        path: { model: session.modelId, layer: layer.id, format },
        body: file,
        header: { "Idempotency-Key": newId() },
      },
    );
    if (texelsChanged === 0) notices.show("info", words.same);
    else notices.show("success", texts.areas.changed(formatArea(areaM2)));
  } catch (error) {
    notices.error(error);
  }
}
