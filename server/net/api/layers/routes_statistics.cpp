#include <algorithm>

#include "app/authorization/visibility_leak_check.h"
#include "app/figures/class_names.h"
#include "app/records/readable_area.h"
#include "core/compensated_sum.h"
#include "core/text/base64.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "expression/expression_parser.h"
#include "media/picture.h"
#include "net/api/addressed.h"
#include "net/api/layers/region_reader.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/serialization/as_of.h"
#include "net/serialization/edit_serialization.h"
#include "net/serialization/sheet_response.h"
#include "net/serialization/statistics_serialization.h"
#include "net/transport/server_options.h"
#include "query/sampling/texel_samples.h"
#include "query/statistics/agreement.h"
#include "query/statistics/cross_table.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/selection.h"
#include "store/content/named_parts.h"
#include "store/store.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

Result<room::Selection> selection_of(const RouteContext& context, const Request& request,
                                     const room::Room& room,
                                     const std::optional<std::string>& where,
                                     const std::optional<protocol::Within>& within,
                                     const std::optional<protocol::At>& at) {
  room::Selection selection;
  if (where) {
    auto condition = STRATA_TRY(query::parse_condition(*where, "where"));
    selection.where = std::move(condition);
  }
  if (within) {
    protocol::Within part = *within;
    RegionReader reader(room, context.store.selections(), request.user());
    selection.within = STRATA_TRY(reader.read(part));
    selection.personal_field = reader.personal_field();
  }
  auto sequence = STRATA_TRY(find_sequence(context, room, at));
  selection.at = sequence;
  return selection;
}

Result<Response> statistics(const RouteContext& context, const Request& request) {
  const auto options = STRATA_TRY(statistics_options(request));
  auto room = STRATA_TRY(open_room(context, request));
  auto layer = STRATA_TRY(room->layers().find(request.param("layer")));
  std::optional<std::string> where;
  if (const auto given = request.query.find("where"); given != request.query.end())
    where = given->second;
  const auto selection =
      STRATA_TRY(selection_of(context, request, *room, where, std::nullopt, as_of(request)));
  const auto sequence = selection.at.value_or(room->edits().sequence());
  auto statistics = room->queries().statistics(layer.slug, selection, options);
  if (!statistics) return tl::unexpected(statistics.error());
  Response response = json_response(to_json(*statistics));
  add_sequences(response, sequence, room->edits().durable_sequence());
  return response;
}

Result<room::Selection::Changed> changed_of(const RouteContext& context, const room::Room& room,
                                            const protocol::SelectChanged& body) {
  const auto sequence_of = [&](const protocol::At& at,
                               const std::string& field) -> Result<std::int64_t> {
    auto found = find_sequence(context, room, at);
    if (found) return **found;
    found.error().field = field;
    return tl::unexpected(std::move(found.error()));
  };
  room::Selection::Changed changed;
  changed.from = STRATA_TRY(sequence_of(body.from, "changed.from"));
  changed.to = room.edits().durable_sequence();
  if (body.to) changed.to = STRATA_TRY(sequence_of(*body.to, "changed.to"));
  std::vector<Layer> layers;
  if (body.layers) {
    std::vector<std::string> refs;
    for (const auto& ref : *body.layers) refs.push_back(protocol::to_ref(ref));
    layers = STRATA_TRY(find_layers(room, refs, "changed.layers"));
  } else {
    layers = room.layers().all();
  }
  for (const Layer& layer : layers) changed.layers.push_back(layer.slug);
  return changed;
}

// Checks that all users who see the painted layer may also see the layers that select the area. The
// layers of conditions are checked when the conditions are evaluated (Selection::painted_for).
Result<void> check_can_show(const room::Room& room, const room::Selection& selection,
                            const Layer& painted) {
  if (!selection.personal_field.empty())
    return fail(ErrorCode::invalid, "Personal selection",
                "Only you can see this selection, but other users can see the painted layer. Save "
                "the selection for everyone, or send its definition.",
                selection.personal_field);
  for (const room::LayerRead& read : room::layers_compared(selection)) {
    const auto source = STRATA_TRY(room.layers().find(read.slug));
    STRATA_TRY(app::check_all_may_see(source, painted, read.field));
  }
  return {};
}

// Changes the area of the edit to the selected texels of its layer.
void fill_only(room::EditRequest& edit, const protocol::Within& within,
               room::SelectedArea::Texels selected) {
  std::get<room::FillEdit>(edit.edit).region = room::FillEdit::Selected{
      std::make_shared<const query::TexelSelection>(std::move(selected.texels)),
      selected.resolution};
  edit.record.erase("where");
  edit.record["mode"] = "selection";
  edit.record["within"] = protocol::to_json(within);
}

// The edit that paints the selection, and its layer.
struct Painting {
  room::EditRequest edit;
  std::string slug;
};

