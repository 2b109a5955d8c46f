// The classes in the dialog of a layer: a row for each class, with its color and label.

import { html, nothing, type TemplateResult } from "lit";
import { kClassColors, opaqueColor } from "../../domain/palette";
import { texts } from "../../texts";
import { icon } from "../../ui/icons";

export interface ClassRow {
  at: number;
  label: string;
  color: string; // in the format #rrggbbaa
}

const kMaxClasses = 255;
const words = texts.layer_dialog;

export const newClass = (at: number): ClassRow => ({
  at,
  label: "",
  color: kClassColors[(at - 1) % kClassColors.length]!,
});

/** Adds a class with the lowest free number. Returns null if no number is free. */
export function withNewClass(rows: readonly ClassRow[]): ClassRow[] | null {
  const used = new Set(rows.map((row) => row.at));
  for (let at = 1; at <= kMaxClasses; ++at) if (!used.has(at)) return [...rows, newClass(at)];
  return null;
}

/**
 * `isNew` means that the layer is being created. In an existing layer, texels keep their classes.
 */
export function classRows({
  rows,
  isNew,
  change,
  add,
}: {
  rows: readonly ClassRow[];
  isNew: boolean;
  change(rows: ClassRow[]): void;
  add(): void;
}): TemplateResult {
  const set = (index: number, part: Partial<ClassRow>): void =>
    change(rows.map((row, other) => (other === index ? { ...row, ...part } : row)));
  return html`<div class="details">
    <p class="caption">${words.classes_title}</p>
    <div class="classes">
      ${rows.map(
        (row, index) =>
          html`<div class="class">
            <input
              type="color"
              .value=${opaqueColor(row.color)}
              aria-label=${words.class_color(row.at)}
              @input=${(event: Event) => set(index, { color: `${(event.target as HTMLInputElement).value}ff` })}
            />
            <input
              type="text"
              maxlength="200"
              .value=${row.label}
              placeholder=${words.class_default(row.at)}
              aria-label=${words.class_label(row.at)}
              @input=${(event: Event) => set(index, { label: (event.target as HTMLInputElement).value })}
            />
            <button
              type="button"
              class="icon quiet"
              aria-label=${words.class_remove(row.label || words.class_default(row.at))}
              ?disabled=${rows.length === 1}
              @click=${() => change(rows.filter((_, other) => other !== index))}
            >
              ${icon("close")}
            </button>
          </div>`,
      )}
    </div>
    <div class="row">
      <button type="button" @click=${add}>${icon("plus")}${words.class_add}</button>
      ${isNew ? nothing : html`<span class="hint">${words.class_kept}</span>`}
    </div>
  </div>`;
}
