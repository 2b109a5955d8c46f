// Calls about layers. They return layers with complete palettes.

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
 * Changes a layer. With `etag`, the change applies only to this version. If another user has
 * changed the layer since, an ApiError with status 412 is thrown. Without `etag`, the change
 * applies to any version.
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
 * Creates a layer. With `expression`, returns the layer, or a job if the shape of the surface must
 * be computed first. With `compute`, returns a job whose result is the layer. Otherwise returns the
 * layer.
 */
export async function createLayerOrJob(
  api: Api,
  model: Id,
  layer: LayerCreate,
): Promise<{ layer: Layer } | { job: Job }> {
  const answer = await api.json("POST /models/{model}/layers", { path: { model }, body: layer });
  return "slug" in answer ? { layer: completeLayer(answer) } : { job: answer };
}

/** Creates a layer without `compute` and `expression`. */
export async function createLayer(api: Api, model: Id, layer: LayerCreate): Promise<Layer> {
  const answer = await api.json("POST /models/{model}/layers", { path: { model }, body: layer });
  return completeLayer(answer as Layer);
}

/** Computes the layer's expression again from its current inputs. */
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
