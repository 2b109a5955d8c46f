// This user's painting settings, and the edits that result from them.

import { labelOf } from "../../domain/cells";
import { newId } from "../../core/ids";
import type { Connection } from "../../net/connection";
import type { Point, StrokeHandle } from "../../net/stroke";
import type { PointerSample } from "../../ui/input";
import { formatArea, metresPer } from "../../domain/measure";
import type { Applied, Edit, Picked, Within } from "../../core/protocol.gen";
import type { Layer, Model } from "../../core/types";
import { whyLocked } from "../../session/layer-lock";
import { BrushSettings } from "./brush-settings";
import type { DrawnOutline, HeldKeys, Selection } from "./selection";
import { describeValue, type RecordLabels, valueProblem } from "../../session/layer-values";
import { notices } from "../../ui/notices";
import type { PointerWatch } from "../../session/pointer-watch";
import { texts } from "../../texts";
import type { ViewControl } from "../../session/view-control";
import type { LayersPart } from "../../session/parts";

export interface PaintingHost {
  readonly connection: Connection;
  readonly view: ViewControl;
  readonly layers: LayersPart;
  readonly pointer: PointerWatch;
  /** The selection; null until it is loaded. */
  selection(): Selection | null;
  /** Uses the selection, after it is loaded. */
  withSelection(use: (selection: Selection) => void): void;
  model(): Model | null;
  records: RecordLabels;
  mayPaint(): boolean;
  isLocked(layer: Layer): boolean; // for this user
  changed(): void;
}

/** A layer, and what a whole edit does in it. */
export interface AreaTarget {
  layer: Layer;
  paint: { value: number } | { erase: true };
}

const kThinnest = 0.08; // share of the brush's radius at the lowest pen pressure

export class Painting {
  readonly brush = new BrushSettings();
  stroking = false; // also true while an outline is drawn
  penUsed = false; // whether the user has used a pen with pressure

  private _stroke: StrokeHandle | null = null;
  private _afterStroke: (() => void)[] = [];
  private _held: HeldKeys = {}; // at the start of the outline
  private readonly _wholeEdits = new Set<string>(); // edits that were sent and have no response yet

  constructor(private readonly _host: PaintingHost) {}

  changed(): void {
    this._host.changed();
  }

  setBrush(change: (brush: BrushSettings) => void): void {
    change(this.brush);
    this._host.changed();
  }

  /** Returns the radius of the brush in window pixels, on the surface under the pointer. */
  radiusWindowPx(): number {
    const { unit, width } = this.brush;
    const { view, pointer } = this._host;
    const model = this._host.model();
    if (unit === "px") return (width.px / 2) * view.scale;
    if (!model) return 0;
    const radius = (width.mm / 2) * (0.001 / metresPer(model.unit));
    return radius / view.camera.unitPerPixel(pointer.surfaceDepth());
  }

  /** Returns the brush's diameter on the object under the pointer, in meters. */
  widthMetres(): number {
    const { view, pointer } = this._host;
    const model = this._host.model();
    if (!model) return 0;
    return (
      2 *
      this.radiusWindowPx() *
      view.camera.unitPerPixel(pointer.surfaceDepth()) *
      metresPer(model.unit)
    );
  }

  // ── strokes ────────────────────────────────────────────────────────────────────────────────────

  beginStroke(erase: boolean): StrokeHandle | null {
    const layer = this.layerToPaint();
    if (!layer) return null;
    const value = this.valueFor(layer, erase);
    if (value === null) return null;
    const { unit, width, shape, through, slant } = this.brush;
    const { connection, view } = this._host;
    const stroke = connection.beginStroke({
      layer: layer.id,
      value,
      erase,
      camera: view.camera.message(),
      through,
      ...(slant.limited && !through ? { max_angle_deg: slant.maxDeg } : {}),
      radius: unit === "px" ? { px: (width.px / 2) * view.scale } : { mm: width.mm / 2 },
      shape,
    });
    if (!stroke) {
      notices.show(
        "problem",
        connection.full ? texts.brush.too_much_waits : texts.brush.not_connected,
      );
      return null;
    }
    this.stroking = true;
    this._stroke = stroke;
    this._host.changed();
    return stroke;
  }

  /** Returns the brush's width at a pen pressure. Records that a pen is in use. */
  widthOf(pressure: number): number {
    if (!this.penUsed) {
      this.penUsed = true;
      this._host.changed();
    }
    return this.brush.pressure ? Math.min(1, Math.max(kThinnest, pressure)) : 1;
  }

  /**
   * Ends the stroke for the server, even if the user continues to draw. The painted part remains.
   */
  breakOff(): void {
    this._stroke?.end();
  }

  strokeEnded(): void {
    this.stroking = false;
    this._stroke = null;
    for (const action of this._afterStroke.splice(0)) action();
    this._host.changed();
  }

  whenFree(action: () => void): void {
    if (this.stroking) this._afterStroke.push(action);
    else action();
  }

  // ── whole edits ────────────────────────────────────────────────────────────────────────────────

  undo(): void {
    this.sendHistory("undo");
  }
  redo(): void {
    this.sendHistory("redo");
  }

