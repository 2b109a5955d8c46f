// <strata-command-palette>: finds a command by its words and runs it. It is a field with a list
// (the combobox pattern of ARIA). Recently used commands come first.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { Kept } from "../core/kept";
import { searched } from "../core/search";
import { texts } from "../texts";
import "../ui/dialog";
import type { StrataDialog } from "../ui/dialog";
import { icon } from "../ui/icons";
import { arrowStep } from "../ui/keyboard";
import { hasFingersOnly } from "../ui/pointers";
import { sharedStyles } from "../ui/styles";
import type { Command } from "./command";
import { keyCommands } from "./commands";
import { moreCommands } from "./more-commands";
import type { PageHost } from "./open-dialog";

const words = texts.commands;
const kMostRecent = 6;
const kPage = 8; // number of rows that Page Up and Page Down move by

interface Section {
  title: string;
  commands: readonly Command[];
}

@customElement("strata-command-palette")
export class StrataCommandPalette extends LitElement {
  @property({ attribute: false }) host!: PageHost;
  @state() private _text = "";
  @state() private _at = 0; // index of the command that Enter runs
  @query("strata-dialog") private _dialog!: StrataDialog;
  private readonly _recent = new Kept<string[]>(() => localStorage, "strata.recent_commands", []);
  private _all: readonly Command[] = [];
  private _sections: readonly Section[] = [];
  private _chosen: Command | null = null;

  static override styles = [
    sharedStyles,
    css`
      .find {
        position: relative;
      }
      .find svg.glyph {
        position: absolute;
        top: 50%;
        left: var(--space-3);
        translate: 0 -50%;
        color: var(--ink-soft);
        pointer-events: none;
      }
      .find input {
        padding-left: calc(var(--space-8) + var(--space-1));
      }
      .list {
        height: min(27rem, 60dvh);
        margin: 0 calc(-1 * var(--space-3));
        overflow: auto;
      }
      .title {
        margin: 0;
        padding: var(--space-3) var(--space-3) var(--space-1);
        color: var(--ink-soft);
        font-size: var(--text-small);
        font-weight: 600;
      }
      .command {
        display: grid;
        grid-template-columns: auto minmax(0, 1fr) auto;
        align-items: center;
        gap: 0 var(--space-3);
        min-height: 2.25rem;
        padding: var(--space-1) var(--space-3);
        border-radius: var(--radius-small);
        scroll-margin-block: 2.25rem var(--space-1);
        cursor: pointer;
      }
      .command:hover {
        background: var(--hover);
      }
      .command[aria-selected="true"] {
        background: var(--accent-soft);
        box-shadow: inset 0 0 0 2px var(--accent);
      }
      .command svg.glyph {
        width: 1.125rem;
        height: 1.125rem;
        color: var(--ink-soft);
      }
      .command[aria-disabled="true"] {
        color: var(--ink-soft);
        cursor: default;
      }
      .what {
        overflow-wrap: anywhere;
      }
      .why,
      .group {
        color: var(--ink-soft);
        font-size: var(--text-small);
      }
      .why {
        display: block;
      }
      .end {
        display: flex;
        align-items: center;
        gap: var(--space-1);
      }
      .none {
        padding: var(--space-3);
        color: var(--ink-soft);
      }
      @media (pointer: coarse) {
        .command {
          min-height: 2.75rem;
        }
      }
    `,
  ];

  override willUpdate(changed: PropertyValues): void {
    // The list stays the same when the page is rendered again, so rows do not move under the
    // pointer.
    if (this._all.length === 0)
      this._all = [...keyCommands(this.host), ...moreCommands(this.host)].filter(
        ({ isKeyOnly }) => !isKeyOnly,
      );
    if (changed.has("_text") || this._sections.length === 0)
      this._sections = this._text.trim() === "" ? this.everything() : this.found();
  }

  private everything(): Section[] {
    const recent = this._recent.value.flatMap(
      (id) => this._all.find((command) => command.id === id) ?? [],
    );
    const groups = new Map<string, Command[]>();
    for (const command of this._all)
      groups.set(command.group, [...(groups.get(command.group) ?? []), command]);
    const sections = [...groups].map(([title, commands]) => ({ title, commands }));
    return recent.length > 0 ? [{ title: words.recent, commands: recent }, ...sections] : sections;
  }

