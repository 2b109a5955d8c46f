// One open model on this page: its life cycle, and the messages between its parts. `view` is the
// camera, `lit` the highlighted part of the surface, `layers` the layers, and `tables` the records
// behind the layers' keys. `comments` are the comments on the surface, and `hovered` is the record
// under the mouse pointer while the pointer does not move. `appearance` contains the surface
// images, the light and the section. `pointer` contains the values under the pointer, `painting`
// the brush and the edits. `together` contains the participants and the followed view, `cursors`
// their pointers. `views` are the saved views, `surveys` the other surveys of the object,
// `tours` the tours, `measuring` the measurement, `figures` the figures to scale, `reports` the
// condition reports, and `exports` the 3D models for other programs. `face` is the face to pick, and
// `past` the earlier states.
// Elements subscribe to the parts' state and render it. They change it only through methods. The
// file is long because it is the only one that connects the parts.

import type { Api } from "../net/api";
import { ApiError } from "../net/api-error";
import { Connection, type ConnectionState, type SavingState } from "../net/connection";
import type { SocketLike } from "../net/socket";
import type { FrameMessage } from "../net/frame-header";
import type { GestureHandler, PointerSample } from "../ui/input";
import type { Background, ModelEvent, ProblemMessage, Welcome } from "../core/protocol.gen";
import {
  completeLayer,
  mayCurate,
  mayPaint,
  type Column,
  type Layer,
  type Model,
  type ModelPatch,
  type Role,
} from "../core/types";
import { OfflineQueue } from "../net/offline-queue";
import { Activities } from "../features/activity/activity";
import {
  kChangingTools,
  kMarkingTools,
  kSelectionKeepingTools,
  type ToolName,
} from "../tools/tool";
import type { ToolManager } from "../tools/tool-manager";
import { EditableModel, type ModelScale } from "../session/editable-model";
import { Appearance } from "../features/appearance/appearance";
import { Comments } from "../features/comments/comments";
import { FacePick } from "../features/figures/face-pick";
import { Figures } from "../features/figures/figures";
import { FileJobs } from "../session/file-jobs";
import { LayerJobs } from "../session/layer-jobs";
import { LitArea } from "../session/lit-area";
import { LockWatch } from "../session/lock-watch";
import { LayerList } from "../features/layers/layer-list";
import { MarkDrawing } from "../features/records/mark-drawing";
import { Measuring } from "../features/measuring/measuring";
import { notices } from "../ui/notices";
import { Painting } from "../features/painting/painting";
import type { EdgeSnapper } from "../features/painting/edge-snapper";
import type { Photographs } from "../features/photographs/photographs";
import type { SavedSelections } from "../session/saved-selections";
import type { Selection } from "../features/painting/selection";
import type { SharpFrame, sharpFrames, ShownFrame } from "../features/painting/sharp-frame";
import type { Strokes } from "../features/painting/strokes";
import { Past } from "../features/past/past";
import { Visits } from "../features/past/visits";
import { PeopleCursors } from "../features/presence/people-cursors";
import { PointerWatch } from "../session/pointer-watch";
import { RecordEditors } from "../session/record-editors";
import { RecordHover } from "../features/records/record-hover";
import { RecordSight } from "../features/records/record-sight";
import { ModelExports } from "../features/exports/exports";
import { Reports } from "../features/reports/reports";
import { Reviews } from "../features/review/reviews";
import { forget, remember } from "../session/sessions";
import { Surveys } from "../features/surveys/surveys";
import { Tables } from "../features/tables/tables";
import { texts } from "../texts";
import { Together, type Shown } from "../features/presence/together";
import { ToolShapes } from "../features/painting/tool-shapes";
import { Tours } from "../features/tours/tours";
import { ViewControl, wantsLessMotion } from "../session/view-control";
import { Views } from "../features/views/views";
import { kBesideView } from "../net/view-settings";
import type { ModelSession, SessionPart } from "../session/model-session";
import { Signals } from "../session/signals";
import { eventsOfParts } from "./live-events";
import { makeTools } from "./make-tools";
import { partOf, withPart } from "./page-parts";

