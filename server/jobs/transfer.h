#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "domain/scene/model.h"
#include "store/store.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct Geometry;
class SearchTree;
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::jobs {

// The model that receives the layers.
struct TransferTarget {
  Model model;
  std::shared_ptr<const mesh::Geometry> geometry;
  std::shared_ptr<const mesh::SearchTree> tree;
  std::function<Result<std::shared_ptr<const mesh::SurfaceMap>>(int resolution)> surface_map;
};

struct TransferRequest {
  Model source;
  std::vector<Layer> layers;  // of the source
  double tolerance_mm = 1;
  double max_angle_degrees = 60;
};

// One layer on the target, with its areas.
struct TransferredLayer {
  const Layer* from = nullptr;
  int resolution = 0;  // that of the source, or the target's lowest if that is higher
  TileMap tiles;
  double source_m2 = 0;       // painted surface of the source
  double transferred_m2 = 0;  // painted surface of the target
  double lost_m2 = 0;         // part of source_m2 without a counterpart on the target
};

struct TransferSummary {
  double area_m2 = 0, matched_m2 = 0;  // surface of the target; part of it with a counterpart
};

// For every texel of the target, finds the nearest place of the source within the tolerance whose
// triangle faces the same way within the angle, and copies each layer's value there: of one texel,
// without mixing, so that keys stay valid. The world coordinates of both models must be of one
// system, each in its own units. Edits of the source that are not yet durable are ignored.
// `deliver` receives one layer after the other and may refuse, which ends the transfer. Long:
// reports progress, honors cancel. Thread: any that may block.
using Deliver = std::function<Result<void>(TransferredLayer layer)>;
Result<TransferSummary> transfer_layers(store::Store& store, const TransferTarget& target,
                                        const TransferRequest& request, const Deliver& deliver,
                                        Progress& progress);

}  // namespace strata::jobs
