#include "jobs/import_job.h"

#include <algorithm>
#include <bit>
#include <set>
#include <span>
#include <utility>

#include "core/text/filename.h"
#include "core/text/slug.h"
#include "domain/scene/surveyed_object.h"
#include "domain/scene/up.h"
#include "jobs/model_geometry.h"
#include "media/picture.h"
#include "mesh/io/load.h"
#include "mesh/repair/scale_proposal.h"
#include "mesh/surface/geometry.h"
#include "mesh/texture/base_color.h"
#include "store/content/models.h"
#include "store/content/projects.h"

namespace strata::jobs {
namespace {

// The lowest resolution of layers. The gutters of the atlas are wide enough for it.
constexpr int kLowestResolution = 2048;
constexpr int kMaxResolution = 16384;
constexpr std::size_t kMaxNameLength = 200;

// Shares of the import time, as measured on scans of 100 000 to 1 000 000 triangles.
constexpr double kRead = 0.15, kUnfolded = 0.7, kPainted = 0.77, kBuilt = 0.85;

bool is_crs(const std::string& crs) {
  constexpr std::string_view kPrefix = "EPSG:";
  const std::size_t digits = crs.size() - std::min(crs.size(), kPrefix.size());
  return crs.starts_with(kPrefix) && digits >= 1 && digits <= 7 &&
         is_all_digits(crs.substr(kPrefix.size()));
}

std::vector<std::string> names_of(std::span<const ImportFile> files) {
  std::vector<std::string> names;
  for (const ImportFile& file : files) names.push_back(file.filename);
  return names;
}

// Returns the files with their base names, or with their folders if they determine the tree of
// parts. Later files with the same name get numbers.
std::vector<store::NewModel::Source> sources_of(const ImportRequest& request) {
  std::vector<store::NewModel::Source> sources;
  std::set<std::string> taken;
  for (const ImportFile& file : request.files) {
    const std::string base = base_filename(file.filename);
    std::string name = request.parts ? relative_filename(file.filename) : base;
    if (name.size() > kMaxFilenameLength) name = base;
    for (int n = 2; !taken.insert(name).second; ++n) name = std::to_string(n) + "-" + base;
    sources.push_back({name, file.path});
  }
  return sources;
}

// The name of the only scan, or of the innermost folder that contains all scans.
std::string default_name(const ImportRequest& request) {
  const auto scans = mesh::pick_scans(names_of(request.files), request.parts);
  const auto name_at = [&](std::size_t i) {
    return relative_filename(request.files[(*scans)[i]].filename);
  };
  const std::string first = name_at(0);
  if (scans->size() == 1) return filename_stem(first);
  std::size_t common = first.find_last_of('/');
  for (std::size_t i = 1; i < scans->size() && common != std::string::npos; ++i) {
    const std::string other = name_at(i);
    while (common != std::string::npos && other.compare(0, common + 1, first, 0, common + 1) != 0)
      common = common == 0 ? std::string::npos : first.find_last_of('/', common - 1);
  }
  return common == std::string::npos ? filename_stem(first)
                                     : base_filename(first.substr(0, common));
}

Result<void> refuse_faults(const std::vector<Repair>& repairs) {
  std::string list;
  for (const auto& repair : repairs)
    if (mesh::is_fault(repair))
      list += (list.empty() ? "" : ", ") + repair.what + " (" + std::to_string(repair.count) + ")";
  if (list.empty()) return {};
  return fail(ErrorCode::invalid, "File needs repair",
              "The server can import this file only after these repairs: " + list +
                  ". Repair the file, or import it without `strict`.",
              "strict");
}

// Returns an atlas with the texture coordinates of the file if they are suitable for layers.
// Otherwise unfolds the surface, and adds the reason to `repairs`.
Result<mesh::Atlas> atlas_for(const mesh::TriangleMesh& mesh, std::vector<Repair>& repairs,
                              Progress& progress) {
  // The texture coordinates of several scans overlap.
  if (!mesh.corner_uvs.empty() && mesh.part_ends.empty()) {
    progress.report(0, "Checking the texture coordinates");
    auto own_atlas = mesh::keep_uvs(mesh, kLowestResolution, progress);
    if (own_atlas)
      repairs.insert(repairs.end(), own_atlas->repairs.begin(), own_atlas->repairs.end());
    if (own_atlas || own_atlas.error().code == ErrorCode::cancelled) return own_atlas;
    repairs.push_back(
        {"texture coordinates not kept: " + own_atlas.error().detail, mesh.triangle_count()});
  }
  progress.report(0, "Unfolding the surface");
  return mesh::make_atlas(mesh, kLowestResolution, progress);
}

}  // namespace

Result<void> check(const ImportRequest& request) {
  if (request.name.size() > kMaxNameLength)
    return fail(ErrorCode::invalid, "Name too long", "The name can be at most 200 bytes long.",
                "name");
  if (!request.up.empty() && !is_up(request.up))
    return fail(ErrorCode::invalid, "Unknown direction",
                "`up` must be one of x, y, z, -x, -y and -z.", "up");
  if (!request.crs.empty() && !is_crs(request.crs))
    return fail(ErrorCode::invalid, "Unknown coordinate system",
                "Write a coordinate system as EPSG:n, for example EPSG:25830.", "crs");
  if (request.object.size() > kMaxNameLength)
    return fail(ErrorCode::invalid, "Name too long",
                "The name of the object can be at most 200 bytes long.", "object");
  STRATA_TRY(check_survey(!request.object.empty(), request.survey_date));
  if (!(request.weld_distance >= 0 && request.weld_distance < 1e15))
    return fail(ErrorCode::invalid, "Invalid distance",
                "The welding distance must be 0 or a positive number.", "weld");
  for (const auto& [field, length] :
       {std::pair("cell", request.cell), std::pair("gap", request.gap)})
    if (!(length >= 0 && length < 1e15))
      return fail(ErrorCode::invalid, "Invalid length",
                  "The length must be 0 or a positive number.", field);
  const int resolution = request.resolution;
  if (resolution != 0 && (resolution < kLowestResolution || resolution > kMaxResolution ||
                          !std::has_single_bit(unsigned(resolution))))
    return fail(ErrorCode::invalid, "Invalid resolution",
                "The resolution of layers must be 2048, 4096, 8192 or 16384.", "resolution");
  STRATA_TRY(mesh::pick_scans(names_of(request.files), request.parts));
  return {};
}

Result<Model> import_model(store::Store& store, const ImportRequest& request, Progress& progress,
                           const store::IdempotentResponse<Model>& answer, MemoryLedger* memory) {
  STRATA_TRY(check(request));
  const auto project = STRATA_TRY(store.projects().find(request.project));

  progress.begin_stage(0, kRead);
  progress.report(0, "Reading the file");
  auto loaded = STRATA_TRY(
      mesh::load_mesh(request.files, progress,
                      {request.weld_distance, {request.cell, request.gap}, request.parts}));
  if (request.strict) STRATA_TRY(refuse_faults(loaded.repairs));

  const std::string& crs = request.crs.empty() ? loaded.crs : request.crs;
  ScaleProposal proposal = mesh::propose_scale(loaded, crs);
  if (request.unit) {
    proposal.unit = *request.unit;
    proposal.unit_reason = ScaleReason::given;
    proposal.unit_confidence = 1;
  }
  if (!request.up.empty()) {
    proposal.up = request.up;
    proposal.up_reason = ScaleReason::given;
    proposal.up_confidence = 1;
  }
  if (progress.cancelled()) return cancelled_problem();

  progress.begin_stage(kRead, kUnfolded);
  auto atlas = STRATA_TRY(atlas_for(loaded.mesh, loaded.repairs, progress));

  progress.begin_stage(kUnfolded, kPainted);
  store::NewModel fresh;
  auto base_color =
      STRATA_TRY(mesh::bake_base_color(loaded.mesh, atlas, loaded.repairs, progress, memory));
  if (auto& color = base_color)
    fresh.images.push_back({"Base colour", std::string(media_type(color->format)),
                            std::move(color->bytes), color->width, color->height});

  progress.begin_stage(kPainted, kBuilt);
  progress.report(0, "Building the model");
  if (progress.cancelled()) return cancelled_problem();
  mesh::Geometry geometry = mesh::build_geometry(loaded.mesh, atlas);
  loaded.mesh = {};  // frees memory for large scans, because the geometry contains the mesh
  atlas.corner_uvs = {};

  Model& model = fresh.model;
  model.project_id = project.id;
  model.name = request.name.empty() ? default_name(request) : request.name;
  model.slug = make_slug(model.name);
  const auto unit = request.unit ? request.unit : loaded.unit;
  model.unit = unit.value_or(request.unit_proposed ? proposal.unit : Unit::m);
  model.unit_assumed = !unit;
  const std::string& up = request.up.empty() ? loaded.up : request.up;
  if (!up.empty())
    model.up = up;
  else if (request.up_proposed)
    model.up = proposal.up;
  model.proposal = proposal;
  model.crs = crs;
  model.from_points = loaded.from_points;
  model.parts = std::move(loaded.parts);
  fresh.object_name = request.object;
  model.survey_date = request.survey_date;
  model.default_resolution = request.resolution == 0 ? kLowestResolution : request.resolution;
  model.atlas = atlas.report;
  model.repairs = loaded.repairs;
  STRATA_TRY(put_geometry(std::move(geometry), progress, fresh));

  progress.begin_stage(kBuilt, 1);
  progress.report(0, "Saving");
  fresh.sources = sources_of(request);
  progress.report(0.5, "Saving");
  auto created = store.models().create(
      fresh, [&progress] { return progress.cancelled(); }, answer);
  if (created) progress.report(1, "Done");
  return created;
}

}  // namespace strata::jobs
