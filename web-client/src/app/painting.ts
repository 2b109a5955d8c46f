// What this person paints with, and the edits that come of it.

import { new_id } from "../core/api";
import type { Connection, StrokeHandle } from "../core/connection";
import { metres_per } from "../core/measure";
import type { Picked } from "../core/protocol.gen";
import type { Layer, Model } from "../core/types";
import { BrushSettings, describe_value, value_problem } from "./brush-settings";
import type { LayerList } from "./layer-list";
import { notices } from "./notices";
import type { PointerWatch } from "./pointer-watch";
import { texts } from "./texts";
import type { ViewControl } from "./view-control";

export interface PaintingHost {
  readonly connection: Connection;
  readonly view: ViewControl;
  readonly layers: LayerList;
  readonly pointer: PointerWatch;
  model(): Model | null;
  may_paint(): boolean;
  changed(): void;
}

export class Painting {
  readonly brush = new BrushSettings();
  stroking = false;

  private after_stroke_: (() => void)[] = [];

  constructor(private readonly host_: PaintingHost) {}

  set_brush(change: (brush: BrushSettings) => void): void {
    change(this.brush);
    this.host_.changed();
  }

  /** Radius of the brush in window pixels at the surface under the pointer. */
  radius_window_px(): number {
    const { unit, width } = this.brush;
    const { view, pointer } = this.host_;
    const model = this.host_.model();
    if (unit === "px") return (width.px / 2) * view.scale;
    if (!model) return 0;
    const radius = (width.mm / 2) * (0.001 / metres_per(model.unit));
    return radius / view.camera.unit_per_pixel(pointer.surface_depth());
  }

  /** Its diameter on the object, there. */
  width_metres(): number {
    const { view, pointer } = this.host_;
    const model = this.host_.model();
    if (!model) return 0;
    return 2 * this.radius_window_px() * view.camera.unit_per_pixel(pointer.surface_depth()) * metres_per(model.unit);
  }

  // ── strokes ───────────────────────────────────────────────────────────────────────────────────────────────────────

  begin_stroke(erase: boolean): StrokeHandle | null {
    const layer = this.layer_to_paint();
    if (!layer) return null;
    const value = this.value_for(layer, erase);
    if (value === null) return null;
    const { unit, width, shape } = this.brush;
    const { connection, view } = this.host_;
    const stroke = connection.begin_stroke({
      layer: layer.id,
      value,
      erase,
      camera: view.camera.message(),
      radius: unit === "px" ? { px: (width.px / 2) * view.scale } : { mm: width.mm / 2 },
      shape,
    });
    if (!stroke) {
      notices.show("problem", connection.full ? texts.brush.too_much_waits : texts.brush.not_connected);
      return null;
    }
    this.stroking = true;
    this.host_.changed();
    return stroke;
  }

  stroke_ended(): void {
    this.stroking = false;
    for (const action of this.after_stroke_.splice(0)) action();
    this.host_.changed();
  }

  when_free(action: () => void): void {
    if (this.stroking) this.after_stroke_.push(action);
    else action();
  }

  // ── whole edits ───────────────────────────────────────────────────────────────────────────────────────────────────

  undo(): void {
    this.send_history("undo");
  }
  redo(): void {
    this.send_history("redo");
  }

  fill(layer: Layer): void {
    const value = this.brush.value_of(layer);
    const edit = { op: "fill", value, mode: "where", where: "true" } as const;
    this.report_unsent(this.host_.connection.send_change({ op: "edit", id: new_id(), layer: layer.id, edit }));
  }

  /** The selected layer's value goes onto the brush. */
  take_picked(message: Picked): void {
    const layer = this.host_.layers.selected;
    if (!layer || !message.hit) return;
    const found = message.values?.[layer.slug];
    if (found?.valid && found.value !== undefined) {
      this.brush.set_value(layer, found.value);
      notices.show("info", texts.value.picked(describe_value(layer, found.value), layer.name));
    } else {
      notices.show("info", texts.value.picked_nothing(layer.name));
    }
  }

  private send_history(op: "undo" | "redo"): void {
    const layer = this.host_.layers.selected;
    if (!layer || this.stroking) return;
    this.report_unsent(this.host_.connection.send_change({ op, id: new_id(), layer: layer.id }));
  }

  private report_unsent(id: string | null): void {
    if (id === null) notices.show("problem", texts.brush.not_connected);
  }

  /** The brush's value for the layer; null when the layer cannot hold it, and the person was told why. */
  private value_for(layer: Layer, erase: boolean): number | null {
    const value = this.brush.value_of(layer);
    const wrong = erase ? null : value_problem(layer, value);
    if (wrong) notices.show("problem", wrong);
    return wrong ? null : value;
  }

  private layer_to_paint(): Layer | null {
    const { layers } = this.host_;
    if (!this.host_.may_paint()) {
      notices.show("problem", texts.brush.viewer_only);
      return null;
    }
    const layer = layers.selected;
    if (!layer) {
      notices.show("info", texts.brush.no_layer);
      return null;
    }
    if (!layers.visible(layer)) {
      layers.set_visible(layer, true);
      notices.show("info", texts.brush.hidden_layer(layer.name));
    }
    return layer;
  }
}
