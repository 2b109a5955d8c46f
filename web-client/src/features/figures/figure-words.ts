// Fields for the texts on the sheet of a figure: title, caption and credit.

import { html, type nothing, type TemplateResult } from "lit";
import type { FigureWords } from "../../domain/figures";
import type { ModelSession } from "../../session/model-session";
import { texts } from "../../texts";

const words = texts.figures;
const kWords: readonly { name: keyof FigureWords; most: number }[] = [
  { name: "title", most: 200 },
  { name: "caption", most: 2000 },
  { name: "credit", most: 1000 },
];

/** Callbacks to the dialog for the state of its fields and for a changed text. */
interface WordFields {
  wrong(field: string): boolean;
  told(field: string): string | typeof nothing;
  problem(field: string): TemplateResult | typeof nothing;
  write(written: FigureWords, changed: keyof FigureWords): void;
}

export function wordFields(
  { model, figures }: ModelSession,
  { wrong, told, problem, write }: WordFields,
): TemplateResult {
  const written = figures.draft.words;
  const usual = {
    title: model?.name ?? "",
    caption: words.caption_hint,
    credit: model?.credit || words.credit_hint,
  };
  return html`${kWords.map(({ name, most }) => {
    const type = (event: Event): void =>
      write({ ...written, [name]: (event.target as HTMLInputElement).value }, name);
    return html`<div class="group full">
      <label class="field">
        <span>${words.written[name]}</span>
        ${
          name === "caption"
            ? html`<textarea name=${name} maxlength=${most} placeholder=${usual[name]} .value=${written[name]} aria-invalid=${wrong(name)} aria-describedby=${told(name)} @input=${type}></textarea>`
            : html`<input type="text" name=${name} maxlength=${most} autocomplete="off" placeholder=${usual[name]} .value=${written[name]} aria-invalid=${wrong(name)} aria-describedby=${told(name)} @input=${type} />`
        }
      </label>
      ${problem(name)}
    </div>`;
  })}`;
}