/** The exports of a later part that make the selection, and find edges and areas in frames. */
interface SelectionPart {
  selectionOf(session: ModelSession): Selection;
  makeStrokes(session: ModelSession, frame: () => SharpFrame | null): Strokes;
  EdgeSnapper: typeof EdgeSnapper;
  sharpFrames: typeof sharpFrames;
}

export class OpenModelSession implements ModelSession {
  deleted = false;
  signedOut = false; // the server no longer recognizes the session
  role: Role = "viewer";
  user = ""; // the name of this user
  session = "";
  connectionState: ConnectionState = "connecting";
  moved = false; // another node of the site has the model; the page connects to it
  databaseLost = false; // the node has lost its database, and still draws the model
  saving: SavingState = { waiting: 0, failing: false };

  readonly view: ViewControl;
  readonly lit: LitArea;
  readonly layers: LayerList;
  readonly jobs: LayerJobs;
  readonly appearance: Appearance;
  readonly pointer: PointerWatch;
  readonly painting: Painting;
  readonly past: Past;
  readonly visits: Visits;
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
  readonly surveys: Surveys;
  readonly tours: Tours;
  readonly files: FileJobs;
  readonly figures: Figures;
  readonly reports: Reports;
  readonly exports: ModelExports;
  readonly face: FacePick;
  readonly tools: ToolManager;
  selection: Selection | null = null;
  savedSelections: SavedSelections | null = null;
  photographs: Photographs | null = null;
  /** The stage sets these callbacks. */
  onFrame: (part: FrameMessage) => void = () => {};
  onResetFrames: () => void = () => {};
  shownFrame: () => ShownFrame | null = () => null;

  private readonly _connection: Connection;
  private readonly _sight: RecordSight;
  private readonly _model: EditableModel;
  private readonly _locks: LockWatch;
  private readonly _signals = new Signals<SessionPart>("session");
  private _wasOpen = false;
  private _closed = false; // whether the page was closed
  private _toldLeft = false;
  // a frame of the second view without an acknowledgment
  private _thenWithoutAck: number | null = null;
  private _edges: EdgeSnapper | null = null;
  private _strokes: Strokes | null = null;
  private _sharpFrame: (() => SharpFrame | null) | null = null;

