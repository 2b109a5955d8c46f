// <strata-tour-stop-fields>: a stop of a tour: its view, its texts in each language, its times and
// transition, its layers and records.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { labelOf } from "../../domain/cells";
import { languageInWords } from "../../core/languages";
import {
  isAbout,
  kMostLayers,
  kSeconds,
  languageOfField,
  untranslated,
  type StopDraft,
} from "../../domain/tours";
import type { TourClasses, TourFile, TourTransition } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { numberInput } from "../../ui/number-input";
import "../../ui/order/ordered-choice";
import { radioGroup } from "../../ui/radio-group";
import { numberFieldStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "./tour-media";
import "./tour-records";
import { visibilityBadge } from "../../ui/visibility";

const words = texts.tours;
const kMostClasses = 256;
const kTransitions: readonly TourTransition[] = ["move", "cut"];

@customElement("strata-tour-stop-fields")
export class StrataTourStopFields extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) stop!: StopDraft;
  /** The tour's id; null for an unsaved tour. */
  @property({ attribute: false }) tour: number | null = null;
  @property({ attribute: false }) files: readonly TourFile[] = [];
  /** Names of classes, for the whole tour. */
  @property({ attribute: false }) classes: readonly TourClasses[] = [];
  @property({ attribute: false }) languages: readonly string[] = [];
  /** The language that is edited next to the first one. */
  @property() language = "";
  /** The refused field, such as `title.fr`; empty if no field of this stop was refused. */
  @property() wrong = "";
  @property() problem = "";

  constructor() {
    super();
    followSession(this, "tours", "views", "layers", "tables");
  }

  static override styles = [
    sharedStyles,
    numberFieldStyles,
    css`
      :host {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        align-content: start;
        gap: var(--space-3);
      }
      .part {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-2);
      }
      .view {
        display: flex;
        gap: var(--space-2);
      }
      .view select {
        flex: 1;
        min-width: 0;
      }
      .words {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(min(100%, 13.125rem), 1fr));
        gap: var(--space-3);
      }
      .language {
        display: grid;
        align-content: start;
        gap: var(--space-2);
        min-width: 0;
      }
      .segments {
        justify-self: start;
      }
      .segments button {
        gap: var(--space-2);
      }
      .dot {
        width: 0.5rem;
        height: 0.5rem;
        border-radius: 50%;
        background: var(--warn);
      }
      textarea {
        min-height: 6.5rem;
      }
      textarea[aria-invalid="true"],
      select[aria-invalid="true"] {
        border-color: var(--danger);
      }
      .times {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(9.375rem, 1fr));
        align-items: end;
        gap: var(--space-3);
      }
      .times .segments {
        display: flex;
        justify-self: stretch;
      }
      details[open] > summary {
        margin-bottom: var(--space-2);
      }
      summary {
        cursor: pointer;
      }
      .lacks {
        color: var(--warn);
      }
      .layer-names {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(min(12rem, 100%), 1fr));
        gap: var(--space-2);
      }
    `,
  ];

  /** Focuses the refused field. */
  async focusWrong(): Promise<void> {
    await this.updateComplete;
    const find = (selector: string): HTMLElement | null =>
      this.renderRoot.querySelector<HTMLElement>(selector);
    const field = find('[aria-invalid="true"]') ?? find("#refusal") ?? find("strata-tour-records");
    field?.scrollIntoView({ block: "center" }); // includes the problem below the field
    field?.focus({ preventScroll: true });
  }

  private isWrong(field: string): boolean {
    return this.wrong !== "" && isAbout(this.wrong, field);
  }
  private refusal(...fields: string[]): TemplateResult | typeof nothing {
    return fields.some((field) => this.isWrong(field))
      ? html`<p class="error" role="alert" id="refusal">${this.problem}</p>`
      : nothing;
  }
  private invalid(field: string): "true" | "false" {
    return this.isWrong(field) ? "true" : "false";
  }

  override render(): TemplateResult {
    const { stop, session } = this;
    return html`${this.view()} ${this.words()} ${this.times()}
      <div class="part">
        <span class="caption">${words.swipe}</span>
        <p class="hint">${words.swipe_hint}</p>
        <strata-ordered-choice
          label=${words.swipe}
          add_label=${words.layer_add}
          most=${kMostLayers}
          .things=${[...session.layers.all].reverse().map((layer) => ({ value: layer.slug, name: labelOf(layer), badge: visibilityBadge(layer.visibility) }))}
          .chosen=${stop.layers}
          .wrong=${this.isWrong("layers") ? stop.layers.filter((_, index) => this.wrong === `layers[${index}]`) : []}
          @chosen=${(event: CustomEvent<string[]>) => this.change({ layers: event.detail })}
        ></strata-ordered-choice>
        ${this.refusal("layers")} ${this.layerNames()}
      </div>
      <div class="part">
        <span class="caption">${words.media}</span>
        <p class="hint">${words.media_hint}</p>
        <strata-tour-media
          .session=${session}
          .tour=${this.tour}
          .media=${stop.media}
          .files=${this.files}
          .languages=${this.written}
          wrong=${this.wrong.startsWith("media") ? this.wrong : ""}
          @changed=${(event: CustomEvent<StopDraft["media"]>) => this.change({ media: event.detail })}
        ></strata-tour-media>
        ${this.refusal("media")}
      </div>
      <div class="part">
        <span class="caption">${words.records}</span>
        <p class="hint">${words.records_hint}</p>
        <strata-tour-records
          .session=${session}
          .records=${stop.records}
          .languages=${this.written}
          wrong=${this.wrong.startsWith("records") ? this.wrong : ""}
          problem=${this.problem}
          @changed=${(event: CustomEvent<StopDraft["records"]>) => this.change({ records: event.detail })}
        ></strata-tour-records>
        ${/^records\[/.test(this.wrong) ? nothing : this.refusal("records")}
      </div>`;
  }

  /**
   * Renders the names on visitors' layer buttons. They belong to the layers and are saved there
   * immediately.
   */
  private layerNames(): TemplateResult | typeof nothing {
    const { session, stop } = this;
    const layers = stop.layers.flatMap(
      (slug) => session.layers.all.find((layer) => layer.slug === slug) ?? [],
    );
    if (layers.length === 0 || this.languages.length < 2) return nothing;
    return html`<p class="hint">${words.layer_names}</p>
      <div class="layer-names">
        ${layers.map((layer) =>
          this.written.map(
            (language) =>
              html`<label class="field">
                <span>${words.layer_name(layer.name, languageInWords(language))}</span>
                <input
                  type="text"
                  maxlength="200"
                  lang=${language}
                  placeholder=${labelOf(layer, [language])}
                  .value=${layer.labels[language] ?? ""}
                  @change=${(event: Event) => void this.nameLayer(layer, language, (event.target as HTMLInputElement).value)}
                />
              </label>`,
          ),
        )}
      </div>
      ${layers.filter(({ palette }) => palette.mode === "categorical").map((layer) => this.classNames(layer))}`;
  }

  /** Renders the names of classes that appear after a tap on the model. They belong to the tour. */
  private classNames(layer: Layer): TemplateResult | typeof nothing {
    const { points } = layer.palette;
    const own = this.classes.find((each) => each.layer === layer.slug)?.classes ?? [];
    const others = this.written.slice(1);
    if (points.length === 0 || points.length > kMostClasses) return nothing;
    return html`<details>
      <summary>${words.class_names(labelOf(layer))}</summary>
      <div class="layer-names">
        ${points.map(({ at, label }) =>
          others.map(
            (language) =>
              html`<label class="field">
                <span>${words.class_name(label || String(at), languageInWords(language))}</span>
                <input
                  type="text"
                  maxlength="200"
                  lang=${language}
                  .value=${own.find(({ value }) => value === at)?.names[language] ?? ""}
                  @input=${(event: Event) => this.nameClass(layer.slug, at, language, (event.target as HTMLInputElement).value)}
                />
              </label>`,
          ),
        )}
      </div>
    </details>`;
  }

  private nameClass(layer: string, value: number, language: string, name: string): void {
    const own = this.classes.find((each) => each.layer === layer)?.classes ?? [];
    const names = { ...own.find((each) => each.value === value)?.names, [language]: name };
    const classes = [...own.filter((each) => each.value !== value), { value, names }].sort(
      (a, b) => a.value - b.value,
    );
    const all = [...this.classes.filter((each) => each.layer !== layer), { layer, classes }];
    this.dispatchEvent(new CustomEvent<TourClasses[]>("classes", { detail: all }));
  }

  private async nameLayer(layer: Layer, language: string, typed: string): Promise<void> {
    const { [language]: _, ...others } = layer.labels;
    const name = typed.trim();
    try {
      await this.session.layers.change(layer, {
        labels: name === "" ? others : { ...others, [language]: name },
      });
    } catch (error) {
      notices.error(error);
    }
  }

  private view(): TemplateResult {
    const { stop } = this;
    const { all, loaded } = this.session.views;
    const known = all.some(({ slug }) => slug === stop.view);
    const gone = loaded && !known;
    return html`<div class="part">
      <span class="caption" id="view">${words.view}</span>
      <div class="view">
        <select aria-labelledby="view" aria-invalid=${gone ? "true" : this.invalid("view")} @change=${(event: Event) => this.change({ view: (event.target as HTMLSelectElement).value })}>
          ${known ? nothing : html`<option value="" selected disabled>${gone ? words.view_choose : texts.loading}</option>`}
          ${repeat(
            all,
            ({ id }) => id,
            ({ slug, name }) =>
              html`<option value=${slug} .selected=${slug === stop.view}>${name}</option>`,
          )}
        </select>
        <button type="button" ?disabled=${!known} @click=${() => this.dispatchEvent(new CustomEvent("try"))}>${icon("eye")}${words.try_stop}</button>
      </div>
      ${gone ? html`<p class="error" role="alert">${words.view_gone}</p>` : this.refusal("view")}
    </div>`;
  }

  // ── texts ──────────────────────────────────────────────────────────────────────────────────────

  /** The first language, and the language that is edited next to it. */
  private get written(): string[] {
    const [first = ""] = this.languages;
    const other =
      this.languages.includes(this.language) && this.language !== first
        ? this.language
        : this.languages[1];
    return other === undefined ? [first] : [first, other];
  }

  private words(): TemplateResult {
    const [first, ...others] = this.languages;
    const { written, stop } = this;
    const lacks = untranslated(stop, this.languages);
    const mark = (language: string): unknown =>
      lacks.includes(language)
        ? html`<span class="dot" role="img" aria-label=${words.lacks} title=${words.lacks}></span>`
        : nothing;
    return html`<div class="part">
      ${
        others.length > 1
          ? radioGroup<string>({
              label: words.translation,
              class: "segments",
              choices: others.map((language) => ({
                value: language,
                content: html`${languageInWords(language)}${mark(language)}`,
              })),
              chosen: written[1] ?? null,
              choose: (language) =>
                this.dispatchEvent(new CustomEvent<string>("language", { detail: language })),
            })
          : nothing
      }
      <div class="words">${repeat(
        written,
        (language) => language,
        (language) => this.inLanguage(language, language === first),
      )}</div>
      ${this.refusal("title", "text")}
    </div>`;
  }

  private inLanguage(language: string, isFirst: boolean): TemplateResult {
    const { stop } = this;
    const name = languageInWords(language);
    const alone = this.languages.length === 1;
    const lacks = !isFirst && untranslated(stop, this.languages).includes(language);
    const refused =
      languageOfField(this.wrong) === language ||
      (isFirst && (this.wrong === "title" || this.wrong === "text"));
    return html`<div class="language" role="group" aria-label=${name}>
      <label class="field">
        <span>${alone ? words.stop_title : words.stop_title_in(name)}</span>
        <input
          type="text"
          maxlength="200"
          lang=${language}
          aria-invalid=${refused && this.isWrong("title") ? "true" : "false"}
          .value=${stop.title[language] ?? ""}
          @input=${(event: Event) => this.change({ title: { ...stop.title, [language]: (event.target as HTMLInputElement).value } })}
        />
      </label>
      <label class="field">
        <span>${alone ? words.stop_text : words.stop_text_in(name)}</span>
        <textarea
          maxlength="5000"
          lang=${language}
          aria-invalid=${refused && this.isWrong("text") ? "true" : "false"}
          .value=${stop.text[language] ?? ""}
          @input=${(event: Event) => this.change({ text: { ...stop.text, [language]: (event.target as HTMLTextAreaElement).value } })}
        ></textarea>
      </label>
      ${lacks ? html`<p class="hint lacks">${words.lacks}</p>` : nothing}
    </div>`;
  }

  // ── times and transition ───────────────────────────────────────────────────────────────────────

  private times(): TemplateResult {
    const { stop } = this;
    const seconds = (field: "attract_s" | "transition_s", caption: string): TemplateResult => {
      const [min, max] = kSeconds[field === "attract_s" ? "attract" : "transition"];
      return html`<label class="field">
        <span>${caption}</span>
        <span class="number">${numberInput({ value: stop[field], min, max, wrong: this.isWrong(field), typed: (text) => this.change({ [field]: text }) })}<span>s</span></span>
      </label>`;
    };
    return html`<div class="part">
      <div class="times">
        ${seconds("attract_s", words.attract)}
        <div class="part">
          <span class="caption" id="transition">${words.transition}</span>
          ${radioGroup<TourTransition>({
            label: { id: "transition" },
            class: "segments",
            choices: kTransitions.map((value) => ({ value, content: words.transitions[value] })),
            chosen: stop.transition,
            choose: (transition) => this.change({ transition }),
          })}
        </div>
        ${stop.transition === "cut" ? nothing : seconds("transition_s", words.transition_takes)}
      </div>
      ${this.refusal("attract_s", "transition", "transition_s")}
    </div>`;
  }

  private change(change: Partial<StopDraft>): void {
    this.dispatchEvent(
      new CustomEvent<StopDraft>("changed", { detail: { ...this.stop, ...change } }),
    );
  }
}
