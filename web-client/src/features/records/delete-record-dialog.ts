// <strata-delete-record-dialog>: deletes a record; where its key is painted, asks what becomes of
// that.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError, type TexelsOfDeleted } from "../../net/api";
import { tell_binned } from "../../ui/trash";
import "../../ui/dialog";
import type { ModelSession } from "../../session/model-session";
import { radio_group } from "../../ui/radio-group";
import "../../session/fields/record-chooser";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.tables;

@customElement("strata-delete-record-dialog")
export class StrataDeleteRecordDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** Id. */
  @property({ attribute: false }) table = 0;
  @property({ attribute: false }) key = 0;
  @state() private painted_ = ""; // where, once it is known that it is
  @state() private what_: "clear" | "reassign" = "clear";
  @state() private to_: readonly number[] = [];
  @state() private problem_ = "";
  @state() private busy_ = false;

  static override styles = [
    shared_styles,
    css`
      .segments {
        display: flex;
      }
    `,
  ];

  override render(): TemplateResult {
    const name = this.session.tables.label(this.table, this.key) ?? words.record(this.key);
    return html`<strata-dialog heading=${words.delete_title(name)} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <p>${this.painted_ || words.delete_lead}</p>
      ${this.painted_ ? this.choice() : nothing}
      <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      <button
        slot="actions"
        class="danger"
        ?disabled=${this.busy_ || (this.painted_ !== "" && this.what_ === "reassign" && this.to_.length === 0)}
        @click=${() => void this.delete_record()}
      >
        ${texts.delete}
      </button>
    </strata-dialog>`;
  }

  private choice(): TemplateResult {
    return html`${radio_group({
      label: words.texels,
      class: "segments",
      choices: [
        { value: "clear" as const, content: words.texels_clear },
        { value: "reassign" as const, content: words.texels_reassign },
      ],
      chosen: this.what_,
      choose: (what) => (this.what_ = what),
    })}
    ${
      this.what_ === "reassign"
        ? html`<strata-record-chooser
          .session=${this.session}
          .table=${this.table}
          .chosen=${this.to_}
          .without=${this.key}
          label=${words.texels_to}
          @chosen=${(event: CustomEvent<number[]>) => (this.to_ = event.detail)}
        ></strata-record-chooser>`
        : nothing
    }`;
  }

  private get texels(): TexelsOfDeleted {
    if (this.painted_ === "") return { what: "refuse" };
    return this.what_ === "clear" ? { what: "clear" } : { what: "reassign", to: this.to_[0]! };
  }

  private async delete_record(): Promise<void> {
    const { api, model, tables } = this.session;
    const name = tables.label(this.table, this.key) ?? words.record(this.key);
    const gone = {
      kind: "record",
      entry: `record-${this.table}-${this.key}`,
      name,
      project: model?.project ?? "",
    } as const;
    this.busy_ = true;
    this.problem_ = "";
    try {
      await api.delete_record(this.table, this.key, this.texels);
      this.session.tables.view?.forget(this.key);
      tell_binned(api, gone);
      this.dispatchEvent(new CustomEvent("closed"));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 409 && error.problem.field === "texels")
        this.painted_ = words.painted(where_of(error.message));
      else this.problem_ = error.message;
    } finally {
      this.busy_ = false;
    }
  }
}

/** The server's first sentence says where; the second what a script would send. */
const where_of = (detail: string): string => detail.split(/(?<=\.)\s+(?=[A-Z])/)[0] ?? detail;