// Returns the edit that paints the texels where the condition is true when the edit starts. With
// `within`, it gets its area from the selection (`fill_only`), which then reads only what all users
// of the layer can see.
Result<Painting> painting(const Request& request, const protocol::SelectRequest& body,
                          room::Selection& selection, const room::Room& room) {
  if (request.principal->role < Role::annotator)
    return fail(
        ErrorCode::forbidden, "Not allowed",
        "Only annotators can use `into`, because it paints on a layer. Ask an administrator "
        "for the role annotator.",
        "into");
  if (body.where.has_value() == body.within.has_value() || body.at || body.changed)
    return fail(ErrorCode::invalid, "Cannot paint this area",
                "`into` can paint where a condition is true, or a part of the surface, in the "
                "current state. Send either `where` or `within`, but not `changed` or `at`.",
                "into");
  const auto layer = room.layers().find(protocol::to_ref(body.into->layer));
  if (!layer) {
    Error problem = layer.error();
    problem.field = "into.layer";
    return tl::unexpected(std::move(problem));
  }
  protocol::EditFill fill;
  fill.mode = protocol::EditFillMode::where;
  fill.where = body.where.value_or("true");
  fill.value = body.into->value;
  fill.erase = body.into->erase;
  auto edit = STRATA_TRY(edit_request(fill, *layer, room.model(),
                                      edit_id(request, *layer, "select"), request.author()));
  STRATA_TRY(check_can_show(room, selection, *layer));
  if (selection.within) selection.painted_for = layer->visibility;
  return Painting{std::move(edit), layer->slug};
}

// Returns a PNG that is white where the byte is 1 and transparent elsewhere.
std::vector<std::uint8_t> selection_png(const std::vector<std::uint8_t>& seen, int width,
                                        int height) {
  std::vector<std::uint8_t> rgba(seen.size() * 4, 0);
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i] != 0) std::fill_n(rgba.begin() + static_cast<std::ptrdiff_t>(i * 4), 4, 255);
  return encode_png(rgba, width, height);
}

void select(const RouteContext& context, const Request& request, const Respond& respond) {
  const auto select_request = body_of<protocol::SelectRequest>(request);
  if (!select_request) return respond(select_request.error());
  const auto room = open_room(context, request);
  if (!room) return respond(room.error());
  std::vector<std::string> refs, slugs;
  for (const auto& ref : select_request->layers.value_or(std::vector<protocol::LayerRef>{}))
    refs.push_back(protocol::to_ref(ref));
  const auto layers = find_layers(**room, refs, "layers");
  if (!layers) return respond(layers.error());
  for (const auto& layer : *layers) slugs.push_back(layer.slug);
  auto selection = selection_of(context, request, **room, select_request->where,
                                select_request->within, select_request->at);
  if (!selection) return respond(selection.error());
  if (select_request->changed) {
    auto changed = changed_of(context, **room, *select_request->changed);
    if (!changed) return respond(changed.error());
    selection->changed = std::move(*changed);
  }
  auto options = statistics_options(select_request->include);
  if (const auto& picture = select_request->picture)
    options.seen = room::SeenGrid{picture->camera, picture->width, picture->height};
  std::optional<room::EditRequest> edit;
  if (select_request->into) {
    auto made = painting(request, *select_request, *selection, **room);
    if (!made) return respond(made.error());
    edit = std::move(made->edit);
    options.painted = std::move(made->slug);
  }
  const auto sequence = selection->at.value_or((*room)->edits().sequence());
  auto area = (*room)->queries().select(*selection, slugs, options);
  if (!area) return respond(area.error());
  if (edit && select_request->within)
    fill_only(*edit, *select_request->within, std::move(area->painted.value()));
  nlohmann::json body = to_json(*area);
  if (const auto& grid = options.seen)
    body["picture"] = to_base64(selection_png(area->seen, grid->columns, grid->rows));
  if (edit)
    return apply_edit(context, request, *room, std::move(*edit), respond,
                      [body](nlohmann::json of_edit) mutable {
                        body["edit"] = std::move(of_edit);
                        return std::move(body);
                      });
  Response response = json_response(body);
  add_sequences(response, sequence, (*room)->edits().durable_sequence());
  respond(std::move(response));
}

constexpr const char* kNoValue = "–";  // for texels without a value

// Returns the names for one axis of a cross-table.
Result<std::vector<std::string>> side_names(const RouteContext& context, const room::Room& room,
                                            const Layer& layer, Role role,
                                            const std::vector<query::CrossTable::Key>& side,
                                            std::optional<std::int64_t> at,
                                            const std::string& language) {
  std::vector<double> values;
  for (const auto& key : side)
    if (key) values.push_back(*key);
  std::optional<std::int64_t> records_at;  // sequence of the table at the edit `at`
  if (layer.table && at) {
    const auto found =
        STRATA_TRY(context.store.tables().sequence_when(*layer.table, room.model().id, *at));
    records_at = found;
  }
  auto names = app::class_names(context.store, layer, role, values, records_at, language);
  if (names && values.size() < side.size()) names->emplace_back(kNoValue);  // for "no value"
  return names;
}

