// <strata-layer-panel>: the layers from top to bottom, as this person sees them. Tools paint on the
// selected one.

import { recomputeLayer } from "../../net/layers";
import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { descriptionIn, labelOf } from "../../domain/cells";
import { isAsComputed, valueRange, type Layer, type LayerPatch } from "../../core/types";
import { askToTrash, tellTrashed } from "../../ui/trash";
import { openTrashOf } from "../../ui/trash-dialog";
import { ask } from "../../ui/dialog";
import { DragOrder } from "../../ui/drag-order";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import { unlockLabel } from "../../session/layer-lock";
import { layerPanelStyles } from "./layer-panel-styles";
import { canBeColored } from "./color-dialog";
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
  | { dialog: "edit" | "colors" | "statistics" | "map"; layer: Layer };

@customElement("strata-layer-panel")
export class StrataLayerPanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _computing: number | null = null;
  private readonly _drag = new DragOrder<number>(
    this,
    () => this.shown.map(({ id }) => id),
    (id, to) => {
      const layer = this.session.layers.find(id);
      if (layer) this.move(layer, to);
    },
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
  ];

  /** Top to bottom. */
  private get shown(): Layer[] {
    return [...this.session.layers.all].reverse();
  }

  override render(): TemplateResult {
    const { session } = this;
    const words = texts.layers;
    const shown = this.shown;
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
          : html`<ul class="list" @dragover=${this._drag.overList} @drop=${this._drag.drop}>
            ${repeat(
              shown,
              (layer) => layer.id,
              (layer, index) => this.row(layer, index),
            )}
          </ul>`
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
    const count = session.layers.all.length;
    return html`<li
      class="layer ${selected ? "selected" : ""} ${this._drag.classes(layer.id, index)}"
      @dragover=${(event: DragEvent) => this._drag.overRow(event, index)}
    >
      <div class="line">
        ${
          count > 1
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
        ${layer.locked ? html`<span class="lock" role="img" aria-label=${this.whoIsLocked(layer)} title=${this.whoIsLocked(layer)}>${icon("lock")}</span>` : nothing}
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
                  ${icon("upload")}${texts.maps.menu}
                </button>`
              : nothing
          }
          <hr />
          <button class="quiet" role="menuitem" ?disabled=${index === 0} @click=${() => this.move(layer, index - 1)}>
            ${icon("up")}${words.up}
          </button>
          <button class="quiet" role="menuitem" ?disabled=${index === count - 1} @click=${() => this.move(layer, index + 1)}>
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
      ${layer.locked ? this.lockTold(layer) : nothing} ${layer.edited_by_hand === true ? this.handTold(layer) : nothing} ${layer.review ? this.reviewTold(layer) : nothing}
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

  private whoIsLocked(layer: Layer): string {
    if (isAsComputed(layer)) return texts.layers.locked_computed;
    return this.session.isLocked(layer)
      ? texts.layers.locked_to_you
      : texts.layers.locked_to_others;
  }

  private lockTold(layer: Layer): TemplateResult {
    const unlock = (): void => void this.change(layer, { locked: false });
    return html`<p class="locked">
      ${icon("lock")}<span>${this.whoIsLocked(layer)}</span>
      ${this.session.canCurate ? html`<button class="link" @click=${unlock}>${unlockLabel(layer)}</button>` : nothing}
    </p>`;
  }

  private handTold(layer: Layer): TemplateResult {
    return html`<p class="locked by-hand">
      ${icon("edit")}<span>${layer.expression === undefined ? texts.layers.by_hand : `${texts.layers.by_hand} ${texts.layers.by_hand_formula}`}</span>
    </p>`;
  }

  private reviewTold(layer: Layer): TemplateResult {
    const { canCurate, reviews } = this.session;
    const waiting = reviews.waitingOn(layer);
    return html`<p class="locked">
      ${icon("shield")}<span>${canCurate ? texts.review.asked : texts.review.asked_of_you} ${waiting > 0 ? texts.review.waiting(waiting) : nothing}</span>
    </p>`;
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

  /** Anyone who may change the layer may recompute it: its lock only prevents editing by hand. */
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

  /** `index` counts from the top of the displayed list, without the layer itself. */
  private move(layer: Layer, index: number): void {
    const last = this.session.layers.all.length - 1;
    this.session.layers.move(layer, last - index);
  }

  private async saveDefault(): Promise<void> {
    try {
      await this.session.layers.saveOverridesAsDefault();
      notices.show("success", texts.layers.saved_default);
    } catch (error) {
      notices.error(error);
    }
  }

  /** Changes to a value type that has room for more keys. */
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
