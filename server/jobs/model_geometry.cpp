#include "jobs/model_geometry.h"

#include <future>

#include "mesh/surface/detail_levels.h"
#include "mesh/surface/open_edges.h"
#include "store/content/models.h"

namespace strata::jobs {

Result<void> put_geometry(const mesh::Geometry& geometry, Progress& progress,
                          store::NewModel& fresh) {
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
  // In parallel: making the coarser copies keeps one core busy for as long.
  auto open_edges =
      std::async(std::launch::async, [&geometry] { return mesh::measure_open_edges(geometry); });
  const auto levels = STRATA_TRY(mesh::make_detail_levels(geometry, progress));
  for (const mesh::Geometry& level : levels)
    fresh.detail_levels.push_back(mesh::encode_geometry(level));
  fresh.geometry = mesh::encode_geometry(geometry);
  model.open_edges = open_edges.get();
  return {};
}

}  // namespace strata::jobs
