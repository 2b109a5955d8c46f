#pragma once

#include <memory>
#include <optional>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Nearest point and ray queries on a model's surface, in model space (world minus origin), without
// the GPU. Immutable after construction; queries are thread-safe.
class SearchTree {
 public:
  // Shares ownership of `geometry`.
  explicit SearchTree(std::shared_ptr<const Geometry> geometry);
  ~SearchTree();
  SearchTree(const SearchTree&) = delete;
  SearchTree& operator=(const SearchTree&) = delete;

  struct Hit {
    glm::vec3 position;  // model space
    glm::vec3 normal;    // of the triangle, unit, outward
    glm::vec2 uv;
    float distance;  // from the query point, or along the ray
    std::uint32_t triangle;
    glm::vec3 barycentric;
  };
  std::optional<Hit> nearest(const glm::vec3& point, float max_distance) const;
  // Searches among triangles whose normal is within an angle of `normal` (unit; `least_cos` is the
  // cosine): this selects the right side of a thin wall.
  std::optional<Hit> nearest_facing(const glm::vec3& point, float max_distance,
                                    const glm::vec3& normal, float least_cos) const;
  std::optional<Hit> first_hit(const glm::vec3& origin, const glm::vec3& direction) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::mesh
