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

// The layers that are visible where several layers overlap.

enum class Cover { nothing, some, all };  // how much a value hides of the layers below it

struct LayerCover {
  std::function<Cover(double value)> of;  // called on several threads
  bool tells_values = false;              // true: also collect its visible values
};

struct SeenLayer {
  bool is_seen = false;
  std::set<double> values;
};

// Finds, for each layer from bottom to top, whether it is visible in the window of the camera. The
// window is divided by a grid, and the centers of its cells are tested. A layer is visible where it
// is drawn and no layer above covers it completely. `covers` has one element for each layer.
std::vector<SeenLayer> seen_layers(const mesh::SearchTree& tree, const glm::dvec3& origin,
                                   const Camera& camera, int columns, int rows,
                                   const std::vector<LayerView>& layers,
                                   const std::vector<LayerCover>& covers);

// Adds the layers that are visible at a texture coordinate to `seen`, which has one element for
// each layer.
void see_point(glm::vec2 uv, const std::vector<LayerView>& layers,
               const std::vector<LayerCover>& covers, std::vector<SeenLayer>& seen);
void merge(std::vector<SeenLayer>& all, std::vector<SeenLayer>&& seen);

}  // namespace strata::query
