#include "app/records/painted_keys.h"

#include <algorithm>
#include <cstdio>

#include "app/change_notifier.h"
#include "app/edits.h"
#include "app/records/readable_area.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/tables/table.h"
#include "expression/expression.h"
#include "room/edit.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/content/layers.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/table_changes.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace {

constexpr std::size_t kMaxNamed = 5;

std::string area_text(double area_m2) {
  const AreaUnit unit = readable_area(area_m2);
  char number[48];
  std::snprintf(number, sizeof number, "%.2f ", area_m2 * unit.per_m2);
  return number + unit.name;
}

}  // namespace

Result<std::vector<PaintedLayer>> painted_layers(const Services& services, TableId table_id,
                                                 Role seen_by) {
  auto layers = STRATA_TRY(services.store.layers().of_table(table_id, seen_by));
  std::vector<PaintedLayer> painted;
  for (Layer& layer : layers) {
    if (layer.sequence == 0) continue;  // the layer was never painted
    auto room = STRATA_TRY(services.rooms.open(to_string(layer.model_id), seen_by));
    auto areas = room->queries().key_areas(layer.slug);
    if (!areas && areas.error().code == ErrorCode::not_found) continue;  // the layer is deleted
    if (!areas) return tl::unexpected(areas.error());
    painted.push_back({std::move(room), std::move(layer), std::move(*areas)});
  }
  return painted;
}

std::string where_painted(const std::vector<PaintedLayer>& layers,
                          const std::vector<std::int64_t>& keys) {
  std::string text;
  std::size_t named = 0;
  for (const PaintedLayer& painted : layers) {
    double area_m2 = 0;
    bool found = false;
    for (const auto key : keys)
      if (const auto area = painted.areas.find(key); area != painted.areas.end()) {
        found = true;
        area_m2 += area->second.area_m2;
      }
    if (!found) continue;
    if (++named > kMaxNamed) return text + ", …";
    text += (text.empty() ? "" : ", ") + area_text(area_m2) + " on " + painted.layer.name + " of " +
            painted.room->model().name;
  }
  return text;
}

Result<void> repaint_key(const Services& services, const std::vector<PaintedLayer>& layers,
                         std::int64_t key, std::optional<std::int64_t> to, const Author& author) {
  for (const PaintedLayer& painted : layers) {
    if (!painted.areas.contains(key)) continue;
    STRATA_TRY(room::check_not_locked(painted.layer, author.role));
    if (to && static_cast<double>(*to) > highest_value(painted.layer.type))
      return fail(
          ErrorCode::invalid, "Key too large",
          painted.layer.name + " of " + painted.room->model().name + " can store keys up to " +
              std::to_string(static_cast<std::int64_t>(highest_value(painted.layer.type))) + ".",
          "to");
  }
  for (const PaintedLayer& painted : layers) {
    if (!painted.areas.contains(key)) continue;
    Expression number, of_layer, equal;
    number.op = Expression::Op::number;
    number.number = static_cast<double>(key);
    of_layer.op = Expression::Op::layer;
    of_layer.name = painted.layer.slug;
    equal.op = Expression::Op::equal;
    equal.parts = {of_layer, number};
    room::FillEdit fill;
    fill.erase = !to;
    fill.value_bits = static_cast<std::uint32_t>(to.value_or(0));
    fill.region = room::FillEdit::Where{std::move(equal)};
    room::EditRequest edit{random_uuid(), author, painted.layer.id};
    edit.record = {{"op", "fill"},
                   {"mode", "where"},
                   {"where", "\"" + painted.layer.slug + "\" = " + std::to_string(key)},
                   {"value", to.value_or(0)},
                   {"erase", !to}};
    edit.edit = std::move(fill);
    STRATA_TRY(edit_and_wait(*painted.room, std::move(edit), services.edits));
  }
  return {};
}

Result<void> records_from_legend(const Services& services, const Layer& layer,
                                 const std::vector<std::int64_t>& keys, const Author& author) {
  if (keys.empty() || !layer.table || !lists_values(layer.palette)) return {};
  const auto missing = STRATA_TRY(services.store.records().missing(*layer.table, keys));
  auto table = STRATA_TRY(services.store.tables().find(to_string(*layer.table), author.role));
  const auto text =
      std::find_if(table.columns.begin(), table.columns.end(),
                   [](const Column& column) { return column.kind == ColumnKind::text; });
  store::WriteRecords write;
  write.op = "import";
  for (const auto& point : layer.palette.points) {
    const auto key = static_cast<std::int64_t>(point.at);
    if (point.label.empty() || static_cast<double>(key) != point.at ||
        !std::binary_search(missing.begin(), missing.end(), key))
      continue;
    write.records.push_back({key, {}});
    if (text != table.columns.end()) write.records.back().values[text->id] = point.label;
  }
  if (write.records.empty()) return {};
  STRATA_TRY(room::check_not_locked(layer, author.role));
  auto change = STRATA_TRY(services.store.records().write(table.id, write, author.user));
  if (!change.problems.empty()) return tl::unexpected(change.problems.front().problem);
  services.changes.records_changed(change, author.user);
  return {};
}

Result<void> check_keys(store::Store& store, const Layer& layer,
                        const std::vector<std::int64_t>& keys) {
  if (keys.empty() || !layer.table) return {};
  const auto missing = STRATA_TRY(store.records().missing(*layer.table, keys));
  if (missing.empty()) return {};
  std::string named;
  for (std::size_t i = 0; i < std::min(missing.size(), kMaxNamed); ++i)
    named += (i ? ", " : "") + std::to_string(missing[i]);
  return fail(ErrorCode::invalid, "Record not found",
              "The table of " + layer.name + " has no record " + named +
                  (missing.size() > kMaxNamed ? ", …" : "") +
                  ". Create the record first, then paint.",
              "value");
}

}  // namespace strata::app
