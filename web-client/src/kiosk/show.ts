// The model on the kiosk's stage: the live connection, the camera, and what the stop that is seen
// shows of layers, looks and light.

import { ViewControl } from "../session/view-control";
import { new_id } from "../net/api";
import { Connection, type SocketLike } from "../net/connection";
import type { FrameMessage } from "../net/frame-header";
import type { GestureHandler, PointerSample } from "../ui/input";
import { place_like } from "../math/fit-to-window";
import type { LayerOverride, Look, Model, Picked, View, Welcome } from "../core/protocol.gen";
import { complete_layer, type Layer } from "../core/types";
import { looks_of_view } from "../domain/views";
import { OrbitTool } from "../tools/navigate";
import { as_kiosk } from "./as-kiosk";

const kAway_ms = 3000; // so long a lost connection is no news
const kTapReach_css = 14; // a finger on glass

export interface ShowHost {
  /**
   * The model, its layers, or a named view are known, or others; `views`: those of the tour are to
   * be read again.
   */
  learned(what: "model" | "views"): void;
  /** A tap, and what is there; where on the stage, in CSS pixels. */
  tapped(picked: Picked, at: { x: number; y: number }): void;
  /** The picture moves away from under what was told of a place. */
  moved(): void;
  /** There are live pictures, or no longer. */
  changed(): void;
  /** The connection is gone, for a moment or for long. */
  lost(): void;
}

export class KioskShow {
  model: Model | null = null;
  layers: Layer[] = [];
  looks: Look[] = [];
  /** A live picture is on the canvas. */
  drawn = false;
  /** There have been no live pictures for some seconds. */
  away = false;
  /** Set by the stage. */
  on_frame: (part: FrameMessage) => void = () => {};
  on_reset_frames: () => void = () => {};

  readonly view: ViewControl;
  private readonly connection_: Connection;
  private readonly orbit_tool_: OrbitTool;
  private view_shown_: View | null = null;
  private stands_at_view_ = false; // nobody has moved the camera since
  private placed_ = false; // the camera has been where the view has it
  private away_timer_: ReturnType<typeof setTimeout> | null = null;
  private pick_ = ""; // the newest tap that is not answered
  private picked_at_ = { x: 0, y: 0 }; // on the stage, CSS pixels
  private flight_ends_ms_ = 0;

  constructor(
    readonly model_ref: string,
    private readonly host_: ShowHost,
    make_socket?: (url: string, protocol: string) => SocketLike,
  ) {
    this.view = new ViewControl({
      send: (moving) => this.connection_.set_camera(this.view.camera.message(), moving),
      when_free: (action) => action(),
      is_painting: () => false,
      came_to_rest: () => {},
      went_own_way: () => {},
      changed: () => {},
    });
    this.orbit_tool_ = new OrbitTool(
      {
        orbit: (dx, dy) => this.move(() => this.view.orbit_pixels(dx, dy)),
        pan: () => {},
        tap: (sample) => this.tap(sample),
      },
      () => kTapReach_css * this.view.scale,
    );
    this.connection_ = this.make_connection(make_socket);
  }

  readonly gestures: GestureHandler = {
    tool_down: (sample) => this.orbit_tool_.down(sample),
    tool_move: (samples) => this.orbit_tool_.move(samples),
    tool_up: () => this.orbit_tool_.up(),
    tool_cancel: () => this.orbit_tool_.cancel(),
    orbit: (dx, dy) => this.move(() => this.view.orbit_pixels(dx, dy)),
    pan: (dx, dy) => this.move(() => this.view.pan_pixels(dx, dy)),
    zoom: (factor, x, y) => this.move(() => this.view.zoom_at(factor, x, y)),
    twist: (angle) => this.move(() => this.view.twist(angle)),
    hover: () => {},
    free_mouse: () => {},
    tool_is_for_pen: () => false,
  };

  open(): void {
    this.expect_pictures();
    this.connection_.open();
  }
  close(): void {
    this.view.stop();
    this.stop_expecting();
    this.connection_.close();
  }
  /** The server has just answered something else: no need to wait for the next attempt. */
  check_connection(): void {
    this.connection_.check();
  }

  /** As the view has it, but with these layers; `flight_s`: how long the way there takes. */
  go_to(view: View, layers: LayerOverride[], flight_s: number): void {
    this.view_shown_ = view;
    this.stands_at_view_ = true;
    this.show_settings(view, layers);
    this.placed_ = this.model !== null;
    if (!this.model) return;
    this.view.set_section(view.camera.section ?? [], flight_s > 0);
    const flight_ms = this.drawn ? flight_s * 1000 : 0;
    this.flight_ends_ms_ = performance.now() + flight_ms;
    this.view.fly(place_like(view.camera, this.view.camera), flight_ms);
  }

  /**
   * What is known of the model, or of the view, may be something else than before. Where visitors
   * have turned to stays, unless the view itself was changed.
   */
  go_on(view: View, layers: LayerOverride[]): void {
    const same =
      this.placed_ && JSON.stringify(this.view_shown_?.camera) === JSON.stringify(view.camera);
    if (same) this.show_settings(view, layers);
    else this.go_to(view, layers, 0);
  }

