// <strata-map-dialog>: paints a layer from files: readings and vertex values (CSV), area maps,
// rasters, orthophotos, scanned maps.

import type { Query } from "../../net/calls";
import { asUploads } from "../../net/upload";
import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { labelOf } from "../../domain/cells";
import { formatList, readNumber } from "../../core/locale";
import { formatArea } from "../../domain/measure";
import type { EditResult } from "../../core/protocol.gen";
import type { Layer, MapContents } from "../../core/types";
import type { Along } from "../../domain/along";
import "../../ui/dialog";
import "../../ui/file-choice";
import { followSession } from "../../session/follow-session";
import "./map-colors";
import {
  crsInDoubt,
  crsQuery,
  crsQuestion,
  crsStyles,
  focusQuestion,
  kNotAsked,
  type CrsAnswer,
} from "./map-crs";
import {
  accepted,
  colorKeys,
  colorRows,
  fileKind,
  kMapEndings,
  kTableEndings,
  pictureModes,
  tableKind,
  unknownFile,
  worldNumbers,
  type ColorRow,
  type PictureMode,
} from "./map-file";
import { directionField, foundLine, progressLine, worldField } from "./map-place";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { numberInput } from "../../ui/number-input";
import { radioGroup } from "../../ui/radio-group";
import { Sending, type Begin } from "../../ui/sending";
import { filesStyles, formStyles, numberFieldStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "../../session/fields/value-picker";

const words = texts.maps;
const kFirstLineBytes = 65536;
const kTolerance = { least: 1, most: 60, usual: 12 } as const; // the tolerance of colors

type Kind = "readings" | "vertices" | "polygons" | "picture";

@customElement("strata-map-dialog")
export class StrataMapDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private _files: readonly File[] = [];
  @state() private _kind: Kind | null = null;
  @state() private _contents: MapContents | null = null;
  @state() private _attribute = "";
  @state() private _names = "";
  @state() private _mode: PictureMode = "luminance";
  @state() private _rows: readonly ColorRow[] = [];
  @state() private _painting = false;
  @state() private _crs: CrsAnswer = kNotAsked;
  private _radiusMm = 5;
  private _toleranceMm = 5;
  private _source = "";
  private _along: Along = "-z";
  private _world = "";
  private _band = 1;
  private _tolerance: number = kTolerance.usual;
  private readonly _sending = new Sending(this);

  constructor() {
    super();
    followSession(this, "painting", "layers", "tables");
  }

  static override styles = [
    sharedStyles,
    filesStyles,
    formStyles,
    numberFieldStyles,
    crsStyles,
    css`
      .pair {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(140px, 1fr));
        gap: var(--space-3);
      }
      .short {
        width: 110px;
      }
    `,
  ];

  override render(): TemplateResult {
    const crs = crsInDoubt(this._contents, this.session.model);
    const asking = crs !== null && this._crs.asked && this._crs.taken === null;
    const ready = this._kind !== null && !this._sending.busy && !asking;
    return html`<strata-dialog heading=${words.title(labelOf(this.layer))} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <form id="map" @submit=${(event: Event) => this.onSubmit(event)}>
        <p class="hint">${words.lead}</p>
        <div class="part">
          <span class="caption">${words.file}</span>
          <strata-file-choice
            multiple
            label=${words.file}
            accept=${accepted([...kTableEndings, ...kMapEndings])}
            ?disabled=${this._painting}
            .names=${this._files.map(({ name }) => name)}
            @files=${(event: CustomEvent<File[]>) => void this.onFiles(event.detail)}
          ></strata-file-choice>
        </div>
        ${this._files.length === 0 ? html`<p class="hint">${words.file_hint}</p>` : nothing} ${this.fields()}
        ${asking ? crsQuestion(crs, (takes) => this.onCrs(takes ? crs : null)) : nothing}
        ${this._sending.problem ? html`<p class="error" role="alert">${this._sending.problem}</p>` : nothing}
        ${this._sending.busy ? progressLine(this._sending.share, this._painting ? words.working : words.looking) : nothing}
      </form>
      <button slot="actions" class="primary" form="map" ?disabled=${!ready}>${words.paint}</button>
    </strata-dialog>`;
  }

  private fields(): TemplateResult | typeof nothing {
    const { _contents: contents } = this;
    if (this._kind === "readings") return this.readings();
    if (this._kind === "vertices") return this.vertices();
    if (!contents) return nothing;
    return html`${foundLine(contents)} ${directionField(this._along, (along) => (this._along = along))}
    ${contents.kind === "polygons" ? this.polygons(contents) : this.picture(contents)}`;
  }

  // ── tables ─────────────────────────────────────────────────────────────────────────────────────

  private readings(): TemplateResult {
    const length = (label: string, value: number, set: (mm: number) => void): TemplateResult =>
      html`<label class="field">
        <span>${label}</span>
        <span class="number">
          ${numberInput({ value, min: 0, changed: (text) => set(readNumber(text)) })}
          <span>mm</span>
        </span>
      </label>`;
    return html`<p class="hint">${words.readings_hint}</p>
      <div class="pair">
        ${length(words.radius, this._radiusMm, (mm) => (this._radiusMm = mm))}
        ${length(words.tolerance, this._toleranceMm, (mm) => (this._toleranceMm = mm))}
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
            <select name="source" @change=${(event: Event) => (this._source = (event.target as HTMLSelectElement).value)}>
              ${this.sources.map((name) => html`<option value=${name} ?selected=${name === this._source}>${name}</option>`)}
            </select>
          </label>`
          : nothing
      }`;
  }

  // ── maps ───────────────────────────────────────────────────────────────────────────────────────

  private polygons({ columns = [] }: MapContents): TemplateResult {
    const { session, layer } = this;
    const hasNames = layer.palette.mode === "categorical";
    const usable = columns.filter(({ type }) => type !== "mixed");
    const chosen = usable.find(({ name }) => name === this._attribute);
    const nameColumns = columns.filter(
      ({ type, name }) => type === "text" && name !== chosen?.name,
    );
    const option = (value: string, label: string, now: string): TemplateResult =>
      html`<option value=${value} ?selected=${value === now}>${label}</option>`;
    return html`<label class="field">
        <span>${words.attribute}</span>
        <select name="attribute" @change=${(event: Event) => (this._attribute = (event.target as HTMLSelectElement).value)}>
          ${option("", words.one_value, this._attribute)}
          ${usable.map(({ name, type }) =>
            option(
              name,
              type === "number" ? words.attribute_number(name) : words.attribute_text(name),
              this._attribute,
            ),
          )}
        </select>
      </label>
      ${chosen && chosen.samples.length > 0 ? html`<p class="hint">${words.samples(formatList(chosen.samples.slice(0, 6)))}</p>` : nothing}
      ${chosen?.type === "text" ? html`<p class="hint">${hasNames ? words.names_become : words.names_need_legend}</p>` : nothing}
      ${
        chosen?.type === "number" && hasNames && nameColumns.length > 0
          ? html`<label class="field">
            <span>${words.names}</span>
            <select name="names" @change=${(event: Event) => (this._names = (event.target as HTMLSelectElement).value)}>
              ${option("", words.no_names, this._names)} ${nameColumns.map(({ name }) => option(name, name, this._names))}
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
            .value=${session.painting.brush.valueFor(layer)}
          ></strata-value-picker>`
      }`;
  }

  private picture(contents: MapContents): TemplateResult {
    const modes = pictureModes(contents);
    return html`${worldField(contents, this._world, (text) => (this._world = text))}
      <div class="part">
        <span class="caption" id="gives">${words.picture_gives}</span>
        ${radioGroup({
          label: { id: "gives" },
          class: "segments",
          choices: modes.map((mode) => ({
            value: mode,
            content: words.modes[mode],
            title: words.mode_hints[mode],
          })),
          chosen: this._mode,
          choose: (mode) => (this._mode = mode),
        })}
        <p class="hint">${words.mode_hints[this._mode]}</p>
      </div>
      ${this._mode === "band" && (contents.bands ?? 1) > 1 ? this.band(contents.bands!) : nothing}
      ${this._mode === "colors" ? this.colors() : nothing}`;
  }

  private band(bands: number): TemplateResult {
    return html`<label class="field">
      <span>${words.band}</span>
      <span class="short">${numberInput({ name: "band", value: this._band, min: 1, max: bands, changed: (text) => (this._band = readNumber(text)) })}</span>
    </label>`;
  }

  private colors(): TemplateResult {
    return html`<strata-map-colors
        .layer=${this.layer}
        .rows=${this._rows}
        @rows=${(event: CustomEvent<ColorRow[]>) => (this._rows = event.detail)}
      ></strata-map-colors>
      <label class="field">
        <span>${words.color_tolerance}</span>
        <span class="short">
          ${numberInput({
            name: "tolerance",
            title: words.color_tolerance_hint,
            value: this._tolerance,
            min: kTolerance.least,
            max: kTolerance.most,
            changed: (text) => void this.onTolerance(readNumber(text)),
          })}
        </span>
      </label>`;
  }

  // ── actions ────────────────────────────────────────────────────────────────────────────────────

  private async onFiles(files: File[]): Promise<void> {
    this._sending.cancel();
    [this._files, this._kind, this._contents, this._attribute, this._names] = [
      files,
      null,
      null,
      "",
      "",
    ];
    this._crs = kNotAsked;
    this._sending.refuse("");
    const names = files.map(({ name }) => name);
    const kind = fileKind(names);
    if (kind === null) {
      this._sending.refuse(words.unknown(unknownFile(names)));
    } else if (kind === "table") {
      const read = tableKind(await files[0]!.slice(0, kFirstLineBytes).text());
      if (files === this._files) this._kind = read;
      this._source = this.sources[0] ?? "";
    } else {
      await this.look();
    }
  }

  /** Requests the contents of the files from the server. */
  private async look(): Promise<void> {
    const { _files: files, session } = this;
    const query = { tolerance: this._tolerance };
    const contents = await this._sending.run((progress) =>
      session.api.upload(
        "POST /models/{model}/map-contents",
        { path: { model: session.modelId }, query },
        asUploads(files),
        progress,
        true,
      ),
    );
    if (!contents || files !== this._files) return;
    this._contents = contents;
    this._kind = contents.kind;
    if (contents.kind === "picture") {
      const modes = pictureModes(contents);
      if (!modes.includes(this._mode) || this._rows.length === 0)
        this._mode = modes[0] ?? "luminance";
      const { mode, points } = this.layer.palette;
      this._rows = colorRows(
        contents.colors ?? [],
        mode === "categorical" ? points.map(({ at }) => at) : [],
      );
    }
  }

  private async onTolerance(tolerance: number): Promise<void> {
    if (!(tolerance >= kTolerance.least && tolerance <= kTolerance.most)) {
      this._sending.refuse(words.bad_tolerance(kTolerance.least, kTolerance.most));
      return;
    }
    this._tolerance = tolerance;
    await this.look();
  }

  private onSubmit(event: Event): void {
    event.preventDefault();
    void this.apply();
  }

  /** Returns the request, or a text about missing input. */
  private request(kind: Kind): Begin<EditResult> | string {
    const { api, modelId } = this.session;
    const path = { model: modelId, layer: this.layer.id };
    const files = asUploads(this._files);
    switch (kind) {
      case "vertices": {
        const query = this.sources.length > 1 ? { source: this._source } : {};
        return (progress) =>
          api.upload(
            "PUT /models/{model}/layers/{layer}/vertices.csv",
            { path, query },
            files.slice(0, 1),
            progress,
          );
      }
      case "readings": {
        const query = { radius_mm: this._radiusMm, tolerance_mm: this._toleranceMm };
        return (progress) =>
          api.upload(
            "POST /models/{model}/layers/{layer}/readings",
            { path, query },
            files,
            progress,
            false,
          );
      }
      // the names of map files identify their parts, so they are sent as a form
      case "polygons": {
        const query = this.polygonsQuery();
        return (progress) =>
          api.upload(
            "POST /models/{model}/layers/{layer}/polygons",
            { path, query },
            files,
            progress,
            true,
          );
      }
      case "picture": {
        const query = this.pictureQuery();
        if (typeof query === "string") return query;
        return (progress) =>
          api.upload(
            "POST /models/{model}/layers/{layer}/picture",
            { path, query },
            files,
            progress,
            true,
          );
      }
    }
  }

  private polygonsQuery(): Query<"POST /models/{model}/layers/{layer}/polygons"> {
    const along = { along: this._along, ...crsQuery(this._crs) };
    if (this._attribute === "")
      return { ...along, value: this.session.painting.brush.valueFor(this.layer) };
    return {
      ...along,
      attribute: this._attribute,
      ...(this._names ? { names: this._names } : {}),
    };
  }

  private pictureQuery(): Query<"POST /models/{model}/layers/{layer}/picture"> | string {
    const world = this._contents?.world ? undefined : worldNumbers(this._world);
    if (world === null) return words.world_wrong;
    const placed = {
      along: this._along,
      ...crsQuery(this._crs),
      ...(world === undefined ? {} : { world }),
    };
    if (this._mode === "luminance") return placed;
    if (this._mode === "band") return { ...placed, band: this._band };
    const colors = colorKeys(this._rows);
    return colors === null ? words.colors_wrong : { ...placed, colors, tolerance: this._tolerance };
  }

  private onCrs(taken: string | null): void {
    this._crs = { asked: taken !== null, taken };
    if (taken !== null) void this.apply();
  }

  private async apply(): Promise<void> {
    if (!this._kind || this._sending.busy) return;
    const request = this.request(this._kind);
    if (typeof request === "string") {
      this._sending.refuse(request);
      return;
    }
    if (crsInDoubt(this._contents, this.session.model) !== null && this._crs.taken === null) {
      this._crs = { asked: true, taken: null };
      await this.updateComplete;
      focusQuestion(this.renderRoot);
      return;
    }
    this._painting = true;
    this._sending.givesUp = false; // closing the dialog does not cancel the request
    const done = await this._sending.run(request);
    this._painting = false;
    this._sending.givesUp = true;
    if (!done) return;
    if (done.texels_changed === 0) notices.show("info", texts.areas.nothing_changed);
    else notices.show("success", texts.areas.changed(formatArea(done.area_m2)));
    this.dispatchEvent(new CustomEvent("closed"));
  }
}
