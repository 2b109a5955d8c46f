// <strata-layer-panel>: the layers from top to bottom, as this person sees them. The selected one
// is painted on.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { description_in, label_of } from "../../domain/cells";
import { is_as_computed, value_range, type Layer, type LayerPatch } from "../../core/types";
import { ask_to_bin, tell_binned } from "../../ui/trash";
import { open_bin_of } from "../../ui/trash-dialog";
import { ask } from "../../ui/dialog";
import { DragOrder } from "../../ui/drag-order";
import { follow_session } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import { unlock_label } from "../../session/layer-lock";
import { layer_job_row, layer_job_styles } from "./layer-job-row";
import { can_be_colored } from "./color-dialog";
import { layer_chip, legend, legend_styles } from "./legend";
import "../../ui/menu";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { drag_styles, shared_styles } from "../../ui/styles";
import {
  choose_raster,
  formats_of,
  kFeatureFormats,
  save_features,
  save_raster,
} from "./raster-files";
import type { TermsRequest } from "../../session/requests";
import { texts } from "../../texts";
import { visibility_badge } from "../../ui/visibility";

export type LayerPanelRequest =
  | TermsRequest
  | { dialog: "create" | "template" | "transfer" }
  | { dialog: "edit" | "colors" | "statistics" | "map"; layer: Layer };

