// <strata-tour-dialog>: makes a tour of the model's views, or changes one: its languages, its
// stops, what is said and shown at each. Nothing is sent before it is saved; what others save
// meanwhile is told, and nothing that was written here is lost by it.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError, new_id } from "../../net/api";
import { language_in_words } from "../../core/languages";
import { page_locale } from "../../core/locale";
import type { Tour, TourEntry } from "../../core/protocol.gen";
import {
  body_of,
  differs,
  draft_of,
  empty_tour,
  is_about,
  kSeconds,
  language_of_field,
  place_of,
  problem_of,
  without_language,
  writes_in,
  type DraftProblem,
  type StopDraft,
  type TourDraft,
} from "../../domain/tours";
import { ask } from "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import { follow_session } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { number_input } from "../../ui/number-input";
import { hold_page } from "../../ui/routes";
import { number_field_styles, shared_styles } from "../../ui/styles";
import { texts } from "../../texts";
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
  /** Null: a new one. */
  @property({ attribute: false }) tour: TourEntry | null = null;
  @state() private draft_: TourDraft | null = null; // null: it is being read
  @state() private chosen_: number | null = null; // id of a stop
  @state() private language_ = ""; // written beside the first
  @state() private trying_ = false;
  @state() private busy_ = false;
  @state() private problem_: { field: string; text: string } | null = null;
  @state() private theirs_: Tour | null = null; // what somebody else saved meanwhile
  @query("strata-dialog") private dialog_!: StrataDialog | null;
  @query("strata-tour-stop-fields") private fields_!: StrataTourStopFields | null;
  private base_: Tour | null = null; // as this person knows it; null: there is none yet
  private saved_: TourDraft = empty_tour(""); // what nothing is lost of
  private key_ = new_id();
  private asked_: Promise<boolean> | null = null; // whether it may be lost
  private let_go_ = (): void => {};

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    number_field_styles,
    css`
      .editor {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: 1.125rem;
      }
      .about {
        display: grid;
        grid-template-columns: minmax(0, 1fr) minmax(14.375rem, max-content);
        align-items: end;
        gap: 0.75rem 1rem;
      }
      .about textarea {
        min-height: 2.375rem;
      }
      .about .full,
      .about strata-tour-languages,
      .about .error {
        grid-column: 1 / -1;
      }
      .stops {
        display: grid;
        grid-template-columns: 16.875rem minmax(0, 1fr);
        gap: 1.25rem;
        padding-top: 0.875rem;
        border-top: var(--edge) solid var(--line);
      }
      strata-tour-stops {
        position: sticky; /* beside the fields of a stop, which are longer */
        top: 0;
        align-self: start;
        max-height: calc(100dvh - 11.875rem);
        margin: -5px;
        padding: 5px;
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
        gap: 0.75rem;
        min-width: 0;
      }
      .stop > .hint {
        padding: 1.5rem 0;
        text-align: center;
      }
      .told {
        flex: 1 1 100%;
        display: flex;
        flex-wrap: wrap;
        gap: 4px 0.875rem;
        padding: 0.625rem 0.875rem;
        border-radius: var(--radius-small);
        background: var(--warn-soft);
        color: var(--ink);
        font-size: 0.92rem;
      }
      @media (max-width: 760px) {
        .about,
        .stops {
          grid-template-columns: minmax(0, 1fr);
        }
        .stops > .stop.unchosen,
        .in-stop .about,
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
    addEventListener("beforeunload", this.on_unload);
    // a stop is tried on the page, whose links lead elsewhere
    this.let_go_ = hold_page(this.may_close);
    void this.read();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    removeEventListener("beforeunload", this.on_unload);
    this.let_go_();
  }

  private async read(): Promise<void> {
    this.problem_ = null;
    if (!this.tour) {
      this.take(empty_tour(page_locale().split("-")[0]!));
      return;
    }
    try {
      this.base_ = await this.session.tours.read(this.tour.id);
      this.take(draft_of(this.base_));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.problem_ = { field: "", text: error.message };
    }
  }

  private take(draft: TourDraft): void {
    this.draft_ = this.saved_ = draft;
    this.chosen_ = null;
    this.theirs_ = null;
    this.problem_ = null;
  }

  private get changed(): boolean {
    return this.draft_ !== null && differs(this.draft_, this.saved_);
  }

  private readonly on_unload = (event: Event): void => {
    if (this.changed) event.preventDefault();
  };

  private readonly may_close = async (): Promise<boolean> => {
    if (!this.changed) return true;
    this.asked_ ??= ask({
      heading: words.leave_title,
      lead: words.leave_lead,
      yes: words.leave_yes,
      danger: true,
    }).finally(() => (this.asked_ = null));
    return this.asked_; // once, whichever way somebody wants to leave by
  };

  // ── what is seen
  // ──────────────────────────────────────────────────────────────────────────────────────────────────

  override render(): TemplateResult {
    const { draft_: draft, problem_: problem } = this;
    if (draft && this.trying_) return this.trial(draft);
    return html`<strata-dialog
      vast
      heading=${this.tour ? words.edit_title(this.tour.name) : words.new_title}
      way_out=${draft ? texts.cancel : ""}
      .may_close=${this.may_close}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      ${draft ? this.content(draft) : html`<p class="hint" role="status" ?hidden=${problem !== null}>${texts.loading}</p>`}
      ${
        this.theirs_
          ? html`<div slot="told" class="told" role="alert">
            <span>${words.conflict}</span>
            <button class="link" @click=${() => void this.take_theirs()}>${words.take_theirs}</button>
          </div>`
          : nothing
      }
      ${problem && this.general(problem.field) ? html`<p slot="told" class="error told" role="alert">${problem.text}</p>` : nothing}
      ${
        draft
          ? html`<button slot="actions" class="primary" ?disabled=${this.busy_} @click=${() => void this.save()}>${texts.save}</button>`
          : nothing
      }
      ${!draft && problem ? html`<button slot="actions" @click=${() => void this.read()}>${texts.try_again}</button>` : nothing}
    </strata-dialog>`;
  }

  private content(draft: TourDraft): TemplateResult {
    const index = this.shown_index(draft);
    const stop = draft.stops[index];
    const place = place_of(this.problem_?.field ?? "");
    const refused = place.stop !== null && place.stop === index;
    return html`<div class="editor ${this.chosen_ === null ? "" : "in-stop"}">
      ${this.about(draft)}
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
            this.chosen_ = detail.chosen;
          }}
        ></strata-tour-stops>
        <div class="stop ${this.chosen_ === null ? "unchosen" : ""}">
          ${
            stop
              ? html`<button class="back" @click=${() => (this.chosen_ = null)}>${icon("back")}${words.all_stops}</button>
                <strata-tour-stop-fields
                  .session=${this.session}
                  .stop=${stop}
                  .languages=${draft.languages}
                  .language=${this.language_}
                  wrong=${refused ? place.within : ""}
                  problem=${refused ? (this.problem_?.text ?? "") : ""}
                  @language=${({ detail }: CustomEvent<string>) => (this.language_ = detail)}
                  @changed=${({ detail }: CustomEvent<StopDraft>) => this.put({ stops: draft.stops.map((each) => (each.id === detail.id ? detail : each)) })}
                  @try=${() => this.try_stop(index)}
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
        <span class="number">${number_input({ value: draft.idle_s, min, max, wrong: this.refusal("idle_s") !== "", typed: (idle_s) => this.put({ idle_s }) })}<span>s</span></span>
      </label>
      <label class="field full">
        <span>${words.text}</span>
        <textarea rows="1" maxlength="10000" aria-invalid=${wrong("text")} .value=${draft.text} @input=${(event: Event) => this.put({ text: (event.target as HTMLTextAreaElement).value })}></textarea>
      </label>
      <strata-tour-languages
        .languages=${draft.languages}
        @chosen=${({ detail }: CustomEvent<string[]>) => this.choose_languages(detail)}
        @remove=${({ detail }: CustomEvent<string>) => void this.remove_language(detail)}
      ></strata-tour-languages>
      ${["name", "idle_s", "text", "languages"].map((field) => (this.refusal(field) ? html`<p class="error" role="alert">${this.refusal(field)}</p>` : nothing))}
    </div>`;
  }

  private trial(draft: TourDraft): TemplateResult {
    const index = this.shown_index(draft);
    return html`<strata-tour-trial
      .stops=${draft.stops}
      index=${index}
      language=${draft.languages[0] ?? ""}
      @go=${({ detail }: CustomEvent<number>) => this.try_stop(detail)}
      @end=${() => (this.trying_ = false)}
    ></strata-tour-trial>`;
  }

  /** Of the stop that is looked at: wide windows always show one. */
  private shown_index({ stops }: TourDraft): number {
    return Math.max(
      0,
      stops.findIndex(({ id }) => id === this.chosen_),
    );
  }

  private refusal(field: string): string {
    return this.problem_ &&
      is_about(this.problem_.field, field) &&
      place_of(this.problem_.field).stop === null
      ? this.problem_.text
      : "";
  }
  /** What no field of the dialog shows. */
  private general(field: string): boolean {
    const { stop } = place_of(field);
    if (stop !== null) return this.draft_?.stops[stop] === undefined;
    return !["name", "idle_s", "text", "languages", "stops"].some((each) => is_about(field, each));
  }

  // ── what is changed
  // ───────────────────────────────────────────────────────────────────────────────────────────────

  private put(change: Partial<TourDraft>): void {
    if (!this.draft_) return;
    this.draft_ = { ...this.draft_, ...change };
    this.problem_ = null;
    this.key_ = new_id();
  }

  private choose_languages(languages: readonly string[]): void {
    const added = languages.find((each) => !this.draft_?.languages.includes(each));
    if (added !== undefined) this.language_ = added;
    this.put({ languages });
  }

  private async remove_language(language: string): Promise<void> {
    if (!this.draft_) return;
    const name = language_in_words(language);
    const question = {
      heading: words.language_remove_title(name),
      lead: words.language_remove_lead,
      yes: words.language_remove_yes,
      danger: true,
    };
    if (writes_in(this.draft_, language) && !(await ask(question))) return;
    this.put(without_language(this.draft_, language));
  }

  private try_stop(index: number): void {
    const stop = this.draft_?.stops[index];
    const view = this.session.views.all.find(({ slug }) => slug === stop?.view);
    if (!stop) return;
    this.chosen_ = stop.id;
    this.trying_ = true;
    this.dispatchEvent(new CustomEvent("try"));
    if (view) this.session.views.go_to(view);
  }

  private async take_theirs(): Promise<void> {
    const theirs = this.theirs_;
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
    this.take(draft_of(theirs));
  }

  // ── saving
  // ────────────────────────────────────────────────────────────────────────────────────────────────────────

  private async save(): Promise<void> {
    const { draft_: draft } = this;
    if (!draft || this.busy_) return;
    const problem = problem_of(draft);
    if (problem) return this.refuse(problem.field, told(problem));
    this.busy_ = true;
    try {
      const body = body_of(draft);
      const { tours } = this.session;
      this.base_ = await (this.base_
        ? tours.change(this.base_, body)
        : tours.make(body, this.key_));
      this.saved_ = draft;
      notices.show("success", words.saved(body.name));
      this.dialog_?.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      await this.refused(error);
    } finally {
      this.busy_ = false;
    }
  }

  private async refused(error: ApiError): Promise<void> {
    if (this.base_ && (error.status === 412 || error.status === 404)) {
      try {
        this.base_ = this.theirs_ = await this.session.tours.read(this.base_.id);
        return;
      } catch (again) {
        if (!(again instanceof ApiError)) throw again;
        if (again.status !== 404) return this.refuse("", again.message);
        this.base_ = null; // the next attempt makes it anew
        this.theirs_ = null;
        this.key_ = new_id();
        return this.refuse("", words.gone);
      }
    }
    this.refuse(error.problem.field ?? "", error.message);
  }

  /** At the field that is meant, which is brought into sight. */
  private refuse(field: string, text: string): void {
    this.problem_ = { field, text };
    const place = place_of(field);
    const stop = place.stop === null ? undefined : this.draft_?.stops[place.stop];
    if (stop) {
      this.chosen_ = stop.id;
      this.language_ = language_of_field(place.within) ?? this.language_;
    } else {
      this.chosen_ = null;
    }
    void this.updateComplete.then(() => {
      if (stop) void this.fields_?.focus_wrong();
      else this.renderRoot.querySelector<HTMLElement>('.about [aria-invalid="true"]')?.focus();
    });
  }
}

const told = ({ wrong, range }: DraftProblem): string =>
  wrong === "seconds" ? words.wrong_seconds(...(range ?? [0, 0])) : words.wrong[wrong];
