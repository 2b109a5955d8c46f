// <strata-selection-bar>: a bar over the 3D view while polygon, lasso, wand or strokes have selected
// an area, and always while the tool for strokes is active. It shows the area's size and the effect
// of the next part. Its controls change, save, paint, erase or discard the selection. While there are
// strokes, it only shows their controls, so that it leaves room to draw on a phone. It is in the page
// while one of these tools is active, because screen readers announce only changes of an element
// that already exists.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { formatPercent } from "../../core/locale";
import type { KeyStatistics } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { labelOf } from "../../domain/cells";
import { formatArea, formatNumber } from "../../domain/measure";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import type { SelectionRequest, TablePanelRequest } from "../../session/requests";
import { icon, type IconName } from "../../ui/icons";
import "../../ui/menu";
import { notices } from "../../ui/notices";
import { radioGroup } from "../../ui/radio-group";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import type { Selection, SelectionMode } from "./selection";
import "./selection-border";
import { selectionOf } from "./selection-of";
import { strokeControls, strokeEnds } from "./stroke-controls";
import type { Strokes } from "./strokes";

const words = texts.selection;
const kModes: readonly SelectionMode[] = ["replace", "add", "subtract", "intersect"];
const kSteps = 120;
const kMostRecords = 300; // The filter of a table has at most 4096 characters.

type MenuItem = (
  glyph: IconName,
  title: string,
  act: () => void,
  disabled?: boolean,
) => TemplateResult;

