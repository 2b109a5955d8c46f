// <strata-export-dialog>: sets the options of a 3D model for other programs, and starts the job
// that makes the file.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { formatCount, formatPercent, pageLanguage, pageLocale } from "../../core/locale";
import type { ProblemBody } from "../../core/types";
import { labelOf } from "../../domain/cells";
import {
  exportRequest,
  kFileFormats,
  kTextureFormats,
  kTextureSizes,
  kUsualExport,
  triangleCounts,
  type ExportInput,
} from "../../domain/exports";
import { AwaitedFile, awaitedFileStyles } from "../../session/awaited-file";
import { followSession } from "../../session/follow-session";
import { idsOf, layerChoice } from "../../session/layer-choice";
import type { ModelSession } from "../../session/model-session";
import { savedSelectionsOf } from "../../session/saved-selections-of";
import "../../ui/dialog";
import { radioGroup } from "../../ui/radio-group";
import { formatChoiceStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.export_dialog;

@customElement("strata-export-dialog")
export class StrataExportDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _input: ExportInput = kUsualExport;
  @state() private _problem = "";
  private readonly _file = new AwaitedFile(this, (problem) => this.refuse(problem));

  constructor() {
    super();
    followSession(this, "jobs", "layers", "painting", "views");
  }

  static override styles = [
    sharedStyles,
    formatChoiceStyles,
    awaitedFileStyles,
    css`
      .editor,
      .group {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        align-content: start;
      }
      .editor {
        gap: var(--space-4);
      }
      .group,
      .layers {
        gap: var(--space-1);
      }
      .layers {
        display: grid;
      }
      .layers label {
        min-width: 0;
        overflow-wrap: anywhere;
      }
      button.link {
        justify-self: start;
      }
      @media (pointer: coarse) {
        .layers label {
          min-height: var(--control-touch);
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this._input = this.session.exports.draft;
    void savedSelectionsOf(this.session).load();
  }

  override render(): TemplateResult {
    return html`<strata-dialog
      wide
      heading=${texts.model_export.title}
      way_out=${this._file.running ? "" : texts.close}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      <form id="export" class="editor" novalidate @submit=${this.onSubmit}>
        <p>${words.lead}</p>
        ${this.file()} ${this.surfacePart()} ${this.triangles()} ${this.layers()} ${this.features()} ${this.size()} ${this.format()} ${this.light()}
      </form>
      ${this._file.footer({
        form: "export",
        make: words.make,
        making: words.making,
        cancel: words.cancel,
        saved: ({ name, triangles }) => words.saved(name, texts.home.triangles(triangles ?? 0)),
        problem: this._problem,
      })}
    </strata-dialog>`;
  }

  private file(): TemplateResult {
    return html`<div class="group">
      <span class="caption" id="file">${words.file}</span>
      ${radioGroup({
        label: { id: "file" },
        class: "formats",
        choices: kFileFormats.map((value) => ({
          value,
          content: html`<b>${words.files[value]}</b><span class="hint">${words.file_hints[value]}</span>`,
        })),
        chosen: this._input.file,
        choose: (file) => this.choose({ file }),
      })}
    </div>`;
  }

  private surfacePart(): TemplateResult {
    const saved = savedSelectionsOf(this.session);
    const { chosenPart } = this;
    const choose = (event: Event): void => {
      const { value } = event.target as HTMLSelectElement;
      this.choose({ part: value === "" ? null : Number(value) });
    };
    return html`<div class="group">
      <label class="field">
        <span>${words.part}</span>
        <select name="part" aria-describedby="part_hint" @change=${choose}>
          <option value="" ?selected=${chosenPart === null}>${words.whole}</option>
          ${saved.all.map(({ id, name, within }) => (within ? html`<option value=${id} ?selected=${id === chosenPart}>${name}</option>` : nothing))}
        </select>
      </label>
      ${
        saved.failed
          ? html`<p class="error" role="alert" id="part_hint">${texts.saved_selections.failed}</p>
              <button type="button" class="link" @click=${() => void saved.load()}>${texts.try_again}</button>`
          : html`<p class="hint" id="part_hint">${words.part_hint}</p>`
      }
    </div>`;
  }

  private triangles(): TemplateResult {
    const all = this.session.model?.triangles ?? 0;
    const { triangles } = this._input;
    // The number of triangles of a part is not known.
    const share = (count: number): string =>
      this.chosenPart === null ? ` (${formatPercent(count / all)})` : "";
    const choose = (event: Event): void => {
      const { value } = event.target as HTMLSelectElement;
      this.choose({ triangles: value === "" ? null : Number(value) });
    };
    return html`<div class="group">
      <label class="field">
        <span>${words.triangles}</span>
        <select name="triangles" aria-describedby="triangles_hint" @change=${choose}>
          <option value="" ?selected=${triangles === null}>${this.chosenPart === null ? words.all_triangles(formatCount(all)) : words.all_of_part}</option>
          ${triangleCounts(all).map((count) => html`<option value=${count} ?selected=${count === triangles}>${words.at_most(formatCount(count))}${share(count)}</option>`)}
        </select>
      </label>
      <p class="hint" id="triangles_hint">${words.triangles_hint}</p>
    </div>`;
  }

  private layers(): TemplateResult {
    return layerChoice({
      layers: this.session.layers,
      chosen: this._input.layers,
      label: words.layers,
      hint: words.layers_hint,
      choose: (layers) => this.choose({ layers }),
    });
  }

  private features(): TemplateResult {
    const all = [...this.session.layers.all].reverse();
    const isGlb = this._input.file === "glb";
    const features = isGlb ? this.featureLayer : null;
    const choose = (event: Event): void => {
      const { value } = event.target as HTMLSelectElement;
      this.choose({ features: value === "" ? null : Number(value) });
    };
    return html`<div class="group">
      <label class="field">
        <span>${words.features}</span>
        <select name="features" aria-describedby="features_hint" ?disabled=${!isGlb} @change=${choose}>
          <option value="" ?selected=${features === null}>${words.no_features}</option>
          ${all.map((layer) => html`<option value=${layer.id} ?selected=${layer.id === features}>${labelOf(layer)}</option>`)}
        </select>
      </label>
      <p class="hint" id="features_hint">${isGlb ? words.features_hint : words.features_only_in_glb}</p>
    </div>`;
  }

  private size(): TemplateResult {
    const { size } = this._input;
    const choose = (event: Event): void => {
      const { value } = event.target as HTMLSelectElement;
      this.choose({ size: value === "" ? null : Number(value) });
    };
    return html`<div class="group">
      <label class="field">
        <span>${words.size}</span>
        <select name="size" aria-describedby="size_hint" @change=${choose}>
          <option value="" ?selected=${size === null}>${words.auto_size}</option>
          ${kTextureSizes.map((side) => html`<option value=${side} ?selected=${side === size}>${words.side(side)}</option>`)}
        </select>
      </label>
      <p class="hint" id="size_hint">${words.size_hint}</p>
    </div>`;
  }

  private format(): TemplateResult {
    return html`<div class="group">
      <span class="caption" id="format">${words.format}</span>
      ${radioGroup({
        label: { id: "format" },
        class: "formats",
        choices: kTextureFormats.map((value) => ({
          value,
          content: html`<b>${words.formats[value]}</b><span class="hint">${words.format_hints[value]}</span>`,
        })),
        chosen: this._input.format,
        choose: (format) => this.choose({ format }),
      })}
    </div>`;
  }

  private light(): TemplateResult {
    return html`<div class="group">
      <label class="check">
        <input type="checkbox" name="unlit" aria-describedby="unlit_hint" .checked=${this._input.unlit} @change=${(event: Event) => this.choose({ unlit: (event.target as HTMLInputElement).checked })} />
        ${words.unlit}
      </label>
      <p class="hint" id="unlit_hint">${words.unlit_hint}</p>
    </div>`;
  }

  /** The layer of the features. It may have been deleted since it was chosen. */
  private get featureLayer(): number | null {
    return this.session.layers.find(this._input.features)?.id ?? null;
  }

  /** The saved selection. It may have been deleted since it was chosen. */
  private get chosenPart(): number | null {
    const { part } = this._input;
    return part !== null && savedSelectionsOf(this.session).find(part)?.within ? part : null;
  }

  /** The ids of the layers in the texture, from bottom to top. */
  private get chosenLayers(): number[] {
    return idsOf(this.session.layers, this._input.layers);
  }

  private choose(change: Partial<ExportInput>): void {
    this._input = this.session.exports.draft = { ...this._input, ...change };
    this._problem = "";
  }

  private refuse(problem: ProblemBody): void {
    this._problem = problem.detail ?? problem.title;
  }

  private readonly onSubmit = (event: Event): void => {
    event.preventDefault();
    if (!this._file.isFree) return;
    const { exports, model } = this.session;
    const all = this.session.layers.all.map(({ id }) => id);
    const input = { ...this._input, features: this.featureLayer, part: this.chosenPart };
    const request = exportRequest(input, all, this.chosenLayers, this.session.views.content());
    const lang = pageLanguage(pageLocale(), []);
    this._problem = "";
    void this._file.make(
      () => exports.make(words.job(model?.name ?? ""), words.ready, request, lang),
      () => this.isConnected,
    );
  };
}