  constructor(
    readonly api: Api,
    readonly modelId: string,
    makeSocket?: (url: string, protocol: string) => SocketLike,
  ) {
    this._connection = this.makeConnection(makeSocket);
    this._locks = new LockWatch({
      selected: () => this.layers.selected,
      tool: () => this.tools.active,
      canCurate: () => this.canCurate,
      stop: () => {
        this.painting.breakOff();
        this.tools.stop();
      },
    });
    const changes = (part: SessionPart) => (): void => this.changed(part);
    const withSelection = (use: (selection: Selection) => void): void => {
      if (this.selection) use(this.selection);
      else withPart<SelectionPart>("model_dialogs", ({ selectionOf }) => use(selectionOf(this)));
    };
    this.view = new ViewControl({
      send: (moving) => {
        this.hovered.waitAgain();
        this.comments.sight.cameraMoved();
        this.measuring.cameraMoved();
        this.lit.cameraMoved();
        this._connection.setCamera(this.view.camera.message(), moving);
        this.surveys.other?.cameraMoved(moving);
      },
      whenFree: (action) => this.painting.whenFree(action),
      isPainting: () => this.painting.stroking,
      cameToRest: () => {
        this.pointer.askAgain();
        this.cursors.lookAgain();
        this.together.cameToRest();
        this.comments.lookAgain();
        this.measuring.cameToRest();
        this.lit.cameToRest();
      },
      wentOwnWay: () => this.together.stopFollowing(),
      changed: changes("view"),
    });
    this.lit = new LitArea(api, modelId, {
      camera: () => this.view.camera,
      changed: changes("lit"),
    });
    this._model = new EditableModel(api, modelId, {
      view: this.view,
      changed: () => {
        this.surveys.modelChanged();
        this.changed();
      },
    });
    this.layers = new LayerList(api, modelId, {
      sendOverrides: (overrides) => this._connection.setLayerOverrides(overrides),
      changed: () => {
        this.surveys.other?.showLayers();
        this.targetChanged("layers");
      },
    });
    this.jobs = new LayerJobs(api, modelId, changes("jobs"));
    this.appearance = new Appearance(api, modelId, {
      send: (looks, light) => {
        this._connection.setAppearance(looks, light);
        this.surveys.other?.showLight();
      },
      sendSection: (planes, hiddenParts, moving) =>
        this.view.setSection(planes, hiddenParts, moving),
      bounds: () => this.model?.bounds ?? null,
      changed: changes("appearance"),
    });
    this.pointer = new PointerWatch({
      camera: () => this.view.camera,
      // The server returns values only for the newest state.
      ready: () => this.connectionState === "open" && !this.past.isActive,
      ask: (id, { x, y }) => this._connection.pick(id, x, y),
      showOthers: (pointer) => this.together.show(this.shownAt(pointer)),
      taken: (message) => {
        this.painting.takePicked(message);
        this.tables.showCard(this.layers.selected, message);
      },
      looked: (message) => {
        this.tables.showCard(this._sight.layerWithRecord(message), message);
        if (message.hit && message.position) this.photographs?.lookAt(message.position);
      },
      learned: () => this.hovered.picked(),
      changed: changes("pointer"),
    });
    this.painting = new Painting({
      connection: this._connection,
      view: this.view,
      layers: this.layers,
      pointer: this.pointer,
      selection: () => this.selection,
      withSelection,
      model: () => this.model,
      records: {
        label: (table, key) => this.tables.label(table, key),
        term: (table, key) => this.tables.term(table, key),
      },
      mayPaint: () => this.canPaint,
      isLocked: (layer) => this.isLocked(layer),
      changed: changes("painting"),
    });
    this.past = new Past(api, modelId, {
      show: (at, beside) => {
        this._connection.setPast(at, beside);
        if (!beside || this._thenWithoutAck === null) return;
        this._connection.ack(kBesideView, this._thenWithoutAck);
        this._thenWithoutAck = null;
      },
      whenFree: (action) => this.painting.whenFree(action),
      unsaved: () => this.saving.waiting,
      camera: () => this.view.camera.message(),
      stopPainting: () => {
        if (kChangingTools.includes(this.tools.active)) this.tools.choose("orbit");
        this.pointer.reset();
      },
      beginPart: () => this.tools.borrow("part"),
      endPart: () => this.tools.giveBack(),
      changed: changes("past"),
    });
    this.visits = new Visits(api, modelId, changes("past"));
    this.shapes = new ToolShapes(api, {
      chosen: () => this.painting.brush.shape,
      choose: (shape) => this.painting.setBrush((brush) => (brush.shape = shape)),
      changed: changes("shapes"),
    });
    this.tables = new Tables(api, {
      modelId,
      project: () => this.model?.project ?? null,
      highlight: (layerId, what) => this.layers.setHighlight(layerId, what),
      flyTo: (bounds) => this.view.flyTo(bounds),
      changed: changes("tables"),
    });
    this.editors = new RecordEditors({
      say: (what) => this._connection.editRecord(what),
      nameOf: (user) => this.together.nameOf(user),
      changed: changes("editors"),
    });
    this.marks = new MarkDrawing(api, {
      view: this.view,
      layers: this.layers,
      painting: this.painting,
      tables: this.tables,
      model: () => this.model,
      changed: changes("marks"),
    });
    this.measuring = new Measuring(api, {
      view: this.view,
      layers: this.layers,
      model: () => this.model,
      changed: changes("measuring"),
    });
    this.comments = new Comments(api, modelId, {
      view: this.view,
      layers: this.layers,
      tables: this.tables,
      model: () => this.model,
      here: () => this.together.viewers,
      began: () => this.tools.choose("orbit"),
      changed: changes("comments"),
    });
    this.activity = new Activities(api, {
      view: this.view,
      layers: this.layers,
      tables: this.tables,
      comments: this.comments,
      model: () => this.model,
      me: () => this.user,
      changed: changes("activity"),
    });
    this.reviews = new Reviews(api, modelId, {
      view: this.view,
      layers: this.layers,
      me: () => this.user,
      nameOf: (user) => this.together.nameOf(user),
      canPaint: () => this.canPaint,
      canCurate: () => this.canCurate,
      changed: changes("reviews"),
    });
    this._sight = new RecordSight({
      layers: this.layers,
      picked: () => this.pointer.picked,
      tool: () => this.tools.active,
      card: () => this.tables.card,
    });
    this.hovered = new RecordHover({
      here: () => this._sight.here,
      settled: () => this.pointer.settled,
      changed: changes("hovered"),
    });
    this.together = new Together({
      session: () => this.session,
      ready: () => this.connectionState === "open",
      send: (shown) => this._connection.presence(shown),
      view: this.view,
      ask: (id, x, y) => this._connection.pick(id, x, y),
      changed: changes("together"),
    });
    this.cursors = new PeopleCursors({
      camera: () => this.view.camera,
      scale: () => this.view.scale,
      ready: () => this.connectionState === "open",
      ask: (id, x, y, camera) => this._connection.pick(id, x, y, camera),
      wantsLessMotion,
    });
    this.views = new Views(api, modelId, {
      view: this.view,
      layers: this.layers,
      appearance: this.appearance,
      tables: this.tables,
      whenFree: (action) => this.painting.whenFree(action),
      canCurate: () => this.canCurate,
      changed: changes("views"),
    });
    this.surveys = new Surveys(
      api,
      {
        model: () => this.model,
        camera: () => this.view.camera,
        place: () => this.view.place,
        beginAt: (place) => this.view.beginAt(place),
        seen: () => this.layers.seen,
        show: (seen) => this.layers.showAlike(seen),
        light: () => this.appearance.light,
        setLight: (light) => this.appearance.setLight(light),
        changed: changes("surveys"),
      },
      makeSocket,
    );
    this.tours = new Tours(api, modelId, changes("tours"));
    this.files = new FileJobs(api, this.jobs);
    this.figures = new Figures(api, modelId, this.files);
    this.reports = new Reports(api, modelId, this.files);
    this.exports = new ModelExports(api, modelId, this.files);
    this.face = new FacePick(api, {
      view: this.view,
      model: () => this.model,
      begin: () => this.tools.borrow("face"),
      end: () => this.tools.giveBack(),
    });
    this.tools = makeTools(this, {
      chosen: (name) => {
        if (!kSelectionKeepingTools.includes(name)) this.selection?.clear();
        this.targetChanged("tools");
      },
      outline: () => this.changed("tools"),
      edges: () => this.edges,
      strokes: () => this.strokes,
      withSelection,
    });
  }

