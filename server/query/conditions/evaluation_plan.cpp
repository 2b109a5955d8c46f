#include "query/conditions/evaluation_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace strata::query {
namespace {

using Op = Expression::Op;

// With fewer numbers, comparisons are as fast as a lookup in a set.
constexpr std::size_t kMin = 3;

// Collects the operands of a chain of one operator, at any depth of nesting.
void flatten(const Expression& e, Op op, std::vector<const Expression*>& parts) {
  for (const Expression& part : e.parts) {
    if (part.op == op)
      flatten(part, op, parts);
    else
      parts.push_back(&part);
  }
}

// A comparison of a value with a number, which may be on either side of the operator.
struct Compared {
  const Expression* value = nullptr;
  double number = 0;
};
Compared compared_with_number(const Expression& e, Op op) {
  if (e.op != op || e.parts.size() != 2) return {};
  const auto is_number = [](const Expression& part) {
    return part.op == Op::number && std::isfinite(part.number);
  };
  if (is_number(e.parts[1])) return {&e.parts[0], e.parts[1].number};
  if (is_number(e.parts[0])) return {&e.parts[1], e.parts[0].number};
  return {};
}

class Planner {
 public:
  explicit Planner(const std::vector<std::string>& slugs) : slugs_(slugs) {}

  PlanNode plan(const Expression& e) const {
    if (e.op == Op::any || e.op == Op::all) return chain(e);
    PlanNode node;
    node.op = e.op;
    node.number = e.number;
    node.index = e.index;
    if (!e.name.empty())
      node.source = static_cast<int>(std::ranges::find(slugs_, e.name) - slugs_.begin());
    for (const Expression& part : e.parts) node.parts.push_back(plan(part));
    return node;
  }

 private:
  PlanNode chain(const Expression& e) const {
    struct Group {
      const Expression* value;
      std::vector<const Expression*> members;
      std::vector<double> numbers;
    };
    std::vector<const Expression*> parts, others;
    flatten(e, e.op, parts);
    std::vector<Group> groups;
    for (const Expression* part : parts) {
      const Compared compared =
          compared_with_number(*part, e.op == Op::any ? Op::equal : Op::not_equal);
      if (compared.value == nullptr) {
        others.push_back(part);
        continue;
      }
      auto group =
          std::ranges::find_if(groups, [&](const Group& g) { return *g.value == *compared.value; });
      if (group == groups.end()) group = groups.insert(groups.end(), {compared.value, {}, {}});
      group->members.push_back(part);
      group->numbers.push_back(compared.number);
    }
    PlanNode node;
    node.op = e.op;
    for (const Group& group : groups) {
      if (group.members.size() < kMin) {
        others.insert(others.end(), group.members.begin(), group.members.end());
        continue;
      }
      PlanNode among;
      among.op = Op::equal;
      among.set = std::make_shared<const NumberSet>(group.numbers);
      among.parts.push_back(plan(*group.value));
      if (e.op == Op::all) {
        PlanNode none;
        none.op = Op::negation;
        none.parts.push_back(std::move(among));
        among = std::move(none);
      }
      node.parts.push_back(std::move(among));
    }
    for (const Expression* other : others) node.parts.push_back(plan(*other));
    return node;
  }

  const std::vector<std::string>& slugs_;
};

constexpr int kNoSource = -1, kNoOneSource = -2;

// Returns the only source that the node reads, kNoSource if it reads no source, or kNoOneSource if
// it reads several sources or the position.
int source_read(const PlanNode& node) {
  switch (node.op) {
    case Op::x:
    case Op::y:
    case Op::z:
    case Op::area: return kNoOneSource;
    default: break;
  }
  int found = node.source;
  for (const PlanNode& part : node.parts) {
    const int source = source_read(part);
    if (source == kNoOneSource || (source >= 0 && found >= 0 && source != found))
      return kNoOneSource;
    if (source >= 0) found = source;
  }
  return found;
}

}  // namespace

Result<EvaluationPlan> plan_evaluation(const Expression& expression,
                                       const std::vector<LayerView>& layers,
                                       const std::string& field) {
  const std::vector<std::string> slugs = layers_of(expression);
  EvaluationPlan plan;
  for (const std::string& slug : slugs) {
    const auto found = std::find_if(layers.begin(), layers.end(),
                                    [&](const auto& v) { return v.layer.slug == slug; });
    if (found == layers.end())
      return fail(ErrorCode::invalid, "Invalid expression",
                  "This model has no layer '" + slug +
                      "'. Use the slug of a layer, and write spaces around a minus sign.",
                  field);
    const Layer& layer = found->layer;
    plan.sources.push_back(
        {TileTable(found->snapshot.tiles, layer.resolution), layer.type, layer.resolution});
  }
  plan.root = Planner(slugs).plan(expression);
  return plan;
}

int only_source(const PlanNode& node) { return std::max(source_read(node), kNoSource); }

std::uint64_t steps_of(const PlanNode& node) {
  if (node.table) return 1;
  std::uint64_t steps = 1;
  for (const PlanNode& part : node.parts) steps += steps_of(part);
  return steps;
}

}  // namespace strata::query
