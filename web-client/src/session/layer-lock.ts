// Why a layer may not be changed, and what makes it free, in words.

import { label_of } from "../domain/cells";
import { is_as_computed, type Layer } from "../core/types";
import { texts } from "../texts";

export const why_locked = (layer: Layer): string =>
  is_as_computed(layer)
    ? texts.layers.computed_detail(label_of(layer))
    : texts.layers.locked_detail(label_of(layer));

export const unlock_label = (layer: Layer): string =>
  is_as_computed(layer) ? texts.layers.unlock_computed : texts.layers.unlock;
