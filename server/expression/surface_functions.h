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
// Of hot_spot_chance.
constexpr int kMinPermutations = 99, kDefaultPermutations = 999, kMaxPermutations = 9999;

struct NamedSurfaceFunction {
  Expression::Op op;
  std::string_view name;
  // The first argument. The result of a clean-up is a condition if the argument is one.
  enum class Argument { number, condition, either } argument = Argument::number;
  // The second argument: whether it exists, its name, and whose unit it has.
  enum class Limit { none, optional, needed } limit = Limit::needed;
  std::string_view limit_name = "distance", limit_unit = "model";
};
inline constexpr std::array kSurfaceFunctions{
    NamedSurfaceFunction{.op = Expression::Op::distance,
                         .name = "distance",
                         .argument = NamedSurfaceFunction::Argument::condition,
                         .limit = NamedSurfaceFunction::Limit::optional},
    NamedSurfaceFunction{.op = Expression::Op::nearest,
                         .name = "nearest",
                         .limit = NamedSurfaceFunction::Limit::optional},
    NamedSurfaceFunction{.op = Expression::Op::focal_mean, .name = "focal_mean"},
    NamedSurfaceFunction{.op = Expression::Op::focal_min, .name = "focal_min"},
    NamedSurfaceFunction{.op = Expression::Op::focal_max, .name = "focal_max"},
    NamedSurfaceFunction{.op = Expression::Op::focal_variety, .name = "focal_variety"},
    NamedSurfaceFunction{.op = Expression::Op::hot_spot, .name = "hot_spot"},
    NamedSurfaceFunction{.op = Expression::Op::hot_spot_chance, .name = "hot_spot_chance"},
    NamedSurfaceFunction{.op = Expression::Op::valley, .name = "valley", .limit_name = "width"},
    NamedSurfaceFunction{.op = Expression::Op::ridge, .name = "ridge", .limit_name = "width"},
    NamedSurfaceFunction{.op = Expression::Op::watershed,
                         .name = "watershed",
                         .limit_name = "height",
                         .limit_unit = "layer"},
    NamedSurfaceFunction{.op = Expression::Op::run_off,
                         .name = "run_off",
                         .limit = NamedSurfaceFunction::Limit::none},
    NamedSurfaceFunction{.op = Expression::Op::sieve,
                         .name = "sieve",
                         .argument = NamedSurfaceFunction::Argument::either,
                         .limit_name = "area",
                         .limit_unit = "model, squared"},
    NamedSurfaceFunction{.op = Expression::Op::fill_holes,
                         .name = "fill_holes",
                         .argument = NamedSurfaceFunction::Argument::either,
                         .limit_name = "area",
                         .limit_unit = "model, squared"},
    NamedSurfaceFunction{.op = Expression::Op::majority,
                         .name = "majority",
                         .argument = NamedSurfaceFunction::Argument::either},
    NamedSurfaceFunction{.op = Expression::Op::opening,
                         .name = "opening",
                         .argument = NamedSurfaceFunction::Argument::condition,
                         .limit_name = "width"},
    NamedSurfaceFunction{.op = Expression::Op::closing,
                         .name = "closing",
                         .argument = NamedSurfaceFunction::Argument::condition,
                         .limit_name = "width"},
    NamedSurfaceFunction{.op = Expression::Op::interpolated, .name = "interpolated"},
    NamedSurfaceFunction{.op = Expression::Op::interpolation_error, .name = "interpolation_error"}};

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