  readonly gestures: GestureHandler = {
    toolDown: (sample) => this.tools.down(sample),
    toolMove: (samples) => this.tools.move(samples),
    toolUp: () => this.tools.up(),
    toolCancel: () => this.tools.cancel(),
    orbit: (dx, dy) => this.view.orbitPixels(dx, dy),
    pan: (dx, dy) => this.view.panPixels(dx, dy),
    zoom: (factor, x, y) => this.view.zoomAt(factor, x, y),
    twist: (angle) => this.view.twist(angle),
    hover: (sample) => {
      this.tools.hover(sample);
      this.pointer.hover(sample);
    },
    freeMouse: (sample) => this.hovered.move(sample),
    toolIsForPen: () => kChangingTools.includes(this.tools.active),
  };

  /** Follows edges in the shown frame. Null until its part of the page is loaded. */
  private get edges(): EdgeSnapper | null {
    const part = partOf("model_dialogs") as SelectionPart | undefined;
    if (!part) return null;
    return (this._edges ??= new part.EdgeSnapper({
      frame: this.sharpFrame(part),
      window: () => this.view.camera,
      scale: () => this.view.scale,
      nowMs: () => performance.now(),
    }));
  }

  get strokes(): Strokes | null {
    const part = partOf("model_dialogs") as SelectionPart | undefined;
    return part ? (this._strokes ??= part.makeStrokes(this, this.sharpFrame(part))) : null;
  }

