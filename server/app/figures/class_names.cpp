#include "app/figures/class_names.h"

#include "app/records/record_words.h"
#include "core/text/csv.h"
#include "domain/tables/term_list.h"
#include "store/tables/records.h"

namespace strata::app {

Result<RecordNames> record_names(store::Store& store, TableId table_id, Role seen_by,
                                 std::vector<std::int64_t> keys, std::optional<std::int64_t> at,
                                 const std::string& language) {
  store::RecordQuery query;
  query.keys = std::move(keys);
  query.at = at;
  auto page = STRATA_TRY(store.records().page(table_id, seen_by, query));
  RecordNames names;
  if (const auto columns = term_columns(page.table)) {
    for (const ListedTerm& listed : list_terms(*columns, page.records))
      names[listed.key] = label_in(listed.term, language);
    return names;
  }
  const Column* title = name_column(page.table);
  if (!title || title->kind != ColumnKind::term) {
    for (const Record& record : page.records) names[record.key] = record_name(record, page.table);
    return names;
  }
  const auto words = RecordWords::load(store, *title->target, seen_by, language);
  if (!words) return tl::unexpected(words.error());
  for (const Record& record : page.records) {
    const auto value = record.values.find(title->id);
    const bool has_title = value != record.values.end() && !value->second.is_null();
    names[record.key] = has_title ? words->name(value->second.get<std::int64_t>()) : std::string();
  }
  return names;
}

std::string palette_label(const Layer& layer, double value) {
  for (const Palette::Point& point : layer.palette.points)
    if (point.at == value) return point.label;
  return {};
}

std::string quantity_label(const query::Quantity& quantity, const Layer& layer,
                           const RecordNames& names) {
  if (layer.kind == LayerKind::database) {
    const auto name = names.find(static_cast<std::int64_t>(*quantity.value));
    return name == names.end() ? std::string() : name->second;
  }
  // In a stepped palette, the color and the label of a point apply to the range that begins there.
  if (!quantity.value && (layer.palette.mode != PaletteMode::step || !quantity.from)) return {};
  const double at = quantity.value ? *quantity.value : *quantity.from;
  return palette_label(layer, at);
}

std::string quantity_text(const query::Quantity& quantity, const std::string& label) {
  if (!label.empty()) return label;
  if (quantity.value) return csv_number(*quantity.value, ',');
  if (quantity.from && quantity.to)
    return "from " + csv_number(*quantity.from, ',') + " to " + csv_number(*quantity.to, ',');
  if (quantity.from) return "from " + csv_number(*quantity.from, ',');
  if (quantity.to) return "below " + csv_number(*quantity.to, ',');
  return "all";
}

Result<std::vector<std::string>> class_names(store::Store& store, const Layer& layer, Role seen_by,
                                             const std::vector<double>& values,
                                             std::optional<std::int64_t> at,
                                             const std::string& language) {
  RecordNames records;
  if (layer.table) {
    std::vector<std::int64_t> keys;
    for (const double value : values) keys.push_back(static_cast<std::int64_t>(value));
    auto found =
        STRATA_TRY(record_names(store, *layer.table, seen_by, std::move(keys), at, language));
    records = std::move(found);
  }
  std::vector<std::string> names;
  for (const double value : values) {
    const auto record = records.find(static_cast<std::int64_t>(value));
    const std::string name =
        layer.table ? (record == records.end() ? std::string() : record->second)
        : layer.palette.mode == PaletteMode::categorical ? palette_label(layer, value)
                                                         : std::string();
    names.push_back(name.empty() ? csv_number(value, ',') : name);
  }
  return names;
}

}  // namespace strata::app
