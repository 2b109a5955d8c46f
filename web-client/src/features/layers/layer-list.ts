// The layers of the open model: the list, the selected layer, and this user's visibility, opacity
// and order. These settings are stored for this user only.

import { changeLayer } from "../../net/layers";
import type { Api } from "../../net/api";
import { samePalette } from "../../domain/palette";
import { seenAlike, type LayersSeen } from "../../domain/surveys";
import { layersOfView, layersToKeep, ownPart, type LayerShown } from "../../domain/views";
import type { Highlight, LayerEvent, LayerOverride, PersonalView } from "../../core/protocol.gen";
import { completeLayer, type Layer, type LayerPatch, type Palette } from "../../core/types";
import { notices } from "../../ui/notices";
import { PersonalViewKeeper } from "./personal-view";
import { texts } from "../../texts";

export interface LayerListHost {
  sendOverrides(overrides: LayerOverride[]): void;
  changed(): void;
}

export class LayerList {
  all: Layer[] = []; // in this user's order; the last one is on top
  selectedId: number | null = null;

  // the applied settings: the settings of a saved view, with later changes
  private _overrides = new Map<number, LayerShown>();
  private _own = new Map<number, LayerShown>(); // the stored settings
  private _atView = false;
  private readonly _keeper: PersonalViewKeeper;
  /** Palettes that a dialog shows until the user chooses. They are not stored as a default. */
  private readonly _previewed = new Map<number, Palette>();
  /**
   * Records that are highlighted temporarily. They take precedence over the highlighted records of
   * a view.
   */
  private readonly _highlights = new Map<number, Highlight>();

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: LayerListHost,
  ) {
    this._keeper = new PersonalViewKeeper(_api, _modelId);
  }

  get selected(): Layer | null {
    return this.find(this.selectedId);
  }

  find(id: number | null): Layer | null {
    return this.all.find((layer) => layer.id === id) ?? null;
  }

  select(layer: Layer): void {
    this.selectedId = layer.id;
    this._host.changed();
  }

  // ── this user's settings ───────────────────────────────────────────────────────────────────────

  visible(layer: Layer): boolean {
    return this._overrides.get(layer.id)?.visible ?? layer.visible;
  }
  opacity(layer: Layer): number {
    return this._overrides.get(layer.id)?.opacity ?? layer.opacity;
  }
  palette(layer: Layer): Palette {
    return this._overrides.get(layer.id)?.palette ?? layer.palette;
  }

  private order(layer: Layer): number {
    return this._overrides.get(layer.id)?.order ?? layer.order;
  }

  /** Whether this user's settings differ from the defaults. */
  get hasOverrides(): boolean {
    return this.all.some((layer) => {
      const shown = this._overrides.get(layer.id);
      return shown && (ownPart(layer, shown) !== null || shown.highlight !== undefined);
    });
  }

  setVisible(layer: Layer, visible: boolean): void {
    this.override([layer], { visible });
  }
  setAllVisible(layers: readonly Layer[], visible: boolean): void {
    this.override(layers, { visible });
  }
  setOpacity(layer: Layer, opacity: number): void {
    this.override([layer], { opacity });
  }
  /** How this user sees the layers, by their names. */
  get seen(): LayersSeen {
    return new Map(
      this.all.map((layer) => [
        layer.name,
        { visible: this.visible(layer), opacity: this.opacity(layer) },
      ]),
    );
  }
  /** Shows the layers like the layers with the same names in another model. */
  showAlike(seen: LayersSeen): void {
    const changes = seenAlike(seen, this.all).filter(({ layer: id, visible, opacity }) => {
      const layer = this.find(id)!;
      return visible !== this.visible(layer) || opacity !== this.opacity(layer);
    });
    if (changes.length === 0) return;
    for (const { layer, ...change } of changes)
      for (const shown of [this._overrides, this._own])
        shown.set(layer, { ...shown.get(layer), ...change });
    this.changedByHand();
  }
  /** Shows a palette until the next call of setPalette. */
  previewPalette(layer: Layer, palette: Palette): void {
    this.setPalette(layer, palette);
    this._previewed.set(layer.id, palette);
  }
  /** Null stands for the layer's own palette. */
  setPalette(layer: Layer, palette: Palette | null): void {
    this._previewed.delete(layer.id);
    for (const shown of [this._overrides, this._own]) {
      const { palette: _, ...rest } = shown.get(layer.id) ?? {};
      shown.set(layer.id, palette ? { ...rest, palette } : rest);
    }
    this.changedByHand();
  }
  /** Sets this order of the layers, bottom to top, for this user. */
  arrange(wanted: readonly Layer[]): void {
    // Changes the order of as few layers as possible, so a new layer appears at its default
    // position.
    const places = wanted.map((each) => this.order(each)).sort((a, b) => a - b);
    const differ = places.every((place, at) => at === 0 || place > places[at - 1]!);
    wanted.forEach((each, at) => {
      const order = differ ? places[at]! : at;
      if (order === this.order(each)) return;
      for (const shown of [this._overrides, this._own])
        shown.set(each.id, { ...shown.get(each.id), order });
    });
    this.putAll(this.all);
    this.changedByHand();
  }
  /** Null removes the highlight. */
  setHighlight(layerId: number, highlight: Highlight | null): void {
    if (highlight) this._highlights.set(layerId, highlight);
    else if (!this._highlights.delete(layerId)) return;
    this.sendOverrides();
  }
  resetOverrides(): void {
    this._overrides.clear();
    this._own.clear();
    this._atView = false;
    this.putAll(this.all);
    this.changedByHand();
  }

  /** Sends unsaved settings, before the page closes and after a reconnection. */
  flush(): void {
    this._keeper.flush();
  }

  /** Returns the settings that a saved view stores. */
  toKeep(): LayerOverride[] {
    return layersToKeep(this.all, ({ id }) => this.shown(id));
  }
  /**
   * Applies the settings of a saved view, without other highlights. Layers that the view does not
   * contain get their defaults. Returns a function that restores the previous settings, without the
   * temporary highlights.
   */
  showView(view: { layers: LayerOverride[] }): () => void {
    const { _overrides: overrides, _atView: wasAtView } = this;
    this.showAll(layersOfView(view, this.all), true);
    this._highlights.clear();
    this.sendOverrides();
    return () => {
      this.showAll(wasAtView ? overrides : new Map(this._own), wasAtView);
      this.forgetUnknown();
      this.sendOverrides();
    };
  }

  async saveOverridesAsDefault(): Promise<void> {
    for (const layer of this.all) {
      const [visible, opacity, palette] = [
        this.visible(layer),
        this.opacity(layer),
        this.palette(layer),
      ];
      const recolored = !this._previewed.has(layer.id) && !samePalette(palette, layer.palette);
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
    this.resetOverrides();
    for (const [id, palette] of [...this._previewed]) {
      const layer = this.find(id);
      if (layer) this.previewPalette(layer, palette);
    }
  }

  // ── shared state ───────────────────────────────────────────────────────────────────────────────

  /** `etag` is the version that the change is based on. */
  async change(layer: Layer, change: LayerPatch, etag?: string): Promise<void> {
    this.put(await changeLayer(this._api, this._modelId, layer.id, change, etag));
  }

  async remove(layer: Layer): Promise<void> {
    await this._api.deleteAsRead("DELETE /models/{model}/layers/{layer}", {
      path: { model: this._modelId, layer: layer.id },
    });
    this.drop(layer.id);
  }

  put(layer: Layer): void {
    this.putAll([...this.all.filter((other) => other.id !== layer.id), layer]);
  }

  /**
   * Takes the layers that the server sends when this page joins the room. Discards settings of
   * unknown layers. `kept` are the settings that are stored for this user, if any.
   */
  takeAll(layers: Layer[], kept?: PersonalView): void {
    this.putAll(layers);
    this.forgetUnknown();
    if (this._keeper.isAhead) this._keeper.flush();
    else if (kept) this.takeKept(kept);
    if (!this.selected) this.selectTop();
  }

  onEvent(event: LayerEvent): void {
    if ((event.event === "created" || event.event === "changed") && event.layer) {
      this.put(completeLayer(event.layer));
      if (this.selectedId === null) this.selectedId = event.layer_id;
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
    this._host.changed();
  }

  private shown(id: number): LayerShown {
    const highlight = this._highlights.get(id);
    return { ...this._overrides.get(id), ...(highlight ? { highlight } : {}) };
  }

  /** The server refuses a whole message that contains an unknown layer. */
  private forgetUnknown(): void {
    const known = new Set(this.all.map((layer) => layer.id));
    for (const kept of [this._overrides, this._own, this._highlights])
      for (const id of kept.keys()) if (!known.has(id)) kept.delete(id);
  }

  private override(layers: readonly Layer[], change: LayerShown): void {
    for (const shown of [this._overrides, this._own])
      for (const { id } of layers) shown.set(id, { ...shown.get(id), ...change });
    this.changedByHand();
  }

  private takeKept(kept: PersonalView): void {
    this._own = layersOfView(kept, this.all);
    if (this._atView) return;
    this.showAll(new Map(this._own), false);
    this.sendOverrides();
  }

  private showAll(overrides: Map<number, LayerShown>, atView: boolean): void {
    this._overrides = overrides;
    this._atView = atView;
    this.putAll(this.all);
  }

  /** Sends the changed settings and stores them. */
  private changedByHand(): void {
    this.sendOverrides();
    const own = this.all.map((layer) => ({
      layer: layer.id,
      ...ownPart(layer, this._own.get(layer.id) ?? {}),
    }));
    this._keeper.keep({ layers: own.filter((each) => Object.keys(each).length > 1) });
  }

  private sendOverrides(): void {
    const ids = new Set([...this._overrides.keys(), ...this._highlights.keys()]);
    this._host.sendOverrides([...ids].map((layer) => ({ layer, ...this.shown(layer) })));
    this._host.changed();
  }

  private putAll(layers: Layer[]): void {
    this.all = [...layers].sort((a, b) => this.order(a) - this.order(b) || a.id - b.id);
    this._host.changed();
  }

  private selectTop(): void {
    this.selectedId = this.all[this.all.length - 1]?.id ?? null;
    this._host.changed();
  }

  private drop(id: number): void {
    this.all = this.all.filter((layer) => layer.id !== id);
    this._own.delete(id);
    const had = this._overrides.delete(id);
    if (this._highlights.delete(id) || had) this.sendOverrides();
    if (this.selectedId === id) this.selectTop();
    this._host.changed();
  }
}
