#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "mesh/load_formats.h"
#include "mesh/polygon.h"

namespace strata::mesh {

// Collects polygons as triangles: shared by the formats. Texture coordinates are kept for all corners or for none.
class FaceBuilder {
 public:
  explicit FaceBuilder(TriangleMesh& mesh) : mesh_(mesh) {}

  struct Corner {
    std::uint32_t position = 0;  // in range: the caller has checked it
    glm::vec2 uv{0};
  };

  // Refuses polygons of more than kMaxPolygonCorners; `place` is called for the message only.
  template <class Place>
  Result<void> add(const std::vector<Corner>& corners, bool has_uv, Place place) {
    if (corners.size() < 3) {
      ++too_few_corners_;
      return {};
    }
    if (corners.size() > kMaxPolygonCorners) {
      return refuse_file("The face at " + place() + " has " + std::to_string(corners.size()) +
                         " corners; at most 4096 are taken. Triangulate the mesh before importing it.");
    }
    if (corners.size() == 3) {
      add_triangle(corners[0], corners[1], corners[2], has_uv);
      return {};
    }
    ++polygons_;
    points_.clear();
    for (const Corner& corner : corners) points_.push_back(mesh_.positions[corner.position]);
    triangulate_polygon(points_, split_);
    for (std::size_t i = 0; i + 2 < split_.size(); i += 3) {
      add_triangle(corners[split_[i]], corners[split_[i + 1]], corners[split_[i + 2]], has_uv);
    }
    return {};
  }

  void add_triangle(const Corner& a, const Corner& b, const Corner& c, bool has_uv) {
    mesh_.triangles.insert(mesh_.triangles.end(), {a.position, b.position, c.position});
    const bool finite = has_uv && finite_uv(a) && finite_uv(b) && finite_uv(c);
    if (!finite) {
      ++without_uv_;
      if (!mesh_.corner_uvs.empty()) mesh_.corner_uvs.insert(mesh_.corner_uvs.end(), 3, glm::vec2(0));
      return;
    }
    // The first triangle with coordinates: those before it get none.
    if (mesh_.corner_uvs.empty()) {
      mesh_.corner_uvs.reserve(mesh_.triangles.capacity());
      mesh_.corner_uvs.resize(mesh_.triangles.size() - 3, glm::vec2(0));
    }
    mesh_.corner_uvs.insert(mesh_.corner_uvs.end(), {a.uv, b.uv, c.uv});
  }

  void report(std::vector<Repair>& repairs) const {
    note(repairs, "polygons split into triangles", polygons_);
    note(repairs, "dropped faces with fewer than three corners", too_few_corners_);
    if (!mesh_.corner_uvs.empty()) note(repairs, "triangles without texture coordinates", without_uv_);
  }

 private:
  static bool finite_uv(const Corner& corner) { return std::isfinite(corner.uv.x) && std::isfinite(corner.uv.y); }

  TriangleMesh& mesh_;
  std::vector<glm::dvec3> points_;
  std::vector<std::uint32_t> split_;
  std::uint64_t polygons_ = 0;
  std::uint64_t too_few_corners_ = 0;
  std::uint64_t without_uv_ = 0;
};

}  // namespace strata::mesh
