// <strata-layer-panel>: the layers from top to bottom, in this user's order. Tools paint on the
// selected layer.

import { recomputeLayer } from "../../net/layers";
import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { descriptionIn, labelOf } from "../../domain/cells";
import { valueRange, type Layer, type LayerPatch } from "../../core/types";
import { askToTrash, tellTrashed } from "../../ui/trash";
import { openTrashOf } from "../../ui/trash-dialog";
import { ask } from "../../ui/dialog";
import { DragOrder } from "../../ui/order/drag-order";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import { unlockLabel } from "../../session/layer-lock";
import {
  fits,
  isFiltered,
  kMostWithoutSearch,
  kNoFilter,
  layerFilter,
  layerFilterStyles,
} from "./layer-filter";
import { groupRow, groupRowStyles, regroup } from "./group-row";
import { groupsOf, placeAfterStep, withMoved } from "../../domain/layer-groups";
import { Kept } from "../../core/kept";
import { layerNotes, whoIsLocked } from "./layer-notes";
import { layerPanelStyles } from "./layer-panel-styles";
import { canBeColored } from "../../domain/palette";
import { layerChip, legend, legendStyles } from "./legend";
import "../../ui/panel/empty-state";
import "../../ui/menu";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { panelHeadingStyles } from "../../ui/panel/panel-styles";
import { dragStyles, sharedStyles } from "../../ui/styles";
import { chooseRaster, formatsOf, kFeatureFormats, saveFeatures, saveRaster } from "./raster-files";
import type { TermsRequest } from "../../session/requests";
import { withKey } from "../../ui/keys/command-keys";
import { texts } from "../../texts";
import { visibilityBadge } from "../../ui/visibility";

export type LayerPanelRequest =
  | TermsRequest
  | { dialog: "create" | "template" | "transfer" }
  | { dialog: "edit" | "colors" | "statistics" | "map" | "cleanup" | "pieces"; layer: Layer };

