#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <vector>

#include "mesh/io/load_formats.h"
#include "mesh/io/polygon.h"

namespace strata::mesh {

// Converts the polygons of all formats to triangles. Texture coordinates are kept either for all
// corners or for no corner. Triangles without texture coordinates get no textured material.
class FaceBuilder {
 public:
  FaceBuilder(TriangleMesh& mesh, std::size_t max_triangles)
      : mesh_(mesh), max_triangles_(max_triangles) {}

  struct Corner {
    std::uint32_t position = 0;  // in range; the caller checks it
    glm::vec2 uv{0};
  };

  // Reserves memory for this number of triangles.
  void reserve(std::size_t faces) { mesh_.triangles.reserve(3 * std::min(faces, max_triangles_)); }

  // Readers call this function before they store the corners of a face with more than
  // kMaxPolygonCorners corners.
  static tl::unexpected<Error> too_many_corners(const std::string& place) {
    return refuse_file("The face at " + place + " has more than " +
                       std::to_string(kMaxPolygonCorners) +
                       " corners. Triangulate the mesh before importing it.");
  }

  // Sets the material of the triangles added after this call. The mesh already has its materials
  // and their textures.
  void use_material(std::uint16_t material) { material_ = material; }

  // `corners` has at most kMaxPolygonCorners entries. Refuses triangles beyond the limit.
  Result<void> add(const std::vector<Corner>& corners, bool has_uv) {
    assert(corners.size() <= kMaxPolygonCorners);
    if (corners.size() < 3) {
      ++too_few_corners_;
      return {};
    }
    if (corners.size() == 3) return add_triangle(corners[0], corners[1], corners[2], has_uv);
    ++polygons_;
    points_.clear();
    for (const Corner& corner : corners) points_.push_back(mesh_.positions[corner.position]);
    triangulate_polygon(points_, split_);
    for (std::size_t i = 0; i + 2 < split_.size(); i += 3) {
      auto added =
          add_triangle(corners[split_[i]], corners[split_[i + 1]], corners[split_[i + 2]], has_uv);
      if (!added) return added;
    }
    return {};
  }

  Result<void> add_triangle(const Corner& a, const Corner& b, const Corner& c, bool has_uv) {
    if (mesh_.triangle_count() >= max_triangles_) {
      return refuse_file("The faces of the file form more than " + std::to_string(max_triangles_) +
                         " triangles. Reduce the mesh, or split it into several models.");
    }
    mesh_.triangles.insert(mesh_.triangles.end(), {a.position, b.position, c.position});
    const bool finite = has_uv && finite_uv(a) && finite_uv(b) && finite_uv(c);
    if (!mesh_.materials.empty()) {
      const bool usable =
          material_ < mesh_.materials.size() && (finite || mesh_.materials[material_].texture < 0);
      mesh_.triangle_materials.push_back(usable ? material_ : kNoMaterial);
    }
    if (!finite) {
      ++without_uv_;
      if (!mesh_.corner_uvs.empty())
        mesh_.corner_uvs.insert(mesh_.corner_uvs.end(), 3, glm::vec2(0));
      return {};
    }
    // This is the first triangle with coordinates. The triangles before it get zeros.
    if (mesh_.corner_uvs.empty()) {
      mesh_.corner_uvs.reserve(mesh_.triangles.capacity());
      mesh_.corner_uvs.resize(mesh_.triangles.size() - 3, glm::vec2(0));
    }
    mesh_.corner_uvs.insert(mesh_.corner_uvs.end(), {a.uv, b.uv, c.uv});
    return {};
  }

  void report(std::vector<Repair>& repairs) const {
    note(repairs, "polygons split into triangles", polygons_);
    note(repairs, "dropped faces with fewer than three corners", too_few_corners_);
    if (!mesh_.corner_uvs.empty())
      note(repairs, "triangles without texture coordinates", without_uv_);
  }

 private:
  static bool finite_uv(const Corner& corner) {
    return std::isfinite(corner.uv.x) && std::isfinite(corner.uv.y);
  }

  TriangleMesh& mesh_;
  const std::size_t max_triangles_;
  std::vector<glm::dvec3> points_;
  std::vector<std::uint32_t> split_;
  std::uint16_t material_ = kNoMaterial;
  std::uint64_t polygons_ = 0;
  std::uint64_t too_few_corners_ = 0;
  std::uint64_t without_uv_ = 0;
};

}  // namespace strata::mesh
