// <strata-photographs-dialog>: the photographs that see a place of the model, or all of them, next to
// the 3D view. Curators also import camera poses and images. Its event `opened` contains a photograph to show.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { formatCount } from "../../core/locale";
import type { Photograph, PosesReport, SeeingPhotograph } from "../../core/protocol.gen";
import { formatNumber } from "../../domain/measure";
import { asUploads } from "../../net/upload";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { texts } from "../../texts";
import { ask } from "../../ui/dialog";
import "../../ui/file-choice";
import { icon } from "../../ui/icons";
import { notices } from "../../ui/notices";
import { radioGroup } from "../../ui/radio-group";
import { Sending } from "../../ui/sending";
import { formStyles, sharedStyles } from "../../ui/styles";
import { PhotographList } from "./photograph-list";
import { PictureImport } from "./picture-import";
import { photographsOf } from "./photographs-of";

const words = texts.photographs;
const kThumbnail = 256;
const kPoseEndings = ".xml,.csv,.xmp,.txt,.bin,.out,.zip";
const kPictureTypes = "image/jpeg,image/png,image/tiff";
const kMostRefused = 20; // listed reasons
const kSearchAfterMs = 250;
const kMostSearched = 200; // characters, as in the contract

/** Returns the last part of a name with folders. */
const shortName = (name: string): string => name.slice(name.search(/[^/\\]*$/));

const qualityOf = ({ mm_per_pixel: mm, angle }: SeeingPhotograph): string =>
  words.quality(formatNumber(mm, 2), formatCount(Math.round(angle)));

