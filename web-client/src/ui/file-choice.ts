// <strata-file-choice>: the choice of files in a dialog: a button and a drop target next to it. The
// event "files" contains the files.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { formatList } from "../core/locale";
import { FileDrop } from "./drop";
import { icon } from "./icons";
import { sharedStyles } from "./styles";
import { texts } from "../texts";

const words = texts.file_choice;

@customElement("strata-file-choice")
export class StrataFileChoice extends LitElement {
  /** A description of the expected files. */
  @property() label = "";
  /** The accepted file extensions, as in <input accept>. */
  @property() accept = "";
  /**
   * Whether several files that belong together are accepted. Otherwise only the first file is used.
   */
  @property({ type: Boolean }) multiple = false;
  @property({ type: Boolean }) disabled = false;
  /** The names of the accepted files. */
  @property({ attribute: false }) names: readonly string[] = [];
  @query("input") private _input!: HTMLInputElement;
  private readonly _drop = new FileDrop(this, (files) => this.take(files));

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
      }
      div {
        display: flex;
        align-items: center;
        gap: var(--space-3);
        padding: var(--space-3);
        border: var(--edge) dashed var(--line-strong);
        border-radius: var(--radius-small);
      }
      div.over {
        border-color: var(--accent);
        background: var(--accent-soft);
      }
      input {
        display: none;
      }
      button {
        flex: none;
      }
      span {
        min-width: 0;
        overflow-wrap: anywhere;
      }
    `,
  ];

  override render(): TemplateResult {
    const { label, names, multiple, disabled } = this;
    const choose = multiple ? words.choose_several : words.choose;
    const drop = multiple ? words.drop_several : words.drop;
    return html`<div
      role="group"
      aria-label=${label}
      class=${this._drop.over ? "over" : ""}
    >
      <button type="button" ?disabled=${disabled} @click=${() => this._input.click()}>${icon("upload")}${choose}</button>
      <input
        type="file"
        tabindex="-1"
        aria-label=${label}
        accept=${this.accept}
        ?multiple=${multiple}
        ?disabled=${disabled}
        @change=${this.onChosen}
      />
      <span class=${names.length > 0 ? "" : "hint"} role="status">${names.length > 0 ? formatList(names) : drop}</span>
    </div>`;
  }

  private take(files: readonly File[]): void {
    if (this.disabled) return;
    const taken = this.multiple ? [...files] : files.slice(0, 1);
    if (taken.length > 0) this.dispatchEvent(new CustomEvent<File[]>("files", { detail: taken }));
  }

  private readonly onChosen = (): void => {
    const files = [...(this._input.files ?? [])];
    this._input.value = ""; // allows the user to choose a corrected file again
    this.take(files);
  };
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-file-choice": StrataFileChoice;
  }
}
