// <strata-bills-dialog>: the bills of quantities of a project. It creates, imports, renames, deletes
// and exports bills, and opens one of them (bill-dialog.ts).

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { newId } from "../../core/ids";
import type { BillEntry } from "../../core/protocol.gen";
import type { Api } from "../../net/api";
import { ApiError } from "../../net/api-error";
import { ask, askText } from "../../ui/dialog";
import "../../ui/file-choice";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import { rowList, rowListStyles, type ListedRow } from "../../ui/row-list";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "./bill-dialog";
import { BillFiles } from "./bill-files";

const words = texts.bills;
const kFiles = ".x80,.x81,.x82,.x83,.x84,.x85,.x86,.xml";

@customElement("strata-bills-dialog")
export class StrataBillsDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  /** The slug of the project. */
  @property() project = "";
  @state() private _bills: readonly BillEntry[] | null = null;
  @state() private _open: number | null = null;
  @state() private _problem = "";
  @state() private _imported: { name: string; remarks: readonly string[] } | null = null;
  @state() private _busy = false;
  @query("input[name=name]") private _name!: HTMLInputElement;
  private _key = newId();
  private readonly _files = new BillFiles(this);

  static override styles = [
    sharedStyles,
    rowListStyles,
    css`
      .content {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-4);
      }
      form {
        display: flex;
        flex-wrap: wrap;
        align-items: end;
        gap: var(--space-2);
      }
      form .field {
        flex: 1 1 12rem;
      }
      .import {
        display: grid;
        gap: var(--space-1);
      }
      .remarks {
        display: grid;
        gap: var(--space-1);
        padding: var(--space-2) var(--space-3);
        border-radius: var(--radius-small);
        background: var(--calm-soft);
        font-size: var(--text-small);
      }
      .remarks ul {
        margin: 0;
        padding-left: 1.2em;
        max-height: 9rem;
        overflow: auto;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.attempt(() => this.read());
  }

  private get path(): { project: string } {
    return { project: this.project };
  }

  private async read(): Promise<void> {
    const call = "GET /projects/{project}/bills";
    this._bills = await this.api.all(call, "bills", { path: this.path });
  }

  /** Resolves to whether the work succeeded. */
  private async attempt(work: () => Promise<void>): Promise<boolean> {
    if (this._busy) return false;
    this._busy = true;
    this._problem = "";
    try {
      await work();
      return true;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = error.status === 412 ? words.changed_by_other : error.message;
      return false;
    } finally {
      this._busy = false;
    }
  }

  override render(): TemplateResult {
    if (this._open !== null)
      return html`<strata-bill-dialog
        .api=${this.api}
        project=${this.project}
        .bill=${this._open}
        @closed=${() => {
          this._open = null;
          void this.attempt(() => this.read());
        }}
      ></strata-bill-dialog>`;
    return html`<strata-dialog
      broad
      heading=${words.title}
      way_out=${texts.close}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      <div class="content">
        <p class="hint">${words.lead}</p>
        ${this.list()} ${this._files.state()}
        <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
        ${this.remarks()}
        <form @submit=${this.onCreate}>
          <label class="field">
            <span>${words.new_name}</span>
            <input type="text" name="name" maxlength="200" autocomplete="off" placeholder=${words.name_hint} @input=${() => (this._key = newId())} />
          </label>
          <button ?disabled=${this._busy}>${icon("plus")}${words.create}</button>
        </form>
        <div class="import">
          <span class="caption">${words.import_label}</span>
          <strata-file-choice
          label=${words.import_label}
          accept=${kFiles}
          ?disabled=${this._busy}
          @files=${({ detail }: CustomEvent<File[]>) => detail[0] && void this.import(detail[0])}
        ></strata-file-choice>
        </div>
      </div>
    </strata-dialog>`;
  }

  private list(): TemplateResult {
    const { _bills: bills } = this;
    if (!bills)
      return html`<p class="hint" role="status" ?hidden=${this._problem !== ""}>${texts.loading}</p>`;
    if (bills.length === 0) return html`<p>${words.none}</p>`;
    return rowList(bills, (bill) => this.row(bill), { label: words.title });
  }

  private row(bill: BillEntry): ListedRow {
    return {
      label: bill.name,
      glyph: icon("document"),
      name: html`<button class="link" @click=${() => this.show(bill.id)}>${bill.name}</button>`,
      about: html`<span class="hint">${words.positions(bill.positions)}</span>`,
      tools: html`<strata-menu label=${words.options(bill.name)}>
        ${this._files.items((format) => void this._files.save(this.api, { ...this.path, bill: bill.id }, bill.name, format))}
        <hr />
        <button class="quiet" role="menuitem" @click=${() => void this.rename(bill)}>${icon("edit")}${words.rename}</button>
        <button class="quiet" role="menuitem" @click=${() => void this.delete(bill)}>${icon("trash")}${texts.layers.delete}</button>
      </strata-menu>`,
    };
  }

  private remarks(): TemplateResult | typeof nothing {
    const { _imported: imported } = this;
    if (!imported) return nothing;
    return html`<div class="remarks" role="status">
      <span>${words.imported(imported.name)}</span>
      ${
        imported.remarks.length > 0
          ? html`<span>${words.remarks}</span><ul>${imported.remarks.map((remark) => html`<li>${remark}</li>`)}</ul>`
          : nothing
      }
    </div>`;
  }

  private show(bill: number): void {
    this._problem = "";
    this._imported = null;
    this._open = bill;
  }

  private readonly onCreate = (event: Event): void => {
    event.preventDefault();
    const name = this._name.value.trim();
    if (name === "") {
      this._problem = words.name_empty;
      this._name.focus();
      return;
    }
    void this.attempt(async () => {
      const made = await this.api.json("POST /projects/{project}/bills", {
        path: this.path,
        body: { name },
        header: { "Idempotency-Key": this._key },
      });
      this._key = newId();
      this.show(made.id);
    });
  };

  private async import(file: File): Promise<void> {
    this._imported = null;
    await this.attempt(async () => {
      const { bill, remarks } = await this.api.json("POST /projects/{project}/bills/gaeb", {
        path: this.path,
        body: file,
        type: "application/octet-stream",
      });
      this._imported = { name: bill.name, remarks };
      await this.read();
    });
  }

  private async rename(bill: BillEntry): Promise<void> {
    const question = { heading: words.rename_title, label: words.name, text: bill.name };
    const name = await askText({ ...question, yes: texts.save });
    if (name === null || name === bill.name) return;
    await this.attempt(async () => {
      const path = { ...this.path, bill: bill.id };
      const read = await this.api.versioned("GET /projects/{project}/bills/{bill}", { path });
      const { currency, items } = read.value;
      await this.api.json("PUT /projects/{project}/bills/{bill}", {
        path,
        body: { name, currency, items },
        header: { "If-Match": read.etag },
      });
      await this.read();
    });
  }

  private async delete(bill: BillEntry): Promise<void> {
    const heading = words.delete_title(bill.name);
    const sure = { heading, lead: words.delete_lead, yes: texts.delete, danger: true };
    if (!(await ask(sure))) return;
    await this.attempt(async () => {
      const path = { ...this.path, bill: bill.id };
      await this.api.deleteAsRead("DELETE /projects/{project}/bills/{bill}", { path });
      await this.read();
    });
  }
}
