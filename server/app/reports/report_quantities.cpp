#include <algorithm>

#include "app/figures/class_names.h"
#include "app/reports/report_parts.h"
#include "room/queries.h"
#include "room/room.h"

namespace strata::app {
namespace {

constexpr std::size_t kMaxListed = 200;  // classes of a layer

// Returns the color of a class, or nullopt if the values of records or ranges define the colors.
std::optional<report::Color> color_of_class(const query::Quantity& quantity,
                                            const Palette& palette) {
  if (!palette.column.empty()) return std::nullopt;
  std::optional<double> value = quantity.value;
  if (!value && quantity.from && quantity.to) value = (*quantity.from + *quantity.to) / 2;
  if (!value) value = quantity.from ? quantity.from : quantity.to;
  if (!value) return std::nullopt;
  const Rgba color = color_of(palette, *value);
  // Over the white paper.
  const auto mixed = [&](std::size_t i) {
    return static_cast<std::uint8_t>((color[i] * color[3] + 255 * (255 - color[3]) + 127) / 255);
  };
  return report::Color{mixed(0), mixed(1), mixed(2)};
}

// Returns the row of a class, or of the sum.
std::vector<report::Cell> row_of(const ReportWords& words, const query::Quantity& quantity,
                                 const query::Quantities& all, std::string name,
                                 std::optional<report::Color> swatch) {
  const double share = all.surface_m2 > 0 ? std::min(1.0, quantity.area_m2 / all.surface_m2) : 0;
  return {report::Cell{std::move(name), swatch}, report::Cell{std::to_string(quantity.pieces)},
          report::Cell{area_in(words, quantity.area_m2)},
          report::Cell{number_in(words, 100 * share) + " %"}};
}

Result<report::Block> layer_table(const ReportContext& context, const Layer& layer) {
  const ReportWords& words = context.words;
  const ReportRequest& request = context.request;
  auto all = STRATA_TRY(request.room->queries().quantities(layer.slug, request.shown.at));
  if (all.classes.empty()) return report::Block(report::Paragraph{{{words.nothing_painted}}});
  const std::size_t count = all.classes.size();
  if (count > kMaxListed)
    std::ranges::stable_sort(all.classes, std::greater(), &query::Quantity::area_m2);
  const std::size_t listed = std::min(count, kMaxListed);
  RecordNames names;
  if (layer.table) {
    std::vector<std::int64_t> keys;
    for (std::size_t i = 0; i < listed; ++i)
      if (all.classes[i].value) keys.push_back(static_cast<std::int64_t>(*all.classes[i].value));
    auto found = STRATA_TRY(record_names(context.services.store, *layer.table, request.reader.role,
                                         std::move(keys), {}, words.tag));
    names = std::move(found);
  }
  report::Table table{{{words.class_name, 3},
                       {words.pieces, 1, report::Alignment::end},
                       {words.area, 1.2, report::Alignment::end},
                       {words.share, 1.4, report::Alignment::end}},
                      {}};
  for (std::size_t i = 0; i < listed; ++i) {
    const query::Quantity& quantity = all.classes[i];
    const std::string label = quantity_label(quantity, layer, names);
    std::string name = quantity_text(quantity, label);
    if (!layer.unit.empty() && !layer.table && label.empty()) name += " " + layer.unit;
    table.rows.push_back(
        row_of(words, quantity, all, std::move(name), color_of_class(quantity, layer.palette)));
  }
  table.total = row_of(words, all.sum, all, words.total, {});
  if (listed < count)
    table.caption = filled(words.largest_classes, std::to_string(listed), std::to_string(count));
  return report::Block(std::move(table));
}

}  // namespace

Result<Blocks> quantities_part(const ReportContext& context, Progress& progress) {
  Blocks blocks;
  // The topmost layer first, as in legends.
  for (auto layer = context.request.layers.rbegin(); layer != context.request.layers.rend();
       ++layer) {
    if (progress.cancelled()) return cancelled_problem();
    auto table = STRATA_TRY(layer_table(context, *layer));
    blocks.emplace_back(report::Heading{2, layer_name(context, *layer)});
    blocks.push_back(std::move(table));
  }
  return blocks;
}

}  // namespace strata::app
