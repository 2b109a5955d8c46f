// <strata-report-dialog>: sets the options and texts of a condition report, and starts the job that
// makes the file.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { languageInWords } from "../../core/languages";
import { pageLanguage, pageLocale } from "../../core/locale";
import type { ReportPart } from "../../core/protocol.gen";
import type { ProblemBody } from "../../core/types";
import { kDirections } from "../../domain/figures";
import {
  kMostFigures,
  kReportFormats,
  kReportLanguages,
  kRecordRange,
  keptLogo,
  keptReport,
  keyOfView,
  reportInput,
  reportRequest,
  type FieldInput,
  type Logo,
  type ReportInput,
  type SectionInput,
} from "../../domain/reports";
import { AwaitedFile, awaitedFileStyles } from "../../session/awaited-file";
import { followSession } from "../../session/follow-session";
import type { ShowFile } from "../../session/file-jobs";
import { idsOf, layerChoice } from "../../session/layer-choice";
import type { ModelSession } from "../../session/model-session";
import "../../ui/dialog";
import { focusWrong } from "./focus-wrong";
import { numberInput } from "../../ui/number-input";
import "../../ui/order/ordered-choice";
import { radioGroup } from "../../ui/radio-group";
import { formatChoiceStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "./report-fields";
import "./report-logo";
import { previewRequest, ReportPreview, type ReportSettings } from "./report-preview";
import { fieldOf, problemsIn, without, type Problems } from "./report-problems";
import "./report-sections";
import { reportStyles } from "./report-styles";

const words = texts.report_dialog;
const kWritten = ["title", "subject", "author"] as const;

@customElement("strata-report-dialog")
export class StrataReportDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _input: ReportInput = reportInput(null, "en");
  @state() private _logo: Logo | null = null;
  @state() private _problems: Problems = new Map();
  @state() private _preview: ReportPreview | null = null;
  private _sent: ReportInput = this._input; // the input of the last request
  private readonly _file = new AwaitedFile(this, (problem) => this.refuse(problem));

  constructor() {
    super();
    followSession(this, "jobs", "layers", "views");
  }

  static override styles = [sharedStyles, formatChoiceStyles, awaitedFileStyles, reportStyles];

  override connectedCallback(): void {
    super.connectedCallback();
    const { reports } = this.session;
    const language = pageLanguage(pageLocale(), []);
    this._input = reports.draft ?? reportInput(reports.choices.value, language);
    this._logo = keptLogo(reports.logo.value);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._preview?.release();
    this._preview = null;
  }

  // ── rendering ──────────────────────────────────────────────────────────────────────────────────

  override render(): TemplateResult {
    return html`<strata-dialog
      vast
      heading=${texts.condition_report.title}
      way_out=${this._file.running ? "" : texts.close}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      <form id="report" class="editor" novalidate @submit=${this.onSubmit}>
        <div class="fields">
          ${this.format()} ${this.language()} ${this.written()} ${this.logo()} ${this.titleBlock()}
          ${this.layers()}
        </div>
        <div class="group">
          <span class="caption" id="sections">${words.sections}</span>
          <p class="hint">${words.sections_hint}</p>
          ${this.problemOf("sections")}
          <strata-report-sections
            .sections=${this._input.sections}
            .problems=${this._problems}
            .more=${(part: ReportPart) => this.optionsOf(part)}
            @changed=${({ detail }: CustomEvent<SectionInput[]>) => this.changeSections(detail)}
          ></strata-report-sections>
        </div>
      </form>
      ${this._file.footer({
        form: "report",
        make: words.make,
        making: this.session.files.awaitsPreview ? words.making_preview : words.making,
        cancel: this.session.files.awaitsPreview ? words.cancel_preview : words.cancel,
        saved: ({ name }) => words.saved(name),
        problem: this._problems.get("") ?? "",
        actions: html`<button slot="actions" ?disabled=${!this._file.isFree} @click=${() => this.preview()}>${words.preview}</button>`,
        status: this._preview?.render(this.settings) ?? null,
      })}
    </strata-dialog>`;
  }

  private format(): TemplateResult {
    return html`<div class="group">
      <span class="caption" id="format">${words.format}</span>
      ${radioGroup({
        label: { id: "format" },
        class: "formats",
        choices: kReportFormats.map((value) => ({
          value,
          content: html`<b>${words.formats[value]}</b><span class="hint">${words.format_hints[value]}</span>`,
        })),
        chosen: this._input.format,
        choose: (format) => this.choose({ format }),
      })}
      ${this.problemOf("format")}
    </div>`;
  }

  private language(): TemplateResult {
    return html`<div class="group">
      <span class="caption" id="language">${words.language}</span>
      ${radioGroup({
        label: { id: "language" },
        class: "segments",
        choices: kReportLanguages.map((value) => ({ value, content: languageInWords(value) })),
        chosen: this._input.language,
        choose: (language) => this.choose({ language }),
      })}
      ${this.problemOf("language")}
    </div>`;
  }

  private written(): TemplateResult {
    const usual = {
      title: this.session.model?.name ?? "",
      subject: words.subject_hint,
      author: words.author_hint,
    };
    return html`${kWritten.map(
      (name) =>
        html`<div class="group">
          <label class="field">
            <span>${words.written[name]}</span>
            <input type="text" name=${name} maxlength="200" autocomplete="off" placeholder=${usual[name]} .value=${this._input[name]} aria-invalid=${this._problems.has(name)} aria-describedby=${this.toldAt(name)} @input=${(event: Event) => this.choose({ [name]: (event.target as HTMLInputElement).value })} />
          </label>
          ${this.problemOf(name)}
        </div>`,
    )}`;
  }

  private logo(): TemplateResult {
    return html`<div class="group">
      <span class="caption">${words.logo}</span>
      <strata-report-logo
        .logo=${this._logo}
        @changed=${({ detail }: CustomEvent<Logo | null>) => this.putLogo(detail)}
        @refused=${({ detail }: CustomEvent<string>) => (this._problems = new Map([...without(this._problems, ["logo"]), ["logo", detail]]))}
      ></strata-report-logo>
      <p class="hint">${words.logo_hint}</p>
      ${this.problemOf("logo")}
    </div>`;
  }

  private titleBlock(): TemplateResult {
    return html`<div class="group">
      <span class="caption">${words.fields}</span>
      <p class="hint">${words.fields_hint}</p>
      <strata-report-fields
        .rows=${this._input.fields}
        .problems=${this._problems}
        @changed=${({ detail }: CustomEvent<FieldInput[]>) => this.changeFields(detail)}
      ></strata-report-fields>
      ${this.problemOf("fields")}
    </div>`;
  }

  private layers(): TemplateResult {
    return layerChoice({
      layers: this.session.layers,
      chosen: this._input.layers,
      label: words.layers,
      hint: words.layers_hint,
      choose: (layers) => this.choose({ layers }),
      problem: { id: this.toldAt("layers"), text: this.problemOf("layers") },
    });
  }

  private optionsOf(part: ReportPart): unknown {
    if (part === "figures") return this.figures();
    return part === "findings" ? this.findings() : nothing;
  }

  private figures(): TemplateResult {
    const { views } = this.session;
    const things = [
      ...kDirections.map((value) => ({ value, name: texts.figures.froms[value] })),
      ...views.all.map((view) => ({ value: keyOfView(view), name: words.view(view.name) })),
    ];
    const { figures } = this._input;
    return html`<strata-ordered-choice
        label=${words.figures}
        add_label=${words.add_figure}
        most=${kMostFigures}
        .things=${things}
        .chosen=${figures.map(({ of }) => of)}
        .wrong=${figures.map(({ of }) => of).filter((of) => this._problems.has(`figure:${of}`))}
        .more=${(of: string) => this.scaleOf(of, things.find(({ value }) => value === of)?.name ?? of)}
        @chosen=${({ detail }: CustomEvent<string[]>) => this.chooseFigures(detail)}
      ></strata-ordered-choice>
      ${figures.length === 0 ? html`<p class="hint">${words.no_figures}</p>` : nothing}
      ${this.problemOf("figures")}`;
  }

  private scaleOf(of: string, name: string): TemplateResult {
    const scale = this._input.figures.find((each) => each.of === of)?.scale ?? "";
    const problem = this._problems.get(`figure:${of}`);
    const type = (event: Event): void => {
      const typed = (event.target as HTMLInputElement).value;
      const figures = this._input.figures;
      this.choose(
        { figures: figures.map((each) => (each.of === of ? { ...each, scale: typed } : each)) },
        [`figure:${of}`],
      );
    };
    return html`<div>
        <input type="text" autocomplete="off" name="scale_${of}" aria-label=${words.scale_of(name)} placeholder=${words.scale_hint} .value=${scale} aria-invalid=${problem !== undefined} aria-describedby=${problem ? `scale_${of}_problem` : nothing} @input=${type} />
        ${problem ? html`<p class="error" role="alert" id="scale_${of}_problem">${problem}</p>` : nothing}
      </div>`;
  }

  private findings(): TemplateResult {
    const { least, most } = kRecordRange;
    const { records, recordPictures } = this._input;
    return html`<label class="field">
        <span>${words.records}</span>
        ${numberInput({
          value: records,
          name: "records",
          min: least,
          max: most,
          wrong: this._problems.has("records"),
          toldAt: "records_problem",
          typed: (text) => this.choose({ records: text }),
        })}
      </label>
      ${this.problemOf("records")}
      <label class="check">
        <input type="checkbox" name="record_pictures" .checked=${recordPictures} @change=${(event: Event) => this.choose({ recordPictures: (event.target as HTMLInputElement).checked })} />
        ${words.record_pictures}
      </label>`;
  }

  // ── choices ────────────────────────────────────────────────────────────────────────────────────

  /** The ids of the layers in the report, from bottom to top. */
  private get chosenLayers(): number[] {
    return idsOf(this.session.layers, this._input.layers);
  }

  /** Changes the input. Removes the problems of these fields, by default of the changed members. */
  private choose(change: Partial<ReportInput>, fields: string[] = Object.keys(change)): void {
    const { reports } = this.session;
    this._input = reports.draft = { ...this._input, ...change };
    reports.choices.value = keptReport(this._input);
    this._problems = without(this._problems, fields);
  }

  private changeFields(fields: readonly FieldInput[]): void {
    const changed = this._input.fields.filter((each) => !fields.includes(each));
    this.choose({ fields }, ["fields", ...changed.map(({ id }) => `field:${id}`)]);
  }

  private changeSections(sections: readonly SectionInput[]): void {
    const changed = this._input.sections.filter((each) => !sections.includes(each));
    this.choose({ sections }, ["sections", ...changed.map(({ part }) => `section:${part}`)]);
  }

  private chooseFigures(chosen: readonly string[]): void {
    const { figures } = this._input;
    const gone = figures.filter(({ of }) => !chosen.includes(of)).map(({ of }) => `figure:${of}`);
    this.choose(
      {
        figures: chosen.map((of) => figures.find((each) => each.of === of) ?? { of, scale: "" }),
      },
      ["figures", ...gone],
    );
  }

  private putLogo(logo: Logo | null): void {
    this._logo = logo;
    this.session.reports.logo.value = logo;
    this._problems = without(this._problems, ["logo"]);
  }

  // ── problems ───────────────────────────────────────────────────────────────────────────────────

  private toldAt(field: string): string | typeof nothing {
    return this._problems.has(field) ? `${field}_problem` : nothing;
  }
  private problemOf(field: string): TemplateResult | typeof nothing {
    const problem = this._problems.get(field);
    return problem
      ? html`<p class="error" role="alert" id="${field}_problem">${problem}</p>`
      : nothing;
  }

  private refuse(problem: ProblemBody): void {
    const field = fieldOf(problem, this._sent, this._input);
    this.tell(new Map([[field, problem.detail ?? problem.title]]));
  }

  private tell(problems: Problems): void {
    this._problems =
      problems.size > 0 && !problems.has("") ? new Map([...problems, ["", words.wrong]]) : problems;
    void focusWrong(this);
  }

  // ── the job ────────────────────────────────────────────────────────────────────────────────────

  private get settings(): ReportSettings {
    return { input: this._input, layers: this.chosenLayers, logo: this._logo };
  }

  private readonly onSubmit = (event: Event): void => {
    event.preventDefault();
    const request = reportRequest(this._input, this.chosenLayers, this._logo?.data ?? null);
    this.start((title) => this.session.reports.make(words.job(title), words.ready, request));
  };

  private preview(): void {
    const { settings } = this;
    const show: ShowFile = (pdf, name) => {
      this._preview?.release();
      this._preview = new ReportPreview(pdf, name, settings);
    };
    this.start((title) =>
      this.session.reports.preview(words.preview_job(title), previewRequest(settings), show),
    );
  }

  /** Starts a job with the current settings, if they are valid. */
  private start(make: (title: string) => Promise<number>): void {
    if (!this._file.isFree) return;
    const { model, views } = this.session;
    const problems = problemsIn(this._input, views.all);
    this.tell(problems);
    if (problems.size > 0) return;
    this._sent = this._input;
    const title = this._input.title.trim() || (model?.name ?? "");
    void this._file.make(
      () => make(title),
      () => this.isConnected,
    );
  }
}
