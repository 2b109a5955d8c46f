// <strata-scans-dialog>: asks whether several scans become several models, or the parts of one model.
// askAboutScans() opens the dialog.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import type { DroppedFile } from "../../ui/drop";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { scanOfParts, type Scan } from "./imports";

const words = texts.scans;
const kMostListed = 8;
const kMostFilesOfForm = 256; // of the contract of POST /models

/** Returns why the server would refuse these files as the parts of one model, or "". */
const partsRefusal = (files: readonly DroppedFile[]): string =>
  files.some(({ path }) => /\.zip$/i.test(path))
    ? words.no_zips
    : files.length > kMostFilesOfForm
      ? words.too_many(kMostFilesOfForm)
      : "";

@customElement("strata-scans-dialog")
class StrataScansDialog extends LitElement {
  @property({ attribute: false }) scans!: readonly Scan[];
  @property({ attribute: false }) files!: readonly DroppedFile[];
  answer: (scans: readonly Scan[]) => void = () => {};

  @state() private _asParts = false;
  @state() private _name: string | null = null; // null: the proposed name
  @query("strata-dialog") private _dialog!: StrataDialog;
  private _answer: readonly Scan[] = [];

  static override styles = [
    sharedStyles,
    css`
      fieldset {
        display: grid;
        gap: var(--space-3);
        margin: 0;
        padding: 0;
        border: 0;
      }
      .choice {
        display: grid;
        grid-template-columns: auto minmax(0, 1fr);
        gap: 0 var(--space-2);
        align-items: baseline;
      }
      .choice .hint {
        grid-column: 2;
      }
      ul {
        margin: 0;
        padding-left: var(--space-4);
        overflow-wrap: anywhere;
      }
    `,
  ];

  override render(): TemplateResult {
    const { scans } = this;
    const refusal = partsRefusal(this.files);
    const choice = (asParts: boolean, label: string, hint: string): TemplateResult =>
      html`<label class="choice">
        <input type="radio" name="as" ?disabled=${asParts && refusal !== ""} .checked=${this._asParts === asParts} @change=${() => (this._asParts = asParts)} />
        <span>${label}</span>
        <span class="hint">${hint}</span>
      </label>`;
    return html`<strata-dialog heading=${words.heading(scans.length)} way_out=${texts.cancel} @closed=${() => this.finish()}>
      <ul>
        ${scans.slice(0, kMostListed).map(({ name }) => html`<li>${name}</li>`)}
        ${scans.length > kMostListed ? html`<li>${words.more(scans.length - kMostListed)}</li>` : nothing}
      </ul>
      <fieldset>
        ${choice(false, words.as_models(scans.length), words.as_models_hint)}
        ${choice(true, words.as_parts(scans.length), refusal || words.as_parts_hint)}
      </fieldset>
      ${
        this._asParts
          ? html`<label class="field">
              <span>${words.name}</span>
              <input
                type="text"
                maxlength="200"
                .value=${this._name ?? scanOfParts(scans, this.files).name}
                @input=${(event: Event) => (this._name = (event.target as HTMLInputElement).value)}
              />
            </label>`
          : nothing
      }
      <button slot="actions" class="primary" @click=${() => this.start()}>${words.start}</button>
    </strata-dialog>`;
  }

  private start(): void {
    const parts = scanOfParts(this.scans, this.files);
    this._answer = this._asParts
      ? [{ ...parts, name: this._name?.trim() || parts.name }]
      : this.scans;
    this._dialog.close();
  }

  private finish(): void {
    this.answer(this._answer);
    this.remove();
  }
}

/** Returns the scans to import. Returns none if the user cancels. */
export function askAboutScans(
  scans: readonly Scan[],
  files: readonly DroppedFile[],
): Promise<readonly Scan[]> {
  return new Promise((resolve) => {
    const element = new StrataScansDialog();
    Object.assign(element, { scans, files, answer: resolve });
    document.body.append(element);
  });
}
