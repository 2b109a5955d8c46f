// One open model on this page: its life, and the messages between its parts. `view` is the camera,
// `layers` what is painted on, `tables` the records that layers hold the keys of, `comments` what
// people wrote on the surface, `hovered` the one that the mouse rests on, `appearance` its looks,
// light and section, `pointer` what lies under the pointer, `painting` the brush and the edits,
// `together` who else is here and whose view this is, `cursors` where they point, `views` what was
// kept to come back to, `tours` what curators make of views, `measuring` what is measured,
// `figures` what is drawn to scale, `face` the one that is asked for. Elements subscribe and draw
// themselves from their state; they change it only through their methods.

import { type Api, ApiError, type Versioned } from "../net/api";
import {
  Connection,
  type ConnectionState,
  type Point,
  type SavingState,
  type SocketLike,
} from "../net/connection";
import type { FrameMessage } from "../net/frame-header";
import type { GestureHandler, PointerSample } from "../ui/input";
import type {
  Background,
  LayerEvent,
  ModelEvent,
  Picked,
  ProblemMessage,
  Welcome,
} from "../core/protocol.gen";
import {
  complete_layer,
  is_as_computed,
  may_curate,
  may_paint,
  type Column,
  type Layer,
  type Model,
  type ModelPatch,
  type Role,
} from "../core/types";
import { UnsavedShelf } from "../net/offline-queue";
import { BrushTool } from "../features/painting/brush-tool";
import { BucketTool } from "../features/painting/bucket-tool";
import { CommentTool } from "../features/comments/comment-tool";
import { Activities } from "../features/activity/activity";
import { FaceTool } from "../features/figures/face-tool";
import { LineTool } from "../features/records/line-tool";
import { MeasureTool } from "../features/measuring/measure-tool";
import { OrbitTool, PanTool } from "../tools/navigate";
import { LassoTool, PolygonTool } from "../tools/outline";
import { PickTool } from "../features/painting/pick-tool";
import { PointTool } from "../features/records/point-tool";
import { kChangingTools, kMarkingTools, kPaintingTools, type ToolName } from "../tools/tool";
import { ToolManager } from "../tools/tool-manager";
import { Appearance } from "../features/appearance/appearance";
import { Comments } from "../features/comments/comments";
import { FacePick } from "../features/figures/face-pick";
import { Figures } from "../features/figures/figures";
import { LayerJobs } from "../session/layer-jobs";
import { why_locked } from "../session/layer-lock";
import { LayerList } from "../features/layers/layer-list";
import { MarkDrawing } from "../features/records/mark-drawing";
import { Measuring } from "../features/measuring/measuring";
import { notices } from "../ui/notices";
import { Painting } from "../features/painting/painting";
import { PeopleCursors } from "../features/presence/people-cursors";
import { PointerWatch } from "../session/pointer-watch";
import { RecordEditors } from "../session/record-editors";
import { RecordHover, type RecordAt } from "../features/records/record-hover";
import { Reviews } from "../features/review/reviews";
import { forget, remember } from "../session/sessions";
import { Tables } from "../features/tables/tables";
import { texts } from "../texts";
import { Together, type Shown } from "../features/presence/together";
import { ToolShapes } from "../features/painting/tool-shapes";
import { Tours } from "../features/tours/tours";
import { ViewControl, wants_less_motion } from "../session/view-control";
import { Views } from "../features/views/views";
import type { ModelSession } from "../session/model-session";

export class OpenModelSession implements ModelSession {
  model: Model | null = null;
  deleted = false;
  signed_out = false; // the server no longer knows who this is
  role: Role = "viewer";
  user = ""; // the name of who looks
  session = "";
  connection_state: ConnectionState = "connecting";
  saving: SavingState = { waiting: 0, failing: false };

  readonly view: ViewControl;
  readonly layers: LayerList;
  readonly jobs: LayerJobs;
  readonly appearance: Appearance;
  readonly pointer: PointerWatch;
  readonly painting: Painting;
  readonly shapes: ToolShapes;
  readonly tables: Tables;
  readonly editors: RecordEditors;
  readonly marks: MarkDrawing;
  readonly measuring: Measuring;
  readonly comments: Comments;
  readonly activity: Activities;
  readonly reviews: Reviews;
  readonly hovered: RecordHover;
  readonly together: Together;
  readonly cursors: PeopleCursors;
  readonly views: Views;
  readonly tours: Tours;
  readonly figures: Figures;
  readonly face: FacePick;
  readonly tools: ToolManager;
  /** Set by the stage. */
  on_frame: (part: FrameMessage) => void = () => {};
  on_reset_frames: () => void = () => {};

