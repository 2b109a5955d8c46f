// <strata-comment-card>: a thread or a new thread, in a card next to its pin. On a phone it is a
// sheet at the bottom.

import { html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { labelOf } from "../../domain/cells";
import { ApiError } from "../../net/api-error";
import { beside } from "../../ui/beside";
import { commentsIn, type Thread } from "../../domain/comments";
import { called } from "../../domain/people";
import type { Comment } from "../../core/protocol.gen";
import { commentCardStyles } from "./comment-card-styles";
import { commentText, commentTextStyles } from "./comment-text";
import type { DraftOf } from "./comments";
import { ask } from "../../ui/dialog";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import { hasKeyboard } from "../../ui/keyboard";
import type { ModelSession } from "../../session/model-session";
import { NameCompletion, nameCompletionStyles } from "./name-completion";
import { personMark, personMarkStyles } from "../../ui/person-mark";
import { hashOfComment } from "../../ui/routes";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { toldTime } from "../../domain/times";

const words = texts.comments;
const kGapPx = 20;
const kMostCharacters = 10_000; // the server's limit on the characters of a comment
const kNarrow = "(max-width: 820px)";

@customElement("strata-comment-card")
export class StrataCommentCard extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _problem: { of: DraftOf | "thread"; text: string } | null = null;
  @state() private _busy = false;
  @state() private _editing: number | null = null;
  @query("section") private _section!: HTMLElement | null;
  private _shown: number | "new" | null = null;
  private _opener: HTMLElement | null = null; // the focused element before the card opened
  private readonly _names = new NameCompletion(this, () => this.session.comments.loadPeople());

  constructor() {
    super();
    followSession(this, "comments", "view", "layers", "tables", "together");
  }

  static override styles = [
    sharedStyles,
    personMarkStyles,
    commentTextStyles,
    nameCompletionStyles,
    commentCardStyles,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this._opener = hasKeyboard();
  }

  /** Returns the keyboard focus to the element that opened the card. */
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    if (hasKeyboard() === null && this._opener?.isConnected)
      this._opener.focus({ preventScroll: true });
  }

  override willUpdate(changed: PropertyValues<this>): void {
    super.willUpdate(changed);
    const { card } = this.session.comments;
    if (card === this._shown) return;
    const now = hasKeyboard();
    if (this._shown !== null && now && !this.containsDeep(now)) this._opener = now;
    this._problem = null;
    this._editing = null;
  }

  override render(): TemplateResult {
    const { comments } = this.session;
    if (comments.card === "new") return this.composer();
    const thread = comments.card === null ? null : comments.find(comments.card);
    return thread ? this.thread(thread) : html``;
  }

  override updated(): void {
    const { comments } = this.session;
    const { card } = comments;
    this.putBeside();
    const thread = typeof card === "number" ? comments.find(card) : null;
    if (thread && document.visibilityState === "visible") comments.markRead(thread);
    const fresh = card !== this._shown;
    this._shown = card;
    if (!fresh || card === null) return;
    const target = card === "new" ? this.renderRoot.querySelector("textarea") : this._section;
    target?.focus({ preventScroll: true });
  }

  /**
   * Positions the card next to its pin, because the size of the card is known only after rendering.
   */
  private putBeside(): void {
    const { _section: section, session } = this;
    if (!section || matchMedia(kNarrow).matches) return;
    const { comments, view } = session;
    const place =
      comments.card === "new"
        ? comments.draft("new")?.position
        : comments.card === null
          ? null
          : comments.find(comments.card)?.first.position;
    const at = place ? view.camera.project(place) : null;
    const frame = { width: this.clientWidth, height: this.clientHeight };
    const [x, y] = at ? [at.x / view.scale, at.y / view.scale] : [-1, -1];
    const inView = x >= 0 && y >= 0 && x <= frame.width && y <= frame.height;
    const size = { width: section.offsetWidth, height: section.offsetHeight };
    const margin = 14;
    const found = inView
      ? beside(
          [x - margin, y - margin],
          size,
          { width: frame.width - 2 * margin, height: frame.height - 2 * margin },
          kGapPx + margin,
        )
      : null;
    section.style.left = `${found ? found.left + margin : frame.width - size.width - margin}px`;
    section.style.top = `${found ? found.top + margin : margin}px`;
  }

  // ── a new thread ───────────────────────────────────────────────────────────────────────────────

  private composer(): TemplateResult {
    const { comments } = this.session;
    const draft = comments.draft("new");
    const subjects = draft?.subjects ?? [];
    return html`<section role="dialog" aria-label=${words.new_title} tabindex="-1" @keydown=${this.onKey}>
      <div class="row head">
        <h2 class="grow">${words.new_title}</h2>
        ${this.closeButton()}
      </div>
      <form
        @submit=${(event: Event) => {
          event.preventDefault();
          void this.send("new", () => comments.sendNew());
        }}
      >
        ${this.field("new", words.text, words.text_hint)}
        ${
          subjects.length === 0
            ? nothing
            : html`<label class="field">
              <span>${words.about}</span>
              <select
                @change=${(event: Event) => {
                  const { value } = event.target as HTMLSelectElement;
                  comments.chooseSubject(value === "" ? null : Number(value));
                }}
              >
                <option value="" ?selected=${draft?.subject === undefined}>${words.about_nothing}</option>
                ${subjects.map(({ label }, index) => html`<option value=${index} ?selected=${draft?.subject === index}>${label}</option>`)}
              </select>
            </label>`
        }
        ${this.problem("new")}
        <div class="row">
          <button
            type="button"
            class="quiet"
            @click=${() => {
              comments.setDraft("new", null);
              comments.close();
            }}
          >
            ${words.give_up}
          </button>
          <button class="primary" ?disabled=${this._busy || !draft?.text.trim()}>${words.send}</button>
        </div>
      </form>
    </section>`;
  }

  // ── a thread ───────────────────────────────────────────────────────────────────────────────────

  private thread(thread: Thread): TemplateResult {
    const { session } = this;
    const { comments } = session;
    const { first } = thread;
    const resolved = first.state === "resolved";
    const reply: DraftOf = `reply ${first.id}`;
    return html`<section role="dialog" aria-label=${words.thread(called(first))} tabindex="-1" @keydown=${this.onKey}>
      <div class="row head">
        <h2 class="grow">${words.heading}</h2>
        ${
          session.canPaint
            ? html`<button class="quiet" ?disabled=${this._busy} @click=${() => void this.turn(first, resolved ? "open" : "resolved")}>
              ${icon(resolved ? "undo" : "check")}${resolved ? words.reopen : words.resolve}
            </button>`
            : nothing
        }
        <button class="icon quiet" aria-label=${words.fly} title=${words.fly} @click=${() => comments.flyTo(thread)}>${icon("fit")}</button>
        ${this.closeButton()}
      </div>
      <div class="list">
        ${
          first.resolved
            ? html`<div class="settled">${icon("check")}<span>${words.resolved_by(called(first.resolved), toldTime(first.resolved.time))}</span></div>`
            : nothing
        }
        ${this.about(first)}
        ${repeat(
          commentsIn(thread),
          ({ id }) => id,
          (comment) => this.comment(comment),
        )}
        ${this.problem("thread")}
      </div>
      ${
        session.canPaint
          ? html`<form
            class="foot"
            @submit=${(event: Event) => {
              event.preventDefault();
              void this.send(reply, () => comments.sendReply(first.id));
            }}
          >
            ${this.field(reply, words.reply_text, words.reply_hint)} ${this.problem(reply)}
            <div class="row" ?hidden=${!comments.draft(reply)}>
              <button class="primary" ?disabled=${this._busy || !comments.draft(reply)?.text.trim()}>${words.send_reply}</button>
            </div>
          </form>`
          : html`<div></div>`
      }
    </section>`;
  }

  private about({ layer: layerId, table, record }: Comment): TemplateResult | typeof nothing {
    const { session } = this;
    const layer = session.layers.find(layerId ?? null);
    if (table === undefined || record === undefined)
      return layer ? html`<div class="about">${words.about_is(labelOf(layer))}</div>` : nothing;
    const called = session.tables.label(table, record) ?? texts.tables.record(record);
    if (!layer) return html`<div class="about">${words.about_is(called)}</div>`;
    const what = words.about_is(words.record_of(called, labelOf(layer)));
    return html`<div class="about"><button class="link" @click=${() => session.tables.showRow(layer, record)}>${what}</button></div>`;
  }

  private comment(comment: Comment): TemplateResult {
    const { session } = this;
    const { comments } = session;
    const { id, user, time, edited, text, deleted } = comment;
    const isOwn = user === comments.me && session.canPaint;
    const link = hashOfComment(id);
    const edit: DraftOf = `edit ${id}`;
    const isWritten = this._editing === id || comments.draft(edit) !== null;
    const acts = html`<div class="row acts">
      ${isOwn ? html`<button class="link" @click=${() => void this.beginEdit(comment)}>${words.edit}</button>` : nothing}
      ${isOwn || session.canCurate ? html`<button class="link" ?disabled=${this._busy} @click=${() => void this.deleteComment(comment)}>${words.delete}</button>` : nothing}
    </div>`;
    return html`<article data-comment=${id}>
      ${personMark(comment)}
      <div class="by">
        <b>${called(comment)}</b>
        <a class="hint" href=${link} title=${words.link}>${toldTime(time)}</a>
        ${edited ? html`<span class="hint" title=${toldTime(edited)}>${words.edited(toldTime(edited))}</span>` : nothing}
      </div>
      ${
        deleted
          ? html`<p class="words gone">${words.deleted}</p>`
          : isOwn && isWritten
            ? html`<form
              @submit=${(event: Event) => {
                event.preventDefault();
                void this.save(comment);
              }}
            >
              ${this.field(edit, words.text, "", text)} ${this.problem(edit)}
              <div class="row">
                <button type="button" class="quiet" @click=${() => this.endEdit(comment)}>${texts.cancel}</button>
                <button class="primary" ?disabled=${this._busy || !(comments.draft(edit)?.text ?? text).trim()}>${texts.save}</button>
              </div>
            </form>`
            : html`${commentText(text, comments.people)} ${isOwn || session.canCurate ? acts : nothing}`
      }
    </article>`;
  }

  // ── writing ────────────────────────────────────────────────────────────────────────────────────

  private field(of: DraftOf, label: string, hint: string, text = ""): TemplateResult {
    const { comments } = this.session;
    const offers = this._names.offersIn(of);
    const look = (event: Event): void => void this._names.look(event.target as HTMLTextAreaElement);
    return html`<textarea
        name=${of}
        aria-label=${label}
        placeholder=${hint}
        rows="2"
        dir="auto"
        role=${offers ? "combobox" : nothing}
        aria-autocomplete=${offers ? "list" : nothing}
        aria-expanded=${offers ? "true" : nothing}
        aria-controls=${offers ? "names" : nothing}
        aria-activedescendant=${offers ? this._names.active : nothing}
        .value=${comments.draft(of)?.text ?? text}
        @input=${(event: Event) => {
          comments.setDraft(of, { text: (event.target as HTMLTextAreaElement).value });
          look(event);
        }}
        @click=${look}
        @keydown=${(event: KeyboardEvent) => this._names.onKey(event)}
        @keyup=${({ key, target }: KeyboardEvent) => {
          if (/^(Arrow(Left|Right)|Home|End)$/.test(key))
            void this._names.look(target as HTMLTextAreaElement);
        }}
        @blur=${() => this._names.close()}
      ></textarea>
      ${offers ? this._names.list() : nothing}`;
  }

  private problem(of: DraftOf | "thread"): TemplateResult | typeof nothing {
    return this._problem?.of === of
      ? html`<p class="error" role="alert">${this._problem.text}</p>`
      : nothing;
  }

  private closeButton(): TemplateResult {
    return html`<button class="icon quiet" aria-label=${words.close} title=${words.close} @click=${() => this.session.comments.close()}>${icon("close")}</button>`;
  }

  private readonly onKey = (event: KeyboardEvent): void => {
    if (event.key === "Escape") {
      event.preventDefault();
      this.session.comments.close();
    } else if (
      event.key === "Enter" &&
      (event.ctrlKey || event.metaKey) &&
      event.target instanceof HTMLTextAreaElement
    ) {
      event.preventDefault();
      event.target.form?.requestSubmit();
    }
  };

  private async beginEdit({ id }: Comment): Promise<void> {
    this._editing = id;
    await this.updateComplete;
    const field = this.renderRoot.querySelector<HTMLTextAreaElement>(`textarea[name="edit ${id}"]`);
    field?.focus();
    field?.setSelectionRange(field.value.length, field.value.length);
  }

  private endEdit({ id }: Comment): void {
    this.session.comments.setDraft(`edit ${id}`, null);
    this._editing = null;
    this._problem = null;
    this._section?.focus({ preventScroll: true });
  }

  private async save(comment: Comment): Promise<void> {
    const { comments } = this.session;
    const of: DraftOf = `edit ${comment.id}`;
    const text = comments.draft(of)?.text ?? comment.text;
    await this.send(
      of,
      async () => {
        if (text !== comment.text) await comments.change(comment, { text });
        this.endEdit(comment);
      },
      text,
    );
  }

  private async send(
    of: DraftOf,
    work: () => Promise<void>,
    text = this.session.comments.draft(of)?.text ?? "",
  ): Promise<void> {
    if (text.trim() === "" || this._busy) return;
    if ([...text].length > kMostCharacters)
      this._problem = { of, text: words.too_long(kMostCharacters) };
    else await this.attempt(of, work);
  }

  private turn(first: Comment, state: "open" | "resolved"): Promise<void> {
    return this.attempt("thread", () => this.session.comments.change(first, { state }));
  }

  private async deleteComment(comment: Comment): Promise<void> {
    const question = {
      heading: words.delete_title,
      lead: words.delete_lead,
      yes: words.delete,
      danger: true,
    };
    if (await ask(question))
      await this.attempt("thread", () => this.session.comments.remove(comment));
  }

  /** Keeps the text in its field if the server refuses the request. */
  private async attempt(of: DraftOf | "thread", work: () => Promise<void>): Promise<void> {
    this._busy = true;
    this._problem = null;
    try {
      await work();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = { of, text: error.message };
    } finally {
      this._busy = false;
    }
  }

  private containsDeep(element: Node): boolean {
    return element.getRootNode() === this.renderRoot;
  }
}
