#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace strata::mesh {

constexpr std::size_t kMaxPolygonCorners = 4096;

// Splits a polygon in space into triangles with the same winding. A convex polygon becomes a fan.
// Otherwise ears are clipped in the plane of the polygon's area vector. `corners` has the points in
// order, from 3 to kMaxPolygonCorners. Replaces the content of `triangles` with n-2 triples of
// corner numbers. A self-crossing or non-finite outline also becomes n-2 triangles.
void triangulate_polygon(std::span<const glm::dvec3> corners,
                         std::vector<std::uint32_t>& triangles);

}  // namespace strata::mesh
