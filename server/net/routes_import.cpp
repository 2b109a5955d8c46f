#include <memory>

#include "core/log.h"
#include "core/uuid.h"
#include "jobs/import_job.h"
#include "net/routes.h"
#include "net/upload.h"
#include "net/wire.h"

namespace strata::net {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxName = 200;
constexpr std::size_t kMaxCrs = 15;

// A file that goes away with its last owner, also when the job never runs.
class TemporaryFile {
 public:
  explicit TemporaryFile(fs::path path) : path_(std::move(path)) {}
  ~TemporaryFile() {
    std::error_code error;
    fs::remove(path_, error);
    if (error) log::warning("an upload could not be removed: " + error.message());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

bool is_crs(const std::string& text) {
  return text.size() > 5 && text.size() <= kMaxCrs && text.starts_with("EPSG:") &&
         text.find_first_not_of("0123456789", 5) == std::string::npos;
}

// Everything but the file, from the query.
Result<jobs::ImportRequest> import_request(const RouteContext& context, const Request& request) {
  jobs::ImportRequest asked;
  asked.name = request.query_or("name", {});
  if (asked.name.size() > kMaxName) return fail(422, "Name too long", "A name has at most 200 bytes.", "name");
  asked.project = request.query_or("project", "default");
  if (auto project = context.store.project(asked.project); !project) {
    Problem problem = project.error();
    problem.field = "project";
    return tl::unexpected(std::move(problem));
  }
  if (auto unit = request.query_or("unit", {}); !unit.empty()) {
    asked.unit = parse_unit(unit);
    if (!asked.unit) return fail(422, "Unknown unit", "The unit is mm, cm or m.", "unit");
  }
  asked.up = request.query_or("up", {});
  if (!asked.up.empty() && asked.up != "x" && asked.up != "y" && asked.up != "z")
    return fail(422, "Unknown direction", "Up is x, y or z.", "up");
  asked.crs = request.query_or("crs", {});
  if (!asked.crs.empty() && !is_crs(asked.crs)) return fail(422, "Unknown coordinate system", "Write it as EPSG:n.", "crs");
  if (auto text = request.query_or("resolution", {}); !text.empty()) {
    auto resolution = parse_integer(text, 256, 16384, "resolution");
    if (!resolution || (*resolution & (*resolution - 1)) != 0)
      return fail(422, "Resolution not usable", "The resolution is a power of two from 256 to 16384.", "resolution");
    asked.resolution = static_cast<int>(*resolution);
  }
  const std::string strict = request.query_or("strict", "false");
  if (strict != "true" && strict != "false") return fail(422, "Neither true nor false", "`strict` is true or false.", "strict");
  asked.strict = strict == "true";
  asked.filename = base_filename(request.query_or("filename", {}));
  return asked;
}

Result<Response> start_import(const RouteContext& context, const Request& request) {
  auto asked = import_request(context, request);
  if (!asked) return tl::unexpected(asked.error());
  auto upload = take_upload(request, context.options.upload_dir);
  if (!upload) return tl::unexpected(upload.error());
  std::shared_ptr<TemporaryFile> file;
  if (upload->file == request.body_file) {
    // The request's file goes with the answer; the job needs its own name for it.
    const fs::path kept = context.options.upload_dir / (to_string(random_uuid()) + ".upload");
    std::error_code error;
    fs::rename(request.body_file, kept, error);
    if (error) return fail(500, "Upload lost", "The uploaded file could not be kept: " + error.message());
    file = std::make_shared<TemporaryFile>(kept);
  } else {
    file = std::make_shared<TemporaryFile>(upload->file);
  }
  if (asked->filename.empty()) asked->filename = upload->filename;
  const std::string extension = to_lower(fs::path(asked->filename).extension().string());
  if (extension.empty())
    return fail(422, "File name missing", "Give ?filename=NAME.ply (or .obj): the ending names the format.", "filename");
  if (extension != ".ply" && extension != ".obj")
    return fail(415, "Format not taken", "'" + extension + "' files are not taken; send PLY or OBJ.", "filename");
  asked->file = file->path();

  auto job = context.jobs.add([&store = context.store, asked = *asked, file](Progress& progress) -> Result<std::int64_t> {
    auto model = jobs::import_model(store, asked, progress);
    if (!model) return tl::unexpected(model.error());
    return model->id;
  });
  if (!job) return tl::unexpected(job.error());
  auto status = context.jobs.status(*job);
  return json_response(status ? to_json(*status) : nlohmann::json{{"id", *job}, {"state", "queued"}, {"progress", 0}, {"message", ""}}, 202)
      .with("Location", "/api/v1/jobs/" + std::to_string(*job));
}

}  // namespace

void add_import_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::post,
              .pattern = "/api/v1/models",
              .handler = answering([&context](const Request& request) { return start_import(context, request); }),
              .role = Role::curator,
              .query = {"name", "project", "unit", "up", "crs", "resolution", "filename", "strict"},
              .body = BodyKind::file,
              .max_body = context.options.max_upload_bytes,
              .keeps_answer = true});
}

}  // namespace strata::net