  private sharpFrame({ sharpFrames: make }: SelectionPart): () => SharpFrame | null {
    return (this._sharpFrame ??= make(
      () => this.shownFrame(),
      (seq) => this._connection.cameraInFrame(seq),
    ));
  }

  private makeConnection(makeSocket?: (url: string, protocol: string) => SocketLike): Connection {
    const { protocol, host } = window.location;
    const url = `${protocol === "https:" ? "wss" : "ws"}://${host}/api/v1/models/${encodeURIComponent(this.modelId)}/live`;
    const client = "strata-page/0.1";
    const events = eventsOfParts(this);
    return new Connection(
      {
        url,
        client,
        devicePixelRatio: window.devicePixelRatio,
        ...(makeSocket ? { makeSocket } : {}),
        makeQueue: (user, model) => new OfflineQueue(user, model, notKept),
      },
      {
        state: (state) => this.onState(state),
        welcome: (message) => this.onWelcome(message),
        frame: (part) =>
          part.header.view_id === kBesideView ? this.past.onFrame(part) : this.onFrame(part),
        saving: (state) => this.onSaving(state),
        ...events,
        presence: (message) => {
          if (!this._closed) events.presence(message);
        },
        model: (event) => this.onModel(event),
        problem: (problem) => this.onProblem(problem),
        takenUp: (changes) =>
          notices.show("info", texts.saving.taken_up(changes), texts.saving.taken_up_hint),
      },
    );
  }

  // ── life cycle ─────────────────────────────────────────────────────────────────────────────────

  subscribe(listener: () => void, parts?: readonly SessionPart[]): () => void {
    return this._signals.subscribe(listener, parts);
  }

  async open(): Promise<void> {
    const model = await this._model.read();
    if (this._closed) return;
    this.surveys.begin(model.value);
    this._model.take(model);
    remember(this);
    this._connection.open();
  }

  /**
   * Closes the session when the page is closed. The connection stays open until all unsaved edits
   * are saved.
   */
  close(): void {
    this._closed = true;
    this.layers.flush();
    this.tools.stop();
    this.selection?.clear();
    this.view.stop();
    this.lit.stop();
    this.pointer.stop();
    this.together.stop();
    this.cursors.stop();
    this.hovered.end();
    this.activity.close();
    this.reviews.close();
    this.past.stop();
    this.surveys.close();
    this.visits.close();
    this.tables.close();
    this._signals.clear();
    this.onFrame = this.onResetFrames = () => {};
    this.shownFrame = () => null;
    if (this.saving.waiting === 0) {
      this.discard();
      return;
    }
    this._connection.presence({});
    this._connection.stopViewing();
    this.tellLeftBehind();
  }

  /** Ends the connection. Unsaved changes are sent when the same user opens the model again. */
  discard(): void {
    forget(this);
    this.saving = { waiting: 0, failing: false };
    this._connection.close();
  }

  checkConnection(): void {
    this._connection.check();
    this.surveys.other?.checkConnection();
  }

  get canPaint(): boolean {
    return mayPaint(this.role);
  }
  get canCurate(): boolean {
    return mayCurate(this.role);
  }

  isLocked(layer: Layer): boolean {
    return this._locks.isLocked(layer);
  }
  get lockedTarget(): Layer | null {
    return this._locks.target;
  }

  /** Call this when the tool, the layer or its lock has changed. */
  private targetChanged(part: "layers" | "tools"): void {
    this._locks.lookAgain();
    this.changed(part);
  }

  changed(part: SessionPart = "session"): void {
    this._signals.tell(part);
  }

  /** Opens or closes the table of the selected layer. */
  toggleTable(): void {
    const layer = this.layers.selected;
    if (this.tables.view) this.tables.close();
    else if (layer) this.tables.open(layer);
  }

  // ── requests of elements ───────────────────────────────────────────────────────────────────────

  chooseTool(name: ToolName): void {
    if (kChangingTools.includes(name) && this.refusesChanges()) return;
    this.tools.choose(name);
  }

