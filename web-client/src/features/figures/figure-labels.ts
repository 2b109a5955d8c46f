// Labels at positions in a figure: the texts of one column, for a layer of records.

import { html, nothing, type TemplateResult } from "lit";
import { holdsFiles, labelColumn, labelOf } from "../../domain/cells";
import { holdsMarks } from "../../domain/marks";
import type { FigureLabels } from "../../core/protocol.gen";
import type { Column, Layer } from "../../core/types";
import type { ModelSession } from "../../session/model-session";
import { texts } from "../../texts";

const words = texts.figures;

/** The user's choice. An empty `column` means the first column. */
export interface LabelChoice {
  layer: number;
  column: string;
}

/** Returns the columns that can be a label. The column with the records' names is first. */
export function columnsForLabels(session: ModelSession, layer: Layer): Column[] {
  const table = session.tables.find(layer.table!);
  if (!table) return [];
  const title = labelColumn(table);
  const columns = table.columns.filter((column) => !holdsFiles(column) && !holdsMarks(column));
  return columns.sort((a, b) => Number(b === title) - Number(a === title));
}

/** Returns the labels for the request, or null if the figure has no labels. */
export function labelsOf(session: ModelSession): FigureLabels | null {
  const { layer: id, column } = session.figures.draft.labels ?? {};
  const layer = session.layers.all.find((each) => each.id === id);
  const chosen = column || (layer && columnsForLabels(session, layer)[0]?.slug);
  return layer && chosen ? { layer: layer.id, column: chosen } : null;
}

const valueFor = (event: Event): string => (event.target as HTMLSelectElement).value;

/**
 * `wrong` is whether the field is invalid. `told` is the id of the error message, for ARIA
 * attributes.
 */
export function labelFields(
  session: ModelSession,
  {
    wrong,
    told,
    problem,
    choose,
  }: {
    wrong: boolean;
    told: string | typeof nothing;
    problem: TemplateResult | typeof nothing;
    choose(labels: LabelChoice | null): void;
  },
): TemplateResult | typeof nothing {
  // in the order of the layer list
  const layers = session.layers.all.filter(({ table }) => table !== undefined).reverse();
  if (layers.length === 0) return nothing;
  const layer = layers.find(({ id }) => id === session.figures.draft.labels?.layer) ?? null;
  return html`<div class="group ${layer ? "" : "full"}">
      <label class="field">
        <span>${words.labels}</span>
        <select name="labels" aria-invalid=${wrong} aria-describedby=${told} @change=${(event: Event) => choose(valueFor(event) === "" ? null : { layer: Number(valueFor(event)), column: "" })}>
          <option value="" ?selected=${layer === null}>${words.no_labels}</option>
          ${layers.map((each) => html`<option value=${each.id} ?selected=${each === layer}>${each.name}</option>`)}
        </select>
      </label>
    </div>
    ${layer ? columnField(session, layer, { wrong, told, choose }) : nothing} ${problem}`;
}

function columnField(
  session: ModelSession,
  layer: Layer,
  {
    wrong,
    told,
    choose,
  }: { wrong: boolean; told: string | typeof nothing; choose(labels: LabelChoice): void },
): TemplateResult {
  const columns = columnsForLabels(session, layer);
  const chosen = labelsOf(session)?.column;
  const gone = chosen !== undefined && !columns.some(({ slug }) => slug === chosen);
  if (session.tables.find(layer.table!) && columns.length === 0)
    return html`<p class="hint">${words.no_columns}</p>`;
  return html`<label class="field">
    <span>${words.column}</span>
    <select name="column" aria-invalid=${wrong} aria-describedby=${told} @change=${(event: Event) => choose({ layer: layer.id, column: valueFor(event) })}>
      ${columns.map((column) => html`<option value=${column.slug} ?selected=${column.slug === chosen}>${labelOf(column)}</option>`)}
      ${gone ? html`<option value=${chosen} selected>${chosen}</option>` : nothing}
    </select>
  </label>`;
}
