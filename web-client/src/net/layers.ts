// Layers as calls send and answer them, with palettes that are complete.

import {
  completeLayer,
  type Job,
  type Layer,
  type LayerCreate,
  type LayerPatch,
} from "../core/types";
import type { Api, Versioned } from "./api";
import type { Id } from "./calls";

export async function readLayer(api: Api, model: Id, layer: Id): Promise<Versioned<Layer>> {
  const { value, etag } = await api.versioned("GET /models/{model}/layers/{layer}", {
    path: { model, layer },
  });
  return { value: completeLayer(value), etag };
}

/**
 * With the version that the change was thought out for: another's change in between is an ApiError
 * of status 412. Without, the change stands on its own, and goes onto whatever the layer is now.
 */
export async function changeLayer(
  api: Api,
  model: Id,
  layer: Id,
  change: LayerPatch,
  etag?: string,
): Promise<Layer> {
  const changed = await api.json("PATCH /models/{model}/layers/{layer}", {
    path: { model, layer },
    body: change,
    header: { "If-Match": etag ?? (await readLayer(api, model, layer)).etag },
  });
  return completeLayer(changed);
}

/**
 * With `expression`: the layer, or a job where the surface's shape has to be worked out first. With
 * `compute`: a job, and the layer is there once it is done. Otherwise the layer.
 */
export async function createLayerOrJob(
  api: Api,
  model: Id,
  layer: LayerCreate,
): Promise<{ layer: Layer } | { job: Job }> {
  const answer = await api.json("POST /models/{model}/layers", { path: { model }, body: layer });
  return "slug" in answer ? { layer: completeLayer(answer) } : { job: answer };
}

/** Neither by `compute` nor by `expression`. */
export async function createLayer(api: Api, model: Id, layer: LayerCreate): Promise<Layer> {
  const answer = await api.json("POST /models/{model}/layers", { path: { model }, body: layer });
  return completeLayer(answer as Layer);
}

/** The layer of an expression, from what it reads as it is now. */
export async function recomputeLayer(
  api: Api,
  model: Id,
  layer: Id,
  overwrite = false,
): Promise<Layer> {
  return completeLayer(
    await api.json("POST /models/{model}/layers/{layer}/compute", {
      path: { model, layer },
      ...(overwrite ? { query: { overwrite } } : {}),
    }),
  );
}
