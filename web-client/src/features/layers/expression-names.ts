// The names that a condition or formula for the open model can contain, in groups, and examples
// that use the model's layers.

import type { Column, Model, Table } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { labelOf } from "../../domain/cells";
import { nameInText, type NamedClass, type Suggestion } from "../../domain/completion";
import { formatNumber } from "../../domain/measure";
import { purposeOf } from "../../domain/palette";
import { texts } from "../../texts";

const words = texts.expressions;

export const kSurfaceNames = [
  "x",
  "y",
  "z",
  "area",
  "nx",
  "ny",
  "nz",
  "height",
  "slope",
  "curvature",
] as const;
const kEverywhere = 4; // the first 4 names also work in conditions over stored layers

export interface Name extends Suggestion {
  /** The name that users see. The default is the text itself. */
  label?: string;
  /** The value of a class. After a comparison with the layer, only the value is inserted. */
  value?: number;
}

export interface NameGroup {
  title: string;
  names: Name[];
}

export interface NamesOf {
  layers: readonly Layer[];
  table(id: number): Table | null;
  /** Whether the expression may also be a number. */
  computes: boolean;
}

const isMeasurement = ({ kind, palette }: Layer): boolean =>
  kind === "numeric" && palette.mode !== "categorical";

/** Returns the classes with a label in the layer's legend. Layers of records have no classes. */
const classesOf = (layer: Layer): { at: number; label: string }[] =>
  layer.kind === "numeric" && layer.palette.mode === "categorical" && !layer.palette.column
    ? layer.palette.points.flatMap(({ at, label }) => (label ? [{ at, label }] : []))
    : [];

function layerHint(layer: Layer): string {
  const purpose = purposeOf(layer);
  if (purpose !== "measurement") return words.kinds[purpose];
  const { min, max } = layer.palette;
  return words.range(formatNumber(min), formatNumber(max), layer.unit ?? "");
}

function columnHint({ kind, unit, choices }: Column): string {
  if (kind === "enumeration" && choices) return choices.map((each) => `'${each}'`).join(", ");
  return unit || texts.column_dialog.kinds[kind];
}

/** Returns the names of the classes, for errors where the user typed a name instead of a number. */
export const namedClasses = (layers: readonly Layer[]): NamedClass[] =>
  layers.flatMap((layer) =>
    classesOf(layer).map(({ at, label }) => ({
      layer: nameInText(layer.slug),
      value: at,
      label,
    })),
  );

export function nameGroups({ layers, table, computes }: NamesOf): NameGroup[] {
  const groups: NameGroup[] = [
    {
      title: words.groups.layers,
      names: layers.map((layer) => ({
        text: nameInText(layer.slug),
        label: labelOf(layer),
        hint: layerHint(layer),
      })),
    },
  ];
  for (const layer of layers) {
    const slug = nameInText(layer.slug);
    const classes = classesOf(layer);
    // in a layer with only one class, each painted texel has that class
    if (classes.length > 1)
      groups.push({
        title: words.groups.classes(labelOf(layer)),
        names: classes.map(({ at, label }) => ({
          text: `${slug} = ${at}`,
          label,
          hint: "",
          value: at,
        })),
      });
    const columns = layer.table === undefined ? [] : (table(layer.table)?.columns ?? []);
    if (columns.length > 0)
      groups.push({
        title: words.groups.columns(labelOf(layer)),
        names: columns.map((column) => ({
          text: `${slug}.${nameInText(column.slug)}`,
          label: labelOf(column),
          hint: columnHint(column),
        })),
      });
  }
  const surface = computes ? kSurfaceNames : kSurfaceNames.slice(0, kEverywhere);
  groups.push({
    title: words.groups.surface,
    names: surface.map((text) => ({ text, hint: words.surface[text] })),
  });
  groups.push({
    title: words.groups.functions,
    names: [...words.functions, ...(computes ? words.surface_functions : [])].map(
      ([text, hint]) => ({ text, hint }),
    ),
  });
  return groups.filter(({ names }) => names.length > 0);
}

/** Returns the groups with the names that contain all words of the search. */
export function foundIn(groups: readonly NameGroup[], search: string): NameGroup[] {
  const wanted = search.toLocaleLowerCase().split(/\s+/).filter(Boolean);
  if (wanted.length === 0) return [...groups];
  return groups
    .map(({ title, names }) => ({
      title,
      names: names.filter(({ text, label = "", hint }) => {
        const whole = `${text} ${label} ${hint} ${title}`.toLocaleLowerCase();
        return wanted.every((word) => whole.includes(word));
      }),
    }))
    .filter(({ names }) => names.length > 0);
}

/**
 * Replaces the selection by a name. Returns the text, and the caret position after the name. Adds
 * the spaces that separate the name from its neighbors. After a comparison with its layer, only the
 * number of a class is inserted.
 */
