// <strata-map-dialog>: paints a layer from files: readings and vertex values (CSV), maps of areas,
// rasters, orthophotos, scanned maps.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { label_of } from "../../domain/cells";
import { format_list, read_number } from "../../core/locale";
import { format_area } from "../../domain/measure";
import type { EditResult } from "../../core/protocol.gen";
import type { Layer, MapContents } from "../../core/types";
import "../../ui/dialog";
import "../../ui/file-choice";
import { follow_session } from "../../session/follow-session";
import "./map-colors";
import {
  crs_in_doubt,
  crs_query,
  crs_question,
  crs_styles,
  focus_question,
  kNotAsked,
  type CrsAnswer,
} from "./map-crs";
import {
  accepted,
  as_uploads,
  color_keys,
  color_rows,
  file_kind,
  kMapEndings,
  kTableEndings,
  picture_modes,
  table_kind,
  unknown_file,
  world_numbers,
  type Along,
  type ColorRow,
  type PictureMode,
} from "./map-file";
import { direction_field, found_line, progress_line, world_field } from "./map-place";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { number_input } from "../../ui/number-input";
import { radio_group } from "../../ui/radio-group";
import { Sending, type Begin } from "../../ui/sending";
import { files_styles, form_styles, number_field_styles, shared_styles } from "../../ui/styles";
import { texts } from "../../texts";
import "../../session/fields/value-picker";

const words = texts.maps;
const kFirstLine_bytes = 65536;
const kTolerance = { least: 1, most: 60, usual: 12 } as const; // of colours

type Kind = "readings" | "vertices" | "polygons" | "picture";

