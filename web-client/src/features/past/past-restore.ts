// <strata-past-restore>: restores a layer, or a part of it, to the displayed state. It first counts
// the texels that the restore would change.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { formatArea } from "../../domain/measure";
import { labelOf } from "../../domain/cells";
import type { Difference } from "../../core/protocol.gen";
import { formatFixed } from "../../core/locale";
import type { Layer } from "../../core/types";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.past;

@customElement("strata-past-restore")
export class StrataPastRestore extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /**
   * Null before the user chooses. The default is then a layer that has changed since the state, if
   * possible the selected layer.
   */
  @state() private _layer: number | null = null;
  @state() private _count: Difference | null = null;
  @state() private _working = false;
  private _counted = ""; // the layer, state and part to which `_count` applies
  private _asked = 0;

  constructor() {
    super();
    followSession(this, "past", "layers");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        gap: var(--space-1);
        padding: var(--space-1) var(--space-2);
        border-radius: var(--radius-small);
        background: var(--paper);
      }
      label {
        display: flex;
        align-items: center;
        gap: var(--space-1);
        min-width: 0;
      }
      select {
        width: auto;
        max-width: 14rem;
      }
      p {
        flex: 1 1 12rem;
        margin: 0;
        font-size: var(--text-small);
      }
    `,
  ];

  override updated(): void {
    void this.count();
  }

  /** Layers that this user may change. */
  private get layers(): Layer[] {
    return this.session.layers.all.filter((layer) => !this.session.isLocked(layer));
  }

  private get layer(): Layer | null {
    const { layers, session } = this;
    const at = session.past.at ?? Infinity;
    const changed = layers.filter(({ sequence }) => sequence > at);
    const selected = layers.find(({ id }) => id === session.layers.selected?.id);
    return (
      layers.find(({ id }) => id === this._layer) ??
      changed.find((each) => each === selected) ??
      changed.sort((a, b) => b.sequence - a.sequence)[0] ??
      selected ??
      layers[0] ??
      null
    );
  }

  private async count(): Promise<void> {
    const { layer, session } = this;
    const { past } = session;
    const counted = JSON.stringify([layer?.id, layer?.sequence, past.at, past.part]);
    if (!layer || past.at === null || past.drawsPart || counted === this._counted) return;
    this._counted = counted;
    this._count = null;
    const question = ++this._asked;
    const found = await past.count(layer.id);
    if (question === this._asked) this._count = found;
  }

  override render(): TemplateResult {
    const { layer, session } = this;
    const { past } = session;
    if (!layer)
      return html`<p>${words.no_layer}</p><button @click=${() => this.close()}>${texts.cancel}</button>`;
    return html`<label>${words.layer}
        <select
          @change=${(event: Event) => (this._layer = Number((event.target as HTMLSelectElement).value))}
        >
          ${this.layers.map((each) => html`<option value=${each.id} ?selected=${each.id === layer.id}>${labelOf(each)}</option>`)}
        </select>
      </label>
      <button aria-pressed=${past.part !== null || past.drawsPart} @click=${() => (past.part || past.drawsPart ? past.setPart(null) : past.drawPart())}>${words.part}</button>
      <p role="status">${this.told()}</p>
      <button ?disabled=${this._working} @click=${() => this.close()}>${texts.cancel}</button>
      <button
        class="primary"
        ?disabled=${this._working || past.drawsPart || !this._count || this._count.texels === 0}
        @click=${() => void this.restore(layer)}
      >
        ${words.restore_now}
      </button>`;
  }

  private told(): string {
    if (this.session.past.drawsPart) return words.draw_part;
    if (!this._count) return texts.loading;
    const { texels, area_m2: areaM2, share } = this._count;
    return texels === 0
      ? words.same
      : words.changes(formatArea(areaM2), `${formatFixed(share * 100, share < 0.01 ? 2 : 1)} %`);
  }

  private async restore(layer: Layer): Promise<void> {
    this._working = true;
    const done = await this.session.past.restore(layer.id);
    this._working = false;
    if (!done) return;
    notices.show(
      "success",
      words.restored(labelOf(layer), formatArea(done.area_m2)),
      words.restored_hint,
    );
    this.close();
  }

  private close(): void {
    this.dispatchEvent(new CustomEvent("closed"));
  }
}
