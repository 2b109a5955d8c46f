#include "app/layers/layer_features.h"

#include <algorithm>
#include <map>
#include <set>

#include "app/figures/class_names.h"
#include "app/maps/map_place.h"
#include "app/records/record_csv.h"
#include "domain/tables/column_value.h"
#include "domain/tables/surface_feature.h"
#include "query/maps/map_features.h"
#include "room/surface.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace {

using Kind = FeatureField::Kind;

// The table of a database layer, with all records that may have features.
struct Records {
  std::vector<Column> columns;           // become the attributes of the features
  std::vector<Column> surface_features;  // columns with lines and points
  std::map<std::int64_t, Record> by_key;
  RecordNames names;
  WordsOfTables words;
};

Result<Records> read_records(store::Store& store, const FeatureRequest& request,
                             std::vector<std::int64_t> painted) {
  store::RecordQuery query;
  query.limit = store::kMaxRecords;
  if (request.at) {
    const auto then =
        store.tables().sequence_when(*request.layer.table, request.layer.model_id, *request.at);
    if (!then) return tl::unexpected(then.error());
    query.at = *then;
  }
  const auto table = STRATA_TRY(store.tables().find(to_string(*request.layer.table), request.role));
  // Includes records without painted texels because they may have lines and points.
  const auto is_feature = [](const Column& column) { return holds_features(column.kind); };
  if (std::ranges::none_of(table.columns, is_feature)) query.keys = std::move(painted);
  auto page = STRATA_TRY(store.records().page(table.id, request.role, query));
  Records records;
  for (const Column& column : page.table.columns)
    if (is_feature(column))
      records.surface_features.push_back(column);
    else if (!holds_attachments(column.kind))
      records.columns.push_back(column);
  std::vector<std::int64_t> keys;
  for (Record& record : page.records) {
    keys.push_back(record.key);
    records.by_key.emplace(record.key, std::move(record));
  }
  auto names =
      record_names(store, table.id, request.role, std::move(keys), query.at, request.language);
  if (!names) return tl::unexpected(names.error());
  records.names = std::move(*names);
  auto words = STRATA_TRY(words_of(store, records.columns, request.role, request.language));
  records.words = std::move(words);
  return records;
}

Kind kind_of(const Column& column) {
  switch (column.kind) {
    case ColumnKind::integer: return Kind::integer;
    case ColumnKind::numeric: return Kind::real;
    case ColumnKind::boolean: return Kind::boolean;
    default: return Kind::text;
  }
}

FeatureValue value_of(const Record& record, const Column& column, const WordsOfTables& words) {
  const auto found = record.values.find(column.id);
  if (found == record.values.end() || found->second.is_null()) return {};
  const nlohmann::json& value = found->second;
  if (auto word = term_word(record, column, words)) return std::move(*word);
  switch (kind_of(column)) {
    case Kind::integer: return value.get<std::int64_t>();
    case Kind::real: return value.get<double>();
    case Kind::boolean: return value.get<bool>();
    // Without the protection from formulas in spreadsheets, which would change the text.
    default: return value.is_string() ? value.get<std::string>() : print_value(column, value);
  }
}

// Creates the field names of a table. Adds the prefix `column_` to a name that is already used, or
// that a file format reserves.
class Fields {
 public:
  explicit Fields(std::vector<FeatureField> own) : fields_(std::move(own)) {
    for (const FeatureField& field : fields_) taken_.insert(field.name);
  }
  void add(const Column& column) {
    std::string name = column.slug;
    while (taken_.contains(name)) name = "column_" + name;
    taken_.insert(name);
    fields_.push_back({std::move(name), kind_of(column), column.choices, column.name, column.unit});
  }
  std::vector<FeatureField> take() { return std::move(fields_); }

 private:
  std::vector<FeatureField> fields_;
  std::set<std::string> taken_{"fid", "geom", "kind", "ogc_fid", "rowid"};
};

