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

// The truth of a condition for each bit pattern of a layer of one or two bytes: bit 0: it holds,
// bit 1: it is known.
struct TruthTable {
  std::vector<std::uint8_t> of_bits;
  std::uint8_t of_nothing = 0;  // where the layer has no value
};

// A formula in the form in which it is evaluated: the meaning of its Expression, in fewer steps.
//
// 1. Alternatives of one value, `a = 1 or a = 2 …` and so `a in (1, 2, …)`, become one look-up in a
//    set; `a <> 1 and a <> 2 …` becomes its negation. Chains of `or` and of `and` are flattened.
// 2. A condition that reads only one layer of one or two bytes may be evaluated once for each bit
//    pattern (`table`).
struct PlanNode {
  Expression::Op op = Expression::Op::number;
  double number = 0;
  std::size_t index = 0;                      // of records
  int source = -1;                            // of the layer that it reads
  std::shared_ptr<const NumberSet> set{};     // a condition: the only part is in this set
  std::shared_ptr<const TruthTable> table{};  // a condition: by the bits of the source
  std::vector<PlanNode> parts{};

  bool is_condition() const { return op >= Expression::Op::truth; }
};

struct EvaluationPlan {
  PlanNode root;
  std::vector<PlanSource> sources;
};

// Refused (invalid at `field`): a layer that is not in `layers`.
Result<EvaluationPlan> plan_evaluation(const Expression& expression,
                                       const std::vector<LayerView>& layers,
                                       const std::string& field);

// Returns the only source that the node reads; -1 if it reads several, none, or the texel's
// position.
int only_source(const PlanNode& node);

// The number of steps for one texel.
std::uint64_t steps_of(const PlanNode& node);

}  // namespace strata::query
