// <strata-tour-file-add>: uploads files of a tour one at a time, with progress and the server's
// refusals. The event "added" contains the TourFile.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { TourFile } from "../../core/protocol.gen";
import type { ModelSession } from "../../session/model-session";
import "../../ui/file-choice";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.tours;

@customElement("strata-tour-file-add")
export class StrataTourFileAdd extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The tour's id; null for an unsaved tour, which cannot have files. */
  @property({ attribute: false }) tour: number | null = null;
  @property() label = "";
  @property() accept = "";
  @property({ type: Boolean }) multiple = false;
  @state() private _sending: { name: string; share: number } | null = null;
  @state() private _problem = "";

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-2);
      }
    `,
  ];

  override render(): TemplateResult {
    if (this.tour === null) return html`<p class="hint">${words.files_after_save}</p>`;
    const { _sending: sending } = this;
    return html`<strata-file-choice
        label=${this.label}
        accept=${this.accept}
        ?multiple=${this.multiple}
        ?disabled=${sending !== null}
        .names=${sending ? [words.sending(sending.name, Math.round(sending.share * 100))] : []}
        @files=${({ detail }: CustomEvent<File[]>) => void this.send(detail)}
      ></strata-file-choice>
      ${this._problem ? html`<p class="error" role="alert">${this._problem}</p>` : nothing}`;
  }

  private async send(files: readonly File[]): Promise<void> {
    const { tour } = this;
    if (tour === null) return;
    this._problem = "";
    for (const file of files) {
      this._sending = { name: file.name, share: 0 };
      try {
        const added = await this.session.tours.addFile(tour, file, (share) => {
          this._sending = { name: file.name, share };
        }).done;
        this.dispatchEvent(new CustomEvent<TourFile>("added", { detail: added }));
      } catch (error) {
        if (!(error instanceof ApiError)) throw error;
        this._problem = `${file.name}: ${error.message}`;
      }
    }
    this._sending = null;
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-tour-file-add": StrataTourFileAdd;
  }
}
