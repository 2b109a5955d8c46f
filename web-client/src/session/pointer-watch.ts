// Where this person's pointer is, what lies under it, and what the others are told of it.

import type { OrbitCamera } from "../math/camera";
import type { PointerSample } from "../ui/input";
import type { Picked } from "../core/protocol.gen";
import { PickProbe, type PickPurpose } from "./pick-probe";

const kPresenceEvery_ms = 100;

export interface PointerHost {
  camera(): OrbitCamera;
  ready(): boolean;
  ask(id: string, sample: PointerSample): void;
  show_others(pointer: PointerSample | null): void;
  /** Somebody pressed here to take the value, or tapped to look closer. */
  taken(message: Picked): void;
  looked(message: Picked): void;
  /** `picked` is newer. */
  learned(): void;
  changed(): void;
}

export class PointerWatch {
  at: PointerSample | null = null; // window pixels
  picked: Picked | null = null; // under the pointer, newest known

  private depth_: number | null = null; // of the last surface point seen under the pointer
  private presence_timer_: ReturnType<typeof setTimeout> | null = null;
  private readonly probe_: PickProbe;

  constructor(private readonly host_: PointerHost) {
    this.probe_ = new PickProbe({
      ready: () => host_.ready(),
      ask: (id, sample) => host_.ask(id, sample),
      answered: (message, purpose) => this.on_picked(message, purpose),
    });
  }

  /** `picked` is of where the pointer is now. */
  get settled(): boolean {
    return this.probe_.idle;
  }

  hover(sample: PointerSample | null): void {
    this.at = sample;
    if (sample) this.probe_.ask(sample);
    else this.picked = null;
    this.schedule_presence();
    this.host_.changed();
  }

  take(sample: PointerSample): void {
    this.probe_.ask(sample, "take");
  }
  look(sample: PointerSample): void {
    this.probe_.ask(sample, "look");
  }

  /** The surface or the view may have changed under a pointer that rests. */
  ask_again(): void {
    this.probe_.ask_again(this.at);
  }

  answer(message: Picked): void {
    this.probe_.answer(message);
  }
  /** True when the refusal is of a question of this pointer. */
  refused(ref: string | undefined): boolean {
    return this.probe_.refused(ref);
  }
  /** The connection is gone, and the answer with it. */
  reset(): void {
    this.probe_.reset();
  }

  stop(): void {
    if (this.presence_timer_) clearTimeout(this.presence_timer_);
    this.presence_timer_ = null;
    this.probe_.stop();
  }

  /** Depth of the surface under the pointer; where it is not known, of the camera's target. */
  surface_depth(): number {
    return this.depth_ !== null && this.depth_ > 0 ? this.depth_ : this.host_.camera().distance;
  }

  private on_picked(message: Picked, purpose: PickPurpose): void {
    if (this.at || purpose !== "hover") this.picked = message;
    if (message.hit && message.position)
      this.see_depth(this.host_.camera().depth_of(message.position));
    if (purpose === "take") this.host_.taken(message);
    if (purpose === "look") this.host_.looked(message);
    this.host_.learned();
    this.host_.changed();
  }

  /** How large the brush is on the surface was told with the depth that was known then. */
  private see_depth(depth: number): void {
    const told = this.depth_;
    this.depth_ = depth;
    if (this.at && depth !== told) this.schedule_presence();
  }

  private schedule_presence(): void {
    if (this.presence_timer_) return;
    this.presence_timer_ = setTimeout(() => {
      this.presence_timer_ = null;
      this.host_.show_others(this.at);
    }, kPresenceEvery_ms);
  }
}
