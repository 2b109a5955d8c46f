#include "app/bills/bill_depths.h"

#include "bill/units.h"
#include "domain/layers/layer.h"
#include "expression/expression.h"
#include "query/statistics/statistics.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/rooms.h"
#include "room/selection.h"
#include "store/content/layers.h"
#include "store/store.h"

namespace strata::app {
namespace {

using bill::ExactNumber;

tl::unexpected<Error> no_unit(const std::string& what, const std::string& field) {
  return fail(ErrorCode::invalid, "Unit of the depth missing",
              "The unit of the " + what + " is not mm, cm or m. Set its unit.", field);
}

}  // namespace

tl::unexpected<Error> no_such_source(const std::string& what, const std::string& field) {
  return fail(
      ErrorCode::invalid, "Source not found",
      "The " + what + " does not exist in this project, or you cannot see it. Choose another one.",
      field);
}

Result<BillDepths> BillDepths::of(const protocol::BillRule& rule, const Table* table) {
  BillDepths depths;
  if (!rule.depth) return depths;
  if (rule.depth->metres) depths.metres_ = ExactNumber::parse(*rule.depth->metres);
  if (rule.depth->column) {
    const Column* column = find_column(table->columns, *rule.depth->column);
    if (!column || (column->kind != ColumnKind::integer && column->kind != ColumnKind::numeric))
      return fail(ErrorCode::invalid, "Depth not found",
                  "The table has no column `" + *rule.depth->column + "` with numbers.",
                  "depth.column");
    const auto unit = bill::metres_of_unit(column->unit);
    if (!unit) return no_unit("column `" + column->name + "`", "depth.column");
    depths.column_ = column->id;
    depths.unit_ = *unit;
  }
  depths.layer_ = rule.depth->layer;
  return depths;
}

Result<ExactNumber> BillDepths::volume(const Services& services, const BillSource& source,
                                       const Layer& layer, double value, double area_m2,
                                       const Record* record) {
  if (layer_) return measured_volume(services, source, layer, value);
  const ExactNumber area = ExactNumber::measured(area_m2);
  if (metres_) return area * *metres_;
  const auto cell = record->values.find(*column_);
  if (cell == record->values.end() || !cell->second.is_number()) return ExactNumber(0);
  return area * ExactNumber::measured(cell->second.get<double>() * unit_);
}

Result<ExactNumber> BillDepths::measured_volume(const Services& services, const BillSource& source,
                                                const Layer& layer, double value) {
  if (++classes_ > kMaxDepthClasses)
    return fail(ErrorCode::invalid, "Too many depths",
                "A rule can read the depths of at most " + std::to_string(kMaxDepthClasses) +
                    " elements from a layer. Choose fewer elements, or use a column.",
                "depth.layer");
  const std::string model = to_string(layer.model_id);
  const auto depth =
      STRATA_TRY(of_rule(services.store.layers().find(layer.model_id, *layer_, source.seen_by),
                         "layer `" + *layer_ + "` with the depth", "depth.layer"));
  const auto unit = bill::metres_of_unit(depth.unit);
  if (!unit) return no_unit("layer `" + depth.name + "`", "depth.layer");
  if (depth.sequence == 0) return ExactNumber(0);
  const auto room = STRATA_TRY(services.rooms.open_to_read(model, source.seen_by));
  Expression number, painted, is_value;
  number.op = Expression::Op::number;
  number.number = value;
  painted.op = Expression::Op::layer;
  painted.name = layer.slug;
  is_value.op = Expression::Op::equal;
  is_value.parts = {painted, number};
  room::Selection selection;
  selection.where = is_value;
  selection.seen_by = source.seen_by;
  const auto found = STRATA_TRY(room->queries().statistics(depth.slug, selection));
  return ExactNumber::measured(found.texels > 0 ? found.area_m2 * found.mean * *unit : 0);
}

}  // namespace strata::app
