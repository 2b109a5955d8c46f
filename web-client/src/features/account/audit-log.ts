// <strata-audit-log>: the audit log of the site, for administrators. It shows the newest entries,
// filters them and downloads them.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import {
  changeIn,
  isFiltered,
  kAuditActions,
  kNoFilter,
  queryOf,
  type AuditFilter,
} from "../../domain/audit";
import type { AuditEntry } from "../../core/protocol.gen";
import type { Role } from "../../core/types";
import { icon } from "../../ui/icons";
import { saveFrom } from "../../ui/save-from";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { toldTime } from "../../domain/times";

const words = texts.audit;
const kPageSize = 100;

@customElement("strata-audit-log")
export class StrataAuditLog extends LitElement {
  @property({ attribute: false }) api!: Api;
  @state() private _entries: readonly AuditEntry[] | null = null;
  @state() private _days = 0;
  @state() private _filter: AuditFilter = kNoFilter;
  @state() private _next: string | null = null;
  @state() private _busy = false;
  @state() private _problem = "";
  private _asked = 0; // counts the reads, so that a late response of an earlier filter is ignored

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-3);
      }
      form {
        display: grid;
        grid-template-columns: repeat(auto-fill, minmax(10rem, 1fr));
        align-items: end;
        gap: var(--space-2) var(--space-3);
      }
      .scroll {
        overflow-x: auto;
      }
      table {
        width: 100%;
        min-width: 36rem; /* a phone scrolls the table instead of breaking its words */
        border-collapse: collapse;
      }
      th,
      td {
        padding: var(--space-2) var(--space-3) var(--space-2) 0;
        text-align: left;
        vertical-align: top;
        overflow-wrap: anywhere;
      }
      th {
        font-size: var(--text-tiny);
        color: var(--ink-soft);
      }
      td {
        border-top: var(--edge) solid var(--line);
      }
      td .hint {
        display: block;
      }
      .time {
        min-width: 7.5rem;
      }
      button.more {
        justify-self: start;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.read();
  }

  private async read(at: string | null = null): Promise<void> {
    const asked = ++this._asked;
    this._busy = true;
    this._problem = "";
    try {
      const query = { ...queryOf(this._filter), limit: kPageSize };
      const { value, next } = await this.api.page("GET /audit", { query }, at);
      if (asked !== this._asked) return;
      this._entries = at ? [...(this._entries ?? []), ...value.entries] : value.entries;
      this._days = value.days;
      this._next = next;
    } catch (error) {
      if (asked === this._asked) this._problem = this.told(error);
    } finally {
      if (asked === this._asked) this._busy = false;
    }
  }

  private told(error: unknown): string {
    if (!(error instanceof ApiError)) throw error;
    if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
    return error.message;
  }

  override render(): TemplateResult {
    const { _entries: entries } = this;
    return html`${this.filters()}
      ${entries ? html`<p class="hint">${words.lead(this._days)}</p>` : nothing}
      ${
        entries === null
          ? html`<p class="hint" role="status" ?hidden=${this._problem !== ""}>${texts.loading}</p>`
          : entries.length === 0
            ? html`<p role="status">${isFiltered(this._filter) ? words.none_found : words.none}</p>`
            : this.table(entries)
      }
      ${
        this._problem
          ? html`<p class="error" role="alert">${this._problem}</p>
            <button class="more" @click=${() => void this.read()}>${texts.try_again}</button>`
          : this._next
            ? html`<button class="more" ?disabled=${this._busy} @click=${() => void this.read(this._next)}>${words.more}</button>`
            : nothing
      }`;
  }

  private filters(): TemplateResult {
    const change =
      (name: keyof AuditFilter) =>
      (event: Event): void => {
        const { value } = event.target as HTMLInputElement | HTMLSelectElement;
        this._filter = { ...this._filter, [name]: value };
        void this.read();
      };
    const field = (name: "actor" | "from" | "to", type: string): TemplateResult =>
      html`<label class="field">
        <span>${words[name]}</span>
        <input
          type=${type}
          maxlength=${type === "text" ? 255 : nothing}
          autocomplete="off"
          autocapitalize="off"
          spellcheck="false"
          .value=${this._filter[name]}
          @change=${change(name)}
        />
      </label>`;
    return html`<form @submit=${(event: Event) => event.preventDefault()}>
      ${field("actor", "text")}
      <label class="field">
        <span>${words.action}</span>
        <select .value=${this._filter.action} @change=${change("action")}>
          <option value="">${words.all_actions}</option>
          ${kAuditActions.map((action) => html`<option value=${action}>${words.actions[action]}</option>`)}
        </select>
      </label>
      ${field("from", "date")} ${field("to", "date")}
      <button type="button" ?disabled=${!this._entries?.length} @click=${this.download}>${icon("import")}${words.download}</button>
    </form>`;
  }

  private readonly download = (): void =>
    saveFrom(
      this.api.url("GET /audit", { query: { ...queryOf(this._filter), f: "jsonl" } }),
      "audit.jsonl",
    );

  private table(entries: readonly AuditEntry[]): TemplateResult {
    return html`<div class="scroll" tabindex="0" role="region" aria-label=${words.title}>
      <table>
        <thead>
          <tr>
            <th scope="col">${words.time}</th>
            <th scope="col">${words.who}</th>
            <th scope="col">${words.what}</th>
            <th scope="col">${words.subject}</th>
            <th scope="col">${words.address}</th>
          </tr>
        </thead>
        <tbody>
          ${repeat(
            entries,
            ({ id }) => id,
            (entry) => this.row(entry),
          )}
        </tbody>
      </table>
    </div>`;
  }

  private row(entry: AuditEntry): TemplateResult {
    const notes = this.notes(entry);
    return html`<tr>
      <td class="time"><time datetime=${entry.time}>${toldTime(entry.time)}</time></td>
      <td>${this.actor(entry)}</td>
      <td>${words.actions[entry.action]}${notes ? html`<span class="hint">${notes}</span>` : nothing}</td>
      <td>
        ${entry.subject ?? ""}${entry.project_slug ? html`<span class="hint">${entry.project_slug}</span>` : nothing}
      </td>
      <td>${entry.address ?? ""}</td>
    </tr>`;
  }

  private actor({ actor, actor_kind: kind }: AuditEntry): TemplateResult {
    const how = kind === "token" ? words.by_token : kind === "link" ? words.by_link : "";
    return html`${kind === "server" ? words.server : (actor ?? words.unknown)}${how ? html`<span class="hint">${how}</span>` : nothing}`;
  }

  /** Returns a summary of the details. The download contains all details. */
  private notes(entry: AuditEntry): string {
    const { group, records, user } = entry.details;
    const isRole = entry.action === "role_changed" || entry.action.startsWith("member_");
    const change = changeIn(entry, (value) =>
      isRole ? (texts.roles[value as Role] ?? value) : value,
    );
    return [
      entry.count > 1 ? words.attempts(entry.count) : "",
      change,
      typeof group === "string" ? group : "",
      typeof records === "number" ? words.records(records) : "",
      typeof user === "string" && user !== entry.actor ? user : "",
    ]
      .filter((note) => note !== "")
      .join(" · ");
  }
}
