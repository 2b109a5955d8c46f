// The model on the kiosk's stage: the live connection, the camera, and the layers, surface images
// and light of the current stop.

import { ViewControl } from "../session/view-control";
import { newId } from "../core/ids";
import { Connection } from "../net/connection";
import type { SocketLike } from "../net/socket";
import type { FrameMessage } from "../net/frame-header";
import type { GestureHandler, PointerSample } from "../ui/input";
import { placeOfObject } from "./fit";
import type {
  Background,
  LayerOverride,
  Look,
  Model,
  Picked,
  View,
  Welcome,
} from "../core/protocol.gen";
import { completeLayer, type Layer } from "../core/types";
import { looksOfView } from "../domain/views";
import { OrbitTool } from "../tools/navigate";
import { asKiosk } from "./as-kiosk";

const kAwayMs = 3000; // shorter interruptions are not shown
const kTapReachCss = 14; // tolerance for a finger

export interface ShowHost {
  /**
   * The model, its layers or a saved view were loaded or changed. For `views`, the tour's views
   * must be read again.
   */
  learned(what: "model" | "views"): void;
  /**
   * The visitor tapped. The arguments are the values at the point and its position on the stage in
   * CSS pixels.
   */
  tapped(picked: Picked, at: { x: number; y: number }): void;
  /** The camera has moved, so the tapped point is at another position. */
  moved(): void;
  /** The frames have started or stopped. */
  changed(): void;
  /** The connection was lost, temporarily or for a longer time. */
  lost(): void;
}

export class KioskShow {
  model: Model | null = null;
  layers: Layer[] = [];
  looks: Look[] = [];
  /** Whether a frame is on the canvas. */
  drawn = false;
  /** Whether no frame has arrived for some seconds. */
  away = false;
  /** The stage sets these callbacks. */
  onFrame: (part: FrameMessage) => void = () => {};
  onResetFrames: () => void = () => {};

  readonly view: ViewControl;
  private readonly _connection: Connection;
  private readonly _orbitTool: OrbitTool;
  private _viewShown: View | null = null;
  private _standsAtView = false; // the camera was not moved since the view was shown
  private _placed = false; // the camera has reached the position of the view
  private _awayTimer: ReturnType<typeof setTimeout> | null = null;
  private _pick = ""; // the id of the last tap without a response
  private _pickedAt = { x: 0, y: 0 }; // on the stage, in CSS pixels
  private _flightEndsMs = 0;

  constructor(
    readonly modelRef: string,
    private readonly _host: ShowHost,
    makeSocket?: (url: string, protocol: string) => SocketLike,
  ) {
    this.view = new ViewControl({
      send: (moving) => this._connection.setCamera(this.view.camera.message(), moving),
      whenFree: (action) => action(),
      isPainting: () => false,
      cameToRest: () => {},
      wentOwnWay: () => {},
      changed: () => {},
    });
    this._orbitTool = new OrbitTool(
      {
        orbit: (dx, dy) => this.move(() => this.view.orbitPixels(dx, dy)),
        pan: () => {},
        tap: (sample) => this.tap(sample),
      },
      () => kTapReachCss * this.view.scale,
    );
    this._connection = this.makeConnection(makeSocket);
  }

  readonly gestures: GestureHandler = {
    toolDown: (sample) => this._orbitTool.down(sample),
    toolMove: (samples) => this._orbitTool.move(samples),
    toolUp: () => this._orbitTool.up(),
    toolCancel: () => this._orbitTool.cancel(),
    orbit: (dx, dy) => this.move(() => this.view.orbitPixels(dx, dy)),
    pan: (dx, dy) => this.move(() => this.view.panPixels(dx, dy)),
    zoom: (factor, x, y) => this.move(() => this.view.zoomAt(factor, x, y)),
    twist: (angle) => this.move(() => this.view.twist(angle)),
    hover: () => {},
    freeMouse: () => {},
    toolIsForPen: () => false,
  };

  open(): void {
    this.expectPictures();
    this._connection.open();
  }
  close(): void {
    this.view.stop();
    this.stopExpecting();
    this._connection.close();
  }
  /** Reconnects immediately. Call this when the server has just responded to another request. */
  checkConnection(): void {
    this._connection.check();
  }

  /** Sets the background that the server draws around the object. */
  setRoom(room: Background): void {
    this._connection.setBackground(room);
  }

  /** Shows the view with these layers. `flightS` is the duration of the camera's movement. */
  goTo(view: View, layers: LayerOverride[], flightS: number): void {
    this._viewShown = view;
    this._standsAtView = true;
    this.showSettings(view, layers);
    this._placed = this.model !== null;
    if (!this.model) return;
    this.view.setSection(view.camera.section ?? [], view.camera.hidden_parts ?? [], flightS > 0);
    const flightMs = this.drawn ? flightS * 1000 : 0;
    this._flightEndsMs = performance.now() + flightMs;
    this.view.fly(placeOfObject(view.camera, this.view.camera), flightMs);
  }

