// Groups of layers in the list of layers. The list shows a group at the position of its topmost
// layer, even if other layers are drawn between the group's layers.

import { plainText } from "../core/search";

interface Grouped {
  id: number;
  group?: string;
}

export interface LayerGroup<L extends Grouped> {
  /** Null for layers without a group. */
  name: string | null;
  layers: L[];
}

/** Groups layers, which are ordered from top to bottom. */
export function groupsOf<L extends Grouped>(layers: readonly L[]): LayerGroup<L>[] {
  const groups: LayerGroup<L>[] = [];
  for (const layer of layers) {
    const name = layer.group ?? null;
    const known = name === null ? groups.at(-1) : groups.find((each) => each.name === name);
    if (known?.name === name) known.layers.push(layer);
    else groups.push({ name, layers: [layer] });
  }
  return groups;
}

/** Returns the names of all groups, in alphabetical order. */
export const groupNames = (layers: readonly Grouped[]): string[] =>
  [...new Set(layers.flatMap(({ group }) => group ?? []))].sort((a, b) => a.localeCompare(b));

/**
 * Returns the group whose name matches the text, ignoring case and accents. If no group matches,
 * returns the trimmed text.
 */
export function groupCalled(text: string, layers: readonly Grouped[]): string {
  const wanted = text.trim();
  return groupNames(layers).find((name) => plainText(name) === plainText(wanted)) ?? wanted;
}

/**
 * Returns the layers from top to bottom after `layer` was moved to `index` in the list without it.
 * The order of the other layers does not change. The layer follows the layer listed above it if
 * both are in the same group. Otherwise it precedes the layer listed below it.
 */
export function withMoved<L extends Grouped>(top: readonly L[], layer: L, index: number): L[] {
  const listed = groupsOf(top)
    .flatMap(({ layers }) => layers)
    .filter(({ id }) => id !== layer.id);
  const above = listed[index - 1];
  const below = listed[index];
  const others = top.filter(({ id }) => id !== layer.id);
  const before = top.findIndex(({ id }) => id === layer.id);
  const isWith = (other: L | undefined): boolean =>
    other !== undefined && (other.group ?? "") === (layer.group ?? "");
  let at = others.length;
  if (above && isWith(above)) at = others.indexOf(above) + 1;
  else if (below) at = others.indexOf(below);
  // If the layer becomes the top of its group, the group keeps its position in the list.
  if (layer.group && !isWith(above) && isWith(below) && isWith(top[before]))
    at = Math.min(at, before);
  others.splice(at, 0, layer);
  return others;
}

/**
 * Returns the index of a layer after one step up (-1) or down (1), in the list without the layer. A
 * layer stays in its group. A layer without a group moves past whole groups. Returns null if no
 * step in this direction is possible.
 */
export function placeAfterStep<L extends Grouped>(
  groups: readonly LayerGroup<L>[],
  layer: L,
  step: 1 | -1,
): number | null {
  const at = groups.findIndex(({ layers }) => layers.includes(layer));
  const group = groups[at];
  if (!group) return null;
  const index = group.layers.indexOf(layer);
  const before = groups.slice(0, at).reduce((sum, { layers }) => sum + layers.length, 0);
  if (group.layers[index + step]) return before + index + step;
  const next = groups[at + step];
  if (group.name !== null || !next) return null;
  return before + index + step * next.layers.length;
}