  /**
   * Returns whether the user cannot make changes, and shows a notice about the reason. While an
   * earlier state is shown, no user can make changes. Viewers get the notice only after the model
   * was opened.
   */
  private refusesChanges(): boolean {
    if (this.past.isActive) {
      notices.show("info", texts.past.paint_refused);
      return true;
    }
    if (!this.canPaint && this._wasOpen) notices.show("problem", texts.brush.viewer_only);
    return !this.canPaint;
  }

  /** Adds the next drawings to this column of the record. */
  drawMarks(layer: Layer, key: number, column: Column): void {
    if (layer.table === undefined || this.refusesChanges()) return;
    this.layers.select(layer);
    this.painting.setBrush((brush) => brush.setValue(layer, key));
    this.marks.chooseColumn(layer.table, column);
    this.tools.choose(column.kind === "line" ? "line" : "point");
  }

  /**
   * Undoes a stroke. With tools that add to records, undoes a change to the table. Strokes of an
   * area that can still change are undone first.
   */
  undo(): void {
    if (this.refusesChanges()) return;
    const strokes = this.tools.active === "strokes" ? this.strokes : null;
    if (strokes?.isOpen) {
      strokes.undo();
      return;
    }
    strokes?.forgetUndone();
    if (kMarkingTools.includes(this.tools.active)) void this.marks.undo();
    else this.painting.undo();
  }
  redo(): void {
    if (this.refusesChanges()) return;
    const strokes = this.tools.active === "strokes" ? this.strokes : null;
    if (strokes?.canRedo) {
      strokes.redo();
      return;
    }
    if (kMarkingTools.includes(this.tools.active)) void this.marks.redo();
    else this.painting.redo();
  }

  /** Sets the background of the model. Null restores the server's default. */
  setBackground(background: Background | null): void {
    this._connection.setBackground(background);
    this.surveys.setBackground(background);
  }

  frameDrawn(part: FrameMessage): void {
    this._connection.ack(part.header.view_id, part.header.frame);
    this.view.countFrame();
    if (!this.past.compares) this.past.frameDrawn(part);
  }
  thenDrawn(part: FrameMessage): void {
    if (!this.past.compares) {
      // Without an acknowledgment, the server draws no further frames of this view until it is
      // shown again.
      this._thenWithoutAck = part.header.frame;
      return;
    }
    this._connection.ack(part.header.view_id, part.header.frame);
    this.past.frameDrawn(part);
  }

  /** Adds and selects a layer that this user has created. */
  addCreated(layer: Layer): void {
    this.layers.put(layer);
    this.layers.select(layer);
    this.showToMaker(layer);
    if (this.tools.active !== "brush" && !this.isLocked(layer)) this.tools.choose("brush");
  }

  /**
   * Shows a new computed layer to its author. It is hidden by default, so it does not cover the
   * views of other users.
   */
  private showToMaker(layer: Layer): void {
    if (!this.layers.visible(layer)) this.layers.setVisible(layer, true);
  }

  /** Shows the layers that a job made for this user, and selects the first one. */
  showMade(ids: readonly number[]): void {
    const layer = this.layers.find(ids[0] ?? null);
    if (layer) this.layers.select(layer);
    for (const id of ids) {
      const made = this.layers.find(id);
      if (made) this.showToMaker(made);
    }
  }

  changeModel(change: ModelPatch): Promise<void> {
    return this._model.change(change);
  }
  async reloadModel(): Promise<void> {
    this._model.take(await this._model.read());
  }
  previewScale(scale: ModelScale | null): void {
    this._model.preview(scale);
  }
  get model(): Model | null {
    return this._model.value;
  }
  get shownUnit(): Model["unit"] {
    return this._model.shownUnit;
  }

  // ── messages ───────────────────────────────────────────────────────────────────────────────────

  private onState(state: ConnectionState): void {
    this.connectionState = state;
    this.moved = this._connection.moved;
    if (state !== "open") {
      this._thenWithoutAck = null; // the frame belonged to the lost connection
      this.editors.left();
      this.together.disconnected();
      this.cursors.reset();
      this.pointer.reset();
      this.onResetFrames();
    }
    if (state === "lost") {
      if (this._closed) this.tellLeftBehind();
      void this.findWhyLost();
    }
    this.changed();
  }

