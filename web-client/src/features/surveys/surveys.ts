// The surveys of the object that the open model belongs to: the switch between them, and another
// survey next to the open one.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import type { SocketLike } from "../../net/socket";
import type { Background, Light, Survey, SurveyedObject } from "../../core/protocol.gen";
import type { Model } from "../../core/types";
import { placeInUnit, type LayersSeen } from "../../domain/surveys";
import type { OrbitCamera, Place } from "../../math/camera";
import { navigate, pathOfModel } from "../../ui/routes";
import { handOver, takeHandover, type Handover } from "./handover";
import { OtherSurvey } from "./other-survey";

const kDividerMargin = 0.02; // the divider stays reachable

export interface SurveysHost {
  model(): Model | null;
  camera(): OrbitCamera;
  /** The position of the camera, or the end of its flight. */
  place(): Place;
  /** Sets the position of the first view. */
  beginAt(place: Place): void;
  seen(): LayersSeen;
  show(seen: LayersSeen): void;
  light(): Light;
  setLight(light: Light): void;
  changed(): void;
}

export class Surveys {
  object: SurveyedObject | null = null;
  /** The survey next to the open one. */
  other: OtherSurvey | null = null;
  /** The position of the divider, as a share of the width. */
  divider = 0.5;
  /** Whether the date bar takes the keyboard focus when it appears. */
  takesFocus = false;

  private _handover: Handover | null = null;
  private _known = ""; // the object and the date that `object` was read for
  private _connected = false; // since the page was opened
  private _asked = 0;
  private _background: Background | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _host: SurveysHost,
    private readonly _makeSocket?: (url: string, protocol: string) => SocketLike,
  ) {}

  /** The survey that is open. */
  get current(): Survey | null {
    const id = this._host.model()?.id;
    return this.object?.surveys.find(({ model }) => model === id) ?? null;
  }
  get others(): readonly Survey[] {
    const { current } = this;
    return this.object?.surveys.filter((survey) => survey !== current) ?? [];
  }
  /** Whether the other survey is earlier than the open one. If so, it is at the left. */
  get otherIsEarlier(): boolean {
    const { object, other, current } = this;
    if (!object || !other || !current) return true;
    const place = (id: number): number => object.surveys.findIndex(({ model }) => model === id);
    return place(other.survey.model) < place(current.model);
  }

  // ── from one survey to the next ────────────────────────────────────────────────────────────────

  /** Opens another survey with this camera, light and these layers. */
  open(survey: Survey, hasFocus: boolean): void {
    const model = this._host.model();
    if (!model || survey.model === model.id) return;
    const { up } = this._host.camera();
    handOver(survey.model, {
      place: this._host.place(),
      unit: model.unit,
      up,
      seen: this._host.seen(),
      light: this._host.light(),
      hasFocus,
    });
    navigate(pathOfModel(survey.model));
  }

  /** Takes over the view of the previous survey. Call this before the first view is set. */
  begin(model: Model): void {
    const handover = (this._handover = takeHandover(model.id));
    if (!handover) return;
    this.takesFocus = handover.hasFocus;
    if (handover.up === model.up)
      this._host.beginAt(placeInUnit(handover.place, handover.unit, model.unit));
  }

  /** Call this after each connection, when the layers are known. */
  welcome(): void {
    // Surveys may have come and gone while the connection was lost.
    if (this._connected && this._known !== "") void this.load();
    this._connected = true;
    const handover = this._handover;
    this._handover = null;
    if (!handover) return;
    this._host.setLight(handover.light);
    this._host.show(handover.seen);
  }

  // ── the object ─────────────────────────────────────────────────────────────────────────────────

  /** Reads the object if the model has entered or left an object, or its date has changed. */
  modelChanged(): void {
    const model = this._host.model();
    const known = model?.object === undefined ? "" : `${model.object} ${model.survey_date}`;
    if (known === this._known) return;
    this._known = known;
    void this.load();
  }

  /**
   * Reads the object. If it does not exist or cannot be read, the page shows only the open model.
   * While the server cannot be reached, the known surveys remain.
   */
  async load(): Promise<void> {
    const asked = ++this._asked;
    const model = this._host.model();
    let object: SurveyedObject | null = null;
    if (model?.object !== undefined) {
      try {
        object = await this._api.json("GET /projects/{project}/objects/{object}", {
          path: { project: model.project, object: model.object },
        });
      } catch (error) {
        if (!(error instanceof ApiError)) throw error;
        if (error.status !== 404 && this.object?.id === model.object) return;
      }
    }
    if (asked !== this._asked) return;
    this.object = object;
    if (!this.others.some((survey) => survey.model === this.other?.survey.model)) this.endSwipe();
    this._host.changed();
  }

  // ── two surveys next to each other ─────────────────────────────────────────────────────────────

  /** Shows this survey next to the open one. Null shows only the open one. */
  compareWith(survey: Survey | null): void {
    if (survey?.model === this.other?.survey.model) return;
    this.endSwipe();
    if (survey) {
      this.other = new OtherSurvey(
        survey,
        {
          view: () => ({
            camera: this._host.camera(),
            unit: this._host.model()?.unit ?? "m",
            seen: this._host.seen(),
            light: this._host.light(),
          }),
          gone: () => {
            this.compareWith(null);
            void this.load();
          },
          changed: () => this._host.changed(),
        },
        this._makeSocket,
      );
      this.other.setBackground(this._background);
      this.other.open();
    }
    this._host.changed();
  }

  private endSwipe(): void {
    this.other?.close();
    this.other = null;
  }

  setDivider(share: number): void {
    this.divider = Math.min(1 - kDividerMargin, Math.max(kDividerMargin, share));
    this._host.changed();
  }

  setBackground(background: Background | null): void {
    this._background = background;
    this.other?.setBackground(background);
  }

  /** Ends the comparison when the page closes. */
  close(): void {
    this._asked += 1;
    this.endSwipe();
  }
}
