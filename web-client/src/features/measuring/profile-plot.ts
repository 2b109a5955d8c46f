// <strata-profile-plot>: height, or a layer's values, along the measured line. The pointer or the
// arrow keys select a point, which is also marked on the model.

import { css, html, LitElement, nothing, render, svg, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { axisName } from "../../math/camera";
import { labelOf } from "../../domain/cells";
import { formatFixed, formatPlace } from "../../core/locale";
import { heightOf } from "../../math/measured-line";
import { formatNumber, kMeasuredDigits, measuredLength, metresPer } from "../../domain/measure";
import { makePlot, nearestIndex, type Plot, type PlotPoint } from "../../domain/plot";
import type { ProfilePlace } from "../../domain/profile";
import type { Layer, Model } from "../../core/types";
import type { MeasuredProfile } from "./measuring";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.measure;
const kHeightPx = 190;
const kFile = { width: 960, height: 400 };

interface PlotColors {
  ink: string;
  soft: string;
  grid: string;
  curve: string;
  ground: string;
}
const kOnPage: PlotColors = {
  ink: "var(--ink)",
  soft: "var(--ink-soft)",
  grid: "var(--line)",
  curve: "var(--accent)",
  ground: "none",
};
const kOnPaper: PlotColors = {
  ink: "black",
  soft: "dimgray",
  grid: "gainsboro",
  curve: "black",
  ground: "white",
};

@customElement("strata-profile-plot")
export class StrataProfilePlot extends LitElement {
  @property({ attribute: false }) profile!: MeasuredProfile;
  @property({ attribute: false }) model!: Model;
  /** The layer with the plotted values; null for heights. */
  @property({ attribute: false }) layer: Layer | null = null;
  @property({ type: Boolean }) equal = false;
  /** The index of the selected point. */
  @property({ attribute: false }) pointed: number | null = null;
  @state() private _width = 0;

  private _observer: ResizeObserver | null = null;
  private _plot: Plot | null = null;

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
      }
      .plot {
        cursor: crosshair;
        margin-bottom: var(--space-2); /* space for the focus outline */
        touch-action: pan-y;
        border-radius: var(--radius-small);
      }
      svg {
        display: block;
        width: 100%;
      }
      output {
        display: block;
        min-height: 3lh; /* the content below does not move */
        font-size: var(--text-small);
        color: var(--ink-soft);
      }
      output b {
        color: var(--ink);
        font-weight: 600;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this._observer = new ResizeObserver(
      ([entry]) => (this._width = Math.floor(entry!.contentRect.width)),
    );
    this._observer.observe(this);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._observer?.disconnect();
    this.pointOut(null);
  }

  override willUpdate(changed: Map<PropertyKey, unknown>): void {
    const onlyPointed = changed.size === 1 && changed.has("pointed");
    if (this._width > 0 && !(onlyPointed && this._plot))
      this._plot = this.make(this._width, kHeightPx);
  }

  override render(): TemplateResult {
    const { _plot: plot, profile } = this;
    const last = profile.places.length - 1;
    const place = this.pointed === null ? undefined : profile.places[this.pointed];
    return html`<div
        class="plot"
        tabindex="0"
        role="slider"
        aria-label=${words.plot}
        aria-orientation="horizontal"
        aria-valuemin="0"
        aria-valuemax=${Math.max(0, last)}
        aria-valuenow=${this.pointed ?? 0}
        aria-valuetext=${place ? this.describe(place) : words.none_pointed}
        @pointerdown=${this.onPointer}
        @pointermove=${this.onPointer}
        @pointerleave=${(event: PointerEvent) => event.pointerType === "mouse" && this.pointOut(null)}
        @keydown=${this.onKey}
      >
        ${plot ? this.draw(plot, kOnPage, place) : nothing}
      </div>
      <output aria-hidden="true">${place ? this.told(place) : html`${words.plot_hint}`}</output>`;
  }

  /** Returns the plot as a separate file, dark on white. */
  file(): Blob {
    const holder = document.createElement("div");
    render(this.draw(this.make(kFile.width, kFile.height), kOnPaper), holder);
    const drawn = holder.querySelector("svg")!;
    const comments = document.createTreeWalker(drawn, NodeFilter.SHOW_COMMENT);
    const leftByLit: Node[] = [];
    while (comments.nextNode()) leftByLit.push(comments.currentNode);
    for (const each of leftByLit) each.parentNode?.removeChild(each);
    return new Blob(
      [`<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(drawn)}\n`],
      { type: "image/svg+xml" },
    );
  }

  private get metres(): number {
    return metresPer(this.model.unit);
  }

  private make(width: number, height: number): Plot {
    const { layer, metres } = this;
    const yOf = ({ place, value }: ProfilePlace): number | null =>
      layer ? value : heightOf(place, this.model.up) * metres;
    const parts = this.profile.parts.map((part) =>
      part.map((each): PlotPoint => ({ x: each.along * metres, y: yOf(each) })),
    );
    return makePlot({
      parts,
      yUnit: layer ? layer.unit : null,
      equal: this.equal,
      width,
      height,
    });
  }

  private draw(plot: Plot, colors: PlotColors, place?: ProfilePlace): TemplateResult {
    const { left, right, top, bottom, width, height } = plot;
    const named = (name: string, unit: string): string => (unit ? `${name}, ${unit}` : name);
    const yName = this.layer ? labelOf(this.layer) : words.height(axisName(this.model.up));
    const x = place ? plot.xAt(place.along * this.metres) : 0;
    const y = place && this.yOfPointed(plot, place);
    return html`<svg viewBox="0 0 ${width} ${height}" width=${width} height=${height} font-family="system-ui, sans-serif" font-size="11" aria-hidden="true">
      <rect width=${width} height=${height} fill=${colors.ground} />
      ${plot.y.ticks.map(
        ({
          at,
          label,
        }) => svg`<path d="M${left} ${at.toFixed(1)}H${right}" stroke=${colors.grid} fill="none" />
          <text x=${left - 6} y=${at + 3.8} text-anchor="end" fill=${colors.soft}>${label}</text>`,
      )}
      ${plot.x.ticks.map(
        ({
          at,
          label,
        }) => svg`<path d="M${at.toFixed(1)} ${bottom}v4" stroke=${colors.soft} fill="none" />
          <text x=${at} y=${bottom + 15} text-anchor="middle" fill=${colors.soft}>${label}</text>`,
      )}
      <path d="M${left} ${top}V${bottom}H${right}" stroke=${colors.soft} fill="none" />
      <text x="2" y="12" fill=${colors.ink} font-weight="600">${named(yName, plot.y.unit)}</text>
      <text x=${right} y=${height - 6} text-anchor="end" fill=${colors.ink} font-weight="600">${named(words.along, plot.x.unit)}</text>
      ${plot.breaks.map((at) => svg`<path class="break" d="M${at.toFixed(1)} ${top}V${bottom}" stroke=${colors.soft} stroke-dasharray="2 3" fill="none" />`)}
      ${plot.curves.map((curve) => svg`<path class="curve" d=${curve} stroke=${colors.curve} stroke-width="1.8" stroke-linejoin="round" stroke-linecap="round" fill="none" />`)}
      ${
        place
          ? svg`<path d="M${x.toFixed(1)} ${top}V${bottom}" stroke=${colors.ink} fill="none" />
            ${y === null || y === undefined ? nothing : svg`<circle cx=${x} cy=${y} r="4.5" fill=${colors.curve} stroke="var(--raised)" stroke-width="1.5" />`}`
          : nothing
      }
    </svg>`;
  }

  private yOfPointed(plot: Plot, { place, value }: ProfilePlace): number | null {
    if (!this.layer) return plot.yAt(heightOf(place, this.model.up) * this.metres);
    return value === null ? null : plot.yAt(value);
  }

  private valueFor({ place, value }: ProfilePlace): string {
    const { layer, model } = this;
    if (!layer) return measuredLength(heightOf(place, model.up) * this.metres);
    if (value === null) return words.no_value;
    return `${formatNumber(value, kMeasuredDigits)}${layer.unit ? ` ${layer.unit}` : ""}`;
  }

  private describe(place: ProfilePlace): string {
    const name = this.layer ? labelOf(this.layer) : words.height(axisName(this.model.up));
    return words.sample(measuredLength(place.along * this.metres), name, this.valueFor(place));
  }

  private told(place: ProfilePlace): TemplateResult {
    const { unit } = this.model;
    const decimals = unit === "mm" ? 2 : unit === "cm" ? 3 : 4;
    return html`<span
      ><b>${this.describe(place)}</b><br />${texts.value.position} ${formatPlace(place.place.map((each) => formatFixed(each, decimals)))} ${unit}</span
    >`;
  }

  private pointOut(index: number | null): void {
    this.dispatchEvent(new CustomEvent("point-out", { detail: index }));
  }

  private readonly onPointer = (event: PointerEvent): void => {
    const { _plot: plot, profile } = this;
    if (
      !plot ||
      profile.places.length === 0 ||
      (event.type === "pointermove" && event.pointerType !== "mouse" && event.buttons === 0)
    )
      return;
    const { left } = (event.currentTarget as HTMLElement).getBoundingClientRect();
    const along = plot.xOf(event.clientX - left) / this.metres;
    this.pointOut(
      nearestIndex(
        profile.places.map((each) => each.along),
        along,
      ),
    );
  };

  private readonly onKey = (event: KeyboardEvent): void => {
    const last = this.profile.places.length - 1;
    if (event.altKey || event.ctrlKey || event.metaKey || last < 0) return;
    const step = event.shiftKey ? 1 : Math.max(1, Math.round(last / 100));
    const page = Math.max(1, Math.round(last / 10));
    const at = this.pointed ?? 0;
    const to: Record<string, number> = {
      ArrowRight: at + step,
      ArrowUp: at + step,
      ArrowLeft: at - step,
      ArrowDown: at - step,
      PageUp: at + page,
      PageDown: at - page,
      Home: 0,
      End: last,
    };
    const next = to[event.key];
    if (next === undefined) return;
    event.preventDefault();
    this.pointOut(Math.min(last, Math.max(0, next)));
  };
}
