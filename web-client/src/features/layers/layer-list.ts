// The layers of the open model: which there are, which is chosen, and what this person shows, hides
// and puts in another order, which is kept for them alone.

import type { Api } from "../../net/api";
import { same_palette } from "../../domain/palette";
import { layers_of_view, layers_to_keep, own_part, type LayerShown } from "../../domain/views";
import type { Highlight, LayerEvent, LayerOverride, PersonalView } from "../../core/protocol.gen";
import { complete_layer, type Layer, type LayerPatch, type Palette } from "../../core/types";
import { notices } from "../../ui/notices";
import { PersonalViewKeeper } from "./personal-view";
import { texts } from "../../texts";

export interface LayerListHost {
  send_overrides(overrides: LayerOverride[]): void;
  changed(): void;
}

export class LayerList {
  all: Layer[] = []; // in this person's order: the last is on top
  selected_id: number | null = null;

  // as it is shown: a named view, and what was changed since
  private overrides_ = new Map<number, LayerShown>();
  private own_ = new Map<number, LayerShown>(); // as it is kept
  private at_view_ = false;
  private readonly keeper_: PersonalViewKeeper;
  /** Records that are looked at just now, before those of a view. */
  private readonly highlights_ = new Map<number, Highlight>();

  constructor(
    private readonly api_: Api,
    private readonly model_id_: string,
    private readonly host_: LayerListHost,
  ) {
    this.keeper_ = new PersonalViewKeeper(api_, model_id_);
  }

  get selected(): Layer | null {
    return this.find(this.selected_id);
  }

  find(id: number | null): Layer | null {
    return this.all.find((layer) => layer.id === id) ?? null;
  }

  select(layer: Layer): void {
    this.selected_id = layer.id;
    this.host_.changed();
  }

  // ── what this person shows
  // ────────────────────────────────────────────────────────────────────────────────────────

  visible(layer: Layer): boolean {
    return this.overrides_.get(layer.id)?.visible ?? layer.visible;
  }
  opacity(layer: Layer): number {
    return this.overrides_.get(layer.id)?.opacity ?? layer.opacity;
  }
  palette(layer: Layer): Palette {
    return this.overrides_.get(layer.id)?.palette ?? layer.palette;
  }

  private order(layer: Layer): number {
    return this.overrides_.get(layer.id)?.order ?? layer.order;
  }

  /** What is shown differs from what everyone sees at first. */
  get has_overrides(): boolean {
    return this.all.some((layer) => {
      const shown = this.overrides_.get(layer.id);
      return shown && (own_part(layer, shown) !== null || shown.highlight !== undefined);
    });
  }

  set_visible(layer: Layer, visible: boolean): void {
    this.override(layer, { visible });
  }
  set_opacity(layer: Layer, opacity: number): void {
    this.override(layer, { opacity });
  }
  /** Null: the layer's own. */
  set_palette(layer: Layer, palette: Palette | null): void {
    for (const shown of [this.overrides_, this.own_]) {
      const { palette: _, ...rest } = shown.get(layer.id) ?? {};
      shown.set(layer.id, palette ? { ...rest, palette } : rest);
    }
    this.changed_by_hand();
  }
  /** Moves the layer to the place `index` of the list, which is bottom to top: for this person. */
  move(layer: Layer, index: number): void {
    const wanted = this.all.filter((other) => other.id !== layer.id);
    wanted.splice(Math.max(0, Math.min(index, wanted.length)), 0, layer);
    // As few as can be get another place, so that what comes later lies where it would for
    // everybody.
    const places = wanted.map((each) => this.order(each)).sort((a, b) => a - b);
    const differ = places.every((place, at) => at === 0 || place > places[at - 1]!);
    wanted.forEach((each, at) => {
      const order = differ ? places[at]! : at;
      if (order === this.order(each)) return;
      for (const shown of [this.overrides_, this.own_])
        shown.set(each.id, { ...shown.get(each.id), order });
    });
    this.put_all(this.all);
    this.changed_by_hand();
  }
  /** Null: no records before others. */
  set_highlight(layer_id: number, highlight: Highlight | null): void {
    if (highlight) this.highlights_.set(layer_id, highlight);
    else if (!this.highlights_.delete(layer_id)) return;
    this.send_overrides();
  }
  reset_overrides(): void {
    this.overrides_.clear();
    this.own_.clear();
    this.at_view_ = false;
    this.put_all(this.all);
    this.changed_by_hand();
  }

  /** The page may be gone in a moment, or the connection is back. */
  flush(): void {
    this.keeper_.flush();
  }

  /** What a named view keeps of all this. */
  to_keep(): LayerOverride[] {
    return layers_to_keep(this.all, ({ id }) => this.shown(id));
  }
  /**
   * As a named view has it, and no records before those of the view; layers that it does not name
   * as everyone sees them at first. Returns the way back, without the records that were looked at.
   */
  show_view(view: { layers: LayerOverride[] }): () => void {
    const { overrides_: overrides, at_view_: was_at_view } = this;
    this.show_all(layers_of_view(view, this.all), true);
    this.highlights_.clear();
    this.send_overrides();
    return () => {
      this.show_all(was_at_view ? overrides : new Map(this.own_), was_at_view);
      this.forget_unknown();
      this.send_overrides();
    };
  }