@customElement("strata-selection-bar")
export class StrataSelectionBar extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "painting", "tools", "layers", "tables", "lit");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        position: absolute;
        inset: 0.75rem 5.75rem auto; /* left of the controls of the view */
        display: flex;
        justify-content: center;
        pointer-events: none;
      }
      .bar,
      .parts,
      .actions {
        display: flex;
        align-items: center;
        justify-content: center;
        gap: var(--space-2) var(--space-3);
      }
      .bar,
      .parts {
        flex-wrap: wrap;
      }
      .next {
        color: var(--ink-soft);
      }
      .bar {
        position: relative;
        padding: var(--space-2) var(--space-3);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--surface);
        color: var(--ink);
        box-shadow: var(--shadow);
        font-size: var(--text-body);
        pointer-events: auto;
      }
      output {
        min-width: 8.5rem;
        padding: 0 var(--space-2);
        font-weight: 600;
      }
      output small {
        display: block;
        color: var(--ink-soft);
        font-size: var(--text-small);
        font-weight: 400;
      }
      .segments {
        flex: none;
      }
      .segments button {
        padding: 0 var(--space-3);
      }
      label {
        display: flex;
        align-items: center;
        gap: var(--space-2);
      }
      label .numeric {
        min-width: 4rem;
      }
      @media (max-width: 560px) {
        :host {
          inset: auto 4.75rem 0.75rem 0.5rem;
        }
        .actions {
          flex-wrap: wrap;
        }
        .ends strata-menu {
          display: none; /* a phone always shows the buttons that undo and redo strokes */
        }
        output {
          min-width: 0;
          padding: 0;
        }
        .segments {
          flex: initial;
        }
        .segments button {
          padding: 0 var(--space-2);
        }
        .discard {
          position: absolute;
          inset: var(--space-1) var(--space-1) auto auto;
        }
      }
    `,
  ];

  /** Shows the elements that wait for the selection, which this bar makes. */
  override firstUpdated(): void {
    this.session.painting.changed();
  }

  override render(): TemplateResult {
    const selection = selectionOf(this.session);
    const strokes = this.session.tools.active === "strokes" ? this.session.strokes : null;
    return html`<span class="visually-hidden" role="status">${this.announcement(selection, strokes)}</span>
      ${selection.isEmpty && !strokes ? nothing : this.bar(selection, strokes)}`;
  }

  private announcement({ isEmpty, measured }: Selection, strokes: Strokes | null): string {
    if (strokes?.isOpen && strokes.state !== "found") return texts.strokes.next[strokes.state];
    if (isEmpty || !measured) return "";
    if (measured.texels === 0) return words.nothing;
    return words.selected(formatArea(measured.area_m2), formatPercent(measured.share));
  }

  private bar(selection: Selection, strokes: Strokes | null): TemplateResult {
    if (strokes?.isOpen) return this.strokesBar(selection, strokes);
    return html`<div class="bar" role="group" aria-label=${words.title}>
      <div class="parts">
        ${strokes ? strokeControls(strokes) : nothing} ${selection.isEmpty ? nothing : this.parts(selection)}
      </div>
      ${selection.isEmpty ? nothing : this.actions(selection)}
    </div>`;
  }

  private strokesBar(selection: Selection, strokes: Strokes): TemplateResult {
    const isFound = strokes.state === "found";
    return html`<div class="bar" role="group" aria-label=${words.title}>
      <div class="parts">
        ${strokeControls(strokes)} ${isFound ? this.size(selection) : nothing}
      </div>
      ${isFound ? html`<div class="actions ends">${strokeEnds(strokes)} ${this.menu(selection, strokes)}</div>` : nothing}
    </div>`;
  }

  private size(selection: Selection): TemplateResult {
    const { measured, unmeasured } = selection;
    const elsewhere = selection.outlines.filter(({ outline }) => !selection.isInView(outline));
    const size = measured
      ? measured.texels > 0
        ? formatArea(measured.area_m2)
        : words.nothing
      : unmeasured
        ? words.unmeasured
        : words.measuring;
    const details =
      elsewhere.length > 0
        ? words.elsewhere(elsewhere.length)
        : measured
          ? words.share(formatPercent(measured.share))
          : "\u00a0";
    return html`<output class="numeric" aria-live="off">${size}<small>${details}</small></output>
      ${unmeasured ? html`<button @click=${() => selection.measureAgain()}>${texts.try_again}</button>` : nothing}`;
  }

  private parts(selection: Selection): TemplateResult {
    return html`${this.size(selection)}
      ${radioGroup<SelectionMode>({
        label: words.mode,
        class: "segments",
        choices: kModes.map((value) => ({
          value,
          content: words.modes[value],
          title: words.mode_hints[value],
        })),
        chosen: selection.mode,
        choose: (mode) => selection.setMode(mode),
      })}
      ${this.session.tools.active === "wand" ? this.tolerance(selection) : nothing}`;
  }

  private actions(selection: Selection): TemplateResult {
    const { erases } = this.session.painting.brush.areas;
    const { busy } = selection;
    return html`<div class="actions">
      ${
        selection.canDelete
          ? html`<button @click=${() => selection.deleteCorner()}>${words.delete_corner}</button>`
          : nothing
      }
      <strata-selection-border .selection=${selection}></strata-selection-border>
      <button class=${erases ? "" : "primary"} ?disabled=${busy} @click=${() => void selection.paint(false)}>${words.fill}</button>
      <button class=${erases ? "primary" : ""} ?disabled=${busy} @click=${() => void selection.paint(true)}>${words.erase}</button>
      ${this.menu(selection, null)}
      <button class="icon quiet discard" aria-label=${words.discard} title=${words.discard} @click=${() => selection.clear()}>${icon("close")}</button>
      </div>`;
  }

  private menu(selection: Selection, strokes: Strokes | null): TemplateResult {
    const item: MenuItem = (glyph, title, act, disabled = false) =>
      html`<button class="quiet" role="menuitem" ?disabled=${disabled} @click=${act}>${icon(glyph)}${title}</button>`;
    const drawn = texts.strokes;
    return html`<strata-menu label=${words.more}>
      ${strokes ? item("undo", drawn.undo, () => strokes.undo()) : item("undo", words.undo, () => selection.undo(), !selection.canUndo)}
      ${strokes ? item("redo", drawn.redo, () => strokes.redo(), !strokes.canRedo) : item("redo", words.redo, () => selection.redo(), !selection.canRedo)}
      ${this.recordItems(selection, item)}
      <hr />
      ${item("chart", words.statistics, () => this.request("selection-statistics"))}
      ${item("plus", words.save, () => this.request("save-selection"))}
      ${item("layers", words.saved, () => this.request("selections"))}
    </strata-menu>`;
  }

  /** Renders the items for a layer of records. */
  private recordItems(selection: Selection, item: MenuItem): TemplateResult | typeof nothing {
    const layer = this.session.layers.selected;
    if (layer?.table === undefined) return nothing;
    const { measured, busy } = selection;
    const found = measured?.layers[layer.slug]?.keys;
    const isTerms = this.session.tables.find(layer.table)?.kind === "terms";
    return html`<hr />
      ${isTerms ? nothing : item("plus", words.new_record, () => this.makeRecord(selection, layer), busy)}
      ${item("table", words.show_records, () => this.showRecords(layer, found ?? []), !found)}`;
  }

  /** Opens the form of a new record. When it is saved, the selection is painted with the record. */
  private makeRecord(selection: Selection, layer: Layer): void {
    const { painting } = this.session;
    if (!painting.areaTarget(true)) return;
    const made = (key: number): void => {
      painting.setBrush((brush) => brush.setValue(layer, key));
      if (this.session.layers.selected?.id === layer.id) void selection.paint(false);
    };
    this.send({ dialog: "record", layer, key: null, made });
  }

  /** Shows the records in the selection, those with the largest areas first if there are many. */
  private showRecords(layer: Layer, found: readonly KeyStatistics[]): void {
    const keys = [...found].sort((a, b) => b.area_m2 - a.area_m2).map(({ key }) => key);
    if (keys.length === 0) notices.show("info", words.no_records(labelOf(layer)));
    else this.session.tables.showRows(layer, keys.slice(0, kMostRecords));
    if (keys.length > kMostRecords) notices.show("info", words.most_records(kMostRecords));
  }

  private request(dialog: SelectionRequest["dialog"]): void {
    this.send({ dialog });
  }

  private send(detail: SelectionRequest | TablePanelRequest): void {
    this.dispatchEvent(
      new CustomEvent<SelectionRequest | TablePanelRequest>("request", {
        detail,
        bubbles: true,
        composed: true,
      }),
    );
  }

  private tolerance({ wand }: Selection): TemplateResult | typeof nothing {
    const { by, tolerance, mostTolerance } = wand;
    if (mostTolerance <= 0) return nothing;
    const told = texts.wand.amount[by](formatNumber(tolerance));
    return html`<label title=${texts.wand.tolerance_hints[by]}>
      <span>${texts.wand.tolerance}</span>
      <input
        type="range"
        min="0"
        max=${kSteps}
        step="1"
        aria-valuetext=${told}
        .value=${String(Math.round((tolerance / mostTolerance) * kSteps))}
        @input=${(event: Event) => wand.setTolerance((Number((event.target as HTMLInputElement).value) / kSteps) * mostTolerance)}
      />
      <span class="numeric" aria-hidden="true">${told}</span>
    </label>`;
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-selection-bar": StrataSelectionBar;
  }
}
