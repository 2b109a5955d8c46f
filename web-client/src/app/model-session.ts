// One open model on this page: joins the connection, the camera, the tools and what the panels show. Elements
// subscribe and draw themselves from its state; they change it only through its methods.

import { Api, ApiError, new_id, type Versioned } from "../core/api";
import { OrbitCamera, type StandardView } from "../core/camera";
import { Connection, type ConnectionState, type SavingState, type SocketLike, type StrokeHandle } from "../core/connection";
import type { FrameMessage } from "../core/frame-header";
import type { GestureHandler, PointerSample } from "../core/input";
import { metres_per } from "../core/measure";
import type { LayerEvent, LayerOverride, ModelEvent, Picked, PresenceUser, ProblemMessage, Welcome } from "../core/protocol.gen";
import { complete_layer, may_curate, may_paint, type Layer, type LayerPatch, type Model, type ModelPatch, type Role } from "../core/types";
import { BrushTool } from "../tools/brush";
import { OrbitTool, PanTool } from "../tools/navigate";
import { PickTool } from "../tools/pick";
import type { ToolName } from "../tools/tool";
import { ToolManager } from "../tools/tool-manager";
import { BrushSettings, describe_value, value_problem } from "./brush-settings";
import { notices } from "./notices";
import { PickProbe } from "./pick-probe";
import { forget, remember } from "./sessions";
import { texts } from "./texts";

interface Override {
  visible?: boolean;
  opacity?: number;
}

const kStillAfter_ms = 120; // without input the camera counts as still
const kPresenceEvery_ms = 100;

export class ModelSession {
  model: Model | null = null;
  layers: Layer[] = []; // by order: the last is on top
  selected: number | null = null;
  deleted = false;
  signed_out = false; // the server no longer knows who this is
  role: Role = "viewer";
  session = "";
  users: PresenceUser[] = [];
  connection_state: ConnectionState = "connecting";
  saving: SavingState = { waiting: 0, failing: false };
  pointer: PointerSample | null = null; // window pixels
  picked: Picked | null = null; // under the pointer, newest known
  stroking = false;
  frames_drawn = 0;

  readonly camera = new OrbitCamera();
  readonly brush = new BrushSettings();
  readonly tools: ToolManager;
  /** Window pixels per CSS pixel. */
  scale = 1;
  /** Set by the stage. */
  on_frame: (part: FrameMessage) => void = () => {};
  on_reset_frames: () => void = () => {};

  private readonly connection_: Connection;
  private readonly listeners_ = new Set<() => void>();
  private readonly overrides_ = new Map<number, Override>();
  private etag_ = "";
  private fitted_ = false;
  private was_open_ = false;
  private closed_ = false; // its page is gone
  private told_left_ = false;
  private after_stroke_: (() => void)[] = [];
  private depth_: number | null = null; // of the last surface point seen under the pointer
  private still_timer_: ReturnType<typeof setTimeout> | null = null;
  private readonly probe_ = new PickProbe({
    ready: () => this.connection_state === "open",
    ask: (id, { x, y }) => this.connection_.pick(id, x, y),
    answered: (message, take) => this.on_picked(message, take),
  });
  private presence_timer_: ReturnType<typeof setTimeout> | null = null;

  constructor(
    readonly api: Api,
    readonly model_id: string,
    make_socket?: (url: string, protocol: string) => SocketLike,
  ) {
    const { protocol, host } = window.location;
    const url = `${protocol === "https:" ? "wss" : "ws"}://${host}/api/v1/models/${encodeURIComponent(model_id)}/live`;
    this.connection_ = new Connection(
      {
        url,
        client: "strata-page/0.1",
        device_pixel_ratio: window.devicePixelRatio,
        ...(make_socket ? { make_socket } : {}),
      },
      {
        state: (state) => this.on_state(state),
        welcome: (message) => this.on_welcome(message),
        frame: (part) => this.on_frame(part),
        saving: (state) => this.on_saving(state),
        applied: () => this.probe_.ask_again(this.pointer),
        saved: () => {},
        layer: (event) => this.on_layer(event),
        model: (event) => this.on_model(event),
        record: () => {},
        presence: (message) => {
          this.users = message.users;
          this.changed();
        },
        picked: (message) => this.probe_.answer(message),
        problem: (problem) => this.on_problem(problem),
      },
    );
    const brush_host = {
      begin_stroke: (erase: boolean) => this.begin_stroke(erase),
      stroke_ended: () => this.stroke_ended(),
      radius_px: () => this.radius_window_px(),
      next_frame: (callback: () => void) => void requestAnimationFrame(callback),
    };
    this.tools = new ToolManager(
      [
        new OrbitTool(this.gestures),
        new PanTool(this.gestures),
        new BrushTool("brush", brush_host),
        new BrushTool("eraser", brush_host),
        new PickTool((sample) => this.probe_.ask(sample, true)),
      ],
      "orbit",
      () => this.changed(),
    );
  }