  private readonly connection_: Connection;
  private readonly listeners_ = new Set<() => void>();
  private etag_ = "";
  private preview_: Pick<Model, "unit" | "up"> | null = null;
  private was_open_ = false;
  private closed_ = false; // its page is gone
  private told_left_ = false;
  // the layer of which the person knows that it is locked
  private told_locked_: number | null = null;

  constructor(
    readonly api: Api,
    readonly model_id: string,
    make_socket?: (url: string, protocol: string) => SocketLike,
  ) {
    this.connection_ = this.make_connection(make_socket);
    const changed = (): void => this.changed();
    this.view = new ViewControl({
      send: (moving) => {
        this.hovered.wait_again();
        this.comments.sight.camera_moved();
        this.measuring.camera_moved();
        this.connection_.set_camera(this.view.camera.message(), moving);
      },
      when_free: (action) => this.painting.when_free(action),
      is_painting: () => this.painting.stroking,
      came_to_rest: () => {
        this.pointer.ask_again();
        this.cursors.look_again();
        this.together.came_to_rest();
        this.comments.look_again();
        this.measuring.came_to_rest();
      },
      went_own_way: () => this.together.stop_following(),
      changed,
    });
    this.layers = new LayerList(api, model_id, {
      send_overrides: (overrides) => this.connection_.set_layer_overrides(overrides),
      changed: () => this.target_changed(),
    });
    this.jobs = new LayerJobs(api, model_id, changed);
    this.appearance = new Appearance(api, model_id, {
      send: (looks, light) => this.connection_.set_appearance(looks, light),
      send_section: (planes, moving) => this.view.set_section(planes, moving),
      bounds: () => this.model?.bounds ?? null,
      changed,
    });
    this.pointer = new PointerWatch({
      camera: () => this.view.camera,
      ready: () => this.connection_state === "open",
      ask: (id, { x, y }) => this.connection_.pick(id, x, y),
      show_others: (pointer) => this.together.show(this.shown_at(pointer)),
      taken: (message) => {
        this.painting.take_picked(message);
        this.tables.show_card(this.layers.selected, message);
      },
      looked: (message) => this.tables.show_card(this.layer_with_record(message), message),
      learned: () => this.hovered.picked(),
      changed,
    });
    this.painting = new Painting({
      connection: this.connection_,
      view: this.view,
      layers: this.layers,
      pointer: this.pointer,
      model: () => this.model,
      records: {
        label: (table, key) => this.tables.label(table, key),
        term: (table, key) => this.tables.term(table, key),
      },
      may_paint: () => this.can_paint,
      is_locked: (layer) => this.is_locked(layer),
      changed,
    });
    this.shapes = new ToolShapes(api, {
      chosen: () => this.painting.brush.shape,
      choose: (shape) => this.painting.set_brush((brush) => (brush.shape = shape)),
      changed,
    });
    this.tables = new Tables(api, {
      model_id,
      project: () => this.model?.project ?? null,
      highlight: (layer_id, what) => this.layers.set_highlight(layer_id, what),
      fly_to: (bounds) => this.view.fly_to(bounds),
      changed,
    });
    this.editors = new RecordEditors({
      say: (what) => this.connection_.edit_record(what),
      name_of: (user) => this.together.name_of(user),
      changed,
    });
    this.marks = new MarkDrawing(api, {
      view: this.view,
      layers: this.layers,
      painting: this.painting,
      tables: this.tables,
      model: () => this.model,
      changed,
    });
    this.measuring = new Measuring(api, {
      view: this.view,
      layers: this.layers,
      model: () => this.model,
      changed,
    });
    this.comments = new Comments(api, model_id, {
      view: this.view,
      layers: this.layers,
      tables: this.tables,
      model: () => this.model,
      here: () => this.together.viewers,
      began: () => this.tools.choose("orbit"),
      changed,
    });
    this.activity = new Activities(api, {
      view: this.view,
      layers: this.layers,
      tables: this.tables,
      comments: this.comments,
      model: () => this.model,
      changed,
    });
    this.reviews = new Reviews(api, model_id, {
      view: this.view,
      layers: this.layers,
      me: () => this.user,
      name_of: (user) => this.together.name_of(user),
      can_paint: () => this.can_paint,
      can_curate: () => this.can_curate,
      changed,
    });
    this.hovered = new RecordHover({
      here: () => this.record_here(),
      settled: () => this.pointer.settled,
      changed,
    });
    this.together = new Together({
      session: () => this.session,
      ready: () => this.connection_state === "open",
      send: (shown) => this.connection_.presence(shown),
      view: this.view,
      ask: (id, x, y) => this.connection_.pick(id, x, y),
      changed,
    });
    this.cursors = new PeopleCursors({
      camera: () => this.view.camera,
      scale: () => this.view.scale,
      ready: () => this.connection_state === "open",
      ask: (id, x, y, camera) => this.connection_.pick(id, x, y, camera),
      wants_less_motion,
    });
    this.views = new Views(api, model_id, {
      view: this.view,
      layers: this.layers,
      appearance: this.appearance,
      tables: this.tables,
      when_free: (action) => this.painting.when_free(action),
      can_curate: () => this.can_curate,
      changed,
    });
    this.tours = new Tours(api, model_id, changed);
    this.figures = new Figures(api, this.jobs);
    this.face = new FacePick(api, {
      view: this.view,
      model: () => this.model,
      begin: () => this.tools.borrow("face"),
      end: () => this.tools.give_back(),
    });
    this.tools = this.make_tools();
  }

