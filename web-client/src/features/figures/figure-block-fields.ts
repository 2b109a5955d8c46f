// The fields of the title block, in a part of the dialog that can be opened.

import { css, html, type nothing, type TemplateResult } from "lit";
import {
  kBlockFieldNames,
  kBlockFields,
  type BlockField,
  type BlockTexts,
} from "../../domain/figure-block";
import { kDirections } from "../../domain/figures";
import type { FigureDirection, FigureRequest } from "../../core/protocol.gen";
import type { ModelSession } from "../../session/model-session";
import { texts } from "../../texts";

const words = texts.figures.block;

export const blockStyles = css`
  .block {
    display: grid;
    grid-template-columns: minmax(0, 1fr) minmax(0, 1fr);
    gap: var(--space-3);
    padding-top: var(--space-2);
  }
`;

/** Adds the names of the fields, in the user's language, and the direction as the usual title. */
export function withBlockWords(request: FigureRequest): FigureRequest {
  const { title_block: block, direction, title } = request;
  if (!block) return request;
  const usual = direction && isDirection(direction) ? texts.figures.froms[direction] : undefined;
  return {
    ...request,
    ...(title === undefined && usual !== undefined ? { title: usual } : {}),
    title_block: { ...block, labels: { ...words.fields } },
  };
}

const isDirection = (name: string): name is FigureDirection =>
  (kDirections as readonly string[]).includes(name);

/** Callbacks to the dialog. `write` also turns the title block on. */
interface BlockFields {
  on: boolean;
  problem: TemplateResult | typeof nothing;
  turn(on: boolean): void;
  write(name: BlockField, text: string): void;
}

export function blockFields(
  { model }: ModelSession,
  written: BlockTexts,
  { on, problem, turn, write }: BlockFields,
): TemplateResult {
  const number = model?.inventory_number ? ` (${model.inventory_number})` : "";
  const usual: Partial<Record<BlockField, string>> = {
    organization: model?.owner ?? "",
    object: `${model?.name ?? ""}${number}`,
    author: words.author_hint,
    date: words.date_hint,
    status: words.status_hint,
    sheet: "1/1",
  };
  return html`<details class="full" ?open=${on}>
    <summary>${words.title}</summary>
    <div class="block">
      <label class="check full">
        <input type="checkbox" name="title_block" .checked=${on} @change=${(event: Event) => turn((event.target as HTMLInputElement).checked)} />
        ${words.on}
      </label>
      ${kBlockFieldNames.map(
        (name) =>
          html`<label class="field">
            <span>${words.fields[name]}</span>
            <input type="text" name="block_${name}" maxlength=${kBlockFields[name]} autocomplete="off" placeholder=${usual[name] ?? ""} .value=${written[name]} @input=${(event: Event) => write(name, (event.target as HTMLInputElement).value)} />
          </label>`,
      )}
      <p class="hint full">${words.hint}</p>
    </div>
    ${problem}
  </details>`;
}
