// Two sheets that only tell: help, and what is known about the model.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { upName } from "../math/camera";
import { formatCount } from "../core/locale";
import {
  detailChoices,
  formatArea,
  formatBytes,
  formatLength,
  formatSize,
  metresPer,
} from "../domain/measure";
import type { ServerVersion } from "../core/protocol.gen";
import { mayDownload, type Model, type Role } from "../core/types";
import "../ui/dialog";
import type { StrataDialog } from "../ui/dialog";
import { hasFingersOnly } from "../ui/pointers";
import { sharedStyles } from "../ui/styles";
import { texts } from "../texts";

const sheetStyles = css`
  h3 {
    margin: 2px 0 -0.5rem;
    font: 600 1rem var(--serif);
  }
  dl {
    display: grid;
    grid-template-columns: minmax(9.375rem, auto) 1fr;
    gap: 0.4375rem 1.125rem;
    margin: 0;
  }
  dt {
    color: var(--ink-soft);
  }
  dd {
    margin: 0;
    overflow-wrap: anywhere;
  }
  .parts section + section {
    margin-top: 1rem;
  }
  .parts h3 {
    margin: 2px 0 0.5rem;
    break-after: avoid;
  }
  dl.keys {
    display: block;
  }
  .keys > div {
    display: grid;
    grid-template-columns: minmax(6.875rem, 44%) 1fr;
    gap: 1.125rem;
    padding-bottom: 0.4375rem;
    break-inside: avoid;
  }
  .version {
    margin: 1.25rem 0 0;
    color: var(--ink-soft);
  }
  .keys dt {
    color: var(--ink);
    font-weight: 600;
  }
  @media (min-width: 2560px) {
    .parts {
      columns: 2;
      column-gap: 3rem;
    }
  }
  @media (max-width: 560px) {
    dl,
    .keys > div {
      grid-template-columns: minmax(6.875rem, 40%) 1fr;
    }
  }
`;

@customElement("strata-help-sheet")
export class StrataHelpSheet extends LitElement {
  @query("strata-dialog") private _dialog!: StrataDialog;

  static override styles = [sharedStyles, sheetStyles];

  /** Of the server, which brings the page. Empty until it has answered. */
  @state() private _version = "";

  override connectedCallback(): void {
    super.connectedCallback();
    void this.readVersion();
  }

  private async readVersion(): Promise<void> {
    try {
      const answer = await fetch("/api/v1/version");
      if (answer.ok) this._version = ((await answer.json()) as ServerVersion).version;
    } catch {
      // The help is useful without it.
    }
  }

  override render(): TemplateResult {
    const words = texts.help;
    const part = (title: string, rows: readonly (readonly [string, string])[]): TemplateResult =>
      html`<section>
        <h3>${title}</h3>
        <dl class="keys">${rows.map(([keys, does]) => html`<div><dt>${keys}</dt><dd>${does}</dd></div>`)}</dl>
      </section>`;
    return html`<strata-dialog wide prose long heading=${words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <div class="parts">
        ${hasFingersOnly() ? nothing : part(words.mouse, words.mouse_rows)} ${part(words.touch, words.touch_rows)} ${part(words.keys, words.key_rows)}
        ${part(words.brush, words.brush_rows)} ${part(words.terms, words.terms_rows)} ${part(words.table, words.table_rows)} ${part(words.layers, words.layer_rows)}
      </div>
      ${this._version ? html`<p class="version">Strata ${this._version}</p>` : nothing}
      <button slot="actions" @click=${this.showTour}>${texts.tour.again}</button>
    </strata-dialog>`;
  }

  /** Closed first: the tour gives the keyboard back to what opened the help. */
  private showTour(): void {
    this._dialog.close();
    this.dispatchEvent(new CustomEvent("tour"));
  }
}

const kDownloaders = ["viewer", "annotator", "curator"] as const;

@customElement("strata-about-sheet")
export class StrataAboutSheet extends LitElement {
  @property({ attribute: false }) model!: Model;
  @property() viewer: Role = "guest"; // what this person may do
  /** This person may correct the model's unit and up direction, and say who gets its files. */
  @property({ type: Boolean }) correctable = false;

  static override styles = [sharedStyles, sheetStyles];

  override render(): TemplateResult {
    const { model } = this;
    const words = texts.model.details_list;
    const metres = metresPer(model.unit);
    const sides = [0, 1, 2].map(
      (axis) => (model.bounds.max[axis]! - model.bounds.min[axis]!) * metres,
    );
    const detail = detailChoices(model.atlas).find(
      (choice) => choice.resolution === model.default_resolution,
    );
    const rows: [string, string][] = [
      [words.size, formatSize(sides)],
      [words.area, formatArea(model.area_m2)],
      [words.triangles, formatCount(model.triangles)],
      [words.up, upName(model.up)],
      [words.smallest, detail ? formatLength(detail.detailM) : ""],
      [words.crs, model.crs],
      [words.inventory_number, model.inventory_number],
      [words.owner, model.owner],
      [words.creator, model.creator],
      [words.captured, model.captured],
      [words.rights, model.rights_uri],
      [words.credit, model.credit],
      [
        words.repairs,
        model.repairs.map((repair) => `${repair.what}: ${formatCount(repair.count)}`).join("; "),
      ],
    ];
    return html`<strata-dialog wide prose heading=${model.name} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <dl>
        ${rows.map(([name, value]) => (value ? html`<dt>${name}</dt><dd class="numeric">${value}</dd>` : nothing))}
        ${
          model.source_files.length > 0
            ? html`<dt>${words.files}</dt>
              <dd>
                ${model.source_files.map(
                  (file) =>
                    html`<div>
                      ${
                        mayDownload(this.viewer, model)
                          ? html`<a class="text" href="/api/v1/models/${model.id}/source/${encodeURIComponent(file.name)}" download=${file.name}>${file.name}</a>`
                          : file.name
                      }
                      <span class="hint numeric">${formatBytes(file.bytes)}</span>
                    </div>`,
                )}
                ${mayDownload(this.viewer, model) ? nothing : html`<p class="hint">${texts.visibility.no_download}</p>`}
              </dd>`
            : nothing
        }
      </dl>
      ${this.correctable ? this.downloadChoice() : nothing}
      ${
        this.correctable
          ? html`<button slot="actions" @click=${() => this.dispatchEvent(new CustomEvent("correct"))}>
            ${texts.model.correct_size}
          </button>`
          : nothing
      }
    </strata-dialog>`;
  }

  private downloadChoice(): TemplateResult {
    const words = texts.visibility;
    return html`<label class="field">
      <span>${words.download}</span>
      <select @change=${(event: Event) => this.dispatchEvent(new CustomEvent("download-for", { detail: (event.target as HTMLSelectElement).value }))}>
        ${kDownloaders.map((role) => html`<option value=${role} ?selected=${role === this.model.source_download}>${words.download_roles[role]}</option>`)}
      </select>
    </label>`;
  }
}
