// <strata-files-field>: the images or documents of a record in its form. New files are sent when
// the form is saved.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { labelOf } from "../../domain/cells";
import { formatBytes } from "../../domain/measure";
import type { Attachment, Column, Visibility } from "../../core/protocol.gen";
import { FileDrop } from "../../ui/drop";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../model-session";
import { notices } from "../../ui/notices";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { kVisibilities } from "../../ui/visibility";

const words = texts.files;

@customElement("strata-files-field")
export class StrataFilesField extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) column!: Column;
  /** The ids of the table and the record. The record is null if it does not exist yet. */
  @property({ attribute: false }) table = 0;
  @property({ attribute: false }) record: number | null = null;
  /** The ids of the record's files, in their order. */
  @property({ attribute: false }) ids: number[] = [];
  @state() private _pending: File[] = [];
  @state() private _known = new Map<number, Attachment>();
  @state() private _isKnown = false; // whether the visible files are loaded
  @query("input") private _input!: HTMLInputElement;
  private readonly _drop = new FileDrop(
    this,
    (files) => (this._pending = [...this._pending, ...files]),
  );

  static override shadowRootOptions = { ...LitElement.shadowRootOptions, delegatesFocus: true };

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
      }
      .field {
        display: flex;
        flex-wrap: wrap;
        gap: var(--space-2);
        align-items: stretch;
        padding: var(--space-2);
        border: var(--edge) dashed var(--line-strong);
        border-radius: var(--radius-small);
      }
      .field.over {
        border-color: var(--accent);
        background: var(--accent-soft, var(--calm-soft));
      }
      figure {
        position: relative;
        display: grid;
        grid-template-rows: 4.5rem auto auto;
        gap: var(--space-1);
        width: 6.5rem;
        margin: 0;
        font-size: var(--text-tiny);
      }
      figure a {
        display: grid;
        place-items: center;
        overflow: hidden;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
        background: var(--raised);
        color: var(--ink-soft);
      }
      figure img {
        width: 100%;
        height: 100%;
        object-fit: cover;
      }
      figure select {
        min-height: var(--control-small);
        padding: 0 var(--space-1);
        font-size: var(--text-tiny);
      }
      figure.waits {
        opacity: 0.6;
      }
      figure button.icon {
        position: absolute;
        top: 2px;
        right: 2px;
        width: 1.625rem;
        min-height: 1.625rem;
        background: var(--raised);
      }
      .add {
        min-width: 6.5rem;
      }
      input {
        display: none;
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    if (
      (changed.has("record") || changed.has("ids")) &&
      this.record !== null &&
      this.ids.some((id) => !this._known.has(id))
    )
      void this.load();
  }

  /** The files to send after the record exists. */
  get pending(): readonly File[] {
    return this._pending;
  }
  /** Removes a file from the pending files after it was sent. */
  sent(file: File): void {
    this._pending = this._pending.filter((each) => each !== file);
  }

  private async load(): Promise<void> {
    try {
      const { attachments } = await this.session.api.json(
        "GET /tables/{table}/records/{key}/attachments",
        {
          path: { table: this.table, key: this.record! },
        },
      );
      this._known = new Map(attachments.map((file) => [file.id, file]));
      this._isKnown = true;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      notices.error(error);
    }
  }

  private get isPictures(): boolean {
    return this.column.kind === "picture";
  }

  override render(): TemplateResult {
    return html`<div class="field ${this._drop.over ? "over" : ""}" role="group" aria-label=${labelOf(this.column)}>
      ${this.ids.filter((id) => !this._isKnown || this._known.has(id)).map((id) => this.kept(id))} ${this._pending.map((file) => this.waiting(file))}
      <button type="button" class="add" @click=${() => this._input.click()}>${icon("plus")}${this.isPictures ? words.add_pictures : words.add_documents}</button>
      <input type="file" multiple tabindex="-1" aria-label=${words.choose} accept=${this.isPictures ? "image/*" : ""} @change=${this.onChosen} />
    </div>`;
  }

  private kept(id: number): TemplateResult {
    const file = this._known.get(id);
    const name = file?.name ?? words.file(id);
    return html`<figure>
      <a href=${this.session.api.url("GET /attachments/{attachment}", { path: { attachment: id } })} target="_blank" rel="noopener" title=${file ? `${name}, ${formatBytes(file.bytes)}` : name}>
        ${this.isPictures ? html`<img src=${this.session.api.url("GET /attachments/{attachment}", { path: { attachment: id }, query: { thumbnail: 256 } })} alt=${name} loading="lazy" />` : icon("document")}
      </a>
      <figcaption class="ellipsis">${name}</figcaption>
      ${file ? this.seenBy(file) : nothing}
      <button
        type="button"
        class="icon quiet"
        aria-label=${words.remove(name)}
        title=${words.remove(name)}
        @click=${() => (this.ids = this.ids.filter((each) => each !== id))}
      >
        ${icon("close")}
      </button>
    </figure>`;
  }

  /**
   * Shows the choice of the file's visibility. It applies immediately, because the file already
   * exists.
   */
  private seenBy(file: Attachment): TemplateResult | typeof nothing {
    const { session } = this;
    if (!session.canCurate && file.user !== session.user) return nothing;
    const says = texts.visibility;
    return html`<select
      aria-label=${says.of(file.name)}
      title=${says.says[file.visibility]}
      @change=${(event: Event) => void this.showTo(file, event.target as HTMLSelectElement)}
    >
      ${kVisibilities.map((each) => html`<option value=${each} ?selected=${each === file.visibility}>${says.names[each]}</option>`)}
    </select>`;
  }

  private async showTo(file: Attachment, choice: HTMLSelectElement): Promise<void> {
    try {
      const now = await this.session.api.json("PATCH /attachments/{attachment}", {
        path: { attachment: file.id },
        body: { visibility: choice.value as Visibility },
      });
      this._known = new Map(this._known).set(file.id, now);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      choice.value = file.visibility;
      notices.error(error);
    }
  }

  private waiting(file: File): TemplateResult {
    return html`<figure class="waits">
      <a title=${words.waits}>${icon("upload")}</a>
      <figcaption class="ellipsis">${file.name}</figcaption>
      <button type="button" class="icon quiet" aria-label=${words.remove(file.name)} title=${words.remove(file.name)} @click=${() => this.sent(file)}>${icon("close")}</button>
    </figure>`;
  }

  private readonly onChosen = (): void => {
    this._pending = [...this._pending, ...(this._input.files ?? [])];
    this._input.value = "";
  };
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-files-field": StrataFilesField;
  }
}
