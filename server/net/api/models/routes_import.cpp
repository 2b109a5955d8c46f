#include <charconv>
#include <memory>

#include "core/temporary_file.h"
#include "core/text/filename.h"
#include "core/uuid.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "jobs/import_job.h"
#include "jobs/job_queue.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/job_idempotency.h"
#include "net/http/upload.h"
#include "net/transport/server_options.h"
#include "room/rooms.h"
#include "store/content/idempotent_response.h"
#include "store/content/projects.h"
#include "store/store.h"

namespace strata::net {
namespace {

namespace fs = std::filesystem;

// Everything but the file, from the query.
Result<jobs::ImportRequest> import_request(const RouteContext& context, const Request& request) {
  jobs::ImportRequest asked;
  asked.name = request.query_or("name", {});
  asked.project = request.query_or("project", "default");
  if (auto project = context.store.projects().find(asked.project); !project) {
    Error problem = project.error();
    problem.field = "project";
    return tl::unexpected(std::move(problem));
  }
  constexpr const char* kProposed = "proposed";
  if (auto unit = request.query_or("unit", {}); unit == kProposed) {
    asked.unit_proposed = true;
  } else if (!unit.empty()) {
    asked.unit = parse_unit(unit);
    if (!asked.unit)
      return fail(ErrorCode::invalid, "Unknown unit",
                  "The unit is mm, cm or m, or `proposed` for what the file lets one guess.",
                  "unit");
  }
  asked.up = request.query_or("up", {});
  if (asked.up == kProposed) {
    asked.up_proposed = true;
    asked.up.clear();
  }
  asked.crs = request.query_or("crs", {});
  if (auto text = request.query_or("resolution", {}); !text.empty()) {
    auto resolution = STRATA_TRY(parse_integer(text, 1, INT32_MAX, "resolution"));
    asked.resolution = static_cast<int>(resolution);
  }
  if (auto text = request.query_or("weld", {}); !text.empty()) {
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), asked.weld_distance);
    if (error != std::errc() || end != text.data() + text.size())
      return fail(ErrorCode::invalid, "Not a number",
                  "`weld` is a distance in the file's units, such as 0.05.", "weld");
  }
  const std::string strict = request.query_or("strict", "false");
  if (strict != "true" && strict != "false")
    return fail(ErrorCode::invalid, "Neither true nor false", "`strict` is true or false.",
                "strict");
  asked.strict = strict == "true";
  asked.files.push_back({base_filename(request.query_or("filename", {})), {}});
  return asked;
}

// Before the upload; its name may be in there.
Result<void> check_import(const RouteContext& context, const Request& request) {
  auto asked = STRATA_TRY(import_request(context, request));
  if (asked.files[0].filename.empty()) asked.files[0].filename = "named in the body.ply";
  return jobs::check(asked);
}

// The upload under a name of its own: the request's file goes with the answer, the job needs it
// longer.
Result<std::shared_ptr<TemporaryFile>> keep_upload(const Request& request, const fs::path& file,
                                                   const fs::path& folder) {
  if (file != request.body_file) return std::make_shared<TemporaryFile>(file);
  const fs::path kept = folder / (to_string(random_uuid()) + ".upload");
  std::error_code error;
  fs::rename(file, kept, error);
  if (error)
    return fail(ErrorCode::internal, "Upload lost",
                "The uploaded file could not be kept: " + error.message());
  return std::make_shared<TemporaryFile>(kept);
}

Result<Response> start_import(const RouteContext& context, JobIdempotency& book,
                              const Request& request) {
  auto known = STRATA_TRY(book.find(request));
  if (known) return std::move(job_response(context, *known).with("Idempotency-Replayed", "true"));
  auto asked = import_request(context, request);
  if (!asked) return tl::unexpected(asked.error());
  auto uploads = STRATA_TRY(take_upload(request, context.options.upload_dir));
  std::vector<std::shared_ptr<TemporaryFile>> kept;
  const std::string named = asked->files[0].filename;
  asked->files.clear();
  for (const Upload& upload : uploads) {
    auto file = STRATA_TRY(keep_upload(request, upload.file, context.options.upload_dir));
    kept.push_back(std::move(file));
    asked->files.push_back({upload.filename, kept.back()->path});
  }
  // One file goes by the name that the query gives it, whatever a form calls it.
  if (asked->files.size() == 1 && !named.empty()) asked->files[0].filename = named;
  STRATA_TRY(jobs::check(*asked));

  const store::IdempotentResponse<Model> answer{
      scoped_key(request),
      [print = fingerprint(request)](const Model& model) {
        return nlohmann::json{{"request", print}, {"model", model.id}};
      },
      request.user()};
  const auto project = STRATA_TRY(context.store.projects().find(asked->project));
  auto job = STRATA_TRY(context.jobs.add(
      project.id,
      [&store = context.store, &memory = context.rooms.memory(), asked = *asked,
       kept = std::move(kept), answer](Progress& progress) -> Result<jobs::JobResult> {
        store::IdempotentResponse<Model> kept_answer = answer;
        kept_answer.job = progress.job();
        auto model = jobs::import_model(store, asked, progress, kept_answer, &memory);
        if (!model) return tl::unexpected(model.error());
        return model->id;
      }));
  book.started(request, job);
  return job_response(context, job);
}

// The import succeeded. Its job is known where this server did it.
Result<Response> repeat_import(const RouteContext& context, JobIdempotency& book,
                               const Request& request, const nlohmann::json& kept) {
  auto known = STRATA_TRY(book.find(request));
  if (known) return job_response(context, *known);
  const auto project =
      STRATA_TRY(context.store.projects().find(request.query_or("project", "default")));
  auto job = STRATA_TRY(book.finished(request, project.id, kept.at("model").get<ModelId>()));
  return job_response(context, job);
}

}  // namespace

void add_import_routes(Router& router, const RouteContext& context) {
  auto book = std::make_shared<JobIdempotency>(context.jobs);
  router.add(
      {.method = Method::post,
       .pattern = "/api/v1/models",
       .handler = answering([&context, book](const Request& request) {
         return start_import(context, *book, request);
       }),
       .role = Role::curator,
       .query = {"name", "project", "unit", "up", "crs", "resolution", "filename", "weld",
                 "strict"},
       .project_in_query = true,
       .check = [&context](const Request& request) { return check_import(context, request); },
       .body = BodyKind::file,
       .max_body = context.options.max_upload_bytes,
       .keeps_answer = true,
       .replay =
           [&context, book](const Request& request, const nlohmann::json& kept) {
             return repeat_import(context, *book, request, kept);
           }});
}

}  // namespace strata::net
