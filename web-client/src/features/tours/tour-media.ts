// <strata-tour-media>: the pictures, sounds and videos of a stop in their order. Each has a caption
// and a description in every language. Videos can have subtitles.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { languageInWords } from "../../core/languages";
import type { TourFile } from "../../core/protocol.gen";
import { kMostMedia, moved, newMedium, type MediumDraft } from "../../domain/tours";
import { formatBytes } from "../../domain/measure";
import type { ModelSession } from "../../session/model-session";
import { icon } from "../../ui/icons";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "./tour-file-add";

const words = texts.tours;
const kAccepted = ".jpg,.jpeg,.png,.webp,.mp3,.m4a,.wav,.flac,.ogg,.oga,.mp4,.m4v,.webm";

@customElement("strata-tour-media")
export class StrataTourMedia extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) tour: number | null = null;
  @property({ attribute: false }) media: readonly MediumDraft[] = [];
  @property({ attribute: false }) files: readonly TourFile[] = [];
  /** The languages that the user edits. */
  @property({ attribute: false }) languages: readonly string[] = [];
  /** The refused field, such as `media[0].alt.fr`. */
  @property() wrong = "";

  static override styles = [
    sharedStyles,
    css`
      :host,
      .fields,
      .subtitles {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-2);
      }
      .medium {
        display: grid;
        grid-template-columns: 6rem minmax(0, 1fr);
        gap: var(--space-3);
        padding: var(--space-3);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
      }
      .medium.wrong {
        border-color: var(--danger);
      }
      .seen {
        display: grid;
        place-items: center;
        align-self: start;
        height: 4.5rem;
        overflow: hidden;
        border-radius: var(--radius-small);
        background: var(--calm-soft);
        color: var(--ink-soft);
      }
      .seen img {
        width: 100%;
        height: 100%;
        object-fit: cover;
      }
      .seen svg {
        width: 1.75rem;
        height: 1.75rem;
      }
      .head {
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        gap: var(--space-1) var(--space-2);
      }
      .head b {
        flex: 1 1 8rem;
        min-width: 0;
        overflow-wrap: anywhere;
      }
      .pair {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(min(100%, 12rem), 1fr));
        gap: var(--space-2);
      }
      @media (max-width: 560px) {
        .medium {
          grid-template-columns: minmax(0, 1fr);
        }
      }
    `,
  ];

  override render(): TemplateResult {
    const { media, session, tour } = this;
    return html`${repeat(
      media,
      ({ file }) => file,
      (medium, index) => this.medium(medium, index),
    )}
    ${
      media.length < kMostMedia
        ? html`<strata-tour-file-add multiple .session=${session} .tour=${tour} label=${words.media_add} accept=${kAccepted} @added=${({ detail }: CustomEvent<TourFile>) => this.add(detail)}></strata-tour-file-add>`
        : nothing
    }`;
  }

  private medium(medium: MediumDraft, index: number): TemplateResult {
    const { media, files } = this;
    const file = files.find(({ id }) => id === medium.file);
    const name = file?.name ?? words.media_gone;
    const wrong = this.wrong.startsWith(`media[${index}]`);
    return html`<section class="medium ${wrong ? "wrong" : ""}" aria-label=${name}>
      <div class="seen">${this.preview(file)}</div>
      <div class="fields">
        <div class="head">
          <b>${name}</b>
          ${file ? html`<span class="hint">${words.file_kinds[file.kind]} · ${formatBytes(file.bytes)}</span>` : nothing}
          <button type="button" class="icon quiet" aria-label=${texts.ordered_choice.up(name)} ?disabled=${index === 0} @click=${() => this.put(moved(media, index, index - 1))}>${icon("up")}</button>
          <button type="button" class="icon quiet" aria-label=${texts.ordered_choice.down(name)} ?disabled=${index === media.length - 1} @click=${() => this.put(moved(media, index, index + 1))}>${icon("down")}</button>
          <button type="button" class="icon quiet" aria-label=${texts.ordered_choice.remove(name)} @click=${() => this.put(media.filter((each) => each !== medium))}>${icon("trash")}</button>
        </div>
        ${this.texts(medium, "caption", words.caption, 1000)}
        ${this.texts(medium, "alt", words.alt, 200)}
        ${file?.kind === "video" ? this.subtitles(medium) : nothing}
      </div>
    </section>`;
  }

  private preview(file: TourFile | undefined): unknown {
    if (file?.kind !== "picture" || this.tour === null)
      return icon(file?.kind === "sound" ? "comment" : file ? "picture" : "warning");
    return html`<img src=${this.session.tours.addressOf(this.tour, file.id, 256)} alt="" />`;
  }

  private texts(
    medium: MediumDraft,
    member: "caption" | "alt",
    caption: string,
    most: number,
  ): TemplateResult {
    return html`<div class="pair">
      ${this.languages.map(
        (language) =>
          html`<label class="field">
            <span>${this.languages.length > 1 ? words.in_language(caption, languageInWords(language)) : caption}</span>
            <input
              type="text"
              maxlength=${most}
              lang=${language}
              .value=${medium[member][language] ?? ""}
              @input=${(event: Event) => this.change(medium, { [member]: { ...medium[member], [language]: (event.target as HTMLInputElement).value } })}
            />
          </label>`,
      )}
    </div>`;
  }

  private subtitles(medium: MediumDraft): TemplateResult {
    return html`<div class="subtitles">
      ${this.languages.map((language) => {
        const file = this.files.find(({ id }) => id === medium.subtitles[language]);
        const label = words.subtitles(languageInWords(language));
        if (!file)
          return html`<span class="hint">${label}</span>
            <strata-tour-file-add .session=${this.session} .tour=${this.tour} label=${label} accept=".vtt" @added=${({ detail }: CustomEvent<TourFile>) => this.subtitle(medium, language, detail)}></strata-tour-file-add>`;
        const { [language]: _, ...others } = medium.subtitles;
        return html`<div class="head">
          <span>${label}: ${file.name}</span>
          <button type="button" class="icon quiet" aria-label=${texts.ordered_choice.remove(file.name)} @click=${() => this.change(medium, { subtitles: others })}>${icon("trash")}</button>
        </div>`;
      })}
    </div>`;
  }

  private add(file: TourFile): void {
    this.tell(file);
    this.put([...this.media, newMedium(file.id)]);
  }
  private subtitle(medium: MediumDraft, language: string, file: TourFile): void {
    this.tell(file);
    this.change(medium, { subtitles: { ...medium.subtitles, [language]: file.id } });
  }
  private change(medium: MediumDraft, change: Partial<MediumDraft>): void {
    this.put(this.media.map((each) => (each.file === medium.file ? { ...each, ...change } : each)));
  }
  private put(media: readonly MediumDraft[]): void {
    this.dispatchEvent(new CustomEvent("changed", { detail: media }));
  }
  /** Reports an uploaded file to the editor, because the tour's draft must contain it. */
  private tell(file: TourFile): void {
    this.dispatchEvent(
      new CustomEvent<TourFile>("file", { detail: file, bubbles: true, composed: true }),
    );
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-tour-media": StrataTourMedia;
  }
}
