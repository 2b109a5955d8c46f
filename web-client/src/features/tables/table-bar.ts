// <strata-table-bar>: the bar above a table, with its title, the filter, and commands for the whole
// table.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { holdsFiles, labelOf } from "../../domain/cells";
import { formatArea } from "../../domain/measure";
import type { Table } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { openTrashOf } from "../../ui/trash-dialog";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import type { ModelSession } from "../../session/model-session";
import { saveFrom } from "../../ui/save-from";
import { sharedStyles } from "../../ui/styles";
import type { TableView } from "./table-view";
import { withKey } from "../../ui/keys/command-keys";
import { texts } from "../../texts";
import type { TablePanelRequest } from "../../session/requests";

@customElement("strata-table-bar")
export class StrataTableBar extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) view!: TableView;
  /** Whether the panel is too narrow for a single row of tools. */
  @property({ type: Boolean, reflect: true }) narrow = false;
  @query(".filter input") private _filter!: HTMLInputElement;

  constructor() {
    super();
    followSession(this, "tables", "layers");
  }

  static override styles = [
    sharedStyles,
    css`
    :host {
      display: block;
      flex: none;
    }
    .bar {
      display: flex;
      align-items: center;
      gap: var(--space-2);
      padding: var(--space-1) var(--space-2) var(--space-1) var(--space-3);
      border-bottom: var(--edge) solid var(--line);
    }
    .bar h2 {
      font-size: var(--text-large);
      flex: 0 1 auto; /* shrinks, so the last buttons stay inside the panel */
      min-width: 4rem;
      max-width: 30%;
    }
    .bar .count {
      flex: 0 1 auto;
      min-width: 0;
      overflow: hidden;
      text-overflow: ellipsis;
      white-space: nowrap;
    }
    .bar button,
    .bar input[type="text"] {
      min-height: 2rem;
    }
    .bar button.icon {
      width: 2rem;
    }
    .filter {
      position: relative;
      flex: 100 1 10rem; /* takes the free space before the gap */
      min-width: 12rem;
      max-width: 40rem;
      margin-left: var(--space-2);
    }
    .filter input {
      padding-right: var(--space-8);
      font: var(--text-small) var(--mono);
    }
    .filter button {
      position: absolute;
      right: 0;
      top: 0;
    }
    .on-model {
      display: flex;
      flex: none;
      align-items: center;
      gap: var(--space-half);
      white-space: nowrap;
    }
    .on-model button[aria-pressed="true"] {
      background: var(--accent-soft);
      color: var(--accent);
    }
    .on-model .hint {
      padding-right: var(--space-2);
    }
    .files {
      display: flex;
      flex: none;
      gap: var(--space-half);
    }
    .files button {
      padding: 0 var(--space-2);
      font-size: var(--text-small);
    }
    @container (max-width: 1100px) {
      .bar .words {
        display: none;
      }
    }
    /* the first row has the title and the close button, and the second row has the filter */
    :host([narrow]) .bar {
      flex-wrap: wrap;
      row-gap: var(--space-1);
    }
    :host([narrow]) .bar h2 {
      flex: 1 1 0;
      min-width: 3.75rem;
      max-width: none;
    }
    :host([narrow]) .bar > .grow {
      display: none;
    }
    :host([narrow]) .bar::after {
      content: "";
      order: 1;
      flex-basis: 100%;
    }
    :host([narrow]) .filter {
      order: 2;
      max-width: none;
      margin-left: 0;
    }
    :host([narrow]) .on-model {
      order: 2;
    }
    `,
  ];

  override render(): TemplateResult | typeof nothing {
    const { table } = this.view;
    const layer = this.session.layers.find(this.view.layerId);
    return table && layer ? this.bar(table, layer) : nothing;
  }

  private bar(table: Table, layer: Layer): TemplateResult {
    const words = texts.tables;
    const { view, session } = this;
    const { rows } = view;
    const shown =
      rows.filter === "" ? words.records(rows.total) : words.records_of(rows.total, table.records);
    return html`<div class="bar">
      <h2 class="ellipsis" title=${table.description}>${labelOf(table)}</h2>
      <span class="hint count" role="status">${view.told || (rows.loaded ? shown : "")}</span>
      ${view.outdated ? html`<button class="link" title=${words.outdated_hint} @click=${() => rows.refresh()}>${words.outdated}</button>` : nothing}
      <div class="filter">
        <input
          type="text"
          spellcheck="false"
          autocapitalize="off"
          maxlength="4096"
          aria-label=${words.filter}
          placeholder=${words.filter_example}
          aria-invalid=${rows.problem?.field === "filter" ? "true" : "false"}
          .value=${rows.filter}
          @change=${this.onFilter}
          @keydown=${this.onFilterKey}
        />
        ${
          rows.filter === ""
            ? nothing
            : html`<button class="icon quiet" aria-label=${words.filter_clear} title=${words.filter_clear} @click=${() => rows.setQuery({ filter: "" })}>
              ${icon("close")}
            </button>`
        }
      </div>
      <span class="grow"></span>
      ${this.onModel()}
      ${
        this.session.canPaint
          ? html`<button aria-label=${words.new_record} title=${words.new_record} @click=${() => this.request({ dialog: "record", layer, key: null })}>
              ${icon("plus")}<span class="words">${words.new_record}</span>
            </button>
            ${this.narrow ? nothing : this.turns("tool")}`
          : nothing
      }
      ${
        this.narrow
          ? nothing
          : html`<span class="files">
            <button title=${words.save_xlsx} aria-label=${words.save_xlsx} @click=${() => this.saveWorkbook(table, "xlsx")}>XLSX</button>
            <button title=${words.save_csv} aria-label=${words.save_csv} @click=${() => this.saveWorkbook(table, "csv")}>CSV</button>
          </span>`
      }
      <strata-menu label=${words.more}>
        ${this.session.canPaint && this.narrow ? html`${this.turns("menuitem")}<hr />` : nothing}
        ${
          session.canCurate
            ? html`<button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "column", table: table.id, column: null })}>
                ${icon("plus")}${words.new_column}
              </button>
              <hr />`
            : nothing
        }
        <button class="quiet" role="menuitem" @click=${() => this.saveWorkbook(table, "xlsx")}>${icon("import")}${words.save_xlsx}</button>
        <button class="quiet" role="menuitem" @click=${() => this.saveWorkbook(table, "csv")}>${icon("import")}${words.save_csv}</button>
        <button class="quiet" role="menuitem" @click=${() => this.saveWorkbook(table, "csv", { separator: "semicolon" })}>${icon("import")}${words.save_csv_semicolon}</button>
        ${table.kind === "terms" ? this.termsMenu(table) : nothing}
        ${
          this.session.canPaint
            ? html`<button class="quiet" role="menuitem" @click=${() => this.chooseCsv(table)}>${icon("upload")}${words.import_csv}</button>
              ${
                table.columns.some(holdsFiles)
                  ? html`<button class="quiet" role="menuitem" @click=${() => this.choosePhotos(table)}>${icon("picture")}${texts.files.add_menu}</button>`
                  : nothing
              }
              <hr />
              <button class="quiet" role="menuitem" @click=${() => void openTrashOf(session)}>${icon("trash")}${texts.bin.open}</button>`
            : nothing
        }
      </strata-menu>
      <button class="icon quiet" aria-label=${words.close} title=${withKey(words.close, "table")} @click=${() => session.tables.close()}>${icon("close")}</button>
    </div>`;
  }

  /** Renders undo and redo, among the tools or in the menu. */
  private turns(place: "tool" | "menuitem"): TemplateResult[] {
    const { view } = this;
    const words = texts.tables;
    const turn = (glyph: "undo" | "redo", does: () => Promise<void>): TemplateResult =>
      place === "tool"
        ? html`<button class="icon quiet" aria-label=${words[glyph]} title=${words[glyph]} @click=${does}>${icon(glyph)}</button>`
        : html`<button class="quiet" role="menuitem" @click=${does}>${icon(glyph)}${words[glyph]}</button>`;
    return [turn("undo", () => view.undo()), turn("redo", () => view.redo())];
  }

  private termsMenu(table: Table): TemplateResult {
    const words = texts.terms_dialog;
    const { api, canCurate } = this.session;
    const save = (format: "csv" | "turtle", ending: string) => () =>
      saveFrom(
        api.url("GET /tables/{table}/terms", { path: { table: table.id }, query: { f: format } }),
        `${table.slug}.${ending}`,
      );
    return html`<hr />
      <button class="quiet" role="menuitem" @click=${save("csv", "csv")}>${icon("import")}${words.save_csv}</button>
      <button class="quiet" role="menuitem" @click=${save("turtle", "ttl")}>${icon("import")}${words.save_turtle}</button>
      ${
        canCurate
          ? html`<button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "terms", table: table.id, file: null })}>
            ${icon("upload")}${words.open_more}
          </button>`
          : nothing
      }
      <hr />`;
  }

  /** Renders the buttons that highlight the selected or filtered rows on the model. */
  private onModel(): TemplateResult {
    const words = texts.tables;
    const { view } = this;
    const { extent, highlight } = view;
    const byFilter = extent !== null && view.selected.size === 0;
    const isNowhere = extent !== null && !extent.bounds;
    return html`<div class="on-model" role="group" aria-label=${words.on_model}>
      ${byFilter ? html`<span class="hint" title=${words.painted_of(extent.painted, extent.records)}>${formatArea(extent.area_m2)}</span>` : nothing}
      <button
        class="icon quiet"
        aria-pressed=${view.lightsUp}
        aria-label=${words.light_up}
        title="${words.light_up}. ${words.light_up_hint}"
        @click=${() => view.setLightsUp(!view.lightsUp)}
      >
        ${icon("bulb")}
      </button>
      <button class="icon quiet" aria-pressed=${view.isolates} aria-label=${words.isolate} title=${words.isolate} @click=${() => view.setIsolates(!view.isolates)}>
        ${icon("isolate")}
      </button>
      <button
        class="icon quiet"
        ?disabled=${highlight === null || isNowhere}
        aria-label=${words.fly}
        title=${isNowhere ? words.nothing_here : words.fly}
        @click=${() => view.fly()}
      >
        ${icon("fit")}
      </button>
    </div>`;
  }

  // ── filter and files

  private onFilter(): void {
    this.dispatchEvent(new CustomEvent("filter", { detail: this._filter.value.trim() }));
  }

  private onFilterKey(event: KeyboardEvent): void {
    if (event.key === "Enter") this.onFilter();
    else if (event.key === "Escape") this._filter.value = this.view.rows.filter;
  }

  /** Saves the filtered rows in their order. */
  private saveWorkbook(
    table: Table,
    format: "csv" | "xlsx",
    more: Record<string, string> = {},
  ): void {
    const { sortby, filter } = this.view.rows;
    const query = {
      f: format,
      ...more,
      ...(sortby ? { sortby } : {}),
      ...(filter ? { filter } : {}),
    };
    saveFrom(
      this.session.api.url("GET /models/{model}/layers/{layer}/records", {
        path: { model: this.session.modelId, layer: this.view.layerId },
        query,
      }),
      `${table.slug}.${format}`,
    );
  }

  private choosePhotos(table: Table): void {
    const input = document.createElement("input");
    input.type = "file";
    input.multiple = true;
    input.addEventListener("change", () => {
      const files = [...(input.files ?? [])];
      if (files.length > 0) this.request({ dialog: "photos", table: table.id, files });
    });
    input.click();
  }
  private chooseCsv(table: Table): void {
    const input = document.createElement("input");
    input.type = "file";
    input.accept = ".csv,.tsv,.txt,text/csv";
    input.addEventListener("change", () => {
      const [file] = input.files ?? [];
      if (file) this.request({ dialog: "csv", table: table.id, file });
    });
    input.click();
  }

  private request(detail: TablePanelRequest): void {
    this.dispatchEvent(new CustomEvent<TablePanelRequest>("request", { detail }));
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-table-bar": StrataTableBar;
  }
}
