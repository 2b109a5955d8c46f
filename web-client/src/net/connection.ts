// The WebSocket connection of one open model. It sends hello, keeps the latest camera, resends
// unsaved changes, and reconnects automatically. Tests run it without a browser and with
// a fake socket, because this file does not use the DOM.

import { newId } from "../core/ids";
import type { CameraMessage } from "../math/camera";
import { decodeFrame, FrameError, type FrameMessage } from "./frame-header";
import { Outbox, type ChangeMessage, type SingleChange } from "./outbox";
import { BatchFlow } from "./batch-flow";
import { CameraSender } from "./camera-sender";
import { addressAtNode } from "./node-address";
import { NodeSearch } from "./node-search";
import { kLastRetryMs, Resender, retryDelayMs } from "./resender";
import { kOpenSocket, type SocketLike } from "./socket";
import { SilenceWatch } from "./silence-watch";
import { beginOf, StrokeHandle, type StrokeOptions } from "./stroke";
import { kBesideView, ViewSettings } from "./view-settings";
import { ownProblems } from "../core/problems";
import {
  parse_server_message,
  SUBPROTOCOL,
  type Applied,
  type Background,
  type ClientMessage,
  type CommentEvent,
  type DatabaseState,
  type LayerEvent,
  type LayerOverride,
  type Light,
  type LookEvent,
  type LookShown,
  type ModelEvent,
  type Moved,
  type Picked,
  type Presence,
  type PresenceUpdate,
  type ProblemMessage,
  type RecordEditors,
  type RecordEvent,
  type Saved,
  type ServerMessage,
  type SelectionEvent,
  type SnapshotEvent,
  type TableEvent,
  type ToolEvent,
  type ViewEvent,
  type Welcome,
} from "../core/protocol.gen";

/** lost: the connection waits for the next attempt. open: the server has sent welcome. */
export type ConnectionState = "connecting" | "open" | "lost" | "closed";

export interface SavingState {
  waiting: number; // number of changes that are not durable yet
  failing: boolean; // the server cannot save some changes at present; they are sent again
}

export interface ConnectionCallbacks {
  state(state: ConnectionState): void;
  welcome(message: Welcome): void;
  frame(part: FrameMessage): void;
  saving(state: SavingState): void;
  applied(message: Applied): void;
  saved(message: Saved): void;
  layer(message: LayerEvent): void;
  look(message: LookEvent): void;
  tool(message: ToolEvent): void;
  model(message: ModelEvent): void;
  record(message: RecordEvent): void;
  table(message: TableEvent): void;
  editors(message: RecordEditors): void;
  comment(message: CommentEvent): void;
  view(message: ViewEvent): void;
  snapshot(message: SnapshotEvent): void;
  selection(message: SelectionEvent): void;
  presence(message: Presence): void;
  picked(message: Picked): void;
  /** The server refused a message. A change that is refused permanently is not sent again. */
  problem(problem: Omit<ProblemMessage, "op">): void;
  /**
   * Reports the number of changes that an earlier page could not save and that this page sends
   * again.
   */
  takenUp(changes: number): void;
}

/** Storage for waiting changes that persists after the page is closed (offline-queue.ts). */
export interface ChangeQueue {
  read(): Promise<ChangeMessage[]>;
  put(message: ChangeMessage): void;
  remove(ids: readonly string[]): void;
}

export interface ConnectionOptions {
  url: string;
  client: string;
  devicePixelRatio: number;
  makeSocket?: (url: string, protocol: string) => SocketLike;
  /**
   * Makes the queue of the user who paints. Without a queue, unsaved changes are lost when the
   * connection object is closed.
   */
  makeQueue?: (user: string, model: number) => ChangeQueue;
  /** Calls back before the next repaint. */
  nextFrame?: (callback: () => void) => void;
  random?: () => number;
}

// The time limit for the handshake and the message `welcome`. The server may load the model in this
// time.
const kOpeningMs = 30_000;
const kBusySocketBytes = 256 * 1024; // no camera is sent above this number of unsent bytes
const kAdvice = "advice"; // id of messages whose failure is not reported
const kLastMovedRetryMs = 1000; // retry delay while the site decides which node has the model
const kMostWaiting = 5000; // number of changes above which new strokes are refused

