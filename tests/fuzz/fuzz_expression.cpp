// A formula over layers: what is read comes back from a text made of it, and a condition selects surface only.
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include "query/expression_evaluator.h"
#include "query/expression_parser.h"

namespace {

using strata::Expression;
using Op = Expression::Op;

void demand(bool holds) {
  if (!holds) std::abort();
}

std::string text_of(const Expression& expression);

std::string call(const char* function, const Expression& expression) {
  std::string text = std::string(function) + "(";
  for (const auto& part : expression.parts) text += (&part == expression.parts.data() ? "" : ", ") + text_of(part);
  return text + ")";
}

std::string joined(const char* word, const Expression& expression) {
  std::string text;
  for (const auto& part : expression.parts)
    text += (text.empty() ? "(" : std::string(" ") + word + " ") + text_of(part);
  return text + ")";
}

std::string text_of(const Expression& expression) {
  switch (expression.op) {
    case Op::number: {
      demand(std::isfinite(expression.number) && !std::signbit(expression.number));
      char text[40];
      return {text, std::to_chars(text, text + sizeof text, expression.number).ptr};
    }
    case Op::layer: return '"' + expression.layer + '"';
    case Op::add: return joined("+", expression);
    case Op::subtract: return joined("-", expression);
    case Op::multiply: return joined("*", expression);
    case Op::divide: return joined("/", expression);
    case Op::negate: return "(-" + text_of(expression.parts.at(0)) + ")";
    case Op::absolute: return call("abs", expression);
    case Op::least: return call("min", expression);
    case Op::greatest: return call("max", expression);
    case Op::choose: return call("if", expression);
    case Op::truth: return expression.number == 1 ? "true" : "false";
    case Op::valid: return "valid(\"" + expression.layer + "\")";
    case Op::less: return joined("<", expression);
    case Op::less_equal: return joined("<=", expression);
    case Op::greater: return joined(">", expression);
    case Op::greater_equal: return joined(">=", expression);
    case Op::equal: return joined("=", expression);
    case Op::not_equal: return joined("<>", expression);
    case Op::all: return joined("and", expression);
    case Op::any: return joined("or", expression);
    case Op::negation: return "(not " + text_of(expression.parts.at(0)) + ")";
  }
  std::abort();
}

// The text made of an expression has more brackets than that which it was read from.
bool is_beyond_limits(const strata::Problem& problem) {
  return problem.title == "Expression too long" || problem.detail.find("nested too deeply") != std::string::npos;
}

// One block of surface.
strata::mesh::SurfaceMap one_block() {
  strata::mesh::SurfaceMap map;
  map.resolution = strata::kTileSize;
  map.blocks_per_side = strata::kTileSize / strata::kBlockSize;
  map.slot_of_block.assign(static_cast<std::size_t>(map.blocks_per_side * map.blocks_per_side), strata::mesh::kNoSlot);
  map.slot_of_block[0] = 0;
  map.block_of_slot = {0};
  map.surface_mask = {~std::uint64_t{1}};
  return map;
}

// Values from below zero up, with gaps.
strata::query::LayerView layer(const std::string& slug) {
  strata::query::LayerView view;
  view.layer.slug = slug;
  view.layer.type = strata::ValueType::i8;
  view.layer.resolution = strata::kTileSize;
  auto tile = std::make_shared<strata::TileData>(view.layer.type);
  for (int i = 0; i < strata::kTexelsPerTile; i += 3) tile->write(i, static_cast<std::uint8_t>(i % 16 - 8));
  view.snapshot.tiles[{0, 0}] = tile;
  return view;
}

void evaluate(const Expression& condition) {
  static const strata::mesh::SurfaceMap map = one_block();
  std::vector<strata::query::LayerView> layers;
  for (const auto& slug : strata::layers_of(condition)) layers.push_back(layer(slug));
  const auto selection = strata::query::select_where(condition, layers, map, "where", 1);
  demand(selection.has_value() && (selection->at(0) & ~map.surface_mask[0]) == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto condition = strata::query::parse_condition(text, "where")) {
    demand(condition->is_condition());
    evaluate(*condition);
    const auto again = strata::query::parse_condition(text_of(*condition), "where");
    demand(again.has_value() ? *again == *condition : is_beyond_limits(again.error()));
  }
  if (const auto number = strata::query::parse_number(text, "value")) {
    demand(!number->is_condition());
    const auto again = strata::query::parse_number(text_of(*number), "value");
    demand(again.has_value() ? *again == *number : is_beyond_limits(again.error()));
  }
  return 0;
}
