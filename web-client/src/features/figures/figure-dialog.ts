// <strata-figure-dialog>: sets the options of a measured figure, previews the sheet, and starts the
// job that makes the file. The figure shows this user's view or, with `view`, a saved view.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import type { CameraMessage } from "../../math/camera";
import {
  figureChoices,
  figureRequest,
  hasAreas,
  hasDimensions,
  hasOutlines,
  hasSheet,
  hasViews,
  isDpi,
  isRollout,
  kAreas,
  kDpiRange,
  kFigureFrom,
  kFormats,
  kOrientations,
  kPapers,
  kResolutions,
  kScales,
  kTolerances,
  readScale,
  scaleText,
  type FigureChoices,
  type FigureFrom,
  type FigureWords,
} from "../../domain/figures";
import type { BlockField, BlockTexts } from "../../domain/figure-block";
import { kFewestViews, viewsOf } from "../../domain/figure-views";
import { readNumber, typedNumber } from "../../core/locale";
import type { FigureRequest, FigureView, View } from "../../core/protocol.gen";
import type { ProblemBody } from "../../core/types";
import "../../ui/dialog";
import "./face-hint";
import "./figure-preview";
import { figureStyles } from "./figure-styles";
import { AwaitedFile, awaitedFileStyles } from "../../session/awaited-file";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import { Kept } from "../../core/kept";
import { hasKeyboard } from "../../ui/keyboard";
import type { ModelSession } from "../../session/model-session";
import { fieldProblem, typingProblem, type FieldProblem } from "./figure-problems";
import { wordFields } from "./figure-words";
import { nameOfViews, viewsFields, viewsStyles } from "./figure-views-fields";
import { blockFields, blockStyles, withBlockWords } from "./figure-block-fields";
import { rolloutFields, rolloutStyles } from "./rollout-fields";
import { kNewRollout, rolloutOf, wrongSurface, type RolloutInput } from "./rollout-request";
import { labelFields, labelsOf, type LabelChoice } from "./figure-labels";
import { numberInput } from "../../ui/number-input";
import { radioGroup } from "../../ui/radio-group";
import { formatChoiceStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.figures;
/** Returns the words for a direction of this user's view. */
const nameOf = (from: FigureFrom): string =>
  from === "rollout" ? texts.rollouts.from : words.froms[from];

@customElement("strata-figure-dialog")
export class StrataFigureDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** Null stands for this user's view. */
  @property({ attribute: false }) view: View | null = null;
  /** Whether the dialog opens with the rollout of the draft. */
  @property({ attribute: false }) unrolled = false;
  @state() private _choices: FigureChoices = figureChoices(null);
  @state() private _scaleTyped: string | null = null; // null if a scale of the list is chosen
  @state() private _dpiTyped: string | null = null;
  @state() private _problem: FieldProblem | null = null;
  @state() private _asking = false; // whether the user is picking a face while the dialog is hidden
  @state() private _rollout: RolloutInput = kNewRollout; // the last valid input
  private readonly _kept = new Kept<unknown>(() => localStorage, "strata.figure", null);
  private readonly _file = new AwaitedFile(this, (problem) => {
    this.refuse(problem);
    void this.goToProblem();
  });
  private _camera: CameraMessage | null = null; // this user's camera
  private _opener: HTMLElement | null = null;

  constructor() {
    super();
    followSession(
      this,
      "jobs",
      "layers",
      "tables",
      "views",
      "view",
      "appearance",
      "tools",
      "measuring",
    );
  }

  static override styles = [
    sharedStyles,
    formatChoiceStyles,
    awaitedFileStyles,
    figureStyles,
    blockStyles,
    viewsStyles,
    rolloutStyles,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this._opener = hasKeyboard();
    const choices = figureChoices(this._kept.value);
    const { face } = this.session.figures.draft;
    this._choices = choices.from === "face" && !face ? { ...choices, from: "camera" } : choices;
    // a figure of a saved view initially uses the camera of the view
    if (this.view) this._choices = { ...this._choices, from: "camera" };
    if (this.unrolled) this._choices = { ...this._choices, from: "rollout" };
    const { rollout } = this.session.figures.draft;
    if (rollout && wrongSurface(rollout) === null) this._rollout = rollout;
    if (choices.scale !== null && !kScales.includes(choices.scale))
      this._scaleTyped = scaleText(choices.scale);
    if (!kResolutions.includes(choices.dpi)) this._dpiTyped = String(choices.dpi);
    this.seeCamera();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.session.face.giveUp();
  }

  /**
   * Stores the current camera, because the user's camera may follow another participant while the
   * dialog is open.
   */
  private seeCamera(): void {
    this._camera = this.session.views.content().camera;
  }

  private get requestNow(): FigureRequest | null {
    const { session, view } = this;
    const { model } = session;
    const { words: written, face } = session.figures.draft;
    const shown = view
      ? { view: String(view.id) }
      : { ...session.views.content(), ...(this._camera ? { camera: this._camera } : {}) };
    const rollout = model && rolloutOf(this._rollout, model);
    const labels = labelsOf(session);
    const block = this._choices.title_block ? this.block : null;
    const measured = session.measuring.positions;
    const parts = { face, labels, rollout, block, views: this.views, measured };
    const request = figureRequest(shown, this._choices, written, parts);
    return (
      request && {
        ...withBlockWords(request),
        provisional: texts.figures.provisional,
        continued: texts.figures.continued,
      }
    );
  }

  private get views(): FigureView[] | null {
    const { figures, views } = this.session;
    const known = figures.draft.views.filter((id) => views.all.some((view) => view.id === id));
    return viewsOf(this._choices.views, known, (each) => words.views.directions[each]);
  }

  private get block(): BlockTexts {
    return { ...this.session.figures.draft.block, ...this._choices.block_texts };
  }

  // ── rendering ──────────────────────────────────────────────────────────────────────────────────

  override render(): TemplateResult {
    const { session, view } = this;
    if (this._asking) return html`<strata-face-hint .session=${session}></strata-face-hint>`;
    return html`<strata-dialog vast heading=${view ? words.title_of_view(view.name) : words.title} way_out=${this._file.running ? "" : texts.close} @closed=${this.onClosed}>
      <div class="editor">
        <form id="figure" class="fields" novalidate @submit=${this.onSubmit}>
          ${hasSheet(this._choices) ? this.viewsField() : nothing} ${hasViews(this._choices) ? nothing : this.direction()} ${this.scale()} ${this.sheet()} ${hasSheet(this._choices) ? this.resolution() : nothing} ${this.format()} ${this.areas()}
          ${hasSheet(this._choices) ? html`${this.written()} ${this.titleBlock()} ${this.legend()}` : nothing} ${this.labels()} ${this.dimensions()}
        </form>
        <div class="sheet">
          ${this.warning()}
          <strata-figure-preview .session=${session} .request=${this.requestNow} missing=${this.missing} alt=${this.description()} @told=${this.onTold}></strata-figure-preview>
          <p class="hint">${words.preview_hint}</p>
        </div>
      </div>
      ${this.actions()}
    </strata-dialog>`;
  }

  private viewsField(): TemplateResult {
    const { draft } = this.session.figures;
    return viewsFields(this.session, {
      chosen: this._choices.views,
      saved: draft.views,
      wrong: this.isWrong("views"),
      told: this.toldAt("views"),
      problem: this.problemOf("views"),
      choose: (views) => this.choose({ views }),
      tick: (saved) => {
        draft.views = saved;
        this.choose({ views: "saved" });
      },
    });
  }

  /** What the request lacks. */
  private get missing(): string {
    return hasViews(this._choices) ? words.views.few(kFewestViews) : words.no_face;
  }

  private direction(): TemplateResult {
    const { from } = this._choices;
    const { face } = this.session.figures.draft;
    return html`<div class="group full">
      <label class="field">
        <span>${words.from}</span>
        <select name="from" autofocus aria-invalid=${this.isWrong("from")} aria-describedby=${this.toldAt("from")} @change=${(event: Event) => this.chooseFrom(valueFor(event) as FigureFrom)}>
          ${kFigureFrom.map((each) => html`<option value=${each} ?selected=${each === from}>${each === "camera" && this.view ? words.as_view : nameOf(each)}</option>`)}
        </select>
      </label>
      ${
        from === "face"
          ? html`<div class="row">
            <button type="button" @click=${() => void this.askFace()}>${icon("pick")}${face ? words.pick_again : words.pick}</button>
          </div>`
          : nothing
      }
      ${from === "rollout" ? this.surface() : nothing}
      ${this.problemOf("from")}
    </div>`;
  }

  private surface(): TemplateResult | typeof nothing {
    const { model, figures } = this.session;
    return model
      ? rolloutFields(figures.draft.rollout ?? kNewRollout, model, (input) => this.unroll(input))
      : nothing;
  }

  private scale(): TemplateResult {
    const { scale } = this._choices;
    const own = this._scaleTyped;
    return html`<div class="group">
      <label class="field">
        <span>${words.scale}</span>
        <select name="scale" aria-invalid=${own === null && this.isWrong("scale")} aria-describedby=${this.toldAt("scale")} @change=${(event: Event) => this.chooseScale(valueFor(event))}>
          <option value="" ?selected=${own === null && scale === null}>${words.fits}</option>
          ${kScales.map((each) => html`<option value=${each} ?selected=${own === null && scale === each}>${scaleText(each)}</option>`)}
          <option value="own" ?selected=${own !== null}>${words.own_scale}</option>
        </select>
      </label>
      ${
        own === null
          ? nothing
          : html`<input
            type="text"
            name="own_scale"
            autocomplete="off"
            aria-label=${words.own_scale_label}
            placeholder="1 : 40"
            .value=${own}
            aria-invalid=${this.isWrong("scale")} aria-describedby=${this.toldAt("scale")}
            @input=${(event: Event) => this.typeScale(valueFor(event))}
          />`
      }
    </div>`;
  }

  private sheet(): TemplateResult {
    const { paper, orientation } = this._choices;
    return html`<div class="group">
        <span class="caption" id="paper">${words.paper}</span>
        ${radioGroup({
          label: { id: "paper" },
          class: "segments",
          choices: kPapers.map((value) => ({ value, content: value.toUpperCase() })),
          chosen: paper,
          choose: (value) => this.choose({ paper: value }),
        })}
      </div>
      ${this.problemOf("scale")} ${this.problemOf("paper")}
      <div class="group full">
        <span class="caption" id="orientation">${words.orientation}</span>
        ${radioGroup({
          label: { id: "orientation" },
          class: "segments",
          choices: [
            { value: null, content: words.fits },
            ...kOrientations.map((value) => ({ value, content: words.orientations[value] })),
          ],
          chosen: orientation,
          choose: (value) => this.choose({ orientation: value }),
        })}
        ${this.problemOf("orientation")}
      </div>`;
  }

  private resolution(): TemplateResult {
    const own = this._dpiTyped;
    return html`<div class="group full">
      <span class="caption" id="dpi">${words.dpi}</span>
      ${radioGroup<number | null>({
        label: { id: "dpi" },
        class: "segments",
        choices: [
          ...kResolutions.map((value) => ({ value, content: words.dpi_of(value) })),
          { value: null, content: words.own_dpi },
        ],
        chosen: own === null ? this._choices.dpi : null,
        choose: (value) => this.chooseDpi(value),
      })}
      ${
        own === null
          ? nothing
          : html`<label class="own">
            ${numberInput({
              value: own,
              name: "own_dpi",
              label: words.own_dpi_label,
              min: kDpiRange.least,
              max: kDpiRange.most,
              wrong: this._problem?.field === "dpi",
              typed: (text) => this.typeDpi(text),
            })}
            <span class="hint">${words.dpi_range(kDpiRange.least, kDpiRange.most)}</span>
          </label>`
      }
      ${this.problemOf("dpi")}
    </div>`;
  }

  private format(): TemplateResult {
    return html`<div class="group full">
      <span class="caption" id="format">${words.format}</span>
      ${radioGroup({
        label: { id: "format" },
        class: "formats",
        choices: kFormats.map((value) => ({
          value,
          content: html`<b>${value.toUpperCase()}</b><span class="hint">${words.formats[value]}</span>`,
        })),
        chosen: this._choices.format,
        choose: (value) => this.choose({ format: value }),
      })}
      ${this.problemOf("format")}
    </div>`;
  }

  private areas(): TemplateResult | typeof nothing {
    const chosen = this._choices;
    if (!hasAreas(chosen) && !hasOutlines(chosen)) return nothing;
    return html`<div class="group full">
      ${
        hasAreas(chosen)
          ? html`<span class="caption" id="areas">${words.areas}</span>
              ${radioGroup({
                label: { id: "areas" },
                class: "segments",
                choices: kAreas.map((value) => ({ value, content: words.areas_as[value] })),
                chosen: chosen.areas,
                choose: (value) => this.choose({ areas: value }),
              })}`
          : nothing
      }
      ${
        hasOutlines(chosen)
          ? html`<label class="field">
            <span>${words.tolerance}</span>
            <select name="tolerance" @change=${(event: Event) => this.choose({ tolerance_mm: Number(valueFor(event)) })}>
              ${kTolerances.map((each) => html`<option value=${each} ?selected=${each === chosen.tolerance_mm}>${typedNumber(each)} mm</option>`)}
            </select>
          </label>
          <p class="hint">${words.outlines_hint}</p>`
          : nothing
      }
      ${this.problemOf("areas")}
    </div>`;
  }

  private written(): TemplateResult {
    return wordFields(this.session, {
      wrong: (field) => this.isWrong(field),
      told: (field) => this.toldAt(field),
      problem: (field) => this.problemOf(field),
      write: (written, name) => this.write(written, name),
    });
  }

  private titleBlock(): TemplateResult {
    return blockFields(this.session, this.block, {
      on: this._choices.title_block,
      problem: this.problemOf("title_block"),
      turn: (on) => this.choose({ title_block: on }),
      write: (name, text) => this.writeBlock(name, text),
    });
  }

  private legend(): TemplateResult {
    return html`<div class="full group">
        <label class="check">
          <input type="checkbox" name="legend" .checked=${this._choices.legend} @change=${(event: Event) => this.choose({ legend: (event.target as HTMLInputElement).checked })} />
          ${words.legend}
        </label>
      </div>`;
  }

  private labels(): TemplateResult | typeof nothing {
    if (isRollout(this._choices)) return nothing;
    return labelFields(this.session, {
      wrong: this.isWrong("labels"),
      told: this.toldAt("labels"),
      problem: this.problemOf("labels"),
      choose: (labels) => this.label(labels),
    });
  }

  private dimensions(): TemplateResult | typeof nothing {
    if (!hasDimensions(this._choices) || this.session.measuring.places.length < 2) return nothing;
    return html`<div class="full group">
      <label class="check">
        <input type="checkbox" name="dimensions" aria-describedby="dimensions_hint" .checked=${this._choices.dimensions} @change=${(event: Event) => this.choose({ dimensions: (event.target as HTMLInputElement).checked })} />
        ${words.dimensions}
      </label>
      <p class="hint" id="dimensions_hint">${words.dimensions_hint}</p>
    </div>`;
  }

  private warning(): TemplateResult | typeof nothing {
    const { model, canCurate } = this.session;
    if (!model || (model.scale_verified && !model.unit_assumed)) return nothing;
    return html`<div class="warning">
      <span>${canCurate ? words.unsure : `${words.unsure} ${words.unsure_ask}`}</span>
      ${canCurate ? html`<button class="link" @click=${this.correct}>${texts.model.check_size}</button>` : nothing}
    </div>`;
  }

  private actions(): TemplateResult {
    return this._file.footer({
      form: "figure",
      make: words.make,
      making: words.making,
      cancel: words.cancel,
      saved: ({ name }) => words.saved(name),
      problem: this._problem?.field === "" ? this._problem.text : "",
    });
  }

  /** Returns a description of the preview for screen readers. */
  private description(): string {
    const { from, scale, paper } = this._choices;
    const single = from === "camera" && this.view ? words.as_view : nameOf(from);
    const seen = hasViews(this._choices) ? nameOfViews(this._choices.views) : single;
    return words.preview(paper.toUpperCase(), seen, scale === null ? words.fits : scaleText(scale));
  }

  // ── choices ────────────────────────────────────────────────────────────────────────────────────

  private choose(change: Partial<FigureChoices>): void {
    this._choices = { ...this._choices, ...change };
    this._kept.value = this._choices;
    if (Object.keys(change).includes(this._problem?.field ?? "") || this._problem?.field === "")
      this._problem = null;
  }

  private chooseFrom(from: FigureFrom): void {
    if (from === "face" && !this.session.figures.draft.face) void this.askFace();
    else this.choose({ from });
  }

  /**
   * Hides the dialog while the user picks a face. Shows it again afterwards, with the picked face
   * if there is one.
   */
  private async askFace(): Promise<void> {
    this._asking = true;
    this.dispatchEvent(new CustomEvent("aside"));
    const face = await this.session.face.ask();
    this._asking = false;
    this.seeCamera();
    if (!face) return;
    this.session.figures.draft.face = face;
    this.choose({ from: "face" });
  }

  private chooseScale(value: string): void {
    const { scale } = this._choices;
    this._scaleTyped = value !== "own" ? null : scale === null ? "" : scaleText(scale);
    this.choose({ scale: value === "own" ? scale : value === "" ? null : Number(value) });
  }

  private typeScale(typed: string): void {
    this._scaleTyped = typed;
    const scale = readScale(typed);
    if (Number.isNaN(scale)) this._problem = this.typingProblem;
    else this.choose({ scale });
  }

  private chooseDpi(dpi: number | null): void {
    this._dpiTyped = dpi === null ? String(this._choices.dpi) : null;
    this.choose({ dpi: dpi ?? this._choices.dpi });
  }

  private typeDpi(typed: string): void {
    this._dpiTyped = typed;
    const dpi = readNumber(typed);
    if (isDpi(dpi)) this.choose({ dpi });
    else this._problem = this.typingProblem;
  }

  private write(written: FigureWords, name: keyof FigureWords): void {
    this.session.figures.draft.words = written;
    if (this._problem?.field === name) this._problem = null;
    this.requestUpdate();
  }

  private writeBlock(name: BlockField, text: string): void {
    const { draft } = this.session.figures;
    draft.block = { ...draft.block, [name]: text };
    const { block_texts: kept } = this._choices;
    this.choose({
      title_block: true,
      block_texts: name in kept ? { ...kept, [name]: text } : kept,
    });
  }

  /** Sets the labels. If the choice has no column, the figure uses the first column. */
  private label(labels: LabelChoice | null): void {
    this.session.figures.draft.labels = labels;
    if (this._problem?.field === "labels") this._problem = null;
    this.requestUpdate();
  }

  /** The preview keeps the last valid surface. The fields show what is wrong. */
  private unroll(input: RolloutInput): void {
    this.session.figures.draft.rollout = input;
    if (wrongSurface(input) === null) this._rollout = input;
    if (this._problem?.field === "from") this._problem = null;
    this.requestUpdate();
  }

  private correct(): void {
    this.dispatchEvent(new CustomEvent("correct"));
  }

  // ── problems ───────────────────────────────────────────────────────────────────────────────────

  private isWrong(field: string): boolean {
    return this._problem?.field === field;
  }
  private toldAt(field: string): string | typeof nothing {
    return this.isWrong(field) ? `${field}_problem` : nothing;
  }
  private problemOf(field: string): TemplateResult | typeof nothing {
    return this.isWrong(field)
      ? html`<p class="error" role="alert" id="${field}_problem">${this._problem?.text}</p>`
      : nothing;
  }

  private refuse(problem: ProblemBody): void {
    this._problem = fieldProblem(problem);
  }

  /** Shows a problem of the preview at its field, if the dialog has that field. */
  private onTold(event: CustomEvent<ProblemBody | null>): void {
    const problem = event.detail;
    if (this.typingProblem) return; // the preview's request does not contain the typed values
    if (problem?.field === undefined) return;
    this.refuse(problem);
    if (this._problem?.field !== "") event.preventDefault();
  }

  private get typingProblem(): FieldProblem | null {
    return typingProblem(this._scaleTyped, this._dpiTyped);
  }

  // ── the job ────────────────────────────────────────────────────────────────────────────────────

  private readonly onSubmit = (event: Event): void => {
    event.preventDefault();
    const request = this.requestNow;
    if (!this._file.isFree) return;
    const field = hasViews(this._choices) ? "views" : "from";
    const problem = request ? this.typingProblem : { field, text: this.missing };
    const { rollout } = this.session.figures.draft;
    const isWrong = isRollout(this._choices) && rollout && wrongSurface(rollout) !== null;
    if (request && !problem && !isWrong) {
      void this.make(request);
    } else {
      this._problem = problem;
      void this.goToProblem();
    }
  };

  /** Focuses the field with the problem, which may be outside the visible part of the dialog. */
  private async goToProblem(): Promise<void> {
    await this.updateComplete;
    this.renderRoot.querySelector<HTMLElement>('[aria-invalid="true"]')?.focus();
  }

  private async make(request: FigureRequest): Promise<void> {
    const { figures, model } = this.session;
    this._problem = null;
    await this._file.make(
      () => figures.make(words.job(request.title ?? model?.name ?? ""), request),
      () => this.isConnected,
    );
  }

  private readonly onClosed = (): void => {
    this.dispatchEvent(new CustomEvent("closed"));
    // the browser does not restore the focus if the dialog was hidden in the meantime
    if (!hasKeyboard()) this._opener?.focus();
  };
}

const valueFor = (event: Event): string => (event.target as HTMLInputElement).value;