export function withName(
  text: string,
  [from, to]: readonly [number, number],
  name: Name,
): { text: string; caret: number } {
  const before = text.slice(0, from);
  const after = text.slice(to);
  const layer = name.value === undefined ? "" : (name.text.split(" = ")[0] ?? "");
  const compared =
    layer !== "" &&
    new RegExp(`(^|[\\s(])${escaped(layer)}\\s*(=|==|<>|!=|in\\s*\\([^()]*)\\s*$`, "i").test(
      before,
    );
  const written = compared ? String(name.value) : name.text;
  const gap = before === "" || /[\s(]$/.test(before) ? "" : " ";
  const opens = written.endsWith("(") || written.endsWith(" ");
  const space = after === "" ? "" : opens || /^[\s),]/.test(after) ? "" : " ";
  const inserted = gap + written;
  return { text: before + inserted + space + after, caret: (before + inserted).length };
}

const escaped = (text: string): string => text.replaceAll(/[.*+?^${}()|[\]\\]/g, "\\$&");

// ── examples ─────────────────────────────────────────────────────────────────────────────────────

export interface Example {
  text: string;
  does: string;
}

const kMostExamples = 4;

/** Returns a number in the middle of the legend, with few digits. */
function middleOf(low: number, high: number): number {
  const middle = (low + high) / 2;
  const digits = Math.floor(Math.log10(Math.abs(high - low) || 1)) - 1;
  const step = 10 ** digits;
  return Number((Math.round(middle / step) * step).toPrecision(4));
}

/** Returns a short distance on the model, with one digit. */
function nearIn({ bounds: { min, max } }: Pick<Model, "bounds">): number {
  const sides = max.map((high, axis) => high - min[axis]!);
  return Number((Math.max(...sides) / 50).toPrecision(1));
}

/** Returns conditions and, with `computes`, formulas over the model's layers. */
export function examplesFor(
  { layers, table, computes }: NamesOf,
  model: Pick<Model, "bounds" | "unit"> | null,
): Example[] {
  const examples: Example[] = [];
  const add = (text: string, does: string): void => {
    if (examples.length < kMostExamples) examples.push({ text, does });
  };
  const measured = layers.filter(isMeasurement);
  const [first, second] = measured;
  const area = layers.find(
    (layer) => layer.kind === "numeric" && layer.palette.mode === "categorical",
  );
  const withClasses = layers.find((layer) => classesOf(layer).length > 1);
  if (computes && area && model) {
    const near = nearIn(model);
    add(
      `within(${nameInText(area.slug)}, ${near})`,
      words.examples.around(labelOf(area), `${formatNumber(near)} ${model.unit}`),
    );
  }
  if (first) {
    const slug = nameInText(first.slug);
    const middle = middleOf(first.palette.min, first.palette.max);
    const amount = `${formatNumber(middle)}${first.unit ? ` ${first.unit}` : ""}`;
    if (computes && second)
      add(
        `${slug} - ${nameInText(second.slug)}`,
        words.examples.difference(labelOf(first), labelOf(second)),
      );
    else if (computes) add(`${slug} * 2`, words.examples.twice(labelOf(first)));
    add(`${slug} > ${middle}`, words.examples.above(labelOf(first), amount));
    if (area)
      add(
        `${slug} > ${middle} and not valid(${nameInText(area.slug)})`,
        words.examples.above_outside(labelOf(first), amount, labelOf(area)),
      );
  } else if (area) {
    add(`valid(${nameInText(area.slug)})`, words.examples.painted(labelOf(area)));
  }
  if (withClasses) {
    const [, some] = classesOf(withClasses);
    if (some)
      add(
        `${nameInText(withClasses.slug)} = ${some.at}`,
        words.examples.class(labelOf(withClasses), some.label),
      );
  }
  for (const layer of layers) {
    const columns = layer.table === undefined ? [] : (table(layer.table)?.columns ?? []);
    const choice = columns.find(({ kind, choices }) => kind === "enumeration" && choices?.length);
    const column = choice ?? columns.find(({ kind }) => kind === "numeric" || kind === "text");
    if (!column) continue;
    const path = `${nameInText(layer.slug)}.${nameInText(column.slug)}`;
    if (choice)
      add(
        `${path} = '${choice.choices![0]!.replaceAll("'", "''")}'`,
        words.examples.class(labelOf(choice), choice.choices![0]!),
      );
    else add(`${path} is not null`, words.examples.filled(labelOf(column), labelOf(layer)));
    break;
  }
  if (examples.length < 2 && model) {
    const { min, max } = model.bounds;
    add(`z > ${middleOf(min[2], max[2])}`, words.examples.upper);
  }
  if (computes && examples.length < kMostExamples) add("slope", words.surface.slope);
  return examples;
}
