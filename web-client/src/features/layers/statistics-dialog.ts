// <strata-statistics-dialog>: the area that a layer's values cover.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { formatArea, formatNumber } from "../../domain/measure";
import { colorOf, cssColor, withRange } from "../../domain/palette";
import type { WorkbookQuery } from "../../domain/workbooks";
import type { KeyStatistics, Layer, Palette, Statistics } from "../../core/types";
import { labelOf } from "../../domain/cells";
import { describeValue } from "../../session/layer-values";
import "./cross-table";
import { hasClasses } from "./cross-table";
import "../../ui/dialog";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { saveFrom } from "../../ui/save-from";
import { workbookButtons, workbookQuery } from "../../ui/workbook-buttons";
import { styled } from "../../ui/styled";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const kMostRows = 60;

@customElement("strata-statistics-dialog")
export class StrataStatisticsDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private _statistics: Statistics | null = null;
  @state() private _problem = "";
  // the palette while the user drags a limit of the colors
  @state() private _tried: Palette | null = null;
  private _saving = false;
  private _counted = 0; // the layer's sequence at the time of the statistics

  constructor() {
    super();
    followSession(this, "layers", "tables");
  }

  static override styles = [
    sharedStyles,
    css`
      .total {
        display: flex;
        align-items: baseline;
        gap: var(--space-2);
      }
      .total b {
        font: 600 var(--text-title-1) var(--serif);
      }
      .row {
        flex-wrap: wrap;
      }
      .bars {
        display: grid;
        gap: var(--space-2);
        margin: 0;
        padding: 0;
        list-style: none;
      }
      .bars .words {
        display: flex;
        gap: var(--space-2);
        align-items: center;
        font-size: var(--text-small);
      }
      .bars .share {
        min-width: 4rem;
        text-align: end;
      }
      .bars .track {
        height: 0.5625rem;
        margin-top: var(--space-1);
        border-radius: var(--radius-tiny);
        background: var(--hover);
      }
      .bars .track i {
        display: block;
        height: 100%;
        min-width: 2px;
        border-radius: var(--radius-tiny);
        box-shadow: inset 0 0 0 1px var(--swatch-rim);
      }
      dl {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(6.875rem, 1fr));
        gap: var(--space-3);
        margin: 0;
      }
      dt {
        font-size: var(--text-tiny);
        font-weight: 600;
        color: var(--ink-soft);
      }
      dd {
        margin: 0;
        font-size: var(--text-large);
      }
      .histogram {
        display: flex;
        align-items: flex-end;
        gap: var(--space-half);
        height: 7.5rem;
        border-bottom: var(--edge) solid var(--line-strong);
      }
      .histogram i {
        flex: 1;
        border-radius: var(--radius-tiny) var(--radius-tiny) 0 0;
      }
      .limits {
        position: relative;
        height: 1.5rem;
      }
      .limits input {
        position: absolute;
        inset: 0;
        background: none;
        pointer-events: none;
        appearance: none;
      }
      .limits input::-webkit-slider-thumb {
        width: 0.875rem;
        height: 1.25rem;
        border: 2px solid var(--raised);
        border-radius: var(--radius-tiny);
        background: var(--accent);
        cursor: ew-resize;
        pointer-events: auto;
        appearance: none;
      }
      .limits input::-moz-range-thumb {
        width: 0.75rem;
        height: 1.125rem;
        border-radius: var(--radius-tiny);
        background: var(--accent);
        cursor: ew-resize;
        pointer-events: auto;
      }
      .ends {
        display: flex;
        justify-content: space-between;
        margin-top: var(--space-1);
        font-size: var(--text-tiny);
        color: var(--ink-soft);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.load();
  }

  /** Requests the statistics again after an edit. */
  override updated(): void {
    if (this._statistics && this.layer.sequence > this._counted) void this.load();
  }

  private async load(): Promise<void> {
    this._problem = "";
    this._counted = this.layer.sequence;
    try {
      this._statistics = await this.session.api.json(
        "GET /models/{model}/layers/{layer}/statistics",
        { path: { model: this.session.modelId, layer: this.layer.id } },
      );
    } catch (error) {
      this._problem = error instanceof Error ? error.message : texts.problems.unexpected;
    }
  }

  override render(): TemplateResult {
    return html`<strata-dialog
      docked
      heading=${texts.statistics.title(labelOf(this.layer))}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      ${
        this._problem
          ? html`<p class="error" role="alert">${this._problem}</p>`
          : this._statistics
            ? this.content(this._statistics)
            : html`<p class="hint" role="status">${texts.loading}</p>`
      }
      ${this._statistics && hasClasses(this.layer) ? html`<strata-cross-table .session=${this.session} .layer=${this.layer}></strata-cross-table>` : nothing}
      <button slot="actions" @click=${() => void this.load()}>${texts.statistics.refresh}</button>
    </strata-dialog>`;
  }

  private content(statistics: Statistics): TemplateResult {
    const words = texts.statistics;
    if (statistics.texels === 0) return html`<p>${words.nothing}</p>`;
    const share = this.share(statistics.area_m2);
    return html`<div class="total">
        <b>${formatArea(statistics.area_m2)}</b>
        ${share ? html`<span class="hint">${words.of_surface(share)}</span>` : nothing}
      </div>
      <div class="row" role="group" aria-label=${words.title(labelOf(this.layer))}>
        ${workbookButtons({ what: words.title(labelOf(this.layer)), rows: () => this.rows(statistics), save: (f) => this.save(f) })}
      </div>
      ${this.layer.palette.mode === "categorical" ? this.keys(statistics) : this.spread(statistics)}`;
  }

  /** Returns an area as a share of the model's surface. */
  private share(areaM2: number): string {
    const whole = this.session.model?.area_m2 ?? 0;
    return whole > 0 ? `${formatNumber((areaM2 / whole) * 100)} %` : "";
  }

  /** Returns the rows to copy: the displayed values, with one number in each cell. */
  private rows(statistics: Statistics): string[][] {
    const words = texts.statistics;
    const line = (name: string, area: number): string[] => [
      name,
      formatArea(area),
      this.share(area),
    ];
    if (this.layer.palette.mode === "categorical")
      return [
        [words.class, words.area, words.share],
        ...sorted(statistics).map((key) =>
          line(describeValue(this.layer, key.key, this.session.tables), key.area_m2),
        ),
        line(words.sum, statistics.area_m2),
        ...this.damageIndices(statistics).map(([name, value]) => [name, formatNumber(value, 4)]),
      ];
    const { unit } = this.layer;
    return [
      line(words.area, statistics.area_m2),
      ...this.measures(statistics).map(([name, value]) => [name, formatNumber(value, 4), unit]),
      [words.from, words.to, words.area],
      ...statistics.histogram.map((bin) => [
        formatNumber(bin.from, 4),
        formatNumber(bin.to, 4),
        formatArea(bin.area_m2),
      ]),
    ];
  }

  private save(f: WorkbookQuery["f"]): void {
    saveFrom(
      this.session.api.url("GET /models/{model}/layers/{layer}/quantities", {
        path: { model: this.session.modelId, layer: this.layer.id },
        query: workbookQuery(f),
      }),
      `${this.layer.slug}-quantities.${f}`,
    );
  }

  private measures(statistics: Statistics): [string, number][] {
    const words = texts.statistics;
    const all: [string, number | null | undefined][] = [
      [words.mean, statistics.mean],
      [words.min, statistics.min],
      [words.max, statistics.max],
      [words.std, statistics.std],
      [words.root_mean_square, statistics.root_mean_square],
    ];
    return all.flatMap(([name, value]): [string, number][] =>
      value === null || value === undefined ? [] : [[name, value]],
    );
  }

  /** Returns the damage indices, if the values can be ratings: small numbers, and not keys. */
  private damageIndices({
    keys,
    mean,
    root_mean_square: rootMeanSquare,
  }: Statistics): [string, number][] {
    const words = texts.statistics.damage_index;
    const isRating = this.layer.kind !== "database" && keys?.every(({ key }) => key <= kMostRating);
    return !isRating || mean === undefined || rootMeanSquare === undefined
      ? []
      : [
          [words.linear, mean],
          [words.progressive, rootMeanSquare],
        ];
  }

  private keys(statistics: Statistics): TemplateResult {
    const keys = sorted(statistics);
    const largest = keys[0]?.area_m2 ?? 1;
    return html`<ul class="bars">
      ${keys.slice(0, kMostRows).map((key) => {
        const color = colorOf(this.layer.palette, key.key);
        const background = color ? cssColor(color) : "var(--line-strong)";
        return html`<li>
          <div class="words">
            <span class="swatch" ${styled({ background })}></span>
            <span class="grow ellipsis">${describeValue(this.layer, key.key, this.session.tables)}</span>
            <span>${formatArea(key.area_m2)}</span>
            <span class="hint share">${this.share(key.area_m2)}</span>
          </div>
          <div class="track"><i ${styled({ width: `${(key.area_m2 / largest) * 100}%`, background })}></i></div>
        </li>`;
      })}
    </ul>
      ${this.ratings(this.damageIndices(statistics))}`;
  }

  private ratings(indices: [string, number][]): TemplateResult | typeof nothing {
    if (indices.length === 0) return nothing;
    return html`<div>
      <p class="caption">${texts.statistics.damage_index.caption}</p>
      ${figures(indices)}
    </div>`;
  }

  private spread(statistics: Statistics): TemplateResult {
    const words = texts.statistics;
    const unit = this.layer.unit ? ` ${this.layer.unit}` : "";
    const bins = statistics.histogram;
    const largest = Math.max(...bins.map((bin) => bin.area_m2), Number.MIN_VALUE);
    const palette = this._tried ?? this.layer.palette;
    return html`${figures(this.measures(statistics), unit)}
      ${
        bins.length > 1
          ? html`<div>
            <p class="caption">${words.spread}</p>
            <div class="histogram" role="img" aria-label=${words.spread}>
              ${bins.map((bin) => {
                const color = colorOf(palette, (bin.from + bin.to) / 2);
                const height = `${((bin.area_m2 / largest) * 100).toFixed(1)}%`;
                return html`<i ${styled({ height, background: color ? cssColor(color) : "var(--calm)" })}></i>`;
              })}
            </div>
            ${this.session.canCurate ? this.limits(palette, bins[0]!.from, bins[bins.length - 1]!.to, unit) : nothing}
            <div class="ends">
              <span>${formatNumber(bins[0]!.from, 4)}${unit}</span>
              <span>${formatNumber(bins[bins.length - 1]!.to, 4)}${unit}</span>
            </div>
          </div>`
          : nothing
      }`;
  }

  /** Renders two handles for the pointer and the arrow keys, which set the range of the colors. */
  private limits(palette: Palette, from: number, to: number, unit: string): TemplateResult {
    const words = texts.statistics;
    const handle = (
      label: string,
      value: number,
      range: (moved: number) => [number, number],
    ): TemplateResult =>
      html`<input
        type="range"
        aria-label=${label}
        aria-valuetext="${formatNumber(value, 4)}${unit}"
        min=${from}
        max=${to}
        step=${(to - from) / 200}
        .value=${String(value)}
        @input=${(event: Event) => {
          const [min, max] = range(Number((event.target as HTMLInputElement).value));
          if (min < max) this._tried = withRange(this.layer.palette, min, max);
        }}
        @change=${() => void this.saveRange()}
      />`;
    return html`<div class="limits">
        ${handle(words.range_from, palette.min, (moved) => [moved, palette.max])} ${handle(words.range_to, palette.max, (moved) => [palette.min, moved])}
      </div>
      <p class="hint" role="status">${words.range(`${formatNumber(palette.min, 4)}${unit}`, `${formatNumber(palette.max, 4)}${unit}`)}</p>`;
  }

  /**
   * Saves one change at a time. Each key press is a change. If several changes wait, only the last
   * of them is saved.
   */
  private async saveRange(): Promise<void> {
    if (this._saving) return;
    this._saving = true;
    try {
      while (this._tried) {
        const palette = this._tried;
        await this.session.layers.change(this.layer, { palette });
        if (this._tried === palette) this._tried = null;
      }
    } catch (error) {
      this._tried = null;
      this._problem = error instanceof Error ? error.message : texts.problems.unexpected;
    } finally {
      this._saving = false;
    }
  }
}

const kMostRating = 10;

/** Sorts by area, with the largest first. */
const sorted = (statistics: Statistics): KeyStatistics[] =>
  [...(statistics.keys ?? [])].sort((a, b) => b.area_m2 - a.area_m2);

const figures = (named: [string, number][], unit = ""): TemplateResult =>
  html`<dl>${named.map(([name, value]) => html`<div><dt>${name}</dt><dd>${formatNumber(value, 4)}${unit}</dd></div>`)}</dl>`;
