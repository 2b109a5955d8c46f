#include "app/layers/feature_transfer.h"
#include "core/digest.h"
#include "core/mapped_file.h"
#include "core/text/number_text.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "jobs/job_queue.h"
#include "jobs/shape_layer.h"
#include "jobs/transfer.h"
#include "mesh/io/input_files.h"
#include "mesh/io/vertex_properties.h"
#include "net/api/addressed.h"
#include "net/api/layers/layer_jobs.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/transport/server_options.h"
#include "room/edit.h"
#include "room/layers.h"
#include "room/room.h"
#include "room/surface.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/store.h"

namespace strata::net {
namespace {

constexpr std::size_t kMaxProperties = 10000;
constexpr std::uint64_t kMaxCsvBytes = 1ull << 30;

Result<std::vector<Layer>> chosen_layers(store::Store& store, const Model& source, Role seen_by,
                                         const Model& target,
                                         const std::optional<std::vector<std::string>>& refs) {
  std::vector<Layer> layers;
  if (refs) {
    for (const std::string& ref : *refs) {
      auto layer = store.layers().find(source.id, ref, seen_by);
      if (!layer && layer.error().code == ErrorCode::not_found)
        return fail(ErrorCode::invalid, "Layer not found",
                    source.name + " has no layer \"" + ref + "\".", "layers");
      if (!layer) return tl::unexpected(layer.error());
      layers.push_back(std::move(*layer));
    }
  } else {
    auto all = STRATA_TRY(store.layers().of_model(source.id, seen_by));
    layers = std::move(all);
  }
  if (layers.empty())
    return fail(ErrorCode::invalid, "No layers to transfer",
                source.name + " has no layers to transfer.", "from");
  for (const Layer& layer : layers)
    if (layer.table && source.project_id != target.project_id)
      return fail(ErrorCode::invalid, "Table of another project",
                  "The keys of the layer " + layer.name +
                      " belong to a table of another project. Choose other layers.",
                  "layers");
  return layers;
}

Result<jobs::TransferRequest> transfer_request(store::Store& store, const protocol::Transfer& body,
                                               const Model& target, const Principal& who) {
  auto source = store.models().find(body.from);
  if (source ? !who.sees(source->project_id) : source.error().code == ErrorCode::not_found)
    return fail(ErrorCode::invalid, "Model not found", "There is no model \"" + body.from + "\".",
                "from");
  if (!source) return tl::unexpected(source.error());
  if (source->id == target.id)
    return fail(ErrorCode::invalid, "Same model",
                "A model cannot get layers from itself. Choose another model.", "from");
  if (!source->crs.empty() && !target.crs.empty() && source->crs != target.crs)
    return fail(ErrorCode::invalid, "Different coordinate systems",
                "This model has the coordinate system " + target.crs +
                    ", but the other model has " + source->crs +
                    ". Transform both scans into one coordinate system and import them again.",
                "from");
  auto layers =
      chosen_layers(store, *source, who.roles.in(source->project_id), target, body.layers);
  if (!layers) return tl::unexpected(layers.error());
  return jobs::TransferRequest{std::move(*source), std::move(*layers), body.tolerance_mm,
                               body.max_angle};
}

// Returns a copy of a layer of the source model for the target model.
Layer copy_of(const Layer& from, int resolution, int order, const jobs::TransferRequest& request) {
  Layer layer = from;
  layer.id = 0;
  layer.resolution = resolution;
  layer.order = order;
  layer.locked = false;   // users continue to edit the copy
  layer.formula.reset();  // the transfer copies the values unchanged
  layer.origin.reset();
  layer.edited_by_hand = false;
  layer.description += (layer.description.empty() ? "" : "\n\n") +
                       std::string("Transferred from ") + request.source.name + ", within " +
                       short_number(request.tolerance_mm) + " mm.";
  return layer;
}

Result<nlohmann::json> transfer(const RouteContext& context, room::Room& room,
                                const jobs::TransferRequest& request, const std::string& user,
                                app::NewLayers& layers, Progress& progress) {
  jobs::TransferTarget target{room.model(), room.surface().geometry(), room.surface().search_tree(),
                              [&room](int resolution) { return room.surface().map(resolution); }};
  int order = app::order_on_top(room.layers().all());
  nlohmann::json report{{"from", request.source.id}, {"layers", nlohmann::json::array()}};
  const auto deliver = [&](jobs::TransferredLayer transferred) -> Result<void> {
    Layer layer = copy_of(*transferred.from, transferred.resolution, order++, request);
    layer.model_id = target.model.id;
    const nlohmann::json recipe{{"kind", "transfer"},
                                {"model", to_string(request.source.id)},
                                {"layer", to_string(transferred.from->id)},
                                {"tolerance_mm", request.tolerance_mm},
                                {"max_angle", request.max_angle_degrees}};
    auto made = STRATA_TRY(layers.add(std::move(layer), std::move(transferred.tiles), recipe));
    report["layers"].push_back({{"from", transferred.from->id},
                                {"layer", made.id},
                                {"name", made.name},
                                {"source_m2", transferred.source_m2},
                                {"transferred_m2", transferred.transferred_m2},
                                {"lost_m2", transferred.lost_m2}});
    return {};
  };
  auto summary =
      STRATA_TRY(jobs::transfer_layers(context.store, target, request, deliver, progress));
  report["area_m2"] = summary.area_m2;
  report["matched_m2"] = summary.matched_m2;
  const auto brought = STRATA_TRY(app::bring_features(context, target, request, user));
  report["marks"] = brought.features;
  report["lost_marks"] = brought.lost_features;
  return report;
}

Result<Response> start_transfer(const RouteContext& context, JobIdempotency& book,
                                const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::Transfer>(request));
  auto room = open_room(context, request);
  if (!room) return tl::unexpected(room.error());
  auto job_request = transfer_request(context.store, body, (*room)->model(), *request.principal);
  if (!job_request) return tl::unexpected(job_request.error());
  return start_layer_job(context, book, request, *room,
                         [&context, room = *room, job_request = std::move(*job_request),
                          user = request.user()](app::NewLayers& layers, Progress& progress) {
                           return transfer(context, *room, job_request, user, layers, progress);
                         });
}

Result<Response> list_properties(const RouteContext& context, const Request& request) {
  auto model = STRATA_TRY(stored_model(context, request));
  nlohmann::json list = nlohmann::json::array();
  for (const SourceFile& source : model.source_files) {
    std::vector<std::uint8_t> beginning;
    auto read = context.store.models().read_source(model.id, source.name,
                                                   [&](std::span<const std::uint8_t> chunk) {
                                                     beginning.assign(chunk.begin(), chunk.end());
                                                     return false;
                                                   });
    if (!read) return tl::unexpected(read.error());
    for (const std::string& property : mesh::vertex_property_names(beginning))
      if (list.size() < kMaxProperties)
        list.push_back({{"source", source.name}, {"property", property}});
  }
  const std::size_t total = list.size();
  return json_response({{"properties", std::move(list)}, {"total", total}});
}

// Returns the scan with the name `requested`. If it is empty, returns the only scan whose format
// keeps the order of vertices.
Result<std::string> scan_of(const Model& model, const std::string& requested) {
  std::vector<std::string> scans;
  for (const SourceFile& source : model.source_files) {
    const auto kind = mesh::input_kind(source.name);
    const bool has_order = kind == mesh::InputKind::ply || kind == mesh::InputKind::obj;
    if (has_order && (requested.empty() || source.name == requested)) scans.push_back(source.name);
  }
  if (scans.size() == 1) return scans.front();
  return fail(ErrorCode::invalid, "Source file not specified",
              scans.empty()
                  ? "This model has no matching PLY or OBJ file for these values."
                  : "Several files of this model have vertices. Specify one of them as `source`.",
              "source");
}

void write_vertices(const RouteContext& context, const Request& request, const Respond& respond) {
  auto room = open_room(context, request);
  if (!room) return respond(room.error());
  auto layer = (*room)->layers().find(request.param("layer"));
  if (!layer) return respond(layer.error());
  const Model model = (*room)->model();
  auto source = scan_of(model, request.query_or("source", {}));
  if (!source) return respond(source.error());
  const auto file = MappedFile::open(request.body_file);
  if (!file || file->bytes().empty())
    return respond(Error{ErrorCode::malformed, "Empty body",
                         "The request has no body. Send one number per line as the body.", "body"});
  Progress progress;
  auto scan = jobs::read_source(context.store, model, *source, progress);
  if (!scan) return respond(scan.error());
  auto values = mesh::read_vertex_csv(*scan, *source, file->view(), progress);
  if (!values) return respond(values.error());
  scan->clear();
  const auto geometry = (*room)->surface().geometry();
  auto tiles = jobs::paint_vertex_values(
      geometry, mesh::values_at_positions(*geometry, *values, !is_float(layer->type)), layer->type,
      layer->resolution, progress);
  if (!tiles) {
    Error problem = tiles.error();
    if (problem.field == "type")
      problem.field = "body";  // the layer's type is fixed, so the values are wrong
    return respond(problem);
  }
  room::EditRequest edit{edit_id(request, *layer, "import"), request.author(), layer->id};
  edit.record = {{"op", "import"},
                 {"format", "vertices.csv"},
                 {"source", *source},
                 {"bytes", request.body_bytes},
                 {"sha256", sha256_hex(file->view())}};
  edit.edit = room::ImportEdit{std::move(*tiles)};
  apply_edit(context, request, *room, std::move(edit), respond);
}

}  // namespace

void add_shape_routes(Router& router, const RouteContext& context) {
  auto book = std::make_shared<JobIdempotency>(context.jobs);
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/transfer",
              .handler = answering([&context, book](const Request& request) {
                return start_transfer(context, *book, request);
              }),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true,
              .replay = [&context, book](const Request& request, const nlohmann::json& stored) {
                return repeat_layer_job(context, *book, request, stored);
              }});
  router.add(
      {.method = Method::put,
       .pattern = "/api/v1/models/{model}/layers/{layer}/vertices.csv",
       .handler = [&context](const Request& request,
                             const Respond& respond) { write_vertices(context, request, respond); },
       .role = Role::annotator,
       .query = {"source"},
       .body = BodyKind::file,
       .max_body = kMaxCsvBytes});
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/vertex-properties",
              .handler = answering([&context](const Request& request) {
                return list_properties(context, request);
              })});
}

}  // namespace strata::net
