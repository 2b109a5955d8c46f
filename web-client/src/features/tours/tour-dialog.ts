// <strata-tour-dialog>: creates a tour of the model's views, or changes one: its languages and
// stops, with their texts and contents. The dialog sends nothing before the user saves. If other
// users save the tour in the meantime, it shows a message and keeps all input.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { newId } from "../../core/ids";
import { languageInWords } from "../../core/languages";
import { pageLocale } from "../../core/locale";
import type { Tour, TourClasses, TourEntry, TourFile, TourTheme } from "../../core/protocol.gen";
import {
  bodyOf,
  differs,
  draftOf,
  emptyTour,
  isAbout,
  kSeconds,
  languageOfField,
  placeOf,
  problemOf,
  withoutLanguage,
  writesIn,
  type DraftProblem,
  type StopDraft,
  type TourDraft,
} from "../../domain/tours";
import { ask } from "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { numberInput } from "../../ui/number-input";
import { holdPage } from "../../ui/routes";
import { numberFieldStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "./tour-design";
import "./tour-languages";
import "./tour-stop-fields";
import type { StrataTourStopFields } from "./tour-stop-fields";
import "./tour-stops";
import type { StopsChange } from "./tour-stops";
import "./tour-trial";

const words = texts.tours;

@customElement("strata-tour-dialog")
export class StrataTourDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** Null for a new tour. */
  @property({ attribute: false }) tour: TourEntry | null = null;
  @state() private _draft: TourDraft | null = null; // null while the tour is loading
  @state() private _chosen: number | null = null; // the id of the selected stop
  @state() private _language = ""; // the language that is edited next to the first one
  @state() private _trying = false;
  @state() private _busy = false;
  @state() private _problem: { field: string; text: string } | null = null;
  // the version that another user has saved in the meantime
  @state() private _theirs: Tour | null = null;
  @query("strata-dialog") private _dialog!: StrataDialog | null;
  @query("strata-tour-stop-fields") private _fields!: StrataTourStopFields | null;
  // the version that this user has seen; null before the tour is created
  private _base: Tour | null = null;
  private _saved: TourDraft = emptyTour(""); // a draft equal to this one can be discarded
  private _key = newId();
  private _asked: Promise<boolean> | null = null; // the open question whether to discard the draft
  private _letGo = (): void => {};

  constructor() {
    super();
    followSession(this, "tours", "views");
  }

  static override styles = [
    sharedStyles,
    numberFieldStyles,
    css`
      .editor {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-4);
      }
      .about {
        display: grid;
        grid-template-columns: minmax(0, 1fr) minmax(14.375rem, max-content);
        align-items: end;
        gap: var(--space-3) var(--space-4);
      }
      .about textarea {
        min-height: var(--control);
      }
      .about .full,
      .about strata-tour-languages,
      .about .error {
        grid-column: 1 / -1;
      }
      .stops {
        display: grid;
        grid-template-columns: 16.875rem minmax(0, 1fr);
        gap: var(--space-5);
        padding-top: var(--space-3);
        border-top: var(--edge) solid var(--line);
      }
      strata-tour-stops {
        position: sticky; /* stays visible next to the fields of a stop, which are longer */
        top: 0;
        align-self: start;
        max-height: calc(100dvh - 11.875rem);
        margin: calc(-1 * var(--space-1));
        padding: var(--space-1);
        overflow: auto;
      }
      .back {
        display: none;
        justify-self: start;
      }
      .stop {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        align-content: start;
        gap: var(--space-3);
        min-width: 0;
      }
      .stop > .hint {
        padding: var(--space-6) 0;
        text-align: center;
      }
      .told {
        flex: 1 1 100%;
        display: flex;
        flex-wrap: wrap;
        gap: var(--space-1) var(--space-3);
        padding: var(--space-2) var(--space-3);
        border-radius: var(--radius-small);
        background: var(--warn-soft);
        color: var(--ink);
        font-size: var(--text-small);
      }
      @media (max-width: 760px) {
        .about,
        .stops {
          grid-template-columns: minmax(0, 1fr);
        }
        .stops > .stop.unchosen,
        .in-stop .about,
        .in-stop .design,
        .in-stop strata-tour-stops {
          display: none;
        }
        strata-tour-stops {
          position: static;
          max-height: none;
          overflow: visible;
        }
        .in-stop .stops {
          padding-top: 0;
          border-top: 0;
        }
        .back {
          display: inline-flex;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    addEventListener("beforeunload", this.onUnload);
    // The preview of a stop is on the page, and links on the page leave the editor.
    this._letGo = holdPage(this.mayClose);
    void this.read();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    removeEventListener("beforeunload", this.onUnload);
    this._letGo();
  }

  private async read(): Promise<void> {
    this._problem = null;
    if (!this.tour) {
      this.take(emptyTour(pageLocale().split("-")[0]!));
      return;
    }
    try {
      this._base = await this.session.tours.read(this.tour.id);
      this.take(draftOf(this._base));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = { field: "", text: error.message };
    }
  }

  private take(draft: TourDraft): void {
    this._draft = this._saved = draft;
    this._chosen = null;
    this._theirs = null;
    this._problem = null;
  }

  private get changed(): boolean {
    return this._draft !== null && differs(this._draft, this._saved);
  }

  private readonly onUnload = (event: Event): void => {
    if (this.changed) event.preventDefault();
  };

  private readonly mayClose = async (): Promise<boolean> => {
    if (!this.changed) return true;
    this._asked ??= ask({
      heading: words.leave_title,
      lead: words.leave_lead,
      yes: words.leave_yes,
      danger: true,
    }).finally(() => (this._asked = null));
    return this._asked; // all attempts to leave wait for the answer to the same question
  };

  // ── rendering ──────────────────────────────────────────────────────────────────────────────────

  override render(): TemplateResult {
    const { _draft: draft, _problem: problem } = this;
    if (draft && this._trying) return this.trial(draft);
    return html`<strata-dialog
      vast
      heading=${this.tour ? words.edit_title(this.tour.name) : words.new_title}
      way_out=${draft ? texts.cancel : ""}
      .mayClose=${this.mayClose}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      ${draft ? this.content(draft) : html`<p class="hint" role="status" ?hidden=${problem !== null}>${texts.loading}</p>`}
      ${
        this._theirs
          ? html`<div slot="told" class="told" role="alert">
            <span>${words.conflict}</span>
            <button class="link" @click=${() => void this.takeTheirs()}>${words.take_theirs}</button>
          </div>`
          : nothing
      }
      ${problem && this.general(problem.field) ? html`<p slot="told" class="error told" role="alert">${problem.text}</p>` : nothing}
      ${
        draft
          ? html`<button slot="actions" class="primary" ?disabled=${this._busy} @click=${() => void this.save()}>${texts.save}</button>`
          : nothing
      }
      ${!draft && problem ? html`<button slot="actions" @click=${() => void this.read()}>${texts.try_again}</button>` : nothing}
    </strata-dialog>`;
  }

  private content(draft: TourDraft): TemplateResult {
    const index = this.shownIndex(draft);
    const stop = draft.stops[index];
    const place = placeOf(this._problem?.field ?? "");
    const refused = place.stop !== null && place.stop === index;
    const tour = this._base?.id ?? null; // null means that the tour cannot have files yet
    return html`<div class="editor ${this._chosen === null ? "" : "in-stop"}" @file=${({ detail }: CustomEvent<TourFile>) => this.put({ files: [...this._draft!.files, detail] })}>
      ${this.about(draft)}
      <strata-tour-design
        class="design"
        .session=${this.session}
        .tour=${tour}
        .theme=${draft.theme}
        .files=${draft.files}
        heading=${draft.stops[0]?.title[draft.languages[0] ?? ""] ?? draft.name}
        problem=${this.refusal("theme")}
        @changed=${({ detail }: CustomEvent<TourTheme>) => this.put({ theme: detail })}
      ></strata-tour-design>
      <div class="stops">
        <strata-tour-stops
          .session=${this.session}
          .stops=${draft.stops}
          .languages=${draft.languages}
          .chosen=${stop?.id ?? null}
          .wrong=${place.stop}
          problem=${this.refusal("stops")}
          @changed=${({ detail }: CustomEvent<StopsChange>) => {
            this.put({ stops: detail.stops });
            this._chosen = detail.chosen;
          }}
        ></strata-tour-stops>
        <div class="stop ${this._chosen === null ? "unchosen" : ""}">
          ${
            stop
              ? html`<button class="back" @click=${() => (this._chosen = null)}>${icon("back")}${words.all_stops}</button>
                <strata-tour-stop-fields
                  .session=${this.session}
                  .stop=${stop}
                  .tour=${tour}
                  .files=${draft.files}
                  .classes=${draft.classes}
                  @classes=${({ detail }: CustomEvent<TourClasses[]>) => this.put({ classes: detail })}
                  .languages=${draft.languages}
                  .language=${this._language}
                  wrong=${refused ? place.within : ""}
                  problem=${refused ? (this._problem?.text ?? "") : ""}
                  @language=${({ detail }: CustomEvent<string>) => (this._language = detail)}
                  @changed=${({ detail }: CustomEvent<StopDraft>) => this.put({ stops: this._draft!.stops.map((each) => (each.id === detail.id ? detail : each)) })}
                  @try=${() => this.tryStop(index)}
                ></strata-tour-stop-fields>`
              : html`<p class="hint">${words.stops_lead}</p>`
          }
        </div>
      </div>
    </div>`;
  }

  private about(draft: TourDraft): TemplateResult {
    const [min, max] = kSeconds.idle;
    const wrong = (field: string): "true" | "false" => (this.refusal(field) ? "true" : "false");
    return html`<div class="about">
      <label class="field">
        <span>${words.name}</span>
        <input
          type="text"
          maxlength="200"
          autocomplete="off"
          ?autofocus=${this.tour === null}
          placeholder=${this.tour ? "" : words.name_hint}
          aria-invalid=${wrong("name")}
          .value=${draft.name}
          @input=${(event: Event) => this.put({ name: (event.target as HTMLInputElement).value })}
        />
      </label>
      <label class="field" title=${words.idle_hint}>
        <span>${words.idle}</span>
        <span class="number">${numberInput({ value: draft.idle_s, min, max, wrong: this.refusal("idle_s") !== "", typed: (idleS) => this.put({ idle_s: idleS }) })}<span>s</span></span>
      </label>
      <label class="field full">
        <span>${words.text}</span>
        <textarea rows="1" maxlength="10000" aria-invalid=${wrong("text")} .value=${draft.text} @input=${(event: Event) => this.put({ text: (event.target as HTMLTextAreaElement).value })}></textarea>
      </label>
      <strata-tour-languages
        .languages=${draft.languages}
        @chosen=${({ detail }: CustomEvent<string[]>) => this.chooseLanguages(detail)}
        @remove=${({ detail }: CustomEvent<string>) => void this.removeLanguage(detail)}
      ></strata-tour-languages>
      ${["name", "idle_s", "text", "languages"].map((field) => (this.refusal(field) ? html`<p class="error" role="alert">${this.refusal(field)}</p>` : nothing))}
    </div>`;
  }

  private trial(draft: TourDraft): TemplateResult {
    const index = this.shownIndex(draft);
    return html`<strata-tour-trial
      .stops=${draft.stops}
      index=${index}
      language=${draft.languages[0] ?? ""}
      @go=${({ detail }: CustomEvent<number>) => this.tryStop(detail)}
      @end=${() => (this._trying = false)}
    ></strata-tour-trial>`;
  }

  /** Returns the index of the selected stop. Wide windows always show a stop. */
  private shownIndex({ stops }: TourDraft): number {
    return Math.max(
      0,
      stops.findIndex(({ id }) => id === this._chosen),
    );
  }

  private refusal(field: string): string {
    return this._problem &&
      isAbout(this._problem.field, field) &&
      placeOf(this._problem.field).stop === null
      ? this._problem.text
      : "";
  }
  /** Returns whether the problem belongs to no field of the dialog. */
  private general(field: string): boolean {
    const { stop } = placeOf(field);
    if (stop !== null) return this._draft?.stops[stop] === undefined;
    return !["name", "idle_s", "text", "languages", "stops", "theme"].some((each) =>
      isAbout(field, each),
    );
  }

  // ── changes ────────────────────────────────────────────────────────────────────────────────────

  private put(change: Partial<TourDraft>): void {
    if (!this._draft) return;
    this._draft = { ...this._draft, ...change };
    this._problem = null;
    this._key = newId();
  }

  private chooseLanguages(languages: readonly string[]): void {
    const added = languages.find((each) => !this._draft?.languages.includes(each));
    if (added !== undefined) this._language = added;
    this.put({ languages });
  }

  private async removeLanguage(language: string): Promise<void> {
    if (!this._draft) return;
    const name = languageInWords(language);
    const question = {
      heading: words.language_remove_title(name),
      lead: words.language_remove_lead,
      yes: words.language_remove_yes,
      danger: true,
    };
    if (writesIn(this._draft, language) && !(await ask(question))) return;
    this.put(withoutLanguage(this._draft, language));
  }

  private tryStop(index: number): void {
    const stop = this._draft?.stops[index];
    const view = this.session.views.all.find(({ slug }) => slug === stop?.view);
    if (!stop) return;
    this._chosen = stop.id;
    this._trying = true;
    this.dispatchEvent(new CustomEvent("try"));
    if (view) this.session.views.goTo(view);
  }

  private async takeTheirs(): Promise<void> {
    const theirs = this._theirs;
    if (
      !theirs ||
      !(await ask({
        heading: words.theirs_title,
        lead: words.leave_lead,
        yes: words.take_theirs,
        danger: true,
      }))
    )
      return;
    this.take(draftOf(theirs));
  }

  // ── saving ─────────────────────────────────────────────────────────────────────────────────────

  private async save(): Promise<void> {
    const { _draft: draft } = this;
    if (!draft || this._busy) return;
    const problem = problemOf(draft);
    if (problem) return this.refuse(problem.field, told(problem));
    this._busy = true;
    try {
      const body = bodyOf(draft);
      const { tours } = this.session;
      this._base = await (this._base
        ? tours.change(this._base, body)
        : tours.make(body, this._key));
      this._saved = draft;
      notices.show("success", words.saved(body.name));
      this._dialog?.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      await this.refused(error);
    } finally {
      this._busy = false;
    }
  }

  private async refused(error: ApiError): Promise<void> {
    if (this._base && (error.status === 412 || error.status === 404)) {
      try {
        this._base = this._theirs = await this.session.tours.read(this._base.id);
        return;
      } catch (again) {
        if (!(again instanceof ApiError)) throw again;
        if (again.status !== 404) return this.refuse("", again.message);
        this._base = null; // the next attempt to save creates the tour again
        this._theirs = null;
        this._key = newId();
        return this.refuse("", words.gone);
      }
    }
    this.refuse(error.problem.field ?? "", error.message);
  }

  /** Shows the problem at its field, and scrolls to it. */
  private refuse(field: string, text: string): void {
    this._problem = { field, text };
    const place = placeOf(field);
    const stop = place.stop === null ? undefined : this._draft?.stops[place.stop];
    if (stop) {
      this._chosen = stop.id;
      this._language = languageOfField(place.within) ?? this._language;
    } else {
      this._chosen = null;
    }
    void this.updateComplete.then(() => {
      if (stop) void this._fields?.focusWrong();
      else this.renderRoot.querySelector<HTMLElement>('.about [aria-invalid="true"]')?.focus();
    });
  }
}

const told = ({ wrong, range }: DraftProblem): string =>
  wrong === "seconds"
    ? words.wrong_seconds(...(range ?? [0, 0]))
    : wrong === "contrast"
      ? "" // <strata-tour-design> shows this problem with the contrast values
      : words.wrong[wrong];