export class Connection {
  private _socket: SocketLike | null = null;
  private _state: ConnectionState = "connecting";
  private _attempts = 0;
  private _moved = false;
  private _databaseLost = false;
  private _address: string; // address of the next connection: the site, or one of its nodes
  private _retryTimer: ReturnType<typeof setTimeout> | null = null;
  private readonly _silence = new SilenceWatch({
    ask: () => this.askForLife(),
    giveUp: () => this.giveUpSocket(),
  });
  private _failing = false;
  private _stroke: StrokeHandle | null = null; // the newest one
  private readonly _flow = new BatchFlow();
  private _pathPoints = 4096;
  private readonly _resender = new Resender((message) => this.send(message));
  private readonly _search = new NodeSearch(
    {
      connect: (node) => this.makeSocket(addressAtNode(this._options.url, node)),
      hello: (socket) => this.sayHello(socket),
      found: (socket, welcome) => this.onNodeFound(socket, welcome),
      random: () => (this._options.random ?? Math.random)(),
    },
    kOpeningMs,
  );

  private _queue: ChangeQueue | null = null;
  private readonly _outbox = new Outbox((ids) => this._queue?.remove(ids));
  // The ids of messages whose responses are ignored: discarded changes and liveness checks.
  private readonly _silenced = new Set<string>();

  private readonly _camera: CameraSender;
  private readonly _settings = new ViewSettings();

  constructor(
    private readonly _options: ConnectionOptions,
    private readonly _callbacks: ConnectionCallbacks,
  ) {
    this._address = _options.url;
    this._camera = new CameraSender({
      maySend: () => this._state === "open",
      isBusy: () => (this._socket?.bufferedAmount ?? 0) > kBusySocketBytes,
      send: (message) => {
        this.send(message);
        if (this._settings.comparesWithPast && message.op === "camera")
          this.send({ ...message, view_id: kBesideView });
        this.expectAnswer(); // the server will send a frame
      },
      nextFrame: _options.nextFrame ?? ((callback) => void requestAnimationFrame(callback)),
    });
  }

  get state(): ConnectionState {
    return this._state;
  }
  /** Whether another node of the site has the model, and its welcome has not arrived yet. */
  get moved(): boolean {
    return this._moved;
  }
  /**
   * Whether the node has lost its database. It still draws the model, but saves nothing, and the
   * picture may be out of date.
   */
  get databaseLost(): boolean {
    return this._databaseLost;
  }
  get waiting(): number {
    return this._outbox.waiting;
  }
  /** Whether new strokes are refused because too many changes are unsaved. */
  get full(): boolean {
    return this._outbox.waiting > kMostWaiting;
  }
  /**
   * Returns a number of the current camera that only this camera has. Returns null if a frame with
   * this camera number shows an older camera.
   */
  cameraInFrame(seq: number): number | null {
    return this._camera.numberOf(seq);
  }

  open(): void {
    this.setState("connecting");
    this.use(this.makeSocket(this._address));
    this._silence.limit(kOpeningMs);
  }

  private makeSocket(address: string): SocketLike {
    const make =
      this._options.makeSocket ??
      ((url, protocol) => new WebSocket(url, protocol) as unknown as SocketLike);
    return make(address, SUBPROTOCOL);
  }

  private use(socket: SocketLike): void {
    socket.binaryType = "arraybuffer";
    this._socket = socket;
    socket.onopen = () => {
      if (socket === this._socket) this.sayHello(socket);
    };
    socket.onmessage = (event) => {
      if (socket === this._socket) this.onMessage(event.data);
    };
    socket.onclose = () => {
      if (socket === this._socket) this.onLost();
    };
    socket.onerror = () => {}; // the browser then sends a close event
  }

  private sayHello(socket: SocketLike): void {
    const hello: ClientMessage = {
      op: "hello",
      client: this._options.client,
      dpr: this._options.devicePixelRatio,
      accept: ["jpeg", "png"],
    };
    socket.send(JSON.stringify(hello));
  }

  /** Closes the connection permanently. Unsaved changes stay in the queue. */
  close(): void {
    this.forgetTimers();
    this._search.stop();
    const socket = this._socket;
    this._socket = null;
    this.setState("closed");
    socket?.close(1000, "left");
  }

