#pragma once

#include <glm/glm.hpp>

#include "core/error.h"
#include "expression/expression.h"
#include "expression/record_parts.h"
#include "mesh/texels/surface_map.h"
#include "query/conditions/texel_selection.h"
#include "query/sampling/values.h"

namespace strata::query {

// The coordinate frame of a map's texels.
struct Frame {
  glm::dvec3 origin{0};  // of model space in the world
  double metres = 1;     // of a model unit
};

// A formula over layers from split_records, and the numbers of its parts over records, by their
// index.
struct BoundExpression {
  Expression expression;
  std::vector<RecordNumbers> records{};
};

// Returns the surface texels of the map where the condition holds (never gutter texels, nor texels
// where it is unknown). For a layer of another resolution, the texel that contains the center of
// the map's texel counts. Refused (invalid at `field`): a layer that is not in `layers`. `within`:
// restricts the evaluation to these texels; null: all. Runs on up to `threads` threads. If the cost
// exceeds the limit of the current question (domain/people/question.h), it throws QuestionEnded
// before it begins.
Result<TexelSelection> select_where(const BoundExpression& condition,
                                    const std::vector<LayerView>& layers,
                                    const mesh::SurfaceMap& map, const std::string& field,
                                    int threads = 2, const Frame& frame = {},
                                    const TexelSelection* within = nullptr);

// Computes the content of a layer of `type` at the map's resolution: the value of the formula at
// each surface texel, nothing where it is unknown. A condition is 1 where it holds, and nothing
// elsewhere. Integer types get the nearest integer. Gutter texels follow their owners. Refused as
// above, and for a number that the type cannot hold (invalid, `type`).
Result<TileMap> compute_tiles(const BoundExpression& expression,
                              const std::vector<LayerView>& layers, const mesh::SurfaceMap& map,
                              const Frame& frame, ValueType type, const std::string& field,
                              int threads = 2);

}  // namespace strata::query
