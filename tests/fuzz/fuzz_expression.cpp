// Fuzzes a formula over layers. The text made from an expression must parse to the same expression.
// A condition must select only texels of the surface.
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include "expression/expression_parser.h"
#include "expression/surface_functions.h"
#include "query/conditions/expression_evaluator.h"

namespace {

using strata::Expression;
using Op = Expression::Op;

void demand(bool holds) {
  if (!holds) std::abort();
}

std::string text_of(const Expression& expression);

std::string call(const char* function, const Expression& expression) {
  std::string text = std::string(function) + "(";
  for (const auto& part : expression.parts)
    text += (&part == expression.parts.data() ? "" : ", ") + text_of(part);
  return text + ")";
}

// Returns a call of a function along the surface.
std::string with_limit(const char* function, const Expression& expression) {
  std::string text = call(function, expression);
  if (std::isinf(expression.number)) return text;
  Expression limit;
  limit.number = expression.number;
  text.back() = ',';
  return text + " " + text_of(limit) + ")";
}

// Returns a call of hysteresis, whose thresholds can be negative.
std::string hysteresis(const Expression& function) {
  std::string text = "hysteresis(" + text_of(function.parts.at(0));
  for (const double threshold : {function.parts.at(1).number, function.number}) {
    char number[40];
    text += ", ";
    text.append(number, std::to_chars(number, number + sizeof number, threshold).ptr);
  }
  return text + ")";
}

bool is_condition_in_text(const Expression& function) {
  return function.op == Op::hysteresis || (function.op >= Op::sieve && function.op <= Op::closing &&
                                           function.parts.at(0).is_condition());
}

std::string hot_spot_chance(const Expression& function) {
  Expression radius;
  radius.number = function.number;
  return "hot_spot_chance(" + text_of(function.parts.at(0)) + ", " + text_of(radius) + ", " +
         text_of(function.parts.at(1)) + ")";
}

std::string joined(const char* word, const Expression& expression) {
  // `a in (1)` has the same text as `a = 1`.
  if (expression.parts.size() == 1) return text_of(expression.parts[0]);
  std::string text;
  for (const auto& part : expression.parts)
    text += (text.empty() ? "(" : std::string(" ") + word + " ") + text_of(part);
  return text + ")";
}

std::string quoted(const std::string& text) {
  std::string all = "'";
  for (const char c : text) all += c == '\'' ? "''" : std::string(1, c);
  return all + "'";
}

std::string named(const Expression& expression) {
  std::string text = expression.name.empty() ? "" : '"' + expression.name + '"';
  for (const auto& column : expression.path) text += (text.empty() ? "\"" : ".\"") + column + '"';
  return text;
}

std::string text_of(const Expression& expression) {
  const auto part = [&] { return text_of(expression.parts.at(0)); };
  switch (expression.op) {
    case Op::number: {
      if (std::isnan(expression.number)) return "null";
      demand(std::isfinite(expression.number) && !std::signbit(expression.number));
      char text[40];
      return {text, std::to_chars(text, text + sizeof text, expression.number).ptr};
    }
    case Op::layer:
    case Op::column: return named(expression);
    case Op::text: return quoted(expression.text);
    case Op::keys: return call("", expression);
    case Op::distance: return with_limit("distance", expression);
    case Op::nearest: return with_limit("nearest", expression);
    case Op::focal_mean: return with_limit("focal_mean", expression);
    case Op::focal_min: return with_limit("focal_min", expression);
    case Op::focal_max: return with_limit("focal_max", expression);
    case Op::focal_variety: return with_limit("focal_variety", expression);
    case Op::hot_spot: return with_limit("hot_spot", expression);
    case Op::hot_spot_chance: return hot_spot_chance(expression);
    case Op::watershed: return with_limit("watershed", expression);
    case Op::run_off: return call("run_off", expression);
    case Op::valley: return with_limit("valley", expression);
    case Op::ridge: return with_limit("ridge", expression);
    case Op::hysteresis: return hysteresis(expression);
    case Op::sieve: return with_limit("sieve", expression);
    case Op::fill_holes: return with_limit("fill_holes", expression);
    case Op::majority: return with_limit("majority", expression);
    case Op::opening: return with_limit("opening", expression);
    case Op::closing: return with_limit("closing", expression);
    case Op::interpolated: return with_limit("interpolated", expression);
    case Op::interpolation_error: return with_limit("interpolation_error", expression);
    case Op::add: return joined("+", expression);
    case Op::subtract: return joined("-", expression);
    case Op::multiply: return joined("*", expression);
    case Op::divide: return joined("/", expression);
    case Op::remainder: return joined("%", expression);
    case Op::whole_division: return joined("div", expression);
    case Op::power: return joined("^", expression);
    case Op::negate: return "(-" + part() + ")";
    case Op::absolute: return call("abs", expression);
    case Op::least: return call("min", expression);
    case Op::greatest: return call("max", expression);
    case Op::square_root: return call("sqrt", expression);
    case Op::exponential: return call("exp", expression);
    case Op::natural_log: return call("ln", expression);
    case Op::decimal_log: return call("log10", expression);
    case Op::floor: return call("floor", expression);
    case Op::ceiling: return call("ceil", expression);
    case Op::round: return call("round", expression);
    case Op::sine: return call("sin", expression);
    case Op::cosine: return call("cos", expression);
    case Op::tangent: return call("tan", expression);
    case Op::arc_sine: return call("asin", expression);
    case Op::arc_cosine: return call("acos", expression);
    case Op::arc_tangent: return call("atan", expression);
    case Op::radians: return call("radians", expression);
    case Op::degrees: return call("degrees", expression);
    case Op::choose: return call("if", expression);
    case Op::fold_case: return call("casei", expression);
    case Op::fold_accents: return call("accenti", expression);
    case Op::truth: return expression.number == 1 ? "true" : "false";
    case Op::valid: return "valid(" + named(expression) + ")";
    case Op::known:
      // The function alone is a condition in the text.
      if (is_condition_in_text(expression.parts.at(0))) return part();
      return "(" + part() + " is not null)";
    case Op::holds: return "(" + part() + " = true)";
    case Op::less: return joined("<", expression);
    case Op::less_equal: return joined("<=", expression);
    case Op::greater: return joined(">", expression);
    case Op::greater_equal: return joined(">=", expression);
    case Op::equal: return joined("=", expression);
    case Op::not_equal: return joined("<>", expression);
    case Op::like: return joined("like", expression);
    case Op::before: return call("t_before", expression);
    case Op::after: return call("t_after", expression);
    case Op::during: return call("t_during", expression);
    case Op::contains: return call("t_contains", expression);
    case Op::intersects: return call("t_intersects", expression);
    case Op::disjoint: return call("t_disjoint", expression);
    case Op::coincides: return call("t_equals", expression);
    case Op::has_all: return call("a_contains", expression);
    case Op::has_any: return call("a_overlaps", expression);
    case Op::has_only: return call("a_containedby", expression);
    case Op::has_exactly: return call("a_equals", expression);
    case Op::all: return joined("and", expression);
    case Op::any: return joined("or", expression);
    case Op::negation: return "(not " + part() + ")";
    case Op::x:
    case Op::y:
    case Op::z:
    case Op::area:
    case Op::record_number:
    case Op::record_truth: break;
  }
  std::abort();
}

// Returns whether the generated text exceeds a limit. That is not a fault, because the text has
// more brackets than the original text.
bool is_beyond_limits(const strata::Error& problem) {
  return problem.title == "Expression too long" ||
         problem.detail.find("nested too deeply") != std::string::npos ||
         problem.detail.find("too many parts") != std::string::npos;
}

// Returns a surface map with one block of surface.
strata::mesh::SurfaceMap one_block() {
  strata::mesh::SurfaceMap map;
  map.resolution = strata::kTileSize;
  map.blocks_per_side = strata::kTileSize / strata::kBlockSize;
  map.slot_of_block.assign(static_cast<std::size_t>(map.blocks_per_side * map.blocks_per_side),
                           strata::mesh::kNoSlot);
  map.slot_of_block[0] = 0;
  map.block_of_slot = {0};
  map.surface_mask = {~std::uint64_t{1}};
  return map;
}

// Returns a layer of negative and positive values with gaps.
strata::query::LayerView layer(const std::string& slug) {
  strata::query::LayerView view;
  view.layer.slug = slug;
  view.layer.type = strata::ValueType::i8;
  view.layer.resolution = strata::kTileSize;
  auto tile = std::make_shared<strata::TileData>(view.layer.type);
  for (int i = 0; i < strata::kTexelsPerTile; i += 3)
    tile->write(i, static_cast<std::uint8_t>(i % 16 - 8));
  view.snapshot.tiles[{0, 0}] = tile;
  return view;
}

void evaluate_parts(const Expression& condition);

// Evaluates a condition, and the conditions in its functions along the surface. The functions
// themselves have any values.
void evaluate(const Expression& condition) {
  const auto formula = strata::query::separate_surface_functions(condition, "where");
  demand(formula || formula.error().reason == strata::mistake::kTooLarge);
  if (!formula) return;
  demand(formula->functions.empty() || !strata::query::split_records(condition, "where"));
  for (const auto& each : formula->functions)
    if (each.function.parts.front().is_condition()) evaluate_parts(each.function.parts.front());
  evaluate_parts(formula->expression);
}

void evaluate_parts(const Expression& condition) {
  static const strata::mesh::SurfaceMap map = one_block();
  const auto split = strata::query::split_records(condition, "where");
  if (!split) return;
  strata::query::BoundExpression bound{split->expression, {}};
  for (std::size_t part = 0; part < split->parts.size(); ++part)
    bound.records.emplace_back(
        std::vector<strata::KeyNumber>{{1, 0}, {3, static_cast<double>(part)}, {1u << 20, 1}});
  std::vector<strata::query::LayerView> layers;
  for (const auto& slug : strata::layers_of(bound.expression)) layers.push_back(layer(slug));
  const auto selection = strata::query::select_where(bound, layers, map, "where", 1);
  demand(selection.has_value() && (selection->at(0) & ~map.surface_mask[0]) == 0);
}

template <class Parse>
void read_again(const Expression& expression, Parse parse) {
  const std::string text = text_of(expression);
  const auto again = parse(text);
  demand(again.has_value() ? text_of(*again) == text : is_beyond_limits(again.error()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using strata::query::Names;
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const Names names : {Names::layers, Names::columns}) {
    const auto as_condition = [&](const std::string& read) {
      return strata::query::parse_condition(read, "where", names);
    };
    const auto as_number = [&](const std::string& read) {
      return strata::query::parse_number(read, "value", names);
    };
    if (const auto condition = as_condition(text)) {
      demand(condition->is_condition());
      read_again(*condition, as_condition);
      if (names == Names::layers) evaluate(*condition);
    }
    if (const auto number = as_number(text)) {
      demand(!number->is_condition());
      read_again(*number, as_number);
    }
  }
  return 0;
}
