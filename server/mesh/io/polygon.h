#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace strata::mesh {

constexpr std::size_t kMaxPolygonCorners = 4096;

// Splits a polygon in space into triangles that keep its winding: a fan where it is convex, ear
// clipping otherwise, in the plane of its area vector. `corners` are its points in order,
// 3…kMaxPolygonCorners of them. Replaces the content of `triangles` by n-2 triples of corner
// numbers. A self-crossing or non-finite outline also gives n-2 triangles.
void triangulate_polygon(std::span<const glm::dvec3> corners,
                         std::vector<std::uint32_t>& triangles);

}  // namespace strata::mesh
