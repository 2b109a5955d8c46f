// The column headers of a table: names, sorting, column widths, and a menu for each column.

import { html, nothing, type ReactiveControllerHost, type TemplateResult } from "lit";
import { canBeTitle, isNumber, labelColumn, labelOf } from "../../domain/cells";
import { chosenIn } from "../../domain/column-filter";
import { kAsItIs } from "../../net/api";
import type { Column, Table } from "../../core/protocol.gen";
import "./column-filter";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { measuresOf } from "../../session/fields/record-measures";
import type { TablePanelRequest } from "../../session/requests";
import type { TableColumns } from "./table-columns";
import type { TableView } from "./table-view";
import { texts } from "../../texts";
import { visibilityBadge } from "../../ui/visibility";

export interface TableHeadHost extends ReactiveControllerHost {
  readonly session: ModelSession;
  readonly view: TableView;
  readonly columns: TableColumns;
  sort(name: string): void;
  setFilter(filter: string): void;
  drop(column: Column): void;
  request(what: TablePanelRequest): void;
}

export class TableHead {
  // the column whose filter is open
  private _filtered: { column: Column; anchor: HTMLElement } | null = null;

  constructor(private readonly _host: TableHeadHost) {}

  private choose(filtered: { column: Column; anchor: HTMLElement } | null): void {
    this._filtered = filtered;
    this._host.requestUpdate();
  }

  row(table: Table): TemplateResult {
    const words = texts.tables;
    return html`<div class="head" role="row" aria-rowindex="1">
      ${this.headCell("key", words.key, "key")}
      ${table.columns.map((column) => this.headCell(column.slug, labelOf(column), isNumber(column) ? "number" : "", column))}
      ${measuresOf(table).map(({ name, label }) => this.headCell(name, label, "number"))}
    </div>`;
  }

  private headCell(name: string, label: string, kind: string, column?: Column): TemplateResult {
    const words = texts.tables;
    const { sortby } = this._host.view.rows;
    const sorted = sortby === name ? "ascending" : sortby === `-${name}` ? "descending" : "none";
    return html`<div class="cell ${kind}" role="columnheader" aria-sort=${sorted}>
      <button class="sort" tabindex="-1" title=${column?.comment || words.sort(label)} @click=${() => this._host.sort(name)}>
        <span class="ellipsis"
          >${label}${column?.unit ? html` <span class="unit">${column.unit}</span>` : nothing}${
            column?.required
              ? html`<span class="required" title=${words.required}> *</span>`
              : nothing
          }</span
        >
        ${column ? visibilityBadge(column.visibility) : nothing} ${sorted === "none" ? nothing : icon(sorted === "ascending" ? "up" : "down")}
      </button>
      ${column ? this.filterButton(column, label) : nothing}
      ${
        column && this._host.session.canCurate
          ? html`<strata-menu label=${words.column_menu(label)} small>
            <button class="quiet" role="menuitem" @click=${() => this._host.request({ dialog: "column", table: this._host.view.tableId, column })}>
              ${icon("edit")}${words.change_column}
            </button>
            ${this.titleButton(column)}
            <button class="quiet" role="menuitem" @click=${() => this._host.drop(column)}>
              ${icon("trash")}${words.drop_column}
            </button>
          </strata-menu>`
          : nothing
      }
      <span class="edge" @pointerdown=${(event: PointerEvent) => this.onEdge(event, name)}></span>
    </div>`;
  }

  private filterButton(column: Column, label: string): TemplateResult {
    const words = texts.column_filter;
    const isOn = chosenIn(this._host.view.rows.filter, column) !== null;
    const told = isOn ? words.open_on(label) : words.open(label);
    return html`<button class="icon quiet by-column ${isOn ? "on" : ""}" aria-haspopup="dialog" aria-label=${told} title=${told} @click=${(event: Event) => this.openFilter(column, event)}>
      ${icon("filter")}
    </button>`;
  }

  /** Renders the button that makes the column the source of the records' names. */
  private titleButton(column: Column): TemplateResult | typeof nothing {
    const words = texts.tables;
    const { table } = this._host.view;
    if (!table || table.kind === "terms" || !canBeTitle(column)) return nothing;
    const isTitle = labelColumn(table)?.id === column.id;
    return html`<button
      class="quiet"
      role="menuitemcheckbox"
      aria-checked=${isTitle}
      ?disabled=${isTitle && table.title_column !== column.id}
      title=${words.title_hint}
      @click=${() => void this.setTitle(table.id, isTitle ? null : column.id)}
    >
      ${icon(isTitle ? "check" : "edit")}${words.title_column}
    </button>`;
  }

  private async setTitle(table: number, column: number | null): Promise<void> {
    try {
      await this._host.session.api.json("PATCH /tables/{table}", {
        path: { table },
        body: { title_column: column === null ? "" : `${column}` },
        header: kAsItIs,
      });
      await this._host.session.tables.reload(table);
    } catch (error) {
      notices.error(error);
    }
  }

  private onEdge(event: PointerEvent, name: string): void {
    const edge = event.currentTarget as HTMLElement;
    const width = edge.parentElement!.getBoundingClientRect().width;
    edge.setPointerCapture(event.pointerId);
    event.preventDefault();
    const move = (moved: PointerEvent): void => {
      this._host.columns.drag(name, width + moved.clientX - event.clientX);
      this._host.requestUpdate();
    };
    edge.addEventListener("pointermove", move);
    edge.addEventListener(
      "lostpointercapture",
      () => edge.removeEventListener("pointermove", move),
      { once: true },
    );
  }

  private openFilter(column: Column, event: Event): void {
    this.choose({ column, anchor: event.currentTarget as HTMLElement });
  }

  /** Renders the filter of a column while it is open. */
  filter(table: Table): TemplateResult | typeof nothing {
    const { view } = this._host;
    const filtered = this._filtered;
    const column = filtered && table.columns.find(({ id }) => id === filtered.column.id);
    if (!filtered || !column) return nothing;
    return html`<strata-column-filter
      .session=${this._host.session}
      .table=${view.tableId}
      .column=${column}
      .filter=${view.rows.filter}
      .anchor=${filtered.anchor}
      @filter=${(event: CustomEvent<string>) => this._host.setFilter(event.detail)}
      @closed=${() => this.choose(null)}
    ></strata-column-filter>`;
  }
}