  readonly gestures: GestureHandler = {
    tool_down: (sample) => this.tools.down(sample),
    tool_move: (samples) => this.tools.move(samples),
    tool_up: () => this.tools.up(),
    tool_cancel: () => this.tools.cancel(),
    orbit: (dx, dy) => this.view.orbit_pixels(dx, dy),
    pan: (dx, dy) => this.view.pan_pixels(dx, dy),
    zoom: (factor, x, y) => this.view.zoom_at(factor, x, y),
    twist: (angle) => this.view.twist(angle),
    hover: (sample) => {
      this.tools.hover(sample);
      this.pointer.hover(sample);
    },
    free_mouse: (sample) => this.hovered.move(sample),
    tool_is_for_pen: () => kChangingTools.includes(this.tools.active),
  };

  private make_connection(make_socket?: (url: string, protocol: string) => SocketLike): Connection {
    const { protocol, host } = window.location;
    const url = `${protocol === "https:" ? "wss" : "ws"}://${host}/api/v1/models/${encodeURIComponent(this.model_id)}/live`;
    const client = "strata-page/0.1";
    return new Connection(
      {
        url,
        client,
        device_pixel_ratio: window.devicePixelRatio,
        ...(make_socket ? { make_socket } : {}),
        make_shelf: (user, model) => new UnsavedShelf(user, model, not_kept),
      },
      {
        state: (state) => this.on_state(state),
        welcome: (message) => this.on_welcome(message),
        frame: (part) => this.on_frame(part),
        saving: (state) => this.on_saving(state),
        applied: (message) => {
          this.painting.on_applied(message);
          this.pointer.ask_again();
        },
        saved: () => {
          this.reviews.saved();
          this.tables.refresh_areas(); // with the areas that this person's own strokes leave
          this.activity.outdated();
        },
        layer: (event) => this.on_layer(event),
        look: (event) => {
          this.appearance.on_event(event);
          this.activity.outdated();
        },
        tool: (event) => this.shapes.on_event(event),
        model: (event) => this.on_model(event),
        record: (event) => {
          this.tables.on_record(event);
          this.activity.outdated();
        },
        table: (event) => {
          this.tables.on_table(event);
          this.activity.outdated();
        },
        comment: (event) => {
          this.comments.on_event(event);
          this.activity.outdated();
        },
        view: (event) => this.views.on_event(event),
        editors: (message) => this.editors.on_message(message),
        presence: ({ users }) => {
          if (this.closed_) return;
          this.together.receive(users);
          this.cursors.receive(users.filter(({ session }) => session !== this.session));
        },
        picked: (message) => {
          if (!this.cursors.answer(message) && !this.together.answer(message))
            this.pointer.answer(message);
        },
        problem: (problem) => this.on_problem(problem),
        taken_up: (changes) =>
          notices.show("info", texts.saving.taken_up(changes), texts.saving.taken_up_hint),
      },
    );
  }

