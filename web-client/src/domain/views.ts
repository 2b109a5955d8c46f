// Named views: what they keep of how somebody sees the model, and what follows from it for who
// comes to see it so. Layers and looks are meant by id. What nobody says of a view, its name and
// text, is not of this file.

import { samePalette } from "./palette";
import type {
  Highlight,
  LayerOverride,
  Look,
  LookShown,
  PersonalView,
  View,
} from "../core/protocol.gen";
import { completePalette, type Layer, type Palette } from "../core/types";

/**
 * Where from, and what is shown how: enough to show the same again, whatever the defaults are then.
 */
export type ViewContent = Required<Pick<View, "camera" | "layers" | "looks" | "light">>;

/** How somebody shows a layer. An absent member is the layer's own. */
export interface LayerShown {
  visible?: boolean;
  opacity?: number;
  palette?: Palette;
  order?: number;
  highlight?: Highlight;
}

/** How somebody shows a look. An absent member is the look's own. */
export interface LookSettings {
  visible?: boolean;
  opacity?: number;
}

/**
 * What a view keeps of the layers: visibility and opacity of each, as the defaults may be others
 * later; palettes, places in the order and highlights where they are this person's own.
 */
export const layersToKeep = (
  layers: readonly Layer[],
  shown: (layer: Layer) => LayerShown,
): LayerOverride[] =>
  layers.map((layer) => {
    const {
      visible = layer.visible,
      opacity = layer.opacity,
      palette,
      order,
      highlight,
    } = shown(layer);
    const recolored = palette && !samePalette(palette, layer.palette);
    const moved = order !== undefined && order !== layer.order;
    return {
      layer: layer.id,
      visible,
      opacity,
      ...(recolored ? { palette } : {}),
      ...(moved ? { order } : {}),
      ...(highlight ? { highlight } : {}),
    };
  });

/**
 * Of how a layer is shown, what differs from what everybody sees at first; null: nothing.
 * Highlights are of views.
 */
export function ownPart(
  layer: Layer,
  { visible, opacity, palette, order }: LayerShown,
): LayerShown | null {
  const own: LayerShown = {
    ...(visible !== undefined && visible !== layer.visible ? { visible } : {}),
    ...(opacity !== undefined && Math.abs(opacity - layer.opacity) > 1e-6 ? { opacity } : {}),
    ...(palette && !samePalette(palette, layer.palette) ? { palette } : {}),
    ...(order !== undefined && order !== layer.order ? { order } : {}),
  };
  return Object.keys(own).length > 0 ? own : null;
}

/** How the layers that there are shown in a view, by id. */
export function layersOfView(
  { layers }: Pick<View, "layers"> | PersonalView,
  known: readonly Layer[],
): Map<number, LayerShown> {
  const ids = new Set(known.map(({ id }) => id));
  return new Map(
    layers
      .filter(({ layer }) => ids.has(Number(layer)))
      .map(({ layer, palette, ...rest }) => [
        Number(layer),
        { ...rest, ...(palette ? { palette: completePalette(palette) } : {}) },
      ]),
  );
}

/**
 * How the looks that there are shown in a view, by id, and those that it shows from bottom to top.
 * Without `looks` it shows the defaults.
 */
export function looksOfView(
  { looks }: { looks?: LookShown[] },
  known: readonly Look[],
): { settings: Map<number, LookSettings>; stack: number[] } {
  if (!looks) return { settings: new Map(), stack: [] };
  const shown = new Map(looks.map(({ look, opacity = 1 }) => [Number(look), opacity]));
  const settings = known.map(({ id }): [number, LookSettings] => {
    const opacity = shown.get(id);
    return [id, opacity === undefined ? { visible: false } : { visible: true, opacity }];
  });
  return {
    settings: new Map(settings),
    stack: [...shown.keys()].filter((id) => known.some((look) => look.id === id)),
  };
}
