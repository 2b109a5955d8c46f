#include "expression/expression.h"

#include <algorithm>

namespace strata {
namespace {

void collect(const Expression& expression, std::vector<std::string>& layers) {
  if (!expression.name.empty() &&
      std::find(layers.begin(), layers.end(), expression.name) == layers.end())
    layers.push_back(expression.name);
  for (const Expression& part : expression.parts) collect(part, layers);
}

}  // namespace

Error expression_problem(const std::string& what, Expression::Position position,
                         const std::string& field, std::string_view reason,
                         std::vector<std::string> suggestions) {
  Error problem{ErrorCode::invalid, "Invalid expression",
                what + " (at character " + std::to_string(position.at + 1) + ").", field};
  problem.offset = position.at;
  problem.length = position.length;
  problem.suggestions = std::move(suggestions);
  problem.reason = reason;
  return problem;
}

std::vector<std::string> layers_of(const Expression& expression) {
  std::vector<std::string> layers;
  collect(expression, layers);
  return layers;
}

bool reads_records(const Expression& expression) {
  return expression.is_column() || std::ranges::any_of(expression.parts, reads_records);
}

bool has_surface_function(const Expression& expression) {
  return expression.is_surface_function() ||
         std::ranges::any_of(expression.parts, has_surface_function);
}

}  // namespace strata
