#include "app/layers/formula_limits.h"

#include <utility>

#include "domain/scene/model_measures.h"
#include "query/regions/neighborhood_limits.h"

namespace strata::app {
namespace {

constexpr const char* kField = "expression";

Result<void> check_function(const Expression& function, double texel_size, double metres_per_unit) {
  using Op = Expression::Op;
  switch (function.op) {
    case Op::focal_mean:
    case Op::focal_min:
    case Op::focal_max:
    case Op::focal_variety:
    case Op::hot_spot:
    case Op::hot_spot_chance: return query::check_focal_radius(function.number, texel_size, kField);
    case Op::valley:
    case Op::ridge: return query::check_line_width(function.number, texel_size, kField);
    case Op::interpolated:
    case Op::interpolation_error:
      return query::check_interpolation_range(function.number, texel_size, kField);
    case Op::majority:
      return query::check_majority_radius(function.number, texel_size, metres_per_unit);
    default: return {};
  }
}

Result<void> check_all(const Expression& expression, double texel_size, double metres_per_unit) {
  for (const Expression& part : expression.parts)
    STRATA_TRY(check_all(part, texel_size, metres_per_unit));
  auto checked = check_function(expression, texel_size, metres_per_unit);
  if (checked) return {};
  Error problem = std::move(checked.error());
  problem.field = kField;
  problem.offset = expression.position.at;
  problem.length = expression.position.length;
  return tl::unexpected(std::move(problem));
}

}  // namespace

Result<void> check_formula_limits(const Expression& expression, const Model& model,
                                  int resolution) {
  const auto texel_size = reported_texel_size(model.atlas, resolution);
  return texel_size ? check_all(expression, *texel_size, model.metres()) : Result<void>{};
}

}  // namespace strata::app
