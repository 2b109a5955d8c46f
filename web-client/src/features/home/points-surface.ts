// <strata-points-surface>: describes how the surface of a model was made from points, and makes it
// again with other lengths. The result is a new model, because painted values belong to a surface.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { formatCount, readNumber } from "../../core/locale";
import type { ModelPatch } from "../../core/protocol.gen";
import type { Job, Model } from "../../core/types";
import { formatLength, metresPer } from "../../domain/measure";
import { ApiError } from "../../net/api-error";
import { followJob } from "../../net/follow-job";
import { stepOf } from "../../session/layer-jobs";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { numberInput } from "../../ui/number-input";
import { navigate, pathOfModel } from "../../ui/routes";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { tellTrashed } from "../../ui/trash";
import { texts } from "../../texts";

const kLengths = ["cell", "gap"] as const;
type Length = (typeof kLengths)[number];

/** What users may have entered about the model. The new model keeps it. */
const kKept = [
  "north",
  "inventory_number",
  "owner",
  "creator",
  "captured",
  "method",
  "accuracy",
  "processing",
  "rights_uri",
  "credit",
  "source_download",
  "scale_verified",
] as const satisfies readonly (keyof ModelPatch & keyof Model)[];

/** Rounds to three digits, which is more precise than the lengths are. */
const rounded = (value: number): number => Number(value.toPrecision(3));

@customElement("strata-points-surface")
export class StrataPointsSurface extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** Whether the user can make the surface again. */
  @property({ type: Boolean }) changeable = false;
  @state() private _typed: Partial<Record<Length, string>> = {};
  @state() private _wrong: Length | null = null;
  @state() private _problem = "";
  @state() private _job: Job | null = null;

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-2);
      }
      p {
        margin: 0;
      }
      details > :not(summary) {
        margin-top: var(--space-3);
      }
      summary {
        cursor: pointer;
      }
      .length {
        display: flex;
        align-items: center;
        gap: var(--space-2);
      }
      .length input {
        width: 10em;
      }
      .bar {
        height: 0.375rem;
        border-radius: var(--radius-tiny);
        overflow: hidden;
        background: var(--line);
      }
      .bar i {
        display: block;
        height: 100%;
        background: var(--accent);
      }
    `,
  ];

  override render(): TemplateResult | typeof nothing {
    const facts = this.session.model?.from_points;
    if (!facts) return nothing;
    const words = texts.points;
    return html`<p>
        ${words.made(formatCount(facts.points), formatLength(facts.point_spacing_m))}
        ${facts.used < facts.points ? words.thinned(formatCount(facts.used)) : nothing}
        ${words.near(formatLength(facts.distance_median_m), formatLength(facts.distance_95_m))}
      </p>
      ${
        this.changeable
          ? html`<details>
              <summary>${words.again}</summary>
              ${kLengths.map((name) => this.field(name))}
              ${this._problem ? html`<p class="error" role="alert" id="wrong">${this._problem}</p>` : nothing}
              ${this._job ? this.running(this._job) : html`<button type="button" @click=${() => void this.start()}>${words.start}</button>`}
              <p class="hint">${words.result}</p>
            </details>`
          : nothing
      }`;
  }

  private field(name: Length): TemplateResult {
    const model = this.session.model!;
    const words = texts.points.lengths[name];
    return html`<label class="field">
      <span>${words.label}</span>
      <span class="length">
        ${numberInput({
          name,
          value: this._typed[name] ?? this.current(name),
          min: 0,
          wrong: this._wrong === name,
          toldAt: "wrong",
          disabled: this._job !== null,
          typed: (text) => (this._typed = { ...this._typed, [name]: text }),
        })}
        ${model.unit}
      </span>
      <small>${words.hint}</small>
    </label>`;
  }

  private running(job: Job): TemplateResult {
    const share = Math.round(job.progress * 100);
    return html`<p role="status">${stepOf(job, texts.points.running)}</p>
      <div class="bar" role="progressbar" aria-label=${texts.points.running} aria-valuemin="0" aria-valuemax="100" aria-valuenow=${share}>
        <i ${styled({ width: `${share}%` })}></i>
      </div>
      <button type="button" @click=${() => void this.cancel(job)}>${texts.cancel}</button>`;
  }

  /** The length with which the surface was made, in the model's unit. */
  private current(name: Length): number {
    const { from_points: facts, unit } = this.session.model!;
    return rounded(facts![`${name}_m`] / metresPer(unit));
  }

  private lengthOf(name: Length): number {
    const typed = this._typed[name];
    return typed === undefined ? this.current(name) : readNumber(typed);
  }

  private async start(): Promise<void> {
    const { api, model, surveys } = this.session;
    if (!model) return;
    this._wrong = kLengths.find((name) => !(this.lengthOf(name) > 0)) ?? null;
    this._problem = this._wrong ? texts.points.wrong : "";
    if (this._wrong) return;
    const object = model.survey_date ? surveys.object?.name : undefined;
    try {
      const first = await api.json("POST /models", {
        query: {
          files_of: String(model.id),
          project: model.project,
          name: model.name,
          unit: model.scale_verified || !model.unit_assumed ? model.unit : "proposed",
          up: model.up,
          cell: this.lengthOf("cell"),
          gap: this.lengthOf("gap"),
          resolution: model.default_resolution,
          ...(model.crs ? { crs: model.crs } : {}),
          ...(object ? { object, survey_date: model.survey_date! } : {}),
        },
        body: new Blob([]),
      });
      this._job = first;
      const job = await followJob(api, first, (now) => (this._job = now));
      if (job.state === "failed")
        this._problem = [job.problem?.title, job.problem?.detail].filter(Boolean).join(". ");
      if (job.state === "done" && job.model) await this.open(model, job.model);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = [error.problem.title, error.problem.detail].filter(Boolean).join(". ");
    } finally {
      this._job = null;
    }
  }

  /** Opens the new model. The old one moves to the trash if nothing was painted on it. */
  private async open(old: Model, made: number): Promise<void> {
    const { api, layers } = this.session;
    const path = { model: String(made) };
    const { etag } = await api.versioned("GET /models/{model}", { path });
    await api.json("PATCH /models/{model}", {
      path,
      header: { "If-Match": etag },
      body: Object.fromEntries(kKept.map((name) => [name, old[name]])),
    });
    if (layers.all.length === 0) {
      await api.deleteAsRead("DELETE /models/{model}", { path: { model: String(old.id) } });
      tellTrashed(api, {
        kind: "model",
        entry: `model-${old.id}`,
        name: old.name,
        project: old.project,
      });
    } else {
      notices.show("success", texts.points.done, texts.points.old_stays(old.name));
    }
    navigate(pathOfModel(made));
  }

  private async cancel(job: Job): Promise<void> {
    await this.session.api
      .send("DELETE /jobs/{job}", { path: { job: job.id } })
      .catch((error: unknown) => notices.error(error));
  }
}