  private make_tools(): ToolManager {
    const brush_host = {
      begin_stroke: (erase: boolean) => this.painting.begin_stroke(erase),
      stroke_ended: () => this.painting.stroke_ended(),
      radius_px: () => this.painting.radius_window_px(),
      width_of: (pressure: number) => this.painting.width_of(pressure),
      next_frame: (callback: () => void) => void requestAnimationFrame(callback),
    };
    const comment = (sample: PointerSample): void => void this.comments.begin(sample);
    const navigator = {
      orbit: (dx: number, dy: number) => this.view.orbit_pixels(dx, dy),
      pan: (dx: number, dy: number) => this.view.pan_pixels(dx, dy),
      tap: (sample: PointerSample) => this.pointer.look(sample),
    };
    const { measuring } = this;
    const measure_host = {
      ...navigator,
      tap: (sample: PointerSample) => measuring.set_at(sample),
      point_at: (sample: PointerSample | null) => measuring.point_at(sample),
      set_in_middle: () => measuring.set_in_middle(),
      end: () => measuring.end(),
      take_back: () => measuring.take_back(),
      clear: () => measuring.clear(),
      begun: () => measuring.begun,
    };
    const face_host = {
      ...navigator,
      tap: (sample: PointerSample) => void this.face.take_at(sample),
      take_in_middle: () => this.face.take_in_middle(),
      give_up: () => this.face.give_up(),
    };
    const outline_host = {
      begin_outline: () => this.painting.begin_outline(),
      finish_outline: (path: Point[]) => this.painting.finish_outline(path),
      outline_ended: () => this.painting.stroke_ended(),
      scale: () => this.view.scale,
      outline_changed: () => this.changed(),
    };
    const line_host = {
      ...outline_host,
      begin_outline: () => this.marks.begin_line(),
      finish_outline: (path: Point[]) => this.marks.finish_line(path),
      outline_changed: () => {
        this.marks.line_changed(this.tools.outline);
        this.changed();
      },
    };
    return new ToolManager(
      [
        new OrbitTool(navigator),
        new PanTool(navigator),
        new BrushTool("brush", brush_host),
        new BrushTool("eraser", brush_host),
        new PolygonTool(outline_host),
        new LassoTool(outline_host),
        new BucketTool((sample) => this.painting.fill_at(sample)),
        new PickTool((sample) => this.pointer.take(sample)),
        new LineTool(line_host),
        new PointTool((sample) => this.marks.set_point(sample)),
        new MeasureTool(measure_host),
        new FaceTool(face_host),
        new CommentTool({ ...navigator, tap: comment }, () => ({
          x: this.view.camera.width / 2,
          y: this.view.camera.height / 2,
        })),
      ],
      "orbit",
      () => this.target_changed(),
    );
  }

  // ── life
  // ──────────────────────────────────────────────────────────────────────────────────────────────────────────

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

  /**
   * Its page is gone. What was painted still goes to the server: the connection lingers until all
   * of it is saved.
   */
  close(): void {
    this.closed_ = true;
    this.layers.flush();
    this.tools.stop();
    this.view.stop();
    this.pointer.stop();
    this.together.stop();
    this.cursors.stop();
    this.hovered.end();
    this.activity.close();
    this.reviews.close();
    this.tables.close();
    this.listeners_.clear();
    this.on_frame = this.on_reset_frames = () => {};
    if (this.saving.waiting === 0) {
      this.discard();
      return;
    }
    this.connection_.presence({});
    this.connection_.stop_viewing();
    this.tell_left_behind();
  }

  /**
   * Ends the connection; what is not saved is sent when the same person comes back to the model.
   */
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

  /**
   * To this person: curators change locked layers, too, but for those that are as they were
   * computed.
   */
  is_locked(layer: Layer): boolean {
    return layer.locked && (!this.can_curate || is_as_computed(layer));
  }

  /** The chosen layer, where a tool is in hand that would change its texels but may not. */
  get locked_target(): Layer | null {
    const { selected } = this.layers;
    const { active } = this.tools;
    const paints = kPaintingTools.includes(active) && !kMarkingTools.includes(active);
    return paints && selected && this.is_locked(selected) ? selected : null;
  }

  /**
   * Another tool, another layer, or another lock: who cannot paint any more is told so once, before
   * they try.
   */
  private target_changed(): void {
    const locked = this.locked_target;
    const told = this.told_locked_;
    this.told_locked_ = locked?.id ?? null;
    if (locked && locked.id !== told) {
      this.painting.break_off();
      this.tools.stop();
      this.tell_locked(locked);
    }
    this.changed();
  }

