// The layers of the open model: which there are, which is chosen, and what this person shows and hides.

import type { Api } from "../core/api";
import { same_palette } from "../core/palette";
import { layers_of_view, layers_to_keep, type LayerShown } from "../core/views";
import type { Highlight, LayerEvent, LayerOverride } from "../core/protocol.gen";
import { complete_layer, type Layer, type LayerPatch, type Palette } from "../core/types";
import { notices } from "./notices";
import { reorder } from "./reorder";
import { texts } from "./texts";

export interface LayerListHost {
  send_overrides(overrides: LayerOverride[]): void;
  changed(): void;
}

export class LayerList {
  all: Layer[] = []; // by order: the last is on top
  selected_id: number | null = null;

  private overrides_ = new Map<number, LayerShown>();
  /** Records that are looked at just now, before those of a view. */
  private readonly highlights_ = new Map<number, Highlight>();

  constructor(
    private readonly api_: Api,
    private readonly model_id_: string,
    private readonly host_: LayerListHost,
  ) {}

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

  // ── what this person shows ────────────────────────────────────────────────────────────────────────────────────────

  visible(layer: Layer): boolean {
    return this.overrides_.get(layer.id)?.visible ?? layer.visible;
  }
  opacity(layer: Layer): number {
    return this.overrides_.get(layer.id)?.opacity ?? layer.opacity;
  }
  palette(layer: Layer): Palette {
    return this.overrides_.get(layer.id)?.palette ?? layer.palette;
  }

  /** What is shown differs from what everyone sees at first. */
  get has_overrides(): boolean {
    return this.all.some(
      (layer) =>
        this.visible(layer) !== layer.visible ||
        Math.abs(this.opacity(layer) - layer.opacity) > 1e-6 ||
        !same_palette(this.palette(layer), layer.palette) ||
        this.overrides_.get(layer.id)?.highlight !== undefined,
    );
  }

  set_visible(layer: Layer, visible: boolean): void {
    this.override(layer, { visible });
  }
  set_opacity(layer: Layer, opacity: number): void {
    this.override(layer, { opacity });
  }
  /** Null: the layer's own. */
  set_palette(layer: Layer, palette: Palette | null): void {
    const { palette: _, ...rest } = this.overrides_.get(layer.id) ?? {};
    this.overrides_.set(layer.id, palette ? { ...rest, palette } : rest);
    this.send_overrides();
  }
  /** Null: no records before others. */
  set_highlight(layer_id: number, highlight: Highlight | null): void {
    if (highlight) this.highlights_.set(layer_id, highlight);
    else if (!this.highlights_.delete(layer_id)) return;
    this.send_overrides();
  }
  reset_overrides(): void {
    this.overrides_.clear();
    this.send_overrides();
  }

  /** What a named view keeps of all this. */
  to_keep(): LayerOverride[] {
    return layers_to_keep(this.all, ({ id }) => this.shown(id));
  }
  /** As a named view has it, and no records before those of the view; layers that it does not name as everyone sees them at first. Returns the way back, without
   *  the records that were looked at. */
  show_view(view: { layers: LayerOverride[] }): () => void {
    const overrides = this.overrides_;
    this.overrides_ = layers_of_view(view, this.all);
    this.highlights_.clear();
    this.send_overrides();
    return () => {
      this.overrides_ = overrides;
      this.forget_unknown();
      this.send_overrides();
    };
  }

  async save_overrides_as_default(): Promise<void> {
    for (const layer of this.all) {
      const [visible, opacity, palette] = [this.visible(layer), this.opacity(layer), this.palette(layer)];
      const recolored = !same_palette(palette, layer.palette);
      if (visible === layer.visible && opacity === layer.opacity && !recolored) continue;
      await this.change(layer, { visible, opacity, ...(recolored ? { palette } : {}) });
    }
    this.reset_overrides();
  }

  // ── what everyone has ─────────────────────────────────────────────────────────────────────────────────────────────

  /** `etag`: the version that the change was thought out for. */
  async change(layer: Layer, change: LayerPatch, etag?: string): Promise<void> {
    this.put(await this.api_.change_layer(this.model_id_, layer.id, change, etag));
  }

  /** Moves the layer to the place `index` of the list, which is bottom to top. */
  async move(layer: Layer, index: number): Promise<void> {
    await reorder(this.all, layer, index, {
      show: (layers) => this.put_all(layers),
      save: (each) => this.change(each, { order: each.order }),
      reload: () => this.api_.layers(this.model_id_),
    });
  }

  async remove(layer: Layer): Promise<void> {
    await this.api_.delete_layer(this.model_id_, layer.id);
    this.drop(layer.id);
  }

  put(layer: Layer): void {
    this.put_all([...this.all.filter((other) => other.id !== layer.id), layer]);
  }

  /** What the server says on joining: what is known of other layers is forgotten. */
  take_all(layers: Layer[]): void {
    this.put_all(layers);
    this.forget_unknown();
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
        layer.id === event.layer_id ? { ...layer, sequence: event.sequence ?? layer.sequence } : layer,
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
    for (const kept of [this.overrides_, this.highlights_]) for (const id of kept.keys()) if (!known.has(id)) kept.delete(id);
  }

  private override(layer: Layer, change: LayerShown): void {
    this.overrides_.set(layer.id, { ...this.overrides_.get(layer.id), ...change });
    this.send_overrides();
  }

  private send_overrides(): void {
    const ids = new Set([...this.overrides_.keys(), ...this.highlights_.keys()]);
    this.host_.send_overrides([...ids].map((layer) => ({ layer, ...this.shown(layer) })));
    this.host_.changed();
  }

  private put_all(layers: Layer[]): void {
    this.all = [...layers].sort((a, b) => a.order - b.order || a.id - b.id);
    this.host_.changed();
  }

  private select_top(): void {
    this.selected_id = this.all[this.all.length - 1]?.id ?? null;
    this.host_.changed();
  }

  private drop(id: number): void {
    this.all = this.all.filter((layer) => layer.id !== id);
    const had = this.overrides_.delete(id);
    if (this.highlights_.delete(id) || had) this.send_overrides();
    if (this.selected_id === id) this.select_top();
    this.host_.changed();
  }
}
