// <strata-tour-stops>: the stops of a tour in their order, and the selected stop. It adds, moves
// and removes stops.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { languageInWords } from "../../core/languages";
import { formatList } from "../../core/locale";
import { kMostStops, moved, newStop, untranslated, type StopDraft } from "../../domain/tours";
import type { View } from "../../core/protocol.gen";
import { DragOrder } from "../../ui/order/drag-order";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import type { ModelSession } from "../../session/model-session";
import { dragStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "../../ui/thumbnail";

const words = texts.tours;

export interface StopsChange {
  stops: readonly StopDraft[];
  /** The id of the selected stop. */
  chosen: number | null;
}

@customElement("strata-tour-stops")
export class StrataTourStops extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) stops: readonly StopDraft[] = [];
  @property({ attribute: false }) languages: readonly string[] = [];
  @property({ attribute: false }) chosen: number | null = null;
  /** The index of the refused stop. */
  @property({ attribute: false }) wrong: number | null = null;
  @property() problem = "";
  @state() private _removed: { stop: StopDraft; index: number }[] = []; // the latest is last
  @query("select") private _select!: HTMLSelectElement | null;
  private readonly _drag = new DragOrder<number>(
    this,
    () => this.stops.map(({ id }) => id),
    (id, to) =>
      this.move(
        this.stops.findIndex((stop) => stop.id === id),
        to,
      ),
  );

  constructor() {
    super();
    followSession(this, "tours", "views");
  }

  static override styles = [
    sharedStyles,
    dragStyles,
    css`
      :host {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        align-content: start;
        gap: var(--space-2);
      }
      ol {
        display: grid;
        gap: var(--space-2);
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li {
        display: grid;
        grid-template-columns: auto minmax(0, 1fr) auto;
        align-items: center;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
      }
      li.chosen {
        border-color: var(--accent);
        box-shadow: inset 3px 0 0 var(--accent);
      }
      li.wrong {
        border-color: var(--danger);
      }
      button.stop {
        display: grid;
        grid-template-columns: 3.25rem minmax(0, 1fr);
        justify-content: stretch;
        gap: var(--space-half) var(--space-2);
        min-height: 3.25rem;
        padding: var(--space-2) var(--space-1);
        text-align: start;
        white-space: normal;
      }
      strata-thumbnail,
      .no-view {
        grid-row: span 3;
        width: 3.25rem;
        border-radius: var(--radius-tiny);
      }
      .no-view {
        display: grid;
        place-items: center;
        height: 2.4375rem;
        color: var(--danger);
      }
      b {
        font-weight: 600;
        font-size: var(--text-small);
        overflow-wrap: anywhere;
        unicode-bidi: plaintext;
      }
      .lacks {
        font-size: var(--text-tiny);
        color: var(--warn);
      }
      .gone {
        font-size: var(--text-tiny);
        color: var(--danger);
      }
      .removed {
        display: flex;
        flex-wrap: wrap;
        align-items: baseline;
        gap: var(--space-half) var(--space-3);
        padding: var(--space-2) var(--space-3);
        border-radius: var(--radius-small);
        background: var(--calm-soft);
        font-size: var(--text-small);
        overflow-wrap: anywhere;
      }
      .add {
        display: grid;
        gap: var(--space-2);
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    // the removed stops may have texts in a removed language
    if (changed.has("languages") && changed.get("languages") !== undefined) this._removed = [];
  }

  override render(): TemplateResult {
    const { stops } = this;
    const removed = this._removed.at(-1);
    return html`<span class="caption" id="caption">${words.stops}</span>
      ${
        stops.length === 0
          ? html`<p class="hint" ?hidden=${this.lacksViews}>${words.none_stops}</p>`
          : html`<ol aria-labelledby="caption" @dragover=${this._drag.overList} @drop=${this._drag.drop}>
            ${repeat(
              stops,
              ({ id }) => id,
              (stop, index) => this.row(stop, index),
            )}
          </ol>`
      }
      ${
        removed
          ? html`<p class="removed" role="status">${words.removed(this.titleOf(removed.stop))} <button type="button" class="link" @click=${this.putBack}>${words.undo}</button></p>`
          : nothing
      }
      ${this.problem ? html`<p class="error" role="alert">${this.problem}</p>` : nothing}
      ${stops.length < kMostStops ? this.adding() : nothing}`;
  }

  private titleOf({ title }: StopDraft): string {
    return title[this.languages[0] ?? ""]?.trim() || texts.unnamed;
  }

  private get lacksViews(): boolean {
    const { all, loaded } = this.session.views;
    return loaded && all.length === 0;
  }

  private viewOf({ view }: StopDraft): View | null {
    return this.session.views.all.find(({ slug }) => slug === view) ?? null;
  }

  private row(stop: StopDraft, index: number): TemplateResult {
    const { stops, languages, session } = this;
    const title = this.titleOf(stop);
    const view = this.viewOf(stop);
    const lacks = untranslated(stop, languages).map(languageInWords);
    const chosen = stop.id === this.chosen;
    return html`<li
      class="${chosen ? "chosen" : ""} ${this.wrong === index ? "wrong" : ""} ${this._drag.classes(stop.id, index)}"
      @dragover=${(event: DragEvent) => this._drag.overRow(event, index)}
    >
      ${
        stops.length > 1
          ? html`<span class="grip" draggable="true" title=${texts.layers.drag(title)} @dragstart=${(event: DragEvent) => this._drag.start(event, stop.id, title)} @dragend=${this._drag.end}>${icon("grip")}</span>`
          : html`<span></span>`
      }
      <button type="button" class="quiet stop" aria-current=${chosen} @click=${() => this.put(stops, stop.id)}>
        ${
          view && session.model
            ? html`<strata-thumbnail .api=${session.api} .model=${session.model} .view=${view}></strata-thumbnail>`
            : html`<span class="no-view">${icon("warning")}</span>`
        }
        <b>${index + 1}. ${title}</b>
        ${view || !session.views.loaded ? nothing : html`<span class="gone">${words.view_gone_short}</span>`}
        ${lacks.length > 0 ? html`<span class="lacks">${words.missing(formatList(lacks))}</span>` : nothing}
      </button>
      <strata-menu label=${texts.layers.options(title)}>
        <button type="button" class="quiet" role="menuitem" ?disabled=${index === 0} @click=${() => this.move(index, index - 1)}>${icon("up")}${texts.layers.up}</button>
        <button type="button" class="quiet" role="menuitem" ?disabled=${index === stops.length - 1} @click=${() => this.move(index, index + 1)}>${icon("down")}${texts.layers.down}</button>
        <hr />
        <button type="button" class="quiet" role="menuitem" @click=${() => this.removeStop(index)}>${icon("trash")}${words.remove}</button>
      </strata-menu>
    </li>`;
  }

  private adding(): TemplateResult {
    const { all } = this.session.views;
    if (this.lacksViews) return html`<p class="hint">${words.no_views}</p>`;
    const used = new Set(this.stops.map(({ view }) => view));
    const unused = all.filter(({ slug }) => !used.has(slug));
    const next = unused[0] ?? all[0];
    const room = kMostStops - this.stops.length;
    return html`<div class="add">
      <select aria-label=${words.add_view}>
        ${repeat(
          all,
          ({ id }) => id,
          (view) =>
            html`<option value=${view.slug} ?selected=${view === next}>${view.name}</option>`,
        )}
      </select>
      <button type="button" @click=${() => void this.add()}>${icon("plus")}${words.add}</button>
      ${
        unused.length > 1 && unused.length <= room
          ? html`<button type="button" class="quiet" @click=${() => this.addAll(unused)}>${words.add_all(unused.length)}</button>`
          : nothing
      }
    </div>`;
  }

  private addAll(views: readonly View[]): void {
    const added = views.map((view) => newStop(view, this.languages[0] ?? ""));
    this.put([...this.stops, ...added], added[0]!.id);
  }

  private async add(): Promise<void> {
    const view = this.session.views.all.find(({ slug }) => slug === this._select?.value);
    if (!view) return;
    const stop = newStop(view, this.languages[0] ?? "");
    this.put([...this.stops, stop], stop.id);
    await this.updateComplete;
    const next = [...(this._select?.options ?? [])].find(({ defaultSelected }) => defaultSelected);
    if (next) next.selected = true; // also replaces a choice by the user
  }

  private move(from: number, to: number): void {
    if (from !== to) this.put(moved(this.stops, from, to), this.chosen);
  }

  private removeStop(index: number): void {
    const stop = this.stops[index]!;
    const rest = this.stops.filter((each) => each !== stop);
    this._removed = [...this._removed, { stop, index }];
    this.put(rest, stop.id === this.chosen ? null : this.chosen);
  }

  private putBack(): void {
    const last = this._removed.at(-1);
    if (!last) return;
    this._removed = this._removed.slice(0, -1);
    const stops = [...this.stops];
    stops.splice(last.index, 0, last.stop);
    this.put(stops, last.stop.id);
  }

  private put(stops: readonly StopDraft[], chosen: number | null): void {
    this.dispatchEvent(new CustomEvent<StopsChange>("changed", { detail: { stops, chosen } }));
  }
}