  private changed(): void {
    for (const listener of this.listeners_) listener();
  }

  /** The one that is painted on, if there is a record, or the topmost that shows one. */
  private layer_with_record(picked: Picked): Layer | null {
    const { selected, all } = this.layers;
    if (selected && this.shows_record(selected, picked)) return selected;
    return [...all].reverse().find((layer) => this.shows_record(layer, picked)) ?? null;
  }
  private shows_record(layer: Layer, { values }: Picked): boolean {
    return (
      layer.table !== undefined &&
      this.layers.visible(layer) &&
      values?.[layer.slug]?.valid === true
    );
  }

  /** Under the pointer, where the tool's tap would show its card, and does not already. */
  private record_here(): RecordAt | null {
    const { picked } = this.pointer;
    const { active } = this.tools;
    const { selected } = this.layers;
    if (!picked) return null;
    const looks = active === "orbit" || active === "pan";
    const layer = looks
      ? this.layer_with_record(picked)
      : active === "pick" && selected && this.shows_record(selected, picked)
        ? selected
        : null;
    const key = layer ? picked.values?.[layer.slug]?.value : undefined;
    const { card } = this.tables;
    return !layer || key === undefined || (card?.layer.id === layer.id && card.key === key)
      ? null
      : { layer, key };
  }

  /** The table of the layer that is painted on: shown, or no longer. */
  toggle_table(): void {
    const layer = this.layers.selected;
    if (this.tables.view) this.tables.close();
    else if (layer) this.tables.open(layer);
  }

  // ── what elements ask for
  // ─────────────────────────────────────────────────────────────────────────────────────────

  choose_tool(name: ToolName): void {
    if (kChangingTools.includes(name) && this.refuses_changes()) return;
    this.tools.choose(name);
  }

  /** Who may only look was told so, once they could look. */
  private refuses_changes(): boolean {
    if (!this.can_paint && this.was_open_) notices.show("problem", texts.brush.viewer_only);
    return !this.can_paint;
  }

  /** What is drawn next goes into this column of the record. */
  draw_marks(layer: Layer, key: number, column: Column): void {
    if (layer.table === undefined) return;
    this.layers.select(layer);
    this.painting.set_brush((brush) => brush.set_value(layer, key));
    this.marks.choose_column(layer.table, column);
    this.tools.choose(column.kind === "line" ? "line" : "point");
  }

  /** Strokes; with tools that add to records, changes of the table. */
  undo(): void {
    if (this.refuses_changes()) return;
    if (kMarkingTools.includes(this.tools.active)) this.marks.undo();
    else this.painting.undo();
  }
  redo(): void {
    if (this.refuses_changes()) return;
    if (kMarkingTools.includes(this.tools.active)) this.marks.redo();
    else this.painting.redo();
  }

  /** Behind the model; null: as the server has it. */
  set_background(background: Background | null): void {
    this.connection_.set_background(background);
  }

  frame_drawn(part: FrameMessage): void {
    this.connection_.ack(part.header.view_id, part.header.frame);
    this.view.count_frame();
  }

  /** A layer that this person made: it is what they paint on next. */
  add_created(layer: Layer): void {
    this.layers.put(layer);
    this.layers.select(layer);
    this.show_to_maker(layer);
    if (this.tools.active !== "brush" && !this.is_locked(layer)) this.tools.choose("brush");
  }

  /** What was computed does not cover what others look at: who made it sees it at once. */
  private show_to_maker(layer: Layer): void {
    if (!this.layers.visible(layer)) this.layers.set_visible(layer, true);
  }

  /** Layers that work made for this person: the first is what they look at next. */
  show_made(ids: readonly number[]): void {
    const layer = this.layers.find(ids[0] ?? null);
    if (layer) this.layers.select(layer);
    for (const id of ids) {
      const made = this.layers.find(id);
      if (made) this.show_to_maker(made);
    }
  }

  async change_model(change: ModelPatch): Promise<void> {
    this.take_model(await this.api.change_model(this.model_id, change, this.etag_));
  }

  async reload_model(): Promise<void> {
    this.take_model(await this.api.model(this.model_id));
  }

  /**
   * Shows the model as if it had this unit and up direction, without keeping them; null: as it has
   * them.
   */
  preview_scale(scale: Pick<Model, "unit" | "up"> | null): void {
    if (!this.model) return;
    this.preview_ = scale;
    this.view.preview_up(this.model, scale?.up ?? this.model.up);
    this.changed();
  }

