// <strata-figure-dialog>: asks what a measured figure is to be like, shows the sheet while it is
// chosen, and has the file made. Of what this person sees, or with `view` of what a named view
// shows.

import { html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api";
import type { CameraMessage } from "../../math/camera";
import { holds_files, label_column, label_of } from "../../domain/cells";
import {
  figure_choices,
  figure_request,
  is_dpi,
  kDirections,
  kDpiRange,
  kFormats,
  kOrientations,
  kPapers,
  kResolutions,
  kScales,
  read_scale,
  scale_text,
  type FigureChoices,
  type FigureFrom,
  type FigureWords,
} from "../../domain/figures";
import { read_number } from "../../core/locale";
import { holds_marks } from "../../domain/marks";
import type { FigureLabels, FigureRequest, View } from "../../core/protocol.gen";
import type { Column, Layer, ProblemBody } from "../../core/types";
import "../../ui/dialog";
import "./face-hint";
import "./figure-preview";
import { figure_styles } from "./figure-styles";
import { follow_session } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import { Kept } from "../../core/kept";
import { has_keyboard } from "../../ui/keyboard";
import { is_busy, type LayerJob } from "../../session/layer-jobs";
import type { ModelSession } from "../../session/model-session";
import { number_input } from "../../ui/number-input";
import { radio_group } from "../../ui/radio-group";
import { styled } from "../../ui/styled";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.figures;
const kFrom: readonly FigureFrom[] = ["camera", ...kDirections, "face"];
const kWords: readonly { name: keyof FigureWords; most: number }[] = [
  { name: "title", most: 200 },
  { name: "caption", most: 2000 },
  { name: "credit", most: 1000 },
];
/** Which of the dialog's fields a part of the request is chosen in. */
const kFieldOf: Readonly<Record<string, string>> = {
  direction: "from",
  normal: "from",
  center: "from",
  camera: "from",
  view: "from",
};
const kFields: readonly string[] = [
  "from",
  "scale",
  "paper",
  "orientation",
  "dpi",
  "format",
  "title",
  "caption",
  "credit",
  "labels",
];

@customElement("strata-figure-dialog")
export class StrataFigureDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** Null: what this person sees. */
  @property({ attribute: false }) view: View | null = null;
  @state() private choices_: FigureChoices = figure_choices(null);
  @state() private scale_typed_: string | null = null; // null: one of the list
  @state() private dpi_typed_: string | null = null;
  @state() private problem_: { field: string; text: string } | null = null;
  @state() private asking_ = false; // for a face: the dialog is aside
  @state() private sending_ = false;
  private readonly kept_ = new Kept<unknown>(() => localStorage, "strata.figure", null);
  private camera_: CameraMessage | null = null; // that this person sees by
  private opener_: HTMLElement | null = null;

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [shared_styles, figure_styles];

  override connectedCallback(): void {
    super.connectedCallback();
    this.opener_ = has_keyboard();
    const choices = figure_choices(this.kept_.value);
    const { face } = this.session.figures.draft;
    this.choices_ = choices.from === "face" && !face ? { ...choices, from: "camera" } : choices;
    // the view is what was asked for
    if (this.view) this.choices_ = { ...this.choices_, from: "camera" };
    if (choices.scale !== null && !kScales.includes(choices.scale))
      this.scale_typed_ = scale_text(choices.scale);
    if (!kResolutions.includes(choices.dpi)) this.dpi_typed_ = String(choices.dpi);
    this.see_camera();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.session.figures.awaited = null; // its file is offered by a notice
    this.session.face.give_up();
  }

  override willUpdate(_: PropertyValues): void {
    const { awaited: key } = this.session.figures;
    const problem = this.job?.problem;
    if (key === null || !problem) return;
    this.session.figures.awaited = null;
    this.session.jobs.dismiss(key);
    this.refuse(problem);
    void this.go_to_problem();
  }

  /** While the dialog is open the camera may follow somebody; the sheet does not. */
  private see_camera(): void {
    this.camera_ = this.session.views.content().camera;
  }

  private get job(): LayerJob | null {
    const { figures, jobs } = this.session;
    return jobs.entries.find(({ key }) => key === figures.awaited) ?? null;
  }

  private get request_now(): FigureRequest | null {
    const { session, view } = this;
    const { words: written, face } = session.figures.draft;
    const shown = view
      ? { view: String(view.id) }
      : { ...session.views.content(), ...(this.camera_ ? { camera: this.camera_ } : {}) };
    const request = figure_request(shown, this.choices_, written, face, this.labels_now);
    return (
      request && {
        ...request,
        provisional: texts.figures.provisional,
        continued: texts.figures.continued,
      }
    );
  }

  /** Null: none, or none yet. */
  private get labels_now(): FigureLabels | null {
    const { layer: id, column } = this.session.figures.draft.labels ?? {};
    const layer = this.session.layers.all.find((each) => each.id === id);
    const chosen = column || (layer && this.columns(layer)[0]?.slug);
    return layer && chosen ? { layer: layer.id, column: chosen } : null;
  }

  // ── what is seen
  // ──────────────────────────────────────────────────────────────────────────────────────────────────

  override render(): TemplateResult {
    const { session, view } = this;
    if (this.asking_) return html`<strata-face-hint .session=${session}></strata-face-hint>`;
    return html`<strata-dialog vast heading=${view ? words.title_of_view(view.name) : words.title} way_out=${this.job && is_busy(this.job) ? "" : texts.close} @closed=${this.on_closed}>
      <div class="editor">
        <form id="figure" class="fields" novalidate @submit=${this.on_submit}>
          ${this.direction()} ${this.scale()} ${this.sheet()} ${this.resolution()} ${this.format()} ${this.written()}
          ${this.labels()}
        </form>
        <div class="sheet">
          ${this.warning()}
          <strata-figure-preview .session=${session} .request=${this.request_now} alt=${this.description()} @told=${this.on_told}></strata-figure-preview>
          <p class="hint">${words.preview_hint}</p>
        </div>
      </div>
      ${this.actions()}
    </strata-dialog>`;
  }

  private direction(): TemplateResult {
    const { from } = this.choices_;
    const { face } = this.session.figures.draft;
    return html`<div class="group full">
      <label class="field">
        <span>${words.from}</span>
        <select name="from" autofocus aria-invalid=${this.is_wrong("from")} aria-describedby=${this.told_at("from")} @change=${(event: Event) => this.choose_from(value_of(event) as FigureFrom)}>
          ${kFrom.map((each) => html`<option value=${each} ?selected=${each === from}>${each === "camera" && this.view ? words.as_view : words.froms[each]}</option>`)}
        </select>
      </label>
      ${
        from === "face"
          ? html`<div class="row">
            <button type="button" @click=${() => void this.ask_face()}>${icon("pick")}${face ? words.pick_again : words.pick}</button>
          </div>`
          : nothing
      }
      ${this.problem_of("from")}
    </div>`;
  }

  private scale(): TemplateResult {
    const { scale } = this.choices_;
    const own = this.scale_typed_;
    return html`<div class="group">
      <label class="field">
        <span>${words.scale}</span>
        <select name="scale" aria-invalid=${own === null && this.is_wrong("scale")} aria-describedby=${this.told_at("scale")} @change=${(event: Event) => this.choose_scale(value_of(event))}>
          <option value="" ?selected=${own === null && scale === null}>${words.fits}</option>
          ${kScales.map((each) => html`<option value=${each} ?selected=${own === null && scale === each}>${scale_text(each)}</option>`)}
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
            aria-invalid=${this.is_wrong("scale")} aria-describedby=${this.told_at("scale")}
            @input=${(event: Event) => this.type_scale(value_of(event))}
          />`
      }
    </div>`;
  }

  private sheet(): TemplateResult {
    const { paper, orientation } = this.choices_;
    return html`<div class="group">
        <span class="caption" id="paper">${words.paper}</span>
        ${radio_group({
          label: { id: "paper" },
          class: "segments",
          choices: kPapers.map((value) => ({ value, content: value.toUpperCase() })),
          chosen: paper,
          choose: (value) => this.choose({ paper: value }),
        })}
      </div>
      ${this.problem_of("scale")} ${this.problem_of("paper")}
      <div class="group full">
        <span class="caption" id="orientation">${words.orientation}</span>
        ${radio_group({
          label: { id: "orientation" },
          class: "segments",
          choices: [
            { value: null, content: words.fits },
            ...kOrientations.map((value) => ({ value, content: words.orientations[value] })),
          ],
          chosen: orientation,
          choose: (value) => this.choose({ orientation: value }),
        })}
        ${this.problem_of("orientation")}
      </div>`;
  }

  private resolution(): TemplateResult {
    const own = this.dpi_typed_;
    return html`<div class="group full">
      <span class="caption" id="dpi">${words.dpi}</span>
      ${radio_group<number | null>({
        label: { id: "dpi" },
        class: "segments",
        choices: [
          ...kResolutions.map((value) => ({ value, content: words.dpi_of(value) })),
          { value: null, content: words.own_dpi },
        ],
        chosen: own === null ? this.choices_.dpi : null,
        choose: (value) => this.choose_dpi(value),
      })}
      ${
        own === null
          ? nothing
          : html`<label class="own">
            ${number_input({
              value: own,
              name: "own_dpi",
              label: words.own_dpi_label,
              min: kDpiRange.least,
              max: kDpiRange.most,
              wrong: this.problem_?.field === "dpi",
              typed: (text) => this.type_dpi(text),
            })}
            <span class="hint">${words.dpi_range(kDpiRange.least, kDpiRange.most)}</span>
          </label>`
      }
      ${this.problem_of("dpi")}
    </div>`;
  }

  private format(): TemplateResult {
    return html`<div class="group full">
      <span class="caption" id="format">${words.format}</span>
      ${radio_group({
        label: { id: "format" },
        class: "formats",
        choices: kFormats.map((value) => ({
          value,
          content: html`<b>${value.toUpperCase()}</b><span class="hint">${words.formats[value]}</span>`,
        })),
        chosen: this.choices_.format,
        choose: (value) => this.choose({ format: value }),
      })}
      ${this.problem_of("format")}
    </div>`;
  }

  private written(): TemplateResult {
    const { model, figures } = this.session;
    const written = figures.draft.words;
    const usual = {
      title: model?.name ?? "",
      caption: words.caption_hint,
      credit: model?.credit || words.credit_hint,
    };
    return html`${kWords.map(({ name, most }) => {
      const type = (event: Event): void =>
        this.write({ ...written, [name]: value_of(event) }, name);
      return html`<div class="group full">
        <label class="field">
          <span>${words.written[name]}</span>
          ${
            name === "caption"
              ? html`<textarea name=${name} maxlength=${most} placeholder=${usual[name]} .value=${written[name]} aria-invalid=${this.is_wrong(name)} aria-describedby=${this.told_at(name)} @input=${type}></textarea>`
              : html`<input type="text" name=${name} maxlength=${most} autocomplete="off" placeholder=${usual[name]} .value=${written[name]} aria-invalid=${this.is_wrong(name)} aria-describedby=${this.told_at(name)} @input=${type} />`
          }
        </label>
        ${this.problem_of(name)}
      </div>`;
    })}`;
  }

  private labels(): TemplateResult {
    const { layers, figures } = this.session;
    const { labels } = figures.draft;
    // as in the list of layers
    const choices = layers.all.filter(({ table }) => table !== undefined).reverse();
    const layer = choices.find(({ id }) => id === labels?.layer) ?? null;
    return html`<div class="full group">
        <label class="check">
          <input type="checkbox" name="legend" .checked=${this.choices_.legend} @change=${(event: Event) => this.choose({ legend: (event.target as HTMLInputElement).checked })} />
          ${words.legend}
        </label>
      </div>
      ${
        choices.length === 0
          ? nothing
          : html`<div class="group ${layer ? "" : "full"}">
              <label class="field">
                <span>${words.labels}</span>
                <select name="labels" aria-invalid=${this.is_wrong("labels")} aria-describedby=${this.told_at("labels")} @change=${(event: Event) => this.label(value_of(event) === "" ? null : { layer: Number(value_of(event)), column: "" })}>
                  <option value="" ?selected=${layer === null}>${words.no_labels}</option>
                  ${choices.map((each) => html`<option value=${each.id} ?selected=${each === layer}>${each.name}</option>`)}
                </select>
              </label>
            </div>
            ${layer ? this.label_column(layer) : nothing}
            ${this.problem_of("labels")}`
      }`;
  }

  private label_column(layer: Layer): TemplateResult {
    const columns = this.columns(layer);
    const chosen = this.labels_now?.column;
    const gone = chosen !== undefined && !columns.some(({ slug }) => slug === chosen);
    if (this.session.tables.find(layer.table!) && columns.length === 0)
      return html`<p class="hint">${words.no_columns}</p>`;
    return html`<label class="field">
      <span>${words.column}</span>
      <select name="column" aria-invalid=${this.is_wrong("labels")} aria-describedby=${this.told_at("labels")} @change=${(event: Event) => this.label({ layer: layer.id, column: value_of(event) })}>
        ${columns.map((column) => html`<option value=${column.slug} ?selected=${column.slug === chosen}>${label_of(column)}</option>`)}
        ${gone ? html`<option value=${chosen} selected>${chosen}</option>` : nothing}
      </select>
    </label>`;
  }

  private warning(): TemplateResult | typeof nothing {
    const { model, can_curate } = this.session;
    if (!model || (model.scale_verified && !model.unit_assumed)) return nothing;
    return html`<div class="warning">
      <span>${can_curate ? words.unsure : `${words.unsure} ${words.unsure_ask}`}</span>
      ${can_curate ? html`<button class="link" @click=${this.correct}>${texts.model.check_size}</button>` : nothing}
    </div>`;
  }

  private actions(): TemplateResult {
    const { job } = this;
    const { saved } = this.session.figures;
    const busy = job !== null && is_busy(job);
    const percent = Math.round((job?.job.progress ?? 0) * 100);
    const general = this.problem_?.field === "" ? this.problem_.text : "";
    return html`${
      busy
        ? html`<div slot="told" class="making">
          <div class="bar" role="progressbar" aria-label=${words.making} aria-valuemin="0" aria-valuemax="100" aria-valuenow=${percent}>
            <i ${styled({ width: `${percent}%` })}></i>
          </div>
          <span class="hint">${job.job.state === "queued" ? texts.layer_jobs.queued : job.job.message || words.making}</span>
        </div>`
        : html`<div slot="told" class="told ${general || saved ? "" : "nothing"}">
          ${general ? html`<span class="error" role="alert">${general}</span>` : html`<span class="hint" role="status">${saved ? words.saved(saved) : ""}</span>`}
        </div>`
    }
    ${busy ? html`<button slot="actions" @click=${() => void this.cancel(job)}>${words.cancel}</button>` : nothing}
    <button slot="actions" class="primary" form="figure" ?disabled=${busy || this.sending_}>${words.make}</button>`;
  }

  /** For who does not see the picture. */
  private description(): string {
    const { from, scale, paper } = this.choices_;
    const seen = from === "camera" && this.view ? words.as_view : words.froms[from];
    return words.preview(
      paper.toUpperCase(),
      seen,
      scale === null ? words.fits : scale_text(scale),
    );
  }

  // ── what is chosen
  // ────────────────────────────────────────────────────────────────────────────────────────────────

  private choose(change: Partial<FigureChoices>): void {
    this.choices_ = { ...this.choices_, ...change };
    this.kept_.value = this.choices_;
    if (Object.keys(change).includes(this.problem_?.field ?? "") || this.problem_?.field === "")
      this.problem_ = null;
  }

  private choose_from(from: FigureFrom): void {
    if (from === "face" && !this.session.figures.draft.face) void this.ask_face();
    else this.choose({ from });
  }

  /** The dialog comes back with the face, or as it was. */
  private async ask_face(): Promise<void> {
    this.asking_ = true;
    this.dispatchEvent(new CustomEvent("aside"));
    const face = await this.session.face.ask();
    this.asking_ = false;
    this.see_camera();
    if (!face) return;
    this.session.figures.draft.face = face;
    this.choose({ from: "face" });
  }

  private choose_scale(value: string): void {
    const { scale } = this.choices_;
    this.scale_typed_ = value !== "own" ? null : scale === null ? "" : scale_text(scale);
    this.choose({ scale: value === "own" ? scale : value === "" ? null : Number(value) });
  }

  private type_scale(typed: string): void {
    this.scale_typed_ = typed;
    const scale = read_scale(typed);
    if (Number.isNaN(scale)) this.problem_ = this.typing_problem;
    else this.choose({ scale });
  }

  private choose_dpi(dpi: number | null): void {
    this.dpi_typed_ = dpi === null ? String(this.choices_.dpi) : null;
    this.choose({ dpi: dpi ?? this.choices_.dpi });
  }

  private type_dpi(typed: string): void {
    this.dpi_typed_ = typed;
    const dpi = read_number(typed);
    if (is_dpi(dpi)) this.choose({ dpi });
    else this.problem_ = this.typing_problem;
  }

  private write(written: FigureWords, name: keyof FigureWords): void {
    this.session.figures.draft.words = written;
    if (this.problem_?.field === name) this.problem_ = null;
    this.requestUpdate();
  }

  /** What can be written beside a place. */
  private columns(layer: Layer): Column[] {
    const table = this.session.tables.find(layer.table!);
    if (!table) return [];
    const title = label_column(table); // what records are called comes first
    const words = table.columns.filter((column) => !holds_files(column) && !holds_marks(column));
    return words.sort((a, b) => Number(b === title) - Number(a === title));
  }

  /** Without a column: the first that there is. */
  private label(labels: { layer: number; column: string } | null): void {
    this.session.figures.draft.labels = labels;
    if (this.problem_?.field === "labels") this.problem_ = null;
    this.requestUpdate();
  }

  private correct(): void {
    this.dispatchEvent(new CustomEvent("correct"));
  }

  // ── what is wrong
  // ─────────────────────────────────────────────────────────────────────────────────────────────────

  private is_wrong(field: string): boolean {
    return this.problem_?.field === field;
  }
  private told_at(field: string): string | typeof nothing {
    return this.is_wrong(field) ? `${field}_problem` : nothing;
  }
  private problem_of(field: string): TemplateResult | typeof nothing {
    return this.is_wrong(field)
      ? html`<p class="error" role="alert" id="${field}_problem">${this.problem_?.text}</p>`
      : nothing;
  }

  private refuse({ field = "", title, detail }: ProblemBody): void {
    const part = field.split(/[.[]/)[0]!;
    const own = kFieldOf[part] ?? part;
    this.problem_ = { field: kFields.includes(own) ? own : "", text: detail ?? title };
  }

  /** Of the preview: what is wrong stands at its field, where it has one. */
  private on_told(event: CustomEvent<ProblemBody | null>): void {
    const problem = event.detail;
    if (this.typing_problem) return; // what is asked for is not what is typed
    if (problem?.field === undefined) return;
    this.refuse(problem);
    if (this.problem_?.field !== "") event.preventDefault();
  }

  /** A field holds what is none of its choices. */
  private get typing_problem(): { field: string; text: string } | null {
    const { scale_typed_: scale, dpi_typed_: dpi } = this;
    if (scale !== null && Number.isNaN(read_scale(scale)))
      return { field: "scale", text: words.wrong_scale };
    return dpi !== null && !is_dpi(read_number(dpi))
      ? { field: "dpi", text: words.wrong_dpi(kDpiRange.least, kDpiRange.most) }
      : null;
  }

  // ── what is made
  // ──────────────────────────────────────────────────────────────────────────────────────────────────

  private readonly on_submit = (event: Event): void => {
    event.preventDefault();
    const request = this.request_now;
    if (this.sending_ || (this.job && is_busy(this.job))) return;
    const problem = request ? this.typing_problem : { field: "from", text: words.no_face };
    if (request && !problem) {
      void this.make(request);
    } else {
      this.problem_ = problem;
      void this.go_to_problem();
    }
  };

  /** The field may be out of sight. */
  private async go_to_problem(): Promise<void> {
    await this.updateComplete;
    this.renderRoot.querySelector<HTMLElement>('[aria-invalid="true"]')?.focus();
  }

  private async make(request: FigureRequest): Promise<void> {
    const { figures, model } = this.session;
    this.sending_ = true;
    this.problem_ = null;
    try {
      await figures.make(words.job(request.title ?? model?.name ?? ""), request);
      if (!this.isConnected) figures.awaited = null;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refuse(error.problem);
      void this.go_to_problem();
    } finally {
      this.sending_ = false;
    }
  }

  private async cancel({ key }: LayerJob): Promise<void> {
    try {
      await this.session.jobs.cancel(key);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refuse(error.problem);
    }
  }

  private readonly on_closed = (): void => {
    this.dispatchEvent(new CustomEvent("closed"));
    // the browser forgets it where the dialog stepped aside
    if (!has_keyboard()) this.opener_?.focus();
  };
}

const value_of = (event: Event): string => (event.target as HTMLInputElement).value;
