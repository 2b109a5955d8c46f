// <strata-color-dialog>: the colors of a layer: the column of records that sets them, and the
// colors and patterns of classes. The model previews each choice for this user until the choice is
// saved.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { holdsFiles, isNumber, labelOf } from "../../domain/cells";
import { formatCount, readNumber, typedNumber } from "../../core/locale";
import { holdsMarks } from "../../domain/marks";
import {
  categoryPalette,
  cssGradient,
  graduatedPalette,
  kClassColors,
  kRamps,
  opaqueColor,
  rampColors,
  recordPalette,
  samePalette,
  swatchStyle,
  type Ramp,
} from "../../domain/palette";
import type { Column, ColumnClasses } from "../../core/protocol.gen";
import type { Layer, Palette, PalettePoint } from "../../core/types";
import { describeValue } from "../../session/layer-values";
import "../../ui/dialog";
import { followSession } from "../../session/follow-session";
import { classRange, valueLabel } from "./legend";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { numberInput } from "../../ui/number-input";
import { choicesStyles, sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";

type Method = "unique" | "equal" | "quantile" | "smooth";
const kPatterns = ["solid", "hatch", "dots", "outline"] as const;
const kAngles = [45, 135, 0, 90]; // angles of the hatches of successive classes
const kMostCategories = 30;

const colorsLayers = (column: Column): boolean =>
  column.kind !== "relation" && !holdsFiles(column) && !holdsMarks(column);

@customElement("strata-color-dialog")
export class StrataColorDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private _method: Method = "unique";
  @state() private _count = 5;
  @state() private _ramp: Ramp = "viridis";
  @state() private _palette: Palette | null = null;
  @state() private _classes: ColumnClasses | null = null;
  @state() private _problem = "";
  @state() private _working = false;
  private _before: Palette | null = null; // this user's palette before the dialog opened
  private _asked = 0;

  constructor() {
    super();
    followSession(this, "layers", "tables");
  }

  static override styles = [
    sharedStyles,
    choicesStyles,
    css`
      ul {
        display: grid;
        gap: var(--space-2);
        margin: 0;
        padding: 0;
        list-style: none;
        max-height: 42dvh;
        overflow: auto;
      }
      li {
        display: grid;
        grid-template-columns: auto minmax(0, 1fr) auto 6.5rem;
        align-items: center;
        gap: var(--space-2);
        font-size: var(--text-small);
      }
      /* The color well shows the class with its pattern, as on the surface. */
      li input[type="color"] {
        width: var(--control-small);
        height: var(--control-small);
      }
      li input[type="color"]::-webkit-color-swatch {
        opacity: 0;
      }
      li input[type="color"]::-moz-color-swatch {
        opacity: 0;
      }
      li select {
        min-height: var(--control-small);
        padding: var(--space-half) var(--space-2);
      }
      .ramps {
        display: flex;
        gap: var(--space-2);
      }
      .ramps button {
        flex: 1;
        min-height: var(--control-small);
        padding: var(--space-1);
      }
      .ramps i {
        display: block;
        width: 100%;
        height: 1rem;
        border-radius: var(--radius-tiny);
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    if (!changed.has("layer") || this._palette) return;
    this._before = this.session.layers.palette(this.layer);
    this._palette = this._before;
    if (!this._palette.column) return;
    this._method =
      this._palette.mode === "categorical"
        ? "unique"
        : this._palette.mode === "linear"
          ? "smooth"
          : "quantile";
    this._count = Math.min(9, Math.max(2, this._palette.points.length));
  }

  private get table(): Column[] {
    const { table } = this.layer;
    return (
      (table === undefined ? null : this.session.tables.find(table))?.columns.filter(
        colorsLayers,
      ) ?? []
    );
  }
  private get column(): Column | undefined {
    return this.table.find((column) => column.slug === this._palette?.column);
  }

  override render(): TemplateResult {
    const words = texts.colors;
    const { session, layer, _palette: palette, column } = this;
    if (!palette) return html``;
    return html`<strata-dialog docked heading=${words.title(labelOf(layer))} way_out=${texts.cancel} @closed=${() => this.onClosed()}>
      ${layer.table === undefined ? nothing : this.choices(palette, column)}
      ${this._problem ? html`<p class="error" role="alert">${this._problem}</p>` : nothing}
      ${palette.mode === "linear" ? nothing : this.rows(palette, column)} ${this.rest(palette)}
      <button slot="actions" @click=${() => this.keep(false)}>${words.only_me}</button>
      ${
        session.canCurate
          ? html`<button slot="actions" class="primary" ?disabled=${this._working} @click=${() => this.keep(true)}>${words.everyone}</button>`
          : nothing
      }
    </strata-dialog>`;
  }

  private choices(palette: Palette, column: Column | undefined): TemplateResult {
    const words = texts.colors;
    const numbers = column !== undefined && isNumber(column);
    return html`<div class="choices">
      <label class="full"
        ><span class="caption">${words.column}</span>
        <select name="column" @change=${(event: Event) => this.chooseColumn((event.target as HTMLSelectElement).value)}>
          <option value="" ?selected=${!palette.column}>${words.each_record}</option>
          ${this.table.map((each) => html`<option value=${each.slug} ?selected=${each.slug === palette.column}>${labelOf(each)}</option>`)}
        </select></label
      >
      ${
        numbers
          ? html`<label
              ><span class="caption">${words.method}</span>
              <select name="method" @change=${(event: Event) => this.choose({ method: (event.target as HTMLSelectElement).value as Method })}>
                ${(["quantile", "equal", "smooth", "unique"] as const).map(
                  (each) =>
                    html`<option value=${each} ?selected=${each === this._method}>${words.methods[each]}</option>`,
                )}
              </select></label
            >
            ${
              this._method === "unique" || this._method === "smooth"
                ? nothing
                : html`<label
                  ><span class="caption">${words.count}</span>
                  ${numberInput({ name: "count", value: this._count, min: 2, max: 9, changed: (text, input) => this.onCount(text, input) })}</label
                >`
            }
            ${
              this._method === "unique"
                ? nothing
                : html`<div class="full ramps" role="group" aria-label=${words.ramp}>
                  ${(Object.keys(kRamps) as Ramp[]).map(
                    (ramp) =>
                      html`<button aria-pressed=${ramp === this._ramp} aria-label=${words.ramps[ramp]} title=${words.ramps[ramp]} @click=${() => this.choose({ ramp })}>
                        <i ${styled({ background: cssGradient(rampPalette(ramp, 0, 1)) })}></i>
                      </button>`,
                  )}
                </div>`
            }`
          : nothing
      }
    </div>`;
  }

  /**
   * Returns whether the point's record exists. A palette also has colors for future records, which
   * have no name and no row.
   */
  private isThere({ at }: PalettePoint): boolean {
    const { table } = this.layer;
    return (
      this._palette?.column !== undefined ||
      table === undefined ||
      !this.session.tables.lacks(table, at)
    );
  }

  private rows(palette: Palette, column: Column | undefined): TemplateResult {
    const words = texts.colors;
    const name = (point: PalettePoint, index: number): string => {
      if (!palette.column) return describeValue(this.layer, point.at, this.session.tables);
      if (palette.mode === "categorical") return valueLabel(point, column, this.session.tables);
      return classRange(point.at, palette.points[index + 1]?.at ?? palette.max, column?.unit ?? "");
    };
    return html`<ul>
      ${palette.points.map((point, index) => {
        if (!this.isThere(point)) return nothing;
        const text = name(point, index);
        const records = this._classes?.classes[index]?.records;
        return html`<li>
          <input
            type="color"
            ${styled(swatchStyle(point))}
            aria-label=${words.color_of(text)}
            .value=${opaqueColor(point.color)}
            @input=${(event: Event) => this.changePoint(index, { color: `${(event.target as HTMLInputElement).value}ff` })}
          />
          <span class="ellipsis" title=${text}>${text}</span>
          <span class="hint">${records === undefined ? "" : formatCount(records)}</span>
          <select
            aria-label=${words.pattern_of(text)}
            @change=${(event: Event) => this.changePoint(index, { pattern: (event.target as HTMLSelectElement).value as (typeof kPatterns)[number] })}
          >
            ${kPatterns.map((pattern) => html`<option value=${pattern} ?selected=${pattern === (point.pattern ?? "solid")}>${words.patterns[pattern]}</option>`)}
          </select>
        </li>`;
      })}
    </ul>`;
  }

  /**
   * Renders the row for values outside the classes, and the switch for the patterns of all classes.
   */
  private rest(palette: Palette): TemplateResult {
    const words = texts.colors;
    const { _classes: classes } = this;
    const patterned = palette.points.some((point) => (point.pattern ?? "solid") !== "solid");
    const byRecord =
      this.layer.table !== undefined &&
      !palette.column &&
      !palette.others &&
      palette.points.length > 0;
    return html`${byRecord ? html`<p class="hint">${words.further}</p>` : nothing}
    ${
      classes && (classes.unclassified > 0 || classes.without > 0)
        ? html`<p class="hint">
          ${classes.unclassified > 0 ? words.unclassified(classes.unclassified) : nothing} ${classes.without > 0 ? words.without_count(classes.without) : nothing}
        </p>`
        : nothing
    }
    ${
      palette.mode === "linear" || palette.points.length === 0
        ? nothing
        : html`<label class="check" title=${words.patterned_hint}
          ><input type="checkbox" .checked=${patterned} @change=${(event: Event) => this.patternAll((event.target as HTMLInputElement).checked)} /><span
            >${words.patterned}</span
          ></label
        >`
    }`;
  }

  // ── choices ────────────────────────────────────────────────────────────────────────────────────

  private chooseColumn(slug: string): void {
    const column = this.table.find((each) => each.slug === slug);
    this._classes = null;
    this._problem = "";
    if (!column) {
      this._asked += 1;
      this.show(recordPalette());
      return;
    }
    this._method = isNumber(column) ? "quantile" : "unique";
    void this.classify(column);
  }

  private onCount(text: string, input: HTMLInputElement): void {
    this.choose({ count: readNumber(text) });
    input.value = typedNumber(this._count);
  }

  private choose({
    method = this._method,
    count = this._count,
    ramp = this._ramp,
  }: {
    method?: Method;
    count?: number;
    ramp?: Ramp;
  }): void {
    const { column } = this;
    this._method = method;
    this._count = Number.isInteger(count) ? Math.min(9, Math.max(2, count)) : this._count;
    this._ramp = ramp;
    if (column) void this.classify(column);
  }

  /** Requests the classes and shows them. Ignores a response if a later request was sent. */
  private async classify(column: Column): Promise<void> {
    const asked = ++this._asked;
    const { layer, _method: method, _count: count, _ramp: ramp } = this;
    try {
      const numbers = method !== "unique";
      const classes = await this.session.api.json("GET /tables/{table}/columns/{column}/classes", {
        path: { table: layer.table!, column: column.slug },
        query: {
          method: method === "smooth" ? "equal" : method,
          count: numbers ? (method === "smooth" ? 1 : count) : kMostCategories,
        },
      });
      if (asked !== this._asked) return;
      this._classes = method === "smooth" ? null : classes;
      this._problem = classes.classes.length === 0 ? texts.colors.no_values : "";
      if (classes.classes.length === 0) return;
      const limits = classes.classes.map(({ from = 0, to = 0 }) => ({ from, to }));
      if (method === "smooth")
        this.show({ ...rampPalette(ramp, limits[0]!.from, limits[0]!.to), column: column.slug });
      else if (numbers)
        this.show(graduatedPalette(column.slug, limits, rampColors(ramp, limits.length)));
      else this.show(this.categories(column, classes));
    } catch (error) {
      notices.error(error);
    }
  }

  private categories(column: Column, { classes }: ColumnClasses): Palette {
    const colors = classes.map(
      (_, index) => kClassColors[index] ?? rampColors("viridis", classes.length)[index]!,
    );
    if (!isNumber(column)) {
      return categoryPalette(
        column.slug,
        classes.map(({ value = "" }, index) => ({ value, label: "", color: colors[index]! })),
      );
    }
    const points = classes
      .map(({ value = "0" }, index) => ({ at: Number(value), color: colors[index]! }))
      .sort((a, b) => a.at - b.at);
    this._classes = {
      ...this._classes!,
      classes: [...classes].sort((a, b) => Number(a.value) - Number(b.value)),
    };
    return {
      mode: "categorical",
      column: column.slug,
      min: points[0]?.at ?? 0,
      max: points[points.length - 1]?.at ?? 1,
      points,
    };
  }

  private changePoint(index: number, change: Partial<PalettePoint>): void {
    const palette = this._palette!;
    this.show({
      ...palette,
      points: palette.points.map((point, at) => (at === index ? { ...point, ...change } : point)),
    });
  }

  /** Gives neighboring classes different patterns, or removes all patterns. */
  private patternAll(patterned: boolean): void {
    const palette = this._palette!;
    const turns = [
      ...kAngles.map((angle) => ({ pattern: "hatch" as const, angle })),
      { pattern: "dots" as const, angle: 45 },
      { pattern: "outline" as const, angle: 45 },
      { pattern: "solid" as const, angle: 45 },
    ];
    const points = palette.points.map((point, index) => ({
      ...point,
      ...(patterned ? turns[index % turns.length]! : { pattern: "solid" as const }),
    }));
    this.show({ ...palette, points });
  }

  private show(palette: Palette): void {
    this._palette = palette;
    this.session.layers.previewPalette(this.layer, palette);
  }

  // ── saving and closing ─────────────────────────────────────────────────────────────────────────

  private async keep(forEveryone: boolean): Promise<void> {
    const { layer, _palette: palette } = this;
    if (!forEveryone && palette) this.session.layers.setPalette(layer, palette);
    if (forEveryone && palette) {
      this._working = true;
      try {
        await this.session.layers.change(layer, { palette });
        this.session.layers.setPalette(layer, null);
      } catch (error) {
        notices.error(error);
        return;
      } finally {
        this._working = false;
      }
    }
    this._before = null;
    this.dispatchEvent(new CustomEvent("closed"));
  }

  /** Runs when another dialog replaces this one, or when the page closes. */
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.restore();
  }

  private onClosed(): void {
    this.restore();
    this.dispatchEvent(new CustomEvent("closed"));
  }

  /** Restores the previous palette if nothing was saved. */
  private restore(): void {
    const { _before: before } = this;
    this._before = null;
    if (!before || !this.session.layers.find(this.layer.id)) return;
    this.session.layers.setPalette(
      this.layer,
      samePalette(before, this.layer.palette) ? null : before,
    );
  }
}

const rampPalette = (ramp: Ramp, from: number, to: number): Palette => {
  const colors = rampColors(ramp, kRamps[ramp].length);
  return {
    mode: "linear",
    min: from,
    max: to,
    // a range of length zero has a single point
    points:
      to > from
        ? colors.map((color, index) => ({
            at: from + ((to - from) * index) / (colors.length - 1),
            color,
          }))
        : [{ at: from, color: colors[4]! }],
  };
};

declare global {
  interface HTMLElementTagNameMap {
    "strata-color-dialog": StrataColorDialog;
  }
}
