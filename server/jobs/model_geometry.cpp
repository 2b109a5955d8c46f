#include "jobs/model_geometry.h"

#include <algorithm>
#include <future>

#include "mesh/analysis/vertex_openness.h"
#include "mesh/surface/detail_levels.h"
#include "mesh/surface/open_edges.h"
#include "store/content/models.h"

namespace strata::jobs {

namespace {

// The message for a part of a stage, because stages of `progress` cannot be nested.
constexpr const char* kShading = "Shading the model";

// Ignores all Errors except a cancellation: a model without baked light is still valid.
Result<void> unless_cancelled(const Result<void>& baked) {
  if (baked || baked.error().code != ErrorCode::cancelled) return {};
  return tl::unexpected(baked.error());
}

// Makes the coarser copies. Bakes the light into the full mesh and its copies.
Result<std::vector<mesh::Geometry>> shaded_levels(mesh::Geometry& geometry, Progress& progress) {
  const auto traced = [](const mesh::Geometry& level) {
    return level.triangle_count() <= mesh::kMostTracedTriangles;
  };
  if (traced(geometry)) {  // the copies have the baked vertices
    STRATA_TRY(unless_cancelled(mesh::bake_openness(geometry, progress)));
    return mesh::make_detail_levels(geometry, progress);
  }
  auto levels = STRATA_TRY(mesh::make_detail_levels(geometry, progress));
  const auto finest = std::ranges::find_if(levels, traced);
  if (finest == levels.end()) return levels;
  const auto baked = mesh::bake_openness(*finest, progress);
  STRATA_TRY(unless_cancelled(baked));
  if (!baked) return levels;
  progress.report(1, kShading);
  mesh::copy_openness(*finest, geometry);
  for (mesh::Geometry& level : levels)
    if (&level != &*finest) mesh::copy_openness(*finest, level);
  return levels;
}

}  // namespace

Result<void> put_geometry(mesh::Geometry geometry, Progress& progress, store::NewModel& fresh) {
  Model& model = fresh.model;
  model.origin = geometry.origin;
  model.triangles = geometry.triangle_count();
  model.vertices = geometry.positions.size();
  model.area = mesh::surface_area(geometry);
  model.bounds_min = model.bounds_max = geometry.positions.front();
  for (const auto& position : geometry.positions) {
    model.bounds_min = glm::min(model.bounds_min, position);
    model.bounds_max = glm::max(model.bounds_max, position);
  }
  // Runs while the coarser copies are made. Each task uses one core and takes about as long.
  auto open_edges =
      std::async(std::launch::async, [&geometry] { return mesh::measure_open_edges(geometry); });
  const auto levels = STRATA_TRY(shaded_levels(geometry, progress));
  for (const mesh::Geometry& level : levels)
    fresh.detail_levels.push_back(mesh::encode_geometry(level));
  fresh.geometry = mesh::encode_geometry(geometry);
  model.open_edges = open_edges.get();
  return {};
}

}  // namespace strata::jobs
