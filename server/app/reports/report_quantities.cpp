#include <algorithm>

#include "app/figures/class_names.h"
#include "app/records/feature_measures.h"
#include "app/records/record_measures.h"
#include "app/reports/report_parts.h"
#include "core/text/csv.h"
#include "domain/people/question.h"
#include "room/queries.h"
#include "room/room.h"
#include "store/store.h"
#include "store/tables/tables.h"

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

// Formats a limit or a value of a class with all its digits.
std::string value_in(const ReportWords& words, double value) {
  std::string text = csv_number(value, ',');
  if (const auto point = text.find('.'); point != std::string::npos)
    text.replace(point, 1, words.decimal);
  return text;
}

// Returns the text of a class without a name.
std::string values_in(const ReportWords& words, const query::Quantity& quantity) {
  if (quantity.value) return value_in(words, *quantity.value);
  if (quantity.from && quantity.to)
    return filled(words.from_to, value_in(words, *quantity.from), value_in(words, *quantity.to));
  if (quantity.from) return filled(words.from, value_in(words, *quantity.from));
  if (quantity.to) return filled(words.below, value_in(words, *quantity.to));
  return words.all_values;
}

// What a layer has of each class.
struct OfLayer {
  query::Quantities all;
  FeatureMeasures features;
  RecordNames names;  // of records
};

Result<OfLayer> quantities_of(const ReportContext& context, const Layer& layer) {
  const ReportRequest& request = context.request;
  auto all = STRATA_TRY(request.room->queries().quantities(layer.slug, request.shown.at));
  OfLayer found{std::move(all), {}, {}};
  if (!layer.table) return found;
  store::Store& store = context.services.store;
  const auto table = STRATA_TRY(store.tables().find(to_string(*layer.table), request.reader.role));
  const auto at = records_at(context, layer);
  auto features = STRATA_TRY(FeatureMeasures::of_table(context.services, table, request.reader.role,
                                                       request.room->model(), at));
  found.features = std::move(features);
  add_classes(found.all, found.features);
  std::vector<std::int64_t> keys;
  for (const query::Quantity& quantity : found.all.classes)
    keys.push_back(static_cast<std::int64_t>(*quantity.value));
  auto names = STRATA_TRY(record_names(store, *layer.table, request.reader.role, std::move(keys),
                                       at, context.words.tag));
  found.names = std::move(names);
  return found;
}

std::string class_name(const ReportWords& words, const Layer& layer, const OfLayer& found,
                       const query::Quantity& quantity) {
  if (layer.table)
    return record_label(words, found.names, static_cast<std::int64_t>(*quantity.value));
  std::string label = quantity_label(quantity, layer, {});
  if (!label.empty()) return label;
  return values_in(words, quantity) + (layer.unit.empty() ? "" : " " + layer.unit);
}

// Returns the row of a class, or of the sum. `measures` are those of lines and points.
std::vector<report::Cell> row_of(const ReportWords& words, const query::Quantity& quantity,
                                 const std::vector<double>& measures, const OfLayer& found,
                                 std::string name, std::optional<report::Color> swatch) {
  const double share = query::share_of_surface(quantity.area_m2, found.all.surface_m2);
  std::vector<report::Cell> row{report::Cell{std::move(name), swatch},
                                report::Cell{std::to_string(quantity.pieces)},
                                report::Cell{area_in(words, quantity.area_m2)}};
  for (std::size_t i = 0; i < measures.size(); ++i)
    row.push_back(report::Cell{found.features.names[i] == kLengthMeasure
                                   ? length_in(words, measures[i])
                                   : number_in(words, measures[i])});
  row.push_back(report::Cell{number_in(words, 100 * share) + " %"});
  return row;
}

Result<report::Block> layer_table(const ReportContext& context, const Layer& layer) {
  const ReportWords& words = context.words;
  auto found = STRATA_TRY(quantities_of(context, layer));
  auto& classes = found.all.classes;
  if (classes.empty()) return report::Block(report::Paragraph{{{words.nothing_painted}}});
  const std::size_t listed = std::min(classes.size(), kMaxListed);
  if (listed < classes.size())
    std::ranges::stable_sort(classes, std::greater(), &query::Quantity::area_m2);
  report::Table table{{{words.class_name, 3},
                       {words.pieces, 1, report::Alignment::end},
                       {words.area, 1.2, report::Alignment::end}},
                      {}};
  for (const std::string& measure : found.features.names)
    table.columns.push_back(
        {measure == kLengthMeasure ? words.length : words.points, 1.2, report::Alignment::end});
  table.columns.push_back({words.share, 1.4, report::Alignment::end});
  for (std::size_t i = 0; i < listed; ++i) {
    const query::Quantity& quantity = classes[i];
    const auto measures = layer.table
                              ? found.features.of(static_cast<std::int64_t>(*quantity.value))
                              : std::vector<double>();
    table.rows.push_back(row_of(words, quantity, measures, found,
                                class_name(words, layer, found, quantity),
                                color_of_class(quantity, layer.palette)));
  }
  table.total =
      row_of(words, found.all.sum, found.features.sum(), found, words.total, std::nullopt);
  if (listed < classes.size())
    table.caption =
        filled(words.largest_classes, std::to_string(listed), std::to_string(classes.size()));
  return report::Block(std::move(table));
}

}  // namespace

Result<Blocks> quantities_part(const ReportContext& context, Progress& progress) {
  Blocks blocks;
  // The topmost layer first, as in legends.
  for (auto layer = context.request.layers.rbegin(); layer != context.request.layers.rend();
       ++layer) {
    check_question();
    if (progress.cancelled()) return cancelled_problem();
    auto table = STRATA_TRY(layer_table(context, *layer));
    blocks.emplace_back(report::Heading{2, layer_name(context, *layer)});
    blocks.push_back(std::move(table));
  }
  return blocks;
}

}  // namespace strata::app
