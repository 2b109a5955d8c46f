// The WebSocket of one open model: says hello, keeps the newest camera, resends what is not saved,
// and comes back by itself after a lost connection. The socket can be replaced by a fake; nothing
// here touches the page.

import { new_id } from "./api";
import type { CameraMessage } from "../math/camera";
import { decode_frame, FrameError, type FrameMessage } from "./frame-header";
import { Outbox, type ChangeMessage, type SingleChange } from "./outbox";
import { own_problems } from "../core/problems";
import {
  parse_server_message,
  SUBPROTOCOL,
  type Applied,
  type Background,
  type ClientMessage,
  type CommentEvent,
  type LayerEvent,
  type LayerOverride,
  type Light,
  type LookEvent,
  type LookShown,
  type ModelEvent,
  type Picked,
  type Presence,
  type PresenceUpdate,
  type ProblemMessage,
  type RecordEditors,
  type RecordEvent,
  type Saved,
  type ServerMessage,
  type StrokeBegin,
  type TableEvent,
  type ToolEvent,
  type ToolShape,
  type ViewEvent,
  type Welcome,
} from "../core/protocol.gen";

const kOpenSocket = 1; // WebSocket.OPEN

export interface SocketLike {
  binaryType: BinaryType;
  readonly bufferedAmount: number;
  readonly readyState?: number; // as a WebSocket has it; absent: open
  onopen: ((event: never) => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: ((event: { code: number; reason: string }) => void) | null;
  onerror: ((event: never) => void) | null;
  send(data: string): void;
  close(code?: number, reason?: string): void;
}

/** lost: waits for the next attempt. open: the server said welcome. */
export type ConnectionState = "connecting" | "open" | "lost" | "closed";

export interface SavingState {
  waiting: number; // changes that are not durable
  failing: boolean; // the server could not keep some of them; they are sent again
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
  presence(message: Presence): void;
  picked(message: Picked): void;
  /** A refusal. What was refused for good is no longer waiting. */
  problem(problem: Omit<ProblemMessage, "op">): void;
  /** So many changes that an earlier page could not have saved are sent again. */
  taken_up(changes: number): void;
}

/** Where changes wait that are to outlive the page (unsaved-shelf.ts). */
export interface Shelf {
  read(): Promise<ChangeMessage[]>;
  put(message: ChangeMessage): void;
  remove(ids: readonly string[]): void;
}

export interface ConnectionOptions {
  url: string;
  client: string;
  device_pixel_ratio: number;
  make_socket?: (url: string, protocol: string) => SocketLike;
  /**
   * Of the person who paints here; without it what is not saved lives as long as the connection.
   */
  make_shelf?: (user: string, model: number) => Shelf;
  /** Calls back before the next picture is drawn. */
  next_frame?: (callback: () => void) => void;
  random?: () => number;
}

export interface StrokeOptions {
  layer: number | string;
  value: number;
  erase: boolean;
  camera: CameraMessage;
  radius: { px: number } | { mm: number };
  shape: ToolShape;
  through: boolean;
  max_angle_deg?: number;
}

export type Point = [number, number];

const kFirstRetry_ms = 250;
const kLastRetry_ms = 8000;
const kQuiet_ms = 10_000; // an answer is due but nothing came: ask for a sign of life
const kSilence_ms = 10_000; // nor came one: the connection is dead
// for the handshake and the welcome; the server may be reading the model
const kOpening_ms = 30_000;
const kBusySocket_bytes = 256 * 1024; // cameras wait while so much is unsent
const kAdvice = "advice"; // of messages that may fail: what is wrong is told by what they are about
const kMostWaiting = 5000; // changes; new strokes are refused above

export class Connection {
  private socket_: SocketLike | null = null;
  private state_: ConnectionState = "connecting";
  private attempts_ = 0;
  private retry_timer_: ReturnType<typeof setTimeout> | null = null;
  private resend_timer_: ReturnType<typeof setTimeout> | null = null;
  private slice_timer_: ReturnType<typeof setTimeout> | null = null;
  private silence_timer_: ReturnType<typeof setTimeout> | null = null;
  private answer_due_ = false; // something was sent that the server answers
  private resend_delay_ms_ = kFirstRetry_ms;
  private failing_ = false;
  private path_points_ = 4096;
  private resend_slice_ = 100; // messages a second, so that the server's limit is kept
  private resending_: ChangeMessage[] = []; // still to go out again; new changes queue behind them

