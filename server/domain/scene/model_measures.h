#pragma once

#include "domain/scene/model.h"

namespace strata {

// Returns whether lengths, heights and slopes mean the same in both states of a model. Otherwise,
// the computed layers are stale (store::Models::update).
inline bool same_measures(const Model& a, const Model& b) {
  return a.unit == b.unit && a.up == b.up;
}

}  // namespace strata
