#pragma once

#include "app/layers/feature_set.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "query/maps/plane_outlines.h"
#include "room/at.h"
#include "room/room.h"
#include "store/store.h"

namespace strata::app {

struct FeatureRequest {
  std::shared_ptr<room::Room> room;  // as who asks sees it
  Layer layer;
  room::At at;  // nothing: now
  query::OutlinePlane plane;
  Role role = Role::viewer;
  std::string language;  // of terms
};

// The areas of a layer's classes, and of a database layer the lines and points of its records on
// the model, each with what it is and what its record holds in the columns that the role sees.
// Blocks.
Result<FeatureSet> layer_features(store::Store& store, const FeatureRequest& request);

}  // namespace strata::app
