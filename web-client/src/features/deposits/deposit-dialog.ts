// <strata-deposit-dialog>: describes the project of the model for a repository, and makes the file
// for the repository.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import type { DepositRecord } from "../../core/protocol.gen";
import type { ProblemBody } from "../../core/types";
import {
  draftOf,
  fieldOf,
  kNewCreator,
  kUsualLicenses,
  recordOf,
  type DepositDraft,
  type DraftCreator,
} from "../../domain/deposits";
import { ApiError } from "../../net/api-error";
import { AwaitedFile, awaitedFileStyles } from "../../session/awaited-file";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import "../../ui/dialog";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.deposit;
/** The fields with one line, except the creators. */
const kRequired = ["title", "publisher", "year", "license"] as const;
const kOptional = ["language", "version", "doi"] as const;
type Line = (typeof kRequired)[number] | (typeof kOptional)[number];

@customElement("strata-deposit-dialog")
export class StrataDepositDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _draft: DepositDraft | null = null;
  @state() private _problem = "";
  @state() private _wrong = ""; // the name of a field
  @state() private _saved = false;
  private _record: DepositRecord = {};
  private _etag = "";
  private readonly _file = new AwaitedFile(this, (problem) => this.refuse(problem));

  constructor() {
    super();
    followSession(this, "jobs");
  }

  static override styles = [
    sharedStyles,
    awaitedFileStyles,
    css`
      form {
        display: grid;
        gap: var(--space-4);
      }
      .creators {
        display: grid;
        gap: var(--space-2);
      }
      .creator {
        display: grid;
        grid-template-columns: minmax(0, 1fr) minmax(0, 1fr) auto;
        gap: var(--space-2);
        align-items: end;
      }
      button.link {
        justify-self: start;
      }
      @media (max-width: 560px) {
        .creator {
          grid-template-columns: minmax(0, 1fr) auto;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.load();
  }

  private get path(): { project: string } {
    return { project: this.session.model!.project };
  }

  private async load(): Promise<void> {
    try {
      const { value, etag } = await this.session.api.versioned("GET /projects/{project}/metadata", {
        path: this.path,
      });
      this.take(value.record, etag);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refuse(error.problem);
    }
  }

  private take(record: DepositRecord, etag: string): void {
    this._record = record;
    this._etag = etag;
    this._draft = draftOf(record);
  }

  override render(): TemplateResult {
    const draft = this._draft;
    return html`<strata-dialog
      wide
      heading=${words.title}
      way_out=${this._file.running ? "" : texts.close}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      <form id="deposit" novalidate @submit=${this.onSubmit}>
        <p>${words.lead}</p>
        ${draft ? this.fields(draft) : nothing}
      </form>
      ${this._file.footer({
        form: "deposit",
        make: words.make,
        making: words.making,
        cancel: words.cancel,
        actions: html`<button slot="actions" type="button" ?disabled=${!draft} @click=${() => void this.save()}>
          ${texts.save}
        </button>`,
        status: this._saved ? html`${words.saved}` : null,
        saved: ({ name }) => words.made(name),
        problem: this._problem,
      })}
    </strata-dialog>`;
  }

  private fields(draft: DepositDraft): TemplateResult {
    const change = (event: Event): void =>
      this.change({ description: (event.target as HTMLTextAreaElement).value });
    return html`${this.line("title", draft)} ${this.creators(draft)}
      ${kRequired.slice(1).map((name) => this.line(name, draft))}
      <datalist id="licenses">${kUsualLicenses.map((license) => html`<option value=${license}></option>`)}</datalist>
      <label class="field">
        <span>${words.fields.description}</span>
        <textarea name="description" rows="4" .value=${draft.description} @input=${change}></textarea>
      </label>
      ${kOptional.map((name) => this.line(name, draft))}`;
  }

  private line(name: Line, draft: DepositDraft): TemplateResult {
    const required = (kRequired as readonly string[]).includes(name);
    const isWrong = this._wrong === name;
    const change = (event: Event): void =>
      this.change({ [name]: (event.target as HTMLInputElement).value });
    return html`<div>
      <label class="field">
        <span>${words.fields[name]}${required ? words.required : ""}</span>
        <input
          type="text"
          name=${name}
          list=${name === "license" ? "licenses" : nothing}
          inputmode=${name === "year" ? "numeric" : nothing}
          aria-required=${required}
          aria-invalid=${isWrong}
          aria-describedby="${name}_hint"
          .value=${draft[name]}
          @input=${change}
        />
      </label>
      <p class="hint" id="${name}_hint">${words.hints[name]}</p>
    </div>`;
  }

  private creators(draft: DepositDraft): TemplateResult {
    const set = (index: number, part: Partial<DraftCreator>): void =>
      this.change({
        creators: draft.creators.map((each, i) => (i === index ? { ...each, ...part } : each)),
      });
    const field = (
      index: number,
      part: "name" | "orcid",
      creator: DraftCreator,
    ): TemplateResult => {
      const name = `creator_${part}_${index}`;
      const change = (event: Event): void =>
        set(index, { [part]: (event.target as HTMLInputElement).value });
      return html`<label class="field">
        <span>${part === "name" ? words.creator_name(index + 1) : words.orcid(index + 1)}</span>
        <input type="text" name=${name} aria-invalid=${this._wrong === name} aria-describedby="creators_hint" .value=${creator[part]} @input=${change} />
      </label>`;
    };
    return html`<div class="creators" role="group" aria-label=${words.creators}>
      ${draft.creators.map(
        (creator, i) =>
          html`<div class="creator">
            ${field(i, "name", creator)} ${field(i, "orcid", creator)}
            <button
              type="button"
              aria-label=${words.remove_creator(i + 1)}
              ?disabled=${draft.creators.length === 1}
              @click=${() => this.change({ creators: draft.creators.filter((_, k) => k !== i) })}
            >
              ${words.remove}
            </button>
          </div>`,
      )}
      <p class="hint" id="creators_hint">${words.creators_hint}</p>
      <button type="button" class="link" @click=${() => this.change({ creators: [...draft.creators, kNewCreator] })}>
        ${words.add_creator}
      </button>
    </div>`;
  }

  private change(part: Partial<DepositDraft>): void {
    if (!this._draft) return;
    this._draft = { ...this._draft, ...part };
    this._problem = this._wrong = "";
    this._saved = false;
  }

  private readonly onSubmit = (event: Event): void => {
    event.preventDefault();
    if (this._file.isFree) void this.make();
  };

  private async make(): Promise<void> {
    const missing = await this.save();
    if (missing === null) return;
    if (missing.length > 0) {
      this.refuse({ detail: words.incomplete, field: missing[0]! });
      return;
    }
    this._saved = false; // the footer then only reports the file
    await this._file.make(
      () =>
        this.session.files.start(words.job, words.ready, () =>
          this.session.api.json("POST /projects/{project}/deposits", { path: this.path }),
        ),
      () => this.isConnected,
    );
  }

  /** Returns what a DOI still needs, or null if the server refused the record. */
  private async save(): Promise<readonly string[] | null> {
    if (!this._draft) return null;
    try {
      const { value, etag } = await this.session.api.versioned("PUT /projects/{project}/metadata", {
        path: this.path,
        body: recordOf(this._draft, this._record),
        header: { "If-Match": this._etag },
      });
      this.take(value.record, etag);
      this._saved = true;
      return value.missing;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refuse(error.problem);
      return null;
    }
  }

  private refuse(problem: Pick<ProblemBody, "detail" | "field">): void {
    this._problem = problem.detail ?? "";
    this._saved = false;
    this._wrong = problem.field ? fieldOf(problem.field) : "";
    if (this._wrong)
      void this.updateComplete.then(() =>
        this.renderRoot.querySelector<HTMLElement>(`[name="${this._wrong}"]`)?.focus(),
      );
  }
}
