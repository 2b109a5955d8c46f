// This user's pointer, the values under it, and the presence messages to other participants.

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
  /**
   * The results of a press that takes the value for the brush, and of a tap to look at the values.
   */
  taken(message: Picked): void;
  looked(message: Picked): void;
  /** `picked` has changed. */
  learned(): void;
  changed(): void;
}

export class PointerWatch {
  at: PointerSample | null = null; // in window pixels
  picked: Picked | null = null; // last known values under the pointer

  private _depth: number | null = null; // depth of the last surface point under the pointer
  private _presenceTimer: ReturnType<typeof setTimeout> | null = null;
  private readonly _probe: PickProbe;

  constructor(private readonly _host: PointerHost) {
    this._probe = new PickProbe({
      ready: () => _host.ready(),
      ask: (id, sample) => _host.ask(id, sample),
      answered: (message, purpose) => this.onPicked(message, purpose),
    });
  }

  /** Whether `picked` belongs to the pointer's current position. */
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

  /**
   * Requests the values again. Call this when the surface or the view may have changed under a
   * resting pointer.
   */
  askAgain(): void {
    this._probe.askAgain(this.at);
  }

  answer(message: Picked): void {
    this._probe.answer(message);
  }
  /** Handles a refusal. Returns true if it belongs to this pointer's request. */
  refused(ref: string | undefined): boolean {
    return this._probe.refused(ref);
  }
  /** Discards the pending request, because its response was lost with the connection. */
  reset(): void {
    this._probe.reset();
  }

  stop(): void {
    if (this._presenceTimer) clearTimeout(this._presenceTimer);
    this._presenceTimer = null;
    this._probe.stop();
  }

  /**
   * Returns the depth of the surface under the pointer. If it is unknown, returns the depth of the
   * camera's target. After a touch there is no pointer, and the camera may have moved since then.
   */
  surfaceDepth(): number {
    const { at, _depth: depth } = this;
    return at && depth !== null && depth > 0 ? depth : this._host.camera().distance;
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

  /** Stores the depth, on which the brush radius in the presence message depends. */
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