  private shelf_: Shelf | null = null;
  private readonly outbox_ = new Outbox((ids) => this.shelf_?.remove(ids));
  // ids whose answers say nothing new: given up, or signs of life
  private readonly silenced_ = new Set<string>();

  private camera_: { camera: CameraMessage; moving: boolean } | null = null;
  private camera_seq_ = 0;
  private camera_scheduled_ = false;
  private overrides_: LayerOverride[] = [];
  private looks_: LookShown[] | null = null; // null: those that everyone sees at first
  private light_: Light | null = null; // null: the server's own
  private background_: Background | null = null;

  constructor(
    private readonly options_: ConnectionOptions,
    private readonly callbacks_: ConnectionCallbacks,
  ) {}

  get state(): ConnectionState {
    return this.state_;
  }
  get waiting(): number {
    return this.outbox_.waiting;
  }
  /** So much waits to be saved that new strokes are refused. */
  get full(): boolean {
    return this.outbox_.waiting > kMostWaiting;
  }
  /** Number of the newest camera sent; frames echo it. */
  get camera_seq(): number {
    return this.camera_seq_;
  }

  open(): void {
    this.set_state("connecting");
    const make =
      this.options_.make_socket ??
      ((url, protocol) => new WebSocket(url, protocol) as unknown as SocketLike);
    const socket = make(this.options_.url, SUBPROTOCOL);
    socket.binaryType = "arraybuffer";
    this.socket_ = socket;
    socket.onopen = () => {
      if (socket !== this.socket_) return;
      this.send({
        op: "hello",
        client: this.options_.client,
        dpr: this.options_.device_pixel_ratio,
        accept: ["jpeg", "png"],
      });
    };
    socket.onmessage = (event) => {
      if (socket === this.socket_) this.on_message(event.data);
    };
    socket.onclose = () => {
      if (socket === this.socket_) this.on_lost();
    };
    socket.onerror = () => {}; // a close follows
    this.set_silence_timer(kOpening_ms, () => this.give_up_socket());
  }

  /** For good; what is not saved stays on the shelf. */
  close(): void {
    this.forget_timers();
    const socket = this.socket_;
    this.socket_ = null;
    this.set_state("closed");
    socket?.close(1000, "left");
  }

  /**
   * The network changed, the page came back, or a person asked: reconnects without waiting, and
   * finds out whether a connection that looks open still is.
   */
  check(): void {
    if (this.state_ === "open") this.ask_for_life();
    if (this.state_ !== "lost") return;
    if (this.retry_timer_) clearTimeout(this.retry_timer_);
    this.retry_timer_ = null;
    this.open();
  }

  /**
   * Nobody looks any more: no camera goes out again after a reconnect. What is not saved still
   * does.
   */
  stop_viewing(): void {
    this.camera_ = null;
    this.overrides_ = [];
    this.looks_ = this.light_ = null;
  }

  /** Latest wins: at most one camera per drawn picture leaves, always the newest. */
  set_camera(camera: CameraMessage, moving: boolean): void {
    this.camera_ = { camera, moving };
    this.schedule_camera();
  }

  set_layer_overrides(overrides: LayerOverride[]): void {
    this.overrides_ = overrides;
    this.send_settings();
  }

  set_appearance(looks: LookShown[] | null, light: Light): void {
    if (
      !looks &&
      !this.looks_ &&
      light.mode === "museum" &&
      (this.light_?.mode ?? "museum") === "museum"
    )
      return;
    this.looks_ = looks;
    this.light_ = light;
    this.send_settings();
  }

  /** Null: the server's own. */
  set_background(background: Background | null): void {
    if (JSON.stringify(background) === JSON.stringify(this.background_)) return;
    this.background_ = background;
    this.send_settings();
  }

  private send_settings(): void {
    if (this.state_ !== "open") return;
    this.send({
      op: "layers",
      layers: this.overrides_,
      ...(this.looks_ ? { looks: this.looks_ } : {}),
      ...(this.light_ && this.light_.mode !== "museum" ? { light: this.light_ } : {}),
      ...(this.background_ ? { background: this.background_ } : {}),
    });
  }