FeatureValue text_or_nothing(std::string text) {
  return text.empty() ? FeatureValue{} : FeatureValue(std::move(text));
}

void add_record(Feature& feature, const Records& records, std::int64_t key) {
  const auto record = records.by_key.find(key);
  for (const Column& column : records.columns)
    feature.values.push_back(record == records.by_key.end()
                                 ? FeatureValue{}
                                 : value_of(record->second, column, records.words));
}

// Returns the class of query::classes_of to which the quantity belongs.
std::uint32_t class_of(const query::Quantity& quantity, const Layer& layer,
                       const query::ValueClasses& classes) {
  if (quantity.value)
    return classes.of(encode_value(layer.type, *quantity.value).value_or(0), *quantity.value);
  std::uint32_t range = 0;
  while (range < classes.limits.size() && classes.from(range) != quantity.from) ++range;
  return range;
}

LayerClasses classes_in(const FeatureRequest& request, room::LayerAreas areas,
                        const Records& records) {
  const Layer& layer = request.layer;
  const Model model = request.room->model();
  const query::ValueClasses classes = query::classes_of(layer);
  const bool has_keys = layer.table.has_value();
  std::vector<FeatureField> own;
  if (has_keys)
    own.push_back({"key", Kind::integer});
  else if (classes.each)
    own.push_back({"value", Kind::real});
  else
    own.insert(own.end(), {{"from", Kind::real}, {"to", Kind::real}});
  own.insert(own.end(), {{"name", Kind::text},
                         {"area_m2", Kind::real},
                         {"perimeter_m", Kind::real},
                         {"texels", Kind::integer},
                         {"pieces", Kind::integer},
                         {"layer", Kind::text},
                         {"model", Kind::text}});
  Fields fields(std::move(own));
  for (const Column& column : records.columns) fields.add(column);
  FeatureTable table{FeatureKind::areas, "areas", fields.take(), {}};
  std::vector<std::uint32_t> of_features;
  const auto number = [](const std::optional<double>& value) {
    return value ? FeatureValue(*value) : FeatureValue{};
  };
  for (const query::Quantity& quantity : areas.quantities.classes) {
    Feature& feature = table.features.emplace_back();
    const std::uint32_t a_class = class_of(quantity, layer, classes);
    of_features.push_back(a_class);
    const std::int64_t key = has_keys ? static_cast<std::int64_t>(*quantity.value) : 0;
    feature.id = quantity.value ? query::number_text(*quantity.value)
                                : "range-" + std::to_string(a_class + 1);
    if (has_keys)
      feature.values = {key};
    else if (classes.each)
      feature.values = {*quantity.value};
    else
      feature.values = {number(quantity.from), number(quantity.to)};
    const std::string label = quantity_label(quantity, layer, records.names);
    feature.values.push_back(text_or_nothing(has_keys ? label : quantity_text(quantity, label)));
    const auto length = areas.perimeters.of_class.find(a_class);
    feature.values.emplace_back(quantity.area_m2);
    feature.values.emplace_back(
        length == areas.perimeters.of_class.end() ? 0 : length->second * model.metres());
    feature.values.emplace_back(static_cast<std::int64_t>(quantity.texels));
    feature.values.emplace_back(static_cast<std::int64_t>(quantity.pieces));
    feature.values.emplace_back(layer.slug);
    feature.values.emplace_back(model.slug);
    add_record(feature, records, key);
  }
  return {std::move(areas), std::move(table), std::move(of_features)};
}

