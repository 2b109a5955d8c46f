// Explains why a layer cannot be changed, and how to unlock it.

import { labelOf } from "../domain/cells";
import { isAsComputed, type Layer } from "../core/types";
import { texts } from "../texts";

export const whyLocked = (layer: Layer): string =>
  isAsComputed(layer)
    ? texts.layers.computed_detail(labelOf(layer))
    : texts.layers.locked_detail(labelOf(layer));

export const unlockLabel = (layer: Layer): string =>
  isAsComputed(layer) ? texts.layers.unlock_computed : texts.layers.unlock;
