#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/progress.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "domain/scene/model.h"
#include "mesh/surface/search_tree.h"
#include "mesh/texels/surface_map.h"
#include "store/store.h"

namespace strata::jobs {

// The model that layers are put on.
struct TransferTarget {
  Model model;
  std::shared_ptr<const mesh::Geometry> geometry;
  std::shared_ptr<const mesh::SearchTree> tree;
  std::function<Result<std::shared_ptr<const mesh::SurfaceMap>>(int resolution)> surface_map;
};

struct TransferRequest {
  Model source;
  std::vector<Layer> layers;  // of it
  double tolerance_mm = 1;
  double max_angle_degrees = 60;
};

// One layer as it lies on the target, and how much of it that is.
struct TransferredLayer {
  const Layer* from = nullptr;
  int resolution = 0;  // that of the source, or the target's lowest where that is higher
  TileMap tiles;
  double source_m2 = 0;       // painted surface there
  double transferred_m2 = 0;  // painted surface here
  double lost_m2 = 0;         // of source_m2: without a counterpart here
};

struct TransferSummary {
  double area_m2 = 0, matched_m2 = 0;  // surface of the target; of that with a counterpart
};

// For every texel of the target the nearest place of the source within the tolerance whose triangle
// faces within the angle of it, and what each layer has there: one texel, no mixing, so that keys
// stay keys. Both models' world coordinates are taken to be of one system, in their own units. What
// is not yet durable on the source is not seen. `deliver` gets one layer after the other and may
// refuse, which ends it. Long: reports progress, honours cancel. Thread: any that may block.
using Deliver = std::function<Result<void>(TransferredLayer layer)>;
Result<TransferSummary> transfer_layers(store::Store& store, const TransferTarget& target,
                                        const TransferRequest& request, const Deliver& deliver,
                                        Progress& progress);

}  // namespace strata::jobs
