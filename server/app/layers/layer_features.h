#pragma once

#include <functional>

#include "app/layers/feature_set.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "query/maps/plane_outlines.h"
#include "room/at.h"
#include "room/queries.h"
#include "room/room.h"
#include "store/store.h"

namespace strata::app {

struct FeatureRequest {
  std::shared_ptr<room::Room> room;  // as visible to the caller
  Layer layer;
  room::At at;  // empty: current state
  query::OutlinePlane plane;
  Role role = Role::viewer;
  std::string language;  // for the labels of terms
  // The tables to return: the areas, and the lines and points of records.
  bool with_areas = true, with_marks = true;
  // Returns whether the area of a class is outlined. The others have no geometry. It gets the
  // number of the feature in the table and the feature. Empty: all are outlined.
  std::function<bool(std::size_t number, const Feature& feature)> outlines{};
};

// Returns the areas of a layer's classes. For a database layer, also returns the lines and points
// of its records on the model. Each feature has its name and the values of the record in the
// columns that are visible to the role. Blocks.
Result<FeatureSet> layer_features(store::Store& store, const FeatureRequest& request);

// The classes of a layer that occur, as the areas of layer_features without their geometry.
struct LayerClasses {
  room::LayerAreas areas;
  FeatureTable table;
  std::vector<std::uint32_t> classes;  // by feature, in the sense of query::classes_of
};
// The plane of the request has no effect. Blocks.
Result<LayerClasses> layer_classes(store::Store& store, const FeatureRequest& request);

}  // namespace strata::app
