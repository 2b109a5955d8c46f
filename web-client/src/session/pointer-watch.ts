// Where this person's pointer is, what lies under it, and what the others are told of it.

import type { OrbitCamera } from "../math/camera";
import type { PointerSample } from "../ui/input";
import type { Picked } from "../core/protocol.gen";
import { PickProbe, type PickPurpose } from "./pick-probe";

const kPresenceEveryMs = 100;

export interface PointerHost {
  camera(): OrbitCamera;
  ready(): boolean;
  ask(id: string, sample: PointerSample): void;
  showOthers(pointer: PointerSample | null): void;
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

  private _depth: number | null = null; // of the last surface point seen under the pointer
  private _presenceTimer: ReturnType<typeof setTimeout> | null = null;
  private readonly _probe: PickProbe;

  constructor(private readonly _host: PointerHost) {
    this._probe = new PickProbe({
      ready: () => _host.ready(),
      ask: (id, sample) => _host.ask(id, sample),
      answered: (message, purpose) => this.onPicked(message, purpose),
    });
  }

  /** `picked` is of where the pointer is now. */
  get settled(): boolean {
    return this._probe.idle;
  }

  hover(sample: PointerSample | null): void {
    this.at = sample;
    if (sample) this._probe.ask(sample);
    else this.picked = null;
    this.schedulePresence();
    this._host.changed();
  }

  take(sample: PointerSample): void {
    this._probe.ask(sample, "take");
  }
  look(sample: PointerSample): void {
    this._probe.ask(sample, "look");
  }

  /** The surface or the view may have changed under a pointer that rests. */
  askAgain(): void {
    this._probe.askAgain(this.at);
  }

  answer(message: Picked): void {
    this._probe.answer(message);
  }
  /** True when the refusal is of a question of this pointer. */
  refused(ref: string | undefined): boolean {
    return this._probe.refused(ref);
  }
  /** The connection is gone, and the answer with it. */
  reset(): void {
    this._probe.reset();
  }

  stop(): void {
    if (this._presenceTimer) clearTimeout(this._presenceTimer);
    this._presenceTimer = null;
    this._probe.stop();
  }

  /** Depth of the surface under the pointer; where it is not known, of the camera's target. */
  surfaceDepth(): number {
    return this._depth !== null && this._depth > 0 ? this._depth : this._host.camera().distance;
  }

  private onPicked(message: Picked, purpose: PickPurpose): void {
    if (this.at || purpose !== "hover") this.picked = message;
    if (message.hit && message.position)
      this.seeDepth(this._host.camera().depthOf(message.position));
    if (purpose === "take") this._host.taken(message);
    if (purpose === "look") this._host.looked(message);
    this._host.learned();
    this._host.changed();
  }

  /** How large the brush is on the surface was told with the depth that was known then. */
  private seeDepth(depth: number): void {
    const told = this._depth;
    this._depth = depth;
    if (this.at && depth !== told) this.schedulePresence();
  }

  private schedulePresence(): void {
    if (this._presenceTimer) return;
    this._presenceTimer = setTimeout(() => {
      this._presenceTimer = null;
      this._host.showOthers(this.at);
    }, kPresenceEveryMs);
  }
}
