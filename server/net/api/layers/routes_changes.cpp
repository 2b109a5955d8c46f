// The comparison of a layer with the layer of another survey, as a job.
#include <cmath>
#include <utility>

#include "app/layers/changes_sheet.h"
#include "app/layers/layer_changes.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "jobs/job_queue.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/job_idempotency.h"
#include "net/serialization/sheet_response.h"
#include "net/serialization/statistics_serialization.h"
#include "net/transport/server_options.h"
#include "room/layers.h"
#include "room/room.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/store.h"

namespace strata::net {
namespace {

Result<Layer> layer_of_other(store::Store& store, const Model& other, Role seen_by,
                             const std::optional<std::string>& ref, const std::string& name) {
  const auto absent = [&](const std::string& layer) {
    return fail(ErrorCode::invalid, "Layer not found",
                other.name + " has no layer \"" + layer + "\".", "layer");
  };
  if (ref) {
    auto layer = store.layers().find(other.id, *ref, seen_by);
    if (!layer && layer.error().code == ErrorCode::not_found) return absent(*ref);
    return layer;
  }
  auto layers = STRATA_TRY(store.layers().of_model(other.id, seen_by));
  for (Layer& layer : layers)
    if (layer.name == name) return std::move(layer);
  return absent(name);
}

Result<app::ChangesSince> changes_since(store::Store& store,
                                        const protocol::LayerChangesRequest& body,
                                        const Model& model, const Layer& layer,
                                        const Principal& who) {
  auto other = store.models().find(body.since);
  if (other ? !who.sees(other->project_id) : other.error().code == ErrorCode::not_found)
    return fail(ErrorCode::invalid, "Model not found", "There is no model \"" + body.since + "\".",
                "since");
  if (!other) return tl::unexpected(other.error());
  if (other->id == model.id)
    return fail(ErrorCode::invalid, "Same model",
                "A model has no changes since itself. Choose another model.", "since");
  // Curators of this project can see the result.
  if (other->project_id != model.project_id)
    return fail(ErrorCode::invalid, "Different projects",
                other->name + " is in another project. Choose a model of this project.", "since");
  if (!other->crs.empty() && !model.crs.empty() && other->crs != model.crs)
    return fail(ErrorCode::invalid, "Different coordinate systems",
                "This model has the coordinate system " + model.crs + ", but the other model has " +
                    other->crs +
                    ". Transform both scans into one coordinate system and import them again.",
                "since");
  auto then = STRATA_TRY(
      layer_of_other(store, *other, who.roles.in(other->project_id), body.layer, layer.name));
  STRATA_TRY(app::check_comparable(layer, then));
  return app::ChangesSince{std::move(*other), std::move(then), body.tolerance_mm, body.max_angle,
                           body.min_area_cm2 / 1e4};
}

nlohmann::json areas_json(const std::map<double, double>& areas) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [value, area_m2] : areas)
    list.push_back({{"value", value}, {"area_m2", area_m2}});
  return list;
}

nlohmann::json pieces_json(const app::ChangedPieces& pieces) {
  nlohmann::json list = nlohmann::json::array();
  for (const app::ChangedPiece& piece : pieces.list)
    list.push_back({{"value", piece.value},
                    {"area_m2", piece.area_m2},
                    {"at", {piece.at.x, piece.at.y, piece.at.z}}});
  return {{"pieces", std::move(list)}, {"total", pieces.total}, {"area_m2", pieces.area_m2}};
}

nlohmann::json report_of(const app::LayerChanges& changes, const app::ChangesSince& since) {
  return {{"since", since.model.id},
          {"layer", since.layer.id},
          {"area_m2", changes.area_m2},
          {"matched_m2", changes.matched_m2},
          {"table", to_json(changes.table)},
          {"unmatched_now", areas_json(changes.unmatched_now_m2)},
          {"unmatched_then", areas_json(changes.unmatched_then_m2)},
          {"appeared", pieces_json(changes.appeared)},
          {"vanished", pieces_json(changes.vanished)}};
}

// The file that a job makes of the table, if the request asks for one.
struct TableFile {
  SheetFormat format;
  char separator;
  Role seen_by;
  std::string language;
  std::filesystem::path folder;
};

Result<TableFile> table_file(const RouteContext& context, const Request& request) {
  // `Accept` is for the response, which is a job.
  const auto format = STRATA_TRY(
      request.query.contains("f") ? sheet_format(request) : Result<SheetFormat>(SheetFormat::json));
  const auto separator = STRATA_TRY(csv_separator(request));
  auto language = STRATA_TRY(requested_language(request));
  return TableFile{format, separator, request.role(), std::move(language),
                   context.options.upload_dir};
}

Result<std::shared_ptr<const TemporaryFile>> write_table(store::Store& store,
                                                         const app::LayerChanges& changes,
                                                         const Layer& now,
                                                         const app::ChangesSince& since,
                                                         const TableFile& file) {
  if (file.format == SheetFormat::json) return nullptr;
  const auto sheet =
      STRATA_TRY(app::changes_sheet(store, changes, now, since, file.seen_by, file.language));
  return file.format == SheetFormat::xlsx ? app::write_workbook(sheet, file.folder)
                                          : app::write_csv(sheet, file.separator, file.folder);
}

Result<Response> start_comparison(const RouteContext& context, JobIdempotency& book,
                                  const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::LayerChangesRequest>(request));
  const auto room = STRATA_TRY(open_room(context, request));
  const auto layer = STRATA_TRY(room->layers().find(request.param("layer")));
  auto since =
      STRATA_TRY(changes_since(context.store, body, room->model(), layer, *request.principal));
  auto file = STRATA_TRY(table_file(context, request));
  const auto known = STRATA_TRY(book.find(request));
  if (known) return std::move(job_response(context, *known).with("Idempotency-Replayed", "true"));
  const auto job = STRATA_TRY(context.jobs.add(
      room->model().project_id,
      [&services = static_cast<const app::Services&>(context), room, layer,
       since = std::move(since),
       file = std::move(file)](Progress& progress) -> Result<jobs::JobResult> {
        const auto changes =
            STRATA_TRY(app::compare_layers(services, *room, layer.id, since, progress));
        jobs::JobResult result(room->model().id);
        result.report = report_of(changes, since);
        result.file = STRATA_TRY(write_table(services.store, changes, layer, since, file));
        return result;
      },
      request.user(), jobs::JobKind::changes));
  book.started(request, job);
  return job_response(context, job);
}

}  // namespace

void add_change_routes(Router& router, const RouteContext& context) {
  auto book = std::make_shared<JobIdempotency>(context.jobs);
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/layers/{layer}/changes",
              .handler = answering([&context, book](const Request& request) {
                return start_comparison(context, *book, request);
              }),
              .role = Role::annotator,
              .query = {"f", "separator", "lang"},
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes});
}

}  // namespace strata::net
