#pragma once

#include <glm/glm.hpp>

#include "core/error.h"
#include "expression/expression.h"
#include "expression/record_parts.h"
#include "query/conditions/texel_selection.h"
#include "query/sampling/values.h"

namespace strata::query {

// Where the texels of a map lie.
struct Frame {
  glm::dvec3 origin{0};  // of model space in the world
  double metres = 1;     // of a model unit
};

// A formula over layers as split_records leaves it, and what its parts over records are, by their
// index.
struct BoundExpression {
  Expression expression;
  std::vector<RecordNumbers> records{};
};

// The surface texels of the map where the condition holds (never gutter texels, and none where it
// is unknown). A layer of another resolution counts by the texel that holds the centre of the map's
// texel. Refused (invalid at `field`): a layer that is not among `layers`. `within`: only these are
// looked at; null: all. Runs on up to `threads` threads, and may cost the current question
// (domain/people/question.h) more than it may (QuestionEnded), which is known before it begins.
Result<TexelSelection> select_where(const BoundExpression& condition,
                                    const std::vector<LayerView>& layers,
                                    const mesh::SurfaceMap& map, const std::string& field,
                                    int threads = 2, const Frame& frame = {},
                                    const TexelSelection* within = nullptr);

// The content of a layer of `type` at the map's resolution: at each surface texel what the formula
// is there, nothing where it is unknown; a condition is 1 where it holds, and nothing elsewhere.
// Types of whole numbers get the nearest one. Gutter texels follow their owners. Refused as above,
// and a number that the type does not hold (invalid, `type`).
Result<TileMap> compute_tiles(const BoundExpression& expression,
                              const std::vector<LayerView>& layers, const mesh::SurfaceMap& map,
                              const Frame& frame, ValueType type, const std::string& field,
                              int threads = 2);

}  // namespace strata::query
