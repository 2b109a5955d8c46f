// What this person paints with, and the edits that come of it.

import { label_of } from "../../domain/cells";
import { new_id } from "../../net/api";
import type { Connection, Point, StrokeHandle } from "../../net/connection";
import type { PointerSample } from "../../ui/input";
import { format_area, metres_per } from "../../domain/measure";
import type { Applied, Edit, Picked } from "../../core/protocol.gen";
import type { Layer, Model } from "../../core/types";
import { why_locked } from "../../session/layer-lock";
import { BrushSettings } from "./brush-settings";
import { describe_value, type RecordLabels, value_problem } from "../../session/layer-values";
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
  model(): Model | null;
  records: RecordLabels;
  may_paint(): boolean;
  is_locked(layer: Layer): boolean; // to this person
  changed(): void;
}

const kThinnest = 0.08; // of the radius, however softly a pen is pressed

export class Painting {
  readonly brush = new BrushSettings();
  stroking = false; // or an outline is being drawn
  pen_used = false; // whose pressure counts

  private stroke_: StrokeHandle | null = null;
  private after_stroke_: (() => void)[] = [];
  private readonly whole_edits_ = new Set<string>(); // sent and not answered

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
    return (
      2 *
      this.radius_window_px() *
      view.camera.unit_per_pixel(pointer.surface_depth()) *
      metres_per(model.unit)
    );
  }

  // ── strokes
  // ───────────────────────────────────────────────────────────────────────────────────────────────────────

  begin_stroke(erase: boolean): StrokeHandle | null {
    const layer = this.layer_to_paint();
    if (!layer) return null;
    const value = this.value_for(layer, erase);
    if (value === null) return null;
    const { unit, width, shape, through, slant } = this.brush;
    const { connection, view } = this.host_;
    const stroke = connection.begin_stroke({
      layer: layer.id,
      value,
      erase,
      camera: view.camera.message(),
      through,
      ...(slant.limited && !through ? { max_angle_deg: slant.max_deg } : {}),
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
    this.stroke_ = stroke;
    this.host_.changed();
    return stroke;
  }

  /** Of the brush, as a pen presses. That one is used is known from then on. */
  width_of(pressure: number): number {
    if (!this.pen_used) {
      this.pen_used = true;
      this.host_.changed();
    }
    return this.brush.pressure ? Math.min(1, Math.max(kThinnest, pressure)) : 1;
  }

  /** Nothing more of the stroke is sent, whatever is still drawn. What was painted stays. */
  break_off(): void {
    this.stroke_?.end();
  }

  stroke_ended(): void {
    this.stroking = false;
    this.stroke_ = null;
    for (const action of this.after_stroke_.splice(0)) action();
    this.host_.changed();
  }

  when_free(action: () => void): void {
    if (this.stroking) this.after_stroke_.push(action);
    else action();
  }

  // ── whole edits
  // ───────────────────────────────────────────────────────────────────────────────────────────────────

  undo(): void {
    this.send_history("undo");
  }
  redo(): void {
    this.send_history("redo");
  }

  fill(layer: Layer): void {
    if (this.refuses(layer)) return;
    this.send_edit(layer, {
      op: "fill",
      value: this.brush.value_of(layer),
      mode: "where",
      where: "true",
    });
  }

  /** Fills what is connected with the place under the pointer. */
  fill_at({ x, y }: PointerSample): void {
    const target = this.area_target();
    if (!target) return;
    const at = { camera: this.host_.view.camera.message(), x, y };
    this.send_edit(target.layer, { op: "fill", ...target.paint, mode: this.brush.areas.reach, at });
  }

  begin_outline(): boolean {
    if (!this.area_target()) return false;
    this.stroking = true;
    return true;
  }

  finish_outline(path: Point[]): void {
    const target = this.area_target();
    if (!target) return;
    const camera = this.host_.view.camera.message();
    this.send_edit(target.layer, {
      op: "polygon",
      ...target.paint,
      camera,
      path,
      through: this.brush.through,
    });
  }

  /** The server's answer to a whole edit that was sent from here: how much it changed. */
  on_applied({ id, texels_changed, area_m2 }: Applied): void {
    if (id === undefined || !this.whole_edits_.delete(id)) return;
    if (texels_changed === 0) notices.show("info", texts.areas.nothing_changed);
    else notices.show("success", texts.areas.changed(format_area(area_m2 ?? 0)));
  }

  private area_target(): { layer: Layer; paint: { value: number } | { erase: true } } | null {
    const layer = this.layer_to_paint();
    if (!layer) return null;
    if (this.brush.areas.erases) return { layer, paint: { erase: true } };
    const value = this.value_for(layer, false);
    return value === null ? null : { layer, paint: { value } };
  }

  private send_edit(layer: Layer, edit: Edit): void {
    const id = this.host_.connection.send_change({
      op: "edit",
      id: new_id(),
      layer: layer.id,
      edit,
    });
    this.report_unsent(id);
    if (id !== null) this.whole_edits_.add(id);
  }

  /** The selected layer's value goes onto the brush. */
  take_picked(message: Picked): void {
    const layer = this.host_.layers.selected;
    if (!layer || !message.hit) return;
    const found = message.values?.[layer.slug];
    if (found?.valid && found.value !== undefined) {
      this.brush.set_value(layer, found.value);
      notices.show(
        "info",
        texts.value.picked(describe_value(layer, found.value, this.host_.records), label_of(layer)),
      );
    } else {
      notices.show("info", texts.value.picked_nothing(label_of(layer)));
    }
  }

  private send_history(op: "undo" | "redo"): void {
    const layer = this.host_.layers.selected;
    if (!layer || this.stroking || this.refuses(layer)) return;
    this.report_unsent(this.host_.connection.send_change({ op, id: new_id(), layer: layer.id }));
  }

  private report_unsent(id: string | null): void {
    if (id === null) notices.show("problem", texts.brush.not_connected);
  }

  /**
   * The brush's value for the layer; null when the layer cannot hold it, and the person was told
   * why.
   */
  private value_for(layer: Layer, erase: boolean): number | null {
    const value = this.brush.value_of(layer);
    const wrong = erase ? null : value_problem(layer, value);
    if (wrong) notices.show("problem", wrong);
    return wrong ? null : value;
  }

  /** The chosen layer, whose texels may be changed; otherwise as `chosen_layer`. */
  private layer_to_paint(): Layer | null {
    const layer = this.chosen_layer();
    return layer && this.refuses(layer) ? null : layer;
  }

  private refuses(layer: Layer): boolean {
    const locked = this.host_.is_locked(layer);
    if (locked) notices.show("problem", texts.layers.locked, why_locked(layer));
    return locked;
  }

  /** It is made visible; null: there is none to add to, and the person was told why. */
  chosen_layer(): Layer | null {
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
      notices.show("info", texts.brush.hidden_layer(label_of(layer)));
    }
    return layer;
  }
}
