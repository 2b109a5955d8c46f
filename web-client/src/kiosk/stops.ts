// The contents of a tour's stops: the existing stops, and the layers that visitors can choose at
// each stop.

import type { LayerOverride, Tour, TourStop, View } from "../core/protocol.gen";
import type { Layer } from "../core/types";
import { layersOfView } from "../domain/views";

/** A stop with its view. */
export interface Stop {
  stop: TourStop;
  view: View;
}

/** Returns the stops whose views exist. The keys of `views` are slugs. */
export const stopsOf = (tour: Pick<Tour, "stops">, views: ReadonlyMap<string, View>): Stop[] =>
  tour.stops.flatMap((stop) => {
    const view = stop.view === undefined ? undefined : views.get(stop.view);
    return view ? [{ stop, view }] : [];
  });

export const stepFrom = (index: number, by: number, count: number): number =>
  (((index + by) % count) + count) % count;

/** The layer that a visitor chose at a stop. Null shows the layers as saved in the view. */
export type LayerChoice = Layer | null;

/**
 * Returns the choices at a stop: the view as saved, then the stop's existing layers. The view as
 * saved is omitted if it shows exactly one of these layers.
 */
export function choicesOf({ stop, view }: Stop, layers: readonly Layer[]): LayerChoice[] {
  const offered = stop.layers.flatMap((slug) => layers.find((layer) => layer.slug === slug) ?? []);
  if (offered.length === 0) return [];
  return shownAtFirst({ stop, view }, offered).length === 1 ? offered : [null, ...offered];
}

/** Returns the initial choice at a stop. */
export const firstChoice = (stop: Stop, choices: readonly LayerChoice[]): LayerChoice =>
  choices.includes(null)
    ? null
    : (shownAtFirst(
        stop,
        choices.filter((choice) => choice !== null),
      )[0] ?? null);

function shownAtFirst({ view }: Stop, offered: readonly Layer[]): Layer[] {
  const shown = layersOfView(view, offered);
  return offered.filter((layer) => shown.get(layer.id)?.visible ?? layer.visible);
}

/**
 * Returns the layers of the view. Of the layers that visitors can choose, only the chosen one is
 * visible.
 */
export function layersShown(
  stop: Stop,
  layers: readonly Layer[],
  choices: readonly LayerChoice[],
  chosen: LayerChoice,
): LayerOverride[] {
  const shown = layersOfView(stop.view, layers);
  if (chosen)
    for (const layer of choices)
      if (layer) shown.set(layer.id, { ...shown.get(layer.id), visible: layer.id === chosen.id });
  return [...shown].map(([layer, rest]) => ({ layer, ...rest }));
}

/** Returns the visible layers, the topmost first. */
export function seenLayers(layers: readonly Layer[], overrides: readonly LayerOverride[]): Layer[] {
  const visible = new Map(overrides.map((each) => [each.layer, each.visible]));
  return [...layers]
    .sort((a, b) => b.order - a.order || b.id - a.id)
    .filter((layer) => visible.get(layer.id) ?? layer.visible);
}
