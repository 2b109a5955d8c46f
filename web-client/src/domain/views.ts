// The settings that saved views store and apply. They refer to layers and surface images by id.
// This file does not include the name and text of a view.

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

/** The camera and all display settings. They reproduce the view even if the defaults change. */
export type ViewContent = Required<Pick<View, "camera" | "layers" | "looks" | "light">>;

/** A user's settings for a layer. If a member is absent, the layer's default applies. */
export interface LayerShown {
  visible?: boolean;
  opacity?: number;
  palette?: Palette;
  order?: number;
  highlight?: Highlight;
}

/** A user's settings for a surface image. If a member is absent, the image's default applies. */
export interface LookSettings {
  visible?: boolean;
  opacity?: number;
}

/**
 * Returns the layer settings that a view stores. They always include visibility and opacity,
 * because the defaults may change. They include palette, order and highlight only if the user has
 * changed them.
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
 * Returns the settings of a layer that differ from the defaults, or null. Highlights are not
 * included, because they belong to views.
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

/** Returns the settings of a view's existing layers, by id. */
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
 * Returns the settings of a view's existing surface images, by id, and the stack of visible images
 * from bottom to top. A view without `looks` shows the defaults.
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
