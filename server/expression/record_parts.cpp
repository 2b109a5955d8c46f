#include "expression/record_parts.h"

#include <algorithm>

#include "expression/surface_functions.h"

namespace strata::query {
namespace {

using Op = Expression::Op;

constexpr std::uint32_t kMaxDense = 1u << 16;  // most keys are consecutive; at most 0.5 MiB

// Returns the only layer whose records the expression reads. Returns null if the expression reads
// the values of a layer, or the records of several layers.
const std::string* only_record(const Expression& e) {
  const std::string* found = nullptr;
  if (e.op == Op::layer || e.op == Op::valid || has_surface_function(e)) return nullptr;
  if (e.is_column()) return &e.name;
  for (const Expression& part : e.parts) {
    if (layers_of(part).empty()) continue;
    const std::string* layer = only_record(part);
    if (layer == nullptr || (found != nullptr && *found != *layer)) return nullptr;
    found = layer;
  }
  return found;
}

// Rewrites the expression so that it reads the columns of the record directly.
Expression over_columns(Expression e) {
  e.name.clear();
  for (Expression& part : e.parts) part = over_columns(std::move(part));
  return e;
}

class Splitter {
 public:
  explicit Splitter(const std::string& field) : field_(field) {}

  Result<SplitExpression> split(const Expression& e) {
    Expression rest = rewrite(e);
    if (problem_) return tl::unexpected(*problem_);
    return SplitExpression{std::move(rest), std::move(parts_)};
  }

 private:
  Expression rewrite(const Expression& e) {
    if (e.is_surface_function()) {
      if (!problem_) problem_ = surface_function_problem(e, field_);
      return {};
    }
    if (const std::string* layer = only_record(e)) return part(e, *layer);
    const bool of_records =
        e.is_text() || e.op == Op::keys || (e.op >= Op::like && !is_logic(e.op));
    if (of_records ||
        std::ranges::any_of(e.parts, [](const Expression& part) { return part.is_text(); })) {
      if (!problem_)
        problem_ = expression_problem(
            "Texts and times can be compared within one record only: compare one of its "
            "columns with a text",
            e.position, field_, mistake::kWrongType);
      return {};
    }
    Expression rest = e;
    for (Expression& each : rest.parts) each = rewrite(each);
    return rest;
  }

  static bool is_logic(Op op) { return op == Op::all || op == Op::any || op == Op::negation; }

  Expression part(const Expression& e, const std::string& layer) {
    RecordPart requested{layer, over_columns(e)};
    const auto found = std::find(parts_.begin(), parts_.end(), requested);
    Expression rest;
    rest.op = e.is_condition() ? Op::record_truth : Op::record_number;
    rest.name = layer;
    rest.index = static_cast<std::size_t>(found - parts_.begin());
    rest.position = e.position;
    if (found == parts_.end()) parts_.push_back(std::move(requested));
    return rest;
  }

  const std::string& field_;
  std::vector<RecordPart> parts_;
  std::optional<Error> problem_;
};

}  // namespace

Result<SplitExpression> split_records(const Expression& expression, const std::string& field) {
  return Splitter(field).split(expression);
}

RecordNumbers::RecordNumbers(const std::vector<KeyNumber>& numbers) {
  std::uint32_t last = 0;
  for (const KeyNumber& each : numbers)
    if (each.key < kMaxDense) last = std::max(last, each.key + 1);
  dense_.assign(last, kUnknown);
  for (const KeyNumber& each : numbers)
    if (each.key < kMaxDense)
      dense_[each.key] = each.number;
    else
      sparse_.push_back(each);
  std::ranges::sort(sparse_, {}, &KeyNumber::key);
}

double RecordNumbers::look_up(std::uint32_t key) const {
  const auto found = std::ranges::lower_bound(sparse_, key, {}, &KeyNumber::key);
  return found != sparse_.end() && found->key == key ? found->number : kUnknown;
}

}  // namespace strata::query