@customElement("strata-layer-panel")
export class StrataLayerPanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _computing: number | null = null;
  @state() private _filter = kNoFilter;
  private readonly _folded = new Kept<string[]>(() => localStorage, "strata.folded_groups", []);
  // a heading's id is the name of its group
  private readonly _drag = new DragOrder<number | string>(
    this,
    () => this.rows.map((row) => (typeof row === "string" ? row : row.id)),
    (id, to, over) => this.drop(id, to, over),
  );

  constructor() {
    super();
    followSession(this, "layers", "tables", "reviews");
  }

  static override styles = [
    sharedStyles,
    panelHeadingStyles,
    legendStyles,
    dragStyles,
    layerPanelStyles,
    layerFilterStyles,
    groupRowStyles,
  ];

  /** The layers from top to bottom. */
  private get shown(): Layer[] {
    return [...this.session.layers.all].reverse();
  }

  private get isLong(): boolean {
    return this.session.layers.all.length > kMostWithoutSearch;
  }
  private get isFiltered(): boolean {
    return this.isLong && isFiltered(this._filter);
  }

  /** The rows of the list: layers, and names of groups. */
  private get rows(): (Layer | string)[] {
    const { layers } = this.session;
    const { isFiltered: filtered, shown } = this;
    const found = filtered
      ? shown.filter((layer) => fits(layer, this._filter, layers.visible(layer)))
      : shown;
    return groupsOf(found).flatMap(({ name, layers: inside }) => {
      if (name === null) return inside;
      return this._folded.value.includes(name) && !filtered ? [name] : [name, ...inside];
    });
  }

  private group(name: string, layers: Layer[], index: number): TemplateResult {
    const folded = this._folded.value;
    const isFolded = folded.includes(name) && !this.isFiltered;
    return html`<li
      class="group ${this._drag.classes(name, index)}"
      @dragover=${(event: DragEvent) => this._drag.overRow(event, index)}
    >
      ${groupRow({
        session: this.session,
        name,
        layers,
        isFolded,
        fold: this.isFiltered
          ? null
          : () => {
              this._folded.value = isFolded
                ? folded.filter((each) => each !== name)
                : [...folded, name];
              this.requestUpdate();
            },
      })}
    </li>`;
  }

  /**
   * Moves the dragged row. `to` is the new index in the list without this row. The row joins the
   * group of the row under the pointer, or of the two rows between which it is dropped.
   */
  private drop(id: number | string, to: number, over: number | null): void {
    const layer = this.session.layers.find(Number(id));
    if (!layer) return;
    const { rows } = this;
    const target = over === null ? null : rows[over]!;
    const others = rows.filter((row) => row !== layer);
    const before = others.slice(0, to);
    const [above, below] = [before.at(-1), others[to]];
    const groupOf = (row: Layer | string | undefined): string =>
      typeof row === "string" ? row : (row?.group ?? "");
    // the upper half of a heading belongs to the end of the rows above it
    const isAbove = typeof target === "string" && !before.includes(target);
    const share = typeof below !== "string" && groupOf(above) === groupOf(below);
    const wanted =
      target !== null ? groupOf(isAbove ? above : target) : share ? groupOf(above) : layer.group;
    const group = this.session.canCurate ? (wanted ?? "") : (layer.group ?? "");
    if (group !== (layer.group ?? "")) void regroup(this.session, [layer], group);
    this.move({ ...layer, group: group || undefined }, this.placeOf(layer, above, below));
  }

  /** Returns the index for `layer` between two rows, in the list without `layer`. */
  private placeOf(
    layer: Layer,
    above: Layer | string | undefined,
    below: Layer | string | undefined,
  ): number {
    const listed = this.listed.filter((each) => each !== layer);
    const first = (name: string): number => listed.findIndex((each) => each.group === name);
    if (above === undefined) return 0;
    if (typeof above !== "string") return listed.indexOf(above) + 1;
    if (first(above) >= 0) {
      const isFolded = below === undefined || typeof below === "string" || below.group !== above;
      return isFolded
        ? first(above) + listed.filter((each) => each.group === above).length
        : first(above);
    }
    // the only neighbor is the heading of the dragged layer
    if (below === undefined) return listed.length;
    return typeof below === "string" ? first(below) : listed.indexOf(below);
  }

  /** All layers in the order of the list, including those of folded groups. */
  private get listed(): Layer[] {
    return groupsOf(this.shown).flatMap(({ layers }) => layers);
  }

  override render(): TemplateResult {
    const { session } = this;
    const words = texts.layers;
    const { shown, rows } = this;
    const groups = new Map(groupsOf(shown).map((group) => [group.name, group]));
    return html`<div class="heading">
        <h2>${words.title}</h2>
        ${
          session.canCurate
            ? html`<button @click=${() => this.request({ dialog: "create" })}>${icon("plus")}${words.new}</button>
              <strata-menu label=${words.more}>
                <button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "template" })}>
                  ${icon("layers")}${texts.templates.open}
                </button>
                <button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "terms", table: null, file: null })}>
                  ${icon("upload")}${texts.terms_dialog.open}
                </button>
                <button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "transfer" })}>
                  ${icon("import")}${texts.transfer.open}
                </button>
                <hr />
                <button class="quiet" role="menuitem" @click=${() => void openTrashOf(session)}>${icon("trash")}${texts.bin.open}</button>
              </strata-menu>`
            : nothing
        }
      </div>
      ${
        shown.length === 0
          ? html`<div class="empty">
            <strata-empty line=${words.empty_title} more=${words.empty_lead}></strata-empty>
            ${
              session.canCurate
                ? html`<button @click=${() => this.request({ dialog: "template" })}>${icon("layers")}${texts.templates.open}</button>`
                : nothing
            }
          </div>`
          : html`${this.isLong ? layerFilter(this._filter, (filter) => (this._filter = filter)) : nothing}
          <ul class="list" @dragover=${this._drag.overList} @drop=${this._drag.drop}>
            ${repeat(
              rows,
              (row) => (typeof row === "string" ? row : row.id),
              (row, index) =>
                typeof row === "string"
                  ? this.group(row, groups.get(row)!.layers, index)
                  : this.row(row, index),
            )}
          </ul>
          ${rows.length === 0 ? html`<p class="hint" role="status">${words.none_found}</p>` : nothing}`
      }
      ${
        session.layers.hasOverrides
          ? html`<div class="personal">
            <span>${words.personal}</span>
            ${
              session.canCurate
                ? html`<button class="link" @click=${() => void this.saveDefault()}>${words.save_default}</button>`
                : nothing
            }
            <button class="link" @click=${() => session.layers.resetOverrides()}>${words.reset_default}</button>
          </div>`
          : nothing
      }`;
  }

  private row(layer: Layer, index: number): TemplateResult {
    const { session } = this;
    const words = texts.layers;
    const selected = session.layers.selectedId === layer.id;
    const visible = session.layers.visible(layer);
    const groups = groupsOf(this.shown);
    const [above, below] = ([-1, 1] as const).map((step) => placeAfterStep(groups, layer, step));
    return html`<li
      class="layer ${layer.group ? "inside" : ""} ${selected ? "selected" : ""} ${this._drag.classes(layer.id, index)}"
      @dragover=${(event: DragEvent) => this._drag.overRow(event, index)}
    >
      <div class="line">
        ${
          session.layers.all.length > 1 && !this.isFiltered
            ? html`<span
              class="grip"
              draggable="true"
              title=${words.drag(labelOf(layer))}
              @dragstart=${(event: DragEvent) => this._drag.start(event, layer.id, labelOf(layer))}
              @dragend=${this._drag.end}
              >${icon("grip")}</span
            >`
            : nothing
        }
        <button
          class="icon quiet"
          aria-pressed=${visible}
          aria-label=${visible ? words.hide(labelOf(layer)) : words.show(labelOf(layer))}
          title=${visible ? words.hide(labelOf(layer)) : words.show(labelOf(layer))}
          @click=${() => session.layers.setVisible(layer, !visible)}
        >
          ${icon(visible ? "eye" : "eye_off")}
        </button>
        <button
          class="quiet name ${visible ? "" : "off"}"
          aria-pressed=${selected}
          aria-label=${words.select(labelOf(layer))}
          title=${labelOf(layer)}
          @click=${() => session.layers.select(layer)}
        >
          ${layerChip(session.layers.palette(layer))}<span class="ellipsis">${labelOf(layer)}</span>
        </button>
        ${visibilityBadge(layer.visibility)}
        ${layer.locked ? html`<span class="lock" role="img" aria-label=${whoIsLocked(session, layer)} title=${whoIsLocked(session, layer)}>${icon("lock")}</span>` : nothing}
        <strata-menu label=${words.options(labelOf(layer))}>
          ${
            session.canCurate
              ? html`<button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "edit", layer })}>
                  ${icon("edit")}${words.edit}
                </button>
                <button class="quiet" role="menuitem" @click=${() => void this.change(layer, { locked: !layer.locked })}>
                  ${icon(layer.locked ? "unlock" : "lock")}${layer.locked ? unlockLabel(layer) : words.lock}
                </button>
                ${
                  layer.expression === undefined
                    ? html`<button class="quiet" role="menuitem" @click=${() => void this.change(layer, { review: !layer.review })}>
                      ${icon("shield")}${layer.review ? texts.review.end : texts.review.begin}
                    </button>`
                    : nothing
                }`
              : nothing
          }
          ${
            canBeColored(layer)
              ? html`<button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "colors", layer })}>${icon("palette")}${texts.colors.open}</button>`
              : nothing
          }
          ${
            layer.table === undefined
              ? nothing
              : html`<button class="quiet" role="menuitem" @click=${() => session.tables.open(layer)}>${icon("table")}${texts.tables.open}</button>`
          }
          ${
            layer.table !== undefined && layer.type !== "u32" && session.canCurate
              ? html`<button class="quiet" role="menuitem" @click=${() => void this.widen(layer)}>${icon("plus")}${words.widen}</button>`
              : nothing
          }
          <button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "statistics", layer })}>
            ${icon("chart")}${words.statistics}
          </button>
          <hr />
          ${formatsOf(layer).map(
            (format) =>
              html`<button class="quiet" role="menuitem" @click=${() => saveRaster(session, layer, format)}>
                ${icon("import")}${texts.rasters.save[format]}
              </button>`,
          )}
          ${kFeatureFormats.map(
            (format) =>
              html`<button class="quiet" role="menuitem" @click=${() => saveFeatures(session, layer, format)}>
                ${icon("import")}${texts.rasters.save_outlines[format]}
              </button>`,
          )}
          ${
            session.canPaint && !session.isLocked(layer)
              ? html`<button class="quiet" role="menuitem" @click=${() => chooseRaster(session, layer)}>
                  ${icon("upload")}${texts.rasters.import}
                </button>
                <button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "map", layer })}>
                  ${icon("upload")}${texts.layers.paint_file}
                </button>
                <button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "cleanup", layer })}>
                  ${icon("eraser")}${texts.cleanup.open}
                </button>`
              : nothing
          }
          ${
            session.canPaint
              ? html`<button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "pieces", layer })}>
                  ${icon("table")}${texts.cleanup.open_pieces}
                </button>`
              : nothing
          }
          <hr />
          <button class="quiet" role="menuitem" ?disabled=${above === null} @click=${() => this.move(layer, above!)}>
            ${icon("up")}${words.up}
          </button>
          <button class="quiet" role="menuitem" ?disabled=${below === null} @click=${() => this.move(layer, below!)}>
            ${icon("down")}${words.down}
          </button>
          ${
            session.canCurate
              ? html`<hr />
                <button class="quiet" role="menuitem" @click=${() => void this.deleteLayer(layer)}>
                  ${icon("trash")}${words.delete}
                </button>`
              : nothing
          }
        </strata-menu>
      </div>
      ${selected ? this.details(layer) : nothing}
    </li>`;
  }

  private details(layer: Layer): TemplateResult {
    const { session } = this;
    const opacity = session.layers.opacity(layer);
    return html`<div class="more">
      ${layerNotes(session, layer, () => void this.change(layer, { locked: false }))}
      ${descriptionIn(layer) ? html`<p class="description">${descriptionIn(layer)}</p>` : nothing} ${legend(layer, session.layers.palette(layer), session.tables)}
      ${layer.expression === undefined ? nothing : this.formula(layer)}
      ${
        layer.table === undefined
          ? nothing
          : html`<button aria-pressed=${session.tables.view?.layerId === layer.id} title=${withKey(texts.tables.open, "table")} @click=${() => session.toggleTable()}>
            ${icon("table")}${texts.tables.open}
          </button>`
      }
      <div class="opacity">
        <span class="caption">${texts.layers.opacity}</span>
        <input
          type="range"
          min="0"
          max="100"
          .value=${String(Math.round(opacity * 100))}
          aria-label=${texts.layers.opacity_of(labelOf(layer))}
          @input=${(event: Event) => session.layers.setOpacity(layer, Number((event.target as HTMLInputElement).value) / 100)}
        />
        <output>${Math.round(opacity * 100)} %</output>
      </div>
    </div>`;
  }

  private async change(layer: Layer, change: LayerPatch): Promise<void> {
    await this.session.layers.change(layer, change).catch((error: unknown) => notices.error(error));
  }

  private formula(layer: Layer): TemplateResult {
    return html`<div class="formula">
      <code>${layer.expression}</code>
      ${
        layer.stale === true && layer.edited_by_hand !== true
          ? html`<span class="hint" role="status">${layer.recompute === "automatic" ? texts.layers.stale_automatic : texts.layers.stale}</span>`
          : nothing
      }
      ${
        this.mayRecompute(layer)
          ? html`<button ?disabled=${this._computing === layer.id} @click=${() => void this.recompute(layer)}>${icon("redo")}${texts.layers.recompute}</button>`
          : nothing
      }
    </div>`;
  }

  /**
   * Users who may change the layer may also recompute it. The lock of a computed layer only prevents
   * edits by hand.
   */
  private mayRecompute(layer: Layer): boolean {
    const { canPaint, canCurate } = this.session;
    return (
      (layer.locked || layer.edited_by_hand === true ? canCurate : canPaint) &&
      (layer.recompute !== "automatic" || layer.edited_by_hand === true)
    );
  }

  private async recompute(layer: Layer): Promise<void> {
    const { session } = this;
    const words = texts.layers;
    const byHand = layer.edited_by_hand === true;
    if (
      byHand &&
      !(await ask({
        heading: words.overwrite_title(layer.name),
        lead: words.overwrite_lead,
        yes: words.recompute,
      }))
    )
      return;
    this._computing = layer.id;
    try {
      session.layers.put(await recomputeLayer(session.api, session.modelId, layer.id, byHand));
    } catch (error) {
      notices.error(error);
    } finally {
      this._computing = null;
    }
  }

  private request(detail: LayerPanelRequest): void {
    this.dispatchEvent(new CustomEvent<LayerPanelRequest>("request", { detail }));
  }

  /**
   * `index` counts from the top of the list of all layers, without the layer itself. The layer
   * already has its new group.
   */
  private move(layer: Layer, index: number): void {
    const { layers } = this.session;
    const top = withMoved([...layers.all].reverse(), layer, index);
    layers.arrange(top.reverse().flatMap(({ id }) => layers.find(id) ?? []));
  }

  private async saveDefault(): Promise<void> {
    try {
      await this.session.layers.saveOverridesAsDefault();
      notices.show("success", texts.layers.saved_default);
    } catch (error) {
      notices.error(error);
    }
  }

  /** Changes the layer to a value type with more keys. */
  private async widen(layer: Layer): Promise<void> {
    const words = texts.layers;
    const [, highest] = valueRange(layer.type);
    if (
      !(await ask({
        heading: words.widen_title(labelOf(layer)),
        lead: words.widen_lead(highest),
        yes: words.widen_yes,
      }))
    )
      return;
    await this.session.layers
      .change(layer, { type: "u32" })
      .then(() => notices.show("success", words.widened))
      .catch((error: unknown) => notices.error(error));
  }

  private async deleteLayer(layer: Layer): Promise<void> {
    const words = texts.layers;
    const { api, layers, model } = this.session;
    if (!model) return;
    const gone = {
      kind: "layer",
      entry: `layer-${layer.id}`,
      name: layer.name,
      project: model.project,
    } as const;
    if (!(await askToTrash(api, gone, { title: words.delete_title, lead: words.delete_lead })))
      return;
    await layers.remove(layer).then(
      () => tellTrashed(api, gone),
      (error: unknown) => notices.error(error),
    );
  }
}