@customElement("strata-map-dialog")
export class StrataMapDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private files_: readonly File[] = [];
  @state() private kind_: Kind | null = null;
  @state() private contents_: MapContents | null = null;
  @state() private attribute_ = "";
  @state() private names_ = "";
  @state() private mode_: PictureMode = "luminance";
  @state() private rows_: readonly ColorRow[] = [];
  @state() private painting_ = false;
  @state() private crs_: CrsAnswer = kNotAsked;
  private radius_mm_ = 5;
  private tolerance_mm_ = 5;
  private source_ = "";
  private along_: Along = "-z";
  private world_ = "";
  private band_ = 1;
  private tolerance_: number = kTolerance.usual;
  private readonly sending_ = new Sending(this);

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    files_styles,
    form_styles,
    number_field_styles,
    crs_styles,
    css`
      .pair {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(140px, 1fr));
        gap: 12px;
      }
      .short {
        width: 110px;
      }
    `,
  ];

  override render(): TemplateResult {
    const crs = crs_in_doubt(this.contents_, this.session.model);
    const asking = crs !== null && this.crs_.asked && this.crs_.taken === null;
    const ready = this.kind_ !== null && !this.sending_.busy && !asking;
    return html`<strata-dialog heading=${words.title(label_of(this.layer))} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <form id="map" @submit=${(event: Event) => this.on_submit(event)}>
        <p class="hint">${words.lead}</p>
        <div class="part">
          <span class="caption">${words.file}</span>
          <strata-file-choice
            multiple
            label=${words.file}
            accept=${accepted([...kTableEndings, ...kMapEndings])}
            ?disabled=${this.painting_}
            .names=${this.files_.map(({ name }) => name)}
            @files=${(event: CustomEvent<File[]>) => void this.on_files(event.detail)}
          ></strata-file-choice>
        </div>
        ${this.files_.length === 0 ? html`<p class="hint">${words.file_hint}</p>` : nothing} ${this.fields()}
        ${asking ? crs_question(crs, (takes) => this.on_crs(takes ? crs : null)) : nothing}
        ${this.sending_.problem ? html`<p class="error" role="alert">${this.sending_.problem}</p>` : nothing}
        ${this.sending_.busy ? progress_line(this.sending_.share, this.painting_ ? words.working : words.looking) : nothing}
      </form>
      <button slot="actions" class="primary" form="map" ?disabled=${!ready}>${words.paint}</button>
    </strata-dialog>`;
  }

  private fields(): TemplateResult | typeof nothing {
    const { contents_: contents } = this;
    if (this.kind_ === "readings") return this.readings();
    if (this.kind_ === "vertices") return this.vertices();
    if (!contents) return nothing;
    return html`${found_line(contents)} ${direction_field(this.along_, (along) => (this.along_ = along))}
    ${contents.kind === "polygons" ? this.polygons(contents) : this.picture(contents)}`;
  }

  // ── tables
  // ────────────────────────────────────────────────────────────────────────────────────────────────────────

  private readings(): TemplateResult {
    const length = (label: string, value: number, set: (mm: number) => void): TemplateResult =>
      html`<label class="field">
        <span>${label}</span>
        <span class="number">
          ${number_input({ value, min: 0, changed: (text) => set(read_number(text)) })}
          <span>mm</span>
        </span>
      </label>`;
    return html`<p class="hint">${words.readings_hint}</p>
      <div class="pair">
        ${length(words.radius, this.radius_mm_, (mm) => (this.radius_mm_ = mm))}
        ${length(words.tolerance, this.tolerance_mm_, (mm) => (this.tolerance_mm_ = mm))}
      </div>`;
  }

  private get sources(): string[] {
    return (this.session.model?.source_files ?? [])
      .map(({ name }) => name)
      .filter((name) => /\.(ply|obj)$/i.test(name));
  }

  private vertices(): TemplateResult {
    return html`<p class="hint">${words.vertices_hint}</p>
      ${
        this.sources.length > 1
          ? html`<label class="field">
            <span>${words.source}</span>
            <select name="source" @change=${(event: Event) => (this.source_ = (event.target as HTMLSelectElement).value)}>
              ${this.sources.map((name) => html`<option value=${name} ?selected=${name === this.source_}>${name}</option>`)}
            </select>
          </label>`
          : nothing
      }`;
  }

  // ── maps
  // ──────────────────────────────────────────────────────────────────────────────────────────────────────────

  private polygons({ columns = [] }: MapContents): TemplateResult {
    const { session, layer } = this;
    const has_names = layer.palette.mode === "categorical";
    const usable = columns.filter(({ type }) => type !== "mixed");
    const chosen = usable.find(({ name }) => name === this.attribute_);
    const name_columns = columns.filter(
      ({ type, name }) => type === "text" && name !== chosen?.name,
    );
    const option = (value: string, label: string, now: string): TemplateResult =>
      html`<option value=${value} ?selected=${value === now}>${label}</option>`;
    return html`<label class="field">
        <span>${words.attribute}</span>
        <select name="attribute" @change=${(event: Event) => (this.attribute_ = (event.target as HTMLSelectElement).value)}>
          ${option("", words.one_value, this.attribute_)}
          ${usable.map(({ name, type }) =>
            option(
              name,
              type === "number" ? words.attribute_number(name) : words.attribute_text(name),
              this.attribute_,
            ),
          )}
        </select>
      </label>
      ${chosen && chosen.samples.length > 0 ? html`<p class="hint">${words.samples(format_list(chosen.samples.slice(0, 6)))}</p>` : nothing}
      ${chosen?.type === "text" ? html`<p class="hint">${has_names ? words.names_become : words.names_need_legend}</p>` : nothing}
      ${
        chosen?.type === "number" && has_names && name_columns.length > 0
          ? html`<label class="field">
            <span>${words.names}</span>
            <select name="names" @change=${(event: Event) => (this.names_ = (event.target as HTMLSelectElement).value)}>
              ${option("", words.no_names, this.names_)} ${name_columns.map(({ name }) => option(name, name, this.names_))}
            </select>
          </label>`
          : nothing
      }
      ${
        chosen
          ? nothing
          : html`<strata-value-picker
            .session=${session}
            .layer=${layer}
            .value=${session.painting.brush.value_of(layer)}
          ></strata-value-picker>`
      }`;
  }

  private picture(contents: MapContents): TemplateResult {
    const modes = picture_modes(contents);
    return html`${world_field(contents, this.world_, (text) => (this.world_ = text))}
      <div class="part">
        <span class="caption" id="gives">${words.picture_gives}</span>
        ${radio_group({
          label: { id: "gives" },
          class: "segments",
          choices: modes.map((mode) => ({
            value: mode,
            content: words.modes[mode],
            title: words.mode_hints[mode],
          })),
          chosen: this.mode_,
          choose: (mode) => (this.mode_ = mode),
        })}
        <p class="hint">${words.mode_hints[this.mode_]}</p>
      </div>
      ${this.mode_ === "band" && (contents.bands ?? 1) > 1 ? this.band(contents.bands!) : nothing}
      ${this.mode_ === "colors" ? this.colors() : nothing}`;
  }

  private band(bands: number): TemplateResult {
    return html`<label class="field">
      <span>${words.band}</span>
      <span class="short">${number_input({ name: "band", value: this.band_, min: 1, max: bands, changed: (text) => (this.band_ = read_number(text)) })}</span>
    </label>`;
  }

  private colors(): TemplateResult {
    return html`<strata-map-colors
        .layer=${this.layer}
        .rows=${this.rows_}
        @rows=${(event: CustomEvent<ColorRow[]>) => (this.rows_ = event.detail)}
      ></strata-map-colors>
      <label class="field">
        <span>${words.color_tolerance}</span>
        <span class="short">
          ${number_input({
            name: "tolerance",
            title: words.color_tolerance_hint,
            value: this.tolerance_,
            min: kTolerance.least,
            max: kTolerance.most,
            changed: (text) => void this.on_tolerance(read_number(text)),
          })}
        </span>
      </label>`;
  }

  // ── what is done
  // ──────────────────────────────────────────────────────────────────────────────────────────────────

  private async on_files(files: File[]): Promise<void> {
    this.sending_.cancel();
    [this.files_, this.kind_, this.contents_, this.attribute_, this.names_] = [
      files,
      null,
      null,
      "",
      "",
    ];
    this.crs_ = kNotAsked;
    this.sending_.refuse("");
    const names = files.map(({ name }) => name);
    const kind = file_kind(names);
    if (kind === null) {
      this.sending_.refuse(words.unknown(unknown_file(names)));
    } else if (kind === "table") {
      const read = table_kind(await files[0]!.slice(0, kFirstLine_bytes).text());
      if (files === this.files_) this.kind_ = read;
      this.source_ = this.sources[0] ?? "";
    } else {
      await this.look();
    }
  }

  /** Asks the server what the files hold. */
  private async look(): Promise<void> {
    const { files_: files, session } = this;
    const query = { tolerance: String(this.tolerance_) };
    const contents = await this.sending_.run((progress) =>
      session.api.map_contents(session.model_id, query, as_uploads(files), progress),
    );
    if (!contents || files !== this.files_) return;
    this.contents_ = contents;
    this.kind_ = contents.kind;
    if (contents.kind === "picture") {
      const modes = picture_modes(contents);
      if (!modes.includes(this.mode_) || this.rows_.length === 0)
        this.mode_ = modes[0] ?? "luminance";
      const { mode, points } = this.layer.palette;
      this.rows_ = color_rows(
        contents.colors ?? [],
        mode === "categorical" ? points.map(({ at }) => at) : [],
      );
    }
  }

  private async on_tolerance(tolerance: number): Promise<void> {
    if (!(tolerance >= kTolerance.least && tolerance <= kTolerance.most)) {
      this.sending_.refuse(words.bad_tolerance(kTolerance.least, kTolerance.most));
      return;
    }
    this.tolerance_ = tolerance;
    await this.look();
  }

  private on_submit(event: Event): void {
    event.preventDefault();
    void this.apply();
  }

  /** The request; a text that says what is missing. */
  private request(kind: Kind): Begin<EditResult> | string {
    const { session, layer } = this;
    const files = as_uploads(this.files_);
    if (kind === "vertices") {
      const source = this.sources.length > 1 ? this.source_ : null;
      return (progress) =>
        session.api.put_vertex_values(session.model_id, layer.id, source, files[0]!, progress);
    }
    const lengths = {
      radius_mm: String(this.radius_mm_),
      tolerance_mm: String(this.tolerance_mm_),
    };
    const query = kind === "readings" ? lengths : this.map_query(kind);
    if (typeof query === "string") return query;
    return (progress) =>
      session.api.paint_map(session.model_id, layer.id, kind, query, files, progress);
  }

  private map_query(kind: "polygons" | "picture"): Record<string, string> | string {
    const along = { along: this.along_, ...crs_query(this.crs_) };
    if (kind === "polygons") {
      const value = String(this.session.painting.brush.value_of(this.layer));
      if (this.attribute_ === "") return { ...along, value };
      return {
        ...along,
        attribute: this.attribute_,
        ...(this.names_ ? { names: this.names_ } : {}),
      };
    }
    const world = this.contents_?.world ? {} : { world: world_numbers(this.world_) };
    if (world.world === null) return words.world_wrong;
    const placed = { ...along, ...(world as Record<string, string>) };
    if (this.mode_ === "luminance") return placed;
    if (this.mode_ === "band") return { ...placed, band: String(this.band_) };
    const colors = color_keys(this.rows_);
    return colors === null
      ? words.colors_wrong
      : { ...placed, colors, tolerance: String(this.tolerance_) };
  }

  private on_crs(taken: string | null): void {
    this.crs_ = { asked: taken !== null, taken };
    if (taken !== null) void this.apply();
  }

  private async apply(): Promise<void> {
    if (!this.kind_ || this.sending_.busy) return;
    const request = this.request(this.kind_);
    if (typeof request === "string") {
      this.sending_.refuse(request);
      return;
    }
    if (crs_in_doubt(this.contents_, this.session.model) !== null && this.crs_.taken === null) {
      this.crs_ = { asked: true, taken: null };
      await this.updateComplete;
      focus_question(this.renderRoot);
      return;
    }
    this.painting_ = true;
    this.sending_.gives_up = false; // closing the dialog does not undo it
    const done = await this.sending_.run(request);
    this.painting_ = false;
    this.sending_.gives_up = true;
    if (!done) return;
    if (done.texels_changed === 0) notices.show("info", texts.areas.nothing_changed);
    else notices.show("success", texts.areas.changed(format_area(done.area_m2)));
    this.dispatchEvent(new CustomEvent("closed"));
  }
}
