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
  std::vector<Layer> layers;  // layers of the source
  double tolerance_mm = 1;
  double max_angle_degrees = 60;
};

// A transferred layer on the target, with its areas.
struct TransferredLayer {
  const Layer* from = nullptr;
  int resolution = 0;  // of the source layer, but at least the target's lowest
  TileMap tiles;
  double source_m2 = 0;       // painted area on the source
  double transferred_m2 = 0;  // painted area on the target
  double lost_m2 = 0;         // the part of source_m2 without a counterpart on the target
};

struct TransferSummary {
  double area_m2 = 0, matched_m2 = 0;  // area of the target, and the part of it with a counterpart
};

// Transfers layers. For each texel of the target, finds the nearest point of the source within the
// tolerance. The triangle at that point must face the same direction as the texel, within the
// angle. Copies the value of one source texel for each layer, without mixing values, so keys stay
// valid. Both models must have the same world coordinate system. Each model may have its own unit.
// Ignores edits of the source that are not durable yet. Passes one layer after another to
// `deliver`. An Error of `deliver` ends the transfer. Takes long, reports progress and can be
// canceled. Blocks, so call it only on a thread that is allowed to block.
using Deliver = std::function<Result<void>(TransferredLayer layer)>;
Result<TransferSummary> transfer_layers(store::Store& store, const TransferTarget& target,
                                        const TransferRequest& request, const Deliver& deliver,
                                        Progress& progress);

}  // namespace strata::jobs
