#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

#include "core/error.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/texel_graph.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
class RayScene;
}

namespace strata::query {

// Where water lands that falls off a surface: straight below, on the first face that it meets from
// its front. Water that meets nothing, or the back of a face farther away than its rim, leaves the
// model.
class WaterFalls {
 public:
  // `map` and `graph` belong to the geometry, and must outlive this object. `up` is in model axes
  // and has length 1. Fails like RayScene::make.
  static Result<WaterFalls> make(std::shared_ptr<const mesh::Geometry> geometry,
                                 const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                 glm::dvec3 up, Progress& progress);
  WaterFalls(WaterFalls&&) noexcept;
  ~WaterFalls();

  // Return the surface texel where water lands, or kNoNeighbour. It falls from a texel that faces
  // down, or over the edge of the surface at a texel.
  std::uint32_t below(std::uint32_t texel) const;
  std::uint32_t below_edge(std::uint32_t texel) const;

 private:
  WaterFalls(std::shared_ptr<const mesh::Geometry> geometry, std::unique_ptr<mesh::RayScene> scene,
             const mesh::SurfaceMap& map, const mesh::TexelGraph& graph, glm::dvec3 up);
  glm::vec3 place(std::uint32_t texel) const;
  std::uint32_t landing(const glm::vec3& from, float least) const;
  std::uint32_t texel_near(glm::vec2 uv, const glm::vec3& place) const;

  std::shared_ptr<const mesh::Geometry> geometry_;
  std::unique_ptr<mesh::RayScene> scene_;
  const mesh::SurfaceMap* map_;
  const mesh::TexelGraph* graph_;
  glm::vec3 down_;
  float texel_size_;  // mean
};

}  // namespace strata::query
