// <strata-orthophoto-dialog>: makes a surface image from a picture that was taken along an axis.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { nameOfFile } from "../../domain/file-names";
import type { MapContents } from "../../core/types";
import type { Along } from "../../domain/along";
import "../../ui/dialog";
import "../../ui/file-choice";
import { accepted, fileKind, kPictureEndings, unknownFile, worldNumbers } from "./map-file";
import {
  crsInDoubt,
  crsQuery,
  crsQuestion,
  crsStyles,
  focusQuestion,
  kNotAsked,
  type CrsAnswer,
} from "./map-crs";
import { directionField, foundLine, progressLine, worldField } from "./map-place";
import type { ModelSession } from "../../session/model-session";
import { asUploads } from "../../net/upload";
import { notices } from "../../ui/notices";
import { Sending } from "../../ui/sending";
import { filesStyles, formStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.orthophoto;

@customElement("strata-orthophoto-dialog")
export class StrataOrthophotoDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _files: readonly File[] = [];
  @state() private _contents: MapContents | null = null;
  @state() private _name = "";
  @state() private _crs: CrsAnswer = kNotAsked;
  private _along: Along = "-z";
  private _world = "";
  private readonly _sending = new Sending(this);

  static override styles = [sharedStyles, filesStyles, formStyles, crsStyles];

  override render(): TemplateResult {
    const { _contents: contents } = this;
    const crs = crsInDoubt(contents, this.session.model);
    const asking = crs !== null && this._crs.asked && this._crs.taken === null;
    return html`<strata-dialog heading=${words.title} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <form id="orthophoto" @submit=${(event: Event) => this.onSubmit(event)}>
        <p class="hint">${words.lead}</p>
        <div class="part">
          <span class="caption">${words.file}</span>
          <strata-file-choice
            multiple
            label=${words.file}
            accept=${accepted(kPictureEndings)}
            .names=${this._files.map(({ name }) => name)}
            @files=${(event: CustomEvent<File[]>) => void this.onFiles(event.detail)}
          ></strata-file-choice>
        </div>
        ${
          contents
            ? html`${foundLine(contents)}
              <label class="field">
                <span>${words.name}</span>
                <input
                  type="text"
                  name="name"
                  required
                  maxlength="200"
                  .value=${this._name}
                  @input=${(event: Event) => (this._name = (event.target as HTMLInputElement).value)}
                />
              </label>
              ${directionField(this._along, (along) => (this._along = along))}
              ${worldField(contents, this._world, (text) => (this._world = text))}`
            : nothing
        }
        ${asking ? crsQuestion(crs, (takes) => this.onCrs(takes ? crs : null)) : nothing}
        ${this._sending.problem ? html`<p class="error" role="alert">${this._sending.problem}</p>` : nothing}
        ${this._sending.busy ? progressLine(this._sending.share, texts.maps.looking) : nothing}
      </form>
      <button slot="actions" class="primary" form="orthophoto" ?disabled=${!contents || this._sending.busy || asking}>${words.add}</button>
    </strata-dialog>`;
  }

  private async onFiles(files: File[]): Promise<void> {
    this._sending.cancel();
    [this._files, this._contents, this._crs] = [files, null, kNotAsked];
    this._sending.refuse("");
    const names = files.map(({ name }) => name);
    if (fileKind(names) !== "map") {
      this._sending.refuse(texts.maps.unknown(unknownFile(names)));
      return;
    }
    const { api, modelId } = this.session;
    const contents = await this._sending.run((progress) =>
      api.upload(
        "POST /models/{model}/map-contents",
        { path: { model: modelId } },
        asUploads(files),
        progress,
        true,
      ),
    );
    if (!contents || files !== this._files) return;
    if (contents.kind === "polygons") this._sending.refuse(words.no_picture);
    else if (!contents.has_colors) this._sending.refuse(words.no_colors);
    else this._contents = contents;
    const picture = files.find(({ name }) => /\.(tiff?|png|jpe?g|zip)$/i.test(name)) ?? files[0]!;
    this._name = nameOfFile(picture.name);
  }

  private onSubmit(event: Event): void {
    event.preventDefault();
    void this.add();
  }

  private onCrs(taken: string | null): void {
    this._crs = { asked: taken !== null, taken };
    if (taken !== null) void this.add();
  }

  private async add(): Promise<void> {
    const { session, _contents: contents } = this;
    if (!contents || this._sending.busy) return;
    const world = contents.world ? "" : worldNumbers(this._world);
    if (world === null) {
      this._sending.refuse(texts.maps.world_wrong);
      return;
    }
    if (crsInDoubt(contents, session.model) !== null && this._crs.taken === null) {
      this._crs = { asked: true, taken: null };
      await this.updateComplete;
      focusQuestion(this.renderRoot);
      return;
    }
    const name = this._name.trim();
    const query = {
      name,
      along: this._along,
      ...crsQuery(this._crs),
      ...(world ? { world } : {}),
    };
    const files = asUploads(this._files);
    const job = await this._sending.run((progress) =>
      session.api.upload(
        "POST /models/{model}/orthophotos",
        { path: { model: session.modelId }, query },
        files,
        progress,
        true,
      ),
    );
    if (!job) return;
    session.jobs.watch(words.job(name), job, ({ look }) => {
      if (look) session.appearance.showMade(look).catch((error: unknown) => notices.error(error));
    });
    this.dispatchEvent(new CustomEvent("closed"));
  }
}