  readonly gestures: GestureHandler = {
    tool_down: (sample) => this.tools.down(sample),
    tool_move: (samples) => this.tools.move(samples),
    tool_up: () => this.tools.up(),
    tool_cancel: () => this.tools.cancel(),
    orbit: (dx, dy) => this.move_camera(() => this.camera.orbit_pixels(dx, dy)),
    pan: (dx, dy) => this.move_camera(() => this.camera.pan_pixels(dx, dy)),
    zoom: (factor, x, y) => this.move_camera(() => this.camera.zoom_at(factor, x, y)),
    twist: (angle) => this.move_camera(() => this.camera.orbit(-angle, 0)),
    hover: (sample) => this.hover(sample),
  };

  // ── life ──────────────────────────────────────────────────────────────────────────────────────────────────────────

  subscribe(listener: () => void): () => void {
    this.listeners_.add(listener);
    return () => this.listeners_.delete(listener);
  }

  async open(): Promise<void> {
    const model = await this.api.model(this.model_id);
    if (this.closed_) return;
    this.take_model(model);
    remember(this);
    this.connection_.open();
  }

  /** Its page is gone. What was painted still goes to the server: the connection lingers until all of it is saved. */
  close(): void {
    this.closed_ = true;
    this.tools.cancel();
    for (const timer of [this.still_timer_, this.presence_timer_]) if (timer) clearTimeout(timer);
    this.probe_.stop();
    this.listeners_.clear();
    this.on_frame = this.on_reset_frames = () => {};
    if (this.saving.waiting === 0) {
      this.discard();
      return;
    }
    this.connection_.presence(null);
    this.connection_.stop_viewing();
    this.tell_left_behind();
  }

  /** Ends the connection; what is not saved is lost. */
  discard(): void {
    forget(this);
    this.saving = { waiting: 0, failing: false };
    this.connection_.close();
  }

  check_connection(): void {
    this.connection_.check();
  }

  get can_paint(): boolean {
    return may_paint(this.role);
  }
  get can_curate(): boolean {
    return may_curate(this.role);
  }

  private changed(): void {
    for (const listener of this.listeners_) listener();
  }

  // ── camera ────────────────────────────────────────────────────────────────────────────────────────────────────────

  /** The stage's size in CSS pixels, and window pixels for each of them. */
  set_viewport(width: number, height: number, scale: number): void {
    if (this.stroking) {
      this.after_stroke_.push(() => this.set_viewport(width, height, scale));
      return;
    }
    this.scale = scale;
    this.camera.resize(width * scale, height * scale);
    this.fit_at_first();
    this.camera_moved(false);
  }

  /** Once the model and the stage's size are both known. */
  private fit_at_first(): void {
    if (this.fitted_ || !this.model || this.camera.width <= 1) return;
    this.fitted_ = true;
    this.camera.first_view();
    this.camera_moved(false);
  }

  standard_view(view: StandardView): void {
    this.move_camera(() => this.camera.standard_view(view), false);
  }
  fit(): void {
    this.move_camera(() => this.camera.fit(), false);
  }
  set_perspective(perspective: boolean): void {
    this.move_camera(() => (this.camera.perspective = perspective), false);
  }

  /** Shows the model with another up direction without keeping it. */
  preview_up(up: Model["up"]): void {
    if (!this.model) return;
    this.camera.set_model(this.model.bounds, up);
    this.camera_moved(false);
  }

  private move_camera(move: () => void, moving = true): void {
    if (this.stroking) return; // a stroke's pixels are of the camera that it began with
    move();
    this.camera_moved(moving);
  }

