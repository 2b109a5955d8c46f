// Another survey of the object, next to the open model. It has a connection to its own model, and
// shows it with the camera, the light and the layers of the open model.

import { seenAlike, standAlike, type LayersSeen } from "../../domain/surveys";
import type { Background, Light, Survey, Welcome } from "../../core/protocol.gen";
import type { Model } from "../../core/types";
import { OrbitCamera } from "../../math/camera";
import { Connection } from "../../net/connection";
import type { FrameMessage } from "../../net/frame-header";
import type { SocketLike } from "../../net/socket";

/** The open model's view. */
export interface OwnView {
  readonly camera: OrbitCamera;
  readonly unit: Model["unit"];
  readonly seen: LayersSeen;
  readonly light: Light;
}

export interface OtherSurveyHost {
  view(): OwnView;
  /** The model was deleted, or the user may no longer see it. */
  gone(): void;
  changed(): void;
}

export class OtherSurvey {
  /** Whether a frame is on the screen. */
  drawn = false;
  lost = false;
  /** The element that shows the frames sets these callbacks. */
  onFrame: (part: FrameMessage) => void = (part) => this.frameDrawn(part);
  onResetFrames: () => void = () => {};

  private readonly _connection: Connection;
  private readonly _camera = new OrbitCamera();
  private _model: Model | null = null;
  private _sent = ""; // the settings of the layers
  private _layers: readonly { id: number; name: string }[] = [];

  constructor(
    readonly survey: Survey,
    private readonly _host: OtherSurveyHost,
    makeSocket?: (url: string, protocol: string) => SocketLike,
  ) {
    const { protocol, host } = window.location;
    const nothing = (): void => {};
    this._connection = new Connection(
      {
        url: `${protocol === "https:" ? "wss" : "ws"}://${host}/api/v1/models/${survey.model}/live`,
        client: "strata-page/0.1",
        devicePixelRatio: window.devicePixelRatio,
        ...(makeSocket ? { makeSocket } : {}),
      },
      {
        state: (state) => {
          this.lost = state === "lost";
          if (state !== "open") this.onResetFrames();
          this._host.changed();
        },
        welcome: (message) => this.onWelcome(message),
        frame: (part) => this.onFrame(part),
        layer: ({ event, layer_id: id, layer }) => {
          if (event === "edited") return;
          this._layers = this._layers.filter((each) => each.id !== id);
          if (layer && event !== "deleted") this._layers = [...this._layers, layer];
          this.showLayers();
        },
        model: ({ event, model }) => {
          if (event === "deleted") this._host.gone();
          else if (model) this.takeModel(model);
        },
        // The page shows problems of the open model only.
        problem: ({ title, detail }) => console.info(`the other survey: ${title} ${detail ?? ""}`),
        look: nothing,
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
        view: nothing,
        presence: nothing,
        picked: nothing,
      },
    );
  }

  open(): void {
    this._connection.open();
  }
  close(): void {
    this._connection.close();
  }
  checkConnection(): void {
    this._connection.check();
  }

  /** Call this after each move of the open model's camera. */
  cameraMoved(moving: boolean): void {
    if (!this._model) return;
    const { camera, unit } = this._host.view();
    // The angles of the camera refer to the up direction of the open model.
    this._camera.setModel(this._model.bounds, camera.up);
    standAlike(this._camera, camera, unit, this._model.unit);
    this._connection.setCamera(this._camera.message(), moving);
  }

  showLayers(): void {
    const overrides = seenAlike(this._host.view().seen, this._layers);
    if (JSON.stringify(overrides) === this._sent) return;
    this._sent = JSON.stringify(overrides);
    this._connection.setLayerOverrides(overrides);
  }
  showLight(): void {
    this._connection.setAppearance(null, this._host.view().light);
  }
  setBackground(background: Background | null): void {
    this._connection.setBackground(background);
  }

  /** A complete frame is on the screen. */
  frameDrawn({ header }: FrameMessage): void {
    if (!header.last) return;
    this._connection.ack(header.view_id, header.frame);
    if (this.drawn) return;
    this.drawn = true;
    this._host.changed();
  }

  private onWelcome({ model, layers }: Welcome): void {
    this._layers = layers;
    this.showLayers();
    this.showLight();
    this.takeModel(model);
  }

  private takeModel(model: Model): void {
    this._model = model;
    this.cameraMoved(false);
  }
}
