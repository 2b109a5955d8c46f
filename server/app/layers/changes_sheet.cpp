#include "app/layers/changes_sheet.h"

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "app/figures/class_names.h"
#include "app/records/readable_area.h"
#include "core/compensated_sum.h"

namespace strata::app {
namespace {

using Key = query::CrossTable::Key;

// One axis of the table: the values, then the surface without a value, then the surface without a
// counterpart.
struct Axis {
  std::vector<double> values;
  std::vector<std::string> names;
};

Result<Axis> axis_of(store::Store& store, const std::vector<Key>& known,
                     const std::map<double, double>& unmatched, const Layer& layer, Role seen_by,
                     const std::string& language) {
  std::set<double> values;
  for (const Key& key : known)
    if (key) values.insert(*key);
  for (const auto& [value, area] : unmatched) values.insert(value);
  Axis axis{{values.begin(), values.end()}, {}};
  axis.names = STRATA_TRY(class_names(store, layer, seen_by, axis.values, std::nullopt, language));
  axis.names.emplace_back("not painted");
  axis.names.emplace_back("no counterpart");
  return axis;
}

// The areas of the table by row and column of the axes.
std::vector<std::vector<double>> areas_of(const LayerChanges& changes, const Axis& rows,
                                          const Axis& columns) {
  std::vector<std::vector<double>> areas(rows.names.size(),
                                         std::vector<double>(columns.names.size(), 0));
  const auto place = [](const Axis& axis, const Key& key) {
    if (!key) return axis.values.size();
    return static_cast<std::size_t>(std::ranges::lower_bound(axis.values, *key) -
                                    axis.values.begin());
  };
  const query::CrossTable& table = changes.table;
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    for (std::size_t column = 0; column < table.columns.size(); ++column)
      areas[place(rows, table.rows[row])][place(columns, table.columns[column])] =
          table.area_m2[row][column];
  for (const auto& [value, area] : changes.unmatched_now_m2)
    areas.back()[place(columns, value)] = area;
  for (const auto& [value, area] : changes.unmatched_then_m2)
    areas[place(rows, value)].back() = area;
  return areas;
}

}  // namespace

Result<Sheet> changes_sheet(store::Store& store, const LayerChanges& changes, const Layer& now,
                            const ChangesSince& since, Role seen_by, const std::string& language) {
  const auto rows = STRATA_TRY(axis_of(store, changes.table.rows, changes.unmatched_then_m2,
                                       since.layer, seen_by, language));
  const auto columns = STRATA_TRY(
      axis_of(store, changes.table.columns, changes.unmatched_now_m2, now, seen_by, language));
  auto areas = areas_of(changes, rows, columns);
  CompensatedSum all_m2;
  for (const auto& row : areas)
    for (const double area : row) all_m2 += area;
  const AreaUnit unit = readable_area(all_m2.value());
  Sheet sheet{now.slug + "-changes", {since.model.name + " / now, " + unit.name}, {}, {}};
  sheet.heads.insert(sheet.heads.end(), columns.names.begin(), columns.names.end());
  sheet.heads.emplace_back("total");
  std::vector<CompensatedSum> sums(columns.names.size() + 1);
  for (std::size_t row = 0; row < rows.names.size(); ++row) {
    std::vector<SheetCell> cells{rows.names[row]};
    CompensatedSum sum;
    for (std::size_t column = 0; column < columns.names.size(); ++column) {
      const double area = areas[row][column] * unit.per_m2;
      cells.emplace_back(area);
      sums[column] += area;
      sum += area;
    }
    cells.emplace_back(sum.value());
    sums.back() += sum;
    sheet.rows.push_back(std::move(cells));
  }
  std::vector<SheetCell> last{std::string("total")};
  for (const CompensatedSum& sum : sums) last.emplace_back(sum.value());
  sheet.rows.push_back(std::move(last));
  sheet.number_formats.assign(sheet.heads.size(), number_format(all_m2.value() * unit.per_m2));
  return sheet;
}

}  // namespace strata::app