  /** Nobody has turned it since it came to the view. */
  get untouched(): boolean {
    return this.stands_at_view_;
  }

  private show_settings(view: View, layers: LayerOverride[]): void {
    this.show_layers(layers);
    const { settings, stack } = looks_of_view(view, this.looks);
    const shown = view.looks
      ? stack.map((look) => ({ look, opacity: settings.get(look)?.opacity ?? 1 }))
      : null;
    this.connection_.set_appearance(shown, view.light);
  }
  show_layers(layers: LayerOverride[]): void {
    this.connection_.set_layer_overrides(layers);
  }

  /**
   * CSS pixels, and window pixels for each. The words of a stop may need more room than those
   * before: what is on its way there goes on.
   */
  set_viewport(width: number, height: number, scale: number): void {
    this.view.set_viewport(width, height, scale);
    if (!this.view_shown_ || !this.stands_at_view_ || !this.model) return;
    const left_ms = Math.max(0, this.flight_ends_ms_ - performance.now());
    this.view.fly(place_like(this.view_shown_.camera, this.view.camera), left_ms);
  }

  frame_drawn(part: FrameMessage): void {
    this.connection_.ack(part.header.view_id, part.header.frame);
    this.view.count_frame();
    if (this.drawn && !this.away) return;
    this.stop_expecting();
    this.drawn = true;
    this.away = false;
    this.host_.changed();
  }

  private move(change: () => void): void {
    const first = this.stands_at_view_;
    this.stands_at_view_ = false;
    this.pick_ = ""; // what was tapped is elsewhere by now
    change();
    this.host_.moved();
    if (first) this.host_.changed();
  }

  private tap({ x, y }: PointerSample): void {
    this.pick_ = new_id();
    this.picked_at_ = { x: x / this.view.scale, y: y / this.view.scale };
    this.connection_.pick(this.pick_, x, y);
  }

  private make_connection(make_socket?: (url: string, protocol: string) => SocketLike): Connection {
    const { protocol, host } = window.location;
    const address = `${protocol === "https:" ? "wss" : "ws"}://${host}/api/v1/models/${encodeURIComponent(this.model_ref)}/live`;
    const nothing = (): void => {};
    return new Connection(
      {
        url: as_kiosk(address),
        client: "strata-kiosk/0.1",
        device_pixel_ratio: window.devicePixelRatio,
        ...(make_socket ? { make_socket } : {}),
      },
      {
        state: (state) => {
          if (state === "lost") this.on_lost();
        },
        welcome: (message) => this.on_welcome(message),
        frame: (part) => this.on_frame(part),
        layer: (event) => {
          if (event.event === "edited") return;
          this.layers = this.layers.filter(({ id }) => id !== event.layer_id);
          if (event.layer && event.event !== "deleted")
            this.layers = by_order([...this.layers, complete_layer(event.layer)]);
          this.host_.learned("model");
        },
        look: (event) => {
          this.looks = this.looks.filter(({ id }) => id !== event.look_id);
          if (event.look && event.event !== "deleted")
            this.looks = by_order([...this.looks, event.look]);
          this.host_.learned("model");
        },
        model: ({ model }) => {
          if (model) this.take_model(model);
        },
        view: () => this.host_.learned("views"),
        picked: (message) => {
          if (message.id !== this.pick_) return;
          this.pick_ = "";
          this.host_.tapped(message, this.picked_at_);
        },
        // What visitors could do nothing about is not told to them; who looks after the screen
        // finds it in the browser's console.
        problem: (problem) =>
          console.info(
            "the server refused something:",
            problem.status,
            problem.title,
            problem.detail,
          ),
        saving: nothing,
        applied: nothing,
        saved: nothing,
        taken_up: nothing,
        tool: nothing,
        record: nothing,
        table: nothing,
        editors: nothing,
        comment: nothing,
        presence: nothing,
      },
    );
  }

  private on_welcome({ model, layers, looks }: Welcome): void {
    this.layers = by_order(layers.map(complete_layer));
    this.looks = by_order(looks);
    this.take_model(model);
  }

  private take_model(model: Model): void {
    const turned = this.model !== null && this.model.up !== model.up;
    this.model = model;
    this.view.set_model(model, turned);
    this.host_.learned("model");
  }

  private on_lost(): void {
    this.on_reset_frames();
    this.expect_pictures();
    this.host_.lost();
  }

  private expect_pictures(): void {
    this.away_timer_ ??= setTimeout(() => {
      this.drawn = false;
      this.away = true;
      this.host_.changed();
    }, kAway_ms);
  }
  private stop_expecting(): void {
    if (this.away_timer_) clearTimeout(this.away_timer_);
    this.away_timer_ = null;
  }
}

const by_order = <T extends { id: number; order: number }>(things: readonly T[]): T[] =>
  [...things].sort((a, b) => a.order - b.order || a.id - b.id);