@customElement("strata-photographs-dialog")
export class StrataPhotographsDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _report: PosesReport | null = null;
  private readonly _poses = new Sending(this);
  private _pictures!: PictureImport;
  private _all: PhotographList | null = null; // while all photographs are listed
  private _timer = 0;
  private _imports = false; // whether the fields for the import are open

  constructor() {
    super();
    followSession(this, "photographs");
  }

  static override styles = [
    sharedStyles,
    formStyles,
    css`
      ul.found {
        display: grid;
        grid-template-columns: repeat(auto-fill, minmax(8.5rem, 1fr));
        gap: var(--space-3);
        margin: 0;
        padding: 0;
        list-style: none;
      }
      .found button {
        display: grid;
        gap: var(--space-1);
        width: 100%;
        height: auto;
        padding: var(--space-1);
        text-align: left;
        white-space: normal;
      }
      .found img,
      .found .empty {
        width: 100%;
        aspect-ratio: 4 / 3;
        object-fit: cover;
        border-radius: var(--radius-tiny);
        background: var(--stage);
      }
      .found .empty {
        display: grid;
        place-items: center;
        padding: var(--space-2);
        font-size: var(--text-tiny);
        color: var(--on-stage);
      }
      .found small {
        overflow-wrap: anywhere;
      }
      details > * {
        margin-block: var(--space-3);
      }
      .refused {
        max-height: 10rem;
        overflow: auto;
        margin: 0;
        padding-left: var(--space-4);
        font-size: var(--text-small);
      }
      .running {
        display: flex;
        align-items: center;
        gap: var(--space-3);
      }
      .running progress {
        flex: 1;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    const { session } = this;
    this._pictures = new PictureImport(session.api, session.modelId, () => this.requestUpdate());
    photographsOf(session).open();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._pictures.stop();
    this.listPlace();
    photographsOf(this.session).close();
  }

  override render(): TemplateResult {
    const photographs = photographsOf(this.session);
    const { counts } = photographs;
    return html`<strata-dialog docked heading=${words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${counts?.total === 0 ? html`<p>${this.session.canCurate ? words.none_yet : words.none}</p>` : this.list()}
      ${photographs.problem ? html`<p class="error" role="alert">${photographs.problem}</p>` : nothing}
      ${this.session.canCurate ? this.import() : nothing}
      ${counts && counts.total > 0 ? html`<p class="hint">${words.counts(counts.total, counts.pictures)}</p>` : nothing}
    </strata-dialog>`;
  }

  private list(): TemplateResult {
    const all = this._all;
    return html`${radioGroup({
      label: words.which,
      class: "segments",
      choices: [
        { value: false, content: words.of_place },
        { value: true, content: words.all },
      ],
      chosen: all !== null,
      choose: (chosen) => (chosen ? this.listAll() : this.listPlace()),
    })}
    ${all ? this.all(all) : this.found()}`;
  }

  private listAll(): void {
    const { api, modelId } = this.session;
    this._all ??= new PhotographList(api, modelId, () => this.requestUpdate());
    void this._all.choose("", false);
  }

  private listPlace(): void {
    clearTimeout(this._timer);
    this._all?.stop();
    this._all = null;
    this.requestUpdate();
  }

  private all(all: PhotographList): TemplateResult {
    const search = (event: Event): void => {
      const text = (event.target as HTMLInputElement).value.trim();
      clearTimeout(this._timer);
      this._timer = window.setTimeout(() => void all.choose(text, all.missing), kSearchAfterMs);
    };
    const onlyMissing = (event: Event): void =>
      void all.choose(all.text, (event.target as HTMLInputElement).checked);
    return html`<label class="field">
        <span>${words.search}</span>
        <input type="search" maxlength=${kMostSearched} @input=${search} />
      </label>
      <label class="check"><input type="checkbox" .checked=${all.missing} @change=${onlyMissing} /> ${words.only_missing}</label>
      <p role="status">${all.total === null ? texts.loading : words.listed(all.total)}</p>
      ${all.problem ? html`<p class="error" role="alert">${all.problem}</p>` : nothing}
      <ul class="found" aria-label=${words.all}>
        ${all.photographs.map((each) => html`<li>${this.photograph(each)}</li>`)}
      </ul>
      ${all.hasMore ? html`<div><button ?disabled=${all.isLoading} @click=${() => void all.readMore()}>${words.more}</button></div>` : nothing}`;
  }

  private found(): TemplateResult {
    const photographs = photographsOf(this.session);
    const { found } = photographs;
    return html`<p class="hint">${words.how}</p>
      <div><button @click=${() => photographs.lookAtMiddle()}>${icon("pick")}${words.middle}</button></div>
      <p role="status">
        ${photographs.isSearching && !found ? words.searching : found ? (found.position ? words.seen_by(found.total) : words.no_place) : ""}
      </p>
      ${
        found
          ? html`<ul class="found" aria-label=${words.title}>
              ${found.photographs.map((each) => html`<li>${this.photograph(each.photograph, qualityOf(each))}</li>`)}
            </ul>`
          : nothing
      }
      ${found && found.unknown_size > 0 ? html`<p class="hint">${words.unknown_size(found.unknown_size)}</p>` : nothing}`;
  }

  private photograph(photograph: Photograph, quality = ""): TemplateResult {
    const { api, modelId } = this.session;
    const path = { model: modelId, photograph: photograph.id };
    const open = (): boolean =>
      this.dispatchEvent(new CustomEvent<Photograph>("opened", { detail: photograph }));
    return html`<button class="quiet" ?disabled=${!photograph.has_picture} title=${photograph.name} @click=${open}>
      ${
        photograph.has_picture
          ? html`<img
              loading="lazy"
              src=${api.url("GET /models/{model}/photographs/{photograph}/picture", { path, query: { thumbnail: kThumbnail } })}
              alt=""
            />`
          : html`<span class="empty">${words.no_picture}</span>`
      }
      <small>${shortName(photograph.name)}</small>
      ${quality ? html`<small class="hint">${quality}</small>` : nothing}
    </button>`;
  }

  private import(): TemplateResult {
    const pictures = this._pictures;
    const busy = this._poses.busy || pictures.isRunning;
    const counts = photographsOf(this.session).counts;
    this._imports ||= counts?.total === 0; // stays open after the first import
    return html`<details
      ?open=${this._imports}
      @toggle=${(event: Event) => (this._imports = (event.target as HTMLDetailsElement).open)}
    >
      <summary>${words.import}</summary>
      <p class="hint">${words.import_lead}</p>
      <div class="field"><span>${words.poses}</span>
      <strata-file-choice
        multiple
        label=${words.poses}
        accept=${kPoseEndings}
        ?disabled=${busy}
        @files=${(event: CustomEvent<File[]>) => void this.importPoses(event.detail)}
      ></strata-file-choice>
      </div>
      ${this._poses.busy ? html`<p role="status">${words.reading_poses}</p>` : nothing}
      ${this._poses.problem ? html`<p class="error" role="alert">${this._poses.problem}</p>` : nothing}
      ${this._report ? this.report(this._report) : nothing}
      <div class="field"><span>${words.pictures}</span>
      <strata-file-choice
        multiple
        label=${words.pictures}
        accept=${kPictureTypes}
        ?disabled=${busy || !counts || counts.total === 0}
        @files=${(event: CustomEvent<File[]>) => void this.addPictures(event.detail)}
      ></strata-file-choice>
      </div>
      ${
        pictures.isRunning
          ? html`<div class="running" role="status">
              <progress max=${pictures.total} value=${pictures.done} aria-label=${words.pictures}></progress>
              <span>${words.sent(pictures.done, pictures.total)}</span>
              <button @click=${() => pictures.stop()}>${texts.cancel}</button>
            </div>`
          : nothing
      }
      ${this.refused(pictures.refused, pictures.refused.length)}
      ${counts && counts.total > 0 ? html`<div><button class="danger" ?disabled=${busy} @click=${() => void this.deleteAll()}>${icon("trash")}${words.delete_all}</button></div>` : nothing}
    </details>`;
  }

  private report(report: PosesReport): TemplateResult {
    const leftOut = report.without_pose + report.in_other_components;
    return html`<p role="status">${words.imported(report.added, report.updated)} ${leftOut > 0 ? words.without_pose(leftOut) : ""}</p>
      ${this.refused(report.refused, report.refused_total)}`;
  }

  private refused(
    refused: readonly { name: string; reason: string }[],
    total: number,
  ): TemplateResult | typeof nothing {
    if (total === 0) return nothing;
    return html`<p class="error" role="alert">${words.refused(total)}</p>
      <ul class="refused" tabindex="0" aria-label=${words.refused(total)}>
        ${refused.slice(0, kMostRefused).map(({ name, reason }) => html`<li><b>${shortName(name)}</b>: ${reason}</li>`)}
      </ul>`;
  }

  private readAgain(): void {
    photographsOf(this.session).readAgain();
    const all = this._all;
    if (all) void all.choose(all.text, all.missing);
  }

  private async importPoses(files: File[]): Promise<void> {
    const { api, modelId } = this.session;
    const [first] = files;
    this._report = null;
    this._report = await this._poses.run((progress) =>
      api.upload(
        "POST /models/{model}/photograph-poses",
        { path: { model: modelId }, query: files.length === 1 ? { filename: first!.name } : {} },
        asUploads(files),
        progress,
      ),
    );
    if (this._report) this.readAgain();
  }

  private async addPictures(files: File[]): Promise<void> {
    const stored = await this._pictures.send(files);
    if (stored > 0) notices.show("success", words.stored(stored));
    if (this.isConnected) this.readAgain();
  }

  private async deleteAll(): Promise<void> {
    const { api, modelId } = this.session;
    const total = photographsOf(this.session).counts?.total ?? 0;
    const sure = await ask({
      heading: words.delete_title(total),
      lead: words.delete_lead,
      yes: texts.delete,
    });
    if (!sure) return;
    try {
      await api.send("DELETE /models/{model}/photographs", { path: { model: modelId } });
      this._report = null;
      this.readAgain();
    } catch (error) {
      notices.error(error);
    }
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-photographs-dialog": StrataPhotographsDialog;
  }
}
