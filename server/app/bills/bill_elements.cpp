#include "app/bills/bill_elements.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "app/bills/bill_depths.h"
#include "app/figures/class_names.h"
#include "app/records/record_measures.h"
#include "domain/layers/layer.h"
#include "domain/people/question.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "expression/expression_parser.h"
#include "query/statistics/key_areas.h"
#include "query/statistics/quantities.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace {

using bill::Element;
using bill::ExactNumber;
using Measure = protocol::BillRuleMeasure;
using KeyAreas = std::map<std::int64_t, query::KeyArea>;

constexpr std::size_t kKeptConditions = 16;

}  // namespace

// The records of a rule.
struct ChosenRecords {
  Table table;
  std::vector<Record> records;  // sorted by key
  RecordNames names;
};

namespace {

void place_at(Element& element, const Model& model) {
  element.model = model.id.number();
  element.model_name = model.name;
  element.link = "/models/" + model.slug;
}

}  // namespace

// What the rules of a bill share.
struct BillElements::Cache {
  const Services& services;
  const BillSource source;
  std::map<ModelId, Model> models{};
  std::map<LayerId, KeyAreas> areas{};
  std::map<std::pair<std::int64_t, std::string>, ChosenRecords> records{};  // by table and `where`

  Result<void> load_models() {
    if (!models.empty()) return {};
    for (Model& model : STRATA_TRY(services.store.models().all(source.project)))
      models.emplace(model.id, std::move(model));
    return {};
  }

  Result<const Model*> model(ModelId id) const {
    const auto found = models.find(id);
    if (found == models.end()) return no_such_source("model " + to_string(id), "model");
    return &found->second;
  }

  Result<const KeyAreas*> areas_of(const Layer& layer) {
    const auto known = areas.find(layer.id);
    if (known != areas.end()) return &known->second;
    KeyAreas found;
    if (layer.sequence > 0) {  // otherwise it was never painted
      const auto room =
          STRATA_TRY(services.rooms.open_to_read(to_string(layer.model_id), source.seen_by));
      found = STRATA_TRY(room->queries().key_areas(layer.slug));
    }
    return &areas.emplace(layer.id, std::move(found)).first->second;
  }
};

namespace {

Result<ChosenRecords> chosen_records(const Services& services, const BillSource& source,
                                     const protocol::BillRule& rule) {
  store::Store& store = services.store;
  auto table = STRATA_TRY(of_rule(store.tables().find(std::to_string(*rule.table), source.seen_by),
                                  "table " + std::to_string(*rule.table), "table"));
  if (table.project_id != source.project)
    return no_such_source("table " + std::to_string(*rule.table), "table");
  store::RecordQuery query;
  query.limit = store::kMaxRecords;
  if (rule.where)
    query.filter = STRATA_TRY(query::parse_condition(*rule.where, "where", query::Names::columns));
  auto page = store.records().page(table.id, source.seen_by, query);
  if (!page) {
    Error problem = page.error();
    if (problem.field == "filter") problem.field = "where";
    return tl::unexpected(std::move(problem));
  }
  std::ranges::sort(page->records, {}, &Record::key);
  std::vector<std::int64_t> keys;
  for (const Record& record : page->records) keys.push_back(record.key);
  auto names = STRATA_TRY(record_names(store, table.id, source.seen_by, std::move(keys),
                                       std::nullopt, source.language));
  return ChosenRecords{std::move(page->table), std::move(page->records), std::move(names)};
}

Result<void> check_count(std::size_t elements) {
  if (elements <= bill::kMaxLines) return {};
  return fail(ErrorCode::invalid, "Too many elements",
              "A bill can have at most " + std::to_string(bill::kMaxLines) +
                  " lines. Choose fewer elements, or divide the bill.",
              "where");
}

// The lines and points of the chosen records on one model.
struct ModelFeatures {
  std::map<std::int64_t, double> lengths_m;  // of records with lines
  std::set<std::int64_t> keys;               // of records with lines or points

