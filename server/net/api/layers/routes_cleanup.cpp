// Operations on the regions of a layer, as jobs that end with one edit.
#include <optional>
#include <utility>

#include "app/layers/cleanup.h"
#include "app/layers/piece_records.h"
#include "app/records/painted_keys.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/tables/table.h"
#include "jobs/job_queue.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/job_idempotency.h"
#include "net/transport/server_options.h"
#include "room/edit.h"
#include "room/layers.h"
#include "room/room.h"
#include "store/store.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

using Operation = app::Cleanup::Operation;

Result<double> required(const std::optional<double>& member, const std::string& name) {
  if (member) return *member;
  return fail(ErrorCode::invalid, "Value missing", "This operation requires `" + name + "`.", name);
}

// Refuses members that have no effect.
Result<void> check_members(const protocol::Cleanup& body) {
  const bool border = body.operation == protocol::CleanupOperation::border,
             sieve = body.operation == protocol::CleanupOperation::sieve,
             fill = body.operation == protocol::CleanupOperation::fill_holes,
             majority = body.operation == protocol::CleanupOperation::majority,
             narrow = body.operation == protocol::CleanupOperation::open ||
                      body.operation == protocol::CleanupOperation::close;
  const struct {
    const char* name;
    bool is_set, is_allowed;
  } members[] = {{"area_cm2", body.area_cm2.has_value(), sieve || fill},
                 {"erase_regions", body.erase_regions, sieve},
                 {"radius_mm", body.radius_mm.has_value(), majority},
                 {"width_mm", body.width_mm.has_value(), border || narrow},
                 {"from", body.from.has_value(), border},
                 {"of", body.of.has_value(), border || narrow},
                 {"inside", body.inside, border && body.of},
                 {"erase", body.erase, border},
                 {"value", body.value.has_value(), border && !body.erase}};
  for (const auto& member : members)
    if (member.is_set && !member.is_allowed)
      return fail(ErrorCode::invalid, "Member without effect",
                  "`" + std::string(member.name) +
                      "` has no effect with the other members. Remove it, or correct them.",
                  member.name);
  return {};
}

Result<std::uint32_t> bits_of(const Layer& layer, double value, const std::string& field) {
  auto bits = encode_value(layer.type, value);
  if (bits) return *bits;
  Error problem = bits.error();
  problem.field = field;
  return tl::unexpected(std::move(problem));
}

// Finds another layer that the body names. The error names `field`.
Result<Layer> other_layer(const room::Room& room, const protocol::LayerRef& ref,
                          const std::string& field) {
  auto found = STRATA_TRY(find_layers(room, {protocol::to_ref(ref)}, field));
  return std::move(found.front());
}

Result<void> read_border(const RouteContext& context, const room::Room& room, const Layer& layer,
                         const protocol::Cleanup& body, app::Cleanup& cleanup) {
  cleanup.width_m = STRATA_TRY(required(body.width_mm, "width_mm")) / 1000;
  cleanup.inside = body.inside;
  Layer from = layer;
  if (body.from) {
    auto other = STRATA_TRY(other_layer(room, *body.from, "from"));
    from = std::move(other);
    cleanup.from = from.id;
  }
  if (body.of) {
    const auto bits = STRATA_TRY(bits_of(from, *body.of, "of"));
    cleanup.of_bits = bits;
  }
  if (body.erase) return {};
  const double value = STRATA_TRY(required(body.value, "value"));
  const auto bits = STRATA_TRY(bits_of(layer, value, "value"));
  cleanup.line = {bits, true};
  if (layer.kind != LayerKind::database) return {};
  return app::check_keys(context.store, layer, {static_cast<std::int64_t>(bits)});
}

Result<app::Cleanup> cleanup_of(const RouteContext& context, const room::Room& room,
                                const Layer& layer, const protocol::Cleanup& body) {
  STRATA_TRY(check_members(body));
  app::Cleanup cleanup;
  static_assert(static_cast<int>(protocol::CleanupOperation::sieve) ==
                static_cast<int>(Operation::sieve));
  static_assert(static_cast<int>(protocol::CleanupOperation::close) ==
                static_cast<int>(Operation::close));
  cleanup.operation = static_cast<Operation>(body.operation);
  switch (cleanup.operation) {
    case Operation::sieve:
    case Operation::fill_holes:
      cleanup.area_m2 = STRATA_TRY(required(body.area_cm2, "area_cm2")) / 1e4;
      if (body.erase_regions) cleanup.to = query::SieveTo::no_value;
      break;
    case Operation::majority:
      cleanup.radius_m = STRATA_TRY(required(body.radius_mm, "radius_mm")) / 1000;
      break;
    case Operation::open:
    case Operation::close:
      cleanup.width_m = STRATA_TRY(required(body.width_mm, "width_mm")) / 1000;
      if (body.of) {
        const auto bits = STRATA_TRY(bits_of(layer, *body.of, "of"));
        cleanup.of_bits = bits;
      }
      break;
    case Operation::border: STRATA_TRY(read_border(context, room, layer, body, cleanup)); break;
  }
  return cleanup;
}

