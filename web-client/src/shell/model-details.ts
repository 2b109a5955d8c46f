// <strata-about-sheet>: information about the model, its files, and the roles that can download
// them.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { upName } from "../math/camera";
import { formatCount } from "../core/locale";
import {
  detailChoices,
  formatArea,
  formatBytes,
  formatLength,
  formatSize,
  metresPer,
  typedNorth,
} from "../domain/measure";
import { toldSurveyDate } from "../domain/surveys";
import { mayDownload, type Model, type Role } from "../core/types";
import type { ModelSession } from "../session/model-session";
import "../features/deposits/citation";
import "../features/home/points-surface";
import "../features/surveys/survey-fields";
import "../ui/dialog";
import { sharedStyles } from "../ui/styles";
import { texts } from "../texts";
import { detailStyles } from "./detail-styles";

const kDownloaders = ["viewer", "annotator", "curator"] as const;

/** Describes the open edges. Empty for models that an earlier release imported. */
function openEdgesText({ open_edges: edges }: Model): string {
  const words = texts.model.details_list;
  if (!edges) return "";
  if (edges.loops === 0) return words.closed_surface;
  return words.loops(edges.loops, formatLength(edges.length_m), formatLength(edges.longest_m[0]!));
}

/** The direction of north in degrees, or as another program wrote it. */
const northText = (model: Model): string =>
  Number.isNaN(Number(model.north)) ? model.north : model.north && `${typedNorth(model)}°`;

@customElement("strata-about-sheet")
export class StrataModelDetails extends LitElement {
  @property({ attribute: false }) model!: Model;
  @property() viewer: Role = "guest"; // the user's role
  /**
   * Whether the user can correct the model's unit and up direction, and set the role for downloads.
   */
  @property({ type: Boolean }) correctable = false;

  @property({ attribute: false }) session!: ModelSession;

  static override styles = [sharedStyles, detailStyles];

  override render(): TemplateResult {
    const { model } = this;
    const words = texts.model.details_list;
    const metres = metresPer(model.unit);
    const sides = [0, 1, 2].map(
      (axis) => (model.bounds.max[axis]! - model.bounds.min[axis]!) * metres,
    );
    const detail = detailChoices(model.atlas).find(
      (choice) => choice.resolution === model.default_resolution,
    );
    const rows: [string, string][] = [
      [words.size, formatSize(sides)],
      [words.area, formatArea(model.area_m2)],
      [words.triangles, formatCount(model.triangles)],
      [words.up, upName(model.up)],
      [words.north, northText(model)],
      [words.smallest, detail ? formatLength(detail.detailM) : ""],
      [words.crs, model.crs],
      [words.inventory_number, model.inventory_number],
      [words.owner, model.owner],
      [words.creator, model.creator],
      [words.captured, model.captured],
      [texts.surveys.object, this.session.surveys.object?.name ?? ""],
      [texts.surveys.date, model.survey_date ? toldSurveyDate(model.survey_date) : ""],
      [words.rights, model.rights_uri],
      [words.credit, model.credit],
      [words.open_edges, openEdgesText(model)],
      [
        words.repairs,
        model.repairs.map((repair) => `${repair.what}: ${formatCount(repair.count)}`).join("; "),
      ],
    ];
    return html`<strata-dialog wide prose heading=${model.name} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <dl>
        ${rows.map(([name, value]) => (value ? html`<dt>${name}</dt><dd>${value}</dd>` : nothing))}
        ${
          model.source_files.length > 0
            ? html`<dt>${words.files}</dt>
              <dd>
                ${model.source_files.map(
                  (file) =>
                    html`<div>
                      ${
                        mayDownload(this.viewer, model)
                          ? html`<a class="text" href="/api/v1/models/${model.id}/source/${encodeURIComponent(file.name)}" download=${file.name}>${file.name}</a>`
                          : file.name
                      }
                      <span class="hint">${formatBytes(file.bytes)}</span>
                    </div>`,
                )}
                ${mayDownload(this.viewer, model) ? nothing : html`<p class="hint">${texts.visibility.no_download}</p>`}
              </dd>`
            : nothing
        }
        ${
          model.from_points
            ? html`<dt>${texts.points.heading}</dt>
                <dd><strata-points-surface .session=${this.session}></strata-points-surface></dd>`
            : nothing
        }
        <dt>${texts.deposit.citation}</dt>
        <dd><strata-citation .api=${this.session.api} project=${model.project}></strata-citation></dd>
      </dl>
      ${
        this.correctable
          ? html`<strata-survey-fields .session=${this.session} .model=${model}></strata-survey-fields>
            ${this.downloadChoice()}`
          : nothing
      }
      ${
        this.correctable
          ? html`<button slot="actions" @click=${() => this.dispatchEvent(new CustomEvent("deposit"))}>
              ${texts.deposit.open}
            </button>
            <button slot="actions" @click=${() => this.dispatchEvent(new CustomEvent("correct"))}>
              ${texts.model.correct_size}
            </button>`
          : nothing
      }
    </strata-dialog>`;
  }

  private downloadChoice(): TemplateResult {
    const words = texts.visibility;
    return html`<label class="field">
      <span>${words.download}</span>
      <select @change=${(event: Event) => this.dispatchEvent(new CustomEvent("download-for", { detail: (event.target as HTMLSelectElement).value }))}>
        ${kDownloaders.map((role) => html`<option value=${role} ?selected=${role === this.model.source_download}>${words.download_roles[role]}</option>`)}
      </select>
    </label>`;
  }
}