@customElement("strata-layer-panel")
export class StrataLayerPanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private computing_: number | null = null;
  private readonly drag_ = new DragOrder<number>(
    this,
    () => this.shown.map(({ id }) => id),
    (id, to) => {
      const layer = this.session.layers.find(id);
      if (layer) this.move(layer, to);
    },
  );

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    legend_styles,
    layer_job_styles,
    drag_styles,
    css`
      :host {
        display: block;
      }
      .heading {
        display: flex;
        align-items: center;
        gap: 0.5rem;
        margin-bottom: 0.5rem;
      }
      h2 {
        flex: 1;
        font-size: 1.08rem;
      }
      .list {
        display: grid;
        grid-template-columns: minmax(0, 1fr); /* a long name does not widen its card */
        gap: 0.375rem;
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li.layer {
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
      }
      li.layer.selected {
        border-color: var(--accent);
        box-shadow: inset 3px 0 0 var(--accent);
      }
      .line {
        display: flex;
        align-items: center;
        gap: 2px;
        padding: 3px 4px 3px 2px;
      }
      .name {
        flex: 1;
        justify-content: flex-start;
        min-width: 0;
        padding: 0 0.5rem;
        gap: 0.625rem;
      }
      .name.off {
        color: var(--ink-soft);
      }
      .selected .name {
        padding-block: 0.375rem;
        font-weight: 600;
        text-align: start;
        white-space: normal; /* of the chosen layer the whole name is read */
      }
      .selected .name .ellipsis {
        overflow-wrap: anywhere;
        white-space: normal;
      }
      .lock,
      .seen-by {
        display: grid;
        place-items: center;
        width: 1.375rem;
        color: var(--ink-soft);
      }
      .locked {
        display: grid;
        grid-template-columns: auto minmax(0, 1fr);
        align-items: start;
        gap: 0.25rem 0.5rem;
        color: var(--ink-soft);
        font-size: 0.88rem;
      }
      .locked button {
        grid-column: 2;
        justify-self: start;
      }
      .more {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: 0.75rem;
        padding: 0.375rem 0.875rem 0.875rem;
        border-top: var(--edge) solid var(--line);
      }
      .more p.description {
        color: var(--ink-soft);
        font-size: 0.88rem;
        overflow-wrap: anywhere;
      }
      .opacity {
        display: grid;
        grid-template-columns: auto 1fr 3.25rem;
        align-items: center;
        gap: 0.625rem;
        font-size: 0.88rem;
      }
      .opacity output {
        text-align: right;
        white-space: nowrap;
      }
      .personal {
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        gap: 4px 0.875rem;
        margin-top: 0.625rem;
        padding: 0.5625rem 0.75rem;
        border-radius: var(--radius-small);
        background: var(--calm-soft);
        font-size: 0.86rem;
      }
      .personal span {
        flex-basis: 100%;
      }
      .personal button.link {
        color: var(--calm);
      }
      .formula {
        display: grid;
        gap: 0.5rem;
        justify-items: start;
        font-size: 0.88rem;
      }
      .formula code {
        font: 0.86rem var(--mono);
        white-space: pre-wrap;
        word-break: break-word;
      }
      .empty {
        display: grid;
        gap: 0.625rem;
        justify-items: start;
        padding: 1rem;
        border: var(--edge) dashed var(--line-strong);
        border-radius: var(--radius);
      }
      .empty p {
        color: var(--ink-soft);
        font-size: 0.9rem;
      }
    `,
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
          session.can_curate
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
                <button class="quiet" role="menuitem" @click=${() => void open_bin_of(session)}>${icon("trash")}${texts.bin.open}</button>
              </strata-menu>`
            : nothing
        }
      </div>
      ${session.jobs.entries.map((entry) => layer_job_row(session, entry))}
      ${
        shown.length === 0
          ? html`<div class="empty">
            <b>${words.empty_title}</b>
            <p>${words.empty_lead}</p>
            ${
              session.can_curate
                ? html`<button @click=${() => this.request({ dialog: "template" })}>${icon("layers")}${texts.templates.open}</button>`
                : nothing
            }
          </div>`
          : html`<ul class="list" @dragover=${this.drag_.over_list} @drop=${this.drag_.drop}>
            ${repeat(
              shown,
              (layer) => layer.id,
              (layer, index) => this.row(layer, index),
            )}
          </ul>`
      }
      ${
        session.layers.has_overrides
          ? html`<div class="personal">
            <span>${words.personal}</span>
            ${
              session.can_curate
                ? html`<button class="link" @click=${() => void this.save_default()}>${words.save_default}</button>`
                : nothing
            }
            <button class="link" @click=${() => session.layers.reset_overrides()}>${words.reset_default}</button>
          </div>`
          : nothing
      }`;
  }

  private row(layer: Layer, index: number): TemplateResult {
    const { session } = this;
    const words = texts.layers;
    const selected = session.layers.selected_id === layer.id;
    const visible = session.layers.visible(layer);
    const count = session.layers.all.length;
    return html`<li
      class="layer ${selected ? "selected" : ""} ${this.drag_.classes(layer.id, index)}"
      @dragover=${(event: DragEvent) => this.drag_.over_row(event, index)}
    >
      <div class="line">
        ${
          count > 1
            ? html`<span
              class="grip"
              draggable="true"
              title=${words.drag(label_of(layer))}
              @dragstart=${(event: DragEvent) => this.drag_.start(event, layer.id, label_of(layer))}
              @dragend=${this.drag_.end}
              >${icon("grip")}</span
            >`
            : nothing
        }
        <button
          class="icon quiet"
          aria-pressed=${visible}
          aria-label=${visible ? words.hide(label_of(layer)) : words.show(label_of(layer))}
          title=${visible ? words.hide(label_of(layer)) : words.show(label_of(layer))}
          @click=${() => session.layers.set_visible(layer, !visible)}
        >
          ${icon(visible ? "eye" : "eye_off")}
        </button>
        <button
          class="quiet name ${visible ? "" : "off"}"
          aria-pressed=${selected}
          aria-label=${words.select(label_of(layer))}
          title=${label_of(layer)}
          @click=${() => session.layers.select(layer)}
        >
          ${layer_chip(session.layers.palette(layer))}<span class="ellipsis">${label_of(layer)}</span>
        </button>
        ${visibility_badge(layer.visibility)}
        ${layer.locked ? html`<span class="lock" role="img" aria-label=${this.who_is_locked(layer)} title=${this.who_is_locked(layer)}>${icon("lock")}</span>` : nothing}
        <strata-menu label=${words.options(label_of(layer))}>
          ${
            session.can_curate
              ? html`<button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "edit", layer })}>
                  ${icon("edit")}${words.edit}
                </button>
                <button class="quiet" role="menuitem" @click=${() => void this.change(layer, { locked: !layer.locked })}>
                  ${icon(layer.locked ? "unlock" : "lock")}${layer.locked ? unlock_label(layer) : words.lock}
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
            can_be_colored(layer)
              ? html`<button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "colors", layer })}>${icon("palette")}${texts.colors.open}</button>`
              : nothing
          }
          ${
            layer.table === undefined
              ? nothing
              : html`<button class="quiet" role="menuitem" @click=${() => session.tables.open(layer)}>${icon("table")}${texts.tables.open}</button>`
          }
          ${
            layer.table !== undefined && layer.type !== "u32" && session.can_curate
              ? html`<button class="quiet" role="menuitem" @click=${() => void this.widen(layer)}>${icon("plus")}${words.widen}</button>`
              : nothing
          }
          <button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "statistics", layer })}>
            ${icon("chart")}${words.statistics}
          </button>
          <hr />
          ${formats_of(layer).map(
            (format) =>
              html`<button class="quiet" role="menuitem" @click=${() => save_raster(session, layer, format)}>
                ${icon("import")}${texts.rasters.save[format]}
              </button>`,
          )}
          ${kFeatureFormats.map(
            (format) =>
              html`<button class="quiet" role="menuitem" @click=${() => save_features(session, layer, format)}>
                ${icon("import")}${texts.rasters.save_outlines[format]}
              </button>`,
          )}
          ${
            session.can_paint && !session.is_locked(layer)
              ? html`<button class="quiet" role="menuitem" @click=${() => choose_raster(session, layer)}>
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
            session.can_curate
              ? html`<hr />
                <button class="quiet" role="menuitem" @click=${() => void this.delete_layer(layer)}>
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
      ${layer.locked ? this.lock_told(layer) : nothing} ${layer.edited_by_hand === true ? this.hand_told(layer) : nothing} ${layer.review ? this.review_told(layer) : nothing}
      ${description_in(layer) ? html`<p class="description">${description_in(layer)}</p>` : nothing} ${legend(layer, session.layers.palette(layer), session.tables)}
      ${layer.expression === undefined ? nothing : this.formula(layer)}
      ${
        layer.table === undefined
          ? nothing
          : html`<button aria-pressed=${session.tables.view?.layer_id === layer.id} title="${texts.tables.open} (T)" @click=${() => session.toggle_table()}>
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
          aria-label=${texts.layers.opacity_of(label_of(layer))}
          @input=${(event: Event) => session.layers.set_opacity(layer, Number((event.target as HTMLInputElement).value) / 100)}
        />
        <output class="numeric">${Math.round(opacity * 100)} %</output>
      </div>
    </div>`;
  }

  private who_is_locked(layer: Layer): string {
    if (is_as_computed(layer)) return texts.layers.locked_computed;
    return this.session.is_locked(layer)
      ? texts.layers.locked_to_you
      : texts.layers.locked_to_others;
  }

  private lock_told(layer: Layer): TemplateResult {
    const unlock = (): void => void this.change(layer, { locked: false });
    return html`<p class="locked">
      ${icon("lock")}<span>${this.who_is_locked(layer)}</span>
      ${this.session.can_curate ? html`<button class="link" @click=${unlock}>${unlock_label(layer)}</button>` : nothing}
    </p>`;
  }

  private hand_told(layer: Layer): TemplateResult {
    return html`<p class="locked by-hand">
      ${icon("edit")}<span>${layer.expression === undefined ? texts.layers.by_hand : `${texts.layers.by_hand} ${texts.layers.by_hand_formula}`}</span>
    </p>`;
  }

  private review_told(layer: Layer): TemplateResult {
    const { can_curate, reviews } = this.session;
    const waiting = reviews.waiting_on(layer);
    return html`<p class="locked">
      ${icon("shield")}<span>${can_curate ? texts.review.asked : texts.review.asked_of_you} ${waiting > 0 ? texts.review.waiting(waiting) : nothing}</span>
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
        this.may_recompute(layer)
          ? html`<button ?disabled=${this.computing_ === layer.id} @click=${() => void this.recompute(layer)}>${icon("redo")}${texts.layers.recompute}</button>`
          : nothing
      }
    </div>`;
  }

  /** Whoever may change it may have it computed: its lock is against hands. */
  private may_recompute(layer: Layer): boolean {
    const { can_paint, can_curate } = this.session;
    return (
      (layer.locked || layer.edited_by_hand === true ? can_curate : can_paint) &&
      (layer.recompute !== "automatic" || layer.edited_by_hand === true)
    );
  }

  private async recompute(layer: Layer): Promise<void> {
    const { session } = this;
    const words = texts.layers;
    const by_hand = layer.edited_by_hand === true;
    if (
      by_hand &&
      !(await ask({
        heading: words.overwrite_title(layer.name),
        lead: words.overwrite_lead,
        yes: words.recompute,
      }))
    )
      return;
    this.computing_ = layer.id;
    try {
      session.layers.put(await session.api.recompute_layer(session.model_id, layer.id, by_hand));
    } catch (error) {
      notices.error(error);
    } finally {
      this.computing_ = null;
    }
  }

  private request(detail: LayerPanelRequest): void {
    this.dispatchEvent(new CustomEvent<LayerPanelRequest>("request", { detail }));
  }

  /** `index` counts from the top of the shown list, without the layer itself. */
  private move(layer: Layer, index: number): void {
    const last = this.session.layers.all.length - 1;
    this.session.layers.move(layer, last - index);
  }

  private async save_default(): Promise<void> {
    try {
      await this.session.layers.save_overrides_as_default();
      notices.show("success", texts.layers.saved_default);
    } catch (error) {
      notices.error(error);
    }
  }

  /** Room for the keys of more records. */
  private async widen(layer: Layer): Promise<void> {
    const words = texts.layers;
    const [, highest] = value_range(layer.type);
    if (
      !(await ask({
        heading: words.widen_title(label_of(layer)),
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

  private async delete_layer(layer: Layer): Promise<void> {
    const words = texts.layers;
    const { api, layers, model } = this.session;
    if (!model) return;
    const gone = {
      kind: "layer",
      entry: `layer-${layer.id}`,
      name: layer.name,
      project: model.project,
    } as const;
    if (!(await ask_to_bin(api, gone, { title: words.delete_title, lead: words.delete_lead })))
      return;
    await layers.remove(layer).then(
      () => tell_binned(api, gone),
      (error: unknown) => notices.error(error),
    );
  }
}
