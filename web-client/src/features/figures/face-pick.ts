// Lets the user pick a face of the surface: by a tap, in the middle of the 3D view, or not at all
// by canceling.

import type { Api } from "../../net/api";
import { OrbitCamera } from "../../math/camera";
import type { Face } from "../../domain/figures";
import type { PointerSample } from "../../ui/input";
import type { Model } from "../../core/types";
import { dot, scale, subtract } from "../../math/vector";
import { notices } from "../../ui/notices";
import { texts } from "../../texts";
import type { ViewControl } from "../../session/view-control";

export interface FacePickHost {
  readonly view: ViewControl;
  model(): Model | null;
  /** Activates the tool; `end` deactivates it. */
  begin(): void;
  end(): void;
}

export class FacePick {
  // resolves the pending promise of ask()
  private _answer: ((face: Face | null) => void) | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _host: FacePickHost,
  ) {}

  /** Resolves to null if the user cancels. */
  ask(): Promise<Face | null> {
    this.giveUp();
    return new Promise((resolve) => {
      this._answer = resolve;
      this._host.begin();
    });
  }

  async takeAt({ x, y }: PointerSample): Promise<void> {
    // a copy, because the camera may move before the response arrives
    const camera = Object.assign(new OrbitCamera(), this._host.view.camera);
    const asker = this._answer;
    const model = this._host.model();
    if (!asker || !model) return;
    try {
      const { hit, position, normal } = await this._api.json("POST /models/{model}/pick", {
        path: { model: model.id },
        body: { camera: camera.message(), x, y },
      });
      if (asker !== this._answer) return;
      const { back } = camera.axes();
      if (!hit || !position) {
        notices.show("info", texts.marks.missed);
        return;
      }
      const outwards = normal ?? back;
      const toEye = camera.perspective ? subtract(camera.eye(), position) : back;
      // the inner side of an open scan may be visible
      const seen = dot(outwards, toEye) < 0 ? scale(outwards, -1) : outwards;
      this.finish({ center: position, normal: [seen[0], seen[1], seen[2]] });
    } catch (error) {
      notices.error(error);
    }
  }

  takeInMiddle(): void {
    const { width, height } = this._host.view.camera;
    void this.takeAt({ x: width / 2, y: height / 2 });
  }

  giveUp(): void {
    this.finish(null);
  }

  private finish(face: Face | null): void {
    const answer = this._answer;
    if (!answer) return;
    this._answer = null;
    this._host.end();
    answer(face);
  }
}
