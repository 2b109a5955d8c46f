#pragma once

#include <functional>
#include <set>
#include <vector>

#include "query/sampling/values.h"

namespace strata {
struct Camera;
}
namespace strata::mesh {
class SearchTree;
}

namespace strata::query {

// Which of several overlying layers a picture shows.

enum class Cover { nothing, some, all };  // how much a value hides of the layers below it

struct LayerCover {
  std::function<Cover(double value)> of;  // called by several threads
  bool tells_values = false;              // also collect which of its values are seen
};

struct SeenLayer {
  bool is_seen = false;
  std::set<double> values;
};

// For each layer (bottom to top), finds whether it is visible at the center of a cell of a grid
// over the camera's window: where it is drawn and no layer above covers it completely. `covers`:
// one for each layer.
std::vector<SeenLayer> seen_layers(const mesh::SearchTree& tree, const glm::dvec3& origin,
                                   const Camera& camera, int columns, int rows,
                                   const std::vector<LayerView>& layers,
                                   const std::vector<LayerCover>& covers);

}  // namespace strata::query
