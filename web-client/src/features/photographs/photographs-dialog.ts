// <strata-photographs-dialog>: the photographs that see a place of the model, next to the 3D view.
// Curators also import camera poses and images. Its event `opened` contains a photograph to show.

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
import { Sending } from "../../ui/sending";
import { formStyles, sharedStyles } from "../../ui/styles";
import { PictureImport } from "./picture-import";
import { photographsOf } from "./photographs-of";

const words = texts.photographs;
const kThumbnail = 256;
const kPoseEndings = ".xml,.csv,.xmp,.txt,.bin,.out,.zip";
const kPictureTypes = "image/jpeg,image/png,image/tiff";
const kMostRefused = 20; // listed reasons

/** Returns the last part of a name with folders. */
const shortName = (name: string): string => name.slice(name.search(/[^/\\]*$/));

@customElement("strata-photographs-dialog")
export class StrataPhotographsDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _report: PosesReport | null = null;
  private readonly _poses = new Sending(this);
  private _pictures!: PictureImport;
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
    photographsOf(this.session).close();
  }

  override render(): TemplateResult {
    const photographs = photographsOf(this.session);
    const { counts } = photographs;
    return html`<strata-dialog docked heading=${words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${counts?.total === 0 ? html`<p>${this.session.canCurate ? words.none_yet : words.none}</p>` : this.found()}
      ${photographs.problem ? html`<p class="error" role="alert">${photographs.problem}</p>` : nothing}
      ${this.session.canCurate ? this.import() : nothing}
      ${counts && counts.total > 0 ? html`<p class="hint">${words.counts(counts.total, counts.pictures)}</p>` : nothing}
    </strata-dialog>`;
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
              ${found.photographs.map((each) => html`<li>${this.photograph(each)}</li>`)}
            </ul>`
          : nothing
      }
      ${found && found.unknown_size > 0 ? html`<p class="hint">${words.unknown_size(found.unknown_size)}</p>` : nothing}`;
  }

  private photograph({ photograph, mm_per_pixel: mm, angle }: SeeingPhotograph): TemplateResult {
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
      <small class="hint">${words.quality(formatNumber(mm, 2), formatCount(Math.round(angle)))}</small>
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
    if (this._report) photographsOf(this.session).readAgain();
  }

  private async addPictures(files: File[]): Promise<void> {
    const stored = await this._pictures.send(files);
    if (stored > 0) notices.show("success", words.stored(stored));
    if (this.isConnected) photographsOf(this.session).readAgain();
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
      photographsOf(this.session).readAgain();
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
