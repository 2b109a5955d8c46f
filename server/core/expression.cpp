#include "core/expression.h"

#include <algorithm>

namespace strata {
namespace {

void collect(const Expression& expression, std::vector<std::string>& layers) {
  if (!expression.layer.empty() && std::find(layers.begin(), layers.end(), expression.layer) == layers.end())
    layers.push_back(expression.layer);
  for (const Expression& part : expression.parts) collect(part, layers);
}

}  // namespace

std::vector<std::string> layers_of(const Expression& expression) {
  std::vector<std::string> layers;
  collect(expression, layers);
  return layers;
}

}  // namespace strata
