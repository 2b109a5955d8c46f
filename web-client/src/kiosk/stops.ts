// The contents of a tour's stops: the existing stops, and the layers that visitors can choose at
// each.

import type { LayerOverride, Tour, TourStop, View } from "../core/protocol.gen";
import type { Layer } from "../core/types";
import { layersOfView } from "../domain/views";

/** A stop with its view. */
export interface Stop {
  stop: TourStop;
  view: View;
}

/** The stops whose views exist; the others are skipped. `views`: by slug. */
export const stopsOf = (tour: Pick<Tour, "stops">, views: ReadonlyMap<string, View>): Stop[] =>
  tour.stops.flatMap((stop) => {
    const view = stop.view === undefined ? undefined : views.get(stop.view);
    return view ? [{ stop, view }] : [];
  });

export const stepFrom = (index: number, by: number, count: number): number =>
  (((index + by) % count) + count) % count;

/** A way in which a stop shows its layers; null: as saved in its view. */
export type LayerChoice = Layer | null;

/**
 * The existing layers of the stop, and before them the view as saved, unless that view shows only
 * one of them.
 */
export function choicesOf({ stop, view }: Stop, layers: readonly Layer[]): LayerChoice[] {
  const offered = stop.layers.flatMap((slug) => layers.find((layer) => layer.slug === slug) ?? []);
  if (offered.length === 0) return [];
  return shownAtFirst({ stop, view }, offered).length === 1 ? offered : [null, ...offered];
}

/** The choice at arrival. */
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

/** The layers of the view; among the choices, only the chosen one. */
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

/** The visible layers, the topmost first. */
export function seenLayers(layers: readonly Layer[], overrides: readonly LayerOverride[]): Layer[] {
  const visible = new Map(overrides.map((each) => [each.layer, each.visible]));
  return [...layers]
    .sort((a, b) => b.order - a.order || b.id - a.id)
    .filter((layer) => visible.get(layer.id) ?? layer.visible);
}
