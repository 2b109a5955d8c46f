// <strata-brush-panel>: the value that the selected painting tool paints in the selected layer, and
// the options of the tool, such as the width of the brush and the extent of a fill.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { labelOf } from "../../domain/cells";
import { readNumber, typedNumber } from "../../core/locale";
import type { MarkKind } from "../../domain/marks";
import type { Layer } from "../../core/types";
import { describeValue } from "../../session/layer-values";
import { ask } from "../../ui/dialog";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import { withKey } from "../../ui/keys/command-keys";
import { unlockLabel, whyLocked } from "../../session/layer-lock";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { numberInput } from "../../ui/number-input";
import { radioGroup } from "../../ui/radio-group";
import { numberFieldStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "./brush-width";
import "./shape-picker";
import "../../session/fields/value-picker";

/** A request to open the dialog that fills by a condition. */
export type WhereRequest = { dialog: "where"; layer: Layer };

@customElement("strata-brush-panel")
export class StrataBrushPanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "painting", "layers", "tools", "tables", "marks", "shapes", "view");
  }

  static override styles = [
    sharedStyles,
    numberFieldStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-3);
      }
      h2 {
        font-size: var(--text-large);
      }
      .slant {
        display: grid;
        grid-template-columns: 1fr 5.75rem;
        align-items: center;
        gap: var(--space-3);
      }
      .slant .check input:disabled + span {
        opacity: var(--unavailable);
      }
      .locked {
        display: flex;
        gap: var(--space-2);
        align-items: start;
        padding: var(--space-2) var(--space-3);
        border: var(--edge) solid var(--calm);
        border-radius: var(--radius-small);
        background: var(--calm-soft);
        font-size: var(--text-small);
        overflow-wrap: anywhere;
      }
      .locked .glyph {
        flex: none;
      }
      .pair {
        display: flex;
        flex-wrap: wrap;
        gap: var(--space-2);
      }
      .pair .segments {
        flex: 1 1 auto;
      }
    `,
  ];

  override render(): TemplateResult {
    const { session } = this;
    const layer = session.layers.selected;
    if (!layer) return html`<p class="hint">${texts.brush.no_layer}</p>`;
    const tool = session.tools.active;
    if (session.lockedTarget) return this.locked(session.lockedTarget);
    if (tool === "brush" || tool === "eraser") return this.strokes(layer, tool === "eraser");
    if (tool === "line" || tool === "point") return this.marks(layer, tool);
    if (tool === "strokes" || tool === "bucket" || tool === "lasso") return this.areas(layer, tool);
    return this.areas(layer, "polygon");
  }

  private locked(layer: Layer): TemplateResult {
    const { layers, canCurate } = this.session;
    const unlock = (): void =>
      void layers.change(layer, { locked: false }).catch((error: unknown) => notices.error(error));
    return html`<h2>${texts.tools[this.session.tools.active]}</h2>
      <p class="locked" role="status">${icon("lock")}<span>${whyLocked(layer)}</span></p>
      ${canCurate ? html`<button @click=${unlock}>${icon("unlock")}${unlockLabel(layer)}</button>` : nothing}`;
  }

  private strokes(layer: Layer, erases: boolean): TemplateResult {
    return html`<h2>${erases ? texts.brush.eraser_title : texts.brush.title}</h2>
      ${erases ? html`<p class="hint">${texts.brush.erases(labelOf(layer))}</p>` : this.value(layer)}
      <strata-brush-width .session=${this.session}></strata-brush-width>
      <strata-shape-picker .session=${this.session}></strata-shape-picker>
      ${this.through()} ${this.slant()} ${this.session.painting.penUsed ? this.pressure() : nothing} ${erases ? nothing : this.whole(layer)}`;
  }

  private areas(layer: Layer, tool: "bucket" | "lasso" | "polygon" | "strokes"): TemplateResult {
    const { session } = this;
    const { painting } = session;
    const { erases, reach } = painting.brush.areas;
    const words = texts.areas;
    return html`<h2>${texts.tools[tool]}</h2>
      <p class="hint">${words.how[tool]}</p>
      ${tool === "bucket" || tool === "strokes" ? nothing : this.snaps()}
      ${tool === "bucket" || !session.selection ? nothing : html`<strata-selection-panel .session=${session}></strata-selection-panel>`}
      ${radioGroup<boolean>({
        label: words.does,
        class: "segments",
        choices: [
          { value: false, content: words.paints },
          { value: true, content: words.erases },
        ],
        chosen: erases,
        choose: (chosen) => painting.setBrush((brush) => (brush.areas.erases = chosen)),
      })}
      ${erases ? html`<p class="hint">${texts.brush.erases(labelOf(layer))}</p>` : this.value(layer)}
      ${
        tool === "bucket"
          ? radioGroup<typeof reach>({
              label: words.reach,
              class: "segments",
              choices: [
                { value: "connected", content: words.connected, title: words.connected_hint },
                { value: "island", content: words.island, title: words.island_hint },
              ],
              chosen: reach,
              choose: (chosen) => painting.setBrush((brush) => (brush.areas.reach = chosen)),
            })
          : this.through()
      }
      ${this.whole(layer)}`;
  }

  /** Renders the fields for the record and the column of new lines and points. */
  private marks(layer: Layer, kind: MarkKind): TemplateResult {
    const { marks } = this.session;
    const words = texts.marks;
    const columns = marks.columns(kind);
    const { table } = layer;
    if (table === undefined || columns.length === 0)
      return html`<h2>${texts.tools[kind]}</h2><p class="hint">${words.no_column[kind]}</p>`;
    const choose = (event: Event): void => {
      const chosen = columns.find(
        ({ id }) => `${id}` === (event.target as HTMLSelectElement).value,
      );
      if (chosen) marks.chooseColumn(table, chosen);
    };
    return html`<h2>${texts.tools[kind]}</h2>
      <p class="hint">${words.how[kind]}</p>
      ${kind === "line" ? this.snaps() : nothing} ${this.value(layer)}
      ${
        columns.length > 1
          ? html`<label class="field">
            <span>${words.into}</span>
            <select @change=${choose}>
              ${columns.map((column) => html`<option value=${column.id} ?selected=${column.id === marks.column(kind)?.id}>${labelOf(column)}</option>`)}
            </select>
          </label>`
          : nothing
      }`;
  }

  private value(layer: Layer): TemplateResult {
    return html`<strata-value-picker
      .session=${this.session}
      .layer=${layer}
      .value=${this.session.painting.brush.valueFor(layer)}
    ></strata-value-picker>`;
  }

  private through(): TemplateResult {
    return this.option("through", texts.areas.through);
  }

  private pressure(): TemplateResult {
    return this.option("pressure", texts.brush.pressure);
  }

  private snaps(): TemplateResult {
    return this.option("snaps", texts.areas.snaps, withKey(texts.areas.snaps, "polygon.snap"));
  }

  private option(
    name: "through" | "pressure" | "snaps",
    label: string,
    title: string | typeof nothing = nothing,
  ): TemplateResult {
    const { painting } = this.session;
    return html`<label class="check" title=${title}>
      <input
        type="checkbox"
        .checked=${painting.brush[name]}
        @change=${(event: Event) => {
          const { checked } = event.target as HTMLInputElement;
          painting.setBrush((brush) => (brush[name] = checked));
        }}
      />
      <span>${label}</span>
    </label>`;
  }

  private slant(): TemplateResult {
    const { painting } = this.session;
    const { slant, through } = painting.brush;
    const limited = slant.limited && !through;
    return html`<div class="slant">
      <label class="check" title=${through ? texts.brush.slant_through : ""}>
        <input
          type="checkbox"
          .checked=${limited}
          ?disabled=${through}
          @change=${(event: Event) => {
            const { checked } = event.target as HTMLInputElement;
            painting.setBrush((brush) => (brush.slant.limited = checked));
          }}
        />
        <span>${texts.brush.slant}</span>
      </label>
      <span class="number">
        ${numberInput({
          label: texts.brush.slant_degrees,
          value: slant.maxDeg,
          min: 1,
          max: 90,
          disabled: !limited,
          changed: (text, input) => {
            painting.setBrush((brush) => brush.setSlant(readNumber(text)));
            input.value = typedNumber(painting.brush.slant.maxDeg);
          },
        })}
        <span>°</span>
      </span>
    </div>`;
  }

  /** Renders the edits that affect the whole layer and need no pointer. */
  private whole(layer: Layer): TemplateResult {
    const detail: WhereRequest = { dialog: "where", layer };
    const askWhere = (): void =>
      void this.dispatchEvent(new CustomEvent<WhereRequest>("request", { detail }));
    return html`<div class="pair">
      <button class="quiet" @click=${() => void this.fill(layer)}>${icon("drop")}${texts.brush.fill}</button>
      <button class="quiet" @click=${askWhere}>${icon("formula")}${texts.areas.where}</button>
    </div>`;
  }

  private async fill(layer: Layer): Promise<void> {
    const what = describeValue(
      layer,
      this.session.painting.brush.valueFor(layer),
      this.session.tables,
    );
    const words = texts.brush;
    if (
      await ask({
        heading: words.fill_title(labelOf(layer)),
        lead: words.fill_lead(what),
        yes: words.fill,
      })
    ) {
      this.session.painting.fill(layer);
    }
  }
}
