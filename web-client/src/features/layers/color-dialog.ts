// <strata-color-dialog>: what a layer is drawn with: by a column of its records, and colours and
// patterns of its classes. What is chosen is seen on the model at once, by this person alone until
// it is kept.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { holds_files, is_number, label_of } from "../../domain/cells";
import { format_count, read_number, typed_number } from "../../core/locale";
import { holds_marks } from "../../domain/marks";
import {
  category_palette,
  css_gradient,
  graduated_palette,
  kClassColors,
  kRamps,
  opaque_color,
  ramp_colors,
  record_palette,
  swatch_style,
  type Ramp,
} from "../../domain/palette";
import type { Column, ColumnClasses } from "../../core/protocol.gen";
import type { Layer, Palette, PalettePoint } from "../../core/types";
import { describe_value } from "../../session/layer-values";
import "../../ui/dialog";
import { follow_session } from "../../session/follow-session";
import { class_range, value_label } from "./legend";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { number_input } from "../../ui/number-input";
import { choices_styles, shared_styles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";

type Method = "unique" | "equal" | "quantile" | "smooth";
const kPatterns = ["solid", "hatch", "dots", "outline"] as const;
const kAngles = [45, 135, 0, 90]; // of hatches, in turn
const kMostCategories = 30;

/** Layers with classes, and those whose records have columns. */
export const can_be_colored = (layer: Layer): boolean =>
  layer.table !== undefined ||
  layer.palette.mode === "step" ||
  (layer.palette.mode === "categorical" && layer.palette.points.length > 0);

const colors_layers = (column: Column): boolean =>
  column.kind !== "relation" && !holds_files(column) && !holds_marks(column);

@customElement("strata-color-dialog")
export class StrataColorDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private method_: Method = "unique";
  @state() private count_ = 5;
  @state() private ramp_: Ramp = "viridis";
  @state() private palette_: Palette | null = null;
  @state() private classes_: ColumnClasses | null = null;
  @state() private problem_ = "";
  @state() private working_ = false;
  private before_: Palette | null = null; // what this person saw
  private asked_ = 0;

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    choices_styles,
    css`
      ul {
        display: grid;
        gap: 0.375rem;
        margin: 0;
        padding: 0;
        list-style: none;
        max-height: 42dvh;
        overflow: auto;
      }
      li {
        display: grid;
        grid-template-columns: 1.375rem 2.125rem minmax(0, 1fr) auto 6rem;
        align-items: center;
        gap: 0.5625rem;
        font-size: 0.9rem;
      }
      li .swatch {
        width: 1.375rem;
        height: 1.375rem;
      }
      li input[type="color"] {
        width: 2.125rem;
        height: 1.75rem;
        padding: 2px;
      }
      li select {
        min-height: 1.875rem;
        padding: 2px 0.375rem;
      }
      .ramps {
        display: flex;
        gap: 0.5rem;
      }
      .ramps button {
        flex: 1;
        min-height: 1.875rem;
        padding: 5px;
      }
      .ramps i {
        display: block;
        width: 100%;
        height: 1rem;
        border-radius: 4px;
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    if (!changed.has("layer") || this.palette_) return;
    this.before_ = this.session.layers.palette(this.layer);
    this.palette_ = this.before_;
    if (!this.palette_.column) return;
    this.method_ =
      this.palette_.mode === "categorical"
        ? "unique"
        : this.palette_.mode === "linear"
          ? "smooth"
          : "quantile";
    this.count_ = Math.min(9, Math.max(2, this.palette_.points.length));
  }

  private get table(): Column[] {
    const { table } = this.layer;
    return (
      (table === undefined ? null : this.session.tables.find(table))?.columns.filter(
        colors_layers,
      ) ?? []
    );
  }
  private get column(): Column | undefined {
    return this.table.find((column) => column.slug === this.palette_?.column);
  }

  override render(): TemplateResult {
    const words = texts.colors;
    const { session, layer, palette_: palette, column } = this;
    if (!palette) return html``;
    return html`<strata-dialog aside heading=${words.title(label_of(layer))} way_out=${texts.cancel} @closed=${() => this.on_closed()}>
      ${layer.table === undefined ? nothing : this.choices(palette, column)}
      ${this.problem_ ? html`<p class="error" role="alert">${this.problem_}</p>` : nothing}
      ${palette.mode === "linear" ? nothing : this.rows(palette, column)} ${this.rest(palette)}
      <button slot="actions" @click=${() => this.keep(false)}>${words.only_me}</button>
      ${
        session.can_curate
          ? html`<button slot="actions" class="primary" ?disabled=${this.working_} @click=${() => this.keep(true)}>${words.everyone}</button>`
          : nothing
      }
    </strata-dialog>`;
  }

  private choices(palette: Palette, column: Column | undefined): TemplateResult {
    const words = texts.colors;
    const numbers = column !== undefined && is_number(column);
    return html`<div class="choices">
      <label class="full"
        ><span class="caption">${words.column}</span>
        <select name="column" @change=${(event: Event) => this.choose_column((event.target as HTMLSelectElement).value)}>
          <option value="" ?selected=${!palette.column}>${words.each_record}</option>
          ${this.table.map((each) => html`<option value=${each.slug} ?selected=${each.slug === palette.column}>${label_of(each)}</option>`)}
        </select></label
      >
      ${
        numbers
          ? html`<label
              ><span class="caption">${words.method}</span>
              <select name="method" @change=${(event: Event) => this.choose({ method: (event.target as HTMLSelectElement).value as Method })}>
                ${(["quantile", "equal", "smooth", "unique"] as const).map(
                  (each) =>
                    html`<option value=${each} ?selected=${each === this.method_}>${words.methods[each]}</option>`,
                )}
              </select></label
            >
            ${
              this.method_ === "unique" || this.method_ === "smooth"
                ? nothing
                : html`<label
                  ><span class="caption">${words.count}</span>
                  ${number_input({ name: "count", value: this.count_, min: 2, max: 9, changed: (text, input) => this.on_count(text, input) })}</label
                >`
            }
            ${
              this.method_ === "unique"
                ? nothing
                : html`<div class="full ramps" role="group" aria-label=${words.ramp}>
                  ${(Object.keys(kRamps) as Ramp[]).map(
                    (ramp) =>
                      html`<button aria-pressed=${ramp === this.ramp_} aria-label=${words.ramps[ramp]} title=${words.ramps[ramp]} @click=${() => this.choose({ ramp })}>
                        <i ${styled({ background: css_gradient(ramp_palette(ramp, 0, 1)) })}></i>
                      </button>`,
                  )}
                </div>`
            }`
          : nothing
      }
    </div>`;
  }

  /** A palette has colours for records that may come: those have no name yet, and no line. */
  private is_there({ at }: PalettePoint): boolean {
    const { table } = this.layer;
    return (
      this.palette_?.column !== undefined ||
      table === undefined ||
      !this.session.tables.lacks(table, at)
    );
  }

  private rows(palette: Palette, column: Column | undefined): TemplateResult {
    const words = texts.colors;
    const name = (point: PalettePoint, index: number): string => {
      if (!palette.column) return describe_value(this.layer, point.at, this.session.tables);
      if (palette.mode === "categorical") return value_label(point, column, this.session.tables);
      return class_range(
        point.at,
        palette.points[index + 1]?.at ?? palette.max,
        column?.unit ?? "",
      );
    };
    return html`<ul>
      ${palette.points.map((point, index) => {
        if (!this.is_there(point)) return nothing;
        const text = name(point, index);
        const records = this.classes_?.classes[index]?.records;
        return html`<li>
          <span class="swatch" ${styled(swatch_style(point))}></span>
          <input
            type="color"
            aria-label=${words.color_of(text)}
            .value=${opaque_color(point.color)}
            @input=${(event: Event) => this.change_point(index, { color: `${(event.target as HTMLInputElement).value}ff` })}
          />
          <span class="ellipsis" title=${text}>${text}</span>
          <span class="hint numeric">${records === undefined ? "" : format_count(records)}</span>
          <select
            aria-label=${words.pattern_of(text)}
            @change=${(event: Event) => this.change_point(index, { pattern: (event.target as HTMLSelectElement).value as (typeof kPatterns)[number] })}
          >
            ${kPatterns.map((pattern) => html`<option value=${pattern} ?selected=${pattern === (point.pattern ?? "solid")}>${words.patterns[pattern]}</option>`)}
          </select>
        </li>`;
      })}
    </ul>`;
  }

  /** What the classes leave out, and a way to patterns for all. */
  private rest(palette: Palette): TemplateResult {
    const words = texts.colors;
    const { classes_: classes } = this;
    const patterned = palette.points.some((point) => (point.pattern ?? "solid") !== "solid");
    const by_record =
      this.layer.table !== undefined &&
      !palette.column &&
      !palette.others &&
      palette.points.length > 0;
    return html`${by_record ? html`<p class="hint">${words.further}</p>` : nothing}
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
          ><input type="checkbox" .checked=${patterned} @change=${(event: Event) => this.pattern_all((event.target as HTMLInputElement).checked)} /><span
            >${words.patterned}</span
          ></label
        >`
    }`;
  }

  // ── choices
  // ───────────────────────────────────────────────────────────────────────────────────────────────────────

  private choose_column(slug: string): void {
    const column = this.table.find((each) => each.slug === slug);
    this.classes_ = null;
    this.problem_ = "";
    if (!column) {
      this.asked_ += 1;
      this.show(record_palette());
      return;
    }
    this.method_ = is_number(column) ? "quantile" : "unique";
    void this.classify(column);
  }

  private on_count(text: string, input: HTMLInputElement): void {
    this.choose({ count: read_number(text) });
    input.value = typed_number(this.count_);
  }

  private choose({
    method = this.method_,
    count = this.count_,
    ramp = this.ramp_,
  }: {
    method?: Method;
    count?: number;
    ramp?: Ramp;
  }): void {
    const { column } = this;
    this.method_ = method;
    this.count_ = Number.isInteger(count) ? Math.min(9, Math.max(2, count)) : this.count_;
    this.ramp_ = ramp;
    if (column) void this.classify(column);
  }

  /** Asks for the classes and shows them; the newest question wins. */
  private async classify(column: Column): Promise<void> {
    const asked = ++this.asked_;
    const { layer, method_: method, count_: count, ramp_: ramp } = this;
    try {
      const numbers = method !== "unique";
      const classes = await this.session.api.classes(
        layer.table!,
        column.slug,
        method === "smooth" ? "equal" : method,
        numbers ? (method === "smooth" ? 1 : count) : kMostCategories,
      );
      if (asked !== this.asked_) return;
      this.classes_ = method === "smooth" ? null : classes;
      this.problem_ = classes.classes.length === 0 ? texts.colors.no_values : "";
      if (classes.classes.length === 0) return;
      const limits = classes.classes.map(({ from = 0, to = 0 }) => ({ from, to }));
      if (method === "smooth")
        this.show({ ...ramp_palette(ramp, limits[0]!.from, limits[0]!.to), column: column.slug });
      else if (numbers)
        this.show(graduated_palette(column.slug, limits, ramp_colors(ramp, limits.length)));
      else this.show(this.categories(column, classes));
    } catch (error) {
      notices.error(error);
    }
  }

  private categories(column: Column, { classes }: ColumnClasses): Palette {
    const colors = classes.map(
      (_, index) => kClassColors[index] ?? ramp_colors("viridis", classes.length)[index]!,
    );
    if (!is_number(column)) {
      return category_palette(
        column.slug,
        classes.map(({ value = "" }, index) => ({ value, label: "", color: colors[index]! })),
      );
    }
    const points = classes
      .map(({ value = "0" }, index) => ({ at: Number(value), color: colors[index]! }))
      .sort((a, b) => a.at - b.at);
    this.classes_ = {
      ...this.classes_!,
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

  private change_point(index: number, change: Partial<PalettePoint>): void {
    const palette = this.palette_!;
    this.show({
      ...palette,
      points: palette.points.map((point, at) => (at === index ? { ...point, ...change } : point)),
    });
  }

  /** Neighbours get patterns that differ, or all lose theirs. */
  private pattern_all(patterned: boolean): void {
    const palette = this.palette_!;
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
    this.palette_ = palette;
    this.session.layers.set_palette(this.layer, palette);
  }

  // ── the end
  // ───────────────────────────────────────────────────────────────────────────────────────────────────────

  private async keep(for_everyone: boolean): Promise<void> {
    const { layer, palette_: palette } = this;
    if (for_everyone && palette) {
      this.working_ = true;
      try {
        await this.session.layers.change(layer, { palette });
        this.session.layers.set_palette(layer, null);
      } catch (error) {
        notices.error(error);
        return;
      } finally {
        this.working_ = false;
      }
    }
    this.before_ = null;
    this.dispatchEvent(new CustomEvent("closed"));
  }

  /** Without a choice all is as it was before. */
  private on_closed(): void {
    if (this.before_)
      this.session.layers.set_palette(
        this.layer,
        this.before_ === this.layer.palette ? null : this.before_,
      );
    this.before_ = null;
    this.dispatchEvent(new CustomEvent("closed"));
  }
}

const ramp_palette = (ramp: Ramp, from: number, to: number): Palette => {
  const colors = ramp_colors(ramp, kRamps[ramp].length);
  return {
    mode: "linear",
    min: from,
    max: to,
    // Without a range one point stands for all.
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
