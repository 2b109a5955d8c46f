#pragma once

#include <functional>
#include <set>
#include <vector>

#include "domain/scene/camera.h"
#include "mesh/surface/search_tree.h"
#include "query/sampling/values.h"

namespace strata::query {

// What a picture shows of layers that lie over each other.

enum class Cover { nothing, some, all };  // how much of what lies below a value is drawn over

struct LayerCover {
  std::function<Cover(double value)> of;  // called by several threads
  bool tells_values = false;              // which of its values are seen is asked, too
};

struct SeenLayer {
  bool is_seen = false;
  std::set<double> values;
};

// Of each layer (bottom to top) what is seen in the middle of some cell of a grid over the camera's
// window: where it is drawn and no layer above it covers it wholly. `covers`: one for each layer.
std::vector<SeenLayer> seen_layers(const mesh::SearchTree& tree, const glm::dvec3& origin,
                                   const Camera& camera, int columns, int rows,
                                   const std::vector<LayerView>& layers,
                                   const std::vector<LayerCover>& covers);

}  // namespace strata::query
