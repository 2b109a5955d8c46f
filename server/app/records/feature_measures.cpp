#include "app/records/feature_measures.h"

#include <algorithm>
#include <set>

#include "app/records/record_measures.h"
#include "core/compensated_sum.h"
#include "store/store.h"
#include "store/tables/records.h"

namespace strata::app {

Result<FeatureMeasures> FeatureMeasures::of_table(const Services& services, const Table& table,
                                                  Role seen_by, const std::optional<Model>& model,
                                                  std::optional<std::int64_t> at) {
  if (std::ranges::none_of(table.columns,
                           [](const Column& column) { return holds_features(column.kind); }))
    return FeatureMeasures{};
  store::RecordQuery query;
  query.limit = store::kMaxRecords;
  query.at = at;
  const auto page = STRATA_TRY(services.store.records().page(table.id, seen_by, query));
  const auto measures =
      RecordMeasures::of_place(services, {page.table, model, {}}, page.table.columns);
  if (!measures) return tl::unexpected(measures.error());
  FeatureMeasures features{measures->names(), {}};
  for (const Record& record : page.records) {
    auto values = measures->of(record);
    if (std::ranges::any_of(values, [](double value) { return value > 0; }))
      features.of_key[record.key] = std::move(values);
  }
  return features;
}

std::vector<double> FeatureMeasures::sum() const {
  std::vector<CompensatedSum> sums(names.size());
  for (const auto& [key, values] : of_key)
    for (std::size_t i = 0; i < values.size(); ++i) sums[i] += values[i];
  std::vector<double> all;
  for (const CompensatedSum& sum : sums) all.push_back(sum.value());
  return all;
}

std::vector<double> FeatureMeasures::of(std::int64_t key) const {
  const auto found = of_key.find(key);
  return found == of_key.end() ? std::vector<double>(names.size(), 0.0) : found->second;
}

void add_classes(query::Quantities& all, const FeatureMeasures& features) {
  std::set<double> painted;
  for (const query::Quantity& quantity : all.classes) painted.insert(*quantity.value);
  for (const auto& [key, values] : features.of_key) {
    if (painted.contains(static_cast<double>(key))) continue;
    query::Quantity& quantity = all.classes.emplace_back();
    quantity.value = static_cast<double>(key);
  }
  std::ranges::stable_sort(all.classes, {},
                           [](const query::Quantity& quantity) { return *quantity.value; });
}

}  // namespace strata::app
