#include <charconv>
#include <fstream>
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
#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/store.h"

namespace strata::net {
namespace {

namespace fs = std::filesystem;

// Reads a length in the units of the file. 0 if the query does not contain it.
Result<double> length_of(const Request& request, const std::string& name) {
  const std::string text = request.query_or(name, {});
  if (text.empty()) return 0.0;
  double length = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
  if (error != std::errc() || end != text.data() + text.size())
    return fail(ErrorCode::invalid, "Not a number",
                "`" + name + "` must be a distance in the units of the file, such as 0.05.", name);
  return length;
}

Result<bool> flag_of(const Request& request, const std::string& name) {
  const std::string text = request.query_or(name, "false");
  if (text != "true" && text != "false")
    return fail(ErrorCode::invalid, "Not true or false", "`" + name + "` must be true or false.",
                name);
  return text == "true";
}

// Reads all parameters of the import from the query. The files are in the body.
Result<jobs::ImportRequest> import_request(const RouteContext& context, const Request& request) {
  jobs::ImportRequest requested;
  requested.name = request.query_or("name", {});
  requested.project = request.query_or("project", "default");
  if (auto project = context.store.projects().find(requested.project); !project) {
    Error problem = project.error();
    problem.field = "project";
    return tl::unexpected(std::move(problem));
  }
  constexpr const char* kProposed = "proposed";
  if (auto unit = request.query_or("unit", {}); unit == kProposed) {
    requested.unit_proposed = true;
  } else if (!unit.empty()) {
    requested.unit = parse_unit(unit);
    if (!requested.unit)
      return fail(ErrorCode::invalid, "Unknown unit",
                  "The unit must be mm, cm, m or `proposed`. With `proposed`, the server guesses "
                  "the unit from the file.",
                  "unit");
  }
  requested.up = request.query_or("up", {});
  if (requested.up == kProposed) {
    requested.up_proposed = true;
    requested.up.clear();
  }
  requested.crs = request.query_or("crs", {});
  requested.object = request.query_or("object", {});
  requested.survey_date = request.query_or("survey_date", {});
  if (auto text = request.query_or("resolution", {}); !text.empty()) {
    auto resolution = STRATA_TRY(parse_integer(text, 1, INT32_MAX, "resolution"));
    requested.resolution = static_cast<int>(resolution);
  }
  requested.weld_distance = STRATA_TRY(length_of(request, "weld"));
  requested.cell = STRATA_TRY(length_of(request, "cell"));
  requested.gap = STRATA_TRY(length_of(request, "gap"));
  requested.strict = STRATA_TRY(flag_of(request, "strict"));
  requested.parts = STRATA_TRY(flag_of(request, "parts"));
  requested.files.push_back({base_filename(request.query_or("filename", {})), {}});
  return requested;
}

// The model whose stored files the query asks to import again. The caller is a curator in the
// project of the new model, and a model of another project is like a missing one.
Result<std::optional<Model>> imported_again(const RouteContext& context, const Request& request) {
  const std::string ref = request.query_or("files_of", {});
  if (ref.empty()) return std::optional<Model>();
  const auto project =
      STRATA_TRY(context.store.projects().find(request.query_or("project", "default")));
  auto model = context.store.models().find(ref);
  if (model && model->project_id == project.id) return std::optional(std::move(*model));
  if (!model && model.error().code != ErrorCode::not_found) return tl::unexpected(model.error());
  return fail(ErrorCode::invalid, "No such model",
              "`files_of` must be a model of the project. Name its project in `project`.",
              "files_of");
}

// Writes the stored files of a model to temporary files.
Result<std::vector<std::shared_ptr<TemporaryFile>>> fetch_sources(store::Store& store,
                                                                  const Model& model,
                                                                  const fs::path& folder,
                                                                  Progress& progress) {
  std::vector<std::shared_ptr<TemporaryFile>> files;
  for (const SourceFile& source : model.source_files) {
    files.push_back(
        std::make_shared<TemporaryFile>(folder / (to_string(random_uuid()) + ".upload")));
    std::ofstream out(files.back()->path, std::ios::binary);
    STRATA_TRY(
        store.models().read_source(model.id, source.name, [&](std::span<const std::uint8_t> chunk) {
          out.write(reinterpret_cast<const char*>(chunk.data()), std::streamsize(chunk.size()));
          return bool(out) && !progress.cancelled();
        }));
    if (progress.cancelled()) return cancelled_problem();
    if (!out.flush())
      return fail(ErrorCode::storage_full, "Disk full",
                  "The files of the model could not be copied for the import.");
  }
  return files;
}

// Runs before the upload. The file name may be in the form, which is not read yet.
Result<void> check_import(const RouteContext& context, const Request& request) {
  auto requested = STRATA_TRY(import_request(context, request));
  STRATA_TRY(imported_again(context, request));
  if (requested.files[0].filename.empty()) requested.files[0].filename = "named in the body.ply";
  return jobs::check(requested);
}

// Renames the uploaded file, because the request's file is deleted after the response but the job
// still needs it.
Result<std::shared_ptr<TemporaryFile>> keep_upload(const Request& request, const fs::path& file,
                                                   const fs::path& folder) {
  if (file != request.body_file) return std::make_shared<TemporaryFile>(file);
  const fs::path destination = folder / (to_string(random_uuid()) + ".upload");
  std::error_code error;
  fs::rename(file, destination, error);
  if (error)
    return fail(ErrorCode::internal, "Upload not saved",
                "The server could not save the uploaded file: " + error.message());
  return std::make_shared<TemporaryFile>(destination);
}

Result<Response> start_import(const RouteContext& context, JobIdempotency& book,
                              const Request& request) {
  auto known = STRATA_TRY(book.find(request));
  if (known) return std::move(job_response(context, *known).with("Idempotency-Replayed", "true"));
  auto requested = import_request(context, request);
  if (!requested) return tl::unexpected(requested.error());
  const auto again = STRATA_TRY(imported_again(context, request));
  std::vector<Upload> uploads;
  if (!again) uploads = STRATA_TRY(take_upload(request, context.options.upload_dir));
  std::error_code unknown;
  if (again && fs::file_size(request.body_file, unknown) > 0 && !unknown)
    return fail(ErrorCode::invalid, "Two scans", "Send a scan or `files_of`, but not both.",
                "files_of");
  std::vector<std::shared_ptr<TemporaryFile>> stored_files;
  const std::string named = requested->files[0].filename;
  requested->files.clear();
  for (const Upload& upload : uploads) {
    auto file = STRATA_TRY(keep_upload(request, upload.file, context.options.upload_dir));
    stored_files.push_back(std::move(file));
    requested->files.push_back({upload.filename, stored_files.back()->path});
  }
  // The file name in the query has precedence over the file name in a form.
  if (requested->files.size() == 1 && !named.empty()) requested->files[0].filename = named;
  if (again) {
    for (const SourceFile& source : again->source_files)
      requested->files.push_back({source.name, {}});
    requested->parts = requested->parts || !again->parts.empty();
  }
  STRATA_TRY(jobs::check(*requested));

  const store::IdempotentResponse<Model> answer{
      scoped_key(request),
      [print = fingerprint(request)](const Model& model) {
        return nlohmann::json{{"request", print}, {"model", model.id}};
      },
      request.user()};
  const auto project = STRATA_TRY(context.store.projects().find(requested->project));
  auto job = STRATA_TRY(context.jobs.add(
      project.id,
      [&store = context.store, &memory = context.rooms.memory(), requested = *requested,
       stored_files = std::move(stored_files), again, folder = context.options.upload_dir,
       answer](Progress& progress) mutable -> Result<jobs::JobResult> {
        if (again) {
          stored_files = STRATA_TRY(fetch_sources(store, *again, folder, progress));
          for (std::size_t i = 0; i < stored_files.size(); ++i)
            requested.files[i].path = stored_files[i]->path;
        }
        store::IdempotentResponse<Model> stored_answer = answer;
        stored_answer.job = progress.job();
        auto model = jobs::import_model(store, requested, progress, stored_answer, &memory);
        if (!model) return tl::unexpected(model.error());
        return model->id;
      }));
  book.started(request, job);
  return job_response(context, job);
}

// Creates the response for an import that succeeded. Only the server process that ran the job still
// lists that job.
Result<Response> repeat_import(const RouteContext& context, JobIdempotency& book,
                               const Request& request, const nlohmann::json& stored) {
  auto known = STRATA_TRY(book.find(request));
  if (known) return job_response(context, *known);
  const auto project =
      STRATA_TRY(context.store.projects().find(request.query_or("project", "default")));
  auto job = STRATA_TRY(
      book.finished(request, project.id, stored.at("model").get<ModelId>(), jobs::JobKind::import));
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
       .query = {"name", "project", "unit", "up", "crs", "object", "survey_date", "resolution",
                 "filename", "weld", "cell", "gap", "files_of", "parts", "strict"},
       .project_in_query = true,
       .check = [&context](const Request& request) { return check_import(context, request); },
       .body = BodyKind::file,
       .max_body = context.options.max_upload_bytes,
       .keeps_answer = true,
       .replay =
           [&context, book](const Request& request, const nlohmann::json& stored) {
             return repeat_import(context, *book, request, stored);
           }});
}

}  // namespace strata::net