  double length_of(std::int64_t key) const {
    const auto found = lengths_m.find(key);
    return found == lengths_m.end() ? 0.0 : found->second;
  }
};

bool needs_features(const protocol::BillRule& rule) {
  return rule.measure == Measure::length || rule.measure == Measure::count ||
         (rule.size && rule.size->of == protocol::BillSizeOf::length);
}

Result<ModelFeatures> features_on(const Services& services, const ChosenRecords& chosen,
                                  const Model& model) {
  ModelFeatures features;
  const auto measures = STRATA_TRY(RecordMeasures::of_place(
      services, {chosen.table, model, std::nullopt}, chosen.table.columns));
  for (const Record& record : chosen.records) {
    const auto values = measures.of(record);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] <= 0) continue;
      features.keys.insert(record.key);
      if (measures.names()[i] == kLengthMeasure) features.lengths_m[record.key] = values[i];
    }
  }
  return features;
}

// Reads the elements of one rule over the records of a table.
class RecordElements {
 public:
  RecordElements(BillElements::Cache& cache, const protocol::BillRule& rule,
                 const ChosenRecords& chosen, BillDepths depths)
      : cache_(cache), rule_(rule), chosen_(chosen), depths_(std::move(depths)) {
    for (const Record& record : chosen.records) record_of_.emplace(record.key, &record);
  }

  Result<std::vector<Element>> read() {
    if (needs_features(rule_))
      for (const auto& [id, model] : cache_.models) {
        check_question();
        if (rule_.model && id != ModelId(*rule_.model)) continue;
        features_[id] = STRATA_TRY(features_on(cache_.services, chosen_, model));
      }
    if (rule_.measure != Measure::length) STRATA_TRY(add_painted());
    // Records with lines or points. Those that are painted have been counted.
    const bool counts = rule_.measure == Measure::count && !rule_.layer;
    if (rule_.measure == Measure::length || counts) STRATA_TRY(add_with_features(counts));
    return std::move(elements_);
  }

 private:
  Element element_of(const Model& model, std::int64_t key) const {
    Element element;
    place_at(element, model);
    element.table = chosen_.table.id.number();
    element.key = key;
    const auto name = chosen_.names.find(key);
    element.title =
        name == chosen_.names.end() || name->second.empty() ? std::to_string(key) : name->second;
    return element;
  }

  Result<void> add_painted() {
    const bool sizes_lengths = rule_.size && rule_.size->of == protocol::BillSizeOf::length;
    bool has_layer = false;
    for (const Layer& layer : STRATA_TRY(
             cache_.services.store.layers().of_table(chosen_.table.id, cache_.source.seen_by))) {
      if (rule_.model && layer.model_id != ModelId(*rule_.model)) continue;
      if (rule_.layer && layer.id != LayerId(*rule_.layer)) continue;
      has_layer = true;
      const Model* model = STRATA_TRY(cache_.model(layer.model_id));
      const KeyAreas* areas = STRATA_TRY(cache_.areas_of(layer));
      for (const auto& [key, area] : *areas) {
        const auto record = record_of_.find(key);
        if (record == record_of_.end()) continue;
        check_question();
        painted_.emplace(layer.model_id, key);
        Element element = element_of(*model, key);
        element.layer = layer.id.number();
        element.layer_name = layer.name;
        element.id = "layer " + to_string(layer.id) + " key " + std::to_string(key);
        element.size = ExactNumber::measured(
            sizes_lengths ? features_[layer.model_id].length_of(key) : area.area_m2);
        element.measured = ExactNumber::measured(area.area_m2);
        if (rule_.measure == Measure::count) element.measured = ExactNumber(1);
        if (rule_.measure == Measure::volume)
          element.measured =
              STRATA_TRY(depths_.volume(cache_.services, cache_.source, layer,
                                        static_cast<double>(key), area.area_m2, record->second));
        elements_.push_back(std::move(element));
        STRATA_TRY(check_count(elements_.size()));
      }
    }
    // Without this, the quantity would be 0 after the layer is deleted.
    if (rule_.layer && !has_layer)
      return no_such_source("layer " + std::to_string(*rule_.layer), "layer");
    return {};
  }

  Result<void> add_with_features(bool counts) {
    for (const auto& [model_id, features] : features_) {
      const Model* model = STRATA_TRY(cache_.model(model_id));
      for (const std::int64_t key : features.keys) {
        const double length_m = features.length_of(key);
        if (counts ? painted_.contains({model_id, key}) : length_m <= 0) continue;
        Element element = element_of(*model, key);
        element.id = "model " + to_string(model_id) + " key " + std::to_string(key);
        element.size = ExactNumber::measured(length_m);
        element.measured = counts ? ExactNumber(1) : element.size;
        elements_.push_back(std::move(element));
        STRATA_TRY(check_count(elements_.size()));
      }
    }
    return {};
  }

