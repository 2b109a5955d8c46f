// <strata-measure-panel>: the measurement as numbers and as a profile.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { axisName } from "../../math/camera";
import { flatPolygon, heightOf, legsOf, sum } from "../../math/measured-line";
import { kMeasuredDigits, measuredArea, measuredLength, metresPer } from "../../domain/measure";
import type { Model } from "../../core/types";
import { length, subtract } from "../../math/vector";
import { followSession } from "../../session/follow-session";
import { kMostPlaces, type MeasuredProfile, type Way } from "./measuring";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import "./profile-plot";
import type { StrataProfilePlot } from "./profile-plot";
import { radioGroup } from "../../ui/radio-group";
import { saveBlob } from "../../ui/save-from";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.measure;
const kFlat = 0.005; // share of the polygon's size; points nearer to its plane count as flat

@customElement("strata-measure-panel")
export class StrataMeasurePanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _equal = false;
  @query("strata-profile-plot") private _plot!: StrataProfilePlot | null;
  private _hasKeyboard = false; // one of the panel's buttons had the focus before rendering

  constructor() {
    super();
    followSession(this, "measuring", "layers", "view");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
      }
      .all {
        display: grid;
        gap: var(--space-3);
      }
      h2 {
        font-size: var(--text-title-3);
      }
      h3 {
        margin: var(--space-1) 0 0;
        font: 600 var(--text-large) var(--serif);
      }
      dl {
        display: grid;
        grid-template-columns: minmax(0, auto) auto;
        gap: var(--space-1) var(--space-3);
        margin: 0;
      }
      dt {
        color: var(--ink-soft);
        font-size: var(--text-small);
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
        gap: var(--space-2);
      }
      .acts button {
        padding: 0 var(--space-3);
        font-size: var(--text-small);
      }
      .chip {
        padding: var(--space-2) var(--space-2);
        border-radius: var(--radius-small);
        background: var(--warn-soft);
        color: var(--warn);
        font-size: var(--text-small);
      }
      .segments {
        display: flex;
      }
      .choices {
        display: flex;
        flex-wrap: wrap;
        gap: var(--space-2) var(--space-3);
        align-items: center;
      }
      .choices label.field {
        flex: 1 1 9.375rem;
      }
    `,
  ];

  /** Scrolls the panel into view if another part of the side panel was visible. */
  override firstUpdated(): void {
    this.scrollIntoView({ block: "nearest" });
  }

  override willUpdate(): void {
    this._hasKeyboard = this.shadowRoot?.activeElement instanceof HTMLButtonElement;
  }

  /** Moves the focus if the pressed button was removed together with its measurement. */
  override updated(): void {
    if (this._hasKeyboard && !this.shadowRoot?.activeElement)
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
        ${ended ? nothing : html`<button @click=${() => measuring.setInMiddle()} title="${words.set_in_middle} (M)">${words.set_in_middle}</button>`}
        ${places.length > 1 && !ended ? html`<button class="primary" @click=${() => measuring.end()} title="${words.end} (Enter)">${words.end}</button>` : nothing}
        ${
          places.length > 0
            ? html`<button @click=${() => measuring.takeBack()} title="${words.take_back} (${words.backspace})">${words.take_back}</button>
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
    const metres = metresPer(model.unit);
    const told = (units: number): string => measuredLength(units * metres);
    const { positions } = measuring;
    const [first, last] = [positions[0]!, positions.at(-1)!];
    const straight = sum(legsOf(positions));
    const rise = roundLike(heightOf(last, model.up) - heightOf(first, model.up), straight);
    const polygon = flatPolygon(positions);
    const parts = measuring.profile?.parts.length ?? 1;
    const { hasWay } = measuring;
    const isFlat = polygon !== null && polygon.off_plane <= kFlat * Math.sqrt(polygon.area);
    return html`<dl>
        <dt>${words.straight}</dt>
        <dd data-figure="straight">${told(straight)}</dd>
        ${positions.length > 2 ? html`<dt>${words.ends}</dt><dd data-figure="ends">${told(length(subtract(last, first)))}</dd>` : nothing}
        <dt>${parts > 1 && hasWay ? words.along_parts(parts) : words.along}</dt>
        ${
          measuring.along === null || !hasWay
            ? html`<dd class="wait">${measuring.busy ? words.busy : "–"}</dd>`
            : html`<dd data-figure="along">${told(measuring.along)}</dd>`
        }
        <dt>${words.rise(axisName(model.up))}</dt>
        <dd data-figure="rise">${rise > 0 ? "+" : ""}${told(rise)}</dd>
        ${
          polygon
            ? html`<dt>${words.area}</dt>
              <dd data-figure="area">${measuredArea(polygon.area * metres * metres)}</dd>
              <dt>${words.perimeter}</dt>
              <dd data-figure="perimeter">${told(polygon.perimeter)}</dd>`
            : nothing
        }
      </dl>
      ${polygon ? html`<p class="hint">${words.area_hint} ${isFlat ? nothing : words.off_plane(told(roundLike(polygon.off_plane, straight)))}</p>` : nothing}
      ${parts > 1 ? html`<p class="chip">${hasWay ? words.gaps(parts - 1) : words.no_way}</p>` : nothing}`;
  }

  private profile(model: Model, profile: MeasuredProfile): TemplateResult {
    const { measuring } = this.session;
    const { layer, layers } = measuring;
    return html`<h3>${words.profile}</h3>
      <strata-profile-plot
        .profile=${profile}
        .model=${model}
        .layer=${layer}
        .equal=${this._equal}
        .pointed=${measuring.pointed}
        @point-out=${(event: CustomEvent<number | null>) => measuring.pointOut(event.detail)}
      ></strata-profile-plot>
      <div class="choices">
        <label class="field">
          <span>${words.shows}</span>
          <select @change=${(event: Event) => measuring.chooseLayer(Number((event.target as HTMLSelectElement).value) || null)}>
            <option value="" ?selected=${layer === null}>${words.height(axisName(model.up))}</option>
            ${layers.map((each) => html`<option value=${each.id} ?selected=${layer?.id === each.id}>${each.name}${each.unit ? ` (${each.unit})` : ""}</option>`)}
          </select>
        </label>
        ${
          layer
            ? nothing
            : html`<label class="check"
              ><input type="checkbox" .checked=${this._equal} @change=${(event: Event) => (this._equal = (event.target as HTMLInputElement).checked)} />
              ${words.equal}</label
            >`
        }
      </div>
      <div>
        <p class="caption" id="way">${words.way}</p>
        ${radioGroup<Way>({
          label: { id: "way" },
          class: "segments",
          choices: [
            { value: "seen", content: words.ways.seen },
            { value: "nearest", content: words.ways.nearest },
          ],
          chosen: profile.way,
          choose: (way) => measuring.chooseWay(way),
        })}
        <p class="hint">${words.way_hints[profile.way]}</p>
      </div>
      <div class="acts">
        <button @click=${() => void this.saveCsv(model)}>${words.save_csv}</button>
        <button @click=${() => this.saveSvg(model)}>${words.save_svg}</button>
      </div>`;
  }

  /** Returns the text for screen readers, which do not notice that the numbers change. */
  private said(model: Model): string {
    const { measuring } = this.session;
    const told = (units: number): string => measuredLength(units * metresPer(model.unit));
    return [
      words.places(measuring.places.length),
      measuring.places.length > 1
        ? `${words.straight}: ${told(sum(legsOf(measuring.positions)))}`
        : "",
      measuring.along === null || !measuring.hasWay
        ? ""
        : `${words.along}: ${told(measuring.along)}`,
    ]
      .filter(Boolean)
      .join(". ");
  }

  private async saveCsv({ slug }: Model): Promise<void> {
    try {
      saveBlob(await this.session.measuring.csv(), `${slug}-profile.csv`);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      notices.error(error);
    }
  }

  private saveSvg({ slug }: Model): void {
    if (this._plot) saveBlob(this._plot.file(), `${slug}-profile.svg`);
  }
}

/** Rounds a difference between lengths to the precision of the lengths. */
function roundLike(difference: number, measured: number): number {
  if (!(measured > 0)) return difference;
  const step = 10 ** (Math.floor(Math.log10(measured)) - kMeasuredDigits + 1);
  return Math.round(difference / step) * step || 0;
}
