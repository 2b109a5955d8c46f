// <strata-measure-panel>: what is measured, in figures and as a profile.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api";
import { axis_name } from "../../math/camera";
import { flat_polygon, height_of, legs_of, sum } from "../../math/measured-line";
import { kMeasuredDigits, measured_area, measured_length, metres_per } from "../../domain/measure";
import type { Model } from "../../core/types";
import { length, subtract } from "../../math/vector";
import { follow_session } from "../../session/follow-session";
import { kMostPlaces, type MeasuredProfile, type Way } from "./measuring";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import "./profile-plot";
import type { StrataProfilePlot } from "./profile-plot";
import { radio_group } from "../../ui/radio-group";
import { save_blob } from "../../ui/save-from";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.measure;
const kFlat = 0.005; // of the polygon's size: nearer to its plane all places count as in it

@customElement("strata-measure-panel")
export class StrataMeasurePanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private equal_ = false;
  @query("strata-profile-plot") private plot_!: StrataProfilePlot | null;
  private has_keyboard_ = false; // one of its buttons, before it is drawn anew

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    css`
      :host {
        display: block;
      }
      .all {
        display: grid;
        gap: 0.6875rem;
      }
      h2 {
        font-size: 1.12rem;
      }
      h3 {
        margin: 4px 0 0;
        font: 600 1rem var(--serif);
      }
      dl {
        display: grid;
        grid-template-columns: minmax(0, auto) auto;
        gap: 5px 0.75rem;
        margin: 0;
      }
      dt {
        color: var(--ink-soft);
        font-size: 0.9rem;
      }
      dd {
        margin: 0;
        text-align: right;
        font-weight: 600;
        white-space: nowrap;
      }
      dd.wait {
        font-weight: 400;
        color: var(--ink-soft);
      }
      .acts {
        display: flex;
        flex-wrap: wrap;
        gap: 0.4375rem;
      }
      .acts button {
        padding: 0 0.6875rem;
        font-size: 0.88rem;
      }
      .chip {
        padding: 0.375rem 0.625rem;
        border-radius: var(--radius-small);
        background: var(--warn-soft);
        color: var(--warn);
        font-size: 0.84rem;
      }
      .segments {
        display: flex;
      }
      .choices {
        display: flex;
        flex-wrap: wrap;
        gap: 0.5625rem 0.875rem;
        align-items: center;
      }
      .choices label.field {
        flex: 1 1 9.375rem;
      }
    `,
  ];

  /** Where other parts of the panel were looked at, it is brought into sight. */
  override firstUpdated(): void {
    this.scrollIntoView({ block: "nearest" });
  }

  override willUpdate(): void {
    this.has_keyboard_ = this.shadowRoot?.activeElement instanceof HTMLButtonElement;
  }

  /** The button that was pressed may have gone with what it was for. */
  override updated(): void {
    if (this.has_keyboard_ && !this.shadowRoot?.activeElement)
      this.renderRoot.querySelector<HTMLElement>(".acts button")?.focus();
  }

  override render(): TemplateResult {
    const { measuring, model } = this.session;
    const { places, ended } = measuring;
    if (!model) return html``;
    return html`<div class="all">
      <h2>${words.title}</h2>
      ${model.scale_verified ? nothing : html`<p class="chip"><b>${texts.home.scale_open}.</b> ${words.unconfirmed}</p>`}
      <p class="hint">
        ${places.length === 0 ? words.how : ended ? words.how_anew : places.length === kMostPlaces ? words.most(kMostPlaces) : words.how_on}
      </p>
      <div class="acts">
        ${ended ? nothing : html`<button @click=${() => measuring.set_in_middle()} title="${words.set_in_middle} (M)">${words.set_in_middle}</button>`}
        ${places.length > 1 && !ended ? html`<button class="primary" @click=${() => measuring.end()} title="${words.end} (Enter)">${words.end}</button>` : nothing}
        ${
          places.length > 0
            ? html`<button @click=${() => measuring.take_back()} title="${words.take_back} (${words.backspace})">${words.take_back}</button>
              <button @click=${() => measuring.clear()} title="${words.clear} (Escape)">${words.clear}</button>`
            : nothing
        }
      </div>
      ${places.length > 1 ? this.figures(model) : nothing}
      ${measuring.problem ? html`<p class="error" role="alert">${measuring.problem}</p>` : nothing}
      ${ended && measuring.profile ? this.profile(model, measuring.profile) : nothing}
      <span class="visually-hidden" role="status">${places.length > 0 ? this.said(model) : nothing}</span>
    </div>`;
  }

  private figures(model: Model): TemplateResult {
    const { measuring } = this.session;
    const metres = metres_per(model.unit);
    const told = (units: number): string => measured_length(units * metres);
    const { positions } = measuring;
    const [first, last] = [positions[0]!, positions.at(-1)!];
    const straight = sum(legs_of(positions));
    const rise = round_like(height_of(last, model.up) - height_of(first, model.up), straight);
    const polygon = flat_polygon(positions);
    const parts = measuring.profile?.parts.length ?? 1;
    const { has_way } = measuring;
    const is_flat = polygon !== null && polygon.off_plane <= kFlat * Math.sqrt(polygon.area);
    return html`<dl class="numeric">
        <dt>${words.straight}</dt>
        <dd data-figure="straight">${told(straight)}</dd>
        ${positions.length > 2 ? html`<dt>${words.ends}</dt><dd data-figure="ends">${told(length(subtract(last, first)))}</dd>` : nothing}
        <dt>${parts > 1 && has_way ? words.along_parts(parts) : words.along}</dt>
        ${
          measuring.along === null || !has_way
            ? html`<dd class="wait">${measuring.busy ? words.busy : "–"}</dd>`
            : html`<dd data-figure="along">${told(measuring.along)}</dd>`
        }
        <dt>${words.rise(axis_name(model.up))}</dt>
        <dd data-figure="rise">${rise > 0 ? "+" : ""}${told(rise)}</dd>
        ${
          polygon
            ? html`<dt>${words.area}</dt>
              <dd data-figure="area">${measured_area(polygon.area * metres * metres)}</dd>
              <dt>${words.perimeter}</dt>
              <dd data-figure="perimeter">${told(polygon.perimeter)}</dd>`
            : nothing
        }
      </dl>
      ${polygon ? html`<p class="hint">${words.area_hint} ${is_flat ? nothing : words.off_plane(told(round_like(polygon.off_plane, straight)))}</p>` : nothing}
      ${parts > 1 ? html`<p class="chip">${has_way ? words.gaps(parts - 1) : words.no_way}</p>` : nothing}`;
  }

  private profile(model: Model, profile: MeasuredProfile): TemplateResult {
    const { measuring } = this.session;
    const { layer, layers } = measuring;
    return html`<h3>${words.profile}</h3>
      <strata-profile-plot
        .profile=${profile}
        .model=${model}
        .layer=${layer}
        .equal=${this.equal_}
        .pointed=${measuring.pointed}
        @point-out=${(event: CustomEvent<number | null>) => measuring.point_out(event.detail)}
      ></strata-profile-plot>
      <div class="choices">
        <label class="field">
          <span>${words.shows}</span>
          <select @change=${(event: Event) => measuring.choose_layer(Number((event.target as HTMLSelectElement).value) || null)}>
            <option value="" ?selected=${layer === null}>${words.height(axis_name(model.up))}</option>
            ${layers.map((each) => html`<option value=${each.id} ?selected=${layer?.id === each.id}>${each.name}${each.unit ? ` (${each.unit})` : ""}</option>`)}
          </select>
        </label>
        ${
          layer
            ? nothing
            : html`<label class="check"
              ><input type="checkbox" .checked=${this.equal_} @change=${(event: Event) => (this.equal_ = (event.target as HTMLInputElement).checked)} />
              ${words.equal}</label
            >`
        }
      </div>
      <div>
        <p class="caption" id="way">${words.way}</p>
        ${radio_group<Way>({
          label: { id: "way" },
          class: "segments",
          choices: [
            { value: "seen", content: words.ways.seen },
            { value: "nearest", content: words.ways.nearest },
          ],
          chosen: profile.way,
          choose: (way) => measuring.choose_way(way),
        })}
        <p class="hint">${words.way_hints[profile.way]}</p>
      </div>
      <div class="acts">
        <button @click=${() => void this.save_csv(model)}>${words.save_csv}</button>
        <button @click=${() => this.save_svg(model)}>${words.save_svg}</button>
      </div>`;
  }

  /** For those who cannot see the figures change. */
  private said(model: Model): string {
    const { measuring } = this.session;
    const told = (units: number): string => measured_length(units * metres_per(model.unit));
    return [
      words.places(measuring.places.length),
      measuring.places.length > 1
        ? `${words.straight}: ${told(sum(legs_of(measuring.positions)))}`
        : "",
      measuring.along === null || !measuring.has_way
        ? ""
        : `${words.along}: ${told(measuring.along)}`,
    ]
      .filter(Boolean)
      .join(". ");
  }

  private async save_csv({ slug }: Model): Promise<void> {
    try {
      save_blob(await this.session.measuring.csv(), `${slug}-profile.csv`);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      notices.error(error);
    }
  }

  private save_svg({ slug }: Model): void {
    if (this.plot_) save_blob(this.plot_.file(), `${slug}-profile.svg`);
  }
}

/** A difference of lengths has no more decimals than they have digits. */
function round_like(difference: number, measured: number): number {
  if (!(measured > 0)) return difference;
  const step = 10 ** (Math.floor(Math.log10(measured)) - kMeasuredDigits + 1);
  return Math.round(difference / step) * step || 0;
}
