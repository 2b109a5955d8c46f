#pragma once

#include <memory>
#include <optional>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Queries for the nearest point and for rays on a model's surface, in model space (world minus
// origin), without the GPU. Immutable after construction. Queries are thread-safe.
class SearchTree {
 public:
  // Shares ownership of `geometry`.
  explicit SearchTree(std::shared_ptr<const Geometry> geometry);
  ~SearchTree();
  SearchTree(const SearchTree&) = delete;
  SearchTree& operator=(const SearchTree&) = delete;

  struct Hit {
    glm::vec3 position;  // in model space
    glm::vec3 normal;    // unit normal of the triangle, outward
    glm::vec2 uv;
    float distance;  // from the query point, or along the ray
    std::uint32_t triangle;
    glm::vec3 barycentric;
  };
  std::optional<Hit> nearest(const glm::vec3& point, float max_distance) const;
  // Searches among triangles with a normal within an angle of the unit vector `normal`. `least_cos`
  // is the cosine of this angle. The search therefore finds the correct side of a thin wall.
  std::optional<Hit> nearest_facing(const glm::vec3& point, float max_distance,
                                    const glm::vec3& normal, float least_cos) const;
  // A ray passes through hidden parts.
  std::optional<Hit> first_hit(const glm::vec3& origin, const glm::vec3& direction,
                               const PartSet& hidden_parts = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::mesh
