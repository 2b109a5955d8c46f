// What the page of one survey passes on to the page of another survey of the object. Each model has
// its own page, so the two pages have no other common state.

import type { LayersSeen } from "../../domain/surveys";
import type { Light } from "../../core/protocol.gen";
import type { Model } from "../../core/types";
import type { Place } from "../../math/camera";

export interface Handover {
  place: Place;
  /** The unit of `place`, and the up direction that its angles refer to. */
  unit: Model["unit"];
  up: Model["up"];
  seen: LayersSeen;
  light: Light;
  /** Whether the keyboard focus was in the date bar. */
  hasFocus: boolean;
}

let waiting: { model: number; handover: Handover } | null = null;

/** Keeps this for the page of the model. The page of another model discards it. */
export function handOver(model: number, handover: Handover): void {
  waiting = { model, handover };
}

export function takeHandover(model: number): Handover | null {
  const taken = waiting?.model === model ? waiting.handover : null;
  waiting = null;
  return taken;
}
