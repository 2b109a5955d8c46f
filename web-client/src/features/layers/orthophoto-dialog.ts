// <strata-orthophoto-dialog>: makes a look of a picture that was taken along an axis.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { name_of_file } from "../../net/api";
import type { MapContents } from "../../core/types";
import "../../ui/dialog";
import "../../ui/file-choice";
import {
  accepted,
  as_uploads,
  file_kind,
  kPictureEndings,
  unknown_file,
  world_numbers,
  type Along,
} from "./map-file";
import {
  crs_in_doubt,
  crs_query,
  crs_question,
  crs_styles,
  focus_question,
  kNotAsked,
  type CrsAnswer,
} from "./map-crs";
import { direction_field, found_line, progress_line, world_field } from "./map-place";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { Sending } from "../../ui/sending";
import { files_styles, form_styles, shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.orthophoto;

@customElement("strata-orthophoto-dialog")
export class StrataOrthophotoDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private files_: readonly File[] = [];
  @state() private contents_: MapContents | null = null;
  @state() private name_ = "";
  @state() private crs_: CrsAnswer = kNotAsked;
  private along_: Along = "-z";
  private world_ = "";
  private readonly sending_ = new Sending(this);

  static override styles = [shared_styles, files_styles, form_styles, crs_styles];

  override render(): TemplateResult {
    const { contents_: contents } = this;
    const crs = crs_in_doubt(contents, this.session.model);
    const asking = crs !== null && this.crs_.asked && this.crs_.taken === null;
    return html`<strata-dialog heading=${words.title} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <form id="orthophoto" @submit=${(event: Event) => this.on_submit(event)}>
        <p class="hint">${words.lead}</p>
        <div class="part">
          <span class="caption">${words.file}</span>
          <strata-file-choice
            multiple
            label=${words.file}
            accept=${accepted(kPictureEndings)}
            .names=${this.files_.map(({ name }) => name)}
            @files=${(event: CustomEvent<File[]>) => void this.on_files(event.detail)}
          ></strata-file-choice>
        </div>
        ${
          contents
            ? html`${found_line(contents)}
              <label class="field">
                <span>${words.name}</span>
                <input
                  type="text"
                  name="name"
                  required
                  maxlength="200"
                  .value=${this.name_}
                  @input=${(event: Event) => (this.name_ = (event.target as HTMLInputElement).value)}
                />
              </label>
              ${direction_field(this.along_, (along) => (this.along_ = along))}
              ${world_field(contents, this.world_, (text) => (this.world_ = text))}`
            : nothing
        }
        ${asking ? crs_question(crs, (takes) => this.on_crs(takes ? crs : null)) : nothing}
        ${this.sending_.problem ? html`<p class="error" role="alert">${this.sending_.problem}</p>` : nothing}
        ${this.sending_.busy ? progress_line(this.sending_.share, texts.maps.looking) : nothing}
      </form>
      <button slot="actions" class="primary" form="orthophoto" ?disabled=${!contents || this.sending_.busy || asking}>${words.add}</button>
    </strata-dialog>`;
  }

  private async on_files(files: File[]): Promise<void> {
    this.sending_.cancel();
    [this.files_, this.contents_, this.crs_] = [files, null, kNotAsked];
    this.sending_.refuse("");
    const names = files.map(({ name }) => name);
    if (file_kind(names) !== "map") {
      this.sending_.refuse(texts.maps.unknown(unknown_file(names)));
      return;
    }
    const { api, model_id } = this.session;
    const contents = await this.sending_.run((progress) =>
      api.map_contents(model_id, {}, as_uploads(files), progress),
    );
    if (!contents || files !== this.files_) return;
    if (contents.kind === "polygons") this.sending_.refuse(words.no_picture);
    else if (!contents.has_colors) this.sending_.refuse(words.no_colors);
    else this.contents_ = contents;
    const picture = files.find(({ name }) => /\.(tiff?|png|jpe?g|zip)$/i.test(name)) ?? files[0]!;
    this.name_ = name_of_file(picture.name);
  }

  private on_submit(event: Event): void {
    event.preventDefault();
    void this.add();
  }

  private on_crs(taken: string | null): void {
    this.crs_ = { asked: taken !== null, taken };
    if (taken !== null) void this.add();
  }

  private async add(): Promise<void> {
    const { session, contents_: contents } = this;
    if (!contents || this.sending_.busy) return;
    const world = contents.world ? "" : world_numbers(this.world_);
    if (world === null) {
      this.sending_.refuse(texts.maps.world_wrong);
      return;
    }
    if (crs_in_doubt(contents, session.model) !== null && this.crs_.taken === null) {
      this.crs_ = { asked: true, taken: null };
      await this.updateComplete;
      focus_question(this.renderRoot);
      return;
    }
    const name = this.name_.trim();
    const query = {
      name,
      along: this.along_,
      ...crs_query(this.crs_),
      ...(world ? { world } : {}),
    };
    const files = as_uploads(this.files_);
    const job = await this.sending_.run((progress) =>
      session.api.add_orthophoto(session.model_id, query, files, progress),
    );
    if (!job) return;
    session.jobs.watch(words.job(name), job, ({ look }) => {
      if (look) session.appearance.show_made(look).catch((error: unknown) => notices.error(error));
    });
    this.dispatchEvent(new CustomEvent("closed"));
  }
}
