#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "expression/expression.h"

namespace strata::query {

// Functions that depend on the surface around a texel. They are computed for all texels at once,
// before the formula is evaluated, and only for computed layers.
constexpr std::size_t kMaxSurfaceFunctions = 8;  // in one formula

struct NamedSurfaceFunction {
  Expression::Op op;
  std::string_view name;
  // The second argument: whether it exists, its name, and whose unit it has.
  enum class Limit { none, optional, needed } limit = Limit::needed;
  std::string_view limit_name = "distance", limit_unit = "model";
};
inline constexpr std::array kSurfaceFunctions{
    NamedSurfaceFunction{Expression::Op::distance, "distance",
                         NamedSurfaceFunction::Limit::optional},
    NamedSurfaceFunction{Expression::Op::nearest, "nearest", NamedSurfaceFunction::Limit::optional},
    NamedSurfaceFunction{Expression::Op::focal_mean, "focal_mean"},
    NamedSurfaceFunction{Expression::Op::focal_min, "focal_min"},
    NamedSurfaceFunction{Expression::Op::focal_max, "focal_max"},
    NamedSurfaceFunction{Expression::Op::focal_variety, "focal_variety"},
    NamedSurfaceFunction{Expression::Op::hot_spot, "hot_spot"},
    NamedSurfaceFunction{Expression::Op::valley, "valley", NamedSurfaceFunction::Limit::needed,
                         "width"},
    NamedSurfaceFunction{Expression::Op::ridge, "ridge", NamedSurfaceFunction::Limit::needed,
                         "width"},
    NamedSurfaceFunction{Expression::Op::watershed, "watershed",
                         NamedSurfaceFunction::Limit::needed, "height", "layer"},
    NamedSurfaceFunction{Expression::Op::run_off, "run_off", NamedSurfaceFunction::Limit::none},
    NamedSurfaceFunction{Expression::Op::interpolated, "interpolated"},
    NamedSurfaceFunction{Expression::Op::interpolation_error, "interpolation_error"}};

// The slugs of the layers that take the place of functions begin with this text.
inline constexpr std::string_view kSurfaceFunctionPrefix = "surface.function.";

// A formula in which layers take the place of the functions along the surface.
struct SurfaceFormula {
  struct Function {
    std::string slug;     // of the layer with the values of the function
    Expression function;  // its part reads only layers of earlier functions
  };
  Expression expression;
  std::vector<Function> functions;  // equal functions occur once
};
// Returns an `invalid` error at `field` for a formula with more than kMaxSurfaceFunctions different
// functions.
Result<SurfaceFormula> separate_surface_functions(const Expression& expression,
                                                  const std::string& field);

// Returns the error for a function along the surface that is not in a computed layer.
Error surface_function_problem(const Expression& function, const std::string& field);

}  // namespace strata::query
