// Groups of layers in the list of layers. A group is shown where its topmost layer is, also if
// other layers are drawn between its own.

import { plainText } from "../core/search";

interface Grouped {
  id: number;
  group?: string;
}

export interface LayerGroup<L extends Grouped> {
  /** Null: layers without a group. */
  name: string | null;
  layers: L[];
}

/** `layers`: top to bottom. */
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

/** The names of all groups, in alphabetical order. */
export const groupNames = (layers: readonly Grouped[]): string[] =>
  [...new Set(layers.flatMap(({ group }) => group ?? []))].sort((a, b) => a.localeCompare(b));

/** The group that has this name in other letters or accents, else the name without blanks. */
export function groupCalled(text: string, layers: readonly Grouped[]): string {
  const wanted = text.trim();
  return groupNames(layers).find((name) => plainText(name) === plainText(wanted)) ?? wanted;
}

/**
 * The layers from top to bottom after `layer` moved to `index` of the list without it. Only this
 * layer changes its place among the others: it follows a layer of its group that is listed above,
 * else it precedes the one that is listed below.
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
  // At the top of its group it stays where the group is listed.
  if (layer.group && !isWith(above) && isWith(below) && isWith(top[before]))
    at = Math.min(at, before);
  others.splice(at, 0, layer);
  return others;
}

/**
 * The place of a layer one step up (-1) or down (1) in the list without it. It stays in its group;
 * a layer without a group passes over whole groups. Null: it is the first or last one.
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
