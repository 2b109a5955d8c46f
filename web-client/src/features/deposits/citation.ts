// <strata-citation>: the citation of the model's project, with a button that copies it, and files
// for reference managers.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import "../../ui/copy-field";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

/** The formats, with their names, which are not translated. */
const kFiles = [
  ["bibtex", "BibTeX"],
  ["ris", "RIS"],
  ["csl", "CSL-JSON"],
] as const;

@customElement("strata-citation")
export class StrataCitation extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property() project = "";
  @state() private _text = "";

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-1);
      }
      .files {
        display: flex;
        flex-wrap: wrap;
        gap: var(--space-3);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.load();
  }

  private async load(): Promise<void> {
    try {
      const { project } = this;
      const file = await this.api.blob("GET /projects/{project}/citation", { path: { project } });
      this._text = await file.text();
    } catch (error) {
      // The details of the model are also useful without the citation.
      if (!(error instanceof ApiError)) throw error;
    }
  }

  override render(): TemplateResult | typeof nothing {
    if (!this._text) return nothing;
    const { project } = this;
    const address = (f: (typeof kFiles)[number][0]): string =>
      this.api.url("GET /projects/{project}/citation", { path: { project }, query: { f } });
    return html`<p class="text">${this._text}</p>
      <strata-copy-field label=${texts.deposit.citation} .text=${this._text}></strata-copy-field>
      <div class="files">
        ${kFiles.map(([format, name]) => html`<a class="text" href=${address(format)} download>${name}</a>`)}
      </div>`;
  }
}
