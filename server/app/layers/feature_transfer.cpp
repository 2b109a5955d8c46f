#include "app/layers/feature_transfer.h"

#include <algorithm>
#include <set>

#include "app/change_notifier.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/tables/surface_feature.h"
#include "domain/tables/table.h"
#include "jobs/transfer_features.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/table_changes.h"

namespace strata::app {
namespace {

Result<FeatureTransfer> bring_features_of(const Services& services, TableId table_id,
                                          const jobs::TransferTarget& target,
                                          const jobs::TransferRequest& request,
                                          const std::string& user) {
  FeatureTransfer brought;
  store::RecordQuery query;
  query.limit = store::kMaxRecords;
  const auto page = STRATA_TRY(services.store.records().page(table_id, Role::curator, query));
  store::WriteRecords write;
  write.op = "transfer";
  write.may_create = false;
  for (const Record& record : page.records) {
    store::RecordInput input{record.key, {}, record.version};
    for (const Column& column : page.table.columns) {
      if (!holds_features(column.kind)) continue;
      auto features = features_of(record, column);
      if (std::ranges::any_of(features, [&](const SurfaceFeature& feature) {
            return feature.model == target.model.id;
          }))
        continue;
      std::vector<SurfaceFeature> there;
      std::ranges::copy_if(features, std::back_inserter(there), [&](const SurfaceFeature& feature) {
        return feature.model == request.source.id;
      });
      auto found = jobs::transfer_features(there, request.source, target, request.tolerance_mm);
      brought.lost_features += found.lost_features;
      if (found.features.empty()) continue;
      features.insert(features.end(), found.features.begin(), found.features.end());
      auto value = to_json(features);
      // The value exceeds the limit of a cell.
      if (!read_features(value, column.kind == ColumnKind::line)) {
        brought.lost_features += found.features.size();
        continue;
      }
      brought.features += found.features.size();
      input.values[column.id] = std::move(value);
    }
    if (!input.values.empty()) write.records.push_back(std::move(input));
  }
  if (write.records.empty()) return brought;
  const auto change = STRATA_TRY(services.store.records().write(table_id, write, user));
  if (!change.problems.empty()) return tl::unexpected(change.problems.front().problem);
  services.changes.records_changed(change, user);
  return brought;
}

}  // namespace

Result<FeatureTransfer> bring_features(const Services& services, const jobs::TransferTarget& target,
                                       const jobs::TransferRequest& request,
                                       const std::string& user) {
  std::set<TableId> tables;
  for (const Layer& layer : request.layers)
    if (layer.table) tables.insert(*layer.table);
  FeatureTransfer all;
  for (const TableId table : tables) {
    const auto brought = STRATA_TRY(bring_features_of(services, table, target, request, user));
    all.features += brought.features;
    all.lost_features += brought.lost_features;
  }
  return all;
}

}  // namespace strata::app