  BillElements::Cache& cache_;
  const protocol::BillRule& rule_;
  const ChosenRecords& chosen_;
  BillDepths depths_;
  std::map<std::int64_t, const Record*> record_of_;
  std::map<ModelId, ModelFeatures> features_;
  std::set<std::pair<ModelId, std::int64_t>> painted_;
  std::vector<Element> elements_;
};

}  // namespace

BillElements::BillElements(const Services& services, BillSource source)
    : cache_(new Cache{services, std::move(source)}) {}
BillElements::~BillElements() = default;

Result<std::vector<Element>> BillElements::of(const protocol::BillRule& rule) {
  STRATA_TRY(cache_->load_models());
  if (rule.model) STRATA_TRY(cache_->model(ModelId(*rule.model)));
  check_question();
  if (!rule.table) return of_layer(rule);
  const std::pair key(*rule.table, rule.where.value_or(""));
  auto known = cache_->records.find(key);
  if (known == cache_->records.end()) {
    auto fresh = STRATA_TRY(chosen_records(cache_->services, cache_->source, rule));
    // Most bills have few conditions. The others are read again, so that memory stays bounded.
    if (cache_->records.size() >= kKeptConditions) cache_->records.clear();
    known = cache_->records.emplace(key, std::move(fresh)).first;
  }
  const ChosenRecords& chosen = known->second;
  const auto depths = STRATA_TRY(BillDepths::of(rule, &chosen.table));
  return RecordElements(*cache_, rule, chosen, depths).read();
}

Result<std::vector<Element>> BillElements::of_layer(const protocol::BillRule& rule) {
  const Services& services = cache_->services;
  const BillSource& source = cache_->source;
  const Model* model = STRATA_TRY(cache_->model(ModelId(*rule.model)));
  const auto layer = STRATA_TRY(
      of_rule(services.store.layers().find(model->id, std::to_string(*rule.layer), source.seen_by),
              "layer " + std::to_string(*rule.layer), "layer"));
  if (layer.table)
    return fail(ErrorCode::invalid, "Layer of records",
                "The elements of layer `" + layer.name +
                    "` are records. Add its `table` to the "
                    "rule.",
                "table");
  std::vector<Element> elements;
  if (layer.sequence == 0) return elements;
  auto depths = STRATA_TRY(BillDepths::of(rule, nullptr));
  const auto room = STRATA_TRY(services.rooms.open_to_read(to_string(model->id), source.seen_by));
  const auto all = STRATA_TRY(room->queries().quantities(layer.slug));
  for (const query::Quantity& quantity : all.classes) {
    check_question();
    if (rule.values &&
        (!quantity.value || std::ranges::find(*rule.values, *quantity.value) == rule.values->end()))
      continue;
    if (rule.depth && rule.depth->layer && !quantity.value)
      return fail(ErrorCode::invalid, "Classes are ranges",
                  "The depth of a layer can only be read for classes that are single values.",
                  "depth.layer");
    Element element;
    place_at(element, *model);
    element.layer = layer.id.number();
    element.layer_name = layer.name;
    element.title = quantity_text(quantity, quantity_label(quantity, layer, {}));
    const auto limit = [](const std::optional<double>& value) {
      return value ? ExactNumber::measured(*value).short_text() : std::string("…");
    };
    element.id = "layer " + to_string(layer.id) + " class " +
                 (quantity.value ? limit(quantity.value)
                                 : limit(quantity.from) + " to " + limit(quantity.to));
    element.size = element.measured = ExactNumber::measured(quantity.area_m2);
    if (rule.measure == Measure::count)
      element.measured = ExactNumber(static_cast<std::int64_t>(quantity.pieces));
    if (rule.measure == Measure::volume)
      element.measured = STRATA_TRY(depths.volume(
          services, source, layer, quantity.value.value_or(0), quantity.area_m2, nullptr));
    elements.push_back(std::move(element));
    STRATA_TRY(check_count(elements.size()));
  }
  return elements;
}

}  // namespace strata::app