  private camera_moved(moving: boolean): void {
    if (this.fitted_) this.connection_.set_camera(this.camera.message(), moving);
    if (this.still_timer_) clearTimeout(this.still_timer_);
    this.still_timer_ = null;
    if (moving) {
      this.still_timer_ = setTimeout(() => {
        this.still_timer_ = null;
        this.connection_.set_camera(this.camera.message(), false);
        this.probe_.ask_again(this.pointer);
      }, kStillAfter_ms);
    }
    this.changed();
  }

  frame_drawn(part: FrameMessage): void {
    this.connection_.ack(part.header.view_id, part.header.frame);
    this.frames_drawn += 1;
    if (this.frames_drawn === 1) this.changed();
  }

  // ── pointer ───────────────────────────────────────────────────────────────────────────────────────────────────────

  private hover(sample: PointerSample | null): void {
    this.pointer = sample;
    if (sample) this.probe_.ask(sample);
    else this.picked = null;
    this.schedule_presence();
    this.changed();
  }

  private schedule_presence(): void {
    if (this.presence_timer_) return;
    this.presence_timer_ = setTimeout(() => {
      this.presence_timer_ = null;
      this.connection_.presence(this.pointer ? [this.pointer.x, this.pointer.y] : null);
    }, kPresenceEvery_ms);
  }

  private on_picked(message: Picked, take: boolean): void {
    if (this.pointer || take) this.picked = message;
    if (message.hit && message.position) this.depth_ = this.camera.depth_of(message.position);
    if (take) this.take_picked(message);
    this.changed();
  }

  /** The selected layer's value goes onto the brush. */
  private take_picked(message: Picked): void {
    const layer = this.selected_layer;
    if (!layer || !message.hit) return;
    const found = message.values?.[layer.slug];
    if (found?.valid && found.value !== undefined) {
      this.brush.set_value(layer, found.value);
      notices.show("info", texts.value.picked(describe_value(layer, found.value), layer.name));
    } else {
      notices.show("info", texts.value.picked_nothing(layer.name));
    }
  }

  // ── brush ─────────────────────────────────────────────────────────────────────────────────────────────────────────

  /** Radius of the brush in window pixels at the surface under the pointer. */
  radius_window_px(): number {
    const { unit, width } = this.brush;
    if (unit === "px") return (width.px / 2) * this.scale;
    if (!this.model) return 0;
    const radius = (width.mm / 2) * (0.001 / metres_per(this.model.unit));
    return radius / this.camera.unit_per_pixel(this.surface_depth());
  }

  /** Depth of the surface under the pointer; where it is not known, of the camera's target. */
  surface_depth(): number {
    return this.depth_ !== null && this.depth_ > 0 ? this.depth_ : this.camera.distance;
  }

  set_brush(change: (brush: BrushSettings) => void): void {
    change(this.brush);
    this.changed();
  }

  choose_tool(name: ToolName): void {
    this.tools.choose(name);
  }

  private begin_stroke(erase: boolean): StrokeHandle | null {
    const layer = this.layer_to_paint();
    if (!layer) return null;
    const value = this.brush.value_of(layer);
    const wrong = erase ? null : value_problem(layer, value);
    if (wrong) {
      notices.show("problem", wrong);
      return null;
    }
    const { unit, width, shape } = this.brush;
    const stroke = this.connection_.begin_stroke({
      layer: layer.id,
      value,
      erase,
      camera: this.camera.message(),
      radius: unit === "px" ? { px: (width.px / 2) * this.scale } : { mm: width.mm / 2 },
      shape,
    });
    if (!stroke) {
      notices.show("problem", this.connection_.full ? texts.brush.too_much_waits : texts.brush.not_connected);
      return null;
    }
    this.stroking = true;
    this.changed();
    return stroke;
  }

  private stroke_ended(): void {
    this.stroking = false;
    for (const action of this.after_stroke_.splice(0)) action();
    this.changed();
  }

  private layer_to_paint(): Layer | null {
    if (!this.can_paint) {
      notices.show("problem", texts.brush.viewer_only);
      return null;
    }
    const layer = this.selected_layer;
    if (!layer) {
      notices.show("info", texts.brush.no_layer);
      return null;
    }
    if (!this.visible(layer)) {
      this.set_visible(layer, true);
      notices.show("info", texts.brush.hidden_layer(layer.name));
    }
    return layer;
  }