Result<ColumnId> column_of(const Table& table, const std::string& ref, const std::string& field) {
  if (const Column* column = find_column(table.columns, ref)) return column->id;
  return fail(ErrorCode::invalid, "Column not found",
              "The table " + table.name + " has no column \"" + ref + "\".", field);
}

Result<app::PieceRecords> pieces_of(const RouteContext& context, const room::Room& room,
                                    const Layer& layer, const protocol::PieceRecords& body,
                                    Role role) {
  const auto into = STRATA_TRY(other_layer(room, body.into, "into"));
  if (!into.table)
    return fail(ErrorCode::invalid, "No table",
                into.name + " is not a layer of records. Choose a layer of records.", "into");
  if (body.apply) STRATA_TRY(room::check_not_locked(into, role));
  const struct {
    const char* name;
    const std::optional<std::string>& column;
  } of_lines[] = {{"length_column", body.length_column},
                  {"width_column", body.width_column},
                  {"greatest_width_column", body.greatest_width_column}};
  for (const auto& [member, column] : of_lines)
    if (column && !body.as_lines)
      return fail(ErrorCode::invalid, "Member without effect",
                  "`" + std::string(member) +
                      "` has no effect without `as_lines`. Remove it, or set `as_lines`.",
                  member);
  app::PieceRecords pieces;
  pieces.into = into.id;
  pieces.min_area_m2 = body.min_area_cm2 / 1e4;
  pieces.as_lines = body.as_lines;
  pieces.in_reading_order = body.in_reading_order || body.as_lines;
  if (body.of) {
    const auto bits = STRATA_TRY(bits_of(layer, *body.of, "of"));
    pieces.of_bits = bits;
  }
  const auto table = STRATA_TRY(context.store.tables().find(to_string(*into.table), role));
  const auto find = [&](const std::optional<std::string>& ref, const std::string& field,
                        std::optional<ColumnId>& column) -> Result<void> {
    if (!ref) return {};
    const auto found = STRATA_TRY(column_of(table, *ref, field));
    column = found;
    return {};
  };
  STRATA_TRY(find(body.number_column, "number_column", pieces.number));
  STRATA_TRY(find(body.area_column, "area_column", pieces.area_cm2));
  STRATA_TRY(find(body.perimeter_column, "perimeter_column", pieces.perimeter_mm));
  STRATA_TRY(find(body.length_column, "length_column", pieces.length_mm));
  STRATA_TRY(find(body.width_column, "width_column", pieces.width_mm));
  STRATA_TRY(find(body.greatest_width_column, "greatest_width_column", pieces.greatest_width_mm));
  return pieces;
}

jobs::JobResult job_result(ModelId model, std::string_view operation,
                           const app::CleanupResult& done) {
  jobs::JobResult result(model);
  nlohmann::json& report = result.report;
  report = {{"operation", operation},
            {"applied", done.applied},
            {"regions", done.regions},
            {"texels", done.texels},
            {"area_m2", done.area_m2}};
  if (done.sequence == 0) return result;
  report["skipped_texels"] = done.skipped_texels;
  report["sequence"] = done.sequence;
  if (done.provisional) report["provisional"] = true;
  if (!done.keys.empty()) report["keys"] = done.keys;
  if (!done.unpainted_keys.empty()) report["unpainted_keys"] = done.unpainted_keys;
  return result;
}

