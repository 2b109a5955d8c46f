// <strata-profile-plot>: height, or what a layer holds, along the line that is measured. The
// pointer or the arrow keys choose a place of it, which is marked on the model, too.

import { css, html, LitElement, nothing, render, svg, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { axis_name } from "../../math/camera";
import { label_of } from "../../domain/cells";
import { format_fixed, format_place } from "../../core/locale";
import { height_of } from "../../math/measured-line";
import { format_number, kMeasuredDigits, measured_length, metres_per } from "../../domain/measure";
import { make_plot, nearest_index, type Plot, type PlotPoint } from "../../domain/plot";
import type { ProfilePlace } from "../../domain/profile";
import type { Layer, Model } from "../../core/types";
import type { MeasuredProfile } from "./measuring";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.measure;
const kHeight_px = 190;
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
  /** Whose values are shown; null: heights are. */
  @property({ attribute: false }) layer: Layer | null = null;
  @property({ type: Boolean }) equal = false;
  /** Index of the place that is pointed at. */
  @property({ attribute: false }) pointed: number | null = null;
  @state() private width_ = 0;

  private observer_: ResizeObserver | null = null;
  private plot_: Plot | null = null;

  static override styles = [
    shared_styles,
    css`
      :host {
        display: block;
      }
      .plot {
        cursor: crosshair;
        margin-bottom: 0.4375rem; /* of the focus's line */
        touch-action: pan-y;
        border-radius: var(--radius-small);
      }
      svg {
        display: block;
        width: 100%;
      }
      output {
        display: block;
        min-height: 3lh; /* what is below it keeps its place */
        font-size: 0.82rem;
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
    this.observer_ = new ResizeObserver(
      ([entry]) => (this.width_ = Math.floor(entry!.contentRect.width)),
    );
    this.observer_.observe(this);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.observer_?.disconnect();
    this.point_out(null);
  }

  override willUpdate(changed: Map<PropertyKey, unknown>): void {
    const only_pointed = changed.size === 1 && changed.has("pointed");
    if (this.width_ > 0 && !(only_pointed && this.plot_))
      this.plot_ = this.make(this.width_, kHeight_px);
  }

  override render(): TemplateResult {
    const { plot_: plot, profile } = this;
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
        @pointerdown=${this.on_pointer}
        @pointermove=${this.on_pointer}
        @pointerleave=${(event: PointerEvent) => event.pointerType === "mouse" && this.point_out(null)}
        @keydown=${this.on_key}
      >
        ${plot ? this.draw(plot, kOnPage, place) : nothing}
      </div>
      <output aria-hidden="true">${place ? this.told(place) : html`${words.plot_hint}`}</output>`;
  }

  /** As a file of its own, dark on white. */
  file(): Blob {
    const holder = document.createElement("div");
    render(this.draw(this.make(kFile.width, kFile.height), kOnPaper), holder);
    const drawn = holder.querySelector("svg")!;
    const comments = document.createTreeWalker(drawn, NodeFilter.SHOW_COMMENT);
    const left_by_lit: Node[] = [];
    while (comments.nextNode()) left_by_lit.push(comments.currentNode);
    for (const each of left_by_lit) each.parentNode?.removeChild(each);
    return new Blob(
      [`<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(drawn)}\n`],
      { type: "image/svg+xml" },
    );
  }

  private get metres(): number {
    return metres_per(this.model.unit);
  }

  private make(width: number, height: number): Plot {
    const { layer, metres } = this;
    const y_of = ({ place, value }: ProfilePlace): number | null =>
      layer ? value : height_of(place, this.model.up) * metres;
    const parts = this.profile.parts.map((part) =>
      part.map((each): PlotPoint => ({ x: each.along * metres, y: y_of(each) })),
    );
    return make_plot({
      parts,
      y_unit: layer ? layer.unit : null,
      equal: this.equal,
      width,
      height,
    });
  }

  private draw(plot: Plot, colors: PlotColors, place?: ProfilePlace): TemplateResult {
    const { left, right, top, bottom, width, height } = plot;
    const named = (name: string, unit: string): string => (unit ? `${name}, ${unit}` : name);
    const y_name = this.layer ? label_of(this.layer) : words.height(axis_name(this.model.up));
    const x = place ? plot.x_at(place.along * this.metres) : 0;
    const y = place && this.y_of_pointed(plot, place);
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
      <text x="2" y="12" fill=${colors.ink} font-weight="600">${named(y_name, plot.y.unit)}</text>
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

  private y_of_pointed(plot: Plot, { place, value }: ProfilePlace): number | null {
    if (!this.layer) return plot.y_at(height_of(place, this.model.up) * this.metres);
    return value === null ? null : plot.y_at(value);
  }

  private value_of({ place, value }: ProfilePlace): string {
    const { layer, model } = this;
    if (!layer) return measured_length(height_of(place, model.up) * this.metres);
    if (value === null) return words.no_value;
    return `${format_number(value, kMeasuredDigits)}${layer.unit ? ` ${layer.unit}` : ""}`;
  }

  private describe(place: ProfilePlace): string {
    const name = this.layer ? label_of(this.layer) : words.height(axis_name(this.model.up));
    return words.sample(measured_length(place.along * this.metres), name, this.value_of(place));
  }

  private told(place: ProfilePlace): TemplateResult {
    const { unit } = this.model;
    const decimals = unit === "mm" ? 2 : unit === "cm" ? 3 : 4;
    return html`<span class="numeric"
      ><b>${this.describe(place)}</b><br />${texts.value.position} ${format_place(place.place.map((each) => format_fixed(each, decimals)))} ${unit}</span
    >`;
  }

  private point_out(index: number | null): void {
    this.dispatchEvent(new CustomEvent("point-out", { detail: index }));
  }

  private readonly on_pointer = (event: PointerEvent): void => {
    const { plot_: plot, profile } = this;
    if (
      !plot ||
      profile.places.length === 0 ||
      (event.type === "pointermove" && event.pointerType !== "mouse" && event.buttons === 0)
    )
      return;
    const { left } = (event.currentTarget as HTMLElement).getBoundingClientRect();
    const along = plot.x_of(event.clientX - left) / this.metres;
    this.point_out(
      nearest_index(
        profile.places.map((each) => each.along),
        along,
      ),
    );
  };

  private readonly on_key = (event: KeyboardEvent): void => {
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
    this.point_out(Math.min(last, Math.max(0, next)));
  };
}