  ack(view_id: number, frame: number): void {
    if (this.state_ === "open") this.send({ op: "ack", view_id, frame });
  }

  pick(id: string, x: number, y: number, camera?: CameraMessage): void {
    if (this.state_ === "open") this.send({ op: "pick", id, x, y, ...(camera ? { camera } : {}) });
  }

  /** What this person shows of themselves; replaces what was shown before. */
  presence(shown: Omit<PresenceUpdate, "op">): void {
    if (this.state_ === "open") this.send({ op: "presence", ...shown });
  }

  /** That this person writes into a record, or no longer. */
  edit_record(what: { table: number; key: number; editing: boolean; take_over?: boolean }): void {
    if (this.state_ === "open") this.send({ op: "record.edit", id: kAdvice, ...what });
  }

  /** Null while edits cannot be taken: not connected, or too much waits to be saved. */
  begin_stroke(options: StrokeOptions): StrokeHandle | null {
    if (this.state_ !== "open" || this.full) return null;
    const begin: StrokeBegin = {
      op: "stroke.begin",
      id: new_id(),
      stroke: new_id(),
      layer: options.layer,
      ...(options.erase ? { erase: true } : { value: options.value }),
      camera: options.camera,
      ...("px" in options.radius
        ? { radius_px: options.radius.px }
        : { radius_mm: options.radius.mm }),
      shape: options.shape,
      ...(options.through ? { through: true } : {}),
      ...(options.max_angle_deg === undefined ? {} : { max_angle_deg: options.max_angle_deg }),
    };
    this.change(begin);
    return new StrokeHandle(begin.stroke, this.path_points_, (message) => {
      if (this.outbox_.has_stroke(begin.stroke)) this.change(message);
    });
  }

  /** An edit, undo or redo. Returns its id, or null while edits cannot be taken. */
  send_change(message: SingleChange): string | null {
    if (this.state_ !== "open") return null;
    this.change(message);
    return message.id;
  }

  private change(message: ChangeMessage): void {
    this.shelf_?.put(message);
    this.outbox_.add(message);
    if (this.resending_.length > 0) this.resending_.push(message);
    else if (this.state_ === "open") this.send(message);
    this.expect_answer();
    this.report_saving();
  }

  private send(message: ClientMessage): void {
    // The other side may have begun to close it. What must not be lost is sent again over the next
    // one.
    if ((this.socket_?.readyState ?? kOpenSocket) > kOpenSocket) return;
    this.socket_?.send(JSON.stringify(message));
  }

  private schedule_camera(): void {
    if (this.camera_scheduled_ || !this.camera_) return;
    this.camera_scheduled_ = true;
    const next_frame =
      this.options_.next_frame ?? ((callback) => void requestAnimationFrame(callback));
    next_frame(() => {
      this.camera_scheduled_ = false;
      if (this.state_ !== "open" || !this.camera_) return;
      if ((this.socket_?.bufferedAmount ?? 0) > kBusySocket_bytes) this.schedule_camera();
      else this.send_camera();
    });
  }

  private send_camera(): void {
    if (!this.camera_) return;
    const { camera, moving } = this.camera_;
    this.camera_ = { camera, moving: false }; // after a reconnect the picture is a still one
    this.camera_seq_ += 1;
    this.send({ op: "camera", seq: this.camera_seq_, ...camera, moving });
    this.expect_answer(); // a frame
  }

  private on_message(data: unknown): void {
    if (this.state_ === "open") this.heard();
    if (typeof data !== "string") {
      this.on_frame(data as ArrayBuffer);
      return;
    }
    let message: ServerMessage;
    try {
      message = parse_server_message(data);
    } catch (error) {
      this.callbacks_.problem(unreadable(String(error)));
      return;
    }
    this.dispatch(message);
  }

  private on_frame(data: ArrayBuffer): void {
    try {
      this.callbacks_.frame(decode_frame(data));
    } catch (error) {
      if (!(error instanceof FrameError)) throw error;
      this.callbacks_.problem(unreadable(error.message));
    }
  }