// With an Idempotency-Key, a repeated call finds the job of the first call. If the server no longer
// lists this job, for example after a restart, the journal answers the call.
Result<std::optional<Response>> repeat_job(const RouteContext& context, JobIdempotency& book,
                                           const Request& request, const Model& model,
                                           std::string_view operation,
                                           const app::CleanupEdit& edit) {
  auto job = STRATA_TRY(book.find(request));
  if (!job && !request.header("idempotency-key").empty()) {
    const auto saved = STRATA_TRY(app::find_saved(context, model.id, edit));
    if (saved) {
      const auto finished = STRATA_TRY(book.finished(request, model.project_id,
                                                     job_result(model.id, operation, *saved),
                                                     jobs::JobKind::regions));
      job = finished;
    }
  }
  if (!job) return std::nullopt;
  return std::move(job_response(context, *job).with("Idempotency-Replayed", "true"));
}

using Run = std::function<Result<app::CleanupResult>(Progress&)>;

// Returns 202 with a job of the caller.
Result<Response> start_job(const RouteContext& context, JobIdempotency& book,
                           const Request& request, const Model& model, std::string operation,
                           Run run) {
  const auto job = STRATA_TRY(context.jobs.add(
      model.project_id,
      [model_id = model.id, operation = std::move(operation),
       run = std::move(run)](Progress& progress) -> Result<jobs::JobResult> {
        const auto done = STRATA_TRY(run(progress));
        return job_result(model_id, operation, done);
      },
      request.user(), jobs::JobKind::regions));
  book.started(request, job);
  return job_response(context, job);
}

// `route` separates the ids of calls with the same Idempotency-Key.
app::CleanupEdit edit_of(const Request& request, const Layer& layer, std::string_view route,
                         bool apply, const nlohmann::json& body) {
  nlohmann::json record{{"op", "cleanup"}};
  record.update(body);
  return {apply, edit_id(request, layer, route), request.author(), std::move(record)};
}

Result<Response> start_cleanup(const RouteContext& context, JobIdempotency& book,
                               const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::Cleanup>(request));
  const auto room = STRATA_TRY(open_room(context, request));
  const auto layer = STRATA_TRY(room->layers().find(request.param("layer")));
  const std::string operation(name(body.operation));
  auto edit = edit_of(request, layer, "cleanup", body.apply, protocol::to_json(body));
  auto repeated = STRATA_TRY(repeat_job(context, book, request, room->model(), operation, edit));
  if (repeated) return std::move(*repeated);
  const auto cleanup = STRATA_TRY(cleanup_of(context, *room, layer, body));
  STRATA_TRY(app::check_radius(room->model(), layer, cleanup));
  if (body.apply) STRATA_TRY(room::check_not_locked(layer, edit.author.role));
  return start_job(context, book, request, room->model(), operation,
                   [&services = static_cast<const app::Services&>(context), room, layer, cleanup,
                    edit = std::move(edit)](Progress& progress) {
                     return app::clean_up(services, *room, layer, cleanup, edit, progress);
                   });
}

Result<Response> start_piece_records(const RouteContext& context, JobIdempotency& book,
                                     const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::PieceRecords>(request));
  const auto room = STRATA_TRY(open_room(context, request));
  const auto layer = STRATA_TRY(room->layers().find(request.param("layer")));
  auto edit = edit_of(request, layer, "pieces", body.apply, protocol::to_json(body));
  edit.record["operation"] = "pieces";
  edit.record["from"] = to_string(layer.id);
  auto repeated = STRATA_TRY(repeat_job(context, book, request, room->model(), "pieces", edit));
  if (repeated) return std::move(*repeated);
  const auto pieces = STRATA_TRY(pieces_of(context, *room, layer, body, request.role()));
  return start_job(context, book, request, room->model(), "pieces",
                   [&services = static_cast<const app::Services&>(context), room, layer, pieces,
                    edit = std::move(edit)](Progress& progress) {
                     return app::make_piece_records(services, *room, layer, pieces, edit, progress);
                   });
}

}  // namespace

void add_cleanup_routes(Router& router, const RouteContext& context) {
  const std::string layer = "/api/v1/models/{model}/layers/{layer}";
  auto book = std::make_shared<JobIdempotency>(context.jobs);
  const auto add = [&](const std::string& pattern, auto start) {
    router.add({.method = Method::post,
                .pattern = layer + pattern,
                .handler = answering([&context, book, start](const Request& request) {
                  return start(context, *book, request);
                }),
                .role = Role::annotator,
                .body = BodyKind::memory,
                .max_body = context.options.max_json_bytes,
                .keeps_answer = true});
  };
  add("/cleanup", start_cleanup);
  add("/piece-records", start_piece_records);
}

}  // namespace strata::net
