// <strata-photos-dialog>: attaches files to records by their file names. It shows the target of
// each file before it sends the files.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { labelColumn, labelOf } from "../../domain/cells";
import type { AttachmentMatches, Column, MatchedName } from "../../core/protocol.gen";
import "../../ui/dialog";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { choicesStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.files;
const kAskMs = 250; // delay after the last key press in the pattern
const kMostShown = 200;

/**
 * Returns a likely pattern for the names of these files. Underscores and dots separate words, and
 * the first word names the record.
 */
export function likelyPattern(names: readonly string[], column: string): string {
  const [first = ""] = names;
  const dot = first.lastIndexOf(".");
  const [stem, ending] = dot > 0 ? [first.slice(0, dot), first.slice(dot)] : [first, ""];
  const parts = stem.split("_");
  const others = ["view", "n"];
  const rest = parts.slice(1).map((_, index) => `{${others[index] ?? `word${index + 1}`}}`);
  return `${[`{${column}}`, ...rest].join("_")}${names.every((name) => name.endsWith(ending)) ? ending : ".{type}"}`;
}

@customElement("strata-photos-dialog")
export class StrataPhotosDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The table's id. */
  @property({ attribute: false }) table = 0;
  @property({ attribute: false }) files: File[] = [];
  @state() private _column = ""; // the column whose values are part of the file names
  @state() private _target = ""; // the column that receives the files
  @state() private _pattern = "";
  @state() private _matches: AttachmentMatches | null = null;
  @state() private _problem = "";
  @state() private _sent = 0;
  @state() private _busy = false;
  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _asked = 0;
  private _stopped = false;

  static override styles = [
    sharedStyles,
    choicesStyles,
    css`
      .found {
        max-height: 300px;
        overflow: auto;
      }
      table {
        width: 100%;
        border-collapse: collapse;
        font-size: var(--text-small);
      }
      th {
        padding-top: var(--space-2);
        text-align: left;
        font-size: var(--text-tiny);
        color: var(--ink-soft);
      }
      td {
        padding: var(--space-1) var(--space-2) var(--space-1) 0;
        border-bottom: var(--edge) solid var(--line);
        overflow-wrap: anywhere;
      }
      td.left {
        color: var(--ink-soft);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    const columns = this.columns;
    const table = this.session.tables.find(this.table);
    const title = table ? labelColumn(table) : null;
    // file names do not contain terms, so the key is used instead
    this._column = title && title.kind !== "term" ? title.slug : "key";
    this._target = (columns.find(({ kind }) => kind === "picture") ?? columns[0])?.slug ?? "";
    this._pattern = likelyPattern(this.names, this._column);
    this._problem = this._target === "" ? words.no_column : "";
    if (this._target !== "") void this.match();
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._stopped = true;
    if (this._timer) clearTimeout(this._timer);
  }

  private get names(): string[] {
    return this.files.map(({ name }) => name);
  }
  private get columns(): Column[] {
    return (
      this.session.tables
        .find(this.table)
        ?.columns.filter(({ kind }) => kind === "picture" || kind === "document") ?? []
    );
  }

  override render(): TemplateResult {
    const { _matches: matches, session } = this;
    const named =
      session.tables
        .find(this.table)
        ?.columns.filter(
          ({ kind }) => kind === "text" || kind === "integer" || kind === "enumeration",
        ) ?? [];
    const ready = matches !== null && matches.matched.length > 0 && !this._busy;
    return html`<strata-dialog wide heading=${words.folder_title(this.files.length)} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <div class="choices" ?inert=${this._busy}>
        <label
          ><span class="caption">${words.by_column}</span>
          <select @change=${(event: Event) => this.chooseColumn((event.target as HTMLSelectElement).value)}>
            <option value="key" ?selected=${this._column === "key"}>${texts.tables.key}</option>
            ${named.map((column) => html`<option value=${column.slug} ?selected=${column.slug === this._column}>${labelOf(column)}</option>`)}
          </select></label
        >
        <label
          ><span class="caption">${words.into}</span>
          <select @change=${(event: Event) => (this._target = (event.target as HTMLSelectElement).value)}>
            ${this.columns.map((column) => html`<option value=${column.slug} ?selected=${column.slug === this._target}>${labelOf(column)}</option>`)}
          </select></label
        >
        <label class="full"
          ><span class="caption">${words.pattern}</span>
          <input type="text" spellcheck="false" maxlength="200" .value=${this._pattern} @input=${(event: Event) => this.setPattern((event.target as HTMLInputElement).value)} />
          <span class="hint">${words.pattern_hint}</span></label
        >
      </div>
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      ${matches ? this.found(matches) : nothing}
      ${this._busy ? html`<p class="hint" role="status">${words.sending(this._sent + 1, matches?.matched.length ?? 0)}</p>` : nothing}
      <button slot="actions" class="primary" ?disabled=${!ready} @click=${() => void this.send()}>${words.send(matches?.matched.length ?? 0)}</button>
    </strata-dialog>`;
  }

  private found({ matched, unmatched, duplicate }: AttachmentMatches): TemplateResult {
    const rows = (
      title: string,
      names: readonly MatchedName[],
      tell: (name: MatchedName) => unknown,
    ): TemplateResult | typeof nothing =>
      names.length === 0
        ? nothing
        : html`<tbody>
            <tr>
              <th colspan="2">${title}</th>
            </tr>
            ${names.slice(0, kMostShown).map((each) => html`<tr><td>${each.name}</td><td class="left">${tell(each)}</td></tr>`)}
            ${names.length > kMostShown ? html`<tr><td colspan="2" class="left">${words.more(names.length - kMostShown)}</td></tr>` : nothing}
          </tbody>`;
    const record = ({ key = 0 }: MatchedName): string =>
      this.session.tables.label(this.table, key) ?? texts.tables.record(key);
    return html`<div class="found">
      <table>
        ${rows(words.matched(matched.length), matched, record)} ${rows(words.duplicates(duplicate.length), duplicate, ({ reason = "twice" }) => words.reasons[reason])}
        ${rows(words.unmatched(unmatched.length), unmatched, ({ reason = "pattern" }) => words.reasons[reason])}
      </table>
    </div>`;
  }

  private chooseColumn(slug: string): void {
    this._pattern = this._pattern.replace(`{${this._column}}`, `{${slug}}`);
    this._column = slug;
    void this.match();
  }
  private setPattern(pattern: string): void {
    this._pattern = pattern;
    if (this._timer) clearTimeout(this._timer);
    this._timer = setTimeout(() => void this.match(), kAskMs);
  }

  /** Requests the matches. Ignores a response if a later request was sent. */
  private async match(): Promise<void> {
    const asked = ++this._asked;
    const { _pattern: pattern, _column: column, names } = this;
    try {
      const matches = await this.session.api.json("POST /tables/{table}/attachments/match", {
        path: { table: this.table },
        body: {
          pattern,
          column,
          names,
        },
      });
      if (asked !== this._asked) return;
      this._matches = matches;
      this._problem = "";
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked !== this._asked) return;
      this._matches = null;
      this._problem = error.message;
    }
  }

  /**
   * Sends one file at a time. Files that were sent before a refusal remain, and a second attempt
   * omits them.
   */
  private async send(): Promise<void> {
    const { _matches: matches, _target: target } = this;
    if (!matches || this._busy) return;
    this._busy = true;
    this._sent = 0;
    this._problem = "";
    try {
      for (const { name, key } of matches.matched) {
        if (this._stopped) break;
        const file = this.files.find((each) => each.name === name);
        if (!file || key === undefined) continue;
        await this.session.api.send("POST /tables/{table}/records/{key}/attachments", {
          path: { table: this.table, key },
          query: { name: file.name, column: target },
          body: file,
        });
        this._sent += 1;
      }
      notices.show("success", words.sent(this._sent));
      this.dispatchEvent(new CustomEvent("closed"));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      const { message } = error;
      await this.match();
      this._problem = message;
    } finally {
      this._busy = false;
      this.session.tables.view?.rows.refresh();
    }
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-photos-dialog": StrataPhotosDialog;
  }
}