  undo(): void {
    this.send_history("undo");
  }
  redo(): void {
    this.send_history("redo");
  }

  private send_history(op: "undo" | "redo"): void {
    const layer = this.selected_layer;
    if (!layer || this.stroking) return;
    this.report_unsent(this.connection_.send_change({ op, id: new_id(), layer: layer.id }));
  }

  fill(layer: Layer): void {
    const value = this.brush.value_of(layer);
    const edit = { op: "fill", value, mode: "where", where: "true" } as const;
    this.report_unsent(this.connection_.send_change({ op: "edit", id: new_id(), layer: layer.id, edit }));
  }

  private report_unsent(id: string | null): void {
    if (id === null) notices.show("problem", texts.brush.not_connected);
  }

  // ── layers ────────────────────────────────────────────────────────────────────────────────────────────────────────

  get selected_layer(): Layer | null {
    return this.layers.find((layer) => layer.id === this.selected) ?? null;
  }

  select(layer: Layer): void {
    this.selected = layer.id;
    this.changed();
  }

  visible(layer: Layer): boolean {
    return this.overrides_.get(layer.id)?.visible ?? layer.visible;
  }
  opacity(layer: Layer): number {
    return this.overrides_.get(layer.id)?.opacity ?? layer.opacity;
  }

  /** What is shown differs from what everyone sees at first. */
  get has_overrides(): boolean {
    return this.layers.some(
      (layer) => this.visible(layer) !== layer.visible || Math.abs(this.opacity(layer) - layer.opacity) > 1e-6,
    );
  }

  set_visible(layer: Layer, visible: boolean): void {
    this.override(layer, { visible });
  }
  set_opacity(layer: Layer, opacity: number): void {
    this.override(layer, { opacity });
  }
  reset_overrides(): void {
    this.overrides_.clear();
    this.send_overrides();
  }

  async save_overrides_as_default(): Promise<void> {
    for (const layer of this.layers) {
      const [visible, opacity] = [this.visible(layer), this.opacity(layer)];
      if (visible === layer.visible && opacity === layer.opacity) continue;
      await this.change_layer(layer, { visible, opacity });
    }
    this.reset_overrides();
  }

  /** `etag`: the version that the change was thought out for. */
  async change_layer(layer: Layer, change: LayerPatch, etag?: string): Promise<void> {
    this.put_layer(await this.api.change_layer(this.model_id, layer.id, change, etag));
  }

  /** Moves the layer to the place `index` of the list, which is bottom to top. */
  async move_layer(layer: Layer, index: number): Promise<void> {
    const wanted = this.layers.filter((other) => other.id !== layer.id);
    wanted.splice(Math.max(0, Math.min(index, wanted.length)), 0, layer);
    const before = this.layers;
    this.layers = wanted.map((each, order) => ({ ...each, order }));
    this.changed();
    try {
      for (const each of this.layers) {
        if (before.find((old) => old.id === each.id)?.order === each.order) continue;
        await this.change_layer(each, { order: each.order });
      }
    } catch (error) {
      this.put_layers(await this.api.layers(this.model_id).catch(() => before)); // some may have moved already
      throw error;
    }
  }

  add_created(layer: Layer): void {
    this.put_layer(layer);
    this.selected = layer.id;
    if (this.tools.active !== "brush") this.tools.choose("brush");
    this.changed();
  }

  async delete_layer(layer: Layer): Promise<void> {
    await this.api.delete_layer(this.model_id, layer.id);
    this.drop_layer(layer.id);
  }

  private override(layer: Layer, change: Override): void {
    this.overrides_.set(layer.id, { ...this.overrides_.get(layer.id), ...change });
    this.send_overrides();
  }

  private send_overrides(): void {
    const overrides: LayerOverride[] = [...this.overrides_].map(([layer, override]) => ({ layer, ...override }));
    this.connection_.set_layer_overrides(overrides);
    this.changed();
  }

  private put_layer(layer: Layer): void {
    this.put_layers([...this.layers.filter((other) => other.id !== layer.id), layer]);
  }

  private put_layers(layers: Layer[]): void {
    this.layers = [...layers].sort((a, b) => a.order - b.order || a.id - b.id);
    this.changed();
  }