  private dispatch(message: ServerMessage): void {
    switch (message.op) {
      case "welcome":
        return this.on_welcome(message);
      case "applied":
        return this.callbacks_.applied(message);
      case "saved":
        this.outbox_.saved(message);
        this.failing_ = false;
        this.resend_delay_ms_ = kFirstRetry_ms;
        this.report_saving();
        return this.callbacks_.saved(message);
      case "unsaved":
        this.resend_later();
        return this.report_saving();
      case "problem":
        return this.on_problem(message);
      case "layer":
        return this.callbacks_.layer(message);
      case "look":
        return this.callbacks_.look(message);
      case "tool":
        return this.callbacks_.tool(message);
      case "model":
        return this.callbacks_.model(message);
      case "record":
        return this.callbacks_.record(message);
      case "table":
        return this.callbacks_.table(message);
      case "record.editors":
        return this.callbacks_.editors(message);
      case "comment":
        return this.callbacks_.comment(message);
      case "view":
        return this.callbacks_.view(message);
      case "presence":
        return this.callbacks_.presence(message);
      case "picked":
        if (message.id !== undefined && this.silenced_.delete(message.id)) return;
        return this.callbacks_.picked(message);
      default:
        message satisfies never; // parse_server_message throws on an op it does not know
    }
  }

  private on_welcome(message: Welcome): void {
    this.attempts_ = 0;
    this.path_points_ = message.limits.path_points;
    this.resend_slice_ = Math.max(1, Math.floor(message.limits.messages_per_second / 2));
    this.set_state("open");
    this.heard();
    const layers = new Set<number | string>(message.layers.map((layer) => layer.id));
    // one unknown layer refuses them all
    this.overrides_ = this.overrides_.filter(({ layer }) => layers.has(layer));
    const looks = new Set<number | string>(message.looks.map((look) => look.id));
    this.looks_ = this.looks_?.filter(({ look }) => looks.has(look)) ?? null;
    for (const { stroke, n } of message.strokes) this.outbox_.saved_through(stroke, n);
    this.callbacks_.welcome(message);
    const has_settings =
      this.overrides_.length > 0 ||
      this.looks_ ||
      (this.light_ && this.light_.mode !== "museum") ||
      this.background_;
    if (has_settings) this.send_settings();
    if (this.camera_) this.send_camera();
    this.resend();
    this.report_saving();
    if (!this.shelf_ && this.options_.make_shelf) {
      this.shelf_ = this.options_.make_shelf(message.user, message.model.id);
      void this.take_up(this.shelf_, message.strokes);
    }
  }

  /** What this person's earlier pages could not have saved. */
  private async take_up(shelf: Shelf, known: Welcome["strokes"]): Promise<void> {
    const messages = await shelf.read();
    if (this.state_ === "closed") return;
    const changes = this.outbox_.adopt(messages);
    for (const { stroke, n } of known) this.outbox_.saved_through(stroke, n);
    if (changes === 0) return;
    this.callbacks_.taken_up(changes);
    if (this.state_ === "open") this.resend();
    this.report_saving();
  }

  private on_problem(message: ProblemMessage): void {
    const { op: _, ...problem } = message;
    if (
      message.ref !== undefined &&
      (message.ref === kAdvice || this.silenced_.delete(message.ref))
    )
      return;
    if (message.ref === undefined || !this.outbox_.has(message.ref)) {
      this.callbacks_.problem(problem);
      return;
    }
    // A batch is out of order when the one before it was refused for the moment: both go again.
    const out_of_order = message.status === 409 && this.outbox_.follows_waiting_batch(message.ref);
    const passing = message.status === 429 || message.status >= 500 || out_of_order;
    if (passing) {
      const first = !this.failing_;
      this.resend_later();
      this.report_saving();
      if (first) this.callbacks_.problem(problem);
      return;
    }
    for (const id of this.outbox_.give_up(message.ref))
      if (id !== message.ref) this.silenced_.add(id);
    this.report_saving();
    this.callbacks_.problem(problem);
  }

  /** The model is gone, and with it what waits. */
  forget(): void {
    this.shelf_?.remove(this.outbox_.messages().map((message) => message.id));
  }

  private resend(): void {
    this.resending_ = this.outbox_.messages();
    if (this.resending_.length > 0) this.expect_answer();
    this.resend_slice();
  }

  private resend_slice(): void {
    for (const message of this.resending_.splice(0, this.resend_slice_)) this.send(message);
    if (this.slice_timer_) clearTimeout(this.slice_timer_);
    this.slice_timer_ = null;
    if (this.resending_.length === 0) return;
    this.slice_timer_ = setTimeout(() => this.resend_slice(), 1000);
  }