  /**
   * Shows a view after the model or the view may have changed. The camera stays where visitors have
   * moved it, unless the camera of the view has changed.
   */
  goOn(view: View, layers: LayerOverride[]): void {
    const same =
      this._placed && JSON.stringify(this._viewShown?.camera) === JSON.stringify(view.camera);
    if (same) this.showSettings(view, layers);
    else this.goTo(view, layers, 0);
  }

  /** Whether visitors have not moved the camera away from the view. */
  get untouched(): boolean {
    return this._standsAtView;
  }

  private showSettings(view: View, layers: LayerOverride[]): void {
    this.showLayers(layers);
    const { settings, stack } = looksOfView(view, this.looks);
    const shown = view.looks
      ? stack.map((look) => ({ look, opacity: settings.get(look)?.opacity ?? 1 }))
      : null;
    this._connection.setAppearance(shown, view.light);
  }
  showLayers(layers: LayerOverride[]): void {
    this._connection.setLayerOverrides(layers);
  }

  /**
   * Sets the size in CSS pixels and the number of window pixels per CSS pixel. The size may change
   * between stops, because their texts need different amounts of space. A running camera movement
   * continues.
   */
  setViewport(width: number, height: number, scale: number): void {
    this.view.setViewport(width, height, scale);
    if (!this._viewShown || !this._standsAtView || !this.model) return;
    const leftMs = Math.max(0, this._flightEndsMs - performance.now());
    this.view.fly(placeOfObject(this._viewShown.camera, this.view.camera), leftMs);
  }

  frameDrawn(part: FrameMessage): void {
    this._connection.ack(part.header.view_id, part.header.frame);
    this.view.countFrame();
    if (this.drawn && !this.away) return;
    this.stopExpecting();
    this.drawn = true;
    this.away = false;
    this._host.changed();
  }

  private move(change: () => void): void {
    const first = this._standsAtView;
    this._standsAtView = false;
    this._pick = ""; // the tapped point has moved
    change();
    this._host.moved();
    if (first) this._host.changed();
  }

  private tap({ x, y }: PointerSample): void {
    this._pick = newId();
    this._pickedAt = { x: x / this.view.scale, y: y / this.view.scale };
    this._connection.pick(this._pick, x, y);
  }

  private makeConnection(makeSocket?: (url: string, protocol: string) => SocketLike): Connection {
    const { protocol, host } = window.location;
    const address = `${protocol === "https:" ? "wss" : "ws"}://${host}/api/v1/models/${encodeURIComponent(this.modelRef)}/live`;
    const nothing = (): void => {};
    return new Connection(
      {
        url: asKiosk(address),
        client: "strata-kiosk/0.1",
        devicePixelRatio: window.devicePixelRatio,
        ...(makeSocket ? { makeSocket } : {}),
      },
      {
        state: (state) => {
          if (state === "lost") this.onLost();
        },
        welcome: (message) => this.onWelcome(message),
        frame: (part) => this.onFrame(part),
        layer: (event) => {
          if (event.event === "edited") return;
          this.layers = this.layers.filter(({ id }) => id !== event.layer_id);
          if (event.layer && event.event !== "deleted")
            this.layers = byOrder([...this.layers, completeLayer(event.layer)]);
          this._host.learned("model");
        },
        look: (event) => {
          this.looks = this.looks.filter(({ id }) => id !== event.look_id);
          if (event.look && event.event !== "deleted")
            this.looks = byOrder([...this.looks, event.look]);
          this._host.learned("model");
        },
        model: ({ model }) => {
          if (model) this.takeModel(model);
        },
        view: () => this._host.learned("views"),
        picked: (message) => {
          if (message.id !== this._pick) return;
          this._pick = "";
          this._host.tapped(message, this._pickedAt);
        },
        // Visitors cannot solve problems and do not see them. The operator finds them in the
        // browser's console.
        problem: (problem) =>
          console.info(
            "the server refused something:",
            problem.status,
            problem.title,
            problem.detail,
          ),
        saving: nothing,
        applied: nothing,
        snapshot: nothing,
        selection: nothing,
        saved: nothing,
        takenUp: nothing,
        tool: nothing,
        record: nothing,
        table: nothing,
        editors: nothing,
        comment: nothing,
        presence: nothing,
      },
    );
  }

  private onWelcome({ model, layers, looks }: Welcome): void {
    this.layers = byOrder(layers.map(completeLayer));
    this.looks = byOrder(looks);
    this.takeModel(model);
  }

  private takeModel(model: Model): void {
    const turned = this.model !== null && this.model.up !== model.up;
    this.model = model;
    this.view.setModel(model, turned);
    this._host.learned("model");
  }

  private onLost(): void {
    this.onResetFrames();
    this.expectPictures();
    this._host.lost();
  }

  private expectPictures(): void {
    this._awayTimer ??= setTimeout(() => {
      this.drawn = false;
      this.away = true;
      this._host.changed();
    }, kAwayMs);
  }
  private stopExpecting(): void {
    if (this._awayTimer) clearTimeout(this._awayTimer);
    this._awayTimer = null;
  }
}

const byOrder = <T extends { id: number; order: number }>(things: readonly T[]): T[] =>
  [...things].sort((a, b) => a.order - b.order || a.id - b.id);