  /**
   * Determines why the connection was lost. The browser does not report why a socket was refused,
   * so this method sends a request over HTTP.
   */
  private async findWhyLost(): Promise<void> {
    try {
      await this._model.read();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 404) this.onDeleted();
      this.signedOut = error.status === 401;
      this.changed();
    }
  }

  private onDeleted(): void {
    const { waiting } = this.saving;
    if (waiting > 0) notices.show("problem", texts.saving.lost_with_model(waiting, this.name));
    this._connection.forget();
    this.deleted = true;
    this.discard();
    this.changed();
  }

  private onSaving(state: SavingState): void {
    this.saving = state;
    if (this.databaseLost !== this._connection.databaseLost) {
      this.databaseLost = this._connection.databaseLost;
      this.changed();
    }
    if (this._closed && state.waiting === 0) {
      if (this._toldLeft) notices.show("success", texts.saving.left_saved(this.name));
      this.discard();
    }
    this.changed("saving");
  }

  /**
   * Shows a notice about unsaved changes after the page was closed. It is shown only once, and only
   * while the server is not connected, because saving is usually fast.
   */
  private tellLeftBehind(): void {
    if (this._toldLeft || this.connectionState === "open") return;
    this._toldLeft = true;
    notices.show(
      "problem",
      texts.saving.left_behind(this.saving.waiting, this.name),
      texts.saving.left_behind_hint,
    );
  }

  private get name(): string {
    return this.model?.name ?? "";
  }

  private onWelcome(message: Welcome): void {
    if (this._wasOpen && !this._closed) {
      if (message.role === this.role) notices.show("success", texts.connection.back);
      else
        notices.show(
          "info",
          texts.people.role_now(texts.roles[message.role]),
          texts.role_hints[message.role],
        );
    }
    this._wasOpen = true;
    this.signedOut = false;
    this.user = message.user;
    this.role = message.role;
    if (!this.canPaint && kChangingTools.includes(this.tools.active)) this.tools.choose("orbit");
    this.session = message.session;
    this.editors.joined(message.session, message.user);
    this._model.put(message.model);
    this.layers.takeAll(message.layers.map(completeLayer), message.personal_view);
    this.appearance.takeLooks(message.looks);
    this.surveys.welcome();
    this.shapes.refresh();
    this.tables.refresh();
    this.together.connected();
    this.comments.welcome(message.user);
    this.activity.outdated();
    this.reviews.welcome();
    this.views.welcome(message.user);
    this.past.welcome();
    void this.visits.welcome(message.user, message.model.sequence);
  }

  /**
   * Returns the pointer for other participants. The brush radius is sent as a length on the
   * surface.
   */
  private shownAt(pointer: PointerSample | null): Shown {
    if (!pointer) return { pointer: null };
    const { active } = this.tools;
    const { view, painting } = this;
    const radius =
      painting.radiusWindowPx() * view.camera.unitPerPixel(this.pointer.surfaceDepth());
    const inHand = (active === "brush" || active === "eraser") && radius > 0;
    return { pointer: [pointer.x, pointer.y], ...(inHand ? { radius } : {}) };
  }

  private onModel(event: ModelEvent): void {
    this.activity.outdated();
    if (event.event === "deleted") this.onDeleted();
    else this.painting.whenFree(() => this.reloadAfterChange());
  }

  private reloadAfterChange(): void {
    // The new version is required for later changes.
    this.reloadModel().catch((error: unknown) => notices.error(error));
  }

  private onProblem(problem: Omit<ProblemMessage, "op">): void {
    const { ref } = problem;
    if (this.pointer.refused(ref) || this.cursors.refused(ref) || this.together.refused(problem))
      return;
    if (!this._locks.explains(problem)) notices.problem(problem);
  }
}

let toldNotKept = false;
const notKept = (why: unknown): void => {
  if (toldNotKept) return;
  toldNotKept = true;
  notices.show("problem", texts.saving.not_kept, `${texts.saving.not_kept_hint} (${String(why)})`);
};
