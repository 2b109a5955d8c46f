#include "query/statistics/quantities.h"

#include <stdexcept>
#include <unordered_map>

#include "core/compensated_sum.h"
#include "domain/people/question.h"
#include "mesh/texels/texel_graph.h"
#include "query/conditions/texel_values.h"
#include "query/statistics/pieces.h"

namespace strata::query {

ValueClasses classes_of(const Layer& layer) {
  ValueClasses classes;
  classes.each =
      layer.kind == LayerKind::database || layer.palette.mode == PaletteMode::categorical;
  if (classes.each) return classes;
  for (const Palette::Point& point : layer.palette.points) classes.limits.push_back(point.at);
  classes.last_limit_below = layer.palette.mode == PaletteMode::linear && classes.limits.size() > 1;
  return classes;
}

Result<Quantities> quantities(const LayerView& view, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, const ValueClasses& classes,
                              double metres_per_unit) {
  if (map.resolution != view.layer.resolution)
    throw std::invalid_argument("The surface map has another resolution than the layer.");
  const ValueType type = view.layer.type;
  const double m2_per_unit2 = metres_per_unit * metres_per_unit;
  struct Sum {
    double value = 0;
    std::uint64_t texels = 0;
    CompensatedSum area;
  };
  std::unordered_map<std::uint32_t, Sum> sums;
  std::uint32_t last_class = 0;
  const QuestionTurn turn;
  Sum* last = nullptr;  // neighbors mostly have the same class; references stay valid
  for (const auto& [address, tile] : sorted_tiles(view.snapshot.tiles)) {
    turn.check(kTexelsPerTile);
    for_each_value(*tile, address, type, map, nullptr,
                   [&](std::uint32_t slot, int texel, std::uint32_t bits, double value) {
                     const std::uint32_t number = classes.of(bits, value);
                     if (!last || number != last_class) last = &sums[number];
                     last_class = number;
                     last->value = value;
                     ++last->texels;
                     last->area +=
                         map.area[std::size_t{slot} * 64 + static_cast<std::size_t>(texel)];
                   });
    if (sums.size() > kMaxClasses)
      return fail(ErrorCode::invalid, "Too many classes",
                  "The layer contains more than " + std::to_string(kMaxClasses) +
                      " different values. Set a palette with ranges (linear or step).",
                  "layer");
  }
  const PieceCounts pieces = count_pieces(view, map, graph, nullptr, classes);
  Quantities out;
  CompensatedSum area;
  out.surface_m2 = map.area_total * m2_per_unit2;
  // ranges are sorted by their numbers, and classes by their values
  std::vector<std::pair<double, std::uint32_t>> order;
  for (const auto& [number, sum] : sums)
    order.emplace_back(classes.each ? sum.value : double(number), number);
  std::ranges::sort(order);
  for (const auto& [place, number] : order) {
    const Sum& sum = sums.at(number);
    Quantity quantity;
    if (classes.each) {
      quantity.value = sum.value == 0 ? 0 : sum.value;
    } else {
      quantity.from = classes.from(number);
      quantity.to = classes.to(number);
    }
    quantity.pieces = pieces.of_class.at(number);
    quantity.texels = sum.texels;
    quantity.area_m2 = sum.area.value() * m2_per_unit2;
    out.sum.pieces += quantity.pieces;
    out.sum.texels += quantity.texels;
    area += sum.area;
    out.classes.push_back(quantity);
  }
  out.sum.area_m2 = area.value() * m2_per_unit2;
  return out;
}

}  // namespace strata::query
