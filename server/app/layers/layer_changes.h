#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "app/services.h"
#include "core/progress.h"
#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "query/statistics/cross_table.h"
#include "room/room.h"

// What became of the classes of a layer since an earlier survey of the object.
namespace strata::app {

// The layer of the other survey, and how its places are found on the open model.
struct ChangesSince {
  Model model;
  Layer layer;
  double tolerance_mm = 1;
  double max_angle_degrees = 60;
  double min_area_m2 = 0;  // smaller pieces are not listed
};

// A connected area of one value.
struct ChangedPiece {
  double value = 0;
  double area_m2 = 0;
  glm::dvec3 at{0};  // a place in it, in world coordinates of the open model
};
struct ChangedPieces {
  std::vector<ChangedPiece> list;  // the kMaxChangedPieces largest
  std::uint64_t total = 0;
  double area_m2 = 0;  // of all pieces
};
constexpr std::size_t kMaxChangedPieces = 1000;

struct LayerChanges {
  double area_m2 = 0, matched_m2 = 0;  // area of the open model, and the part with a counterpart
  // Rows: values in the other survey. Columns: values on the open model. Areas of the open model
  // with a counterpart.
  query::CrossTable table;
  // by value: painted areas of each survey without a counterpart on the other
  std::map<double, double> unmatched_now_m2, unmatched_then_m2;
  ChangedPieces appeared;  // pieces of the open model that overlap nothing painted in the other
  ChangedPieces vanished;  // pieces of the other survey that overlap nothing painted here
};

// Checks that the values of both layers have the same meaning. The error names `layer`.
Result<void> check_comparable(const Layer& now, const Layer& then);

// Compares a layer of the open model with a layer of another survey. Both models have the same
// world coordinate system, and each may have its own unit. Ignores edits of the other model that
// are not durable yet. Takes long, reports progress and can be cancelled. Blocks.
Result<LayerChanges> compare_layers(const Services& services, room::Room& room, LayerId layer,
                                    const ChangesSince& since, Progress& progress);

}  // namespace strata::app
