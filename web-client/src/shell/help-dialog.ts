// <strata-help-sheet>: shows the keys and gestures of the page, and the version of the server.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import type { ServerVersion } from "../core/protocol.gen";
import "../ui/dialog";
import type { StrataDialog } from "../ui/dialog";
import { icon } from "../ui/icons";
import { keyCaps } from "../ui/keys/key-caps";
import { hasFingersOnly } from "../ui/pointers";
import { sharedStyles } from "../ui/styles";
import { loadHelp, texts } from "../texts";
import type { HelpTexts } from "../texts/shape";
import type { Command } from "./command";
import { keyCommands } from "./commands";
import { detailStyles } from "./detail-styles";
import type { PageHost } from "./open-dialog";

@customElement("strata-help-sheet")
export class StrataHelpDialog extends LitElement {
  @query("strata-dialog") private _dialog!: StrataDialog;

  static override styles = [sharedStyles, detailStyles];

  @property({ attribute: false }) host!: PageHost;
  /** The version of the server and of the page. Empty until the response arrives. */
  @state() private _version = "";
  @state() private _rows: HelpTexts | null = null; // null: not loaded yet
  private _next: (() => void) | null = null; // called after the help has closed

  override connectedCallback(): void {
    super.connectedCallback();
    void this.readVersion();
    loadHelp().then(
      (rows) => (this._rows = rows),
      () => {}, // The help then shows only the keys of commands.
    );
  }

  private async readVersion(): Promise<void> {
    try {
      const answer = await fetch("/api/v1/version");
      if (answer.ok) this._version = ((await answer.json()) as ServerVersion).version;
    } catch {
      // The help also works without the version.
    }
  }

  override render(): TemplateResult {
    const words = texts.help;
    const rows = this._rows;
    return html`<strata-dialog wide prose long heading=${words.title} @closed=${this.onClosed}>
      <div class="parts">
        ${rows ? this.gestures(rows) : nothing} ${this.commands()} ${rows ? this.others(rows) : nothing}
      </div>
      <p class="guides">
        <a href="/guide/" target="_blank">${words.guide}</a>
        <a href="/guide/reference/keyboard" target="_blank">${words.all_keys}</a>
        <a href="/docs" target="_blank">${words.contract}</a>
        <a href="/third-party-notices.txt" target="_blank">${words.licenses}</a>
      </p>
      <p class="version">${this._version ? html`Strata ${this._version}<br />` : nothing}${words.fonts}</p>
      <button slot="actions" @click=${this.showCommands}>${icon("search")}${texts.commands.title}</button>
      <button slot="actions" @click=${this.showTour}>${texts.tour.again}</button>
    </strata-dialog>`;
  }

  private gestures(rows: HelpTexts): TemplateResult {
    return html`${hasFingersOnly() ? nothing : part(rows, rows.mouse, rows.mouse_rows)} ${part(rows, rows.touch, rows.touch_rows)}`;
  }

  private others(rows: HelpTexts): TemplateResult {
    return html`${part(rows, rows.tool_keys, rows.tool_rows)} ${part(rows, rows.brush, rows.brush_rows)} ${part(rows, rows.terms, rows.terms_rows)}
    ${part(rows, rows.table, rows.table_rows)} ${part(rows, rows.layers, rows.layer_rows)}`;
  }

  /** Lists the keys of the commands, by group. */
  private commands(): TemplateResult {
    const groups = new Map<string, Command[]>();
    for (const command of keyCommands(this.host))
      groups.set(command.group, [...(groups.get(command.group) ?? []), command]);
    return html`${[...groups].map(
      ([title, commands]) =>
        html`<section>
          <h3>${title}</h3>
          <dl class="keys commands">
            ${commands.map(({ caps = [], title: does }) => html`<div><dt>${caps.map((cap) => html`<kbd>${cap}</kbd> `)}</dt><dd>${does}</dd></div>`)}
          </dl>
        </section>`,
    )}`;
  }

  private showCommands(): void {
    this._next = () => this.host.show({ dialog: "commands" });
    this._dialog.close();
  }

  private onClosed(): void {
    this.dispatchEvent(new CustomEvent("closed"));
    this._next?.();
  }

  /**
   * Closes the help before the tour starts, so the tour later returns the focus to the element that
   * opened the help.
   */
  private showTour(): void {
    this._dialog.close();
    this.dispatchEvent(new CustomEvent("tour"));
  }
}

const part = (
  { key_names: names }: HelpTexts,
  title: string,
  rows: readonly (readonly string[])[],
): TemplateResult =>
  html`<section>
    <h3>${title}</h3>
    <dl class="keys">${rows.map(([keys = "", does]) => html`<div><dt>${keyCaps(keys, names)}</dt><dd>${does}</dd></div>`)}</dl>
  </section>`;
