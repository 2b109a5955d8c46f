#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "expression/expression.h"
#include "query/conditions/number_set.h"
#include "query/conditions/tile_table.h"
#include "query/sampling/values.h"

namespace strata::query {

// A layer that a formula reads.
struct PlanSource {
  TileTable tiles;
  ValueType type;
  int resolution;
};

// The truth of a condition for each bit pattern of a layer with one or two bytes per texel. Bit 0
// is set where the condition is true, bit 1 where its truth is known.
struct TruthTable {
  std::vector<std::uint8_t> of_bits;
  std::uint8_t of_nothing = 0;  // truth for texels where the layer has no value
};

// A formula in its evaluated form. It is equivalent to its Expression but has fewer steps.
//
// 1. Several comparisons of one value, `a = 1 or a = 2 …` or `a in (1, 2, …)`, become one lookup in
//    a set. `a <> 1 and a <> 2 …` becomes the negation of a lookup. Chains of `or` and of `and` are
//    flattened.
// 2. A condition that reads only one layer, with one or two bytes per texel, may be evaluated once
//    for each bit pattern (`table`).
struct PlanNode {
  Expression::Op op = Expression::Op::number;
  double number = 0;
  std::size_t index = 0;                      // index of the numbers of records
  int source = -1;                            // index of the layer in `sources`
  std::shared_ptr<const NumberSet> set{};     // condition: true if its part's value is in it
  std::shared_ptr<const TruthTable> table{};  // for a condition: truth by the bits of the source
  std::vector<PlanNode> parts{};

  bool is_condition() const { return op >= Expression::Op::truth; }
};

struct EvaluationPlan {
  PlanNode root;
  std::vector<PlanSource> sources;
};

// Returns an `invalid` error at `field` for a layer that is not in `layers`.
Result<EvaluationPlan> plan_evaluation(const Expression& expression,
                                       const std::vector<LayerView>& layers,
                                       const std::string& field);

// Returns the index of the only source that the node reads. Returns -1 if the node reads several
// sources, no source, or the position of the texel.
int only_source(const PlanNode& node);

// Returns the number of steps for one texel.
std::uint64_t steps_of(const PlanNode& node);

}  // namespace strata::query