  private resend_later(): void {
    this.failing_ = true;
    if (this.resend_timer_) return;
    this.resend_timer_ = setTimeout(() => {
      this.resend_timer_ = null;
      if (this.state_ === "open") this.resend();
    }, this.resend_delay_ms_);
    this.resend_delay_ms_ = Math.min(kLastRetry_ms, this.resend_delay_ms_ * 2);
  }

  private on_lost(): void {
    this.forget_timers();
    this.silenced_.clear();
    this.socket_ = null;
    this.set_state("lost");
    this.report_saving();
    // a listener closed it or asked for another attempt
    if (this.retry_timer_ || this.state_ !== "lost") return;
    const random = (this.options_.random ?? Math.random)();
    const delay_ms =
      Math.min(kLastRetry_ms, kFirstRetry_ms * 2 ** this.attempts_) * (0.75 + random / 2);
    this.attempts_ += 1;
    this.retry_timer_ = setTimeout(() => {
      this.retry_timer_ = null;
      this.open();
    }, delay_ms);
  }

  /**
   * A dead network does not say so: the server's silence must. Before the socket is given up, the
   * server is asked something that it always answers, because not everything that is sent brings an
   * answer of its own.
   */
  private expect_answer(): void {
    if (this.state_ !== "open" || this.answer_due_) return;
    this.answer_due_ = true;
    this.set_silence_timer(kQuiet_ms, () => this.ask_for_life());
  }

  private ask_for_life(): void {
    const id = new_id();
    this.silenced_.add(id);
    this.pick(id, 0, 0);
    this.answer_due_ = true;
    this.set_silence_timer(kSilence_ms, () => this.give_up_socket());
  }

  private heard(): void {
    this.answer_due_ = false;
    this.set_silence_timer(0, null);
    if (this.outbox_.waiting > 0) this.expect_answer();
  }

  private give_up_socket(): void {
    const socket = this.socket_;
    this.on_lost();
    socket?.close(4000, "no answer");
  }

  private set_silence_timer(after_ms: number, action: (() => void) | null): void {
    if (this.silence_timer_) clearTimeout(this.silence_timer_);
    this.silence_timer_ = action ? setTimeout(action, after_ms) : null;
  }

  private forget_timers(): void {
    const timers = [this.retry_timer_, this.resend_timer_, this.slice_timer_, this.silence_timer_];
    for (const timer of timers) if (timer) clearTimeout(timer);
    this.retry_timer_ = this.resend_timer_ = this.slice_timer_ = this.silence_timer_ = null;
    this.answer_due_ = false;
    this.resending_ = [];
  }

  private set_state(state: ConnectionState): void {
    if (state === this.state_ && state !== "connecting") return;
    this.state_ = state;
    this.callbacks_.state(state);
  }

  private report_saving(): void {
    if (this.outbox_.waiting === 0) this.failing_ = false;
    this.callbacks_.saving({ waiting: this.outbox_.waiting, failing: this.failing_ });
  }
}

/** One stroke being drawn. The server sweeps the brush from the last point of the batch before. */
export class StrokeHandle {
  private n_ = 0;
  private ended_ = false;

  constructor(
    readonly stroke: string,
    private readonly path_points_: number,
    private readonly change_: (message: ChangeMessage) => void,
  ) {}

  /** `widths`: what share of the radius the brush has at each of them; absent: the whole. */
  extend(points: readonly Point[], widths?: readonly number[]): void {
    if (this.ended_ || points.length === 0) return;
    for (let start = 0; start < points.length; start += this.path_points_) {
      const path = points.slice(start, start + this.path_points_);
      this.change_({
        op: "stroke.extend",
        id: new_id(),
        stroke: this.stroke,
        n: this.n_++,
        path,
        ...(widths ? { widths: widths.slice(start, start + this.path_points_) } : {}),
      });
    }
  }

  end(): void {
    if (this.ended_) return;
    this.ended_ = true;
    this.change_({ op: "stroke.end", id: new_id(), stroke: this.stroke });
  }
}

const unreadable = (what: string): Omit<ProblemMessage, "op"> => ({
  title: own_problems().unreadable,
  status: 502,
  detail: own_problems().unreadable_detail(what),
});
