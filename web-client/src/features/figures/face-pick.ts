// A face of the surface that is asked for: the person taps it, takes what is in the middle of the
// picture, or gives up.

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
  /** Its tool is in hand from now on; and no longer. */
  begin(): void;
  end(): void;
}

export class FacePick {
  private answer_: ((face: Face | null) => void) | null = null; // of who asks

  constructor(
    private readonly api_: Api,
    private readonly host_: FacePickHost,
  ) {}

  /** Null: none was taken. */
  ask(): Promise<Face | null> {
    this.give_up();
    return new Promise((resolve) => {
      this.answer_ = resolve;
      this.host_.begin();
    });
  }

  async take_at({ x, y }: PointerSample): Promise<void> {
    // which moves on until the answer comes
    const camera = Object.assign(new OrbitCamera(), this.host_.view.camera);
    const asker = this.answer_;
    const model = this.host_.model();
    if (!asker || !model) return;
    try {
      const { hit, position, normal } = await this.api_.pick(model.id, camera.message(), [x, y]);
      if (asker !== this.answer_) return;
      const { back } = camera.axes();
      if (!hit || !position) {
        notices.show("info", texts.marks.missed);
        return;
      }
      const outwards = normal ?? back;
      const to_eye = camera.perspective ? subtract(camera.eye(), position) : back;
      // of an open scan its inside
      const seen = dot(outwards, to_eye) < 0 ? scale(outwards, -1) : outwards;
      this.finish({ center: position, normal: [seen[0], seen[1], seen[2]] });
    } catch (error) {
      notices.error(error);
    }
  }

  take_in_middle(): void {
    const { width, height } = this.host_.view.camera;
    void this.take_at({ x: width / 2, y: height / 2 });
  }

  give_up(): void {
    this.finish(null);
  }

  private finish(face: Face | null): void {
    const answer = this.answer_;
    if (!answer) return;
    this.answer_ = null;
    this.host_.end();
    answer(face);
  }
}