FeatureTable features_in(const FeatureRequest& request, const Records& records,
                         const Column& drawn) {
  const bool are_lines = drawn.kind == ColumnKind::line;
  const Model model = request.room->model();
  std::vector<FeatureField> own{{"key", Kind::integer}, {"name", Kind::text}};
  if (are_lines) own.push_back({"length_m", Kind::real});
  own.insert(own.end(), {{"layer", Kind::text}, {"model", Kind::text}});
  Fields fields(std::move(own));
  for (const Column& column : records.columns) fields.add(column);
  FeatureTable table{are_lines ? FeatureKind::lines : FeatureKind::points,
                     (are_lines ? "lines_" : "points_") + drawn.slug,
                     fields.take(),
                     {}};
  for (const auto& [key, record] : records.by_key) {
    int number = 0;  // of the mark in the record
    for (const SurfaceFeature& surface_feature : features_of(record, drawn)) {
      ++number;
      if (surface_feature.model != model.id) continue;
      Feature& feature = table.features.emplace_back();
      feature.id = std::to_string(key) + "-" + std::to_string(number);
      const auto name = records.names.find(key);
      feature.values = {
          key, text_or_nothing(name == records.names.end() ? std::string() : name->second)};
      if (are_lines) feature.values.emplace_back(length_of(surface_feature) * model.metres());
      feature.values.emplace_back(request.layer.slug);
      feature.values.emplace_back(model.slug);
      add_record(feature, records, key);
      query::FlatRing path;
      for (const glm::dvec3& place : surface_feature.places)
        path.emplace_back(place[request.plane.right], place[request.plane.up],
                          place[request.plane.depth]);
      feature.geometry = {{{std::move(path)}}};
    }
  }
  return table;
}

// The classes of a layer with the records of its table.
struct Described {
  LayerClasses classes;
  Records records;
};

Result<Described> describe(store::Store& store, FeatureRequest request) {
  if (!request.with_areas) {
    Described marks;
    if (request.layer.table) marks.records = STRATA_TRY(read_records(store, request, {}));
    return marks;
  }
  auto areas =
      STRATA_TRY(request.room->queries().layer_areas(to_string(request.layer.id), request.at));
  // Its palette and slug may have changed since the request.
  request.layer = areas.view.layer;
  Records records;
  if (request.layer.table) {
    std::vector<std::int64_t> painted;
    for (const query::Quantity& quantity : areas.quantities.classes)
      painted.push_back(static_cast<std::int64_t>(*quantity.value));
    auto read = STRATA_TRY(read_records(store, request, std::move(painted)));
    records = std::move(read);
  }
  LayerClasses classes = classes_in(request, std::move(areas), records);
  return Described{std::move(classes), std::move(records)};
}

}  // namespace

Result<LayerClasses> layer_classes(store::Store& store, const FeatureRequest& request) {
  auto described = STRATA_TRY(describe(store, request));
  return std::move(described.classes);
}

Result<FeatureSet> layer_features(store::Store& store, const FeatureRequest& request) {
  const Model model = request.room->model();
  auto [classes, records] = STRATA_TRY(describe(store, request));
  FeatureSet set;
  set.name = model.slug + "-" + request.layer.slug;
  set.unit = name(model.unit);
  for (const int axis : {request.plane.right, request.plane.up, request.plane.depth})
    set.axes += "xyz"[axis];
  set.epsg = epsg_of(model, request.plane.depth);
  set.description = request.layer.name + " on " + model.name + ": " + set.axes + " in " + set.unit;
  if (request.with_areas) {
    std::set<std::uint32_t> chosen;
    for (std::size_t i = 0; request.outlines && i < classes.classes.size(); ++i)
      if (request.outlines(i, classes.table.features[i])) chosen.insert(classes.classes[i]);
    auto outlines =
        query::plane_outlines(classes.areas.view, *request.room->surface().geometry(),
                              *classes.areas.map, query::classes_of(classes.areas.view.layer),
                              request.plane, request.outlines ? &chosen : nullptr);
    if (!outlines) return tl::unexpected(outlines.error());
    for (std::size_t i = 0; i < classes.classes.size(); ++i)
      if (const auto outline = outlines->find(classes.classes[i]); outline != outlines->end())
        classes.table.features[i].geometry = std::move(outline->second);
    set.tables.push_back(std::move(classes.table));
  }
  if (request.with_marks)
    for (const Column& column : records.surface_features)
      set.tables.push_back(features_in(request, records, column));
  return set;
}

}  // namespace strata::app