  /**
   * Reconnects without delay, or checks whether an open connection still works. Call this when the
   * network has changed, the page is visible again, or the user requests it.
   */
  check(): void {
    if (this._state === "open") this._silence.askNow();
    if (this._state !== "lost") return;
    if (this._retryTimer) clearTimeout(this._retryTimer);
    this._retryTimer = null;
    this.open();
  }

  /** Ends viewing. No camera is sent after a reconnection. Unsaved changes are still sent. */
  stopViewing(): void {
    this._camera.forget();
    this._settings.forgetShown();
  }

  setCamera(camera: CameraMessage, moving: boolean): void {
    this._camera.set(camera, moving);
  }

  setLayerOverrides(overrides: LayerOverride[]): void {
    this._settings.overrides = overrides;
    this.sendSettings();
  }

  setAppearance(looks: LookShown[] | null, light: Light): void {
    if (this._settings.setAppearance(looks, light)) this.sendSettings();
  }

  /** Sets the background. Null restores the server's default. */
  setBackground(background: Background | null): void {
    if (this._settings.setBackground(background)) this.sendSettings();
  }

  /**
   * Shows the state after this edit instead of the newest state. With `beside`, the second view
   * shows it next to the newest state. Null shows only the newest state.
   */
  setPast(at: number | null, beside: boolean): void {
    const compared = this._settings.comparesWithPast;
    this._settings.setPast(at, beside);
    this.sendSettings();
    if (this._state !== "open") return;
    if (this._settings.comparesWithPast && !compared) this._camera.sendNow();
    // Resets the second view to the newest state. The page does not acknowledge later frames of
    // this view, so the server stops drawing them.
    if (compared && !this._settings.comparesWithPast)
      this.send({ op: "layers", view_id: kBesideView, layers: [] });
  }

  private sendSettings(): void {
    if (this._state !== "open") return;
    this.send(this._settings.message());
    if (this._settings.comparesWithPast) this.send(this._settings.messageBeside());
  }

  ack(viewId: number, frame: number): void {
    if (this._state === "open") this.send({ op: "ack", view_id: viewId, frame });
  }

  pick(id: string, x: number, y: number, camera?: CameraMessage): void {
    if (this._state === "open") this.send({ op: "pick", id, x, y, ...(camera ? { camera } : {}) });
  }

  /** Sends the presence of this user, which replaces the previous one. */
  presence(shown: Omit<PresenceUpdate, "op">): void {
    if (this._state === "open") this.send({ op: "presence", ...shown });
  }

  /** Reports that this user edits a record, or has stopped editing it. */
  editRecord(what: { table: number; key: number; editing: boolean; take_over?: boolean }): void {
    if (this._state === "open") this.send({ op: "record.edit", id: kAdvice, ...what });
  }

  /**
   * Begins a stroke. Returns null while edits are not possible, because the page is not connected
   * or too many changes are unsaved.
   */
  beginStroke(options: StrokeOptions): StrokeHandle | null {
    if (this._state !== "open" || this.full) return null;
    const begin = beginOf(options);
    this.change(begin);
    this._stroke = new StrokeHandle(begin.stroke, this._pathPoints, this._flow, (message) => {
      if (!this._outbox.hasStroke(begin.stroke)) return;
      if (message.op === "stroke.extend") this._flow.sent(message);
      this.change(message);
    });
    return this._stroke;
  }

  /** Sends an edit, undo or redo. Returns its id, or null while edits are not possible. */
  sendChange(message: SingleChange): string | null {
    if (this._state !== "open") return null;
    this.change(message);
    return message.id;
  }

  private change(message: ChangeMessage): void {
    this._queue?.put(message);
    this._outbox.add(message);
    // A node without its database refuses changes. They are sent when the node has its database
    // again.
    if (!this._databaseLost && !this._resender.queue(message) && this._state === "open")
      this.send(message);
    this.expectAnswer();
    this.reportSaving();
  }

  private send(message: ClientMessage): void {
    // The server may have begun to close the connection. Changes are sent again over the next
    // connection.
    if ((this._socket?.readyState ?? kOpenSocket) > kOpenSocket) return;
    this._socket?.send(JSON.stringify(message));
  }

  private onMessage(data: unknown): void {
    if (this._state === "open") this.heard();
    if (typeof data !== "string") {
      this.onFrame(data as ArrayBuffer);
      return;
    }
    let message: ServerMessage;
    try {
      message = parse_server_message(data);
    } catch (error) {
      this._callbacks.problem(unreadable(String(error)));
      return;
    }
    this.dispatch(message);
  }