  private drop_layer(id: number): void {
    this.layers = this.layers.filter((layer) => layer.id !== id);
    if (this.overrides_.delete(id)) this.send_overrides();
    if (this.selected === id) this.selected = this.layers[this.layers.length - 1]?.id ?? null;
    this.changed();
  }

  // ── model ─────────────────────────────────────────────────────────────────────────────────────────────────────────

  async change_model(change: ModelPatch): Promise<void> {
    this.take_model(await this.api.change_model(this.model_id, change, this.etag_));
  }

  async reload_model(): Promise<void> {
    this.take_model(await this.api.model(this.model_id));
  }

  private take_model({ value, etag }: Versioned<Model>): void {
    this.etag_ = etag;
    this.put_model(value);
  }

  private put_model(model: Model): void {
    const turned = this.model !== null && this.model.up !== model.up;
    this.model = model;
    this.camera.set_model(model.bounds, model.up);
    this.fit_at_first();
    if (turned) this.camera_moved(false);
    this.changed();
  }

  // ── messages ──────────────────────────────────────────────────────────────────────────────────────────────────────

  private on_state(state: ConnectionState): void {
    this.connection_state = state;
    if (state !== "open") {
      this.users = [];
      this.probe_.reset();
      this.on_reset_frames();
    }
    if (state === "lost") {
      if (this.closed_) this.tell_left_behind();
      void this.find_why_lost();
    }
    this.changed();
  }

  /** A refused socket does not say why; the same question over HTTP does. */
  private async find_why_lost(): Promise<void> {
    try {
      await this.api.model(this.model_id);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 404) this.on_deleted();
      this.signed_out = error.status === 401;
      this.changed();
    }
  }

  private on_deleted(): void {
    const { waiting } = this.saving;
    if (waiting > 0) notices.show("problem", texts.saving.lost_with_model(waiting, this.name));
    this.deleted = true;
    this.discard();
    this.changed();
  }

  private on_saving(state: SavingState): void {
    this.saving = state;
    if (this.closed_ && state.waiting === 0) {
      if (this.told_left_) notices.show("success", texts.saving.left_saved(this.name));
      this.discard();
    }
    this.changed();
  }

  /** Once, and only when it takes long: usually all is saved in a moment. */
  private tell_left_behind(): void {
    if (this.told_left_ || this.connection_state === "open") return;
    this.told_left_ = true;
    notices.show("problem", texts.saving.left_behind(this.saving.waiting, this.name), texts.saving.left_behind_hint);
  }

  private get name(): string {
    return this.model?.name ?? "";
  }

  private on_welcome(message: Welcome): void {
    if (this.was_open_ && !this.closed_) notices.show("success", texts.connection.back);
    this.was_open_ = true;
    this.signed_out = false;
    this.role = message.role;
    this.session = message.session;
    this.put_model(message.model);
    this.put_layers(message.layers.map(complete_layer));
    const known = new Set(this.layers.map((layer) => layer.id));
    for (const id of this.overrides_.keys()) if (!known.has(id)) this.overrides_.delete(id);
    if (!this.selected_layer) this.selected = this.layers[this.layers.length - 1]?.id ?? null;
    this.changed();
  }

  private on_layer(event: LayerEvent): void {
    if ((event.event === "created" || event.event === "changed") && event.layer) {
      this.put_layer(complete_layer(event.layer));
      if (this.selected === null) this.selected = event.layer_id;
    } else if (event.event === "deleted") {
      const gone = this.layers.find((layer) => layer.id === event.layer_id);
      if (gone) notices.show("info", texts.layers.deleted_by_other(gone.name));
      this.drop_layer(event.layer_id);
    } else if (event.event === "edited") {
      this.layers = this.layers.map((layer) =>
        layer.id === event.layer_id ? { ...layer, sequence: event.sequence ?? layer.sequence } : layer,
      );
      this.probe_.ask_again(this.pointer);
    }
    this.changed();
  }

  private on_model(event: ModelEvent): void {
    if (event.event === "deleted") this.on_deleted();
    else if (this.stroking) this.after_stroke_.push(() => this.reload_after_change());
    else this.reload_after_change();
  }

  private reload_after_change(): void {
    this.reload_model().catch((error: unknown) => notices.error(error)); // with the version that changes need
  }

  private on_problem(problem: Omit<ProblemMessage, "op">): void {
    if (!this.probe_.refused(problem.ref)) notices.problem(problem);
  }
}