  /** What lengths on the screen are told in. */
  get shown_unit(): Model["unit"] {
    return this.preview_?.unit ?? this.model?.unit ?? "m";
  }

  private take_model({ value, etag }: Versioned<Model>): void {
    this.etag_ = etag;
    this.put_model(value);
  }

  private put_model(model: Model): void {
    const turned = this.model !== null && this.model.up !== model.up;
    this.model = model;
    // What somebody else changes meanwhile does not end the preview.
    if (this.preview_) this.view.set_model({ ...model, up: this.preview_.up }, false);
    else this.view.set_model(model, turned);
    this.changed();
  }

  // ── messages
  // ──────────────────────────────────────────────────────────────────────────────────────────────────────

  private on_state(state: ConnectionState): void {
    this.connection_state = state;
    if (state !== "open") {
      this.editors.left();
      this.together.disconnected();
      this.cursors.reset();
      this.pointer.reset();
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
    this.connection_.forget();
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
    notices.show(
      "problem",
      texts.saving.left_behind(this.saving.waiting, this.name),
      texts.saving.left_behind_hint,
    );
  }

  private get name(): string {
    return this.model?.name ?? "";
  }

  private on_welcome(message: Welcome): void {
    if (this.was_open_ && !this.closed_) {
      if (message.role === this.role) notices.show("success", texts.connection.back);
      else
        notices.show(
          "info",
          texts.people.role_now(texts.roles[message.role]),
          texts.role_hints[message.role],
        );
    }
    this.was_open_ = true;
    this.signed_out = false;
    this.user = message.user;
    this.role = message.role;
    if (!this.can_paint && kChangingTools.includes(this.tools.active)) this.tools.choose("orbit");
    this.session = message.session;
    this.editors.joined(message.session, message.user);
    this.put_model(message.model);
    this.layers.take_all(message.layers.map(complete_layer), message.personal_view);
    this.appearance.take_looks(message.looks);
    this.shapes.refresh();
    this.tables.refresh();
    this.together.connected();
    this.comments.welcome(message.user);
    this.activity.outdated();
    this.reviews.welcome();
    this.views.welcome(message.user);
  }

  /** The brush is told as large as it is on the surface. */
  private shown_at(pointer: PointerSample | null): Shown {
    if (!pointer) return { pointer: null };
    const { active } = this.tools;
    const { view, painting } = this;
    const radius =
      painting.radius_window_px() * view.camera.unit_per_pixel(this.pointer.surface_depth());
    const in_hand = (active === "brush" || active === "eraser") && radius > 0;
    return { pointer: [pointer.x, pointer.y], ...(in_hand ? { radius } : {}) };
  }

  private on_layer(event: LayerEvent): void {
    this.layers.on_event(event);
    this.reviews.on_event(event);
    this.activity.outdated();
    if (event.event === "edited") {
      this.pointer.ask_again();
      this.measuring.on_layer_edited(event.layer_id);
      this.tables.on_layer_edited(event.layer_id);
    } else if (event.event === "deleted") {
      this.tables.on_layer_deleted(event.layer_id);
    }
  }

  private on_model(event: ModelEvent): void {
    this.activity.outdated();
    if (event.event === "deleted") this.on_deleted();
    else this.painting.when_free(() => this.reload_after_change());
  }

  private reload_after_change(): void {
    // with the version that changes need
    this.reload_model().catch((error: unknown) => notices.error(error));
  }

  private on_problem(problem: Omit<ProblemMessage, "op">): void {
    const { ref } = problem;
    if (this.pointer.refused(ref) || this.cursors.refused(ref) || this.together.refused(problem))
      return;
    const { selected } = this.layers;
    if (is_of_lock(problem) && selected && this.is_locked(selected)) this.tell_locked(selected);
    else notices.problem(problem);
  }

  /** In the words that the page has for it, whoever noticed: one notice stands for all. */
  private tell_locked(layer: Layer): void {
    notices.show("problem", texts.layers.locked, why_locked(layer));
  }
}

let told_not_kept = false;
const not_kept = (why: unknown): void => {
  if (told_not_kept) return;
  told_not_kept = true;
  notices.show("problem", texts.saving.not_kept, `${texts.saving.not_kept_hint} (${String(why)})`);
};

/** It is painting that was on its way when the layer was locked. */
const is_of_lock = ({ status, field }: Omit<ProblemMessage, "op">): boolean =>
  status === 403 && field === "layer";