  private onFrame(data: ArrayBuffer): void {
    try {
      this._callbacks.frame(decodeFrame(data));
    } catch (error) {
      if (!(error instanceof FrameError)) throw error;
      this._callbacks.problem(unreadable(error.message));
    }
  }

  private dispatch(message: ServerMessage): void {
    switch (message.op) {
      case "welcome":
        return this.onWelcome(message);
      case "applied":
        this.onPainted(message);
        return this._callbacks.applied(message);
      case "saved":
        this.onPainted(message);
        this._outbox.saved(message);
        this._failing = false;
        this._resender.succeeded();
        this.reportSaving();
        return this._callbacks.saved(message);
      case "unsaved":
        this.resendLater();
        return this.reportSaving();
      case "moved":
        return this.onMoved(message);
      case "database":
        return this.onDatabase(message);
      case "problem":
        return this.onProblem(message);
      case "layer":
        return this._callbacks.layer(message);
      case "look":
        return this._callbacks.look(message);
      case "tool":
        return this._callbacks.tool(message);
      case "model":
        return this._callbacks.model(message);
      case "record":
        return this._callbacks.record(message);
      case "table":
        return this._callbacks.table(message);
      case "record.editors":
        return this._callbacks.editors(message);
      case "comment":
        return this._callbacks.comment(message);
      case "view":
        return this._callbacks.view(message);
      case "snapshot":
        return this._callbacks.snapshot(message);
      case "selection":
        return this._callbacks.selection(message);
      case "presence":
        return this._callbacks.presence(message);
      case "picked":
        if (message.id !== undefined && this._silenced.delete(message.id)) return;
        return this._callbacks.picked(message);
      default:
        message satisfies never; // parse_server_message throws an error if op is unknown
    }
  }

  private onWelcome(message: Welcome): void {
    this._attempts = 0;
    this._moved = false;
    this._flow.restart();
    this._pathPoints = message.limits.path_points;
    this._resender.messagesPerSecond = Math.max(
      1,
      Math.floor(message.limits.messages_per_second / 2),
    );
    this.setState("open");
    this.heard();
    this._settings.keepOnly(message);
    for (const { stroke, n } of message.strokes) this._outbox.savedThrough(stroke, n);
    this._callbacks.welcome(message);
    if (this._settings.differ) this.sendSettings();
    this._camera.sendNow();
    this.resend();
    this.reportSaving();
    if (!this._queue && this._options.makeQueue) {
      this._queue = this._options.makeQueue(message.user, message.model.id);
      void this.takeUp(this._queue, message.strokes);
    }
  }

  /** Sends changes that this user's earlier pages could not save. */
  private async takeUp(queue: ChangeQueue, known: Welcome["strokes"]): Promise<void> {
    const messages = await queue.read();
    if (this._state === "closed") return;
    const changes = this._outbox.adopt(messages);
    for (const { stroke, n } of known) this._outbox.savedThrough(stroke, n);
    if (changes === 0) return;
    this._callbacks.takenUp(changes);
    if (this._state === "open") this.resend();
    this.reportSaving();
  }

  private onPainted({ stroke, n }: Applied | Saved): void {
    if (stroke === undefined || n === undefined) return;
    this._flow.painted(stroke, n);
    this._stroke?.proceed();
  }

  private onProblem(message: ProblemMessage): void {
    const { op: _, ...problem } = message;
    if (message.ref !== undefined) this._flow.refused(message.ref);
    if (
      message.ref !== undefined &&
      (message.ref === kAdvice || this._silenced.delete(message.ref))
    )
      return;
    if (message.ref === undefined || !this._outbox.has(message.ref)) {
      this._callbacks.problem(problem);
      return;
    }
    // A batch is out of order if the previous batch was refused temporarily. Both are sent again.
    const outOfOrder = message.status === 409 && this._outbox.followsWaitingBatch(message.ref);
    // 307: another node has the model. The message `moved` follows.
    const { status } = message;
    const passing = status === 307 || status === 429 || status >= 500 || outOfOrder;
    if (passing) {
      const first = !this._failing;
      this.resendLater();
      this.reportSaving();
      if (first && !this._databaseLost) this._callbacks.problem(problem);
      return;
    }
    for (const id of this._outbox.giveUp(message.ref))
      if (id !== message.ref) this._silenced.add(id);
    this.reportSaving();
    this._callbacks.problem(problem);
  }