// Returns the table with names and sums, in the unit that suits the total area.
app::Sheet sheet_of(const query::CrossTable& table, const Layer& rows, const Layer& columns,
                    const std::vector<std::string>& row_names,
                    const std::vector<std::string>& column_names) {
  CompensatedSum all_m2;
  for (const auto& row : table.area_m2)
    for (const double area_m2 : row) all_m2 += area_m2;
  const app::AreaUnit unit = app::readable_area(all_m2.value());
  app::Sheet sheet{rows.slug + "-" + columns.slug,
                   {rows.name + " / " + columns.name + ", " + unit.name},
                   {},
                   {}};
  sheet.heads.insert(sheet.heads.end(), column_names.begin(), column_names.end());
  sheet.heads.emplace_back("total");
  std::vector<CompensatedSum> sums(column_names.size() + 1);
  for (std::size_t row = 0; row < row_names.size(); ++row) {
    std::vector<app::SheetCell> cells{row_names[row]};
    CompensatedSum sum;
    for (std::size_t column = 0; column < column_names.size(); ++column) {
      const double area = table.area_m2[row][column] * unit.per_m2;
      cells.emplace_back(area);
      sums[column] += area;
      sum += area;
    }
    cells.emplace_back(sum.value());
    sums.back() += sum;
    sheet.rows.push_back(std::move(cells));
  }
  std::vector<app::SheetCell> last{std::string("total")};
  for (const CompensatedSum& sum : sums) last.emplace_back(sum.value());
  sheet.rows.push_back(std::move(last));
  sheet.number_formats.assign(sheet.heads.size(), app::number_format(all_m2.value() * unit.per_m2));
  return sheet;
}

nlohmann::json table_json(const query::CrossTable& table, const Layer& rows, const Layer& columns) {
  nlohmann::json json = to_json(table);
  if (query::share_classes(rows, columns))
    if (const auto agreement = query::measure_agreement(table))
      json["agreement"] = to_json(*agreement);
  return json;
}

Result<Response> cross_table(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::CrossTableRequest>(request));
  // A script that sends no `f` gets keys. A sheet contains names because users read it.
  const bool as_csv = !request.query.contains("f") &&
                      request.header("accept").find("text/csv") != std::string_view::npos;
  const auto format =
      STRATA_TRY(as_csv ? Result<SheetFormat>(SheetFormat::csv) : sheet_format(request));
  const auto separator = STRATA_TRY(csv_separator(request));
  const auto language = STRATA_TRY(requested_language(request));
  const auto room = STRATA_TRY(open_room(context, request));
  const auto rows = STRATA_TRY(find_layers(*room, {protocol::to_ref(body.rows)}, "rows"));
  const auto columns = STRATA_TRY(find_layers(*room, {protocol::to_ref(body.columns)}, "columns"));
  const auto selection =
      STRATA_TRY(selection_of(context, request, *room, body.where, body.within, body.at));
  const auto sequence = selection.at.value_or(room->edits().sequence());
  const auto table =
      room->queries().cross_table(rows.front().slug, columns.front().slug, selection);
  if (!table) return tl::unexpected(table.error());
  Response response =
      as_csv ? text_response(cross_table_csv(*table, rows.front().slug, columns.front().slug),
                             kCsvType)
             : json_response(table_json(*table, rows.front(), columns.front()));
  if (!as_csv && format != SheetFormat::json) {
    const auto side = [&](const Layer& layer, const std::vector<query::CrossTable::Key>& keys) {
      return side_names(context, *room, layer, request.role(), keys, selection.at, language);
    };
    const auto row_names = STRATA_TRY(side(rows.front(), table->rows));
    const auto column_names = STRATA_TRY(side(columns.front(), table->columns));
    auto sheet =
        sheet_response(sheet_of(*table, rows.front(), columns.front(), row_names, column_names),
                       format, separator, context.options.upload_dir);
    if (!sheet) return sheet;
    response = std::move(*sheet);
  }
  add_sequences(response, sequence, room->edits().durable_sequence());
  response.with("Vary", "Accept");
  return response;
}

}  // namespace

void add_statistics_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/layers/{layer}/statistics",
              .handler = answering(
                  [&context](const Request& request) { return statistics(context, request); }),
              .query = {"include", "at", "where"},
              .is_question = true,
              .state = state_of_model(context)});
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/select",
              .handler = [&context](const Request& request,
                                    const Respond& respond) { select(context, request, respond); },
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/cross-table",
              .handler = answering(
                  [&context](const Request& request) { return cross_table(context, request); }),
              .query = {"f", "separator", "lang"},
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
}

}  // namespace strata::net
