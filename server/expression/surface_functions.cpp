#include "expression/surface_functions.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace strata::query {
namespace {

class Separator {
 public:
  explicit Separator(const std::string& field) : field_(field) {}

  Result<SurfaceFormula> separate(Expression expression) {
    formula_.expression = rewrite(std::move(expression));
    if (problem_) return tl::unexpected(*problem_);
    return std::move(formula_);
  }

 private:
  Expression rewrite(Expression e) {
    for (Expression& part : e.parts) part = rewrite(std::move(part));
    if (!e.is_surface_function()) return e;
    Expression layer;
    layer.op = Expression::Op::layer;
    layer.position = e.position;
    layer.name = slug_of(std::move(e));
    return layer;
  }

  std::string slug_of(Expression function) {
    auto& functions = formula_.functions;
    const auto same = std::ranges::find(functions, function, &SurfaceFormula::Function::function);
    if (same != functions.end()) return same->slug;
    if (functions.size() == kMaxSurfaceFunctions) {
      if (!problem_)
        problem_ = expression_problem(
            "This expression has more than " + std::to_string(kMaxSurfaceFunctions) +
                " functions along the surface: compute a layer from some of them first",
            function.position, field_, mistake::kTooLarge);
      return {};
    }
    functions.push_back({std::string(kSurfaceFunctionPrefix) + std::to_string(functions.size() + 1),
                         std::move(function)});
    return functions.back().slug;
  }

  const std::string& field_;
  SurfaceFormula formula_;
  std::optional<Error> problem_;
};

}  // namespace

Result<SurfaceFormula> separate_surface_functions(const Expression& expression,
                                                  const std::string& field) {
  return Separator(field).separate(expression);
}

Error surface_function_problem(const Expression& function, const std::string& field) {
  return expression_problem(
      "This function along the surface works in computed layers only: create a computed layer "
      "with it and use that layer here",
      function.position, field, mistake::kComputedLayersOnly);
}

}  // namespace strata::query