  /** Discards the waiting changes, because the model was deleted. */
  forget(): void {
    this._outbox.clear();
  }

  private resend(): void {
    if (this._databaseLost) return;
    const messages = this._outbox.messages();
    if (messages.length > 0) this.expectAnswer();
    this._resender.start(messages);
  }

  private resendLater(): void {
    this._failing = true;
    this._resender.later(() => {
      if (this._state === "open") this.resend();
    });
  }

  private onLost(): void {
    // The node may have ended. The address of the site leads to the node that has the model now.
    this._address = this._options.url;
    if (this.dropSocket()) this.retryLater();
  }

  /**
   * Connects to the node that has the model now. After the welcome, unsaved changes are sent again.
   * If that node also refers to another node, the next attempt is delayed, because two nodes may
   * refer to each other.
   */
  private onMoved({ url }: Moved): void {
    const again = this._moved;
    const socket = this._socket;
    this._moved = true;
    this._address = addressAtNode(this._options.url, url);
    const reconnects = this.dropSocket();
    socket?.close(1000, "moved");
    if (!reconnects) return;
    if (again) this.retryLater();
    else this.open();
  }

  private onDatabase({ reachable }: DatabaseState): void {
    if (this._databaseLost !== reachable) return;
    this._databaseLost = !reachable;
    this._resender.stop();
    if (reachable) {
      this._search.stop();
      this._resender.succeeded();
      this.resend();
    } else {
      this._search.start();
    }
    this.reportSaving();
  }

  /** Continues at another node, which has taken over the model and has sent this welcome. */
  private onNodeFound(socket: SocketLike, welcome: string): void {
    const before = this._socket;
    this._moved = true;
    this._address = this._options.url;
    const continues = this.dropSocket();
    before?.close(1000, "moved");
    if (!continues) return socket.close(1000, "left");
    this.setState("connecting");
    this.use(socket);
    this.onMessage(welcome);
  }

  /** Returns whether this object should connect again. */
  private dropSocket(): boolean {
    this.forgetTimers();
    this._silenced.clear();
    this._socket = null;
    this._search.stop();
    this._databaseLost = false; // unknown from now on: the next connection may be to another node
    this.setState("lost");
    this.reportSaving();
    // A listener may have closed the connection or requested another attempt.
    return !this._retryTimer && this._state === "lost";
  }

  private retryLater(): void {
    const random = (this._options.random ?? Math.random)();
    const lastMs = this._moved ? kLastMovedRetryMs : kLastRetryMs;
    const delayMs = retryDelayMs(this._attempts, random, lastMs);
    this._attempts += 1;
    this._retryTimer = setTimeout(() => {
      this._retryTimer = null;
      this.open();
    }, delayMs);
  }

  private expectAnswer(): void {
    if (this._state === "open") this._silence.expectAnswer();
  }

  /** Sends a request to which the server always responds. */
  private askForLife(): void {
    const id = newId();
    this._silenced.add(id);
    this.pick(id, 0, 0);
  }

  private heard(): void {
    this._silence.heard();
    if (this._outbox.waiting > 0) this._silence.expectAnswer();
  }

  private giveUpSocket(): void {
    const socket = this._socket;
    this.onLost();
    socket?.close(4000, "no answer");
  }

  private forgetTimers(): void {
    if (this._retryTimer) clearTimeout(this._retryTimer);
    this._retryTimer = null;
    this._resender.stop();
    this._silence.heard();
  }

  private setState(state: ConnectionState): void {
    if (state === this._state && state !== "connecting") return;
    this._state = state;
    this._callbacks.state(state);
  }

  private reportSaving(): void {
    if (this._outbox.waiting === 0) this._failing = false;
    const { waiting } = this._outbox;
    const failing = this._failing || (this._databaseLost && waiting > 0);
    this._callbacks.saving({ waiting, failing });
  }
}

const unreadable = (what: string): Omit<ProblemMessage, "op"> => ({
  title: ownProblems().unreadable,
  status: 502,
  detail: ownProblems().unreadable_detail(what),
});