  async save_overrides_as_default(): Promise<void> {
    for (const layer of this.all) {
      const [visible, opacity, palette] = [
        this.visible(layer),
        this.opacity(layer),
        this.palette(layer),
      ];
      const recolored = !same_palette(palette, layer.palette);
      const order = this.order(layer);
      if (
        visible === layer.visible &&
        opacity === layer.opacity &&
        order === layer.order &&
        !recolored
      )
        continue;
      await this.change(layer, { visible, opacity, order, ...(recolored ? { palette } : {}) });
    }
    this.reset_overrides();
  }

  // ── what everyone has
  // ─────────────────────────────────────────────────────────────────────────────────────────────

  /** `etag`: the version that the change was thought out for. */
  async change(layer: Layer, change: LayerPatch, etag?: string): Promise<void> {
    this.put(await this.api_.change_layer(this.model_id_, layer.id, change, etag));
  }

  async remove(layer: Layer): Promise<void> {
    await this.api_.delete_layer(this.model_id_, layer.id);
    this.drop(layer.id);
  }

  put(layer: Layer): void {
    this.put_all([...this.all.filter((other) => other.id !== layer.id), layer]);
  }

  /**
   * What the server says on joining: what is known of other layers is forgotten. `kept`: how this
   * person shows them, where the server knows.
   */
  take_all(layers: Layer[], kept?: PersonalView): void {
    this.put_all(layers);
    this.forget_unknown();
    if (this.keeper_.is_ahead) this.keeper_.flush();
    else if (kept) this.take_kept(kept);
    if (!this.selected) this.select_top();
  }

  on_event(event: LayerEvent): void {
    if ((event.event === "created" || event.event === "changed") && event.layer) {
      this.put(complete_layer(event.layer));
      if (this.selected_id === null) this.selected_id = event.layer_id;
    } else if (event.event === "deleted") {
      const gone = this.find(event.layer_id);
      if (gone) notices.show("info", texts.layers.deleted_by_other(gone.name));
      this.drop(event.layer_id);
    } else if (event.event === "edited") {
      this.all = this.all.map((layer) =>
        layer.id === event.layer_id
          ? { ...layer, sequence: event.sequence ?? layer.sequence }
          : layer,
      );
    }
    this.host_.changed();
  }

  private shown(id: number): LayerShown {
    const highlight = this.highlights_.get(id);
    return { ...this.overrides_.get(id), ...(highlight ? { highlight } : {}) };
  }

  /** One unknown layer, and the server refuses what is said of all. */
  private forget_unknown(): void {
    const known = new Set(this.all.map((layer) => layer.id));
    for (const kept of [this.overrides_, this.own_, this.highlights_])
      for (const id of kept.keys()) if (!known.has(id)) kept.delete(id);
  }

  private override(layer: Layer, change: LayerShown): void {
    for (const shown of [this.overrides_, this.own_])
      shown.set(layer.id, { ...shown.get(layer.id), ...change });
    this.changed_by_hand();
  }

  private take_kept(kept: PersonalView): void {
    this.own_ = layers_of_view(kept, this.all);
    if (this.at_view_) return;
    this.show_all(new Map(this.own_), false);
    this.send_overrides();
  }

  private show_all(overrides: Map<number, LayerShown>, at_view: boolean): void {
    this.overrides_ = overrides;
    this.at_view_ = at_view;
    this.put_all(this.all);
  }

  /** What was just set is shown, and kept. */
  private changed_by_hand(): void {
    this.send_overrides();
    const own = this.all.map((layer) => ({
      layer: layer.id,
      ...own_part(layer, this.own_.get(layer.id) ?? {}),
    }));
    this.keeper_.keep({ layers: own.filter((each) => Object.keys(each).length > 1) });
  }

  private send_overrides(): void {
    const ids = new Set([...this.overrides_.keys(), ...this.highlights_.keys()]);
    this.host_.send_overrides([...ids].map((layer) => ({ layer, ...this.shown(layer) })));
    this.host_.changed();
  }

  private put_all(layers: Layer[]): void {
    this.all = [...layers].sort((a, b) => this.order(a) - this.order(b) || a.id - b.id);
    this.host_.changed();
  }

  private select_top(): void {
    this.selected_id = this.all[this.all.length - 1]?.id ?? null;
    this.host_.changed();
  }

  private drop(id: number): void {
    this.all = this.all.filter((layer) => layer.id !== id);
    this.own_.delete(id);
    const had = this.overrides_.delete(id);
    if (this.highlights_.delete(id) || had) this.send_overrides();
    if (this.selected_id === id) this.select_top();
    this.host_.changed();
  }
}