  fill(layer: Layer): void {
    if (this.refuses(layer)) return;
    this.sendEdit(layer, {
      op: "fill",
      value: this.brush.valueFor(layer),
      mode: "where",
      where: "true",
    });
  }

  /** Fills the connected area under the pointer. */
  fillAt({ x, y }: PointerSample): void {
    const target = this.areaTarget();
    if (!target) return;
    const at = { camera: this._host.view.camera.message(), x, y };
    this.sendEdit(target.layer, { op: "fill", ...target.paint, mode: this.brush.areas.reach, at });
  }

  beginOutline(at: PointerSample): boolean {
    if (this._host.selection()?.refusesMore(at) || !this.areaTarget()) return false;
    this._held = at;
    this.stroking = true;
    return true;
  }

  /** Selects the inside of the outline, which is painted later. */
  finishOutline(path: Point[], corners: boolean): void {
    const camera = this._host.view.camera.message();
    const outline: DrawnOutline = { camera, path, through: this.brush.through, corners };
    const held = this._held;
    this._host.withSelection((selection) => selection.addOutline(outline, held));
  }

  /** Paints or erases the inside of outlines, as one edit. */
  paintOutlines({ layer, paint }: AreaTarget, { camera, path, through, steps }: Within): void {
    this.sendEdit(layer, {
      op: "polygon",
      ...paint,
      camera: camera!,
      path: path!,
      through: through ?? false,
      ...(steps ? { steps } : {}),
    });
  }

  /** Shows the size of the change after the server's response to a whole edit from this page. */
  onApplied({ id, texels_changed: texelsChanged, area_m2: areaM2 }: Applied): void {
    if (id === undefined || !this._wholeEdits.delete(id)) return;
    this.showChange(texelsChanged, areaM2);
  }

  showChange(texels: number | undefined, areaM2: number | undefined): void {
    if (texels === 0) notices.show("info", texts.areas.nothing_changed);
    else notices.show("success", texts.areas.changed(formatArea(areaM2 ?? 0)));
  }

  /** Returns null if nothing can be painted, after showing the reason to the user. */
  areaTarget(erases = this.brush.areas.erases): AreaTarget | null {
    const layer = this.layerToPaint();
    if (!layer) return null;
    if (erases) return { layer, paint: { erase: true } };
    const value = this.valueFor(layer, false);
    return value === null ? null : { layer, paint: { value } };
  }

  private sendEdit(layer: Layer, edit: Edit): void {
    const id = this._host.connection.sendChange({
      op: "edit",
      id: newId(),
      layer: layer.id,
      edit,
    });
    this.reportUnsent(id);
    if (id !== null) this._wholeEdits.add(id);
  }

  /** Sets the brush to the picked value of the selected layer. */
  takePicked(message: Picked): void {
    const layer = this._host.layers.selected;
    if (!layer || !message.hit) return;
    const found = message.values?.[layer.slug];
    if (found?.valid && found.value !== undefined) {
      this.brush.setValue(layer, found.value);
      notices.show(
        "info",
        texts.value.picked(describeValue(layer, found.value, this._host.records), labelOf(layer)),
      );
    } else {
      notices.show("info", texts.value.picked_nothing(labelOf(layer)));
    }
  }

  private sendHistory(op: "undo" | "redo"): void {
    const layer = this._host.layers.selected;
    if (!layer || this.stroking || this.refuses(layer)) return;
    this.reportUnsent(this._host.connection.sendChange({ op, id: newId(), layer: layer.id }));
  }

  private reportUnsent(id: string | null): void {
    if (id === null) notices.show("problem", texts.brush.not_connected);
  }

  /**
   * Returns the brush's value for the layer. Returns null if the layer cannot store it, after
   * showing the reason to the user.
   */
  private valueFor(layer: Layer, erase: boolean): number | null {
    const value = this.brush.valueFor(layer);
    const wrong = erase ? null : valueProblem(layer, value);
    if (wrong) notices.show("problem", wrong);
    return wrong ? null : value;
  }

  /** Returns the result of `chosenLayer`, or null if the layer's texels cannot be changed. */
  private layerToPaint(): Layer | null {
    const layer = this.chosenLayer();
    return layer && this.refuses(layer) ? null : layer;
  }

  private refuses(layer: Layer): boolean {
    const locked = this._host.isLocked(layer);
    if (locked) notices.show("problem", texts.layers.locked, whyLocked(layer));
    return locked;
  }

  /**
   * Returns the selected layer, and makes it visible. Returns null if no layer can be painted,
   * after showing the reason to the user.
   */
  chosenLayer(): Layer | null {
    const { layers } = this._host;
    if (!this._host.mayPaint()) {
      notices.show("problem", texts.brush.viewer_only);
      return null;
    }
    const layer = layers.selected;
    if (!layer) {
      notices.show("info", texts.brush.no_layer);
      return null;
    }
    if (!layers.visible(layer)) {
      layers.setVisible(layer, true);
      notices.show("info", texts.brush.hidden_layer(labelOf(layer)));
    }
    return layer;
  }
}
