#include "app/layers/mark_transfer.h"

#include <algorithm>
#include <set>

#include "app/change_notifier.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/tables/mark.h"
#include "domain/tables/table.h"
#include "jobs/transfer_marks.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/table_changes.h"

namespace strata::app {
namespace {

Result<MarkTransfer> bring_marks_of(const Services& services, std::int64_t table_id,
                                    const jobs::TransferTarget& target,
                                    const jobs::TransferRequest& request, const std::string& user) {
  MarkTransfer brought;
  store::RecordQuery query;
  query.limit = store::kMostRecords;
  const auto page = STRATA_TRY(services.store.records().page(table_id, Role::curator, query));
  store::WriteRecords write;
  write.op = "transfer";
  write.may_create = false;
  for (const Record& record : page.records) {
    store::RecordInput input{record.key, {}, record.version};
    for (const Column& column : page.table.columns) {
      if (!holds_marks(column.kind)) continue;
      auto marks = marks_of(record, column);
      if (std::ranges::any_of(marks,
                              [&](const Mark& mark) { return mark.model == target.model.id; }))
        continue;
      std::vector<Mark> there;
      std::ranges::copy_if(marks, std::back_inserter(there),
                           [&](const Mark& mark) { return mark.model == request.source.id; });
      auto found = jobs::transfer_marks(there, request.source, target, request.tolerance_mm);
      brought.lost_marks += found.lost_marks;
      if (found.marks.empty()) continue;
      marks.insert(marks.end(), found.marks.begin(), found.marks.end());
      auto value = to_json(marks);
      if (!read_marks(value, column.kind == ColumnKind::line)) {  // more than a cell may hold
        brought.lost_marks += found.marks.size();
        continue;
      }
      brought.marks += found.marks.size();
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

Result<MarkTransfer> bring_marks(const Services& services, const jobs::TransferTarget& target,
                                 const jobs::TransferRequest& request, const std::string& user) {
  std::set<std::int64_t> tables;
  for (const Layer& layer : request.layers)
    if (layer.table) tables.insert(*layer.table);
  MarkTransfer all;
  for (const std::int64_t table : tables) {
    const auto brought = STRATA_TRY(bring_marks_of(services, table, target, request, user));
    all.marks += brought.marks;
    all.lost_marks += brought.lost_marks;
  }
  return all;
}

}  // namespace strata::app
