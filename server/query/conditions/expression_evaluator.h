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
  glm::dvec3 origin{0};  // origin of model space, in world coordinates
  double metres = 1;     // meters in one model unit
};

// A formula over layers, from split_records. `records` contains, by index, the numbers of its parts
// that read records.
struct BoundExpression {
  Expression expression;
  std::vector<RecordNumbers> records{};
};

// Returns the surface texels of the map where the condition is true. Gutter texels, and texels
// where the condition is unknown, are never included. For a layer with another resolution, the
// layer texel that contains the center of the map texel is used. Returns an `invalid` error at
// `field` for a layer that is not in `layers`. `within` restricts the evaluation to these texels;
// null means all texels. Runs on up to `threads` threads. Throws QuestionEnded before the
// evaluation begins if the cost exceeds the limit of the current question
// (domain/people/question.h).
Result<TexelSelection> select_where(const BoundExpression& condition,
                                    const std::vector<LayerView>& layers,
                                    const mesh::SurfaceMap& map, const std::string& field,
                                    int threads = 2, const Frame& frame = {},
                                    const TexelSelection* within = nullptr);

// Computes the content of a layer of `type` with the resolution of the map. Each surface texel gets
// the value of the formula, or no value where the formula is unknown. For a condition, the value is
// 1 where the condition is true; other texels have no value. Values of integer types are rounded to
// the nearest integer. Gutter texels copy surface texels. Returns the errors of select_where, and
// an `invalid` error at `type` for a number that the type cannot hold.
Result<TileMap> compute_tiles(const BoundExpression& expression,
                              const std::vector<LayerView>& layers, const mesh::SurfaceMap& map,
                              const Frame& frame, ValueType type, const std::string& field,
                              int threads = 2);

}  // namespace strata::query
