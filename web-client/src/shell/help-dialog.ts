// <strata-help-sheet>: the keys and gestures of the page, and the release of the server.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, query, state } from "lit/decorators.js";
import type { ServerVersion } from "../core/protocol.gen";
import "../ui/dialog";
import type { StrataDialog } from "../ui/dialog";
import { keyCaps } from "../ui/key-caps";
import { hasFingersOnly } from "../ui/pointers";
import { sharedStyles } from "../ui/styles";
import { texts } from "../texts";
import { detailStyles } from "./detail-styles";

@customElement("strata-help-sheet")
export class StrataHelpDialog extends LitElement {
  @query("strata-dialog") private _dialog!: StrataDialog;

  static override styles = [sharedStyles, detailStyles];

  /** The server's version, which is also the page's. Empty until the answer arrives. */
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
      // The help works without the version.
    }
  }

  override render(): TemplateResult {
    const words = texts.help;
    const part = (title: string, rows: readonly (readonly [string, string])[]): TemplateResult =>
      html`<section>
        <h3>${title}</h3>
        <dl class="keys">${rows.map(([keys, does]) => html`<div><dt>${keyCaps(keys, words.key_names)}</dt><dd>${does}</dd></div>`)}</dl>
      </section>`;
    return html`<strata-dialog wide prose long heading=${words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <div class="parts">
        ${hasFingersOnly() ? nothing : part(words.mouse, words.mouse_rows)} ${part(words.touch, words.touch_rows)} ${part(words.keys, words.key_rows)}
        ${part(words.brush, words.brush_rows)} ${part(words.terms, words.terms_rows)} ${part(words.table, words.table_rows)} ${part(words.layers, words.layer_rows)}
      </div>
      <p class="guides">
        <a href="/guide/" target="_blank">${words.guide}</a>
        <a href="/guide/reference/keyboard" target="_blank">${words.all_keys}</a>
        <a href="/docs" target="_blank">${words.contract}</a>
        <a href="/third-party-notices.txt" target="_blank">${words.licenses}</a>
      </p>
      <p class="version">${this._version ? html`Strata ${this._version}<br />` : nothing}${words.fonts}</p>
      <button slot="actions" @click=${this.showTour}>${texts.tour.again}</button>
    </strata-dialog>`;
  }

  /** Closes first, so that the tour later returns the focus to the opener of the help. */
  private showTour(): void {
    this._dialog.close();
    this.dispatchEvent(new CustomEvent("tour"));
  }
}