  /**
   * Returns the matching commands. Among commands with the same rank, recently used ones come first
   * and unavailable ones last.
   */
  private found(): Section[] {
    const recent = this._recent.value;
    const place = ({ id, problem }: Command): number =>
      problem ? kMostRecent + 1 : recent.includes(id) ? recent.indexOf(id) : kMostRecent;
    const all = [...this._all].sort((a, b) => place(a) - place(b));
    const commands = searched(this._text, all, ({ title, group }) => ({ title, also: group }));
    return commands.length > 0 ? [{ title: "", commands }] : [];
  }

  private get rows(): readonly Command[] {
    return this._sections.flatMap(({ commands }) => commands);
  }

  override render(): TemplateResult {
    const { rows } = this;
    let index = 0;
    return html`<strata-dialog wide top heading=${words.title} @closed=${this.onClosed}>
      <div class="find">
        ${icon("search")}
        <input
          type="text"
          role="combobox"
          aria-label=${words.find}
          aria-expanded="true"
          aria-controls="list"
          aria-autocomplete="list"
          aria-activedescendant=${rows.length > 0 ? `command-${this._at}` : nothing}
          autocomplete="off"
          autocapitalize="off"
          spellcheck="false"
          maxlength="200"
          placeholder=${words.find}
          ?autofocus=${!hasFingersOnly()}
          @input=${this.onInput}
          @keydown=${this.onKey}
        />
      </div>
      <div class="list" id="list" role="listbox" aria-label=${words.title} tabindex="-1" @pointerdown=${keepFocus}>
        ${this._sections.map(({ title, commands }) =>
          title === ""
            ? commands.map((command) => this.row(command, index++, true))
            : html`<div role="group" aria-label=${title}>
                <p class="title" aria-hidden="true">${title}</p>
                ${commands.map((command) => this.row(command, index++, false))}
              </div>`,
        )}
        ${rows.length === 0 ? html`<p class="none">${words.none}</p>` : nothing}
      </div>
      <p class="visually-hidden" role="status">${this._text === "" ? "" : rows.length === 0 ? words.none : words.found(rows.length)}</p>
    </strata-dialog>`;
  }

  private row(command: Command, index: number, withGroup: boolean): TemplateResult {
    const { title, group, glyph, caps, problem } = command;
    return html`<div
      class="command"
      role="option"
      id="command-${index}"
      data-command=${command.id}
      aria-selected=${index === this._at}
      aria-disabled=${problem ? "true" : nothing}
      @click=${() => this.choose(command)}
    >
      ${glyph ? icon(glyph) : html`<span></span>`}
      <span class="what">${title}${problem ? html` <span class="why">${problem}</span>` : nothing}</span>
      <span class="end">
        ${withGroup ? html`<span class="group">${group}</span>` : nothing}
        ${caps && !hasFingersOnly() ? caps.map((cap) => html`<kbd>${cap}</kbd>`) : nothing}
      </span>
    </div>`;
  }

  private onInput(event: Event): void {
    this._text = (event.target as HTMLInputElement).value;
    this._at = 0;
    this.bringRow();
  }

  private onKey(event: KeyboardEvent): void {
    const { rows } = this;
    const { key } = event;
    if (event.isComposing || event.altKey || event.ctrlKey || event.metaKey) return;
    if (key === "Enter") {
      event.preventDefault();
      const command = rows[this._at];
      if (command) this.choose(command);
      return;
    }
    const last = rows.length - 1;
    const next =
      key === "PageDown"
        ? Math.min(last, this._at + kPage)
        : key === "PageUp"
          ? Math.max(0, this._at - kPage)
          : key === "ArrowDown" || key === "ArrowUp"
            ? arrowStep(key, this._at, rows.length)
            : null;
    if (next === null) return;
    event.preventDefault();
    this._at = next;
    this.bringRow();
  }

  private bringRow(): void {
    void this.updateComplete.then(() =>
      this.renderRoot.querySelector(`#command-${this._at}`)?.scrollIntoView({ block: "nearest" }),
    );
  }

  private choose(command: Command): void {
    if (command.problem) return;
    this._chosen = command;
    this._recent.value = [
      command.id,
      ...this._recent.value.filter((id) => id !== command.id),
    ].slice(0, kMostRecent);
    this._dialog.close();
  }

  /** Runs the command after this dialog has closed, because the command may open another dialog. */
  private onClosed(): void {
    this.dispatchEvent(new CustomEvent("closed"));
    this._chosen?.run("");
  }
}

/** Keeps the focus in the field when the user presses on the list. */
const keepFocus = (event: Event): void => event.preventDefault();

declare global {
  interface HTMLElementTagNameMap {
    "strata-command-palette": StrataCommandPalette;
  }
}
