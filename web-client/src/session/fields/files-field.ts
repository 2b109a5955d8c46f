// <strata-files-field>: the pictures or documents of a record in its form. Files that are added
// wait until the form is saved.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api";
import { label_of } from "../../domain/cells";
import { format_bytes } from "../../domain/measure";
import type { Attachment, Column, Visibility } from "../../core/protocol.gen";
import { FileDrop } from "../../ui/drop";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../model-session";
import { notices } from "../../ui/notices";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";
import { kVisibilities } from "../../ui/visibility";

const words = texts.files;

@customElement("strata-files-field")
export class StrataFilesField extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) column!: Column;
  /** Ids of the table and the record; null: a record that is not there yet. */
  @property({ attribute: false }) table = 0;
  @property({ attribute: false }) record: number | null = null;
  /** Of the files that the record has, in their order. */
  @property({ attribute: false }) ids: number[] = [];
  @state() private pending_: File[] = [];
  @state() private known_ = new Map<number, Attachment>();
  @state() private is_known_ = false; // which of the files this person sees
  @query("input") private input_!: HTMLInputElement;
  private readonly drop_ = new FileDrop(
    this,
    (files) => (this.pending_ = [...this.pending_, ...files]),
  );

  static override shadowRootOptions = { ...LitElement.shadowRootOptions, delegatesFocus: true };

  static override styles = [
    shared_styles,
    css`
      :host {
        display: block;
      }
      .field {
        display: flex;
        flex-wrap: wrap;
        gap: 0.5rem;
        align-items: stretch;
        padding: 0.5rem;
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
        gap: 3px;
        width: 6.5rem;
        margin: 0;
        font-size: 0.76rem;
      }
      figure a {
        display: grid;
        place-items: center;
        overflow: hidden;
        border: var(--edge) solid var(--line);
        border-radius: 0.375rem;
        background: var(--raised);
        color: var(--ink-soft);
      }
      figure img {
        width: 100%;
        height: 100%;
        object-fit: cover;
      }
      figure select {
        min-height: 1.75rem;
        padding: 0 4px;
        font-size: 0.76rem;
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
      this.ids.some((id) => !this.known_.has(id))
    )
      void this.load();
  }

  /** Files that are to be sent once the record is there. */
  get pending(): readonly File[] {
    return this.pending_;
  }
  /** It is sent. */
  sent(file: File): void {
    this.pending_ = this.pending_.filter((each) => each !== file);
  }

  private async load(): Promise<void> {
    try {
      const files = await this.session.api.attachments(this.table, this.record!);
      this.known_ = new Map(files.map((file) => [file.id, file]));
      this.is_known_ = true;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      notices.error(error);
    }
  }

  private get is_pictures(): boolean {
    return this.column.kind === "picture";
  }

  override render(): TemplateResult {
    return html`<div class="field ${this.drop_.over ? "over" : ""}" role="group" aria-label=${label_of(this.column)}>
      ${this.ids.filter((id) => !this.is_known_ || this.known_.has(id)).map((id) => this.kept(id))} ${this.pending_.map((file) => this.waiting(file))}
      <button type="button" class="add" @click=${() => this.input_.click()}>${icon("plus")}${this.is_pictures ? words.add_pictures : words.add_documents}</button>
      <input type="file" multiple tabindex="-1" aria-label=${words.choose} accept=${this.is_pictures ? "image/*" : ""} @change=${this.on_chosen} />
    </div>`;
  }

  private kept(id: number): TemplateResult {
    const file = this.known_.get(id);
    const name = file?.name ?? words.file(id);
    return html`<figure>
      <a href=${this.session.api.attachment_url(id)} target="_blank" rel="noopener" title=${file ? `${name}, ${format_bytes(file.bytes)}` : name}>
        ${this.is_pictures ? html`<img src=${this.session.api.attachment_url(id, 256)} alt=${name} loading="lazy" />` : icon("document")}
      </a>
      <figcaption class="ellipsis">${name}</figcaption>
      ${file ? this.seen_by(file) : nothing}
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

  /** Counts at once, as the file is there already. */
  private seen_by(file: Attachment): TemplateResult | typeof nothing {
    const { session } = this;
    if (!session.can_curate && file.user !== session.user) return nothing;
    const says = texts.visibility;
    return html`<select
      aria-label=${says.of(file.name)}
      title=${says.says[file.visibility]}
      @change=${(event: Event) => void this.show_to(file, event.target as HTMLSelectElement)}
    >
      ${kVisibilities.map((each) => html`<option value=${each} ?selected=${each === file.visibility}>${says.names[each]}</option>`)}
    </select>`;
  }

  private async show_to(file: Attachment, choice: HTMLSelectElement): Promise<void> {
    try {
      const now = await this.session.api.show_attachment(file.id, choice.value as Visibility);
      this.known_ = new Map(this.known_).set(file.id, now);
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

  private readonly on_chosen = (): void => {
    this.pending_ = [...this.pending_, ...(this.input_.files ?? [])];
    this.input_.value = "";
  };
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-files-field": StrataFilesField;
  }
}
