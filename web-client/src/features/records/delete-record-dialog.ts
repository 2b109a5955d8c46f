// <strata-delete-record-dialog>: deletes a record. If its key is painted, the dialog asks for the
// new content of the texels with this key.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { kAsItIs } from "../../net/api";
import { tellTrashed } from "../../ui/trash";
import "../../ui/dialog";
import type { ModelSession } from "../../session/model-session";
import { radioGroup } from "../../ui/radio-group";
import "../../session/fields/record-chooser";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.tables;

@customElement("strata-delete-record-dialog")
export class StrataDeleteRecordDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The table's id. */
  @property({ attribute: false }) table = 0;
  @property({ attribute: false }) key = 0;
  @state() private _painted = ""; // the models and layers where the key is painted
  @state() private _what: "clear" | "reassign" = "clear";
  @state() private _to: readonly number[] = [];
  @state() private _problem = "";
  @state() private _busy = false;

  static override styles = [
    sharedStyles,
    css`
      .segments {
        display: flex;
      }
    `,
  ];

  override render(): TemplateResult {
    const name = this.session.tables.label(this.table, this.key) ?? words.record(this.key);
    return html`<strata-dialog heading=${words.delete_title(name)} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <p>${this._painted || words.delete_lead}</p>
      ${this._painted ? this.choice() : nothing}
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      <button
        slot="actions"
        class="danger"
        ?disabled=${this._busy || (this._painted !== "" && this._what === "reassign" && this._to.length === 0)}
        @click=${() => void this.deleteRecord()}
      >
        ${texts.delete}
      </button>
    </strata-dialog>`;
  }

  private choice(): TemplateResult {
    return html`${radioGroup({
      label: words.texels,
      class: "segments",
      choices: [
        { value: "clear" as const, content: words.texels_clear },
        { value: "reassign" as const, content: words.texels_reassign },
      ],
      chosen: this._what,
      choose: (what) => (this._what = what),
    })}
    ${
      this._what === "reassign"
        ? html`<strata-record-chooser
          .session=${this.session}
          .table=${this.table}
          .chosen=${this._to}
          .without=${this.key}
          label=${words.texels_to}
          @chosen=${(event: CustomEvent<number[]>) => (this._to = event.detail)}
        ></strata-record-chooser>`
        : nothing
    }`;
  }

  /** The choice for texels with the record's key. */
  private get texels(): { texels: "refuse" | "clear" | "reassign"; to?: number } {
    if (this._painted === "") return { texels: "refuse" };
    return this._what === "clear" ? { texels: "clear" } : { texels: "reassign", to: this._to[0]! };
  }

  private async deleteRecord(): Promise<void> {
    const { api, model, tables } = this.session;
    const name = tables.label(this.table, this.key) ?? words.record(this.key);
    const gone = {
      kind: "record",
      entry: `record-${this.table}-${this.key}`,
      name,
      project: model?.project ?? "",
    } as const;
    this._busy = true;
    this._problem = "";
    try {
      await api.send("DELETE /tables/{table}/records/{key}", {
        path: { table: this.table, key: this.key },
        query: this.texels,
        header: kAsItIs,
      });
      this.session.tables.view?.forget(this.key);
      tellTrashed(api, gone);
      this.dispatchEvent(new CustomEvent("closed"));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 409 && error.problem.field === "texels")
        this._painted = words.painted(whereOf(error.message));
      else this._problem = error.message;
    } finally {
      this._busy = false;
    }
  }
}

/** The server's first sentence names the painted layers. The second is advice for scripts. */
const whereOf = (detail: string): string => detail.split(/(?<=\.)\s+(?=[A-Z])/)[0] ?? detail;
